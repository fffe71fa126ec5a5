"""From a seed and a number to one corrupted model on disk; the same number always gives the same model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.corruption import meshes, text

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from benchmarks.corruption.bases import Base

KINDS = (*text.CORRUPTIONS, *meshes.CORRUPTIONS)
_BUILT_SHARE = 0.5
"""Share of the model with a mesh of every format; the rest is drawn from all."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A corrupted model."""

    number: int
    kind: str
    base: str
    urdf: Path


def write_case(number: int, seed: int, bases: Sequence[Base], folder: Path) -> Case:
    """Write the corrupted model of a number into an empty folder."""
    random = np.random.default_rng([seed, number])
    kind = KINDS[number % len(KINDS)]
    base = bases[0] if random.random() < _BUILT_SHARE else bases[int(random.integers(len(bases)))]
    names = sorted(base.meshes)
    harmed = names[int(random.integers(len(names)))] if kind in meshes.CORRUPTIONS and names else None
    for name, path in base.meshes.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(path.read_bytes())
    urdf = folder / "model.urdf"
    if harmed is not None:
        meshes.CORRUPTIONS[kind](folder / harmed, random)
        urdf.write_bytes(base.text)
    else:
        # A model without mesh files loses bytes of its text instead.
        urdf.write_bytes(text.CORRUPTIONS.get(kind, text.flip_bits)(base.text, random))
    return Case(number=number, kind=kind, base=base.name, urdf=urdf)
