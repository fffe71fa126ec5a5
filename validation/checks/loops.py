"""KV350: linkages that close."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.check import check
from kinematify.validation.finding import Blame, Severity

if TYPE_CHECKING:
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.evidence.pins import SharedPin


@check(
    "KV350",
    title="Links that share a pin are joined there",
    fails="A linkage is open where two links share a pin",
    severity=Severity.NOTE,
    blame=Blame.KINEMATICS,
)
def open_linkage(result: OpenCheck, pin: SharedPin) -> None:
    """Two links that no joint joins, and that are both round about one line where they touch (topology.pin_score), do
    not come apart there by more than topology.pin_opens of the model's size when a joint moves alone.

    Why it matters: A URDF is a tree: of the loop of a gripper or a four-bar linkage one pin is missing, and in an
    engine the linkage hangs open there.

    Remedy: Close it where the engine can: an <equality><connect> in MuJoCo, createConstraint in PyBullet; or let the
    passive joints of the loop follow the driven one with <mimic>.
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
