"""The fit of the edges of the tree: spanning trees of contact graphs, of which the true one is to be the likeliest."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import minimize

from benchmarks.fit.examples import content_key
from kinematify.contact.build_graph import build_contact_graph
from kinematify.geometry.part_stats import assembly_stats
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_bearings
from kinematify.joints.choice.edges import MEASUREMENTS, EdgeWeights, edge_measurements, edge_probabilities
from kinematify.joints.features.pins import find_pins
from kinematify.topology.search import maximum_spanning_edges

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.assembly.part import Assembly
    from kinematify.assembly.truth import GroundTruth
    from kinematify.config import Config
    from kinematify.robot.arrays import FloatArray, IntArray

_FACTS = ("object", "category", "origin", "source", "fits", "parents")  # of an example, beside its arrays
_PENALTY = 0.02  # of the squared weights, beside the mean surprise of a tree


@dataclass(frozen=True, kw_only=True, eq=False)
class TreeExample:
    """The contact graph of one object and its true tree."""

    object: str
    category: str
    origin: str
    source: str
    fits: bool
    """As of `examples.Example`."""
    measured: FloatArray
    """Of every edge, shape (m, k)."""
    pairs: IntArray
    """Ends of every edge, shape (m, 2)."""
    parents: tuple[int, ...]
    """True parent of every part, -1 for the root."""

    @property
    def true(self) -> IntArray:
        """1 for the edges of the true tree, shape (m,)."""
        edges = {(min(edge), max(edge)) for edge in enumerate(self.parents) if edge[1] >= 0}
        return np.array([(int(a), int(b)) in edges for a, b in self.pairs], dtype=np.int64)


def tree_example(
    assembly: Assembly, truth: GroundTruth, config: Config, *, category: str, origin: str, source: str, fits: bool
) -> TreeExample:
    """Measure the contacts of an object; arguments as of `examples.examples_of`."""
    surfaces = part_surfaces(assembly, config=config.surface)
    graph = build_contact_graph(assembly, surfaces, config=config.contact, seed=config.seed)
    bearings = fit_bearings(assembly, surfaces, graph, config=config.bearing, seed=config.seed)
    stats = assembly_stats(assembly)
    return TreeExample(
        object=assembly.source,
        category=category,
        origin=origin,
        source=source,
        fits=fits,
        measured=edge_measurements(graph, stats, bearings, find_pins(assembly, graph, stats, bearings, config)),
        pairs=np.array(list(graph.by_pair), dtype=np.int64).reshape(-1, 2),
        parents=tuple(truth.parents),
    )


def fit_edges(examples: Sequence[TreeExample], provenance: Mapping[str, Any]) -> EdgeWeights:
    """Weights under which the true trees are likeliest, by L-BFGS; each category weighs as the root of its objects.

    Objects with one possible tree teach nothing, nor do those of which a true edge joins parts that are not near;
    without any other all weights are 0.
    """
    usable = [item for item in examples if len(item.pairs) >= len(item.parents) == int(item.true.sum()) + 1]
    if not usable:
        flat = np.zeros(len(MEASUREMENTS))
        return EdgeWeights(weights=flat, offset=0.0, provenance=provenance)
    values = np.concatenate([item.measured for item in usable])
    mean, scale = values.mean(axis=0), values.std(axis=0) + 1e-9
    standard = [(item.measured - mean) / scale for item in usable]
    true = [item.true for item in usable]
    counts = Counter(item.category for item in usable)
    shares = np.array([counts[item.category] ** -0.5 for item in usable])
    shares /= shares.sum()

    def log_loss(weights: FloatArray) -> tuple[float, FloatArray]:
        """Mean of -log P(true tree) with the penalty, and its gradient."""
        total = _PENALTY * float(weights @ weights)
        slope = 2.0 * _PENALTY * weights
        for item, columns, right, share in zip(usable, standard, true, shares, strict=True):
            scores = columns @ weights
            likely, log_z = edge_probabilities([(int(a), int(b)) for a, b in item.pairs], scores, len(item.parents))
            total += share * (log_z - float(scores[right > 0].sum()))
            slope = slope + share * ((likely - right) @ columns)
        return total, slope

    found = minimize(log_loss, np.zeros(values.shape[1]), jac=True, method="L-BFGS-B")
    return EdgeWeights(
        weights=found.x / scale,
        # Qualities saturate; those of true edges are not to, or what competes with them looks as good.
        offset=-float(values[np.concatenate(true) > 0].mean(axis=0) @ (found.x / scale)),
        provenance={**provenance, "objects": len(usable), "recipe": edge_recipe_key()},
    )


def edge_recipe_key() -> str:
    """Hash of how the weights are fitted."""
    return content_key(MEASUREMENTS, _PENALTY)


def missed_edges(examples: Sequence[TreeExample], weights: EdgeWeights) -> int:
    """True edges that the likeliest trees lack, whatever their root."""
    return sum(_missed(example, weights.scores(example.measured)) for example in examples)


def _missed(example: TreeExample, scores: FloatArray) -> int:
    """The same of one object."""
    n = len(example.parents)
    weights = {(int(a), int(b)): float(score) for (a, b), score in zip(example.pairs, scores, strict=True)}
    found = maximum_spanning_edges(weights, n) if weights else ()
    true = {(min(edge), max(edge)) for edge in enumerate(example.parents) if edge[1] >= 0}
    return len(true - set(found))


# ---- files ---------------------------------------------------------------------------------------------------------


def write_edge_weights(weights: EdgeWeights, path: Path) -> None:
    """Write the file that `choice.edges.shipped_edge_weights` reads."""
    stored = {
        "weights": {name: round(float(value), 6) for name, value in zip(MEASUREMENTS, weights.weights, strict=True)},
        "offset": round(weights.offset, 6),
        "provenance": dict(weights.provenance),
    }
    path.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")


def write_tree_examples(path: Path, examples: Sequence[TreeExample]) -> None:
    """Write the example of one object, if there is one; the file appears whole or not at all."""
    arrays: dict[str, Any] = {}
    facts = []
    for k, example in enumerate(examples):
        arrays |= {f"measured_{k}": example.measured, f"pairs_{k}": example.pairs}
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
                measured=stored[f"measured_{k}"],
                pairs=stored[f"pairs_{k}"],
            )
            for k, facts in enumerate(json.loads(str(stored["facts"])))
        ]
