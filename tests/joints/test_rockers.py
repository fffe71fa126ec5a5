"""Rockers: the fold of a front shows the line and the stroke, and nothing that is flat, sloped or bulging has one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.generate.procedural.solids import box, cylinder, hull
from kinematify.joints.features.frames import find_fold
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import CONFIG, infer_joints, scene_of
from tests.known import KnownObject, known_object, turning, with_yaw

if TYPE_CHECKING:
    from manifold3d import Manifold

LEAN = np.radians(6.0)


def switch(front: str = "folded", *, level: bool = False) -> KnownObject:
    """A plate on a wall with a rocker 30 by 60 mm in a shallow recess; its pins are not modelled."""
    wide, high, thick = (0.06, 0.03, 0.01) if level else (0.03, 0.06, 0.01)
    across, along = (2, 0) if high > wide else (0, 2)
    room = 0.5 * np.array([wide, 2.0, high]) + 3e-4
    room[across] += 1e-3
    plate = box((-0.06, 0.0, -0.06), (0.06, 0.02, 0.06)) - box(-room, (room[0], 0.01, room[2]))
    half = 0.5 * max(wide, high)
    solid = _front(front, half, 0.5 * min(wide, high), thick)
    if across == 0:
        solid = solid.rotate((0, 90, 0))
    axis = np.eye(3)[along]
    joint = turning("plate", "rocker", axis, (0, 0, 0), (-LEAN, LEAN))
    return known_object("switch", {"plate": plate, "rocker": solid}, joint)


def _front(shape: str, half: float, side: float, thick: float) -> Manifold:
    """A plate 2 `half` high and 2 `side` wide whose front, along -y, has this shape; its back lies at y = 0.0055."""
    back = box((-side, 0.005, -half), (side, 0.0055, half))
    out = thick * 0.5
    if shape == "folded":
        rise = half * np.tan(LEAN)
        ends = [box((-side, -out, s * half - 1e-5), (side, -out + 1e-5, s * half + 1e-5)) for s in (-1, 1)]
        middle = box((-side, rise - out, -1e-5), (side, rise - out + 1e-5, 1e-5))
        flat = [box((-side, 0.005, min(0.0, s * half)), (side, 0.0055, max(0.0, s * half))) for s in (-1, 1)]
        return hull(ends[0], middle, flat[0]) + hull(ends[1], middle, flat[1])
    if shape == "sloped":
        return hull(back, box((-side, -out, half - 1e-5), (side, 0.0, half)))
    if shape == "bulging":
        radius = 0.5 * (half**2 + out**2) / out
        bulge = cylinder(radius, (-side, radius - out, 0), (side, radius - out, 0), segments=600)
        return hull(back, bulge ^ box((-side, -1.0, -half), (side, 0.0, half)))
    return box((-side, -out, -half), (side, 0.0055, half))


@pytest.mark.parametrize("level", [False, True])
def test_a_rocker_tips_about_its_fold(level: bool) -> None:
    """Of one laid on its side, and of one set high, which may be taken for a button."""
    known = with_yaw(switch(level=level), 0.4)
    found = infer_joints(known)["rocker"]
    truth = known.joints[0]
    turn = next(item for item in found.alternatives if item.kind.turns)
    assert abs(float(turn.axis @ truth.axis)) > np.cos(np.radians(1.0))
    offset = np.cross(turn.pivot - truth.pivot, truth.axis)
    assert np.linalg.norm(offset) < 0.006
    if not level:
        assert found.kind is JointType.REVOLUTE
        assert (-found.lower, found.upper) == pytest.approx((LEAN, LEAN), abs=np.radians(1.5))


@pytest.mark.parametrize("shape", ["flat", "sloped", "bulging"])
def test_other_fronts_have_no_fold(shape: str) -> None:
    scene = scene_of(switch(shape), "rocker")
    assert find_fold(scene.cache.samples(scene.child), scene.frame, CONFIG.joints.rockers) is None
