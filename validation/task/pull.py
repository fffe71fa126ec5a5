"""The stage `task`: a robot opens every joint of the object (KV7xx), and films show how.

Joints are planned one after the other, then executed, then filmed, so that a lack of time costs films first.
"""

from __future__ import annotations

import time
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.geometry.scene import read_scene, visible_shapes
from kinematify.manipulation import execute_mujoco, execute_pybullet
from kinematify.manipulation.copies import write_scaled
from kinematify.manipulation.execute import Execution, Hold, Loaded, load
from kinematify.manipulation.film import write_film
from kinematify.manipulation.grasp import joint_at
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.motion import Motion
from kinematify.manipulation.place import object_box, standing_at
from kinematify.manipulation.planning import Failure, PullPlan, depend, plan_pull
from kinematify.manipulation.request import POUR
from kinematify.manipulation.robot import robot_of
from kinematify.manipulation.sizes import sizing
from kinematify.robot.read import read_model
from kinematify.validation.catalogue.task import CHECKS
from kinematify.validation.finding import Blame, Severity
from kinematify.validation.task import pour_stage

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.request import Suspicion, TaskRequest
    from kinematify.manipulation.robot import TaskRobot
    from kinematify.manipulation.sizes import Sizing
    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

OBJECT_FILE = "object.urdf"
LEEWAY = 20.0
"""Before the deadline no more work is begun, so that what is known can be told [s]."""
_FILM_SECONDS = 15.0  # a film is begun only with so much time left [s]
_CHECK_OF = {
    Failure.NO_WAY: "KV702",
    Failure.NO_GRASP: "KV702",
    Failure.NO_REACH: "KV703",
    Failure.NO_PATH: "KV704",
    Failure.STOPS: "KV705",
    Failure.COVERED: "KV705",
    Failure.JAMS: "KV706",
}


def run(request: StageRequest, recorder: Recorder) -> None:
    """Carry out the task of a request; see `kinematify.validation.stage`."""
    task = request.task
    if task is None:
        return
    if task.kind == POUR:
        pour_stage.run(request, task, recorder)
        return
    with recorder.check("KV701") as check:
        setting = _set_up(request, task, check)
    if setting is None:
        _skip_rest(recorder, "the task cannot be set up, see KV701")
        return
    setting.plan_all()
    _tell_plans(recorder, setting)
    _tell_executions(recorder, setting)
    if recorder.wants("KV709"):
        _tell_films(recorder, setting)


