"""Refining: it repairs what simulation shows to be wrong, keeps what is right, and cannot win by cheating."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh

import kinematify
from kinematify.assembly.part import Assembly, Part
from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.config.validation import ValidationSettings, load_settings
from kinematify.joints.candidate import JointCandidate, JointEstimate
from kinematify.model.simulable import simulable_model
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.inference import Inference
from kinematify.pipeline.record import file_hashes, write_inference
from kinematify.refinement import loop
from kinematify.refinement.choose import LEAD_ELSEWHERE, Chooser, Trial
from kinematify.refinement.folder import open_model_folder, read_record
from kinematify.refinement.hints import parse_hints, with_hints
from kinematify.refinement.joint_plan import Plan
from kinematify.refinement.loop import Refinement, refine
from kinematify.refinement.simulate import Simulator
from kinematify.robot.joint_type import JointType
from kinematify.validation.failure_rates import LINE, TYPE, shipped_rates
from kinematify.validation.finding import Severity
from tests.inferred import inferred, write_inferred

CONFIG = load_config()
SETTINGS = load_settings()


def joint_above(inference: Inference, child: str) -> JointEstimate:
    number = inference.assembly.names.index(child)
    return next(joint for joint in inference.joints if joint.child == number)


def with_joint(inference: Inference, child: str, **changes: object) -> Inference:
    """The inference as if it had chosen otherwise for one part; the right candidate stays among its alternatives."""
    wrong = replace(joint_above(inference, child), **changes)
    joints = tuple(wrong if joint.child == wrong.child else joint for joint in inference.joints)
    return replace(inference, joints=joints)


def mistaken(inference: Inference, child: str, axis: tuple[float, float, float], lead: float = 0.5) -> Inference:
    """A slide along another axis, which its evidence prefers by `lead`."""
    right = joint_above(inference, child)
    candidate = JointCandidate(
        kind=JointType.PRISMATIC, axis=np.array(axis), pivot=right.pivot, score=right.alternatives[0].score + lead,
        source="planted",
    )  # fmt: skip
    return with_joint(
        inference, child, kind=JointType.PRISMATIC, axis=candidate.axis, lower=-0.2, upper=0.2,
        alternatives=(candidate, *right.alternatives),
    )  # fmt: skip


def askew() -> Inference:
    """The drawer along the front."""
    return mistaken(inferred("drawer"), "drawer", (1.0, 0.0, 0.0))


@cache
def refined() -> Refinement:
    return refine(askew())


@pytest.mark.parametrize("name", ["drawer", "lever"])
def test_what_is_right_stays_as_it_is(name: str) -> None:
    before = inferred(name)
    after = refine(before)
    assert after.history.kept == 0
    assert after.inference.joints == before.joints
    assert after.inference.trees == before.trees
    assert not after.interrupted


def test_a_drawer_along_the_wrong_axis_finds_the_right_one_again() -> None:
    right = joint_above(inferred("drawer"), "drawer")
    refinement = refined()
    found = joint_above(refinement.inference, "drawer")
    assert refinement.history.rounds[0].errors > 0
    assert refinement.history.rounds[refinement.history.kept].errors == 0
    assert abs(float(found.axis @ right.axis)) == pytest.approx(1.0, abs=1e-3)
    (change,) = refinement.history.changed
    assert (change.part, change.what) == ("drawer", "axis")


def test_a_joint_that_nothing_speaks_against_but_the_shape_is_measured_and_replaced() -> None:
    """It is no candidate, and no failure points to its line."""
    right = joint_above(inferred("edge_door"), "door")
    tilted = right.axis + np.array([0.0, 0.6, 0.0])
    refinement = refine(with_joint(inferred("edge_door"), "door", axis=tilted, upper=0.1))
    assert not {"door: axis", "door: type"} & set(refinement.history.rounds[0].suspected)
    assert refinement.history.rounds[0].score < -LEAD_ELSEWHERE
    found = joint_above(refinement.inference, "door")
    assert abs(float(found.axis @ right.axis)) == pytest.approx(1.0, abs=1e-3)


def test_a_joint_that_is_stopped_after_a_hair_moves_however_shallow_the_contact() -> None:
    level = mistaken(inferred("drawer"), "drawer", (1.0, 0.0, 0.0), lead=0.0)
    for settings in (SETTINGS, with_wrong_depth(10.0)):
        refinement = refine(level, settings=settings)
        assert "KV310 drawer_joint" in refinement.history.rounds[0].failed
        assert refinement.history.changed


def test_a_hint_is_kept_against_failures_and_both_are_reported() -> None:
    start = askew()
    hinted = with_hints(start, parse_hints(["drawer:axis=x"], start.assembly.names))
    blocked = with_joint(hinted, "drawer", lower=-0.2, upper=0.2)
    refinement = refine(blocked)
    assert abs(float(joint_above(refinement.inference, "drawer").axis[0])) == pytest.approx(1.0)
    assert any("a hint asked for" in refused for item in refinement.history.rounds for refused in item.refused)


@pytest.mark.parametrize("short", [-50.0, LEAD_ELSEWHERE - 0.2])
def test_evidence_of_shape_can_outweigh_the_simulation(short: float) -> None:
    """Blocked both ways is not enough for another direction to lead by less than it has to."""
    blocked = max(shipped_rates().weight("KV310", Severity.ERROR, wrong) for wrong in (LINE, TYPE))
    lead = blocked - short
    sure = mistaken(inferred("drawer"), "drawer", (1.0, 0.0, 0.0), lead=lead)
    refinement = refine(sure)
    assert joint_above(refinement.inference, "drawer").kind is JointType.PRISMATIC
    assert refinement.history.changed == ()


def test_a_range_beyond_the_free_travel_ends_there_and_not_far_below() -> None:
    """Where the door goes into its wall so deep that it is an error; a scratch by which right joints warn too stays."""
    right = joint_above(inferred("edge_door"), "door")
    wide = with_joint(inferred("edge_door"), "door", upper=4.5)
    found = joint_above(refine(wide, settings=with_wrong_depth(0.0)).inference, "door")
    assert right.upper <= found.upper < 4.5
    assert found.upper > 2.25
    assert joint_above(refine(wide, settings=with_wrong_depth(10.0)).inference, "door").upper == 4.5


def with_wrong_depth(depth: float) -> ValidationSettings:
    """The settings of the validation with another depth from which on an overlap is an error."""
    return SETTINGS.model_copy(update={"geometry": SETTINGS.geometry.model_copy(update={"wrong": depth})})


def cell() -> Inference:
    """A cube in a closed box that leaves it a tenth of a millimetre on every side."""
    wall, room = 0.02, 0.0501
    walls = [
        trimesh.creation.box(extents=np.where(np.arange(3) == axis, wall, 2 * (room + wall))).apply_translation(
            sign * (room + 0.5 * wall) * np.eye(3)[axis]
        )
        for axis in range(3)
        for sign in (-1.0, 1.0)
    ]
    shell, core = trimesh.util.concatenate(walls), trimesh.creation.box(extents=[0.1] * 3)
    parts = [Part(name=name, vertices=m.vertices, faces=m.faces) for name, m in (("shell", shell), ("core", core))]
    return infer(Assembly(parts=tuple(parts), source="cell"), config=CONFIG, base="shell")


def test_what_no_near_best_joint_can_move_is_fixed_with_its_evidence() -> None:
    middle = np.zeros(3)
    slide, turn = (
        JointCandidate(kind=kind, axis=np.eye(3)[axis], pivot=middle, score=-0.1 * axis, source="planted")
        for axis, kind in enumerate((JointType.PRISMATIC, JointType.REVOLUTE))
    )
    loose = with_joint(
        cell(), "core", kind=JointType.PRISMATIC, axis=slide.axis, pivot=middle, lower=-0.1, upper=0.1,
        alternatives=(slide, turn),
    )  # fmt: skip
    refinement = refine(loose)
    assert joint_above(refinement.inference, "core").kind is JointType.FIXED
    (change,) = refinement.history.changed
    assert (change.part, change.what) == ("core", "fixed")
    assert "blocked to both sides" in change.why


def test_the_best_round_is_kept_even_if_later_ones_are_worse(monkeypatch: pytest.MonkeyPatch) -> None:
    good = inferred("drawer")
    worse = askew()

    def choose_badly(self: loop._Loop, done: loop._Done) -> object:
        change = loop.PlanChange(part="drawer", what="axis", before="a", after="b", why="planted")
        return Plan(inference=worse), [change], []

    monkeypatch.setattr(loop._Loop, "_choose", choose_badly)
    refinement = refine(good, rounds=1)
    assert [item.errors > 0 for item in refinement.history.rounds] == [False, True]
    assert refinement.history.kept == 0
    assert refinement.inference.joints == good.joints


def test_rounds_are_bounded() -> None:
    start = askew()
    history = refine(start, rounds=0).history
    assert len(history.rounds) == 1
    assert history.candidates == 0


def test_history_is_written_and_a_second_refinement_goes_on_from_the_first(tmp_path: Path) -> None:
    found = refined().inference
    write_inference(found, tmp_path / "out", preview=False)
    record = json.loads((tmp_path / "out" / "inference.json").read_text())
    assert record["refinement"]["kept"] == 1
    assert [item["number"] for item in record["refinement"]["rounds"]] == [0, 1]
    assembly, config = open_model_folder(tmp_path / "out")
    assert assembly.names == found.assembly.names
    for one, other in zip(assembly.parts, found.assembly.parts, strict=True):
        assert np.abs(one.bounds - other.bounds).max() < 1e-6
    assert config == CONFIG


def test_refine_command_and_its_refusals(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    write_inferred("drawer", out)
    (out / "notes.txt").write_text("mine")
    before, other = file_hashes(out), tmp_path / "refined"
    assert run(["refine", str(out), "-o", str(other), "--no-preview", "--json", "-"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["passes"]
    assert answer["refinement"]["kept"] == 0
    assert answer["out"] == str(other)
    assert file_hashes(out) == before
    assert "refinement" not in read_record(out) or read_record(out)["refinement"] is None
    assert read_record(other)["refinement"]["kept"] == 0
    assert (other / "notes.txt").read_text() == "mine"
    assert run(["refine", str(out), "--force", "--no-preview"]) == 0
    assert "Kept: the model as it was inferred" in capsys.readouterr().out
    assert read_record(out)["refinement"]["kept"] == 0
    assert (out / "notes.txt").read_text() == "mine"
    assert run(["refine", str(out), "--force", "--base", "nobody"]) == 2
    assert run(["refine", str(tmp_path), "--force"]) == 2
    assert "There is no inference.json" in capsys.readouterr().err
    urdf = out / "model.urdf"
    urdf.write_text(urdf.read_text().replace("prismatic", "revolute"))
    assert run(["refine", str(out), "--force"]) == 2
    assert "was changed or removed since" in capsys.readouterr().err


def test_refine_replaces_no_folder_unasked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, other = tmp_path / "out", tmp_path / "other"
    write_inferred("drawer", out)
    write_inferred("drawer", other)
    before = read_record(out)
    refusals = {
        (): ["The refined model would replace the one in", "Give -o OUT"],
        ("-o", str(other)): ["exists already"],
        ("-o", str(out)): ["exists already"],
        ("-o", str(out / "refined"), "--force"): ["lies in the other"],
    }
    for words, said in refusals.items():
        assert run(["refine", str(out), *words]) == 2
        error = capsys.readouterr().err
        assert all(text in error for text in said), error
        assert len(error.splitlines()) <= 2
    assert read_record(out) == read_record(other) == before
    assert run(["refine", str(out), "-o", str(other), "--force", "--no-preview", "--no-validation"]) == 0
    assert read_record(out) == before
    assert read_record(other)["refinement"]["kept"] == 0


def test_a_folder_without_candidates_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_inferred("drawer", tmp_path / "out")
    path = tmp_path / "out" / "inference.json"
    record = json.loads(path.read_text())
    for joint in record["joints"]:
        del joint["candidates"]
    path.write_text(json.dumps(record))
    assert run(["refine", str(tmp_path / "out"), "--force"]) == 2
    assert "has no candidates of the joint of drawer" in capsys.readouterr().err


def test_ctrl_c_in_the_middle_of_a_trial_keeps_the_best_round_and_a_whole_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    write_inference(askew(), out, preview=False)
    whole = Chooser.trial

    def stopped(self: Chooser, joint: JointEstimate, score: float) -> Trial:
        whole(self, joint, score)
        raise KeyboardInterrupt

    monkeypatch.setattr(Chooser, "trial", stopped)
    assert run(["refine", str(out), "--force", "--no-preview"]) == 130
    record = read_record(out)
    assert [item["number"] for item in record["refinement"]["rounds"]] == [0]
    assert record["refinement"]["ended"] == "it was interrupted"
    assert record["files"] == file_hashes(out), "nothing is half-written"
    open_model_folder(out)


def test_simulation_in_memory_says_what_validate_says(tmp_path: Path) -> None:
    bad = askew()
    mine = Simulator(bad.model, SETTINGS.geometry).judge(bad.model).findings
    write_inference(bad, tmp_path / "out", preview=False)
    checks = ["KV301", "KV302", "KV303", "KV310", "KV311", "KV312", "KV320", "KV321"]
    report = kinematify.validate(tmp_path / "out" / "model.urdf", checks=checks, engines=())
    theirs = [item for item in report.findings if item.check in checks]
    assert sorted((item.check, item.joint) for item in mine) == sorted((item.check, item.joint) for item in theirs)
    assert any(item.severity is Severity.ERROR for item in mine)


def test_collision_geometry_is_cut_by_what_simulation_moved() -> None:
    """As it is where nothing was moved yet, but for rounding; what was free is not asked again; others are.

    What moves freely was not moved beyond its range.
    """
    bad = askew()
    moved = {sweep.travel.joint: sweep for sweep in Simulator(bad.model, SETTINGS.geometry).judge(bad.model).sweeps}
    free = {
        name: replace(sweep, sides=tuple(replace(side, meetings=()) for side in sweep.sides))
        for name, sweep in moved.items()
    }
    fresh, known, blind = (simulable_model(bad.model, CONFIG, swept=swept).record() for swept in (None, moved, free))
    stops, found = fresh.pop("blocked"), known.pop("blocked")
    assert fresh == known
    assert stops
    for stop, moment in zip(stops, found, strict=True):  # written models are rounded
        assert stop | {"depth": moment["depth"]} == moment
        assert stop["depth"] == pytest.approx(moment["depth"], abs=1e-8)
    assert not blind["blocked"]
    right = loop.repaired(inferred("drawer"))
    assert set(right.swept) == {joint.name for joint in right.model.joints if joint.kind is not JointType.FIXED}
    assert all(side.reached == side.declared for sweep in right.swept.values() for side in sweep.sides)
    assert not with_joint(right, "drawer", upper=0.1).swept
