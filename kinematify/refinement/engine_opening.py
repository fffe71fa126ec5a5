"""Which engines open a file as it is, each asked in a process of its own: some crash, one prints."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

_SECONDS = 300.0
"""An engine that takes longer does not open it [s]."""
_CODE = """import sys
from pathlib import Path
from kinematify.simulation.engines import load_file
from kinematify.simulation.engine_file import Unloadable
engine, urdf, *folders = sys.argv[1:]
try:
    load_file(engine, Path(urdf), "", [Path(folder) for folder in folders])
except Unloadable as error:
    sys.exit(f"\\0{error}" if not error.floats else 0)
"""


def refusals(urdf: Path, engines: Sequence[str], package_dirs: Sequence[Path] = ()) -> dict[str, str]:
    """Load a file raw into engines and return what those say that do not open it.

    Args:
        urdf: The file.
        engines: Of `kinematify.simulation.engines.ENGINES`.
        package_dirs: Where packages lie, for engines that are given folders.
    """
    folders = [str(folder.resolve()) for folder in package_dirs]
    running = {
        engine: subprocess.Popen(
            [sys.executable, "-c", _CODE, engine, str(urdf.resolve()), *folders],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
        )
        for engine in engines
    }
    found = {}
    for engine, process in running.items():
        try:
            _, said = process.communicate(timeout=_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            found[engine] = f"it took longer than {_SECONDS:g} s"
            continue
        if process.returncode != 0:
            _, marked, message = said.rpartition("\0")
            found[engine] = message.strip() if marked else f"it crashed with status {process.returncode}"
    return found
