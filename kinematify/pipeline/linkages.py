"""Closed chains of an inferred model: loop joints for the pins that the tree leaves out, and one motion for each chain.

What a tree says of the joints of a chain was found with each joint moving alone. In a linkage they move together: the
axes of a plane linkage are parallel, one joint drives the others, and all limits are reached at once, where the linkage
meets something or one of the ranges that were inferred ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config.validation import load_settings
from kinematify.geometry.scene import read_scene, visible_shapes
from kinematify.geometry.sweep import Sweeper
from kinematify.model.build import snapped
from kinematify.model.urdf import model_robot
from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import linkages, loop_gaps, with_closures
from kinematify.robot.robot import LoopJoint, Mimic

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.linkage import Linkage
    from kinematify.robot.robot import Joint, Robot

_MULTIPLES = (1.0, -1.0, 2.0, -2.0, 0.5, -0.5)
"""How parallelograms and scissors move; others are along a curve."""
_SLACK = 5e-3
"""How much farther than the linkage takes it a passive joint may go, as a share of its range."""
_ALONG = 0.999
"""Cosine between axes that are parallel."""
_SHARED = 0.3
"""Congruent linkages whose ranges have less than this in common stand differently."""
_SAMPLES = 41
"""Of a linkage's motion, where the gap of its pins is measured."""


_PARALLEL_DEG = 3.0  # axes of fitted bearings are off by 0.02 deg in the median, rough pins by 1 or 2
"""Axes of a chain that differ by less are made parallel [deg]."""
_EXACT = 5.0e-4  # half of what a closed loop may open
"""Joints follow by a fixed multiple where no pin opens by more."""
_MIMIC_DEG = 1.0  # the gap decides; this only finds the multiple
"""How far a joint may be from a fixed multiple [deg]."""
_LEAST = 0.02  # 1 deg: less is play
"""A linkage that is free over less than this is not judged by what it meets [rad or m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SharedAxis:
    """A pin that two links share without a joint between them."""

    links: tuple[str, str]
    axis: FloatArray
    """Unit direction, world frame, shape (3,)."""
    pivot: FloatArray
    """Point on it, world frame [m], shape (3,)."""


@dataclass(frozen=True, kw_only=True)
class Closing:
    """Result for a shared pin."""

    loop: str | None = None
    """The loop joint that was written; None where it would leave its joints no motion."""
    driver: str | None = None
    """Joint that moves the chain; None where the chain has more than one motion."""
    by: str = ""
    """``mimic`` where all others follow by a fixed multiple, ``loop`` where the loop joint alone holds them."""
    range: tuple[float, float] = (0.0, 0.0)
    """Of the driver [rad or m]."""


def close_chains(
    model: KinematicModel,
    pins: Sequence[SharedAxis],
    kind: Mapping[str, int],
    diagonal: float,
) -> tuple[KinematicModel, tuple[Closing, ...]]:
    """Write a loop joint for every shared pin that leaves its chain a motion, and make the chain's joints agree.

    Args:
        model: A tree; zero is the pose as given.
        pins: What the tree leaves out, the surest first.
        kind: One number for all links that are congruent.
        diagonal: Of the object [m].
        config: What counts as parallel, as exact and as closed.

    Returns:
        The model, and what became of each pin.
    """
    names: list[str | None] = []
    for pin in pins:
        loop = _loop(model, pin)
        tried = _parallel(replace(model, loops=(*model.loops, loop)), pins)
        rigid = any(loop.name in found.loops and found.mobility < 1 for found in linkages(_unlimited(tried, diagonal)))
        names.append(None if rigid else loop.name)
        model = model if rigid else tried
    moving = [found for found in linkages(_unlimited(model, diagonal)) if found.driver is not None]
    model = _same_way(model, moving, kind)
    moving = [found for found in linkages(_unlimited(model, diagonal)) if found.driver is not None]
    ranges = _alike(model, moving, [_range(model, found, diagonal) for found in moving], kind)
    closing: dict[str, Closing] = {}
    for linkage, ends in zip(moving, ranges, strict=True):
        model, found = _moving_as_one(model, linkage, ends, diagonal)
        closing |= dict.fromkeys(linkage.loops, found)
    done = tuple(
        Closing() if name is None else replace(closing.get(name, Closing(loop=name)), loop=name) for name in names
    )
    joints = with_closures(model.robot).joints
    return replace(model, joints=joints), done


def _loop(model: KinematicModel, pin: SharedAxis) -> LoopJoint:
    taken = {loop.name for loop in model.loops} | {joint.name for joint in model.joints}
    name, number = f"{pin.links[1]}_loop", 1
    while name in taken:
        number += 1
        name = f"{pin.links[1]}_loop_{number}"
    one, other = (pin.pivot - model.link_by_name[link].T_world_link[:3, 3] for link in pin.links)
    return LoopJoint(name=name, links=pin.links, points=(one, other))


def _unlimited(model: KinematicModel, diagonal: float) -> Robot:
    """Return the tree with room in all joints: turns without end, and slides by the object's size."""
    return replace(
        model.robot,
        joints=tuple(
            joint
            if joint.kind is JointType.FIXED
            else replace(joint, kind=JointType.CONTINUOUS, lower=-math.inf, upper=math.inf, closure=None)
            if joint.kind.turns
            else replace(joint, lower=-diagonal, upper=diagonal, closure=None)
            for joint in model.joints
        ),
    )


