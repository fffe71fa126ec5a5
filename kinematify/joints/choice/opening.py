"""Three fitted answers beside the choice: which way a turn opens, whether it has an end, and what is fixed.

Gradient-boosted trees (Friedman 2001) read what is measured towards either side, as the difference of both and their
mean. With f for their sum, the log odds that the axis opens as it is are f(difference) - f(-difference), so that an
axis and its opposite get opposite answers. Conventions decide where neither side opens.

Whether a turn goes round is read from what is measured of it alone, not from what else was proposed nor from cues.
Whether a part is fixed to the one that carries it (handles, feet, shelves) is asked apart from which joint it is,
because objects teach the two apart; it is read from the turn and the slide that cues rank first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.joints.candidate import ELSEWHERE, SLIDE, TURN, Hypotheses
from kinematify.joints.choice.scorer import OPENING_WEIGHTS, RIGID_WEIGHTS, TURNING_WEIGHTS, columns_of, shipped_scorer
from kinematify.joints.features.frames import UP
from kinematify.joints.features.measurements import MeasuredHypotheses, measure
from kinematify.robot.vectors import crossed, unit

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from kinematify.joints.choice.scorer import Scorer
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.measurements import Values
    from kinematify.robot.arrays import FloatArray, IntArray


def measure_sides(scene: JointScene, axis: FloatArray, pivot: FloatArray) -> Values:
    """Everything that is measured of a turn, once towards either side.

    Args:
        scene: The pair.
        axis: Unit direction, shape (3,).
        pivot: Point on the line [m], shape (3,).

    Returns:
        Name -> value of the turn about `axis` and of that about its opposite, shape (2,).
    """
    measured = MeasuredHypotheses(scene, _both_ways(axis, pivot), sided=True)
    return {**measure(measured), **_leads_to(measured)}


def _both_ways(axis: FloatArray, pivot: FloatArray) -> Hypotheses:
    """The turn about a line and that about its opposite."""
    return Hypotheses(
        kinds=np.array([TURN, TURN]),
        axes=np.array([axis, -axis]),
        pivots=np.array([pivot, pivot]),
        places=np.array([ELSEWHERE, ELSEWHERE]),
        sources=np.array(["forward", "backward"]),
    )


def _leads_to(m: MeasuredHypotheses) -> Values:
    """Where the first motion of the child and of its handle leads: out, up, or to the face on which the line lies."""
    scene, frame = m.scene, m.scene.frame
    way = _directions(m, scene.centre)
    normal, thickness = frame.thin_axis, max(float(frame.extents[frame.thin]), 1e-6 * m.unit)
    off = float((m.hypotheses.pivots[0] - scene.centre) @ normal) / thickness
    result = {
        "side_hinge": off * (way @ normal),
        "side_up": m.hypotheses.axes @ UP,
        "side_parent": way @ (scene.centre - scene.parent_frame.centre) / m.unit,
        "side_contact": way @ (scene.centre - m.scene.anchor) / m.unit,
    }
    if scene.handle is not None:
        pull = _directions(m, scene.handle.centre)
        result["side_handle"] = pull @ (scene.handle.centre - scene.centre) / m.unit
        result["side_handle_out"] = pull @ scene.outward
    return result


def _directions(m: MeasuredHypotheses, point: FloatArray) -> FloatArray:
    """Unit directions in which each turn first moves a point, shape (h, 3); zero on its line."""
    return unit(m.velocity(point), 1e-9 * m.unit)


# ---- conventions ---------------------------------------------------------------------------------------------------


def default_sign(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray) -> float:
    """Return the sign of links in series and of free parts: the freer way opens, else the one that rises.

    Args:
        scene: The pair.
        axis: Unit direction, shape (3,).
        pivot: Point on the axis [m], shape (3,).
        free: Free angle towards + and - [rad], shape (2,).
    """
    if abs(free[0] - free[1]) > np.radians(10.0) and free.min() < np.radians(60.0):
        return 1.0 if free[0] > free[1] else -1.0
    rises = float(crossed(axis, scene.centre - pivot) @ UP)
    if abs(rises) < 0.05 * scene.frame.diagonal:
        return swing_sign(scene, axis, pivot)
    return 1.0 if rises > 0.0 else -1.0


def swing_sign(scene: JointScene, axis: FloatArray, pivot: FloatArray) -> float:
    """Where neither way leads out of the parent or up: away from the middle of the object, else all to one side of it.

    Knees and fingers that go both ways alike have no opening direction that could be seen; but those of two legs and
    of all fingers have the same one, and hips that swing sideways have mirrored ones. The one side is that to which
    small parts lie of large ones. What merely twists opens as knobs do.
    """
    parts = scene.cache.assembly.parts
    centroids, areas = np.array([part.centroid for part in parts]), np.array([part.area for part in parts])
    moving = np.setdiff1d(np.arange(len(parts)), (scene.parent, *scene.others))
    limb = np.average(centroids[moving], axis=0, weights=areas[moving])
    velocity = crossed(axis, limb - pivot)
    speed = float(np.linalg.norm(velocity))
    if speed < 0.05 * scene.frame.diagonal:
        return neutral_sign(scene, axis)
    middle = np.average(centroids, axis=0, weights=areas)
    apart = float((limb - middle) @ velocity) / speed
    if abs(apart) > 0.05 * scene.diagonal:
        return 1.0 if apart > 0.0 else -1.0
    side = (centroids.mean(axis=0) - middle) * (1.0, 1.0, 0.0)  # up and down has been asked
    towards = float(velocity @ side) / speed
    if abs(towards) < 1e-5 * scene.diagonal:  # rounding would decide
        return neutral_sign(scene, axis)
    return 1.0 if towards > 0.0 else -1.0


def neutral_sign(scene: JointScene, axis: FloatArray) -> float:
    """Where neither way opens: the axis points from the parent to the child, else up, as knobs and arms have it."""
    apart = float((scene.centre - scene.parent_frame.centre) @ axis)
    if abs(apart) < 0.02 * scene.parent_frame.diagonal:
        apart = float(axis @ UP) if abs(float(axis @ UP)) > 0.1 else apart
    return 1.0 if apart >= 0.0 else -1.0


def clockwise_sign(scene: JointScene, axis: FloatArray) -> float:
    """Knobs turn up clockwise as seen by who turns them (IEC 60447): the axis points into the part that carries them.

    Wheels, turntables and whole links have no face that somebody looks at; there the axis points to the child.
    """
    knob = scene.smallness > 0.0 or not (scene.plate and scene.flat)
    if not knob or (scene.serial and scene.parent_moves):
        return neutral_sign(scene, axis)
    return -(_open_side(scene, axis) or neutral_sign(scene, axis))


def _open_side(scene: JointScene, axis: FloatArray) -> float:
    """Sign of the way along an axis on which the parent is not in front of the child; 0 where it is on both or none."""
    ahead, behind = scene.walls(np.array([axis, -axis]))
    return float(behind) - float(ahead)


_UNDECIDED = 0.2  # log odds; noise of the samples decides below


def turn_sign(scene: JointScene, axis: FloatArray, pivot: FloatArray, free: FloatArray) -> float:
    """+1 where a turn opens about the axis as it is, -1 where it must be reversed.

    What stands at a stop opens the other way. Links in series, what turns on a bearing and is not stopped either way,
    and what looks alike towards both sides have no side that opens: customs tell theirs (`default_sign`).

    Args:
        scene: The pair.
        axis: Unit direction, shape (3,).
        pivot: Point on the axis [m], shape (3,).
        free: Free angle towards + and - [rad], shape (2,).
    """
    limits = scene.config.limits
    stopped, unstopped = np.radians((limits.stopped_deg, limits.unstopped_deg))
    if free.min() < stopped and free.max() > unstopped:
        return 1.0 if free[0] > free[1] else -1.0
    either = scene.serial or (scene.has_bearing and free.min() > unstopped)
    odds = 0.0 if either else opening_odds(shipped_scorer(OPENING_WEIGHTS), measure_sides(scene, axis, pivot))
    return default_sign(scene, axis, pivot, free) if abs(odds) < _UNDECIDED else float(np.sign(odds))


def opening_odds(scorer: Scorer, sides: Mapping[str, FloatArray]) -> float:
    """Log odds that the first of two sides is the one that opens.

    Args:
        scorer: The fitted trees.
        sides: Name -> value towards either side, shape (2,) each.
    """
    forward, backward = scorer.sums(side_columns(sides, scorer.measurements))
    return float(forward - backward)


def side_columns(sides: Mapping[str, FloatArray], names: Sequence[str]) -> NDArray[Any]:
    """Return the columns of either side: by how much it is ahead of the other, and the mean, shape (2, 2 n)."""
    values = columns_of(sides, names, 2)
    ahead = np.round(values - values[::-1], 6)  # rounding is no lead
    mean = np.broadcast_to(values.mean(axis=0), values.shape)
    return np.concatenate([ahead, mean], axis=1)


def round_odds(scene: JointScene, axis: FloatArray, pivot: FloatArray) -> float:
    """Log odds that a turn has no end, as of wheels, knobs and propellers; -inf of links in series, which have stops.

    Args:
        scene: The pair.
        axis: Unit direction, shape (3,).
        pivot: Point on the line [m], shape (3,).
    """
    if scene.serial and scene.smallness < 1.0 and not scene.rolls:
        return -np.inf
    # Of both signs of the axis, which measurements around it start from; the mean does not depend on the one given.
    scorer, measured = shipped_scorer(TURNING_WEIGHTS), measure(MeasuredHypotheses(scene, _both_ways(axis, pivot)))
    return float(scorer.sums(columns_of(measured, scorer.measurements, 2)).mean())


def rigid_odds(kinds: IntArray, measured: Mapping[str, FloatArray]) -> float:
    """Log odds that the child of an edge is fixed to its parent, from its shapes alone.

    Args:
        kinds: FIXED, TURN or SLIDE of each hypothesis, shape (h,).
        measured: Name -> values, shape (h,) each.
    """
    scorer = shipped_scorer(RIGID_WEIGHTS)
    return float(scorer.sums(rigid_columns(kinds, measured, scorer.measurements)[None])[0])


def rigid_columns(kinds: IntArray, measured: Mapping[str, FloatArray], names: Sequence[str]) -> NDArray[Any]:
    """Return what the trees read of one edge: of a turn, of a slide, and the number of hypotheses, shape (2 n + 1,)."""
    support = np.nan_to_num(measured["rules_score"], nan=-np.inf)
    values = columns_of(measured, names, len(kinds))
    found: list[NDArray[Any]] = []
    for kind in (TURN, SLIDE):
        rows = np.flatnonzero(kinds == kind)
        none = np.full(len(names), np.nan, dtype=np.float32)
        found.append(values[rows[np.argmax(support[rows])]] if len(rows) else none)
    return np.concatenate([*found, np.array([len(kinds)], dtype=np.float32)])
