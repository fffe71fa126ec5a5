"""What a result depends on: the sources that gave it, as a hash, and the commit that they stand at."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import subprocess
from pathlib import Path

from kinematify import __version__

_PACKAGE = Path(__file__).resolve().parents[1]
NOT_INFERRING = (
    "batch", "cli", "configs", "envs", "generate", "manipulation", "refinement", "simulation", "validation", "view",
    "vision",
    "evaluation/nightly",
    *(f"evaluation/{name}.py" for name in ("paper", "record", "regression", "run", "summary")),
)  # fmt: skip
"""What neither infers nor scores; configurations count by their values."""


def code_version(*, without: tuple[str, ...] = (), module: str = "") -> str:
    """Hash of the package's sources and settings: results of other code are not taken up.

    Args:
        without: Files and folders of the package, ``/`` between names, that a result does not depend on.
        module: Of another package whose sources count too.
    """
    digest = hashlib.sha256()
    origin = importlib.util.find_spec(module.partition(".")[0]) if module else None
    folders = [_PACKAGE, *(origin.submodule_search_locations or () if origin is not None else ())]
    # `validation`, `envs` and `configs` stand behind links.
    paths = (
        (Path(root, file), Path(root, file).relative_to(top).as_posix())
        for top in folders
        for root, _, files in os.walk(top, followlinks=True)
        for file in files
    )
    for path, place in sorted((path, place) for path, place in paths if path.suffix in (".py", ".yaml")):
        if not any(place == left or place.startswith(f"{left}/") for left in without):
            digest.update(place.encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def git_commit() -> tuple[str, bool]:
    """Return the commit of the sources and whether they differ from it; the version where there is no checkout."""
    commit = _git("rev-parse", "--short=7", "HEAD")
    if not (_PACKAGE.parent / ".git").exists() or not commit:
        return f"v{__version__}", False
    return commit, bool(_git("status", "--porcelain", "--untracked-files=no"))


def _git(*words: str) -> str:
    try:
        done = subprocess.run(
            ["git", "-C", str(_PACKAGE.parent), *words], capture_output=True, text=True, timeout=30, check=True
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()
