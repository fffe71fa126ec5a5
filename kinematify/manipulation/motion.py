"""A planned motion and its timing: what the engines are told to track."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kinematify.config.task import ExecutionSettings
    from kinematify.manipulation.grasp import Grasp
    from kinematify.manipulation.robot import TaskRobot
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """Reach, grasp and pull, as planned; world z is up and the floor is at z = 0."""

    robot: TaskRobot
    object_urdf: Path
    """At its real size."""
    T_world_base: FloatArray
    """Root link of the robot, shape (4, 4)."""
    T_world_object: FloatArray
    """Root link of the object, shape (4, 4)."""
    joint: str
    """Joint of the object that is opened."""
    start: Mapping[str, float]
    """Values of the object's leading joints before the pull [rad or m]."""
    grasp: Grasp
    reach: FloatArray
    """Arm joints on the way to the grasp [rad or m], shape (n, dof), n >= 1."""
    pull: FloatArray
    """Arm joints during the pull, the first row is the last of `reach`, shape (m, dof), m >= 2."""
    opened: FloatArray
    """Value of the object's joint in each row of `pull` [rad or m], shape (m,)."""
    freed: tuple[str, ...] = ()
    """Other joints of the object that the hand moves too; all that are not named stay where they are."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Reference:
    """Commands of the arm per time step, in three phases: reach, close the fingers, pull; the end is held."""

    arm: FloatArray
    """[rad or m], shape (steps, dof)."""
    speed: FloatArray
    """Its derivative, shape (steps, dof)."""
    grasped: int
    """Step at which the arm has arrived at the grasp and the fingers close."""
    pulls: int
    """Step at which the pull begins."""
    arrives: int
    """Step at which the pull has arrived."""

    @property
    def steps(self) -> int:
        """Number of time steps."""
        return len(self.arm)


def timed(motion: Motion, fastest: FloatArray, settings: ExecutionSettings, step: float) -> Reference:
    """Give a motion its timing: no joint exceeds its share of the speed limit, and both ends are smooth.

    Args:
        motion: The paths.
        fastest: Speed limits of the arm joints [rad/s or m/s], shape (dof,).
        settings: Shares and pauses.
        step: Time step [s].
    """
    allowed = settings.speed_share * fastest
    reach = _along(motion.reach, allowed, 0.0, step)
    pull = _along(motion.pull, allowed, settings.pull_seconds, step)
    closing = round(settings.grip_seconds / step)
    settling = round(settings.settle_seconds / step)
    arm = np.concatenate([reach, np.tile(reach[-1], (closing, 1)), pull, np.tile(pull[-1], (settling, 1))])
    speed = np.gradient(arm, step, axis=0) if len(arm) > 1 else np.zeros_like(arm)
    grasped, pulls = len(reach), len(reach) + closing
    return Reference(arm=arm, speed=speed, grasped=grasped, pulls=pulls, arrives=pulls + len(pull))


def _along(path: FloatArray, allowed: FloatArray, least: float, step: float) -> FloatArray:
    """Move along a path with a smooth start and end in at least `least` seconds, shape (steps, dof)."""
    if len(path) < 2:
        return path
    times = np.concatenate([[0.0], np.cumsum(np.max(np.abs(np.diff(path, axis=0)) / allowed, axis=1))])
    times += 1e-9 * np.arange(len(times))  # rows that are the same still follow one another
    # The derivative of the smooth step is at most 1.5 times that of the straight one.
    seconds = max(1.5 * float(times[-1]), least, step)
    phase = np.linspace(0.0, 1.0, max(2, round(seconds / step) + 1))
    at = times[-1] * phase**2 * (3.0 - 2.0 * phase)
    return np.stack([np.interp(at, times, column) for column in path.T], axis=1)
