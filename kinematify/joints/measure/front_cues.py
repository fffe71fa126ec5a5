"""What stands at the foot of a body: pedals that are trodden on, and wheels; both tell its front from its back.

A pedal is where the user's foot is, in front. A bin on two wheels is tipped back onto them, so they are behind, below
the hinge of its lid.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.hypotheses.frames import UP

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import FrontCuesConfig
    from kinematify.joints.hypotheses.frames import BoxFrame
    from kinematify.robot.arrays import FloatArray


def foot_side(part: BoxFrame, body: FloatArray, config: FrontCuesConfig) -> FloatArray:
    """Unit level direction from the middle of a body to a small part at one side of its foot, else zero, shape (3,).

    Args:
        part: Box frame of the part.
        body: Bounds of the body in the world frame [m], shape (2, 3).
        config: What counts as small, low and on one side.
    """
    extents = body[1] - body[0]
    middle = 0.5 * (part.lower + part.upper) @ part.axes
    offset = (middle - body.mean(axis=0)) * (1.0, 1.0, 0.0)
    distance = float(np.linalg.norm(offset))
    small = part.diagonal < config.small * float(np.linalg.norm(extents))
    low = middle[2] - body[0, 2] < config.low * extents[2]
    aside = distance > config.aside * 0.5 * float(extents[:2].min())
    return np.asarray(offset / distance) if small and low and aside else np.zeros(3)


def front_of(
    body: FloatArray, frames: Sequence[BoxFrame], rolling: Sequence[bool], config: FrontCuesConfig
) -> FloatArray:
    """The level direction in which the front of a body looks, zero where nothing at its foot says so, shape (3,).

    Args:
        body: Bounds of the body in the world frame [m], shape (2, 3).
        frames: Box frames of the parts that it carries.
        rolling: Which of them are wheels.
        config: What counts as small, low and on one side.
    """
    front = np.zeros(3)
    for frame, rolls in zip(frames, rolling, strict=True):
        if rolls or is_level_plate(frame):
            front += foot_side(frame, body, config) * (-1.0 if rolls else 1.0)
    length = float(np.linalg.norm(front))
    # Feet or castors all around cancel out.
    return front / length if length > config.agreeing else np.zeros(3)


def is_level_plate(frame: BoxFrame) -> bool:
    """Whether a part is thin upwards, as what is trodden on."""
    sides = np.sort(frame.extents)
    return bool(abs(float(frame.axes[frame.thin] @ UP)) > np.cos(np.radians(30.0)) and sides[0] < 0.5 * sides[1])
