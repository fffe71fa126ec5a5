"""Interface of a physics engine.

An engine loads the prepared copy of a model (`Engine.load`), looks at configurations of it (`EngineModel`), and runs it
in time (`Simulation`). It also loads a file as users do (`Engine.load_raw`, see `raw_model`). An engine that only
computes, as Pinocchio does, sees no contacts and never runs. All numbers of a prepared model are in the order of the
document: links as in `LeaderMechanism.links`, joints as in `LeaderMechanism.joints`.

A new engine is one file ``NAME_engine.py`` with the class ``NameEngine``, and its entry in `engines`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.contacts import Contacts, Touching
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.raw_model import RawEngineModel
    from kinematify.simulation.servos import Drive, Servos
    from kinematify.simulation.world import EngineWorld, WorldSpec

FINER = 4
"""Small steps per step of `Simulation.release` with `fine`."""
SLOW_SECONDS = 0.1
"""Time over which the speed at the end of a drop is measured."""


class Refused(Exception):
    """The engine does not load the file; the text is its own message."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadedJoint:
    """A joint as an engine has it."""

    turns: bool
    lower: float
    """[rad or m]; -inf if unlimited."""
    upper: float
    """[rad or m]; +inf if unlimited."""
    axis: FloatArray | None = None
    """In the joint's frame, shape (3,); None: the engine does not keep it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadedRobot:
    """Model that an engine made of `prepared.urdf`."""

    joints: Mapping[str, LoadedJoint]
    """Joints that move, keyed by name."""
    masses: Mapping[str, float]
    """[kg], keyed by link; links that the engine merged into others are missing."""
    total_mass: float
    """[kg]."""
    balanced: bool = False
    """True if the engine refused an inertia tensor, and all such were replaced by balanced ones."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Measured:
    """Measurements of a table of configurations, one entry per row."""

    T_world_link: FloatArray
    """The root's frame is the world, shape (n, L, 4, 4); NaN for links that the engine lost."""
    contacts: Contacts
    """Of links that move against each other."""
    gravity: FloatArray
    """Torques and forces that hold the model still [N m or N], shape (n, J)."""
    inertia: FloatArray
    """Mass matrix of the first row, shape (J, J)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeRun:
    """A run in which nothing is driven."""

    q: FloatArray
    """Values of the leaders after every step that was sound [rad or m], shape (steps, leaders)."""
    energy: FloatArray
    """Potential and kinetic [J] at some or all of them, shape (looks, 2)."""
    fastest: float
    """Largest speed of a link [m/s]."""
    warnings: tuple[str, ...]
    """Why the engine gave up; empty if it went on to the end."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DriveRun:
    """A run in which one joint is driven and the others are held."""

    q: FloatArray
    """Values of all joints after every step [rad or m], shape (steps, J); fewer steps than commanded: no use."""
    force: FloatArray
    """Of the servo that drives [N m or N], shape (steps,)."""
    pressed: frozenset[tuple[int, int]]
    """Pairs of bodies that press against each other when the joint has arrived, as far as the engine tells."""
    fastest: float
    """Largest speed of a link [m/s]."""
    warnings: tuple[str, ...]
    """Why the engine gave up; empty if it went on to the end."""


@dataclass(frozen=True, kw_only=True)
class Dropped:
    """The end of a drop on a floor."""

    depth: float
    """Of the lowest point below the floor [m], negative above."""
    speed: float
    """Of the fastest link [m/s]."""
    warnings: tuple[str, ...]
    """Why the engine gave up; empty if it went on to the end."""


class Engine(Protocol):
    """An engine in this process."""

    def __init__(self, settings: EngineSettings, log: Path) -> None:
        """Open it.

        Args:
            settings: Time step, servos and how long it runs.
            log: File that this process prints into, where an engine speaks by printing.
        """

    @staticmethod
    def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> RawEngineModel:
        """Load a file untouched, with the engine's defaults; what runs gives a `RunningFile`.

        Args:
            urdf: The file.
            root: Name of its first link.
            package_dirs: Where packages lie, for engines that look for them.

        Raises:
            Unloadable: The engine does not open it.
        """

    def load(self, prepared: Prepared, mechanism: LeaderMechanism) -> EngineModel:
        """Load a prepared file, its root fixed at the world's origin, gravity along -z.

        Args:
            prepared: The file and its record.
            mechanism: Its tree.

        Raises:
            Refused: The engine cannot.
        """

    def messages(self) -> list[str]:
        """Return what the engine itself has said so far, each message once."""


class WorldEngine(Engine, Protocol):
    """An engine in which environments and planned motions run."""

    @staticmethod
    def open_world(spec: WorldSpec) -> EngineWorld:
        """Build a world that runs.

        Raises:
            Refused: The engine cannot load a model.
        """


class EngineModel(Protocol):
    """A loaded model in which everything collides; it is set to configurations and never runs."""

    @property
    def loaded(self) -> LoadedRobot:
        """Return what became of joints and masses."""

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""

    @property
    def size(self) -> float:
        """Of the model [m]."""

    def poses(self, values: FloatArray) -> FloatArray:
        """Return T_world_link in every row of values of all joints (n, J), shape (n, L, 4, 4); NaN for lost links."""


class PhysicsModel(EngineModel, Protocol):
    """A model in an engine that sees contacts and runs."""

    def measure(self, values: FloatArray) -> Measured:
        """Set the model to every row of values of all joints [rad or m], shape (n, J), and look."""

    @property
    def resistance(self) -> FloatArray:
        """Damping and friction of all joints, shape (2, J)."""

    @property
    def ignored_pairs(self) -> frozenset[tuple[int, int]]:
        """Pairs of links that touch at rest and do not act on each other in runs, smaller index first.

        Not empty only where the engine knows no depth that a pair may have.
        """

    def contacts(self, values: FloatArray) -> Contacts:
        """Contacts in every row of values of all joints, shape (n, J), as runs lead to them."""

    def simulation(self, sweep: Touching, seen: Measured, servos: Servos) -> Simulation:
        """Return what runs with servos.

        Args:
            sweep: Contacts along `LeaderMechanism.sweep`: what a pair has at rest it may have in runs.
            seen: What was measured there.
            servos: One per leader.
        """


class Simulation(Protocol):
    """A model with a position servo on each joint that leads. Every run begins at rest."""

    @property
    def step(self) -> float:
        """Time step [s]."""

    @property
    def batch(self) -> int:
        """Drives that are best run at a time."""

    def hold(self, efforts: FloatArray, seconds: float) -> FreeRun:
        """Hold the model by servos no stronger than `efforts` [N m or N], shape (leaders,)."""

    def release(self, seconds: float, *, fine: bool = False) -> FreeRun:
        """Make the model go, without servos, damping and friction.

        Args:
            seconds: How long.
            fine: With `FINER` steps per step; `FreeRun.q` has the values at the same times nevertheless.
        """

    def drive(self, drives: Sequence[Drive]) -> list[DriveRun]:
        """Drive a joint to an end, the others held, for each of `drives`; its servo is no stronger than it must be."""

    def drop(self) -> Dropped:
        """Make the model fall on a floor from `EngineSettings.drop`, its joints held."""
