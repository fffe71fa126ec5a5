"""HalfOpen: bring a part to the middle of its way, and keep it there."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np

from kinematify.envs.base import made
from kinematify.envs.goal import CALM, Goal
from kinematify.envs.open_part import OpenPartEnv
from kinematify.envs.vector import OpenPartVectorEnv

if TYPE_CHECKING:
    from kinematify.simulation.world import ObjectState


class HalfOpen(Goal):
    """At rest within 5 % of the middle."""

    def judge(self, reading: ObjectState, progress: dict[str, Any]) -> tuple[Any, Any]:
        """Return success, and how near the part is to it, in [0, 1]: numbers, or arrays for many environments."""
        fraction, speed = self.fraction(reading), self.speed(reading)
        progress.update(fraction=fraction, speed=speed)
        away = abs(fraction - 0.5)
        return (away < 0.05) & (abs(speed) < CALM), 1.0 - np.minimum(2.0 * away, 1.0)


class HalfOpenEnv(OpenPartEnv):
    """`OpenPartEnv` with another goal; spaces, start and randomisation are the same."""

    goal_type = HalfOpen


gymnasium.register(
    "mine/HalfOpen-v0",
    entry_point=partial(made, HalfOpenEnv),
    vector_entry_point=partial(OpenPartVectorEnv, env_type=HalfOpenEnv),
    max_episode_steps=100,
)
