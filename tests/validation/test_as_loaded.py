"""KV8xx: the untouched file in plain engines; quiet on what works, and what is said can be seen without Kinematify."""

from __future__ import annotations

import subprocess
import sys
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import trimesh

from kinematify.config.validation import load_settings
from kinematify.simulation.engine_runs import drive, overlaps, rest, row, script
from kinematify.simulation.engines import DEFAULT_ENGINES, open_engine
from kinematify.simulation.world import OpenedFile
from kinematify.validation.as_loaded_context import AsLoadedContext
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, CheckResult, Finding, Severity, Status, not_finished
from kinematify.validation.run import needs, validate
from kinematify.validation.run.conclusion import concluded
from kinematify.validation.run.report import (
    as_loaded_words,
    contract_words,
)
from kinematify.validation.stage import StageRequest
from tests.validation.engine_models import Box, FindingGroup, Model, Part, cabinet, tell

ENGINES = ("mujoco", "pybullet")
each_engine = pytest.mark.parametrize("engine", ENGINES)
CONTRACT = ("KV820", "KV821")
WALL = Box(size=(0.02, 0.64, 0.4), at=(0.35, 0.0, 0.0))
"""In front of the cabinet: the drawer gets 135 mm far, the door hits it too."""


def request_of(model: Model, folder: Path) -> StageRequest:
    return StageRequest(
        urdf=model.write(folder),
        package_dirs=(),
        work=folder,
        settings=load_settings(),
        selected=frozenset(CHECKS),
        deadline=time.process_time() + 100.0,
    )


def reported(model: Model, folder: Path, engine: str) -> FindingGroup:
    return tell(partial(needs.engine, name=engine), request_of(model, folder))


def collision(model: Model, name: str, *boxes: Box) -> Model:
    (part,) = (part for part in model.parts if part.name == name)
    return model.with_part(name, collision=(*part.boxes, *boxes))


def jamming() -> Model:
    """A cabinet whose drawer has collision geometry in the way of the door."""
    return collision(cabinet(), "drawer", Box(size=(0.02, 0.1, 0.1), at=(0.24, 0.25, 0.0)))


def counts(result: FindingGroup) -> dict[str, float]:
    """How many joints move in the file as it is loaded without flags."""
    measured = result.results["KV804"].measured
    return {name: measured[name] for name in ("joints", "right")}


def moved_with_contacts(result: FindingGroup) -> float:
    measured = result.results["KV804"].measured
    return measured.get("with_contacts", measured["right"])


def printed(code: str | None, line: int = -1) -> list[float]:
    """The numbers that the code of a report prints, run as it was copied."""
    assert code is not None
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return [float(word) for word in done.stdout.splitlines()[line].split() if not word.endswith("_joint")]


@each_engine
def test_a_good_cabinet_passes(tmp_path: Path, engine: str) -> None:
    result = reported(cabinet(), tmp_path, engine)
    assert {check: r.findings for check, r in result.results.items() if r.status is not Status.PASS} == {}
    assert counts(result) == {"joints": 2.0, "right": 2.0}


def test_pinocchio_reads_joints_and_limits(tmp_path: Path) -> None:
    good = reported(cabinet(), tmp_path, "pinocchio").results
    assert {check: r.status for check, r in good.items()} == {"KV801": Status.PASS, "KV807": Status.PASS}
    assert good["KV801"].measured == {"joints": 2.0, "read": 2.0}


@pytest.mark.parametrize("engine", [*ENGINES, "pinocchio"])
def test_a_link_that_an_engine_puts_elsewhere_is_named_with_its_joint(tmp_path: Path, engine: str) -> None:
    context = AsLoadedContext(request=request_of(cabinet(), tmp_path), engine=engine)
    drawer, shift = cabinet().parts[1], (0.0, 0.0, 0.01)
    other = cabinet().with_part("drawer", at=tuple(a + b for a, b in zip(drawer.at, shift, strict=True)))
    (tmp_path / "other").mkdir()
    vars(context)["loading"] = open_engine(engine, OpenedFile(urdf=other.write(tmp_path / "other"), root="body"))
    result = OpenCheck(id="KV807", engine=engine)
    CHECKS["KV807"].run(result, context)
    (finding,) = result.findings
    assert (finding.joint, finding.link) == ("drawer_joint", "drawer")
    assert finding.value == pytest.approx(0.01, abs=1e-6)


