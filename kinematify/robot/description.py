"""Temporary: the old names of what `robot` and `read` hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.robot.read import read_robot
from kinematify.robot.robot import Joint as DescribedJoint
from kinematify.robot.robot import Link as DescribedLink
from kinematify.robot.robot import (
    LinkMesh,
    Mimic,
    RigidGroup,
    forward_kinematics,
    joint_values,
    rest_configuration,
    rigid_groups,
)
from kinematify.robot.robot import Robot as RobotDescription
from kinematify.robot.urdf_text import parse_description

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

__all__ = [
    "DescribedJoint", "DescribedLink", "LinkMesh", "Mimic", "RigidGroup", "RobotDescription", "forward_kinematics",
    "joint_values", "parse_description", "read_description", "rest_configuration", "rigid_groups",
]  # fmt: skip


def read_description(path: Path, *, package_dirs: Sequence[Path] = ()) -> RobotDescription:
    """Read what is shown of a URDF; see `read_robot`."""
    return read_robot(path, package_dirs=package_dirs, geometry="shown")
