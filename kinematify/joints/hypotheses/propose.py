"""Joints that geometry proposes for one edge: lines to turn about, directions to slide along, and fixed.

A panel has no bearing in most meshes, so lines through its box and its contact stand beside those of bearings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.line import Lines
from kinematify.joints.candidate import CENTRE, CORNER, ELSEWHERE, FIXED, GIVEN, HALF_WAY, SLIDE, TURN, Hypotheses
from kinematify.joints.features.frames import UP
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.joints.bearings.line import Line
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.robot.arrays import FloatArray

_SAME_DEG, _SAME_LINE = 2.0, 0.01  # lines this close, the second in diagonals of the child, are one
_DISTINCT_DEG = 4.0  # of directions through centres
_TRIED = 400  # samples of a part, and the least of them that show where solids stand in each other
_LEAST_SHARED = 5
_LEAST_ACROSS = 0.2  # sine between two directions that span a third
Proposal = tuple["FloatArray", "FloatArray", int, str]
"""Axis, a point, place and source of a line."""


def propose(scene: JointScene, given: Sequence[Line] = ()) -> Hypotheses:
    """Fixed, then every turn, then every slide.

    Args:
        scene: The pair.
        given: Lines from elsewhere that stand beside the proposals, as turns and as slides; their source is `GIVEN`.
    """
    turns = [*_turns(scene), *((line.axis, line.point, ELSEWHERE, GIVEN) for line in given)]
    slides = [*_slides(scene), *((line.axis, GIVEN) for line in given)]
    every: list[Proposal] = [
        (np.zeros(3), scene.anchor, ELSEWHERE, "fixed"),
        *turns,
        *((axis, scene.anchor, ELSEWHERE, source) for axis, source in slides),
    ]
    axes, pivots, places, sources = (np.array(column) for column in zip(*every, strict=True))
    return Hypotheses(
        kinds=np.repeat([FIXED, TURN, SLIDE], [1, len(turns), len(slides)]),
        axes=axes,
        pivots=pivots + np.einsum("cd,cd->c", scene.anchor - pivots, axes)[:, None] * axes,
        places=places,
        sources=sources,
    )


def _turns(scene: JointScene) -> list[Proposal]:
    """Bearing lines, lines through the contact, nine lines per direction of the slab's box, lines through centres."""
    found: list[Proposal] = []
    for line in scene.lines[: scene.config.panels.bearings]:
        beyond_doubt = scene.has_bearing and not found
        found.append((line.axis, line.pivot, ELSEWHERE, "bearing" if beyond_doubt else "weak_bearing"))
    found += _contact_lines(scene)
    found += _box_lines(scene)
    return found + _distinct(scene, centre_lines(scene), found)


def _slides(scene: JointScene) -> list[tuple[FloatArray, str]]:
    """Distinct directions: rail, bearing, the child's box, the parent's box."""
    found: list[tuple[FloatArray, str]] = []
    if scene.rail is not None and scene.mechanism > 0:
        found.append((scene.rail.axis, "rail"))
    if scene.has_bearing:
        found.append((scene.lines[0].axis, "bearing"))
    found += [(axis, "box") for axis in scene.frame.axes]
    found += [(axis, "parent_box") for axis in scene.parent_frame.axes]
    return [found[k] for k in distinct_axes([axis for axis, _ in found], scene.config.slides.distinct_deg)]


def distinct_axes(axes: Sequence[FloatArray], angle: float) -> list[int]:
    """Positions of those directions that differ by more than an angle [deg] from all kept before."""
    every = Lines(axes=np.array(axes), points=np.zeros((len(axes), 3)))
    return every.distinct(len(axes), angle=angle, distance=np.inf)


def _distinct(
    scene: JointScene,
    lines: Sequence[tuple[FloatArray, FloatArray]],
    known: Sequence[Proposal],
) -> list[Proposal]:
    """Those of the lines through centres that run beside all known ones, and beside each other."""
    axes, points = [line[0] for line in known], [line[1] for line in known]
    found = []
    for axis, point in lines:
        apart = lengths_of(crossed(np.array(points) - point, axis))
        same = (np.abs(np.array(axes) @ axis) > np.cos(np.radians(_SAME_DEG))) & (
            apart < _SAME_LINE * scene.frame.diagonal
        )
        if not same.any():
            axes.append(axis)
            points.append(point)
            found.append((axis, point, ELSEWHERE, "centre"))
    return found


def _box_lines(scene: JointScene) -> list[Proposal]:
    frame = scene.frame
    levels = np.stack([frame.slab_lower, 0.5 * (frame.slab_lower + frame.slab_upper), frame.slab_upper])
    found = []
    for along in range(3):
        first, second = (along + 1) % 3, (along + 2) % 3
        for i in range(3):
            for j in range(3):
                corner = levels[1].copy()
                corner[first], corner[second] = levels[i, first], levels[j, second]
                place = (CORNER, HALF_WAY, CENTRE)[(i == 1) + (j == 1)]
                found.append((frame.axes[along], corner @ frame.axes, place, "box_edge"))
    return found


def _contact_lines(scene: JointScene) -> list[Proposal]:
    """The direction that most of a small contact faces, and the long direction of the contact."""
    contact = scene.contact
    if len(contact.points) < scene.config.panels.least_contact:
        return []
    values, vectors = contact.spread
    found = []
    if max(scene.smallness, scene.compact) > 0:
        found.append((contact.facing[1][:, 2], contact.centroid, ELSEWHERE, "contact_axis"))
    if values[1] < 0.1 * values[2]:
        found.append((vectors[:, 2], contact.centroid, ELSEWHERE, "contact_line"))
    return found


def centre_lines(scene: JointScene) -> list[tuple[FloatArray, FloatArray]]:
    """Directions and points of lines through the centre of what parent and child share, and through the centroid.

    They are for joints that show no hardware and lie on no edge of a box: limbs that end in a ball, levers, propellers,
    heads on a stalk. The box of a round or tilted part says nothing of its joint, so the directions are also those of
    its parent and of the whole object.
    """
    shared = np.concatenate([_within(scene, scene.child, scene.parent), _within(scene, scene.parent, scene.child)])
    held = 0.5 * (shared.min(axis=0) + shared.max(axis=0)) if len(shared) >= _LEAST_SHARED else scene.anchor
    points = (held, scene.samples.points.mean(axis=0))
    return [(axis, point) for point in points for axis in _centre_directions(scene, held)]


def _within(scene: JointScene, part: int, other: int) -> FloatArray:
    """Samples of a part that lie in the solid of another [m], shape (n, 3)."""
    points = scene.cache.samples(part).points
    low, high = scene.cache.assembly.parts[other].bounds
    near = points[np.all((points > low) & (points < high), axis=1)]
    near = near[:: max(1, len(near) // _TRIED)]
    return near[scene.cache.inside(other, near)]


def _centre_directions(scene: JointScene, held: FloatArray) -> list[FloatArray]:
    """Distinct axes of the whole object, the boxes of parent and child, and those across the way out of the parent."""
    away = scene.centre - held
    found = [*scene.cache.upright_axes, *scene.parent_frame.axes, *scene.frame.axes]
    for first, second in ((away, UP), (away, scene.frame.thin_axis)):
        across = crossed(first, second)
        length = float(np.linalg.norm(across))
        if length > _LEAST_ACROSS * float(np.linalg.norm(first)) > 0.0:
            found.append(across / length)
    return [found[k] for k in distinct_axes(found, _DISTINCT_DEG)]
