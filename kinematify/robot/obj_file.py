"""Wavefront OBJ, read and written without loss: vertices as shared in the file, all digits, groups and materials.

Read by itself because trimesh 5.2 cuts polygons into fans and has neither groups nor continued lines, at 1.5 times the
time (1.3 million triangles: 8.5 s, 5.8 s here); tinyobjloader rounds to float32, which is 0.5 m in survey coordinates.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.robot.appearance import Appearance, Material, painted
from kinematify.robot.polygons import triangle_places
from kinematify.robot.raw_mesh import RawMesh, compacted

if TYPE_CHECKING:
    from pathlib import Path
    from typing import TextIO

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray


_RUN = re.compile(r"(?:v[ \t].*\n?)++|(?:f[ \t].*\n?)++")
"""Lines of vertices, or of faces, that follow one another."""
_TEXTURE_AND_NORMAL = re.compile(r"/\S*")
_CONTINUED = re.compile(r"\\[ \t]*\n")
_COMMENT = re.compile(r"#.*")
_SILENT = (
    "",
    "vn",
    "s",
    "mg",
    "lod",
    "bevel",
    "vt",
    "usemtl",
    "mtllib",
    "c_interp",
    "d_interp",
    "shadow_obj",
    "trace_obj",
)
"""Words that begin lines without a surface."""


@dataclass(kw_only=True)
class _Content:
    """Content read so far."""

    appearance: bool
    """Whether materials, textures and colours are read."""
    vertices: list[FloatArray] = field(default_factory=list)
    count: int = 0
    """Vertices read."""
    runs: dict[tuple[str, str], list[tuple[str, IntArray, IntArray, IntArray]]] = field(default_factory=dict)
    """Of every object and group: material, corners, their places in the texture or -1, sizes of polygons."""
    uv: list[list[float]] = field(default_factory=list)
    colors: list[FloatArray] = field(default_factory=list)
    """sRGB of every run of vertices, not a number where none is stated."""
    libraries: list[str] = field(default_factory=list)
    material: str = ""
    holders: tuple[str, str] = ("", "")
    unknown: dict[str, None] = field(default_factory=dict)


def read_obj(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read the faces under every combination of object (``o``) and group (``g``), in the order of their first face.

    Normals are skipped, and polygons are triangles inside of them.

    Args:
        path: The file.
        appearance: Read materials, textures and colours of vertices too.

    Raises:
        OSError: The file cannot be opened.
        ValueError: A line is malformed; the message names it.
    """
    content = _Content(appearance=appearance)
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    if "\\" in text:
        text = _CONTINUED.sub(" ", text)
    end = 0
    while end < len(text):
        start = end
        run = _RUN.match(text, start)
        end = run.end() if run else (text.find("\n", start) + 1 or len(text))
        lines = text[start:end]
        keyword, _, rest = lines.strip().partition(" ") if not run else (text[start], "", "")
        if keyword in ("v", "f"):
            lines = _COMMENT.sub("", lines) if "#" in lines else lines
            (_read_vertices if keyword == "v" else _read_faces)(lines, content)
        else:
            _read_line(keyword, rest.strip(), content)
    vertices = np.concatenate([np.empty((0, 3)), *content.vertices])
    if not len(vertices):
        raise ValueError("it has no vertex")
    known, notes = _materials(path, content)
    uv, colors = np.array(content.uv).reshape(-1, 2), np.concatenate([np.empty((0, 3)), *content.colors])
    groups, objects = [], [*dict.fromkeys(name for name, _ in content.runs)]
    for holders, runs in content.runs.items():
        corners, places, sizes = (np.concatenate([run[k] for run in runs]) for k in (1, 2, 3))
        if corners.max(initial=-1) >= len(vertices):
            raise ValueError("a face refers to a vertex that the file does not hold")
        cut = triangle_places(vertices[corners], sizes) if (sizes > 3).any() else np.arange(len(corners)).reshape(-1, 3)
        looks = None
        if known:
            named = dict.fromkeys(run[0] for run in runs)
            index = np.repeat([[*named].index(run[0]) for run in runs], [int((run[3] - 2).sum()) for run in runs])
            at = places[cut]
            placed = (at >= 0) & (at < len(uv))
            looks = Appearance(
                materials=tuple(known.get(name, Material(name=name)) for name in named),
                material_of_face=index,
                uv=np.where(placed[..., None], uv[np.where(placed, at, 0)], 0.0) if placed.any() else None,
                notes=notes,
            )
        elif len(colors) and np.isfinite(colors).all():
            opaque = np.column_stack([np.clip(colors, 0.0, 1.0), np.ones(len(colors))])
            looks = painted(opaque[corners[cut]].mean(axis=1), notes=notes)
        mesh = RawMesh(
            name="/".join(filter(None, holders)),
            vertices=vertices,
            faces=corners[cut],
            appearance=looks,
            # A group of one name in two objects is two groups.
            holders=tuple((k * (1 + objects.index(holders[0])), name) for k, name in enumerate(holders) if name),
            notes=tuple(f"lines that begin with {word}" for word in content.unknown),
        )
        # Every group keeps its own vertices only: with thousands of groups the copies would fill the memory.
        groups.append(compacted(mesh) if len(content.runs) > 1 else mesh)
    return tuple(groups)


