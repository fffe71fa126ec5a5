"""KV230: linkages that close."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.linkage import linkages, loop_gaps
from kinematify.robot.robot import joint_ends, rest_configuration
from kinematify.validation.check import check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.validation.asset.rigid_bodies import Physics
    from kinematify.validation.check import OpenCheck


_SAMPLES = 25
"""Values of each joint that leads at which loops are measured."""


def something_closes(physics: Physics) -> str | None:
    """A loop joint."""
    return None if physics.model.loops else "no loop joint closes a chain"


_SHORT = 0.05
"""Of a range that a loop may leave: a piston's has a clearance beyond its dead points."""


@check(
    "KV230",
    title="Loops stay closed over the range of their driver",
    fails="A loop opens, or cannot move",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    needs=(something_closes,),
)
def loops_close(result: OpenCheck, physics: Physics) -> None:
    """Both ends of a loop joint (`drake:ball_constraint`, `loop_joint`, `connect`) coincide within physics.loop_gap of
    the model's size, at rest and while each joint that leads goes through its range with the others at rest, and the
    joints that the loop holds can move. Where what drives a loop has no limits, the only joint that has some gets to
    both but for a twentieth of its range.

    Why it matters: An engine pulls an open loop together by force, and a linkage works against its own stops.

    Remedy: Correct the points of the loop, or the limits, so that all joints of the loop reach theirs at once.
    """
    robot, size = physics.model, physics.diagonal
    rest = rest_configuration(robot)
    worst = {name: (gap, "", 0.0) for name, gap in loop_gaps(robot, rest).items()}
    leaders = [joint for joint in robot.leaders if joint.is_limited]
    for joint, low, high in zip(leaders, *joint_ends(leaders), strict=True):
        for value in np.linspace(low, high, _SAMPLES).tolist():
            for name, gap in loop_gaps(robot, {**rest, joint.name: value}).items():
                if gap > worst[name][0] + 1e-9:
                    worst[name] = gap, joint.name, value
    result.measured["widest_gap"] = max(gap for gap, *_ in worst.values())
    found = tuple(linkages(robot))
    rigid = {name for item in found if item.mobility < 1 for name in item.loops}
    allowed = physics.settings.loop_gap * size
    for loop in robot.loops:
        gap, mover, value = worst[loop.name]
        if loop.name in rigid:
            result.find(
                f"The loop {loop.name} of {loop.links[0]} and {loop.links[1]} leaves its joints no motion.",
                "Remove the loop, or correct the axes of its joints: those of a plane linkage are parallel.",
                pair=loop.links,
            )
        elif gap > allowed:
            at = f"with {mover} at {value:.3g}" if mover else "at rest"
            result.find(
                f"The loop {loop.name} of {loop.links[0]} and {loop.links[1]} is open by {gap:.3g} m {at}.",
                "Let both points of the loop coincide at rest, and end the range of its driver where it closes.",
                pair=loop.links,
                joint=mover or None,
                value=gap,
                limit=allowed,
                unit="m",
            )
    for item in found:
        limited = [joint for name in item.joints if (joint := robot.joint_by_name[name]).is_limited]
        if len(limited) == 1 and len(item.curve) and item.driver != limited[0].name:
            (joint,), way = limited, item.curve[:, item.joints.index(limited[0].name)]
            if np.ptp(way) < (1.0 - _SHORT) * (joint.upper - joint.lower):
                result.find(
                    f"The loop {', '.join(item.loops)} closes for {joint.name} from {way.min():.4g} to "
                    f"{way.max():.4g}; its limits are {joint.lower:.4g} and {joint.upper:.4g}.",
                    f"End the range of {joint.name} where its loop closes, or correct the points of the loop.",
                    joint=joint.name,
                )
