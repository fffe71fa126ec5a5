"""The two small networks of the fitted choice, evaluated in numpy; what fitted them is not needed.

The first reads what is measured of all hypotheses of an edge at once. Each is embedded on its own; the mean and the
greatest of what all of them say is beside it when it is scored (deep sets, Zaheer et al. 2017). Several
networks that began elsewhere are averaged in log probability.

The second looks at points of both parts, as each joint moves them. For every hypothesis the points of an edge are put
into the frame of its line, so that what is learned holds whichever way an object stands: along the line, out to the
child's middle, aside. Each point is embedded on its own; mean and greatest of the child's points, of the parent's and
of the rest make the hypothesis (PointNet, Qi et al. 2017), which is then scored beside the others as in the first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import log_softmax

from kinematify.joints.candidate import FIXED, SLIDE, TURN
from kinematify.joints.features.frames import UP
from kinematify.joints.features.workspace import CARRIED, CHILD, OTHER, PARENT
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.workspace import Cloud
    from kinematify.robot.arrays import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Scale:
    """Scale of the columns as the network reads them: each spread evenly over [-1, 1], and which are missing."""

    knots: NDArray[Any]
    """Quantiles of each column, ascending and each once, then the last one repeated, shape (f, k)."""
    counts: IntArray
    """How many of them are a column's own; below two, nothing is read of it, shape (f,)."""
    missing: IntArray
    """Columns that have a second input, which shows where they are missing, shape (m,)."""

    def inputs(self, columns: NDArray[Any]) -> FloatArray:
        """Columns (n, f) as inputs (n, f + m); what is missing is 0, the middle."""
        spread = np.zeros(columns.shape)
        for k in np.flatnonzero(self.counts > 1):
            places = np.minimum(-1.0 + 2.0 * np.arange(self.knots.shape[1]) / (self.counts[k] - 1), 1.0)
            spread[:, k] = np.interp(columns[:, k], self.knots[k], places)
        absent = ~np.isfinite(columns)
        spread[absent] = 0.0
        return np.concatenate([spread, absent[:, self.missing]], axis=1)


@dataclass(frozen=True, kw_only=True, eq=False)
class SetNetwork:
    """Networks that score all hypotheses of an edge together.

    There are s of one shape, with n inputs, h hidden values, and g that are shared among hypotheses.
    """

    embed: FloatArray
    """Shape (s, n, h)."""
    embed_bias: FloatArray
    """Shape (s, h)."""
    share: FloatArray
    """Shape (s, h, g)."""
    share_bias: FloatArray
    """Shape (s, g)."""
    compare: FloatArray
    """Shape (s, h + 2 g, h)."""
    compare_bias: FloatArray
    """Shape (s, h)."""
    score: FloatArray
    """Shape (s, h)."""

    def compared(self, k: int, inputs: NDArray[Any]) -> NDArray[Any]:
        """Return what one of the networks makes of hypotheses with inputs (m, n) beside each other, shape (m, h)."""
        own = swish(inputs @ self.embed[k] + self.embed_bias[k])
        shared = own @ self.share[k] + self.share_bias[k]
        of_all = np.concatenate([shared.mean(axis=0), shared.max(axis=0)])
        beside = np.broadcast_to(of_all, (len(own), len(of_all)))
        return swish(np.concatenate([own, beside], axis=1) @ self.compare[k] + self.compare_bias[k])


@dataclass(frozen=True, kw_only=True, eq=False)
class Network(SetNetwork):
    """Network of the measurements of all hypotheses of an edge as inputs."""

    scale: Scale

    def log_probabilities(self, columns: NDArray[Any]) -> FloatArray:
        """Mean log probability of each hypothesis of an edge, from its columns (h, f), shape (h,)."""
        inputs = self.scale.inputs(columns)
        scores = [np.einsum("nh,h->n", self.compared(k, inputs), score) for k, score in enumerate(self.score)]
        return np.asarray(log_softmax(np.array(scores), axis=1).mean(axis=0))


def swish(values: FloatArray) -> FloatArray:
    """The activation x / (1 + exp(-x)) (Elfwing et al. 2018)."""
    result = np.exp(-values)
    result += 1.0
    return np.divide(values, result, out=result)


POINT_INPUTS, LINE_INPUTS = 20, 10
_TOUCHING, _NEAR = 0.02, 0.1  # of the child's diagonal
_FARTHEST = 2.5  # of the child's diagonal
_OFF_LINE = 0.05  # of the child's diagonal: from here on its middle says which way is out
_LEVEL = 0.2  # of a unit vector
_UPWARDS = 0.1  # of the child's diagonal: what is beside its parent goes by up
_FAST = 1.5  # of the child's diagonal
_AT_ONCE = 8  # hypotheses: what is said of their points fits the cache


