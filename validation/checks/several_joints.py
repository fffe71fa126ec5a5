"""KV333: joints of twins."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.validation.check import check
from kinematify.validation.checks.shared import joints_move
from kinematify.validation.finding import Cause, Severity, not_finished
from kinematify.validation.geometry.mirror_pairs import twins_at_odds

if TYPE_CHECKING:
    from kinematify.robot.robot import Joint
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.geometry.look import GeometryContext


def _two_joints(look: GeometryContext) -> str | None:
    late = None if look.left is None else not_finished(f"time ran out before {look.left}")
    return late or ("only one joint moves" if len(look.scene.travels) < 2 else None)


@check(
    "KV333",
    title="Twins move alike",
    fails="Twins do not move alike",
    severity=Severity.WARNING,
    cause=Cause.KINEMATICS,
    needs=(joints_move, _two_joints),
)
def unlike_twins(result: OpenCheck, look: GeometryContext) -> None:
    """Two parts of one size that mirror or repeat each other at rest, and whose axes do so too, have joints of one type
    whose ranges are about as wide and lead the same way. It is a finding only if no symmetry of the two explains both
    joints, and one joint is in all pairs that differ: legs may bend alike in front and behind.

    Why it matters: One leg that bends the wrong way, or one door that opens inwards, is stopped by nothing in an
    engine.

    Remedy: Compare the two joints; correct the type, the axis or the limits of the one that is wrong.
    """
    found = [*twins_at_odds(look.scene)]
    for first, second, how in found:
        if not all({first.name, second.name} & {one.name, other.name} for one, other, _ in found):
            continue
        result.find(
            f"{first.child} and {second.child} mirror or repeat each other, but {how}: "
            f"{' and '.join(f'{joint.name} ({_line_and_range(joint)})' for joint in (first, second))}.",
            "Compare the two: correct the type, <axis> or limits of the one that is wrong.",
            pair=(first.child, second.child),
            line=second.line,
        )


def _line_and_range(joint: Joint) -> str:
    axis = " ".join(f"{value + 0.0:.4g}" for value in np.round(joint.axis, 4))
    return f"{joint.kind}, axis {axis}, {joint.lower:.4g} to {joint.upper:.4g}"
