"""Shared by several checks: needs, each as the reason why there is nothing to look at, or None, causes and wording."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import CauseScope
from kinematify.validation.finding import not_finished

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.geometry.scene import Scene
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


UNSEEN = "Only the collision geometry does so; the visible surfaces stay clear."
BARELY = "Only the collision geometry does so that deep; the visible surfaces do not get so far into each other."
UNFELT = "What is visible does so; one of the two has no collision geometry, and no engine stops them."
SLIMMER = "Make the collision geometry of the two links follow the visible one more closely; the joint may be right."


def length(metres: float) -> str:
    """A length as people say it."""
    return f"{metres * 1e3:.3g} mm" if abs(metres) < 1.0 else f"{metres:.3g} m"


def joint_value(value: float, *, turns: bool) -> str:
    """The value of a joint as a file has it, with degrees beside radians."""
    return f"{value + 0.0:.4g} rad ({np.degrees(value) + 0.0:.3g} deg)" if turns else f"{value + 0.0:.4g} m"


def configuration(scene: Scene, values: Mapping[int, float]) -> dict[str, float]:
    """Rest with some leaders elsewhere, every joint by name [rad or m]."""
    row = scene.mechanism.rest.copy()
    for leader, value in values.items():
        row[leader] = value
    return dict(zip(scene.mechanism.joints, scene.mechanism.all_values(row[None])[0].tolist(), strict=True))
