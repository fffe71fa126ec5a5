"""Loads that the joints of a robot must bear against gravity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.sampling import spread_rows
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

_GRAVITY = 9.81
_NO_LIMIT = np.pi
"""Range to each side in which a joint without limits is looked at [rad]."""


def worst_loads(robot: Robot, doublings: int) -> dict[str, tuple[float, dict[str, float]]]:
    """Return the largest weight at each joint [N m or N] and the configuration that it was found in.

    Args:
        robot: Its root is fixed, and gravity acts along -z of it.
        doublings: Of the number of configurations that are looked at beside rest.
    """
    loads: dict[str, tuple[float, dict[str, float]]] = {}
    for q in _configurations(robot, doublings):
        poses = forward_kinematics(robot, q)
        carried = _carried(robot, poses)
        for joint in robot.joints:
            if joint.kind is JointType.FIXED:
                continue
            mass, moment = carried[joint.child]
            axis = poses[joint.child][:3, :3] @ joint.axis
            load = mass * abs(axis[2])
            if joint.kind.turns:
                lever = moment - mass * poses[joint.child][:3, 3]
                load = abs(float(axis[1] * lever[0] - axis[0] * lever[1]))
            if _GRAVITY * load > loads.get(joint.name, (0.0, {}))[0]:
                loads[joint.name] = _GRAVITY * float(load), q
    return loads


def _configurations(robot: Robot, doublings: int) -> list[dict[str, float]]:
    """Rest and quasi-random configurations within the limits."""
    joints = robot.leaders
    rest = rest_configuration(robot)
    found = [{joint.name: rest[joint.name] for joint in joints}]
    if joints:
        ends = np.array([[joint.lower, joint.upper] for joint in joints])
        low, high = np.clip(ends, -_NO_LIMIT, _NO_LIMIT).T
        values = spread_rows(low, high, 2**doublings, seed=0)
        found += [dict(zip([joint.name for joint in joints], row.tolist(), strict=True)) for row in values]
    return found


def _carried(robot: Robot, poses: dict[str, FloatArray]) -> dict[str, tuple[float, FloatArray]]:
    """Mass [kg] and mass times centre [kg m] of each link with all that hangs on it, world frame."""
    carried: dict[str, tuple[float, FloatArray]] = {}
    for link in robot.links:
        mass = 0.0 if link.inertial is None else max(link.inertial.mass, 0.0)
        centre = np.zeros(3) if link.inertial is None else link.inertial.center_of_mass
        pose = poses[link.name]
        carried[link.name] = mass, mass * (pose[:3, :3] @ centre + pose[:3, 3])
    for joint in reversed(robot.joints_downward):
        mass, moment = carried[joint.parent]
        more, further = carried[joint.child]
        carried[joint.parent] = mass + more, moment + further
    return carried
