"""Bearings: the line about which both sides of a contact are surfaces of revolution.

A revolute joint that was designed leaves two kinds of evidence on *both* parts near their contact: area that a
rotation about the axis maps onto itself (all normals meet the axis: the linear-complex criterion of Pottmann and
Gelfand-Guibas slippage), and circular edges about the axis. Lines are proposed from pairs of normals and from circles
through feature edges, scored on both parts, and refined by robust Gauss-Newton on the same residuals.
feasibility.md section 4 measured why the paper's own pool and ranking (joints/cavl.py) are not enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import read_only
from kinematify.joints.rail import Rail, fit_rail

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly, FloatArray, IntArray
    from kinematify.config import BearingConfig
    from kinematify.contact.graph import ContactEdge, ContactGraph, ContactSamples
    from kinematify.geometry.surface import PartSurface


@dataclass(frozen=True, kw_only=True, eq=False)
class BearingLine:
    """A line about which the contact could turn, with its support on either part (each in [0, 1])."""

    axis: FloatArray
    """Unit direction, world frame, shape (3,). Read-only."""
    pivot: FloatArray
    """Point of the line nearest to the contact centroid, world frame [m], shape (3,). Read-only."""
    score: float
    """Combined support; comparable among edges of one assembly."""
    surface_a: float
    surface_b: float
    circles_a: float
    circles_b: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", read_only(self.axis, np.float64))
        object.__setattr__(self, "pivot", read_only(self.pivot, np.float64))

    @property
    def surface(self) -> float:
        """Geometric mean of the revolution support of both parts (F of feasibility.md section 4)."""
        return float(np.sqrt(self.surface_a * self.surface_b))

    @property
    def circles(self) -> float:
        """Geometric mean of the circle support of both parts (CS of feasibility.md section 4)."""
        return float(np.sqrt(self.circles_a * self.circles_b))


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeBearing:
    """Bearing lines of one contact edge, best first, and its rail; empty where nothing is round or extruded."""

    a: int
    b: int
    centroid: FloatArray
    """Weighted contact centroid, world frame [m], shape (3,). Read-only."""
    lines: tuple[BearingLine, ...]
    rail: Rail | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class _Side:
    """Evidence of one part near a contact: surface samples and pieces of feature edges, with weights."""

    points: FloatArray
    normals: FloatArray
    weights: FloatArray
    middles: FloatArray
    tangents: FloatArray
    lengths: FloatArray
    edge_weights: FloatArray
    circle_axes: FloatArray
    circle_centres: FloatArray
    circle_weights: FloatArray


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
    return {
        (edge.a, edge.b): fit_edge(surfaces, edge, diagonal=assembly.diagonal, config=config, seed=seed)
        for edge in graph.edges
    }


def fit_edge(
    surfaces: Sequence[PartSurface], edge: ContactEdge, *, diagonal: float, config: BearingConfig, seed: int
) -> EdgeBearing:
    """Propose, score and refine the lines of one contact edge."""
    rng = np.random.default_rng([seed, edge.a, edge.b])
    scale = _contact_scale(surfaces, edge, diagonal, config)
    side_a = _make_side(surfaces[edge.a], edge.samples_a, surfaces[edge.b], edge.gap, scale, config)
    side_b = _make_side(surfaces[edge.b], edge.samples_b, surfaces[edge.a], edge.gap, scale, config)
    centroid = _centroid(side_a, side_b)
    axes, points = _propose((side_a, side_b), centroid, diagonal, config, rng)
    lines: list[BearingLine] = []
    if len(axes):
        lines = _rank(side_a, side_b, axes, points, centroid, diagonal, config)
    if not lines or lines[0].score < config.turned_score:
        turned = _turned_lines(surfaces, edge, centroid, config, rng)
        lines = sorted([*lines, *turned], key=lambda line: -line.score)
    return EdgeBearing(
        a=edge.a,
        b=edge.b,
        centroid=read_only(centroid, np.float64),
        lines=tuple(lines),
        rail=fit_rail((side_a, side_b), config.rail, rng),
    )


def _contact_scale(
    surfaces: Sequence[PartSurface], edge: ContactEdge, diagonal: float, config: BearingConfig
) -> float:
    """Distance over which evidence fades [m]: it follows the smaller part, never beyond the contact band."""
    smaller = min(surfaces[edge.a].part.diagonal, surfaces[edge.b].part.diagonal)
    return min(config.fade * diagonal, config.fade_part * smaller)


def _fade(distances: FloatArray, gap: float, scale: float) -> FloatArray:
    return np.exp(-0.5 * (np.maximum(distances - gap, 0.0) / scale) ** 2)


def _centroid(*sides: _Side) -> FloatArray:
    points = np.concatenate([side.points for side in sides])
    weights = np.concatenate([side.weights / max(side.weights.sum(), 1e-300) for side in sides])
    if weights.sum() <= 0:
        return points.mean(axis=0) if len(points) else np.zeros(3)
    return np.average(points, axis=0, weights=weights)


# ---- one-sided evidence --------------------------------------------------------------------------------------------


def _turned_lines(
    surfaces: Sequence[PartSurface],
    edge: ContactEdge,
    centroid: FloatArray,
    config: BearingConfig,
    rng: np.random.Generator,
) -> list[BearingLine]:
    """Axes of wheels and discs: a part that is round as a whole turns about its own axis.

    The other part often models no bearing at all (a wheel in its well). Long round parts are left out: a rod hinged
    at its end is round about the wrong line.
    """
    lines = []
    for own, other in ((edge.a, edge.b), (edge.b, edge.a)):
        side = _whole_side(surfaces[own], config.turned_samples)
        axes, points = _normal_pair_lines(side, config.turned_samples, rng)
        if len(axes) == 0:
            continue
        best = int(np.argmax(_surface_support(side, axes, points, config)))
        tolerances = np.geomspace(config.normal_tolerance_sine, config.fine_tolerance_sine, config.refine_steps)
        axis, point = _refine(side, side, axes[best], points[best], tolerances, config)
        support = float(_surface_support(side, axis[None], point[None], config)[0])
        arm = side.points - point
        height = float(np.ptp(arm @ axis))
        width = 2 * float(np.linalg.norm(np.cross(arm, axis), axis=1).max())
        if support < config.turned_support or height > config.turned_length * width:
            continue
        shares = (support, 0.0) if own < other else (0.0, support)
        pivot = point + axis * float((centroid - point) @ axis)
        score = config.turned_score * support
        lines.append(
            BearingLine(
                axis=axis,
                pivot=pivot,
                score=score,
                surface_a=shares[0],
                surface_b=shares[1],
                circles_a=0.0,
                circles_b=0.0,
            )
        )
    return lines


def _whole_side(surface: PartSurface, count: int) -> _Side:
    samples = surface.sample(count)
    nothing, none = np.empty((0, 3)), np.empty(0)
    return _Side(
        points=samples.points,
        normals=samples.normals,
        weights=samples.areas,
        middles=nothing,
        tangents=nothing,
        lengths=none,
        edge_weights=none,
        circle_axes=nothing,
        circle_centres=nothing,
        circle_weights=none,
    )


# ---- evidence of one side ------------------------------------------------------------------------------------------


def _make_side(
    surface: PartSurface, samples: ContactSamples, other: PartSurface, gap: float, scale: float, config: BearingConfig
) -> _Side:
    weights = samples.areas * _fade(samples.distances, gap, scale)
    keep = weights > config.negligible * weights.max(initial=0.0)
    edges = surface.feature_pieces
    distance = _distance_near(edges.middles, other, gap + 3 * scale)
    near = np.isfinite(distance)
    triples = surface.feature_circles
    circle_distance = _distance_near(triples.on_circle, other, gap + 3 * scale)
    circle_near = np.isfinite(circle_distance)
    return _Side(
        points=samples.points[keep],
        normals=samples.normals[keep],
        weights=weights[keep],
        middles=edges.middles[near],
        tangents=edges.tangents[near],
        lengths=edges.lengths[near],
        edge_weights=_fade(distance[near], gap, scale),
        circle_axes=triples.axes[circle_near],
        circle_centres=triples.centres[circle_near],
        circle_weights=_fade(circle_distance[circle_near], gap, scale) * triples.lengths[circle_near],
    )


def _distance_near(points: FloatArray, other: PartSurface, reach: float) -> FloatArray:
    """Exact distance to the other part [m], infinite beyond `reach`."""
    result = np.full(len(points), np.inf)
    lower, upper = other.part.bounds
    boxed = np.flatnonzero(np.all((points >= lower - reach) & (points <= upper + reach), axis=1))
    if len(boxed):
        distance = other.distance(points[boxed])
        result[boxed] = np.where(distance <= reach, distance, np.inf)
    return result


# ---- proposals -----------------------------------------------------------------------------------------------------


def _propose(
    sides: tuple[_Side, _Side], centroid: FloatArray, diagonal: float, config: BearingConfig, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Promising distinct lines: the best by area among all, and the best by circles among those through circles.

    Both lists are needed: a bearing that shows as two circles on boxy housings has little round area.

    Returns:
        Axes (L, 3) and points (L, 3); each point is the foot of the contact centroid.
    """
    by_pairs = [_normal_pair_lines(side, config.pairs, rng) for side in sides]
    by_circles = [_circle_lines(side, config.circles, rng) for side in sides]
    axes = np.concatenate([found[0] for found in (*by_circles, *by_pairs)])
    points = np.concatenate([found[1] for found in (*by_circles, *by_pairs)])
    if len(axes) == 0:
        return axes, points
    points = points + np.einsum("ij,ij->i", centroid - points, axes)[:, None] * axes
    area = np.sqrt(
        _surface_support(_thin(sides[0], config.coarse_samples), axes, points, config)
        * _surface_support(_thin(sides[1], config.coarse_samples), axes, points, config)
    )
    votes = _circle_votes(axes, points, len(by_circles[0][0]), len(by_circles[1][0]), diagonal, config)
    chosen: list[int] = []
    for merit, count in ((area, config.shortlist), (votes, config.shortlist_circles)):
        order = np.argsort(-merit, kind="stable")
        order = order[merit[order] > 0]
        picked = _distinct(axes[order], points[order], count, 4.0, 0.006 * diagonal)
        chosen += order[picked].tolist()
    return axes[chosen], points[chosen]


