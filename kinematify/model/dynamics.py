"""Friction, damping and weight that a hand can cope with: nothing moves by itself, and everything moves when pushed.

What hangs on the base by one or two joints is opened by hand: doors, drawers, lids, knobs. Longer chains are machines
with motors: their friction holds what hangs on them, as a worm gear or a valve does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, joint_ends, rest_configuration
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial, Joint, Robot

_GRAVITY = np.array([0.0, 0.0, -9.81])
_AT_LIMIT = 1e-6
"""A limit that is nearer to rest [rad or m] takes the weight."""
_NEAR_REST = 0.1
"""What stands on its head would fall [rad]: the weight is looked at so far to both sides of rest."""
_TIME_STEP = 1.0 / 240.0
"""Of the engine with the longest one [s]."""
_MOST_DECAY = 1.0
"""Of a speed by its damping in one step; what decays by more than twice its size grows."""
_VALUES = 33
"""Values of a joint at which its weight is looked at."""


HAND_FORCE = 60.0  # half of what standards of furniture allow for a drawer
"""What a hand pulls a drawer with [N]."""
HAND_TORQUE = 15.0  # 40 N at a handle 40 cm from the hinge
"""What a hand turns a door with [N m]."""
MOTOR_TORQUE = 8.0e3  # limits of PyBullet give way at three times as much
"""The most that the motor of a joint that turns is given [N m]."""
MOTOR_FORCE = 8.0e3
"""The same for one that slides [N]."""
HAND_SHARE = 0.8  # the rest accelerates
"""Weight and friction take at most this share of it."""
HOLDING = 1.3  # a lid that was given half open stays there
"""Friction over the weight that pulls at a joint where it rests."""
RUBBING = 0.05  # hinges; drawers on rollers have 0.02 to 0.1
"""Friction of bearings and slides over the weight on them."""
MOST_FRICTION = 0.5
"""Friction is at most this share of a hand's force."""
SETTLING_TIME = 0.3  # a door that is let go does not swing on
"""A part that was pushed comes to rest in about this time [s]: inertia over damping."""
OPENING_TIME = 2.0
"""A hand moves it over its whole range in at most about this time [s]."""
EFFORT_MARGIN = 5.0  # a hand that jerks, contacts that rub: a flap of 1 g needs no 100 N m
"""Effort limits are so many times what moves a joint over its range in that time."""
LEAST_EFFORT = 0.1  # a finger
"""Lower effort limits are raised to this [N m or N]."""
SHORTEST_TIME = 0.25  # a button that is struck
"""Velocity limits are not above the range over this time [s]."""


@dataclass(frozen=True, kw_only=True)
class JointLoad:
    """Load of a joint: others rest."""

    inertia: float
    """About the axis [kg m^2], or the mass [kg]."""
    at_rest: float
    """Weight that pulls at the joint where it rests, 0 where a limit takes it [N m or N]."""
    largest: float
    """Largest weight over the range [N m or N]."""
    press: float
    """What bearings and slides rub by: the weight carried [N], for a turn times the radius of gyration [N m]."""
    travel: float
    """Length of the range [rad or m]."""


def with_dynamics(robot: Robot, *, measured: bool = False, powered: bool = False) -> Robot:
    """Return the robot with damping and friction for every joint that has none, and with parts that can be moved.

    Friction holds what rests in the middle of its range against its weight; damping lets a hand's force move it over
    its range in a few seconds and no quicker than in a fraction of one. Efforts and speeds fit the load and the range:
    several times what it takes and at most what the joint had, but motors of machines get what their load asks for.
    Where a hand, or the strongest motor, could not lift what a joint carries, its masses are made smaller, but for
    those that the user stated: they come from the geometry.

    Args:
        robot: Links with mass properties; zero is their pose as given.
        measured: Masses and efforts stay; friction and damping leave motors enough to move.
        powered: What is too heavy for a hand has a motor, and is not made lighter for the hand.
    """
    by_hand = {joint.name for joint in robot.joints if moved_by_hand(robot, joint)}
    if powered:
        by_hand = {name for name in by_hand if not _is_heavy(joint_load(robot, it := robot.joint_by_name[name]), it)}
    for joint in () if measured else reversed(robot.joints_downward):
        if joint.leads:
            robot = _lightened(robot, joint, by_hand=joint.name in by_hand)
    joints = tuple(
        joint
        if joint.kind is JointType.FIXED or joint.damping is not None or joint.friction is not None
        else _with_dynamics(robot, joint, measured=measured)
        if joint.name in by_hand
        else _with_motor(robot, joint, measured=measured)
        for joint in robot.joints
    )
    return _steady(replace(robot, joints=joints), given=robot)


