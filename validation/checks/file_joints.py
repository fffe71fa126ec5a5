"""KV130 to KV137, the numbers themselves apart: type, axis and limits of each joint."""

from __future__ import annotations

import difflib
import math
from typing import TYPE_CHECKING

from kinematify.robot.joint_type import FREE_KINDS
from kinematify.robot.urdf_numbers import line_of
from kinematify.validation.check import check
from kinematify.validation.document import finite_numbers, shown
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.robot.urdf_numbers import JointElement
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf

_SINGLE = ("revolute", "continuous", "prismatic")
_KNOWN = (*_SINGLE, "fixed", *FREE_KINDS)
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


@check(
    "KV130",
    title="Joint types are known",
    fails="A joint type is unknown",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def unknown_types(result: OpenCheck, urdf: Urdf) -> None:
    """Every type is revolute, continuous, prismatic, fixed, floating or planar.

    Why it matters: Readers stop, or take the joint for fixed.

    Remedy: Write one of the types of URDF.
    """
    for joint in urdf.joints:
        if joint.kind not in _KNOWN:
            near = difflib.get_close_matches(joint.kind.lower(), _KNOWN, n=1)
            instead = _ELSEWHERE.get(joint.kind.lower()) or (near[0] if near else None)
            result.find(
                f"The joint {joint.name} has {f'the type {shown(joint.kind)}' if joint.kind else 'no type'}, "
                f"which URDF does not have: it knows {', '.join(_KNOWN)}.",
                f"Write {instead} instead." if instead else "Write one of the types of URDF.",
                joint=joint.name,
                line=line_of(joint.element),
            )


@check(
    "KV131",
    title="Joint types are supported",
    fails="A joint type is not supported",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def free_types(result: OpenCheck, urdf: Urdf) -> None:
    """No floating or planar joint is below a link with geometry. Above the root body it is a note: it states that
    the model is free in the world.

    Why it matters: Engines differ in how they read such joints, most as fixed, so that nothing about the model
    could be compared.

    Remedy: Describe it as several joints with one axis each.
    """
    above = {edge.child: edge.parent for edge in urdf.edges}
    solid = {name for name, _ in urdf.shapes()}
    for joint in urdf.joints:
        if joint.kind not in FREE_KINDS:
            continue
        seen: set[str] = set()
        link: str | None = joint.parent
        while link is not None and link not in seen and link not in solid:
            seen.add(link)
            link = above.get(link)
        _free(result, joint, link if link in solid else None)


def _free(result: OpenCheck, joint: JointElement, solid: str | None) -> None:
    if solid is None:
        result.find(
            f"The {joint.kind} joint {joint.name} above the root body only states that the model is free "
            "in the world; here its base is fixed.",
            "Nothing needs to be done.",
            severity=Severity.NOTE,
            joint=joint.name,
            line=line_of(joint.element),
        )
        return
    result.find(
        f"The {joint.kind} joint {joint.name} lets {joint.child} move freely below the link {solid}; only "
        "joints with one axis can be checked there, and most engines read it as fixed.",
        "Describe it as several joints with one axis each, or as two models.",
        joint=joint.name,
        line=line_of(joint.element),
    )


@check(
    "KV134",
    title="Axes have a direction",
    fails="An axis has no direction",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def zero_axes(result: OpenCheck, urdf: Urdf) -> None:
    """No axis of a joint that moves has a length of `zero_axis` or less.

    Why it matters: PyBullet moves such a joint in some direction; MuJoCo stops.

    Remedy: Write a unit vector along the hinge line or the direction of sliding.
    """
    for joint, element, axis in _axes(urdf):
        length = math.hypot(*axis)
        if length <= urdf.settings.zero_axis:
            result.find(
                f"The axis of the joint {joint.name} is {shown(element.get('xyz'))}: it has no direction.",
                "Write a unit vector along the hinge line or the direction of sliding.",
                joint=joint.name,
                value=length,
                limit=urdf.settings.zero_axis,
                line=line_of(element),
            )


@check(
    "KV135",
    title="Axes have unit length",
    fails="An axis does not have unit length",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
)
def unnormalised_axes(result: OpenCheck, urdf: Urdf) -> None:
    """The length of an axis is one within `unit_axis_tolerance`; it is only a note within `rounded_axis_tolerance`.

    Why it matters: Readers that do not normalise it turn the joint too far or not far enough.

    Remedy: Divide the axis by its length.
    """
    for joint, element, axis in _axes(urdf):
        length = math.hypot(*axis)
        deviation = abs(length - 1.0)
        if length > urdf.settings.zero_axis and deviation > urdf.settings.unit_axis_tolerance:
            rounded = deviation <= urdf.settings.rounded_axis_tolerance
            result.find(
                f"The axis of the joint {joint.name} has the length {length:g}, not 1.",
                f"Write {' '.join(f'{value / length:.9g}' for value in axis)}.",
                severity=Severity.NOTE if rounded else None,
                joint=joint.name,
                value=length,
                limit=1.0,
                line=line_of(element),
            )


@check(
    "KV136",
    title="Revolute and sliding joints state their limits",
    fails="A joint states no limits",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def missing_limits(result: OpenCheck, urdf: Urdf) -> None:
    """Every revolute and prismatic joint has a <limit>; one that states neither lower nor upper is a warning.

    Why it matters: MuJoCo takes the joint for unlimited, PyBullet and Pinocchio refuse the file.

    Remedy: Add the <limit>, or make the joint continuous.
    """
    for joint in urdf.joints:
        if joint.kind not in _UNITS:
            continue
        limit = joint.element.find("limit")
        unit = _UNITS[joint.kind]
        if limit is None:
            turns = joint.kind == "revolute"
            result.find(
                f"The {joint.kind} joint {joint.name} has no <limit>: MuJoCo reads it as unlimited, PyBullet "
                "and Pinocchio refuse the file.",
                f'Add <limit lower="..." upper="..." effort="..." velocity="..."/> with the range in {unit}'
                + (', or write type="continuous".' if turns else "."),
                joint=joint.name,
                harmless=turns,  # it is read as continuous
                unit=unit,
                line=line_of(joint.element),  # it is read as continuous
            )
        elif limit.get("lower") is None and limit.get("upper") is None:
            result.find(
                f"The <limit> of the {joint.kind} joint {joint.name} states neither lower nor upper; both are "
                "zero then, and the joint cannot move.",
                f"Write lower and upper in {unit}.",
                severity=Severity.WARNING,
                joint=joint.name,
                unit=unit,
                line=line_of(limit),
            )


@check(
    "KV137",
    title="Limits stand in order",
    fails="Lower and upper limit are swapped",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
)
def swapped_limits(result: OpenCheck, urdf: Urdf) -> None:
    """lower is not above upper.

    Why it matters: MuJoCo takes the joint for unlimited, others lock it.

    Remedy: Swap the two values.
    """
    for joint in urdf.joints:
        limit = joint.element.find("limit")
        if joint.kind not in _UNITS or limit is None:
            continue
        lower, upper = (_one(limit, name) for name in ("lower", "upper"))
        if lower is not None and upper is not None and lower > upper:
            result.find(
                f"The joint {joint.name} has the lower limit {lower:g} above the upper limit {upper:g}; MuJoCo "
                "reads this as unlimited.",
                f'Write lower="{upper:g}" upper="{lower:g}" if they were swapped.',
                joint=joint.name,
                value=lower,
                limit=upper,
                unit=_UNITS[joint.kind],
                line=line_of(limit),
            )


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
