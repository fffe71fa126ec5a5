"""DW-CAVL: joint candidates ranked by contact-aware virtual motions, distance-weighted (paper III-D).

A candidate is good when small motions along it neither tear the contact apart nor push the parts into each other.
All lengths in the objective are multiples of `CavlConfig.length_unit` times the assembly's diagonal.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import torch

from kinematify.contact.graph import ContactSamples
from kinematify.joints.candidate import JointCandidate
from kinematify.paper.contact_region import ContactRegion, revolve, slide, unit_axis
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from torch import Tensor

    from kinematify.config import CavlConfig
    from kinematify.contact.graph import ContactEdge
    from kinematify.geometry.sampling import SurfaceSamples
    from kinematify.paper.sdf import SignedDistanceField
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class CavlSide:
    """Samples of one part with their weights in the other part's field."""

    field: SignedDistanceField
    points: Tensor
    """World frame [m], float64, shape (N, 3)."""
    anchored: Tensor
    """w_i of the paper times the sample's share of the surface, shape (N,)."""
    free: Tensor
    """Inverse volumetric weights ~w_i times the share, shape (N,)."""
    direction: float
    """1 for samples of the child; -1 for samples of the parent, which move backwards as the child sees them."""

    def thinned(self, count: int) -> CavlSide:
        """At most `count` samples, half of them near the contact; weights grow so that no sum is biased."""
        if len(self.points) <= count:
            return self
        shares = self.anchored + self.free
        density = 0.5 * shares / shares.sum() + 0.5 * self.anchored / self.anchored.sum().clamp_min(1e-300)
        steps = (torch.arange(count, dtype=torch.float64) + 0.5) * (density.sum() / count)
        met = torch.searchsorted(density.cumsum(0), steps).clamp_max(len(density) - 1)
        kept, hits = torch.unique(met, return_counts=True)
        growth = hits * density.sum() / (count * density[kept])
        return replace(
            self,
            points=self.points[kept],
            anchored=self.anchored[kept] * growth,
            free=self.free[kept] * growth,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class CavlScene:
    """Facts of one directed edge for DW-CAVL."""

    sides: tuple[CavlSide, ...]
    """The child's samples in the parent's field, then, if symmetric, the parent's in the child's."""
    contact: ContactRegion
    diagonal: float
    """Diagonal of the assembly [m]."""

    def thinned(self, count: int) -> CavlScene:
        """The same edge with at most `count` samples a side."""
        return replace(self, sides=tuple(side.thinned(count) for side in self.sides))


def cavl_scene(
    edge: ContactEdge,
    *,
    parent: int,
    child: int,
    fields: Callable[[int], SignedDistanceField],
    samples: Sequence[SurfaceSamples],
    diagonal: float,
    config: CavlConfig,
) -> CavlScene:
    """Gather samples, fields and weights of the edge from `parent` to `child`.

    Args:
        edge: The contact between the two.
        parent: Index of the part that stands still.
        child: Index of the part that moves.
        fields: Signed distance field of a part by index.
        samples: Surface samples of every part.
        diagonal: Diagonal of the assembly [m].
        config: Margins and weights.

    Raises:
        ValueError: `edge` does not join the two parts.
    """
    if {parent, child} != {edge.a, edge.b}:
        raise ValueError(f"The contact joins parts {edge.a} and {edge.b}, not {parent} and {child}.")
    contacts = {edge.a: edge.samples_a, edge.b: edge.samples_b}
    pairs = [(child, parent, 1.0), (parent, child, -1.0)]
    sides = [
        _side(samples[own], contacts[own], field=fields(other), direction=direction, diagonal=diagonal, config=config)
        for own, other, direction in (pairs if config.symmetric else pairs[:1])
    ]
    first, second = (_contact_or_all(contacts[own], samples[own], fields, other) for own, other, _ in pairs)
    region = ContactRegion(first=first, second=second, width=config.contact_width * diagonal)
    return CavlScene(sides=tuple(sides), contact=region, diagonal=diagonal)


def _side(
    body: SurfaceSamples,
    contact: ContactSamples,
    *,
    field: SignedDistanceField,
    direction: float,
    diagonal: float,
    config: CavlConfig,
) -> CavlSide:
    """Dense samples near the other part, coarse ones elsewhere, each with the area that it represents."""
    coarse = torch.from_numpy(body.points.copy())
    reach = float(contact.distances.max(initial=-1.0))
    beyond = (field.value(coarse).abs() > reach).numpy()
    points = torch.from_numpy(np.concatenate([contact.points, body.points[beyond]]))
    areas = torch.from_numpy(np.concatenate([contact.areas, body.areas[beyond]]))
    anchored, free = motion_weights(field.value(points), diagonal, config)
    share = areas / areas.sum()
    return CavlSide(
        field=field,
        points=points,
        anchored=share * anchored,
        free=share * free,
        direction=direction,
    )


def _contact_or_all(
    contact: ContactSamples, body: SurfaceSamples, fields: Callable[[int], SignedDistanceField], other: int
) -> ContactSamples:
    """Parts that a bridge joins have no contact samples: their whole surface stands in, weighted by distance."""
    if len(contact.points):
        return contact
    distances = fields(other).value(torch.from_numpy(body.points.copy())).abs().numpy()
    return ContactSamples(points=body.points, normals=body.normals, distances=distances, areas=body.areas)


def motion_weights(initial: Tensor, diagonal: float, config: CavlConfig) -> tuple[Tensor, Tensor]:
    """The weights w_vol w_dist of the consistency term and ~w of the collision term.

    Args:
        initial: s_0, signed distance before the motion [m], shape (N,).
        diagonal: Diagonal of the assembly [m].
        config: m_vol, k and sigma_c.

    Returns:
        w and ~w, each of shape (N,).
    """
    margin, width = config.volume_margin * diagonal, config.contact_width * diagonal
    logit = config.sharpness / margin * (initial - margin)
    anchored = torch.sigmoid(-logit) * torch.exp(-0.5 * (initial / width) ** 2)
    return anchored, torch.sigmoid(logit)


@dataclass(frozen=True, kw_only=True, eq=False)
class CavlTerms:
    """The unweighted terms of J for K candidates and the M motions of Theta, averaged over the sides."""

    consistency: Tensor
    """L_cons(delta), mean squared separation of what was in contact, shape (K, M)."""
    collision: Tensor
    """L_coll(delta), mean squared penetration of what was free, shape (K, M)."""
    offset: Tensor
    """Squared distance of the pivot from the contact centroid, shape (K,); zero for prismatic joints."""
    forward: Tensor
    """True for motions in the positive direction, shape (M,)."""

    def objective(self, config: CavlConfig) -> Tensor:
        """J of eq. total-loss, shape (K,): the mean over Theta, or over that direction of Theta which costs less.

        A drawer moves one way only; the mean over both would compare how hard it hits the back of its cabinet.
        """
        motion = config.consistency_weight * self.consistency + config.collision_weight * self.collision
        groups = [motion[:, self.forward], motion[:, ~self.forward]] if config.better_direction else [motion]
        means = [group.mean(dim=1) for group in groups if group.shape[1]]
        return torch.stack(means).amin(dim=0) + config.pivot_weight * self.offset


def cavl_terms(
    scene: CavlScene, kind: JointType, *, pivots: Tensor, axes: Tensor, motions: Tensor, config: CavlConfig
) -> CavlTerms:
    """Evaluate eq. cons, eq. coll and L_reg for a batch of candidates; differentiable in pivots, axes and motions.

    Args:
        scene: The edge.
        kind: Revolute or prismatic, for the whole batch.
        pivots: World frame [m], float64, shape (K, 3); unused by prismatic candidates.
        axes: Unit directions in the world frame, float64, shape (K, 3).
        motions: Theta, [rad] or [m], shape (M,).
        config: Margins and units.
    """
    unit = config.length_unit * scene.diagonal
    margin = config.volume_margin * scene.diagonal
    consistency = collision = torch.zeros((len(axes), len(motions)), dtype=torch.float64)
    for side in scene.sides:
        moved = _move(side, kind, pivots, axes, motions)
        distances = side.field.value(moved)
        apart, inside = (torch.relu(depths - margin) / unit for depths in (distances, -distances))
        if config.bounded_separation:
            apart = _bounded(apart, config.contact_width * scene.diagonal / unit)
        pushed = side.free + side.anchored if config.bounded_separation else side.free
        separation = _weighted_mean(side.anchored, apart, config.epsilon)
        penetration = _weighted_mean(pushed, inside, config.epsilon)
        consistency = consistency + separation / len(scene.sides)
        collision = collision + penetration / len(scene.sides)
    offset = torch.zeros(len(axes), dtype=torch.float64)
    if kind.turns:
        centroid = torch.from_numpy(scene.contact.centroid)
        offset = (((pivots - centroid) / unit) ** 2).sum(dim=-1)
    return CavlTerms(
        consistency=consistency,
        collision=collision,
        offset=offset,
        forward=motions > 0.0,
    )


def _move(side: CavlSide, kind: JointType, pivots: Tensor, axes: Tensor, motions: Tensor) -> Tensor:
    """Phi_delta of the paper on all samples, shape (K, M, N, 3)."""
    if kind.turns:
        return revolve(side.points, pivots, axes, side.direction * motions)
    return slide(side.points, axes, side.direction * motions)


def _weighted_mean(weights: Tensor, depths: Tensor, epsilon: float) -> Tensor:
    """Weighted mean of the squares over the last dimension, (N,) and (K, M, N) -> (K, M)."""
    return (depths.square() @ weights) / (weights.sum() + epsilon)


def _bounded(depths: Tensor, width: float) -> Tensor:
    """Depths that approach `width` however large they are: squared, the loss of Geman and McClure (1987).

    A closed door touches its frame all around and keeps one side of four: what a motion has to leave is no contact of
    the joint, and how far it gets says nothing.
    """
    return depths / torch.sqrt(1.0 + (depths / width).square())


@dataclass(frozen=True, kw_only=True, eq=False)
class VirtualMotions:
    """Theta, the motions that every candidate of an edge is tried with."""

    angles: FloatArray
    """Of turning candidates [rad], shape (M,)."""
    travels: FloatArray
    """Of sliding candidates [m], shape (M,)."""

    def of(self, turns: bool) -> Tensor:
        """The motions of one type, float64."""
        return torch.from_numpy(np.array(self.angles if turns else self.travels, dtype=np.float64))


def virtual_motions(scene: CavlScene, config: CavlConfig, lever: float | None = None) -> VirtualMotions:
    """Theta of one edge: as configured, or, with `match_motion`, such that both types move the contact equally far.

    Matched angles are those of the configuration, but less where the contact would then move farther than the travels
    of the configuration: a drawer that is turned by 20 deg has passed its cabinet's walls.

    Args:
        scene: The edge.
        config: Angles and travels.
        lever: Mean distance of the contact from the axis to match [m]; by default from its centroid.
    """
    angles = np.deg2rad(np.array(config.angles_deg))
    travels = scene.diagonal * np.array(config.travels)
    if not config.match_motion:
        return VirtualMotions(angles=angles, travels=travels)
    least = config.least_lever * scene.diagonal
    radius = max(scene.contact.radius, least)
    angles = np.sign(angles) * np.minimum(np.abs(angles), np.abs(travels) / radius)
    return VirtualMotions(angles=angles, travels=angles * max(radius if lever is None else lever, least))


def rank_candidates(
    scene: CavlScene, candidates: Sequence[JointCandidate], config: CavlConfig, motions: VirtualMotions | None = None
) -> tuple[JointCandidate, ...]:
    """Score candidates of any source by 1 / (1 + J), best first.

    Args:
        scene: The edge; thin it first for a quick ranking.
        candidates: Revolute, continuous or prismatic candidates.
        config: Theta and weights.
        motions: Theta; by default that of `virtual_motions`.

    Returns:
        The same candidates with score zeta / (1 + J) for prismatic ones and 1 / (1 + J) for the others, so that the
        first one also answers the paper's question of the type; terms of J are in the evidence.
    """
    theta = motions or virtual_motions(scene, config)
    scored: list[JointCandidate] = []
    for turns in (True, False):
        group = [candidate for candidate in candidates if candidate.kind.turns == turns]
        scored += _scored(scene, group, theta.of(turns), config)
    return tuple(sorted(scored, key=lambda candidate: -candidate.score))


def _scored(
    scene: CavlScene, candidates: Sequence[JointCandidate], motions: Tensor, config: CavlConfig
) -> list[JointCandidate]:
    """Candidates of one type with their scores, in pieces that bound the memory."""
    queries = max(len(side.points) for side in scene.sides) * len(motions)
    step = max(1, config.batch_queries // queries)
    scored: list[JointCandidate] = []
    for start in range(0, len(candidates), step):
        group = candidates[start : start + step]
        pivots, axes = _stacked(group)
        with torch.no_grad():
            terms = cavl_terms(scene, group[0].kind, pivots=pivots, axes=axes, motions=motions, config=config)
        scored += [_with_score(candidate, terms, row, config) for row, candidate in enumerate(group)]
    return scored


def _stacked(candidates: Sequence[JointCandidate]) -> tuple[Tensor, Tensor]:
    pivots = torch.from_numpy(np.stack([candidate.pivot for candidate in candidates]))
    axes = torch.from_numpy(np.stack([candidate.axis for candidate in candidates]))
    return pivots, axes


def _with_score(candidate: JointCandidate, terms: CavlTerms, row: int, config: CavlConfig) -> JointCandidate:
    objective = float(terms.objective(config)[row])
    evidence = {
        "cavl_objective": objective,
        "cavl_consistency": float(terms.consistency[row].mean()),
        "cavl_collision": float(terms.collision[row].mean()),
        "cavl_offset": float(terms.offset[row]),
        "cavl_score": 1.0 / (1.0 + objective),
    }
    score = evidence["cavl_score"] * (1.0 if candidate.kind.turns else config.type_ratio)
    return replace(candidate, score=score, evidence={**candidate.evidence, **evidence})


def refine(
    scene: CavlScene, candidates: Sequence[JointCandidate], config: CavlConfig, motions: VirtualMotions | None = None
) -> tuple[JointCandidate, ...]:
    """Minimise J from every candidate by gradient descent; the best point on the way is kept, so J never grows.

    Args:
        scene: The edge, with all samples that shall count.
        candidates: As for `rank_candidates`.
        config: Steps, rate, Theta and weights.
        motions: As for `rank_candidates`.

    Returns:
        Refined candidates, scored and best first.
    """
    theta = motions or virtual_motions(scene, config)
    moved: list[JointCandidate] = []
    for turns in (True, False):
        group = [candidate for candidate in candidates if candidate.kind.turns == turns]
        if group:
            moved += _descended(scene, group, theta.of(turns), config)
    return rank_candidates(scene, moved, config, theta)


def _descended(
    scene: CavlScene, candidates: Sequence[JointCandidate], motions: Tensor, config: CavlConfig
) -> list[JointCandidate]:
    """Adam on the unconstrained direction a and the pivot's shift in diagonals, all candidates of one type at once."""
    pivots, axes = _stacked(candidates)
    free, shift = axes.clone().requires_grad_(), torch.zeros_like(pivots).requires_grad_()
    variables = [free, shift] if candidates[0].kind.turns else [free]
    adam = torch.optim.Adam(variables, lr=config.learning_rate, eps=1e-12)
    best, best_axes, best_pivots = torch.full((len(axes),), torch.inf, dtype=torch.float64), axes, pivots
    for step in range(config.refine_steps + 1):
        now_axes, now_pivots = unit_axis(free), pivots + scene.diagonal * shift
        objective = cavl_terms(
            scene, candidates[0].kind, pivots=now_pivots, axes=now_axes, motions=motions, config=config
        ).objective(config)
        better = (objective < best)[:, None]
        best = torch.minimum(best, objective.detach())
        best_axes = torch.where(better, now_axes.detach(), best_axes)
        best_pivots = torch.where(better, now_pivots.detach(), best_pivots)
        if step < config.refine_steps:
            adam.zero_grad()
            objective.sum().backward()  # type: ignore[no-untyped-call]
            adam.step()
    return [
        replace(candidate, axis=axis.numpy(), pivot=pivot.numpy())
        for candidate, axis, pivot in zip(candidates, best_axes, best_pivots, strict=True)
    ]
