"""Answers of generators, recorded once and replayed without key, network or program: in tests, offline, for others."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError, OutputError
from kinematify.generate.providers.found_parts import found_parts
from kinematify.generate.providers.source import Generated, Provenance

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.generate.providers.job import Job
    from kinematify.generate.providers.prompt import Prompt
    from kinematify.generate.providers.source import PartSource, Progress

_FILES, _FACTS = "files", "provenance.json"
_NAMED = 16  # digits of the digest that name a recording


@dataclass(frozen=True)
class _Taped:
    """A source beside a folder of recordings; requests are those of the source."""

    source: PartSource
    folder: Path

    @property
    def name(self) -> str:
        """That of the source."""
        return self.source.name

    def options(self) -> dict[str, object]:
        """Those of the source."""
        return self.source.options()


class RecordingSource(_Taped):
    """Asks the source, and keeps what it made."""

    def generate(self, prompt: Prompt, job: Job, progress: Progress) -> Generated:
        """See `PartSource`."""
        made = self.source.generate(prompt, job, progress)
        place = self.folder / job.digest[:_NAMED]
        try:
            shutil.rmtree(place, ignore_errors=True)
            (place / _FILES).mkdir(parents=True)
            kept = made.path.iterdir() if made.path.is_dir() else (made.path, made.labels)
            for file in kept:
                if file is not None and file.is_file():
                    shutil.copy(file, place / _FILES / file.name)
            facts = json.dumps(made.provenance.as_json(), indent=1)
            (place / _FACTS).write_text(facts + "\n", encoding="utf-8")
        except OSError as error:
            raise OutputError(f"The recording cannot be written to {place} ({error.strerror}).") from error
        return made


class ReplayedSource(_Taped):
    """Gives what was recorded for the same request, and nothing else."""

    def generate(self, prompt: Prompt, job: Job, progress: Progress) -> Generated:
        """See `PartSource`.

        Raises:
            InputError: Nothing was recorded for this request.
        """
        del prompt
        place = self.folder / job.digest[:_NAMED]
        if not (place / _FACTS).is_file():
            raise InputError(
                f"Nothing is recorded in {self.folder} for this request. Text, images, seed and options have to be the "
                "same as when it was recorded; --record records it."
            )
        progress("replaying a recording", 1.0)
        facts = json.loads((place / _FACTS).read_text(encoding="utf-8"))
        path, labels = found_parts(place / _FILES)
        provenance = Provenance(**{**facts, "images": tuple(facts["images"])})
        return Generated(path=path, labels=labels, provenance=provenance)
