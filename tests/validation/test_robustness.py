"""A seeded sample of the robustness benchmark: whatever is in the files, there is a report or a refusal, in time."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.corruption.bases import Base, built_base
from benchmarks.corruption.cases import KINDS, READY, CorruptionTask, run_case, write_case
from kinematify.validation.checks import CHECKS
from kinematify.validation.run import validate
from kinematify.validation.run.needs import needed, stages_of

FILE_CHECKS = tuple(check for check in CHECKS if check.startswith(("KV1", "KV2")))


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Base:
    return built_base(tmp_path_factory.mktemp("base"))


def test_the_model_that_is_corrupted_is_sound(base: Base, tmp_path: Path) -> None:
    for name, path in base.meshes.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(path.read_bytes())
    (tmp_path / "model.urdf").write_bytes(base.text)
    report = validate(tmp_path / "model.urdf", selected=FILE_CHECKS, engines=())
    assert report.exit_status == 0, [finding.message for finding in report.findings]
    of_file = {check.check: check.status for check in report.checks if check.check.startswith("KV1")}
    assert of_file.pop("KV145") == "skipped"  # there is no SRDF
    assert set(of_file.values()) == {"pass"}


@pytest.mark.parametrize("number", range(len(KINDS)))
def test_every_kind_of_corruption_ends_with_a_report_or_a_refusal(number: int, base: Base) -> None:
    result = run_case(CorruptionTask(number=number, seed=1, bases=(base,), seconds=20.0, selected=FILE_CHECKS))
    assert result["outcome"] in READY, result["message"]
    assert not result.get("unexplained")


def test_the_same_number_gives_the_same_model(base: Base, tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    for number in range(19):
        first = write_case(number, 5, [base], tmp_path / "a")
        second = write_case(number, 5, [base], tmp_path / "b")
        assert first.urdf.read_bytes() == second.urdf.read_bytes()
        assert first.urdf.read_bytes() != base.text


def test_stages_without_a_selected_check_do_not_start() -> None:
    stages = stages_of(())
    assert needed(stages, {"KV101"}) == []
    assert [stage.name for stage in needed(stages, {"KV301"})] == ["geometry"]
    assert needed(stages, set(CHECKS)) == stages
