"""A prompt goes into a generator, files with segmented meshes and where they come from come out."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image, UnidentifiedImageError

from kinematify.assembly.load import PART_SUFFIXES
from kinematify.errors import EnvironmentFault, InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    Progress = Callable[[str, float], None]


MOST_WORDS = 2000
"""Characters of a sentence; longer ones are documents."""
MOST_IMAGES = 5
MOST_BYTES = 20_000_000
"""Of an image."""
FEWEST_PIXELS = 32
"""Along either side of an image."""
_FORMATS = {"PNG": "image/png", "JPEG": "image/jpeg", "WEBP": "image/webp"}


@dataclass(frozen=True, kw_only=True)
class Prompt:
    """A request that has been looked at."""

    text: str | None
    images: tuple[Path, ...]
    """Readable pictures, absolute paths."""
    media: tuple[str, ...]
    """Media type of each image."""
    seed: int

    def digest(self, options: dict[str, object]) -> str:
        """SHA-256 of everything that a generator is given: the same request has the same digest."""
        facts = {
            "text": self.text,
            "images": [hashlib.sha256(image.read_bytes()).hexdigest() for image in self.images],
            "seed": self.seed,
            "options": options,
        }
        return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()


def check_prompt(text: str | None, images: tuple[Path, ...], *, seed: int) -> Prompt:
    """Look at a request.

    Args:
        text: What to build.
        images: Pictures of it.
        seed: Of the generator.

    Raises:
        InputError: There is neither text nor image, too much of either, or a file that is no still image.
    """
    words = " ".join(text.split()) if text is not None else None
    if words is not None and not words:
        raise InputError("The text is empty. Say what to build, e.g. --text 'a red toolbox with a hinged lid'.")
    if words is not None and len(words) > MOST_WORDS:
        raise InputError(
            f"The text has {len(words)} characters; a generator takes {MOST_WORDS} at most. Name the object and its "
            "moving parts in a sentence or two."
        )
    if words is None and not images:
        raise InputError("There is neither a text nor an image. Give --text or --image.")
    if len(images) > MOST_IMAGES:
        raise InputError(f"{len(images)} images were given; at most {MOST_IMAGES} views of one object make sense.")
    media = tuple(_media_type(image) for image in images)
    return Prompt(text=words, images=tuple(image.absolute() for image in images), media=media, seed=seed)


def _media_type(path: Path) -> str:
    """Open an image completely: a truncated one is found here and not by a service that was paid."""
    if not path.is_file():
        raise InputError(f"There is no image {path}. Check the path.")
    if path.stat().st_size > MOST_BYTES:
        raise InputError(f"The image {path} has more than {MOST_BYTES // 1_000_000} MB. Make it smaller.")
    try:
        with Image.open(path) as image:
            form, frames, size = image.format or "", getattr(image, "n_frames", 1), image.size
            image.load()
    except UnidentifiedImageError as error:
        raise InputError(f"{path} is no image. Give a PNG, JPEG or WebP file.") from error
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise InputError(f"The image {path} cannot be read to its end ({error}). Copy or save it again.") from error
    if form not in _FORMATS:
        raise InputError(f"The image {path} is {form or 'of an unknown kind'}. Save it as PNG, JPEG or WebP.")
    if frames != 1:
        raise InputError(f"The image {path} is an animation of {frames} frames. Give one still image.")
    if min(size) < FEWEST_PIXELS:
        raise InputError(f"The image {path} has {size[0]} x {size[1]} pixels; it shows nothing below {FEWEST_PIXELS}.")
    return _FORMATS[form]


@dataclass(frozen=True, kw_only=True)
class Generated:
    """Result of a generator."""

    path: Path
    """File or folder that `kinematify.load_assembly` reads."""
    labels: Path | None
    """Labels per triangle if `path` is one mesh with labels."""
    provenance: dict[str, Any]
    """Who made it of what, and whose terms hold, as JSON values; written into ``inference.json``."""


_PACKED = ".zip"
_SCENES = (".glb", ".gltf", ".zip", ".3mf")  # these hold all parts of an object
_LABELS = ("labels.npy", "labels.json")


def found_parts(folder: Path) -> tuple[Path, Path | None]:
    """Choose what to load from a folder, and labels beside it.

    One scene (GLB, ZIP, 3MF) is the object; one mesh with ``labels.npy`` or ``labels.json`` is too; several meshes are
    its parts.

    Raises:
        EnvironmentFault: There is nothing to load; the message lists what there is.
    """
    files = sorted(path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    meshes = [path for path in files if path.suffix.lower() in (*PART_SUFFIXES, _PACKED) and path.stat().st_size]
    labels = next((folder / name for name in _LABELS if (folder / name).is_file()), None)
    if len(meshes) == 1:
        return meshes[0], labels
    scenes = [path for path in meshes if path.suffix.lower() in _SCENES]
    if len(scenes) == 1:
        return scenes[0], None
    if meshes:
        return folder, None
    there = ", ".join(path.name for path in files[:8]) or "nothing"
    raise EnvironmentFault(
        f"The generator left no mesh in {folder}; there is {there}. Expected: one GLB or ZIP, a mesh per part "
        f"({', '.join(PART_SUFFIXES)}), or one mesh with labels.npy."
    )
