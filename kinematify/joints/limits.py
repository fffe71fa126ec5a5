"""Opening direction and limits: how far the chosen joint can go before the part meets another one.

Meshes do not hold designed stops, so these limits are upper bounds: a panel opens at most to a right angle, a drawer
by most of its own length, a button by its own thickness (everyday.md: such bounds hold for 86 to 90 % of the joints
of those kinds).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import JointType
from kinematify.joints.frames import UP
from kinematify.joints.sweep import moving_points, sweep_slides, sweep_turns

if TYPE_CHECKING:
    from kinematify.assembly.part import FloatArray
    from kinematify.config import JointsConfig
    from kinematify.joints.scene import JointScene


@dataclass(frozen=True, kw_only=True)
class Range:
    """Signed limits of a joint whose axis is turned so that q > 0 opens."""

    kind: JointType
    """`continuous` where a wheel or knob meets nothing in a full turn; else as given."""
    sign: float
    """+1 if the given axis opens the joint as it is, -1 if it must be reversed."""
    lower: float
    """Lower limit [rad or m]."""
    upper: float
    """Upper limit [rad or m]."""
    free_forward: float
    """Free motion in the opening direction [rad or m]."""
    free_backward: float
    """Free motion against it [rad or m]."""


def find_range(scene: JointScene, kind: JointType, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> Range:
    """Sweep the chosen joint both ways against all parts that do not move with it.

    Args:
        scene: The pair.
        kind: Chosen type.
        axis: Unit direction, shape (3,).
        pivot: Point on the axis [m], shape (3,).
        config: Bounds.
    """
    if kind is JointType.FIXED:
        return Range(kind=kind, sign=1.0, lower=0.0, upper=0.0, free_forward=0.0, free_backward=0.0)
    if kind is JointType.PRISMATIC:
        return _slide_range(scene, axis, config)
    return _turn_range(scene, axis, pivot, config)


def _turn_range(scene: JointScene, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> Range:
    points = moving_points(scene.cache, scene.child, config.sweep)
    obstacles = (scene.parent, *scene.others)
    sweep = sweep_turns(scene.cache, points, axis[None], pivot[None], obstacles, limit=np.pi, config=config.sweep)
    free = sweep.free(config.sweep.share)[0]
    if free.min() >= np.pi and _turns_freely(scene, axis):
        return Range(
            kind=JointType.CONTINUOUS,
            sign=_neutral_sign(scene, axis),
            lower=-np.inf,
            upper=np.inf,
            free_forward=np.pi,
            free_backward=np.pi,
        )
    sign = _turn_sign(scene, axis, pivot, free)
    forward, backward = (free[0], free[1]) if sign > 0 else (free[1], free[0])
    least = np.radians(config.limits.least_deg)
    door = scene.panel and scene.mechanism <= 0.5
    if (scene.gated and not door) or scene.mechanism > 0.5:
        lower, upper = -float(backward), float(forward)
    else:
        lower = -float(backward) if backward < least else 0.0
        upper = min(float(forward), np.radians(config.limits.panel_deg))
    return Range(
        kind=JointType.REVOLUTE,
        sign=sign,
        lower=lower,
        upper=max(upper, least),
        free_forward=float(forward),
        free_backward=float(backward),
    )


def _turns_freely(scene: JointScene, axis: FloatArray) -> bool:
    """A knob or wheel: a bearing through the part whose mass is spread evenly about it."""
    if not scene.gated or (scene.mechanism >= 1.0 and scene.smallness < 1.0):
        return False
    points = scene.cache.samples(scene.child).points
    offset = points - scene.contact.centroid
    lever = np.linalg.norm(np.cross(points.mean(axis=0) - scene.contact.centroid, axis))
    reach = np.linalg.norm(np.cross(offset, axis), axis=1).max()
    return bool(lever < 0.25 * reach)


def _turn_sign(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray) -> float:
    """The freer direction opens; where both are alike, the one that leads out of the body or up."""
    if abs(free[0] - free[1]) > np.radians(10.0) and free.min() < np.radians(60.0):
        return 1.0 if free[0] > free[1] else -1.0
    velocity = np.cross(axis, scene.centre - pivot)
    away = scene.outward if scene.outward.any() else UP
    if abs(float(velocity @ away)) < 0.05 * scene.frame.diagonal:
        return _neutral_sign(scene, axis)
    return 1.0 if float(velocity @ away) > 0.0 else -1.0


def _neutral_sign(scene: JointScene, axis: FloatArray) -> float:
    """Where neither way opens: the axis points from the parent to the child, else up, as knobs and arms have it."""
    apart = float((scene.centre - scene.parent_frame.centre) @ axis)
    if abs(apart) < 0.02 * scene.parent_frame.diagonal:
        apart = float(axis @ UP) if abs(float(axis @ UP)) > 0.1 else apart
    return 1.0 if apart >= 0.0 else -1.0


def _slide_range(scene: JointScene, axis: FloatArray, config: JointsConfig) -> Range:
    points = moving_points(scene.cache, scene.child, config.sweep)
    # A door in front of a tray moves away first, so furniture slides are bounded by the body alone.
    obstacles = (scene.parent, *scene.others) if scene.mechanism > 0.5 else (scene.parent,)
    limit = scene.diagonal
    sweep = sweep_slides(scene.cache, points, axis[None], obstacles, limit=limit, config=config.sweep)
    free = sweep.free(config.sweep.share)[0]
    length = float(np.ptp(scene.frame.local(points) @ (scene.frame.axes @ axis)))
    sign = _slide_sign(scene, axis, free)
    forward, backward = (free[0], free[1]) if sign > 0 else (free[1], free[0])
    least = config.limits.least_slide * scene.diagonal
    reach = config.limits.button * length if scene.smallness > 0.5 else config.limits.drawer * length
    upper = max(min(float(forward), reach), least)
    if scene.smallness > 0.5:
        upper = max(reach, least)
    lower = -min(float(backward), reach) if scene.mechanism > 0.5 else 0.0
    return Range(
        kind=JointType.PRISMATIC,
        sign=sign,
        lower=lower,
        upper=upper,
        free_forward=float(forward),
        free_backward=float(backward),
    )


def _slide_sign(scene: JointScene, axis: FloatArray, free: FloatArray) -> float:
    """Drawers and lids leave by the longer way, outwards if both are alike; buttons go in."""
    body = scene.parent_frame.centre
    outwards = 1.0 if float((scene.centre - body) @ axis) >= 0.0 else -1.0
    if scene.smallness > 0.5 and not scene.mechanism > 0.5:
        return -outwards
    if abs(free[0] - free[1]) > 0.02 * scene.diagonal:
        return 1.0 if free[0] > free[1] else -1.0
    return outwards
