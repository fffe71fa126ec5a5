"""Furniture is cut board by board, all else worst first; the same meshes and settings give pieces kept between runs."""

from __future__ import annotations

import hashlib
import os
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING
from zipfile import BadZipFile

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kinematify.geometry.convex import ConvexPiece
from kinematify.geometry.cut import ALONG, Chunk, cut_worst_first, face_levels, split
from kinematify.processes.forked import each
from kinematify.robot.vectors import lengths_of, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.config.validation import PrepareSettings
    from kinematify.geometry.cut import Concave
    from kinematify.robot.arrays import FloatArray


_SQUARE = 0.8
"""Share of the surface that lies across some axis in what is made of boards."""
_FACES = 10
"""Planes of faces that are tried per axis, the largest first."""
_SAME = 0.002
"""Faces nearer to each other than this fraction of the extent lie in one plane."""
_BESIDE = 1e-4
"""How far beside a face a plane stands, fraction of the extent: the face itself stays in one piece."""
_LEAST = 0.01
"""Share of the surface that a board has at least: smaller ones are knobs and screws."""
_WELD = 1e-6
"""Corners nearer than this fraction of the extent are one."""
_MOST = 40
"""Boards of one surface; chests with many compartments have 20."""


def convex_chunks(bodies: Sequence[Concave], cuts: int) -> list[list[Chunk]]:
    """Take apart what is made of boards, and cut the rest worst first.

    Args:
        bodies: The surfaces.
        cuts: For all that are cut together; each that is made of boards may have as many boards on top.

    Returns:
        The chunks of each.
    """
    found = each(lambda body: split_by_boards(body, min(_MOST, cuts)), bodies)
    rest = iter(cut_worst_first([b for b, chunks in zip(bodies, found, strict=True) if chunks is None], cuts))
    return [next(rest) if chunks is None else chunks for chunks in found]


def split_by_boards(body: Concave, most: int) -> list[Chunk] | None:
    """Take the boards of a surface off one after the other, along the planes of its own faces.

    A cut that halves a cabinet leaves two cabinets; only when all of its boards are off, nothing hollow is left. So the
    board with the most surface is taken off again and again, and what falls apart is gone on with separately.

    Args:
        body: The surface.
        most: Boards at most.

    Returns:
        The boards, each as close to the surface as is tolerated; None where something is left that is no board.
    """
    whole = body.triangles
    if not len(whole) or _share_across(whole, body.axes) < _SQUARE:
        return None
    area = float(_areas(whole).sum())
    done: list[Chunk] = []
    waiting = [body.chunk(whole)]
    while waiting:
        chunk = waiting.pop()
        if chunk.gap <= body.tolerance:
            done.append(chunk)
            continue
        found = _largest_board(body, chunk.triangles, _LEAST * area) if len(done) < most else None
        if found is None:
            return None
        board, rest = found
        done.append(board)
        waiting += [body.chunk(piece) for piece in _connected(rest)]
    return done


def _share_across(triangles: FloatArray, axes: FloatArray) -> float:
    normals = triangle_normals(triangles)
    across = (np.abs(normals @ axes.T) > ALONG * lengths_of(normals)[:, None]).any(axis=1)
    areas = lengths_of(normals)
    return float(areas[across].sum() / max(float(areas.sum()), 1e-300))


def _areas(triangles: FloatArray) -> FloatArray:
    return 0.5 * lengths_of(triangle_normals(triangles))


def _largest_board(body: Concave, triangles: FloatArray, least: float) -> tuple[Chunk, FloatArray] | None:
    """The board with the most surface, and the rest without it, shape (n, 3, 3)."""
    candidates = []
    for axis in body.axes:
        heights = triangles @ axis
        for offset in _planes(triangles, heights, axis):
            sides = split(triangles, heights - offset)
            if min(map(len, sides)) == 0:
                continue
            extents = [float(np.ptp(side @ axis)) for side in sides]
            thin = int(extents[1] < extents[0])
            candidates.append((float(_areas(sides[thin]).sum()), sides[thin], sides[1 - thin]))
    for area, board, rest in sorted(candidates, key=lambda item: -item[0]):
        if area < least:
            return None
        chunk = body.chunk(board)
        if chunk.gap <= body.tolerance:
            return chunk, rest
    return None


