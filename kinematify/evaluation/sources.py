"""What a result depends on: the sources that gave it, as a hash, and the commit that they stand at."""

from __future__ import annotations

import hashlib
import os
import subprocess
from pathlib import Path

from kinematify import __version__

_PACKAGE = Path(__file__).resolve().parents[1]
NOT_INFERRING = (
    "batch", "cli", "configs", "envs", "generate", "manipulation", "refinement", "simulation", "validation", "view",
    "vision",
    "benchmarks/studies", "evaluation/nightly", "evaluation/mutants", "evaluation/corruption",
    *(
        f"evaluation/{name}.py"
        for name in (
            "calibration", "degrade_tables", "error_pictures", "errors", "paper", "readme", "record",
            "regression", "report", "run", "study", "summary", "tables",
        )
    ),
)  # fmt: skip
"""What neither infers nor scores; configurations count by their values."""


def code_version(*, without: tuple[str, ...] = ()) -> str:
    """Hash of the package's sources and settings: results of other code are not taken up.

    Args:
        without: Files and folders of the package, ``/`` between names, that a result does not depend on.
    """
    digest = hashlib.sha256()
    # `validation`, `envs` and `configs` stand behind links.
    paths = (Path(folder, file) for folder, _, files in os.walk(_PACKAGE, followlinks=True) for file in files)
    for path in sorted(path for path in paths if path.suffix in (".py", ".yaml")):
        place = path.relative_to(_PACKAGE).as_posix()
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
