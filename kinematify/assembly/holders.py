"""The structure that an artist or an exporter gave a file: evidence of what is one part, and of its name."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse.csgraph import connected_components

from kinematify.robot.raw_mesh import RawMesh, merged
from kinematify.robot.vectors import box_gaps, referenced
from kinematify.robot.weld import weld

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.appearance import Material
    from kinematify.robot.arrays import FloatArray

    _Path = tuple[tuple[int, str], ...]

_GENERATED = re.compile(
    r"(?:object|mesh|node|geom|geometry|primitive|poly|polysurface|shape|group|component|instance|cube|cylinder|plane"
    r"|sphere|circle|default|material|surface|solid|obj|id|root|scene|g)?(?:[\W_]*[0-9]+|[\W_]*)*",
    re.IGNORECASE,
)
"""Names that programs give to what nobody named."""
_TOUCH = 1e-4
"""Of the diagonal of all: boxes that are nearer touch."""
_SHARED = 0.5
"""Share of a mesh's open edges that others continue, and of meshes of which that is so, from which all are pieces."""
_MANY, _MANY_UNNAMED = 40, 8
"""Meshes from which they are perhaps pieces, with names and without."""


def parts_of_holders(meshes: Sequence[RawMesh]) -> tuple[list[RawMesh], list[str]]:
    """Return one mesh per part that the file names, and what was joined.

    A mesh that nobody named belongs to the innermost node above it that has a name and does not hold all meshes. Such
    meshes of one node are one part where each has a material of its own, as exporters split nodes, or where they touch.
    """
    paths = _paths(meshes)
    count = Counter(node for path in paths for node in set(path))
    groups: dict[tuple[int, str], list[int]] = {}
    for k, path in enumerate(paths):
        named = [node for node in path if count[node] < len(meshes) and not _GENERATED.fullmatch(node[1])]
        own = not named or (named[-1] == path[-1] and not _is_split(meshes[k], tuple(named)))
        holder = (-1 - k, "") if not named else named[-1] if own or named[-1] != path[-1] else named[-2]
        groups.setdefault(holder, []).append(k)
    result: list[tuple[int, RawMesh]] = []
    said = []
    for (_, name), members in groups.items():
        given = [meshes[k] for k in members]
        if len(members) > 1 and (_have_own_materials(given) or _touch(given, meshes)):
            result.append((members[0], replace(merged(given, name), holders=((0, name),))))
            said.append(f"{name} ({', '.join(mesh.holders[-1][1] for mesh in given[:3])}{', ...' * (len(given) > 3)})")
        else:
            keeps = [not name or paths[k][-1][1] == name for k in members]
            result += [
                (k, meshes[k] if kept else replace(meshes[k], name=name))
                for k, kept in zip(members, keeps, strict=True)
            ]
    return [mesh for _, mesh in sorted(result, key=lambda item: item[0])], said


def _paths(meshes: Sequence[RawMesh]) -> list[_Path]:
    """Holders of every mesh; an OBJ group of several words, the first the number of its mesh, is held by the others."""
    words = [mesh.holders[-1][1].split() if mesh.holders else [] for mesh in meshes]
    numbers = [line[0] for line in words if len(line) > 1 and _GENERATED.fullmatch(line[0])]
    if len(set(numbers)) < len(meshes):
        return [mesh.holders or ((0, mesh.name),) for mesh in meshes]
    count = Counter(word for line in words for word in line)
    return [
        (*mesh.holders[:-1], *((0, word) for word in sorted(line, key=lambda word: -count[word])))
        for mesh, line in zip(meshes, words, strict=True)
    ]


def _is_split(mesh: RawMesh, named: _Path) -> bool:
    """Whether a node has the name of the one above it with that of its material, as ``door_wood_0``."""
    if len(named) < 2 or not named[-1][1].startswith(named[-2][1]):
        return False
    rest = named[-1][1].removeprefix(named[-2][1]).strip("_-. 0123456789").casefold()
    return bool(rest) and rest in {item.name.strip("_-. 0123456789").casefold() for item in _materials(mesh)}


def _materials(mesh: RawMesh) -> tuple[Material, ...]:
    return () if mesh.appearance is None else mesh.appearance.materials


def _have_own_materials(meshes: Sequence[RawMesh]) -> bool:
    found = Counter(material for mesh in meshes for material in set(_materials(mesh)))
    return all(_materials(mesh) for mesh in meshes) and max(found.values()) == 1


def _touch(meshes: Sequence[RawMesh], everything: Sequence[RawMesh]) -> bool:
    """Whether the boxes of meshes hang together."""
    boxes, scale = _boxes(meshes), np.linalg.norm(np.ptp(_boxes(everything).reshape(-1, 3), axis=0))
    gaps = box_gaps(boxes[:, 0], boxes[:, 1])
    return bool(connected_components(gaps <= _TOUCH * scale, directed=False)[0] == 1)


def _boxes(meshes: Sequence[RawMesh]) -> FloatArray:
    points = [referenced(mesh.vertices, mesh.faces) for mesh in meshes]
    return np.array([[item.min(axis=0), item.max(axis=0)] for item in points if len(item)])


def why_pieces(meshes: Sequence[RawMesh], tolerance: float) -> str:
    """Return why meshes of one file are pieces of surfaces, not parts; empty where they may be parts.

    Args:
        meshes: At least two.
        tolerance: As for `weld`.
    """
    by_material = all(
        len(_materials(mesh)) == 1 and _materials(mesh)[0].name.casefold() == mesh.name.casefold() for mesh in meshes
    )
    whole = merged(meshes, "")
    vertices, faces, kept = weld(whole.vertices, whole.faces, tolerance)
    owner = np.repeat(np.arange(len(meshes)), [len(mesh.faces) for mesh in meshes])[kept]
    ends = np.sort(np.concatenate([faces[:, :2], faces[:, 1:], faces[:, ::2]]), axis=1)
    edge = ends[:, 0] * len(vertices) + ends[:, 1]
    rows, times = np.unique(np.column_stack([edge, np.tile(owner, 3)]), axis=0, return_counts=True)
    open_edges = rows[times == 1]
    _, place, shared = np.unique(open_edges[:, 0], return_inverse=True, return_counts=True)
    met = np.bincount(open_edges[:, 1], shared[place.reshape(-1)] > 1, len(meshes))
    pieces = met > _SHARED * np.maximum(np.bincount(open_edges[:, 1], minlength=len(meshes)), 1)
    if pieces.mean() > _SHARED:
        return "continue each other along open edges"
    if by_material and pieces.any():
        return "are the faces of one material each"
    return ""


def hint_of_many(meshes: Sequence[RawMesh]) -> list[str]:
    """Propose to group meshes that are perhaps pieces: hundreds, or some that nobody named."""
    unnamed = sum(bool(_GENERATED.fullmatch(mesh.name)) for mesh in meshes)
    if len(meshes) < (_MANY_UNNAMED if 2 * unnamed > len(meshes) else _MANY):
        return []
    said = f"Each of the {len(meshes)} nodes or groups of the file is read as a rigid part."
    return [f"{said} If several of them are one, give --pieces group."]
