"""The fitted choice: one score for every hypothesis of an edge, from what is measured of it.

Gradient-boosted trees (Friedman 2001), a small network that reads the same and one that looks at points of both parts
(`point_network.py`) were fitted listwise: with scores s_i of the hypotheses of an edge, the probability
of hypothesis i is exp(s_i) / sum_j exp(s_j), and the fit maximised the likelihood of the right ones. So type, line and
confidence come out at once. Each errs where the others do not; the mean of their log probabilities is what counts.
Evaluated in numpy; what fitted them is not needed.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import log_softmax, softmax

from kinematify.errors import EnvironmentFault
from kinematify.joints.candidate import FIXED, SLIDE, TURN
from kinematify.joints.choice.point_network import Network, PointNetwork, Scale

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from importlib.resources.abc import Traversable

    from numpy.typing import NDArray

    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.workspace import Cloud
    from kinematify.robot.arrays import FloatArray, IntArray

WEIGHTS = "weights.npz"
RIGID_WEIGHTS = "rigid.npz"
OPENING_WEIGHTS = "opening.npz"
TURNING_WEIGHTS = "turning.npz"
PIECES_WEIGHTS = "pieces.npz"
MOVING_WEIGHTS = "moving.npz"
_SCORED = {
    WEIGHTS: "the choice of joints",
    RIGID_WEIGHTS: "what is fixed",
    OPENING_WEIGHTS: "the opening direction",
    TURNING_WEIGHTS: "what goes round",
    PIECES_WEIGHTS: "which pieces are one part",
    MOVING_WEIGHTS: "which pieces move together",
}
NETWORK, POINTS = "network_", "points_"
"""Before the names of the arrays of either network in a file of weights."""
POINTS_SHARE = 0.5
"""How much the points count in the mean log probability of what moves; trees and network share the rest."""
_ARRAYS = ("base", "feature", "threshold", "missing_left", "left", "right", "value")
FORMAT = 2
"""Raised where the meaning of the file changes."""

SUMMARIES = (
    "enter_parent_1", "enter_parent_2", "enter_others_2", "enter_back_2", "stop_parent_2", "kept_large",
    "kept_small", "bearing_score", "contact_radius", "gap_large",
)  # fmt: skip
"""Measurements of which every hypothesis also has the best and worst among all turns and among all slides."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Scorer:
    """Trees in arrays, with the names of what they read."""

    measurements: tuple[str, ...]
    """Names of the measurements, in the order of the columns."""
    base: FloatArray
    """Coefficients of `rules_score`, `rules_odds` and of being fixed, shape (3,)."""
    feature: IntArray
    """Column that each node asks for, -1 in leaves, shape (trees, nodes)."""
    threshold: FloatArray
    """Values up to this go left, shape (trees, nodes)."""
    missing_left: IntArray
    """1 where a missing value goes left, shape (trees, nodes)."""
    left: IntArray
    right: IntArray
    value: FloatArray
    """Of leaves, shape (trees, nodes)."""
    temperature: float
    """Scores are divided by it, so that probabilities hold on held-out objects."""
    provenance: Mapping[str, Any]
    network: Network | None = None
    """Asked beside the trees which hypothesis is right; without it, trees answer alone."""
    points: PointNetwork | None = None
    """Asked which of those that move is right; None as above."""

    def probabilities(self, hypotheses: Hypotheses, measured: Mapping[str, FloatArray], cloud: Cloud) -> FloatArray:
        """Return how likely each hypothesis of an edge is the right one.

        Args:
            hypotheses: Of the edge.
            measured: Name -> values, shape (h,) each; NaN or absent where a measurement does not apply.
            cloud: Points of the edge.

        Returns:
            Shape (h,), sum 1.
        """
        kinds = hypotheses.kinds
        columns = stacked(kinds, measured, self.measurements)
        logs = log_softmax((base_columns(kinds, measured) @ self.base + self.sums(columns)) / self.temperature)
        if self.network is not None:
            logs = 0.5 * (logs + self.network.log_probabilities(columns))
        likely = np.asarray(softmax(logs))
        moving = kinds != FIXED
        if self.points is None or not moving.any():
            return likely
        seen = self.points.log_probabilities(cloud, hypotheses)[moving]
        shared = softmax((1.0 - POINTS_SHARE) * logs[moving] + POINTS_SHARE * seen)
        likely[moving] = likely[moving].sum() * shared
        return likely

    def sums(self, columns: NDArray[Any]) -> FloatArray:
        """Return what the trees say of each row of columns (n, f), shape (n,)."""
        trees = np.arange(len(self.feature))[None]
        node = np.zeros((len(columns), len(self.feature)), dtype=np.int64)
        rows = np.arange(len(columns))[:, None]
        while True:
            feature = self.feature[trees, node]
            inner = feature >= 0
            if not inner.any():
                return np.asarray(self.value[trees, node].sum(axis=1))
            asked = columns[rows, np.maximum(feature, 0)]
            left = np.where(np.isnan(asked), self.missing_left[trees, node] > 0, asked <= self.threshold[trees, node])
            following = np.where(left, self.left[trees, node], self.right[trees, node])
            node = np.where(inner, following, node)