def _planes(triangles: FloatArray, heights: FloatArray, axis: FloatArray) -> Iterator[float]:
    """Planes on both sides of the largest faces across an axis, those at the ends omitted."""
    low, high = float(heights.min()), float(heights.max())
    extent = high - low
    if extent <= 0.0:
        return
    for level in face_levels(triangles, heights, axis, _SAME * extent, _FACES).tolist():
        for offset in (level - _BESIDE * extent, level + _BESIDE * extent):
            if low + 2.0 * _BESIDE * extent < offset < high - 2.0 * _BESIDE * extent:
                yield offset


def _connected(triangles: FloatArray) -> list[FloatArray]:
    """Triangles (n, 3, 3) by connected piece."""
    corners = triangles.reshape(-1, 3)
    width = max(float(np.ptp(corners, axis=0).max()), 1e-300) * _WELD
    _, welded = np.unique(np.round(corners / width).astype(np.int64), axis=0, return_inverse=True)
    faces = welded.reshape(-1, 3)
    count = int(faces.max()) + 1
    first, second = np.concatenate([faces[:, 0], faces[:, 1]]), np.concatenate([faces[:, 1], faces[:, 2]])
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    owner = label[faces[:, 0]]
    return [triangles[owner == number] for number in np.unique(owner)]


_VERSION = b"3"
"""Changes whenever the same input would be cut differently."""


def cached_cuts(bodies: Sequence[Concave], cuts: int, settings: PrepareSettings) -> list[list[ConvexPiece]]:
    """Return the pieces that `convex_chunks` makes of the surfaces, from an earlier run where there was one.

    Args:
        bodies: The surfaces.
        cuts: For all of them together.
        settings: How many files are kept; 0 keeps none.
    """
    if not bodies:
        return []
    path = cache_folder() / f"{_key(bodies, cuts)}.npz"
    known = _load(path, len(bodies)) if settings.cached_files else None
    if known is not None:
        return known
    found = [[chunk.piece for chunk in chunks] for chunks in convex_chunks(bodies, cuts)]
    if settings.cached_files:
        with suppress(OSError):  # a full or read-only disk costs time only
            _store(path, found, settings.cached_files)
    return found


def cache_folder() -> Path:
    """Return the user's cache folder for cuts; it need not exist."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "kinematify" / "cuts"


def _key(bodies: Sequence[Concave], cuts: int) -> str:
    digest = hashlib.sha256(_VERSION + repr(cuts).encode())
    for body in bodies:
        digest.update(repr((body.tolerance, body.thickness, body.surface.vertices.shape)).encode())
        digest.update(body.surface.vertices.tobytes())
        digest.update(body.surface.faces.tobytes())
    return digest.hexdigest()


def _load(path: Path, bodies: int) -> list[list[ConvexPiece]] | None:
    """Return what was stored; None where there is nothing, or a file that someone damaged."""
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            body, corners, triangles = file["body"], file["corners"], file["triangles"]
            vertices = np.split(file["vertices"], np.cumsum(corners)[:-1])
            faces = np.split(file["faces"], np.cumsum(triangles)[:-1])
        os.utime(path)  # what is used is kept longest
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None
    found: list[list[ConvexPiece]] = [[] for _ in range(bodies)]
    for index, points, triples in zip(body.tolist(), vertices, faces, strict=True):
        found[index].append(ConvexPiece(vertices=points, faces=triples))
    return found


def _store(path: Path, found: Sequence[Sequence[ConvexPiece]], most: int) -> None:
    """Write under another name first: a run beside this one never reads half a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    pieces = [piece for group in found for piece in group]
    with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as file:
        np.savez(
            file,
            body=np.repeat(np.arange(len(found)), [len(group) for group in found]),
            corners=np.array([len(piece.vertices) for piece in pieces]),
            triangles=np.array([len(piece.faces) for piece in pieces]),
            vertices=np.concatenate([piece.vertices for piece in pieces]),
            faces=np.concatenate([piece.faces for piece in pieces]),
        )
    Path(file.name).replace(path)
    oldest_first = sorted(path.parent.glob("*.npz"), key=lambda item: item.stat().st_mtime)
    for item in oldest_first[: max(0, len(oldest_first) - most)]:
        item.unlink(missing_ok=True)
