"""Rockers: plates that tip about their own middle, told by a front that is folded there.

The two halves of a rocker's front lean opposite ways, so that each lies level with its frame when the other one is
pressed. Doors, lids and buttons are flat, bulge evenly or slope one way, so the fold shows both that the part turns and
where; and the angle between the halves is its stroke.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.config import RockersConfig
    from kinematify.geometry.sampling import SurfaceSamples
    from kinematify.joints.hypotheses.frames import BoxFrame
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Fold:
    """A front of two halves that lean opposite ways, world frame."""

    axis: FloatArray
    """Unit direction of the fold, shape (3,)."""
    point: FloatArray
    """The centre of the slab [m], shape (3,)."""
    normals: FloatArray
    """Mean unit normal of each half, shape (2, 3)."""

    def turns_level(self, face: FloatArray) -> FloatArray:
        """Turns about the fold that bring each half level with a face of this unit normal [rad], shape (2,)."""
        face = face * np.copysign(1.0, self.normals.sum(axis=0) @ face)
        sines = np.cross(self.normals, face) @ self.axis
        return np.asarray(np.arctan2(sines, self.normals @ face))


def find_fold(samples: SurfaceSamples, frame: BoxFrame, config: RockersConfig) -> Fold | None:
    """Find the fold across the middle of a plate's front or back; None where neither is folded.

    Args:
        samples: Surface samples of the part.
        frame: Its box frame.
        config: How clear a fold must be.
    """
    thin = frame.axes[frame.thin]
    best: tuple[float, Fold] | None = None
    for side in (thin, -thin):
        facing = samples.normals @ side > np.cos(np.radians(config.facing_deg))
        share = float(samples.areas[facing].sum() / samples.areas.sum())
        if share < config.least_share or (best is not None and share <= best[0]):
            continue
        for across in np.delete(np.arange(3), frame.thin):
            fold = _fold_across(samples.points[facing], samples.normals[facing], frame, int(across), config)
            best = best if fold is None else (share, fold)
    return None if best is None else best[1]


def _fold_across(
    points: FloatArray, normals: FloatArray, frame: BoxFrame, across: int, config: RockersConfig
) -> Fold | None:
    """The fold half-way along one side of the plate, perpendicular to it."""
    axis = np.cross(frame.axes[frame.thin], frame.axes[across])
    place = (points - frame.centre) @ frame.axes[across]
    lean = np.degrees(np.arcsin(np.clip(normals @ frame.axes[across], -1.0, 1.0)))
    even = np.abs(np.degrees(np.arcsin(np.clip(normals @ axis, -1.0, 1.0)))) < config.even_deg
    halves = [place < 0.0, place >= 0.0]
    if min(int(half.sum()) for half in halves) < config.least_samples:
        return None
    leans = [float(np.median(lean[half])) for half in halves]
    flat = [np.abs(lean[half] - middle) < config.even_deg for half, middle in zip(halves, leans, strict=True)]
    whole = all(float((f & even[half]).mean()) > config.whole for f, half in zip(flat, halves, strict=True))
    if not whole or leans[0] * leans[1] >= 0.0 or min(abs(item) for item in leans) < config.least_deg:
        return None
    means = np.array([normals[half][f].mean(axis=0) for f, half in zip(flat, halves, strict=True)])
    return Fold(axis=axis, point=frame.centre, normals=means / np.linalg.norm(means, axis=1, keepdims=True))