def _parallel(model: KinematicModel, pins: Sequence[SharedAxis]) -> KinematicModel:
    """Make the axes of a chain exactly parallel where they are nearly so: else a plane linkage would be rigid."""
    for loops in [found.joints for found in linkages(model.robot)]:
        turning = [joint for joint in model.joints if joint.name in loops and joint.kind.turns]
        if not turning:
            continue
        first = turning[0].axis
        directions = [joint.axis for joint in turning] + [pin.axis for pin in pins if _of(model, pin, loops)]
        cosines = [abs(float(axis @ first)) for axis in directions]
        if min(cosines) < math.cos(math.radians(_PARALLEL_DEG)):
            continue
        mean = np.sum([np.copysign(1.0, float(axis @ first)) * axis for axis in directions], axis=0)
        mean = snapped(mean / np.linalg.norm(mean))
        axes = {joint.name: np.copysign(1.0, float(joint.axis @ mean)) * mean + 0.0 for joint in turning}
        joints = tuple(replace(joint, axis=axes.get(joint.name, joint.axis)) for joint in model.joints)
        model = replace(model, joints=joints)
    return model


def _of(model: KinematicModel, pin: SharedAxis, joints: Sequence[str]) -> bool:
    """True if a pin holds links that joints of a chain move."""
    moved = {joint.child for joint in model.joints if joint.name in joints}
    return bool(moved & set(pin.links))


def _same_way(model: KinematicModel, moving: Sequence[Linkage], kind: Mapping[str, int]) -> KinematicModel:
    """Make joints of parallel arms that are congruent with the driver's turn about its axis, not about its opposite."""
    joints = {joint.name: joint for joint in model.joints}
    for linkage in moving:
        driver = joints[linkage.driver or ""]
        for name in linkage.joints:
            joint = joints[name]
            alike = kind[joint.child] == kind[driver.child]
            if alike and joint.kind.turns and float(joint.axis @ driver.axis) < -_ALONG:
                joints[name] = replace(joint, axis=0.0 - joint.axis, lower=-joint.upper, upper=-joint.lower)
    return replace(model, joints=tuple(joints.values()))


def _alike(
    model: KinematicModel,
    moving: Sequence[Linkage],
    ranges: Sequence[tuple[float, float]],
    kind: Mapping[str, int],
) -> list[tuple[float, float]]:
    """Give linkages of congruent parts one range, that in which all of them are free."""
    found = list(ranges)
    for one, other in combinations(range(len(ranges)), 2):
        if _kinds(model, moving[one], kind) != _kinds(model, moving[other], kind):
            continue
        (low, high), (a, b) = found[one], found[other]
        sign, shared = max(
            ((sign, (max(low, x), min(high, y))) for sign, x, y in ((1.0, a, b), (-1.0, -b, -a))),
            key=lambda item: item[1][1] - item[1][0],
        )
        if shared[1] - shared[0] > _SHARED * max(high - low, b - a):
            found[one] = shared
            found[other] = shared if sign > 0.0 else (-shared[1], -shared[0])
    return found


def _kinds(model: KinematicModel, linkage: Linkage, kind: Mapping[str, int]) -> list[int]:
    """Which shapes a linkage moves."""
    return sorted(kind[joint.child] for joint in model.joints if joint.name in linkage.joints)


def _moving_as_one(
    model: KinematicModel, linkage: Linkage, ends: tuple[float, float], diagonal: float
) -> tuple[KinematicModel, Closing]:
    """Give all joints of a linkage the limits of one motion, and <mimic> where that is exact."""
    exact = _with_limits(model, linkage, ends, 0.0)
    # In this range another joint, nearer the root, may drive as well.
    linkage = next(found for found in linkages(exact.robot) if found.loops == linkage.loops)
    if linkage.driver is None:
        return exact, Closing(loop="")
    at = linkage.curve[:, linkage.joints.index(linkage.driver)]
    ends = float(at[0]), float(at[-1])
    model = _with_limits(model, linkage, ends, _SLACK)
    multiples = _multiples(model, linkage, ends, diagonal)
    joints = tuple(
        replace(
            joint,
            lower=min(multiples[joint.name] * end for end in ends),
            upper=max(multiples[joint.name] * end for end in ends),
            mimic=Mimic(joint=linkage.driver, multiplier=multiples[joint.name], offset=0.0),
        )
        if joint.name in multiples
        else joint
        for joint in model.joints
    )
    by = "mimic" if multiples else "loop"
    return replace(model, joints=joints), Closing(loop="", driver=linkage.driver, by=by, range=ends)