def base_columns(kinds: IntArray, measured: Mapping[str, FloatArray]) -> FloatArray:
    """Return the start of the trees: the score within the kind, the odds of the kind, being fixed, shape (h, 3)."""
    score = np.nan_to_num(np.clip(measured["rules_score"], -6.0, 0.0))
    return np.stack([score, np.clip(measured["rules_odds"], -6.0, 6.0), kinds == FIXED], axis=1)


def stacked(kinds: IntArray, measured: Mapping[str, FloatArray], names: tuple[str, ...]) -> NDArray[Any]:
    """Columns that the trees read: kinds, measurements, each of them beside its rivals, and the summaries, (h, f)."""
    values = columns_of(measured, names, len(kinds))
    beside = np.full_like(values, np.nan)
    summaries = []
    chosen = [names.index(name) for name in SUMMARIES]
    for kind in (TURN, SLIDE):
        rows = np.flatnonzero(kinds == kind)
        known = values[rows]
        low, high = _extreme(known, np.fmin), _extreme(known, np.fmax)
        beside[rows] = (known - low) / np.maximum(high - low, np.float32(1e-6))
        summaries += [np.stack([high[chosen], low[chosen]], axis=1).reshape(-1)]
    every = np.broadcast_to(np.concatenate(summaries), (len(kinds), 4 * len(SUMMARIES)))
    kind_columns = np.stack([kinds == kind for kind in (FIXED, TURN, SLIDE)], axis=1).astype(np.float32)
    return np.concatenate([kind_columns, values, beside, every], axis=1)


def columns_of(measured: Mapping[str, FloatArray], names: Sequence[str], count: int) -> NDArray[Any]:
    """Named measurements (count,) as columns (count, n), in single precision as they were fitted; NaN if missing."""
    missing = np.full(count, np.nan)
    values: NDArray[Any] = np.stack([measured.get(name, missing) for name in names], axis=1).astype(np.float32)
    values[~np.isfinite(values)] = np.nan
    return values


def _extreme(values: NDArray[Any], pick: np.ufunc) -> NDArray[Any]:
    """Smallest or largest known value of each column; missing where none is known."""
    if len(values) == 0:
        return np.full(values.shape[1], np.nan, dtype=np.float32)
    return np.asarray(pick.reduce(values, axis=0))


@cache
def shipped_scorer(name: str = WEIGHTS) -> Scorer:
    """A scorer that comes with the package, by its file; the one of hypotheses unless another is named.

    Raises:
        EnvironmentFault: Its file is missing, damaged or of another version.
    """
    return read_scorer(files("kinematify.joints.choice") / name)


def read_scorer(path: Traversable) -> Scorer:
    """Read what the fit wrote (`benchmarks/fit/trees.py`).

    Raises:
        EnvironmentFault: The file is missing, damaged or of another version.
    """
    name = path.name
    remedy = "Install kinematify again, or write the weights with 'python -m benchmarks.fit'."
    try:
        with path.open("rb") as file, np.load(file) as stored:
            facts = json.loads(str(stored["facts"]))
            arrays = {key: stored[key] for key in _ARRAYS}
            layers, points = _stored(stored, NETWORK), _stored(stored, POINTS)
            network = _network(layers) if layers else None
    except (OSError, ValueError, KeyError) as error:
        raise EnvironmentFault(f"The weights of {_SCORED[name]} ({name}) cannot be read. {remedy}") from error
    if facts.get("format") != FORMAT:
        raise EnvironmentFault(
            f"The weights of {_SCORED[name]} ({name}) have format {facts.get('format')}; this version of "
            f"kinematify reads format {FORMAT}. {remedy}"
        )
    return Scorer(
        measurements=tuple(facts["measurements"]),
        temperature=float(facts["temperature"]),
        provenance=facts["provenance"],
        network=network,
        points=PointNetwork(**_single(points)) if points else None,
        **arrays,
    )


def _stored(stored: Mapping[str, NDArray[Any]], prefix: str) -> dict[str, NDArray[Any]]:
    """The arrays of one of the networks of a file of weights, none where it has none."""
    return {key.removeprefix(prefix): stored[key] for key in stored if key.startswith(prefix)}


def _network(arrays: dict[str, NDArray[Any]]) -> Network:
    scale = Scale(**{field.name: arrays.pop(field.name) for field in fields(Scale)})
    return Network(scale=scale, **_single(arrays))


def _single(layers: Mapping[str, NDArray[Any]]) -> dict[str, Any]:
    """Layers in single precision."""
    return {name: layer.astype(np.float32) for name, layer in layers.items()}
