"""Cuts are kept between runs: the same meshes, cut with the same settings, give the same pieces."""

from __future__ import annotations

import hashlib
import os
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING
from zipfile import BadZipFile

import numpy as np

from kinematify.geometry.boards import convex_chunks
from kinematify.geometry.convex import ConvexPiece

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config.validation import PrepareSettings
    from kinematify.geometry.cut import Concave

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
    """What was stored; None where there is nothing, or a file that someone damaged."""
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
