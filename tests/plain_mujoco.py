"""Joints pushed by a hand in MuJoCo as it comes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.model.dynamics import HAND_FORCE, HAND_TORQUE

if TYPE_CHECKING:
    from kinematify.robot.robot import Joint, Robot


def hand(joint: Joint) -> float:
    """Torque or force of a hand [N m or N]."""
    return HAND_TORQUE if joint.kind.turns else HAND_FORCE


def wanted(joint: Joint) -> float:
    """Signed value that a joint is to reach: 95 % of the longer way [rad or m]."""
    upper, lower = (end if math.isfinite(end) else math.copysign(math.pi, end) for end in (joint.upper, joint.lower))
    return 0.95 * (upper if upper >= -lower else lower)


def stuck_joints(model: mujoco.MjModel, robot: Robot) -> list[str]:
    """Joints that do not get where they should when each is pushed alone, the others held."""
    stuck = []
    for joint in robot.leaders:
        data = mujoco.MjData(model)
        at, dof = model.joint(joint.name).qposadr[0], model.joint(joint.name).dofadr[0]
        others, goal = np.arange(model.nv) != dof, wanted(joint)
        for _ in range(3000):
            data.qfrc_applied[dof] = math.copysign(hand(joint), goal)
            mujoco.mj_step(model, data)
            data.qpos[others], data.qvel[others] = 0.0, 0.0
            if abs(data.qpos[at]) >= abs(goal):
                break
        if abs(data.qpos[at]) < abs(goal):
            stuck.append(joint.name)
    return stuck
