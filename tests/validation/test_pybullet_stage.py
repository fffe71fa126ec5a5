"""The PyBullet stage: quiet on what is fine, each kind of finding once, PyBullet's traps kept out of the figures."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
import trimesh

from kinematify.config.validation import load_settings
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.read import read_robot
from kinematify.simulation.prepared import URDF_FILE, load_prepared, prepare
from kinematify.simulation.pybullet_engine import PybulletEngine
from kinematify.validation.checks import checks_of
from kinematify.validation.finding import Cause, Finding, Severity, Status
from kinematify.validation.stages import run_engine as engine_stage
from tests.places import BENCH
from tests.validation.engine_models import Box, FindingGroup, Model, Part, cabinet, prepared_request, tell

IDS = {check.id for check in checks_of("KV5")}
run = partial(engine_stage.run, engine="pybullet")
PANDA = BENCH / "robots/panda/model.urdf"


def reported(model: Model, folder: Path) -> FindingGroup:
    return tell(run, prepared_request(model, folder))


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
    assert skipped == {"KV513": "no loop joint closes a chain"}
    assert result.results["KV505"].measured["arrived"] == 4


def test_drawer_that_opens_inwards_is_an_error_of_its_joint(tmp_path: Path) -> None:
    result = reported(cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)), tmp_path)
    finding = only(result, "KV505")
    assert (finding.severity, finding.cause) == (Severity.ERROR, Cause.KINEMATICS)
    assert (finding.joint, finding.pair) == ("drawer_joint", ("body", "drawer"))
    assert finding.value == pytest.approx(0.005, abs=0.012)  # the room behind it
    assert finding.limit == 0.3
    curve = next(curve for curve in result.curves if curve.joint == "drawer_joint" and curve.upper)
    assert curve.engine == "pybullet"
    assert curve.commanded[-1] == pytest.approx(0.3)
    assert max(curve.reached) < 0.05 < curve.commanded[-1], "it stays where the wall is"
    assert max(map(abs, curve.force)) > 0.0


def test_pair_that_touches_at_rest_stops_a_joint_although_it_does_not_act(tmp_path: Path) -> None:
    # The drawer fills the cabinet to its back: PyBullet must not push it out, and must not let it in.
    model = cabinet().with_part("drawer", boxes=(Box(size=(0.4, 0.27, 0.38)),), axis=(-1.0, 0.0, 0.0))
    result = reported(model, tmp_path)
    assert result.results["KV503"].measured["switched_off_pairs"] == 1.0
    finding = only(result, "KV505")
    assert (finding.joint, finding.pair) == ("drawer_joint", ("body", "drawer"))
    assert abs(finding.value or 0.0) < 0.05


def test_overlap_at_rest_names_the_pair(tmp_path: Path) -> None:
    block = Part(name="block", parent="drawer", kind="prismatic", boxes=(Box(size=(0.1, 0.1, 0.1)),), at=(0, 0.5, 0))
    finding = only(
        reported(Model(parts=(*cabinet().parts, block)).with_part("block", at=(0.2, 0.3, 0)), tmp_path), "KV503"
    )
    assert finding.severity is Severity.WARNING
    assert "block" in (finding.pair or ())


def test_weak_joint_does_not_hold(tmp_path: Path) -> None:
    result = reported(pendulum(effort=0.5), tmp_path)  # 2 kg at 0.2 m need 3.9 N m
    finding = only(result, "KV504")
    assert finding.joint == "rod_joint"
    assert finding.value == pytest.approx(2.0 * 9.81 * 0.2, rel=1e-3)
    assert finding.limit == 0.5


def test_released_pendulum_keeps_its_energy_and_its_limits(tmp_path: Path) -> None:
    result = reported(pendulum(), tmp_path)
    assert result.results["KV508"].status is Status.PASS
    assert result.results["KV508"].measured["kinetic_J"] > 1.0  # it really fell
    assert result.results["KV504"].measured["drift_rad"] > 0.9
    assert result.results["KV504"].status is Status.PASS


def test_follower_follows(tmp_path: Path) -> None:
    mimic = '<mimic joint="drawer_joint" multiplier="-1" offset="0"/>'
    other = Part(
        name="other",
        parent="body",
        kind="prismatic",
        boxes=(Box(size=(0.1, 0.27, 0.1)),),
        at=(1.0, 0.155, 0.0),
        limits=(-0.3, 0.0),
        extra=mimic,
    )
    model = Model(parts=(*(part for part in cabinet().parts if part.name != "door"), other))
    result = reported(model, tmp_path)
    assert result.results["KV505"].status is Status.PASS
    assert result.results["KV505"].measured["drives"] == 2  # the leader's


def test_other_mass_and_other_frame_in_the_engine_are_found(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    path = tmp_path / URDF_FILE
    text = path.read_text().replace('value="20.0"', 'value="21.0"').replace("0.205 0.32 0.0", "0.205 0.32 0.01")
    path.write_text(text)
    result = tell(run, request)
    mass, frame = only(result, "KV501"), only(result, "KV502")
    assert (mass.link, mass.severity, mass.value) == ("body", Severity.ERROR, 21.0)
    assert (frame.link, frame.severity) == ("door", Severity.ERROR)


def test_refused_file_blocks_the_rest_and_gives_the_cause(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    (tmp_path / URDF_FILE).write_text("<robot name='x'><link")
    (tmp_path / "pybullet.log").write_text("pybullet build time: today\nb3Error: cannot parse it\n")
    result = tell(run, request)
    assert set(result.results) == IDS
    assert "cannot parse it" in only(result, "KV501").message
    assert {r.status for check, r in result.results.items() if check != "KV501"} == {Status.BLOCKED}


def test_what_pybullet_prints_is_reported(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    (tmp_path / "pybullet.log").write_text("pybullet build time: today\nb3Warning: odd thing\n")
    finding = only(tell(run, request), "KV510")
    assert "odd thing" in finding.message


def test_no_time_is_said(tmp_path: Path) -> None:
    result = tell(run, prepared_request(cabinet(), tmp_path, seconds=-1.0))
    late = {check for check, r in result.results.items() if r.status is Status.SKIPPED and "time" in (r.reason or "")}
    assert {"KV504", "KV505", "KV506", "KV511"} <= late


def test_model_without_joints_is_looked_at_and_dropped(tmp_path: Path) -> None:
    result = reported(Model(parts=cabinet().parts[:1]), tmp_path)
    assert set(result.results) == IDS
    assert {r.status for r in result.results.values()} == {Status.PASS, Status.SKIPPED}
    assert result.results["KV511"].status is Status.PASS


def test_more_joints_than_pybullet_has_room_for_are_not_given_to_it(tmp_path: Path) -> None:
    parts = [Part(name="p0", boxes=())]
    parts += [Part(name=f"p{k}", boxes=(), parent=f"p{k - 1}", kind="revolute") for k in range(1, 130)]
    result = reported(Model(parts=tuple(parts)), tmp_path)
    assert {r.status for r in result.results.values()} == {Status.SKIPPED}


def test_contacts_do_not_depend_on_what_was_looked_at_before(tmp_path: Path) -> None:
    request = prepared_request(cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)), tmp_path)
    mechanism, prepared = LeaderMechanism(robot=read_robot(request.urdf)), load_prepared(tmp_path)
    loaded = PybulletEngine(settings=load_settings().engines, log=tmp_path / "log").load(prepared, mechanism)
    values = mechanism.all_values(mechanism.sweep(15))
    forth, back = (loaded.contacts(rows) for rows in (values, values[::-1]))
    last = len(values) - 1
    there = {(r, *pair): d for r, pair, d in zip(forth.row.tolist(), forth.links.tolist(), forth.depth, strict=True)}
    again = {
        (last - r, *pair): d for r, pair, d in zip(back.row.tolist(), back.links.tolist(), back.depth, strict=True)
    }
    assert there
    assert there == pytest.approx(again, abs=1e-9)


@pytest.mark.parametrize(("offset", "depth"), [(0.205, 0.0), (0.2005, 0.0), (0.19, 0.01), (0.15, 0.05)])
def test_margin_of_hulls_is_not_counted(tmp_path: Path, offset: float, depth: float) -> None:
    trimesh.creation.box((0.2, 0.2, 0.2)).export(tmp_path / "box.stl")
    collision = '<collision><geometry><mesh filename="box.stl"/></geometry></collision>'
    links = "".join(f'<link name="{name}">{collision}</link>' for name in "ab")
    joint = '<joint name="j" type="prismatic"><parent link="a"/><child link="b"/><limit lower="-1" upper="1"/></joint>'
    path = tmp_path / "two.urdf"
    path.write_text(f'<robot name="two">{links}{joint}</robot>')
    model = read_robot(path)
    prepared = prepare(model, tmp_path, load_settings().prepare)
    engine = PybulletEngine(settings=load_settings().engines, log=tmp_path / "log")
    contacts = engine.load(prepared, LeaderMechanism(robot=model)).contacts(np.array([[offset]]))
    assert np.max(contacts.depth, initial=0.0) == pytest.approx(depth, abs=2e-4)


def test_inertias_of_heavy_models_are_not_refused(tmp_path: Path) -> None:
    # PyBullet's inverse dynamics compares tensors with their transposes to 2e-16 kg m^2.
    model = pendulum(mass=5000.0, inertia=(311.7, 417.3, 523.9), axis=(0.36, 0.48, 0.8))
    request = prepared_request(model, tmp_path)
    assert not any(r.status is Status.BLOCKED for r in tell(run, request).results.values())
    robot = read_robot(request.urdf)
    engine = PybulletEngine(settings=request.settings.engines, log=tmp_path / "log")
    loaded = engine.load(load_prepared(tmp_path), LeaderMechanism(robot=robot))
    axis, lever = np.array([0.36, 0.48, 0.8]), np.array([0.2, 0.0, 0.0])
    expected = axis @ np.diag([311.7, 417.3, 523.9]) @ axis + 5000.0 * np.sum(np.cross(axis, lever) ** 2)
    np.testing.assert_allclose(loaded.measure(np.zeros((1, 1))).inertia.ravel(), expected, rtol=1e-6)


@pytest.mark.skipif(not PANDA.is_file(), reason="the benchmark objects are not there")
def test_panda_has_no_errors(tmp_path: Path) -> None:
    settings = load_settings()
    request = prepared_request(cabinet(), tmp_path, settings)  # for its fields
    prepare(read_robot(PANDA), tmp_path, settings.prepare)
    result = tell(run, type(request)(**{**vars(request), "urdf": PANDA.resolve()}))
    assert set(result.results) == IDS
    errors = [f for r in result.results.values() for f in r.findings if f.severity is Severity.ERROR]
    assert errors == []
    assert not any(r.status is Status.BLOCKED for r in result.results.values())
