"""Wavefront OBJ, read and written without loss: vertices as shared in the file, all digits, groups and materials."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.robot.appearance import Appearance, Material, painted

if TYPE_CHECKING:
    from pathlib import Path
    from typing import TextIO

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray


_RUN = re.compile(r"(?:v[ \t].*\n?)++|(?:f[ \t].*\n?)++")
"""Lines of vertices, or of faces, that follow one another."""
_TEXTURE_AND_NORMAL = re.compile(r"/\S*")


@dataclass(frozen=True, kw_only=True, eq=False)
class ObjGroup:
    """The faces that stand under one combination of object (``o``) and group (``g``)."""

    name: str
    """Empty where the file names neither."""
    faces: IntArray
    """Indices into the file's vertices, polygons split into fans, shape (F, 3)."""
    appearance: Appearance | None = None
    """None where the file states no material and no colours, and where it was not asked for."""


@dataclass
class _Content:
    """Content read so far."""

    appearance: bool = False
    """Whether materials, textures and colours are read."""

    vertices: list[FloatArray] = field(default_factory=list)
    count: int = 0
    """Vertices read."""
    faces: dict[str, list[IntArray]] = field(default_factory=dict)
    used: dict[str, list[str]] = field(default_factory=dict)
    """Material of every run of faces, with the keys of `faces`."""
    places: dict[str, list[IntArray]] = field(default_factory=dict)
    """Places in the texture of the corners of every run of faces, -1 for none, with the keys of `faces`."""
    uv: list[list[float]] = field(default_factory=list)
    colors: list[FloatArray] = field(default_factory=list)
    """sRGB of every run of vertices, not a number where none is stated."""
    libraries: list[str] = field(default_factory=list)
    material: str = ""
    object_name: str = ""
    group_name: str = ""

    @property
    def label(self) -> str:
        return "/".join(name for name in (self.object_name, self.group_name) if name)


def read_obj(path: Path, *, appearance: bool = False) -> tuple[FloatArray, tuple[ObjGroup, ...]]:
    """Read the vertices and the groups that hold faces; normals are skipped.

    Args:
        path: The file.
        appearance: Read materials, textures and colours of vertices too.

    Returns:
        Vertices of the whole file, shape (V, 3), and the groups in the order of their first face.

    Raises:
        OSError: The file cannot be opened.
        ValueError: A line is malformed; the message names it.
    """
    content = _Content(appearance=appearance)
    text = path.read_text(encoding="utf-8", errors="replace")
    end = 0
    while end < len(text):
        start = end
        run = _RUN.match(text, start)
        end = run.end() if run else (text.find("\n", start) + 1 or len(text))
        keyword = text[start] if run else _keyword(text[start:end])
        if keyword == "v":
            _read_vertices(text[start:end], content)
        elif keyword == "f":
            _read_faces(text[start:end], content)
        elif keyword in ("o", "g"):
            _read_name(keyword, text[start:end], content)
        elif appearance:
            _read_appearance(keyword, text[start:end], content)
    vertices = np.concatenate([np.empty((0, 3)), *content.vertices])
    looks = _appearances(path, content) if appearance else {}
    return vertices, tuple(
        ObjGroup(name=name, faces=np.concatenate(runs), appearance=looks.get(name))
        for name, runs in content.faces.items()
    )


def _read_appearance(keyword: str, line: str, content: _Content) -> None:
    """A line about materials or places in a texture."""
    if keyword == "vt":
        words = [*line.split()[1:3], "0"]
        content.uv.append([float(words[0]), float(words[1])])
    elif keyword == "usemtl":
        content.material = line.strip().removeprefix("usemtl").strip()
    elif keyword == "mtllib":
        content.libraries.append(line.strip().removeprefix("mtllib").strip())


