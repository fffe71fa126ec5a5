"""The MuJoCo stage: quiet on what is fine, and each kind of finding once, with the right joint, pair and cause."""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from kinematify.config.validation import load_settings
from kinematify.robot.mechanism import LeaderMechanism, sweep_rows
from kinematify.robot.read import read_robot
from kinematify.simulation.prepared import URDF_FILE, load_prepared, prepare
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks import checks_of
from kinematify.validation.checks.engine_rest import find_drop, find_growth
from kinematify.validation.checks.engine_stability import find_unstable
from kinematify.validation.engine_context import RunEnd
from kinematify.validation.finding import Cause, Finding, Severity, Status
from kinematify.validation.stage import StageRequest
from kinematify.validation.stages import run_engine as engine_stage
from tests.places import BENCH
from tests.validation.engine_models import (
    Box,
    FindingGroup,
    Model,
    Part,
    cabinet,
    engine_settings,
    prepared_request,
    tell,
)

IDS = {check.id for check in checks_of("KV4")}
run = partial(engine_stage.run, engine="mujoco")
PANDA = BENCH / "robots/panda/model.urdf"


def reported(model: Model, folder: Path, **settings: float) -> FindingGroup:
    return tell(run, prepared_request(model, folder, engine_settings(**settings)))


def only(result: FindingGroup, check: str) -> Finding:
    (finding,) = [f for f in result.results[check].findings if f.severity is not Severity.NOTE]
    return finding


def pendulum(**changes: object) -> Model:
    base = Part(name="base", boxes=(Box(size=(0.1, 0.1, 0.1)),))
    rod = Part(
        name="rod",
        parent="base",
        kind="revolute",
        boxes=(Box(size=(0.4, 0.02, 0.02), at=(0.2, 0.0, 0.0)),),
        at=(0.06, 0.0, 0.1),
        axis=(0.0, 1.0, 0.0),
        limits=(-1.0, 1.0),
        center=(0.2, 0.0, 0.0),
    )
    return Model(parts=(base, rod)).with_part("rod", **changes)


def test_good_cabinet_passes_every_check(tmp_path: Path) -> None:
    result = reported(cabinet(), tmp_path)
    assert set(result.results) == IDS
    skipped = {check: r.reason for check, r in result.results.items() if r.status is not Status.PASS}
    assert skipped == {"KV413": "no loop joint closes a chain"}
    assert not any(r.findings for r in result.results.values())
    assert result.results["KV405"].measured["arrived"] == 4


def test_drawer_that_opens_inwards_is_an_error_of_its_joint(tmp_path: Path) -> None:
    result = reported(cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)), tmp_path)
    finding = only(result, "KV405")
    assert (finding.severity, finding.cause) == (Severity.ERROR, Cause.KINEMATICS)
    assert (finding.joint, finding.pair) == ("drawer_joint", ("body", "drawer"))
    assert finding.value == pytest.approx(0.01, abs=0.01)  # 5 mm of room, and what a contact gives way by
    assert finding.limit == 0.3
    curve = next(curve for curve in result.curves if curve.joint == "drawer_joint" and curve.upper)
    assert curve.engine == "mujoco"
    assert curve.commanded[-1] == pytest.approx(0.3)
    assert max(curve.reached) < 0.05 < curve.commanded[-1], "it stays where the wall is"
    assert max(map(abs, curve.force)) > 0.0


def test_stop_at_a_body_without_collision_geometry_is_a_note(tmp_path: Path) -> None:
    inwards = cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0))
    findings = reported(inwards.with_part("body", collision=()), tmp_path).results["KV405"].findings
    assert [(item.joint, item.severity) for item in findings] == [("drawer_joint", Severity.NOTE)]


def test_stop_names_the_link_that_is_met_on_this_way(tmp_path: Path) -> None:
    cube = (Box(size=(0.1, 0.1, 0.1)),)
    walls = [
        Part(name="front", parent="base", boxes=(Box(size=(0.1, 1.0, 0.1)),), at=(0.3, 0.0, 0.2)),
        Part(name="side", parent="base", boxes=(Box(size=(1.0, 0.3, 0.1)),), at=(0.0, 0.4, 0.2)),
    ]
    base = Part(name="base", boxes=(Box(size=(1.0, 1.0, 0.1)),), mass=20.0)
    sled = Part(name="sled", parent="base", kind="prismatic", boxes=cube, at=(0.0, 0.0, 0.1), limits=(0.0, 0.3))
    box = Part(name="box", parent="sled", kind="prismatic", boxes=cube, at=(0.0, 0.0, 0.1), limits=(0.0, 0.3),
               axis=(0.0, 1.0, 0.0))  # fmt: skip
    findings = reported(Model(parts=(base, *walls, sled, box)), tmp_path).results["KV405"].findings
    assert {f.joint: f.pair for f in findings} == {"sled_joint": ("front", "box"), "box_joint": ("side", "box")}


