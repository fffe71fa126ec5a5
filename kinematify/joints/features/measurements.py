"""Measurements of every hypothesis of a joint: one row of continuous numbers each, which the fitted choice reads.

A measurement is pure: it reads geometry alone, no verdict of another one, and no kind of object. Motion is measured
relative to the overlap at rest, because solids that stand in each other are a way of modelling: a point of the child
that lies inside the parent at rest may stay there.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.joints.candidate import FIXED, SLIDE, TURN
from kinematify.joints.features.frames import UP
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.robot.arrays import FloatArray, IntArray


_POINTS = 90  # of a part, in tests of motion
_CONTACT_POINTS = 50
_TURNS = np.radians([3.0, 10.0, 30.0, 75.0])
_SLIDES = np.array([0.03, 0.1, 0.25, 0.6])  # of the child's diagonal
_SMALL, _LARGE = 1, 2  # the steps at which the contact is measured
_TINY = 1e-12


class MeasuredHypotheses:
    """One edge with its hypotheses, and what several measurements share."""

    def __init__(self, scene: JointScene, hypotheses: Hypotheses, *, sided: bool = False) -> None:
        """Keep them.

        Args:
            scene: The edge.
            hypotheses: Its joints.
            sided: Measure every motion in the positive direction of its axis, not in the one with less in the way.
        """
        self.scene = scene
        self.hypotheses = hypotheses
        self.sided = sided
        self.unit = max(scene.frame.diagonal, _TINY)
        """Diagonal of the child's box, the unit of most lengths [m]."""
        self.child = scene.samples
        self.parent = scene.parent_samples
        rng = np.random.default_rng(7)
        self.few = rng.permutation(len(self.child.points))[:_POINTS]
        (low, high), slack = scene.bounds, 0.25 * self.unit
        near = np.all((self.parent.points > low - slack) & (self.parent.points < high + slack), axis=1)
        self.few_parent = rng.permutation(np.flatnonzero(near))[:_POINTS]
        contact = scene.contact
        self.few_contact = (
            rng.choice(len(contact.points), _CONTACT_POINTS, p=contact.weights)
            if len(contact.points)
            else np.empty(0, dtype=np.int64)
        )

    def of_each(self, value: FloatArray | float) -> FloatArray:
        """A value of each hypothesis, shape (h,), of one that may be the same of all."""
        return value if isinstance(value, np.ndarray) else np.full(len(self.hypotheses), float(value))

    @cached_property
    def arms(self) -> FloatArray:
        """From each line to the child's centre, across the line [m], shape (h, 3)."""
        return self.hypotheses.arms(self.scene.centre)

    def radii(self, points: FloatArray) -> FloatArray:
        """Distances of points (n, 3) from each line [m], shape (h, n)."""
        h = self.hypotheses
        return lengths_of(crossed(points[None] - h.pivots[:, None], h.axes[:, None]))

    def velocity(self, point: FloatArray) -> FloatArray:
        """First motion of a point (3,) by each hypothesis, shape (h, 3); zero for fixed."""
        h = self.hypotheses
        return np.where((h.kinds == TURN)[:, None], crossed(h.axes, point - h.pivots), h.axes)

    def moved(self, points: FloatArray, amounts: FloatArray) -> FloatArray:
        """Points (n, 3) or (h, n, 3) after each hypothesis has moved by its amount (h,), shape (h, n, 3)."""
        h = self.hypotheses
        given = np.broadcast_to(points, (len(h), *points.shape[-2:]))
        turned = turned_about(given, h, amounts)
        straight = given + amounts[:, None, None] * h.axes[:, None]
        kinds = h.kinds[:, None, None]
        return np.where(kinds == TURN, turned, np.where(kinds == SLIDE, straight, given))

    @cached_property
    def steps(self) -> list[tuple[int, int, FloatArray]]:
        """Side (0 forward, 1 backward), step and amounts (h,) of every pose that is tried."""
        amounts = np.where((self.hypotheses.kinds == TURN)[:, None], _TURNS, _SLIDES * self.unit)
        return [(side, k, sign * amounts[:, k]) for side, sign in enumerate((1.0, -1.0)) for k in range(len(_TURNS))]

    @cached_property
    def blocked(self) -> dict[str, FloatArray]:
        """Share of points that enter a solid which they were not in at rest, by obstacle, shape (h, 2, steps)."""
        scene = self.scene
        own = self.child.points[self.few] - 0.01 * self.unit * self.child.normals[self.few]
        theirs = self.parent.points[self.few_parent] - 0.01 * self.unit * self.parent.normals[self.few_parent]
        return {
            "parent": self._entered(own, (scene.parent,), 1.0),
            "others": self._entered(own, self.near_others, 1.0),
            "back": self._entered(theirs, (scene.child,), -1.0),
        }

    @cached_property
    def near_others(self) -> tuple[int, ...]:
        """Parts beside the parent that a motion may meet."""
        low, high = self.scene.bounds
        return self.scene.cache.near(self.scene.others, low - 0.6 * self.unit, high + 0.6 * self.unit)

    def _entered(self, points: FloatArray, parts: Sequence[int], sense: float) -> FloatArray:
        count = len(self.hypotheses)
        result = np.zeros((count, 2, len(_TURNS)))
        if len(points) == 0 or len(parts) == 0:
            return result
        outside = points[~self.scene.cache.inside_any(parts, points)]  # what is in a solid at rest cannot enter it
        moving = self.hypotheses.kinds != FIXED
        poses = np.stack([self.moved(outside, sense * amounts)[moving] for _, _, amounts in self.steps])
        entered = self.scene.cache.inside_any(parts, poses.reshape(-1, 3)).reshape(poses.shape[:3])
        shares = entered.sum(axis=2) / len(points)
        for (side, k, _), share in zip(self.steps, shares, strict=True):
            result[moving, side, k] = share
        return result

    @cached_property
    def better(self) -> IntArray:
        """The side that is measured: on which less is in the way, or the first one, shape (h,)."""
        if self.sided:
            return np.zeros(len(self.hypotheses), dtype=np.int64)
        total = np.sum([shares.sum(axis=2) for shares in self.blocked.values()], axis=0)
        return np.asarray(np.argmin(total, axis=1))


