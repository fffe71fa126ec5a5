"""Does it turn, slide or not move at all? Log odds from physical cues, each bounded; turning is the default.

The paper compares averages of DW-CAVL over a motion range (section III-D, type verification); these are nearly equal
for doors and drawers. What distinguishes them is shape and room: boxes in a cavity slide, plates hinge, round things
with a bearing turn, small caps are pressed, and what can only move along one line slides along it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.features.frames import UP
from kinematify.joints.features.motion_test import contact_clearance
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.ranking import Ranked
    from kinematify.robot.arrays import IntArray


WEIGHTS = {
    "drawer": 3.0, "box_inside": 1.5, "panel": -2.0, "tray": 3.0, "bearing": -1.5, "mechanism": -1.5, "button": 1.6,
    "round_small": -1.5, "round_lid": 2.5, "on_moving_part": -1.0, "latch": -2.5, "keyed": 3.0,
    "retained": -2.5, "row": 2.4, "pedal": -2.5, "wheel": -3.0, "gripper": 3.0, "rail": 3.0,
}  # fmt: skip
"""Of each cue of the type, positive for sliding; their sum is a column of the fit, which was made with these."""
BIAS, CAP = -0.8, 3.0  # log odds of sliding without any cue, and the most that one says
_BOX = (0.25, 0.5)
"""Depth over the smaller side of the front up to which a part inside its body is no drawer, and from which it is one:
leaves have up to a tenth, one drawer behind the whole front of a cabinet is half as deep as wide."""


def type_cues(scene: JointScene, turns: Ranked, slides: Ranked) -> dict[str, float]:
    """Return what speaks for sliding or for turning, in terms of `WEIGHTS`.

    Args:
        scene: The pair.
        turns: Proposed turns, best first.
        slides: Proposed slides, best first.
    """
    cues = {
        **_room_cues(scene, slides),
        **_shape_cues(scene, turns),
        "row": scene.smallness * (len(scene.twins) >= 2),
        "gripper": float(scene.gripping),
        **_clearance_cues(scene, turns, slides),
        "rail": scene.mechanism * _held_rail(scene, turns, slides),
    }
    held = max(cues["keyed"], cues["rail"], scene.mechanism * cues["gripper"])
    cues["panel"] *= 1.0 - held  # a plate that cannot turn, rides on a rail or closes on its like is no door
    hinged = float(scene.journal is not None and abs(float(scene.journal.axis @ slides.axes[0])) < 0.5)
    for pulled in ("drawer", "box_inside", "tray", "round_lid"):
        cues[pulled] *= 1.0 - hinged  # hinges hold it, whatever it looks like
    whirls = float(scene.has_bearing and turns.free_parent[0].min() >= np.radians(89.0))
    for box in ("drawer", "box_inside"):
        cues[box] *= 1.0 - whirls  # no drawer turns on a shaft
    if scene.journal is not None and abs(float(scene.journal.axis @ UP)) < scene.config.upright_cosine:
        cues["round_lid"] = 0.0  # a flap in pins across its mouth is not lifted off
    cues["round_lid"] *= 1.0 - cues["retained"]  # what holds it down is turned first
    for round_thing in ("bearing", "mechanism", "round_small", "wheel"):
        cues[round_thing] *= 1.0 - cues["keyed"]  # what is round but keyed is guided
    return cues


def type_odds(cues: Mapping[str, float]) -> float:
    """Log odds of sliding against turning that cues add up to."""
    return BIAS + sum(float(np.clip(WEIGHTS[k] * v, -CAP, CAP)) for k, v in cues.items())


def _held_rail(scene: JointScene, turns: Ranked, slides: Ranked) -> float:
    """The rail, unless it runs along a line about which the part can turn: a pin is extruded along its axis too.

    Nor is it one where the part turns freely about any line and is soon stopped along the rail: boxy knuckles that
    stand in each other are extruded as well.
    """
    if scene.rail is None:
        return 0.0
    rail, config = scene.rail.axis, scene.config
    along = any(abs(float(line.axis @ rail)) > 0.95 for line in scene.lines[:1])
    turn = float(np.degrees(turns.free_parent[0].max()))
    if along and turn > config.rails.pin_deg:
        return 0.0
    travel = float(slides.cues["travel_parent"][np.abs(slides.axes @ rail) > 0.99].max(initial=0.0))
    loose = turn > config.panels.full_turn_deg and travel < config.rails.least_travel
    return 0.0 if loose else scene.prismatic_score


def _clearance_cues(scene: JointScene, turns: Ranked, slides: Ranked) -> dict[str, float]:
    """Return the motions that the contact stops: a key, skirt or groove turning, a bead, barrel or fork sliding."""
    few, config = _near_best(scene, turns), scene.config
    clearance = contact_clearance(scene, turns.axes[few], turns.lines.pivots[few], slides.axes[0])
    if clearance is None:
        return {"keyed": 0.0, "retained": 0.0}
    turn, slide = clearance
    least = config.clearance.least * scene.frame.diagonal

    def goes(free: float, other: float) -> bool:
        """One motion is free where the other one is stopped."""
        return bool(np.isfinite(other) and free > max(least, config.clearance.ratio * other))

    # Round buttons are stopped early both ways; what else is stopped both ways rather overlaps its parent.
    guided = scene.has_bearing or np.isinf(slide)
    if scene.serial:
        # Links of machines overlap where they meet; guided are rods in bores that cannot turn as a whole either, and
        # what is extruded along its slide, nowhere round, and stopped within its clearance.
        blocked = float(turns.free_parent[0].max()) < np.radians(config.rails.pin_deg)
        along = scene.rail is not None and abs(float(scene.rail.axis @ slides.axes[0])) > 0.99
        extruded = along and scene.rail_lead > config.rails.lead_full
        guided = blocked if scene.has_bearing else extruded and turn < 2.0 * least
    return {
        "keyed": float(guided and goes(slide, turn)),
        "retained": float(goes(turn, slide)) * (1.0 - scene.smallness * (not scene.has_bearing)) * (not scene.serial),
    }


def _near_best(scene: JointScene, turns: Ranked) -> IntArray:
    """The best line, and where it is no bearing the next ones along the same edge, which may fit the hinge better."""
    if scene.has_bearing:
        return np.zeros(1, dtype=np.int64)
    clearance = scene.config.clearance
    axes, pivots = (some[: clearance.candidates] for some in (turns.axes, turns.lines.pivots))
    apart = lengths_of(crossed(pivots - pivots[0], axes[0]))
    same = (np.abs(axes @ axes[0]) > np.cos(np.radians(5.0))) & (apart < clearance.edge * scene.frame.diagonal)
    return np.flatnonzero(same)[: clearance.lines]


def _room_cues(scene: JointScene, slides: Ranked) -> dict[str, float]:
    """Where the part can go: a drawer leaves one way and stops the other."""
    frame, way = scene.frame, slides.axes[0]
    own = np.abs(slides.axes @ frame.axes.T) @ frame.extents / scene.diagonal
    travel = np.minimum(slides.free_parent[0] / max(float(own[0]), 1e-9), 1.0)
    level = float(1.0 - abs(float(way @ UP)))
    # Drawers are deep: they reach along their best slide as far as over the smaller side of their front, or nearly so.
    along, extents = np.abs(frame.axes @ way), frame.upper - frame.lower
    face = np.sort(extents[np.argsort(-along)[1:]])
    depth = float(_is_box(scene)) * float(along @ extents) / max(float(face[0]), 1e-12)
    box = float(np.interp(depth, _BOX, (0.0, 1.0)))
    furniture = (1.0 - scene.smallness) * (1.0 - scene.mechanism)
    one_way = float(travel.max() > 0.5) * float(np.clip(1.0 - 4.0 * travel.min(), 0.0, 1.0))
    # Blocked at once across its best direction in three of four ways, or more.
    across = np.abs(slides.axes @ way) < 0.1
    blocked = slides.free_parent[across] < 0.1 * own[across, None]
    channel = float(travel.max() > 0.3 and blocked.size > 0 and blocked.mean() > 0.7)
    return {
        "drawer": furniture * box * level * scene.inside * max(one_way, channel),
        "box_inside": furniture * box * scene.inside,
    }


def _is_box(scene: JointScene) -> bool:
    """All three directions of the frame hold a fair share of the surface."""
    samples = scene.samples
    facing = np.abs(samples.normals @ scene.frame.axes.T) > np.cos(np.radians(15.0))
    return bool(facing.mean(axis=0).min() > 0.06)


def _shape_cues(scene: JointScene, turns: Ranked) -> dict[str, float]:
    large = 1.0 - scene.smallness
    frame = scene.frame
    across = np.delete(frame.extents, frame.thin)
    squat = float(frame.extents[frame.thin] / max(float(across.min()), 1e-12))
    box = float(_is_box(scene))
    edge = float(scene.plate and turns.cues["ajar_contact"].max() > 0.0)
    tray = scene.panel and scene.flat and scene.covered and scene.enclosed > 0.6 and scene.disc < 0.5
    top = scene.on_top
    return {
        "panel": large
        * (1.0 - box * scene.inside)
        * float(scene.panel and not tray and not (top and scene.disc > 0.5)),
        "tray": float(tray and scene.journal is None),
        "bearing": large * (scene.has_bearing and not top),
        "mechanism": scene.mechanism * large,
        "button": scene.smallness * float(not scene.has_bearing) * (1.0 - scene.compact) * (1.0 - edge),
        "wheel": float(scene.rolls),
        "pedal": float(scene.pedal_direction.any()),
        "round_small": scene.smallness * scene.disc * float(squat > 0.3),
        "round_lid": large * (1.0 - scene.mechanism) * float(top and scene.flat and scene.disc > 0.5),
        "latch": scene.smallness * _bridges_a_seam(scene),
        "on_moving_part": scene.parent_moves * scene.smallness,
    }


def _bridges_a_seam(scene: JointScene) -> bool:
    """It touches, besides its parent, a part that is no twin of its own and does not hang on it: a hasp or catch.

    Buttons sit in one part, or beside their like.
    """
    graph, child = scene.cache.graph, scene.child
    touched = [
        edge.b if edge.a == child else edge.a for edge in graph.edges if child in (edge.a, edge.b) and not edge.bridge
    ]
    return any(part in scene.others and part not in graph.alike.others(child) for part in touched)
