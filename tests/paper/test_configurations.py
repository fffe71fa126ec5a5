"""The paper's rules one by one: base link given, clusters open, strength by proximity, contact that survives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
import torch

from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.contact.build import build_contact_graph
from kinematify.errors import InputError
from kinematify.evaluation.study import load_study_report
from kinematify.geometry.surface import part_surfaces
from kinematify.paper.cavl import _surviving_mean
from kinematify.pipeline import infer, write_inference
from kinematify.pipeline.stages import rank_trees
from kinematify.topology.evidence import EdgeEvidence
from tests.objects import BUILDERS
from tests.topology.topology_objects import graph_of, stat

if TYPE_CHECKING:
    from pathlib import Path

BASE, OPEN = load_config("paper-base"), load_config("paper-open")


def test_the_base_link_is_input_where_the_algorithm_takes_it_as_input() -> None:
    with pytest.raises(InputError, match=r"takes the base link as input.*--base"):
        infer(BUILDERS["toilet"]().assembly, config=BASE)


def test_an_edge_inside_a_cluster_is_cut_by_one_rule_and_kept_by_the_other() -> None:
    """Two congruent links of an arm, one after the other: the second touches nothing but its twin."""
    graph = graph_of(3, {(0, 1): 0.9, (1, 2): 0.9}, clusters=[(1, 2)])
    stats = [stat((0.0, 0.0, 0.0), 4.0), stat((0.0, 0.0, 2.0)), stat((0.0, 0.0, 3.0))]
    evidence = {pair: EdgeEvidence(quality=0.0, axis=None) for pair in graph.by_pair}
    found = {
        config.name: rank_trees(graph, stats, evidence, config.topology, seed=0, base=0)[0].parents
        for config in (BASE, OPEN)
    }
    assert found["paper-open"] == (-1, 0, 1)
    assert found["paper-base"] != (-1, 0, 1)


def test_strength_by_proximity_falls_with_the_gap_alone() -> None:
    assembly = BUILDERS["toilet"]().assembly
    surfaces = part_surfaces(assembly, config=OPEN.surface)
    graph = build_contact_graph(assembly, surfaces, config=OPEN.contact, seed=0)
    for edge in graph.edges:
        assert edge.strength == pytest.approx(np.exp(-edge.gap / graph.tolerance))


def test_only_the_share_of_the_contact_that_is_separated_least_counts() -> None:
    weights = torch.tensor([1.0, 1.0, 1.0, 1.0], dtype=torch.float64)
    depths = torch.tensor([[[3.0, 0.0, 1.0, 2.0]]], dtype=torch.float64)
    assert float(_surviving_mean(weights, depths, 0.25, 0.0)) == pytest.approx(0.0)
    assert float(_surviving_mean(weights, depths, 0.5, 0.0)) == pytest.approx(0.5)
    assert float(_surviving_mean(weights, depths, 0.625, 0.0)) == pytest.approx((1.0 + 0.5 * 4.0) / 2.5)
    assert float(_surviving_mean(weights, depths, 1.0, 0.0)) == pytest.approx((1.0 + 4.0 + 9.0) / 4.0)


def test_bench_tells_the_cost_of_the_true_joint_beside_that_of_the_chosen_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for kind in ("robots", "everyday"):
        door = infer(BUILDERS["edge_door"]().assembly, config=load_config())
        write_inference(door, tmp_path / "data" / kind / "door", preview=False)
    monkeypatch.setenv("KINEMATIFY_BENCH", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)
    words = ["bench", "paper", "--sets", "everyday", "--everyday", "*", "--poses", "rest", "--jobs", "1", "-o", "out"]
    assert run(words) == 0
    capsys.readouterr()
    records = load_study_report(tmp_path / "out", "paper").records
    trees = {row["rules"]: row["ted"] for row in records if row["part"] == "trees"}
    assert trees["paper-base"] == trees["paper-open"] == 0, "two parts and a base leave one tree"
    joints = {row["objective"]: row for row in records if row["part"] == "joints"}
    assert set(joints) == {"DW-CAVL", "DW-CAVL+"}
    assert joints["DW-CAVL+"]["j_true"] < joints["DW-CAVL"]["j_true"], "a closed door leaves most of its contact"
    assert "J(true)" in (tmp_path / "out" / "paper.md").read_text()
