"""glTF 2.0 files: one mesh per node with all its primitives and materials, one per joint of a skin.

Read by itself because trimesh 5.2 reads less, and does not say so: sparse accessors as zeros, normalised integers
without their scale, fans, skins, weights of morph targets, instances, and textures that are moved or use a second set
of coordinates not at all. pygltflib would replace `json.loads` alone. DracoPy and meshopt decode what is compressed.
"""

from __future__ import annotations

import base64
import importlib
import json
import struct
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

from kinematify.robot.appearance import Appearance, Material, joined, linear_of, of_one, painted, srgb_of
from kinematify.robot.exact_faces import ExactFaces, joined_faces
from kinematify.robot.raw_mesh import RawMesh, compacted, merged
from kinematify.robot.transforms import rotation_from_quaternion
from kinematify.versions import require

if TYPE_CHECKING:
    import re
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.robot.appearance import Texture
    from kinematify.robot.arrays import FloatArray, IntArray

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
_HARMLESS = (
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_xmp",
    "EXT_texture_",
    "MSFT_",
    "KHR_mesh_quantization",
)
"""Extensions that a file may require without changing how positions are stored."""
_DRACO = "KHR_draco_mesh_compression"
_MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")
_INSTANCES = "EXT_mesh_gpu_instancing"
_READ = (*_HARMLESS, _DRACO, *_MESHOPT, _INSTANCES, "TM_brep_faces")
_OLDER = "KHR_materials_pbrSpecularGlossiness"
_DEFAULT = Material(color=(1.0, 1.0, 1.0, 1.0), metallic=1.0, roughness=1.0)
"""What glTF lets a surface look like of which the file says no more."""
_MOST = 50_000_000
"""Rows of an accessor without data of its own, which a few bytes could state."""


def read_gltf(path: Path, *, appearance: bool = False, unnamed: re.Pattern[str] | None = None) -> tuple[RawMesh, ...]:
    """Read the nodes with triangles of the default scene, parents before children; the rigid parts of skins last.

    Args:
        path: A ``.glb``, or a ``.gltf`` whose buffers are inside or beside it.
        appearance: Read materials, textures and colours of vertices too.
        unnamed: Names of nodes that say nothing, whole; the name of the mesh is taken instead.

    Raises:
        EnvironmentFault: It is compressed, and the decoder is not installed.
        OSError: A file cannot be opened.
        ValueError, KeyError, IndexError, TypeError: The file is truncated or malformed, or needs what is not read.
    """
    document, binary = _opened(path)
    needed = [name for name in document.get("extensionsRequired", ()) if not name.startswith(_READ)]
    if needed:
        raise ValueError(f"it needs the extension {needed[0]}, which is not read; export it without")
    source = _GltfBuffers(document=document, binary=binary, folder=path.parent, loaded={})
    for node in document.get("nodes", []):
        if unnamed is not None and unnamed.fullmatch(str(node.get("name", ""))):
            node.pop("name", None)
    meshes = tuple(_nodes(document, source, _Materials(document, source) if appearance else None))
    unread = [f"the extension {name}" for name in document.get("extensionsUsed", ()) if not name.startswith(_READ)]
    for what in ("animations", "scenes"):
        count = len(document.get(what, ())) - (what == "scenes")
        unread += [f"{count} {'other ' * (what == 'scenes')}{what}"] if count > 0 else []
    modes = {one.get("mode", _TRIANGLES) for mesh in document.get("meshes", ()) for one in mesh["primitives"]}
    unread += ["points and lines"] if modes - {_TRIANGLES, _STRIP, _FAN} else []
    return tuple(replace(mesh, notes=(*mesh.notes, *unread)) for mesh in meshes)


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


def _decoder(package: str, extension: str) -> Any:
    require(f"The extension {extension} of a glTF file (or export it without compression)", package)
    return importlib.import_module(package)