def _with_limits(model: KinematicModel, linkage: Linkage, ends: tuple[float, float], slack: float) -> KinematicModel:
    """Make every joint of a linkage go as far as the driver takes it between two values.

    Args:
        model: The tree.
        linkage: Its motion.
        ends: Of the driver [rad or m].
        slack: How much farther passive joints may go, as a share of their range: it is the driver's stop that counts.
        config: What counts as a whole turn.
    """
    driver = linkage.curve[:, linkage.joints.index(linkage.driver or "")]
    at = np.unique([*ends, *driver[(driver > ends[0]) & (driver < ends[1])]])
    endless = linkage.turns_around and ends[1] - ends[0] >= 2.0 * math.pi - _LEAST
    joints = {joint.name: joint for joint in model.joints}
    for name in linkage.joints:
        values = at if name == linkage.driver else linkage.closure(name).follow(at)
        more = 0.0 if name == linkage.driver else slack * float(np.ptp(values))
        whole = endless and abs(values[-1] - values[0]) > math.pi
        joints[name] = _limited(joints[name], float(values.min()) - more, float(values.max()) + more, endless=whole)
    return replace(model, joints=tuple(joints[joint.name] for joint in model.joints))


def _limited(joint: Joint, lower: float, upper: float, *, endless: bool) -> Joint:
    if endless:
        return replace(joint, kind=JointType.CONTINUOUS, lower=-math.inf, upper=math.inf)
    return replace(joint, kind=JointType.REVOLUTE if joint.kind.turns else joint.kind, lower=lower, upper=upper)


def _range(model: KinematicModel, linkage: Linkage, diagonal: float) -> tuple[float, float]:
    """Values of the driver between which nothing is met, and that one joint of the linkage was thought to reach."""
    column = linkage.joints.index(linkage.driver or "")
    at = linkage.curve[:, column]
    low, high = _thought(model, linkage, at)
    robot = replace(model_robot(model), joints=_unlimited(model, diagonal).joints)
    driven = {name: linkage.closure(name) for name in linkage.joints if name != linkage.driver}
    joints = tuple(
        _limited(joint, max(low, float(at[0])), min(high, float(at[-1])), endless=False)
        if joint.name == linkage.driver
        else replace(joint, closure=driven.get(joint.name))
        for joint in robot.joints
    )
    settings = load_settings().geometry
    scene = read_scene(replace(robot, joints=joints), settings, visible_shapes)
    leader = [travel.joint for travel in scene.travels].index(linkage.driver or "")
    sweeper = Sweeper.of(scene)
    free = sweeper.free_end(leader, -1.0), sweeper.free_end(leader, 1.0)
    if free[1] - free[0] < _LEAST:  # its parts are in each other as they are: the motion cannot be judged
        return max(low, float(at[0])), min(high, float(at[-1]))
    return free


def _thought(model: KinematicModel, linkage: Linkage, at: FloatArray) -> tuple[float, float]:
    """Values of the driver that the inferred range of at least one joint allows.

    A joint that moves alone is stopped by the pin that the tree leaves out, so that the widest range is the likeliest.
    """
    rest = int(np.abs(at).argmin())
    low, high = rest, rest
    for column, name in enumerate(linkage.joints):
        joint = next(item for item in model.joints if item.name == name)
        inside = (linkage.curve[:, column] >= joint.lower - 1e-9) & (linkage.curve[:, column] <= joint.upper + 1e-9)
        inside[rest] = True
        outside = np.flatnonzero(~inside)
        low = min(low, int(outside[outside < rest].max(initial=-1)) + 1)
        high = max(high, int(outside[outside > rest].min(initial=len(at))) - 1)
    return float(at[low]), float(at[high])


def _multiples(
    model: KinematicModel, linkage: Linkage, ends: tuple[float, float], diagonal: float
) -> Mapping[str, float]:
    """Multiples of the driver by which joints follow it, where all pins stay closed that way."""
    driver = linkage.driver or ""
    values = np.linspace(*ends, _SAMPLES)
    reach = _EXACT * diagonal
    found = {}
    for name in linkage.joints:
        joint = model.robot.joint_by_name[name]
        if name == driver or joint.kind.turns is not model.robot.joint_by_name[driver].kind.turns:
            continue
        own = linkage.closure(name).follow(values)
        slack = _MIMIC_DEG if joint.kind.turns else reach
        errors = {multiple: float(np.abs(own - multiple * values).max()) for multiple in _MULTIPLES}
        best = min(errors, key=lambda multiple: errors[multiple])
        if errors[best] < (math.radians(slack) if joint.kind.turns else slack):
            found[name] = best
    if len(found) < len(linkage.joints) - 1:
        return {}  # what follows along a curve would be pulled apart from what follows by a multiple
    tried = replace(
        model.robot,
        joints=tuple(
            replace(joint, mimic=Mimic(joint=driver, multiplier=found[joint.name], offset=0.0))
            if joint.name in found
            else joint
            for joint in model.joints
        ),
    )
    gaps = [max(loop_gaps(tried, {driver: float(value)}).get(name, 0.0) for name in linkage.loops) for value in values]
    return found if max(gaps) <= reach else {}
