"""Shared by several checks: needs, each as the reason why there is nothing to look at, or None, and causes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import CauseScope
from kinematify.validation.finding import not_finished

if TYPE_CHECKING:
    from kinematify.validation.as_loaded_context import AsLoadedContext
    from kinematify.validation.asset.rigid_bodies import Physics
    from kinematify.validation.geometry.look import GeometryContext


AT_REST = {"KV301": CauseScope.PAIR, "KV302": CauseScope.PAIR}
"""Two bodies are in each other as the file is."""
NOT_A_BODY = {
    "KV201": CauseScope.MODEL,
    "KV202": CauseScope.MODEL,
    "KV204": CauseScope.MODEL,
    "KV205": CauseScope.MODEL,
}
"""Masses and inertias that no engine can compute with."""


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


def joints_move(look: GeometryContext) -> str | None:
    """A joint that moves, by geometry."""
    return None if look.scene.travels else "no joint moves"


def late(context: AsLoadedContext) -> str | None:
    """In an engine, time for one more run."""
    return not_finished("time ran out before it") if context.request.remaining <= 0.0 else None
