"""The opening direction of joints that turn both ways alike."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.generate.procedural.pieces.bearing_pieces import fork
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.joints.choice.opening import swing_sign
from tests.joints.joint_scenes import infer_joints, scene_of
from tests.known import KnownObject, known_object, turning

X = np.array([1.0, 0.0, 0.0])


def hand() -> KnownObject:
    """Two fingers side by side on a palm, straight up, free to both sides."""
    solids = {"palm": box((-0.05, -0.008, 0), (0.05, 0.008, 0.07)) + box((-0.02, 0.0, 0.0), (0.02, 0.03, 0.03))}
    joints = []
    for k, x in enumerate((-0.03, 0.03)):
        forked, tongue = (half.translate((x, 0, 0.09)) for half in fork(0.02, 0.008, 3e-4, 0.022))
        solids["palm"] += forked
        solids[f"finger_{k}"] = tongue + box((x - 0.01, -0.008, 0.1), (x + 0.01, 0.008, 0.16))
        joints.append(turning("palm", f"finger_{k}", X, (x, 0, 0.09), (-1.5, 1.5)))
    return known_object("hand", solids, *joints)


def test_all_fingers_open_to_one_side() -> None:
    known = hand()
    found = infer_joints(known)
    signs = {float(np.sign(found[joint.child].axis @ joint.axis)) for joint in known.joints}
    assert len(signs) == 1


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_mirrored_limbs_swing_outwards(side: float) -> None:
    """Two legs on pins along x under a trunk: what opens the one, mirrored, opens the other."""
    solids = {"trunk": box((-0.1, -0.2, 0.5), (0.1, 0.2, 0.8))}
    joints = []
    for name, y in (("left", 0.15), ("right", -0.15)):
        solids[name] = box((-0.03, y - 0.03, 0), (0.03, y + 0.03, 0.48)) + cylinder(
            0.02, (-0.05, y, 0.5), (0.05, y, 0.5)
        )
        joints.append(turning("trunk", name, X, (0, y, 0.5), (-0.5, 0.5)))
    name, y = ("left", 0.15) if side > 0 else ("right", -0.15)
    scene = scene_of(known_object("legs", solids, *joints), name)
    outwards = swing_sign(scene, X, np.array([0.0, y, 0.5]))
    # About +x a leg that hangs swings towards +y.
    assert outwards == side
