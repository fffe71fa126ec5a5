"""Joint estimation as the paper writes it: its candidate pool, DW-CAVL ranking, refinement and type rule (III-D)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import ContactEdge, ContactSamples
from kinematify.geometry.sampling import sample_surface
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.paper.cavl import cavl_scene, rank_candidates, refine, virtual_motions
from kinematify.paper.field_source import field_source
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import CavlConfig, Config
    from kinematify.contact.graph import ContactGraph
    from kinematify.paper.cavl import CavlScene, VirtualMotions
    from kinematify.paper.contact_region import ContactRegion
    from kinematify.robot.arrays import FloatArray


def estimate_paper_joints(
    assembly: Assembly, graph: ContactGraph, edges: Sequence[tuple[int, int]], *, config: Config
) -> tuple[JointEstimate, ...]:
    """Choose the joint of every edge by DW-CAVL alone (paper III-D).

    The paper leaves three things open. Sign: the axis has none, so neither direction counts as opening. Limits: a full
    turn, half of it either way, or the child's own length along the axis either way. Confidence: the score of the
    chosen joint over the sum of its score and that of the best joint of the other type.

    Args:
        assembly: The parts, world frame.
        graph: Contact graph with samples.
        edges: Parent and child of every edge of the tree.
        config: `cavl`, `sdf`, `joints.samples` and `seed` are used.

    Returns:
        One estimate per edge, in the order given.
    """
    field_of = field_source(assembly.parts, config.sdf, seed=config.seed)
    samples = [sample_surface(part, config.joints.samples, config.seed) for part in assembly.parts]
    estimates = []
    for parent, child in edges:
        scene = cavl_scene(
            _edge_between(graph, parent, child),
            parent=parent,
            child=child,
            fields=lambda index: field_of(assembly.parts[index]),
            samples=samples,
            diagonal=assembly.diagonal,
            config=config.cavl,
        )
        ranked = estimate_paper_joint(scene, config.cavl, config.seed)
        estimates.append(_estimate(ranked, parent, child, assembly.parts[child]))
    return tuple(estimates)


def _edge_between(graph: ContactGraph, parent: int, child: int) -> ContactEdge:
    """The contact of a tree edge; a virtual edge has none, so that whole surfaces stand in for it."""
    pair = (min(parent, child), max(parent, child))
    if pair in graph.by_pair:
        return graph.by_pair[pair]
    nothing = ContactSamples(
        points=np.empty((0, 3)), normals=np.empty((0, 3)), distances=np.empty(0), areas=np.empty(0)
    )
    return ContactEdge(
        a=pair[0], b=pair[1], gap=np.inf, strength=0.0, samples_a=nothing, samples_b=nothing, bridge=True
    )


def _estimate(ranked: tuple[JointCandidate, ...], parent: int, child: int, moving: Part) -> JointEstimate:
    best = ranked[0]
    other = max(candidate.score for candidate in ranked if candidate.kind is not best.kind)
    reach = float(np.pi) if best.kind.turns else float(np.ptp(moving.vertices @ best.axis))
    return JointEstimate(
        parent=parent,
        child=child,
        kind=best.kind,
        axis=best.axis,
        pivot=best.pivot,
        lower=-reach,
        upper=reach,
        confidence=best.score / (best.score + other),
        alternatives=ranked,
        evidence=best.evidence,
    )


def estimate_paper_joint(scene: CavlScene, config: CavlConfig, seed: int) -> tuple[JointCandidate, ...]:
    """Rank the pool on thinned samples, refine the best of each type on all, and let the type rule order the rest.

    Args:
        scene: The directed edge, from `cavl_scene`.
        config: The stage's settings.
        seed: Seed of the random directions.

    Returns:
        Refined candidates of both types, best first; the first one is revolute exactly if s_rev > zeta s_pri.
    """
    pool = paper_candidates(scene.contact, scene.diagonal, config, seed)
    coarse, fine = scene.thinned(config.rank_points), scene.thinned(config.refine_points)

    def best_of(kind: JointType, motions: VirtualMotions) -> tuple[JointCandidate, ...]:
        ranked = rank_candidates(coarse, [item for item in pool if item.kind is kind], config, motions)
        return refine(fine, _distinct(ranked)[: config.top], config, motions)

    turning = best_of(JointType.REVOLUTE, virtual_motions(scene, config))
    lever = scene.contact.lever(turning[0].axis, turning[0].pivot)
    sliding = best_of(JointType.PRISMATIC, virtual_motions(scene, config, lever))
    # A stable sort with sliding candidates first gives them the ties: the rule asks for strictly more.
    return tuple(sorted((*sliding, *turning), key=lambda candidate: -candidate.score))


def paper_candidates(
    contact: ContactRegion, diagonal: float, config: CavlConfig, seed: int
) -> tuple[JointCandidate, ...]:
    """The paper's compact pool: a few directions, each with pivots slid along it around the contact centroid.

    Directions: smallest variance of the contact region, contact normal, their orthogonal completion, the other
    principal axes, and random ones, drawn in the principal frame so that they turn with the object.
    """
    axes = _pool_axes(contact, config.random_axes, seed)
    turning = [
        _candidate(JointType.REVOLUTE, source, axis, contact.centroid + offset * diagonal * axis)
        for source, axis in axes
        for offset in config.pivot_offsets
    ]
    sliding = [_candidate(JointType.PRISMATIC, source, axis, contact.centroid) for source, axis in axes]
    return (*turning, *sliding)


def _pool_axes(contact: ContactRegion, random_axes: int, seed: int) -> list[tuple[str, FloatArray]]:
    smallest, middle, largest = contact.principal_axes
    drawn = np.random.default_rng(seed).normal(size=(random_axes, 3))
    random = drawn / np.linalg.norm(drawn, axis=1, keepdims=True) @ contact.principal_axes
    named = [("paper_smallest_variance", smallest), ("paper_contact_normal", contact.normal)]
    named.append(("paper_completion", _completion(smallest, contact.normal, middle)))
    named += [("paper_principal", middle), ("paper_principal", largest)]
    return named + [("paper_random", axis) for axis in random]


def _completion(first: FloatArray, second: FloatArray, instead: FloatArray) -> FloatArray:
    """Unit vector orthogonal to both, or `instead` where they are parallel (within 0.001 deg)."""
    crossed = np.cross(first, second)
    length = float(np.linalg.norm(crossed))
    return np.asarray(crossed / length if length > 2e-5 else instead, dtype=np.float64)


def _candidate(kind: JointType, source: str, axis: FloatArray, pivot: FloatArray) -> JointCandidate:
    return JointCandidate(kind=kind, axis=axis, pivot=pivot, score=0.0, source=source)


def _distinct(ranked: tuple[JointCandidate, ...]) -> list[JointCandidate]:
    """Keep the best of those that differ only by rounding or by the position of the pivot along the axis."""
    kept: list[JointCandidate] = []
    for candidate in ranked:
        if not any(_same_motion(candidate, other) for other in kept):
            kept.append(candidate)
    return kept


def _same_motion(one: JointCandidate, other: JointCandidate) -> bool:
    if np.linalg.norm(np.cross(one.axis, other.axis)) > 1e-6:
        return False
    between = np.linalg.norm(other.pivot - one.pivot)
    aside = np.linalg.norm(np.cross(one.axis, other.pivot - one.pivot))
    return not one.kind.turns or bool(aside <= 1e-6 * between)
