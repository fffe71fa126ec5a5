"""Engines agree with the file on kinematics, so with each other; what Pinocchio has otherwise is found."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.config.validation import load_settings
from kinematify.robot.read import read_robot
from kinematify.simulation.configurations import Configurations, pose_configurations
from kinematify.simulation.engine import LoadedJoint, LoadedRobot
from kinematify.simulation.prepared import URDF_FILE, load_prepared, prepare
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks.engine_loading import compare_with_file
from kinematify.validation.finding import CheckResult, Severity, Status
from kinematify.validation.stages import run_engine as engine_stage
from tests.places import BENCH
from tests.validation.engine_models import Box, Model, Part, cabinet, prepared_request, tell

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.validation.stage import StageRequest

POSES = {"mujoco": "KV402", "pybullet": "KV502", "pinocchio": "KV601"}
each_engine = pytest.mark.parametrize("engine", POSES)
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


def results_in(request: StageRequest, engine: str) -> dict[str, CheckResult]:
    return tell(
        partial(engine_stage.run, engine=engine), replace(request, selected=frozenset(POSES.values()) | {"KV606"})
    ).results


@each_engine
def test_poses_in_an_engine_are_those_of_the_file(tmp_path: Path, engine: str) -> None:
    request = prepared_request(arm(), tmp_path)
    agrees = results_in(request, engine)[POSES[engine]]
    assert agrees.status is Status.PASS
    assert agrees.measured["distance"] < 1e-6
    path = request.work / URDF_FILE
    path.write_text(path.read_text().replace('xyz="0.0 0.0 0.1"', 'xyz="0.0 0.02 0.1"'))
    (finding,) = results_in(request, engine)[POSES[engine]].findings
    assert (finding.link, finding.engine, finding.severity) == ("tip", engine, Severity.ERROR)
    assert finding.value == pytest.approx(0.02, abs=1e-6)


@each_engine
@pytest.mark.skipif(not PANDA.is_file(), reason="the benchmark objects are not there")
def test_engines_agree_on_panda(tmp_path: Path, engine: str) -> None:
    request = replace(prepared_request(cabinet(), tmp_path), urdf=PANDA.resolve())
    prepare(read_robot(PANDA), tmp_path, request.settings.prepare)
    assert results_in(request, engine)[POSES[engine]].status is Status.PASS


def test_pinocchio_tells_other_limits_and_masses(tmp_path: Path) -> None:
    request = prepared_request(arm(), tmp_path)
    path = request.work / URDF_FILE
    path.write_text(path.read_text().replace('upper="0.2"', 'upper="0.3"').replace('value="0.1"', 'value="0.2"'))
    found = {(f.joint, f.link): f for f in results_in(request, "pinocchio")["KV606"].findings}
    assert set(found) == {("tool_joint", None), (None, "tip")}
    assert found[None, "tip"].value == pytest.approx(0.2)


def test_pinocchio_that_refuses_is_a_finding(tmp_path: Path) -> None:
    request = prepared_request(arm(), tmp_path)
    path = request.work / URDF_FILE
    path.write_text(path.read_text().replace('<child link="lower"/>', '<child link="upper"/>'))
    results = results_in(request, "pinocchio")
    assert "refuses" in results["KV606"].findings[0].message
    assert results["KV601"].status is Status.BLOCKED


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
    chosen = load_settings().engines.model_copy(update=changes)
    return pose_configurations(read_robot(model.write(folder)), chosen, 0)


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
    found = configurations(Model(parts=tuple(parts)), folder, pose_end_rows=ends, pose_rows=rows)
    assert found.q.shape[1] == count
    assert len(found.q) <= 2 + rows + max(2, ends)
    k = np.arange(1, count + 1)
    assert np.all((found.q >= -0.1 * k - 1e-12) & (found.q <= 0.2 * k + 1e-12))
    np.testing.assert_allclose(found.q.min(axis=0, initial=0.0), -0.1 * k)  # every joint is at its ends somewhere
    np.testing.assert_allclose(found.q.max(axis=0, initial=0.0), 0.2 * k)
