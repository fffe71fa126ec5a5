"""What a user asks of a robot; it crosses a process border, so it holds plain data only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.validation.task.robot import builtin_robot, user_robot

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.validation.task.robot import TaskRobot

PULL, POUR = "pull", "pour"
TASKS = (PULL, POUR)


@dataclass(frozen=True, kw_only=True)
class Suspicion:
    """What the geometry has against a joint."""

    check: str
    """Id of the check that says so."""
    message: str
    error: bool
    """It is an error there, not only a warning."""


@dataclass(frozen=True, kw_only=True)
class TaskRequest:
    """A task with its robot."""

    kind: str
    """One of `TASKS`."""
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
    scale: float | None = None
    """Metres per unit of the object; from the table of sizes if None."""
    into: Path | None = None
    """URDF of the container that is poured into, absolute."""
    films: Path | None = None
    """Existing folder for films and stills; none are made if None."""
    stem: str = PULL
    """Beginning of their names."""

    def write_robot(self, folder: Path) -> TaskRobot:
        """Write the robot into an existing folder and describe it.

        Raises:
            InputError: There is no such robot, tool or gripper.
            OSError: The folder cannot be written.
        """
        if self.robot is None:
            return builtin_robot(folder)
        if self.tool is None:
            raise InputError(
                f"--robot {self.robot} needs --tool with the link that carries the fingers, e.g. --tool gripper_link."
            )
        return user_robot(self.robot, self.tool, self.gripper, folder=folder, package_dirs=self.package_dirs)
