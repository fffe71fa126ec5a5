"""The protocol of all generators: a prompt goes in, files with segmented meshes and where they come from come out."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.generate.providers.job import Job
    from kinematify.generate.providers.prompt import Prompt

    Progress = Callable[[str, float], None]


@dataclass(frozen=True, kw_only=True)
class Provenance:
    """Where parts come from; it is written into ``inference.json``."""

    provider: str
    model: str
    """Name and version as far as the provider tells them."""
    text: str | None
    images: tuple[str, ...]
    """File names."""
    seed: int
    licence: str
    """Whose terms hold for the result, one sentence."""
    cost: str | None = None
    """What it cost as far as is known."""
    details: dict[str, Any] = field(default_factory=dict)
    """Settings and identifiers of the provider."""

    def as_json(self) -> dict[str, Any]:
        """The same as JSON values."""
        return asdict(self)


@dataclass(frozen=True, kw_only=True)
class Generated:
    """What a generator made."""

    path: Path
    """File or folder that `kinematify.load_assembly` reads."""
    labels: Path | None
    """Labels per triangle if `path` is one mesh with labels."""
    provenance: Provenance


class PartSource(Protocol):
    """A generator of segmented meshes."""

    @property
    def name(self) -> str:
        """What jobs of it are called."""
        ...

    def options(self) -> dict[str, object]:
        """What besides the prompt decides the result: part of the identity of a job."""
        ...

    def generate(self, prompt: Prompt, job: Job, progress: Progress) -> Generated:
        """Make the parts, going on where an earlier call of the same job was stopped.

        Args:
            prompt: What to build.
            job: Folder and state of this request; everything that is made stays in it.
            progress: Told what is being done and the share that is done.

        Raises:
            InputError: The request, the key or the credit is not accepted.
            EnvironmentFault: The provider or the network failed; the job can be resumed.
        """
        ...
