"""Context of all checks of the text: the document, and how they name its values and who answers for them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import UrdfDocument
from kinematify.validation.finding import Cause

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
    losses: tuple[str, ...]
    """What the file holds and the URDF does not, one sentence each."""

    @classmethod
    def of(cls, robot: _Element, request: StageRequest, text: bytes) -> Urdf:
        """Put together what the probes need."""
        return cls(
            robot=robot,
            text=text,
            folder=request.urdf.resolve().parent,
            package_dirs=tuple(folder.resolve() for folder in request.package_dirs),
            settings=request.settings.file,
            losses=request.losses,
        )


def cause_of(element: _Element) -> Cause:
    """Who answers for a number, by the nearest ancestor that tells."""
    for item in (element, *element.iterancestors()):
        if item.tag in ("inertial", "collision", "dynamics", "limit"):
            return Cause.KINEMATICS if item.tag == "limit" else Cause.PHYSICS
        if item.tag in ("visual", "joint"):
            return Cause.ASSET if item.tag == "visual" else Cause.KINEMATICS
    return Cause.ASSET


def shown(text: str | None, most: int = 60) -> str:
    """A value as it is in the file, cut where it is very long."""
    if text is None:
        return "nothing"
    return repr(text) if len(text) <= most else f"{text[:most]!r}... ({len(text)} characters)"
