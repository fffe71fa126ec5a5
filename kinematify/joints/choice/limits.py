"""Opening direction and limits: how far the chosen joint can go before the part meets another one.

Meshes do not hold designed stops, so these limits are upper bounds: a panel opens at most to a right angle, a drawer
by most of its own length, a button by its own thickness (everyday.md: such bounds hold for 86 to 90 % of the joints
of those kinds).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.choice.opening import clockwise_sign, is_continuous, neutral_sign, swing_sign, turn_sign
from kinematify.joints.measure.frames import UP
from kinematify.joints.measure.scene import eccentricity
from kinematify.joints.measure.sweep import Sweep, moving_points, sweep_turns
from kinematify.joints.measure.travel import AS_GIVEN, USUAL, End, Range, Ways, free_ways, slide_range
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Sequence

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
        none = End(0.0, "")
        return Range(kind=kind, sign=1.0, back=none, ahead=none, free=(none, none))
    if kind is JointType.PRISMATIC:
        return slide_range(scene, axis, config)
    return _turn_range(scene, axis, pivot, config)


def _turn_range(scene: JointScene, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> Range:
    ways = _free_turn(scene, axis, pivot, (scene.parent, *scene.others), config)
    free = np.array([way.motion for way in ways])
    if is_continuous(scene, axis, pivot, free):
        none, half, sign = End(np.inf, ""), End(np.pi, ""), clockwise_sign(scene, axis)
        return Range(kind=JointType.CONTINUOUS, sign=sign, back=none, ahead=none, free=(half, half))
    if scene.fold is not None and abs(float(axis @ scene.fold.axis)) > np.cos(np.radians(config.limits.square_deg)):
        return _rocker_range(scene, axis, ways)
    if scene.pedal_direction.any() and abs(float(axis @ UP)) < 0.1:
        return _pedal_range(scene, axis, pivot, ways, config)
    furniture = scene.mechanism <= 0.5
    if furniture and scene.panel:
        return _panel_range(scene, axis, pivot, ways, config)
    if (
        not scene.serial
        and scene.has_bearing
        and free.min() > np.radians(config.limits.unstopped_deg)
        and eccentricity(scene, axis, scene.contact.centroid) >= config.limits.even  # an arm on a pivot
    ):
        return _lever_range(scene, axis, ways, config)
    sign = turn_sign(scene, axis, pivot, free, config.limits)
    forward, backward = ways if sign > 0 else ways[::-1]
    usual, blocked = _usual(config.limits.panel_deg), free.max() < np.radians(config.limits.stopped_deg)
    # What is blocked both ways overlaps its neighbours, or is fixed: the sweep says nothing of its range.
    back, ahead = AS_GIVEN, usual if blocked else min(forward, usual)
    if not blocked and (scene.has_bearing or not furniture):
        back, ahead = backward, _from_stop(scene, forward, backward, config)
    if not scene.serial:  # whose links are stopped by what is not in the mesh, too
        back, ahead = (_usual(config.limits.unmet_deg) if end.motion >= np.pi else end for end in (back, ahead))
    return _range(sign, back, ahead, ways)


def _free_turn(
    scene: JointScene, axis: FloatArray, pivot: FloatArray, obstacles: Sequence[int], config: JointsConfig
) -> Ways:
    """Free angle towards + and -."""
    points = moving_points(scene.cache, scene.child, config.sweep)

    def swept(parts: Sequence[int]) -> Sweep:
        return sweep_turns(scene.cache, points, axis[None], pivot[None], parts, limit=np.pi, config=config.sweep)

    return free_ways(scene, swept, obstacles, config.sweep.share)


def _usual(degrees: float) -> End:
    return End(float(np.radians(degrees)), USUAL)


def _from_stop(scene: JointScene, forward: End, backward: End, config: JointsConfig) -> End:
    """Upper limit of what turns freely: what has a stop opens to a right angle from there at most, as panels do.

    Blades of scissors, arms of glasses and ribs of umbrellas meet nothing on the way round, and none goes round.
    Links that hang on moving ones are left alone unless they stand at the stop, for knees and elbows stop one way, too;
    and so is what has no pin, as a handle that folds back.
    """
    limits = config.limits
    right = _usual(limits.panel_deg)
    if backward.motion < np.radians(limits.stopped_deg):
        return min(forward, right)
    unstopped = forward.motion >= np.pi and backward.motion < right.motion
    pinned = scene.has_bearing and not scene.parent_moves
    return End(right.motion - backward.motion, USUAL) if unstopped and pinned else forward


def _range(sign: float, back: End, ahead: End, free: Ways) -> Range:
    return Range(kind=JointType.REVOLUTE, sign=sign, back=back, ahead=ahead, free=free if sign > 0 else free[::-1])


# ---- rockers and pedals --------------------------------------------------------------------------------------------


def _rocker_range(scene: JointScene, axis: FloatArray, free: Ways) -> Range:
    """A rocker tips until either half of its front is level with the face that it sits in; the longer way opens."""
    fold = scene.fold
    faces = scene.parent_frame.axes
    thin = scene.frame.axes[scene.frame.thin]
    face = faces[int(np.abs(faces @ thin).argmax())]
    turns = np.zeros(2) if fold is None else fold.turns_level(face) * np.copysign(1.0, float(fold.axis @ axis))
    reach = np.array([max(float(turns.max()), 0.0), max(-float(turns.min()), 0.0)])
    sign = neutral_sign(scene, axis) if np.ptp(reach) < 0.1 * reach.max() else float(np.sign(reach[0] - reach[1]))
    ends = [End(float(angle), "level with the face around it") for angle in reach]
    forward, backward = ends if sign > 0 else ends[::-1]
    return _range(sign, backward, forward, free)


def _pedal_range(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: Ways, config: JointsConfig) -> Range:
    """A pedal goes down, by no more than a lever does."""
    sign = 1.0 if float(np.cross(axis, scene.centre - pivot)[2]) < 0.0 else -1.0
    return _range(sign, AS_GIVEN, min(free[0 if sign > 0 else 1], _usual(config.limits.lever_deg)), free)


# ---- panels --------------------------------------------------------------------------------------------------------


def _panel_range(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: Ways, config: JointsConfig) -> Range:
    """A door or lid: it opens away from where it lies on its body, to a right angle beyond that place."""
    limits, right = config.limits, _usual(config.limits.panel_deg)
    if max(free).motion < np.radians(limits.blocked_deg):
        # Something lies on it or stands before it, which is moved away first (a lid on a seat).
        free = _free_turn(scene, axis, pivot, (scene.parent,), config)
    angles = np.array([way.motion for way in free])
    closing = closing_turns(scene, axis, pivot, angles, config)
    sign = -float(np.sign(closing[0])) if len(closing) == 1 else turn_sign(scene, axis, pivot, angles, config.limits)
    forward, backward = free if sign > 0 else free[::-1]
    if len(closing) == 2:
        return _range(sign, min(backward, right), min(forward, right), free)
    if len(closing) == 1:
        shut = End(abs(closing[0]), "shut against its body")
        return _range(sign, shut, min(forward, End(max(right.motion - shut.motion, 0.0), USUAL)), free)
    # Where its mesh overlaps the frame, what stops it says nothing: no door is made to stay shut.
    blocked = max(free).motion < np.radians(limits.blocked_deg)
    return _range(sign, AS_GIVEN, right if blocked else min(forward, right), free)


# ---- levers ----------------------------------------------------------------------------------------------


def _lever_range(scene: JointScene, axis: FloatArray, free: Ways, config: JointsConfig) -> Range:
    """A handle is pressed down by its free end where that lies level; about an upright axis it goes both ways."""
    reach = config.limits.lever_deg
    arm = scene.cache.samples(scene.child).points.mean(axis=0) - scene.contact.centroid
    falling = float(np.cross(axis, arm)[2])
    if abs(falling) > 0.5 * float(np.linalg.norm(np.cross(axis, arm))):
        sign = 1.0 if falling < 0.0 else -1.0
        return _range(sign, AS_GIVEN, min(free[0 if sign > 0 else 1], _usual(reach)), free)
    sign = swing_sign(scene, axis, scene.contact.centroid)
    forward, backward = free if sign > 0 else free[::-1]
    return _range(sign, min(backward, _usual(2 * reach)), min(forward, _usual(2 * reach)), free)


def closing_turns(
    scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray, config: JointsConfig
) -> tuple[float, ...]:
    """Signed angles [rad] by which a panel that stands open turns to lie along its body; none where it is closed.

    An open panel touches its body at the hinge alone and stands askew, or upright on top of it. Of the ways to get
    square to the body, the one that it can go and that brings it nearer closes it. A bail or a carrying handle lies
    down to either side alike.

    Args:
        scene: The pair; its child is a panel.
        axis: Unit direction of the hinge, shape (3,).
        pivot: Point on it [m], shape (3,).
        free: Free angle towards + and - [rad], shape (2,).
        config: Bounds.
    """
    limits = config.limits
    if _touches_elsewhere(scene, axis, pivot, config):
        return ()
    now = _closeness(scene, axis, pivot, 0.0)
    turns, square = _square_turns(scene, axis, config)
    found = sorted((_closeness(scene, axis, pivot, turn) / now, turn) for turn in turns)
    possible = [pair for pair in found if pair[0] < limits.closer and _can_turn(*pair, free, config)]
    if len(possible) > 1 and possible[1][1] * possible[0][1] < 0.0 and possible[0][0] > limits.closer * possible[1][0]:
        return possible[0][1], possible[1][1]
    if square and not (_stands_on_top(scene, axis) and possible and possible[0][0] < limits.lying):
        return ()
    return tuple(turn for _, turn in possible[:1])


def _can_turn(ratio: float, turn: float, free: FloatArray, config: JointsConfig) -> bool:
    """Whether a panel gets as far as to come nearer by a ratio.

    Where it then lies on its body all over, that it met something on the way is an overlap of the meshes at its hinge.
    """
    limits = config.limits
    overlap = np.radians(limits.lying_deg if ratio < limits.lying else limits.blocked_deg)
    return bool(abs(turn) < free[0 if turn > 0 else 1] + overlap)


def _square_turns(scene: JointScene, axis: FloatArray, config: JointsConfig) -> tuple[list[float], bool]:
    """Signed angles [rad] by which a panel turns to get square to its body; and whether it is so as it is."""
    normal = scene.frame.axes[scene.frame.thin]
    turns: list[float] = []
    for face in scene.parent_frame.axes:
        across = face - (face @ axis) * axis
        if np.linalg.norm(across) < 0.9 or abs(float(normal @ axis)) > 0.3:
            continue
        tilt = float(np.arctan2(np.cross(normal, across) @ axis, normal @ across))
        turns += [tilt, tilt - np.copysign(np.pi, tilt)]
    least = np.radians(config.limits.square_deg)
    others = [turn for turn in turns if least < abs(turn) < np.pi - least]
    return others, len(others) < len(turns)


def _stands_on_top(scene: JointScene, axis: FloatArray) -> bool:
    """An upright panel on a level hinge whose middle is above all of its body: no lid is shut like that."""
    top = float(scene.cache.assembly.parts[scene.parent].bounds[1, 2])
    return bool(scene.upright and abs(float(axis @ UP)) < 0.1 and scene.centre[2] > top)


def _touches_elsewhere(scene: JointScene, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> bool:
    """The panel touches its body away from the hinge, as a closed one does on its frame."""
    if len(scene.contact.points) == 0:
        return False
    reach = np.linalg.norm(np.cross(scene.cache.samples(scene.child).points - pivot, axis), axis=1).max()
    apart = np.linalg.norm(np.cross(scene.contact.points - pivot, axis), axis=1)
    near = (apart < config.panels.hinge_band * reach) @ scene.contact.weights
    return bool(near < config.panels.ajar_share)


def _closeness(scene: JointScene, axis: FloatArray, pivot: FloatArray, turn: float) -> float:
    """Mean distance of the turned child from its parent [m]."""
    points = scene.cache.samples(scene.child).points[::10]
    moved = pivot + (points - pivot) @ rotation_about(axis, turn).T
    return float(scene.cache.distances(scene.parent, moved).mean())
