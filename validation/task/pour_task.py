"""The task of pouring from the object into a container."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.manipulation.execute import Execution, Loaded, execute, load
from kinematify.manipulation.film import write_film
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.manipulator import robot_of
from kinematify.manipulation.plan_request import Failure, Hold
from kinematify.manipulation.pour import TILT_DEG, PourPlan, Vessel, plan_pour, read_vessel
from kinematify.simulation.engines import ENGINES, engines_that_hold
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from kinematify.manipulation.plan_request import TaskRequest
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.stage import StageRequest

_HOLD = {Hold.WELD: "with the hand welded to the cup", Hold.CONTACT: "with fingers that hold by friction"}
_MESSAGES = {
    Failure.NO_GRASP: "A gripper finds no hold on the cup. {words}",
    Failure.NO_REACH: "The arm does not take the cup to the container: {words}.",
    Failure.NO_PATH: "A hold of the cup can be reached, but {words}.",
    Failure.STOPS: "The arm gets through {share:.0%} of lifting, carrying and tilting the cup, because {words}.",
}
_NOT_PULLED = "nothing is pulled"


class PourTask:
    """A robot with the cup that it takes and the container that it pours into."""

    def __init__(self, request: StageRequest, task: TaskRequest) -> None:
        """Keep what is asked for."""
        self.request, self.task = request, task
        self.settings = request.settings.task
        self._vessels: tuple[Vessel, Vessel] | None = None
        self._runs: dict[tuple[str, Hold], Execution] = {}

    @cached_property
    def arm(self) -> Arm:
        """The robot."""
        return Arm(robot_of(self.task, self.request.work), self.settings.plan, seed=self.request.settings.seed)

    @cached_property
    def planned(self) -> PourPlan:
        """Return what became of the plan."""
        assert self._vessels is not None
        settings = self.request.settings
        return plan_pour(self.arm, *self._vessels, self.request.work, settings, seed=settings.seed)

    @cached_property
    def world(self) -> Loaded | None:
        """Return what the engines load; None where there is no plan that could be executed."""
        motion = self.planned.motion
        return None if motion is None else load(motion, self.request.work, self.request.settings.prepare)

    def set_up(self, result: OpenCheck) -> None:
        """Measure both vessels; add a finding where that makes no sense."""
        work, settings = self.request.work, self.request.settings
        try:
            if self.task.into is None:
                raise InputError("--task pour needs --into with the URDF of the container, e.g. --into bowl.urdf.")
            cup = read_vessel(self.request.urdf, work / "cup.urdf", settings, scale=self.task.scale)
            self._vessels = cup, read_vessel(self.task.into, work / "into.urdf", settings)
            _ = self.arm
        except InputError as error:
            result.find(str(error), "Give what the message asks for.")
            return

    def plan(self) -> None:
        """Plan the way of the cup."""
        _ = self.planned

    def tell_failures(self, result: OpenCheck, *failures: Failure) -> None:
        """Add what failed, if it did at one of these steps."""
        plan = self.planned
        if plan.failure is None or plan.failure not in failures:
            return
        message = _MESSAGES[plan.failure].format(words=plan.words, share=plan.fraction)
        result.find(message, "Give another --robot or another container.", value=plan.fraction, limit=1.0)

    def tell_successes(self, result: OpenCheck) -> None:
        """Add how the cup is taken."""
        plan = self.planned
        result.measured.update({"carried": plan.fraction, "seconds": plan.seconds})
        if plan.failure is None and plan.motion is not None:
            grasp = plan.motion.grasp
            result.find(
                f"The arm lifts the cup at a {grasp.kind} that is {grasp.width * 1e3:.0f} mm thick, carries it "
                f"upright over the container and tilts it by {TILT_DEG:.0f} deg about its lip.",
                "Nothing to do.",
                severity=Severity.NOTE,
                value=plan.fraction,
            )

    def tell_doubts(self, result: OpenCheck) -> None:
        """Say that no joint is opened."""
        result.skip(_NOT_PULLED)

    def tell_executions(self, result: OpenCheck, hold: Hold) -> None:
        """Pour in the engine of the check, and add what fails."""
        if self.world is None:
            result.skip("there is no plan that could be executed")
            return
        engine = result.engine or ""
        execution = self._execute(self.world, engine, hold)
        result.measured.update({"share": execution.share, "depth": execution.depth})
        if not execution.success:
            result.find(
                f"The pouring fails in {ENGINES[engine].title}, {_HOLD[hold]}: {execution.reason}.",
                "Check masses and collision geometry of the cup; the plan itself is free of collisions.",
                value=execution.share,
                limit=self.settings.execution.opened,
                pair=execution.deepest,
            )

    def _execute(self, world: Loaded, engine: str, hold: Hold) -> Execution:
        if (engine, hold) not in self._runs:
            settings = self.settings.execution
            self._runs[engine, hold] = execute(world, settings, engine=engine, hold=hold)
        return self._runs[engine, hold]

    def tell_films(self, result: OpenCheck) -> None:
        """Film the first execution and add the name of the film."""
        known = [engine for engine in engines_that_hold(Hold.WELD) if engine in self.request.task_engines]
        if self.task.films is None or self.world is None or not known:
            result.skip(_NOT_PULLED)
            return
        first = next(iter(self._runs.values()), None) or self._execute(self.world, known[0], Hold.WELD)
        film = self.task.films / f"{self.task.stem}.gif"
        write_film(self.world, first, film, film.with_suffix(".png"), self.settings.film)
        result.find(f"{film.name} shows how it is poured.", "Nothing to do.")
