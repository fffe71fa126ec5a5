"""What is seen, what counts as open, and what is rewarded: one set of formulas for one environment and for many.

All arrays may have leading axes of environments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.assembly.part import FloatArray
    from kinematify.envs.reading import Reading
    from kinematify.envs.settings import EnvSettings
    from kinematify.envs.thing import Target, Thing

    BoolArray = NDArray[np.bool_]

OPEN_BOUND, SPEED_BOUND, PLACE_BOUND = 2.0, 20.0, 10.0
"""Ends of observed shares [1], speeds [1/s] and places [m]; what goes beyond is clipped."""

_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


@dataclass(slots=True, eq=False)
class Progress:
    """What the judgement remembers from step to step."""

    fraction: FloatArray
    """Share of the way that is open."""
    speed: FloatArray
    """[ways/s]."""
    thrown: BoolArray
    """The part went fast where it counts as open, and has not come back since."""


class Goal:
    """The joint that is opened, as the share of a way."""

    def __init__(self, thing: Thing, target: Target, open_fraction: float, settings: EnvSettings) -> None:
        """Keep what the formulas need.

        Args:
            thing: The object.
            target: Its joint.
            open_fraction: Share of the way that counts as open.
            settings: Of task and reward.
        """
        self.target, self.open_fraction, self.task, self.reward = target, open_fraction, settings.task, settings.reward
        travels = thing.travels
        self.slots = settings.object.slots * -(-len(travels) // settings.object.slots)
        self._order = np.array([target.leader, *(k for k in range(len(travels)) if k != target.leader)], dtype=np.int64)
        lower = np.array([travels[k].lower for k in self._order])
        scale = np.array([max(travels[k].range, 1e-9) for k in self._order])
        lower[0], scale[0] = target.closed, target.range
        self._lower, self._scale = lower, scale
        self._sign = np.sign(target.range)
        self._step = settings.time.control_step
        self._count = len(travels)

    def fraction(self, reading: Reading) -> FloatArray:
        """Share of the way that is open, shape (...)."""
        fraction: FloatArray = (reading.values[..., self.target.leader] - self.target.closed) / self.target.range
        return fraction

    def speed(self, reading: Reading) -> FloatArray:
        """[ways/s], positive opens, shape (...)."""
        speed: FloatArray = reading.speeds[..., self.target.leader] / self.target.range
        return speed

    def direction(self, reading: Reading) -> FloatArray:
        """Unit direction in which the hold moves when the part opens, zero where it does not, shape (..., 3)."""
        if not self.target.turns:
            return np.asarray(self._sign * reading.axis)
        arm = reading.hold - reading.anchor
        # Several times as fast as numpy.cross for one environment.
        moves = reading.axis[..., _NEXT] * arm[..., _LAST] - reading.axis[..., _LAST] * arm[..., _NEXT]
        length = np.sqrt(np.vecdot(moves, moves))[..., None]
        return np.asarray(self._sign * moves / np.maximum(length, 1e-9))

    def fill_joints(self, reading: Reading, out: FloatArray) -> None:
        """Write the share, speed and mask of every joint, the opened one first, to (..., 3 * slots)."""
        slots, count = self.slots, self._count
        shares = (reading.values[..., self._order] - self._lower) / self._scale
        speeds = reading.speeds[..., self._order] / self._scale
        out[..., :count] = np.minimum(np.maximum(shares, -OPEN_BOUND), OPEN_BOUND)
        out[..., slots : slots + count] = np.minimum(np.maximum(speeds, -SPEED_BOUND), SPEED_BOUND)
        out[..., 2 * slots : 2 * slots + count] = 1.0

    def begin(self, reading: Reading) -> Progress:
        """Start of an episode."""
        fraction, speed = self.fraction(reading), self.speed(reading)
        return Progress(fraction=fraction, speed=speed, thrown=np.zeros(np.shape(fraction), dtype=bool))

    def judge(self, reading: Reading, progress: Progress) -> tuple[BoolArray, FloatArray, FloatArray]:
        """Update `progress`.

        Returns:
            Success; how well the part stands open, in [0, 1]; how fast it was at most since last time [ways/s].
        """
        task = self.task
        fraction, speed = self.fraction(reading), self.speed(reading)
        between = np.abs(fraction - progress.fraction) / self._step
        fastest = np.maximum(np.maximum(np.abs(speed), np.abs(progress.speed)), between)
        opened = fraction >= self.open_fraction
        kept = progress.thrown & (fraction >= self.open_fraction - task.forget)
        progress.thrown = kept | (opened & (fastest > task.fast))
        success = opened & (fastest <= task.calm) & ~progress.thrown
        progress.fraction, progress.speed = fraction, speed
        open_share = np.minimum(np.maximum(fraction / self.open_fraction, 0.0), 1.0)
        slow = np.minimum(np.maximum(2.0 - fastest / task.fast, 0.0), 1.0)
        return success, open_share * slow * ~progress.thrown, fastest
