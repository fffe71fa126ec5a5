"""Materials as files hold them: MTL beside OBJ, pictures, 3MF colours, and what the general mesh reader found."""

from __future__ import annotations

import io
import zipfile
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree
from PIL import Image, UnidentifiedImageError

from kinematify.robot.appearance import Appearance, Material, Texture, painted

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.appearance import Rgba
    from kinematify.robot.arrays import FloatArray, IntArray

_MAX_SIDE = 2048  # [pixels] of a texture; larger ones are made smaller
_OPAQUE = 255
_HEX = {7: 6, 9: 8}  # length of a colour in 3MF, its sign included -> hexadecimal digits


def texture_of(name: str, picture: Image.Image) -> Texture:
    """Return a picture as a texture, made smaller where it is larger than can be seen."""
    picture = picture.convert("RGBA")
    picture.thumbnail((_MAX_SIDE, _MAX_SIDE))
    return Texture(name=name, pixels=np.asarray(picture))


def open_texture(name: str, content: Path | bytes) -> Texture | str:
    """Return a picture of a file or of bytes in it; a clause that says why not, where it cannot be read."""
    try:
        with Image.open(io.BytesIO(content) if isinstance(content, bytes) else content) as picture:
            return texture_of(name, picture)
    except FileNotFoundError:
        return f"the texture {name} is not there"
    except (OSError, UnidentifiedImageError, Image.DecompressionBombError, ValueError) as error:
        return f"the texture {name} cannot be read ({type(error).__name__})"


def write_texture(path: Path, texture: Texture) -> None:
    """Write a texture as PNG; without opacity where all of it is opaque, as some renderers need.

    Raises:
        OSError: It cannot be written.
    """
    opaque = bool((texture.pixels[..., 3] == _OPAQUE).all())
    Image.fromarray(texture.pixels[..., :3] if opaque else texture.pixels).save(path)


def read_mtl(path: Path) -> tuple[dict[str, Material], tuple[str, ...]]:
    """Read the materials of an MTL file by name, and what cannot be read, one clause each."""
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return {}, (f"the materials {path.name} are not there",)
    stated: dict[str, dict[str, str]] = {}
    current: dict[str, str] = {}
    for line in lines:
        keyword, _, rest = line.strip().partition(" ")
        if keyword == "newmtl":
            current = stated.setdefault(rest.strip(), {})
        elif keyword and not keyword.startswith("#"):
            current[keyword.lower()] = rest.strip()
    notes: list[str] = []
    return {name: _mtl_material(name, values, path.parent, notes) for name, values in stated.items()}, tuple(notes)


def _mtl_material(name: str, values: Mapping[str, str], folder: Path, notes: list[str]) -> Material:
    red, green, blue = _floats(values.get("kd", ""), 3) or (0.7, 0.7, 0.7)
    opacity = _floats(values.get("d", ""), 1) or [1.0 - lost for lost in _floats(values.get("tr", ""), 1)] or [1.0]
    shine = _floats(values.get("ns", ""), 1)
    roughness = _floats(values.get("pr", ""), 1) or [float(np.sqrt(2.0 / (max(value, 0.0) + 2.0))) for value in shine]
    texture = None
    if "map_kd" in values:
        texture = _mtl_texture(values["map_kd"], folder, notes)
        if texture is not None and not (red or green or blue):  # black by neglect: it would hide the picture
            red = green = blue = 1.0
    return Material(
        name=name,
        color=(red, green, blue, opacity[0]),
        metallic=(_floats(values.get("pm", ""), 1) or [0.0])[0],
        roughness=(roughness or [Material().roughness])[0],
        texture=texture,
    )


def _mtl_texture(stated: str, folder: Path, notes: list[str]) -> Texture | None:
    """The picture that a line names, at its end behind options; beside the MTL if it is not where the line says."""
    name = (stated if not stated.startswith("-") else stated.rsplit(maxsplit=1)[-1]).replace("\\", "/")
    path = folder / name
    found = open_texture(name, path if path.is_file() else folder / name.rpartition("/")[2])
    if isinstance(found, str):
        notes.append(found)
        return None
    return found


def _floats(text: str, count: int) -> list[float]:
    """The first numbers of a text, in [0, 1] or above; empty where it does not begin with so many."""
    try:
        values = [float(word) for word in text.split()[:count]]
    except ValueError:
        return []
    return values if len(values) == count and np.isfinite(values).all() else []


