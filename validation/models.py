"""Which models a user means: files, folders at any depth, and patterns."""

from __future__ import annotations

import glob
import os
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.robot.description import SUFFIXES
from kinematify.robot.known_robots import robot_named
from kinematify.robot.urdf_text import missing_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_KINDS = ".urdf, .xacro, .mjcf, .sdf or .usd"
_SHOWN_KINDS = 5


def find_models(words: Sequence[str]) -> tuple[Path, ...]:
    """Return the files that `words` represent, each once, in the order of the words and sorted within a word.

    Args:
        words: A file is taken as it is, whatever its name; a folder represents all ``.urdf`` files below it, or the
            descriptions of other formats where there is none (links to
            folders are not followed, so that loops of them do no harm); other words are patterns as in a shell, in
            which ``**`` represents any folders.

    Raises:
        InputError: A word names nothing, or something that is neither a file nor a folder.
    """
    found = [path for word in words for path in _models_of(word)]
    once = {os.path.realpath(path): path for path in reversed(found)}
    return tuple(dict.fromkeys(path for path in found if once[os.path.realpath(path)] is path))


def _models_of(word: str) -> list[Path]:
    path = Path(word)
    if path.is_dir():
        return _below(path)
    if path.is_file():
        return [path]
    if path.exists():
        raise InputError(f"{word} is neither a file nor a folder. Give a URDF file or a folder with URDF files.")
    if glob.has_magic(word):
        return _matching(word)
    named = robot_named(word)
    if named is not None:
        return [named]
    raise InputError(missing_file(path))


def _below(folder: Path) -> list[Path]:
    files = [Path(where, name) for where, _, names in os.walk(folder) for name in names]
    models = _models_among(files)
    if not models:
        raise InputError(f"The folder {folder} holds no {_KINDS} file at any depth. {_described(files)}")
    return models


def _matching(pattern: str) -> list[Path]:
    matches = [Path(name) for name in sorted(glob.glob(pattern, recursive=True))]  # noqa: PTH207 - a pattern may be absolute
    models = [path for path in matches if path.is_file()]
    folders = [path for path in matches if path.is_dir()]
    for folder in folders if not models else ():
        models += _models_among(folder.rglob("*"))
    if not models:
        raise InputError(
            f"Nothing matches the pattern {pattern}"
            + (f" but {len(folders)} folders without any {_KINDS} file. " if folders else ". ")
            + "Give the pattern in quotes, with ** for folders at any depth, such as 'models/**/*.urdf'."
        )
    return models


def _models_among(files: Iterable[Path]) -> list[Path]:
    """The URDFs, or descriptions of other formats where there is none: macros of xacro and parts of scenes are none."""
    known = sorted(file for file in files if file.suffix.lower() in SUFFIXES and file.is_file())
    return [file for file in known if file.suffix.lower() == ".urdf"] or known


def _described(files: Iterable[Path]) -> str:
    """Return what lies in a folder instead."""
    kinds = Counter(file.suffix.lower() or "no suffix" for file in files)
    if not kinds:
        return "It is empty. Give the folder that holds the models."
    shown = ", ".join(f"{count} with {kind}" for kind, count in kinds.most_common(_SHOWN_KINDS))
    return f"It holds {sum(kinds.values())} other files ({shown}). Give descriptions or their folder."
