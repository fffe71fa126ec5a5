"""A part as binary glTF, for the page: its surfaces with their materials and textures.

`kinematify.formats.glb` writes whole models by trimesh, which takes longer to load than everything else that the page
waits for.
"""

from __future__ import annotations

import io
import json
import struct
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image

from kinematify.robot.appearance import linear_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.robot.appearance import Material, Surface, Texture

_MAGIC, _VERSION, _JSON, _BINARY = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
_FLOAT, _UNSIGNED = 5126, 5125
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3"}


def glb_of(surfaces: Sequence[Surface], *, double_sided: bool) -> bytes:
    """Return surfaces as one mesh of a GLB file, without normals, so that its triangles look flat.

    Args:
        surfaces: Of one part.
        double_sided: Whether the back of a triangle can be seen, as where the part is open. A page lays the shadow of a
            triangle that has two sides on itself.
    """
    written = _Buffers()
    textures: dict[Texture, int] = {}
    materials, primitives = [], []
    for number, surface in enumerate(surfaces):
        attributes = {"POSITION": written.add_numbers(surface.vertices.astype(np.float32))}
        texture = surface.material.texture
        if texture is not None and surface.uv is not None:
            attributes["TEXCOORD_0"] = written.add_numbers((surface.uv * [1.0, -1.0] + [0.0, 1.0]).astype(np.float32))
            textures.setdefault(texture, len(textures))
        indices = written.add_numbers(surface.faces.reshape(-1, 1).astype(np.uint32))
        primitives.append({"attributes": attributes, "indices": indices, "material": number})
        materials.append(_material(surface.material, textures.get(texture) if texture else None, double_sided))
    images = [{"bufferView": written.add(_png(texture)), "mimeType": "image/png"} for texture in textures]
    content: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": materials,
        "accessors": written.accessors,
        "bufferViews": written.views,
        "buffers": [{"byteLength": written.length}],
    }
    if images:
        content |= {"images": images, "textures": [{"source": number} for number in range(len(images))]}
    said = json.dumps(content).encode()
    said += b" " * (-len(said) % 4)
    binary = b"".join(written.blocks)
    chunks = struct.pack("<II", len(said), _JSON) + said + struct.pack("<II", len(binary), _BINARY) + binary
    return struct.pack("<III", _MAGIC, _VERSION, 12 + len(chunks)) + chunks


class _Buffers:
    """The binary part of a file, as it grows."""

    def __init__(self) -> None:
        self.blocks: list[bytes] = []
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []
        self.length = 0

    def add(self, content: bytes) -> int:
        """Add bytes; return the number of their view."""
        self.views.append({"buffer": 0, "byteOffset": self.length, "byteLength": len(content)})
        self.blocks.append(content + b"\0" * (-len(content) % 4))
        self.length += len(self.blocks[-1])
        return len(self.views) - 1

    def add_numbers(self, rows: NDArray[Any]) -> int:
        """Add rows of numbers, float32 or uint32, shape (n, k); return the number of their accessor."""
        stated = {
            "bufferView": self.add(rows.tobytes()),
            "componentType": _FLOAT if rows.dtype == np.float32 else _UNSIGNED,
            "count": len(rows),
            "type": _KINDS[rows.shape[1]],
            "min": rows.min(axis=0).tolist(),
            "max": rows.max(axis=0).tolist(),
        }
        self.accessors.append(stated)
        return len(self.accessors) - 1


def _material(material: Material, texture: int | None, double_sided: bool) -> dict[str, Any]:
    looks: dict[str, Any] = {
        "baseColorFactor": [*linear_of(np.array(material.color[:3])).tolist(), material.color[3]],
        "metallicFactor": material.metallic,
        "roughnessFactor": material.roughness,
    }
    if texture is not None:
        looks["baseColorTexture"] = {"index": texture}
    opaque = material.color[3] >= 1.0
    return {"pbrMetallicRoughness": looks, "doubleSided": double_sided, "alphaMode": "OPAQUE" if opaque else "BLEND"}


def _png(texture: Texture) -> bytes:
    content = io.BytesIO()
    Image.fromarray(texture.pixels).save(content, format="PNG", compress_level=1)
    return content.getvalue()