def test_stop_at_a_part_that_can_move_itself_is_a_note(tmp_path: Path) -> None:
    post = Part(
        name="post",
        parent="body",
        kind="prismatic",
        boxes=(Box(size=(0.02, 0.1, 0.1)),),
        at=(0.35, -0.155, 0.0),
        axis=(0.0, 0.0, 1.0),
        limits=(0.0, 0.5),
    )
    result = reported(Model(parts=(*cabinet().parts, post)), tmp_path)
    (finding,) = result.results["KV405"].findings
    assert (finding.severity, finding.cause) == (Severity.NOTE, Cause.KINEMATICS)
    assert (finding.joint, finding.pair) == ("drawer_joint", ("drawer", "post"))


def test_stop_at_a_neighbour_whose_contacts_engines_leave_out_is_a_note(tmp_path: Path) -> None:
    arm = Part(name="arm", parent="body", kind="prismatic", boxes=cabinet().parts[0].boxes, at=(2.0, 0.0, 0.0))
    parts = tuple(replace(part, parent="arm") if part.parent == "body" else part for part in cabinet().parts)
    model = Model(parts=(parts[0], arm, *parts[1:])).with_part("drawer", axis=(-1.0, 0.0, 0.0))
    (finding,) = reported(model, tmp_path).results["KV405"].findings
    assert (finding.severity, finding.cause) == (Severity.NOTE, Cause.KINEMATICS)
    assert (finding.joint, finding.pair) == ("drawer_joint", ("arm", "drawer"))


def test_overlap_at_rest_of_parts_that_no_joint_connects(tmp_path: Path) -> None:
    door = {"at": (0.19, 0.32, 0.0), "boxes": (Box(size=(0.02, 0.4, 0.3), at=(0.0, -0.2, 0.0)),)}
    result = reported(cabinet().with_part("door", **door), tmp_path)
    finding = only(result, "KV403")
    assert finding.pair == ("drawer", "door")
    assert finding.value == pytest.approx(0.015, abs=1e-4)
    note = next(f for f in result.results["KV403"].findings if f.severity is Severity.NOTE)
    assert "body and door" in note.message


def test_convex_hull_of_a_hollow_body_stops_no_drawer(tmp_path: Path) -> None:
    request = prepared_request(cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)), tmp_path)
    record = tmp_path / "prepared.json"
    record.write_text(record.read_text(encoding="utf-8").replace('"method": "primitives"', '"method": "hull"'))
    result = tell(run, request)
    assert result.worst("KV405") == []


def test_weak_motor_sags(tmp_path: Path) -> None:
    result = reported(pendulum(effort=3.0), tmp_path)
    finding = only(result, "KV404")
    assert (finding.severity, finding.joint, finding.unit) == (Severity.WARNING, "rod_joint", "N m")
    assert finding.value == pytest.approx(2.0 * 9.81 * 0.2)
    assert finding.limit == 3.0
    assert result.results["KV408"].status is Status.PASS
    assert result.results["KV404"].measured["drift_rad"] > 0.9


def test_strong_motor_holds(tmp_path: Path) -> None:
    assert reported(pendulum(effort=5.0), tmp_path).results["KV404"].status is Status.PASS


def test_stiff_joint_is_driven_against_its_friction(tmp_path: Path) -> None:
    light = {"mass": 0.01, "inertia": (2e-6, 1.4e-4, 1.4e-4), "extra": '<dynamics damping="2.0" friction="4.0"/>'}
    result = reported(pendulum(**light), tmp_path)
    assert result.results["KV405"].status is Status.PASS
    assert result.results["KV405"].measured["arrived"] == 2


