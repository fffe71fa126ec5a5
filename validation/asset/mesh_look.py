"""Mesh files as the checks see them: each opened once, its surface measured when first asked for; the room of links."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import AssemblyError, DescriptionError
from kinematify.robot.mesh_file import read_meshes
from kinematify.robot.raw_mesh import merged
from kinematify.robot.read import parse_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import transformed
from kinematify.robot.urdf_geometry import NoShape, geometry_source
from kinematify.robot.urdf_text import parse_description
from kinematify.validation.asset.mesh_quality import surface_quality

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.config.validation import FileSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.raw_mesh import RawMesh
    from kinematify.robot.robot import Link, Robot
    from kinematify.robot.urdf_geometry import GeometrySource
    from kinematify.validation.asset.mesh_quality import SurfaceQuality
    from kinematify.validation.stage import StageRequest

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


@dataclass(frozen=True, kw_only=True, eq=False)
class Extent:
    """The room that the geometry of a link takes."""

    link: Link
    diagonal: float
    """[m], independent of the link's pose."""
    low: FloatArray
    """World frame at zero [m], shape (3,)."""
    high: FloatArray

    @property
    def has_file(self) -> bool:
        """True if a mesh file belongs to it."""
        return any(shape.file is not None for shape in (*self.link.visuals, *self.link.collisions))

    @property
    def line(self) -> int:
        """Line of its first shape."""
        return min(shape.line for shape in (*self.link.visuals, *self.link.collisions))


def extents_of(robot: Robot) -> dict[str, Extent]:
    """Measure the room of every link, keyed by link; links without geometry are omitted."""
    found = {}
    poses = forward_kinematics(robot, {})
    for link in robot.links:
        clouds = [shape.mesh.vertices for shape in (*link.visuals, *link.collisions) if len(shape.mesh.vertices)]
        if clouds:
            points = np.concatenate(clouds)
            placed = transformed(points, poses[link.name])
            found[link.name] = Extent(
                link=link,
                diagonal=float(np.linalg.norm(np.ptp(points, axis=0))),
                low=placed.min(axis=0),
                high=placed.max(axis=0),
            )
    return found


def gaps_between(robot: Robot, extents: dict[str, Extent]) -> Iterator[tuple[str, float, float]]:
    """Yield for each link the joint above it, its gap to the next link above with geometry, and both sizes [m].

    The gap is that of the bounding boxes, the sizes are added up; of several joints in between, the longest counts.
    """
    above = robot.joint_above
    for name, extent in extents.items():
        joints = []
        place = name
        while place in above and (place == name or place not in extents):
            joints.append(above[place])
            place = above[place].parent
        if joints and place in extents:
            parent = extents[place]
            gap = np.maximum(0.0, np.maximum(extent.low - parent.high, parent.low - extent.high))
            farthest = max(joints, key=lambda joint: float(np.linalg.norm(joint.T_parent_child[:3, 3])))
            yield farthest.name, float(np.linalg.norm(gap)), extent.diagonal + parent.diagonal


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
