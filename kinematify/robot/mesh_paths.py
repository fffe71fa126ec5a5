"""Which files are meshes, and where one that a URDF names may lie: packages, addresses, relative paths."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote, urlparse

from kinematify.errors import DescriptionError

if TYPE_CHECKING:
    from collections.abc import Sequence

GLTF_SUFFIXES = (".glb", ".gltf")
MESH_SUFFIXES = (*GLTF_SUFFIXES, ".obj", ".stl", ".ply", ".off", ".3mf", ".dae")
"""Mesh formats that are read."""
CAD_SUFFIXES = (".step", ".stp")
"""Formats whose surfaces are turned into triangles; an assembly may be one, the mesh of a link not."""
_SHOWN = 6


def find_mesh(filename: str, folder: Path, package_dirs: Sequence[Path], where: str) -> Path:
    """Return the mesh file that a document names.

    Args:
        filename: As written.
        folder: Folder of the document.
        package_dirs: Folders that are packages, or hold them.
        where: The link, for messages.

    Raises:
        DescriptionError: It is nowhere; the message lists the places.
    """
    candidates = mesh_candidates(filename, folder, package_dirs, where)
    found = next((path for path in candidates if _is_file(path)), None)
    if found is None:
        raise DescriptionError(
            f"The mesh {filename!r} of {where} is not there: looked at {', '.join(map(str, candidates[:_SHOWN]))}. "
            "Put the file there, or name the folder that holds the package with --package-dir."
        )
    return found


def mesh_candidates(filename: str, folder: Path, package_dirs: Sequence[Path], where: str) -> list[Path]:
    """Places where a mesh may lie, the likeliest first; arguments and errors as for `find_mesh`."""
    try:
        address = urlparse(filename)
    except ValueError:  # brackets that look like a broken IPv6 address
        address = urlparse("")
    if address.scheme in ("package", "model"):
        return _package_candidates(address.netloc, unquote(address.path).lstrip("/"), folder, package_dirs)
    if address.scheme == "file":
        return [Path(unquote(address.path))]
    if not filename or "://" in filename:
        raise DescriptionError(
            f"The mesh of {where} names the file {filename!r}. Give a path relative to the URDF, or "
            "package://NAME/PATH."
        )
    # A path on the author's Windows machine still has its separators.
    return [folder / filename.replace("\\", "/")]


def _package_candidates(package: str, inside: str, folder: Path, package_dirs: Sequence[Path]) -> list[Path]:
    """``--package-dir`` may be the package or its parent; without it, a folder above the URDF is the package."""
    candidates = []
    for given in package_dirs:
        candidates.append(given / package / inside)
        if given.name == package:
            candidates.append(given / inside)
    for above in (folder, *folder.parents):
        if above.name == package:
            candidates.append(above / inside)
        candidates.append(above / package / inside)
    # Single exported robots keep the package's tree but not its name.
    candidates += [place / inside for place in (*package_dirs, folder)]
    return candidates


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name that is too long, or a folder that may not be entered
        return False
