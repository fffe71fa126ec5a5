"""Mesh files as the checks see them: each file opened once, its surface measured when first asked for."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.read import parse_robot
from kinematify.robot.urdf_geometry import geometry_source
from kinematify.robot.urdf_text import parse_description
from kinematify.validation.asset.extents import extents_of, gaps_between
from kinematify.validation.asset.mesh_files import open_mesh_files
from kinematify.validation.asset.mesh_quality import surface_quality

if TYPE_CHECKING:
    from kinematify.config.validation import FileSettings
    from kinematify.robot.robot import Robot
    from kinematify.validation.asset.extents import Extent
    from kinematify.validation.asset.mesh_files import MeshFile
    from kinematify.validation.asset.mesh_quality import SurfaceQuality
    from kinematify.validation.stage import StageRequest


class MeshContext:
    """The mesh files of a document that has passed the pre-check, and the model that they make."""

    def __init__(self, request: StageRequest) -> None:
        """Keep which document it is."""
        self._request = request
        self._robot = parse_description(request.urdf)
        self._source = geometry_source(request.urdf, request.package_dirs)

    @property
    def settings(self) -> FileSettings:
        """Thresholds."""
        return self._request.settings.file

    @cached_property
    def files(self) -> tuple[MeshFile, ...]:
        """Every mesh file, opened."""
        return open_mesh_files(self._robot, self._source, self.settings)

    @cached_property
    def _read(self) -> Robot | str:
        try:
            with np.errstate(all="ignore"):  # what is not finite is reported by a check
                return parse_robot(self._robot, self._request.urdf, self._source)
        except DescriptionError as error:
            return str(error)

    @property
    def fault(self) -> str | None:
        """Why the model cannot be read, whatever its mesh files are."""
        return self._read if isinstance(self._read, str) else None

    @property
    def model(self) -> Robot:
        """The model; only to be asked for where nothing was found against its meshes."""
        assert not isinstance(self._read, str)
        return self._read

    @cached_property
    def measured(self) -> list[tuple[MeshFile, SurfaceQuality]]:
        """Every mesh file with the quality of its surface."""
        return [(file, surface_quality(file.mesh)) for file in self.files if file.mesh is not None]

    @cached_property
    def extents(self) -> dict[str, Extent]:
        """The room that each link takes, keyed by link; links without geometry are omitted."""
        return extents_of(self.model)

    @cached_property
    def gaps(self) -> list[tuple[str, float, float]]:
        """Implement `gaps_between`."""
        return list(gaps_between(self.model, self.extents))