def _steady(robot: Robot, *, given: Robot) -> Robot:
    """Scale down damping that was made up so that it stays stable where an engine applies that of the last step.

    It is so for as long as no eigenvalue of inverse mass matrix times damping times time step exceeds 2. The damping of
    a joint goes with all that hangs on it, which is far more than moves where a long chain folds.
    """
    roots = np.sqrt([max(joint.damping or 0.0, 0.0) for joint in robot.joints])
    # The same eigenvalues, of a symmetric matrix; what carries no mass is omitted.
    decay = roots[:, None] * np.linalg.pinv(mass_matrix(robot), rcond=1e-9, hermitian=True) * roots
    fastest = float(np.linalg.eigvalsh(decay).max(initial=0.0))
    share = _MOST_DECAY / max(_TIME_STEP * fastest, _MOST_DECAY)
    return replace(
        robot,
        joints=tuple(
            joint
            if share == 1.0 or joint.damping is None or before.damping is not None
            else _stated(joint, share * joint.damping, joint.friction or 0.0)
            for joint, before in zip(robot.joints, given.joints, strict=True)
        ),
    )


def mass_matrix(robot: Robot) -> FloatArray:
    """Return the mass matrix of all joints at rest, shape (J, J); rows of what moves nothing are zero.

    Composite rigid bodies, in spatial vectors about the world's origin.
    """
    poses = forward_kinematics(robot, rest_configuration(robot))
    composite = {
        link.name: np.zeros((6, 6)) if link.inertial is None else _spatial_inertia(link.inertial, poses[link.name])
        for link in robot.links
    }
    for joint in reversed(robot.joints_downward):
        composite[joint.parent] = composite[joint.parent] + composite[joint.child]
    index = {joint.child: k for k, joint in enumerate(robot.joints)}
    twists = np.array([_twist(joint, poses[joint.child]) for joint in robot.joints]).reshape(-1, 6)
    matrix = np.zeros((len(index), len(index)))
    for joint in robot.joints:
        k = index[joint.child]
        momentum, link = composite[joint.child] @ twists[k], joint.child
        while link != robot.root:
            matrix[index[link], k] = matrix[k, index[link]] = twists[index[link]] @ momentum
            link = robot.joint_above[link].parent
    return matrix


def _twist(joint: Joint, T_world_joint: FloatArray) -> FloatArray:
    """Angular velocity and that of the point at the world's origin while the joint moves at speed 1."""
    axis = T_world_joint[:3, :3] @ joint.axis
    if joint.kind is JointType.FIXED:
        return np.zeros(6)
    return np.concatenate([axis, np.cross(T_world_joint[:3, 3], axis)] if joint.kind.turns else [np.zeros(3), axis])


def _spatial_inertia(inertial: Inertial, T_world_link: FloatArray) -> FloatArray:
    turn, mass = T_world_link[:3, :3], inertial.mass
    x, y, z = turn @ inertial.center_of_mass + T_world_link[:3, 3]
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    about_origin = turn @ inertial.tensor @ turn.T + mass * cross @ cross.T
    return np.block([[about_origin, mass * cross], [mass * cross.T, mass * np.eye(3)]])


def moved_by_hand(robot: Robot, joint: Joint) -> bool:
    """True if a joint belongs to a chain of at most two joints that move; others have motors."""
    above = 0
    link: str = joint.parent
    while link != robot.root:
        above += robot.joint_above[link].kind is not JointType.FIXED
        link = robot.joint_above[link].parent
    return above + 1 + _longest_below(robot, joint.child) <= 2


