"""Objects of the built-in generator, for a night that needs no data."""

from __future__ import annotations

import os
import shutil
from typing import TYPE_CHECKING

from kinematify.config import load_config
from kinematify.generate.request import from_text
from kinematify.pipeline.generate import write_blueprint

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def write_smoke_objects(folder: Path, sentences: Sequence[str]) -> None:
    """Write an object with known joints for each sentence, if it is not there yet.

    Args:
        folder: Gets a folder per object.
        sentences: As `kinematify generate --text` takes them.

    Raises:
        InputError: A sentence is not understood.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for number, sentence in enumerate(sentences, start=1):
        blueprint = from_text(sentence).build(seed=0)
        place = folder / f"{blueprint.name}_{number}"
        if place.is_dir():
            continue
        aside = folder / f".{place.name}.{os.getpid()}"
        shutil.rmtree(aside, ignore_errors=True)
        write_blueprint(blueprint, aside, load_config())
        aside.rename(place)
