"""Damping and friction of joints, full force of the hand, and what `randomize` draws of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.simulation.world import Variation

if TYPE_CHECKING:
    from collections.abc import Collection

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.robot.arrays import FloatArray

RANDOMIZED = ("damping", "friction", "mass", "pose", "color")
"""What `randomize` may name."""
DAMPING_RATE = 1.5  # a drawer that is let go comes to rest within a second or two
"""Damping of a joint without one, per inertia that it moves [1/s]."""
FRICTION_ACCELERATION = 0.3  # gives a drawer of 5 kg 1.5 N, a light kitchen slide
"""Friction of a joint without one, per inertia that it moves [m/s^2 or rad/s^2]."""
HOLD = 1.3  # what would start to move by its own weight stands still, as it was given
"""Friction of a joint without one, over what gravity pulls it away from rest with."""

SECONDS = 1.5  # people open doors and drawers in one to two seconds
"""Time in which the hand can open the part from rest to rest [s]."""
FORCE_MARGIN = 3.0  # what is needed stays in the middle of the range of actions
"""Full force over what that needs."""
_LEAST_FORCE = 0.05  # the lightest lids and clock hands need less
"""Full force at least [N]."""

FACTORS = (0.5, 2.0)
"""Of damping in joints, and of friction in joints and contacts, drawn evenly in its logarithm."""
MASSES = (0.8, 1.25)  # what lies in a drawer
"""Factor of the masses of what moves, drawn evenly in its logarithm."""
PLACE, ROBOT_PLACE = (0.05, 0.35), (0.02, 0.08)  # 20 deg; what is out of an arm's reach teaches nothing
"""Of the object along x and y [m] and about z [rad], either way; the same in front of a robot."""
COLOR = 0.25
"""Of each channel, either way."""


def joint_dynamics(
    articulated_object: ArticulatedObject, inertia: FloatArray, gravity: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the declared dynamics; where the file has none, values in proportion to what the joint moves.

    Friction then also holds what its own weight would move from where it was given into its range.

    Args:
        articulated_object: The object.
        inertia: That each joint moves at rest [kg m^2 or kg], shape (J,).
        gravity: Torque or force that holds each joint still at rest [N m or N], shape (J,).

    Returns:
        Damping [N m s/rad or N s/m] and friction [N m or N], shape (J,) each, in the order of `Mechanism.joints`.
    """
    mechanism, declared = articulated_object.scene.mechanism, articulated_object.declared.joint_by_name
    damping, friction = DAMPING_RATE * inertia, FRICTION_ACCELERATION * inertia
    travels = {travel.joint: travel for travel in articulated_object.travels}
    for k, name in enumerate(mechanism.joints):
        joint, travel, torque = declared[name], travels.get(name), float(gravity[k])
        slack = 0.01 * travel.range if travel is not None else 0.0
        moves = travel is None or (
            travel.lower < travel.rest - slack if torque > 0.0 else travel.upper > travel.rest + slack
        )
        if moves:
            friction[k] = max(friction[k], HOLD * abs(torque))
        if joint.damping is not None and joint.damping > 0.0:
            damping[k] = joint.damping
        if joint.friction is not None and joint.friction > 0.0:
            friction[k] = joint.friction
    return damping, friction


def full_force(target: Target, *, inertia: FloatArray, gravity: FloatArray, damping: float, friction: float) -> float:
    """Force of a hand that opens the part from rest to rest in `SECONDS`, with a margin [N].

    Args:
        target: The joint and its way.
        inertia: Along the way [kg m^2 or kg], shape (n,).
        gravity: Along the way [N m or N], shape (n,).
        damping: Of the joint.
        friction: Of the joint.
    """
    acceleration = 4.0 * abs(target.range) / SECONDS**2
    speed = 1.5 * abs(target.range) / SECONDS
    needed = np.max(np.abs(gravity) + inertia * acceleration) + damping * speed + friction
    return max(_LEAST_FORCE, FORCE_MARGIN * float(needed) / target.path_ratio)


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


def draw(names: frozenset[str], joints: int, links: int, rng: np.random.Generator, *, robot: bool) -> Draw:
    """Draw an object; always the same number of draws, so that one name does not change what others give.

    Args:
        names: What is randomised (`drawing`).
        joints: J.
        links: L.
        rng: Source of the draws.
        robot: The object stands in front of a robot, and moves less.
    """
    position, yaw = ROBOT_PLACE if robot else PLACE
    damping, friction = _factors(rng, FACTORS, joints), _factors(rng, FACTORS, joints)
    surface, mass = float(_factors(rng, FACTORS, 1)[0]), _factors(rng, MASSES, links)
    x, y, turn = rng.uniform(-1.0, 1.0, 3) * [position, position, yaw]
    color = rng.uniform(-COLOR, COLOR, (links, 3))
    pose = np.eye(4)
    pose[:2, :2], pose[:2, 3] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]], (x, y)
    return Draw(
        damping=damping if "damping" in names else np.ones(joints),
        friction=friction if "friction" in names else np.ones(joints),
        surface=surface if "friction" in names else 1.0,
        mass=mass if "mass" in names else np.ones(links),
        T_root=pose if "pose" in names else np.eye(4),
        color=color if "color" in names else np.zeros((links, 3)),
    )


def _factors(rng: np.random.Generator, ends: tuple[float, float], count: int) -> FloatArray:
    return np.asarray(np.exp(rng.uniform(np.log(ends[0]), np.log(ends[1]), count)))
