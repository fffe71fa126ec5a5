"""Inferences that several tests look at: a process makes each of them once."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import kinematify
from kinematify.pipeline.record import write_inference
from tests.household import four_bars
from tests.objects import BUILDERS
from tests.places import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.pipeline.inference import Inference

EXAMPLE = ROOT / "examples" / "cabinet"


@cache
def inferred(name: str) -> Inference:
    """What is found by default in an object with known joints, in the four bars or in the bundled ``cabinet``."""
    if name == "cabinet":
        return kinematify.infer(EXAMPLE)
    return kinematify.infer({**BUILDERS, "four_bars": four_bars}[name]().assembly)


def write_inferred(name: str, folder: Path) -> Path:
    """Write that inference as a model folder, without a picture."""
    write_inference(inferred(name), folder, preview=False)
    return folder
