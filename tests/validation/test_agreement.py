"""Agreement of engines: quiet where they agree, else reported at the joint, link or pair where it begins."""

from __future__ import annotations

import shutil
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.config.validation import load_settings
from kinematify.robot.read import read_robot
from kinematify.simulation.configurations import (
    Configurations,
    EnginePoses,
    agreement_configurations,
    read_poses,
    write_poses,
)
from kinematify.simulation.engine import LoadedJoint, LoadedRobot
from kinematify.simulation.prepared import URDF_FILE, load_prepared, prepare
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks.engine_loading import compare_with_file
from kinematify.validation.finding import CheckResult, Finding, Severity, Status
from kinematify.validation.stage import Recorder, StageRequest
from kinematify.validation.stages import engine_agreement as agreement_stage
from kinematify.validation.stages import run_engine as engine_stage
from tests.places import BENCH
from tests.validation.engine_models import Box, Model, Part, cabinet, prepared_request, tell

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

ENGINES = ("mujoco", "pybullet", "pinocchio")
IDS = {"KV601", "KV602", "KV603", "KV604", "KV605"}
PANDA = BENCH / "robots/panda/model.urdf"


def arm() -> Model:
    """Three links in a row, and a follower beside them."""
    rod = (Box(size=(0.3, 0.05, 0.05), at=(0.2, 0.0, 0.0)),)
    turning = {"kind": "revolute", "boxes": rod, "limits": (-1.0, 1.5), "center": (0.2, 0.0, 0.01)}
    mimic = '<mimic joint="lower_joint" multiplier="0.5" offset="0.1"/>'
    return Model(
        parts=(
            Part(name="base", boxes=(Box(size=(0.1, 0.1, 0.1)),), mass=5.0),
            Part(name="upper", parent="base", axis=(0.0, 1.0, 0.0), **turning),
            Part(name="lower", parent="upper", at=(0.4, 0.0, 0.0), axis=(0.0, 0.6, 0.8), **turning),
            Part(name="tool", parent="lower", at=(0.4, 0.0, 0.0), kind="prismatic", boxes=rod, limits=(0.0, 0.2)),
            Part(name="tip", parent="tool", at=(0.0, 0.0, 0.1), boxes=(Box(size=(0.02, 0.02, 0.02)),), mass=0.1),
            Part(name="other", parent="base", at=(0.0, 1.0, 0.0), axis=(0.0, 0.0, 1.0), extra=mimic, **turning),
        )
    )


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> StageRequest:
    """The request of an arm that all engines have seen."""
    request = prepared_request(arm(), tmp_path_factory.mktemp("arm"), seconds=10_000.0)
    for engine in ENGINES:
        tell(partial(engine_stage.run, engine=engine), request)
    return request


@pytest.fixture
def request_copy(ran: StageRequest, tmp_path: Path) -> StageRequest:
    """The same with a folder of its own, in which what engines left can be changed."""
    work = tmp_path / "work"
    shutil.copytree(ran.work, work)
    return replace(ran, work=work)


def compared(
    request: StageRequest, chosen: Sequence[str] = ENGINES, failures: Mapping[str, str] | None = None
) -> dict[str, CheckResult]:
    reported: list[CheckResult] = []
    request = replace(request, engines=tuple(chosen), failures=failures or {})
    agreement_stage.run(request, Recorder(reported.append, request.selected))  # type: ignore[arg-type]
    return {result.check: result for result in reported}


def poses_of(request: StageRequest, engine: str) -> EnginePoses:
    poses = read_poses(request.work, engine)
    assert poses is not None
    return poses


def change(request: StageRequest, engine: str, **fields: object) -> None:
    write_poses(request.work, engine, replace(poses_of(request, engine), **fields))  # type: ignore[arg-type]


def only(results: dict[str, CheckResult], check: str) -> Finding:
    (finding,) = results[check].findings
    assert all(not result.findings for name, result in results.items() if name != check)
    return finding


def below(poses: EnginePoses, names: Sequence[str]) -> list[int]:
    return [poses.links.index(name) for name in names]


