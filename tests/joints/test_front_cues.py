"""What stands at the foot of a bin tells its front from its back, and pedals go down."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.generate.procedural.solids import box, cylinder, tray
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import infer_joints, scene_of
from tests.known import KnownObject, known_object, turning, with_yaw

OPEN = (0.0, 1.5)


def bin_with(*foot: str, yaw: float = 0.0) -> KnownObject:
    """A bin with a loose lid, symmetric but for its foot; its front looks along -y."""
    solids = {
        "body": tray((-0.2, -0.2, 0.02), (0.2, 0.2, 0.6), 0.006),
        "lid": box((-0.21, -0.21, 0.601), (0.21, 0.21, 0.63)),
    }
    joints = [turning("body", "lid", (-1, 0, 0), (0, 0.21, 0.601), OPEN)]
    if "wheels" in foot:
        for k, x in enumerate((-0.225, 0.225)):
            solids[f"wheel_{k}"] = cylinder(0.06, (x - 0.02, 0.16, 0.06), (x + 0.02, 0.16, 0.06))
            joints.append(turning("body", f"wheel_{k}", (1, 0, 0), (x, 0.16, 0.06), (-np.inf, np.inf)))
    if "castors" in foot:
        for k, (x, y) in enumerate([(-0.225, -0.16), (0.225, -0.16), (-0.225, 0.16), (0.225, 0.16)]):
            solids[f"wheel_{k}"] = cylinder(0.04, (x - 0.02, y, 0.04), (x + 0.02, y, 0.04))
            joints.append(turning("body", f"wheel_{k}", (1, 0, 0), (x, y, 0.04), (-np.inf, np.inf)))
    if "pedal" in foot:
        solids["pedal"] = box((-0.04, -0.27, 0.05), (0.04, -0.2, 0.06))
        joints.append(turning("body", "pedal", (1, 0, 0), (0, -0.2, 0.055), (0.0, 0.3)))
    return with_yaw(known_object("bin", solids, *joints), yaw)


@pytest.mark.parametrize("foot", ["wheels", "pedal"])
@pytest.mark.parametrize("yaw", [0.0, 2.2])
def test_the_lid_is_hinged_above_the_wheels_and_opposite_the_pedal(foot: str, yaw: float) -> None:
    known = bin_with(foot, yaw=yaw)
    found = infer_joints(known)["lid"]
    truth = known.joints[0]
    assert found.kind is JointType.REVOLUTE
    assert float(found.axis @ truth.axis) > np.cos(np.radians(2.0))
    assert np.linalg.norm(np.cross(found.pivot - truth.pivot, truth.axis)) < 0.05


def test_feet_all_around_tell_nothing() -> None:
    assert not scene_of(bin_with("castors"), "lid").front.any()
    assert not scene_of(bin_with(), "lid").front.any()


def test_a_pedal_tips_down_about_its_inner_end() -> None:
    known = bin_with("pedal", yaw=0.7)
    found = infer_joints(known)["pedal"]
    truth = known.joints[1]
    assert found.kind is JointType.REVOLUTE
    assert float(found.axis @ truth.axis) > np.cos(np.radians(2.0))
    assert np.linalg.norm(np.cross(found.pivot - truth.pivot, truth.axis)) < 0.02
    assert found.lower == 0.0
    assert 0.0 < found.upper < 1.0