def _longest_below(robot: Robot, link: str) -> int:
    """Moving joints of the longest chain that hangs on a link."""
    below = robot.joints_below[link]
    return max((_longest_below(robot, item.child) + (item.kind is not JointType.FIXED) for item in below), default=0)


def _lightened(robot: Robot, joint: Joint, *, by_hand: bool) -> Robot:
    """Scale the masses that a joint carries so that a hand, or a motor, moves them against weight and friction."""
    load = joint_load(robot, joint)
    if by_hand:
        needed, max_safe_force = _by_hand(load), HAND_SHARE * _hand(joint)
    else:
        needed = _Motor.of(load).effort
        max_safe_force = _motor(joint)
    if needed <= max_safe_force:
        return robot
    scale = max_safe_force / needed
    carried = set(carried_links(robot, joint.child))
    return replace(
        robot,
        links=tuple(
            replace(
                link,
                inertial=replace(link.inertial, mass=scale * link.inertial.mass, tensor=scale * link.inertial.tensor),
            )
            if link.name in carried and link.inertial is not None and link.inertial.source != "stated"
            else link
            for link in robot.links
        ),
    )


def _with_dynamics(robot: Robot, joint: Joint, *, measured: bool) -> Joint:
    load, hand = joint_load(robot, joint), _hand(joint)
    friction = min(_rubbing(load), MOST_FRICTION * hand)
    left = max(hand - load.largest - friction, (1.0 - HAND_SHARE) * hand)
    damping = min(load.inertia / SETTLING_TIME, left * OPENING_TIME / max(load.travel, 1e-9))
    if joint.effort is None or joint.velocity is None or measured:
        return _stated(joint, damping, friction)
    needed = max(EFFORT_MARGIN * _effort(robot, joint), LEAST_EFFORT)
    fastest = max(load.travel, 1e-3) / SHORTEST_TIME
    fitted = replace(
        joint, effort=float(f"{min(joint.effort, needed):.3g}"), velocity=float(f"{min(joint.velocity, fastest):.3g}")
    )
    return _stated(fitted, damping, friction)


def _effort(robot: Robot, joint: Joint) -> float:
    """Effort at a joint that moves it and all that follow it [N m or N]."""
    moved = ((robot.joint_by_name[name], ratio) for name, ratio in _moved(robot, joint).items())
    return sum(ratio * _Motor.of(joint_load(robot, other)).effort for other, ratio in moved)


def _moved(robot: Robot, joint: Joint) -> dict[str, float]:
    """A joint and all that move with it, by `<mimic>` or in a closed chain, and how far at most per unit of its way."""
    found = latest = {joint.name: 1.0}
    while latest:  # followers of followers
        after = {}
        for other in robot.joints:
            if other.mimic is not None and other.mimic.joint in latest:
                after[other.name] = latest[other.mimic.joint] * abs(other.mimic.multiplier)
            elif other.closure is not None and other.closure.joint in latest:
                steepest = float(np.abs(np.gradient(other.closure.values, other.closure.at)).max())
                after[other.name] = latest[other.closure.joint] * steepest
        latest = {name: ratio for name, ratio in after.items() if name not in found}
        found |= latest
    return found


@dataclass(frozen=True, kw_only=True)
class _Motor:
    """Motor that a machine needs at a joint; it grows with the masses that the joint carries."""

    friction: float
    damping: float
    lifting: float
    """Largest weight and inertia [N m or N]."""
    effort: float
    """That and friction and damping, over the share of it that is used [N m or N]."""

    @classmethod
    def of(cls, load: JointLoad) -> _Motor:
        pace = load.travel / OPENING_TIME
        friction = _rubbing(load)
        # More would make chains swing in engines that apply damping as a force of the last step.
        damping = load.inertia / SETTLING_TIME
        lifting = load.largest + load.inertia * pace / OPENING_TIME
        effort = (lifting + friction + damping * pace) / HAND_SHARE
        return cls(friction=friction, damping=damping, lifting=lifting, effort=effort)


