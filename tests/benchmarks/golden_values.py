"""What the items of a small subject of goldens give, in a module that processes import quickly."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from benchmarks.goldens.values import made

_VALUES = {"left": 0.5, "right": [1, 2], "gone": "word"}


def values_of(item: str) -> dict[str, Any]:
    """Two values; ``crash`` ends the process, and a path counts in its file how often it was asked for."""
    if item == "crash":
        os.abort()
    if item in _VALUES:
        return made(exact={item: _VALUES[item]}, portable={"name": item})
    runs = Path(item)
    text = runs.read_text() if runs.exists() else ""
    if text != "always the same":
        runs.write_text(f"{text}I")
    return made(spread={"runs": text})
