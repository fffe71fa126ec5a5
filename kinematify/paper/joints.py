"""Joint estimation as the paper writes it: its candidate pool, DW-CAVL ranking, refinement and type rule (III-D)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import ContactEdge, ContactSamples
from kinematify.geometry.sampling import sample_surface
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.paper.cavl import cavl_scene, rank_candidates, refine, virtual_motions
from kinematify.paper.sdf import field_source
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
    turn, half of it either way, or the child's own length along the axis either way. Confidence: the likelihood of the
    chosen joint over the sum of its own and that of the best joint of the other type; a likelihood is exp(-J / noise).

    Args:
        assembly: The parts, world frame.
        graph: Contact graph with samples.
        edges: Parent and child of every edge of the tree.
        config: `cavl`, `sdf`, `joints.samples` and `seed` are used.

    Returns:
        One estimate per edge, in the order given.
    """
    return PaperJoints(assembly, graph, config).choose(edges)


NOISE = "cavl_noise"
"""What J is divided by to be a likelihood, in `JointEstimate.evidence`."""


class PaperJoints:
    """DW-CAVL over the edges of one assembly; fields and samples are made once."""

    def __init__(self, assembly: Assembly, graph: ContactGraph, config: Config) -> None:
        """Make samples and fields; networks are trained here.

        Args:
            assembly: The parts, world frame.
            graph: Contact graph with samples.
            config: `cavl`, `sdf`, `joints.samples` and `seed` are used.
        """
        self._assembly, self._graph, self._config, self._seed = assembly, graph, config.cavl, config.seed
        self._field_of = field_source(assembly.parts, config.sdf, seed=config.seed)
        self._samples = [sample_surface(part, config.joints.samples, config.seed) for part in assembly.parts]

    def scene(self, parent: int, child: int) -> CavlScene:
        """Return what DW-CAVL knows of one edge."""
        return cavl_scene(
            _edge_between(self._graph, parent, child),
            parent=parent,
            child=child,
            fields=lambda index: self._field_of(self._assembly.parts[index]),
            samples=self._samples,
            diagonal=self._assembly.diagonal,
            config=self._config,
        )

    def choose(self, edges: Sequence[tuple[int, int]]) -> tuple[JointEstimate, ...]:
        """The joint of every edge, from parent to child, in the order given."""
        ranked = [estimate_paper_joint(self.scene(*edge), self._config, self._seed) for edge in edges]
        noise = noise_of([_cost(candidates[0]) for candidates in ranked], self._config)
        return tuple(
            _estimate(_as_likelihoods(candidates, noise), edge, self._assembly.parts[edge[1]], noise)
            for edge, candidates in zip(edges, ranked, strict=True)
        )

    def realise(self, joint: JointEstimate, candidate: JointCandidate) -> JointEstimate:
        """The joint that a candidate of an edge would have been, had it been chosen."""
        reach = _reach(candidate, self._assembly.parts[joint.child])
        return replace(
            joint, kind=candidate.kind, axis=candidate.axis, pivot=candidate.pivot, lower=-reach, upper=reach
        )

    def measure(self, joint: JointEstimate) -> JointCandidate:
        """A joint as a candidate of its edge, with its log-likelihood."""
        scene = self.scene(joint.parent, joint.child)
        fine, motions = scene.thinned(self._config.refine_points), self._motions(scene, joint)
        own = rank_candidates(fine, [_as_candidate(joint)], self._config, motions)
        return _as_likelihoods(own, joint.evidence[NOISE])[0]

    def _motions(self, scene: CavlScene, joint: JointEstimate) -> VirtualMotions:
        """Theta as it was when the candidates of a joint were ranked first."""
        turning = next(item for item in joint.alternatives if item.kind.turns)
        lever = scene.contact.lever(turning.axis, turning.pivot)
        return virtual_motions(scene, self._config, lever)


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


def noise_of(costs: Sequence[float], config: CavlConfig) -> float:
    """Return the divisor that makes J a likelihood: the typical J of an object's best joints, right or nearly so.

    Gaps, closed fronts and samples leave every joint with some cost, and how much differs from object to object. It is
    at least that of a separation by the volume margin, below which distances count as touching.

    Args:
        costs: J of the best joint of every edge.
        config: `volume_margin` and `length_unit` are used.
    """
    return max(2.0 * float(np.median(costs)), (config.volume_margin / config.length_unit) ** 2)


def _cost(candidate: JointCandidate) -> float:
    """J behind a score 1 / (1 + J), with the share of the type rule in it."""
    return 1.0 / candidate.score - 1.0


def _as_candidate(joint: JointEstimate) -> JointCandidate:
    kind = JointType.REVOLUTE if joint.kind.turns else JointType.PRISMATIC
    return _candidate(kind, "chosen", joint.axis, joint.pivot)


def _as_likelihoods(ranked: Sequence[JointCandidate], noise: float) -> tuple[JointCandidate, ...]:
    """Candidates with the logarithm of their likelihood exp(-J / noise) for a score, in their order."""
    return tuple(replace(item, score=-_cost(item) / noise) for item in ranked)


def _estimate(ranked: tuple[JointCandidate, ...], edge: tuple[int, int], moving: Part, noise: float) -> JointEstimate:
    best = ranked[0]
    other = max(candidate.score for candidate in ranked if candidate.kind is not best.kind)
    reach = _reach(best, moving)
    return JointEstimate(
        parent=edge[0],
        child=edge[1],
        kind=best.kind,
        axis=best.axis,
        pivot=best.pivot,
        lower=-reach,
        upper=reach,
        confidence=1.0 / (1.0 + float(np.exp(other - best.score))),
        alternatives=ranked,
        evidence={**best.evidence, NOISE: noise},
    )


def _reach(candidate: JointCandidate, moving: Part) -> float:
    """Return how far a joint goes either way [rad or m]; the paper says nothing of it."""
    return float(np.pi) if candidate.kind.turns else float(np.ptp(moving.vertices @ candidate.axis))


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


def _distinct(ranked: Sequence[JointCandidate]) -> list[JointCandidate]:
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
