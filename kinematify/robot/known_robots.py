"""Robots by the names that the package `robot_descriptions` gives them, where it and its cache are present."""

from __future__ import annotations

import importlib
import os
import re
from importlib.util import find_spec
from pathlib import Path

from kinematify.errors import InputError

_PACKAGE = "robot_descriptions"


def robot_named(name: str) -> Path | None:
    """Return the description of a robot such as ``panda``; None if the package is not installed or has no such name.

    Nothing is downloaded.

    Raises:
        InputError: The robot is not in the cache, or it is a xacro that needs arguments.
    """
    found = find_spec(_PACKAGE) if re.fullmatch(r"\w+", name) else None
    if found is None or found.origin is None:
        return None
    module = name if name.endswith("_description") else f"{name}_description"
    source = Path(found.origin).with_name(f"{module}.py")
    repository = re.search(r'_clone_to_cache\(\s*"([^"]+)"', source.read_text("utf-8")) if source.is_file() else None
    if repository is None:
        return None
    cache = Path(os.environ.get("ROBOT_DESCRIPTIONS_CACHE", "~/.cache/robot_descriptions")).expanduser()
    stored = importlib.import_module(f"{_PACKAGE}._repositories").REPOSITORIES[repository[1]].cache_path
    commit = os.environ.get("ROBOT_DESCRIPTION_COMMIT")
    if not (cache / (f"{stored}-{commit}/{stored}" if commit else stored)).is_dir():
        raise InputError(
            f"{name} is a robot of {_PACKAGE} that is not in its cache {cache}. Run: python -m {_PACKAGE} pull {module}"
        )
    robot = importlib.import_module(f"{_PACKAGE}.{module}")
    arguments = getattr(robot, "XACRO_ARGS", {})
    if arguments:
        words = " ".join(f"{key}:={value}" for key, value in arguments.items())
        raise InputError(f"{name} is a xacro. Give its file and arguments: {robot.XACRO_PATH} {words}")
    return Path(getattr(robot, "URDF_PATH", None) or getattr(robot, "XACRO_PATH", None) or robot.MJCF_PATH)
