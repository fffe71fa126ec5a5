"""Joints in words, for tables of rounds and for alternatives."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from kinematify.joints.candidate import JointEstimate


def described(joint: JointEstimate) -> str:
    """Type and axis, e.g. ``revolute about (0, 0, 1)``."""
    if joint.kind is JointType.FIXED:
        return "fixed"
    axis = ", ".join(f"{value + 0.0:.2g}" for value in joint.axis.round(3))
    if joint.kind is JointType.PRISMATIC:
        return f"{joint.kind.value} along ({axis})"
    place = ", ".join(f"{value + 0.0:.3g}" for value in joint.pivot)
    return f"{joint.kind.value} about ({axis}) through ({place})"


def ranged(joint: JointEstimate) -> str:
    """Range with its unit, e.g. ``0 to 90 deg``."""
    if joint.kind is JointType.FIXED:
        return "none"
    if not math.isfinite(joint.upper - joint.lower):
        return "unlimited"
    if joint.kind.turns:
        return f"{math.degrees(joint.lower):z.3g} to {math.degrees(joint.upper):.3g} deg"
    return f"{joint.lower * 1e3:z.3g} to {joint.upper * 1e3:.3g} mm"
