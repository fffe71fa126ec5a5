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
from kinematify.joints.bearings.scores import across_axes
from kinematify.joints.candidate import FIXED, SLIDE, TURN
from kinematify.joints.features.frames import UP
from kinematify.robot.vectors import crossed, lengths_of, unit

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray


_POINTS = 90  # of a part, in tests of motion
_CONTACT_POINTS = 50
_FEW = 50  # in tests of symmetry
_TRIED = 400  # samples of a part that may lie in the other solid
_LEAST_SHARED = 5  # of some 800 points that may lie in the other solid
_TURNS = np.radians([3.0, 10.0, 30.0, 75.0])
_SLIDES = np.array([0.03, 0.1, 0.25, 0.6])  # of the child's diagonal
_OPEN = 2  # the step at which what a motion opens is measured
_ALIKE = 0.01  # of the child's diagonal: a mirror image this far off is 1/e alike
_TINY = 1e-12
_LEVEL = 1e-6  # of the child's diagonal: less is rounding
_FIRST_SECTOR = np.pi + 0.1  # [rad]


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
        near = self._near_child(self.parent.points)
        self.few_parent = rng.permutation(near)[:_POINTS]
        contact = scene.contact
        self.few_contact = (
            rng.choice(len(contact.points), _CONTACT_POINTS, p=contact.weights)
            if len(contact.points)
            else np.empty(0, dtype=np.int64)
        )

    def _near_child(self, points: FloatArray) -> IntArray:
        low, high = self.scene.cache.assembly.parts[self.scene.child].bounds
        slack = 0.25 * self.unit
        return np.flatnonzero(np.all((points > low - slack) & (points < high + slack), axis=1))

    def of_each(self, value: FloatArray | float) -> FloatArray:
        """A value of each hypothesis, shape (h,), of one that may be the same of all."""
        return value if isinstance(value, np.ndarray) else np.full(len(self.hypotheses), float(value))

    @cached_property
    def arms(self) -> FloatArray:
        """From each line to the child's centre, across the line [m], shape (h, 3)."""
        return self.hypotheses.arms(self.scene.centre)

    @cached_property
    def shared(self) -> tuple[FloatArray, FloatArray]:
        """Samples of the child in the solid of the parent and of the parent in the child [m], (n, 3) and (k, 3)."""
        scene = self.scene
        own = self.child.points[:: max(1, len(self.child.points) // _TRIED)]
        near = self.parent.points[self._near_child(self.parent.points)]
        near = near[:: max(1, len(near) // _TRIED)]
        return own[scene.cache.inside(scene.parent, own)], near[scene.cache.inside(scene.child, near)]

    def radii(self, points: FloatArray) -> FloatArray:
        """Distances of points (n, 3) from each line [m], shape (h, n)."""
        h = self.hypotheses
        return lengths_of(crossed(points[None] - h.pivots[:, None], h.axes[:, None]))

    def velocity(self, points: FloatArray) -> FloatArray:
        """First motion of points (n, 3) by each hypothesis, shape (h, n, 3); zero for fixed."""
        h = self.hypotheses
        turned = crossed(h.axes[:, None], points[None] - h.pivots[:, None])
        straight = np.broadcast_to(h.axes[:, None], turned.shape)
        return np.where((h.kinds == TURN)[:, None, None], turned, straight)

    def amounts(self) -> FloatArray:
        """Size of every step of every hypothesis [rad or m], shape (h, steps)."""
        turns = (self.hypotheses.kinds == TURN)[:, None]
        return np.where(turns, _TURNS, _SLIDES * self.unit)

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
        amounts = self.amounts()
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
        low, high = self.scene.cache.assembly.parts[self.scene.child].bounds
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
        if k not in (1, _OPEN):
            continue
        moved = m.moved(points, amounts)
        gap = scene.cache.distances(scene.parent, moved.reshape(-1, 3)).reshape(moved.shape[:2])
        kept = gap < before + tolerance
        values[:, side, int(k == _OPEN), 0] = (gap[:, : len(own)].min(axis=1) - before[: len(own)].min()) / m.unit
        values[:, side, int(k == _OPEN), 1] = kept[:, len(own) :].mean(axis=1) if len(touching) else 0.0
        values[:, side, int(k == _OPEN), 2] = (gap[:, : len(own)] - before[: len(own)]).mean(axis=1) / m.unit
    rows = np.arange(len(h))
    for k, step in enumerate(("small", "large")):
        for j, name in enumerate(("gap", "kept", "leaving")):
            result[f"{name}_{step}"] = values[rows, m.better, k, j]
            result[f"{name}_{step}_back"] = values[rows, 1 - m.better, k, j]
    return result


def sliding_surface(m: MeasuredHypotheses) -> _Found:
    """Share of the contact, and of the whole child, that slides along itself under the first motion."""
    contact, few, every = m.scene.contact, m.few_parent, slice(None, None, max(1, len(m.child.points) // 400))
    ones = np.ones(len(contact.parent_points)) / max(len(contact.parent_points), 1)
    points, normals = m.child.points[every], m.child.normals[every]
    return {
        **_slips(m, "contact", contact.points, contact.normals, contact.weights),
        **_slips(m, "parent_contact", contact.parent_points, contact.parent_normals, ones),
        **_slips(m, "child", points, normals, np.ones(len(points))),
        **_slips(m, "near", m.parent.points[few], m.parent.normals[few], np.ones(len(few))),
    }


def _slips(m: MeasuredHypotheses, name: str, points: FloatArray, normals: FloatArray, weights: FloatArray) -> _Found:
    if len(points) == 0:
        return {f"slip_{name}": 1.0, f"slide_share_{name}": 0.0}
    if len(points) > 400:
        stride = len(points) // 400
        points, normals, weights = points[::stride], normals[::stride], weights[::stride]
    velocity = m.velocity(points)
    speed = np.maximum(lengths_of(velocity), _TINY)
    across = np.abs(np.einsum("hnk,nk->hn", velocity, normals))
    weights = weights / max(float(weights.sum()), _TINY)
    rms = np.sqrt((across**2 @ weights) / np.maximum((speed**2) @ weights, _TINY))
    share = (across < np.sin(np.radians(10.0)) * speed) @ weights
    # Round surface alone: flat area across the axis turns into itself about every line along the axis.
    lateral = np.abs(m.hypotheses.axes @ normals.T) < 0.7
    round_share = ((across < np.sin(np.radians(6.0)) * speed) & lateral) @ weights
    return {f"slip_{name}": rms, f"slide_share_{name}": share, f"lateral_{name}": round_share}


def bearing(m: MeasuredHypotheses) -> _Found:
    """Support of the bearing that proposed the line, or lies nearest to it, and of the rail along it."""
    h, scene = m.hypotheses, m.scene
    names = ("score", "surface", "circles", "surface_least", "circles_least", "axis")
    values: _Found = {f"bearing_{name}": np.zeros(len(h)) for name in names}
    for line in scene.lines:
        cosine = np.abs(h.axes @ line.axis)
        apart = lengths_of(crossed(line.pivot - h.pivots, line.axis)) / m.unit
        same = (cosine > np.cos(np.radians(2.0))) & ((apart < 0.02) | (h.kinds == SLIDE))
        numbers = (
            same * line.score,
            same * line.surface,
            same * line.circles,
            same * min(line.surfaces),
            same * min(line.rings),
            line.score * (cosine > 0.999),
        )
        for name, number in zip(values, numbers, strict=True):
            values[name] = np.maximum(values[name], number)
    rail = scene.rail
    return {
        **values,
        "bearing_best": max((line.score for line in scene.lines), default=0.0),
        "rail_best": 0.0 if rail is None else rail.score,
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
    length = (np.abs(h.axes @ frame.axes.T) @ frame.extents) / m.unit
    body = scene.body_box
    size = np.maximum(body[1] - body[0], 0.01 * m.unit)
    foot = scene.centre - m.arms
    in_body = (foot @ frame.axes.T - body.mean(axis=0)) / (0.5 * size)
    in_body = np.where(np.abs(h.axes @ frame.axes.T) < 0.7, np.abs(in_body), 0.0)
    centre = (scene.centre @ frame.axes.T - body.mean(axis=0)) / (0.5 * size)
    outer = -m.arms @ frame.axes.T
    outer = np.where(np.abs(outer) < _LEVEL * m.unit, 0.0, outer)  # a line through the centre is on neither side
    side = np.argmax(np.abs(outer), axis=1)
    rows = np.arange(len(h))
    low, high = frame.slab_lower - body[0], body[1] - frame.slab_upper
    towards = outer[rows, side] > 0
    near, far = np.where(towards, high[side], low[side]), np.where(towards, low[side], high[side])
    steps = np.linspace(-0.9, 0.9, 7)
    span = 0.5 * length * m.unit
    probes = foot[:, None] + steps[None, :, None] * (span[:, None] * h.axes)[:, None]
    to_parent = scene.cache.distances(scene.parent, probes.reshape(-1, 3)).reshape(len(h), -1) / m.unit
    to_child = scene.cache.distances(scene.child, probes.reshape(-1, 3)).reshape(len(h), -1) / m.unit
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
        "hinge_outward": np.sign(outer[rows, side]) * centre[side],
        "margin_here": near / m.unit,
        "margin_opposite": far / m.unit,
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
        "parent_thin": np.log(max(float(parent_sides[0] / max(parent_sides[1], _TINY)), 1e-4)),
        "parent_slim": np.log(max(float(parent_sides[1] / max(parent_sides[2], _TINY)), 1e-4)),
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
    along = np.abs(h.axes @ frame.axes.T)
    low, high = scene.cache.assembly.bounds
    whole = (scene.centre - low) / np.maximum(high - low, _TINY)
    at_rest = scene.cache.inside(scene.parent, m.child.points[m.few] - 0.01 * m.unit * m.child.normals[m.few])
    own, its = (scene.cache.assembly.parts[part].bounds for part in (scene.child, scene.parent))
    ahead = np.minimum(np.abs(frame.lower - body[0]), np.abs(body[1] - frame.upper)) / m.unit
    filling = frame.extents / size
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
        "flush_count": (np.abs(own - its) < 0.02 * m.unit).sum(),
        "filling": np.prod(np.minimum(filling, 1.0)),
        "filling_most": filling.max(),
        "filling_middle": np.sort(filling)[1],
        "handle": scene.handle is not None,
        "axis_up": np.abs(h.axes @ UP),
        "centre_along": along @ np.abs(centre),
        "filling_along": along @ filling,
        "flush_along": along @ ahead,
    }


def symmetry(m: MeasuredHypotheses) -> _Found:
    """Measure what the motion carries the child onto: itself all around, by a fold of the circle, or along a line.

    Distances of moved points to the surface at rest, in shares of the reach; 0 for a disc about its axle, small after a
    third of a turn for a wheel of three spokes, small along its way for a rail.
    """
    h, scene = m.hypotheses, m.scene
    points = m.child.points[m.few[:_FEW]]
    reach = np.where(h.kinds == TURN, np.maximum(m.radii(points).max(axis=1), 0.02 * m.unit), m.unit)

    turns = h.kinds == TURN

    def missed(angle_deg: float, some: BoolArray) -> FloatArray:
        amounts = np.where(turns, np.radians(angle_deg), np.where(h.kinds == SLIDE, 0.1 * m.unit, 0.0))
        moved = m.moved(points, amounts)[some]
        gaps = scene.cache.distances(scene.child, moved.reshape(-1, 3)).reshape(moved.shape[:2])
        return np.asarray(gaps.mean(axis=1) / reach[some])

    values = np.empty((5, len(h)))
    values[:, turns] = [missed(angle, turns) for angle in (37.0, 180.0, 120.0, 90.0, 72.0)]
    values[:, ~turns] = missed(0.0, ~turns)  # a slide is the same for every angle
    odd, half, folds = values[0], values[1], values[2:].min(axis=0)
    everything = m.child.points[:: max(1, len(m.child.points) // 400)]
    return {
        "itself_odd": odd,
        "itself_half": half,
        "itself_folds": folds,
        "itself_folds_gain": folds / np.maximum(odd, 1e-3),
        **_outline(m, everything),
        "twist": _twist(m, everything, m.child.normals[:: max(1, len(m.child.points) // 400)]),
    }


def _outline(m: MeasuredHypotheses, points: FloatArray) -> _Found:
    """Measure how round the outline about each line is: least over largest radius of twelve sectors, their spread."""
    h = m.hypotheses
    sector, apart = _sectors(m, points)
    radius = np.zeros((len(h), 12))
    np.maximum.at(radius, (np.arange(len(h))[:, None], sector), apart)
    largest = np.maximum(radius.max(axis=1), _TINY)
    turns = h.kinds == TURN
    return {
        "outline_least": np.where(turns, radius.min(axis=1) / largest, np.nan),
        "outline_spread": np.where(turns, radius.std(axis=1) / largest, np.nan),
    }


def _sectors(m: MeasuredHypotheses, points: FloatArray) -> tuple[IntArray, FloatArray]:
    """In which of twelve sectors about each line points (n, 3) lie, and how far from it [m], shape (h, n) each.

    No sector starts where outlines of boxes and prisms have their corners.
    """
    first, second = across_axes(m.hypotheses.axes)
    offset = points[None] - m.hypotheses.pivots[:, None]
    x, y = np.einsum("hnk,hk->hn", offset, first), np.einsum("hnk,hk->hn", offset, second)
    return ((np.arctan2(y, x) + _FIRST_SECTOR) / (2.0 * np.pi) * 12).astype(np.int64) % 12, np.hypot(x, y)


def _twist(m: MeasuredHypotheses, points: FloatArray, normals: FloatArray) -> FloatArray:
    """Return how much the surface winds about each line, as the blades of a propeller do, in [0, 1], shape (h,)."""
    h = m.hypotheses
    along = normals @ h.axes.T
    around = np.einsum("hnk,nk->nh", unit(m.velocity(points)), normals)
    wound = np.abs((along * around).mean(axis=0)) / np.maximum(np.abs(along * around).mean(axis=0), 0.02)
    return np.where(h.kinds == TURN, wound, np.nan)


def axle(m: MeasuredHypotheses) -> _Found:
    """Test whether the line is an axle: how high above the floor beside its reach, what it meets on either side."""
    h, scene = m.hypotheses, m.scene
    radius = np.maximum(m.radii(m.child.points[m.few]).max(axis=1), 0.02 * m.unit)
    foot = scene.centre - m.arms
    floor = float(scene.cache.assembly.bounds[0, 2])
    half = 0.5 * (np.abs(h.axes @ scene.frame.axes.T) @ scene.frame.extents)
    met = []
    for sense in (1.0, -1.0):
        reach = (half + 0.5 * m.unit)[:, None] * h.axes * sense
        hits = scene.cache.first_hits(scene.parent, foot, reach)
        inside = scene.cache.inside(scene.parent, foot + 1.1 * half[:, None] * h.axes * sense)
        met.append(np.where(inside, 0.0, np.minimum(hits, 2.0)))
    of_contact = np.einsum("hk,hk->h", m.scene.anchor - scene.centre + np.zeros_like(h.axes), h.axes)
    return {
        "above_floor": np.clip((foot[:, 2] - floor) / radius, 0.0, 5.0),
        "axle_meets": np.min(met, axis=0),
        "axle_meets_both": np.max(met, axis=0),
        "contact_at_end": np.abs(of_contact) / np.maximum(half, 0.02 * m.unit),
    }


def standing_in(m: MeasuredHypotheses) -> _Found:
    """Where the solids stand in each other at rest: how far from the line, and how far along it."""
    scene, h = m.scene, m.hypotheses
    points = np.concatenate(m.shared)
    result: _Found = {"shared_child": len(m.shared[0]) / _TRIED, "shared_parent": len(m.shared[1]) / _TRIED}
    if len(points) < _LEAST_SHARED:
        return result
    radius = m.radii(points) / m.unit
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    half = 0.5 * (np.abs(h.axes @ scene.frame.axes.T) @ scene.frame.extents)
    return result | {
        "shared_radius": radius.mean(axis=1),
        "shared_radius_most": radius.max(axis=1),
        "shared_along": np.ptp(points @ h.axes.T, axis=0) / m.unit,
        "shared_offset": lengths_of(m.hypotheses.arms(centre)) / m.unit,
        "shared_at_end": np.abs(h.axes @ (centre - scene.centre)) / np.maximum(half, 0.02 * m.unit),
    }


def mirror(m: MeasuredHypotheses) -> _Found:
    """Test whether a joint is as symmetric as what it moves: a drawer and its handle do not say on which side to hinge.

    Planes through the child's centre along its box. Where the child, its contact and the parent around it are alike on
    both sides, a joint that differs from its mirror image chooses a side without a reason.
    """
    h, scene = m.hypotheses, m.scene
    axes = scene.frame.axes
    touching = scene.contact.points[m.few_contact]
    kept = np.array(
        [
            [_mirrored_gap(m, part, some, axis) for axis in axes]
            for part, some in (
                (scene.child, m.child.points[m.few]),
                (scene.child, touching),
                (scene.parent, m.parent.points[m.few_parent]),
            )
        ]
    )
    alike = np.exp(-kept / _ALIKE)
    cosines = h.axes @ axes.T
    # A direction is kept by planes that hold it or that it crosses squarely.
    turned = 2.0 * np.abs(cosines) * np.sqrt(np.maximum(1.0 - cosines**2, 0.0))
    across = np.minimum(2.0 * np.abs(m.arms @ axes.T) / m.unit, 1.0) * np.sqrt(np.maximum(1.0 - cosines**2, 0.0))
    broken = np.where((h.kinds == TURN)[:, None], np.maximum(turned, across), turned)
    both = alike.min(axis=0)
    return {
        "mirror_child": (broken * alike[0]).max(axis=1),
        "mirror_pair": (broken * both).max(axis=1),
        "mirror_contact": (broken * np.minimum(alike[0], alike[1])).max(axis=1),
        "mirror_planes": alike[0].sum(),
        "mirror_pair_planes": both.sum(),
        # What is not alike on both sides should have to do with the joint.
        "mirror_reason": (broken * (1.0 - alike[0])).max(axis=1),
    }


def _mirrored_gap(m: MeasuredHypotheses, part: int, points: FloatArray, normal: FloatArray) -> float:
    """Mean distance of points (n, 3), mirrored at the child's centre, from a part, in diagonals of the child."""
    if len(points) == 0:
        return 1.0
    over = (points - m.scene.centre) @ normal
    images = points - 2.0 * over[:, None] * normal
    before = m.scene.cache.distances(part, points)
    return float(np.abs(m.scene.cache.distances(part, images) - before).mean() / m.unit)


def hollow(m: MeasuredHypotheses) -> _Found:
    """Return what of the child is around its own centre: a drawer is open above, a cap below, a ring along its line."""
    h, scene = m.hypotheses, m.scene
    reach = 2.0 * m.unit

    def met(directions: FloatArray) -> FloatArray:
        starts = np.broadcast_to(scene.centre, directions.shape)
        return np.isfinite(scene.cache.first_hits(scene.child, starts, reach * directions)).astype(np.float64)

    first, second = across_axes(h.axes)
    forward = np.where(m.better == 0, 1.0, -1.0)[:, None] * h.axes
    moves = (h.kinds != FIXED)[:, None]
    around = [met(np.where(moves, sign * axis, UP)) for axis in (first, second) for sign in (1.0, -1.0)]
    return {
        "own_ahead": met(np.where(moves, forward, UP)),
        "own_behind": met(np.where(moves, -forward, UP)),
        "own_around": np.mean(around, axis=0),
        "own_above": met(UP[None])[0],
        "own_below": met(-UP[None])[0],
    }


def around(m: MeasuredHypotheses) -> _Found:
    """Measure how far around the line the contact and the child in it reach: an axle is held on all sides."""
    return {
        "contact_around": _around(m, m.scene.contact.points[m.few_contact]),
        "shared_around": _around(m, np.concatenate(m.shared)),
    }


def _around(m: MeasuredHypotheses, points: FloatArray) -> FloatArray:
    """Share of twelve sectors about each line that hold one of the points (n, 3), shape (h,); NaN without points."""
    h = m.hypotheses
    if len(points) == 0:
        return np.full(len(h), np.nan)
    met = np.zeros((len(h), 12))
    met[np.arange(len(h))[:, None], _sectors(m, points)[0]] = 1.0
    return np.where(h.kinds == TURN, met.mean(axis=1), np.nan)


def gravity(m: MeasuredHypotheses) -> _Found:
    """Where the line lies above or below the child, and whether the free motion lifts it."""
    arms = -m.arms
    length = np.maximum(lengths_of(arms), 1e-9 * m.unit)
    sign = np.where(m.better == 0, 1.0, -1.0)
    velocity = m.velocity(m.scene.centre[None])[:, 0] * sign[:, None]
    speed = np.maximum(lengths_of(velocity), 1e-9 * m.unit)
    out = (m.scene.centre - m.scene.cache.assembly.parts[m.scene.parent].bounds.mean(axis=0)) / m.unit
    whole = m.scene.centre - m.scene.cache.assembly.bounds.mean(axis=0)
    away = m.scene.outward
    return {
        "line_above": arms[:, 2] / length,
        "line_above_far": arms[:, 2] / m.unit,
        "rises": velocity[:, 2] / speed,
        "leaves_parent": (velocity / speed[:, None]) @ out / max(float(np.linalg.norm(out)), _TINY),
        "leaves_whole": (velocity / speed[:, None]) @ whole / max(float(np.linalg.norm(whole)), _TINY),
        "leaves_panel": (velocity / speed[:, None]) @ away,
        "along_outward": np.abs(m.hypotheses.axes @ away),
        "along_out": np.abs(m.hypotheses.axes @ out) / max(float(np.linalg.norm(out)), _TINY),
    }


def handle(m: MeasuredHypotheses) -> _Found:
    """Where a hand pulls: far from the line, and along what it moves."""
    h, held = m.hypotheses, m.scene.handle
    if held is None:
        return {}
    arm = lengths_of(m.hypotheses.arms(held.centre)) / m.unit
    velocity = m.velocity(held.centre[None])[:, 0]
    pull = np.abs(velocity @ m.scene.frame.thin_axis) / np.maximum(lengths_of(velocity), 1e-9 * m.unit)
    frame = m.scene.frame
    off = np.abs((held.centre - m.scene.centre) @ frame.axes.T) / np.maximum(0.5 * frame.extents, 0.02 * m.unit)
    towards = (held.centre - m.scene.centre) / m.unit
    length = np.maximum(lengths_of(m.arms), 1e-9 * m.unit)
    return {
        "handle_far": arm,
        "handle_parallel": np.abs(h.axes @ held.direction),
        "handle_pull": pull,
        "handle_off": np.delete(off, frame.thin).max(),
        "handle_opposite": np.einsum("hk,k->h", m.arms, towards) / length,
    }


def opening(m: MeasuredHypotheses) -> _Found:
    """Return what the motion is for: how much more of the child, and of what it covers, can be seen from outside."""
    scene = m.scene
    rng = np.random.default_rng(11)
    reach = 2.0 * scene.diagonal
    amounts = np.where(m.better == 0, 1.0, -1.0) * m.amounts()[:, _OPEN]
    starts, rays = _outward_rays(m.child.points[m.few], m.child.normals[m.few], 0.01 * m.unit, rng)
    turned = m.moved(starts, amounts), m.moved(starts + rays, amounts)
    blocked = _blocked(m, (scene.parent, *m.near_others), *turned, reach)
    before = _blocked(m, (scene.parent, *m.near_others), starts[None], (starts + rays)[None], reach)
    seen_before = 1.0 - float(before.mean())
    result: _Found = {"seen": seen_before, "seen_more": (1.0 - blocked.mean(axis=1)) - seen_before}
    nothing: _Found = {"covers": 0.0, "uncovers": 0.0}
    covered = m.few_parent
    if len(covered) == 0:
        return result | nothing
    starts, rays = _outward_rays(m.parent.points[covered], m.parent.normals[covered], 0.01 * m.unit, rng)
    free = ~_blocked(m, (scene.parent, *m.near_others), starts[None], (starts + rays)[None], reach)[0]
    starts, rays = starts[free], rays[free]
    if len(starts) == 0:
        return result | nothing
    rest = float(_blocked(m, (scene.child,), starts[None], (starts + rays)[None], reach).mean())
    then = _blocked(m, (scene.child,), m.moved(starts, -amounts), m.moved(starts + rays, -amounts), reach)
    return result | {"covers": rest, "uncovers": rest - then.mean(axis=1), "open_share": free.mean()}


def _outward_rays(
    points: FloatArray, normals: FloatArray, lift: float, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Four rays from each point into the half space that its normal shows, starts and unit directions, (4 n, 3)."""
    directions = unit(unit(rng.normal(size=(4, *points.shape))) + 1.05 * normals)
    starts = np.broadcast_to(points + lift * normals, directions.shape)
    return starts.reshape(-1, 3), directions.reshape(-1, 3)


def _blocked(
    m: MeasuredHypotheses, parts: Sequence[int], starts: FloatArray, ends: FloatArray, reach: float
) -> BoolArray:
    """Test whether rays from starts through ends (c, n, 3) meet any of the parts within `reach` [m], shape (c, n)."""
    result = np.zeros(starts.shape[:2], dtype=bool)
    flat, steps = starts.reshape(-1, 3), (ends - starts).reshape(-1, 3) * reach
    for part in parts:
        left = np.flatnonzero(~result.reshape(-1))
        if len(left):
            hit = np.isfinite(m.scene.cache.first_hits(part, flat[left], steps[left]))
            result.reshape(-1)[left[hit]] = True
    return result


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
    return {name: {key: m.of_each(value) for key, value in group(m).items()} for name, group in GROUPS.items()}


_MEASURING: tuple[Callable[[MeasuredHypotheses], _Found], ...] = (
    motion, contact_motion, sliding_surface, bearing, place, contact_place, child_shape, where, symmetry, axle,
    standing_in, mirror, hollow, around, gravity, handle, opening, neighbours,
)  # fmt: skip
GROUPS = {group.__name__: group for group in _MEASURING}