def test_engines_agree_on_an_arm(ran: StageRequest) -> None:
    results = compared(ran)
    assert set(results) == IDS
    assert {name: (r.status, r.reason) for name, r in results.items() if r.status is not Status.PASS} == {}
    assert "geometry stage left no contacts" in (results["KV604"].reason or "")
    assert results["KV601"].measured["pinocchio_position_m"] < 1e-12
    assert results["KV602"].measured["mujoco_relative"] < 1e-6
    assert results["KV603"].measured["mujoco_relative"] < 1e-6


def test_moved_subtree_is_reported_once_at_the_joint_above_it(request_copy: StageRequest) -> None:
    poses = poses_of(request_copy, "mujoco")
    moved = poses.T_world_link.copy()
    moved[:, below(poses, ["lower", "tool", "tip"]), 2, 3] += 0.01
    change(request_copy, "mujoco", T_world_link=moved)
    finding = only(compared(request_copy), "KV601")
    assert (finding.joint, finding.link, finding.engine) == ("lower_joint", "lower", "mujoco")
    assert finding.value == pytest.approx(0.01)
    assert (finding.unit, finding.severity) == ("m", Severity.ERROR)


def test_turned_frame_names_joint_engine_and_configuration(request_copy: StageRequest) -> None:
    poses = poses_of(request_copy, "pybullet")
    turned = poses.T_world_link.copy()
    swap = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    link = poses.links.index("tip")
    turned[5:, link, :3, :3] = turned[5:, link, :3, :3] @ swap  # not in the first rows
    change(request_copy, "pybullet", T_world_link=turned)
    finding = only(compared(request_copy), "KV601")
    assert (finding.joint, finding.engine, finding.unit) == ("tip_joint", "pybullet", "rad")
    assert finding.value == pytest.approx(np.radians(120.0), abs=1e-6)
    assert finding.q is not None
    assert dict(finding.q) in [dict(zip(poses.joints, row, strict=True)) for row in poses.q[5:].tolist()]


def test_all_engines_against_kinematify_are_one_finding(request_copy: StageRequest) -> None:
    for engine in ENGINES:
        poses = poses_of(request_copy, engine)
        moved = poses.T_world_link.copy()
        moved[:, poses.links.index("other"), 0, 3] += 0.02
        change(request_copy, engine, T_world_link=moved)
    finding = only(compared(request_copy), "KV601")
    assert (finding.joint, finding.engine) == ("other_joint", None)
    assert "All engines" in finding.message


def test_lost_link_is_reported(request_copy: StageRequest) -> None:
    poses = poses_of(request_copy, "pinocchio")
    lost = poses.T_world_link.copy()
    lost[:, poses.links.index("tip")] = np.nan
    change(request_copy, "pinocchio", T_world_link=lost)
    finding = only(compared(request_copy), "KV601")
    assert (finding.link, finding.engine) == ("tip", "pinocchio")


@pytest.mark.parametrize(("check", "field"), [("KV602", "mass_matrix"), ("KV603", "gravity")])
def test_other_dynamics_are_reported_at_the_joint_farthest_from_the_root(
    request_copy: StageRequest, check: str, field: str
) -> None:
    # A heavier link below the joint `lower` shows in all joints above it, but not in those beside and below it.
    poses = poses_of(request_copy, "mujoco")
    values = np.array(getattr(poses, field))
    columns = [poses.joints.index(name) for name in ("upper_joint", "lower_joint")]
    if field == "gravity":
        values[:, columns] *= 1.05
    else:
        values[np.ix_(range(len(values)), columns, columns)] *= 1.05
    change(request_copy, "mujoco", **{field: values})
    finding = only(compared(request_copy), check)
    assert (finding.joint, finding.link, finding.engine) == ("lower_joint", "lower", "mujoco")
    assert finding.value == pytest.approx(0.05, rel=0.01)
    assert finding.severity is Severity.WARNING


def test_other_mass_names_link_and_engine(request_copy: StageRequest) -> None:
    masses = np.array(poses_of(request_copy, "mujoco").masses)
    masses[1] *= 1.01
    change(request_copy, "mujoco", masses=masses)
    finding = only(compared(request_copy), "KV605")
    assert (finding.link, finding.engine, finding.severity) == ("upper", "mujoco", Severity.ERROR)
    assert finding.value == pytest.approx(2.02)
    assert finding.limit == pytest.approx(2.0)


