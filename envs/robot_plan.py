"""Where the robot of DrawerPull stands, how it would hold the part, and a way on which it can open it.

The plan is that of `kinematify validate --task pull`. It is kept between runs, since it takes seconds.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, fields
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.config.validation import load_settings
from kinematify.envs.articulated_object import loadable
from kinematify.envs.model_verdict import content_digest, keep, kept, tell
from kinematify.errors import InputError
from kinematify.geometry.scene import read_scene
from kinematify.manipulation.kinematics import Arm
from kinematify.manipulation.manipulator import builtin_robot, user_robot
from kinematify.manipulation.planning import plan_pull
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject
    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.manipulator import TaskRobot
    from kinematify.robot.arrays import FloatArray

_PLAN_SECONDS = 20.0  # of processor time for finding a place of the robot: it is kept for the next time


@dataclass(frozen=True, kw_only=True, eq=False)
class EnvRobot:
    """A robot as the engines load it."""

    robot: TaskRobot
    arm: Arm
    loaded: Path
    """What engines load (`loadable`)."""
    scene: Scene
    """Of that file."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RobotPlan:
    """World frame, floor at z = 0, the object at its usual place."""

    T_world_base: FloatArray
    """Root link of the robot, shape (4, 4)."""
    T_world_object: FloatArray
    """Root link of the object, shape (4, 4)."""
    T_link_tool: FloatArray
    """Tool at the grasp, frame of the link that the joint moves, shape (4, 4)."""
    reach: FloatArray
    """Arm joints from the start to the grasp [rad or m], shape (n, dof)."""
    pull: FloatArray
    """Arm joints from the grasp on [rad or m], shape (m, dof)."""
    opened: FloatArray
    """Value of the object's joint in each row of `pull` [rad or m], shape (m,)."""
    fraction: float
    """Share of the joint's range that the pull opens."""
    first: dict[str, float]
    """Joints of the object that stand open from the start, since they are in the way [rad or m]."""


@lru_cache(maxsize=8)
def env_robot(articulated_object: ArticulatedObject, robot: str | None, tool: str | None) -> EnvRobot:
    """Read a robot, the built-in arm if None; its files lie beside those of the object.

    Raises:
        InputError: There is no such robot, tool or gripper.
    """
    if robot is not None and tool is None:
        raise InputError(
            f"robot={robot!r} needs tool= with the link that carries the fingers, such as tool='gripper_link'."
        )
    folder = articulated_object.folder / hashlib.sha256(f"{robot} {tool}".encode()).hexdigest()[:12]
    folder.mkdir(parents=True, exist_ok=True)
    found = builtin_robot() if robot is None or tool is None else user_robot(Path(robot), tool, folder=folder)
    loaded = loadable(found.urdf, folder)
    scene = read_scene(read_robot(loaded), load_settings().geometry)
    return EnvRobot(robot=found, arm=Arm(found), loaded=loaded, scene=scene)


@lru_cache(maxsize=16)
def robot_plan(articulated_object: ArticulatedObject, joint: str, robot: EnvRobot) -> RobotPlan:
    """Plan, or take the plan of an earlier run.

    Raises:
        InputError: The robot cannot open the joint; the message says why.
    """
    urdf = robot.robot.urdf.read_bytes()
    digest = hashlib.sha256(
        f"{content_digest(articulated_object)} {joint} {robot.robot.tool}".encode() + urdf
    ).hexdigest()
    known = kept("plans", digest)
    if known is None:
        tell(f"planning how the robot opens {joint} of {articulated_object.source}; it takes seconds, once")
        known = _planned(articulated_object, joint, robot)
        keep("plans", digest, known)
    values = {field.name: known[field.name] for field in fields(RobotPlan)}
    facts: dict[str, Any] = {
        name: np.array(value) if isinstance(value, list) else value for name, value in values.items()
    }
    return RobotPlan(**facts)


def _planned(articulated_object: ArticulatedObject, joint: str, robot: EnvRobot) -> dict[str, object]:
    settings = load_settings().task.plan.model_copy(update={"seconds": _PLAN_SECONDS})
    plan = plan_pull(robot.arm, articulated_object.scene, joint, settings)
    if plan.place is None or plan.reach is None or plan.pull is None or plan.opened is None:
        raise InputError(
            f"The robot cannot open {joint} of the model {articulated_object.source}: {plan.words} (kinematify "
            "validate --task pull shows the reasons). Give another joint, or make kinematify/OpenPart-v0, which needs "
            "no robot."
        )
    return {
        "T_world_base": plan.place.T_world_base.tolist(),
        "T_world_object": plan.T_world_object.tolist(),
        "T_link_tool": plan.place.T_link_tool.tolist(),
        "reach": plan.reach.tolist(),
        "pull": plan.pull.tolist(),
        "opened": plan.opened.tolist(),
        "fraction": plan.fraction,
        "first": dict(plan.first),
    }
