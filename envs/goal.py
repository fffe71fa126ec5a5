"""Observation, success and reward: one set of formulas for one environment and for many.

All arrays may have leading axes of environments.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.world import ObjectState


STEP = 0.002  # where the servos of `validate` and grips by friction are stable
"""Of the engine [s]."""
SUBSTEPS = 25  # 20 actions a second, as in most benchmarks of manipulation
"""Steps of the engine per action."""
CONTROL_STEP = SUBSTEPS * STEP
"""Time between actions [s]."""
SLOTS = 16  # furniture has up to 12
"""Joints in an observation; models with more get the next multiple."""
FAST = 1.5  # a person pulls with 0.7, what is thrown or let slam has 2 and more
"""Faster is thrown [ways/s]."""
CALM = 0.1  # hardly seen to move
"""Slower is at rest [ways/s]."""
FORGET = 0.1  # what was slammed must come back by this share of the way before it counts again
"""Share of the way by which a thrown part must come back."""

OPEN_BOUND, SPEED_BOUND, PLACE_BOUND = 2.0, 20.0, 10.0
"""Ends of observed shares [1], speeds [1/s] and places [m]; what goes beyond is clipped."""

_SHORT = 1e-9  # a hold that is nearer to an axis moves nowhere [m]


class Goal:
    """The joint that is opened, as the share of a way."""

    def __init__(self, articulated_object: ArticulatedObject, target: Target, open_fraction: float) -> None:
        """Keep what the formulas need.

        Args:
            articulated_object: The object.
            target: Its joint.
            open_fraction: Share of the way that counts as open.
        """
        self.target, self.open_fraction = target, open_fraction
        travels = articulated_object.travels
        self.slots = SLOTS * -(-len(travels) // SLOTS)
        self._order = np.array([target.leader, *(k for k in range(len(travels)) if k != target.leader)], dtype=np.int64)
        lower = np.array([travels[k].lower for k in self._order])
        scale = np.array([max(travels[k].range, 1e-9) for k in self._order])
        lower[0], scale[0] = target.closed, target.range
        self._lower, self._per_range = lower, 1.0 / scale
        self._sign = float(np.sign(target.range))
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

    def begin(self, reading: ObjectState) -> dict[str, Any]:
        """Return what is remembered from step to step, at the start of an episode.

        Returns:
            ``fraction``, the share of the way that is open; ``speed`` [ways/s]; and ``thrown``: the part went fast
            where it counts as open, and has not come back since. Each is a number for one environment, else has shape
            (n,).
        """
        fraction = self.fraction(reading)
        thrown = np.zeros(np.shape(fraction), dtype=bool) if np.ndim(fraction) else False
        return {"fraction": fraction, "speed": self.speed(reading), "thrown": thrown}

    def judge(self, reading: ObjectState, progress: dict[str, Any]) -> tuple[Any, Any]:
        """Update `progress`.

        Returns:
            Success; how well the part stands open, in [0, 1].
        """
        fraction, speed = self.fraction(reading), self.speed(reading)
        least, most = (min, max) if isinstance(fraction, float) else (np.minimum, np.maximum)
        between = abs(fraction - progress["fraction"]) / CONTROL_STEP
        fastest = most(most(abs(speed), abs(progress["speed"])), between)
        opened = fraction >= self.open_fraction
        kept = progress["thrown"] & (fraction >= self.open_fraction - FORGET)
        thrown = kept | (opened & (fastest > FAST))
        fair = thrown ^ True
        success = opened & (fastest <= CALM) & fair
        progress.update(fraction=fraction, speed=speed, thrown=thrown)
        open_share = least(most(fraction / self.open_fraction, 0.0), 1.0)
        slow = least(most(2.0 - fastest / FAST, 0.0), 1.0)
        return success, open_share * slow * fair


def _component(values: FloatArray, index: int) -> Any:
    """Values of one joint: NumPy needs a microsecond for what Python does with a float in a tenth of one."""
    return values.item(index) if values.ndim == 1 else values[:, index]
