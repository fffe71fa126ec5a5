"""KV223, KV224 and KV226: what moves a joint and what holds it back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.validation.engines.configurations import spread_rows
from kinematify.validation.finding import Severity
from kinematify.validation.precheck.problem import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredJoint
    from kinematify.validation.asset.bodies import Physics

_GRAVITY = 9.81
_NO_LIMIT = np.pi
"""Range to each side in which a joint without limits is looked at [rad]."""


def missing_drives(physics: Physics) -> Iterator[Problem]:
    """KV223: one problem for the whole model where no joint has both."""
    moving = [joint for joint in physics.model.joints if joint.joint.kind is not JointType.FIXED]
    lacking = [(joint, _lacking(joint)) for joint in moving]
    found = [(joint, words) for joint, words in lacking if words]
    if len(found) > 1 and len(found) == len(moving):
        first, words = found[0]
        yield _drive(f"None of the {len(moving)} joints states effort and velocity; {first.name} {words}.", first)
        return
    for joint, words in found:
        yield _drive(f"The joint {joint.name} {words}.", joint)


def _lacking(joint: DeclaredJoint) -> str:
    """What a joint has not, as words that follow its name."""
    if not joint.has_limit:
        # Continuous joints may do without a limit; PyBullet then has no bound on force and speed.
        return "" if joint.declared_kind == "continuous" else "has no <limit>, so no effort and no velocity"
    absent = [name for name in ("effort", "velocity") if getattr(joint, name) is None]
    if absent:
        return f"states no {' and no '.join(absent)}: Pinocchio and ROS refuse the file"
    idle = [name for name in ("effort", "velocity") if not getattr(joint, name) > 0.0]
    return f"has {' and '.join(f'{name}={getattr(joint, name):g}' for name in idle)}: no drive can move it" * bool(idle)


def _drive(message: str, joint: DeclaredJoint) -> Problem:
    return Problem(
        message=message,
        remedy='Write what the drive can do, such as effort="10" velocity="1"; for a passive joint what it can bear.',
        joint=joint.name,
        link=joint.joint.child,
        line=joint.line,
    )


def implausible_dynamics(physics: Physics) -> Iterator[Problem]:
    """KV224."""
    settings = physics.settings
    for joint in physics.model.joints:
        if joint.joint.kind is JointType.FIXED:
            continue
        for name, value in (("damping", joint.damping), ("friction", joint.friction)):
            if value is not None and (value < 0.0 or value > settings.damping):
                yield _dynamics(joint, name, value, settings.damping)
        if joint.friction and joint.effort and joint.friction >= joint.effort > 0.0:
            yield Problem(
                message=f"The friction {joint.friction:g} of the joint {joint.name} is not below its effort "
                f"{joint.effort:g}: its drive cannot move it.",
                remedy="Correct one of the two.",
                joint=joint.name,
                link=joint.joint.child,
                value=joint.friction,
                limit=joint.effort,
                line=joint.line,
            )


def _dynamics(joint: DeclaredJoint, name: str, value: float, limit: float) -> Problem:
    negative = value < 0.0
    return Problem(
        message=f"The joint {joint.name} has {name}={value:g}"
        + (", which feeds energy into the motion." if negative else f"; above {limit:g} it hardly moves."),
        remedy="Write zero or what was measured, in N m s/rad or N s/m (damping) and N m or N (friction).",
        severity=Severity.ERROR if negative else None,
        joint=joint.name,
        link=joint.joint.child,
        value=value,
        limit=0.0 if negative else limit,
        line=joint.line,
    )


def weak_drives(physics: Physics) -> Iterator[Problem]:
    """KV226: weight at the joint in its worst sampled configuration against its effort."""
    settings = physics.settings
    loads, where = _worst_loads(physics)
    for joint in physics.model.moving:
        load = loads.get(joint.name, 0.0)
        if not joint.effort or joint.effort <= 0.0 or load <= 0.0 or load * settings.margin <= joint.effort:
            continue
        unit = "N m" if joint.joint.kind.turns else "N"
        margin = joint.effort / load
        yield Problem(
            message=f"The joint {joint.name} must hold up to {load:.3g} {unit} against gravity with an effort of "
            f"{joint.effort:g} {unit}, at {_shown(where[joint.name])}.",
            remedy="Check the masses beyond this joint and its effort; take gravity along -z of the root link.",
            severity=Severity.WARNING if margin < 1.0 else Severity.NOTE,
            joint=joint.name,
            link=joint.joint.child,
            value=margin,
            limit=settings.margin,
            line=joint.line,
        )


def _shown(q: dict[str, float]) -> str:
    values = [f"{name} = {value:.2f}" for name, value in q.items()]
    return ", ".join(values[:4]) + (", ..." if len(values) > 4 else "")


def _worst_loads(physics: Physics) -> tuple[dict[str, float], dict[str, dict[str, float]]]:
    """Largest weight at each joint [N m or N] over sampled configurations, and the configuration it was found in."""
    description = physics.model.kinematics
    loads: dict[str, float] = {}
    where: dict[str, dict[str, float]] = {}
    for q in _configurations(physics):
        poses = forward_kinematics(description, q)
        carried = _carried(physics, poses)
        for joint in description.joints:
            if joint.kind is JointType.FIXED:
                continue
            mass, moment = carried[joint.child]
            axis = poses[joint.child][:3, :3] @ joint.axis
            load = mass * abs(axis[2])
            if joint.kind.turns:
                lever = moment - mass * poses[joint.child][:3, 3]
                load = abs(float(axis[1] * lever[0] - axis[0] * lever[1]))
            if _GRAVITY * load > loads.get(joint.name, 0.0):
                loads[joint.name], where[joint.name] = _GRAVITY * float(load), q
    return loads, where


def _configurations(physics: Physics) -> list[dict[str, float]]:
    """Rest and quasi-random configurations within the limits."""
    joints = physics.model.moving
    rest = rest_configuration(physics.model.kinematics)
    found = [{joint.name: rest[joint.name] for joint in joints}]
    if joints:
        ends = np.array([[joint.joint.lower, joint.joint.upper] for joint in joints])
        low, high = np.clip(ends, -_NO_LIMIT, _NO_LIMIT).T
        values = spread_rows(low, high, 2**physics.settings.load_doublings, seed=0)
        found += [dict(zip([joint.name for joint in joints], row.tolist(), strict=True)) for row in values]
    return found


def _carried(physics: Physics, poses: dict[str, FloatArray]) -> dict[str, tuple[float, FloatArray]]:
    """Mass [kg] and mass times centre [kg m] of each link with all that hangs on it, world frame."""
    carried: dict[str, tuple[float, FloatArray]] = {}
    for link in physics.model.links:
        mass = 0.0 if link.inertial is None else max(link.inertial.mass, 0.0)
        centre = np.zeros(3) if link.inertial is None else link.inertial.center_of_mass
        pose = poses[link.name]
        carried[link.name] = mass, mass * (pose[:3, :3] @ centre + pose[:3, 3])
    for joint in reversed(physics.model.kinematics.joints_downward):
        mass, moment = carried[joint.parent]
        more, further = carried[joint.child]
        carried[joint.parent] = mass + more, moment + further
    return carried


PROBES = {"KV223": missing_drives, "KV224": implausible_dynamics, "KV226": weak_drives}
