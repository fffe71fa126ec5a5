"""KV132 and KV133: every number is there, finite, and of a size that a machine can have."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import COUNTS, line_of
from kinematify.validation.check import check
from kinematify.validation.document import cause_of, shown
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.robot.urdf_numbers import UrdfDocument
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf

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


@check(
    "KV132",
    title="Numbers are finite and complete",
    fails="Numbers are missing or not finite",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
)
def unreadable_numbers(result: OpenCheck, urdf: Urdf) -> None:
    """Every attribute that holds numbers holds the right count of plain, finite ones.

    Why it matters: A NaN in an axis passes MuJoCo and PyBullet and turns every later state into NaN.

    Remedy: Write plain numbers separated by spaces; find out why the exporter failed there.
    """
    for field in malformed_fields(urdf):
        result.find(
            f"{field.called} is {_what(field.text, finite_numbers(field.text))}; expected {COUNTS[field.counts[0]]}.",
            _remedy(field.text),
            severity=Severity.WARNING if field.element.tag == "color" else None,
            cause=cause_of(field.element),
            joint=field.joint,
            link=field.link,
            line=line_of(field.element),
        )


def malformed_fields(urdf: UrdfDocument) -> Iterator[NumberField]:
    """Every attribute that does not hold the numbers that it should."""
    for field in _fields(urdf):
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


def _what(text: str, values: list[float] | None) -> str:
    if values is not None:
        return f"{len(values)} numbers" if values else "empty"
    return "not finite" if re.search(r"nan|inf|e\+?\d{3}", text, re.IGNORECASE) else "no number that readers agree on"


def _remedy(text: str) -> str:
    if "$" in text:
        return "This is an expression of xacro: expand the file with `xacro FILE > robot.urdf`."
    if "," in text:
        return "Separate numbers by spaces and write decimals with a point."
    return "Write plain numbers separated by spaces, such as 0 0.5 1e-3; find out why the exporter failed here."


@check(
    "KV133",
    title="Numbers are of a plausible size",
    fails="Numbers have an implausible size",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
)
def implausible_numbers(result: OpenCheck, urdf: Urdf) -> None:
    """No number is larger than `max_number` (a warning for damping and friction, and for limits of a hinge to both
    sides, which are none then; an effort or velocity of such a size is no bound, which is fine), and no roll, pitch or
    yaw is more than one turn (a warning).

    Why it matters: With 1e16 metres or radians all digits are lost; angles above a turn are degrees most of the time.

    Remedy: Write the true value in metres, radians and kilograms; use a continuous joint where there is no limit.
    """
    settings = urdf.settings
    for field in _fields(urdf):
        values = finite_numbers(field.text)
        if not values or field.element.tag == "color":
            continue
        largest = max(values, key=abs)
        if field.attribute in ("effort", "velocity"):
            continue
        if abs(largest) > settings.max_number:
            _huge(result, field, largest, settings.max_number)
        elif field.attribute == "rpy" and abs(largest) > settings.max_angle:
            result.find(
                f"{field.called} turns by {largest:g} rad, more than a whole turn; it looks like degrees.",
                f"Write {math.radians(largest):.6g} if degrees were meant.",
                severity=Severity.WARNING,
                cause=cause_of(field.element),
                value=abs(largest),
                limit=settings.max_angle,
                unit="rad",
                joint=field.joint,
                link=field.link,
                line=line_of(field.element),
            )


def _huge(result: OpenCheck, field: NumberField, value: float, limit: float) -> None:
    bound = field.attribute in ("lower", "upper")
    endless = bound and _is_endless(field.element, limit)
    if endless and field.attribute == "lower":
        return  # the upper end tells it
    drive = field.attribute in ("damping", "friction")
    result.find(
        f"{field.called} is {value:g}, and the lower one is as far: that is no limit."
        if endless
        else f"{field.called} is {value:g}; above {limit:g} few digits are left for what counts.",
        (
            'Write type="continuous" where a hinge has no limit.'
            if bound
            else "Write zero or what was measured."
            if drive
            else "Write the true value; all lengths are in metres."
        ),
        severity=Severity.WARNING if drive or endless else None,
        cause=cause_of(field.element),
        joint=field.joint,
        link=field.link,
        value=value,
        limit=limit,
        line=line_of(field.element),
    )


def _is_endless(element: _Element, limit: float) -> bool:
    """True if a joint is limited so far to both sides that it is not, as by the 1e16 of Gazebo; a slide has an end."""
    joint = element.getparent()
    lower, upper = (finite_numbers(element.get(end) or "") or [0.0] for end in ("lower", "upper"))
    return joint is not None and joint.get("type") != "prismatic" and lower[0] < -limit and upper[0] > limit


def _fields(urdf: UrdfDocument) -> Iterator[NumberField]:
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
