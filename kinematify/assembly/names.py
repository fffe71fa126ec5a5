"""Part names: from what the input calls its parts to names that XML, file systems and engines accept."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

_LONGEST = 64
"""Characters; names go into file names, and engines have crashed on long ones."""
_RESERVED = ("world",)
"""MuJoCo, Gazebo and URDF tools give this name to the fixed frame."""


def part_names(originals: Sequence[str]) -> tuple[str, ...]:
    """Return unique names of ASCII letters, digits, ``_``, ``-`` and ``.``, as near to the originals as possible.

    Names that clash get a number: the first keeps its name. Upper and lower case count as equal, because the names
    become file names.

    Args:
        originals: What the input calls the parts, in order.
    """
    taken: set[str] = set()
    names = []
    for original in originals:
        wanted = _plain(original)
        name, count = wanted, 1
        while name.casefold() in taken:
            count += 1
            name = f"{wanted}_{count}"
        taken.add(name.casefold())
        names.append(name)
    return tuple(names)


def _plain(original: str) -> str:
    # Decomposed, an accented letter is a plain one and a mark, and the mark goes.
    letters = "".join(c for c in unicodedata.normalize("NFKD", original) if not unicodedata.combining(c))
    name = re.sub(r"[^A-Za-z0-9_.-]+", "_", letters).strip("_.-")[:_LONGEST]
    if not name:
        return "part"
    return f"{name}_part" if name.casefold() in _RESERVED else name


def natural_key(name: str) -> tuple[tuple[int, int, str], ...]:
    """Return a sorting key under which ``part_10`` comes after ``part_9``."""
    words = re.split(r"(\d+)", name)
    return tuple((0, int(word), word) if word.isdecimal() else (1, 0, word) for word in words)
