"""What all probes are given: the document, and what a run says of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import UrdfDocument

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.config.validation import FileSettings
    from kinematify.validation.stage import StageRequest


@dataclass(frozen=True, kw_only=True, eq=False)
class Urdf(UrdfDocument):
    """A document with its text, where it lies, and the caps."""

    text: bytes
    folder: Path
    """Where relative mesh paths begin."""
    package_dirs: tuple[Path, ...]
    settings: FileSettings

    @classmethod
    def of(cls, robot: _Element, request: StageRequest, text: bytes) -> Urdf:
        """Put together what the probes need."""
        return cls(
            robot=robot,
            text=text,
            folder=request.urdf.resolve().parent,
            package_dirs=tuple(folder.resolve() for folder in request.package_dirs),
            settings=request.settings.file,
        )
