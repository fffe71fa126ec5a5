"""Panels that stand open, and how far they close."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.generate.procedural.solids import box
from kinematify.joints.choice.limits import find_range
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import CONFIG, scene_of
from tests.known import known_object, moved, turning

Y = np.array([0.0, 1.0, 0.0])


def lid_range(angle: float, axis: np.ndarray) -> tuple[float, float]:
    """Range of the screen of a laptop that stands open by `angle` [rad], in the direction of `axis`."""
    solids = {"base": box((0, -0.15, 0), (0.2, 0.15, 0.02)), "screen": box((0, -0.15, 0.0202), (0.2, 0.15, 0.03))}
    joint = turning("base", "screen", -Y, (0, 0, 0.0201), (0, 2.4))
    scene = scene_of(moved(known_object("laptop", solids, joint), {"screen": angle}), "screen")
    found = find_range(scene, JointType.REVOLUTE, axis, np.array([0.0, 0.0, 0.0201]))
    # Back into the direction of the true joint, whose positive direction opens.
    return (
        (-found.back.motion, found.ahead.motion)
        if found.sign * float(axis @ -Y) > 0
        else (-found.ahead.motion, found.back.motion)
    )


@pytest.mark.parametrize("angle", [0.8, 2.3])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_lid_that_stands_open_closes_by_as_much(angle: float, sign: float) -> None:
    lower, upper = lid_range(angle, sign * Y)
    assert lower == pytest.approx(-angle, abs=0.1)
    assert 0.0 <= upper < np.pi - angle


def test_a_closed_lid_opens() -> None:
    lower, upper = lid_range(0.0, Y)
    assert lower == pytest.approx(0.0, abs=0.1)
    assert upper == pytest.approx(np.radians(CONFIG.joints.limits.panel_deg), abs=0.1)
