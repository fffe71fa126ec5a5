"""KV223, KV224 and KV226: what moves a joint and what holds it back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import CauseScope, check
from kinematify.validation.checks.shared import something_moves, something_weighs
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.robot.robot import Joint
    from kinematify.validation.asset.rigid_bodies import Physics
    from kinematify.validation.check import OpenCheck


@check(
    "KV223",
    title="Joints state effort and velocity",
    fails="Joints state no effort or velocity",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    follows={"KV221": CauseScope.JOINT},
    needs=(something_moves,),
)
def missing_drives(result: OpenCheck, physics: Physics) -> None:
    """Effort and velocity of every joint with a <limit> are there and above zero.

    Why it matters: Pinocchio and ROS refuse a limit without them; with zero no controller moves the joint.

    Remedy: Write what the drive can do; for a passive joint what it can bear.
    """
    # one finding for the whole model where no joint has both
    moving = [joint for joint in physics.model.joints if joint.kind is not JointType.FIXED]
    lacking = [(joint, _lacking(joint)) for joint in moving]
    found = [(joint, words) for joint, words in lacking if words]
    if len(found) > 1 and len(found) == len(moving):
        first, words = found[0]
        _drive(result, f"None of the {len(moving)} joints states effort and velocity; {first.name} {words}.", first)
        return
    for joint, words in found:
        _drive(result, f"The joint {joint.name} {words}.", joint)


def _lacking(joint: Joint) -> str:
    """Return what a joint has not, as words that follow its name."""
    if not joint.has_limit:
        # Continuous joints may do without a limit; PyBullet then has no bound on force and speed.
        return "" if joint.declared_kind == "continuous" else "has no <limit>, so no effort and no velocity"
    absent = [name for name in ("effort", "velocity") if getattr(joint, name) is None]
    if absent:
        return f"states no {' and no '.join(absent)}: Pinocchio and ROS refuse the file"
    idle = [name for name in ("effort", "velocity") if not getattr(joint, name) > 0.0]
    return f"has {' and '.join(f'{name}={getattr(joint, name):g}' for name in idle)}: no drive can move it" * bool(idle)


def _drive(result: OpenCheck, message: str, joint: Joint) -> None:
    result.find(
        message,
        'Write what the drive can do, such as effort="10" velocity="1"; for a passive joint what it can bear.',
        joint=joint.name,
        link=joint.child,
        line=joint.line,
    )


@check(
    "KV224",
    title="Damping and friction are plausible",
    fails="Damping or friction is implausible",
    severity=Severity.ERROR,
    cause=Cause.PHYSICS,
    needs=(something_moves,),
)
def implausible_dynamics(result: OpenCheck, physics: Physics) -> None:
    """Neither is negative; neither is above `damping` (a warning), and friction is below effort (a warning).

    Why it matters: Negative damping makes energy out of nothing; friction above the effort locks the joint.

    Remedy: Write zero, or what was measured.
    """
    settings = physics.settings
    for joint in physics.model.joints:
        if joint.kind is JointType.FIXED:
            continue
        for name, value in (("damping", joint.damping), ("friction", joint.friction)):
            if value is not None and (value < 0.0 or value > settings.damping):
                _dynamics(result, joint, name, value, settings.damping)
        if joint.friction and joint.effort and joint.friction >= joint.effort > 0.0:
            result.find(
                f"The friction {joint.friction:g} of the joint {joint.name} is not below its effort "
                f"{joint.effort:g}: its drive cannot move it.",
                "Correct one of the two.",
                joint=joint.name,
                link=joint.child,
                value=joint.friction,
                limit=joint.effort,
                line=joint.line,
            )


def _dynamics(result: OpenCheck, joint: Joint, name: str, value: float, limit: float) -> None:
    negative = value < 0.0
    result.find(
        f"The joint {joint.name} has {name}={value:g}"
        + (", which feeds energy into the motion." if negative else f"; above {limit:g} it hardly moves."),
        "Write zero or what was measured, in N m s/rad or N s/m (damping) and N m or N (friction).",
        severity=Severity.ERROR if negative else None,
        joint=joint.name,
        link=joint.child,
        value=value,
        limit=0.0 if negative else limit,
        line=joint.line,
    )


@check(
    "KV226",
    title="Joints can bear the weight",
    fails="A joint cannot bear the weight",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    needs=(
        something_moves,
        something_weighs,
    ),
)
def weak_drives(result: OpenCheck, physics: Physics) -> None:
    """The torque or force of gravity at a joint, the worst of rest and some sampled configurations with the root fixed
    and gravity along -z, is below its effort.

    Why it matters: A joint that cannot hold its load sags in every controlled simulation.

    Remedy: Check the masses beyond the joint and its effort.
    """
    for joint in physics.model.leaders:
        load, q = physics.worst_loads.get(joint.name, (0.0, {}))
        if not joint.effort or joint.effort <= 0.0 or load <= joint.effort:
            continue
        unit = "N m" if joint.kind.turns else "N"
        result.find(
            f"The joint {joint.name} must hold up to {load:.3g} {unit} against gravity with an effort of "
            f"{joint.effort:g} {unit}, at {_shown(q)}.",
            "Check the masses beyond this joint and its effort; take gravity along -z of the root link.",
            joint=joint.name,
            link=joint.child,
            value=joint.effort / load,
            limit=1.0,
            line=joint.line,
        )


def _shown(q: dict[str, float]) -> str:
    values = [f"{name} = {value:.2f}" for name, value in q.items()]
    return ", ".join(values[:4]) + (", ..." if len(values) > 4 else "")