def test_other_total_mass_is_reported(request_copy: StageRequest) -> None:
    change(request_copy, "pybullet", total_mass=1.0)
    finding = only(compared(request_copy), "KV605")
    assert (finding.link, finding.engine, finding.value) == (None, "pybullet", 1.0)


@pytest.mark.parametrize("sees", ["mujoco", "pybullet"])
def test_contact_that_only_one_engine_sees(request_copy: StageRequest, sees: str) -> None:
    nothing = {"contacts": np.zeros((0, 3), dtype=np.int64), "contact_depth": np.zeros(0)}
    for engine in ("mujoco", "pybullet"):
        change(request_copy, engine, **nothing)
    links = poses_of(request_copy, sees).links
    rows = np.array([[3, 1, 3], [4, 1, links.index("tip")], [6, 0, 1]])  # tool and tip are one body
    change(request_copy, sees, contacts=rows, contact_depth=np.array([0.02, 0.03, 0.001]))
    finding = only(compared(request_copy), "KV604")
    assert (finding.pair, finding.engine, finding.value) == (("upper", "tip"), sees, 0.03)
    assert finding.q is not None


def test_contact_that_both_engines_see_and_the_exact_geometry_does_not(request_copy: StageRequest) -> None:
    both = {"contacts": np.array([[3, 1, 3]]), "contact_depth": np.array([0.02])}
    for engine in ("mujoco", "pybullet"):
        change(request_copy, engine, **both)
    assert not compared(request_copy)["KV604"].findings
    exact = replace(poses_of(request_copy, "mujoco"), contacts=np.zeros((0, 3), dtype=np.int64))
    write_poses(request_copy.work, "geometry", replace(exact, contact_depth=np.zeros(0)))
    finding = only(compared(request_copy), "KV604")
    assert finding.pair == ("upper", "tool")
    assert "exact geometry" in finding.message


def test_crashed_engine_blocks_with_its_reason_and_what_is_there_is_compared(request_copy: StageRequest) -> None:
    poses = poses_of(request_copy, "pinocchio")
    moved = poses.T_world_link.copy()
    moved[:, poses.links.index("other"), 0, 3] += 0.02
    change(request_copy, "pinocchio", T_world_link=moved)
    (request_copy.work / "poses-mujoco.npz").unlink()
    results = compared(request_copy, failures={"mujoco": "crashed with SIGSEGV"})
    assert results["KV601"].status is Status.FAIL  # a finding counts more
    assert {results[name].status for name in ("KV602", "KV603", "KV604", "KV605")} == {Status.BLOCKED}
    assert all("MuJoCo crashed with SIGSEGV" in (result.reason or "") for result in results.values())


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut off"])
def test_broken_file_of_an_engine_is_as_good_as_none(request_copy: StageRequest, content: bytes) -> None:
    (request_copy.work / "poses-pinocchio.npz").write_bytes(content)
    results = compared(request_copy)
    assert {results[name].status for name in ("KV601", "KV602", "KV603", "KV605")} == {Status.BLOCKED}
    assert "Pinocchio" in (results["KV602"].reason or "")


def test_engines_that_were_not_asked_for_are_no_failure(ran: StageRequest) -> None:
    results = compared(ran, chosen=("pinocchio",))
    assert results["KV601"].status is Status.PASS
    assert {results[name].status for name in ("KV602", "KV603", "KV604")} == {Status.SKIPPED}
    assert {result.status for result in compared(ran, chosen=()).values()} == {Status.SKIPPED}


def test_pinocchio_tells_other_limits_and_masses(tmp_path: Path) -> None:
    request = prepared_request(arm(), tmp_path)
    path = request.work / URDF_FILE
    path.write_text(path.read_text().replace('upper="0.2"', 'upper="0.3"').replace('value="0.1"', 'value="0.2"'))
    found = {
        (f.joint, f.link): f
        for f in tell(partial(engine_stage.run, engine="pinocchio"), request).results["KV606"].findings
    }
    assert set(found) == {("tool_joint", None), (None, "tip")}
    assert found[None, "tip"].value == pytest.approx(0.2)


