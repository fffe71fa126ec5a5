"""The public face of joint inference: type, axis, opening direction and limits of every edge of a tree."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from kinematify.joints.bearings.line import Line
from kinematify.joints.candidate import JointCandidate, JointEstimate, JointType
from kinematify.joints.choice.judge import agreed, alike_edges, judge
from kinematify.joints.choice.kind import ScoredHypotheses, Siblings, decide_kind
from kinematify.joints.choice.limits import find_range
from kinematify.joints.hypotheses.panels import rank_turns
from kinematify.joints.hypotheses.slides import rank_slides
from kinematify.joints.measure.scene import joint_scene, part_frames
from kinematify.joints.measure.workspace import PartCache
from kinematify.robot.exact_faces import joined_faces
from kinematify.robot.vectors import lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import JointsConfig
    from kinematify.contact.graph import ContactGraph
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.choice.judge import Posterior
    from kinematify.joints.measure.frames import BoxFrame
    from kinematify.joints.measure.scene import JointScene
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
    frames = part_frames(cache, tree, config)
    weighed = {
        edge: weigh_joints(cache, tree, frames, edge, bearings.get((min(edge), max(edge))), config=config)
        for edge in tree.edges()
    }
    judged = {edge: judge(joints, config.confidence) for edge, joints in weighed.items()}
    for group in alike_edges(graph, tree):
        alike = [judged[edge] for edge in group]
        likely = agreed([item.hypotheses.kinds for item in alike], [item.likely for item in alike])
        fixed = float(np.mean([item.fixed for item in alike]))
        judged |= {
            edge: replace(judged[edge], likely=given, fixed=fixed) for edge, given in zip(group, likely, strict=True)
        }
    estimates = (_estimate(weighed[edge], judged[edge], config=config) for edge in tree.edges())
    return tuple(with_exact_lines(assembly, estimate) for estimate in estimates)


def _estimate(weighed: ScoredHypotheses, judged: Posterior, *, config: JointsConfig) -> JointEstimate:
    scene, decision = weighed.scene, weighed.decision
    fixed = decision.kind is JointType.FIXED or judged.fixed > config.confidence.fixed
    kind = JointType.FIXED if fixed else judged.kind(judged.best)
    axis, pivot = judged.hypotheses.axes[judged.best], judged.hypotheses.pivots[judged.best]
    found = find_range(scene, kind, axis, pivot, config)
    return JointEstimate(
        parent=scene.parent,
        child=scene.child,
        axis=found.sign * axis,
        pivot=pivot,
        **found.facts,
        confidence=judged.fixed if judged.fixed > config.confidence.fixed else judged.confidence,
        alternatives=judged.alternatives(config.alternatives),
        evidence={
            **decision.cues,
            "odds_prismatic": judged.odds_prismatic,
            "probability_fixed": judged.fixed,
            "bearing_gate": float(scene.has_bearing),
            "smallness": scene.smallness,
            "mechanism": scene.mechanism,
            **found.evidence,
        },
    )


def weigh_joints(
    cache: PartCache,
    tree: KinematicTree,
    frames: Mapping[int, BoxFrame],
    edge: tuple[int, int],
    bearing: EdgeBearing | None,
    *,
    config: JointsConfig,
    given: Sequence[Line] = (),
) -> ScoredHypotheses:
    """Rank all turns and slides of the tree edge (parent, child) and weigh the types against each other.

    Args:
        cache: Samples and scenes of the parts.
        tree: Parent of every part.
        frames: `part_frames` of the tree.
        edge: Parent and child.
        bearing: Of their contact, if they touch.
        config: Weights and thresholds.
        given: Lines to rank beside the proposals, as turns about them and as slides along them. They have no say in
            the type.
    """
    scene = joint_scene(cache, tree, frames, edge, bearing, config=config)
    twins = leaf_twins(cache.graph, tree, edge)
    siblings = describe_twins(scene, tree, frames, twins)
    turns = rank_turns(scene, config, given)
    grips = _twin_directions(scene, frames, twins) if siblings.gripping else np.empty((0, 3))
    slides = rank_slides(scene, grips, config, [line.axis for line in given])
    decision = decide_kind(scene, siblings, turns.proposed, slides.proposed, config)
    return ScoredHypotheses(scene=scene, turns=turns, slides=slides, decision=decision)


# ---- twins ---------------------------------------------------------------------------------------------------------


def leaf_twins(graph: ContactGraph, tree: KinematicTree, edge: tuple[int, int]) -> tuple[int, ...]:
    """Congruent siblings of the child that carry nothing, without the child itself; none if it carries something."""
    parent, child = edge
    label = graph.cluster_of[child]
    if label < 0 or tree.children[child]:
        return ()
    return tuple(
        part
        for part in graph.clusters[label]
        if part != child and tree.parents[part] == parent and not tree.children[part]
    )


def describe_twins(
    scene: JointScene, tree: KinematicTree, frames: Mapping[int, BoxFrame], twins: tuple[int, ...]
) -> Siblings:
    """What the twins say about the type."""
    return Siblings(
        count=1 + len(twins),
        gripping=len(twins) == 1 and _gripping(scene, tree, frames[twins[0]]),
        overlapping=any(_overlapping(scene, frames[twin]) for twin in twins),
    )


def _gripping(scene: JointScene, tree: KinematicTree, twin: BoxFrame) -> bool:
    """Fingers: no bearing, no panel, standing out of the parent and apart from each other.

    At the end of a chain that is enough. On a base, where doors, legs and wheels are twins too, the pair must also be
    parallel and thin along the line between them.
    """
    apart_line = twin.centre - scene.centre
    apart_line = apart_line / max(float(np.linalg.norm(apart_line)), 1e-12)
    closing = abs(float(apart_line @ scene.frame.axes[scene.frame.thin]))
    parallel = abs(float(apart_line @ twin.axes[twin.thin]))
    facing = min(closing, parallel) > np.cos(np.radians(3.0)) and not scene.plate and scene.smallness < 1.0
    chain_end = (tree.depths[scene.child] >= 2 and scene.smallness < 1.0) or facing  # buttons of a door are no fingers
    stands_out = scene.inside < 0.8
    apart = float(np.linalg.norm(twin.centre - scene.centre)) < 2.0 * float(scene.parent_frame.extents.max())
    return bool(chain_end and stands_out and apart and not scene.has_bearing and not scene.is_round)


def _overlapping(scene: JointScene, twin: BoxFrame) -> bool:
    """Parallel thin panels whose planes differ by about their own thickness, handles included: they can pass."""
    frame = scene.frame
    parallel = np.abs(twin.axes @ frame.axes[frame.thin]).max() > np.cos(np.radians(3.0))
    if not (scene.panel and scene.upright and parallel):
        return False
    shift = (twin.centre - scene.centre) @ frame.axes.T
    thickness = float((frame.upper - frame.lower)[frame.thin])
    depth = abs(float(shift[frame.thin])) / max(thickness, 1e-12)
    return bool(0.6 < depth < 4.0)


def _twin_directions(scene: JointScene, frames: Mapping[int, BoxFrame], twins: tuple[int, ...]) -> FloatArray:
    offsets = [frames[twin].centre - scene.centre for twin in twins]
    long_enough = [offset for offset in offsets if np.linalg.norm(offset) > 1e-6 * scene.diagonal]
    return np.array([offset / np.linalg.norm(offset) for offset in long_enough]).reshape(-1, 3)


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
        directions = np.concatenate([axes, stated.normals])
        angles = _angles(directions, item.axis)
        if not len(angles) or angles.min() >= _NEAR:
            return item
        direction = directions[np.argmin(angles)]
        return replace(item, axis=direction * np.sign(direction @ item.axis))
    if not item.kind.turns:
        return item
    beside = lengths_of(np.cross(points - item.pivot, axes))
    near = (_angles(axes, item.axis) < _NEAR) & (beside < _BESIDE * diagonal)
    if not near.any():
        return item
    best = np.flatnonzero(near)[np.argmin(beside[near])]
    axis = axes[best] * np.sign(axes[best] @ item.axis)
    return replace(item, axis=axis, pivot=Line(axis=axis, point=points[best]).foot(item.pivot))


def _angles(directions: FloatArray, axis: FloatArray) -> FloatArray:
    """Between lines, shape (n,) [rad]; by the sine, since cosines near 1 are blunt."""
    return np.asarray(np.arcsin(np.clip(lengths_of(np.cross(directions, axis)), 0.0, 1.0)))
