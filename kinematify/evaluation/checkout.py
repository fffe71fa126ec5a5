"""Find `benchmarks/`, which lies beside the package in a checkout and which no wheel brings."""

from __future__ import annotations

import importlib
import re
import sys
from pathlib import Path
from typing import Any

from kinematify import __version__
from kinematify.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
"""Folder that the package lies in."""
_MARK = re.compile(r'^KINEMATIFY_VERSION = "(.+)"$', flags=re.MULTILINE)
_ADVICE = (
    f"It is part of Kinematify's repository. Get the sources of version {__version__}, install them with "
    "`pip install -e '.[bench,fit]'`, and call the command again."
)


def has_benchmarks() -> bool:
    """True if `benchmarks/` of this version lies beside the package.

    Raises:
        InputError: It is there, and of another version.
    """
    try:
        found = _MARK.search((ROOT / "benchmarks" / "__init__.py").read_text("utf-8"))
    except OSError:
        return False
    if found is not None and found[1] != __version__:
        raise InputError(
            f"{ROOT / 'benchmarks'} belongs to version {found[1]}, and this is Kinematify {__version__}. Check out "
            "one version of both; nothing was measured."
        )
    return found is not None


def benchmark_module(name: str, asked: str) -> Any:
    """Import a module of `benchmarks/`.

    Args:
        name: Of the module, without `benchmarks`.
        asked: What the user asked for, for the message.

    Raises:
        InputError: `benchmarks/` is not beside the package, or of another version.
    """
    if not has_benchmarks():
        raise InputError(f"{asked} needs the folder benchmarks/, which is not at {ROOT / 'benchmarks'}. {_ADVICE}")
    if str(ROOT) != sys.path[0]:  # before another package of that name
        sys.path.insert(0, str(ROOT))
    module = importlib.import_module(f"benchmarks.{name}")
    if ROOT / "benchmarks" not in Path(str(module.__file__)).resolve().parents:
        raise InputError(
            f"{asked} needs {ROOT / 'benchmarks'}, and Python finds {module.__file__} instead. Call it from another "
            "folder."
        )
    return module
