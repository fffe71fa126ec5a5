"""The Drake stage: the same checks as in the other engines, from one more file behind the protocol."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from kinematify.robot.read import read_robot
from kinematify.simulation.configurations import agreement_configurations, link_poses, read_poses
from kinematify.simulation.prepared import URDF_FILE
from kinematify.validation.checks import checks_of
from kinematify.validation.finding import Cause, Severity, Status
from kinematify.validation.stages import run_engine as engine_stage
from tests.validation.engine_models import Box, FindingGroup, Model, Part, cabinet, prepared_request, tell

IDS = {check.id for check in checks_of("KV9")}
run = partial(engine_stage.run, engine="drake")


def reported(model: Model, folder: Path) -> FindingGroup:
    return tell(run, prepared_request(model, folder))


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
    assert skipped == {"KV913": "no loop joint closes a chain"}
    assert result.results["KV905"].measured["arrived"] == 4


def test_leaves_poses_inertias_and_torques_that_agree_with_the_kinematics(tmp_path: Path) -> None:
    request = prepared_request(pendulum(), tmp_path)
    tell(run, request)
    poses = read_poses(tmp_path, "drake")
    robot = read_robot(request.urdf)
    rows = agreement_configurations(robot, request.settings.agreement, request.settings.seed)
    assert poses is not None
    np.testing.assert_allclose(poses.T_world_link, link_poses(robot, rows), atol=1e-12)
    assert poses.mass_matrix is not None
    np.testing.assert_allclose(poses.mass_matrix.ravel(), 0.05 + 2.0 * 0.2**2)
    assert poses.gravity is not None
    weight = 2.0 * 9.81 * 0.2 * np.cos(rows.q[: rows.dynamic, 0])
    np.testing.assert_allclose(poses.gravity[:, 0], -weight)  # it would turn about +y downwards


def test_drawer_that_opens_inwards_is_an_error_of_its_joint(tmp_path: Path) -> None:
    result = reported(cabinet().with_part("drawer", axis=(-1.0, 0.0, 0.0)), tmp_path)
    (finding,) = result.results["KV905"].findings
    assert (finding.severity, finding.cause) == (Severity.ERROR, Cause.KINEMATICS)
    assert (finding.joint, finding.pair) == ("drawer_joint", ("body", "drawer"))
    assert finding.value == pytest.approx(0.005, abs=0.005)  # the room behind it


def test_pair_that_touches_at_rest_stops_a_joint_although_it_does_not_act(tmp_path: Path) -> None:
    model = cabinet().with_part("drawer", boxes=(Box(size=(0.402, 0.27, 0.38)),), axis=(-1.0, 0.0, 0.0))
    result = reported(model, tmp_path)
    assert result.results["KV903"].measured["switched_off_pairs"] == 1.0
    assert {(f.joint, f.pair) for f in result.results["KV905"].findings} == {("drawer_joint", ("body", "drawer"))}


def test_weak_joint_does_not_hold_and_falls_to_its_limit(tmp_path: Path) -> None:
    result = reported(pendulum(effort=0.5), tmp_path)
    (finding,) = result.results["KV904"].findings
    assert (finding.joint, finding.limit) == ("rod_joint", 0.5)
    assert finding.value == pytest.approx(2.0 * 9.81 * 0.2, rel=1e-3)
    assert result.results["KV904"].measured["drift_rad"] == pytest.approx(1.0, abs=0.05)
    assert result.results["KV908"].status is Status.PASS


def test_follower_goes_along(tmp_path: Path) -> None:
    mimic = '<mimic joint="drawer_joint" multiplier="-1" offset="0"/>'
    other = replace(cabinet().parts[1], name="other", at=(1.0, 0.155, 0.0), limits=(-0.3, 0.0), extra=mimic)
    parts = tuple(part for part in cabinet().parts if part.name != "door")
    result = reported(Model(parts=(*parts, other)), tmp_path)
    assert result.results["KV905"].measured == {"drives": 2.0, "arrived": 2.0}


def test_link_called_world_is_a_link(tmp_path: Path) -> None:
    body, *others = cabinet().parts
    renamed = Model(parts=(Part(name="world", boxes=()), replace(body, parent="world", at=(0.0, 0.0, 1.0)), *others))
    results = reported(renamed, tmp_path).results
    assert {check for check, r in results.items() if r.status is not Status.PASS} == {"KV913"}


def test_refused_model_blocks_the_rest(tmp_path: Path) -> None:
    request = prepared_request(cabinet(), tmp_path)
    (tmp_path / URDF_FILE).write_text("<robot name='x'><link")
    result = tell(run, request)
    assert [f.severity for f in result.results["KV901"].findings] == [Severity.ERROR]
    assert {r.status for check, r in result.results.items() if check != "KV901"} == {Status.BLOCKED}
    assert set(result.results) == IDS