@dataclass(frozen=True, kw_only=True, eq=False)
class _GltfBuffers:
    """Numbers of a document by the index of their accessor."""

    document: dict[str, Any]
    binary: bytes
    folder: Path
    loaded: dict[int, bytes]
    """Buffers, and unpacked buffer views by -1 - index."""
    decoded: dict[int, NDArray[Any]] = field(default_factory=dict)
    """Accessors whose values Draco held."""

    def decode(self, primitive: dict[str, Any]) -> None:
        """Unpack the accessors of a primitive that is compressed with Draco."""
        packed = primitive.get("extensions", {}).get(_DRACO)
        if packed is None or "bufferView" in self.document["accessors"][primitive["attributes"]["POSITION"]]:
            return  # what is there plainly, too, needs no decoder
        mesh = _decoder("DracoPy", _DRACO).decode(bytes(self.content(packed["bufferView"])))
        values = {item["unique_id"]: item["data"] for item in mesh.attributes}
        for name, number in packed["attributes"].items():
            self.decoded[primitive["attributes"][name]] = np.reshape(values[number], (len(values[number]), -1))
        if "indices" in primitive:
            self.decoded[primitive["indices"]] = np.reshape(mesh.faces, (-1, 1))

    def numbers(self, index: int) -> NDArray[Any]:
        """Contents of an accessor, shape (count, width); integers that represent fractions become fractions."""
        accessor = self.document["accessors"][index]
        dtype, width, count = (
            np.dtype(_COMPONENTS[accessor["componentType"]]),
            _WIDTHS[accessor["type"]],
            accessor["count"],
        )
        if index in self.decoded:
            array = self.decoded[index]
        elif "bufferView" in accessor:
            array = self._rows(accessor, dtype, count, width)
        elif count <= _MOST:
            array = np.zeros((count, width), dtype)
        else:
            raise ValueError(f"it states {count} values without data")
        sparse = accessor.get("sparse")
        if sparse:
            at = self._rows(
                sparse["indices"], np.dtype(_COMPONENTS[sparse["indices"]["componentType"]]), sparse["count"], 1
            )
            array = array.copy()
            array[at[:, 0]] = self._rows(sparse["values"], dtype, sparse["count"], width)
        if accessor.get("normalized") and dtype.kind in "iu":
            return np.maximum(array / np.iinfo(dtype).max, -1.0)
        return array

    def _rows(self, stated: dict[str, Any], dtype: np.dtype[Any], count: int, width: int) -> NDArray[Any]:
        """What an accessor, or a part of a sparse one, finds in its buffer view."""
        view = self.document["bufferViews"][stated["bufferView"]]
        strides = (view.get("byteStride") or dtype.itemsize * width, dtype.itemsize)
        # numpy refuses what reaches beyond the bytes, in either direction.
        content = self.content(stated["bufferView"])
        return np.ndarray((count, width), dtype, content, offset=stated.get("byteOffset", 0), strides=strides)

    def content(self, index: int) -> memoryview:
        """The bytes of a buffer view, unpacked."""
        view = self.document["bufferViews"][index]
        packed = next((view["extensions"][name] for name in _MESHOPT if name in view.get("extensions", {})), None)
        if packed is None:
            return self._slice(view)
        if -1 - index not in self.loaded:
            if packed["count"] * packed["byteStride"] > 100 * _MOST:
                raise ValueError(f"it states {packed['count']} values in {packed['byteLength']} bytes")
            kind = packed["mode"], packed.get("filter", "NONE")
            rows = _decoder("meshopt", _MESHOPT[0]).decode_gltf_buffer(
                bytes(self._slice(packed)), packed["count"], packed["byteStride"], *kind
            )
            self.loaded[-1 - index] = rows.tobytes()
        return memoryview(self.loaded[-1 - index])

    def _slice(self, stated: dict[str, Any]) -> memoryview:
        start = stated.get("byteOffset", 0)
        return memoryview(self._buffer(stated["buffer"]))[start : start + stated["byteLength"]]

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
        self._read: dict[int, tuple[Material, tuple[str, ...]]] = {}
        self._textures: dict[int, Texture | str] = {}

    def of_primitive(self, primitive: dict[str, Any], corners: IntArray) -> Appearance | None:
        """The appearance of a primitive with these faces, shape (F, 3); None where it states nothing."""
        index, colors = primitive.get("material"), primitive["attributes"].get("COLOR_0")
        if index is None and colors is None:
            return None
        material, notes = (_DEFAULT, ()) if index is None else self._material(index)
        if colors is not None and material.texture is None:
            return self._painted(colors, corners, material)
        uv = None if index is None or material.texture is None else self._places(primitive, index, corners)
        kept = material if uv is not None else replace(material, texture=None)
        return of_one(kept, len(corners), uv, notes)

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

    def _material(self, index: int) -> tuple[Material, tuple[str, ...]]:
        """A material, and what of it cannot be read."""
        if index not in self._read:
            stated = self._document["materials"][index]
            factor, picture = _base_color(stated)
            surface = stated.get("pbrMetallicRoughness", {})
            metallic = _DEFAULT.metallic if _OLDER not in stated.get("extensions", {}) else 0.0
            red, green, blue = srgb_of(np.array(factor[:3])).tolist()
            opacity = float(factor[3]) if stated.get("alphaMode", "OPAQUE") != "OPAQUE" else 1.0
            texture = self._texture(picture["index"]) if picture else None
            material = Material(
                name=str(stated.get("name", "")),
                color=(red, green, blue, opacity),
                metallic=float(surface.get("metallicFactor", metallic)),
                roughness=float(surface.get("roughnessFactor", _DEFAULT.roughness)),
                texture=None if isinstance(texture, str) else texture,
            )
            self._read[index] = material, (texture,) if isinstance(texture, str) else ()
        return self._read[index]

    def _texture(self, index: int) -> Texture | str:
        """A texture, or why it cannot be read."""
        from kinematify.robot.material_files import open_texture  # noqa: PLC0415  # opens pictures, most files hold none

        if index not in self._textures:
            stated = self._document["textures"][index]
            number = stated.get("source", stated.get("extensions", {}).get("EXT_texture_webp", {}).get("source"))
            image = {} if number is None else self._document["images"][number]
            name = str(image.get("name") or image.get("uri", "")[:40] or f"texture {index}")
            try:
                view = image.get("bufferView")
                named = self._source.named
                content = bytes(self._source.content(view)) if view is not None else named(image["uri"], "texture")
                self._textures[index] = open_texture(name, content)
            except (ValueError, KeyError) as error:
                self._textures[index] = f"the texture {name} cannot be read: {error}"
        return self._textures[index]