class _Setting:
    """Robot and object in one world, and what came of each joint."""

    def __init__(self, request: StageRequest, task: TaskRequest, scene: Scene, sized: Sizing) -> None:
        self.request, self.task, self.scene, self.sized = request, task, scene, sized
        self.settings = request.settings.task
        self.plans: list[PullPlan] = []
        self.runs: dict[str, Execution] = {}
        self.left: list[str] = []

    @cached_property
    def arm(self) -> Arm:
        """The robot."""
        return Arm(robot_of(self.task, self.request.work), self.settings.plan, seed=self.request.settings.seed)

    @property
    def joints(self) -> list[str]:
        """Joints to be opened: all that lead, or the one that the given point belongs to."""
        names = [travel.joint for travel in self.scene.travels]
        if self.point is None:
            return names
        return [name for name in names if name == self._joint_at_point]

    @cached_property
    def point(self) -> FloatArray | None:
        """Where to hold, frame of the object's root link [m], shape (3,)."""
        return None if self.task.grasp is None else self.sized.factor * np.array(self.task.grasp)

    @property
    def base(self) -> FloatArray | None:
        """Where the robot has to stand, frame of the object's root link [m], shape (4, 4)."""
        return None if self.task.base is None else standing_at(*self.task.base)

    @cached_property
    def _joint_at_point(self) -> str:
        assert self.point is not None
        return joint_at(self.scene, self.point, self.settings.grasp)

    def plan_all(self) -> None:
        """Plan joint by joint, as long as there is time."""
        for joint in self.joints:
            if self.remaining <= 0.0:
                self.left.append(joint)
                continue
            self.plans.append(
                plan_pull(
                    self.arm, self.scene, joint, self.settings, point=self.point, base=self.base,
                    seed=self.request.settings.seed,
                )
            )  # fmt: skip
        self.plans = list(depend(self.plans))

    @cached_property
    def worlds(self) -> list[Loaded]:
        """What the engines load, for each plan that leads anywhere."""
        model = self.request.work / OBJECT_FILE
        found = [motion_of(plan, self.arm.robot, model) for plan in self.plans]
        motions = [motion for motion in found if motion is not None]
        if not motions:
            return []
        loaded = load(motions[0], self.request.work, self.request.settings.prepare)
        return [replace(loaded, motion=motion) for motion in motions]

    def execute(self, engine: str, hold: Hold) -> Iterator[tuple[str, Execution]]:
        """Execute each plan, as long as there is time for one more."""
        longest = 0.0
        for world in self.worlds:
            if self.remaining < longest:
                return
            start = time.monotonic()
            if engine == "mujoco":
                execution = execute_mujoco.execute(world, self.settings.execution, hold=hold)
            else:
                execution = execute_pybullet.execute(world, self.settings.execution)
            self.runs.setdefault(world.motion.joint, execution)
            longest = max(longest, time.monotonic() - start)
            yield world.motion.joint, execution

    def film_all(self) -> Iterator[tuple[str, Path]]:
        """Film the first execution of each plan."""
        longest = _FILM_SECONDS
        for world in self.worlds if self.task.films is not None else ():
            joint = world.motion.joint
            if joint in self.runs and self.remaining > longest:
                start = time.monotonic()
                yield joint, self._film(joint, world, self.runs[joint])
                longest = max(longest, time.monotonic() - start)

    @property
    def remaining(self) -> float:
        """Seconds until no more work is begun."""
        return max(0.0, self.request.remaining - LEEWAY)

    def _film(self, joint: str, loaded: Loaded, execution: Execution) -> Path:
        assert self.task.films is not None
        safe = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in joint)
        film = self.task.films / f"{self.task.stem}_{safe}.gif"
        write_film(loaded, execution, film, film.with_suffix(".png"), self.settings.film)
        return film


def motion_of(plan: PullPlan, robot: TaskRobot, model: Path) -> Motion | None:
    """Return what the engines are to track; None where the plan leads nowhere.

    Args:
        plan: The plan.
        robot: Its robot.
        model: URDF of the object at its real size.
    """
    if plan.pull is None or plan.reach is None or plan.opened is None or plan.place is None or len(plan.pull) < 2:
        return None
    return Motion(
        robot=robot,
        object_urdf=model,
        T_world_base=plan.place.T_world_base,
        T_world_object=plan.T_world_object,
        joint=plan.joint,
        start=plan.first,
        grasp=plan.place.grasp,
        reach=plan.reach,
        pull=plan.pull,
        opened=plan.opened,
    )