@pytest.mark.parametrize("engine", ["mujoco"])  # PyBullet lets no link collide with its parent
def test_a_drawer_that_jams_is_seen_by_the_code_of_the_report(tmp_path: Path, engine: str) -> None:
    result = reported(collision(cabinet(), "body", WALL), tmp_path, engine)
    (finding,) = (item for item in result.results["KV804"].findings if item.joint == "drawer_joint")
    assert (finding.severity, finding.cause, finding.pair) == (Severity.ERROR, Cause.PHYSICS, ("body", "drawer"))
    assert finding.value == pytest.approx(0.145, abs=0.01)
    assert "mm deep in each other" in finding.message
    assert printed(finding.reproduction) == pytest.approx([0.145], abs=0.01)
    assert len((finding.reproduction or "").splitlines()) <= 5 + 7, "five lines, of which the loop is folded"


@each_engine
def test_the_code_of_a_run_at_rest_repeats_it(tmp_path: Path, engine: str) -> None:
    flap = cabinet().with_part("door", axis=(0.0, 1.0, 0.0), limits=(-1.5, 1.5), mass=2000.0, center=(0.1, 0.0, 0.0))
    context = AsLoadedContext(request=request_of(flap, tmp_path), engine=engine)
    (door,) = (travel for travel in context.travels if travel.joint == "door_joint")
    way = context.way(context.passive_run, door)
    assert np.ptp(way) > 0.01, "it falls"
    code = script(context.loaded, "rest", context.values, joint=door.joint, seconds=context.settings.seconds)
    assert printed(code) == pytest.approx([way.min(), way.max()], abs=1e-6)


@each_engine
def test_siblings_that_jam_are_named_in_both_engines(tmp_path: Path, engine: str) -> None:
    result = reported(jamming(), tmp_path, engine)
    (finding,) = (item for item in result.results["KV804"].findings if item.joint == "door_joint")
    assert set(finding.pair or ()) == {"drawer", "door"}
    (reached,) = printed(finding.reproduction)
    assert reached == pytest.approx(finding.value, abs=0.1)
    assert reached < 0.95 * 1.5
    assert moved_with_contacts(result) == 1.0


def test_what_only_the_flag_for_contacts_shows_is_a_warning_and_plain_pybullet_moves_all(tmp_path: Path) -> None:
    result = reported(jamming(), tmp_path, "pybullet")
    (finding,) = result.results["KV804"].findings
    assert finding.severity is Severity.WARNING
    assert "PyBullet with URDF_USE_SELF_COLLISION" in finding.message
    assert result.results["KV804"].measured == {"joints": 2.0, "right": 2.0, "with_contacts": 1.0}
    words = as_loaded_words(list(result.results.values())).splitlines()
    assert words == [
        "as loaded: PyBullet 2 of 2 joints move",
        "with URDF_USE_SELF_COLLISION: PyBullet 1 of 2",
    ]


def test_a_pair_that_stops_a_joint_is_in_contact_at_the_value_that_is_named(tmp_path: Path) -> None:
    context = AsLoadedContext(request=request_of(jamming(), tmp_path), engine="pybullet")
    group = tell(partial(needs.engine, name="pybullet"), context.request)
    (finding,) = group.results["KV804"].findings
    assert finding.q is not None
    found = overlaps(context.loaded, {**context.values, **finding.q})
    assert finding.pair in [item.links for item in found]


