"""STL files: nearly all are binary, which numpy reads at once; trimesh reads ASCII."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.raw_mesh import RawMesh

if TYPE_CHECKING:
    from pathlib import Path

_HEADER = 84
"""Bytes before the triangles of a binary STL; the last four are their number."""
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read the solids of an STL, which has no `appearance`.

    Raises:
        OSError, ValueError: It cannot be read.
    """
    content = path.read_bytes()
    count = int.from_bytes(content[80:84], "little")
    if count and len(content) == _HEADER + count * _TRIANGLE.itemsize:
        corners = np.frombuffer(content, _TRIANGLE, offset=_HEADER)["corners"].reshape(-1, 3)
        faces = np.arange(3 * count, dtype=np.int64).reshape(-1, 3)
        return (RawMesh(name=path.name, vertices=corners.astype(np.float64), faces=faces),)
    import trimesh  # noqa: PLC0415  # takes longer than reading a binary file

    solids = trimesh.load_scene(path, file_type="stl", process=False).geometry
    meshes = tuple(
        RawMesh(
            name=str(name),
            vertices=np.asarray(solid.vertices, dtype=np.float64),
            faces=np.asarray(solid.faces, dtype=np.int64),
        )
        for name, solid in solids.items()
    )
    empty = content == content[:80] + bytes(4) or (content.startswith(b"solid") and b"facet" not in content)
    if not meshes and not empty:
        raise ValueError("it is neither a binary STL of the length that it states nor a complete ASCII one")
    return meshes
