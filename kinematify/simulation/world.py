"""Contents of an engine: a file, an object that is pulled at a point of a part, or one beside a robot with servos.

Validation opens a file as its users do (`OpenedFile`); environments and executions of plans describe a world
(`WorldSpec`), which every engine with `EngineEntry.holds` builds. Joints and links of a world are in the order of the
document.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism

ROBOT = "robot "
"""Before the names of the robot's links where those of both models are keys."""
FLOOR = "the floor"


class ServoSettings(Protocol):
    """Settings of the motion of a robot."""

    servo_frequency: float
    """Of the arm's servos [Hz]; they are critically damped."""
    armature: float
    """Rotor inertia, fraction of the inertia that a joint moves."""
    finger_inertia: float
    """Of each finger with its drive [kg or kg m^2]."""
    grip_force: float
    """Of each finger [N]."""
    friction: float
    """Of the robot's surfaces."""


@dataclass(frozen=True, kw_only=True)
class OpenedFile:
    """A file alone as its users load it: untouched, its base fixed, with the engine's own defaults."""

    urdf: Path
    root: str
    """Name of its first link."""
    on_floor: bool = False
    """Its base is free, and `place` sets it on a floor with its lowest point (`EngineEntry.floor`)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PlacedModel:
    """A model whose root is fixed in the world."""

    urdf: Path
    """What engines load; its meshes are convex."""
    mechanism: LeaderMechanism
    T_world_root: FloatArray
    """Shape (4, 4)."""
    apart: tuple[tuple[str, str], ...] = ()
    """Pairs of links that do not act on each other."""
    locked: Mapping[str, float] = field(default_factory=dict)
    """Leaders that are held at a value [rad or m] until `Engine.unlock`."""
    damping: Mapping[str, float] = field(default_factory=dict)
    """Least damping of joints, over the inertia that they move [1/s]; PyBullet's solver damps by itself."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PlacedRobot(PlacedModel):
    """A robot; what is neither of its arm nor a finger is held at rest."""

    arm: tuple[str, ...]
    """Joints with servos."""
    fingers: tuple[str, ...]
    """Further ones."""
    strongest: FloatArray
    """Effort limits of the arm [N m or N], shape (arm,)."""
    postures: tuple[FloatArray, ...]
    """Of the arm, at which its servos are scaled [rad or m], shape (arm,) each."""
    tool: str
    settings: ServoSettings
    smoothing: float | None = None
    """Time constant with which MuJoCo's servos are led to a new target [s]; None: they are not."""

    @property
    def driven(self) -> tuple[str, ...]:
        """Arm, then fingers."""
        return (*self.arm, *self.fingers)

    @property
    def finger_links(self) -> tuple[str, ...]:
        """Links of the fingers."""
        return tuple(self.mechanism.robot.joint_by_name[name].child for name in self.fingers)


@dataclass(frozen=True, kw_only=True, eq=False)
class HeldPoint:
    """The point of the object that is observed, and pulled where there is no robot."""

    link: str
    point: FloatArray
    """Frame of the link [m], shape (3,)."""
    axis: FloatArray
    """Of the joint that moves the link, frame of the link, shape (3,)."""
    body: tuple[str, ...] = ()
    """Links of the same rigid body, on which the touch of fingers is measured."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Grip:
    """Grip of a planned motion on a part. Neither model meets itself then; the planner has checked that."""

    hand: frozenset[str]
    """Links that pass through `part`."""
    part: frozenset[str]
    link: str
    """Of the part, to which the tool is welded."""
    piece: tuple[FloatArray, IntArray] | None
    """What the hand holds by friction in place of the part: vertices in the frame of `link` [m], and faces; None: it is
    welded."""
    weld_force: float
    """That a weld of PyBullet may exert [N]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class WorldSpec:
    """Content of a world; it is compiled once for a process where an engine compiles, so keep it."""

    step: float
    """[s]."""
    object: PlacedModel
    robot: PlacedRobot | None = None
    point: HeldPoint | None = None
    grip: Grip | None = None
    iterations: int = 80
    """Of PyBullet's solver, per step."""


@dataclass(frozen=True, kw_only=True)
class PullingHand:
    """A hand without a robot: forces along the world's axes, or a spring between a place and the held point."""

    spring: bool
    force: float
    """Of a full command, or of the spring at most [N]."""
    stiffness: float
    """Of the spring [N/m]."""
    damping: float
    """[N s/m]."""


@dataclass(slots=True, eq=False)
class ObjectState:
    """State of the object, world frame; all arrays may have leading axes of many worlds."""

    values: FloatArray
    """Joints that lead [rad or m], shape (..., J)."""
    speeds: FloatArray
    """Their speeds [rad/s or m/s], shape (..., J)."""
    hold: FloatArray
    """Point at which the part is held [m], shape (..., 3)."""
    anchor: FloatArray
    """Origin of the joint that is opened [m], shape (..., 3)."""
    axis: FloatArray
    """Its axis, unit, shape (..., 3)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Variation:
    """One object of many: factors are 1 and the motion is none where nothing is varied."""

    damping: FloatArray
    """Factor of each joint, shape (J,)."""
    friction: FloatArray
    """Factor of each joint, shape (J,)."""
    surface: float
    """Factor of the friction of all surfaces."""
    mass: FloatArray
    """Factor of each link, shape (L,)."""
    T_root: FloatArray
    """World motion of the object from its usual place, shape (4, 4)."""
