"""The geometry elements of a URDF link as triangles in the link frame."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import AssemblyError, DescriptionError
from kinematify.robot.appearance import plain
from kinematify.robot.mesh_file import read_meshes, to_z_up
from kinematify.robot.mesh_paths import find_mesh
from kinematify.robot.raw_mesh import RawMesh, merged
from kinematify.robot.robot import LinkMesh, Shape
from kinematify.robot.transforms import transformed
from kinematify.robot.urdf_numbers import line_of, origin_transform, vector

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml.etree import _Element

    from kinematify.robot.appearance import Rgba
    from kinematify.robot.arrays import FloatArray, IntArray

SIZES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "capsule": ("radius", "length")}
"""Attributes that hold the size of a primitive."""
_SECTIONS = 64
"""Sides of a tessellated cylinder: its flats lie 0.12 % of the radius inside the circle."""
_SUBDIVISIONS = 4
"""Of an icosphere: 5,120 faces, 0.1 % of the radius inside the sphere."""


_CUBE = np.array(list(product((0.0, 1.0), repeat=3)))
_CUBE_FACES = np.array(
    [1, 3, 0, 4, 1, 0, 0, 3, 2, 2, 4, 0, 1, 7, 3, 5, 1, 4, 5, 7, 1, 3, 7, 2, 6, 4, 2, 2, 7, 6, 6, 5, 4, 7, 5, 6]
).reshape(-1, 3)

_ICOSAHEDRON = np.array(
    [0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,
     3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1]
).reshape(-1, 3)  # fmt: skip


class NoShape(DescriptionError):
    """An element has no geometry that can be read."""


@dataclass(frozen=True, kw_only=True, eq=False)
class GeometrySource:
    """Where the geometry of one document is looked up; every mesh file is read once."""

    folder: Path
    """Folder of the document."""
    package_dirs: tuple[Path, ...]
    """Folders that are packages, or hold them."""
    cache: dict[Path, RawMesh | str]
    """Meshes by file; a sentence for one that cannot be used."""
    heeds_up_axis: bool = False
    """Whether meshes are turned upright whose files state that another axis than z points up."""
    appearance: bool = False
    """Whether materials of mesh files are read; they go before the colour that the document states."""

    omitted: dict[str, None] = field(default_factory=dict)
    """Elements without usable geometry, one sentence each, in order."""
    lacking: set[str] = field(default_factory=set)
    """Links with such a ``collision``."""

    def shapes(self, link: _Element, tag: str) -> tuple[Shape, ...]:
        """Return all ``visual`` or ``collision`` elements of a link with their triangles.

        Primitives with a length of zero represent no shape. An element has none either if it states none or an unknown
        one, or if its mesh is missing or cannot be read; `omitted` names it.

        Raises:
            DescriptionError: A number is malformed.
        """
        shapes = (self._usable(element, f"link {link.get('name')}") for element in link.findall(tag))
        return tuple(shape for shape in shapes if shape is not None)

    def _usable(self, element: _Element, where: str) -> Shape | None:
        try:
            return self._shape(element, where)
        except NoShape as error:
            self.omit(element, error)
            return None

    def omit(self, element: _Element, error: NoShape) -> None:
        """Note why an element has no shape."""
        if element.tag == "collision":
            self.lacking.update(link.get("name", "") for link in element.iterancestors("link"))
        self.omitted[f"A {element.tag} is omitted (line {line_of(element)}). {error}"] = None

    def is_usable(self, element: _Element) -> bool:
        """True if a visual or collision has geometry that can be read, or is of a size of zero."""
        before = len(self.omitted)
        return self._usable(element, "it") is not None or len(self.omitted) == before

    def _shape(self, element: _Element, where: str) -> Shape | None:
        geometry = element.find("geometry")
        if geometry is None or len(geometry) != 1:
            raise NoShape(
                f"The {element.tag} of {where} has no geometry element with exactly one shape inside. Give it a mesh, "
                "box, cylinder or sphere, or remove it."
            )
        shape, transform = geometry[0], origin_transform(element, where)
        color, line = _color(element.find("material")), line_of(element)
        if shape.tag != "mesh":
            size = _primitive_size(shape, where)
            if min(size) <= 0.0:
                return None
            built = primitive(str(shape.tag), size, transform, color, line)
            return built if self.appearance else replace(built, mesh=replace(built.mesh, appearance=None))
        scale = vector(shape, "scale", (1.0, 1.0, 1.0), where)
        made = self.mesh(shape.get("filename") or "", scale, transform, where, color=color, line=line)
        return replace(made, concave=element.get("concave") in ("yes", "true", "1"))

    def mesh(
        self, filename: str, scale: FloatArray, T_link_shape: FloatArray, where: str, *, color: Rgba | None, line: int
    ) -> Shape:
        """Return a mesh file as a shape; a mirroring scale does not turn it inside out.

        Args:
            filename: As the document names it.
            scale: Shape (3,).
            T_link_shape: Shape (4, 4).
            where: The link, for messages.
            color: As for `Shape`.
            line: The same.

        Raises:
            NoShape: It is nowhere, or cannot be read.
        """
        path = self.resolved(filename, where)
        mesh = self._mesh_file(path, where)
        if self.heeds_up_axis and mesh.up:
            mesh = mesh.moved(to_z_up(mesh.up))
        mesh = mesh.placed(np.diag([*scale, 1.0])).moved(T_link_shape[:3, :3], T_link_shape[:3, 3])
        looks = mesh.appearance
        if looks is None and color is not None and self.appearance:
            looks = plain(color, len(mesh.faces))
        shown = LinkMesh(vertices=mesh.vertices, faces=mesh.faces, appearance=looks)
        return Shape(mesh=shown, file=path, scale=scale, T_link_shape=T_link_shape, color=color, line=line)

    def _mesh_file(self, path: Path, where: str) -> RawMesh:
        if path not in self.cache:
            try:
                self.cache[path] = merged(read_meshes(path, appearance=self.appearance), path.stem)
            except AssemblyError as error:
                self.cache[path] = str(error)
        found = self.cache[path]
        if isinstance(found, str):
            raise NoShape(f"The mesh of {where} cannot be used. {found}")
        return found

    @property
    def states_up_axis(self) -> bool:
        """True if a mesh that was read states that another axis than z points up."""
        return any(mesh.up for mesh in self.cache.values() if not isinstance(mesh, str))

    def resolved(self, filename: str, where: str) -> Path:
        """Return the mesh file that a document names; see `kinematify.robot.mesh_paths.find_mesh`.

        Raises:
            DescriptionError: It is nowhere; the message lists the places.
        """
        try:
            return find_mesh(filename, self.folder, self.package_dirs, where)
        except DescriptionError as error:
            raise NoShape(str(error)) from error


def geometry_source(document: Path, package_dirs: Sequence[Path], *, appearance: bool = False) -> GeometrySource:
    """Return the source of geometry for the URDF at `document`."""
    folders = tuple(Path(folder).resolve() for folder in package_dirs)
    return GeometrySource(folder=document.resolve().parent, package_dirs=folders, cache={}, appearance=appearance)


def primitive(
    kind: str,
    size: tuple[float, ...],
    T_link_shape: FloatArray,
    color: Rgba | None = None,
    line: int = 0,
) -> Shape:
    """Return a box, cylinder, sphere or capsule with its triangles; the arguments are fields of `Shape`."""
    mesh = _tessellated(kind, size)
    shape = mesh_shape(mesh.vertices, mesh.faces, T_link_shape, color, line)
    return replace(shape, kind=kind, size=size, T_link_shape=T_link_shape)


def ellipsoid(radii: Sequence[float], T_link_shape: FloatArray, color: Rgba | None, line: int) -> Shape:
    """Return an ellipsoid, which is a mesh here; the arguments are fields of `Shape`."""
    ball = _tessellated("sphere", (1.0,))
    return mesh_shape(ball.vertices * radii, ball.faces, T_link_shape, color, line)


def mesh_shape(
    vertices: FloatArray,
    faces: IntArray,
    T_link_shape: FloatArray,
    color: Rgba | None = None,
    line: int = 0,
) -> Shape:
    """Return a mesh that comes from no file of its own, of one colour; vertices in the frame of the shape, (V, 3)."""
    placed = transformed(np.asarray(vertices, dtype=np.float64), T_link_shape)
    looks = None if color is None else plain(color, len(faces))
    return Shape(mesh=LinkMesh(vertices=placed, faces=faces, appearance=looks), color=color, line=line)


def _primitive_size(shape: _Element, where: str) -> tuple[float, ...]:
    if shape.tag not in SIZES:
        raise NoShape(
            f"The geometry of {where} is a <{shape.tag}>, which URDF does not have. Use a mesh, box, cylinder or "
            "sphere."
        )
    if absent := [name for name in SIZES[str(shape.tag)] if name not in shape.attrib]:
        raise NoShape(f"The <{shape.tag}> of {where} states no {absent[0]}. Write it, or remove the element.")
    count = 3 if shape.tag == "box" else 1
    size = tuple(float(length) for name in SIZES[str(shape.tag)] for length in vector(shape, name, None, where, count))
    if not all(length >= 0.0 for length in size):
        raise DescriptionError(f"The {shape.tag} of {where} has the size {size}. No length may be below zero.")
    return size


def _tessellated(kind: str, size: tuple[float, ...]) -> RawMesh:
    if kind == "box":
        return RawMesh(name="", vertices=(_CUBE - 0.5) * size, faces=_CUBE_FACES)
    if kind == "cylinder":
        return _cylinder(*size)
    if kind == "sphere":
        return _icosphere(*size)
    from trimesh import creation  # noqa: PLC0415  # takes longer than all else that reads a URDF

    mesh = creation.capsule(radius=size[0], height=size[1], count=(_SECTIONS // 2, _SECTIONS))
    return RawMesh(name="", vertices=np.asarray(mesh.vertices), faces=np.asarray(mesh.faces, dtype=np.int64))


def _cylinder(radius: float, height: float) -> RawMesh:
    angle = np.linspace(0.0, 2.0 * np.pi, _SECTIONS, endpoint=False)
    rim = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    low, high = (np.insert(rim, 2, end, axis=1) for end in (-0.5 * height, 0.5 * height))
    sides = np.stack([low, high], axis=1).reshape(-1, 3)
    vertices = np.insert(sides, [0, 2], [[0.0, 0.0, -0.5 * height], [0.0, 0.0, 0.5 * height]], axis=0)
    below = np.array([1, *range(4, len(vertices), 2)])
    after, bottom, top = np.roll(below, -1), np.zeros_like(below), np.full_like(below, 3)
    above, over = below + 1, after + 1
    faces = [below, bottom, after, below, after, above, above, after, over, above, over, top]
    return RawMesh(name="", vertices=vertices, faces=np.stack(faces, axis=1).reshape(-1, 3))


def _icosphere(radius: float) -> RawMesh:
    signs = np.array(list(product((-1.0, 1.0), repeat=2)))[[1, 3, 0, 2]]
    short, long = np.array([1.0, 0.5 * (1.0 + np.sqrt(5.0))]) / np.sqrt(0.5 * (5.0 + np.sqrt(5.0)))
    rim = np.insert(signs * (short, long), 2, 0.0, axis=1)
    vertices, faces = np.concatenate([rim, rim[:, [2, 0, 1]], rim[:, [1, 2, 0]]]), _ICOSAHEDRON
    for _ in range(_SUBDIVISIONS):
        edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        _, first, middle = np.unique(edges @ [1, len(vertices)], return_index=True, return_inverse=True)
        a, b, c = faces.T
        ab, bc, ca = middle.reshape(-1, 3).T + len(vertices)
        faces = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
        vertices = np.concatenate([vertices, vertices[edges[first]].mean(axis=1)])
        lengths = np.sqrt(vertices**2 @ np.ones(3))[:, None]
        vertices = vertices + vertices / lengths * (radius - lengths)
    return RawMesh(name="", vertices=vertices, faces=faces)


def _color(material: _Element | None) -> Rgba | None:
    """Colour of a material, looked up by its name in the document where it states none itself."""
    if material is None:
        return None
    found = _stated_color(material)
    if found is None:
        named = [
            other for other in material.getroottree().iter("material") if other.get("name") == material.get("name")
        ]
        found = next((color for color in map(_stated_color, named) if color is not None), None)
    return found


def _stated_color(material: _Element) -> Rgba | None:
    color = material.find("color")
    try:
        values = [float(word) for word in (color.get("rgba") or "").split()] if color is not None else []
    except ValueError:
        return None
    if len(values) != 4 or not all(0.0 <= value <= 1.0 for value in values):
        return None
    red, green, blue, opacity = values
    return red, green, blue, opacity