def _circle_votes(
    axes: FloatArray, points: FloatArray, count_a: int, count_b: int, diagonal: float, config: BearingConfig
) -> FloatArray:
    """For each line through a circle, how many circles of either side share it (geometric mean); else 0."""
    votes = np.zeros(len(axes))
    total = count_a + count_b
    u, p = axes[:total], points[:total]
    aligned = np.abs(u @ u.T) > np.cos(np.arcsin(config.circle_tolerance_sine))
    offset = p[None] - p[:, None]
    along = np.einsum("ijk,ik->ij", offset, u)
    apart = np.sqrt(np.maximum(np.einsum("ijk,ijk->ij", offset, offset) - along**2, 0))
    same = aligned & (apart < config.circle_cell * diagonal)
    votes[:total] = np.sqrt(same[:, :count_a].sum(axis=1) * same[:, count_a:].sum(axis=1))
    return votes


def _normal_pair_lines(side: _Side, count: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Axis of the cylinder through two samples: along n1 x n2, through the point where the normals meet."""
    if len(side.weights) < 2:
        return np.empty((0, 3)), np.empty((0, 3))
    chance = side.weights / side.weights.sum()
    first, second = rng.choice(len(chance), (2, count), p=chance)
    n1, n2 = side.normals[first], side.normals[second]
    cross = np.cross(n1, n2)
    sine = np.linalg.norm(cross, axis=1)
    good = sine > 0.17  # below 10 deg between the normals the intersection is ill-conditioned
    axis = cross[good] / sine[good, None]
    offset = side.points[second][good] - side.points[first][good]
    # Solve x1 + s n1 = x2 + t n2 in the plane across the axis.
    along = np.einsum("ij,ij->i", np.cross(offset, n2[good]), axis) / sine[good]
    return axis, side.points[first][good] + along[:, None] * n1[good]


def _circle_lines(side: _Side, count: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    if len(side.circle_weights) == 0 or side.circle_weights.sum() <= 0:
        return np.empty((0, 3)), np.empty((0, 3))
    if len(side.circle_weights) > count:
        chance = side.circle_weights / side.circle_weights.sum()
        picked = rng.choice(len(chance), count, p=chance)
    else:
        picked = np.arange(len(side.circle_weights))
    return side.circle_axes[picked], side.circle_centres[picked]


# ---- scores --------------------------------------------------------------------------------------------------------


def _rank(
    side_a: _Side,
    side_b: _Side,
    axes: FloatArray,
    points: FloatArray,
    centroid: FloatArray,
    diagonal: float,
    config: BearingConfig,
) -> list[BearingLine]:
    """Refine lines on few samples, keep the best distinct ones, finish them on all samples; best first."""
    thin = _thin(side_a, config.refine_samples), _thin(side_b, config.refine_samples)
    tolerances = np.geomspace(config.normal_tolerance_sine, config.fine_tolerance_sine, config.refine_steps)
    results = []
    for axis, point in zip(axes, points, strict=True):
        axis, point = _refine(*thin, axis, point, tolerances, config)
        results.append(_line(*thin, axis, point, centroid, diagonal, config))
    results = _best_distinct(results, diagonal, config)
    final = []
    for line in results:
        axis, point = _refine(side_a, side_b, line.axis, line.pivot, tolerances[-2:], config)
        final.append(_line(side_a, side_b, axis, point, centroid, diagonal, config))
    return _best_distinct(final, diagonal, config)


def _best_distinct(lines: list[BearingLine], diagonal: float, config: BearingConfig) -> list[BearingLine]:
    """The best lines, best first, without those that nearly repeat a better one."""
    ordered = sorted(lines, key=lambda line: -line.score)
    axes = np.array([line.axis for line in ordered])
    pivots = np.array([line.pivot for line in ordered])
    return [ordered[index] for index in _distinct(axes, pivots, config.keep, 2.0, 0.003 * diagonal)]


def _line(
    side_a: _Side,
    side_b: _Side,
    axis: FloatArray,
    point: FloatArray,
    centroid: FloatArray,
    diagonal: float,
    config: BearingConfig,
) -> BearingLine:
    """Score a line; its pivot is the foot of the contact centroid."""
    surface = [float(_surface_support(side, axis[None], point[None], config)[0]) for side in (side_a, side_b)]
    circles = [_circle_support(side, axis, point, diagonal, config) for side in (side_a, side_b)]
    support = np.sqrt(surface[0] * surface[1])
    score = float(support * (config.circle_floor + np.sqrt(circles[0] * circles[1])) / (config.circle_floor + 1))
    return BearingLine(
        axis=axis,
        pivot=point + axis * float((centroid - point) @ axis),
        score=score,
        surface_a=surface[0],
        surface_b=surface[1],
        circles_a=circles[0],
        circles_b=circles[1],
    )


def _thin(side: _Side, count: int) -> _Side:
    """Keep about `count` samples, evenly spread over the list."""
    if len(side.weights) <= count:
        return side
    index = np.linspace(0, len(side.weights) - 1, count).astype(np.int64)
    return _Side(
        **{
            **side.__dict__,
            "points": side.points[index],
            "normals": side.normals[index],
            "weights": side.weights[index],
        }
    )


def _surface_support(side: _Side, axes: FloatArray, points: FloatArray, config: BearingConfig) -> FloatArray:
    """Share of near area that turns into itself about each line, weighted by how well it locates the line.

    Consistent area counts through the smaller eigenvalue of the 2x2 matrix of its normals across the axis: a flat
    wall, which a far-away line explains too, has rank one and counts nothing. Area perpendicular to the axis (flanges,
    washers) counts a little.

    Returns:
        Support in [0, 1], shape (L,).
    """
    total = max(float(side.weights.sum()), 1e-300)
    result = np.empty(len(axes))
    for start in range(0, len(axes), 256):
        u, p = axes[start : start + 256], points[start : start + 256]
        e1, e2 = _across(u)
        along = side.normals @ u.T  # (S, L)
        n1, n2 = side.normals @ e1.T, side.normals @ e2.T
        x1 = side.points @ e1.T - np.einsum("ij,ij->i", p, e1)
        x2 = side.points @ e2.T - np.einsum("ij,ij->i", p, e2)
        radius = np.sqrt(x1 * x1 + x2 * x2) + 1e-12
        miss = (x1 * n2 - x2 * n1) / radius  # sine of the angle between normal and meridian plane
        fit = np.exp(-((miss / config.normal_tolerance_sine) ** 2)) * side.weights[:, None]
        s11, s22, s12 = (fit * n1 * n1).sum(0), (fit * n2 * n2).sum(0), (fit * n1 * n2).sum(0)
        half = 0.5 * (s11 + s22)
        smaller = half - np.sqrt(np.maximum(0.25 * (s11 - s22) ** 2 + s12 * s12, 0))
        flat = (np.exp(-((1 - along * along) / config.normal_tolerance_sine**2)) * side.weights[:, None]).sum(0)
        result[start : start + 256] = (2 * smaller + config.flange_weight * flat) / total
    return np.clip(result, 0.0, 1.0)


def _across(axes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors across each axis, shapes (L, 3)."""
    helper = np.eye(3)[np.argmin(np.abs(axes), axis=1)]
    first = np.cross(axes, helper)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(axes, first)


def _circle_support(
    side: _Side, axis: FloatArray, point: FloatArray, diagonal: float, config: BearingConfig
) -> float:
    """Arc of feature edges that run around the line, in full turns near the contact, saturated to [0, 1]."""
    if len(side.lengths) == 0:
        return 0.0
    offset = side.middles - point
    height = offset @ axis
    radial = offset - height[:, None] * axis
    radius = np.linalg.norm(radial, axis=1)
    sine = config.circle_tolerance_sine
    around = (
        (np.abs(side.tangents @ axis) < sine)
        & (np.abs(np.einsum("ij,ij->i", side.tangents, radial)) < sine * radius)
        & (side.lengths < 0.8 * radius)  # at least an octagon: a straight edge is no arc
    )
    if not around.any():
        return 0.0
    cell = config.circle_cell * diagonal
    keys = np.stack([np.round(radius[around] / cell), np.round(height[around] / cell)], axis=1)
    _, inverse = np.unique(keys, axis=0, return_inverse=True)
    turn = side.lengths[around] / radius[around] / (2 * np.pi)
    turns = np.bincount(inverse.reshape(-1), turn)
    weighted = np.bincount(inverse.reshape(-1), turn * side.edge_weights[around])
    arc = weighted * (turns > config.least_arc)
    return float(1 - np.exp(-np.minimum(arc, 2.0).sum()))


# ---- refinement ----------------------------------------------------------------------------------------------------


def _refine(
    side_a: _Side,
    side_b: _Side,
    axis: FloatArray,
    point: FloatArray,
    tolerances: FloatArray,
    config: BearingConfig,
) -> tuple[FloatArray, FloatArray]:
    """Robust Gauss-Newton on the four parameters of the line; the tolerance shrinks from coarse to fine.

    Each round linearises the angular residuals with frozen radii and weights them by exp(-(r / tolerance)^2), where
    `tolerances` holds the sine of the tolerance of each round. Both parts weigh the same whatever their areas.
    """
    spread = _spread(side_a, side_b)
    for tolerance in tolerances:
        basis = _basis(axis)
        normal, gradient = np.zeros((4, 4)), np.zeros(4)
        for side in (side_a, side_b):
            for design, rest, weight in (
                _surface_rows(side, axis, point, basis, spread, tolerance),
                _circle_rows(side, axis, point, basis, spread, tolerance, config),
            ):
                normal += design.T @ (design * weight[:, None])
                gradient += design.T @ (weight * rest)
        damping = (1e-9 * np.trace(normal) + 1e-15) * np.eye(4)
        step = -np.linalg.solve(normal + damping, gradient)
        step *= min(1.0, 0.1 / max(float(np.linalg.norm(step)), 1e-12))
        axis = axis + step[0] * basis[0] + step[1] * basis[1]
        axis /= np.linalg.norm(axis)
        point = point + spread * (step[2] * basis[0] + step[3] * basis[1])
    return axis, point


def _spread(side_a: _Side, side_b: _Side) -> float:
    """Spread of the near samples [m]; makes steps in position as large as steps in direction."""
    return max(float(np.sqrt(sum(side.points.var(0).sum() for side in (side_a, side_b) if len(side.points)))), 1e-12)


def _surface_rows(
    side: _Side, axis: FloatArray, point: FloatArray, basis: FloatArray, spread: float, tolerance: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Rows of n . (u x (x - p)) / radius = 0: the normal line meets the axis."""
    arm = side.points - point
    turned = arm @ _cross_matrix(axis).T
    radius = np.sqrt((turned * turned).sum(axis=1)) + 1e-12
    rest = (side.normals * turned).sum(axis=1) / radius
    # n . (e x arm) for the tilts of the axis towards e, n . (e x u) for its shifts, both as products with e.
    tilt = [(side.normals * (arm @ _cross_matrix(e).T)).sum(axis=1) / radius for e in basis]
    shift = [side.normals @ (_cross_matrix(e) @ axis) / radius * spread for e in basis]
    design = np.stack([*tilt, *shift], axis=1)
    across = 1 - (side.normals @ axis) ** 2
    total = max(float(side.weights.sum()), 1e-300)
    return design, rest, np.exp(-((rest / tolerance) ** 2)) * across * side.weights / total


def _basis(axis: FloatArray) -> FloatArray:
    """Two unit vectors across one axis, shape (2, 3)."""
    first = _cross_matrix(axis) @ np.eye(3)[int(np.argmin(np.abs(axis)))]
    first /= np.sqrt(first @ first)
    return np.stack([first, _cross_matrix(axis) @ first])


def _cross_matrix(vector: FloatArray) -> FloatArray:
    """Matrix of v -> vector x v, shape (3, 3)."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _circle_rows(
    side: _Side,
    axis: FloatArray,
    point: FloatArray,
    basis: FloatArray,
    spread: float,
    tolerance: float,
    config: BearingConfig,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Rows of t . u = 0 and t . (m - p) / radius = 0: a piece of edge runs around the axis."""
    arm = side.middles - point
    radial = arm - (arm @ axis)[:, None] * axis
    radius = np.sqrt((radial * radial).sum(axis=1)) + 1e-12
    level = side.tangents @ axis
    outward = (side.tangents * radial).sum(axis=1) / radius
    zeros = np.zeros((len(radius), 2))
    tilt = np.concatenate([side.tangents @ basis.T, zeros], axis=1)
    shift = np.concatenate([zeros, -(side.tangents @ basis.T) * (spread / radius)[:, None]], axis=1)
    fit = np.exp(-((level / tolerance) ** 2) - (outward / tolerance) ** 2) * (side.lengths < 0.8 * radius)
    weight = config.circle_weight * fit * side.edge_weights * np.minimum(side.lengths / radius, 0.5) / (2 * np.pi)
    return (
        np.concatenate([tilt, shift]),
        np.concatenate([level, outward]),
        np.concatenate([weight, weight]),
    )


def _distinct(axes: FloatArray, points: FloatArray, count: int, degrees: float, distance: float) -> list[int]:
    """Greedily keep lines that differ from all kept ones by an angle or a distance at the contact."""
    kept: list[int] = []
    cosine = np.cos(np.deg2rad(degrees))
    for index in range(len(axes)):
        if kept:
            offset = points[kept] - points[index]
            offset -= (offset @ axes[index])[:, None] * axes[index]
            same = (np.abs(axes[kept] @ axes[index]) > cosine) & (np.linalg.norm(offset, axis=1) < distance)
            if same.any():
                continue
        kept.append(index)
        if len(kept) == count:
            break
    return kept
