"""KV220 to KV222 and KV225: declared ranges of joints."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.validation.finding import Blame, Severity
from kinematify.validation.precheck.problem import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.declared import DeclaredJoint
    from kinematify.robot.robot import DescribedJoint
    from kinematify.validation.asset.bodies import Physics

_ROUND_DEGREES = 5.0
"""People choose limits that are multiples of this [deg]."""
_ROUND_TOLERANCE = 0.01
"""[deg]."""


def implausible_ranges(physics: Physics) -> Iterator[Problem]:
    """KV220: degrees for radians, millimetres for metres."""
    for declared in _limited(physics):
        if declared.joint.kind is JointType.PRISMATIC:
            yield from _slide(physics, declared)
        else:
            yield from _turn(physics, declared)


def _turn(physics: Physics, declared: DeclaredJoint) -> Iterator[Problem]:
    joint, settings = declared.joint, physics.settings
    width = joint.upper - joint.lower
    if width <= settings.full_turn:
        return
    endless = width > settings.endless
    # Wrists of large arms turn by 400 degrees to each side; their limits are round numbers of degrees.
    meant = _round(joint.lower) and _round(joint.upper) and width <= settings.widest_wrist
    if meant and width <= settings.widest_turn:
        return
    degrees = f"{math.radians(joint.lower):.6g} and {math.radians(joint.upper):.6g}"
    yield Problem(
        message=f"The hinge {joint.name} turns from {joint.lower:g} to {joint.upper:g} rad, "
        f"{width / (2.0 * math.pi):.3g} turns"
        + ("." if endless else f"; it looks like {joint.lower:g} to {joint.upper:g} degrees."),
        remedy='Write type="continuous" where a hinge has no limit.'
        if endless
        else f"Write lower and upper in radians: {degrees} if they are degrees.",
        severity=Severity.WARNING if endless or meant or width <= settings.widest_turn else Severity.ERROR,
        joint=joint.name,
        link=joint.child,
        value=width,
        limit=settings.widest_turn if width > settings.widest_turn else settings.full_turn,
        unit="rad",
        line=declared.line,
    )


def _round(angle: float) -> bool:
    degrees = math.degrees(angle)
    return abs(degrees - _ROUND_DEGREES * round(degrees / _ROUND_DEGREES)) <= _ROUND_TOLERANCE


def _slide(physics: Physics, declared: DeclaredJoint) -> Iterator[Problem]:
    joint, settings = declared.joint, physics.settings
    width = joint.upper - joint.lower
    size = physics.diagonal
    beyond = size > 0.0 and width > settings.slide_sizes * size
    if width <= settings.widest_slide and not beyond:
        return
    yield Problem(
        message=f"The slide {joint.name} moves by {width:g} m"
        + (f", {width / size:.3g} times the size of the model ({size:.3g} m)." if size > 0.0 else "."),
        remedy=f"Write lower and upper in metres: {joint.lower / 1000:g} and {joint.upper / 1000:g} if they are "
        "millimetres.",
        severity=Severity.ERROR if size > 0.0 and width > settings.slide_wrong * size else Severity.WARNING,
        joint=joint.name,
        link=joint.child,
        value=width,
        limit=min(settings.widest_slide, settings.slide_sizes * size) if size > 0.0 else settings.widest_slide,
        unit="m",
        line=declared.line,
    )


def empty_ranges(physics: Physics) -> Iterator[Problem]:
    """KV221."""
    for declared in _limited(physics):
        joint = declared.joint
        if joint.lower == joint.upper:
            yield Problem(
                message=f"The joint {joint.name} has the same lower and upper limit ({joint.lower:g}): it cannot move "
                "in PyBullet, and moves without limit in MuJoCo.",
                remedy='Write its true range, or type="fixed".',
                joint=joint.name,
                link=joint.child,
                value=0.0,
                unit=_unit(joint),
                line=declared.line,
            )


def zero_outside(physics: Physics) -> Iterator[Problem]:
    """KV222."""
    for declared in _limited(physics):
        joint = declared.joint
        if joint.lower > 0.0 or joint.upper < 0.0:
            yield Problem(
                message=f"Zero lies outside the range {joint.lower:g} to {joint.upper:g} of the joint {joint.name}; "
                "the middle of the range is taken for its rest.",
                remedy="Start simulations from values within the limits, or move the joint's frame.",
                joint=joint.name,
                link=joint.child,
                value=0.0,
                limit=joint.lower if joint.lower > 0.0 else joint.upper,
                unit=_unit(joint),
                line=declared.line,
            )


def mimics_beyond_limits(physics: Physics) -> Iterator[Problem]:
    """KV225."""
    for declared in physics.model.joints:
        joint = declared.joint
        if joint.mimic is None:
            continue
        if joint.mimic.multiplier == 0.0:
            yield _stuck(declared, joint.mimic.joint)
            continue
        reach = _reach(physics, joint)
        slack = physics.settings.mimic_slack * max(1.0, joint.upper - joint.lower)
        if reach is not None and (reach[0] < joint.lower - slack or reach[1] > joint.upper + slack):
            yield _beyond(declared, reach)


def _reach(physics: Physics, joint: DescribedJoint) -> tuple[float, float] | None:
    """Values that a follower takes while its leader goes through its range; None for a leader that is fixed."""
    rule = joint.mimic
    if rule is None:
        return None
    leader = physics.model.joint_by_name[rule.joint].joint
    if leader.kind is JointType.FIXED:
        return None
    ends = np.array([leader.lower, leader.upper]) * rule.multiplier + rule.offset
    return float(ends.min()), float(ends.max())


def _stuck(declared: DeclaredJoint, leader: str) -> Problem:
    return Problem(
        message=f"The joint {declared.name} follows {leader} with a multiplier of 0: it never moves.",
        remedy="Write the ratio between the two motions.",
        joint=declared.name,
        link=declared.joint.child,
        line=declared.line,
    )


def _beyond(declared: DeclaredJoint, reach: tuple[float, float]) -> Problem:
    joint = declared.joint
    beyond = max(joint.lower - reach[0], reach[1] - joint.upper)
    return Problem(
        message=f"The joint {joint.name} follows its leader from {reach[0]:.4g} to {reach[1]:.4g}, beyond its own "
        f"limits {joint.lower:.4g} to {joint.upper:.4g}: engines let the two fight.",
        remedy="Make the limits of both joints agree with multiplier and offset.",
        blame=Blame.KINEMATICS,
        joint=joint.name,
        link=joint.child,
        value=beyond,
        limit=0.0,
        unit=_unit(joint),
        line=declared.line,
    )


def _limited(physics: Physics) -> Iterator[DeclaredJoint]:
    for declared in physics.model.joints:
        if declared.joint.kind in (JointType.REVOLUTE, JointType.PRISMATIC):
            yield declared


def _unit(joint: DescribedJoint) -> str:
    return "rad" if joint.kind.turns else "m"


PROBES = {
    "KV220": implausible_ranges,
    "KV221": empty_ranges,
    "KV222": zero_outside,
    "KV225": mimics_beyond_limits,
}
