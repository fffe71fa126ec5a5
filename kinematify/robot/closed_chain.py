"""Pins that two links share though no joint of the tree joins them: there a chain of joints closes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.mechanism import Mechanism
from kinematify.robot.robot import forward_kinematics

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot


@dataclass(frozen=True, kw_only=True)
class Opening:
    """How far a shared pin comes apart when one joint moves alone."""

    joint: str
    """Leader that opens it most."""
    value: float
    """Where that leader stands then [rad or m]."""
    distance: float
    """Between the two ends of the pin there [m]."""


def widest_opening(robot: Robot, links: tuple[str, str], point: FloatArray) -> Opening | None:
    """Move each leader that moves one of two links without the other to its ends; None where there is no such leader.

    Mimic joints that keep a linkage closed keep its pins closed, too.

    Args:
        robot: A tree.
        links: The two that share a pin.
        point: Of the pin, frame of the root link at rest [m], shape (3,).
    """
    mechanism = Mechanism(robot=robot)
    first, second = (int(mechanism.body_of_link[mechanism.links.index(link)]) for link in links)
    rest = {travel.joint: travel.rest for travel in mechanism.travels}
    at_rest = forward_kinematics(robot, rest)
    found = []
    for travel, moved in zip(mechanism.travels, mechanism.moved, strict=True):
        if not (moved[first] or moved[second]):
            continue
        for value in (travel.lower, travel.upper):
            if value == travel.rest:
                continue
            poses = forward_kinematics(robot, {**rest, travel.joint: value})
            ends = [poses[link] @ np.linalg.inv(at_rest[link]) @ np.append(point, 1.0) for link in links]
            found.append(Opening(joint=travel.joint, value=value, distance=float(np.linalg.norm(ends[0] - ends[1]))))
    return max(found, key=lambda opening: opening.distance, default=None)


def joints_between(robot: Robot, links: tuple[str, str]) -> tuple[str, ...]:
    """Return the joints of the tree on the way from one link to another, fixed ones left out."""
    ways = []
    for link in links:
        way, above = [], robot.joint_above.get(link)
        while above is not None:
            way.append(above)
            above = robot.joint_above.get(above.parent)
        ways.append(way)
    first, second = ways
    shared = {joint.name for joint in first} & {joint.name for joint in second}
    between = [joint for joint in [*first, *second[::-1]] if joint.name not in shared]
    return tuple(joint.name for joint in between if joint.kind is not JointType.FIXED)
