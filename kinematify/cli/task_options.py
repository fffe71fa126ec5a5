"""Options of `kinematify validate` that ask for a task of a robot."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kinematify.cli.options import listed
from kinematify.errors import InputError, OutputError

if TYPE_CHECKING:
    from kinematify.cli.report_files import ReportFiles
    from kinematify.manipulation.plan_request import TaskRequest


@dataclass(frozen=True, kw_only=True)
class TaskOptions:
    """As they were given; None where one was not."""

    task: str | None
    robot: Path | None
    tool: str | None
    gripper: str | None
    grasp: tuple[float, float, float] | None
    base: tuple[float, float, float, float] | None
    scale: float | None
    films: Path | None
    into: Path | None = None

    def request(self, files: ReportFiles, package_dirs: tuple[Path, ...]) -> TaskRequest | None:
        """Return what the options ask for; the robot is read once, so that what is wrong with it is said at once.

        Raises:
            InputError: There is no such robot, tool or gripper.
            OutputError: Films cannot be written where they should go.
        """
        if self.task is None:
            self._refuse_without_task()
            return None
        if self.task == "pour" and (self.grasp or self.base):
            raise click.UsageError("--grasp and --base belong to --task pull. Leave them out.")
        from kinematify.manipulation.manipulator import robot_of
        from kinematify.manipulation.plan_request import TaskRequest

        request = TaskRequest(
            kind=self.task,
            robot=None if self.robot is None else self.robot.absolute(),
            tool=self.tool,
            gripper=listed(self.gripper),
            package_dirs=package_dirs,
            grasp=self.grasp or None,
            base=self.base or None,
            scale=self.scale,
            into=self._container(),
            films=self._films(files),
        )
        with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
            robot_of(request, Path(folder))
        return request

    def _refuse_without_task(self) -> None:
        for name in ("robot", "tool", "gripper", "grasp", "base", "scale", "films", "into"):
            if getattr(self, name):
                raise click.UsageError(f"--{name} belongs to a task. Give --task pull with it.")

    def _container(self) -> Path | None:
        if (self.into is None) == (self.task == "pour"):
            raise click.UsageError("--task pour and --into, which names the container, belong together.")
        if self.into is not None and not self.into.is_file():
            raise InputError(f"--into {self.into} is no file. Give the URDF of the container that is poured into.")
        return None if self.into is None else self.into.absolute()

    def _films(self, files: ReportFiles) -> Path | None:
        beside = next((path.absolute().parent for path in files.paths.values()), None)
        folder = beside if self.films is None else self.films.absolute()
        if folder is not None and not folder.is_dir():
            raise OutputError(f"--films {folder} is no folder. Give a folder that exists.")
        return folder
