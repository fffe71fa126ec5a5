"""A model folder appears whole or not at all: it is written aside and renamed."""

from __future__ import annotations

import os
import secrets
import shutil
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.errors import InputError, OutputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

MODEL_FILE = "model.urdf"
PREVIEW_FILE = "preview.png"
RECORD_FILE = "inference.json"
SOURCE_FILE = "source.json"
"""What an object of the generator was built with."""


def write_model_folder(out: Path, write: Callable[[Path], None], *, overwrite: bool) -> None:
    """Make `write` fill a hidden folder beside `out`, then give it the name `out`.

    On any failure, an interrupt included, the hidden folder and parent folders made here are removed and a folder that
    was at `out` before is still there.

    Args:
        out: The folder to make; missing parents are made too.
        write: Writes the files into the folder that it is given.
        overwrite: Replace `out` if it is an empty folder or a model folder; nothing else is ever replaced.

    Raises:
        OutputError: `out` exists and must not be replaced, or cannot be written.
    """
    check_output(out, overwrite=overwrite)
    target = out.resolve()
    missing = [folder for folder in target.parents if not folder.exists()]
    staging = target.parent / f".{target.name}.{secrets.token_hex(4)}"
    try:
        staging.mkdir(parents=True)
        write(staging)
        _rename(staging, target)
    except BaseException as error:
        shutil.rmtree(staging, ignore_errors=True)
        for folder in missing:
            with suppress(OSError):
                folder.rmdir()
        if isinstance(error, OSError):
            raise OutputError(
                f"The output folder {out} cannot be written ({error.strerror or error}). "
                "Give another place with -o, or change its permissions or free disk space."
            ) from error
        raise


def urdf_of(model: Path, package_dirs: Sequence[Path] = (), arguments: Mapping[str, str] | None = None) -> Path:
    """Return the URDF of a model folder, or the only one of another folder; a URDF is itself.

    Args:
        model: The folder or file.
        package_dirs: Where packages lie, for a file of another format, which a temporary URDF then represents.
        arguments: Of a xacro.

    Raises:
        InputError: There is no such file, it cannot be read, or the folder has no URDF or several.
    """
    if not model.is_dir():
        from kinematify.robot.known_robots import robot_named  # noqa: PLC0415

        model = model if model.is_file() else robot_named(str(model)) or model
        if not model.is_file():
            raise InputError(f"There is no file {model}. Give a URDF, or a model folder that `kinematify infer` wrote.")
        from kinematify.robot.description import urdf_for  # noqa: PLC0415 - loads NumPy, which --help needs not

        return urdf_for(model, package_dirs, arguments)
    found = [model / MODEL_FILE] if (model / MODEL_FILE).is_file() else sorted(model.glob("*.urdf"))
    if len(found) != 1:
        what = f"{len(found)} URDF files ({', '.join(item.name for item in found[:3])})" if found else "no URDF file"
        raise InputError(f"The folder {model} has {what} and no {MODEL_FILE}. Give the URDF file itself.")
    return found[0]


def check_file(out: Path, *, overwrite: bool) -> None:
    """Refuse a file that must not be replaced or cannot be made, so that a long run need not end in vain.

    Raises:
        OutputError: `out` exists and must not be replaced, or its folder cannot be written.
    """
    if out.is_dir() or (out.is_file() and not overwrite):
        what, remedy = ("is a folder", "") if out.is_dir() else ("exists already", ", or --force to replace it")
        raise OutputError(f"The output {out} {what}. Give another file with -o{remedy}.")
    _check_parent(out, "file")


def check_output(out: Path, *, overwrite: bool) -> None:
    """Refuse an output place that must not be written, so that a long run need not end in vain.

    Args:
        out: The folder that is going to be made.
        overwrite: Whether an empty folder or a model folder may be replaced.

    Raises:
        OutputError: `out` exists and must not be replaced, or its parent cannot be written.
    """
    if os.path.lexists(out):
        _check_replaceable(out, overwrite)
    _check_parent(out, "folder")


def _check_parent(out: Path, what: str) -> None:
    parent = next(folder for folder in out.resolve().parents if folder.exists())
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        raise OutputError(
            f"The output {what} {out} cannot be made because {parent} is not writable. "
            "Give another place with -o, or change its permissions."
        )


def _check_replaceable(out: Path, overwrite: bool) -> None:
    if not overwrite:
        raise OutputError(
            f"The output folder {out} exists already. Give another one with -o, or --force to replace it."
        )
    if not out.is_dir():
        raise OutputError(
            f"The output {out} exists and is not a folder, so --force leaves it. Give another one with -o."
        )
    recorded = (out / RECORD_FILE).is_file() or (out / SOURCE_FILE).is_file()
    ours = (out / MODEL_FILE).is_file() and recorded
    if not ours and any(out.iterdir()):
        raise OutputError(
            f"The output folder {out} holds files but no {MODEL_FILE} with {RECORD_FILE} or {SOURCE_FILE}, so it is "
            "not a model folder and --force leaves it as it is. Give another one with -o, or remove it yourself."
        )


def _rename(staging: Path, target: Path) -> None:
    """Move the finished folder into place; what stood there is put aside first and comes back if that fails."""
    if not target.exists():
        staging.rename(target)
        return
    aside = staging.with_name(f"{staging.name}.old")
    target.rename(aside)
    try:
        staging.rename(target)
    except BaseException:
        aside.rename(target)
        raise
    shutil.rmtree(aside, ignore_errors=True)
