"""Numbers in the attributes of a URDF: finite, of the right count, or one clear error."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.transforms import rotation_from_quaternion, rotation_from_rpy

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from lxml.etree import _Element

    from kinematify.robot.arrays import FloatArray


MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
"""Names of the moments of inertia, in URDF and SDF."""
COUNTS = {1: "one finite number", 3: "three finite numbers", 4: "four finite numbers"}
"""What an attribute holds, by how many."""
_SELF_COLLISION = ("selfCollide", "self_collide")
"""Elements by which Gazebo's extensions say whether a link collides with its own model."""


def vector(
    element: _Element, attribute: str, default: Sequence[float] | None, where: str, count: int = 3
) -> FloatArray:
    """Return finite numbers of an attribute, three if `count` says nothing else, shape (count,).

    Args:
        element: Where to look.
        attribute: Name of the attribute.
        default: Value of an absent attribute; None if it must be there.
        where: The link or joint, for the message.
        count: Of the numbers.

    Raises:
        DescriptionError: The attribute is absent, or anything but so many finite numbers.
    """
    text = element.get(attribute)
    if text is None and default is not None:
        return np.asarray(default, dtype=np.float64)
    try:
        values = [float(word) for word in (text or "").split()]
    except ValueError:
        values = []
    if len(values) == 1 and attribute == "scale":  # some exporters write one factor for all axes
        values = values * 3
    if len(values) != count or not all(map(math.isfinite, values)):
        raise DescriptionError(
            f"The attribute {attribute}={text!r} of <{element.tag}> in {where} must be {COUNTS[count]}. Correct it."
        )
    return np.array(values)


def number(element: _Element, attribute: str, default: float | None, where: str) -> float:
    """Return one finite number of an attribute; arguments and errors as for `vector`."""
    return float(vector(element, attribute, None if default is None else [default], where, 1)[0])


def optional_number(parent: _Element, tag: str, attribute: str, where: str) -> float | None:
    """Return one finite number of an attribute of a child; None where the child or the attribute is absent.

    Raises:
        DescriptionError: The attribute is anything but one finite number.
    """
    element = parent.find(tag)
    if element is None or element.get(attribute) is None:
        return None
    return number(element, attribute, None, where)


def line_of(element: _Element) -> int:
    """Return the line of the start tag."""
    return int(str(element.sourceline))  # the stubs of lxml do not know its type


def origin_transform(element: _Element, where: str) -> FloatArray:
    """Return the transform of the ``origin`` child, shape (4, 4); identity where there is none.

    Roll, pitch and yaw are turns about the fixed x, y and z axes, in this order; ``quat_xyzw`` of URDF 1.1 and later
    goes before them.

    Raises:
        DescriptionError: A number is malformed, or the quaternion zero.
    """
    origin = element.find("origin")
    transform = np.eye(4)
    if origin is not None:
        quaternion = vector(origin, "quat_xyzw", (0.0, 0.0, 0.0, 1.0), where, 4)
        if not quaternion.any():
            raise DescriptionError(f"The quat_xyzw of <origin> in {where} is zero. Write 0 0 0 1 for no rotation.")
        turned = "quat_xyzw" in origin.attrib
        transform[:3, :3] = (
            rotation_from_quaternion(np.roll(quaternion, 1))
            if turned
            else rotation_from_rpy(vector(origin, "rpy", (0.0, 0.0, 0.0), where))
        )
        transform[:3, 3] = vector(origin, "xyz", (0.0, 0.0, 0.0), where)
    return transform


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
        """Names of links, the unnamed omitted, in the order of the document."""
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


def passing_links(robot: _Element) -> frozenset[str]:
    """Return the links that the file declares not to collide with others of the model.

    Gazebo's ``<selfCollide>`` says so, in a ``<gazebo reference="LINK">`` or inside the link; in a ``<gazebo>`` of the
    model without a reference, for all links that do not say otherwise.
    """
    links = [name for link in robot.findall("link") if (name := link.get("name"))]
    said: dict[str | None, bool] = {}
    for gazebo in robot.iter("gazebo"):
        parent = gazebo.getparent()
        inside = parent is not None and parent.tag == "link"
        name = parent.get("name") if inside and parent is not None else gazebo.get("reference")
        for tag in _SELF_COLLISION:
            for element in gazebo.iter(tag):
                said[name] = (element.text or "").strip().lower() not in ("false", "0")
    return frozenset(name for name in links if not said.get(name, said.get(None, True)))
