"""Inputs of a batch: files and folders on disks and in stores, by pattern, each with a name of its own."""

from __future__ import annotations

import hashlib
import posixpath
import re
import shutil
import tempfile
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.load import PART_SUFFIXES
from kinematify.errors import EnvironmentFault, InputError, KinematifyError
from kinematify.robot.mesh_file import read_meshes
from kinematify.robot.mesh_paths import CAD_SUFFIXES, GLTF_SUFFIXES
from kinematify.versions import install_command

if TYPE_CHECKING:
    from collections.abc import Sequence

_MAGIC = re.compile(r"[*?\[]")
_NAMING = {
    ".urdf": re.compile(rb'filename\s*=\s*"([^"]+)"'),
    ".gltf": re.compile(rb'"uri"\s*:\s*"([^"]+)"'),
    ".obj": re.compile(rb"^mtllib\s+(.+?)\s*$", re.MULTILINE),
}
"""How files name others that belong to them."""
_SUFFIXES = (*PART_SUFFIXES, ".urdf", ".zip")
_SCENES = (*GLTF_SUFFIXES, *CAD_SUFFIXES, ".dae", ".3mf")
"""Formats with a node or an object for each part."""
_OPENED = 12
"""Files of a folder that are opened to tell parts from objects."""
_TELLING, _COMMON = 4, 0.5
"""From so many files, with this mean share of the smaller of two boxes in the other, each is an object."""


@dataclass(frozen=True, kw_only=True)
class Source:
    """One object."""

    name: str
    """Of its folder in the output; each has its own."""
    place: str
    """Path or URL of a file, or of a folder with a file for each part."""


def find_sources(patterns: Sequence[str], *, besides: str | None = None) -> tuple[Source, ...]:
    """Return what the patterns match, by place; of a folder of objects, each of these.

    An object is named after its path below the folder, or the part of the pattern that has no wildcard:
    ``kitchen-oven`` for ``assets/kitchen/oven.glb``. Names that would be equal end with a hash of the place.

    Args:
        patterns: Paths or URLs; ``*`` is any name and ``**`` any folders.
        besides: Folder that no object is taken from: what lies in the output is no input.

    Raises:
        InputError: A pattern matches nothing.
        EnvironmentFault: The package that reads a kind of URL is not installed.
    """
    names: dict[str, str] = {}
    for pattern in patterns:
        fs, path = filesystem(pattern)
        objects = [(place, one) for place in fs.glob(path) for one in _objects(fs, place) or [place]]
        objects = [pair for pair in objects if besides is None or not _below(absolute(fs, pair[1]), besides)]
        if not objects:
            raise InputError(
                f"{pattern} matches no file and no folder. Give paths, or patterns in quotes such as 'assets/**/*.glb'."
            )
        for place, one in objects:
            root = _root(path) if _MAGIC.search(path) or one == place else place
            names[absolute(fs, one)] = _name(posixpath.relpath(one, root))
    times = Counter(names.values())
    return tuple(
        Source(name=name if times[name] == 1 else f"{name}-{_short_hash(place)}", place=place)
        for place, name in sorted(names.items())
    )


def _objects(fs: Any, place: str) -> list[str]:
    """Paths of the objects of a place: itself if it is a file or a folder of parts, else what its folder holds.

    Of a folder, the URDFs are the objects; else its meshes and archives, unless the meshes are parts of one object, and
    those of its folders.
    """
    if not fs.isdir(place):
        return [place]
    entries = sorted(entry for entry in fs.ls(place, detail=False) if not posixpath.basename(entry).startswith("."))
    files = [entry for entry in entries if PurePosixPath(entry).suffix.lower() in _SUFFIXES and fs.isfile(entry)]
    if urdfs := [file for file in files if file.lower().endswith(".urdf")]:
        return urdfs
    meshes = [file for file in files if not file.lower().endswith(".zip")]
    if len(meshes) > 1 and not _are_objects(fs, meshes):
        return [place]
    return files + [one for entry in entries if fs.isdir(entry) for one in _objects(fs, entry)]


def _are_objects(fs: Any, files: Sequence[str]) -> bool:
    """True if mesh files are objects, not parts of one: each has several nodes, or they stand in each other."""
    counts, boxes = [], []
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        for k in np.unique(np.linspace(0, len(files) - 1, _OPENED).astype(int)).tolist():
            with suppress(KinematifyError, OSError):  # what cannot be read says nothing
                meshes = read_meshes(fetched(absolute(fs, files[k]), Path(folder, str(k))))
                counts.append(len(meshes))
                boxes.append([f(np.concatenate([m.vertices for m in meshes]), axis=0) for f in (np.min, np.max)])
    if counts and min(counts) > 1 and all(PurePosixPath(file).suffix.lower() in _SCENES for file in files):
        return True
    if len(boxes) < _TELLING:
        return False
    low, high = np.array(boxes).swapaxes(0, 1)
    high += 1e-3 * np.linalg.norm(high.max(axis=0) - low.min(axis=0))  # flat ones have a volume too
    common = np.clip(np.minimum(high[:, None], high) - np.maximum(low[:, None], low), 0.0, None).prod(axis=2)
    sizes = (high - low).prod(axis=1)
    shares = common / np.minimum(sizes[:, None], sizes)
    return bool(shares[np.triu_indices(len(boxes), k=1)].mean() > _COMMON)


