"""KV7xx: a robot uses the object."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity

CHECKS: tuple[Check, ...] = (
    Check(
        id="KV701",
        title="the task can be set up",
        severity=Severity.ERROR,
        blame=Blame.TASK,
        verifies="The object has a joint that moves, its size is that of a thing that an arm can use (objects of "
        "common collections are brought to the usual size of what they are called; --scale wins), and the point of "
        "--grasp lies on a part that moves.",
        matters="Nothing can be said about a task with a cabinet of 300 m, or with a lamp that has no joint.",
        remedy="Give --scale with the metres per unit of the model, or another point.",
    ),
    Check(
        id="KV702",
        title="a gripper finds a hold",
        severity=Severity.WARNING,
        blame=Blame.TASK,
        verifies="On what the joint moves there is a place that two parallel pads can take: seen from outside, with "
        "opposite sides within the opening of the gripper, and with room for the fingers beside it and for the hand "
        "behind it. Handles, knobs and rims are found from the shape alone. Joints that move what they carry by less "
        "than task.plan.least_way are noted and left out.",
        matters="A part without a hold can only be pushed; a robot that pulls it needs another tool.",
        remedy="Model the handle, free its surroundings, give --grasp with a point, or take a wider gripper.",
    ),
    Check(
        id="KV703",
        title="an arm reaches the hold",
        severity=Severity.ERROR,
        blame=Blame.TASK,
        verifies="From at least one place around the object (task.plan.bearings, distances, heights) the arm's inverse "
        "kinematics reaches one of the holds, within the joints' limits and without meeting the object, the floor or "
        "itself while it holds on.",
        matters="What no place can reach is no question of the model's joints: the hold is hidden, or the arm small.",
        remedy="Give --grasp with a hold that is easier to reach, another --robot, or the right --scale.",
    ),
    Check(
        id="KV704",
        title="a way leads to the hold",
        severity=Severity.ERROR,
        blame=Blame.TASK,
        verifies="From the arm's home posture, RRTConnect finds a path free of collisions (task.plan.margin) to a "
        "place in front of the hold, and a straight way leads in from there.",
        matters="A hand that cannot get in without touching what is beside it pushes it over.",
        remedy="Free the surroundings of the hold, or give --grasp with another one.",
    ),
    Check(
        id="KV705",
        title="an arm opens the joint",
        severity=Severity.ERROR,
        blame=Blame.TASK,
        verifies="With the hand fixed to the part, the arm follows the joint from rest to the farther end of its range "
        "(joints without limits by task.plan.range_turn); task.plan.opened of it counts. What ends a pull earlier is "
        "said: a limit of the arm, a singular posture, the arm's own parts, the object, the floor. Where the checks of "
        "KV3xx doubt the joint, that is blamed.",
        matters="A policy can only learn to open what the arm can open.",
        remedy="Give another --robot or --grasp, or accept the part of the range that opens; if the joint is blamed, "
        "correct axis, type or limits first.",
    ),
    Check(
        id="KV706",
        title="the joint leaves its part the way that a pull needs",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="On the way from rest to the open end, the moved part does not run into its own parent before "
        "task.plan.opened of the range, and no check of KV3xx doubts axis, type, place or limits of the joint.",
        matters="A robot that pulls at a part whose joint points elsewhere tears it out, or the gripper slips.",
        remedy="Correct the joint as the named check of KV3xx says, and plan again.",
    ),
    Check(
        id="KV707",
        title="the plan works in simulation",
        severity=Severity.ERROR,
        blame=Blame.TASK,
        engines=("mujoco", "pybullet"),
        verifies="Joint servos track the plan with the hand welded to the part when the fingers have arrived; the "
        "joint ends at task.execution.opened of the planned way, at rest, and the robot gets nowhere deeper into the "
        "object than task.execution.depth.",
        matters="A plan that an engine does not follow fails in training: masses, efforts or convex pieces are in the "
        "way.",
        remedy="Check the collision geometry beside the part (KV332) and the masses; the plan itself is free of "
        "collisions.",
    ),
    Check(
        id="KV708",
        title="friction alone holds",
        severity=Severity.NOTE,
        blame=Blame.TASK,
        engines=("mujoco",),
        verifies="The same with real contact: the fingers close with task.execution.grip_force, and nothing but "
        "friction (task.execution.friction) holds the part.",
        matters="A policy has no weld. Round knobs and thin rims slip where the motion turns in the hand.",
        remedy="Take a hold with flat sides, or let the hand turn about the hold.",
    ),
    Check(
        id="KV709",
        title="films of the task",
        severity=Severity.NOTE,
        blame=Blame.TASK,
        verifies="Nothing: it names the films. Each shows the first execution of a plan, as a GIF, and beside it a "
        "still of its three moments: before, at the grasp, and open.",
        matters="A picture shows at once whether the hold and the motion are what was meant.",
        remedy="Nothing to do.",
    ),
)
