"""What several checks of declared physics need, each as the reason why there is nothing to look at, or None."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from kinematify.validation.asset.bodies import Physics


def something_moves(physics: Physics) -> str | None:
    """A joint that is not fixed."""
    moving = any(joint.kind is not JointType.FIXED for joint in physics.model.joints)
    return None if moving else "no joint moves"


def something_weighs(physics: Physics) -> str | None:
    """A body with a mass."""
    return None if any(body.mass > 0.0 for body in physics.bodies) else "no link has a mass"


def something_follows(physics: Physics) -> str | None:
    """A mimic joint."""
    return None if any(joint.mimic is not None for joint in physics.model.joints) else "no joint follows another"


def something_collides(physics: Physics) -> str | None:
    """A link with collision geometry."""
    return None if physics.collision else "no link has collision geometry"