def _read_line(keyword: str, rest: str, content: _Content) -> None:
    """A line that is neither a vertex nor a face."""
    if keyword == "o":
        content.holders = (rest, "")
    elif keyword == "g":
        content.holders = (content.holders[0], rest)
    elif keyword not in _SILENT and not keyword.startswith("#"):
        content.unknown[keyword[:20]] = None
    elif content.appearance and keyword == "vt":
        u, v = [*rest.split(), "0"][:2]
        content.uv.append([float(u), float(v)])
    elif keyword == "usemtl":
        content.material = rest
    elif keyword == "mtllib":
        content.libraries.append(rest)


def _materials(path: Path, content: _Content) -> tuple[dict[str, Material], tuple[str, ...]]:
    """Materials of the libraries by name, and what of them cannot be read."""
    known: dict[str, Material] = {}
    notes: list[str] = []
    for name in content.libraries if content.appearance else ():
        from kinematify.robot.material_files import read_mtl  # noqa: PLC0415  # opens pictures, most files name none

        found, said = read_mtl(path.with_name(name.replace("\\", "/").rpartition("/")[2]))
        known |= found
        notes += said
    return known, tuple(notes)


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
    textured = "/" in text
    plain = _TEXTURE_AND_NORMAL.sub("", text) if textured else text
    corners = _numbers(plain.replace("f", " "), int)
    sizes, places = np.full(_count(text), 3), np.zeros(len(corners), dtype=np.int64)
    # Polygons, indices that count back, or a mistake to be named; else places in the texture alone.
    if len(corners) != sizes.sum() or corners.min() <= 0 or (textured and content.appearance):
        rows = [_polygon(line, content.count) for line in _lines(text)]
        sizes = np.array([len(row) for row in rows])
        corners, places = np.array([corner for row in rows for corner in row], dtype=np.int64).T
    run = (
        content.material,
        np.where(corners > 0, corners - 1, content.count + corners),
        np.where(places >= 0, places - 1, len(content.uv) + places),
        sizes,
    )
    content.runs.setdefault(content.holders, []).append(run)


def _polygon(line: str, count: int) -> list[tuple[int, int]]:
    """Vertex of every corner, and place in the texture or 0, as they are in a line after `count` vertices."""
    try:
        words = [word.split("/") for word in line.split()[1:]]
        corners = [(int(word[0]), int(word[1]) if word[1:] and word[1] else 0) for word in words]
    except ValueError as error:
        raise ValueError(f"malformed face line {line.strip()[:60]!r}") from error
    if len(corners) < 3 or not all(vertex > 0 or -count <= vertex < 0 for vertex, _ in corners):
        raise ValueError(f"impossible face line {line.strip()[:60]!r}")
    return corners


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
