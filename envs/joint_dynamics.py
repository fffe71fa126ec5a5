"""Damping and friction of joints, full force of the hand, and what `randomize` draws of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.simulation.world import Variation

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.settings import HandSettings, ObjectSettings, RandomizeSettings
    from kinematify.robot.arrays import FloatArray

RANDOMIZED = ("damping", "friction", "mass", "pose", "color")
"""What `randomize` may name."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointDynamics:
    """In the order of `Mechanism.joints`."""

    damping: FloatArray
    """[N m s/rad or N s/m], shape (J,)."""
    friction: FloatArray
    """[N m or N], shape (J,)."""


def joint_dynamics(
    articulated_object: ArticulatedObject, inertia: FloatArray, gravity: FloatArray, settings: ObjectSettings
) -> JointDynamics:
    """Return the declared dynamics; where the file has none, values in proportion to what the joint moves.

    Friction then also holds what its own weight would move from where it was given into its range.

    Args:
        articulated_object: The object.
        inertia: That each joint moves at rest [kg m^2 or kg], shape (J,).
        gravity: Torque or force that holds each joint still at rest [N m or N], shape (J,).
        settings: Proportions.
    """
    mechanism, declared = articulated_object.scene.mechanism, articulated_object.declared.joint_by_name
    damping, friction = settings.damping_rate * inertia, settings.friction_acceleration * inertia
    travels = {travel.joint: travel for travel in articulated_object.travels}
    for k, name in enumerate(mechanism.joints):
        joint, travel, torque = declared[name], travels.get(name), float(gravity[k])
        slack = 0.01 * travel.range if travel is not None else 0.0
        moves = travel is None or (
            travel.lower < travel.rest - slack if torque > 0.0 else travel.upper > travel.rest + slack
        )
        if moves:
            friction[k] = max(friction[k], settings.hold * abs(torque))
        if joint.damping is not None and joint.damping > 0.0:
            damping[k] = joint.damping
        if joint.friction is not None and joint.friction > 0.0:
            friction[k] = joint.friction
    return JointDynamics(damping=damping, friction=friction)


def full_force(
    target: Target, hand: HandSettings, *, inertia: FloatArray, gravity: FloatArray, damping: float, friction: float
) -> float:
    """Force of a hand that opens the part from rest to rest in `hand.seconds`, with a margin [N].

    Args:
        target: The joint and its way.
        hand: Time and margin.
        inertia: Along the way [kg m^2 or kg], shape (n,).
        gravity: Along the way [N m or N], shape (n,).
        damping: Of the joint.
        friction: Of the joint.
    """
    acceleration = 4.0 * abs(target.range) / hand.seconds**2
    speed = 1.5 * abs(target.range) / hand.seconds
    needed = np.max(np.abs(gravity) + inertia * acceleration) + damping * speed + friction
    return max(hand.least_force, hand.margin * float(needed) / target.path_ratio)


@dataclass(frozen=True, kw_only=True, eq=False)
class Draw(Variation):
    """One object of many, and its colours."""

    color: FloatArray
    """Added to sRGB of each link, shape (L, 3)."""


def drawing(randomize: bool | str | Collection[str]) -> frozenset[str]:
    """Return the names that a `randomize` keyword represents.

    Raises:
        InputError: It names something else.
    """
    if isinstance(randomize, bool):
        return frozenset(RANDOMIZED) if randomize else frozenset()
    names = frozenset([randomize] if isinstance(randomize, str) else randomize)
    unknown = sorted(str(name) for name in names if name not in RANDOMIZED)
    if unknown:
        raise InputError(
            f"randomize names {', '.join(unknown)}, which cannot be randomised. Give True, False, or some of "
            f"{', '.join(RANDOMIZED)}."
        )
    return names


def draw(
    names: frozenset[str], joints: int, links: int, ranges: RandomizeSettings, rng: np.random.Generator, *, robot: bool
) -> Draw:
    """Draw an object; always the same number of draws, so that one name does not change what others give.

    Args:
        names: What is randomised (`drawing`).
        joints: J.
        links: L.
        ranges: From where to where.
        rng: Source of the draws.
        robot: The object stands in front of a robot, and moves less.
    """
    position, yaw = (ranges.robot_position, ranges.robot_yaw) if robot else (ranges.position, ranges.yaw)
    damping, friction = _factors(rng, ranges.damping, joints), _factors(rng, ranges.friction, joints)
    surface, mass = float(_factors(rng, ranges.friction, 1)[0]), _factors(rng, ranges.mass, links)
    x, y, turn = rng.uniform(-1.0, 1.0, 3) * [position, position, yaw]
    color = rng.uniform(-ranges.color, ranges.color, (links, 3))
    pose = np.eye(4)
    pose[:2, :2], pose[:2, 3] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]], (x, y)
    given: Mapping[str, bool] = {name: name in names for name in RANDOMIZED}
    return Draw(
        damping=damping if given["damping"] else np.ones(joints),
        friction=friction if given["friction"] else np.ones(joints),
        surface=surface if given["friction"] else 1.0,
        mass=mass if given["mass"] else np.ones(links),
        T_root=pose if given["pose"] else np.eye(4),
        color=color if given["color"] else np.zeros((links, 3)),
    )


def _factors(rng: np.random.Generator, ends: tuple[float, float], count: int) -> FloatArray:
    return np.asarray(np.exp(rng.uniform(np.log(ends[0]), np.log(ends[1]), count)))