def test_pinocchio_that_refuses_is_a_finding(tmp_path: Path) -> None:
    request = prepared_request(arm(), tmp_path)
    path = request.work / URDF_FILE
    path.write_text(path.read_text().replace('<child link="lower"/>', '<child link="upper"/>'))
    (finding,) = tell(partial(engine_stage.run, engine="pinocchio"), request).results["KV606"].findings
    assert "refuses" in finding.message
    assert not (request.work / "poses-pinocchio.npz").exists()


def test_lost_and_swapped_joints_are_found(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    prepared = load_prepared(request.work)
    check = OpenCheck(id="KV606", engine="pinocchio")
    loaded = LoadedRobot(
        joints={"door_joint": LoadedJoint(turns=False, lower=0.0, upper=1.5)},
        masses={link.link: link.mass for link in prepared.links},
        total_mass=prepared.total_mass + 1.0,
    )
    compare_with_file(check, read_robot(request.urdf), prepared, loaded, 1e-4)
    assert [finding.joint for finding in check.findings] == ["drawer_joint", "door_joint"]


def configurations(model: Model, folder: Path, **changes: int) -> Configurations:
    chosen = load_settings().agreement.model_copy(update=changes)
    return agreement_configurations(read_robot(model.write(folder)), chosen, 0)


def test_configurations_hold_zero_rest_and_all_ends(tmp_path: Path) -> None:
    model = arm().with_part("tool", limits=(0.1, 0.3))
    rows = configurations(model, tmp_path)
    tool = rows.q[:, rows.joints.index("tool_joint")]
    assert not rows.q[0, :3].any()
    assert tool[1] == pytest.approx(0.2)
    assert {0.1, 0.3} <= set(tool.tolist())
    lower, other = (rows.q[:, rows.joints.index(name)] for name in ("lower_joint", "other_joint"))
    np.testing.assert_allclose(other, 0.5 * lower + 0.1)
    np.testing.assert_array_equal(rows.q, configurations(model, tmp_path).q)


@settings(max_examples=15, deadline=None)
@given(count=st.integers(0, 40), ends=st.integers(2, 30), rows=st.integers(1, 9))
def test_configurations_stay_within_limits_and_caps(
    tmp_path_factory: pytest.TempPathFactory, count: int, ends: int, rows: int
) -> None:
    parts = [Part(name="p0", boxes=())]
    parts += [
        Part(name=f"p{k}", boxes=(), parent="p0", kind="prismatic", limits=(-0.1 * k, 0.2 * k))
        for k in range(1, count + 1)
    ]
    folder = tmp_path_factory.mktemp("many")
    found = configurations(Model(parts=tuple(parts)), folder, end_rows=ends, random_rows=rows)
    assert found.q.shape[1] == count
    assert len(found.q) <= 2 + rows + max(2, ends)
    assert found.dynamic <= len(found.q)
    k = np.arange(1, count + 1)
    assert np.all((found.q >= -0.1 * k - 1e-12) & (found.q <= 0.2 * k + 1e-12))
    np.testing.assert_allclose(found.q.min(axis=0, initial=0.0), -0.1 * k)  # every joint is at its ends somewhere
    np.testing.assert_allclose(found.q.max(axis=0, initial=0.0), 0.2 * k)


@pytest.mark.skipif(not PANDA.is_file(), reason="the benchmark objects are not there")
def test_engines_agree_on_panda(tmp_path: Path) -> None:
    request = replace(prepared_request(cabinet(), tmp_path), urdf=PANDA.resolve())
    prepare(read_robot(PANDA), tmp_path, request.settings.prepare)
    for engine in ENGINES:
        tell(partial(engine_stage.run, engine=engine), request)
    results = compared(request)
    assert {name: (r.status, r.reason) for name, r in results.items() if r.status is not Status.PASS} == {}


def test_nothing_left_by_any_engine_blocks_with_reasons(request_copy: StageRequest) -> None:
    for path in (*request_copy.work.glob("poses-*.npz"), *request_copy.work.glob("prepared.*")):
        path.unlink()
    results = compared(request_copy)
    assert {results[name].status for name in ("KV601", "KV602", "KV603", "KV605")} == {Status.BLOCKED}
    assert not any("Error" in (result.reason or "") for result in results.values())
