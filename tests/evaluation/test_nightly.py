"""`kinematify nightly`: classes of changes, planted faults, resuming after SIGKILL, the lock and bad folders."""

from __future__ import annotations

import json
import os
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from kinematify.cli.app import run as run_command
from kinematify.config.nightly_settings import NightlySettings, load_nightly
from kinematify.errors import InputError
from kinematify.evaluation.nightly.comparison import ChangeKind, compare
from kinematify.evaluation.nightly.run_night import accept, nightly, write_smoke_objects
from kinematify.evaluation.nightly.runs import Problem, Run
from tests.manipulation.furniture import write_drawer_cabinet
from tests.places import ROOT
from tests.secret_cabinets import write_object

if TYPE_CHECKING:
    from kinematify.evaluation.nightly.run_night import NightResult

SETTINGS = load_nightly()
AXIS = Problem(id="axis hinge", check="axis", severity="error", text="off by 40 deg")
TOUCH = Problem(id="KV312 joint hinge", check="KV312", severity="error", text="runs into the frame")
HINT = Problem(id="KV344 joint hinge", check="KV344", severity="warning", text="beside the pin")
ACCURACY = Run(
    scenario="s1", content="c1", object="door", kind="everyday", what="accuracy", case="rest", status="ok",
    seconds=2.0, values={"angle_deg": 0.5, "types": 1.0},
)  # fmt: skip
VALIDATION = replace(ACCURACY, what="validation", case="truth", status="pass", values={"errors": 0.0})


def changes(now: Run, before: Run, *, same_machine: bool = True) -> list[tuple[str, str, bool]]:
    found = compare([now], {before.place: [before]}, same_machine=same_machine)
    return [(change.kind.value, change.subject, change.gate) for change in found]


@pytest.mark.parametrize(
    ("now", "before", "expected"),
    [
        ({}, {}, []),
        ({"problems": (AXIS,)}, {}, [("new", AXIS.id, True)]),
        ({}, {"problems": (AXIS,)}, [("fixed", AXIS.id, False)]),
        ({"problems": (AXIS,)}, {"problems": (AXIS,)}, [("still failing", AXIS.id, False)]),
        ({"values": {"angle_deg": 0.7, "types": 1.0}}, {}, [("worse", "angle_deg", True)]),
        ({"values": {"angle_deg": 0.1, "types": 1.0}}, {}, [("better", "angle_deg", False)]),
        ({"values": {"angle_deg": 0.5, "types": 0.5}}, {}, [("worse", "types", True)]),
        ({"values": {"angle_deg": 0.51, "types": 1.0}}, {}, []),
        ({"seconds": 9.0}, {}, [("slower", "seconds", False)]),
        ({"seconds": 2.9}, {}, []),
        ({}, {"seconds": 9.0}, [("faster", "seconds", False)]),
        ({"scenario": "s2", "problems": (AXIS,), "seconds": 9.0}, {}, [("new series", "", False)]),
        (
            {"content": "c2", "problems": (AXIS,)},
            {},
            [("new", AXIS.id, True), ("input changed", "", False)],
        ),
        (
            {"content": "c2", "values": {"angle_deg": 0.5, "types": 1.0, "joints": 2.0}},
            {"values": {"angle_deg": 0.5, "types": 1.0, "joints": 3.0}},
            [("worse", "joints", True), ("input changed", "", False)],
        ),
        ({"status": "unreadable", "values": {}}, {}, [("newly skipped", "", True)]),
    ],
)
def test_class_of_a_change(now: dict[str, Any], before: dict[str, Any], expected: list[Any]) -> None:
    assert changes(replace(ACCURACY, **now), replace(ACCURACY, **before)) == expected


