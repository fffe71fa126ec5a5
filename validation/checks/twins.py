"""KV227: what is named left and right has the masses, drives, axes and ranges of a mirror image."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.validation.check import CauseScope, check
from kinematify.validation.checks.shared import something_moves
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from kinematify.robot.robot import Joint, Link
    from kinematify.validation.asset.rigid_bodies import Physics
    from kinematify.validation.check import OpenCheck

_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
_SIDES = {"left": "right", "l": "r", "fl": "fr", "rl": "rr", "lf": "rf", "lh": "rh", "hl": "hr", "bl": "br"}
_SIDES |= {right: left for left, right in _SIDES.items()}
"""Words of names, and what they are on the other side."""
_AGREE = 3
"""Pairs that agree for each one that does not; with fewer, differences are a style of the house."""
_FACTOR, _MOMENTS = 1.5, 2.0
"""Ratio of two values, and of two principal moments, up to which they are a difference of design."""
_RANGE, _PLACE, _ALONG = 0.1, 0.02, 0.985
"""Difference of ranges (of the wider one) and of places (of the model's size), cosine of 10 deg between axes."""


@check(
    "KV227",
    title="Left and right agree",
    fails="Left and right differ where other pairs agree",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    follows={"KV333": CauseScope.PAIR, "KV204": CauseScope.BODY, "KV205": CauseScope.BODY, "KV223": CauseScope.JOINT},
    needs=(something_moves,),
)
def unlike_sides(result: OpenCheck, physics: Physics) -> None:
    """Links and joints whose names differ only in their side (`left_knee`, `right_knee`; `FL`, `FR`) have equal masses
    and principal moments, efforts and velocities up to a factor, and axes and ranges that mirror each other
    in the plane that mirrors most of these joints. What differs is a finding only if at least three pairs agree in it
    for each that does not.

    Why it matters: One slip of a digit or a sign on one side makes a machine limp, and nothing else shows it.

    Remedy: Compare the two; write on one side what the other one has.
    """
    compared: dict[str, list[tuple[Link | Joint, Link | Joint, str]]] = defaultdict(list)
    for found in (_masses(physics), _joints(physics)):
        for what, left, right, said in found:
            compared[what].append((left, right, said))
    for what, pairs in compared.items():
        odd = [pair for pair in pairs if pair[2]]
        for left, right, said in odd if len(pairs) >= (_AGREE + 1) * len(odd) else ():
            names = [getattr(item, "child", item.name) for item in (left, right)]
            result.find(
                f"{left.name} and {right.name} differ in {what}: {said}; the other {len(pairs) - len(odd)} pairs of "
                "left and right agree in it.",
                "Compare the two, and write on one side what the other one has.",
                cause=Cause.KINEMATICS if what in ("axis", "range") else None,
                pair=(names[0], names[1]),
                joint=None if names[1] == right.name else right.name,
                line=right.line,
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
    links = physics.model.link_by_name
    inertials = {name: link.inertial for name, link in links.items() if link.inertial is not None}
    for left, right in _twins(inertials):
        first, second = inertials[left], inertials[right]
        yield "mass", links[left], links[right], _ratio(first.mass, second.mass)
        moments = np.linalg.eigvalsh(first.tensor), np.linalg.eigvalsh(second.tensor)
        least, most = np.minimum(*moments), np.maximum(*moments)
        odd = (least > 0.0).all() and (most > _MOMENTS * least).any()
        said = " and ".join(", ".join(f"{value:.3g}" for value in item) for item in moments)
        yield "principal moments", links[left], links[right], f"{said} kg m2" if odd else ""


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
        for what in ("effort", "velocity"):
            first, second = getattr(left, what), getattr(right, what)
            if first is not None and second is not None:
                yield what, left, right, _ratio(first, second)
        if not beside or left.kind is not right.kind:
            continue
        axes = [poses[joint.child][:3, :3] @ joint.axis for joint in (left, right)]
        cosine = float(axes[0] * mirror @ axes[1]) * (-1.0 if left.kind.turns else 1.0)
        angle = np.degrees(np.arccos(min(abs(cosine), 1.0)))
        yield "axis", left, right, f"{angle:.3g} deg off the mirror image" if abs(cosine) < _ALONG else ""
        if left.is_limited and right.is_limited:
            given = np.array([[left.lower, left.upper], [right.lower, right.upper]])
            stated = ([joint.axis, *joint.T_parent_child[:3], (joint.lower, joint.upper)] for joint in (left, right))
            repeated = all(map(np.allclose, *stated))  # two hands may be one model
            wanted = given[0] if cosine > 0.0 or repeated else -given[0, ::-1]
            odd = np.abs(wanted - given[1]).max() > _RANGE * np.ptp(given, axis=1).max()
            said = (
                f"{given[1][0]:.4g} to {given[1][1]:.4g}, where the mirror image has {wanted[0]:.4g} to {wanted[1]:.4g}"
            )
            yield "range", left, right, said if odd else ""
