"""glTF 2.0 files: one mesh per node with all its primitives and materials, node transforms kept apart."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

from kinematify.robot.appearance import Appearance, Material, joined, linear_of, painted, srgb_of
from kinematify.robot.exact_faces import ExactFaces, joined_faces

if TYPE_CHECKING:
    import re
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.robot.appearance import Texture
    from kinematify.robot.arrays import FloatArray, IntArray

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
_HARMLESS = ("KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_", "MSFT_", "KHR_mesh_quantization")
"""Extensions that a file may require without changing how positions are stored."""
_OLDER = "KHR_materials_pbrSpecularGlossiness"
_DEFAULT = Material(color=(1.0, 1.0, 1.0, 1.0), metallic=1.0, roughness=1.0)
"""What glTF lets a surface look like of which the file says no more."""


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
    appearance: Appearance | None = None
    """None where the file states no material, and where it was not asked for."""
    exact: ExactFaces | None = None
    """Node frame; None where the file states no faces (the extension TM_brep_faces)."""


def read_gltf(path: Path, *, appearance: bool = False, unnamed: re.Pattern[str] | None = None) -> tuple[GltfNode, ...]:
    """Read the nodes with triangles of the default scene, parents before children.

    Args:
        path: A ``.glb``, or a ``.gltf`` whose buffers are inside or beside it.
        appearance: Read materials, textures and colours of vertices too.
        unnamed: Names of nodes that say nothing, whole; the name of the mesh is taken instead.

    Raises:
        OSError: A file cannot be opened.
        ValueError, KeyError, IndexError, TypeError: The file is truncated, malformed or compressed.
    """
    document, binary = _opened(path)
    _check_extensions(document)
    source = _GltfBuffers(document=document, binary=binary, folder=path.parent, loaded={})
    if unnamed is not None:
        for node in document.get("nodes", []):
            if unnamed.fullmatch(str(node.get("name", ""))):
                del node["name"]
    return tuple(_nodes(document, source, _Materials(document, source) if appearance else None))


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
class _GltfBuffers:
    """Numbers of a document by the index of their accessor."""

    document: dict[str, Any]
    binary: bytes
    folder: Path
    loaded: dict[int, bytes]

    def numbers(self, index: int) -> NDArray[Any]:
        """Contents of an accessor, shape (count, width); integers that represent fractions become fractions."""
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

    def content(self, view: int) -> bytes:
        """The bytes of a buffer view."""
        stated = self.document["bufferViews"][view]
        start = stated.get("byteOffset", 0)
        return self._buffer(stated["buffer"])[start : start + stated["byteLength"]]

    def _buffer(self, index: int) -> bytes:
        if index not in self.loaded:
            self.loaded[index] = self._read_buffer(self.document["buffers"][index])
        return self.loaded[index]

    def _read_buffer(self, buffer: dict[str, Any]) -> bytes:
        uri = buffer.get("uri")
        if uri is None:
            return self.binary
        return self.named(uri, "buffer")[: buffer["byteLength"]]

    def named(self, uri: str, what: str) -> bytes:
        """The bytes that an address in the document or beside it represents."""
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        path = (self.folder / unquote(uri)).resolve()
        if not path.is_relative_to(self.folder.resolve()):
            raise ValueError(f"its {what} {uri!r} lies outside of its folder")
        if not path.is_file():
            raise ValueError(f"its {what} {uri!r} is not there")  # a pipe or a device would never end
        return path.read_bytes()


class _Materials:
    """Materials of a document, each read once."""

    def __init__(self, document: dict[str, Any], source: _GltfBuffers) -> None:
        self._document, self._source = document, source
        self._read: dict[int, Material] = {}
        self._textures: dict[int, Texture | str] = {}
        self._notes: dict[int, str] = {}

    def of_primitive(self, primitive: dict[str, Any], corners: IntArray) -> Appearance | None:
        """The appearance of a primitive with these faces, shape (F, 3); None where it states nothing."""
        index, colors = primitive.get("material"), primitive["attributes"].get("COLOR_0")
        if index is None and colors is None:
            return None
        material = _DEFAULT if index is None else self._material(index)
        if colors is not None and material.texture is None:
            return self._painted(colors, corners, material)
        uv = None if index is None or material.texture is None else self._places(primitive, index, corners)
        notes = (self._notes[index],) if index in self._notes else ()
        kept = material if uv is not None else replace(material, texture=None)
        zeros = np.zeros(len(corners), dtype=np.int64)
        return Appearance(materials=(kept,), material_of_face=zeros, uv=uv, notes=notes)

    def _painted(self, accessor: int, corners: IntArray, material: Material) -> Appearance:
        """Colours of vertices, which are linear light, times that of the material, a mean for each face."""
        stated = self._source.numbers(accessor).astype(np.float64)
        light = stated[corners].mean(axis=1)
        opacity = light[:, 3] if light.shape[1] == 4 else np.ones(len(light))
        colors = srgb_of(light[:, :3] * linear_of(np.array(material.color[:3])))
        looks = painted(np.column_stack([colors, opacity * material.color[3]]))
        named = (replace(material, name="", color=one.color) for one in looks.materials)
        return replace(looks, materials=tuple(named))

    def _places(self, primitive: dict[str, Any], index: int, corners: IntArray) -> FloatArray | None:
        """Where the corners lie in the texture, upwards as everywhere but in glTF, shape (F, 3, 2)."""
        stated = _base_color(self._document["materials"][index])[1]
        moved = stated.get("extensions", {}).get("KHR_texture_transform", {})
        number = moved.get("texCoord", stated.get("texCoord", 0))
        accessor = primitive["attributes"].get(f"TEXCOORD_{number}")
        if accessor is None:
            return None
        uv = self._source.numbers(accessor).astype(np.float64)
        turn = moved.get("rotation", 0.0)
        cosine, sine = np.cos(turn), np.sin(turn)
        scaled = uv * np.array(moved.get("scale", (1.0, 1.0)))
        uv = scaled @ np.array([[cosine, -sine], [sine, cosine]]) + np.array(moved.get("offset", (0.0, 0.0)))
        return np.asarray((np.array([0.0, 1.0]) + np.array([1.0, -1.0]) * uv)[corners], dtype=np.float64)

    def _material(self, index: int) -> Material:
        if index not in self._read:
            stated = self._document["materials"][index]
            factor, picture = _base_color(stated)
            surface = stated.get("pbrMetallicRoughness", {})
            metallic = _DEFAULT.metallic if _OLDER not in stated.get("extensions", {}) else 0.0
            red, green, blue = srgb_of(np.array(factor[:3])).tolist()
            opacity = float(factor[3]) if stated.get("alphaMode", "OPAQUE") != "OPAQUE" else 1.0
            self._read[index] = Material(
                name=str(stated.get("name", "")),
                color=(red, green, blue, opacity),
                metallic=float(surface.get("metallicFactor", metallic)),
                roughness=float(surface.get("roughnessFactor", _DEFAULT.roughness)),
                texture=self._texture(index, picture["index"]) if picture else None,
            )
        return self._read[index]

    def _texture(self, material: int, index: int) -> Texture | None:
        from kinematify.robot.material_files import open_texture  # noqa: PLC0415  # opens pictures, most files hold none

        if index not in self._textures:
            stated = self._document["textures"][index]
            number = stated.get("source", stated.get("extensions", {}).get("EXT_texture_webp", {}).get("source"))
            image = {} if number is None else self._document["images"][number]
            name = str(image.get("name") or image.get("uri", "")[:40] or f"texture {index}")
            try:
                view = image.get("bufferView")
                content = (
                    self._source.content(view) if view is not None else self._source.named(image["uri"], "texture")
                )
                self._textures[index] = open_texture(name, content)
            except (ValueError, KeyError) as error:
                self._textures[index] = f"the texture {name} cannot be read: {error}"
        found = self._textures[index]
        if isinstance(found, str):
            self._notes[material] = found
            return None
        return found


def _base_color(material: dict[str, Any]) -> tuple[list[float], dict[str, Any]]:
    """Linear colour with opacity of a material, and its texture; of its older way to say it where it uses that."""
    older = material.get("extensions", {}).get(_OLDER)
    if older is not None:
        return older.get("diffuseFactor", [1.0, 1.0, 1.0, 1.0]), older.get("diffuseTexture", {})
    surface = material.get("pbrMetallicRoughness", {})
    return surface.get("baseColorFactor", [1.0, 1.0, 1.0, 1.0]), surface.get("baseColorTexture", {})


def _nodes(document: dict[str, Any], source: _GltfBuffers, materials: _Materials | None) -> Iterator[GltfNode]:
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
            vertices, faces, appearance = _merged_primitives(mesh, source, materials)
            if len(faces):
                yield GltfNode(
                    name=str(node.get("name") or mesh.get("name") or ""),
                    vertices=vertices,
                    faces=faces,
                    T_world_node=transform,
                    appearance=appearance,
                    exact=joined_faces([_exact_faces(primitive) for primitive in mesh["primitives"]]),
                )


def _exact_faces(primitive: dict[str, Any]) -> ExactFaces | None:
    stated = primitive.get("extensions", {}).get("TM_brep_faces", {}).get("faces")
    if stated is None:
        return None
    cylinders = [face for face in stated if face and face.get("type") == "cylinder"]
    planes = [face for face in stated if face and face.get("type") == "plane"]
    return ExactFaces(
        axes=np.array([face["axis"] for face in cylinders]),
        points=np.array([face["origin"] for face in cylinders]),
        normals=np.array([face["normal"] for face in planes]),
    )


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


def _merged_primitives(
    mesh: dict[str, Any], source: _GltfBuffers, materials: _Materials | None
) -> tuple[FloatArray, IntArray, Appearance | None]:
    """All triangles of a mesh; its primitives differ by material only. Points and lines are omitted."""
    vertices, faces, count = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.int64)], 0
    looks: list[Appearance | None] = []
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
        looks.append(materials.of_primitive(primitive, triangles) if materials is not None else None)
        count += len(points)
    return np.concatenate(vertices), np.concatenate(faces), joined(looks, [len(item) for item in faces[1:]])


def _triangles(corners: IntArray, mode: int) -> IntArray:
    if mode == _TRIANGLES:
        return corners.reshape(-1, 3)
    if mode == _FAN:
        return np.stack([np.full(max(len(corners) - 2, 0), corners[0]), corners[1:-1], corners[2:]], axis=1)
    strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    strip[1::2] = strip[1::2, [1, 0, 2]]  # every other triangle runs the other way round
    return strip
