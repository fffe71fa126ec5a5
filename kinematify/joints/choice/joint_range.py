"""Signed limits of a joint: what sweeps and rules say of how far it goes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.robot.joint_type import JointType


@dataclass(frozen=True, kw_only=True)
class Range:
    """Signed limits of a joint whose axis is turned so that q > 0 opens."""

    kind: JointType
    """`continuous` where a wheel or knob meets nothing in a full turn; else as given."""
    sign: float
    """+1 if the given axis opens the joint as it is, -1 if it must be reversed."""
    lower: float
    """Lower limit [rad or m]."""
    upper: float
    """Upper limit [rad or m]."""
    free_forward: float
    """Free motion in the opening direction [rad or m]."""
    free_backward: float
    """Free motion against it [rad or m]."""
