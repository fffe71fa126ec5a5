"""What an environment asks of an engine."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from kinematify.envs.articulated_object import find_target, load_articulated_object
from kinematify.envs.settings import load_settings

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.dynamics import Draw
    from kinematify.envs.mujoco_hand import HandFacts
    from kinematify.envs.reading import Reading
    from kinematify.robot.arrays import FloatArray

ENGINES = ("mujoco", "pybullet")


class World(Protocol):
    """One object in one engine, driven by a hand or a robot."""

    def draw(self, drawn: Draw) -> None:
        """Redraw the object."""

    def reading(self) -> Reading:
        """Return the state of the object."""

    def depth(self) -> float:
        """How much deeper than allowed two shapes are in each other at most [m]."""

    def stable(self) -> bool:
        """True if all numbers are finite and the solver has not failed."""

    def warnings(self) -> dict[str, int]:
        """What the engine has warned of since `place`, with counts."""

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the object's links by name, of a robot's under ``robot `` and theirs, shape (4, 4) each."""

    def close(self) -> None:
        """Free what the engine holds."""


class HandWorld(World, Protocol):
    """An object and a hand without a robot."""

    facts: HandFacts

    def place(self, leaders: FloatArray) -> float:
        """Set the object's joints that lead, shape (J,) [rad or m], and stop all.

        Returns:
            How much deeper than allowed two shapes are in each other at most [m].
        """

    def act(self, action: FloatArray) -> None:
        """Simulate until the next action; `action` is within -1 and 1, shape (3,)."""

    def command(self) -> FloatArray:
        """From the hold to where the hand wants it [m], zero in force control, shape (3,)."""


class ArmWorld(World, Protocol):
    """An object and a robot."""

    def place(self, leaders: FloatArray, arm: FloatArray) -> float:
        """Set the object's joints that lead, shape (J,), and those of the arm (dof,), fingers apart, and stop all.

        Returns:
            How much deeper than allowed two shapes are in each other at most [m].
        """

    def act(self, arm: FloatArray, fingers: FloatArray) -> None:
        """Simulate until the next action, servos told to go to these values, shapes (dof,) and (fingers,)."""

    def joints(self) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of the arm's joints and then of the fingers', shape (dof + fingers,) each."""

    def tool(self) -> FloatArray:
        """World pose of the tool, shape (4, 4)."""

    def touch(self) -> FloatArray:
        """Force of each finger on the part [N], shape (fingers,)."""


def shared_articulated_object(model: str | Path | None) -> ArticulatedObject:
    """Return the object of a `model` keyword, read once per process as long as its file stays the same."""
    path = Path(model) if isinstance(model, Path) or (isinstance(model, str) and Path(model).exists()) else None
    file = path / "model.urdf" if path is not None and path.is_dir() else path
    stamp = (file.stat().st_mtime_ns, file.stat().st_size) if file is not None and file.is_file() else None
    return _loaded(None if model is None else str(model), stamp)


@lru_cache(maxsize=8)
def _loaded(model: str | None, stamp: tuple[int, int] | None) -> ArticulatedObject:
    del stamp
    return load_articulated_object(model)


@lru_cache(maxsize=32)
def shared_target(articulated_object: ArticulatedObject, joint: str) -> Target:
    """Return the joint of a `joint` keyword, its hold searched once per process."""
    return find_target(articulated_object, joint, load_settings().hand)
