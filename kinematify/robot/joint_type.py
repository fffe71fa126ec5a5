"""The joint types that ground truth, candidates and models share."""

from __future__ import annotations

from enum import StrEnum


class JointType(StrEnum):
    """Joint types of URDF that Kinematify infers."""

    FIXED = "fixed"
    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"

    @property
    def turns(self) -> bool:
        """True for revolute and continuous joints, whose axis has a position."""
        return self in (JointType.REVOLUTE, JointType.CONTINUOUS)


FREE_KINDS = ("floating", "planar")
"""Types of URDF that let a body move freely: they say that a model stands in the world without being fixed to it."""