@pytest.mark.parametrize(
    ("now", "before", "expected"),
    [
        ({"problems": (HINT,)}, {}, [("new", HINT.id, False)]),
        ({"problems": (TOUCH,)}, {"problems": (HINT,)}, [("new", TOUCH.id, True), ("fixed", HINT.id, False)]),
        # A check that does not run any more has fixed nothing.
        ({"not_run": {"KV312": "blocked: x"}}, {"problems": (TOUCH,)}, [("newly skipped", "KV312", True)]),
        ({"not_run": {"KV312": "skipped: y"}}, {"not_run": {"KV312": "blocked: x"}}, []),
        ({"status": "crash", "values": {}}, {}, [("newly skipped", "", True)]),
        ({"status": "crash", "values": {}}, {"status": "timeout", "values": {}}, [("still failing", "", False)]),
    ],
)
def test_class_of_a_change_of_checks(now: dict[str, Any], before: dict[str, Any], expected: list[Any]) -> None:
    assert changes(replace(VALIDATION, **now), replace(VALIDATION, **before)) == expected


def test_the_latest_run_of_the_same_scenario_is_compared_with() -> None:
    """A night of another configuration in between does not hide a regression."""
    other, old = replace(ACCURACY, scenario="s2"), ACCURACY
    found = compare([replace(ACCURACY, problems=(AXIS,))], {ACCURACY.place: [other, old]}, same_machine=True)
    assert [change.kind for change in found] == [ChangeKind.NEW]


def test_a_run_that_is_missing_is_reported() -> None:
    found = compare([], {ACCURACY.place: [ACCURACY]}, same_machine=True)
    assert [(change.kind, change.gate) for change in found] == [(ChangeKind.GONE, False)]


# Nights over small objects.


@pytest.fixture(scope="module")
def boxes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two objects of boxes, of two and of three parts."""
    data = tmp_path_factory.mktemp("boxes")
    write_object(data / "hinged", with_knob=False)
    write_object(data / "drawered", with_knob=True)
    return data


def settings(data: Path, **changed: Any) -> NightlySettings:
    quick = {"conditions": ["rest"], "sources": [], "pulled": [], "engines": [], "data": str(data)}
    return SETTINGS.model_copy(update={**quick, **changed})


def night(data: Path, out: Path, infer: str = "quick_inference:star", **changed: Any) -> NightResult:
    return nightly(None, out, config=settings(data, **changed), jobs=2, infer=infer)


def kinds(result: NightResult) -> Counter[str]:
    return Counter(change.kind.value for change in result.night.changes)


@pytest.fixture(autouse=True)
def _tests_on_the_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers import the function under test by its name."""
    monkeypatch.setenv(
        "PYTHONPATH",
        os.pathsep.join([str(ROOT / "tests" / "evaluation"), *filter(None, [os.environ.get("PYTHONPATH")])]),
    )


def test_an_unchanged_night_reports_nothing_and_a_slow_object_fails_nothing(boxes: Path, tmp_path: Path) -> None:
    first, second = night(boxes, tmp_path), night(boxes, tmp_path)
    assert kinds(first) == {"new series": 2}
    assert set(kinds(second)) <= {"still failing"}
    assert second.night.gate == "pass"
    slow = night(boxes, tmp_path, "planted_inferences:slow_on_three_parts")
    reported = [(change.kind.value, change.object) for change in slow.night.changes if change.kind != "still failing"]
    assert reported == [("slower", "drawered")]
    assert slow.night.gate == "pass"
    assert len({first.place, second.place, slow.place}) == 3
    assert all((place / "index.html").is_file() for place in (first.place, slow.place, tmp_path))
    assert not (tmp_path / ".unfinished").exists()
    assert json.loads((tmp_path / "badge.json").read_text())["message"] == "passing"


def test_baseline_is_compared_with_until_a_night_is_accepted(boxes: Path, tmp_path: Path) -> None:
    good = night(boxes, tmp_path)
    accept(tmp_path, good.night.name)
    broken = [night(boxes, tmp_path, "planted_inferences:crashing_on_three_parts") for _ in range(2)]
    for result in broken:
        assert len(result.night.runs) == 2, "one bad object does not end the night"
        assert result.night.gate == "fail", "a regression fails every night until it is repaired or accepted"
        gates = [change for change in result.night.changes if change.gate]
        assert {change.object for change in gates} == {"drawered"}
    badge = json.loads((tmp_path / "badge.json").read_text())
    assert (badge["schemaVersion"], badge["color"], badge["message"]) == (1, "red", f"{len(gates)} worse")
    accept(tmp_path, broken[-1].night.name)
    assert night(boxes, tmp_path, "planted_inferences:crashing_on_three_parts").night.gate == "pass"


