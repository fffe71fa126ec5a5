"""Lines through the centre of what two parts share, for joints without hardware."""

from __future__ import annotations

import numpy as np

from kinematify.generate.procedural.solids import ball, box, cylinder, union
from kinematify.joints.hypotheses.propose import centre_lines
from tests.joints.joint_scenes import scene_of
from tests.known import KnownObject, known_object, turning

HIP = (0.1, 0.0, 0.3)


def walker() -> KnownObject:
    """A box with a leg that ends in a ball, inside the box; the leg hangs askew."""
    leg = union(ball(0.04, (0, 0, 0)), cylinder(0.02, (0, 0, 0), (0, 0, -0.25))).rotate((0, 25, 0)).translate(HIP)
    body = box((-0.2, -0.1, 0.28), (0.2, 0.1, 0.45))
    return known_object("walker", {"body": body, "leg": leg}, turning("body", "leg", (0, 1, 0), HIP))


def apart(pivot: np.ndarray, axis: np.ndarray) -> float:
    """Distance of the hip from a line [m]."""
    return float(np.linalg.norm(np.cross(np.array(HIP) - pivot, axis)))


def test_a_limb_that_ends_in_a_ball_turns_about_the_ball() -> None:
    """No box of the leg lies square to the body, and nothing is round about the true line alone."""
    lines = centre_lines(scene_of(walker(), "leg"))
    level = [apart(point, axis) for axis, point in lines if abs(axis[1]) > np.cos(np.radians(1.0))]
    assert min(level) < 0.02
