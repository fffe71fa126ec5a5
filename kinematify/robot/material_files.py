"""Materials as files hold them: MTL beside OBJ, and pictures."""

from __future__ import annotations

import io
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, UnidentifiedImageError

from kinematify.robot.appearance import Material, Texture

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

_MAX_SIDE = 2048  # [pixels] of a texture; larger ones are made smaller
_OPAQUE = 255


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
    path.write_bytes(_png(texture))


@lru_cache(maxsize=4)  # links of one object share theirs
def _png(texture: Texture) -> bytes:
    opaque, written = bool((texture.pixels[..., 3] == _OPAQUE).all()), io.BytesIO()
    Image.fromarray(texture.pixels[..., :3] if opaque else texture.pixels).save(written, "PNG")
    return written.getvalue()


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
        stated = values["map_kd"]
        texture = named_texture(stated if not stated.startswith("-") else stated.rsplit(maxsplit=1)[-1], folder, notes)
        if texture is not None and not (red or green or blue):  # black by neglect: it would hide the picture
            red = green = blue = 1.0
    return Material(
        name=name,
        color=(red, green, blue, opacity[0]),
        metallic=(_floats(values.get("pm", ""), 1) or [0.0])[0],
        roughness=(roughness or [Material().roughness])[0],
        texture=texture,
    )


def named_texture(stated: str, folder: Path, notes: list[str]) -> Texture | None:
    """Return the picture that a file names, or the one of this name in its folder; what cannot be read is noted."""
    name = stated.replace("\\", "/")
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
