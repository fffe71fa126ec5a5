"""KV220 to KV222 and KV225: declared ranges of joints."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import CauseScope, check
from kinematify.validation.checks.shared import something_follows, something_moves
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.robot import Joint
    from kinematify.validation.asset.rigid_bodies import Physics
    from kinematify.validation.check import OpenCheck

_FEW_DEGREES = 10.0
"""No range of degrees is so narrow [deg], but published ranges in radians are so wide."""
_ROUND_DEGREES = 5.0
"""People choose limits that are multiples of this [deg]."""
_ROUND_TOLERANCE = 0.3
"""What two decimals of a radian leave of a round angle [deg]: 200 deg are written as 3.49 rad."""
_BOUNDLESS = 1e5
"""No slip of units makes a range of so many rad or m: it means no limit."""
_EVEN, _FEW_TURNS = 0.1, 16.0 * math.pi
"""A range goes as far to both sides within this share of it; up to this width it may stand for no limit [rad]."""


@check(
    "KV220",
    title="Ranges of joints are plausible",
    fails="The range of a joint is implausible",
    severity=Severity.ERROR,
    cause=Cause.KINEMATICS,
    needs=(something_moves,),
)
def implausible_ranges(result: OpenCheck, physics: Physics) -> None:
    """No hinge turns by more than `widest_turn` (a warning from `full_turn` on; a warning beyond `endless`, and a note
    at plus and minus 10 rad or a multiple of pi, where no limit was meant; a warning for some turns to both sides that
    are no round numbers), unless both limits are round numbers of degrees up to `widest_wrist`; it is a note where the
    range would be less than ten degrees if it were degrees. No slide moves by more than `slide_sizes` times the size
    of the model, by `widest_slide` where no geometry shows its size; beyond `slide_wrong` times it is an error. It is
    a note of slides that carry all geometry, as those of a base on the floor do, and of a range of more than 100,000
    rad or m, which means no limit.

    Why it matters: Degrees for radians and millimetres for metres load in every engine, and the joint then moves
    freely.

    Remedy: Write radians and metres; the finding names the converted values.
    """
    for joint in _limited(physics):
        if joint.kind is JointType.PRISMATIC:
            _slide(result, physics, joint)
        else:
            _turn(result, physics, joint)


def _turn(result: OpenCheck, physics: Physics, joint: Joint) -> None:
    settings = physics.settings
    width = joint.upper - joint.lower
    if width <= settings.full_turn:
        return
    # -10.4 and 10.01 are no degrees that anybody writes: they stand for no limit.
    even = abs(joint.lower + joint.upper) < _EVEN * width and width < _FEW_TURNS
    odd = any(end % 0.5 for end in (joint.lower, joint.upper))
    endless = joint.endless or width > settings.endless or (even and odd)
    # Wrists of large arms turn by 400 degrees to each side; their limits are round numbers of degrees.
    meant = _round(joint.lower) and _round(joint.upper) and width <= settings.widest_wrist
    if meant:
        return
    degrees = f"{math.radians(joint.lower):.6g} and {math.radians(joint.upper):.6g}"
    result.find(
        f"The hinge {joint.name} turns from {joint.lower:g} to {joint.upper:g} rad, "
        f"{width / (2.0 * math.pi):.3g} turns"
        + ("." if endless else f"; it looks like {joint.lower:g} to {joint.upper:g} degrees."),
        'Write type="continuous" where a hinge has no limit.'
        if endless
        else f"Write lower and upper in radians: {degrees} if they are degrees.",
        severity=Severity.NOTE
        if joint.endless
        or width > _BOUNDLESS
        or width < _FEW_DEGREES  # read as degrees it would hardly move: wrists are published so wide
        else Severity.WARNING
        if endless or width <= settings.widest_turn
        else Severity.ERROR,
        joint=joint.name,
        link=joint.child,
        value=width,
        limit=settings.widest_turn if width > settings.widest_turn else settings.full_turn,
        unit="rad",
        line=joint.line,
    )


def _round(angle: float) -> bool:
    degrees = math.degrees(angle)
    return abs(degrees - _ROUND_DEGREES * round(degrees / _ROUND_DEGREES)) <= _ROUND_TOLERANCE


def _slide(result: OpenCheck, physics: Physics, joint: Joint) -> None:
    settings = physics.settings
    width = joint.upper - joint.lower
    size = physics.diagonal
    limit = settings.slide_sizes * size if size > 0.0 else settings.widest_slide
    if width <= limit:
        return
    result.find(
        f"The slide {joint.name} moves by {width:g} m"
        + (f", {width / size:.3g} times the size of the model ({size:.3g} m)." if size > 0.0 else "."),
        f"Write lower and upper in metres: {joint.lower / 1000:g} and {joint.upper / 1000:g} if they are millimetres.",
        severity=Severity.NOTE
        if width > _BOUNDLESS or _carries_all(physics, joint)
        else Severity.ERROR
        if size > 0.0 and width > settings.slide_wrong * size
        else Severity.WARNING,
        joint=joint.name,
        link=joint.child,
        value=width,
        limit=limit,
        unit="m",
        line=joint.line,
    )


def _carries_all(physics: Physics, joint: Joint) -> bool:
    """True of a slide that stands for a drive over the floor: no geometry is above it."""
    above = physics.body_of[joint.parent]
    while not above.rooms and above.joint is not None:
        above = physics.body_of[physics.model.joint_by_name[above.joint].parent]
    return not above.rooms


@check(
    "KV221",
    title="Ranges of joints are not empty",
    fails="The range of a joint is empty",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    follows={"KV136": CauseScope.JOINT},
    needs=(something_moves,),
)
def empty_ranges(result: OpenCheck, physics: Physics) -> None:
    """The lower limit of a revolute or prismatic joint is below the upper one.

    Why it matters: MuJoCo and Pinocchio take equal limits for none, PyBullet locks the joint.

    Remedy: Write the true range, or make the joint fixed.
    """
    for joint in _limited(physics):
        if joint.lower == joint.upper:
            result.find(
                f"The joint {joint.name} has the same lower and upper limit ({joint.lower:g}): it cannot move "
                "in PyBullet, and moves without limit in MuJoCo.",
                'Write its true range, or type="fixed".',
                joint=joint.name,
                link=joint.child,
                value=0.0,
                unit=_unit(joint),
                line=joint.line,
            )


@check(
    "KV222",
    title="Zero lies within the limits",
    fails="Zero lies outside the limits",
    severity=Severity.NOTE,
    cause=Cause.KINEMATICS,
    needs=(something_moves,),
)
def zero_outside(result: OpenCheck, physics: Physics) -> None:
    """Zero is a value that the joint may take.

    Why it matters: Engines and viewers start at zero, which is then outside the limits.

    Remedy: Start from a configuration within the limits.
    """
    for joint in _limited(physics):
        if joint.lower > 0.0 or joint.upper < 0.0:
            result.find(
                f"Zero lies outside the range {joint.lower:g} to {joint.upper:g} of the joint {joint.name}; "
                "the middle of the range is taken for its rest.",
                "Start simulations from values within the limits, or move the joint's frame.",
                joint=joint.name,
                link=joint.child,
                value=0.0,
                limit=joint.lower if joint.lower > 0.0 else joint.upper,
                unit=_unit(joint),
                line=joint.line,
            )


@check(
    "KV225",
    title="Mimic joints stay within their limits",
    fails="A mimic joint leaves its limits",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    needs=(something_follows,),
)
def mimics_beyond_limits(result: OpenCheck, physics: Physics) -> None:
    """While the leader goes through its range, the follower stays within its own, to `mimic_slack`.

    Why it matters: The coupling pushes the follower against its stop, and the engine lets the two fight.

    Remedy: Make the limits of both joints agree with multiplier and offset.
    """
    for joint in physics.model.joints:
        if joint.mimic is None:
            continue
        if joint.mimic.multiplier == 0.0:
            _stuck(result, joint, joint.mimic.joint)
            continue
        reach = _reach(physics, joint)
        slack = physics.settings.mimic_slack * max(1.0, joint.upper - joint.lower)
        if reach is not None and (reach[0] < joint.lower - slack or reach[1] > joint.upper + slack):
            _beyond(result, joint, reach)


def _reach(physics: Physics, joint: Joint) -> tuple[float, float] | None:
    """Values that a follower takes while its leader goes through its range; None for a leader that is fixed."""
    rule = joint.mimic
    if rule is None:
        return None
    leader = physics.model.joint_by_name[rule.joint]
    if leader.kind is JointType.FIXED:
        return None
    ends = np.array([leader.lower, leader.upper]) * rule.multiplier + rule.offset
    return float(ends.min()), float(ends.max())


def _stuck(result: OpenCheck, joint: Joint, leader: str) -> None:
    result.find(
        f"The joint {joint.name} follows {leader} with a multiplier of 0: it never moves.",
        "Write the ratio between the two motions.",
        joint=joint.name,
        link=joint.child,
        line=joint.line,
    )


def _beyond(result: OpenCheck, joint: Joint, reach: tuple[float, float]) -> None:
    beyond = max(joint.lower - reach[0], reach[1] - joint.upper)
    result.find(
        f"The joint {joint.name} follows its leader from {reach[0]:.4g} to {reach[1]:.4g}, beyond its own "
        f"limits {joint.lower:.4g} to {joint.upper:.4g}: engines let the two fight.",
        "Make the limits of both joints agree with multiplier and offset.",
        cause=Cause.KINEMATICS,
        joint=joint.name,
        link=joint.child,
        value=beyond,
        limit=0.0,
        unit=_unit(joint),
        line=joint.line,
    )


def _limited(physics: Physics) -> Iterator[Joint]:
    for joint in physics.model.joints:
        if joint.kind in (JointType.REVOLUTE, JointType.PRISMATIC):
            yield joint


def _unit(joint: Joint) -> str:
    return "rad" if joint.kind.turns else "m"
