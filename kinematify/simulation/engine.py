"""The methods of an engine: one class each, which opens a file as its users do, or a world of an object and a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.simulation.world import ObjectState, PullingHand, Variation

_FLOATS = "it gives links other joints than hinges and slides"


class Unloadable(Exception):
    """An engine does not open a file, or does not build a world; the message is the engine's."""

    def __init__(self, message: str = _FLOATS, reproduction: str = "") -> None:
        """Keep the message and plain code of the engine that shows it.

        Args:
            message: Of the engine; none: it opens the file and lets a link float, which no hand can push to an end.
            reproduction: Plain code of the engine.
        """
        super().__init__(" ".join(message.split())[:400].rstrip("."))
        self.floats, self.reproduction = message == _FLOATS, reproduction


class Engine(Protocol):
    """A model in an engine, made from `OpenedFile` or `WorldSpec`: a file is a world of one model with nothing else.

    An engine has the methods that its `EngineEntry` names, see the table in docs/write_checks.md. Arrays are in the
    order of `joints`: of a file that of the engine, of a world that of `LeaderMechanism.joints`.
    """

    title: ClassVar[str]
    """As it is written in messages."""
    code: ClassVar[Mapping[str, str]]
    """Plain code of the engine, which repeats what was found: templates by `joints` (prints each one with its limits),
    `overlap` (how deep two links are in each other), `rest` (the least and largest value of a joint), `push` (how far a
    joint gets), `push_alone` (without contacts), `release` (by how much the energy grows)."""
    keyed: ClassVar[bool]
    """True if the code knows joints by their numbers, not by their place in a list."""
    look_steps: ClassVar[int]
    """Steps between two looks at the energy."""
    facts: dict[str, object]
    """What the code says of the file, by the names in the templates: its `path`, and more."""
    joint_code: Mapping[str, int]
    """Numbers that joints have in the code."""
    link_code: Mapping[str, object]
    """What links are in the code."""
    root: str
    """First link of the object."""
    joints: Sequence[str]
    """Joints of the object that move."""
    limits: Mapping[str, tuple[float, float]]
    """Lower and upper limit of each joint as the engine has read them [rad or m], infinite where there are none."""
    links: Sequence[str]
    """Names of links, to which the pairs of `contacts` point; those of a robot begin with `ROBOT`."""
    time_step: float
    """Of the engine [s]."""

    def place(
        self,
        values: FloatArray,
        robot: FloatArray | None = None,
        *,
        speeds: FloatArray | None = None,
        contacts: bool = True,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """Set everything and start a run.

        Args:
            values: Of all joints [rad or m].
            robot: Values of the joints with servos, which then hold them.
            speeds: Of all joints [rad/s or m/s]; None: all stand still.
            contacts: Links collide with each other.
            gravity: It acts.
            released: Indices of joints without motors, where an engine gives joints some; None: motors as loaded.
        """

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Set values and speeds of all joints in the course of a run."""

    def step(self, count: int = 1) -> None:
        """Simulate so many steps."""

    def state(self, *, robot: bool = False) -> tuple[FloatArray, FloatArray]:
        """Return values and speeds of all joints of the object, or of the robot, shape (joints,) each."""

    def link_poses(self) -> dict[str, FloatArray]:
        """Return the poses in the world of the links that the engine keeps apart, shape (4, 4) each."""

    def contacts(self) -> tuple[IntArray, FloatArray]:
        """Return two of `links` and their depth [m] for every contact, shapes (n, 2) and (n,)."""

    def warnings(self) -> dict[str, int]:
        """Return the engine's warnings since `place`, with their counts."""

    def stable(self) -> bool:
        """Return True if all numbers are finite."""

    def energy(self) -> tuple[float, float]:
        """Return potential and kinetic energy of a file [J]."""

    def inertias(self, values: FloatArray) -> FloatArray:
        """Return what a force at each joint moves in a step of a push [kg or kg m^2], shape (joints,)."""

    def max_safe_force(self, values: FloatArray) -> FloatArray:
        """Return the largest force at each joint that the engine answers rightly [N or N m], shape (joints,)."""

    def apply(self, joint: int, force: float) -> None:
        """Apply a force to a joint in the next step [N or N m]."""

    def command(self, values: FloatArray, speeds: FloatArray | None = None) -> None:
        """Command the robot's servos, the hand where there is no robot, or the motors of a file.

        With a speed servos run ahead of the lag by damping over stiffness.
        """

    def weld(self) -> None:
        """Fix the tool to the part where it now is."""

    def unlock(self, joints: Iterable[str]) -> None:
        """Make locked joints of the object go."""

    def observe(self) -> ObjectState:
        """Return the state of the held point after the last step."""

    def touch(self) -> FloatArray:
        """Return the force of each finger on the held body [N], shape (fingers,)."""

    def resist(self, damping: FloatArray, friction: FloatArray, hand: PullingHand | None = None) -> None:
        """Give the object's joints damping and friction, and the held point a hand, before `vary`."""

    def vary(self, drawn: Variation) -> None:
        """Change the object."""

    def close(self) -> None:
        """Free what Python does not."""


def depth_of(world: Engine) -> float:
    """Return how much deeper than allowed two shapes are in each other at most [m]."""
    return max(0.0, float(world.contacts()[1].max(initial=0.0)))
