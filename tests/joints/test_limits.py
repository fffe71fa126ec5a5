"""Opening direction and limits."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.generate.procedural.pieces.bearing_pieces import barrel
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.generate.registry import build
from kinematify.joints.choice.limits import find_range
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import CONFIG, estimates_of, infer_joints, scene_of
from tests.known import KnownObject, known_object, sliding, turning
from tests.objects import BUILDERS


@pytest.mark.parametrize("name", ["edge_door", "drawer"])
def test_positive_motion_opens(name: str) -> None:
    known = BUILDERS[name]()
    estimates = estimates_of(name)
    for joint in known.joints:
        estimate = estimates[joint.child]
        assert float(estimate.axis @ joint.axis) > 0.9, joint.child
        assert estimate.upper > 0.0
        assert estimate.lower <= 0.0


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


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_leaf_opens_to_the_side_of_its_barrels(side: float) -> None:
    """Two leaves in a plane that both turn freely; only the barrels between them tell which way they fold."""
    level = side * 0.03
    anchors = ((-0.03, -0.006, 0.0, 0.02), (0.006, 0.03, 0.0, 0.02))
    halves = barrel(0.1, 0.008, 4e-4, anchors)
    solids = {}
    for name, half, (left, right) in zip(("fixed", "leaf"), halves, ((-0.4, -0.01), (0.01, 0.4)), strict=True):
        knuckles = half if side < 0 else half.mirror((0, 1, 0))
        solids[name] = box((left, -0.015, -0.5), (right, 0.015, 0.5))
        solids[name] += knuckles.translate((0, level, -0.3)) + knuckles.translate((0, level, 0.3))
    joint = turning("fixed", "leaf", (0, 0, side), (0, level, 0), limits=(0.0, 2.5))
    found = infer_joints(known_object("fold", solids, joint))["leaf"]
    assert float(found.axis @ joint.axis) > 0.99


def test_a_button_on_the_foot_of_a_lamp_is_pressed_down() -> None:
    """The middle of the lamp lies above the button, and what hangs on the post makes a machine of joints in series."""
    foot = box((-0.1, -0.1, 0), (0.1, 0.1, 0.03)) - box((-0.0105, -0.0905, 0.018), (0.0105, -0.0695, 0.1))
    solids = {"lamp": foot + cylinder(0.01, (0, 0, 0.02), (0, 0, 0.6))}
    solids["button"] = box((-0.01, -0.09, 0.022), (0.01, -0.07, 0.033))
    joints = [sliding("lamp", "button", (0, 0, -1), (0, -0.08, 0.03), (0.0, 0.003))]
    for k in range(3):
        solids[f"link_{k}"] = box((-0.02, 0.011 + 0.05 * k, 0.5), (0.02, 0.06 + 0.05 * k, 0.52))
        joints.append(
            turning(f"link_{k - 1}" if k else "lamp", f"link_{k}", (0, 0, 1), (0, 0.011 + 0.05 * k, 0.5), (-1, 1))
        )
    scene = scene_of(known_object("lamp", solids, *joints), "button")
    assert scene.serial
    found = find_range(scene, JointType.PRISMATIC, np.array([0.0, 0.0, 1.0]), joints[0].pivot)
    assert found.sign < 0.0
    assert found.ahead.motion < 0.011


@pytest.mark.parametrize("share", [0.0, 0.6])
def test_what_stands_ajar_opens_to_a_right_angle_from_its_stop(share: float) -> None:
    """Arms of glasses stop at the frame one way, and meet nothing the other way round."""
    made = build("eyeglasses", {"open": share}, seed=7)
    joints = [turning(joint.parent, joint.child, joint.axis, joint.pivot, (0.0, 1.0)) for joint in made.joints]
    parts = made.assembly.parts
    glasses = KnownObject(name="glasses", parts=parts, joints=tuple(joints), root=parts[0].name)
    for estimate in infer_joints(glasses).values():
        assert estimate.upper - estimate.lower == pytest.approx(np.pi / 2, abs=0.15)
        assert estimate.lower == pytest.approx(-share * np.pi / 2, abs=0.15)
