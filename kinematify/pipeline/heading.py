"""Heading of an object: its turn about the vertical: the inference sees it square to the axes, so this does not matter.

Samples, boxes and customs are taken along the axes of the world; a cabinet at 37 deg has other ones than the same
cabinet at 0 deg, and where two hinges are nearly as likely, that decides.
"""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.vectors import lengths_of, triangle_normals

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly, Part
    from kinematify.contact.graph import ContactEdge, ContactSamples
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointCandidate, JointEstimate
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import FloatArray

_LEVEL = 0.02
"""Faces whose unit normal rises by less than this are walls."""
_QUARTER = 0.5 * np.pi
_WIDE, _NARROW = np.radians(0.5), np.radians(0.01)
"""Walls within the first of each other are of one direction; what most of them have within the second is its angle."""
_SHARE = 0.1
"""Of the area of all walls that one direction needs: round objects have none."""
_SQUARE = 1e-5
"""Objects that are turned by less are left as they are [rad]."""
_GRID = 1e-9
"""Of the object's diagonal: vertices are rounded to this after the turn, lest rounding decides between equals."""


def principal_heading(assembly: Assembly) -> float:
    """The angle by which most walls are turned from the axes of the world, in (-45, 45] deg [rad]; 0 without walls."""
    normals = np.concatenate([triangle_normals(part.vertices[part.faces]) for part in assembly.parts])
    areas = lengths_of(normals)
    walls = (areas > 0.0) & (np.abs(normals[:, 2]) < _LEVEL * areas)
    if not walls.any():
        return 0.0
    angles = np.arctan2(normals[walls, 1], normals[walls, 0]) % _QUARTER
    order = np.argsort(angles, kind="stable")
    angles, areas = angles[order], areas[walls][order]
    around = _area_within(angles, areas, _WIDE)
    best = int(np.argmax(around))
    if around[best] < _SHARE * areas.sum():
        return 0.0
    near = np.abs(_apart(angles, angles[best])) <= _WIDE
    finest = angles[near][int(np.argmax(_area_within(angles, areas, _NARROW)[near]))]
    apart = _apart(angles, finest)
    same = np.flatnonzero(np.abs(apart) <= _NARROW)
    same = same[np.argsort(apart[same], kind="stable")]
    median = same[int(np.searchsorted(np.cumsum(areas[same]), 0.5 * areas[same].sum()))]
    angle = float(angles[median])
    angle = angle - _QUARTER if angle > 0.5 * _QUARTER else angle
    return 0.0 if abs(angle) < _SQUARE else angle


def _apart(angles: FloatArray, angle: float) -> FloatArray:
    """From an angle, a quarter turn being none, in [-45, 45) deg [rad], shape (n,)."""
    return np.asarray((angles - angle + 0.5 * _QUARTER) % _QUARTER - 0.5 * _QUARTER)


def _area_within(angles: FloatArray, areas: FloatArray, reach: float) -> FloatArray:
    """Area of the walls within an angle of each of them, shape (n,); angles ascend, and a quarter turn is none."""
    round_twice = np.concatenate([angles - _QUARTER, angles, angles + _QUARTER])
    sums = np.concatenate([[0.0], np.cumsum(np.tile(areas, 3))])
    ends = (np.searchsorted(round_twice, angles + side * reach) for side in (-1.0, 1.0))
    low, high = (sums[end] for end in ends)
    return np.asarray(high - low)


def rotated(assembly: Assembly, angle: float) -> Assembly:
    """An assembly after a turn about the vertical [rad]."""
    turn, grid = _turn(angle), _GRID * assembly.diagonal

    def moved(part: Part) -> Part:
        exact = None if part.exact is None else part.exact.moved(turn, np.zeros(3))
        vertices = np.round(part.vertices @ turn.T / grid) * grid
        return replace(part, vertices=vertices, exact=exact)

    return replace(
        assembly,
        parts=tuple(map(moved, assembly.parts)),
        set_aside=tuple(replace(item, part=moved(item.part)) for item in assembly.set_aside),
        originals={name: moved(part) for name, part in assembly.originals.items()},
    )


def with_heading(inference: Inference, assembly: Assembly, angle: float) -> Inference:
    """Return what was inferred of a turned assembly, for the assembly as it was given.

    Args:
        inference: Of the assembly after a turn by `-angle`.
        assembly: As it was given.
        angle: [rad].
    """
    turn = _turn(angle)
    edges = tuple(_edge(edge, turn) for edge in inference.graph.edges)
    return replace(
        inference,
        assembly=assembly,
        graph=replace(inference.graph, edges=edges),
        bearings=MappingProxyType({ends: _bearing(item, turn) for ends, item in inference.bearings.items()}),
        joints=tuple(_joint(joint, turn) for joint in inference.joints),
    )


def _turn(angle: float) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _edge(edge: ContactEdge, turn: FloatArray) -> ContactEdge:
    return replace(edge, samples_a=_samples(edge.samples_a, turn), samples_b=_samples(edge.samples_b, turn))


def _samples(samples: ContactSamples, turn: FloatArray) -> ContactSamples:
    return replace(samples, points=samples.points @ turn.T, normals=samples.normals @ turn.T)


def _bearing(bearing: EdgeBearing, turn: FloatArray) -> EdgeBearing:
    lines = tuple(replace(line, axis=turn @ line.axis, pivot=turn @ line.pivot) for line in bearing.lines)
    rail = None if bearing.rail is None else replace(bearing.rail, axis=turn @ bearing.rail.axis)
    return replace(bearing, centroid=turn @ bearing.centroid, lines=lines, rail=rail)


def _joint(joint: JointEstimate, turn: FloatArray) -> JointEstimate:
    others = tuple(_candidate(item, turn) for item in joint.alternatives)
    return replace(joint, axis=turn @ joint.axis, pivot=turn @ joint.pivot, alternatives=others)


def _candidate(item: JointCandidate, turn: FloatArray) -> JointCandidate:
    return replace(item, axis=turn @ item.axis, pivot=turn @ item.pivot)
