"""Context of all checks of the text: the document, and how they name its values and who answers for them."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import UrdfDocument
from kinematify.validation.finding import Cause
from kinematify.validation.srdf_file import srdf_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.config.validation import FileSettings
    from kinematify.validation.srdf_file import Srdf
    from kinematify.validation.stage import StageRequest


_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_Counts = dict[str, dict[str, tuple[int, ...]]]
"""Tag -> attribute -> counts of numbers that are right, the usual one first."""

_ORIGIN: dict[str, tuple[int, ...]] = {"xyz": (3,), "rpy": (3,), "quat_xyzw": (4,)}
_JOINT: _Counts = {
    "origin": _ORIGIN,
    "axis": {"xyz": (3,)},
    "limit": {"lower": (1,), "upper": (1,), "effort": (1,), "velocity": (1,)},
    "mimic": {"multiplier": (1,), "offset": (1,)},
    "dynamics": {"damping": (1,), "friction": (1,)},
}
_INERTIAL: _Counts = {
    "origin": _ORIGIN,
    "mass": {"value": (1,)},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), (1,)),
}
_SHAPES: _Counts = {
    "box": {"size": (3,)},
    "sphere": {"radius": (1,)},
    "cylinder": {"radius": (1,), "length": (1,)},
    "capsule": {"radius": (1,), "length": (1,)},
    "mesh": {"scale": (3, 1)},  # some exporters write one factor for all axes
}
_COLOR: _Counts = {"color": {"rgba": (4,)}}


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
    srdf: Srdf | None
    """The SRDF that lies beside it."""

    @classmethod
    def of(cls, robot: _Element, request: StageRequest, text: bytes) -> Urdf:
        """Put together what the probes need."""
        links = robot.findall("link")
        return cls(
            robot=robot,
            text=text,
            folder=request.urdf.resolve().parent,
            package_dirs=tuple(folder.resolve() for folder in request.package_dirs),
            settings=request.settings.file,
            losses=request.losses,
            srdf=srdf_of(request.urdf.resolve(), robot.get("name", ""), [str(link.get("name")) for link in links]),
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


@dataclass(frozen=True, kw_only=True, eq=False)
class NumberField:
    """An attribute that holds numbers."""

    element: _Element
    attribute: str
    counts: tuple[int, ...]
    joint: str | None
    link: str | None

    @property
    def text(self) -> str:
        """As it is in the file."""
        return self.element.get(self.attribute) or ""

    @property
    def called(self) -> str:
        """With its value, its element and who has it, for messages."""
        owner = f"the joint {self.joint}" if self.joint is not None else f"the link {self.link}"
        return f"{self.attribute}={shown(self.text)} of <{self.element.tag}> of {owner}"


def malformed_fields(urdf: UrdfDocument) -> Iterator[NumberField]:
    """Every attribute that does not hold the numbers that it should."""
    for field in number_fields(urdf):
        values = finite_numbers(field.text)
        if values is None or len(values) not in field.counts:
            yield field


def finite_numbers(text: str) -> list[float] | None:
    """The numbers of an attribute as every reader understands them; None if one is no finite number."""
    words = text.split()
    if not all(_NUMBER.fullmatch(word) for word in words):
        return None
    values = [float(word) for word in words]
    return values if all(map(math.isfinite, values)) else None


def number_fields(urdf: UrdfDocument) -> Iterator[NumberField]:
    """Every attribute with numbers that is there; absent ones have defaults or checks of their own."""
    for joint in urdf.joints:
        yield from _below(joint.element, _JOINT, joint=joint.name)
    for link in urdf.links:
        name = link.get("name") or ""
        for inertial in link.findall("inertial"):
            yield from _below(inertial, _INERTIAL, link=name)
    for name, shape in urdf.shapes():
        yield from _below(shape, {"origin": _ORIGIN}, link=name)
        for geometry in shape.findall("geometry"):
            yield from _below(geometry, _SHAPES, link=name)
        for material in shape.findall("material"):
            yield from _below(material, _COLOR, link=name)


def _below(
    parent: _Element, table: _Counts, *, joint: str | None = None, link: str | None = None
) -> Iterator[NumberField]:
    for child in parent:
        for attribute, counts in table.get(str(child.tag), {}).items():
            if child.get(attribute) is not None:
                yield NumberField(element=child, attribute=attribute, counts=counts, joint=joint, link=link)
