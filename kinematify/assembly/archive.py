"""Unpacking a ZIP that may be hostile: no path outside the folder, no link, no more bytes than allowed."""

from __future__ import annotations

import stat
import zipfile
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from kinematify.errors import AssemblyError
from kinematify.robot.mesh_paths import CAD_SUFFIXES, MESH_SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Sequence

WANTED_SUFFIXES = (*MESH_SUFFIXES, *CAD_SUFFIXES, ".bin", ".urdf")
"""Files that an assembly can consist of; nothing else is unpacked."""
_CHUNK = 1 << 20


def unpack(archive: Path, folder: Path, max_bytes: int) -> None:
    """Unpack the meshes of a ZIP into an existing folder, keeping its subfolders.

    Args:
        archive: The ZIP.
        folder: Where to.
        max_bytes: Cap on the unpacked size, as declared and as found.

    Raises:
        AssemblyError: It is no ZIP, is damaged or encrypted, names a file outside itself, holds a link, or is too big.
    """
    try:
        with zipfile.ZipFile(archive) as opened:
            entries = [entry for entry in opened.infolist() if not entry.is_dir()]
            for entry in entries:
                _check_entry(archive, entry)
            _check_size(archive, sum(entry.file_size for entry in entries), max_bytes)
            _extract(archive, opened, [entry for entry in entries if _is_wanted(entry.filename)], folder, max_bytes)
    # zipfile raises NotImplementedError where it does not know the compression, RuntimeError where one is encrypted.
    except (zipfile.BadZipFile, zipfile.LargeZipFile, EOFError, NotImplementedError, RuntimeError, OSError) as error:
        raise AssemblyError(
            f"The archive {archive} cannot be unpacked ({error}). It may be damaged: pack the mesh files again."
        ) from error


def check_packed_mesh(path: Path, max_bytes: int) -> None:
    """Refuse a 3MF, which is a ZIP inside, that would unpack to more than `max_bytes`.

    Raises:
        AssemblyError: It is too big. A damaged file passes: reading it gives the better message.
    """
    try:
        with zipfile.ZipFile(path) as opened:
            declared = sum(entry.file_size for entry in opened.infolist())
    except (zipfile.BadZipFile, OSError):
        return
    _check_size(path, declared, max_bytes)


def _check_entry(archive: Path, entry: zipfile.ZipInfo) -> None:
    name = entry.filename.replace("\\", "/")
    outside = name.startswith("/") or ".." in name.split("/") or ":" in name.split("/")[0]
    if outside or stat.S_ISLNK(entry.external_attr >> 16):
        raise AssemblyError(
            f"The archive {archive} holds {entry.filename!r}, which leads outside of the archive. Pack plain files "
            "with relative paths only; do not trust this archive."
        )
    if entry.flag_bits & 1:
        raise AssemblyError(f"The archive {archive} is encrypted. Unpack it yourself and give the folder.")


def _check_size(archive: Path, found: int, allowed: int) -> None:
    if found > allowed:
        raise AssemblyError(
            f"The archive {archive} unpacks to more than {allowed} bytes (assembly.max_archive_bytes). Simplify the "
            "meshes, or raise the limit in the configuration if you trust the archive."
        )


def _is_wanted(name: str) -> bool:
    path = PurePosixPath(name.replace("\\", "/"))
    # Dot files and __MACOSX hold attributes of the machine that packed the archive.
    hidden = any(word.startswith((".", "__MACOSX")) for word in path.parts)
    return not hidden and path.suffix.lower() in WANTED_SUFFIXES


def _extract(
    archive: Path, opened: zipfile.ZipFile, entries: Sequence[zipfile.ZipInfo], folder: Path, max_bytes: int
) -> None:
    total = 0
    for entry in entries:
        target = folder.joinpath(*PurePosixPath(entry.filename.replace("\\", "/")).parts)
        target.parent.mkdir(parents=True, exist_ok=True)
        with opened.open(entry) as source, target.open("wb") as sink:
            while chunk := source.read(_CHUNK):
                total += len(chunk)
                _check_size(archive, total, max_bytes)  # what a file declares need not be true
                sink.write(chunk)