def _set_up(request: StageRequest, task: TaskRequest, check: OpenCheck) -> _Setting | None:
    """Bring the object to its size; None with a finding where that makes no sense."""
    try:
        model = read_model(request.urdf, package_dirs=request.package_dirs)
        scene = read_scene(model, request.settings.geometry, visible_shapes)
        if not scene.travels or len(scene.bodies) < 1:
            check.find(
                "The object has no joint that moves by itself, so there is nothing that a robot could open.",
                "Give a model with a movable joint.",
            )
            return None
        sized = sizing(request.urdf, model.name, object_box(scene), scale=task.scale)
        extent = sized.factor * float(np.ptp(object_box(scene), axis=0).max())
        plan = request.settings.task.plan
        if not plan.smallest <= extent <= plan.largest:
            check.find(
                f"The object is {extent:.4g} m large with a scale of {sized.factor:.4g}, and no arm can use a thing of "
                "that size.",
                "Give --scale with the metres per unit of the model, e.g. 0.001 for millimetres.",
                value=extent, limit=plan.largest if extent > plan.largest else plan.smallest, unit="m",
            )  # fmt: skip
            return None
        path = request.work / OBJECT_FILE
        write_scaled(request.urdf, sized.factor, path, package_dirs=request.package_dirs)
        scene = read_scene(read_model(path), request.settings.geometry)
        setting = _Setting(request, task, scene, sized)
        joints = setting.joints
    except InputError as error:
        check.find(str(error), "Give what the message asks for.")
        return None
    check.measured["scale"] = sized.factor
    check.measured["joints"] = len(joints)
    if sized.factor != 1.0:
        check.find(f"The object is scaled by {sized.factor:.4g}: {sized.reason}.", "Give --scale if that is wrong.",
                   severity=Severity.NOTE, value=sized.factor)  # fmt: skip
    return setting


def _tell_plans(recorder: Recorder, setting: _Setting) -> None:
    """KV702 to KV706."""
    suspects = setting.request.suspects
    late = f"time ran out before {', '.join(setting.left)}" if setting.left else None
    for name in ("KV702", "KV703", "KV704", "KV705", "KV706"):
        with recorder.check(name) as check:
            for plan in setting.plans:
                if name == "KV705":
                    _measure(check, plan)
                if plan.failure is not None and _CHECK_OF[plan.failure] == name:
                    _find_failure(check, plan, setting, suspects.get(plan.joint))
                elif name == "KV705" and plan.failure is None:
                    _find_success(check, plan, setting)
                elif name == "KV706" and plan.joint in suspects and plan.failure is None:
                    _find_doubt(check, plan, suspects[plan.joint])
            if late is not None:
                check.skip(late)


def _measure(check: OpenCheck, plan: PullPlan) -> None:
    check.measured[f"{plan.joint} opened"] = plan.fraction
    check.measured[f"{plan.joint} seconds"] = plan.seconds
    check.measured[f"{plan.joint} tried"] = plan.tried
    if plan.pull is not None:
        check.measured[f"{plan.joint} manipulability"] = plan.manipulability


def _find_failure(check: OpenCheck, plan: PullPlan, setting: _Setting, suspect: Suspicion | None) -> None:
    """Say what failed, and blame the joint where the geometry doubts it."""
    limit = setting.settings.plan.opened
    opened = f"{plan.fraction:.0%} of its range"
    messages: Mapping[Failure, str] = {
        Failure.NO_WAY: f"{plan.joint} is left out: {plan.words}.",
        Failure.NO_GRASP: f"A gripper finds no hold on what {plan.joint} moves. {plan.words}",
        Failure.NO_REACH: f"The arm reaches no hold of {plan.joint}: {plan.words}.",
        Failure.NO_PATH: f"A hold of {plan.joint} can be reached, but {plan.words}.",
        Failure.STOPS: f"The arm opens {plan.joint} by {opened} and stops there, because {plan.words}.",
        Failure.COVERED: f"{plan.joint} opens by {opened} only: {plan.words}.",
        Failure.JAMS: f"{plan.joint} jams at {plan.free:.0%} of its range, whoever pulls: {plan.words}.",
    }
    assert plan.failure is not None
    message, blame, severity, remedy = messages[plan.failure], None, None, _remedy(check.id)
    if plan.failure is Failure.NO_WAY:
        severity = Severity.NOTE
    elif suspect is not None:
        message += f" The joint itself is doubtful, {suspect.check}: {suspect.message}"
        blame, remedy = Blame.KINEMATICS, f"Correct the joint as {suspect.check} says, and plan again."
    elif plan.failure is Failure.COVERED:
        severity = Severity.WARNING
        remedy = "Open what is in the way first."
    stop = plan.stop
    check.find(
        message, remedy, severity=severity, blame=blame, joint=plan.joint, value=plan.fraction, limit=limit,
        pair=stop.pair if stop is not None else None,
    )  # fmt: skip