def test_links_across_a_fixed_joint_do_not_jam_in_pybullet(tmp_path: Path) -> None:
    """Cylinders of a leg are 2 mm in each other where a fixed link is between them and their joint."""
    flange = Part(name="flange", parent="body", boxes=(), at=(0.0, 0.0, 0.1), mass=0.1)
    body = Part(name="body", boxes=(Box(size=(0.1, 0.1, 0.104), at=(0.0, 0.0, 0.05)),))
    thigh = Part(
        name="thigh", parent="flange", kind="revolute", boxes=(Box(size=(0.1, 0.1, 0.2), at=(0.0, 0.0, 0.1)),),
        axis=(0.0, 0.0, 1.0), limits=(-1.0, 1.0),
    )  # fmt: skip
    result = reported(Model(parts=(body, flange, thigh)), tmp_path, "pybullet")
    assert [check for check in ("KV802", "KV803", "KV804") if result.results[check].findings] == []
    assert result.results["KV804"].measured == {"joints": 1.0, "right": 1.0, "with_contacts": 1.0}


@pytest.mark.parametrize(
    "declared",
    [
        '<gazebo reference="drawer"><selfCollide>false</selfCollide></gazebo>',
        "<gazebo><self_collide>0</self_collide></gazebo>",
    ],
)
def test_a_link_that_is_declared_not_to_collide_with_its_model_does_not(tmp_path: Path, declared: str) -> None:
    request = request_of(jamming(), tmp_path)
    request.urdf.write_text(request.urdf.read_text().replace("</robot>", f"{declared}</robot>"))
    result = tell(partial(needs.engine, name="pybullet"), request)
    assert result.results["KV804"].findings == ()


FOLLOWS = '<mimic joint="door_joint" multiplier="0.2"/>'


@each_engine
def test_what_follows_a_joint_is_pushed_with_it(tmp_path: Path, engine: str) -> None:
    result = reported(cabinet().with_part("drawer", extra=FOLLOWS), tmp_path, engine)
    assert {check: r.findings for check, r in result.results.items() if r.status is not Status.PASS} == {}
    assert counts(result) == {"joints": 1.0, "right": 1.0}


@each_engine
def test_a_joint_jams_where_its_follower_does(tmp_path: Path, engine: str) -> None:
    post = Part(name="post", parent="body", boxes=(Box(size=(0.02, 0.2, 0.4), at=(0.85, -0.155, 0.0)),))
    model = Model(parts=(*cabinet().with_part("drawer", extra=FOLLOWS).parts, post))
    unseen = Box(size=(0.02, 0.2, 0.4), at=(0.35, -0.155, 0.0))
    result = reported(collision(model, "post", unseen), tmp_path, engine)
    if engine == "pybullet":
        assert result.results["KV804"].findings == (), "a fixed joint makes the post a neighbour of the drawer"
        return
    (finding,) = result.results["KV804"].findings
    assert finding.joint == "door_joint"
    assert "drawer" in (finding.pair or ()), "MuJoCo takes the post for a piece of the body"
    assert finding.value == pytest.approx(0.145 / 0.2, abs=0.1)
    assert printed(finding.reproduction) == pytest.approx([finding.value], abs=0.1)


@each_engine
def test_a_button_of_a_millimetre_is_pushed_too(tmp_path: Path, engine: str) -> None:
    result = reported(cabinet().with_part("drawer", limits=(0.0, 0.001)), tmp_path, engine)
    assert counts(result) == {"joints": 2.0, "right": 2.0}


def test_a_drawer_that_is_thrown_out_is_seen_by_the_code_of_the_report(tmp_path: Path) -> None:
    behind = Box(size=(0.1, 0.2, 0.2), at=(-0.16, -0.155, 0.0))
    result = reported(collision(cabinet(), "body", behind), tmp_path, "mujoco")
    (finding,) = result.results["KV803"].findings
    assert (finding.joint, finding.pair) == ("drawer_joint", ("body", "drawer"))
    least, largest = printed(finding.reproduction)
    assert max(-least, largest) == pytest.approx(finding.value)
    (overlap,) = result.results["KV802"].findings
    assert overlap.pair == ("body", "drawer")
    assert printed(overlap.reproduction) == pytest.approx([overlap.value])


