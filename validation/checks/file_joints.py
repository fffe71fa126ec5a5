"""KV130 to KV137, the numbers themselves apart: type, axis and limits of each joint."""

from __future__ import annotations

import difflib
import math
from typing import TYPE_CHECKING

from kinematify.validation.finding import Severity
from kinematify.validation.precheck.numbers import finite_numbers
from kinematify.validation.precheck.problem import Problem, line_of, shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.robot.urdf_document import JointElement
    from kinematify.validation.precheck.urdf import Urdf

_SINGLE = ("revolute", "continuous", "prismatic")
_FREE = ("floating", "planar")
_KNOWN = (*_SINGLE, "fixed", *_FREE)
_ELSEWHERE = {
    "ball": "three continuous joints with massless links between them",
    "spherical": "three continuous joints with massless links between them",
    "universal": "two revolute joints with a massless link between them",
    "screw": "a prismatic joint that mimics a revolute one",
    "hinge": "revolute",
    "slide": "prismatic",
    "slider": "prismatic",
    "rotational": "revolute",
    "linear": "prismatic",
}
_UNITS = {"revolute": "rad", "prismatic": "m"}


def unknown_types(urdf: Urdf) -> Iterator[Problem]:
    """KV130."""
    for joint in urdf.joints:
        if joint.kind not in _KNOWN:
            near = difflib.get_close_matches(joint.kind.lower(), _KNOWN, n=1)
            instead = _ELSEWHERE.get(joint.kind.lower()) or (near[0] if near else None)
            yield Problem(
                message=f"The joint {joint.name} has {f'the type {shown(joint.kind)}' if joint.kind else 'no type'}, "
                f"which URDF does not have: it knows {', '.join(_KNOWN)}.",
                remedy=f"Write {instead} instead." if instead else "Write one of the types of URDF.",
                joint=joint.name,
                line=line_of(joint.element),
            )


def free_types(urdf: Urdf) -> Iterator[Problem]:
    """KV131."""
    above = {edge.child: edge.parent for edge in urdf.edges}
    solid = {name for name, _ in urdf.shapes()}
    for joint in urdf.joints:
        if joint.kind not in _FREE:
            continue
        seen: set[str] = set()
        link: str | None = joint.parent
        while link is not None and link not in seen and link not in solid:
            seen.add(link)
            link = above.get(link)
        yield _free(joint, link if link in solid else None)


def _free(joint: JointElement, solid: str | None) -> Problem:
    if solid is None:
        return Problem(
            message=f"The {joint.kind} joint {joint.name} above the root body only says that the model stands freely "
            "in the world; here the model stands still.",
            remedy="Nothing needs to be done.",
            severity=Severity.NOTE,
            joint=joint.name,
            line=line_of(joint.element),
        )
    return Problem(
        message=f"The {joint.kind} joint {joint.name} lets {joint.child} move freely below the link {solid}; only "
        "joints with one axis can be checked there, and most engines read it as fixed.",
        remedy="Describe it as several joints with one axis each, or as two models.",
        joint=joint.name,
        line=line_of(joint.element),
    )


def zero_axes(urdf: Urdf) -> Iterator[Problem]:
    """KV134."""
    for joint, element, axis in _axes(urdf):
        length = math.hypot(*axis)
        if length <= urdf.settings.zero_axis:
            yield Problem(
                message=f"The axis of the joint {joint.name} is {shown(element.get('xyz'))}: it has no direction.",
                remedy="Write a unit vector along the hinge line or the direction of sliding.",
                joint=joint.name,
                value=length,
                limit=urdf.settings.zero_axis,
                line=line_of(element),
            )


def unnormalised_axes(urdf: Urdf) -> Iterator[Problem]:
    """KV135: readers disagree whether the length of an axis scales the motion."""
    for joint, element, axis in _axes(urdf):
        length = math.hypot(*axis)
        deviation = abs(length - 1.0)
        if length > urdf.settings.zero_axis and deviation > urdf.settings.unit_axis_tolerance:
            rounded = deviation <= urdf.settings.rounded_axis_tolerance
            yield Problem(
                message=f"The axis of the joint {joint.name} has the length {length:g}, not 1.",
                remedy=f"Write {' '.join(f'{value / length:.9g}' for value in axis)}.",
                severity=Severity.NOTE if rounded else None,
                joint=joint.name,
                value=length,
                limit=1.0,
                line=line_of(element),
            )


def missing_limits(urdf: Urdf) -> Iterator[Problem]:
    """KV136."""
    for joint in urdf.joints:
        if joint.kind not in _UNITS:
            continue
        limit = joint.element.find("limit")
        unit = _UNITS[joint.kind]
        if limit is None:
            turns = joint.kind == "revolute"
            yield Problem(
                message=f"The {joint.kind} joint {joint.name} has no <limit>: MuJoCo reads it as unlimited, PyBullet "
                "and Pinocchio refuse the file.",
                remedy=f'Add <limit lower="..." upper="..." effort="..." velocity="..."/> with the range in {unit}'
                + (', or write type="continuous".' if turns else "."),
                joint=joint.name,
                unit=unit,
                line=line_of(joint.element),
                harmless=turns,  # it is read as continuous
            )
        elif limit.get("lower") is None and limit.get("upper") is None:
            yield Problem(
                message=f"The <limit> of the {joint.kind} joint {joint.name} states neither lower nor upper; both are "
                "zero then, and the joint cannot move.",
                remedy=f"Write lower and upper in {unit}.",
                severity=Severity.WARNING,
                joint=joint.name,
                unit=unit,
                line=line_of(limit),
            )


def swapped_limits(urdf: Urdf) -> Iterator[Problem]:
    """KV137."""
    for joint in urdf.joints:
        limit = joint.element.find("limit")
        if joint.kind not in _UNITS or limit is None:
            continue
        lower, upper = (_one(limit, name) for name in ("lower", "upper"))
        if lower is not None and upper is not None and lower > upper:
            yield Problem(
                message=f"The joint {joint.name} has the lower limit {lower:g} above the upper limit {upper:g}; MuJoCo "
                "reads this as unlimited.",
                remedy=f'Write lower="{upper:g}" upper="{lower:g}" if they were swapped.',
                joint=joint.name,
                value=lower,
                limit=upper,
                unit=_UNITS[joint.kind],
                line=line_of(limit),
            )


PROBES = {
    "KV130": unknown_types,
    "KV131": free_types,
    "KV134": zero_axes,
    "KV135": unnormalised_axes,
    "KV136": missing_limits,
    "KV137": swapped_limits,
}


def _axes(urdf: Urdf) -> Iterator[tuple[JointElement, _Element, list[float]]]:
    """Axes of joints that use them and that are three numbers."""
    for joint in urdf.joints:
        element = joint.element.find("axis")
        if joint.kind in _SINGLE and element is not None:
            axis = finite_numbers(element.get("xyz") or "")
            if axis is not None and len(axis) == 3:
                yield joint, element, axis


def _one(element: _Element, attribute: str) -> float | None:
    values = finite_numbers(element.get(attribute) or "0")
    return values[0] if values is not None and len(values) == 1 else None
