"""COLLADA files, by pycollada: one mesh per node with all its pieces and materials, in metres.

Not by trimesh, which reads with pycollada too: it cuts polygons into fans and loses the names of nodes.
"""

from __future__ import annotations

import io
import itertools
from dataclasses import replace
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np
from collada import Collada, DaeError
from collada.material import Map
from collada.polylist import Polylist
from collada.scene import ControllerNode, GeometryNode, Node
from collada.triangleset import TriangleSet
from lxml import etree

from kinematify.robot.appearance import Appearance, Material, of_one, painted
from kinematify.robot.polygons import triangle_places
from kinematify.robot.raw_mesh import RawMesh, merged

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray

    _Found = tuple[Any, FloatArray, tuple[tuple[int, str], ...]]
    """A node with geometry, its transform, and the nodes that hold it."""


def read_collada(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read the nodes that show triangles; up is what the file states, empty where it is silent.

    Raises:
        OSError, ValueError, collada.DaeError: It cannot be read.
    """
    content = path.read_bytes()
    document, found = _opened(content)
    if not any(isinstance(node, GeometryNode) for node, _, _ in found):
        # What is bound to a material that the file does not hold is dropped with it.
        tree = etree.fromstring(content, etree.XMLParser(resolve_entities=False, no_network=True))
        etree.strip_elements(tree, "{*}bind_material", with_tail=False)
        document, found = _opened(etree.tostring(tree))
    looks: dict[str, tuple[Material, tuple[str, ...]]] = {}
    pieces: dict[tuple[tuple[int, str], ...], list[RawMesh]] = {}
    unread = [f"the skin {node.controller.id}" for node, _, _ in found if isinstance(node, ControllerNode)]
    unread += ["holes of polygons"] if b"<ph>" in content else []
    for node, transform, holders in found:
        for piece in node.geometry.primitives if isinstance(node, GeometryNode) else ():
            if not isinstance(piece, (Polylist, TriangleSet)):
                unread.append("lines")
            elif piece.vertex is not None:
                mesh = _piece(piece, node, looks if appearance else None, path)
                pieces.setdefault(holders, []).append(mesh.placed(transform))
    asset = document.assetInfo
    unit = 1.0 if asset.unitmeter is None else float(asset.unitmeter)
    up = asset.upaxis if asset.upaxis in ("X_UP", "Y_UP") else ""
    notes = tuple(dict.fromkeys(unread))
    return tuple(
        replace(merged(items, holders[-1][1]), up=up, holders=holders, notes=notes).moved(unit * np.eye(3))
        for holders, items in pieces.items()
    )


def _opened(content: bytes) -> tuple[Collada, list[_Found]]:
    document = Collada(io.BytesIO(content), ignore=[DaeError])
    scene = document.scene or next(iter(document.scenes), None)
    numbers = itertools.count(1)
    return document, [item for node in (scene.nodes if scene else ()) for item in _nodes(node, np.eye(4), (), numbers)]


def _nodes(
    node: Any, above: FloatArray, holders: tuple[tuple[int, str], ...], numbers: Iterator[int]
) -> Iterator[_Found]:
    """Nodes with geometry; what is instanced twice is held by two."""
    if not isinstance(node, Node):
        yield node, above, holders or ((0, ""),)
        return
    own = (*holders, (next(numbers), node.xmlnode.get("name") or node.id or ""))
    for child in node.children or ():
        yield from _nodes(child, np.dot(above, node.matrix), own, numbers)


def _piece(
    piece: Polylist | TriangleSet,
    node: GeometryNode,
    looks: dict[str, tuple[Material, tuple[str, ...]]] | None,
    path: Path,
) -> RawMesh:
    """A set of polygons of one material; its appearance where `looks` collects materials."""
    corners = np.asarray(piece.vertex_index).reshape(-1)
    sizes = np.asarray(piece.vcounts, dtype=np.int64) if isinstance(piece, Polylist) else np.full(len(corners) // 3, 3)
    places = triangle_places(np.asarray(piece.vertex, dtype=np.float64)[corners], sizes)
    # Vertices in the order in which faces use them.
    used, first, index = np.unique(corners[places].reshape(-1), return_index=True, return_inverse=True)
    order = np.argsort(first)
    vertices = np.asarray(piece.vertex, dtype=np.float64)[used[order]]
    faces = np.argsort(order)[index].reshape(-1, 3)
    found: Appearance | None = None
    bound = next((item.target for item in node.materials if item.symbol == piece.material), None)
    colors = piece.sources.get("COLOR")
    if looks is not None and bound is not None:
        if bound.id not in looks:
            looks[bound.id] = _material(bound.effect, path)
        material, notes = looks[bound.id]
        uv = None
        if material.texture is not None and piece.texcoordset:
            uv = piece.texcoordset[0][np.asarray(piece.texcoord_indexset[0]).reshape(-1)[places]][..., :2]
        found = of_one(material, len(faces), uv, notes)
    elif looks is not None and colors and len(faces):
        rows = np.asarray(piece.index).reshape(len(corners), -1)[:, colors[0][0]]
        stated = np.asarray(colors[0][4].data)[rows[places]].mean(axis=1)
        found = painted(np.column_stack([stated[:, :3], stated[:, 3] if stated.shape[1] > 3 else np.ones(len(stated))]))
    return RawMesh(name="", vertices=vertices, faces=faces, appearance=found)


def _material(effect: Any, path: Path) -> tuple[Material, tuple[str, ...]]:
    """Colour, opacity and texture of an effect, and what of it cannot be read."""
    from kinematify.robot.material_files import named_texture  # noqa: PLC0415  # opens pictures, most files name none

    notes: list[str] = []
    color, texture = np.ones(4), None
    if isinstance(effect.diffuse, Map):
        texture = named_texture(unquote(effect.diffuse.sampler.surface.image.path), path.parent, notes)
    elif effect.diffuse is not None:
        color[: len(effect.diffuse)] = effect.diffuse
    if effect.transparent is not None and not isinstance(effect.transparent, Map):
        color[3] = effect.transparent[3]
    # In steps of a byte, as pictures have them.
    red, green, blue, opacity = (np.round(255.0 * np.clip(color, 0.0, 1.0)) / 255.0).tolist()
    return Material(color=(red, green, blue, opacity), texture=texture), tuple(notes)
