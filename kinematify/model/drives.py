"""An effort and a velocity for every joint that moves: as declared where engines can use them, made up elsewhere."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from kinematify.config.validation import PrepareSettings
    from kinematify.robot.robot import Joint


def lacks_drive(joint: Joint) -> bool:
    """True if a joint that moves has no effort or no velocity above zero."""
    return joint.kind is not JointType.FIXED and (_positive(joint.effort) is None or _positive(joint.velocity) is None)


def prepared_joint(joint: Joint, settings: PrepareSettings) -> Joint:
    """Return the joint with what readers demand; negative damping and friction, which they refuse, are left out."""
    return replace(
        joint,
        effort=_positive(joint.effort) or settings.effort,
        velocity=_positive(joint.velocity) or settings.velocity,
        damping=_unless_negative(joint.damping),
        friction=_unless_negative(joint.friction),
    )


def _positive(value: float | None) -> float | None:
    return value if value is not None and value > 0.0 else None


def _unless_negative(value: float | None) -> float | None:
    return value if value is not None and value >= 0.0 else None
