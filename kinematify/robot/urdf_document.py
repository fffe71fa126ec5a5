"""The elements of a well-formed URDF and how they refer to each other, whatever is wrong with them."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from lxml.etree import _Element


@dataclass(frozen=True, kw_only=True, eq=False)
class JointElement:
    """A joint with what it names; a name that is absent is empty."""

    element: _Element
    name: str
    kind: str
    parent: str
    child: str


@dataclass(frozen=True, kw_only=True, eq=False)
class UrdfDocument:
    """A well-formed document whose root is a robot; links may be missing, repeated or joined in circles."""

    robot: _Element

    @cached_property
    def links(self) -> list[_Element]:
        """Link elements in the order of the document."""
        return self.robot.findall("link")

    @cached_property
    def joints(self) -> list[JointElement]:
        """Joints in the order of the document."""
        return [
            JointElement(
                element=element,
                name=element.get("name") or "",
                kind=element.get("type") or "",
                parent=_end(element, "parent"),
                child=_end(element, "child"),
            )
            for element in self.robot.findall("joint")
        ]

    @cached_property
    def link_names(self) -> list[str]:
        """Names of links, the unnamed left out, in the order of the document."""
        return [name for link in self.links if (name := link.get("name"))]

    @cached_property
    def edges(self) -> list[JointElement]:
        """Joints between two links that are there and differ."""
        known = set(self.link_names)
        return [j for j in self.joints if j.parent in known and j.child in known and j.parent != j.child]

    @cached_property
    def below(self) -> dict[str, list[JointElement]]:
        """Edges that hang on a link, by its name."""
        found: dict[str, list[JointElement]] = defaultdict(list)
        for edge in self.edges:
            found[edge.parent].append(edge)
        return found

    @cached_property
    def roots(self) -> list[str]:
        """Links that no edge carries."""
        carried = {edge.child for edge in self.edges}
        return [name for name in dict.fromkeys(self.link_names) if name not in carried]

    def depths(self, start: Sequence[str]) -> dict[str, int]:
        """Joints between the links of `start` and each link below them, by name."""
        found = dict.fromkeys(start, 0)
        frontier = list(start)
        for link in frontier:
            for edge in self.below.get(link, ()):
                if edge.child not in found:
                    found[edge.child] = found[link] + 1
                    frontier.append(edge.child)
        return found

    def shapes(self) -> Iterator[tuple[str, _Element]]:
        """Every visual and collision element with the name of its link."""
        for link in self.links:
            name = link.get("name") or ""
            for tag in ("visual", "collision"):
                yield from ((name, element) for element in link.findall(tag))


def _end(joint: _Element, tag: str) -> str:
    element = joint.find(tag)
    return "" if element is None else element.get("link") or ""