def test_planted_axis_and_limit_faults_are_new_problems(tmp_path: Path) -> None:
    """With the real inference and the real validation of the model that it writes."""
    data, out = tmp_path / "data", tmp_path / "nights"
    write_smoke_objects(data, ["a cabinet with one drawer"])
    asked = {"sources": ["inferred"], "checks": ["KV3*"]}
    sound = night(data, out, "planted_inferences:sound", **asked)
    assert next(run.status for run in sound.night.runs) == "ok"
    assert not any(problem.severity == "error" for run in sound.night.runs for problem in run.problems)
    accept(out, sound.night.name)
    axis = night(data, out, "planted_inferences:without_axis_evidence")
    found = {(change.kind.value, change.subject.split()[0]) for change in axis.night.changes if change.gate}
    assert {("new", "axis"), ("worse", "angle_deg")} <= found
    limits = night(data, out, "planted_inferences:with_limits_in_degrees", **asked)
    against_sound = {
        (change.kind.value, change.what, change.subject.split()[0]) for change in limits.night.changes if change.gate
    }
    assert ("new", "validation", "KV320") in against_sound, "the drawer leaves the cabinet"
    assert ("new", "accuracy", "limits") in against_sound


def test_an_arm_opens_what_is_named_and_the_share_is_kept(tmp_path: Path) -> None:
    data, out = tmp_path / "data", tmp_path / "nights"
    (data / "cabinet").mkdir(parents=True)
    write_drawer_cabinet(data / "cabinet" / "model.urdf")
    opened = night(data, out, pulled=["*"], engines=["mujoco"])
    (run,) = (run for run in opened.night.runs if run.case == "pulled")
    assert run.values["opened"] is not None
    assert run.values["opened"] > 0.9
    assert set(run.families) == {"KV7"}
    worse = replace(run, values={**run.values, "opened": 0.3})
    found = compare([worse], {run.place: [run]}, same_machine=True)
    assert [(change.kind, change.subject, change.gate) for change in found] == [(ChangeKind.WORSE, "opened", True)]


def test_a_bad_folder_is_named_and_a_newer_night_is_refused(boxes: Path, tmp_path: Path) -> None:
    first = night(boxes, tmp_path)
    (tmp_path / "notes").mkdir()
    header = json.loads((first.place / "night.json").read_text())
    (first.place / "night.json").write_text(json.dumps({**header, "schema": 1}))
    second = night(boxes, tmp_path)
    assert kinds(second) == {"new series": 2}
    assert sorted(Path(notice.split()[0]).name for notice in second.notices) == sorted([first.place.name, "notes"])
    (first.place / "night.json").write_text(json.dumps({**header, "schema": 99}))
    with pytest.raises(InputError, match="newer"):
        night(boxes, tmp_path)


def test_the_smoke_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The whole command, validation in an engine included, on an object of the generator."""
    small = tmp_path / "small.yaml"
    small.write_text("extends: nightly\nsources: [truth]\n")
    out = tmp_path / "nights"
    assert run_command(["nightly", "--smoke", "--config", str(small), "-o", str(out), "--json", "-"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert (answer["schema"], answer["gate"], answer["runs"], answer["objects"]) == (2, "pass", 4, 2)
    assert answer["counts"]["new series"] == 4
    name = Path(answer["folder"]).name
    assert run_command(["nightly", "-o", str(out), "--accept", name]) == 0
    assert json.loads((out / "baseline.json").read_text())["night"] == name
    assert run_command(["nightly", "-o", str(out), "--accept", "none"]) == 2
    runs = [json.loads(line) for line in (out / name / "runs.jsonl").read_text().splitlines()]
    assert {run["families"].get("KV8") for run in runs if run["what"] == "validation"} == {"pass"}