def turned_about(points: FloatArray, lines: Hypotheses, angles: FloatArray) -> FloatArray:
    """Points (c, n, 3) or (1, n, 3) after a turn about each of c lines by its angle (c,) [rad], shape (c, n, 3)."""
    offset = points - lines.pivots[:, None]
    along = np.einsum("cnk,ck->cn", offset, lines.axes)[..., None] * lines.axes[:, None]
    radial = offset - along
    cosine, sine = np.cos(angles)[:, None, None], np.sin(angles)[:, None, None]
    return np.asarray(lines.pivots[:, None] + along + cosine * radial + sine * crossed(lines.axes[:, None], radial))


# ---- measurements --------------------------------------------------------------------------------------------------

Values = dict[str, "FloatArray"]
_Found = dict[str, "FloatArray | float"]  # a number where all hypotheses have the same


def motion(m: MeasuredHypotheses) -> _Found:
    """Free travel each way, by what newly overlaps: the parent, the rest, and the parent's own points in the child."""
    rows = np.arange(len(m.hypotheses))
    result: _Found = {}
    for name, shares in m.blocked.items():
        best, worst = shares[rows, m.better], shares[rows, 1 - m.better]
        for k in range(best.shape[1]):
            result[f"enter_{name}_{k}"] = best[:, k]
            result[f"stop_{name}_{k}"] = worst[:, k]
    return result


def contact_motion(m: MeasuredHypotheses) -> _Found:
    """Return how much of the contact is kept, and what gap opens, after a small and a larger step either way."""
    h, scene = m.hypotheses, m.scene
    own = m.child.points[m.few]
    touching = scene.contact.points[m.few_contact]
    points = np.concatenate([own, touching])
    before = scene.cache.distances(scene.parent, points)
    tolerance = 0.01 * m.unit
    result: _Found = {}
    values = np.zeros((len(h), 2, 2, 3))
    for side, k, amounts in m.steps:
        if k not in (_SMALL, _LARGE):
            continue
        moved, found = m.moved(points, amounts), values[:, side, int(k == _LARGE)]
        gap = scene.cache.distances(scene.parent, moved.reshape(-1, 3)).reshape(moved.shape[:2])
        kept, of_own, at_rest = gap < before + tolerance, gap[:, : len(own)], before[: len(own)]
        found[:, 0] = (of_own.min(axis=1) - at_rest.min()) / m.unit
        found[:, 1] = kept[:, len(own) :].mean(axis=1) if len(touching) else 0.0
        found[:, 2] = (of_own - at_rest).mean(axis=1) / m.unit
    rows = np.arange(len(h))
    for k, step in enumerate(("small", "large")):
        for j, name in enumerate(("gap", "kept", "leaving")):
            result[f"{name}_{step}"] = values[rows, m.better, k, j]
            result[f"{name}_{step}_back"] = values[rows, 1 - m.better, k, j]
    return result


