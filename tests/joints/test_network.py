"""The network of the choice: what it reads, and that arrays say what the fitted layers said."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from benchmarks.fit.network import fit_network
from kinematify.joints.choice.point_network import Network

EDGES, HYPOTHESES, COLUMNS = 800, 5, 4


def edges_where_the_largest_is_right() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Columns, of which the second tells the right hypothesis by its rank among its rivals; starts; target."""
    rng = np.random.default_rng(0)
    columns = rng.normal(size=(EDGES * HYPOTHESES, COLUMNS)).astype(np.float32)
    columns[:, 1] += np.repeat(rng.normal(scale=3.0, size=EDGES), HYPOTHESES)  # alone, its value says little
    columns[rng.random(len(columns)) < 0.2, 2] = np.nan
    starts = np.arange(0, len(columns) + 1, HYPOTHESES)
    best = columns[:, 1].reshape(EDGES, HYPOTHESES).argmax(axis=1)
    target = np.zeros(len(columns))
    target[starts[:-1] + best] = 1.0
    return columns, starts, target


def fitted(columns: np.ndarray, starts: np.ndarray, target: np.ndarray) -> Network:
    """One network that may see everything."""
    return fit_network(columns, starts, target, np.ones(EDGES), np.zeros(COLUMNS, dtype=bool), seeds=(0,))


def test_it_learns_what_only_the_rivals_tell() -> None:
    columns, starts, target = edges_where_the_largest_is_right()
    network = fitted(columns, starts, target)
    right = [np.argmax(network.log_probabilities(columns[a:b])) == np.argmax(target[a:b]) for a, b in pairwise(starts)]
    assert np.mean(right) > 0.6, "by chance 0.2"


def test_probabilities_sum_to_one_and_follow_the_hypotheses_in_any_order() -> None:
    columns, starts, target = edges_where_the_largest_is_right()
    network = fitted(columns, starts, target)
    logs = network.log_probabilities(columns[:HYPOTHESES])
    assert np.exp(logs).sum() == pytest.approx(1.0)
    order = np.array([3, 1, 4, 0, 2])
    np.testing.assert_allclose(network.log_probabilities(columns[:HYPOTHESES][order]), logs[order])
