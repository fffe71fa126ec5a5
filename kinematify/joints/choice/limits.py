"""Opening direction and limits: how far the chosen joint can go before the part meets another one.

Meshes do not hold designed stops, so these limits are upper bounds: a panel opens at most to a right angle, a drawer
by most of its own length, a button by its own thickness (everyday.md: such bounds hold for 86 to 90 % of the joints
of those kinds).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kinematify.contact.graph import pair
from kinematify.joints.choice.opening import clockwise_sign, round_odds, turn_sign
from kinematify.joints.features.frames import UP
from kinematify.joints.features.motion_test import Sweep, moving_points, slide_clearance, slide_paths, turn_paths
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rotation_about
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.robot.arrays import FloatArray


class LimitEnd(NamedTuple):
    """Distance that a joint goes one way."""

    motion: float
    """From the given pose, not negative [rad or m]."""
    stop: str
    """What ends it there, in words; empty where nothing does."""


AS_GIVEN, USUAL = LimitEnd(0.0, "the given pose"), "typical range"
Ways = tuple[LimitEnd, LimitEnd]
"""Along an axis and against it."""


def free_ways(scene: JointScene, obstacles: Sequence[int], swept: Sequence[Sweep], share: float) -> Ways:
    """Return how far one joint goes both ways until more than a share of the part has met others, and which it meets.

    Args:
        scene: The pair.
        obstacles: All parts that may be in the way.
        swept: The motion against each of them.
        share: Of the points that are swept.
    """
    whole, ways = reduce(Sweep.joined, swept), []
    for side, motion in enumerate(whole.free(share)[0]):
        met = obstacles[int(np.argmax([one.crossed(motion)[0, side] for one in swept]))]
        stop = f"contact with {scene.cache.assembly.parts[met].name}"
        ways.append(LimitEnd(float(motion), stop if motion < whole.limit else "none found"))
    return ways[0], ways[1]


@dataclass(frozen=True, kw_only=True)
class Range:
    """Limits of a joint whose axis is turned so that q > 0 opens."""

    kind: JointType
    """`continuous` where a wheel or knob meets nothing in a full turn; else as given."""
    sign: float
    """+1 if the given axis opens the joint as it is, -1 if it must be reversed."""
    back: LimitEnd
    """Lower limit."""
    ahead: LimitEnd
    """Upper limit."""
    free: Ways
    """Free motion in the opening direction and against it."""

    @property
    def facts(self) -> dict[str, Any]:
        """The fields of a joint that it decides, but for the axis and what else is evidence."""
        ends = {"lower": 0.0 - self.back.motion, "upper": self.ahead.motion}
        return {"kind": self.kind, **ends, "stops": (self.back.stop, self.ahead.stop)}

    @property
    def evidence(self) -> Mapping[str, float]:
        """Free motion in the opening direction and against it [rad or m]."""
        return {"free_forward": self.free[0].motion, "free_backward": self.free[1].motion}


_FREE = -0.25  # log odds beyond which what meets nothing goes round: right of 51 of 54 that do, 86 of 114 others
_STOPPED = 1.0  # the same of what meets something on its way, as a tyre its mudguard


def find_range(
    scene: JointScene, kind: JointType, axis: FloatArray, pivot: FloatArray, odds: float | None = None
) -> Range:
    """Sweep the chosen joint both ways against all parts that do not move with it.

    Args:
        scene: The pair.
        kind: Chosen type.
        axis: Unit direction, shape (3,).
        pivot: Point on the axis [m], shape (3,).
        odds: Log odds that turns which are alike go round; without them, those of this one count.
    """
    if kind is JointType.FIXED:
        none = LimitEnd(0.0, "")
        return Range(kind=kind, sign=1.0, back=none, ahead=none, free=(none, none))
    if kind is JointType.PRISMATIC:
        return _slide_range(scene, axis)
    return _turn_range(scene, axis, pivot, round_odds(scene, axis, pivot) if odds is None else odds)


def _turn_range(scene: JointScene, axis: FloatArray, pivot: FloatArray, odds: float) -> Range:
    ways = _free_turn(scene, axis, pivot, (scene.parent, *scene.others))
    free = np.array([way.motion for way in ways])
    if odds > (_FREE if free.min() >= np.pi else _STOPPED):
        none, half, sign = LimitEnd(np.inf, ""), LimitEnd(np.pi, ""), clockwise_sign(scene, axis)
        return Range(kind=JointType.CONTINUOUS, sign=sign, back=none, ahead=none, free=(half, half))
    limits = scene.config.limits
    if scene.pedal_direction.any() and abs(float(axis @ UP)) < 0.1:
        # A pedal goes down, by no more than a lever does.
        sign = 1.0 if float(crossed(axis, scene.centre - pivot)[2]) < 0.0 else -1.0
        return _range(sign, AS_GIVEN, min(ways[0 if sign > 0 else 1], _usual(limits.lever_deg)), ways)
    furniture = scene.mechanism <= 0.5
    if furniture and scene.panel:
        return _panel_range(scene, axis, pivot, ways)
    sign = turn_sign(scene, axis, pivot, free)
    forward, backward = ways if sign > 0 else ways[::-1]
    usual, blocked = _usual(limits.panel_deg), free.max() < np.radians(limits.stopped_deg)
    # What is blocked both ways overlaps its neighbours, or is fixed: the sweep says nothing of its range.
    back, ahead = AS_GIVEN, usual if blocked else min(forward, usual)
    if not blocked and (scene.has_bearing or not furniture):
        back, ahead = backward, _from_stop(scene, forward, backward)
    if not scene.serial:  # whose links are stopped by what is not in the mesh, too
        back, ahead = (_usual(limits.unmet_deg) if end.motion >= np.pi else end for end in (back, ahead))
    return _range(sign, back, ahead, ways)


def _free_turn(scene: JointScene, axis: FloatArray, pivot: FloatArray, obstacles: Sequence[int]) -> Ways:
    """Free angle towards + and -."""
    points = moving_points(scene)
    paths = turn_paths(scene.cache, points, axis[None], pivot[None], limit=np.pi, config=scene.config.sweep)
    met = paths.reached(obstacles)
    return free_ways(scene, met, [paths.against((part,)) for part in met], scene.config.sweep.share)


def _usual(degrees: float) -> LimitEnd:
    return LimitEnd(float(np.radians(degrees)), USUAL)


def _from_stop(scene: JointScene, forward: LimitEnd, backward: LimitEnd) -> LimitEnd:
    """Upper limit of what turns freely: what has a stop opens to a right angle from there at most, as panels do.

    Blades of scissors, arms of glasses and ribs of umbrellas meet nothing on the way round, and none goes round.
    Links that hang on moving ones are left alone unless they stand at the stop, for knees and elbows stop one way, too;
    and so is what has no pin, as a handle that folds back.
    """
    limits = scene.config.limits
    right = _usual(limits.panel_deg)
    if backward.motion < np.radians(limits.stopped_deg):
        return min(forward, right)
    unstopped = forward.motion >= np.pi and backward.motion < right.motion
    pinned = scene.has_bearing and not scene.parent_moves
    return LimitEnd(right.motion - backward.motion, USUAL) if unstopped and pinned else forward


def _range(sign: float, back: LimitEnd, ahead: LimitEnd, free: Ways) -> Range:
    return Range(kind=JointType.REVOLUTE, sign=sign, back=back, ahead=ahead, free=free if sign > 0 else free[::-1])


# ---- panels --------------------------------------------------------------------------------------------------------


def _panel_range(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: Ways) -> Range:
    """A door or lid: it opens away from where it lies on its body, to a right angle beyond that place."""
    limits = scene.config.limits
    right = _usual(limits.panel_deg)
    if max(free).motion < np.radians(limits.blocked_deg):
        # Something lies on it or stands before it, which is moved away first (a lid on a seat).
        free = _free_turn(scene, axis, pivot, (scene.parent,))
    angles = np.array([way.motion for way in free])
    closing = closing_turns(scene, axis, pivot, angles)
    sign = -float(np.sign(closing[0])) if len(closing) == 1 else turn_sign(scene, axis, pivot, angles)
    forward, backward = free if sign > 0 else free[::-1]
    back, ahead = AS_GIVEN, min(forward, right)
    if len(closing) == 2:
        back = min(backward, right)
    elif len(closing) == 1:
        back = LimitEnd(abs(closing[0]), "shut against its body")
        ahead = min(forward, LimitEnd(max(right.motion - back.motion, 0.0), USUAL))
    elif max(free).motion < np.radians(limits.blocked_deg):
        ahead = right  # where its mesh overlaps the frame, what stops it says nothing: no door is made to stay shut
    return _range(sign, back, ahead, free)


def closing_turns(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray) -> tuple[float, ...]:
    """Signed angles [rad] by which a panel that stands open turns to lie along its body; none where it is closed.

    An open panel touches its body at the hinge alone and stands askew, or upright on top of it. Of the ways to get
    square to the body, the one that it can go and that brings it nearer closes it. A bail or a carrying handle lies
    down to either side alike.

    Args:
        scene: The pair; its child is a panel.
        axis: Unit direction of the hinge, shape (3,).
        pivot: Point on it [m], shape (3,).
        free: Free angle towards + and - [rad], shape (2,).
    """
    limits = scene.config.limits
    if _touches_elsewhere(scene, axis, pivot):
        return ()
    now = _gap(scene, axis, pivot, 0.0)
    turns, square = _square_turns(scene, axis)
    found = sorted((_gap(scene, axis, pivot, turn) / now, turn) for turn in turns)
    possible = []
    for ratio, turn in found:
        # Where it then lies on its body all over, it met on the way an overlap of the meshes at its hinge.
        overlap = np.radians(limits.lying_deg if ratio < limits.lying else limits.blocked_deg)
        if ratio < limits.closer and abs(turn) < free[0 if turn > 0 else 1] + overlap:
            possible.append((ratio, turn))
    if len(possible) > 1 and possible[1][1] * possible[0][1] < 0.0 and possible[0][0] > limits.closer * possible[1][0]:
        return possible[0][1], possible[1][1]
    # An upright panel on a level hinge whose middle is above all of its body: no lid is shut like that.
    top = scene.centre[2] > scene.parent_bounds[1, 2]
    on_top = top and scene.upright and abs(float(axis @ UP)) < 0.1
    if square and not (on_top and possible and possible[0][0] < limits.lying):
        return ()
    return tuple(turn for _, turn in possible[:1])


def _square_turns(scene: JointScene, axis: FloatArray) -> tuple[list[float], bool]:
    """Signed angles [rad] by which a panel turns to get square to its body; and whether it is so as it is."""
    normal = scene.frame.thin_axis
    turns: list[float] = []
    for face in scene.parent_frame.axes:
        across = face - (face @ axis) * axis
        if np.linalg.norm(across) < 0.9 or abs(float(normal @ axis)) > 0.3:
            continue
        tilt = float(np.arctan2(crossed(normal, across) @ axis, normal @ across))
        turns += [tilt, tilt - np.copysign(np.pi, tilt)]
    least = np.radians(scene.config.limits.square_deg)
    others = [turn for turn in turns if least < abs(turn) < np.pi - least]
    return others, len(others) < len(turns)


def _touches_elsewhere(scene: JointScene, axis: FloatArray, pivot: FloatArray) -> bool:
    """The panel touches its body away from the hinge, as a closed one does on its frame."""
    if len(scene.contact.points) == 0:
        return False
    reach = lengths_of(crossed(scene.samples.points - pivot, axis)).max()
    apart = lengths_of(crossed(scene.contact.points - pivot, axis))
    near = (apart < scene.config.panels.hinge_band * reach) @ scene.contact.weights
    return bool(near < scene.config.panels.ajar_share)


def _gap(scene: JointScene, axis: FloatArray, pivot: FloatArray, turn: float) -> float:
    """Mean distance of the turned child from its parent [m]."""
    points = scene.samples.points[::10]
    moved = pivot + (points - pivot) @ rotation_about(axis, turn).T
    return float(scene.cache.distances(scene.parent, moved).mean())


# ---- what slides ---------------------------------------------------------------------------------------------------


def _slide_range(scene: JointScene, axis: FloatArray) -> Range:
    """Sweep a slide both ways, and bound it by what kind of thing slides.

    Args:
        scene: The pair.
        axis: Unit direction, shape (3,).
    """
    points, limits, linked = moving_points(scene), scene.config.limits, _in_linkage(scene)
    # A door in front of a tray moves away first, so furniture slides are bounded by the body alone.
    obstacles = (scene.parent, *scene.others) if linked else (scene.parent,)
    paths = slide_paths(scene.cache, points, axis[None], limit=scene.diagonal, config=scene.config.sweep)
    obstacles = paths.reached(obstacles)
    swept = [paths.against((part,)) for part in obstacles]
    ways = free_ways(scene, obstacles, swept, scene.config.sweep.share)
    free = np.array([way.motion for way in ways])
    length = float(np.ptp(scene.frame.local(points) @ (scene.frame.axes @ axis)))
    runs = linked or _is_runner(scene, axis, free, length)
    guided = (_guided(scene, axis, ways[0], length), _guided(scene, -axis, ways[1], length)) if runs else ways
    sign = _slide_sign(scene, axis, np.array([way.motion for way in guided]) if linked else free)
    ways, guided = (ways, guided) if sign > 0 else (ways[::-1], guided[::-1])
    way = sign * axis
    if runs:
        ahead, back = guided
    elif (scene.smallness > 0.5 and not _is_small_lid(scene)) or (scene.has_bearing and _outwards(scene, way) < 0.0):
        # It overlaps the pocket that it is in: a few of its points say nothing of the floor.
        floor = free_ways(scene, obstacles, swept, limits.pressed_share)[0 if sign > 0 else 1]
        ahead, back = min(floor, _press(scene, way, length)), AS_GIVEN
    else:
        # What leaves upwards is a lid: it lies where it is put, and would fall in if it could go lower. A drawer may
        # stand open, by as much as its front stands before the body, without its own handle.
        front = float(np.quantile(scene.samples.points @ way, 0.98) - (scene.parent_samples.points @ way).max())
        ajar = min(ways[1], LimitEnd(0.0 if float(way @ UP) > 0.9 else max(front, 0.0), "flush with the body"))
        back = ajar if ajar.motion > limits.ajar * length else AS_GIVEN
        ahead = min(ways[0], LimitEnd(limits.drawer * length - back.motion, USUAL))
    ahead = max(ahead, LimitEnd(limits.least_slide * scene.diagonal, "the least travel that is kept"))
    return Range(kind=JointType.PRISMATIC, sign=sign, back=back, ahead=ahead, free=ways)


def _guided(scene: JointScene, direction: FloatArray, free: LimitEnd, length: float) -> LimitEnd:
    """Travel along `direction` up to the next stop, or until the guide lets the part go.

    Where no guide is seen, by as much of its own length as drawers travel.
    """
    guided = guided_travel(scene, direction)
    usual = LimitEnd(scene.config.limits.drawer * length, USUAL)
    return min(free, usual if guided is None else LimitEnd(guided, "the end of its guide"))


def _is_runner(scene: JointScene, axis: FloatArray, free: FloatArray, length: float) -> bool:
    """A small part that can slide farther than it is long without leaving its guide: a collar on a rod, no button."""
    if scene.smallness < 1.0 or _is_small_lid(scene):
        return False
    ways = (guided_travel(scene, sign * axis) or 0.0 for sign in (1.0, -1.0))
    return bool(max(min(*pair) for pair in zip(free, ways, strict=True)) > scene.config.guide.runner * length)


def _press(scene: JointScene, direction: FloatArray, length: float) -> LimitEnd:
    """Travel of a button pressed along a direction that nothing stops: what stands out of its surroundings."""
    own, body = scene.samples.points, scene.parent_samples.points
    centre = 0.5 * (own.min(axis=0) + own.max(axis=0))
    wide = 2.0 * float(lengths_of(crossed(own - centre, direction)).max())
    around = body[lengths_of(crossed(body - centre, direction)) < wide]
    visible = length
    if len(around) > 10:
        visible = min(length, max(float((around @ direction).min() - (own @ direction).min()), 0.0))
    # A stem behind the cap is no travel: what is flush is pressed by a share of its length or width.
    whole = min(length, wide)
    return LimitEnd(scene.config.limits.button * (visible if visible > 0.1 * whole else whole), USUAL)


def _slide_sign(scene: JointScene, axis: FloatArray, free: FloatArray) -> float:
    """Drawers and lids leave by the longer way, outwards if both are alike; buttons go in.

    What sits in a bore and has room behind it is pressed in, as a button that stands out before its pocket; a stopper
    or cap has none, for it is in as far as it goes.
    """
    limits, outwards, linked = scene.config.limits, _outwards(scene, axis), _in_linkage(scene)
    longer = 1.0 if free[0] > free[1] else -1.0
    one_way = abs(float(free[0] - free[1])) > limits.one_way * scene.diagonal
    if scene.smallness >= 1.0 and not (scene.has_bearing or linked) and one_way:
        return -longer  # there is a floor below a button and nothing before it; round ones and collars are split below
    if scene.has_bearing and not linked and not _is_sheath(scene, axis):
        clearance = slide_clearance(scene, outwards * axis)
        if clearance is not None and limits.room * scene.frame.diagonal < clearance[1] < np.inf:
            return -outwards
    if scene.smallness > 0.5 and not linked and not _is_small_lid(scene):
        return -outwards
    return longer if one_way else outwards


def _is_sheath(scene: JointScene, axis: FloatArray) -> bool:
    """True if the child goes round what it slides on, as caps and sleeves do: such a part is drawn off.

    Buttons and stoppers sit in what they slide in.
    """
    contact = scene.contact
    if len(contact.points) == 0:
        return False
    across = contact.normals - (contact.normals @ axis)[:, None] * axis
    inwards = np.einsum("ij,ij->i", across, contact.points - contact.centroid) < 0.0
    aside = lengths_of(across) > 0.5
    return bool(contact.weights @ (inwards & aside) > 0.8 * max(float(contact.weights @ aside), 1e-12))


def _in_linkage(scene: JointScene) -> bool:
    """A link of a machine, whose motion has no outside; buttons on the base of a lamp or fan are none."""
    return scene.mechanism > 0.5 and (scene.smallness < 1.0 or (scene.serial and scene.parent_moves))


def _is_small_lid(scene: JointScene) -> bool:
    """A level disc on top that is larger than a button: it covers a mouth and is lifted."""
    return scene.smallness < 1.0 and scene.on_top and scene.flat and scene.disc > 0.5


def _outwards(scene: JointScene, axis: FloatArray) -> float:
    """+1 where the axis points from the middle of the parent to the child, -1 where it points back."""
    return 1.0 if float((scene.centre - scene.parent_frame.centre) @ axis) >= 0.0 else -1.0


def guided_travel(scene: JointScene, direction: FloatArray) -> float | None:
    """Return how far the child slides along `direction` before its guide lets it go [m]; None where no guide is seen.

    The guide is the surface of the contact that runs along the way. A carriage keeps all of its own surface on a long
    rail, a rod fills a short collar all the time, and both may go until that ends; of a telescope each half leaves the
    other from the start, and some of it has to stay in.

    Args:
        scene: The pair.
        direction: Unit direction of travel, shape (3,).
    """
    guide, drawer = scene.config.guide, scene.config.limits.drawer
    travels = np.linspace(0.0, scene.diagonal, guide.steps + 1)
    shares = guided_share(scene, direction, travels)
    if shares is None or shares[0] < guide.kept:
        return None
    return max(_first_below(travels, shares, guide.kept), drawer * _first_below(travels, shares, guide.gone))


def guided_share(scene: JointScene, direction: FloatArray, travels: FloatArray) -> FloatArray | None:
    """Share of the guide that still lies on the other part after each travel.

    Args:
        scene: The pair.
        direction: Unit direction, shape (3,).
        travels: [m], shape (n,).

    Returns:
        The larger of the shares of both parts in [0, 1], shape (n,); None where the contact is not such.
    """
    edge, guide = scene.cache.graph.by_pair.get(pair(scene.parent, scene.child)), scene.config.guide
    if edge is None:
        return None
    # Of small parts, the band of a contact is as wide as they are long.
    reach = edge.gap + min(scene.config.contact_band * scene.diagonal, guide.band * scene.frame.diagonal)
    contact = scene.contact
    sides = (
        (scene.parent, contact.points, contact.normals, direction),
        (scene.child, contact.parent_points, contact.parent_normals, -direction),
    )
    shares = []
    for other, points, normals, motion in sides:
        along = points[np.abs(normals @ direction) < np.sin(np.radians(guide.along_deg))]
        guiding = along[scene.cache.distances(other, along) <= reach] if len(along) else along
        if len(guiding) < guide.least_samples:
            return None
        thinned = guiding[:: max(1, len(guiding) // guide.samples)]
        moved = (thinned[None] + travels[:, None, None] * motion).reshape(-1, 3)
        shares.append((scene.cache.distances(other, moved) <= reach).reshape(len(travels), -1).mean(axis=1))
    return np.asarray(np.maximum(*shares))


def _first_below(travels: FloatArray, shares: FloatArray, level: float) -> float:
    """Travel at which the share falls below a level, between the steps by proportion; the last one if never."""
    below = np.flatnonzero(shares < level)
    if len(below) == 0:
        return float(travels[-1])
    k = int(below[0])
    part = (shares[k - 1] - level) / max(shares[k - 1] - shares[k], 1e-12)
    return float(travels[k - 1] + part * (travels[k] - travels[k - 1]))
