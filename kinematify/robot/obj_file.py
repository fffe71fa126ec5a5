"""Wavefront OBJ, read and written without loss: vertices as shared in the file, all digits, groups and objects kept."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

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


@dataclass
class _Content:
    """What has been read so far."""

    vertices: list[FloatArray] = field(default_factory=list)
    count: int = 0
    """Vertices read."""
    faces: dict[str, list[IntArray]] = field(default_factory=dict)
    object_name: str = ""
    group_name: str = ""

    @property
    def label(self) -> str:
        return "/".join(name for name in (self.object_name, self.group_name) if name)


def read_obj(path: Path) -> tuple[FloatArray, tuple[ObjGroup, ...]]:
    """Read the vertices and the groups that hold faces; materials, normals and textures are skipped.

    Returns:
        Vertices of the whole file, shape (V, 3), and the groups in the order of their first face.

    Raises:
        OSError: The file cannot be opened.
        ValueError: A line is malformed; the message names it.
    """
    content = _Content()
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
    vertices = np.concatenate([np.empty((0, 3)), *content.vertices])
    return vertices, tuple(ObjGroup(name=name, faces=np.concatenate(runs)) for name, runs in content.faces.items())


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


def _read_faces(text: str, content: _Content) -> None:
    plain = _TEXTURE_AND_NORMAL.sub("", text) if "/" in text else text
    corners = _numbers(plain.replace("f", " "), int)
    if len(corners) == 3 * _count(text) and corners.min() > 0:
        block = corners.reshape(-1, 3) - 1
    else:  # polygons, indices that count back, or a mistake to be named
        block = np.array([corner for line in _lines(text) for corner in _fan(line, content.count)], dtype=np.int64)
    content.faces.setdefault(content.label, []).append(block.reshape(-1, 3))


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


def write_obj(path: Path, vertices: FloatArray, faces: IntArray, digits: int | None = None) -> None:
    """Write a mesh.

    Args:
        path: File to create.
        vertices: Shape (V, 3).
        faces: Shape (F, 3).
        digits: Significant ones of each coordinate; None for as many as give back the same float64 numbers.

    Raises:
        OSError: It cannot be written.
    """
    text = repr if digits is None else f"{{:.{digits}g}}".format
    with path.open("w", encoding="ascii") as file:
        file.writelines(f"v {text(x)} {text(y)} {text(z)}\n" for x, y, z in vertices.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist())