def _with_motor(robot: Robot, joint: Joint, *, measured: bool) -> Joint:
    needed = _Motor.of(joint_load(robot, joint))
    if joint.effort is not None and not measured and joint.effort < (most := _effort(robot, joint)):
        joint = replace(joint, effort=float(f"{min(most, _motor(joint)):.3g}"))
    if joint.effort is None or not measured or needed.effort <= joint.effort:
        return _stated(joint, needed.damping, needed.friction)
    left = max(HAND_SHARE * joint.effort - needed.lifting, 0.0)
    share = left / (HAND_SHARE * needed.effort - needed.lifting)
    return _stated(joint, share * needed.damping, share * needed.friction)


def _stated(joint: Joint, damping: float, friction: float) -> Joint:
    return replace(joint, damping=float(f"{damping:.3g}"), friction=float(f"{friction:.3g}"))


def _is_heavy(load: JointLoad, joint: Joint) -> bool:
    return _by_hand(load) > HAND_SHARE * _hand(joint)


def _by_hand(load: JointLoad) -> float:
    """What a hand works against: weight and friction [N m or N]."""
    return load.largest + _rubbing(load)


def _rubbing(load: JointLoad) -> float:
    return max(HOLDING * load.at_rest, RUBBING * load.press)


def _hand(joint: Joint) -> float:
    return HAND_TORQUE if joint.kind.turns else HAND_FORCE


def _motor(joint: Joint) -> float:
    return MOTOR_TORQUE if joint.kind.turns else MOTOR_FORCE


def carried_links(robot: Robot, link: str) -> list[str]:
    """Return a link and all that hangs on it."""
    return [link, *(name for joint in robot.joints_below[link] for name in carried_links(robot, joint.child))]


def joint_load(robot: Robot, joint: Joint) -> JointLoad:
    """Return what a joint has to move, the others at rest."""
    rest = rest_configuration(robot)
    poses = forward_kinematics(robot, rest)
    T_world_joint = poses[joint.child]
    axis, pivot = T_world_joint[:3, :3] @ joint.axis, T_world_joint[:3, 3]
    carried = [(robot.link_by_name[name].inertial, poses[name]) for name in carried_links(robot, joint.child)]
    known = [(inertial, T) for inertial, T in carried if inertial is not None and inertial.mass > 0.0]
    masses = np.array([inertial.mass for inertial, _ in known])
    centres = np.array([T[:3, :3] @ inertial.center_of_mass + T[:3, 3] for inertial, T in known]).reshape(-1, 3)
    lower, upper = (float(end[0]) - rest[joint.name] for end in joint_ends([joint]))
    weight = 9.81 * float(masses.sum())
    if not joint.kind.turns:
        pull = float(masses.sum() * (_GRAVITY @ axis))
        pulls, around, inertia, press = np.array([pull]), [pull], float(masses.sum()), weight
    else:
        arms = [np.cross(axis, centre - pivot) for centre in centres]
        inertia = sum(
            mass * float(arm @ arm) + float(axis @ T[:3, :3] @ inertial.tensor @ T[:3, :3].T @ axis)
            for mass, arm, (inertial, T) in zip(masses, arms, known, strict=True)
        )
        values = np.linspace(lower, upper, _VALUES)
        moment = (masses[:, None] * (centres - pivot)).sum(axis=0)
        pulls = np.array([axis @ np.cross(rotation_about(axis, value) @ moment, _GRAVITY) for value in values])
        nearby = np.array([-_NEAR_REST, 0.0, _NEAR_REST])
        around = [float(axis @ np.cross(rotation_about(axis, value) @ moment, _GRAVITY)) for value in nearby]
        press = weight * float(np.sqrt(inertia / max(float(masses.sum()), 1e-300)))
    return JointLoad(
        inertia=float(inertia),
        at_rest=max((abs(pull) for pull in around if (upper if pull > 0.0 else -lower) > _AT_LIMIT), default=0.0),
        largest=float(np.abs(pulls).max()),
        press=press,
        travel=upper - lower,
    )