def _appearances(path: Path, content: _Content) -> dict[str, Appearance]:
    """Appearance of every group by its name: of its materials, else of the colours of its vertices."""
    if not content.libraries:
        return _painted_groups(content)
    from kinematify.robot.material_files import read_mtl  # noqa: PLC0415  # opens pictures, most files name none

    known: dict[str, Material] = {}
    notes: list[str] = []
    for name in content.libraries:
        found, said = read_mtl(path.with_name(name.replace("\\", "/").rpartition("/")[2]))
        known |= found
        notes += said
    if not known:
        return {name: replace(item, notes=tuple(notes)) for name, item in _painted_groups(content).items()}
    uv = np.array(content.uv).reshape(-1, 2)
    looks = {}
    for name, runs in content.faces.items():
        materials = tuple(dict.fromkeys(content.used[name]))
        index = np.repeat([materials.index(used) for used in content.used[name]], [len(run) for run in runs])
        places = np.concatenate(content.places[name])
        placed = (places >= 0) & (places < len(uv))
        corners = np.where(placed[..., None], uv[np.where(placed, places, 0)], 0.0) if placed.any() else None
        looks[name] = Appearance(
            materials=tuple(known.get(used, Material(name=used)) for used in materials),
            material_of_face=index,
            uv=corners,
            notes=tuple(notes),
        )
    return looks


def _painted_groups(content: _Content) -> dict[str, Appearance]:
    colors = np.concatenate([np.empty((0, 3)), *content.colors])
    if not len(colors) or not np.isfinite(colors).all():
        return {}
    opaque = np.column_stack([np.clip(colors, 0.0, 1.0), np.ones(len(colors))])
    return {name: painted(opaque[np.concatenate(runs)].mean(axis=1)) for name, runs in content.faces.items()}


def _keyword(line: str) -> str:
    return line.split(None, 1)[0] if line.strip() else ""


def _read_vertices(text: str, content: _Content) -> None:
    numbers = _numbers(text.replace("v", " "), float)
    width, rest = divmod(len(numbers), _count(text))
    uniform = rest == 0 and width >= 3
    # Otherwise there is a mixture, or a mistake to be named.
    block = numbers.reshape(-1, width)[:, :3] if uniform else np.array([_vertex(line) for line in _lines(text)])
    content.vertices.append(block)
    content.count += len(block)
    if content.appearance:
        stated = numbers.reshape(-1, width)[:, 3:6] if uniform and width >= 6 else np.full((len(block), 3), np.nan)
        content.colors.append(stated)


def _read_faces(text: str, content: _Content) -> None:
    plain = _TEXTURE_AND_NORMAL.sub("", text) if "/" in text else text
    corners = _numbers(plain.replace("f", " "), int)
    if len(corners) == 3 * _count(text) and corners.min() > 0:
        block = corners.reshape(-1, 3) - 1
    else:  # polygons, indices that count back, or a mistake to be named
        block = np.array([corner for line in _lines(text) for corner in _fan(line, content.count)], dtype=np.int64)
    content.faces.setdefault(content.label, []).append(block.reshape(-1, 3))
    if content.appearance:
        content.used.setdefault(content.label, []).append(content.material)
        places = np.full(block.size, -1)
        if "/" in text:
            places = np.array([corner for line in _lines(text) for corner in _places_of_fan(line, len(content.uv))])
        content.places.setdefault(content.label, []).append(places.astype(np.int64).reshape(-1, 3))


def _places_of_fan(line: str, count: int) -> list[tuple[int, int, int]]:
    """Places in the texture of the triangles of a polygon line, -1 for none, after `count` have been read."""
    stated = [word.split("/")[1] if "/" in word else "" for word in line.split()[1:]]
    places = [-1 if not word else int(word) - 1 if int(word) > 0 else count + int(word) for word in stated]
    return [(places[0], places[k], places[k + 1]) for k in range(1, len(places) - 1)]


def _count(text: str) -> int:
    return text.count("\n") + (not text.endswith("\n"))


def _lines(text: str) -> list[str]:
    return text.removesuffix("\n").split("\n")


