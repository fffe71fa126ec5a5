"""The paper's rules one by one: base link given, clusters open, strength by proximity, contact that survives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
import torch
import trimesh

from benchmarks.paper_configurations import with_types
from benchmarks.studies.paper import field_gaps
from benchmarks.study import RECORDS
from kinematify.assembly.part import Assembly, Part
from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.errors import InputError
from kinematify.evaluation.metrics import Prediction
from kinematify.evaluation.result_record import load_report
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.paper.cavl import _bounded
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.stages import rank_trees
from kinematify.robot.joint_type import JointType
from tests.inferred import write_inferred
from tests.objects import BUILDERS
from tests.topology.topology_objects import evidence_of, graph_of, stat

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
    evidence = evidence_of(dict.fromkeys(graph.by_pair, 0.0))
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


def test_separation_counts_as_printed_near_the_contact_and_no_more_the_farther_it_gets() -> None:
    near, far = (_bounded(torch.tensor(depths, dtype=torch.float64), 2.0) for depths in ([0.0, 0.01], [50.0, 5000.0]))
    assert near.tolist() == pytest.approx([0.0, 0.01], rel=1e-4)
    assert far.tolist() == pytest.approx([2.0, 2.0], rel=1e-3)


def test_bench_tells_the_cost_of_the_true_joint_beside_that_of_the_chosen_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for kind in ("robots", "everyday"):
        write_inferred("edge_door", tmp_path / "data" / kind / "door")
    monkeypatch.setenv("KINEMATIFY_BENCH", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)
    words = ["bench", "paper", "--sets", "everyday", "--everyday", "*", "--poses", "rest", "--jobs", "1", "-o", "out"]
    assert run(words) == 0
    capsys.readouterr()
    records = load_report(tmp_path / "out" / "paper.json", RECORDS).records
    trees = {row["rules"]: row["ted"] for row in records if row["part"] == "trees"}
    assert trees["paper-base"] == trees["paper-open"] == 0, "two parts and a base leave one tree"
    joints = {row["objective"]: row for row in records if row["part"] == "joints"}
    assert set(joints) == {"DW-CAVL", "DW-CAVL+"}
    assert joints["DW-CAVL+"]["j_true"] < joints["DW-CAVL"]["j_true"], "a closed door leaves most of its contact"
    wholes = {(row["rules"], row["without"], row["types_by"]): row for row in records if row["part"] == "whole"}
    assert len(wholes) == (3 * 3 + 2) * 4, "the default has no DW-CAVL to leave out"
    assert all(row["types"] == 1.0 for key, row in wholes.items() if key[2] == "oracle 100 %" and row["matched"] == 1.0)
    assert wholes["paper", "", "own rule"]["types"] == 0.0, "DW-CAVL lets the closed door slide"
    text = (tmp_path / "out" / "paper.md").read_text()
    assert "J(true)" in text
    assert "| everyday | paper-open | oracle 90 % | 1 |" in text


def test_congruent_parts_outvote_what_the_oracle_said_of_one() -> None:
    candidates = tuple(
        JointCandidate(kind=kind, axis=np.eye(3)[k], pivot=np.zeros(3), score=-k, source="made")
        for k, kind in enumerate((JointType.PRISMATIC, JointType.REVOLUTE))
    )
    joints = tuple(
        JointEstimate(
            parent=0, child=child, kind=JointType.PRISMATIC, axis=np.eye(3)[0], pivot=np.zeros(3), lower=0.0, upper=1.0,
            confidence=0.5, alternatives=candidates,
        )
        for child in (1, 2, 3)
    )  # fmt: skip
    answer = Prediction(parents={0: -1, 1: 0, 2: 0, 3: 0}, joints=joints)
    turns = {frozenset((0, child)): True for child in (1, 2, 3)}
    errs_on_the_second = next(
        seed for seed in range(1000) if [*(np.random.default_rng(seed).random(3) < 0.9)] == [True, False, True]
    )
    alone, together = (
        with_types(answer, turns, clusters, 0.9, np.random.default_rng(errs_on_the_second)).joints
        for clusters in ((), ((1, 2, 3),))
    )
    assert [joint.kind.turns for joint in alone] == [True, False, True]
    assert [joint.kind.turns for joint in together] == [True, True, True]
    assert np.allclose(together[1].axis, np.eye(3)[1]), "the best candidate of that type"


def test_gaps_by_fields_are_those_of_the_nearest_sample_and_nothing_inside() -> None:
    shapes = {"one": (0.0, 0.2), "beside": (0.21, 0.2), "inside": (0.05, 0.2)}
    parts = []
    for name, (place, size) in shapes.items():
        mesh = trimesh.creation.box(extents=[size] * 3).apply_translation([place, 0.0, 0.0])
        parts.append(Part(name=name, vertices=mesh.vertices, faces=mesh.faces))
    config = OPEN.model_copy(update={"sdf": OPEN.sdf.model_copy(update={"kind": "grid"})})
    gap = field_gaps(Assembly(parts=tuple(parts), source="made"), config)
    assert gap((0, 1)) == pytest.approx(0.01, abs=2e-3)
    assert gap((0, 2)) == 0.0
