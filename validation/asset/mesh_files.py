"""Opening every mesh file of a document once, and telling what is wrong with each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import AssemblyError
from kinematify.robot.mesh_file import read_meshes
from kinematify.robot.raw_mesh import merged
from kinematify.robot.urdf_geometry import NoShape

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.config.validation import FileSettings
    from kinematify.robot.raw_mesh import RawMesh
    from kinematify.robot.urdf_geometry import GeometrySource

_MEGABYTE = 1_000_000


@dataclass(frozen=True, kw_only=True)
class MeshUse:
    """A mesh element of the document."""

    link: str
    tag: str
    """``visual`` or ``collision``."""
    line: int


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshFile:
    """A mesh file with what uses it."""

    path: Path
    uses: tuple[MeshUse, ...]
    mesh: RawMesh | None
    """As it stands in the file; None where it cannot be read."""
    fault: str
    """Why it cannot be read."""

    @property
    def first(self) -> MeshUse:
        """The use that a finding names: a collision where there is one, because more depends on it."""
        return min(self.uses, key=lambda use: use.tag != "collision")

    @property
    def collides(self) -> bool:
        """True if a collision element uses it."""
        return any(use.tag == "collision" for use in self.uses)

    @property
    def worst_coordinate(self) -> float:
        """The largest absolute coordinate, NaN where one is not a number, 0 where it cannot be read."""
        return 0.0 if self.mesh is None else float(np.abs(self.mesh.vertices).max(initial=0.0))

    @property
    def called(self) -> str:
        """Its name with the links that use it, for messages."""
        links = list(dict.fromkeys(use.link for use in self.uses))
        more = f" and {len(links) - 3} more" if len(links) > 3 else ""
        return f"{self.path.name} ({self.first.tag} of {', '.join(links[:3])}{more})"


def open_mesh_files(robot: _Element, source: GeometrySource, settings: FileSettings) -> tuple[MeshFile, ...]:
    """Open every mesh file once; they, or why they cannot be read, also go into the cache of `source`.

    Args:
        robot: The document, which has passed the pre-check; files that are nowhere are left out.
        source: Where its meshes are looked up.
        settings: Caps.
    """
    uses: dict[Path, list[MeshUse]] = {}
    for link in robot.findall("link"):
        name = link.get("name") or ""
        for tag in ("visual", "collision"):
            for element in link.iterfind(f"{tag}/geometry/mesh"):
                try:
                    path = source.resolved(element.get("filename") or "", f"link {name}")
                except NoShape:
                    continue  # the pre-check has a finding for it
                use = MeshUse(link=name, tag=tag, line=int(str(element.sourceline)))
                uses.setdefault(path, []).append(use)
    return tuple(_opened(path, tuple(users), source, settings) for path, users in uses.items())


def _opened(path: Path, uses: tuple[MeshUse, ...], source: GeometrySource, settings: FileSettings) -> MeshFile:
    mesh, fault = None, ""
    try:
        size = path.stat().st_size
        if size > settings.max_mesh_bytes:
            raise AssemblyError(
                f"The mesh file {path} has {size / _MEGABYTE:.0f} MB; at most "
                f"{settings.max_mesh_bytes / _MEGABYTE:.0f} MB are opened. Simplify it."
            )
        mesh = merged(read_meshes(path), path.stem)
    except AssemblyError as error:
        fault = str(error)
    except OSError as error:
        fault = f"The mesh file {path} cannot be opened: {error.strerror}. Check who may read it."
    source.cache[path] = fault if mesh is None else mesh
    return MeshFile(path=path, uses=uses, mesh=mesh, fault=fault)
