"""Cues that rank the directions along which a part may slide (drawers, trays, buttons, lift-off lids)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.features.frames import UP
from kinematify.joints.features.motion_test import moving_points, slide_paths
from kinematify.joints.features.ranking import Ranked, cue_sum

if TYPE_CHECKING:
    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.motion_test import Sweep
    from kinematify.robot.arrays import FloatArray


WEIGHTS = {
    "travel_parent": 1.0, "travel_all": 0.3, "one_way": 0.6, "flush": 0.6, "crossed": -0.5, "thin_large": -0.4,
    "horizontal": 0.5, "along_bearing": 1.5, "along_rail": 2.5, "lift_off": 1.0, "small_way": 1.0,
    "thin_small": 0.7, "normal_small": 0.7, "twin": 2.5,
}  # fmt: skip
"""Of each cue of a slide, lengths in diagonals; as those of turns."""
CAP = 2.5  # the most that one cue says
_DOMINANT = 0.7  # share of the normals of a contact along one direction, from which it is pressed along that


def rank_slides(scene: JointScene, lines: Hypotheses) -> Ranked:
    """Return what cues say of directions along which the child may slide, best first.

    Args:
        scene: The pair.
        lines: Slides alone.
    """
    axes, points, config = lines.axes, moving_points(scene), scene.config
    limit = config.slides.sweep * scene.diagonal
    paths = slide_paths(scene.cache, points, axes, limit=limit, config=config.sweep)
    with_parent = paths.against((scene.parent,))
    everything = with_parent.joined(paths.against(scene.others))
    cues = {
        **_motion_cues(scene, axes, with_parent, everything),
        **_shape_cues(scene, axes, with_parent),
        "small_way": _small_way(scene, points, axes),
    }
    return Ranked(
        lines=lines,
        scores=cue_sum(cues, WEIGHTS, CAP),
        cues=cues,
        free=everything.free(config.sweep.share) / scene.diagonal,
        free_parent=with_parent.free(config.sweep.share) / scene.diagonal,
    ).best_first


def _motion_cues(scene: JointScene, axes: FloatArray, with_parent: Sweep, everything: Sweep) -> dict[str, FloatArray]:
    """Free travel one way, stop the other way, and what is crossed on a short way."""
    large, slides, share = 1.0 - scene.smallness, scene.config.slides, scene.config.sweep.share
    parent = with_parent.free(share) / scene.diagonal
    free = everything.free(share) / scene.diagonal
    own = np.abs(axes @ scene.frame.axes.T) @ scene.frame.extents / scene.diagonal
    useful = np.maximum(slides.useful_share * own, slides.useful_least)
    longest = np.minimum(1.0, parent.max(axis=1) / useful)
    shortest = np.minimum(1.0, parent.min(axis=1) / useful)
    short = slides.short_travel * scene.diagonal
    crossed = 0.5 * (with_parent.crossed(short) + everything.crossed(short)).min(axis=1)
    return {
        "travel_parent": large * longest,
        "travel_all": large * np.minimum(1.0, free.max(axis=1) / useful),
        "one_way": large * (longest - shortest),
        "flush": large * _flush(scene, axes, parent),
        "crossed": crossed,
    }


def _small_way(scene: JointScene, points: FloatArray, axes: FloatArray) -> FloatArray:
    """Free travel of a small part in its own lengths, 1 at most: a pocket holds it on all sides but the open one.

    Small parts move by less than the grace of other sweeps, so this one has none.
    """
    if scene.smallness == 0.0:
        return np.zeros(len(axes))
    strict = scene.config.sweep.model_copy(update={"grace": 0.0})
    own = np.abs(axes @ scene.frame.axes.T) @ scene.frame.extents
    paths = slide_paths(scene.cache, points, axes, limit=scene.frame.diagonal, config=strict)
    swept = paths.against((scene.parent,))
    return np.asarray(scene.smallness * np.minimum(1.0, swept.free(strict.share).max(axis=1) / own))


def _flush(scene: JointScene, axes: FloatArray, free: FloatArray) -> FloatArray:
    """Return how close the leading face is to the outside of the body, in lengths of the part, for the free way out."""
    samples = scene.samples.points @ axes.T
    body = scene.parent_samples.points @ axes.T
    length = np.maximum(np.ptp(samples, axis=0), 1e-12)
    ahead = np.maximum(body.max(axis=0) - samples.max(axis=0), 0.0) / length
    behind = np.maximum(samples.min(axis=0) - body.min(axis=0), 0.0) / length
    closeness = np.clip(1.0 - np.stack([ahead, behind], axis=1) / 0.25, 0.0, 1.0)
    return np.asarray((closeness * (free > 0.1)).max(axis=1))


def _shape_cues(scene: JointScene, axes: FloatArray, with_parent: Sweep) -> dict[str, FloatArray]:
    large = 1.0 - scene.smallness
    thin = np.abs(axes @ scene.frame.thin_axis)
    shares, facing = scene.contact.facing
    pressed = np.abs(axes @ facing[:, 2]) * (shares[2] > _DOMINANT)
    free = with_parent.free(scene.config.sweep.share)
    rising = np.where(axes[:, 2] >= 0, free[:, 0], free[:, 1]) > 0.1 * scene.diagonal
    bearing, rail = np.zeros((2, len(axes)))
    if scene.has_bearing:
        bearing = np.abs(axes @ scene.lines[0].axis)
    if scene.rail is not None:
        rail = scene.mechanism * scene.prismatic_score * np.abs(axes @ scene.rail.axis)
    return {
        "thin_large": large * thin,
        "horizontal": large * (1.0 - np.abs(axes @ UP)),
        "along_bearing": bearing,
        "along_rail": rail,
        "thin_small": scene.smallness * thin,
        "normal_small": scene.smallness * pressed,
        "twin": _grip(scene, axes),
        "lift_off": large * float(scene.panel and scene.flat and scene.on_top) * np.abs(axes @ UP) * rising,
    }


def _grip(scene: JointScene, axes: FloatArray) -> FloatArray:
    """1 for each axis that no candidate tells apart from the way of a finger to its twin, else 0, shape (c,)."""
    nearest = np.abs(axes @ scene.grips.T).max(axis=1, initial=0.0)
    return np.asarray(nearest >= np.cos(np.radians(scene.config.slides.distinct_deg)), dtype=np.float64)