def _base_color(material: dict[str, Any]) -> tuple[list[float], dict[str, Any]]:
    """Linear colour with opacity of a material, and its texture; of its older way to say it where it uses that."""
    older = material.get("extensions", {}).get(_OLDER)
    if older is not None:
        return older.get("diffuseFactor", [1.0, 1.0, 1.0, 1.0]), older.get("diffuseTexture", {})
    surface = material.get("pbrMetallicRoughness", {})
    return surface.get("baseColorFactor", [1.0, 1.0, 1.0, 1.0]), surface.get("baseColorTexture", {})


def _nodes(document: dict[str, Any], source: _GltfBuffers, materials: _Materials | None) -> Iterator[RawMesh]:
    nodes = document.get("nodes", [])
    found: dict[int, tuple[FloatArray, tuple[tuple[int, str], ...]]] = {}
    top: tuple[tuple[int, str], ...] = ()
    waiting = [(index, np.eye(4), top) for index in reversed(_roots(document))]
    while waiting:
        index, above, path = waiting.pop()
        if index in found:
            raise ValueError("its nodes form no tree")
        node = nodes[index]
        mesh = document["meshes"][node["mesh"]] if "mesh" in node else {}
        found[index] = above @ _local_transform(node), (*path, (index, str(node.get("name") or mesh.get("name") or "")))
        waiting.extend((child, *found[index]) for child in reversed(node.get("children", [])))
    bound: dict[int, list[RawMesh]] = {}
    for index, (transform, path) in found.items():
        node = nodes[index]
        if "mesh" not in node:
            continue
        mesh = document["meshes"][node["mesh"]]
        shape = _Shape(source, materials, node.get("weights", mesh.get("weights", ())))
        skin = document["skins"][node["skin"]] if "skin" in node else None
        if skin is not None and all("JOINTS_0" in one["attributes"] for one in mesh["primitives"]):
            for joint, part in _rigid_parts(shape, mesh, skin, {key: item[0] for key, item in found.items()}):
                bound.setdefault(joint, []).append(part)
            continue
        vertices, faces, looks, _ = shape.merged(mesh)
        if len(faces):
            exact = joined_faces([_exact_faces(primitive) for primitive in mesh["primitives"]])
            made = RawMesh(
                name=path[-1][1], vertices=vertices, faces=faces, appearance=looks, exact=exact, holders=path
            )
            yield from (made.placed(transform @ place) for place in _instances(node, source))
    for joint, parts in bound.items():
        path = found[joint][1]
        yield replace(merged(parts, path[-1][1] or f"joint_{joint}"), holders=path)


def _instances(node: dict[str, Any], source: _GltfBuffers) -> list[FloatArray]:
    """Transforms of the copies of a node in its own frame, shape (4, 4) each; one where it says no more."""
    stated = node.get("extensions", {}).get(_INSTANCES)
    if stated is None:
        return [np.eye(4)]
    rows = {name.lower(): source.numbers(index) for name, index in stated["attributes"].items()}
    count = min((len(values) for values in rows.values()), default=0)
    if count > _COPIES:
        raise ValueError(f"it shows a node {count} times")
    return [_local_transform({name: values[k] for name, values in rows.items()}) for k in range(count)]


_COPIES = 10_000


