"""Opening direction and limits."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.joints.candidate import JointType
from kinematify.joints.limits import find_range
from tests.joint_scenes import CONFIG, estimates_of, scene_of
from tests.objects import BUILDERS


@pytest.mark.parametrize("name", ["edge_door", "drawer", "piano_box"])
def test_positive_motion_opens(name: str) -> None:
    known = BUILDERS[name]()
    estimates = estimates_of(name)
    for joint in known.joints:
        estimate = estimates[joint.child]
        assert float(estimate.axis @ joint.axis) > 0.9, joint.child
        assert estimate.upper > 0.0
        assert estimate.lower <= 0.0


@pytest.mark.parametrize("name", ["edge_door", "drawer"])
def test_reversing_the_given_axis_gives_the_same_joint(name: str) -> None:
    known = BUILDERS[name]()
    joint = known.joints[0]
    scene = scene_of(known, joint.child)
    there = find_range(scene, joint.kind, joint.axis, joint.pivot, CONFIG.joints)
    back = find_range(scene, joint.kind, -joint.axis, joint.pivot, CONFIG.joints)
    assert there.sign == -back.sign
    assert (there.lower, there.upper) == pytest.approx((back.lower, back.upper))


def test_limits_bound_the_designed_range_from_above() -> None:
    known = BUILDERS["drawer"]()
    estimate = estimates_of("drawer")["drawer"]
    assert estimate.upper >= 0.9 * known.joints[0].upper
    length = np.ptp(known.parts[1].vertices[:, 1])
    assert estimate.upper <= length


def test_a_door_opens_to_a_right_angle_at_most() -> None:
    known = BUILDERS["edge_door"]()
    estimate = estimates_of("edge_door")[known.joints[0].child]
    assert estimate.upper == pytest.approx(np.radians(CONFIG.joints.limits.panel_deg), abs=0.2)


def test_a_knob_turns_without_end() -> None:
    estimate = estimates_of("knob")["knob"]
    assert estimate.kind is JointType.CONTINUOUS
    assert (estimate.lower, estimate.upper) == (-np.inf, np.inf)


def test_arms_have_limits_to_both_sides() -> None:
    for estimate in estimates_of("serial_arm").values():
        assert -np.pi <= estimate.lower < 0.0 < estimate.upper <= np.pi
