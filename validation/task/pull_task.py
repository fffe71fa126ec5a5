"""The task of opening every joint of an object, and films that show how.

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
from kinematify.manipulation.execute import Execution, Loaded, execute, load
from kinematify.manipulation.grasp import joint_at
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.manipulator import robot_of
from kinematify.manipulation.plan_request import Failure, Hold
from kinematify.manipulation.planning import PullPlan, depend, motion_of, plan_pull
from kinematify.manipulation.real_size import sizing, write_scaled
from kinematify.manipulation.robot_place import object_box, standing_at
from kinematify.manipulation.task_film import write_film
from kinematify.robot.read import read_robot
from kinematify.simulation.engines import ENGINES
from kinematify.validation.check import REGISTRY
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.plan_request import TaskRequest
    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.stage import StageRequest

OBJECT_FILE = "object.urdf"
LEEWAY = 20.0
"""Before the deadline no more work is begun, so that what is known can be reported [s]."""
_FILM_SECONDS = 15.0  # a film is begun only with so much time left [s]
_HOLD = {Hold.WELD: "with the hand welded to the part", Hold.CONTACT: "with fingers that hold by friction"}


class PullTask:
    """A robot and an object in one world, and what came of each joint."""

    def __init__(self, request: StageRequest, task: TaskRequest) -> None:
        """Keep what is asked for."""
        self.request, self.task = request, task
        self.settings = request.settings.task
        self.runs: dict[str, Execution] = {}
        self.left: list[str] = []
        self._world: tuple[Scene, float] | None = None

    @property
    def scene(self) -> Scene:
        """The object at its real size."""
        assert self._world is not None
        return self._world[0]

    @cached_property
    def arm(self) -> Arm:
        """The robot."""
        return Arm(robot_of(self.task, self.request.work), seed=self.request.settings.seed)

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
        return None if self.task.grasp is None else self._factor * np.array(self.task.grasp)

    @property
    def base(self) -> FloatArray | None:
        """Where the robot has to stand, frame of the object's root link [m], shape (4, 4)."""
        return None if self.task.base is None else standing_at(*self.task.base)

    @cached_property
    def _joint_at_point(self) -> str:
        assert self.point is not None
        return joint_at(self.scene, self.point)

    @cached_property
    def plans(self) -> list[PullPlan]:
        """Return what came of each joint, as long as there was time."""
        found = []
        for joint in self.joints:
            if self.remaining <= 0.0:
                self.left.append(joint)
                continue
            found.append(
                plan_pull(
                    self.arm, self.scene, joint, self.settings.plan, point=self.point, base=self.base,
                    seed=self.request.settings.seed,
                )
            )  # fmt: skip
        return list(depend(found))

    @cached_property
    def worlds(self) -> list[Loaded]:
        """Return what the engines load, for each plan that leads anywhere."""
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
            start = time.process_time()
            execution = execute(world, self.settings.execution, engine=engine, hold=hold)
            self.runs.setdefault(world.motion.joint, execution)
            longest = max(longest, time.process_time() - start)
            yield world.motion.joint, execution

    def film_all(self) -> Iterator[tuple[str, Path]]:
        """Film the first execution of each plan."""
        longest = _FILM_SECONDS
        for world in self.worlds if self.task.films is not None else ():
            joint = world.motion.joint
            if joint in self.runs and self.remaining > longest:
                start = time.process_time()
                yield joint, self._film(joint, world, self.runs[joint])
                longest = max(longest, time.process_time() - start)

    @property
    def remaining(self) -> float:
        """Seconds until no more work is begun."""
        return max(0.0, self.request.remaining - LEEWAY)

    def _film(self, joint: str, loaded: Loaded, execution: Execution) -> Path:
        assert self.task.films is not None
        safe = "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in joint)
        film = self.task.films / f"{self.task.stem}_{safe}.gif"
        write_film(loaded, execution, film, film.with_suffix(".png"))
        return film

    @property
    def _factor(self) -> float:
        assert self._world is not None
        return self._world[1]

    def set_up(self, result: OpenCheck) -> None:
        """Bring the object to its size; add a finding where that makes no sense."""
        try:
            model = read_robot(self.request.urdf, package_dirs=self.request.package_dirs)
            scene = read_scene(model, self.request.settings.geometry, visible_shapes)
            if not scene.travels or len(scene.bodies) < 1:
                result.find(
                    "The object has no joint that moves by itself, so there is nothing that a robot could open.",
                    "Give a model with a movable joint.",
                )
                return
            factor, reason = sizing(self.request.urdf, model.name, object_box(scene), scale=self.task.scale)
            extent = factor * float(np.ptp(object_box(scene), axis=0).max())
            plan = self.request.settings.task.plan
            if not plan.smallest <= extent <= plan.largest:
                result.find(
                    f"The object is {extent:.4g} m large with a scale of {factor:.4g}, and no arm can use a "
                    "thing of that size.",
                    "Give --scale with the metres per unit of the model, e.g. 0.001 for millimetres.",
                    value=extent,
                    limit=plan.largest if extent > plan.largest else plan.smallest,
                    unit="m",
                )
                return
            path = self.request.work / OBJECT_FILE
            write_scaled(self.request.urdf, factor, path, package_dirs=self.request.package_dirs)
            scene = read_scene(read_robot(path), self.request.settings.geometry)
            self._world = scene, factor
            joints = self.joints
        except InputError as error:
            self._world = None
            result.find(str(error), "Give what the message asks for.")
            return
        result.measured["scale"] = factor
        result.measured["joints"] = len(joints)
        if factor != 1.0:
            result.find(
                f"The object is scaled by {factor:.4g}: {reason}.",
                "Give --scale if that is wrong.",
                severity=Severity.NOTE,
                value=factor,
            )

    def tell_failures(self, result: OpenCheck, *failures: Failure) -> None:
        """Add what failed at these steps, and cause the joint where the geometry doubts it."""
        for plan in self.plans:
            if plan.failure in failures:
                self._tell_failure(result, plan)
        if self.left:
            result.leave(f"{', '.join(self.left)}")

    def _tell_failure(self, result: OpenCheck, plan: PullPlan) -> None:
        suspect, limit = self.request.suspects.get(plan.joint), self.settings.plan.opened
        opened = f"{plan.fraction:.0%} of its range"
        messages: Mapping[Failure, str] = {
            Failure.NO_WAY: f"{plan.joint} is omitted: {plan.words}.",
            Failure.NO_GRASP: f"A gripper finds no hold on what {plan.joint} moves. {plan.words}",
            Failure.NO_REACH: f"The arm reaches no hold of {plan.joint}: {plan.words}.",
            Failure.NO_PATH: f"A hold of {plan.joint} can be reached, but {plan.words}.",
            Failure.STOPS: f"The arm opens {plan.joint} by {opened} and stops there, because {plan.words}.",
            Failure.COVERED: f"{plan.joint} opens by {opened} only: {plan.words}.",
            Failure.JAMS: f"{plan.joint} jams at {plan.free:.0%} of its range, whoever pulls: {plan.words}.",
        }
        assert plan.failure is not None
        message, cause, severity, remedy = messages[plan.failure], None, None, REGISTRY[result.id].remedy
        if plan.failure is Failure.NO_WAY:
            severity = Severity.NOTE
        elif suspect is not None:
            message += f" The joint itself is doubtful, {suspect.check}: {suspect.message}"
            cause, remedy = Cause.KINEMATICS, f"Correct the joint as {suspect.check} says, and plan again."
        elif plan.failure is Failure.COVERED:
            severity = Severity.WARNING
            remedy = "Open what is in the way first."
        stop = plan.stop
        result.find(
            message, remedy, severity=severity, cause=cause, joint=plan.joint, value=plan.fraction, limit=limit,
            pair=stop.pair if stop is not None else None,
        )  # fmt: skip

    def tell_successes(self, result: OpenCheck) -> None:
        """Add how far the joints open, and where the robot represents it."""
        for plan in self.plans:
            result.measured[f"{plan.joint} opened"] = plan.fraction
            result.measured[f"{plan.joint} seconds"] = plan.seconds
            result.measured[f"{plan.joint} tried"] = plan.tried
            if plan.pull is not None:
                result.measured[f"{plan.joint} manipulability"] = plan.manipulability
            if plan.failure is not None or plan.place is None:
                continue
            place, grasp = plan.place.T_world_base, plan.place.grasp
            x, y, z = (f"{value:.2f}" for value in place[:3, 3] - plan.T_world_object[:3, 3])
            yaw = np.degrees(np.arctan2(place[1, 0], place[0, 0]))
            after = f", after {' and '.join(plan.first)}," if plan.first else ""
            result.find(
                f"The arm opens {plan.joint}{after} by {plan.fraction:.0%} of its range: it holds a {grasp.kind} that "
                f"is {grasp.width * 1e3:.0f} mm thick, with its base at x {x}, y {y}, z {z} m from the object's origin "
                f"(--base {x} {y} {z} {yaw:.0f}).",
                "Nothing to do.",
                severity=Severity.NOTE,
                joint=plan.joint,
                value=plan.fraction,
                limit=self.settings.plan.opened,
            )

    def tell_doubts(self, result: OpenCheck) -> None:
        """Add the joints that an arm can follow although the geometry doubts them."""
        for plan in self.plans:
            suspect = self.request.suspects.get(plan.joint)
            if suspect is not None and plan.failure is None:
                result.find(
                    f"The arm can follow {plan.joint} as declared, but the joint itself is doubtful, {suspect.check}: "
                    f"{suspect.message}",
                    f"Correct the joint as {suspect.check} says, and plan again.",
                    severity=Severity.ERROR if suspect.error else Severity.WARNING,
                    joint=plan.joint,
                )

    def tell_executions(self, result: OpenCheck, hold: Hold) -> None:
        """Execute each plan in the engine of the check, and add those that fail."""
        executed = 0
        for joint, execution in self.execute(result.engine or "", hold):
            executed += 1
            result.measured[f"{joint} share"] = execution.share
            result.measured[f"{joint} depth"] = execution.depth
            if not execution.success:
                result.find(
                    f"The plan for {joint} fails in {ENGINES[execution.engine].title}, {_HOLD[execution.hold]}: "
                    f"{execution.reason}.",
                    REGISTRY[result.id].remedy,
                    joint=joint,
                    value=execution.share,
                    limit=self.settings.execution.opened,
                    pair=execution.deepest,
                )
        if executed < len(self.worlds):
            result.leave(f"{len(self.worlds) - executed} of the plans were executed")
        elif not executed:
            result.skip("no joint has a plan that could be executed")

    def tell_films(self, result: OpenCheck) -> None:
        """Film the executions and add the names of the films."""
        films = list(self.film_all())
        for joint, film in films:
            result.find(f"{film.name} shows how {joint} is opened.", "Nothing to do.", joint=joint)
        if len(films) < len(self.runs):
            if self.task.films is None:
                result.skip("no films were asked for")
            else:
                result.leave("all films were made")
        elif not films:
            result.skip("no plan was executed that could be shown")
