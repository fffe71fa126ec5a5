"""The fits of the edges and of the base link of the tree: the true ones are to be the likeliest of a contact graph."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import minimize
from scipy.special import logsumexp

from benchmarks.fit.examples import content_key
from kinematify.contact.alike import AlikeParts, find_clusters
from kinematify.contact.build_graph import build_contact_graph
from kinematify.contact.graph import pair
from kinematify.geometry.part_stats import assembly_stats
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_bearings
from kinematify.joints.choice.edges import MEASUREMENTS, LinearWeights, edge_measurements, edge_probabilities
from kinematify.joints.features.pins import find_pins
from kinematify.topology.base_link import COLUMNS, base_columns
from kinematify.topology.search import maximum_spanning_edges

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.assembly.part import Assembly
    from kinematify.assembly.truth import GroundTruth
    from kinematify.config import Config
    from kinematify.contact.graph import Pair
    from kinematify.robot.arrays import FloatArray, IntArray

_FACTS = ("object", "category", "origin", "source", "fits", "parents")  # of an example, beside its arrays
_ARRAYS = ("measured", "pairs", "standing")
_PENALTY = 0.02  # of the squared weights, beside the mean surprise of a tree
_BASE_PENALTY = 0.005


@dataclass(frozen=True, kw_only=True, eq=False)
class TreeExample:
    """The contact graph of one object, its true tree, and what speaks for each part as its base link."""

    object: str
    category: str
    origin: str
    source: str
    fits: bool
    """As of `examples.Example`."""
    measured: FloatArray
    """Of every edge, shape (m, k)."""
    pairs: IntArray
    """Ends of every edge, shape (m, 2); none where the object teaches the base link alone."""
    standing: FloatArray
    """Of every part, the true tree given, shape (n, c)."""
    parents: tuple[int, ...]
    """True parent of every part, -1 for the root."""

    @property
    def true(self) -> IntArray:
        """1 for the edges of the true tree, shape (m,)."""
        edges = _true_edges(self.parents)
        return np.array([(int(a), int(b)) in edges for a, b in self.pairs], dtype=np.int64)


def _true_edges(parents: Sequence[int]) -> set[Pair]:
    return {pair(child, parent) for child, parent in enumerate(parents) if parent >= 0}


def tree_example(
    assembly: Assembly,
    truth: GroundTruth,
    config: Config,
    *,
    category: str,
    origin: str,
    source: str,
    fits: bool,
    contacts: bool = True,
) -> TreeExample:
    """Measure an object, `contacts` too or the parts alone; other arguments as of `examples.examples_of`."""
    surfaces = part_surfaces(assembly, config=config.surface)
    stats = assembly_stats(assembly)
    measured, pairs = np.empty((0, len(MEASUREMENTS))), np.empty((0, 2), dtype=np.int64)
    if contacts:
        graph = build_contact_graph(assembly, surfaces, config=config.contact, seed=config.seed)
        bearings = fit_bearings(assembly, surfaces, graph, config=config.bearing, seed=config.seed)
        measured = edge_measurements(graph, stats, bearings, find_pins(assembly, graph, stats, bearings, config))
        pairs = np.array(list(graph.by_pair), dtype=np.int64).reshape(-1, 2)
        alike = graph.alike
    else:
        alike = AlikeParts(len(stats), find_clusters(assembly, surfaces, config=config.contact, seed=config.seed))
    return TreeExample(
        object=assembly.source,
        category=category,
        origin=origin,
        source=source,
        fits=fits,
        measured=measured,
        pairs=pairs,
        standing=base_columns(_true_edges(truth.parents), stats, alike.kind),
        parents=tuple(truth.parents),
    )


def fit_edges(examples: Sequence[TreeExample], provenance: Mapping[str, Any]) -> LinearWeights:
    """Weights under which the true trees are likeliest, by L-BFGS; each category weighs as the root of its objects.

    Objects with one possible tree teach nothing, nor do those of which a true edge joins parts that are not near;
    without any other all weights are 0.
    """
    usable = [item for item in examples if len(item.pairs) >= len(item.parents) == int(item.true.sum()) + 1]
    if not usable:
        flat = np.zeros(len(MEASUREMENTS))
        return LinearWeights(weights=flat, offset=0.0, provenance=provenance)
    true = [item.true for item in usable]
    trees = [([(int(a), int(b)) for a, b in item.pairs], len(item.parents)) for item in usable]

    def likelihood(item: int, scores: FloatArray) -> tuple[FloatArray, float]:
        pairs, n = trees[item]
        return edge_probabilities(pairs, scores, n)

    columns = [item.measured for item in usable]
    weights = _fitted(columns, true, [item.category for item in usable], likelihood, _PENALTY)
    return LinearWeights(
        weights=weights,
        # Qualities saturate; those of true edges are not to, or what competes with them looks as good.
        offset=-float(np.concatenate(columns)[np.concatenate(true) > 0].mean(axis=0) @ weights),
        provenance={**provenance, "objects": len(usable), "recipe": edge_recipe_key()},
    )


def fit_base(examples: Sequence[TreeExample], provenance: Mapping[str, Any]) -> LinearWeights:
    """Weights under which the true base links are likeliest, fitted as those of edges."""
    true = [np.array(item.parents) < 0 for item in examples]

    def likelihood(_: int, scores: FloatArray) -> tuple[FloatArray, float]:
        log_z = float(logsumexp(scores))
        return np.exp(scores - log_z), log_z

    columns, categories = [item.standing for item in examples], [item.category for item in examples]
    weights = _fitted(columns, true, categories, likelihood, _BASE_PENALTY)
    facts = {**provenance, "objects": len(examples), "recipe": base_recipe_key()}
    return LinearWeights(weights=weights, offset=0.0, provenance=facts)


def _fitted(
    columns: Sequence[FloatArray],
    true: Sequence[NDArray[Any]],
    categories: Sequence[str],
    likelihood: Callable[[int, FloatArray], tuple[FloatArray, float]],
    penalty: float,
) -> FloatArray:
    """Weights of columns under which what is true of every item is likeliest.

    Args:
        columns: Of the edges or parts of every item.
        true: Which of them are true.
        categories: Of the items; each weighs as the root of its number.
        likelihood: Probability of each edge or part, and ``log Z``, by the number of the item and scores.
        penalty: Of the squared weights.
    """
    values = np.concatenate(columns)
    mean, scale = values.mean(axis=0), values.std(axis=0) + 1e-9
    standard = [(item - mean) / scale for item in columns]
    counts = Counter(categories)
    shares = np.array([counts[item] ** -0.5 for item in categories])
    shares /= shares.sum()

    def log_loss(weights: FloatArray) -> tuple[float, FloatArray]:
        """Mean of -log P(what is true) with the penalty, and its gradient."""
        total = penalty * float(weights @ weights)
        slope = 2.0 * penalty * weights
        for item, (measured, right, share) in enumerate(zip(standard, true, shares, strict=True)):
            scores = measured @ weights
            likely, log_z = likelihood(item, scores)
            total += share * (log_z - float(scores[right > 0].sum()))
            slope = slope + share * ((likely - right) @ measured)
        return total, slope

    found = minimize(log_loss, np.zeros(values.shape[1]), jac=True, method="L-BFGS-B")
    return np.asarray(found.x / scale)


def base_recipe_key() -> str:
    """Hash of how the weights of base links are fitted."""
    return content_key(COLUMNS, _BASE_PENALTY)


def edge_recipe_key() -> str:
    """Hash of how the weights are fitted."""
    return content_key(MEASUREMENTS, _PENALTY)


def missed_edges(examples: Sequence[TreeExample], weights: LinearWeights) -> int:
    """True edges that the likeliest trees lack, whatever their root."""
    found = 0
    for example in examples:
        scores = weights.scores(example.measured)
        likely = {(int(a), int(b)): float(score) for (a, b), score in zip(example.pairs, scores, strict=True)}
        found += len(_true_edges(example.parents) - set(maximum_spanning_edges(likely, len(example.parents))))
    return found


def wrong_bases(examples: Sequence[TreeExample], weights: LinearWeights) -> int:
    """Objects whose likeliest base link, the true tree given, is not theirs."""
    return sum(example.parents[int(weights.scores(example.standing).argmax())] >= 0 for example in examples)


# ---- files ---------------------------------------------------------------------------------------------------------


def write_weights(weights: LinearWeights, columns: Sequence[str], path: Path) -> None:
    """Write the file that `choice.edges.shipped_weights` reads."""
    stored = {
        "weights": {name: round(float(value), 6) for name, value in zip(columns, weights.weights, strict=True)},
        "offset": round(weights.offset, 6),
        "provenance": dict(weights.provenance),
    }
    path.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")


def write_tree_examples(path: Path, examples: Sequence[TreeExample]) -> None:
    """Write the example of one object, if there is one; the file appears whole or not at all."""
    arrays: dict[str, Any] = {}
    facts = []
    for k, example in enumerate(examples):
        arrays |= {f"{name}_{k}": getattr(example, name) for name in _ARRAYS}
        facts.append({name: getattr(example, name) for name in _FACTS})
    aside = path.with_suffix(".part.npz")
    np.savez_compressed(aside, facts=json.dumps(facts), **arrays)
    aside.replace(path)


def read_tree_examples(path: Path) -> list[TreeExample]:
    """Read what `write_tree_examples` wrote."""
    with np.load(path) as stored:
        return [
            TreeExample(
                **{**facts, "parents": tuple(facts["parents"])},
                **{name: stored[f"{name}_{k}"] for name in _ARRAYS},
            )
            for k, facts in enumerate(json.loads(str(stored["facts"])))
        ]
