"""STL and PLY files, by trimesh, with polygons cut again; binary STL by numpy, without loading trimesh; OFF."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import AssemblyError
from kinematify.robot.appearance import Appearance, Material, of_one, painted
from kinematify.robot.polygons import triangle_places
from kinematify.robot.raw_mesh import RawMesh

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.robot.arrays import IntArray

_HEADER = 84
"""Bytes before the triangles of a binary STL; the last four are their number."""
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_general(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read an STL, PLY or OFF; polygons are cut again, as trimesh makes fans of them.

    Raises:
        AssemblyError: It is a point cloud.
        OSError, ValueError: It cannot be read.
    """
    content, suffix = path.read_bytes(), path.suffix.lower()
    count = int.from_bytes(content[80:84], "little")
    if suffix == ".stl" and count and len(content) == _HEADER + count * _TRIANGLE.itemsize:
        corners = np.frombuffer(content, _TRIANGLE, offset=_HEADER)["corners"].reshape(-1, 3)
        faces = np.arange(3 * count, dtype=np.int64).reshape(-1, 3)
        return (RawMesh(name=path.name, vertices=corners.astype(np.float64), faces=faces),)
    if suffix == ".off":
        return (_off(path, content),)
    import trimesh  # noqa: PLC0415  # takes longer than reading a binary STL

    # Without `process` no vertex is merged, so that faces keep their order and labels per face stay valid.
    scene = trimesh.load_scene(path, file_type=suffix[1:], process=False, skip_materials=not appearance)
    if scene.geometry and all(isinstance(item, trimesh.PointCloud) for item in scene.geometry.values()):
        raise AssemblyError(f"The file {path} is a point cloud, which has no surface. Make a mesh of it first.")
    meshes = []
    for name, item in scene.geometry.items():
        vertices, faces = np.asarray(item.vertices, dtype=np.float64), np.asarray(item.faces, dtype=np.int64)
        mesh, polygons = RawMesh(name=str(name), vertices=vertices, faces=faces), _polygons(item)
        ears = max(map(len, polygons), default=3) > 3 and item.visual.kind != "texture"
        mesh = _cut(mesh, polygons) if ears else mesh
        looks = (
            _appearance(item.visual, mesh.faces) if appearance and (item.visual.kind != "face" or not ears) else None
        )
        meshes.append(replace(mesh, appearance=looks))
    empty = content == content[:80] + bytes(4) or (content.startswith(b"solid") and b"facet" not in content)
    if suffix == ".stl" and not meshes and not empty:
        raise ValueError("it is neither a binary STL of the length that it states nor a complete ASCII one")
    return tuple(meshes)


def _off(path: Path, content: bytes) -> RawMesh:
    """An OFF with numbers in ASCII, at whose polygons of more than four corners trimesh 5.2 fails."""
    words = (line.partition("#")[0].split() for line in content.decode("utf-8-sig", "replace").splitlines())
    lines = [line for line in words if line]
    if not lines or not lines[0][0].endswith("OFF"):
        raise ValueError("it does not begin like an OFF")
    count, polygons = map(int, (lines[0][1:] or lines.pop(1))[:2])
    vertices = np.array([line[:3] for line in lines[1 : 1 + count]], dtype=np.float64).reshape(count, 3)
    rows = [np.array(line, dtype=np.float64).astype(np.int64) for line in lines[1 + count :][:polygons]]
    if len(rows) != polygons or any(len(row) <= row[0] for row in rows):
        raise ValueError(f"it states {polygons} faces but has fewer")
    return _cut(RawMesh(name=path.name, vertices=vertices, faces=_NONE), [row[1 : 1 + row[0]] for row in rows])


_NONE = np.empty((0, 3), dtype=np.int64)


def _cut(mesh: RawMesh, polygons: Sequence[Any]) -> RawMesh:
    """The mesh with the triangles of polygons, each an array of vertices, as faces."""
    corners = np.concatenate([np.empty(0), *polygons]).astype(np.int64)
    sizes = np.array([len(polygon) for polygon in polygons], dtype=np.int64)
    return replace(mesh, faces=corners[triangle_places(mesh.vertices[corners], sizes)])


def _polygons(item: Any) -> Sequence[Any]:
    """Vertices of every polygon of a PLY, which trimesh has cut into fans; none of other files."""
    data: Any = item.metadata.get("_ply_raw", {}).get("face", {}).get("data")
    names = data.dtype.names or () if isinstance(data, np.ndarray) else data or ()
    lists: Any = next((data[name] for name in names if name.startswith("vertex_ind")), ())
    polygons: Sequence[Any] = lists["f1"] if getattr(getattr(lists, "dtype", None), "names", None) else lists
    return polygons


def _appearance(visual: Any, faces: IntArray) -> Appearance | None:
    """Texture or colours that trimesh found; None where the file states none."""
    picture = getattr(getattr(visual, "material", None), "image", None)
    if picture is not None and getattr(visual, "uv", None) is not None:
        from kinematify.robot.material_files import texture_of  # noqa: PLC0415  # opens pictures, most files have none

        material = Material(color=(1.0, 1.0, 1.0, 1.0), texture=texture_of("texture", picture))
        uv = np.asarray(visual.uv, dtype=np.float64)[faces][..., :2]
        return of_one(material, len(faces), uv)
    if visual.kind == "face":
        return painted(np.asarray(visual.face_colors, dtype=np.float64) / 255.0)
    if visual.kind == "vertex":
        return painted((np.asarray(visual.vertex_colors, dtype=np.float64) / 255.0)[faces].mean(axis=1))
    return None
