"""Planted wrong joints: each is wrong in its own way alone, and refinement is measured on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from benchmarks.planted import (
    AXIS,
    FAULTS,
    PARENT,
    PIVOT,
    SECOND,
    SIGN,
    TYPE,
    TrueMechanism,
    planted_faults,
    true_mechanism,
)
from benchmarks.study import RECORDS
from kinematify.assembly.erasure import erase
from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.evaluation.result_record import load_report
from kinematify.robot.read import read_robot
from tests.inferred import write_inferred

if TYPE_CHECKING:
    from pathlib import Path

CONFIG = load_config()


def written(folder: Path) -> Path:
    return write_inferred("edge_door", folder) / "model.urdf"


@pytest.fixture(scope="module")
def door(tmp_path_factory: pytest.TempPathFactory) -> TrueMechanism:
    urdf = written(tmp_path_factory.mktemp("planted") / "door")
    found = true_mechanism(erase(read_robot(urdf, geometry="shown")), CONFIG)
    assert found is not None
    return found


def test_the_true_mechanism_is_right_and_holds_the_truth_among_its_candidates(door: TrueMechanism) -> None:
    assert not door.wrong(door.inference)
    (joint,) = door.inference.joints
    assert any(item.source == "truth" for item in joint.alternatives)


def test_each_fault_is_wrong_in_its_own_way(door: TrueMechanism) -> None:
    (right,) = door.inference.joints
    planted = {item.fault: item for item in planted_faults(door, 0)}
    assert set(planted) == set(FAULTS) - {PARENT}, "two parts leave no other parent"
    wrong = {fault: item.inference.joints[0] for fault, item in planted.items()}
    assert wrong[AXIS].axis @ right.axis == pytest.approx(0.0, abs=1e-9)
    assert wrong[PIVOT].axis @ right.axis == pytest.approx(1.0)
    assert np.linalg.norm(np.cross(wrong[PIVOT].pivot - right.pivot, right.axis)) > 0.1
    assert wrong[TYPE].kind.turns != right.kind.turns
    assert wrong[SIGN].axis @ right.axis == pytest.approx(-1.0)
    assert all(door.wrong(item.inference) == {item.part} for item in planted.values())
    assert wrong[SECOND].alternatives[0].score == pytest.approx(right.alternatives[0].score), "believed as the best was"


def test_bench_counts_what_refinement_finds_and_repairs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    written(tmp_path / "models" / "door")
    words = ["bench", "refine", "--data", "models", "--objects", "*", "--faults", f"{PIVOT},{SIGN}", "--jobs", "1"]
    assert run([*words, "--inferred", "*", "-o", "out"]) == 0
    capsys.readouterr()
    records = load_report(tmp_path / "out" / "refine.json", RECORDS).records
    assert [record["fault"] for record in records] == ["nothing", PIVOT, SIGN, "as inferred"]
    assert [record["wrong"] for record in records] == [0, 1, 1, 0]
    assert [record["found"] for record in records] == [0, 1, 1, 0]
    assert all(record["repaired"] == record["wrong"] and not record["harmed"] for record in records)
    table = (tmp_path / "out" / "refine.md").read_text()
    assert "| pivot | 1 | 1 (100%) | 1 (100%) | 0 of 0 |" in table
    assert "| as inferred | - | - | - | 0 of 1 |" in table
