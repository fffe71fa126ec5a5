"""Environments that are seen by a camera: `observation="pixels"` and `"pixels+state"`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium import spaces

from kinematify.envs.base import one_of
from kinematify.errors import InputError

if TYPE_CHECKING:
    from kinematify.envs.base import OpeningEnv

STATE, PIXELS, BOTH = "state", "pixels", "pixels+state"
PIXEL_SIZE = (84, 84)
"""Height and width where none are asked for."""


class PixelObservation(gymnasium.ObservationWrapper[Any, Any, Any]):
    """Shows a picture of the object in place of its state, or both under the keys ``pixels`` and ``state``.

    Pictures are `Box(0, 255, (height, width, 3), uint8)`, the object at rest and open in sight, from the side to which
    it opens, the part that is opened in green. They are drawn by software, so that a seed gives the same picture on
    every machine and in both engines.
    """

    def __init__(self, env: OpeningEnv, *, with_state: bool, size: tuple[int, int]) -> None:
        """Wrap an environment.

        Args:
            env: What is seen.
            with_state: Return the state too.
            size: Height and width [pixels].
        """
        super().__init__(env)
        env.camera()  # now, so that the first reset is as quick as the others
        self._bare, self._with_state, self._size = env, with_state, size
        picture = spaces.Box(0, 255, (*size, 3), np.uint8)
        self.observation_space = spaces.Dict({PIXELS: picture, STATE: env.observation_space}) if with_state else picture

    def observation(self, observation: Any) -> Any:
        """Add the picture to a state, or put it in its place."""
        picture = self._bare.pixels(self._size)
        return {PIXELS: picture, STATE: observation} if self._with_state else picture


def observed(env: OpeningEnv, observation: str, size: tuple[int, int]) -> gymnasium.Env[Any, Any]:
    """Return an environment with the observations of an `observation` keyword.

    Raises:
        InputError: There is no such keyword, or the size is none.
    """
    one_of("observation", observation, (STATE, PIXELS, BOTH))
    if len(size) != 2 or min(size) < 1:
        raise InputError(f"pixel_size is {size}, but must be a height and a width in pixels, such as (84, 84).")
    return env if observation == STATE else PixelObservation(env, with_state=observation == BOTH, size=size)
