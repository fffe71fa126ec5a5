"""The joint of one part as that of a congruent one: carried over by the motion that lays part and contact upon them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from kinematify.contact.alike import REACH, SAMPLES, TOLERANCE, RigidMotion, matched, motions_between
from kinematify.contact.graph import pair
from kinematify.geometry.sampling import sample_surface
from kinematify.joints.bearings.line import Line
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly
    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.candidate import JointEstimate
    from kinematify.robot.arrays import FloatArray

Edge = tuple[int, int]
"""Parent and child."""
_VERTICES = 2000
"""Parts of fewer vertices are laid upon each other by these at last, which is exact for copies."""


class TwinJoints:
    """Motions between the contacts of congruent parts, each found once."""

    def __init__(self, assembly: Assembly, graph: ContactGraph, *, seed: int) -> None:
        """Keep the parts; clouds and motions are made when first asked for."""
        self._assembly, self._graph, self._seed = assembly, graph, seed
        self._clouds: dict[int, FloatArray] = {}
        self._between: dict[Edge, list[RigidMotion]] = {}

    def motions(self, model: Edge, twin: Edge) -> list[RigidMotion]:
        """Motions and reflections that lay the child and the contact of one edge upon those of another one.

        Args:
            model: Parent and child.
            twin: Parent and child.

        Returns:
            The one that also brings the parents closest comes first; none where the contacts are no twins.
        """
        found = []
        tree = cKDTree(self._cloud(twin[0]))
        for motion in self._of_parts(model[1], twin[1]):
            if self._contact_misses(model, twin, motion) <= REACH * self._diagonal(twin[1]):
                found.append((float(tree.query(motion.points(self._cloud(model[0])))[0].mean()), motion))
        return [motion for _, motion in sorted(found, key=lambda item: item[0])]

    def carried(self, model: JointEstimate, joint: JointEstimate) -> list[JointEstimate]:
        """A joint as its twin's is, by each of `motions`.

        Args:
            model: The joint that is carried over.
            joint: That of the twin, of which candidates and evidence are kept.
        """
        stop = f"as of {self._assembly.parts[model.child].name}"
        found = replace(joint, kind=model.kind, lower=model.lower, upper=model.upper, stops=(stop, stop))
        motions = self.motions((model.parent, model.child), (joint.parent, joint.child))
        lines = (carried_line(model, motion) for motion in motions)
        return [replace(found, axis=axis, pivot=pivot) for axis, pivot in lines]

    def _of_parts(self, first: int, second: int) -> list[RigidMotion]:
        if (first, second) not in self._between:
            tolerance = TOLERANCE * min(self._diagonal(first), self._diagonal(second))
            motions = motions_between(self._cloud(first), self._cloud(second), tolerance=tolerance)
            self._between[first, second] = [self._exact(motion, first, second) for motion in motions]
        return self._between[first, second]

    def _exact(self, motion: RigidMotion, first: int, second: int) -> RigidMotion:
        """The motion after the vertices of a copy are matched, where that brings them closer than samples can."""
        one, other = (self._assembly.parts[part].vertices for part in (first, second))
        if len(one) != len(other) or len(one) > _VERTICES:
            return motion
        finer, apart = matched(one, other, cKDTree(other), motion)
        return finer if apart < TOLERANCE * self._diagonal(second) else motion

    def _contact_misses(self, model: Edge, twin: Edge, motion: RigidMotion) -> float:
        """Measure how far the contact of one edge is from that of the other after a motion [m]; 0 without contacts."""
        here, there = self._contact(model), self._contact(twin)
        if here is None or there is None:
            return 0.0
        return float(np.linalg.norm(motion.points(here) - there))

    def _contact(self, edge: Edge) -> FloatArray | None:
        """Centre of the contact's area on the child, shape (3,)."""
        contact = self._graph.by_pair.get(pair(*edge))
        if contact is None:
            return None
        samples = contact.samples_a if contact.a == edge[1] else contact.samples_b
        if not len(samples.points) or samples.areas.sum() <= 0.0:
            return None
        return np.asarray(np.average(samples.points, axis=0, weights=samples.areas))

    def _cloud(self, part: int) -> FloatArray:
        if part not in self._clouds:
            samples = sample_surface(self._assembly.parts[part], SAMPLES, self._seed)
            self._clouds[part] = samples.points
        return self._clouds[part]

    def _diagonal(self, part: int) -> float:
        return self._assembly.parts[part].diagonal


def carried_line(model: JointEstimate, motion: RigidMotion) -> tuple[FloatArray, FloatArray]:
    """Axis and pivot of a joint after a motion, such that q moves both alike; a reflection turns the sense of turns."""
    mirrored = float(np.linalg.det(motion.turn)) < 0.0
    axis = motion.directions(model.axis)
    if mirrored and model.kind is not JointType.PRISMATIC:
        axis = -axis
    return axis, Line(axis=axis, point=motion.points(model.pivot)).foot(motion.points(model.pivot))
