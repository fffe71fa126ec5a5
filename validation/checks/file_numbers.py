"""KV132 and KV133: every number is there, finite, and of a size that a machine can have."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import COUNTS, line_of
from kinematify.validation.check import check
from kinematify.validation.document import cause_of, finite_numbers, malformed_fields, number_fields
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from lxml.etree import _Element

    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import NumberField, Urdf


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
    """No number is larger than `max_number` (a warning for damping and friction; a note for limits of a hinge to both
    sides, which are none then; an effort or velocity of such a size is no bound, which is fine), and no roll, pitch or
    yaw is more than one turn (a warning).

    Why it matters: With 1e16 metres or radians all digits are lost; angles above a turn are degrees most of the time.

    Remedy: Write the true value in metres, radians and kilograms; use a continuous joint where there is no limit.
    """
    settings = urdf.settings
    for field in number_fields(urdf):
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
        severity=Severity.NOTE if endless else Severity.WARNING if drive else None,
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