def bearing(m: MeasuredHypotheses) -> _Found:
    """Support of the bearing that proposed the line, or lies nearest to it, and of the rail along it."""
    h, scene = m.hypotheses, m.scene
    names = ("score", "surface", "circles", "surface_least", "circles_least", "axis")
    values = np.zeros((len(names), len(h)))
    for line in scene.lines:
        cosine = np.abs(h.axes @ line.axis)
        apart = lengths_of(crossed(line.pivot - h.pivots, line.axis)) / m.unit
        same = (cosine > np.cos(np.radians(2.0))) & ((apart < 0.02) | (h.kinds == SLIDE))
        supports = (line.score, line.surface, line.circles, min(line.surfaces), min(line.rings))
        values = np.maximum(values, [*(same * support for support in supports), line.score * (cosine > 0.999)])
    rail = scene.rail
    return {
        **{f"bearing_{name}": value for name, value in zip(names, values, strict=True)},
        "bearing_best": max((line.score for line in scene.lines), default=0.0),
        "rail_best": scene.rail_score,
        "rail_along": 0.0 if rail is None else np.where(np.abs(h.axes @ rail.axis) > 0.999, rail.score, 0.0),
        "rail_lead": scene.rail_lead,
        "journal": 0.0 if scene.journal is None else scene.journal.coverage,
    }


