"""The joint of one part as that of a congruent one: carried over by the motion that lays part and contact upon them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from kinematify.contact.alike import TOLERANCE, matched
from kinematify.contact.graph import pair
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.assembly.part import Assembly
    from kinematify.contact.alike import RigidMotion
    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.candidate import JointEstimate
    from kinematify.robot.arrays import FloatArray

_VERTICES = 2000
"""Parts of fewer vertices are laid upon each other by these at last, which is exact for copies."""


def carried(
    assembly: Assembly, graph: ContactGraph, model: JointEstimate, joint: JointEstimate
) -> Iterator[JointEstimate]:
    """A joint as its twin's is, by each motion or reflection that takes part and contact there, the closest first.

    q moves both alike; a reflection turns the sense of turns. None where the contacts are no twins.

    Args:
        assembly: The parts.
        graph: Their contacts.
        model: The joint that is carried over.
        joint: That of the twin, of which candidates and evidence are kept.
    """
    stop = f"as of {assembly.parts[model.child].name}"
    found = replace(joint, kind=model.kind, lower=model.lower, upper=model.upper, stops=(stop, stop))
    edges = (model.parent, model.child), (joint.parent, joint.child)
    centres = _centre(graph, model), _centre(graph, joint)
    for _, motion in graph.alike.contact_motions(*edges, centres):
        exact = _exact(motion, *(assembly.parts[item.child].vertices for item in (model, joint)))
        mirrored = np.linalg.det(exact.turn) < 0.0 and model.kind is not JointType.PRISMATIC
        axis = exact.directions(model.axis)
        yield replace(found, axis=-axis if mirrored else axis, pivot=exact.points(model.pivot))


def _exact(motion: RigidMotion, one: FloatArray, other: FloatArray) -> RigidMotion:
    """The motion after the vertices of a copy are matched, where that brings them closer than samples can."""
    if len(one) != len(other) or len(one) > _VERTICES:
        return motion
    tolerance = TOLERANCE * float(np.linalg.norm(np.ptp(other, axis=0)))
    finer, apart = matched(one, other, cKDTree(other), motion, tolerance)
    return finer if apart < tolerance else motion


def _centre(graph: ContactGraph, joint: JointEstimate) -> FloatArray:
    """Centre of the contact's area on the child, shape (3,); NaN without contact."""
    contact = graph.by_pair.get(pair(joint.parent, joint.child))
    if contact is None:
        return np.full(3, np.nan)
    samples = contact.samples_a if contact.a == joint.child else contact.samples_b
    total = float(samples.areas.sum())
    return np.asarray(samples.areas @ samples.points / total) if total > 0.0 else np.full(3, np.nan)
