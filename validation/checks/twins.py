"""KV227: masses, drives, axes and ranges of left and right mirror each other, those of parts of one shape repeat."""

from __future__ import annotations

import re
from collections import defaultdict
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.validation.check import CauseScope, check
from kinematify.validation.checks.shared import something_moves
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from kinematify.robot.robot import Inertial, Joint, Link
    from kinematify.validation.asset.rigid_bodies import Physics
    from kinematify.validation.check import OpenCheck

_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
_SIDES = {"left": "right", "l": "r", "fl": "fr", "rl": "rr", "lf": "rf", "lh": "rh", "hl": "hr", "bl": "br"}
_SIDES |= {right: left for left, right in _SIDES.items()}
"""Words of names, and what they are on the other side."""
_OF_LINKS = ("mass", "principal moments")
_AGREE = 3
"""Pairs that agree for each one that does not; with fewer, differences are a style of the house."""
_FACTOR, _MOMENTS = 1.5, 2.0
"""Ratio of two values, and of two principal moments, up to which they are a difference of design."""
_RANGE, _PLACE, _ALONG = 0.1, 0.02, 0.985
"""Difference of ranges (of the wider one) and of places (of the model's size), cosine of 10 deg between axes."""
_WIDER = 1.8
"""Ratio of the widths of two ranges of one shape from which on they differ."""
_DIGITS = 4
"""Of the ends of shapes that are one [m]."""
_PLACED = 1e-3
"""Difference of the poses of one shape in the frame of another [m, entries of a rotation]."""


@check(
    "KV227",
    title="Left and right agree, and so do parts of one shape",
    fails="One of left and right, or of parts of one shape, differs where others agree",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    follows={"KV333": CauseScope.PAIR, "KV204": CauseScope.BODY, "KV205": CauseScope.BODY, "KV223": CauseScope.JOINT},
    needs=(something_moves,),
)
def unlike_sides(result: OpenCheck, physics: Physics) -> None:
    """Links and joints whose names differ only in their side (`left_knee`, `right_knee`; `FL`, `FR`) have equal masses
    and principal moments, efforts and velocities up to a factor, and axes and ranges that mirror each other
    in the plane that mirrors most of these joints. So have three or more joints that join links of the same meshes or
    primitives; where these stand in one place to each other, or turned alike on one link, axes and ranges repeat. Two
    or more exceptions among them are a style.
    What differs is a finding only if at least three agree in it for each that does not.

    Why it matters: One slip of a digit or a sign on one side makes a machine limp, and nothing else shows it.

    Remedy: Compare the two; write at one what the other one has.
    """
    reported: set[tuple[str, str]] = set()
    for whose, *found in (
        ("pairs of left and right", _masses(physics), _joints(physics)),
        ("parts of one shape", _repeated(physics)),
    ):
        compared: dict[str, list[tuple[Link | Joint, Link | Joint, str]]] = defaultdict(list)
        for what, first, second, said in chain(*found):
            compared[what].append((first, second, said))
        for what, pairs in compared.items():
            odd = [pair for pair in pairs if pair[2]]
            for first, second, said in odd if len(pairs) >= (_AGREE + 1) * len(odd) else ():
                names = [getattr(item, "child", item.name) for item in (first, second)]
                if (what, names[1]) in reported:
                    continue
                reported |= {(what, name) for name in names}
                result.find(
                    f"{first.name} and {second.name} differ in {what}: {said}; the other {len(pairs) - len(odd)} "
                    f"{whose} agree in it.",
                    "Compare the two, and write at one what the other one has.",
                    cause=Cause.KINEMATICS if what in ("axis", "range") else None,
                    pair=(names[0], names[1]),
                    joint=None if names[1] == second.name else second.name,
                    line=second.line,
                )


def _twins(names: Collection[str]) -> Iterator[tuple[str, str]]:
    """Names with those of the other side, which has the other word for each word of a side."""
    seen = set[str]()
    for name in names:
        twin = _WORD.sub(_other_side, name)
        if twin != name and twin in names and twin not in seen:
            yield name, twin
        seen.add(name)


def _other_side(word: re.Match[str]) -> str:
    other = _SIDES.get(word[0].lower(), word[0])
    return other.upper() if word[0].isupper() else other.title() if word[0].istitle() else other


def _masses(physics: Physics) -> Iterator[tuple[str, Link, Link, str]]:
    """Quantity, two links, and how they differ in it, if they do."""
    links = {name: link for name, link in physics.model.link_by_name.items() if link.inertial is not None}
    for left, right in _twins(links):
        for what, said in _inertials(links[left].inertial, links[right].inertial):
            yield what, links[left], links[right], said


def _inertials(first: Inertial | None, second: Inertial | None) -> Iterator[tuple[str, str]]:
    if first is None or second is None:
        return
    yield "mass", _ratio(first.mass, second.mass)
    moments = np.linalg.eigvalsh(first.tensor), np.linalg.eigvalsh(second.tensor)
    least, most = np.minimum(*moments), np.maximum(*moments)
    odd = (least > 0.0).all() and (most > _MOMENTS * least).any()
    said = " and ".join(", ".join(f"{value:.3g}" for value in item) for item in moments)
    yield "principal moments", f"{said} kg m2" if odd else ""


def _drives(first: Joint, second: Joint) -> Iterator[tuple[str, str]]:
    for what in ("effort", "velocity"):
        values = getattr(first, what), getattr(second, what)
        if None not in values:
            yield what, _ratio(*values)