@dataclass(frozen=True, kw_only=True, eq=False)
class PointNetwork(SetNetwork):
    """Network of points: 6 q of them, and `LINE_INPUTS` of the lines."""

    first: FloatArray
    """Shape (s, POINT_INPUTS, p)."""
    first_bias: FloatArray
    second: FloatArray
    """Shape (s, p, p)."""
    second_bias: FloatArray
    third: FloatArray
    """Shape (s, p, q)."""
    third_bias: FloatArray

    def log_probabilities(self, cloud: Cloud, hypotheses: Hypotheses) -> FloatArray:
        """Mean log probability of each hypothesis among those that move, one at least, shape (h,); -inf for fixed."""
        moving = np.flatnonzero(hypotheses.kinds != FIXED)
        points, lines = point_inputs(cloud, hypotheses, moving)
        groups = point_groups(cloud.labels)
        scores = []
        for k, score in enumerate(self.score):
            pooled = [self._pooled(k, points[i : i + _AT_ONCE], groups) for i in range(0, len(points), _AT_ONCE)]
            scores.append(self.compared(k, np.concatenate([np.concatenate(pooled), lines], axis=1)) @ score)
        found = np.full(len(hypotheses), -np.inf)
        found[moving] = log_softmax(np.array(scores, dtype=np.float64), axis=1).mean(axis=0)
        return found

    def _pooled(self, k: int, points: NDArray[Any], groups: list[IntArray]) -> NDArray[Any]:
        """Mean and greatest of what one of the networks says of the points of each group, shape (n, 6 q)."""
        said = swish(points.reshape(-1, points.shape[2]) @ self.first[k] + self.first_bias[k])
        said = swish(said @ self.second[k] + self.second_bias[k])
        said = (said @ self.third[k] + self.third_bias[k]).reshape(*points.shape[:2], -1)
        pooled = []
        for rows in groups:
            some = said[:, rows]
            nothing = np.zeros((len(said), said.shape[2]), dtype=said.dtype)
            pooled += [some.mean(axis=1), some.max(axis=1)] if len(rows) else [nothing, nothing]
        return np.concatenate(pooled, axis=1)


def point_groups(labels: IntArray) -> list[IntArray]:
    """Positions of the child's points, of the parent's, and of all others."""
    child, parent = labels == CHILD, labels == PARENT
    return [np.flatnonzero(rows) for rows in (child, parent, ~(child | parent))]


def point_inputs(
    cloud: Cloud, hypotheses: Hypotheses, rows: IntArray
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return what the network reads of every point as some hypotheses move it, and of their lines.

    Lengths are in diagonals of the child. Axes are turned away from the parent first, so that nothing depends on their
    sign; nor does anything on the heading of the object, unless both parts have their middle on one upright line, where
    no direction across it is any better than another.

    Args:
        cloud: Points of the edge.
        hypotheses: All joints of the edge.
        rows: Those that are asked about, none of which is fixed, shape (n,).

    Returns:
        Shapes (n, m, POINT_INPUTS) and (n, LINE_INPUTS).
    """
    axes, kinds = hypotheses.axes[rows], hypotheses.kinds[rows]
    away = (cloud.centre - cloud.parent_centre) / cloud.unit
    axes = axes * np.where(axes @ (away + _UPWARDS * UP) < 0.0, -1.0, 1.0)[:, None]
    turns = (kinds == TURN)[:, None]
    pivots = np.where(turns, hypotheses.pivots[rows], cloud.centre)  # a slide has no line of its own
    arms = _across(cloud.centre - pivots, axes) / cloud.unit
    out = _outwards(away, axes, arms)
    aside = crossed(axes, out)
    offset = (cloud.points[None] - pivots[:, None]) / cloud.unit
    along = np.einsum("nmk,nk->nm", cloud.points[None] - cloud.centre, axes) / cloud.unit
    outwards, sidewards = (np.einsum("nmk,nk->nm", offset, direction) for direction in (out, aside))
    radius = np.hypot(outwards, sidewards)
    normal_along, normal_out, normal_aside = (direction @ cloud.normals.T for direction in (axes, out, aside))
    length = np.maximum(radius, 1e-6)
    radial = (normal_out * outwards + normal_aside * sidewards) / length
    tangential = np.abs(normal_aside * outwards - normal_out * sidewards) / length
    of_hypotheses = [
        along,
        np.abs(along),
        outwards,
        np.abs(sidewards),
        radius,
        normal_along,
        np.abs(normal_along),
        radial,
        tangential,
        np.where(turns, tangential * np.minimum(radius, _FAST), np.abs(normal_along)),  # speed along the normal
        normal_out,
        normal_aside * np.sign(sidewards),
    ]
    of_all = [
        (cloud.points[:, 2] - cloud.centre[2]) / cloud.unit,
        cloud.normals[:, 2],
        np.exp(-cloud.gaps / _TOUCHING),
        np.exp(-cloud.gaps / _NEAR),
        *(cloud.labels == label for label in (CHILD, PARENT, OTHER, CARRIED)),
    ]
    of_points = np.stack([*of_hypotheses, *(np.broadcast_to(value, radius.shape) for value in of_all)], axis=2)
    of_lines = np.stack(
        [
            turns[:, 0],
            kinds == SLIDE,
            axes @ UP,
            np.abs(axes @ UP),
            axes @ away,
            lengths_of(arms),
            out @ UP,
            *np.broadcast_to(np.array([*cloud.sizes, away[2]])[:, None], (3, len(rows))),
        ],
        axis=1,
    )
    return _bounded(of_points), _bounded(of_lines)


def _bounded(values: FloatArray) -> NDArray[np.float32]:
    return np.clip(values, -_FARTHEST, _FARTHEST).astype(np.float32)


def _across(vectors: FloatArray, axes: FloatArray) -> FloatArray:
    """The parts of vectors (n, 3) across unit axes (n, 3)."""
    return np.asarray(vectors - np.einsum("nk,nk->n", vectors, axes)[:, None] * axes)


def _outwards(away: FloatArray, axes: FloatArray, arms: FloatArray) -> FloatArray:
    """Unit directions across each axis: to the child's middle, else up, else away from the parent, shape (n, 3)."""
    up = _across(np.broadcast_to(UP, axes.shape), axes)
    apart = _across(np.broadcast_to(away, axes.shape), axes)
    any_across = crossed(axes, np.where(np.abs(axes[:, :1]) < 0.6, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]))
    found = any_across
    for direction, least in ((apart, 1e-3), (up, _LEVEL), (arms, _OFF_LINE)):
        found = np.where(lengths_of(direction)[:, None] > least, direction, found)
    return found / lengths_of(found)[:, None]
