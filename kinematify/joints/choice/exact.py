"""Joints along the cylinders and planes that a CAD file states: what was fitted to triangles becomes exact."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from kinematify.joints.bearings.line import Line
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.robot.exact_faces import joined_faces
from kinematify.robot.joint_type import JointType
from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.exact_faces import ExactFaces

_Joint = TypeVar("_Joint", JointEstimate, JointCandidate)
_NEAR = np.radians(1.0)
"""A fitted direction within this angle of an exact one means it [rad]."""
_BESIDE = 5e-3
"""A fitted line within this share of the assembly's diagonal of an exact one means it."""


def with_exact_lines(assembly: Assembly, joint: JointEstimate) -> JointEstimate:
    """Return the joint with its line, and those of its candidates, on the nearest one that a file states.

    What turns is put on the axis of a cylinder of either part, what slides along one or across a plane. Where nothing
    that is stated is near, and for parts of meshes, the joint stays as it is.
    """
    stated = joined_faces([assembly.parts[part].exact for part in (joint.parent, joint.child)])
    if stated is None:
        return joint
    alternatives = tuple(_exact(item, stated, assembly.diagonal) for item in joint.alternatives)
    return replace(_exact(joint, stated, assembly.diagonal), alternatives=alternatives)


def _exact(item: _Joint, stated: ExactFaces, diagonal: float) -> _Joint:
    axes, points = stated.axes, stated.points
    if item.kind is JointType.PRISMATIC:
        direction = _nearest(np.concatenate([axes, stated.normals]), item.axis)
        return item if direction is None else replace(item, axis=direction)
    if not item.kind.turns:
        return item
    beside = lengths_of(np.cross(points - item.pivot, axes))
    near = (_angles(axes, item.axis) < _NEAR) & (beside < _BESIDE * diagonal)
    if not near.any():
        return item
    best = np.flatnonzero(near)[np.argmin(beside[near])]
    axis = axes[best] * np.sign(axes[best] @ item.axis)
    return replace(item, axis=axis, pivot=Line(axis=axis, point=points[best]).foot(item.pivot))


def _nearest(directions: FloatArray, axis: FloatArray) -> FloatArray | None:
    """The direction nearest to an axis, with its sign, if it is near."""
    if not len(directions):
        return None
    angles = _angles(directions, axis)
    best = int(np.argmin(angles))
    return directions[best] * np.sign(directions[best] @ axis) if angles[best] < _NEAR else None


def _angles(directions: FloatArray, axis: FloatArray) -> FloatArray:
    """Between lines, shape (n,) [rad]; by the sine, since cosines near 1 are blunt."""
    return np.asarray(np.arcsin(np.clip(lengths_of(np.cross(directions, axis)), 0.0, 1.0)))
