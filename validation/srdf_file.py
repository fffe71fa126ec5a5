"""The SRDF of a URDF: it names groups and states of joints, and pairs of links that planners do not check."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.robot.urdf_text import parse_text

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from lxml.etree import _Element

_FOLDERS = ("", "../srdf", "../config")
"""Where it lies, from the folder of the URDF."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Srdf:
    """A file and what it says."""

    path: Path
    robot: _Element

    @cached_property
    def disabled(self) -> dict[frozenset[str], str]:
        """Reason why a pair of links is not checked, by the two links."""
        pairs = self.robot.iterfind("disable_collisions")
        return {frozenset((item.get("link1", ""), item.get("link2", ""))): item.get("reason", "") for item in pairs}


def srdf_of(urdf: Path, name: str, links: Collection[str]) -> Srdf | None:
    """Return the SRDF beside a file: the one of its name, else the only one of a robot of that name and these links.

    Args:
        urdf: The file.
        name: Of its robot.
        links: Names of its links.
    """
    found = []
    for path in (path for folder in _FOLDERS for path in sorted((urdf.parent / folder).glob("*.srdf"))):
        try:
            robot = parse_text(path.read_bytes())
        except (OSError, etree.XMLSyntaxError):
            continue
        srdf = Srdf(path=path, robot=robot)
        if path.stem == urdf.stem or (robot.get("name") == name and all(map(set(links).issuperset, srdf.disabled))):
            found.append(srdf)
    own = [item for item in found if item.path.stem == urdf.stem] or found
    return own[0] if len(own) == 1 else None
