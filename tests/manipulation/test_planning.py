"""Plans of the built-in arm for furniture of boxes, and what is said where they fail."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.geometry.scene import Scene, read_scene
from kinematify.manipulation.collision_world import CollisionWorld
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.manipulator import builtin_robot
from kinematify.manipulation.plan_request import Failure, TaskRequest
from kinematify.manipulation.planning import PullPlan, depend, plan_pull
from kinematify.manipulation.robot_place import object_motion
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.validation.finding import Cause, Severity, Status
from kinematify.validation.run import validate
from tests.manipulation.furniture import SETTINGS, write_covered_drawer, write_drawer_cabinet

PLAN = SETTINGS.task.plan


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm(builtin_robot())


def scene_of(urdf: Path) -> Scene:
    return read_scene(read_robot(urdf), SETTINGS.geometry)


@pytest.fixture(scope="module")
def drawer(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return scene_of(write_drawer_cabinet(tmp_path_factory.mktemp("drawer") / "cabinet.urdf"))


@pytest.fixture(scope="module")
def drawer_plan(arm: Arm, drawer: Scene) -> PullPlan:
    return plan_pull(arm, drawer, "slide", PLAN)


def test_inverse_kinematics_reaches_poses_that_the_arm_can_take(arm: Arm) -> None:
    """The project's own arm, and its own forward kinematics as the judge."""
    rng = np.random.default_rng(0)
    rows = arm.lower + rng.random((40, arm.dof)) * (arm.upper - arm.lower)
    reached = 0
    for q in rows:
        target = forward_kinematics(arm.declared, dict(zip(arm.robot.arm_joints, q.tolist(), strict=True)))[
            arm.robot.tool
        ]
        found = arm.solve_all(target, 6)
        reached += bool(found)
        for solution in found:
            assert np.all(solution >= arm.lower)
            assert np.all(solution <= arm.upper)
            assert np.abs(arm.pose(solution) - target).max() < 2e-3
    assert reached >= 36


def test_arm_opens_a_drawer_and_holds_on_all_the_way(arm: Arm, drawer: Scene, drawer_plan: PullPlan) -> None:
    plan = drawer_plan
    assert plan.failure is None
    assert plan.fraction == pytest.approx(1.0)
    assert plan.opened is not None
    assert plan.pull is not None
    assert plan.place is not None
    assert plan.opened[0] == 0.0
    assert plan.opened[-1] == pytest.approx(0.25)
    T_base_world = np.linalg.inv(plan.place.T_world_base)
    for q, value in zip(plan.pull, plan.opened, strict=True):
        link = forward_kinematics(drawer.model, {"slide": float(value)})["part_7"]
        wanted = T_base_world @ plan.T_world_object @ link @ plan.place.T_link_tool
        assert np.abs(arm.pose(q) - wanted).max() < 2e-3


def test_way_to_the_grasp_is_free_of_collisions_between_its_rows_too(
    arm: Arm, drawer: Scene, drawer_plan: PullPlan
) -> None:
    plan = drawer_plan
    assert plan.reach is not None
    assert plan.pull is not None
    assert plan.place is not None
    assert np.array_equal(plan.reach[-1], plan.pull[0])
    world = CollisionWorld(arm, drawer, "slide", PLAN.margin)
    world.place(plan.place.T_world_base, plan.T_world_object, column=plan.on_column)
    world.pose_object(drawer.at_rest, plan.place.grasp.spread)
    for first, second in zip(plan.reach[:-1], plan.reach[1:], strict=True):
        for share in np.linspace(0.0, 1.0, 8):
            hit = world.hit((1.0 - share) * first + share * second, holding=False)
            assert hit is None, hit


def test_drawer_that_slides_sideways_points_to_its_joint(arm: Arm, tmp_path: Path) -> None:
    scene = scene_of(write_drawer_cabinet(tmp_path / "cabinet.urdf", axis="0 1 0"))
    plan = plan_pull(arm, scene, "slide", PLAN)
    assert plan.failure is Failure.JAMS
    assert plan.fraction < 0.5


