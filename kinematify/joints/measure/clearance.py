"""Clearance: how far the surface of a contact itself can turn or slide before it is stopped.

Sweeps of a whole part (`measure.sweep`) skip the first steps, because meshes overlap where parts touch. The clearance
of a contact is what keys, splines, skirts, grooves and beads decide: it is measured without that grace, on the samples
near the other part alone, each drawn a little into its own material.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.measure.sweep import sweep_slides, sweep_turns

if TYPE_CHECKING:
    from kinematify.config import JointsConfig, SweepConfig
    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True)
class Clearance:
    """Way that the contact can go before it is stopped, the longer of both directions."""

    turn: float
    """Length of the arc at the contact's mean radius [m]; inf where it is not stopped."""
    slide: float
    """Length [m]; inf where it is not stopped."""

    def slides_only(self, least: float, ratio: float) -> bool:
        """It is stopped from turning, and slides by `least` [m] and by `ratio` times as far."""
        return bool(np.isfinite(self.turn) and self.slide > max(least, ratio * self.turn))

    def turns_only(self, least: float, ratio: float) -> bool:
        """It is stopped from sliding, and turns by `least` [m] and by `ratio` times as far."""
        return bool(np.isfinite(self.slide) and self.turn > max(least, ratio * self.slide))


def contact_clearance(
    scene: JointScene, axes: FloatArray, pivots: FloatArray, direction: FloatArray, config: JointsConfig
) -> Clearance | None:
    """Measure how far a contact turns about the freest of several lines and slides, against the parent alone.

    Args:
        scene: The pair.
        axes: Unit directions of the lines, shape (c, 3).
        pivots: Points on them [m], shape (c, 3).
        direction: Unit direction of the slide, shape (3,).
        config: `clearance` and the step of sweeps.

    Returns:
        The clearance; None where the contact has too few samples.
    """
    points = _followed(scene, config)
    if points is None:
        return None
    limit = np.radians(config.clearance.turn_deg)
    turned = sweep_turns(scene.cache, points, axes, pivots, (scene.parent,), limit=limit, config=_strict(config))
    free = turned.free(_share(scene, config)).max(axis=1)
    radii = np.linalg.norm(np.cross(points[None] - pivots[:, None], axes[:, None]), axis=2).mean(axis=1)
    arcs = np.where(free >= limit, np.inf, free * radii)
    return Clearance(turn=float(arcs.max()), slide=float(_slid(scene, points, direction, config).max()))


def slide_clearance(scene: JointScene, direction: FloatArray, config: JointsConfig) -> FloatArray | None:
    """How far the contact slides along + and - a direction [m], shape (2,), inf if never stopped; None as above."""
    points = _followed(scene, config)
    return None if points is None else _slid(scene, points, direction, config)


def _slid(scene: JointScene, points: FloatArray, direction: FloatArray, config: JointsConfig) -> FloatArray:
    reach = config.clearance.slide * scene.frame.diagonal
    swept = sweep_slides(scene.cache, points, direction[None], (scene.parent,), limit=reach, config=_strict(config))
    free = swept.free(_share(scene, config))[0]
    return np.where(free >= reach, np.inf, free)


def _followed(scene: JointScene, config: JointsConfig) -> FloatArray | None:
    """Samples of the contact, drawn into the child [m], shape (n, 3); None where there are too few."""
    contact = scene.contact
    if len(contact.points) < config.clearance.least_samples:
        return None
    stride = max(1, len(contact.points) // config.clearance.samples)
    return np.asarray((contact.points - config.clearance.inset * scene.frame.diagonal * contact.normals)[::stride])


def _strict(config: JointsConfig) -> SweepConfig:
    return config.sweep.model_copy(update={"grace": 0.0, "hinge_zone": 0.0})


def _share(scene: JointScene, config: JointsConfig) -> float:
    """A journal is modelled with its clearance, so that fewer samples are beyond doubt."""
    return config.clearance.share if scene.journal is None else config.clearance.journal_share