def test_limits_that_mujoco_takes_for_none_do_not_hold(tmp_path: Path) -> None:
    stuck = cabinet().with_part("door", limits=(0.0, 0.0))
    results = reported(stuck, tmp_path, "mujoco").results
    (misread,) = results["KV801"].findings
    assert misread.joint == "door_joint"
    assert printed(misread.reproduction, line=1) == [-np.inf, np.inf]
    (finding,) = results["KV805"].findings[:1]
    assert (finding.severity, finding.joint, finding.limit) == (Severity.WARNING, "door_joint", 0.0)
    assert abs(printed(finding.reproduction)[0]) > 0.05
    assert reported(stuck, tmp_path, "pybullet").results["KV805"].status is Status.PASS


@each_engine
def test_what_turns_without_end_has_no_limits_to_hold(tmp_path: Path, engine: str) -> None:
    result = reported(cabinet().with_part("door", kind="continuous"), tmp_path, engine)
    assert result.results["KV805"].status is Status.PASS


@pytest.mark.parametrize("engine", ENGINES)
def test_negative_damping_gains_energy_as_the_code_of_the_report_shows(tmp_path: Path, engine: str) -> None:
    result = reported(cabinet().with_part("drawer", extra='<dynamics damping="-5"/>'), tmp_path, engine)
    (finding,) = result.results["KV806"].findings
    assert finding.severity is Severity.ERROR
    assert printed(finding.reproduction) == pytest.approx([finding.value], rel=0.1)


@pytest.mark.parametrize("kind", ["floating", "planar"])
@pytest.mark.parametrize("engine", ["mujoco", "pybullet", "pinocchio"])
def test_a_model_that_floats_is_opened(tmp_path: Path, engine: str, kind: str) -> None:
    body, *others = cabinet().parts
    floating = Model(parts=(Part(name="world", boxes=()), replace(body, parent="world", kind=kind), *others))
    results = reported(floating, tmp_path, engine).results
    assert not results["KV801"].findings
    states = {name: result.status.value for name, result in results.items()}
    assert {states[name] for name in states if name not in CONTRACT} <= {"pass", "skipped"}
    if engine == "mujoco":  # which holds the base of a file whose one free joint is at the root
        assert ("float" in (results["KV802"].reason or "")) is (kind == "planar")