def _numbers(text: str, kind: type) -> NDArray[Any]:
    """All numbers of a text; empty where it holds anything else."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # older NumPy only warns where there is no number
            return np.fromstring(text, dtype=kind, sep=" ")
    except (DeprecationWarning, ValueError):
        pass
    try:
        return np.array(text.split(), dtype=kind)  # Python knows more ways to write a number
    except ValueError:
        return np.empty(0, dtype=kind)


def _vertex(line: str) -> list[float]:
    try:
        x, y, z = line.split()[1:4]
        return [float(x), float(y), float(z)]
    except ValueError as error:
        raise ValueError(f"malformed vertex line {line.strip()[:60]!r}") from error


def _fan(line: str, count: int) -> list[tuple[int, int, int]]:
    """Triangles of a polygon line, after `count` vertices have been read."""
    try:
        corners = [int(word.partition("/")[0]) for word in line.split()[1:]]
    except ValueError as error:
        raise ValueError(f"malformed face line {line.strip()[:60]!r}") from error
    if len(corners) < 3 or 0 in corners or min(corners) < -count:
        raise ValueError(f"impossible face line {line.strip()[:60]!r}")
    zero_based = [corner - 1 if corner > 0 else count + corner for corner in corners]
    return [(zero_based[0], zero_based[k], zero_based[k + 1]) for k in range(1, len(corners) - 1)]


def _read_name(keyword: str, line: str, content: _Content) -> None:
    name = line.strip()[1:].strip()
    if keyword == "o":
        content.object_name, content.group_name = name, ""
    else:
        content.group_name = name


OBJ_DIGITS = 10
"""One more than a float32 needs; the error is 1e-10 of a coordinate."""


def write_obj(
    path: Path,
    vertices: FloatArray,
    faces: IntArray,
    digits: int | None = None,
    appearance: Appearance | None = None,
    *,
    uv: FloatArray | None = None,
) -> None:
    """Write a mesh; what it looks like goes into an MTL file of the same name with its textures beside it.

    Args:
        path: File to create.
        vertices: Shape (V, 3).
        faces: Shape (F, 3).
        digits: Significant ones of each coordinate; None for as many as give back the same float64 numbers.
        appearance: Of the faces.
        uv: Place of every vertex in a texture that is named elsewhere, shape (V, 2).

    Raises:
        OSError: It cannot be written.
    """
    number = "%r" if digits is None else f"%.{digits}g"
    with path.open("w", encoding="ascii") as file:
        if appearance is not None:
            file.write(f"mtllib {path.stem}.mtl\n")
        file.write(_formatted(f"v {number} {number} {number}\n", vertices))
        if appearance is not None:
            _write_painted_faces(file, path, faces, appearance)
        elif uv is not None:
            file.write(_formatted("vt %.6g %.6g\n", uv))
            file.write(_formatted("f %d/%d %d/%d %d/%d\n", np.repeat(faces + 1, 2, axis=1)))
        else:
            file.write(_formatted("f %d %d %d\n", faces + 1))


def _formatted(line: str, rows: FloatArray | IntArray) -> str:
    """A line for every row; one long format takes half the time of many."""
    return line * len(rows) % tuple(rows.reshape(-1).tolist())


def _write_painted_faces(file: TextIO, path: Path, faces: IntArray, appearance: Appearance) -> None:
    """Faces in their order, with the name of the material wherever it changes."""
    from kinematify.robot.material_files import write_mtl  # noqa: PLC0415  # opens pictures

    names = write_mtl(path.with_suffix(".mtl"), appearance.materials)
    chosen, lines = appearance.material_of_face, [f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist()]
    if appearance.uv is not None:
        uv, place = np.unique(appearance.uv.reshape(-1, 2), axis=0, return_inverse=True)
        file.writelines(f"vt {u:.6g} {v:.6g}\n" for u, v in uv.tolist())
        corners = np.stack([faces + 1, place.reshape(-1, 3) + 1], axis=2)
        lines = [f"f {a}/{s} {b}/{t} {c}/{u}\n" for (a, s), (b, t), (c, u) in corners.tolist()]
    starts = np.flatnonzero(np.diff(chosen, prepend=-1)).tolist()
    for start, end in pairwise([*starts, len(lines)]):
        file.write(f"usemtl {names[chosen[start]]}\n")
        file.writelines(lines[start:end])
