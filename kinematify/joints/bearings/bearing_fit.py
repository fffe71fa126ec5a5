"""Bearings: the line about which both sides of a contact are surfaces of revolution.

A revolute joint that was designed leaves two kinds of evidence on *both* parts near their contact: area that a
rotation about the axis maps onto itself (all normals meet the axis: the linear-complex criterion of Pottmann and
Gelfand-Guibas slippage), and circular edges about the axis. Lines are proposed from pairs of normals and from circles
through feature edges, scored on both parts, and refined by robust Gauss-Newton on the same residuals.
feasibility.md section 4 measured why the paper's own pool and ranking (`paper.cavl`) are not enough.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.surface import distinct_directions
from kinematify.joints.bearings.bearing_evidence import contact_centroid, contact_sides, thin, whole_side
from kinematify.joints.bearings.congruent_contacts import shared_by_twins
from kinematify.joints.bearings.line import NO_LINES, Line, Lines, join, lines_of, meeting_lines
from kinematify.joints.bearings.refine_lines import refine_line, refine_lines
from kinematify.joints.bearings.scores import (
    BearingLine,
    EdgeBearing,
    best_distinct,
    fit_rail,
    scored_line,
    scored_lines,
    surface_support,
)
from kinematify.processes.forked import each
from kinematify.robot.arrays import read_only
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import BearingConfig
    from kinematify.contact.graph import ContactEdge, ContactGraph, Pair
    from kinematify.geometry.surface import PartSurface
    from kinematify.joints.bearings.bearing_evidence import BearingSide, Generators, Sides
    from kinematify.robot.arrays import FloatArray


_ALIKE = 1e-6  # areas that differ by less than this share are the same
_EXACTLY = 0.1  # [deg] lines that were proposed along a direction


def fit_bearings(
    assembly: Assembly, surfaces: Sequence[PartSurface], graph: ContactGraph, *, config: BearingConfig, seed: int
) -> dict[tuple[int, int], EdgeBearing]:
    """Fit bearing lines to every contact edge.

    Args:
        assembly: The parts.
        surfaces: Derived geometry of each part, same order.
        graph: Contact graph with samples.
        config: Scales as fractions of the assembly's diagonal.
        seed: Seed of the sampled pairs.

    Returns:
        One entry per edge, keyed like `ContactGraph.by_pair`.
    """
    scaled = config.in_metres(assembly.diagonal)
    work = partial(_fit_sides, surfaces, config=scaled, seed=seed)
    fitted = dict(zip(graph.by_pair, each(work, graph.edges), strict=True))
    bearings = {pair: bearing for pair, (_, bearing) in fitted.items()}
    sides = {pair: found for pair, (found, _) in fitted.items()}
    return shared_by_twins(bearings, sides, surfaces, graph, config=scaled)


def fit_edge(surfaces: Sequence[PartSurface], edge: ContactEdge, *, config: BearingConfig, seed: int) -> EdgeBearing:
    """Propose, score and refine the lines of one contact edge; `config` has its lengths in metres."""
    return _fit_sides(surfaces, edge, config=config, seed=seed)[1]


def _fit_sides(
    surfaces: Sequence[PartSurface], edge: ContactEdge, *, config: BearingConfig, seed: int
) -> tuple[Sides, EdgeBearing]:
    own = config.for_roughness(max(surfaces[edge.a].roughness, surfaces[edge.b].roughness))
    sides = contact_sides(surfaces, edge, config=own)
    found = _fitted(surfaces, edge, sides, config=own, seed=seed)
    return sides, found if own is config else _sharpened(found, sides, config)


def _sharpened(found: EdgeBearing, sides: Sides, config: BearingConfig) -> EdgeBearing:
    """The best line moved to where the tolerances of clean parts put it, if it is a clear bearing to them as well.

    Many contacts of rough parts are exact, and single parts of clean objects are rough elsewhere.
    """
    if not found.lines:
        return found
    first = found.lines[0]
    moved = refine_line(sides, first.line, _tolerances(config), config)
    sharp = scored_line(sides, moved, found.centroid, config)
    near = abs(float(sharp.axis @ first.axis)) > np.cos(np.radians(config.directed_angle))
    if not near or sharp.score < config.twins.clear:
        return found
    return replace(found, lines=(replace(first, axis=sharp.axis, pivot=sharp.pivot), *found.lines[1:]))


def _fitted(
    surfaces: Sequence[PartSurface], edge: ContactEdge, sides: Sides, *, config: BearingConfig, seed: int
) -> EdgeBearing:
    # One generator for each part, the larger one first: what is drawn depends on the number of neither.
    draws = np.random.default_rng(seed), np.random.default_rng(seed)
    pair, exchanged = (edge.a, edge.b), _is_larger(surfaces[edge.b].part, surfaces[edge.a].part)
    pair, sides = (pair[::-1], sides[::-1]) if exchanged else (pair, sides)
    centroid = contact_centroid(sides)
    directions = np.empty((0, 3))
    if config.directed_pairs:
        # Along which either part is built.
        directions = distinct_directions(np.concatenate([surfaces[part].main_directions for part in pair]))
    proposals = propose_lines(sides, centroid, directions, config=config, draws=draws)
    lines = _rank(sides, proposals, centroid, directions, config)
    if not lines or lines[0].score < config.turned_score:
        turned = _turned_lines(surfaces, pair, centroid, config, draws)
        lines = sorted([*lines, *turned], key=lambda line: -line.score)
    return EdgeBearing(
        centroid=read_only(centroid, np.float64),
        lines=tuple(line.exchanged if exchanged else line for line in lines),
        rail=fit_rail(sides, config.rail, draws),
    )


def _is_larger(one: Part, other: Part) -> bool:
    """True if a part has more surface than another one, or where they are alike lies higher."""
    alike = abs(one.area - other.area) <= _ALIKE * other.area
    return bool(one.centroid[2] > other.centroid[2]) if alike else one.area > other.area


def score_line(surfaces: Sequence[PartSurface], edge: ContactEdge, line: Line, config: BearingConfig) -> BearingLine:
    """Score one given line as a bearing of a contact edge, as `fit_edge` scores its own, without refining it."""
    config = config.for_roughness(max(surfaces[edge.a].roughness, surfaces[edge.b].roughness))
    sides = contact_sides(surfaces, edge, config=config)
    return scored_line(sides, line, contact_centroid(sides), config)


def _rank(
    sides: Sides, proposals: Lines, centroid: FloatArray, directions: FloatArray, config: BearingConfig
) -> list[BearingLine]:
    """Refine lines on few samples, keep the best distinct ones, finish them on all samples; best first."""
    few = thin(sides[0], config.refine_samples), thin(sides[1], config.refine_samples)
    tolerances = _tolerances(config)
    # Lines along a main direction have little left to be refined, and the final rounds let them turn.
    known = np.array([_along(line, directions, _EXACTLY) is not None for line in proposals], dtype=bool)
    axes, points = np.empty((len(proposals), 3)), np.empty((len(proposals), 3))
    for turning, rounds in ((False, tolerances[-4:]), (True, tolerances)):
        index = np.flatnonzero(known != turning)
        refined = refine_lines(few, proposals.subset(index), rounds, config, turning=turning)
        axes[index], points[index] = refined.axes, refined.points
    rough = scored_lines(few, Lines(axes=axes, points=points), centroid, config)
    starts = best_distinct(rough, config)
    free = refine_lines(sides, lines_of([start.line for start in starts]), tolerances[-2:], config)
    final = scored_lines(sides, free, centroid, config)
    along = {k: _along(start.line, directions, config.directed_angle) for k, start in enumerate(starts)}
    straight = {k: line for k, line in along.items() if line is not None}
    held = refine_lines(sides, lines_of(list(straight.values())), tolerances[-2:], config, turning=False)
    for k, line in zip(straight, scored_lines(sides, held, centroid, config), strict=True):
        if line.score * config.directed_bonus > final[k].score:
            final[k] = line
    return best_distinct(final, config)


def _along(line: Line, directions: FloatArray, angle: float) -> Line | None:
    """The same line along the nearest of some directions, if one is within an angle [deg]."""
    if len(directions) == 0:
        return None
    cosines = directions @ line.axis
    best = int(np.argmax(np.abs(cosines)))
    if abs(cosines[best]) < np.cos(np.radians(angle)):
        return None
    return Line(axis=directions[best], point=line.point)


def _tolerances(config: BearingConfig) -> FloatArray:
    """Sine of the tolerance of every round of refinement, coarse to fine."""
    return np.geomspace(config.normal_tolerance_sine, config.fine_tolerance_sine, config.refine_steps)


def _turned_lines(
    surfaces: Sequence[PartSurface], pair: Pair, centroid: FloatArray, config: BearingConfig, draws: Generators
) -> list[BearingLine]:
    """Axes of wheels and discs: a part that is round as a whole turns about its own axis.

    The other part often models no bearing at all (a wheel in its well). Long round parts are omitted: a rod hinged
    at its end is round about the wrong line.
    """
    lines = []
    for own, rng in zip(pair, draws, strict=True):
        side = whole_side(surfaces[own], config.turned_samples)
        proposed = normal_pair_lines(side, config.turned_samples, rng)
        if len(proposed) == 0:
            continue
        best = int(np.argmax(surface_support(side, proposed, config)))
        line = refine_line((side, side), proposed[best], _tolerances(config), config)
        support = float(surface_support(side, lines_of([line]), config)[0])
        arm = side.points - line.point
        height = float(np.ptp(arm @ line.axis))
        width = 2 * float(lengths_of(crossed(arm, line.axis)).max())
        shares = (support, 0.0) if own == pair[0] else (0.0, support)
        if support >= config.turned_support and height <= config.turned_length * width:
            lines.append(
                BearingLine(
                    axis=line.axis,
                    pivot=line.foot(centroid),
                    score=config.turned_score * support,
                    surfaces=shares,
                    rings=(0.0, 0.0),
                )
            )
    return lines


_LEAST_SINE = 0.17  # below 10 deg between two normals their intersection is ill-conditioned
_ALONG = np.cos(np.radians(1.0))
_COARSE = 2.0  # proposals this much farther apart than what is kept: the refinement moves them


def propose_lines(
    sides: Sides, centroid: FloatArray, directions: FloatArray, *, config: BearingConfig, draws: Generators
) -> Lines:
    """Promising distinct lines: the best by area among all, and the best by circles among those through circles.

    Both lists are needed: a bearing that shows as two circles on boxy housings has little round area.

    Args:
        sides: Evidence of both parts.
        centroid: Of the contact, world frame [m], shape (3,).
        directions: Along which lines are proposed besides, shape (k, 3).
        config: Numbers of proposals and of what is kept.
        draws: One generator for each part; they draw its pairs and circles.

    Returns:
        Lines through their feet of the contact centroid; none where nothing is curved.
    """
    each = list(zip(sides, draws, strict=True))
    by_pairs = [normal_pair_lines(side, config.pairs, rng) for side, rng in each]
    by_pairs += [directed_lines(side, directions, config.directed_pairs, rng) for side, rng in each]
    by_circles = [_circle_lines(side, config.circles, rng) for side, rng in each]
    lines = join([*by_circles, *by_pairs]).through_feet(centroid)
    if len(lines) == 0:
        return lines
    coarse = [surface_support(thin(side, config.coarse_samples), lines, config) for side in sides]
    area = np.sqrt(coarse[0] * coarse[1])
    votes = np.zeros(len(lines))
    n_circles = [len(found) for found in by_circles]
    votes[: sum(n_circles)] = _circle_votes(lines.subset(slice(sum(n_circles))), n_circles[0], config)
    chosen: list[int] = []
    lists = [(area, config.shortlist), (votes, config.shortlist_circles)]
    lists += [(area * along, config.shortlist_directed) for along in np.abs(directions @ lines.axes.T) > _ALONG]
    for merit, count in lists:
        order = np.argsort(-merit, kind="stable")
        order = order[merit[order] > 0]
        picked = lines.subset(order).distinct(
            count, angle=_COARSE * config.apart_angle, distance=_COARSE * config.apart
        )
        chosen += order[picked].tolist()
    return lines.subset(list(dict.fromkeys(chosen)))


def normal_pair_lines(side: BearingSide, count: int, rng: np.random.Generator) -> Lines:
    """Axes of the cylinders through `count` random pairs of samples (`meeting_lines`)."""
    if len(side.weights) < 2:
        return NO_LINES
    chance = side.weights / side.weights.sum()
    first, second = rng.choice(len(chance), (2, count), p=chance)
    return meeting_lines(side.points, side.normals, (first, second), _LEAST_SINE)[0]


def directed_lines(side: BearingSide, directions: FloatArray, count: int, rng: np.random.Generator) -> Lines:
    """Lines along given directions, each through the place where the normals of a random pair of samples meet.

    Rough normals are several degrees off, and so is the direction that two of them give; seen along a given direction,
    they still meet near the axis.

    Args:
        side: Evidence of one part.
        directions: Unit directions, shape (k, 3).
        count: Pairs per direction.
        rng: Draws the pairs.
    """
    if len(side.weights) < 2 or count == 0 or len(directions) == 0:
        return NO_LINES
    chance = side.weights / side.weights.sum()
    axes = np.repeat(directions, count, axis=0)
    first, second = rng.choice(len(chance), (2, len(axes)), p=chance)
    n1, n2 = (side.normals[k] - np.einsum("ij,ij->i", side.normals[k], axes)[:, None] * axes for k in (first, second))
    offset = side.points[second] - side.points[first]
    sine = np.einsum("ij,ij->i", crossed(n1, n2), axes)
    good = np.abs(sine) > _LEAST_SINE
    along = np.einsum("ij,ij->i", crossed(offset[good], n2[good]), axes[good]) / sine[good]
    return Lines(axes=axes[good], points=side.points[first][good] + along[:, None] * n1[good])


def _circle_lines(side: BearingSide, count: int, rng: np.random.Generator) -> Lines:
    """Axes of at most `count` circles, drawn by weight."""
    weights = side.circle_weights
    if len(weights) == 0 or weights.sum() <= 0:
        return NO_LINES
    found = Lines(axes=side.circle_axes, points=side.circle_centres)
    return found.subset(rng.choice(len(weights), count, p=weights / weights.sum())) if len(weights) > count else found


def _circle_votes(lines: Lines, n_first: int, config: BearingConfig) -> FloatArray:
    """Return how many circles of either side share each circle's line (geometric mean), shape (C,).

    Args:
        lines: Axes of all circles; the first `n_first` belong to the first side.
        n_first: Number of circles of the first side.
        config: Tolerances.
    """
    axes, points = lines.axes, lines.points
    aligned = np.abs(axes @ axes.T) > np.cos(np.arcsin(config.circle_tolerance_sine))
    x, y, z = (column[None] - column[:, None] for column in points.T)
    along = x * axes[:, :1] + y * axes[:, 1:2] + z * axes[:, 2:]
    apart = np.sqrt(np.maximum(x * x + y * y + z * z - along**2, 0))
    same = aligned & (apart < config.circle_cell)
    return np.asarray(np.sqrt(same[:, :n_first].sum(axis=1) * same[:, n_first:].sum(axis=1)))