def write_mtl(path: Path, materials: Sequence[Material]) -> tuple[str, ...]:
    """Write materials and their textures beside them, named after the file; returns the name of each in the file.

    Raises:
        OSError: It cannot be written.
    """
    names = tuple(f"{path.stem}_{index}" for index in range(len(materials)))
    with path.open("w", encoding="ascii") as file:
        for name, material in zip(names, materials, strict=True):
            red, green, blue, opacity = material.color
            file.write(f"newmtl {name}\nKd {red:.4f} {green:.4f} {blue:.4f}\nd {opacity:.4f}\n")
            file.write(f"Pm {material.metallic:.4g}\nPr {material.roughness:.4g}\n")
            if material.texture is not None:
                write_texture(path.with_name(f"{name}.png"), material.texture)
                file.write(f"map_Kd {name}.png\n")
    return names


def appearance_found(visual: Any, faces: IntArray) -> Appearance | None:
    """Return what trimesh read of a mesh's materials, texture or colours; None where the file states none."""
    material = getattr(visual, "material", None)
    if material is not None:
        read = _material_found(material)
        uv = getattr(visual, "uv", None)
        placed = uv is not None and len(uv) > faces.max(initial=-1) and read.texture is not None
        return Appearance(
            materials=(read,),
            material_of_face=np.zeros(len(faces), dtype=np.int64),
            uv=np.asarray(uv, dtype=np.float64)[faces][..., :2] if placed else None,
        )
    if getattr(visual, "kind", None) == "face":
        return painted(np.asarray(visual.face_colors, dtype=np.float64) / 255.0)
    if getattr(visual, "kind", None) == "vertex":
        return painted((np.asarray(visual.vertex_colors, dtype=np.float64) / 255.0)[faces].mean(axis=1))
    return None


def _material_found(material: Any) -> Material:
    """A material of trimesh, whose colours are sRGB in bytes."""
    picture = getattr(material, "image", None) or getattr(material, "baseColorTexture", None)
    stated = getattr(material, "baseColorFactor", None)
    stated = getattr(material, "diffuse", None) if stated is None else stated
    color = np.array([*np.atleast_1d(stated), 255])[:4] / 255.0 if stated is not None else np.ones(4)
    if picture is not None and not color[:3].any():
        color[:3] = 1.0
    red, green, blue, opacity = color.tolist()
    name = str(getattr(material, "name", None) or "")
    return Material(
        name=name,
        color=(red, green, blue, opacity),
        texture=None if picture is None else texture_of(name or "texture", picture),
    )


def read_3mf_colors(path: Path) -> list[tuple[FloatArray, bool]]:
    """Return the colour of every triangle of each object with triangles, in the order of the file.

    Base materials and groups of colours are read, textures are not.

    Returns:
        sRGB and opacity in [0, 1], shape (F, 4), of every object, and whether the file states any of them.

    Raises:
        OSError, ValueError, KeyError, etree.XMLSyntaxError: It cannot be read.
    """
    with zipfile.ZipFile(path) as archive:
        name = next(item for item in archive.namelist() if item.lower().endswith(".model"))
        root = etree.fromstring(archive.read(name), etree.XMLParser(resolve_entities=False, no_network=True))
    palettes: dict[str, list[Rgba]] = {}
    for group in root.iter("{*}basematerials", "{*}colorgroup"):
        stated = [item.get("displaycolor") or item.get("color") or "" for item in group]
        palettes[group.get("id") or ""] = [_hex_color(text) for text in stated]
    return [
        _object_colors(item, palettes) for item in root.iter("{*}object") if item.find(".//{*}triangle") is not None
    ]


def _object_colors(item: Any, palettes: Mapping[str, list[Rgba]]) -> tuple[FloatArray, bool]:
    usual = item.get("pid"), item.get("pindex")
    grey = Material().color
    found = False
    colors = []
    for triangle in item.iter("{*}triangle"):
        palette = palettes.get(triangle.get("pid") or usual[0] or "", [])
        index = int(triangle.get("p1") or usual[1] or 0)
        known = index < len(palette)
        found |= known
        colors.append(palette[index] if known else grey)
    return np.array(colors), found


def _hex_color(text: str) -> Rgba:
    digits = _HEX.get(len(text), 0)
    if not digits:
        return Material().color
    values = [int(text[1 + k : 3 + k], 16) / 255.0 for k in range(0, digits, 2)]
    red, green, blue, opacity = [*values, 1.0][:4]
    return red, green, blue, opacity
