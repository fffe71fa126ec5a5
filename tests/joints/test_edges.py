"""Edges of the tree: probabilities against all spanning trees, what is measured of contacts, and whole objects."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.fit.edges import (
    TreeExample,
    base_recipe_key,
    edge_recipe_key,
    fit_edges,
    missed_edges,
    read_tree_examples,
    tree_example,
    write_tree_examples,
    write_weights,
)
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.errors import EnvironmentFault
from kinematify.generate.procedural.blueprint import ground_truth
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.generate.registry import build
from kinematify.geometry.part_stats import assembly_stats
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.choice import edges
from kinematify.joints.choice.edges import (
    MEASUREMENTS,
    edge_measurements,
    edge_probabilities,
    shipped_weights,
)
from kinematify.joints.features.pins import EdgePins
from kinematify.pipeline.infer_assembly import infer
from kinematify.topology.base_link import BASE_WEIGHTS, COLUMNS
from tests.joints.joint_scenes import clock
from tests.known import known_object

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


CONFIG = load_config()


@given(st.integers(0, 1000))
def test_probabilities_are_those_over_all_spanning_trees(seed: int) -> None:
    rng = np.random.default_rng(seed)
    pairs = [pair for pair in combinations(range(5), 2) if pair[1] == pair[0] + 1 or rng.random() < 0.5]
    scores = rng.normal(0.0, 2.0, len(pairs))
    trees = [some for some in combinations(range(len(pairs)), 4) if nx.is_tree(nx.Graph([pairs[k] for k in some]))]
    trees = [some for some in trees if len({part for k in some for part in pairs[k]}) == 5]
    weights = np.array([np.exp(scores[list(some)].sum()) for some in trees])
    by_hand = [sum(w for w, some in zip(weights, trees, strict=True) if k in some) for k in range(len(pairs))]
    likely, log_z = edge_probabilities(pairs, scores, 5)
    np.testing.assert_allclose(likely, np.array(by_hand) / weights.sum(), atol=1e-6)
    assert log_z == pytest.approx(np.log(weights.sum()))


@pytest.mark.parametrize(("family", "parameters"), [("door", {"kind": "folding", "leaves": 2}), ("stapler", {})])
def test_parts_that_touch_several_others_hang_where_their_joint_is(family: str, parameters: dict[str, object]) -> None:
    """Leaves of a folding door on each other, the arm of a stapler on its magazine."""
    blueprint = build(family, parameters, seed=0)
    truth = ground_truth(blueprint)
    inference = infer(blueprint.assembly, config=CONFIG)
    names = blueprint.assembly.names
    found = {names[child]: names[parent] for parent, child in inference.trees[0].edges()}
    assert found == {truth.part_names[j.child]: truth.part_names[j.parent] for j in truth.joints}


def test_hands_of_a_clock_hang_side_by_side() -> None:
    known = clock()
    tree = infer(known.assembly, config=CONFIG).trees[0]
    case = known.index["case"]
    assert tree.root == case
    assert all(tree.parents[known.index[name]] == case for name in ("hand_0", "hand_1"))


def test_a_lid_over_a_rim_hangs_on_the_pot_though_it_touches_the_handle_alone() -> None:
    """0.7 % of the object's size from the pot, which is more than a contact and less than a part elsewhere."""
    pot = cylinder(0.1, (0, 0, 0), (0, 0, 0.15)) - cylinder(0.094, (0, 0, 0.006), (0, 0, 0.2))
    handle = box((0.1, -0.01, 0.05), (0.14, 0.01, 0.165))
    lid = cylinder(0.1, (0, 0, 0.152), (0, 0, 0.16)) + box((0.09, -0.01, 0.152), (0.1, 0.01, 0.16))
    known = known_object("pot", {"pot": pot, "handle": handle, "lid": lid})
    inference = infer(known.assembly, config=CONFIG)
    assert inference.trees[0].parents[known.index["lid"]] == known.index["pot"]
    assert any("The parent of lid is pot, which it does not touch" in warning for warning in inference.warnings)


