"""Request of a robot task: the plan, its results, and what holds the part when it is executed.

A request crosses a process border, so it holds plain data only.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True, kw_only=True)
class PriorFinding:
    """Finding of the geometry against a joint."""

    check: str
    """Id of the check that says so."""
    message: str
    error: bool
    """It is an error there, not only a warning."""


@dataclass(frozen=True, kw_only=True)
class TaskRequest:
    """Opening every joint of an object, and the robot that does it."""

    robot: Path | None = None
    """URDF of the user's robot, absolute; the built-in arm if None."""
    tool: str | None = None
    """Link of the robot's gripper."""
    gripper: tuple[str, ...] = ()
    """Joints of its fingers; found on the tool if there are none."""
    package_dirs: tuple[Path, ...] = ()
    """Where the robot's packages lie."""
    grasp: tuple[float, float, float] | None = None
    """Hold the part there, frame of the object's root link [units of the file]; found if None."""
    base: tuple[float, float, float, float] | None = None
    """The robot's root link stands there: x, y, z [m] at the object's real size and yaw [deg], frame of the object's
    root link; searched if None."""
    scale: float | None = None
    """Metres per unit of the object; from the table of sizes if None."""
    films: Path | None = None
    """Existing folder for films and stills; none are made if None."""
    stem: str = "pull"
    """Beginning of their names."""


class Failure(StrEnum):
    """At which step a plan ended; nothing failed where it is None."""

    NO_WAY = "no way"
    """The joint moves nothing, or hardly at all."""
    NO_GRASP = "no grasp"
    NO_REACH = "no reach"
    """No place from which the arm's kinematics reach the grasp."""
    NO_PATH = "no path"
    """The grasp is reached, but no way free of collisions leads there."""
    STOPS = "stops"
    """The arm does not get far enough."""
    COVERED = "covered"
    """Another part of the object is in the way, and opening that one first does not help or fails."""
    JAMS = "jams"
    """The part runs into what no other joint can move away."""


class Hold(StrEnum):
    """Connection of the hand with the part."""

    WELD = "weld"
    """They are fixed to each other once the fingers have arrived."""
    CONTACT = "contact"
    """Fingers that close, and friction."""
