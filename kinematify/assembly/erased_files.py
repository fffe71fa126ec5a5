"""An erased model on disk: a folder of anonymous meshes, and the truth beside it, never inside."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.errors import OutputError
from kinematify.robot.obj_file import write_obj

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.assembly.truth import GroundTruth

TRUTH_SUFFIX = ".truth.json"
"""Files that end so are the benchmark's business; `load_assembly` opens none of them."""


def truth_path(folder: Path) -> Path:
    """Return where the truth about the parts in `folder` is kept."""
    absolute = folder.absolute()
    return absolute.with_name(absolute.name + TRUTH_SUFFIX)


def write_parts(parts: Sequence[Part], truth: GroundTruth, folder: Path) -> Path:
    """Write one OBJ per part into a new folder, without loss, and the truth beside the folder.

    Args:
        parts: The anonymous parts.
        truth: What is known about them.
        folder: Does not exist yet, or is empty.

    Returns:
        The path of the truth, ``FOLDER.truth.json``.

    Raises:
        OutputError: The folder or the truth exists already, or cannot be written. Nothing is left half-written.
    """
    target, truth_file = folder.absolute(), truth_path(folder)
    if truth_file.exists() or (target.exists() and not _is_empty_folder(target)):
        raise OutputError(
            f"The output {folder} (or the truth {truth_file.name} beside it) exists already. Remove both, or give "
            "another folder."
        )
    try:
        _write_aside_and_rename(parts, truth, target, truth_file)
    except OSError as error:
        raise OutputError(
            f"The output {folder} cannot be written ({error.strerror}). Give a folder that you may write to, on a disk "
            "with space."
        ) from error
    return truth_file


def _is_empty_folder(path: Path) -> bool:
    return path.is_dir() and not any(path.iterdir())


def _write_aside_and_rename(parts: Sequence[Part], truth: GroundTruth, target: Path, truth_file: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    aside = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    try:
        (aside / "parts").mkdir()
        for part in parts:
            write_obj(aside / "parts" / f"{part.name}.obj", part.vertices, part.faces)
        (aside / "truth").write_text(truth.to_json(), encoding="utf-8")
        (aside / "truth").rename(truth_file)
        (aside / "parts").rename(target)
    finally:
        shutil.rmtree(aside, ignore_errors=True)
