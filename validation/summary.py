"""Facts that a stage tells besides its checks: what is known of joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.robot import Joint


@dataclass(frozen=True, kw_only=True)
class JointSummary:
    """Facts of one joint at the end."""

    joint: str
    kind: str
    declared_limits: tuple[float, float] | None
    """[rad or m]; None where there are none."""
    free_travel: tuple[float, float] | None = None
    """Range around rest in which nothing collides [rad or m]; None if it was not measured."""
    best_alternative: Mapping[str, Any] | None = None
    """``kind``, ``axis``, ``pivot`` (world frame at zero), ``score`` of a joint that explains the geometry better."""


def summary_of(joint: Joint, **known: Any) -> JointSummary:
    """Return what a file declares of a joint, with what is known of it besides."""
    limited = joint.kind in (JointType.REVOLUTE, JointType.PRISMATIC)
    limits = (joint.lower, joint.upper) if limited else None
    return JointSummary(joint=joint.name, kind=joint.kind.value, declared_limits=limits, **known)
