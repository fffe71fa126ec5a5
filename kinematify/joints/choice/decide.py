"""The public face of joint inference: type, axis, opening direction and limits of every edge of a tree."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from kinematify.contact.graph import pair
from kinematify.joints.bearings.line import Line
from kinematify.joints.candidate import JointEstimate, JointLine, JointType
from kinematify.joints.choice.judge import agreed, judge
from kinematify.joints.choice.limits import find_range
from kinematify.joints.choice.opening import round_odds
from kinematify.joints.features.columns import features_of
from kinematify.joints.features.edge_scene import TreeScenes
from kinematify.joints.features.workspace import PartCache
from kinematify.joints.hypotheses.propose import propose
from kinematify.processes.forked import each
from kinematify.robot.exact_faces import joined_faces
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import JointsConfig
    from kinematify.contact.graph import ContactGraph
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointCandidate
    from kinematify.joints.choice.judge import Posterior
    from kinematify.joints.features.columns import Features
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.exact_faces import ExactFaces


def estimate_joints(
    assembly: Assembly,
    graph: ContactGraph,
    tree: KinematicTree,
    bearings: Mapping[tuple[int, int], EdgeBearing],
    *,
    config: JointsConfig,
    seed: int,
) -> tuple[JointEstimate, ...]:
    """Choose the joint of every tree edge (paper section III-D, with the geometry of everyday.md in place of a VLM).

    Args:
        assembly: The parts, world frame, z up.
        graph: Contact graph with samples and clusters of congruent parts.
        tree: Parent of every part.
        bearings: Bearing lines of the contact edges, keyed (a, b) with a < b.
        config: Weights and thresholds.
        seed: Seed of the surface samples.

    Returns:
        One estimate per edge, in the order of `tree.edges()`.
    """
    cache = PartCache(assembly, graph, samples=config.samples, seed=seed)
    whole = TreeScenes(cache, tree, config)

    def joints_of(group: Sequence[tuple[int, int]]) -> list[JointEstimate]:
        found = [edge_features(whole.scene(edge, bearings.get(pair(*edge)))) for edge in group]
        judged = [judge(features, config.confidence) for features in found]
        if len(group) > 1:
            likely = agreed([item.hypotheses.kinds for item in judged], [item.prior for item in judged])
            fixed = float(np.mean([item.fixed for item in judged]))
            judged = [replace(item, prior=given, fixed=fixed) for item, given in zip(judged, likely, strict=True)]
        chosen = [(one, it, it.alternatives(config.alternatives)) for one, it in zip(found, judged, strict=True)]
        rounds = [
            round_odds(one.scene, best.axis, best.pivot)
            for one, it, (best, *_) in chosen
            if best.kind.turns and it.fixed <= config.confidence.fixed
        ]
        odds = float(np.mean(rounds or [0.0]))
        return [with_exact_lines(assembly, _estimate(*item, odds)) for item in chosen]

    found = each(joints_of, graph.alike.edges(tree))
    estimates = {(joint.parent, joint.child): joint for joints in found for joint in joints}
    return tuple(estimates[edge] for edge in tree.edges())


def _estimate(features: Features, judged: Posterior, options: tuple[JointCandidate, ...], odds: float) -> JointEstimate:
    scene, best = features.scene, options[0]
    fixed = judged.fixed > scene.config.confidence.fixed
    found = find_range(scene, JointType.FIXED if fixed else best.kind, best.axis, best.pivot, odds)
    return JointEstimate(
        parent=scene.parent,
        child=scene.child,
        axis=found.sign * best.axis,
        pivot=best.pivot,
        **found.facts,
        confidence=judged.fixed if fixed else judged.confidence,
        alternatives=options,
        evidence={
            **features.type_cues,
            "odds_prismatic": judged.odds_prismatic,
            "probability_fixed": judged.fixed,
            **found.evidence,
        },
    )


def edge_features(scene: JointScene, given: Sequence[Line] = ()) -> Features:
    """Propose the joints of an edge and measure them.

    Args:
        scene: The edge.
        given: Lines to measure beside the proposals, as turns about them and as slides along them. They have no say in
            the type.
    """
    return features_of(scene, propose(scene, given))


_Joint = TypeVar("_Joint", bound=JointLine)
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
        directions = np.concatenate([axes, stated.normals])
        angles = _angles(directions, item.axis)
        if not len(angles) or angles.min() >= _NEAR:
            return item
        direction = directions[np.argmin(angles)]
        return replace(item, axis=direction * np.sign(direction @ item.axis))
    if not item.kind.turns:
        return item
    beside = lengths_of(crossed(points - item.pivot, axes))
    near = (_angles(axes, item.axis) < _NEAR) & (beside < _BESIDE * diagonal)
    if not near.any():
        return item
    best = np.flatnonzero(near)[np.argmin(beside[near])]
    axis = axes[best] * np.sign(axes[best] @ item.axis)
    return replace(item, axis=axis, pivot=Line(axis=axis, point=points[best]).foot(item.pivot))


def _angles(directions: FloatArray, axis: FloatArray) -> FloatArray:
    """Between lines, shape (n,) [rad]; by the sine, since cosines near 1 are blunt."""
    return np.arcsin(np.clip(lengths_of(crossed(directions, axis)), 0.0, 1.0))
