"""Observation, success and reward: one set of formulas for one environment and for many.

All arrays may have leading axes of environments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.settings import EnvSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.world import ObjectState


OPEN_BOUND, SPEED_BOUND, PLACE_BOUND = 2.0, 20.0, 10.0
"""Ends of observed shares [1], speeds [1/s] and places [m]; what goes beyond is clipped."""

_SHORT = 1e-9  # a hold that is nearer to an axis moves nowhere [m]


@dataclass(slots=True, eq=False)
class Progress:
    """State that the judgement remembers from step to step."""

    fraction: Any
    """Share of the way that is open: a float for one environment, else shape (n,); so are the others."""
    speed: Any
    """[ways/s]."""
    thrown: Any
    """The part went fast where it counts as open, and has not come back since."""


class Goal:
    """The joint that is opened, as the share of a way."""

    def __init__(
        self, articulated_object: ArticulatedObject, target: Target, open_fraction: float, settings: EnvSettings
    ) -> None:
        """Keep what the formulas need.

        Args:
            articulated_object: The object.
            target: Its joint.
            open_fraction: Share of the way that counts as open.
            settings: Of task and reward.
        """
        self.target, self.open_fraction, self.task, self.reward = target, open_fraction, settings.task, settings.reward
        travels = articulated_object.travels
        self.slots = settings.object.slots * -(-len(travels) // settings.object.slots)
        self._order = np.array([target.leader, *(k for k in range(len(travels)) if k != target.leader)], dtype=np.int64)
        lower = np.array([travels[k].lower for k in self._order])
        scale = np.array([max(travels[k].range, 1e-9) for k in self._order])
        lower[0], scale[0] = target.closed, target.range
        self._lower, self._per_range = lower, 1.0 / scale
        self._sign = float(np.sign(target.range))
        self._step = settings.time.control_step
        self._count = len(travels)

    def fraction(self, reading: ObjectState) -> Any:
        """Share of the way that is open: a float for one environment, else shape (n,)."""
        return (_component(reading.values, self.target.leader) - self.target.closed) / self.target.range

    def speed(self, reading: ObjectState) -> Any:
        """[ways/s], positive opens: a float for one environment, else shape (n,)."""
        return _component(reading.speeds, self.target.leader) / self.target.range

    def direction(self, reading: ObjectState) -> FloatArray:
        """Unit direction in which the hold moves when the part opens, zero where it does not, shape (..., 3)."""
        if not self.target.turns:
            return np.asarray(self._sign * reading.axis)
        arm = reading.hold - reading.anchor
        one = arm.ndim == 1
        (ax, ay, az), (bx, by, bz) = (item.tolist() if one else item.T for item in (reading.axis, arm))
        x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        length = (x * x + y * y + z * z) ** 0.5
        scale = self._sign / (max(length, _SHORT) if one else np.maximum(length, _SHORT))
        return np.array([x * scale, y * scale, z * scale]).T

    def fill_joints(self, reading: ObjectState, out: FloatArray) -> None:
        """Write the share, speed and mask of every joint, the opened one first, to (..., 3 * slots); not clipped."""
        slots, count = self.slots, self._count
        out[..., :count] = (reading.values[..., self._order] - self._lower) * self._per_range
        out[..., slots : slots + count] = reading.speeds[..., self._order] * self._per_range
        out[..., 2 * slots : 2 * slots + count] = 1.0

    def begin(self, reading: ObjectState) -> Progress:
        """Start of an episode."""
        fraction, speed = self.fraction(reading), self.speed(reading)
        thrown = np.zeros(np.shape(fraction), dtype=bool) if np.ndim(fraction) else False
        return Progress(fraction=fraction, speed=speed, thrown=thrown)

    def judge(self, reading: ObjectState, progress: Progress) -> tuple[Any, Any, Any]:
        """Update `progress`.

        Returns:
            Success; how well the part stands open, in [0, 1]; how fast it was at most since last time [ways/s].
        """
        task = self.task
        fraction, speed = self.fraction(reading), self.speed(reading)
        least, most = (min, max) if isinstance(fraction, float) else (np.minimum, np.maximum)
        between = abs(fraction - progress.fraction) / self._step
        fastest = most(most(abs(speed), abs(progress.speed)), between)
        opened = fraction >= self.open_fraction
        kept = progress.thrown & (fraction >= self.open_fraction - task.forget)
        progress.thrown = kept | (opened & (fastest > task.fast))
        fair = progress.thrown ^ True
        success = opened & (fastest <= task.calm) & fair
        progress.fraction, progress.speed = fraction, speed
        open_share = least(most(fraction / self.open_fraction, 0.0), 1.0)
        slow = least(most(2.0 - fastest / task.fast, 0.0), 1.0)
        return success, open_share * slow * fair, fastest


def _component(values: FloatArray, index: int) -> Any:
    """Values of one joint: NumPy needs a microsecond for what Python does with a float in a tenth of one."""
    return values.item(index) if values.ndim == 1 else values[:, index]