def filesystem(place: str) -> tuple[Any, str]:
    """Return the file system of a path or URL (`fsspec`), and the path in it.

    Raises:
        EnvironmentFault: The package that reads such URLs is not installed, or the store cannot be reached.
        InputError: The URL is of no kind that is known.
    """
    from fsspec.core import url_to_fs  # noqa: PLC0415  # of the driver and of workers with URLs; 0.1 s

    try:
        fs, path = url_to_fs(place)
    except ImportError as error:
        raise EnvironmentFault(
            f"{place} needs a package that is not installed: {error}. For s3://, run: {install_command('s3fs')}"
        ) from error
    except ValueError as error:
        raise InputError(
            f"{place} cannot be opened: {error}. Give a path, or a URL such as s3://bucket/folder."
        ) from error
    return fs, path


def content_hash(place: str) -> str:
    """Return a hash of an object's files: of their bytes on a disk, of what a store says of their versions elsewhere.

    Raises:
        OSError: A file cannot be read.
    """
    fs, path = filesystem(place)
    digest = hashlib.sha256()
    for name, file in sorted(_files(fs, path).items()):
        digest.update(f"{name}\n".encode())
        digest.update(Path(file).read_bytes() if is_local(fs) else str(fs.checksum(file)).encode())
    return digest.hexdigest()


def fetched(place: str, folder: Path) -> Path:
    """Return a path at which an object can be read: its own on a disk, else that of a copy in `folder`.

    Raises:
        OSError: It cannot be read.
    """
    fs, path = filesystem(place)
    if is_local(fs):
        return Path(path)
    below = folder.joinpath("1", "2", "3")  # files may name others above them
    for name, file in _files(fs, path).items():
        target = Path(posixpath.normpath(below / name))
        if target.is_relative_to(folder):
            target.parent.mkdir(parents=True, exist_ok=True)
            fs.get_file(file, str(target))
    return below / posixpath.basename(path)


def publish(made: Path, place: str) -> None:
    """Move a finished folder to a path or URL; on a disk it appears there whole or not at all.

    Raises:
        OSError: It cannot be written.
    """
    fs, path = filesystem(place)
    if not is_local(fs):
        fs.put(f"{made}/", f"{path}/", recursive=True)
        return
    target = Path(path)
    if target.exists():  # of a run whose record was never written, or is replaced now
        shutil.rmtree(target)
    made.rename(target)


def absolute(fs: Any, place: str) -> str:
    """Return the URL of a file of a store, or the absolute path of one on a disk."""
    return str(Path(place).absolute()) if is_local(fs) else str(fs.unstrip_protocol(place))


def is_local(fs: Any) -> bool:
    """True if a file system is that of this machine."""
    return "file" in (fs.protocol if isinstance(fs.protocol, tuple) else (fs.protocol,))


def _files(fs: Any, path: str) -> dict[str, str]:
    """Files that belong to an object, by their place from its folder: itself and what it names, or all of a folder."""
    if fs.isdir(path):
        top = posixpath.basename(path.rstrip("/"))
        return {posixpath.join(top, posixpath.relpath(file, path)): file for file in fs.find(path)}
    naming = _NAMING.get(PurePosixPath(path).suffix.lower())
    named = {match.decode(errors="replace") for match in naming.findall(fs.cat_file(path))} if naming else set()
    near = {name: posixpath.normpath(posixpath.join(posixpath.dirname(path), name)) for name in named if _is_near(name)}
    return {posixpath.basename(path): path, **{name: file for name, file in near.items() if fs.isfile(file)}}


def _is_near(name: str) -> bool:
    """True if a file is named by its place from the one that names it."""
    return not (name.startswith(("/", "data:")) or "://" in name)


def _root(pattern: str) -> str:
    """The folder of a pattern that stands before its first wildcard."""
    match = _MAGIC.search(pattern)
    return posixpath.dirname(pattern[: match.start()] if match else pattern.rstrip("/"))


def _name(path: str) -> str:
    stem = path[: -len(suffix)] if (suffix := PurePosixPath(path).suffix).lower() in _SUFFIXES else path
    return re.sub(r"[^\w.-]+", "_", stem.replace("/", "-")).strip(".-_") or "object"


def _short_hash(place: str) -> str:
    return hashlib.sha256(place.encode()).hexdigest()[:8]


def _below(place: str, folder: str) -> bool:
    return place == folder or place.startswith(f"{folder.rstrip('/')}/")
