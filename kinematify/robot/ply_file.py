"""PLY and OFF files: polygons, colours of vertices and faces, textures.

Read by themselves because trimesh 5.2 cuts polygons into fans and refuses binary PLY files that mix triangles and
quads; plyfile is under the GPL.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import AssemblyError
from kinematify.robot.appearance import Appearance, Material, painted
from kinematify.robot.polygons import triangle_places
from kinematify.robot.raw_mesh import RawMesh

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray

    _Columns = dict[str, tuple[NDArray[Any], NDArray[Any]]]
    """Values of every property of an element, lists one after another, with the length of each list."""

_NUMPY = ["i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8"]
_KINDS = {
    **dict(zip(["char", "uchar", "short", "ushort", "int", "uint", "float", "double"], _NUMPY, strict=True)),
    **dict(zip(["int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"], _NUMPY, strict=True)),
}
"""Types of PLY, old names and new."""
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_PLACES = (("texture_u", "texture_v"), ("u", "v"), ("s", "t"))
"""Properties of a vertex that are its place in a texture."""
_OFF = re.compile(r"(ST)?C?N?OFF")


def read_ply(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read a PLY file, ASCII or binary.

    Args:
        path: The file.
        appearance: Read colours and the texture too.

    Raises:
        AssemblyError: It is a point cloud.
        OSError, ValueError, KeyError, IndexError: It cannot be read.
    """
    head, end, body = path.read_bytes().partition(b"end_header")
    if not head.startswith(b"ply") or not end:
        raise ValueError("it does not begin like a PLY")
    order, picture = "", ""
    elements: dict[str, tuple[int, list[list[str]]]] = {}
    for line in head.decode("utf-8", "replace").splitlines():
        word, _, rest = line.strip().partition(" ")
        if word == "format":
            order = _ORDERS[rest.split()[0]]
        elif word == "comment" and rest.startswith("TextureFile"):
            picture = rest.removeprefix("TextureFile").strip()
        elif word == "element":
            name, count = rest.split()
            elements[name] = int(count), []
        elif word == "property":
            elements[[*elements][-1]][1].append(rest.split())
    values = _Values(body.partition(b"\n")[2], order)
    read = {name: values.element(count, properties) for name, (count, properties) in elements.items()}
    vertex, face = read["vertex"], read.get("face", {})
    vertices = np.stack([vertex[axis][0] for axis in "xyz"], axis=1).astype(np.float64)
    corners, sizes = next((face[name] for name in ("vertex_indices", "vertex_index") if name in face), _NONE)
    if not len(sizes) and len(vertices):
        raise AssemblyError(f"The file {path} is a point cloud, which has no surface. Make a mesh of it first.")
    faces, cut = _cut(vertices, corners.astype(np.int64), sizes.astype(np.int64))
    polygon = np.searchsorted(np.cumsum(sizes), cut[:, 0], side="right")
    looks = _appearance(path, picture, read, polygon, (faces, cut)) if appearance else None
    unread = tuple(f"the element {name}" for name, (count, _) in elements.items() if count and name not in _ELEMENTS)
    return (RawMesh(name=path.name, vertices=vertices, faces=faces, appearance=looks, notes=unread),)


_NONE = np.empty(0), np.empty(0)
_ELEMENTS = ("vertex", "face", "edge", "material", "camera")


def _cut(vertices: FloatArray, corners: IntArray, sizes: IntArray) -> tuple[IntArray, IntArray]:
    """Faces, and the places of their corners in the polygons, shape (F, 3) each."""
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(vertices):
        raise ValueError("a face refers to a vertex that the file does not hold")
    places = triangle_places(vertices[corners], sizes)
    return corners[places], places