def place(m: MeasuredHypotheses) -> _Found:
    """The line in the boxes of child and parent: along which side, how far from the middle, near what."""
    h, scene = m.hypotheses, m.scene
    frame = scene.frame
    order = np.argsort(frame.extents)
    along = np.abs(h.axes @ frame.axes[order].T)
    half = np.maximum(0.5 * frame.extents[order], 0.01 * m.unit)
    offset = -(m.arms @ frame.axes[order].T) / half
    across = 1.0 - along > 0.5
    offset = np.where(across, offset, 0.0)
    points = m.child.points[:: max(1, len(m.child.points) // 300)]
    radius = m.radii(points)
    reach = np.maximum(radius.max(axis=1), _TINY)
    cosines = np.abs(h.axes @ frame.axes.T)
    length = (cosines @ frame.extents) / m.unit
    body = scene.body_box
    size = np.maximum(body[1] - body[0], 0.01 * m.unit)
    foot = scene.centre - m.arms
    in_body = (foot @ frame.axes.T - body.mean(axis=0)) / (0.5 * size)
    in_body = np.where(cosines < 0.7, np.abs(in_body), 0.0)
    steps = np.linspace(-0.9, 0.9, 7)
    span = 0.5 * length * m.unit
    probes = foot[:, None] + steps[None, :, None] * (span[:, None] * h.axes)[:, None]
    to_parent, to_child = (
        scene.cache.distances(part, probes.reshape(-1, 3)).reshape(len(h), -1) / m.unit
        for part in (scene.parent, scene.child)
    )
    sides = ("short", "middle", "long")
    return {
        **{f"along_{name}": along[:, k] for k, name in enumerate(sides)},
        **{f"off_{name}": np.abs(offset[:, k]) for k, name in enumerate(sides)},
        "off_most": np.abs(offset).max(axis=1),
        "off_least": np.where(across, np.abs(offset), 9.0).min(axis=1),
        "mean_radius": radius.mean(axis=1) / reach,
        "least_radius": radius.min(axis=1) / reach,
        "eccentric": lengths_of(crossed(points.mean(axis=0) - h.pivots, h.axes)) / reach,
        "reach": reach / m.unit,
        "length": length,
        "body_off_most": in_body.max(axis=1),
        "body_off_sum": in_body.sum(axis=1),
        "line_to_parent": to_parent.mean(axis=1),
        "line_to_parent_least": to_parent.min(axis=1),
        "line_to_child": to_child.mean(axis=1),
    }


def contact_place(m: MeasuredHypotheses) -> _Found:
    """Where the contact lies about the line."""
    h, contact = m.hypotheses, m.scene.contact
    if len(contact.points) == 0:
        return {}
    points = contact.points[m.few_contact]
    radius = m.radii(points) / m.unit
    along = (points - contact.centroid) @ h.axes.T
    values, vectors = np.linalg.eigh(np.cov((points - points.mean(axis=0)).T) + _TINY * m.unit**2 * np.eye(3))
    reach = np.maximum(radius.max(axis=1), _TINY)
    normals = contact.normals[m.few_contact]
    return {
        "contact_radius": radius.mean(axis=1),
        "contact_radius_least": radius.min(axis=1),
        "contact_radius_most": reach,
        "contact_share_near": (radius < 0.06).mean(axis=1),
        "contact_spread_along": np.ptp(along, axis=0) / m.unit,
        "contact_offset": lengths_of(crossed(contact.centroid - h.pivots, h.axes)) / m.unit,
        "contact_along": np.abs(h.axes @ vectors[:, 2]),
        "contact_across": np.abs(h.axes @ vectors[:, 0]),
        "contact_flatness": np.sqrt(max(values[0], 0.0) / values[2]),
        "contact_slimness": np.sqrt(max(values[1], 0.0) / values[2]),
        "contact_spread": np.sqrt(values.sum()) / m.unit,
        "contact_normals_along": np.abs(normals @ h.axes.T).mean(axis=0),
    }


def child_shape(m: MeasuredHypotheses) -> _Found:
    """Sides of the child, how boxy and how round it is, and its size beside parent and whole."""
    scene = m.scene
    sides = np.sort(scene.frame.extents)
    sides = np.maximum(sides, 1e-4 * sides[2])
    facing = np.abs(m.child.normals @ scene.frame.axes.T) > np.cos(np.radians(12.0))
    parent_sides = np.sort(scene.parent_frame.extents)
    shares = np.sort(facing.mean(axis=0))
    thin, slim = np.log(np.maximum(parent_sides[:2] / np.maximum(parent_sides[1:], _TINY), 1e-4))
    edge = scene.cache.graph.by_pair.get(pair(scene.parent, scene.child))
    return {
        "thin": np.log(sides[0] / sides[1]),
        "slim": np.log(sides[1] / sides[2]),
        "boxy": facing.any(axis=1).mean(),
        "boxy_least": shares[0],
        "boxy_most": shares[2],
        "disc": scene.disc,
        "size_parent": np.log(scene.frame.diagonal / max(scene.parent_frame.diagonal, _TINY)),
        "size_whole": np.log(scene.frame.diagonal / scene.diagonal),
        "longest_parent": np.log(sides[2] / max(float(parent_sides[2]), _TINY)),
        "parent_thin": thin,
        "parent_slim": slim,
        "sticking_out": scene.frame.diagonal / max(float(np.linalg.norm(scene.frame.extents)), _TINY),
        "contact_share_of_child": len(scene.contact.points) / max(len(m.child.points), 1),
        "gap": (scene.diagonal if edge is None else edge.gap) / m.unit,
    }


def where(m: MeasuredHypotheses) -> _Found:
    """The child in its parent and in the whole: inside, in front, on top, covered, overlapping, facing up."""
    scene, h = m.scene, m.hypotheses
    frame, body = scene.frame, scene.body_box
    size = np.maximum(body[1] - body[0], 1e-3 * m.unit)
    centre = (scene.centre @ frame.axes.T - body.mean(axis=0)) / (0.5 * size)
    low, high = scene.cache.assembly.bounds
    whole = (scene.centre - low) / np.maximum(high - low, _TINY)
    at_rest = scene.cache.inside(scene.parent, m.child.points[m.few] - 0.01 * m.unit * m.child.normals[m.few])
    own, its = scene.bounds, scene.parent_bounds
    return {
        "inside_box": scene.inside,
        "inside_solid": at_rest.mean(),
        "enclosed": scene.enclosed,
        "thin_up": abs(float(frame.thin_axis @ UP)),
        "long_up": abs(float(frame.axes[int(np.argmax(frame.extents))] @ UP)),
        "centre_thin": abs(float(centre[frame.thin])),
        "centre_most": np.abs(centre).max(),
        "centre_up": (scene.centre - its.mean(axis=0)) @ UP / max(float(np.ptp(its[:, 2])), 1e-3 * m.unit),
        "height": whole[2],
        "to_floor": (own[0, 2] - low[2]) / m.unit,
        "handle": scene.handle is not None,
        "axis_up": np.abs(h.axes @ UP),
        "centre_along": np.abs(h.axes @ frame.axes.T) @ np.abs(centre),
    }


def gravity(m: MeasuredHypotheses) -> _Found:
    """Where the line lies above or below the child, and whether the free motion lifts it."""
    arms = -m.arms
    length = np.maximum(lengths_of(arms), 1e-9 * m.unit)
    sign = np.where(m.better == 0, 1.0, -1.0)
    velocity = m.velocity(m.scene.centre) * sign[:, None]
    way = velocity / np.maximum(lengths_of(velocity), 1e-9 * m.unit)[:, None]
    out = (m.scene.centre - m.scene.parent_bounds.mean(axis=0)) / m.unit
    whole = m.scene.centre - m.scene.cache.assembly.bounds.mean(axis=0)
    away, far = m.scene.outward, max(float(np.linalg.norm(out)), _TINY)
    return {
        "line_above": arms[:, 2] / length,
        "line_above_far": arms[:, 2] / m.unit,
        "rises": way[:, 2],
        "leaves_parent": way @ out / far,
        "leaves_whole": way @ whole / max(float(np.linalg.norm(whole)), _TINY),
        "leaves_panel": way @ away,
        "along_outward": np.abs(m.hypotheses.axes @ away),
        "along_out": np.abs(m.hypotheses.axes @ out) / far,
    }


def neighbours(m: MeasuredHypotheses) -> _Found:
    """Congruent parts, in which direction they stand, and what else the child touches or carries."""
    scene, h = m.scene, m.hypotheses
    graph, parts = scene.cache.graph, len(scene.cache.assembly.parts)
    twins = graph.alike.others(scene.child)
    result: _Found = {
        "twins": len(twins),
        "touches": sum(scene.child in (edge.a, edge.b) and not edge.bridge for edge in graph.edges),
        "parts": np.log(parts),
        "parent_moves": scene.parent_moves,
        "serial": scene.serial,
        "carries": parts - len(scene.others) - 2,
    }
    if not twins:
        return result
    centres = np.array([scene.cache.samples(part).points.mean(axis=0) for part in twins])
    offset = centres - m.child.points.mean(axis=0)
    nearest = offset[int(np.argmin(lengths_of(offset)))]
    direction = nearest / max(float(np.linalg.norm(nearest)), _TINY)
    apart = lengths_of(crossed(offset[None] + m.arms[:, None], h.axes[:, None]))
    return result | {
        "twin_coaxial": apart.min(axis=1) / m.unit,
        "twin_along": np.abs(h.axes @ direction),
        "twin_near": float(np.linalg.norm(nearest)) / m.unit,
        "twin_thin": abs(float(direction @ scene.frame.thin_axis)),
        "twin_towards": -np.einsum("hk,k->h", m.arms, direction) / m.unit,
    }


def measure(m: MeasuredHypotheses) -> Values:
    """Everything that is measured of the hypotheses of an edge, (h,) each; NaN or absent where it does not apply."""
    return {name: value for values in measure_groups(m).values() for name, value in values.items()}


def measure_groups(m: MeasuredHypotheses) -> dict[str, Values]:
    """The same by the group that measures it."""
    return {group.__name__: {key: m.of_each(value) for key, value in group(m).items()} for group in GROUPS}


GROUPS: tuple[Callable[[MeasuredHypotheses], _Found], ...] = (
    motion, contact_motion, bearing, place, contact_place, child_shape, where, gravity, neighbours,
)  # fmt: skip
