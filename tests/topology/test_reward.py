"""Reward terms against values computed by hand, and part measurements."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.paper.trees import PaperReward, hierarchy, static_support, symmetry
from kinematify.topology import reward as terms
from tests.topology.topology_objects import edge, evidence_of, graph_of, random_assembly, stat

CONFIG = load_config().topology
PAPER = load_config("paper").topology

CHAIN = terms.layout_tree([-1, 0, 1, 2])
STAR = terms.layout_tree([-1, 0, 0, 0])


def test_static_support_of_a_side_arm() -> None:
    # Root at 0; child of mass 2 at x = 1; grandchild of mass 1 at x = 4 and height 7.
    tree = terms.layout_tree([-1, 0, 1])
    centroids = np.array([[0, 0, 0], [1, 0, 0], [4, 0, 7]], dtype=float)
    volumes = np.array([5.0, 2.0, 1.0])
    # c_sub(1) = (2*1 + 1*4)/3 = 2, torque |2-1| * 3 = 3; the leaf has none.
    assert static_support(tree, centroids, volumes, scale=6.0) == pytest.approx(1 / (1 + 3 / 6))


def test_symmetry_of_the_paper() -> None:
    # Children 1, 2 of one root: no variance, one parent.
    assert symmetry(STAR, [(1, 2, 3)]) == pytest.approx(2.0)
    # In the chain depths 1, 2, 3 have variance 2/3 and the parents 0, 1, 2 differ.
    assert symmetry(CHAIN, [(1, 2, 3)]) == pytest.approx(1 / (1 + 2 / 3), abs=1e-6)
    # Two knees on two thighs: equal depth, but no shared parent.
    legs = terms.layout_tree([-1, 0, 0, 1, 2])
    assert symmetry(legs, [(1, 2), (3, 4)]) == pytest.approx((2 + 1) / 2, abs=1e-6)


def test_corresponding_parents_count_as_symmetric() -> None:
    legs = terms.layout_tree([-1, 0, 0, 1, 2])
    kind = np.array([0, 1, 1, 3, 3])
    assert terms.corresponding_symmetry(legs, [(1, 2), (3, 4)], kind) == pytest.approx(1.0)
    # Three knees on two thighs: one thigh carries two, the other one.
    crooked = terms.layout_tree([-1, 0, 0, 1, 1, 2])
    assert terms.corresponding_symmetry(crooked, [(1, 2), (3, 4, 5)], np.array([0, 1, 1, 3, 3, 3])) < 1.0
    assert terms.corresponding_symmetry(legs, [], np.arange(5)) == 1.0


def test_hierarchy_of_the_paper_and_ours() -> None:
    volumes = np.array([1.0, 3.0, 1.0, 0.5])
    assert hierarchy(CHAIN, volumes) == pytest.approx(1 / (1 + 2), abs=1e-6)
    assert terms.log_hierarchy(CHAIN, volumes) == pytest.approx(1 / (1 + np.log(3) / 3))


def test_total_is_the_weighted_mean() -> None:
    graph, stats, evidence = random_assembly(5, 2, seed=3, clusters=[(1, 2)])
    reward = PaperReward(graph, stats, evidence, PAPER)
    values = reward.terms([-1, 0, 0, 1, 1])
    by_hand = (values["struct"] + values["static"] + values["contact"] + 2 * values["sym"] + values["hier"]) / 6
    assert reward.total(values) == pytest.approx(by_hand)


@pytest.mark.parametrize("passing", [True, False])
def test_shafts_that_pass_each_other_hang_side_by_side(passing: bool) -> None:
    graph = graph_of(3, {(0, 1): 0.0, (0, 2): 0.0, (1, 2): 0.0})
    stats = [stat((0, 0, 0), 2.0), stat((0, 0, 1)), stat((0, 0, 2), 0.5)]
    carriers = {(1, 2): frozenset({0})} if passing else {}
    evidence = evidence_of(dict.fromkeys(graph.by_pair, 0.9), carriers)
    reward = terms.TreeReward(graph, stats, evidence, CONFIG)
    chain, star = (reward.terms(parents)["stack"] for parents in ((-1, 0, 1), (-1, 0, 0)))
    assert star == 1.0
    assert chain == (0.5 if passing else 1.0)


def test_a_bridge_has_no_contact_strength() -> None:
    graph = graph_of(2, {})
    bridged = type(graph)(n_parts=2, edges=(edge(0, 1, 0.9, bridge=True),), clusters=(), tolerance=0.01)
    stats = [stat((0, 0, 0)), stat((1, 0, 0))]
    assert PaperReward(bridged, stats, evidence_of({}), PAPER).quality == {(0, 1): 0.0}
