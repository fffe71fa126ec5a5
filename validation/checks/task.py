"""KV701 to KV709: a robot uses the object, it opens every joint (`validation/task`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.manipulation.plan_request import Failure, Hold
from kinematify.validation.check import check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.task.pull_task import PullTask


@check(
    "KV701",
    title="The task can be set up",
    fails="The task cannot be set up",
    severity=Severity.ERROR,
    cause=Cause.TASK,
    guard=True,
)
def task_set_up(result: OpenCheck, task: PullTask) -> None:
    """The object has a joint that moves, its size is that of a thing that an arm can use (objects of common
    collections are brought to the usual size of what they are called; --scale wins), and the point of --grasp lies
    on a part that moves.

    Why it matters: Nothing can be said about a task with a cabinet of 300 m, or with a lamp that has no joint.

    Remedy: Give --scale with the metres per unit of the model, or another point.
    """
    task.set_up(result)


@check(
    "KV702",
    title="A gripper finds a hold",
    fails="A gripper finds no hold",
    severity=Severity.WARNING,
    cause=Cause.TASK,
)
def no_hold(result: OpenCheck, task: PullTask) -> None:
    """On what the joint moves there is a place that two parallel pads can take: seen from outside, with opposite sides
    within the opening of the gripper, and with room for the fingers beside it and for the hand behind it. Handles,
    knobs and rims are found from the shape alone. Joints that move what they carry by less than task.plan.least_way
    are noted and omitted.

    Why it matters: A part without a hold can only be pushed; a robot that pulls it needs another tool.

    Remedy: Model the handle, free its surroundings, give --grasp with a point, or take a wider gripper.
    """
    task.tell_failures(result, Failure.NO_WAY, Failure.NO_GRASP)


@check(
    "KV703",
    title="An arm reaches the hold",
    fails="No arm reaches the hold",
    severity=Severity.ERROR,
    cause=Cause.TASK,
)
def out_of_reach(result: OpenCheck, task: PullTask) -> None:
    """From at least one place around the object (task.plan.bearings, distances, heights) the arm's inverse kinematics
    reaches one of the holds, within the joints' limits and without meeting the object, the floor or itself while it
    holds on.

    Why it matters: What no place can reach is no question of the model's joints: the hold is hidden, or the arm
    small.

    Remedy: Give --grasp with a hold that is easier to reach, another --robot, or the right --scale.
    """
    task.tell_failures(result, Failure.NO_REACH)


@check(
    "KV704",
    title="A way leads to the hold",
    fails="No way leads to the hold",
    severity=Severity.ERROR,
    cause=Cause.TASK,
)
def no_path(result: OpenCheck, task: PullTask) -> None:
    """From the arm's home posture, RRTConnect finds a path free of collisions (task.plan.margin) to a place in front
    of the hold, and a straight way leads in from there.

    Why it matters: A hand that cannot get in without touching what is beside it pushes it over.

    Remedy: Free the surroundings of the hold, or give --grasp with another one.
    """
    task.tell_failures(result, Failure.NO_PATH)


@check(
    "KV705",
    title="An arm opens the joint",
    fails="An arm does not open the joint",
    severity=Severity.ERROR,
    cause=Cause.TASK,
)
def not_opened(result: OpenCheck, task: PullTask) -> None:
    """With the hand fixed to the part, the arm follows the joint from rest to the farther end of its range (joints
    without limits by task.plan.range_turn); task.plan.opened of it counts. What ends a pull earlier is said: a
    limit of the arm, a singular posture, the arm's own parts, the object, the floor. Where the checks of KV3xx
    doubt the joint, the joint is the cause.

    Why it matters: A policy can only learn to open what the arm can open.

    Remedy: Give another --robot or --grasp, or accept the part of the range that opens; if the joint is the cause,
    correct axis, type or limits first.
    """
    task.tell_failures(result, Failure.STOPS, Failure.COVERED)
    task.tell_successes(result)


@check(
    "KV706",
    title="The joint leaves its part the way that a pull needs",
    fails="The joint blocks the way that a pull needs",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def jams(result: OpenCheck, task: PullTask) -> None:
    """On the way from rest to the open end, the moved part does not run into its own parent before task.plan.opened of
    the range, and no check of KV3xx doubts axis, type, place or limits of the joint.

    Why it matters: A robot that pulls at a part whose joint points elsewhere tears it out, or the gripper slips.

    Remedy: Correct the joint as the named check of KV3xx says, and plan again.
    """
    task.tell_failures(result, Failure.JAMS)
    task.tell_doubts(result)


@check(
    "KV707",
    title="The plan works in simulation",
    fails="The plan fails in simulation",
    severity=Severity.ERROR,
    cause=Cause.TASK,
    runs_in=lambda engine: Hold.WELD in engine.holds,
)
def plan_fails(result: OpenCheck, task: PullTask) -> None:
    """Joint servos track the plan with the hand welded to the part when the fingers have arrived; the joint ends at
    task.execution.opened of the planned way, at rest, and the robot gets nowhere deeper into the object than
    task.execution.depth.

    Why it matters: A plan that an engine does not follow fails in training: masses, efforts or convex pieces are in
    the way.

    Remedy: Check the collision geometry beside the part (KV804) and the masses; the plan itself is free of
    collisions.
    """
    task.tell_executions(result, Hold.WELD)


@check(
    "KV708",
    title="Friction alone holds",
    fails="Friction alone does not hold",
    severity=Severity.NOTE,
    cause=Cause.TASK,
    runs_in=lambda engine: Hold.CONTACT in engine.holds,
)
def slips(result: OpenCheck, task: PullTask) -> None:
    """The same with real contact: the fingers close with task.execution.grip_force, and nothing but friction
    (task.execution.friction) holds the part.

    Why it matters: A policy has no weld. Round knobs and thin rims slip where the motion turns in the hand.

    Remedy: Take a hold with flat sides, or let the hand turn about the hold.
    """
    task.tell_executions(result, Hold.CONTACT)


@check(
    "KV709", title="Films of the task are written", fails="Films of the task", severity=Severity.NOTE, cause=Cause.TASK
)
def films(result: OpenCheck, task: PullTask) -> None:
    """Nothing: it names the films. Each shows the first execution of a plan, as a GIF, and beside it a still of its
    three moments: before, at the grasp, and open.

    Why it matters: A picture shows at once whether the hold and the motion are what was meant.

    Remedy: Nothing to do.
    """
    task.tell_films(result)
