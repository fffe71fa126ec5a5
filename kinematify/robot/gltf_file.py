"""Geometry of glTF 2.0 files: one mesh per node with all its primitives, node transforms kept apart."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray, IntArray

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC3": 3}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
_HARMLESS = ("KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_", "MSFT_", "KHR_mesh_quantization")
"""Extensions that a file may require without changing how positions are stored."""


@dataclass(frozen=True, kw_only=True, eq=False)
class GltfNode:
    """A node that shows triangles."""

    name: str
    """Of the node, else of its mesh; empty where neither has one."""
    vertices: FloatArray
    """Node frame, shape (V, 3)."""
    faces: IntArray
    """Shape (F, 3)."""
    T_world_node: FloatArray
    """May scale and mirror, shape (4, 4)."""


def read_gltf(path: Path) -> tuple[GltfNode, ...]:
    """Read the nodes with triangles of the default scene, parents before children.

    Args:
        path: A ``.glb``, or a ``.gltf`` whose buffers are inside or beside it.

    Raises:
        OSError: A file cannot be opened.
        ValueError, KeyError, IndexError, TypeError: The file is truncated, malformed or compressed.
    """
    document, binary = _opened(path)
    _check_extensions(document)
    source = _Buffers(document=document, binary=binary, folder=path.parent, loaded={})
    return tuple(_nodes(document, source))


def _opened(path: Path) -> tuple[dict[str, Any], bytes]:
    """The JSON document and the binary chunk."""
    content = path.read_bytes()
    if path.suffix.lower() == ".gltf":
        return json.loads(content.decode("utf-8-sig")), b""
    if len(content) < 20 or content[:4] != b"glTF":
        raise ValueError("it does not begin like a GLB")
    version, length = struct.unpack_from("<II", content, 4)
    if version != 2:
        raise ValueError(f"it is glTF version {version}, only 2 is read")
    if length > len(content):
        raise ValueError(f"it states {length} bytes but has {len(content)}")
    chunks: dict[int, bytes] = {}
    place = 12
    while place + 8 <= length:
        size, kind = struct.unpack_from("<II", content, place)
        chunks.setdefault(kind, content[place + 8 : place + 8 + size])
        place += 8 + size
    return json.loads(chunks[_JSON_CHUNK]), chunks.get(_BINARY_CHUNK, b"")


def _check_extensions(document: dict[str, Any]) -> None:
    needed = [name for name in document.get("extensionsRequired", ()) if not name.startswith(_HARMLESS)]
    needed += [name for name in document.get("extensionsUsed", ()) if name == "EXT_mesh_gpu_instancing"]
    if needed:
        raise ValueError(f"it needs the extension {needed[0]}; export it without compression and instancing")


@dataclass(frozen=True, kw_only=True, eq=False)
class _Buffers:
    """Numbers of a document by the index of their accessor."""

    document: dict[str, Any]
    binary: bytes
    folder: Path
    loaded: dict[int, bytes]

    def numbers(self, index: int) -> NDArray[Any]:
        """Contents of an accessor, shape (count, width); integers that stand for fractions become fractions."""
        accessor = self.document["accessors"][index]
        if "sparse" in accessor:
            raise ValueError("it stores positions as sparse changes, which are not read")
        dtype, width = np.dtype(_COMPONENTS[accessor["componentType"]]), _WIDTHS[accessor["type"]]
        view = self.document["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        strides = (view.get("byteStride") or dtype.itemsize * width, dtype.itemsize)
        # numpy refuses what reaches beyond the buffer, in either direction.
        array: NDArray[Any] = np.ndarray(
            (accessor["count"], width), dtype, self._buffer(view["buffer"]), offset=start, strides=strides
        )
        if accessor.get("normalized") and dtype.kind in "iu":
            return np.maximum(array / np.iinfo(dtype).max, -1.0)
        return array

    def _buffer(self, index: int) -> bytes:
        if index not in self.loaded:
            self.loaded[index] = self._read_buffer(self.document["buffers"][index])
        return self.loaded[index]

    def _read_buffer(self, buffer: dict[str, Any]) -> bytes:
        uri = buffer.get("uri")
        if uri is None:
            return self.binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        path = (self.folder / unquote(uri)).resolve()
        if not path.is_relative_to(self.folder.resolve()):
            raise ValueError(f"its buffer {uri!r} lies outside of its folder")
        if not path.is_file():
            raise ValueError(f"its buffer {uri!r} is not there")  # a pipe or a device would never end
        with path.open("rb") as file:
            return file.read(buffer["byteLength"])


def _nodes(document: dict[str, Any], source: _Buffers) -> Iterator[GltfNode]:
    nodes = document.get("nodes", [])
    waiting = [(index, np.eye(4)) for index in reversed(_roots(document))]
    seen: set[int] = set()
    while waiting:
        index, above = waiting.pop()
        if index in seen:
            raise ValueError("its nodes form no tree")
        seen.add(index)
        node = nodes[index]
        transform = above @ _local_transform(node)
        waiting.extend((child, transform) for child in reversed(node.get("children", [])))
        if "mesh" in node:
            mesh = document["meshes"][node["mesh"]]
            vertices, faces = _merged_primitives(mesh, source)
            if len(faces):
                name = str(node.get("name") or mesh.get("name") or "")
                yield GltfNode(name=name, vertices=vertices, faces=faces, T_world_node=transform)


def _roots(document: dict[str, Any]) -> list[int]:
    if "scenes" in document:
        return list(document["scenes"][document.get("scene", 0)].get("nodes", []))
    nodes = document.get("nodes", [])
    children = {child for node in nodes for child in node.get("children", [])}
    return [index for index in range(len(nodes)) if index not in children]


def _local_transform(node: dict[str, Any]) -> FloatArray:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", (0.0, 0.0, 0.0, 1.0)), dtype=np.float64)
    n = 2.0 / (x * x + y * y + z * z + w * w)
    turn = np.array(
        [
            [1 - n * (y * y + z * z), n * (x * y - z * w), n * (x * z + y * w)],
            [n * (x * y + z * w), 1 - n * (x * x + z * z), n * (y * z - x * w)],
            [n * (x * z - y * w), n * (y * z + x * w), 1 - n * (x * x + y * y)],
        ]
    )
    transform = np.eye(4)
    transform[:3, :3] = turn * np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
    transform[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return transform


def _merged_primitives(mesh: dict[str, Any], source: _Buffers) -> tuple[FloatArray, IntArray]:
    """All triangles of a mesh; its primitives differ by material only. Points and lines are left out."""
    vertices, faces, count = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.int64)], 0
    for primitive in mesh["primitives"]:
        mode = primitive.get("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN):
            continue
        points = source.numbers(primitive["attributes"]["POSITION"]).astype(np.float64)
        indexed = "indices" in primitive
        corners = source.numbers(primitive["indices"]).reshape(-1) if indexed else np.arange(len(points))
        triangles = _triangles(corners.astype(np.int64), mode)
        if len(triangles) and triangles.max() >= len(points):
            raise ValueError("a face refers to a vertex that the file does not hold")
        vertices.append(points)
        faces.append(triangles + count)
        count += len(points)
    return np.concatenate(vertices), np.concatenate(faces)


def _triangles(corners: IntArray, mode: int) -> IntArray:
    if mode == _TRIANGLES:
        return corners.reshape(-1, 3)
    if mode == _FAN:
        return np.stack([np.full(max(len(corners) - 2, 0), corners[0]), corners[1:-1], corners[2:]], axis=1)
    strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    strip[1::2] = strip[1::2, [1, 0, 2]]  # every other triangle runs the other way round
    return strip