class _Values:
    """The values of a PLY file, one after another."""

    def __init__(self, body: bytes, order: str) -> None:
        self._body, self._order, self._place = body, order, 0
        self._flat = np.empty(0) if order else np.array(body.split(), dtype=np.float64)

    def element(self, count: int, properties: list[list[str]]) -> _Columns:
        """The columns of the next element."""
        if not count:
            return {}
        start = self._place
        first = [len(self._one(stated)) for stated in properties]
        columns = self._uniform(start, properties, first, count)
        if columns is None:  # lists of several lengths: row by row
            self._place = start
            rows = [[self._one(stated) for stated in properties] for _ in range(count)]
            columns = [
                (np.concatenate(column), np.array([len(one) for one in column])) for column in zip(*rows, strict=True)
            ]
        return {stated[-1]: column for stated, column in zip(properties, columns, strict=True)}

    def _uniform(
        self, start: int, properties: list[list[str]], widths: list[int], count: int
    ) -> list[tuple[NDArray[Any], NDArray[Any]]] | None:
        """The columns where all lists are as long as the first; None where they are not."""
        self._place = start
        fields = [
            field
            for stated, width in zip(properties, widths, strict=True)
            for field in ([(_KINDS[stated[1]], 1)] if stated[0] == "list" else []) + [(_KINDS[stated[-2]], width)]
        ]
        try:
            found = iter(self._rows(fields, count))
        except ValueError:
            return None
        columns = []
        for stated, width in zip(properties, widths, strict=True):
            if stated[0] == "list" and (next(found) != width).any():
                return None
            columns.append((next(found).reshape(-1), np.full(count, width)))
        return columns

    def _one(self, stated: list[str]) -> NDArray[Any]:
        """The next value, or list of values, of a property."""
        width = int(self._rows([(_KINDS[stated[1]], 1)], 1)[0][0, 0]) if stated[0] == "list" else 1
        return self._rows([(_KINDS[stated[-2]], width)], 1)[0][0]

    def _rows(self, fields: list[tuple[str, int]], count: int) -> list[NDArray[Any]]:
        """The next rows of values, shape (count, width) for every field."""
        if not self._order:
            width = sum(number for _, number in fields)
            block = self._flat[self._place : self._place + count * width].reshape(count, width)
            self._place += count * width
            columns = np.split(block, np.cumsum([number for _, number in fields])[:-1], axis=1)
            return [column.astype(kind) for column, (kind, _) in zip(columns, fields, strict=True)]
        dtype = np.dtype([(str(k), self._order + kind, (number,)) for k, (kind, number) in enumerate(fields)])
        table = np.frombuffer(self._body, dtype, count, self._place)
        self._place += table.nbytes
        return [table[name] for name in table.dtype.names or ()]


def _appearance(
    path: Path, picture: str, read: dict[str, _Columns], polygon: IntArray, corners: tuple[IntArray, IntArray]
) -> Appearance | None:
    """Texture, else colours of vertices, else those of faces; None where the file states none.

    Args:
        path: The file.
        picture: Name of the texture.
        read: Columns of every element.
        polygon: Of every face, shape (F,).
        corners: Vertices of the faces and their places in the polygons, shape (F, 3) each.
    """
    faces, cut = corners
    vertex, face = read["vertex"], read.get("face", {})
    if picture:
        from kinematify.robot.material_files import named_texture  # noqa: PLC0415  # opens pictures, most files name none

        notes: list[str] = []
        texture = named_texture(picture, path.parent, notes)
        uv = np.array([])
        if "texcoord" in face:
            uv = face["texcoord"][0].reshape(-1, 2)[cut]
        for names in _PLACES:
            if names[0] in vertex:
                uv = np.stack([vertex[name][0] for name in names], axis=1)[faces]
        placed = texture is not None and len(uv)
        material = Material(color=(1.0, 1.0, 1.0, 1.0), texture=texture if placed else None)
        zeros = np.zeros(len(faces), dtype=np.int64)
        return Appearance(materials=(material,), material_of_face=zeros, uv=uv if placed else None, notes=tuple(notes))
    if "red" in vertex:
        return painted(_colors(vertex)[faces].mean(axis=1))
    if "red" in face:
        return painted(_colors(face)[polygon])
    return None


def _colors(columns: _Columns) -> FloatArray:
    """SRGB and opacity in [0, 1], shape (n, 4)."""
    found = []
    for name in ("red", "green", "blue", "alpha"):
        values = columns[name][0] if name in columns else np.ones(len(found[0]))
        found.append(values / np.iinfo(values.dtype).max if values.dtype.kind == "u" else values)
    return np.stack(found, axis=1).astype(np.float64)


def read_off(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read an OFF file with ASCII numbers; colours (`appearance`) and normals are not read.

    Raises:
        OSError, ValueError, IndexError: It cannot be read.
    """
    words = [line.partition("#")[0].split() for line in path.read_text("utf-8-sig", "replace").splitlines()]
    lines = [line for line in words if line]
    if not lines or not _OFF.fullmatch(lines[0][0]):
        raise ValueError("it does not begin like an OFF")
    counts = lines[0][1:] or lines.pop(1)
    count, polygons = int(counts[0]), int(counts[1])
    rows = lines[1 + count : 1 + count + polygons]
    vertices = np.array([line[:3] for line in lines[1 : 1 + count]], dtype=np.float64).reshape(count, 3)
    if len(rows) != polygons:
        raise ValueError(f"it states {polygons} faces but has {len(rows)}")
    sizes = np.array([int(row[0]) for row in rows], dtype=np.int64)
    corners = np.array([word for row in rows for word in row[1 : 1 + int(row[0])]], dtype=np.int64)
    if len(corners) != sizes.sum():
        raise ValueError("a face has fewer corners than it states")
    return (RawMesh(name=path.name, vertices=vertices, faces=_cut(vertices, corners, sizes)[0]),)
