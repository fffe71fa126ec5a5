"""Temporary: the old names of what `robot` holds."""

from kinematify.robot.robot import Inertial as DeclaredInertial
from kinematify.robot.robot import Joint as DeclaredJoint
from kinematify.robot.robot import Link as DeclaredLink
from kinematify.robot.robot import Robot as DeclaredModel
from kinematify.robot.robot import Shape as DeclaredShape

__all__ = ["DeclaredInertial", "DeclaredJoint", "DeclaredLink", "DeclaredModel", "DeclaredShape"]