def _rigid_parts(
    shape: _Shape, mesh: dict[str, Any], skin: dict[str, Any], T_world_node: dict[int, FloatArray]
) -> Iterator[tuple[int, RawMesh]]:
    """Parts of a mesh at the rest of its skin, each with the joint that moves it most; its node's frame is ignored."""
    inverse = np.tile(np.eye(4), (len(skin["joints"]), 1, 1))
    if "inverseBindMatrices" in skin:
        stated = shape.source.numbers(skin["inverseBindMatrices"]).astype(np.float64)
        inverse = stated[: len(inverse)].reshape(-1, 4, 4).transpose(0, 2, 1)
    T_world_bind = np.stack([T_world_node[joint] for joint in skin["joints"]]) @ inverse
    vertices, faces, looks, owners = shape.merged(mesh, T_world_bind)
    owner = np.sort(owners[:, 0].astype(np.int64)[faces], axis=1)[:, 1]  # of three corners, the joint that two have
    bent = float((owners[:, 1] < _RIGID).mean()) if len(owners) else 0.0
    notes = (f"the skin bends {bent:.0%} of its vertices: each face goes with one joint",) if bent else ()
    whole = RawMesh(name="", vertices=vertices, faces=faces, appearance=looks, notes=notes)
    for number in np.unique(owner):
        yield skin["joints"][number], compacted(whole.of_faces(np.flatnonzero(owner == number)))


_RIGID = 0.99
"""Weight of a joint from which a vertex belongs to it alone."""


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
    turn = rotation_from_quaternion(np.roll(np.array(node.get("rotation", (0.0, 0.0, 0.0, 1.0)), dtype=np.float64), 1))
    transform = np.eye(4)
    transform[:3, :3] = turn * np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
    transform[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return transform


@dataclass(frozen=True, eq=False)
class _Shape:
    """Where vertices of a node's mesh come from."""

    source: _GltfBuffers
    materials: _Materials | None
    weights: list[float]
    """Of its morph targets."""

    def merged(
        self, mesh: dict[str, Any], bones: FloatArray | None = None
    ) -> tuple[FloatArray, IntArray, Appearance | None, FloatArray]:
        """All triangles of a mesh; its primitives differ by material only. Points and lines are omitted.

        Args:
            mesh: As in the document.
            bones: Where each joint of a skin carries a vertex that it moves alone, shape (J, 4, 4).

        Returns:
            Vertices, faces, appearance, and for every vertex the bone that moves it most and by how much, shape (V, 2).
        """
        vertices, faces, count = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.int64)], 0
        looks: list[Appearance | None] = []
        owners = [np.empty((0, 2))]
        for primitive in mesh["primitives"]:
            mode = primitive.get("mode", _TRIANGLES)
            if mode not in (_TRIANGLES, _STRIP, _FAN):
                continue
            self.source.decode(primitive)
            points = self.source.numbers(primitive["attributes"]["POSITION"]).astype(np.float64)
            for target, weight in zip(primitive.get("targets", ()), self.weights, strict=False):
                if weight and "POSITION" in target:
                    points = points + weight * self.source.numbers(target["POSITION"])
            indexed = "indices" in primitive
            corners = self.source.numbers(primitive["indices"]).reshape(-1) if indexed else np.arange(len(points))
            triangles = _triangles(corners.astype(np.int64), mode)
            if len(triangles) and triangles.max() >= len(points):
                raise ValueError("a face refers to a vertex that the file does not hold")
            if bones is not None:
                points, moved_by = self._posed(primitive, points, bones)
                owners.append(moved_by)
            vertices.append(points)
            faces.append(triangles + count)
            looks.append(self.materials.of_primitive(primitive, triangles) if self.materials is not None else None)
            count += len(points)
        looked = joined(looks, [len(item) for item in faces[1:]])
        return np.concatenate(vertices), np.concatenate(faces), looked, np.concatenate(owners)

    def _posed(self, primitive: dict[str, Any], points: FloatArray, bones: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Vertices where their bones carry them, and the last result of `merged`."""
        sets = sorted(name[7:] for name in primitive["attributes"] if name.startswith("JOINTS_"))
        joints, weights = (
            np.concatenate([self.source.numbers(primitive["attributes"][f"{kind}_{k}"]) for k in sets], axis=1)
            for kind in ("JOINTS", "WEIGHTS")
        )
        shares = weights / np.maximum(weights.sum(axis=1, keepdims=True), 1e-9)
        placed = np.zeros_like(points)
        for joint, share in zip(joints.T, shares.T, strict=True):
            moved = np.einsum("vij,vj->vi", bones[joint][:, :3, :3], points) + bones[joint][:, :3, 3]
            placed += share[:, None] * moved
        most, rows = shares.argmax(axis=1), np.arange(len(points))
        return placed, np.stack([joints[rows, most], shares[rows, most]], axis=1)


def _triangles(corners: IntArray, mode: int) -> IntArray:
    if mode == _TRIANGLES:
        return corners.reshape(-1, 3)
    if mode == _FAN:
        return np.stack([np.full(max(len(corners) - 2, 0), corners[0]), corners[1:-1], corners[2:]], axis=1)
    strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    strip[1::2] = strip[1::2, [1, 0, 2]]  # every other triangle runs the other way round
    return strip
