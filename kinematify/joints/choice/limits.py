"""Opening direction and limits: how far the chosen joint can go before the part meets another one.

Meshes do not hold designed stops, so these limits are upper bounds: a panel opens at most to a right angle, a drawer
by most of its own length, a button by its own thickness (everyday.md: such bounds hold for 86 to 90 % of the joints
of those kinds).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.choice.joint_range import Range
from kinematify.joints.choice.opening import turn_sign
from kinematify.joints.choice.turning import goes_round
from kinematify.joints.hypotheses.frames import UP
from kinematify.joints.measure.closing import closing_turns
from kinematify.joints.measure.opening_direction import clockwise_sign, neutral_sign, swing_sign
from kinematify.joints.measure.scene import eccentricity
from kinematify.joints.measure.sweep import moving_points, sweep_turns
from kinematify.joints.measure.travel import slide_range
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from kinematify.config import JointsConfig
    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray


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
        return slide_range(scene, axis, config)
    return _turn_range(scene, axis, pivot, config)


def _turn_range(scene: JointScene, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> Range:
    free = _free_turn(scene, axis, pivot, (scene.parent, *scene.others), config)
    if goes_round(scene, axis, pivot, free):
        return Range(
            kind=JointType.CONTINUOUS,
            sign=clockwise_sign(scene, axis),
            lower=-np.inf,
            upper=np.inf,
            free_forward=np.pi,
            free_backward=np.pi,
        )
    if scene.fold is not None and abs(float(axis @ scene.fold.axis)) > np.cos(np.radians(config.limits.square_deg)):
        return _rocker_range(scene, axis, free, config)
    if scene.pedal_direction.any() and abs(float(axis @ UP)) < 0.1:
        return _pedal_range(scene, axis, pivot, free, config)
    furniture = scene.mechanism <= 0.5
    if furniture and scene.panel:
        return _panel_range(scene, axis, pivot, free, config)
    if (
        not scene.serial
        and scene.has_bearing
        and free.min() > np.radians(config.limits.unstopped_deg)
        and _is_lever(scene, axis, config)
    ):
        return _lever_range(scene, axis, free, config)
    sign = turn_sign(scene, axis, pivot, free, config.limits)
    forward, backward = (free[0], free[1]) if sign > 0 else (free[1], free[0])
    if scene.has_bearing or not furniture:
        lower, upper = -float(backward), _from_stop(scene, float(forward), float(backward), config)
    else:
        lower = -float(backward) if backward < np.radians(config.limits.least_deg) else 0.0
        upper = min(float(forward), np.radians(config.limits.panel_deg))
    return _range(sign, lower, upper, free, config)


def _free_turn(
    scene: JointScene, axis: FloatArray, pivot: FloatArray, obstacles: tuple[int, ...], config: JointsConfig
) -> FloatArray:
    """Free angle towards + and - [rad], shape (2,)."""
    points = moving_points(scene.cache, scene.child, config.sweep)
    sweep = sweep_turns(scene.cache, points, axis[None], pivot[None], obstacles, limit=np.pi, config=config.sweep)
    return np.asarray(sweep.free(config.sweep.share)[0])


def _from_stop(scene: JointScene, forward: float, backward: float, config: JointsConfig) -> float:
    """Upper limit [rad] of what turns freely: what has a stop opens to a right angle from there at most, as panels do.

    Blades of scissors, arms of glasses and ribs of umbrellas meet nothing on the way round, and none goes round.
    Links that hang on moving ones are left alone unless they stand at the stop, for knees and elbows stop one way, too;
    and so is what has no pin, as a handle that folds back.
    """
    limits = config.limits
    if backward < np.radians(limits.stopped_deg):
        return float(min(forward, np.radians(limits.panel_deg)))
    unstopped = forward >= np.pi and backward < np.radians(limits.panel_deg)
    pinned = scene.has_bearing and not scene.parent_moves
    return float(np.radians(limits.panel_deg)) - backward if unstopped and pinned else forward


def _range(sign: float, lower: float, upper: float, free: FloatArray, config: JointsConfig) -> Range:
    forward, backward = (free[0], free[1]) if sign > 0 else (free[1], free[0])
    return Range(
        kind=JointType.REVOLUTE,
        sign=sign,
        lower=lower,
        upper=max(upper, np.radians(config.limits.least_deg)),
        free_forward=float(forward),
        free_backward=float(backward),
    )


# ---- rockers and pedals --------------------------------------------------------------------------------------------


def _rocker_range(scene: JointScene, axis: FloatArray, free: FloatArray, config: JointsConfig) -> Range:
    """A rocker tips until either half of its front is level with the face that it sits in; the longer way opens."""
    fold = scene.fold
    faces = scene.parent_frame.axes
    thin = scene.frame.axes[scene.frame.thin]
    face = faces[int(np.abs(faces @ thin).argmax())]
    turns = np.zeros(2) if fold is None else fold.turns_level(face) * np.copysign(1.0, float(fold.axis @ axis))
    reach = np.array([max(float(turns.max()), 0.0), max(-float(turns.min()), 0.0)])
    reach = np.minimum(reach, np.maximum(free, np.radians(config.limits.least_deg)))
    sign = neutral_sign(scene, axis) if np.ptp(reach) < 0.1 * reach.max() else float(np.sign(reach[0] - reach[1]))
    forward, backward = (reach[0], reach[1]) if sign > 0 else (reach[1], reach[0])
    return _range(sign, -float(backward), float(forward), free, config)


def _pedal_range(
    scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray, config: JointsConfig
) -> Range:
    """A pedal goes down, by no more than a lever does."""
    sign = 1.0 if float(np.cross(axis, scene.centre - pivot)[2]) < 0.0 else -1.0
    down = float(free[0] if sign > 0 else free[1])
    return _range(sign, 0.0, min(down, np.radians(config.limits.lever_deg)), free, config)


# ---- panels --------------------------------------------------------------------------------------------------------


def _panel_range(
    scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray, config: JointsConfig
) -> Range:
    """A door or lid: it opens away from where it lies on its body, to a right angle beyond that place."""
    limits = config.limits
    if free.max() < np.radians(limits.blocked_deg):
        # Something lies on it or stands before it, which is moved away first (a lid on a seat).
        free = _free_turn(scene, axis, pivot, (scene.parent,), config)
    closing = closing_turns(scene, axis, pivot, free, config)
    sign = -float(np.sign(closing[0])) if len(closing) == 1 else turn_sign(scene, axis, pivot, free, config.limits)
    if len(closing) == 2:
        either = np.minimum(free, np.radians(limits.panel_deg))
        forward, backward = (either[0], either[1]) if sign > 0 else (either[1], either[0])
        return _range(sign, -float(backward), float(forward), free, config)
    forward, backward = (float(free[0]), float(free[1])) if sign > 0 else (float(free[1]), float(free[0]))
    if len(closing) == 1:
        ajar = abs(closing[0])
        return _range(sign, -ajar, min(forward, max(np.radians(limits.panel_deg) - ajar, 0.0)), free, config)
    if max(forward, backward) < np.radians(limits.blocked_deg):
        forward = np.pi  # its mesh overlaps the frame: no door is made to stay shut
    lower = -backward if backward < np.radians(limits.least_deg) else 0.0
    return _range(sign, lower, min(forward, np.radians(limits.panel_deg)), free, config)


# ---- levers ----------------------------------------------------------------------------------------------


def _is_lever(scene: JointScene, axis: FloatArray, config: JointsConfig) -> bool:
    """An arm on a pivot."""
    return eccentricity(scene, axis, scene.contact.centroid) >= config.limits.even


def _lever_range(scene: JointScene, axis: FloatArray, free: FloatArray, config: JointsConfig) -> Range:
    """A handle is pressed down by its free end where that lies level; about an upright axis it goes both ways."""
    reach = np.radians(config.limits.lever_deg)
    arm = scene.cache.samples(scene.child).points.mean(axis=0) - scene.contact.centroid
    falling = float(np.cross(axis, arm)[2])
    if abs(falling) > 0.5 * float(np.linalg.norm(np.cross(axis, arm))):
        sign = 1.0 if falling < 0.0 else -1.0
        return _range(sign, 0.0, min(float(free[0 if sign > 0 else 1]), reach), free, config)
    sign = swing_sign(scene, axis, scene.contact.centroid)
    forward, backward = (free[0], free[1]) if sign > 0 else (free[1], free[0])
    return _range(sign, -min(float(backward), 2 * reach), min(float(forward), 2 * reach), free, config)
