"""Panels that stand open: by how much they must turn to lie along their body."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.hypotheses.frames import UP
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from kinematify.config import JointsConfig
    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray


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
    """Signed angles [rad] by which a panel turns to get square to its body; and whether it is so as it stands."""
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