def test_what_an_engine_does_not_open_is_reported_with_its_own_words(tmp_path: Path) -> None:
    result = reported(cabinet().with_part("drawer", mass=1e-20), tmp_path, "mujoco")
    (finding,) = result.results["KV801"].findings
    assert "mass" in finding.message
    assert finding.reproduction is not None
    done = subprocess.run([sys.executable, "-c", finding.reproduction], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "mass" in done.stderr
    assert {r.status for name, r in result.results.items() if name not in ("KV801", *CONTRACT)} == {Status.SKIPPED}
    assert result.results[CONTRACT[0]].status is Status.BLOCKED


def test_a_joint_moves_as_far_as_exact_geometry_leaves_free(tmp_path: Path) -> None:
    model = collision(cabinet(), "body", WALL)
    free = {"drawer_joint": (0.0, 0.14), "door_joint": (0.0, 0.3)}
    request = replace(request_of(model, tmp_path), free_travel=free)
    result = tell(partial(needs.engine, name="mujoco"), request)
    assert result.results["KV804"].status is Status.PASS


@pytest.mark.parametrize(("nearer", "reported_of"), [(0.0, False), (0.003, False), (0.02, True)])
def test_what_is_visible_ends_the_way_too_and_engines_may_touch_a_little_before(
    tmp_path: Path, nearer: float, reported_of: bool
) -> None:
    (body, *others) = cabinet().parts
    seen, in_the_way = (replace(WALL, at=(0.245 - less, 0.0, 0.0)) for less in (0.0, nearer))
    walled = replace(body, boxes=(*body.boxes, seen), collision=(*body.boxes, in_the_way))
    found = reported(Model(parts=(walled, *others)), tmp_path, "mujoco").results["KV804"].findings
    assert ("drawer_joint" in {item.joint for item in found}) == reported_of


def test_what_is_fixed_together_may_stand_in_each_other(tmp_path: Path) -> None:
    """PyBullet lets links touch that are fixed to each other with one between them; nothing moves them apart."""
    flange = Part(name="flange", parent="drawer", boxes=())
    tool = Part(name="tool", parent="flange", boxes=(Box(size=(0.1, 0.1, 0.1)),))
    model = Model(parts=(*cabinet().parts, flange, tool))
    assert reported(model, tmp_path, "pybullet").results["KV802"].status is Status.PASS


def jam(engine: str) -> CheckResult:
    finding = Finding(
        check="KV804",
        severity=Severity.ERROR,
        cause=Cause.PHYSICS,
        message="It jams.",
        remedy="Mend it.",
        joint="drawer_joint",
        engine=engine,
    )
    measured = {"joints": 2.0, "right": 1.0}
    return CheckResult(check="KV804", engine=engine, status=Status.FAIL, findings=(finding,), measured=measured)


def test_what_works_in_another_engine_is_a_warning_unless_the_engine_was_named() -> None:
    opened = [CheckResult(check="KV801", engine=engine, status=Status.PASS) for engine in ENGINES]
    right = replace(jam("pybullet"), status=Status.PASS, findings=(), measured={"joints": 2.0, "right": 2.0})
    one = [*opened, jam("mujoco"), right]
    (finding,) = concluded(one, None, DEFAULT_ENGINES)[2].findings
    assert (finding.severity, finding.message) == (Severity.WARNING, "It jams. It works in PyBullet.")
    assert concluded(one, None, tuple(ENGINES)[:1]) == tuple(one)
    late = replace(right, status=Status.SKIPPED, reason=not_finished("time ran out"))
    (finding,) = concluded([*opened, jam("mujoco"), late], None, DEFAULT_ENGINES)[2].findings
    assert (finding.severity, finding.message) == (Severity.ERROR, "It jams."), "what was measured stands"
    (finding,) = concluded([*opened, jam("mujoco"), late], None, ("mujoco",), named=False)[2].findings
    assert (finding.severity, finding.message) == (Severity.WARNING, "It jams. No other engine was asked.")
    refused = replace(jam("pybullet"), check="KV801", measured={})
    shut = replace(right, status=Status.SKIPPED, reason="PyBullet does not open the file (KV801)")
    (finding,) = concluded([jam("mujoco"), refused, shut], None, DEFAULT_ENGINES)[0].findings
    assert finding.severity is Severity.ERROR, "the other engine does not open the file"
    both = [*opened, jam("mujoco"), jam("pybullet")]
    assert concluded(both, None, DEFAULT_ENGINES) == tuple(both)
    assert as_loaded_words(one) == "as loaded: MuJoCo 1 of 2 joints move, PyBullet 2 of 2"


def energy(engine: str, *, gains: bool) -> CheckResult:
    finding = Finding(
        check="KV806",
        severity=Severity.ERROR,
        cause=Cause.ENGINE,
        engine=engine,
        message="It gains.",
        remedy="Mend it.",
    )
    status = Status.FAIL if gains else Status.PASS
    return CheckResult(check="KV806", engine=engine, status=status, findings=(finding,) if gains else ())


def test_energy_that_one_engine_alone_makes_is_its_time_step() -> None:
    mujoco, pybullet = concluded([energy("mujoco", gains=False), energy("pybullet", gains=True)], None, DEFAULT_ENGINES)
    assert (mujoco.status, pybullet.status) == (Status.PASS, Status.PASS)
    assert pybullet.findings[0].severity is Severity.NOTE
    (alone,) = concluded([energy("pybullet", gains=True)], None, DEFAULT_ENGINES)
    assert (alone.status, alone.findings[0].severity) == (Status.FAIL, Severity.WARNING)
    both = [energy("mujoco", gains=True), energy("pybullet", gains=True)]
    assert concluded(both, None, DEFAULT_ENGINES) == tuple(both)


def test_the_verdict_says_what_moves_as_loaded(tmp_path: Path) -> None:
    report = validate(cabinet().write(tmp_path), selected={"KV801", "KV802", "KV803", "KV804"})
    assert report.verdict == "pass"
    assert report.as_loaded == "as loaded: MuJoCo 2 of 2 joints move, PyBullet 2 of 2, Pinocchio reads 2 of 2"
    assert report.as_json()["as_loaded"] == report.as_loaded


@pytest.mark.parametrize(
    ("engine", "name", "quoted", "remedy"),
    [
        ("pybullet", "door.glb", "invalid mesh filename extension '.glb'", "not .glb: export them as .obj or .stl"),
        ("mujoco", "door.glb", "no decoder found", "not .glb: export them as .obj or .stl"),
        ("pybullet", "meshes\\door.obj", "cannot find", "Write / instead of \\ in the paths of meshes"),
    ],
)
def test_what_an_engine_says_of_a_file_that_it_refuses_is_quoted_with_what_to_do(
    engine: str, name: str, quoted: str, remedy: str, tmp_path: Path
) -> None:
    request = request_of(cabinet(), tmp_path)
    text = request.urdf.read_text().replace('<box size="0.02 0.3 0.4"/>', f'<mesh filename="{name}"/>')
    request.urdf.write_text(text)
    door = tmp_path / name.replace("\\", "/")
    door.parent.mkdir(exist_ok=True)
    trimesh.creation.box((0.02, 0.3, 0.4)).export(door)
    (finding,) = tell(partial(needs.engine, name=engine), request).results["KV801"].findings
    assert quoted in finding.message
    assert remedy in finding.remedy
    assert "kinematify fix" in finding.remedy


def test_light_parts_that_pybullet_answers_wrongly_move_by_their_motor(tmp_path: Path) -> None:
    """Motors of 0.1 kg with the inertia of a man: pushes are limited there, and nothing is wrong with the joint."""
    rotor = Part(
        name="rotor", parent="base", kind="revolute", boxes=(Box(size=(0.04, 0.04, 0.02)),), at=(0.0, 0.0, 0.1),
        axis=(0.0, 0.0, 1.0), limits=(-3.14, 3.14), mass=0.1, inertia=(0.05, 0.05, 0.05),
    )  # fmt: skip
    arm = replace(
        rotor, name="arm", parent="rotor", at=(0.0, 0.0, 0.1), axis=(0.0, 1.0, 0.0), inertia=(1e-7, 1e-7, 1e-7)
    )
    base = Part(name="base", boxes=(Box(size=(0.1, 0.1, 0.1)),))
    measured = reported(Model(parts=(base, rotor, arm)), tmp_path, "pybullet").results["KV804"].measured
    assert measured["right"] == measured["joints"] == 2.0


@pytest.mark.parametrize(
    ("change", "found"),
    [
        ({}, []),
        ({"collision": ()}, ["KV820"]),
        ({"center": (0.3, 0.0, 0.0)}, ["KV820"]),
    ],
)
def test_an_object_that_keeps_the_contract_rests_on_a_floor(tmp_path: Path, change: dict, found: list[str]) -> None:
    urdf = (
        Model(parts=(Part(name="stone", boxes=(Box(size=(0.2, 0.2, 0.2)),)),))
        .with_part("stone", **change)
        .write(tmp_path)
    )
    report = validate(urdf, engines=("mujoco",), selected=CONTRACT, workers=1)
    assert [item.check for item in report.findings] == found
    assert contract_words([report.checks]) == f"contract: {'failed' if found else 'kept'}"


def test_what_mujoco_does_not_build_keeps_no_contract(tmp_path: Path) -> None:
    urdf = Model(parts=(Part(name="frame", boxes=()), Part(name="tip", boxes=(), parent="frame"))).write(tmp_path)
    urdf.write_text(urdf.read_text().replace("inertial", "none"))
    report = validate(urdf, engines=("mujoco",), selected=CONTRACT, workers=1)
    assert contract_words([report.checks]) == "contract: blocked"
    assert "mass" in next(check.reason or "" for check in report.checks if check.check == "KV820")


@pytest.mark.parametrize(("effort", "found"), [(1000.0, []), (1.0, ["drawer_joint"]), (0.0, [])])
def test_a_motor_moves_its_joint_by_no_more_than_its_effort(tmp_path: Path, effort: float, found: list[str]) -> None:
    model = cabinet().with_part("drawer", effort=effort, axis=(0.0, 0.0, 1.0), limits=(0.0, 0.005))
    report = validate(model.write(tmp_path), engines=("mujoco",), selected=CONTRACT, workers=1)
    assert [item.joint for item in report.findings if item.check == "KV821"] == found
    assert not [check for check in validate(tmp_path / "model.urdf", engines=()).checks if check.check in CONTRACT]


def test_the_share_that_keeps_the_contract_has_an_interval() -> None:
    statuses = [Status.PASS] * 3 + [Status.FAIL, Status.BLOCKED, Status.SKIPPED]
    reports = [[CheckResult(check="KV820", engine="mujoco", status=status)] for status in statuses]
    assert contract_words(reports) == (
        "contract: kept by 3 of 4 (75%, 95 % interval 30% to 95%); blocked 1, not applicable 1"
    )


def test_the_servo_of_an_mjcf_is_off_where_energy_and_limits_are_asked(tmp_path: Path) -> None:
    path = tmp_path / "arm.xml"
    path.write_text(
        """<mujoco><worldbody><body name="post"><geom size=".1"/><body name="arm" pos="0 0 .5"><joint name="hinge"
        axis="0 0 1" range="-85 85" actuatorfrcrange="-20 20"/><geom type="box" size=".3 .05 .05" pos=".3 0 0"/></body>
        </body></worldbody><actuator><position joint="hinge" kp="50" ctrlrange="1 1.2"/></actuator></mujoco>"""
    )
    report = validate(path, engines=("mujoco",), selected=("KV805", "KV806"), workers=1)
    asked = {check.check: check.status for check in report.checks if check.engine == "mujoco" and check.check > "KV804"}
    assert (asked["KV805"], asked["KV806"]) == (Status.PASS, Status.PASS), "its servo would add 25 J"


def test_an_mjcf_whose_outer_body_has_no_name_is_placed_as_its_engine_does(tmp_path: Path) -> None:
    outer = '<body><geom type="box" size=".5 .5 .5" mass="1"/>'
    hinge = '<joint name="hinge" axis="1 0 0" range="0 1"/><geom type="box" size=".4 .4 .05" mass="1"/>'
    flap = f'<body name="flap" pos="0 0 .6">{hinge}</body>'
    (tmp_path / "box.xml").write_text(
        f'<mujoco><compiler angle="radian"/><worldbody>{outer}{flap}</body></worldbody></mujoco>'
    )
    report = validate(tmp_path / "box.xml", selected=["KV807"], engines=("mujoco",))
    assert [check.status for check in report.checks if check.check == "KV807" and check.engine == "mujoco"] == [
        Status.PASS
    ]


def test_pybullet_has_its_motors_back_after_pushes_and_drives(tmp_path: Path) -> None:
    context = AsLoadedContext(request=request_of(cabinet(), tmp_path), engine="pybullet")
    values, first = context.values, context.travels[0]
    fresh = context.left_without_contacts
    context.loaded.max_safe_force(row(context.loaded, values))
    drive(context.loaded, first.joint, values, first.upper, 0.5)
    again = rest(context.loaded, values, context.settings.seconds, contacts=False)
    np.testing.assert_array_equal(fresh.seen, again.seen)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_finding_of_a_copy_names_it(engine: str, tmp_path: Path) -> None:
    model = collision(cabinet(), "drawer", Box(size=(0.6, 0.6, 0.3)))
    request, refused = request_of(model, tmp_path), tmp_path / "refused.urdf"
    refused.write_text('<robot name="refused"><joint/></robot>')
    given = replace(request, urdf=refused, resolved=request.urdf)
    for asked, named in ((given, True), (request, False)):
        findings = tell(partial(needs.engine, name=engine), asked).results["KV802"].findings
        assert findings
        for item in findings:
            assert (" (a copy with absolute paths of the meshes)" in item.message) is named