@pytest.mark.parametrize(
    ("other", "share"), [(((0.0, 0.2005, 0.0), (0.3, 0.32, 0.01)), 1.0), (((0.1, 0.05, 0.01), (0.2, 0.15, 0.02)), 0.35)]
)
def test_plates_edge_to_edge_touch_along_the_larger_one_and_a_block_on_it_does_not(
    other: tuple[tuple[float, ...], tuple[float, ...]], share: float
) -> None:
    known = known_object("plates", {"plate": box((0.0, 0.0, 0.0), (0.3, 0.2, 0.01)), "other": box(*other)})
    surfaces = part_surfaces(known.assembly, config=CONFIG.surface)
    graph = build_contact_graph(known.assembly, surfaces, config=CONFIG.contact, seed=0)
    measured = edge_measurements(graph, assembly_stats(known.assembly), {}, EdgePins())[0]
    assert measured[MEASUREMENTS.index("along_larger")] == pytest.approx(share, abs=0.15)


# ---- the fit ---------------------------------------------------------------------------------------------------------


def small_examples() -> list[TreeExample]:
    found = []
    for name in ("stapler", "fridge", "oven", "toilet"):
        blueprint = build(name, seed=0)
        found.append(
            tree_example(
                blueprint.assembly,
                ground_truth(blueprint),
                CONFIG,
                category=name,
                origin="family",
                source="ours",
                fits=True,
            )
        )
    return found


def test_a_small_fit_finds_its_own_trees_and_is_written_and_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    examples = small_examples()
    write_tree_examples(tmp_path / "one.npz", examples)
    again = read_tree_examples(tmp_path / "one.npz")
    assert [item.parents for item in again] == [item.parents for item in examples]
    weights = fit_edges(again, {"seed": 0})
    assert missed_edges(again, weights) < 0.1 * sum(len(item.parents) for item in again)
    write_weights(weights, MEASUREMENTS, tmp_path / edges.EDGE_WEIGHTS)
    monkeypatch.setattr(edges, "files", lambda _: tmp_path)
    read = edges.shipped_weights.__wrapped__(edges.EDGE_WEIGHTS, MEASUREMENTS)
    np.testing.assert_allclose(read.weights, weights.weights, atol=1e-6)


@pytest.mark.parametrize(
    ("file", "columns", "recipe"),
    [(edges.EDGE_WEIGHTS, MEASUREMENTS, edge_recipe_key), (BASE_WEIGHTS, COLUMNS, base_recipe_key)],
)
def test_the_weights_name_their_recipe_and_what_they_are_of(
    file: str, columns: tuple[str, ...], recipe: Callable[[], str]
) -> None:
    """Names of real objects, none of a judge; other columns are refused."""
    shipped = shipped_weights(file, columns)
    assert shipped.provenance["recipe"] == recipe()
    assert len(shipped.weights) == len(columns)
    assert not [
        name for name in shipped.provenance["real"] if name.partition("/")[0] in {"kitchen", "kinart", "everyday"}
    ]
    for others in ((*columns, "another"), columns[::-1]):
        with pytest.raises(EnvironmentFault, match=r"benchmarks\.fit\.edge_fit"):
            shipped_weights(file, others)


def test_the_weights_of_base_links_name_seed_and_numbers_of_drawn_objects() -> None:
    facts = shipped_weights(BASE_WEIGHTS, COLUMNS).provenance
    assert facts["seed"] == 0
    assert facts["objects"] == len(facts["real"]) + sum(facts["generated"].values())


@pytest.mark.parametrize("text", ["", "{}", '{"weights": {"bearing": 1.0}}'])
def test_damaged_weights_are_refused_with_the_remedy(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / edges.EDGE_WEIGHTS).write_text(text, encoding="utf-8")
    monkeypatch.setattr(edges, "files", lambda _: tmp_path)
    with pytest.raises(EnvironmentFault, match=r"benchmarks\.fit"):
        edges.shipped_weights.__wrapped__(edges.EDGE_WEIGHTS, MEASUREMENTS)
