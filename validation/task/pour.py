"""The stage `task` where the task is to pour: plan, executions and film, told as KV701 to KV709."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.manipulation import execute_mujoco, execute_pybullet
from kinematify.manipulation.execute import Execution, Hold, Loaded, load
from kinematify.manipulation.film import write_film
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.pour import CARRIED, GRASP, PATH, REACH, PourPlan, plan_pour
from kinematify.manipulation.pour_scene import read_vessel
from kinematify.manipulation.robot import robot_of
from kinematify.validation.catalogue.task import CHECKS
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from kinematify.manipulation.request import TaskRequest
    from kinematify.validation.stage import OpenCheck, Recorder, StageRequest

_CHECK_OF = {GRASP: "KV702", REACH: "KV703", PATH: "KV704", CARRIED: "KV705"}
_RUNS = (
    ("KV707", "mujoco", Hold.WELD, "in MuJoCo, with the hand welded to the cup"),
    ("KV707", "pybullet", Hold.WELD, "in PyBullet, with the hand welded to the cup"),
    ("KV708", "mujoco", Hold.CONTACT, "in MuJoCo, with fingers that hold by friction"),
)
_MESSAGES = {
    GRASP: "A gripper finds no hold on the cup. {words}",
    REACH: "The arm does not take the cup to the container: {words}.",
    PATH: "A hold of the cup can be reached, but {words}.",
    CARRIED: "The arm gets through {share:.0%} of lifting, carrying and tilting the cup, because {words}.",
}


@dataclass(frozen=True, eq=False)
class _Poured:
    """A plan and what the engines load for it."""

    plan: PourPlan
    loaded: Loaded | None


def run(request: StageRequest, task: TaskRequest, recorder: Recorder) -> None:
    """Pour from the object of the request into the container of the task; see `kinematify.validation.stage`."""
    told: set[tuple[str, str | None]] = {("KV701", None)}
    with recorder.check("KV701") as check:
        poured = _poured(request, task, check)
    if poured is not None:
        told |= _tell_plan(recorder, poured.plan, request)
        told |= _tell_runs(recorder, poured, request, task)
    reason = "nothing is pulled" if poured is not None else "the task cannot be set up, see KV701"
    for entry in CHECKS:
        for engine in entry.engines or (None,):
            if (entry.id, engine) not in told:
                with recorder.check(entry.id, engine) as left:
                    left.skip(reason)


def _poured(request: StageRequest, task: TaskRequest, check: OpenCheck) -> _Poured | None:
    """Measure both vessels and plan; None with a finding where that makes no sense."""
    settings, work = request.settings, request.work
    try:
        if task.into is None:
            raise InputError("--task pour needs --into with the URDF of the container, e.g. --into bowl.urdf.")
        cup = read_vessel(request.urdf, work / "cup.urdf", settings, scale=task.scale)
        into = read_vessel(task.into, work / "into.urdf", settings)
        arm = Arm(robot_of(task, work), settings.task.plan, seed=settings.seed)
        plan = plan_pour(arm, cup, into, work, settings, seed=settings.seed)
    except InputError as error:
        check.find(str(error), "Give what the message asks for.")
        return None
    return _Poured(plan, None if plan.motion is None else load(plan.motion, work, settings.prepare))


def _tell_plan(recorder: Recorder, plan: PourPlan, request: StageRequest) -> set[tuple[str, str | None]]:
    """KV702 to KV705."""
    for name in _CHECK_OF.values():
        with recorder.check(name) as check:
            if plan.failure is not None and _CHECK_OF[plan.failure] == name:
                message = _MESSAGES[plan.failure].format(words=plan.words, share=plan.fraction)
                check.find(message, "Give another --robot or another container.", value=plan.fraction, limit=1.0)
            elif name == "KV705" and plan.failure is None and plan.motion is not None:
                grasp, tilt = plan.motion.grasp, request.settings.task.pour.tilt_deg
                check.find(
                    f"The arm lifts the cup at a {grasp.kind} that is {grasp.width * 1e3:.0f} mm thick, carries it "
                    f"upright over the container and tilts it by {tilt:.0f} deg about its lip.",
                    "Nothing to do.",
                    severity=Severity.NOTE,
                    value=plan.fraction,
                )
            if name == "KV705":
                check.measured.update({"carried": plan.fraction, "seconds": plan.seconds})
    return {(name, None) for name in _CHECK_OF.values()}


def _tell_runs(
    recorder: Recorder, poured: _Poured, request: StageRequest, task: TaskRequest
) -> set[tuple[str, str | None]]:
    """KV707 to KV709."""
    told: set[tuple[str, str | None]] = set()
    first: Execution | None = None
    for name, engine, hold, where in _RUNS:
        if engine not in request.task_engines or not recorder.wants(name, "KV709"):
            continue
        told.add((name, engine))
        with recorder.check(name, engine) as check:
            if poured.loaded is None:
                check.skip("there is no plan that could be executed")
                continue
            execution = _executed(poured.loaded, engine, hold, request)
            first = first or execution
            check.measured.update({"share": execution.share, "depth": execution.depth})
            if not execution.success:
                check.find(
                    f"The pouring fails {where}: {execution.reason}.",
                    "Check masses and collision geometry of the cup; the plan itself is free of collisions.",
                    value=execution.share,
                    limit=request.settings.task.execution.opened,
                    pair=execution.deepest,
                )
    if first is not None and poured.loaded is not None and task.films is not None and recorder.wants("KV709"):
        told.add(("KV709", None))
        with recorder.check("KV709") as check:
            film = task.films / f"{task.stem}.gif"
            write_film(poured.loaded, first, film, film.with_suffix(".png"), request.settings.task.film)
            check.find(f"{film.name} shows how it is poured.", "Nothing to do.", severity=Severity.NOTE)
    return told


def _executed(loaded: Loaded, engine: str, hold: Hold, request: StageRequest) -> Execution:
    settings = request.settings.task.execution
    if engine == "mujoco":
        return execute_mujoco.execute(loaded, settings, hold=hold)
    return execute_pybullet.execute(loaded, settings)
