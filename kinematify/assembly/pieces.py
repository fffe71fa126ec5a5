"""One mesh that holds several parts: cut by labels per face, or into its connected pieces."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kinematify.errors import AssemblyError
from kinematify.robot.raw_mesh import RawMesh, compacted, merged
from kinematify.robot.vectors import crossed, lengths_of, triangle_normals
from kinematify.robot.weld import weld

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray
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
    found = []
    for link in group.links:
        transform = T_world_link[link]
        for mesh in robot.link_by_name[link].meshes:
            # Welded in the link frame, where equal vertices are still equal to the last digit.
            points, triangles, kept = weld(mesh.vertices, mesh.faces, _WELD)
            looks = mesh.appearance and mesh.appearance.of_faces(kept)
            welded = RawMesh(name=name, vertices=points, faces=triangles, appearance=looks)
            found.append(welded.moved(transform[:3, :3], transform[:3, 3]))
    return merged(found, name)


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
    return _split(mesh, index, [f"{'' if values.dtype.kind == 'U' else 'part_'}{label}" for label in distinct.tolist()])


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
    corners = _components(faces[:, :2].reshape(-1), faces[:, 1:].reshape(-1), len(vertices))
    return _pieces(mesh, (vertices, faces, kept), corners[faces[:, 0]])


def connected_sheets(mesh: RawMesh, tolerance: float, *, cut: bool = False) -> tuple[RawMesh, ...]:
    """Return the connected sheets of a mesh, in the order of their first triangle; arguments as above.

    Faces are connected across edges that two of them share. An edge of more faces is where two shells touch or boards
    meet, and separates them; a sheet that is too small to be a part joins the one with which it shares most of them.
    Coincident faces (double-sided meshes) count as one. With `cut`, closed surfaces are cut where they fold inwards, as
    in the grooves and steps around a door that is drawn on its body.
    """
    vertices, faces, kept = weld(mesh.vertices, mesh.faces, tolerance)
    return _pieces(mesh, (vertices, faces, kept), sheet_of_faces(vertices, faces, cut=cut))


def _pieces(mesh: RawMesh, welded: tuple[FloatArray, IntArray, IntArray], label: IntArray) -> tuple[RawMesh, ...]:
    """One mesh per label of the faces of a welded mesh, in the order of their first triangle."""
    vertices, faces, kept = welded
    _, first, piece = np.unique(label, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    names = [f"piece_{k:03d}" for k in range(len(first))]
    return _split(replace(mesh.of_faces(kept), vertices=vertices, faces=faces), rank[piece], names)


def _split(mesh: RawMesh, index: IntArray, names: Sequence[str]) -> tuple[RawMesh, ...]:
    """One mesh per name, made of the faces with its index; one pass, since there may be thousands."""
    order = np.argsort(index, kind="stable")
    ends = np.cumsum(np.bincount(index, minlength=len(names)))[:-1]
    return tuple(
        compacted(replace(mesh.of_faces(part), name=name))
        for name, part in zip(names, np.split(order, ends), strict=False)  # no face: no name, one empty part
    )


def _inward(corners: FloatArray, normals: FloatArray, sheet: IntArray, one: IntArray, other: IntArray) -> BoolArray:
    """Test whether a closed surface folds inwards by more than `_FOLD` between two faces each, shape (n,).

    Args:
        corners: Of all faces, shape (F, 3, 3).
        normals: Of any length, shape (F, 3).
        sheet: Of every face, shape (F,); one with a negative volume has normals that point inwards.
        one: Faces, shape (n,).
        other: Their neighbours, shape (n,).
    """
    volume = np.bincount(sheet, (corners[:, 0] * crossed(corners[:, 1], corners[:, 2])).sum(axis=1))
    sides = np.bincount(sheet[one], minlength=len(volume)) * 2 == np.bincount(sheet, minlength=len(volume)) * 3
    lengths = np.maximum(lengths_of(normals), 1e-300)
    bent = (normals[one] * normals[other]).sum(axis=1) < np.cos(_FOLD) * lengths[one] * lengths[other]
    beyond = (normals[one] * (corners[other].mean(axis=1) - corners[one].mean(axis=1))).sum(axis=1)
    return np.asarray(bent & sides[sheet[one]] & (beyond * np.sign(volume[sheet[one]]) > 0.0))


_FOLD = np.radians(15.0)
"""Angle between faces from which an inward fold is an edge, not a part of something round."""
_SMALL_SHEET = 0.01
"""Share of the whole surface below which a sheet that others share edges with is none of its own."""


def sheet_of_faces(vertices: FloatArray, faces: IntArray, *, cut: bool = False) -> IntArray:
    """Connected sheet of every face, shape (F,), as described in `connected_sheets`.

    Args:
        vertices: Welded, shape (V, 3).
        faces: Shape (F, 3).
        cut: Whether inward folds of closed surfaces separate as well.
    """
    if not len(faces):
        return np.empty(0, dtype=np.int64)
    _, first, same = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_inverse=True)
    single = faces[first]
    ends = np.sort(np.concatenate([single[:, :2], single[:, 1:], single[:, ::2]]), axis=1)
    key = ends[:, 0] * (int(faces.max()) + 1) + ends[:, 1]
    order = np.argsort(key, kind="stable")
    face = np.concatenate([np.arange(len(single))] * 3)[order]
    begins = np.append(True, np.diff(key[order]) != 0)
    starts = np.flatnonzero(begins)
    counts = np.diff(np.append(starts, len(key)))
    pairs = starts[counts == 2]
    sheet = _components(face[pairs], face[pairs + 1], len(single))
    corners = vertices[single]
    normals = triangle_normals(corners)
    areas = 0.5 * lengths_of(normals)
    folds = pairs[_inward(corners, normals, sheet, face[pairs], face[pairs + 1])] if cut else pairs[:0]
    sheet = _components(face[np.setdiff1d(pairs, folds)], face[np.setdiff1d(pairs, folds) + 1], len(single))
    later = np.flatnonzero(~begins & (np.repeat(counts, counts) > 2))
    second = np.concatenate([later, later, folds + 1])
    one = sheet[face[np.concatenate([later - 1, np.repeat(starts, counts)[later], folds])]]
    other, lengths = sheet[face[second]], lengths_of(np.diff(vertices[ends[order][second]], axis=1)[:, 0])
    joined_to = _small_ones_joined(one, other, lengths, np.bincount(sheet, areas).astype(np.float64))
    return np.asarray(joined_to[sheet][same.reshape(-1)], dtype=np.int64)


def _small_ones_joined(one: IntArray, other: IntArray, lengths: FloatArray, areas: FloatArray) -> IntArray:
    """Sheet that every sheet becomes when small ones join the neighbour with which they share the longest edges.

    Args:
        one: Sheet at each common edge, shape (n,).
        other: Another sheet there, shape (n,).
        lengths: Of the edges [m], shape (n,).
        areas: Of the sheets [m^2], shape (k,).
    """
    count = len(areas)
    root = np.arange(count)
    while True:
        a, b = root[one], root[other]
        apart = a != b
        key, place = np.unique(np.minimum(a, b)[apart] * count + np.maximum(a, b)[apart], return_inverse=True)
        shared = np.bincount(place.reshape(-1), lengths[apart])
        a, b = key // count, key % count
        small = np.bincount(root, areas, minlength=count) < _SMALL_SHEET * areas.sum()
        source = np.concatenate([a[small[a]], b[small[b]]])
        if not len(source):
            return root
        target = np.concatenate([b[small[a]], a[small[b]]])
        order = np.lexsort((-np.concatenate([shared[small[a]], shared[small[b]]]), source))
        best = order[np.append(True, np.diff(source[order]) != 0)]
        root = _components(source[best], target[best], count)[root]


def _components(one: IntArray, other: IntArray, count: int) -> IntArray:
    """Component of each of `count` nodes that edges connect, shape (count,)."""
    links = coo_array((np.ones(len(one), dtype=np.int8), (one, other)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)
