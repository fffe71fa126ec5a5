"""Opening direction and limits: how far the chosen joint can go before the part meets another one.

Meshes do not hold designed stops, so these limits are upper bounds: a panel opens at most to a right angle, a drawer
by most of its own length, a button by its own thickness (everyday.md: such bounds hold for 86 to 90 % of the joints
of those kinds).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.robot import rotation_about
from kinematify.joints.candidate import JointType
from kinematify.joints.frames import UP
from kinematify.joints.play import slide_play
from kinematify.joints.scene import eccentricity, is_cap
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
    free = _free_turn(scene, axis, pivot, (scene.parent, *scene.others), config)
    if free.min() >= np.pi and _turns_freely(scene, axis, pivot, config):
        return Range(
            kind=JointType.CONTINUOUS,
            sign=_clockwise_sign(scene, axis),
            lower=-np.inf,
            upper=np.inf,
            free_forward=np.pi,
            free_backward=np.pi,
        )
    if scene.fold is not None and abs(float(axis @ scene.fold.axis)) > np.cos(np.radians(config.limits.square_deg)):
        return _rocker_range(scene, axis, free, config)
    if scene.trodden.any() and abs(float(axis @ UP)) < 0.1:
        return _pedal_range(scene, axis, pivot, free, config)
    furniture = scene.mechanism <= 0.5
    if furniture and scene.panel:
        return _panel_range(scene, axis, pivot, free, config)
    if (
        not scene.serial
        and scene.gated
        and free.min() > np.radians(config.limits.unstopped_deg)
        and _is_lever(scene, axis, config)
    ):
        return _lever_range(scene, axis, free, config)
    sign = _turn_sign(scene, axis, pivot, free, config)
    forward, backward = (free[0], free[1]) if sign > 0 else (free[1], free[0])
    if scene.gated or not furniture:
        lower, upper = -float(backward), float(forward)
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
    sign = _neutral_sign(scene, axis) if np.ptp(reach) < 0.1 * reach.max() else float(np.sign(reach[0] - reach[1]))
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
    if free.max() < np.radians(limits.held_deg):
        # Something lies on it or stands before it, which is moved away first (a lid on a seat).
        free = _free_turn(scene, axis, pivot, (scene.parent,), config)
    ajar = closing_turn(scene, axis, pivot, free, config)
    if ajar != 0.0:
        sign, closing = -float(np.sign(ajar)), abs(ajar)
        forward = float(free[0] if sign > 0 else free[1])
        upper = min(forward, max(np.radians(limits.panel_deg) - closing, 0.0))
        return _range(sign, -closing, upper, free, config)
    sign = _turn_sign(scene, axis, pivot, free, config)
    forward, backward = (float(free[0]), float(free[1])) if sign > 0 else (float(free[1]), float(free[0]))
    if max(forward, backward) < np.radians(limits.held_deg):
        forward = np.pi  # its mesh overlaps the frame: no door is made to stay shut
    lower = -backward if backward < np.radians(limits.least_deg) else 0.0
    return _range(sign, lower, min(forward, np.radians(limits.panel_deg)), free, config)


def closing_turn(
    scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray, config: JointsConfig
) -> float:
    """Signed angle [rad] by which a panel that stands open must turn to lie along its body; 0 where it is closed.

    An open panel touches its body at the hinge alone and stands askew; of the ways to get square to the body, the one
    that it can go and that brings it nearer closes it.

    Args:
        scene: The pair; its child is a panel.
        axis: Unit direction of the hinge, shape (3,).
        pivot: Point on it [m], shape (3,).
        free: Free angle towards + and - [rad], shape (2,).
        config: Bounds.
    """
    if _held_elsewhere(scene, axis, pivot, config):
        return 0.0
    normal = scene.frame.axes[scene.frame.thin]
    found: list[tuple[float, float]] = []
    for face in scene.parent_frame.axes:
        across = face - (face @ axis) * axis
        if np.linalg.norm(across) < 0.9 or abs(float(normal @ axis)) > 0.3:
            continue
        tilt = float(np.arctan2(np.cross(normal, across) @ axis, normal @ across))
        if min(abs(tilt), np.pi - abs(tilt)) < np.radians(config.limits.square_deg):
            return 0.0
        for turn in (tilt, tilt - np.copysign(np.pi, tilt)):
            if abs(turn) < free[0 if turn > 0 else 1] + np.radians(config.limits.held_deg):
                found.append((_closeness(scene, axis, pivot, turn), turn))
    if not found:
        return 0.0
    distance, turn = min(found)
    closer = distance < config.limits.closer * _closeness(scene, axis, pivot, 0.0)
    return turn if closer else 0.0


def _held_elsewhere(scene: JointScene, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> bool:
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


# ---- knobs and levers ----------------------------------------------------------------------------------------------


def _turns_freely(scene: JointScene, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> bool:
    """A knob, wheel or turntable: a bearing through the part, or a round part, whose mass is even about the axis."""
    disc = scene.disc > 0.5 and abs(float(axis @ scene.frame.axes[scene.frame.thin])) > 0.99
    if not (scene.gated or disc) or (scene.serial and scene.smallness < 1.0):
        return False
    anchor = scene.contact.centroid if scene.gated else pivot
    return eccentricity(scene, axis, anchor) < config.limits.even


def _clockwise_sign(scene: JointScene, axis: FloatArray) -> float:
    """Knobs turn up clockwise as seen by who turns them (IEC 60447): the axis points into the part that carries them.

    Wheels, turntables and whole links have no face that somebody looks at; there the axis points to the child.
    """
    knob = scene.smallness > 0.0 or not (scene.plate and scene.flat)
    return (-1.0 if knob and not scene.serial else 1.0) * _neutral_sign(scene, axis)


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
    sign = _neutral_sign(scene, axis)
    forward, backward = (free[0], free[1]) if sign > 0 else (free[1], free[0])
    return _range(sign, -min(float(backward), 2 * reach), min(float(forward), 2 * reach), free, config)


def _turn_sign(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray, config: JointsConfig) -> float:
    """The freer direction opens; where both are alike, the one that leads out of the body or up."""
    if abs(free[0] - free[1]) > np.radians(10.0) and free.min() < np.radians(60.0):
        return 1.0 if free[0] > free[1] else -1.0
    beside = _hinge_side(scene, axis, pivot, config)
    if beside != 0.0:
        return beside
    velocity = np.cross(axis, scene.centre - pivot)
    away = scene.outward if scene.outward.any() else UP
    if abs(float(velocity @ away)) < 0.05 * scene.frame.diagonal:
        return _neutral_sign(scene, axis)
    return 1.0 if float(velocity @ away) > 0.0 else -1.0


def _hinge_side(scene: JointScene, axis: FloatArray, pivot: FloatArray, config: JointsConfig) -> float:
    """Sign of the turn towards the face of an upright panel at which its bearing lies, 0 without such a bearing.

    Barrels stand on the side to which a door opens; on the other one its edge would run into what it hangs on.
    """
    normal = scene.frame.axes[scene.frame.thin]
    off = float((pivot - scene.centre) @ normal)
    aside = abs(off) > config.limits.hinge_off * float(scene.frame.extents[scene.frame.thin])
    if not (scene.gated and scene.panel and scene.upright and aside):
        return 0.0
    return float(np.sign(off * (np.cross(axis, scene.centre - pivot) @ normal)))


def _neutral_sign(scene: JointScene, axis: FloatArray) -> float:
    """Where neither way opens: the axis points from the parent to the child, else up, as knobs and arms have it."""
    apart = float((scene.centre - scene.parent_frame.centre) @ axis)
    if abs(apart) < 0.02 * scene.parent_frame.diagonal:
        apart = float(axis @ UP) if abs(float(axis @ UP)) > 0.1 else apart
    return 1.0 if apart >= 0.0 else -1.0


# ---- slides --------------------------------------------------------------------------------------------------------


def _slide_range(scene: JointScene, axis: FloatArray, config: JointsConfig) -> Range:
    points = moving_points(scene.cache, scene.child, config.sweep)
    # A door in front of a tray moves away first, so furniture slides are bounded by the body alone.
    obstacles = (scene.parent, *scene.others) if _in_linkage(scene) else (scene.parent,)
    limit = scene.diagonal
    sweep = sweep_slides(scene.cache, points, axis[None], obstacles, limit=limit, config=config.sweep)
    free = sweep.free(config.sweep.share)[0]
    length = float(np.ptp(scene.frame.local(points) @ (scene.frame.axes @ axis)))
    sign = _slide_sign(scene, axis, free, config)
    forward, backward = (float(free[0]), float(free[1])) if sign > 0 else (float(free[1]), float(free[0]))
    lower, upper = 0.0, 0.0
    if _in_linkage(scene):
        reach = config.limits.drawer * length
        lower, upper = -min(backward, reach), min(forward, reach)
    elif (scene.smallness > 0.5 and not _is_small_lid(scene)) or (scene.gated and sign * _outwards(scene, axis) < 0.0):
        upper = _press(scene, sign * axis, forward, length, config)
    else:
        lower = -min(backward, _standing_out(scene, sign * axis))
        lower = lower if -lower > config.limits.ajar * length else 0.0
        forward = max(forward, length) if is_cap(scene) else forward  # the shrunk skirt of a cap sweeps into the rim
        upper = min(forward, config.limits.drawer * length + lower)
    return Range(
        kind=JointType.PRISMATIC,
        sign=sign,
        lower=lower,
        upper=max(upper, config.limits.least_slide * scene.diagonal),
        free_forward=forward,
        free_backward=backward,
    )


def _standing_out(scene: JointScene, way: FloatArray) -> float:
    """How far the front of a drawer stands before the body, its own handle left out [m]; 0 if it does not."""
    own = scene.cache.samples(scene.child).points @ way
    body = scene.cache.samples(scene.parent).points @ way
    return max(float(np.quantile(own, 0.98) - body.max()), 0.0)


def _press(scene: JointScene, way: FloatArray, free: float, length: float, config: JointsConfig) -> float:
    """Travel of a button pressed along `way` [m]: what stands out of the surface around it, or until it is stopped."""
    own = scene.cache.samples(scene.child).points
    body = scene.cache.samples(scene.parent).points
    centre = 0.5 * (own.min(axis=0) + own.max(axis=0))
    aside = np.linalg.norm(np.cross(body - centre, way), axis=1)
    around = body[aside < 2.0 * float(np.linalg.norm(np.cross(own - centre, way), axis=1).max())]
    visible = length
    if len(around) > 10:
        visible = min(length, max(float((around @ way).min() - (own @ way).min()), 0.0))
    reach = config.limits.button * (visible if visible > 0.1 * length else length)
    return min(free, reach) if free > 0.2 * reach else reach


def _slide_sign(scene: JointScene, axis: FloatArray, free: FloatArray, config: JointsConfig) -> float:
    """Drawers and lids leave by the longer way, outwards if both are alike; buttons go in.

    What sits in a bore and has room behind it is pressed in, as a button that stands out before its pocket; a stopper
    or cap has none, for it is in as far as it goes.
    """
    outwards = _outwards(scene, axis)
    if is_cap(scene):
        return outwards
    longer = 1.0 if free[0] > free[1] else -1.0
    one_way = abs(float(free[0] - free[1])) > config.limits.one_way * scene.diagonal
    if scene.smallness >= 1.0 and not (scene.gated or _in_linkage(scene)) and one_way:
        return -longer  # there is a floor below a button and nothing before it; round ones are told below from collars
    if scene.gated and not _in_linkage(scene):
        play = slide_play(scene, outwards * axis, config)
        if play is not None and config.limits.room * scene.frame.diagonal < play[1] < np.inf:
            return -outwards
    if scene.smallness > 0.5 and not _in_linkage(scene) and not _is_small_lid(scene):
        return -outwards
    return longer if one_way else outwards


def _in_linkage(scene: JointScene) -> bool:
    """A link of a machine, whose motion has no outside; buttons on the base of a lamp or fan are none."""
    return scene.mechanism > 0.5 and (scene.smallness < 1.0 or (scene.serial and scene.parent_moves))


def _is_small_lid(scene: JointScene) -> bool:
    """A level disc on top that is larger than a button: it covers a mouth and is lifted."""
    return scene.smallness < 1.0 and scene.on_top and scene.flat and scene.disc > 0.5


def _outwards(scene: JointScene, axis: FloatArray) -> float:
    """+1 where the axis points from the middle of the parent to the child, -1 where it points back."""
    return 1.0 if float((scene.centre - scene.parent_frame.centre) @ axis) >= 0.0 else -1.0
