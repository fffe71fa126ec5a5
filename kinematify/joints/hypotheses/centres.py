"""Lines through the centres of a part: where it is in its parent or touches it, and its own centroid.

They are for joints that show no hardware and lie on no edge of a box: limbs that end in a ball, levers, propellers,
heads on a stalk. The box of a round or tilted part says nothing of its joint, so the directions are also those of its
parent and of the whole object.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.measure.frames import UP

if TYPE_CHECKING:
    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray

_DISTINCT_COSINE = float(np.cos(np.radians(4.0)))
_TRIED = 400  # samples of a part, and the least of them that show where solids stand in each other
_LEAST_SHARED = 5
_LEAST_ACROSS = 0.2  # sine between two directions that span a third


def centre_lines(scene: JointScene) -> list[tuple[FloatArray, FloatArray]]:
    """Directions and points of lines through the centre of what parent and child share, and through the centroid."""
    shared = np.concatenate([_within(scene, scene.child, scene.parent), _within(scene, scene.parent, scene.child)])
    if len(shared) >= _LEAST_SHARED:
        held = 0.5 * (shared.min(axis=0) + shared.max(axis=0))
    elif len(scene.contact.points):
        held = scene.contact.centroid
    else:
        held = scene.centre
    points = (held, scene.cache.samples(scene.child).points.mean(axis=0))
    return [(axis, point) for point in points for axis in _directions(scene, held)]


def _within(scene: JointScene, part: int, other: int) -> FloatArray:
    """Samples of a part that lie in the solid of another [m], shape (n, 3)."""
    points = scene.cache.samples(part).points
    low, high = scene.cache.assembly.parts[other].bounds
    near = points[np.all((points > low) & (points < high), axis=1)]
    near = near[:: max(1, len(near) // _TRIED)]
    return near[scene.cache.inside(other, near)]


def _directions(scene: JointScene, held: FloatArray) -> list[FloatArray]:
    """Distinct axes of the whole object, the boxes of parent and child, and those across the way out of the parent."""
    away = scene.centre - held
    found = [*scene.upright_axes, *scene.parent_frame.axes, *scene.frame.axes]
    for first, second in ((away, UP), (away, scene.frame.axes[scene.frame.thin])):
        across = np.cross(first, second)
        length = float(np.linalg.norm(across))
        if length > _LEAST_ACROSS * float(np.linalg.norm(first)) > 0.0:
            found.append(across / length)
    kept: list[FloatArray] = []
    for axis in found:
        if all(abs(float(axis @ other)) < _DISTINCT_COSINE for other in kept):
            kept.append(axis)
    return kept