def _find_success(check: OpenCheck, plan: PullPlan, setting: _Setting) -> None:
    assert plan.place is not None
    place, grasp = plan.place.T_world_base, plan.place.grasp
    x, y, z = (f"{value:.2f}" for value in place[:3, 3] - plan.T_world_object[:3, 3])
    yaw = np.degrees(np.arctan2(place[1, 0], place[0, 0]))
    after = f", after {' and '.join(plan.first)}," if plan.first else ""
    check.find(
        f"The arm opens {plan.joint}{after} by {plan.fraction:.0%} of its range: it holds a {grasp.kind} that is "
        f"{grasp.width * 1e3:.0f} mm thick, with its base at x {x}, y {y}, z {z} m from the object's origin "
        f"(--base {x} {y} {z} {yaw:.0f}).",
        "Nothing to do.",
        severity=Severity.NOTE,
        joint=plan.joint,
        value=plan.fraction,
        limit=setting.settings.plan.opened,
    )


def _find_doubt(check: OpenCheck, plan: PullPlan, suspect: Suspicion) -> None:
    check.find(
        f"The arm can follow {plan.joint} as declared, but the joint itself is doubtful, {suspect.check}: "
        f"{suspect.message}",
        f"Correct the joint as {suspect.check} says, and plan again.",
        severity=Severity.ERROR if suspect.error else Severity.WARNING,
        joint=plan.joint,
    )


def _tell_executions(recorder: Recorder, setting: _Setting) -> None:
    """KV707 and KV708."""
    for name, engine, hold in (
        ("KV707", "mujoco", Hold.WELD), ("KV707", "pybullet", Hold.WELD), ("KV708", "mujoco", Hold.CONTACT),
    ):  # fmt: skip
        if not recorder.wants(name) or engine not in setting.request.task_engines:
            continue
        with recorder.check(name, engine) as check:
            told = 0
            for joint, execution in setting.execute(engine, hold):
                told += 1
                _tell_execution(check, joint, execution, setting)
            if told < len(setting.worlds):
                check.skip(f"time ran out before {len(setting.worlds) - told} of the plans were executed")
            elif not told:
                check.skip("no joint has a plan that could be executed")


def _tell_films(recorder: Recorder, setting: _Setting) -> None:
    """KV709."""
    with recorder.check("KV709") as check:
        films = list(setting.film_all())
        for joint, film in films:
            words = f"{film.name} shows how {joint} is opened."
            check.find(words, "Nothing to do.", severity=Severity.NOTE, joint=joint)
        if len(films) < len(setting.runs):
            check.skip("no films were asked for" if setting.task.films is None else "time ran out before all films")
        elif not films:
            check.skip("no plan was executed that could be shown")


def _tell_execution(check: OpenCheck, joint: str, execution: Execution, setting: _Setting) -> None:
    check.measured[f"{joint} share"] = execution.share
    check.measured[f"{joint} depth"] = execution.depth
    if not execution.success:
        check.find(
            f"The plan for {joint} fails in {_ENGINE[execution.engine]}, {_HOLD[execution.hold]}: {execution.reason}.",
            _remedy(check.id),
            joint=joint,
            value=execution.share,
            limit=setting.settings.execution.opened,
            pair=execution.deepest,
        )


_ENGINE = {"mujoco": "MuJoCo", "pybullet": "PyBullet"}
_HOLD = {Hold.WELD: "with the hand welded to the part", Hold.CONTACT: "with fingers that hold by friction"}


def _remedy(name: str) -> str:
    return next(check.remedy for check in CHECKS if check.id == name)


def _skip_rest(recorder: Recorder, reason: str) -> None:
    for check in CHECKS:
        for engine in check.engines or (None,):
            if check.id != "KV701":
                with recorder.check(check.id, engine) as opened:
                    opened.skip(reason)
