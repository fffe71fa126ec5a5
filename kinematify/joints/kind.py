"""Does it turn, slide or not move at all? Log odds from physical cues, each bounded; turning is the default.

The paper compares averages of DW-CAVL over a motion range (section III-D, type verification); these are nearly equal
for doors and drawers. What tells them apart is shape and room: boxes in a cavity slide, plates hinge, round things
with a bearing turn, small caps are pressed, and what can only move along one line slides along it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import JointType
from kinematify.joints.frames import UP

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config import JointsConfig
    from kinematify.joints.panels import RankedTurns
    from kinematify.joints.scene import JointScene
    from kinematify.joints.slides import RankedSlides


@dataclass(frozen=True, kw_only=True)
class Siblings:
    """Congruent parts on the same parent."""

    count: int
    """Number of twins including the part itself that have no children of their own; 1 without twins."""
    gripping: bool
    """The part and one twin face each other at the end of a chain, as fingers of a gripper do."""
    overlapping: bool
    """Thin twin panels side by side, one behind the other, as sliding windows and doors are."""


@dataclass(frozen=True, kw_only=True, eq=False)
class KindDecision:
    """Type with its evidence."""

    kind: JointType
    odds: float
    """Log odds of sliding against turning."""
    cues: Mapping[str, float]


def decide_kind(
    scene: JointScene, siblings: Siblings, turns: RankedTurns, slides: RankedSlides, config: JointsConfig
) -> KindDecision:
    """Choose between revolute, prismatic and fixed.

    Args:
        scene: The pair.
        siblings: Twins of the child.
        turns: Ranked lines.
        slides: Ranked directions.
        config: Weights; positive ones speak for sliding.
    """
    cues = {**_room_cues(scene, turns, slides), **_shape_cues(scene), **_twin_cues(scene, siblings)}
    weights, cap = config.kind.weights, config.kind.cap
    odds = config.kind.bias + sum(float(np.clip(weights[k] * v, -cap, cap)) for k, v in cues.items())
    if _stuck(scene, turns, slides, config):
        return KindDecision(kind=JointType.FIXED, odds=odds, cues=cues)
    kind = JointType.PRISMATIC if odds > 0 else JointType.REVOLUTE
    return KindDecision(kind=kind, odds=odds, cues=cues)


def _room_cues(scene: JointScene, turns: RankedTurns, slides: RankedSlides) -> dict[str, float]:
    """Where the part can go: a drawer leaves one way and stops the other; a lift cannot turn at all."""
    own = np.abs(slides.axes[0] @ scene.frame.axes.T) @ scene.frame.extents / scene.diagonal
    travel = np.minimum(slides.free_parent[0] / max(float(own), 1e-9), 1.0)
    level = float(1.0 - abs(float(slides.axes[0] @ UP)))
    box = float(_is_box(scene))
    large = 1.0 - scene.smallness
    one_way = float(travel.max() > 0.5) * float(np.clip(1.0 - 4.0 * travel.min(), 0.0, 1.0))
    turn_room = float(turns.free[0].max()) / np.radians(30.0)
    blocked = float(np.clip(1.0 - turn_room, 0.0, 1.0)) * float(travel.max() > 0.3)
    return {
        "drawer": large * box * level * scene.inside * one_way,
        "box_inside": large * box * scene.inside,
        "blocked_turn": large * blocked,
    }


def _is_box(scene: JointScene) -> bool:
    """All three directions of the frame hold a fair share of the surface."""
    samples = scene.cache.samples(scene.child)
    facing = np.abs(samples.normals @ scene.frame.axes.T) > np.cos(np.radians(15.0))
    return bool(facing.mean(axis=0).min() > 0.06)


def _shape_cues(scene: JointScene) -> dict[str, float]:
    large = 1.0 - scene.smallness
    frame = scene.frame
    across = np.delete(frame.extents, frame.thin)
    squat = float(frame.extents[frame.thin] / max(float(across.min()), 1e-12))
    round_part = _round_about_thin(scene)
    tray = scene.panel and scene.flat and scene.enclosed > 0.8 and round_part < 0.5
    top = _on_top(scene)
    return {
        "panel": large * float(scene.panel and not tray and not (top and round_part > 0.5)),
        "tray": float(tray),
        "turntable": float(scene.panel and scene.flat and round_part > 0.5 and not top),
        "bearing": large * float(scene.gated and not top),
        "mechanism": scene.mechanism * large,
        "button": scene.smallness * float(not scene.gated) * (1.0 - scene.compact),
        "round_small": scene.smallness * round_part * float(squat > 0.3),
        "flat_cap": scene.smallness * float(squat < 0.3),
        "round_lid": large * float(top and scene.flat and round_part > 0.5),
        "on_moving_part": float(scene.parent_moves) * scene.smallness,
    }


def _round_about_thin(scene: JointScene) -> float:
    """How round the part is seen along its thin direction, 0 for a square, 1 for a disc."""
    frame = scene.frame
    plane = np.delete(np.arange(3), frame.thin)
    flat = frame.local(scene.cache.samples(scene.child).points)[:, plane] - (frame.centre @ frame.axes.T)[plane]
    angles = np.arctan2(flat[:, 1], flat[:, 0])
    sector = np.floor((angles + np.pi) / (2 * np.pi) * 16).astype(np.int64) % 16
    radius = np.zeros(16)
    np.maximum.at(radius, sector, np.linalg.norm(flat, axis=1))
    ratio = float(radius.min() / max(float(radius.max()), 1e-12))
    return float(np.clip((ratio - 0.75) / 0.15, 0.0, 1.0))


def _on_top(scene: JointScene) -> bool:
    """The part lies above most of its parent."""
    bounds = scene.cache.assembly.parts[scene.parent].bounds[:, 2]
    return bool(scene.centre[2] > bounds[0] + 0.75 * (bounds[1] - bounds[0]))


def _twin_cues(scene: JointScene, siblings: Siblings) -> dict[str, float]:
    return {
        "row": scene.smallness * float(siblings.count >= 3),
        "gripper": float(siblings.gripping),
        "sliding_pair": float(siblings.overlapping),
    }


def _stuck(scene: JointScene, turns: RankedTurns, slides: RankedSlides, config: JointsConfig) -> bool:
    """Neither the best turns nor the best slides are free: one rigid body that was cut in two."""
    if scene.gated:
        return False
    turn = float(turns.free_parent[: config.kind.stuck_candidates].max())
    slide = float(slides.free_parent.max())
    return bool(turn < np.radians(config.kind.stuck_deg) and slide < config.kind.stuck_slide)
