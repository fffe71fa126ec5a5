"""How findings about the text of a URDF name lines, values and who answers for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.finding import Blame

if TYPE_CHECKING:
    from lxml.etree import _Element


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