def _range(first: Joint, second: Joint, *, along: bool, image: str) -> Iterator[tuple[str, str]]:
    """Ranges as they are, or as they are about an axis that runs the other way."""
    if first.is_limited and second.is_limited:
        given = np.array([[first.lower, first.upper], [second.lower, second.upper]])
        wanted = given[0] if along else -given[0, ::-1]
        odd = np.abs(wanted - given[1]).max() > _RANGE * np.ptp(given, axis=1).max()
        said = f"{given[1][0]:.4g} to {given[1][1]:.4g}, where {image} has {wanted[0]:.4g} to {wanted[1]:.4g}"
        yield "range", said if odd else ""


def _ratio(first: float, second: float) -> str:
    return f"{first:g} and {second:g}" if max(first, second) > _FACTOR * min(first, second) else ""


def _joints(physics: Physics) -> Iterator[tuple[str, Joint, Joint, str]]:
    """The same of joints that move."""
    joints = {joint.name: joint for joint in physics.model.joints if joint.kind is not JointType.FIXED}
    pairs = [(joints[left], joints[right]) for left, right in _twins(joints)]
    poses = forward_kinematics(physics.model, rest_configuration(physics.model))
    apart = np.array([np.abs(poses[left.child] - poses[right.child])[:3, 3] for left, right in pairs]).reshape(-1, 3)
    near = apart <= _PLACE * physics.diagonal
    mirrored = ~near & near[:, [1, 0, 0]] & near[:, [2, 2, 1]]
    normal = int(mirrored.sum(axis=0).argmax())
    mirror = np.where(np.arange(3) == normal, -1.0, 1.0)
    for (left, right), beside in zip(pairs, mirrored[:, normal].tolist(), strict=True):
        for what, said in _drives(left, right):
            yield what, left, right, said
        if not beside or left.kind is not right.kind:
            continue
        axes = [poses[joint.child][:3, :3] @ joint.axis for joint in (left, right)]
        cosine = float(axes[0] * mirror @ axes[1]) * (-1.0 if left.kind.turns else 1.0)
        yield "axis", left, right, _turned(cosine, "the mirror image")
        stated = ([joint.axis, *joint.T_parent_child[:3], (joint.lower, joint.upper)] for joint in (left, right))
        repeated = all(map(np.allclose, *stated))  # two hands may be one model
        for what, said in _range(left, right, along=cosine > 0.0 or repeated, image="the mirror image"):
            yield what, left, right, said


def _turned(cosine: float, image: str) -> str:
    angle = np.degrees(np.arccos(min(abs(cosine), 1.0)))
    return f"{angle:.3g} deg off {image}" if abs(cosine) < _ALONG else ""


def _repeated(physics: Physics) -> Iterator[tuple[str, Link | Joint, Link | Joint, str]]:
    """The same of joints between links of one shape, each beside one of them that all but one agree with."""
    links = physics.model.link_by_name
    groups: dict[object, list[Joint]] = defaultdict(list)
    for joint in physics.model.joints:
        child, parent = links[joint.child], links[joint.parent]
        if joint.kind is not JointType.FIXED and child.has_geometry:
            groups[joint.kind, joint.mimic is None, _shapes(child), _shapes(parent)].append(joint)
    for group in groups.values():
        if len(group) < _AGREE:
            continue
        tables = [[dict(_beside(links, first, joint)) for joint in group] for first in group[:2]]
        for what in tables[0][0]:
            for first, table in zip(group, tables, strict=False):
                said = [row.get(what, "") for row in table]
                if sum(map(bool, said)) <= 1:
                    for joint, text in zip(group, said, strict=True):
                        pair = [links[item.child] if what in _OF_LINKS else item for item in (first, joint)]
                        yield what, pair[0], pair[1], text
                    break


def _shapes(link: Link) -> tuple[tuple[str, int, bytes], ...]:
    """Size and place in their own frames of the shapes of a link; equal for links of one shape."""
    found = []
    for shape in filter(lambda shape: len(shape.mesh.vertices), link.visuals or link.collisions):
        points = (shape.mesh.vertices - shape.T_link_shape[:3, 3]) @ shape.T_link_shape[:3, :3]
        ends = np.round([points.min(axis=0), points.max(axis=0)], _DIGITS) + 0.0
        found.append((shape.kind, len(points), ends.tobytes()))
    return tuple(found)


def _beside(links: Mapping[str, Link], first: Joint, second: Joint) -> Iterator[tuple[str, str]]:
    """Quantities in which a joint may differ from one of the same shapes, and how it does."""
    children = [links[joint.child] for joint in (first, second)]
    yield from _inertials(*(child.inertial for child in children))
    yield from _drives(first, second)
    if not links[first.parent].has_geometry or {kind for kind, *_ in _shapes(children[0])} - {"mesh", "box"}:
        return  # the frame of what is round stands at any angle about its axis
    frames = [
        [(link.visuals or link.collisions)[0].T_link_shape for link in (links[joint.parent], links[joint.child])]
        for joint in (first, second)
    ]
    one, other = (
        np.linalg.inv(parent) @ joint.T_parent_child @ child
        for joint, (parent, child) in zip((first, second), frames, strict=True)
    )
    rows = 3 if first.parent == second.parent else 4
    if np.allclose(one[:3, :rows], other[:3, :rows], atol=_PLACED):
        axes = [child[:3, :3].T @ joint.axis for joint, (_, child) in zip((first, second), frames, strict=True)]
        cosine = float(axes[0] @ axes[1])
        yield "axis", _turned(cosine, f"that of {first.name}, by their shapes")
        for what, said in _range(first, second, along=cosine > 0.0, image=first.name) if abs(cosine) >= _ALONG else ():
            narrow, wide = sorted(joint.upper - joint.lower for joint in (first, second))
            # what stands on one link may be mirrored; equal widths that differ elsewhere are turned round
            yield what, said if wide > _WIDER * narrow or (rows > 3 and wide - narrow <= _RANGE * wide) else ""