def test_loads_what_the_file_says_or_says_so(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    urdf = tmp_path / URDF_FILE
    text = urdf.read_text(encoding="utf-8")
    urdf.write_text(text.replace('upper="0.3"', 'upper="0.4"').replace('mass value="20.0"', 'mass value="21.0"'))
    findings = tell(run, request).results["KV401"].findings
    assert {(f.joint, f.link) for f in findings} == {("drawer_joint", None), (None, "body")}
    assert {f.severity for f in findings} == {Severity.ERROR}


def test_link_that_stands_elsewhere_is_named(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    urdf = tmp_path / URDF_FILE
    text = urdf.read_text(encoding="utf-8")
    assert text.count("-0.155") == 1
    urdf.write_text(text.replace("-0.155", "-0.154"))
    finding = only(tell(run, request), "KV402")
    assert finding.link == "drawer"
    assert finding.value == pytest.approx(0.001)


def test_refused_model_blocks_the_rest(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    urdf = tmp_path / URDF_FILE
    urdf.write_text(urdf.read_text(encoding="utf-8").replace('mass value="2.0"', 'mass value="0"'))
    result = tell(run, request)
    assert only(result, "KV401").severity is Severity.ERROR
    assert {r.status for check, r in result.results.items() if check != "KV401"} == {Status.BLOCKED}
    assert set(result.results) == IDS


def test_inertia_at_the_edge_of_what_can_be_is_balanced(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    urdf = tmp_path / URDF_FILE
    text = urdf.read_text(encoding="utf-8")
    assert 'izz="0.05"' in text
    urdf.write_text(text.replace('izz="0.05"', 'izz="0.10000001"'))
    result = tell(run, request)
    finding = only(result, "KV401")
    assert (finding.severity, finding.cause) == (Severity.WARNING, Cause.PHYSICS)
    assert result.results["KV405"].status is Status.PASS


def test_link_called_world_is_a_link(tmp_path: Path) -> None:
    body, *others = cabinet().parts
    renamed = Model(parts=(Part(name="world", boxes=()), replace(body, parent="world", at=(0.0, 0.0, 1.0)), *others))
    result = reported(renamed, tmp_path)
    assert {check for check, r in result.results.items() if r.status is not Status.PASS} == {"KV413"}


def test_follower_goes_along(tmp_path: Path) -> None:
    finger = Part(
        name="left",
        parent="palm",
        kind="prismatic",
        boxes=(Box(size=(0.02, 0.02, 0.1)),),
        at=(0.02, 0.0, 0.1),
        limits=(0.0, 0.04),
        mass=0.1,
        inertia=(1e-4, 1e-4, 1e-4),
    )
    mimic = '<mimic joint="left_joint" multiplier="1" offset="0"/>'
    other = replace(finger, name="right", at=(-0.02, 0.0, 0.1), axis=(-1.0, 0.0, 0.0), extra=mimic)
    palm = Part(name="palm", boxes=(Box(size=(0.2, 0.05, 0.05)),))
    model = Model(parts=(palm, finger, other))
    result = reported(model, tmp_path)
    assert result.results["KV405"].measured == {"drives": 2.0, "arrived": 2.0}
    assert result.results["KV402"].status is Status.PASS


def test_follower_with_less_room_than_its_leader_stops_it_without_contact(tmp_path: Path) -> None:
    mimic = '<mimic joint="rod_joint" multiplier="1" offset="0"/>'
    follower = replace(pendulum().parts[1], name="short", at=(0.06, 0.3, 0.1), limits=(-1.0, 0.3), extra=mimic)
    result = reported(Model(parts=(*pendulum().parts, follower)), tmp_path)
    finding = only(result, "KV405")
    assert (finding.joint, finding.pair, finding.cause) == ("rod_joint", None, Cause.PHYSICS)


def test_soft_stop_is_reported(tmp_path: Path) -> None:
    result = reported(cabinet(), tmp_path, push=20.0, escape=0.002, servo_margin=300.0)
    assert {f.joint for f in result.results["KV409"].findings} >= {"drawer_joint"}


def test_coarse_steps_are_reported(tmp_path: Path) -> None:
    result = reported(pendulum(kind="continuous"), tmp_path, time_step=0.05, step_difference=0.01)
    assert [(f.severity, f.joint) for f in result.results["KV412"].findings] == [(Severity.NOTE, "rod_joint")]


def test_growth_of_energy_is_a_finding() -> None:
    steps, reported_as = np.linspace(0.0, 1.0, 50), {"floor": 0.01, "share": 0.1, "how": "Released"}
    check = OpenCheck(id="KV408", engine="mujoco")
    find_growth(check, np.stack([10.0 - 5.0 * steps, 5.0 * steps], axis=1), **reported_as)
    assert check.findings == []
    find_growth(check, np.stack([10.0 - 5.0 * steps, 6.0 * steps], axis=1), **reported_as)
    assert [f.value for f in check.findings] == [pytest.approx(1.0)]


def test_blow_up_is_an_error(tmp_path: Path) -> None:
    request = prepared_request(pendulum(kind="continuous", effort=1e15), tmp_path, engine_settings(servo_frequency=1e6))
    result = tell(run, request)
    assert Severity.ERROR in {f.severity for f in result.results["KV407"].findings}
    assert result.results["KV410"].findings


def test_flying_link_is_a_warning() -> None:
    check = OpenCheck(id="KV407", engine="mujoco")
    slow = RunEnd(when="it was released", speed=5.0, warnings=())
    fast = RunEnd(when="arm was driven", speed=50.0, warnings=(), joint="arm")
    driven = RunEnd(when="wheel was driven", speed=50.0, warnings=(), joint="wheel", drive_speed=40.0)
    find_unstable(check, [slow, fast, driven], size=1.0, explosion=3.0)
    assert [(f.severity, f.joint) for f in check.findings] == [(Severity.WARNING, "arm")]


def test_drop_that_does_not_end(tmp_path: Path) -> None:
    finding = reported(cabinet(), tmp_path, drop_seconds=0.11).results["KV411"].findings[0]
    assert (finding.severity, finding.unit) == (Severity.NOTE, "m/s")
    check = OpenCheck(id="KV411", engine="mujoco")
    find_drop(check, depth=0.02, speed=0.0, size=0.5, settings=load_settings().engines)
    assert [f.severity for f in check.findings] == [Severity.WARNING]
    find_drop(check, depth=0.02, speed=0.0, size=3.0, settings=load_settings().engines)
    assert len(check.findings) == 1, "it is large"


def test_nobody_sees_a_limit_that_gives_way_by_a_tenth_of_a_millimetre(tmp_path: Path) -> None:
    results = reported(cabinet().with_part("drawer", limits=(0.0, 0.002)), tmp_path).results
    found = [item for check in ("KV404", "KV409") for item in results[check].findings if item.joint == "drawer_joint"]
    assert found == []


def test_model_without_joints_is_skipped_with_a_reason(tmp_path: Path) -> None:
    result = reported(Model(parts=cabinet().parts[:1]), tmp_path)
    skipped = {check for check, r in result.results.items() if r.status is Status.SKIPPED}
    assert skipped == {"KV404", "KV405", "KV406", "KV408", "KV409", "KV412", "KV413"}
    assert {r.reason for r in result.results.values() if r.status is Status.SKIPPED} == {"no joint moves"}


def test_late_stage_says_what_it_left_out(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path, seconds=-1.0)
    result = tell(run, request)
    assert set(result.results) == IDS
    assert result.results["KV405"].status is Status.SKIPPED


def test_sweep_moves_one_joint_at_a_time(tmp_path: Path) -> None:
    mechanism = LeaderMechanism(robot=read_robot(cabinet().write(tmp_path)))
    rows = mechanism.sweep(5)
    assert rows.shape == (11, 2)
    np.testing.assert_array_equal(rows[sweep_rows(1, 5), 0], 0.0)
    np.testing.assert_allclose(rows[sweep_rows(1, 5), 1], np.linspace(0.0, 1.5, 5))
    assert mechanism.moved.tolist() == [[False, True, False], [False, False, True]]


@pytest.mark.skipif(not PANDA.is_file(), reason="the benchmark objects are not there")
def test_panda_has_no_error_and_is_quick(tmp_path: Path) -> None:
    settings = load_settings()
    prepare(read_robot(PANDA), tmp_path, settings.prepare)
    request = StageRequest(
        urdf=PANDA,
        package_dirs=(),
        work=tmp_path,
        settings=settings,
        selected=frozenset(IDS),
        deadline=time.process_time() + 100.0,
    )
    start = time.perf_counter()
    result = tell(run, request)
    assert time.perf_counter() - start < 10.0
    assert not any(f.severity is Severity.ERROR for r in result.results.values() for f in r.findings)
    assert {result.results[check].status for check in ("KV401", "KV402", "KV407", "KV408", "KV409")} == {Status.PASS}
    assert load_prepared(tmp_path).links


def test_empty_range_is_no_way_to_drive(tmp_path: Path) -> None:
    result = reported(cabinet().with_part("door", limits=(0.0, 0.0)), tmp_path)
    assert [(f.severity, f.joint) for f in result.results["KV401"].findings] == [(Severity.WARNING, "door_joint")]
    assert result.results["KV405"].measured["drives"] == 2
    assert not {r.status for r in result.results.values()} & {Status.BLOCKED}


def test_only_what_was_asked_for_is_reported(tmp_path: Path) -> None:
    request = replace(prepared_request(cabinet(), tmp_path), selected=frozenset({"KV402", "KV411"}))
    result = tell(run, request)
    assert set(result.results) == {"KV402", "KV411"}
