"""KV230 and KV350: linkages that close."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.linkage import linkages, loop_gaps
from kinematify.robot.robot import joint_ends, rest_configuration
from kinematify.validation.check import check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.robot.linkage import Linkage
    from kinematify.validation.asset.rigid_bodies import Physics
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.evidence.loop_pins import SharedPin


_SAMPLES = 25
"""Values of each joint that leads at which loops are measured."""


def something_closes(physics: Physics) -> str | None:
    """A loop joint."""
    return None if physics.model.loops else "no loop joint closes a chain"


@check(
    "KV230",
    title="Loops stay closed over the range of their driver",
    fails="A loop opens, or cannot move",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    needs=(something_closes,),
)
def loops_close(result: OpenCheck, physics: Physics) -> None:
    """Both ends of a loop joint (`drake:ball_constraint`, `loop_joint`) coincide within physics.loop_gap of the model's
    size, at rest and while each joint that leads goes through its range with the others at rest, and the joints that
    the loop holds can move. It is a note where a joint stops the linkage before its driver is at its end.

    Why it matters: An engine pulls an open loop together by force, and a linkage works against its own stops.

    Remedy: Correct the points of the loop, or the limits, so that all joints of the loop reach theirs at once.
    """
    robot, size = physics.model, physics.diagonal
    rest = rest_configuration(robot)
    worst = {name: (gap, "", 0.0) for name, gap in loop_gaps(robot, rest).items()}
    for joint, low, high in zip(robot.leaders, *joint_ends(robot.leaders), strict=True):
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
    for linkage in found:
        if linkage.driver is not None:
            _stops(result, physics, linkage)


def _stops(result: OpenCheck, physics: Physics, linkage: Linkage) -> None:
    """Note a passive joint that ends the motion well before the driver's own limit."""
    driver = physics.model.joint_by_name[linkage.driver or ""]
    reached = linkage.curve[:, linkage.joints.index(driver.name)]
    for end, got, stop in zip((driver.lower, driver.upper), reached[[0, -1]].tolist(), linkage.stops, strict=True):
        short = abs(end - got)
        if stop in linkage.joints and stop != driver.name and short > _SHORT * (driver.upper - driver.lower):
            result.find(
                f"The linkage of {', '.join(linkage.loops)} is stopped by {stop} where {driver.name} is at {got:.3g}, "
                f"before its limit {end:.3g}.",
                "Let all joints of the linkage reach their limits at once.",
                severity=Severity.NOTE,
                joint=stop,
                value=got,
                limit=end,
                unit="rad" if driver.kind.turns else "m",
            )


_SHORT = 0.02
"""Share of the driver's range."""


@check(
    "KV350",
    title="Links that share a pin are joined there",
    fails="A linkage is open where two links share a pin",
    severity=Severity.NOTE,
    cause=Cause.KINEMATICS,
)
def open_linkage(result: OpenCheck, pin: SharedPin) -> None:
    """Two links that no joint joins, and that are both round about one line where they touch (topology.pin_score), do
    not come apart there by more than topology.pin_opens of the model's size when a joint moves alone.

    Why it matters: A URDF is a tree: of the loop of a gripper or a four-bar linkage one pin is missing, and in an
    engine the linkage hangs open there.

    Remedy: Close it where the engine can: an <equality><connect> in
    MuJoCo, createConstraint in PyBullet; or let the passive joints of the loop follow the driven one with <mimic>.
    """
    first, second = pin.links
    axis, place = (", ".join(f"{value:.3f}" for value in vector) for vector in (pin.line.axis, pin.line.pivot))
    result.find(
        f"{first} and {second} share a pin, and no joint joins them there: moving {pin.joint} alone pulls it apart by "
        f"{pin.opens:.3g} m. It looks like a linkage that closes there.",
        f"Close the loop in the engine at ({place}) about ({axis}), world frame at rest, or let the passive joints "
        "follow the driven one with <mimic>.",
        joint=pin.joint,
        pair=pin.links,
        q={pin.joint: pin.value},
        value=pin.opens,
        limit=pin.allowed,
        unit="m",
    )
