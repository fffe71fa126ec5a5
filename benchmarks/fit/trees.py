"""The fit itself: gradient-boosted trees with a listwise objective, written as arrays that need no LightGBM."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import minimize

from benchmarks.fit.examples import content_key
from benchmarks.fit.network import PARAMETERS as NETWORK_PARAMETERS
from benchmarks.fit.network import fit_network
from benchmarks.fit.point_network import PARAMETERS as POINT_PARAMETERS
from benchmarks.fit.point_network import fit_points
from kinematify.errors import InputError
from kinematify.joints.choice.opening import rigid_columns, side_columns
from kinematify.joints.choice.scorer import (
    FORMAT,
    NETWORK,
    POINTS,
    SUMMARIES,
    Scorer,
    base_columns,
    columns_of,
    stacked,
)
from kinematify.joints.features.columns import CUES, VERDICTS
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from benchmarks.fit.examples import Example
    from kinematify.robot.arrays import FloatArray, IntArray

_PARAMETERS = {
    "learning_rate": 0.08,
    "num_leaves": 7,
    "min_data_in_leaf": 50,
    "min_sum_hessian_in_leaf": 0.5,
    "lambda_l2": 5.0,
    "feature_fraction": 0.1,
    "bagging_fraction": 0.7,
    "bagging_freq": 1,
    "max_bin": 63,
    "num_threads": 1,
    "deterministic": True,
    "verbosity": -1,
}
_ROUNDS = 220
_RIGIDITY = {"learning_rate": 0.06, "min_data_in_leaf": 30, "min_sum_hessian_in_leaf": 1e-3}
_RIGIDITY_ROUNDS = 250
_OPENING = {"learning_rate": 0.05, "num_leaves": 5, "min_data_in_leaf": 15, "feature_fraction": 0.2}
_OPENING |= {"min_sum_hessian_in_leaf": 1e-3}
_OPENING_ROUNDS = 150
_TURNING = {"learning_rate": 0.05, "min_data_in_leaf": 20, "feature_fraction": 0.15, "min_sum_hessian_in_leaf": 1e-3}
_TURNING_ROUNDS = 120
_PROPOSED = 0.2  # how right the best hypothesis must be, for its measurements to be those of the true joint
_FIXED_SHARE = 0.5
"""Weight of all fixed parts together beside all others."""
_SHARE = {"family": 0.6, "programmed": 0.6, "composed": 0.05}
"""Weight of an example of such an origin beside one of a real object."""


@dataclass(frozen=True, kw_only=True)
class Seeds:
    """How many of each are fitted, and from which seeds."""

    trees: Sequence[int] = (0,)
    networks: Sequence[int] = (0,)
    points: Sequence[int] = (0,)


def fit_scorer(examples: Sequence[Example], *, seeds: Seeds, provenance: Mapping[str, Any]) -> Scorer:
    """Fit the scorer to examples: trees, networks and networks that look at points, of several seeds each.

    Raises:
        InputError: There is nothing to fit to.
        EnvironmentFault: LightGBM is not installed.
    """
    usable = [example for example in examples if example.right.sum() > 1e-3]
    if not usable:
        raise InputError(
            "There is no joint to fit to, or none is left where a category is left out. Give more objects: folders of "
            "objects whose licence allows it, --rounds or --composed."
        )
    names = tuple(sorted({name for example in usable for name in example.measured}))
    columns = np.concatenate([stacked(example.kinds, example.measured, names) for example in usable])
    starts = np.cumsum([0, *(len(example.kinds) for example in usable)])
    target = np.concatenate([example.target for example in usable])
    of_edges = edge_weights(usable)
    weights = of_edges[np.repeat(np.arange(len(usable)), np.diff(starts))]
    begun = np.concatenate([base_columns(example.kinds, example.measured) for example in usable])
    base = _fit_base(begun, starts, target, weights)
    trees = [_boost(columns, begun @ base, starts, target, weights, seed=seed) for seed in seeds.trees]
    of_cues = {name for example in usable for name in example.groups[VERDICTS]}
    verdicts = np.zeros(columns.shape[1], dtype=bool)
    hidden = 3 + np.array([k for k, name in enumerate(names) if name in of_cues])
    verdicts[[*hidden, *(hidden + len(names))]] = True
    return Scorer(
        measurements=names,
        base=base,
        temperature=1.0,
        provenance=dict(provenance),
        network=fit_network(columns, starts, target, of_edges, verdicts, seeds=seeds.networks),
        points=fit_points(usable, of_edges, seeds=seeds.points),
        **_arrays(trees),
    )


def fit_rigidity(examples: Sequence[Example], *, seeds: Sequence[int], provenance: Mapping[str, Any]) -> Scorer:
    """Fit what tells fixed parts from others; trees of several seeds are averaged.

    Raises:
        EnvironmentFault: LightGBM is not installed.
    """
    names = tuple(sorted({name for example in examples for name in example.measured}))
    columns = np.stack([rigid_columns(example.kinds, example.measured, names) for example in examples])
    fixed = np.array([is_fixed(example) for example in examples])
    weights = edge_weights(examples)
    weights[fixed] *= _FIXED_SHARE * weights[~fixed].sum() / max(float(weights[fixed].sum()), 1e-12)
    boosters = boosted_logistic(columns, fixed, weights, _RIGIDITY, seeds=seeds, rounds=_RIGIDITY_ROUNDS)
    return trees_alone(names, boosters, provenance)


def fit_opening(examples: Sequence[Example], *, seeds: Sequence[int], provenance: Mapping[str, Any]) -> Scorer:
    """Fit which way a turn opens, to examples with `sides`; trees of several seeds are averaged.

    Raises:
        EnvironmentFault: LightGBM is not installed.
    """
    names = tuple(sorted({name for example in examples for name in example.sides}))
    columns = np.concatenate([side_columns(example.sides, names) for example in examples])
    opens = np.tile([True, False], len(examples))
    weights = np.repeat(edge_weights(examples), 2)
    boosters = boosted_logistic(columns, opens, weights, _OPENING, seeds=seeds, rounds=_OPENING_ROUNDS)
    return trees_alone(names, boosters, provenance)


def fit_turning(examples: Sequence[Example], *, seeds: Sequence[int], provenance: Mapping[str, Any]) -> Scorer:
    """Fit whether a turn goes round, to examples that turn; trees of several seeds are averaged.

    Raises:
        EnvironmentFault: LightGBM is not installed.
    """
    names = turning_names(examples)
    columns = turns_of(examples, names)
    rounds = np.array([example.is_continuous for example in examples], dtype=np.float64)
    weights = edge_weights(examples)
    boosters = boosted_logistic(columns, rounds, weights, _TURNING, seeds=seeds, rounds=_TURNING_ROUNDS)
    return trees_alone(names, boosters, provenance)


def turning_names(examples: Sequence[Example]) -> tuple[str, ...]:
    """Measurements of one hypothesis by itself: all but cues."""
    groups = {group for example in examples for group in example.groups} - {CUES, VERDICTS}
    return tuple(sorted({name for example in examples for group in groups for name in example.groups.get(group, ())}))


def turns_of(examples: Sequence[Example], names: Sequence[str]) -> NDArray[Any]:
    """What is measured of the hypothesis that fits each true turn best, shape (n, f)."""
    return np.stack(
        [columns_of(item.measured, names, len(item.kinds))[int(np.argmax(item.right))] for item in examples]
    )


def turns_known(example: Example) -> bool:
    """The joint turns, and its line was proposed."""
    return example.is_continuous is not None and example.right.max() >= _PROPOSED


def is_fixed(example: Example) -> bool:
    """The true joint is none."""
    return bool(example.right[0] > 0.5)


def recipe_key(measurements: Sequence[str]) -> str:
    """Hash of how weights are fitted: of what measurements, from which start, with which parameters."""
    options = (_PARAMETERS, _ROUNDS, NETWORK_PARAMETERS, POINT_PARAMETERS)
    return content_key(sorted(measurements), SUMMARIES, FORMAT, *options, _SHARE)


def rigidity_recipe_key(measurements: Sequence[str]) -> str:
    """The same of the weights of what is fixed."""
    return content_key(sorted(measurements), FORMAT, _PARAMETERS, _RIGIDITY, _RIGIDITY_ROUNDS, _FIXED_SHARE, _SHARE)


def opening_recipe_key(measurements: Sequence[str]) -> str:
    """The same of the weights of which way a turn opens."""
    return content_key(sorted(measurements), FORMAT, _PARAMETERS, _OPENING, _OPENING_ROUNDS, _SHARE)


def turning_recipe_key(measurements: Sequence[str]) -> str:
    """The same of the weights of what goes round."""
    return content_key(sorted(measurements), FORMAT, _PARAMETERS, _TURNING, _TURNING_ROUNDS, _SHARE)


def rigidity_odds(scorer: Scorer, examples: Sequence[Example]) -> FloatArray:
    """Log odds that the child of each edge is fixed, shape (n,)."""
    names = scorer.measurements
    return scorer.sums(np.stack([rigid_columns(example.kinds, example.measured, names) for example in examples]))


def data_key(examples: Sequence[Example]) -> str:
    """Hash of what weights are fitted to: objects, measurements and which hypotheses are right."""
    found = hashlib.sha256()
    for example in examples:
        found.update(f"{example.origin}/{example.object}".encode())
        for values in (*(example.measured[name] for name in sorted(example.measured)), example.right):
            found.update(np.asarray(values, dtype=np.float32).tobytes())
    return found.hexdigest()[:20]


def write_scorer(scorer: Scorer, path: Path) -> None:
    """Write the file that `scorer.shipped_scorer` reads."""
    facts = {
        "format": FORMAT,
        "measurements": scorer.measurements,
        "temperature": scorer.temperature,
        "provenance": scorer.provenance,
    }
    arrays = {name: getattr(scorer, name) for name in (*_DTYPES, "base")}
    if scorer.network is not None:
        scale, network = vars(scorer.network.scale), {**vars(scorer.network)}
        del network["scale"]
        small = {name: layer.astype(np.float16) for name, layer in network.items()}
        arrays |= {f"{NETWORK}{name}": layer for name, layer in {**scale, **small}.items()}
    if scorer.points is not None:
        arrays |= {f"{POINTS}{name}": layer.astype(np.float16) for name, layer in vars(scorer.points).items()}
    np.savez_compressed(path, facts=json.dumps(facts), **arrays)


def edge_weights(examples: Sequence[Example]) -> FloatArray:
    """So that neither an object with many joints nor a category with many objects dominates, shape (n,)."""
    of_object = Counter((example.origin, example.object) for example in examples)
    of_category = Counter((example.origin, example.category) for example in examples)
    weights = np.array(
        [
            _SHARE.get(example.origin, 1.0)
            * of_object[example.origin, example.object] ** -0.5
            * of_category[example.origin, example.category] ** -0.25
            for example in examples
        ]
    )
    return np.asarray(weights / weights.mean())


def _likelihood(scores: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
    """Probability within each edge, and its logarithm, shape (rows,) each."""
    edge = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    shifted = scores - np.maximum.reduceat(scores, starts[:-1])[edge]
    logs = shifted - np.log(np.add.reduceat(np.exp(shifted), starts[:-1]))[edge]
    return np.exp(logs), logs


def _fit_base(begun: FloatArray, starts: IntArray, target: FloatArray, weights: FloatArray) -> FloatArray:
    """How much the weighted cues are to be believed before any tree, shape (3,)."""

    def loss(coefficients: FloatArray) -> tuple[float, FloatArray]:
        likely, logs = _likelihood(begun @ coefficients, starts)
        slope = -(begun * (weights * (target - likely))[:, None]).sum(axis=0) + 0.02 * coefficients
        return float(-(weights * target * logs).sum() + 0.01 * coefficients @ coefficients), slope

    return np.asarray(minimize(loss, np.array([1.0, 0.5, -2.0]), jac=True).x)


def _boost(
    columns: NDArray[Any],
    begun: FloatArray,
    starts: IntArray,
    target: FloatArray,
    weights: FloatArray,
    *,
    seed: int,
) -> Any:
    lightgbm = lightgbm_module()

    def objective(scores: FloatArray, data: object) -> tuple[FloatArray, FloatArray]:
        likely, _ = _likelihood(scores, starts)
        return (likely - target) * weights, np.maximum(likely * (1.0 - likely), 1e-3) * weights

    data = lightgbm.Dataset(
        columns, label=target, init_score=begun, params={"max_bin": _PARAMETERS["max_bin"], "verbosity": -1}
    )
    return lightgbm.train({**_PARAMETERS, "objective": objective, "seed": seed}, data, _ROUNDS)


def boosted_logistic(
    columns: NDArray[Any],
    answers: NDArray[Any],
    weights: FloatArray,
    options: Mapping[str, Any],
    *,
    seeds: Sequence[int],
    rounds: int,
) -> list[Any]:
    """Trees of every seed that say yes or no of each row of columns; `options` stand before `_PARAMETERS`."""
    lightgbm = lightgbm_module()
    return [
        lightgbm.train(
            {**_PARAMETERS, "objective": "binary", **options, "seed": seed},
            lightgbm.Dataset(columns, answers, weight=weights, params={"max_bin": _PARAMETERS["max_bin"]}),
            rounds,
        )
        for seed in seeds
    ]


def trees_alone(names: tuple[str, ...], boosters: Sequence[Any], provenance: Mapping[str, Any]) -> Scorer:
    """A scorer that is the average of the boosters."""
    return Scorer(
        measurements=names, base=np.zeros(3), temperature=1.0, provenance=dict(provenance), **_arrays(boosters)
    )


def lightgbm_module() -> Any:
    """LightGBM; EnvironmentFault where it is not installed."""
    require("The fit", "lightgbm")
    import lightgbm  # noqa: PLC0415 - an extra that only the fit needs

    return lightgbm


_DTYPES = {
    "feature": np.int16,
    "threshold": np.float64,
    "missing_left": np.uint8,
    "left": np.uint8,
    "right": np.uint8,
    "value": np.float32,
}


def _arrays(boosters: Sequence[Any]) -> dict[str, Any]:
    """Every tree as rows of nodes; the average of the boosters is the sum of trees with a share of their values."""
    trees = [
        _nodes(tree["tree_structure"], 1.0 / len(boosters))
        for booster in boosters
        for tree in booster.dump_model()["tree_info"]
    ]
    table = np.zeros((len(_DTYPES), len(trees), max(len(tree) for tree in trees)))
    table[0] = -1
    for k, tree in enumerate(trees):
        table[:, k, : len(tree)] = np.array(tree).T
    return {name: rows.astype(dtype) for (name, dtype), rows in zip(_DTYPES.items(), table, strict=True)}


def _nodes(root: Mapping[str, Any], share: float) -> list[tuple[float, ...]]:
    found: list[tuple[float, ...]] = []

    def visit(node: Mapping[str, Any]) -> int:
        place = len(found)
        found.append(())
        if "split_feature" not in node:
            found[place] = (-1, 0.0, 0, 0, 0, share * node["leaf_value"])
            return place
        left, right = visit(node["left_child"]), visit(node["right_child"])
        # Where no value was missing in the fit, LightGBM takes a missing one for zero.
        known = node["missing_type"] != "NaN"
        missing_left = node["threshold"] >= 0.0 if known else node["default_left"]
        found[place] = (node["split_feature"], node["threshold"], int(missing_left), left, right, 0.0)
        return place

    visit(root)
    return found
