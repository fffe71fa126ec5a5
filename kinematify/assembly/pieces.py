"""One mesh that holds several parts: cut by labels per face, or into its connected pieces."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kinematify.errors import AssemblyError
from kinematify.robot.appearance import joined
from kinematify.robot.mesh_file import RawMesh, compacted
from kinematify.robot.weld import weld

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import RigidGroup, Robot


_WELD = 1e-9
"""Vertices closer than this fraction of their mesh's diagonal are one: equal but for rounding."""


def baked(robot: Robot, group: RigidGroup, T_world_link: Mapping[str, FloatArray]) -> RawMesh:
    """Return all meshes of a group that has geometry as one, in the world frame [m].

    It is named after the group's first link with geometry: those above it are frames such as ``world``.

    Args:
        robot: The robot.
        group: One of its rigid groups.
        T_world_link: Pose of every link, shape (4, 4).
    """
    name = next(link for link in group.links if robot.link_by_name[link].has_geometry)
    vertices, faces, looks, count = [], [], [], 0
    for link in group.links:
        transform = T_world_link[link]
        for mesh in robot.link_by_name[link].meshes:
            # Welded in the link frame, where equal vertices are still equal to the last digit.
            points, triangles, kept = weld(mesh.vertices, mesh.faces, _WELD)
            vertices.append(points @ transform[:3, :3].T + transform[:3, 3])
            faces.append(triangles + count)
            looks.append(None if mesh.appearance is None else mesh.appearance.of_faces(kept))
            count += len(points)
    return RawMesh(
        name=name,
        vertices=np.concatenate(vertices),
        faces=np.concatenate(faces),
        appearance=joined(looks, [len(part) for part in faces]),
    )


def labelled_parts(mesh: RawMesh, labels: Path) -> tuple[RawMesh, ...]:
    """Return one mesh per label, in natural order of the labels.

    Args:
        mesh: Triangles in the order of the file.
        labels: ``.npy`` with F integers, or ``.json`` with a list of F integers or texts (or an object with this list
            under ``labels``). Text labels name the parts; integers give ``part_<label>``.

    Raises:
        AssemblyError: The file cannot be read, or has not one label per triangle.
    """
    values = _read_labels(labels)
    if values.shape != (len(mesh.faces),):
        raise AssemblyError(
            f"The labels {labels} have the shape {values.shape}, but the mesh has {len(mesh.faces)} triangles. Give "
            "one label per triangle, in the order of the file; polygons count as their triangles."
        )
    distinct, index = np.unique(values, return_inverse=True)
    prefix = "" if values.dtype.kind == "U" else "part_"
    return _split(mesh, index, [f"{prefix}{label}" for label in distinct.tolist()])


def _read_labels(path: Path) -> NDArray[Any]:
    if path.name.endswith(".truth.json") or path.suffix.lower() not in (".npy", ".json"):
        raise AssemblyError(f"The labels {path} are no labels file. Give a .npy or .json with one label per triangle.")
    try:
        values = np.load(path, allow_pickle=False) if path.suffix.lower() == ".npy" else _json_labels(path)
    except (OSError, ValueError, EOFError) as error:
        raise AssemblyError(
            f"The labels {path} cannot be read ({error}). Write them with numpy.save, or as a JSON list."
        ) from error
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "iuU":
        raise AssemblyError(f"The labels {path} must be integers, or texts in a JSON file: they name the parts.")
    return values


def _json_labels(path: Path) -> NDArray[Any]:
    values = json.loads(path.read_text(encoding="utf-8"))
    if isinstance(values, dict):
        values = values.get("labels")
    if not isinstance(values, list) or len({type(value) for value in values}) > 1:
        raise ValueError("expected a list of labels of one kind")
    return np.array(values)


def connected_pieces(mesh: RawMesh, tolerance: float) -> tuple[RawMesh, ...]:
    """Return the pieces of a mesh that share no vertex, in the order of their first triangle.

    Args:
        mesh: Any mesh with finite vertices; it is welded first, because many formats store corners per triangle.
        tolerance: Fraction of the mesh's diagonal below which vertices are one.
    """
    vertices, faces, kept = weld(mesh.vertices, mesh.faces, tolerance)
    _, first, piece = np.unique(_piece_of_face(faces, len(vertices)), return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    names = [f"piece_{k:03d}" for k in range(len(first))]
    return _split(replace(mesh.of_faces(kept), vertices=vertices, faces=faces), rank[piece], names)


def _split(mesh: RawMesh, index: IntArray, names: Sequence[str]) -> tuple[RawMesh, ...]:
    """One mesh per name, made of the faces with its index; one pass, since there may be thousands."""
    order = np.argsort(index, kind="stable")
    ends = np.cumsum(np.bincount(index, minlength=len(names)))[:-1]
    return tuple(
        compacted(replace(mesh.of_faces(part), name=name))
        for name, part in zip(names, np.split(order, ends), strict=True)
    )


def _piece_of_face(faces: IntArray, n_vertices: int) -> IntArray:
    ends = np.concatenate([faces[:, :2], faces[:, 1:]])
    links = coo_array((np.ones(len(ends), dtype=np.int8), (ends[:, 0], ends[:, 1])), shape=(n_vertices, n_vertices))
    label: IntArray = connected_components(links, directed=False)[1].astype(np.int64)
    return label[faces[:, 0]]
