"""Which of the files that a generator left are the parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.assembly.load import PART_SUFFIXES
from kinematify.errors import EnvironmentFault

if TYPE_CHECKING:
    from pathlib import Path

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
