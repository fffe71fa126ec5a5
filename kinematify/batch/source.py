"""What is converted: files and folders on disks and in stores, by pattern, each with a name of its own."""

from __future__ import annotations

import hashlib
import posixpath
import re
import shutil
from collections import Counter
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from kinematify.assembly.load import PART_SUFFIXES
from kinematify.errors import EnvironmentFault, InputError

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


@dataclass(frozen=True, kw_only=True)
class Source:
    """One object."""

    name: str
    """Of its folder in the output; each has its own."""
    place: str
    """Path or URL of a file, or of a folder with a file for each part."""


def find_sources(patterns: Sequence[str], *, besides: str | None = None) -> tuple[Source, ...]:
    """Return what the patterns match, by place.

    An object is named after its path below the part of the pattern that has no wildcard: ``kitchen-oven`` for
    ``assets/kitchen/oven.glb`` of ``assets/**/*.glb``. Names that would be equal end with a hash of the place.

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
        found = [place for place in fs.glob(path) if besides is None or not _below(absolute(fs, place), besides)]
        if not found:
            raise InputError(
                f"{pattern} matches no file and no folder. Give paths, or patterns in quotes such as 'assets/**/*.glb'."
            )
        root = _root(path)
        names.update({absolute(fs, place): _name(posixpath.relpath(place, root)) for place in found})
    times = Counter(names.values())
    return tuple(
        Source(name=name if times[name] == 1 else f"{name}-{_short_hash(place)}", place=place)
        for place, name in sorted(names.items())
    )


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
            f"{place} needs a package that is not installed: {error}. Run `pip install kinematify[cloud]` for "
            "s3://, or install the package that the message names."
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
    """Whether a file system is that of this machine."""
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
    """Whether a file is named by its place from the one that names it."""
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
