"""What a probe of the document hands back, before it becomes a finding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import line_of
from kinematify.validation.finding import Blame, Severity

if TYPE_CHECKING:
    from lxml.etree import _Element

    from kinematify.validation.stage import OpenCheck


__all__ = ["Problem", "blame_of", "line_of", "shown"]


@dataclass(frozen=True, kw_only=True)
class Problem:
    """One thing that is wrong with the text; severity and blame are those of the check unless given."""

    message: str
    remedy: str
    severity: Severity | None = None
    blame: Blame | None = None
    joint: str | None = None
    link: str | None = None
    value: float | None = None
    limit: float | None = None
    unit: str | None = None
    line: int | None = None
    harmless: bool = False
    """True where later stages may read the file although it is an error."""

    def add_to(self, check: OpenCheck) -> None:
        """Turn it into a finding."""
        check.find(
            self.message,
            self.remedy,
            severity=self.severity,
            blame=self.blame,
            joint=self.joint,
            link=self.link,
            value=self.value,
            limit=self.limit,
            unit=self.unit,
            line=self.line,
        )


def blame_of(element: _Element) -> Blame:
    """Who answers for a number, by the nearest ancestor that tells."""
    for item in (element, *element.iterancestors()):
        if item.tag in ("inertial", "collision", "dynamics", "limit"):
            return Blame.KINEMATICS if item.tag == "limit" else Blame.PHYSICS
        if item.tag in ("visual", "joint"):
            return Blame.ASSET if item.tag == "visual" else Blame.KINEMATICS
    return Blame.ASSET


def shown(text: str | None, most: int = 60) -> str:
    """A value as it stands in the file, cut where it is very long."""
    if text is None:
        return "nothing"
    return repr(text) if len(text) <= most else f"{text[:most]!r}... ({len(text)} characters)"