def test_handle_wider_than_the_gripper_is_no_hold(arm: Arm, tmp_path: Path) -> None:
    scene = scene_of(write_drawer_cabinet(tmp_path / "cabinet.urdf"))
    narrow = Arm(replace(arm.robot, opening=0.004))
    assert plan_pull(narrow, scene, "slide", PLAN).failure is Failure.NO_GRASP


def test_grasp_beside_the_object_is_refused(arm: Arm, drawer: Scene) -> None:
    with pytest.raises(InputError, match="grasp point"):
        plan_pull(arm, drawer, "slide", PLAN, point=np.array([3.0, 0.0, 0.0]))


def test_door_is_opened_before_the_drawer_behind_it(arm: Arm, tmp_path: Path) -> None:
    scene = scene_of(write_covered_drawer(tmp_path / "cabinet.urdf"))
    door, drawer = depend([plan_pull(arm, scene, joint, PLAN) for joint in ("hinge", "slide")])
    assert door.failure is None
    assert not door.first
    assert drawer.failure is None
    assert drawer.first == {"hinge": pytest.approx(-1.4)}
    assert drawer.pull is not None
    assert drawer.place is not None
    world = CollisionWorld(arm, scene, "slide", PLAN.margin)
    world.place(drawer.place.T_world_base, drawer.T_world_object, column=drawer.on_column)
    opened = scene.standing(drawer.first)
    motion = object_motion(opened, "slide", 0.2)
    assert np.array_equal(motion.T_world_object, drawer.T_world_object)
    for poses, q in ((motion.body_poses[0], drawer.pull[0]), (motion.body_poses[-1], drawer.pull[-1])):
        world.pose_object(poses, drawer.place.grasp.spread)
        assert world.hit(q, holding=True) is None


@pytest.mark.parametrize(("axis", "verdict"), [("-1 0 0", "pass"), ("0 1 0", "fail")])
def test_validate_says_who_can_act(tmp_path: Path, axis: str, verdict: str) -> None:
    urdf = write_drawer_cabinet(tmp_path / "cabinet.urdf", axis=axis)
    report = validate(urdf, selected={f"KV70{k}" for k in range(1, 10)}, engines=(), task=TaskRequest(), workers=1)
    found = [finding for finding in report.findings if finding.joint == "slide" and finding.check >= "KV7"]
    if verdict == "pass":
        assert [(f.check, f.severity) for f in found] == [("KV705", Severity.NOTE)], found
        assert found[0].value == pytest.approx(1.0)
    else:
        assert any(f.severity is Severity.ERROR and f.cause is Cause.KINEMATICS for f in found)
    assert {c.status for c in report.checks if c.check == "KV707"} == {Status.SKIPPED}


def test_without_a_task_its_checks_are_not_in_the_report(tmp_path: Path) -> None:
    report = validate(write_drawer_cabinet(tmp_path / "cabinet.urdf"), selected={"KV101"}, engines=())
    assert not [check for check in report.checks if check.check.startswith("KV7")]


@pytest.mark.parametrize(
    "asked",
    [{"scale": 0.0}, {"scale": 1e4}, {"grasp": (3.0, 0.0, 0.0)}],
    ids=["scale of nothing", "kilometres", "grasp beside the object"],
)
def test_what_cannot_be_set_up_is_a_finding(tmp_path: Path, asked: dict[str, Any]) -> None:
    urdf = write_drawer_cabinet(tmp_path / "cabinet.urdf")
    task = TaskRequest(**asked)
    report = validate(urdf, selected={"KV701", "KV703"}, engines=(), task=task, workers=1)
    assert [finding.check for finding in report.findings if finding.severity is Severity.ERROR] == ["KV701"]
    assert {check.status for check in report.checks if check.check == "KV703"} == {Status.SKIPPED}
