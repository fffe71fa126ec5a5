"""Which files are meshes, and where one that a URDF names may lie: packages, addresses, relative paths."""

from __future__ import annotations

import itertools
import os
import re
from functools import lru_cache
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
_SHOWN = 3
_PACKAGE_PATHS = ("ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "SDF_PATH")
"""Variables of the environment that name folders of packages."""
_NEAR, _MOST_BESIDE = 3, 300
"""Folders above a document in which clones are looked for, and entries of each that are looked at."""
_MANIFEST_BYTES = 100_000
_LEVELS = 4
"""Folders above a document that may be its package under another name: ``urdf/robots/arm/`` is the deepest seen."""
_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")
"""Of a package in its `package.xml`."""


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
        places = ", ".join(map(str, candidates[:_SHOWN]))
        more = f" and {len(candidates) - _SHOWN} more places" if len(candidates) > _SHOWN else ""
        raise DescriptionError(
            f"The mesh {filename!r} of {where} is not there: looked at {places}{more}. "
            "Put the file there, or name the folder that holds the package with --package-dir."
        )
    return found


def near_mesh(filename: str, folder: Path, package_dirs: Sequence[Path]) -> Path | None:
    """Return the one file that a name which leads to none may mean; None without one, or with several.

    Letters in another case anywhere in the path, or the same end of the path in a folder beside or above the document.
    """
    tail = filename.replace("\\", "/").split("://")[-1]
    words = [word for word in tail.split("/") if word not in ("", ".", "..")]
    above = [folder, *folder.parents][:_LEVELS]
    try:
        asked = [path for path in mesh_candidates(filename, folder, package_dirs, "") if len(path.parts) > 1]
    except DescriptionError:
        asked = []
    for path in (*asked, *(place / Path(*words[-depth:]) for depth in (2, 1) if words[-depth:] for place in above)):
        found = _in_any_case(path)
        if len(found) == 1:
            return found[0]
    return None


def _in_any_case(path: Path) -> list[Path]:
    """Files whose path differs from one in the case of letters only."""
    known = [Path(path.anchor)]
    for word in path.parts[1:] if path.anchor else path.parts:
        exact = [place / word for place in known if word == ".." or os.path.lexists(place / word)]
        known = exact or [item for place in known for item in _children(place) if item.name.lower() == word.lower()]
    return [item for item in known if _is_file(item)]


def _children(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:
        return []


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
    """Find packages: given folders first; then those above, by the name in their manifest, then by their own; then ROS.

    ``--package-dir`` may be the package or its parent.
    """
    above = (folder, *folder.parents)
    candidates = []
    for given in package_dirs:
        candidates.append(given / package / inside)
        if package in (given.name, declared_name(given)):
            candidates.append(given / inside)
    candidates += [place / inside for place in above if declared_name(place) == package]
    candidates += [beside / inside for beside in _cloned_beside(folder, package)]
    for place in above:
        if place.name == package:
            candidates.append(place / inside)
        candidates.append(place / package / inside)
    candidates += [place / inside for place in _ros_packages(package)]
    # Clones and single exported robots keep the package's tree but not its name.
    return candidates + [place / inside for place in (*package_dirs, *above[:_LEVELS])]


@lru_cache(maxsize=64)
def _cloned_beside(folder: Path, package: str) -> list[Path]:
    """Packages near a document by the name in their manifest: clones are often in folders of other names."""
    found = []
    for place in folder.parents[:_NEAR]:
        try:
            beside = sorted(item for item in itertools.islice(place.iterdir(), _MOST_BESIDE) if item.is_dir())
        except OSError:
            continue
        found += [item for item in beside if item.name != package and declared_name(item) == package]
    return found


def _ros_packages(package: str) -> list[Path]:
    """Places of a package in the workspaces that the environment names."""
    sources = [place for name in _PACKAGE_PATHS for place in _environment_paths(name)]
    installed = _environment_paths("AMENT_PREFIX_PATH")
    named = [place for place in sources if package in (place.name, declared_name(place))]
    return [*named, *(place / package for place in sources), *(place / "share" / package for place in installed)]


def _environment_paths(name: str) -> list[Path]:
    return [Path(place) for place in os.environ.get(name, "").split(os.pathsep) if place]


@lru_cache(maxsize=1024)
def declared_name(folder: Path) -> str | None:
    """Name of a package by its manifest; None where a folder has none."""
    try:
        with (folder / "package.xml").open("rb") as file:
            found = _NAME.search(file.read(_MANIFEST_BYTES))
    except OSError:
        return None
    return None if found is None else found[1].decode("utf-8", "replace")


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name that is too long, or a folder that may not be entered
        return False
