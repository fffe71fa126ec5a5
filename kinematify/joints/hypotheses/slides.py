"""Sliding joints: candidate directions and the cues that rank them (drawers, trays, buttons, lift-off lids)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.hypotheses.panels import GIVEN, some_of
from kinematify.joints.measure.frames import UP
from kinematify.joints.measure.scene import is_cap
from kinematify.joints.measure.sweep import moving_points, sweep_slides

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import JointsConfig
    from kinematify.joints.measure.scene import JointScene
    from kinematify.joints.measure.sweep import Sweep
    from kinematify.robot.arrays import FloatArray


WEIGHTS = {
    "travel_parent": 1.0, "travel_all": 0.3, "one_way": 0.6, "flush": 0.6, "crossed": -0.5, "thin_large": -0.4,
    "horizontal": 0.5, "along_bearing": 1.5, "along_rail": 2.5, "lift_off": 1.0, "cap": 2.5, "small_way": 1.0,
    "thin_small": 0.7, "normal_small": 0.7, "twin": 2.5,
}  # fmt: skip
"""Of each cue of a slide, lengths in diagonals; as those of turns."""
CAP = 2.5  # the most that one cue says


@dataclass(frozen=True, kw_only=True, eq=False)
class RankedSlides:
    """Candidate directions with their scores, best first."""

    axes: FloatArray
    """Unit directions in the world frame, shape (c, 3)."""
    sources: tuple[str, ...]
    """Generator of each direction."""
    scores: FloatArray
    """Shape (c,), higher is better."""
    cues: Mapping[str, FloatArray]
    """Value of each cue before its weight, shape (c,) each."""
    free: FloatArray
    """Free travel towards + and - before the part hits anything, fraction of the diagonal, shape (c, 2)."""
    free_parent: FloatArray
    """The same against the parent alone, shape (c, 2)."""

    @property
    def proposed(self) -> RankedSlides:
        """Without those that were given."""
        found: RankedSlides = some_of(self, np.flatnonzero(np.array(self.sources) != GIVEN))
        return found


def rank_slides(
    scene: JointScene, twins: FloatArray, config: JointsConfig, given: Sequence[FloatArray] = ()
) -> RankedSlides:
    """Propose the directions along which the child may slide and rank them.

    Args:
        scene: The pair.
        twins: Unit directions towards congruent leaf siblings, shape (k, 3).
        config: Weights and sweeps.
        given: Unit directions (3,) to rank beside the proposals, from elsewhere; their source is `panels.GIVEN`.
    """
    axes, sources = _directions(scene, twins, config)
    axes = np.concatenate([axes, np.reshape(given, (-1, 3))])
    sources += (GIVEN,) * len(given)
    points = moving_points(scene.cache, scene.child, config.sweep)
    limit = config.slides.sweep * scene.diagonal
    with_parent = sweep_slides(scene.cache, points, axes, (scene.parent,), limit=limit, config=config.sweep)
    everything = with_parent.joined(
        sweep_slides(scene.cache, points, axes, scene.others, limit=limit, config=config.sweep)
    )
    cues = {
        **_motion_cues(scene, axes, with_parent, everything, config),
        **_shape_cues(scene, axes, twins, with_parent, config),
        "small_way": _small_way(scene, points, axes, config),
    }
    scores = np.sum([np.clip(WEIGHTS[name] * value, -CAP, CAP) for name, value in cues.items()], axis=0)
    ranked = RankedSlides(
        axes=axes,
        sources=sources,
        scores=scores,
        cues=cues,
        free=everything.free(config.sweep.share) / scene.diagonal,
        free_parent=with_parent.free(config.sweep.share) / scene.diagonal,
    )
    best_first: RankedSlides = some_of(ranked, np.argsort(-scores, kind="stable"))
    return best_first


def _directions(scene: JointScene, twins: FloatArray, config: JointsConfig) -> tuple[FloatArray, tuple[str, ...]]:
    """Distinct directions: rail, bearing, twins, the child's box, the parent's box, the contact normal."""
    found: list[tuple[FloatArray, str]] = []
    if scene.bearing is not None and scene.bearing.rail is not None and scene.mechanism > 0:
        found.append((scene.bearing.rail.axis, "rail"))
    if scene.bearing is not None and scene.bearing.lines and scene.has_bearing:
        found.append((scene.bearing.lines[0].axis, "bearing"))
    found += [(axis, "twin") for axis in twins]
    found += [(axis, "box") for axis in scene.frame.axes]
    found += [(axis, "parent_box") for axis in scene.parent_frame.axes]
    normal = contact_normal(scene)
    if normal is not None:
        found.append((normal, "contact_normal"))
    kept: list[tuple[FloatArray, str]] = []
    cosine = np.cos(np.radians(config.slides.distinct_deg))
    for axis, source in found:
        if all(abs(float(axis @ other)) < cosine for other, _ in kept):
            kept.append((axis, source))
    return np.array([axis for axis, _ in kept]), tuple(source for _, source in kept)


def contact_normal(scene: JointScene) -> FloatArray | None:
    """Dominant direction of the child's normals where it touches its parent; None without a dominant one."""
    contact = scene.contact
    if len(contact.points) == 0:
        return None
    values, vectors = np.linalg.eigh((contact.normals * contact.weights[:, None]).T @ contact.normals)
    return np.asarray(vectors[:, 2]) if values[2] > 0.7 else None


def _motion_cues(
    scene: JointScene, axes: FloatArray, with_parent: Sweep, everything: Sweep, config: JointsConfig
) -> dict[str, FloatArray]:
    """Free travel one way, stop the other way, and what is crossed on a short way."""
    large = 1.0 - scene.smallness
    share = config.sweep.share
    parent = with_parent.free(share) / scene.diagonal
    free = everything.free(share) / scene.diagonal
    own = np.abs(axes @ scene.frame.axes.T) @ scene.frame.extents / scene.diagonal
    useful = np.clip(config.slides.useful_share * own, config.slides.useful_least, None)
    longest = np.minimum(1.0, parent.max(axis=1) / useful)
    shortest = np.minimum(1.0, parent.min(axis=1) / useful)
    short = config.slides.short_travel * scene.diagonal
    crossed = 0.5 * (with_parent.crossed(short) + everything.crossed(short)).min(axis=1)
    return {
        "travel_parent": large * longest,
        "travel_all": large * np.minimum(1.0, free.max(axis=1) / useful),
        "one_way": large * (longest - shortest),
        "flush": large * _flush(scene, axes, parent),
        "crossed": crossed,
    }


def _small_way(scene: JointScene, points: FloatArray, axes: FloatArray, config: JointsConfig) -> FloatArray:
    """Free travel of a small part in its own lengths, 1 at most: a pocket holds it on all sides but the open one.

    Small parts move by less than the grace of other sweeps, so this one has none.
    """
    if scene.smallness == 0.0:
        return np.zeros(len(axes))
    strict = config.sweep.model_copy(update={"grace": 0.0})
    own = np.abs(axes @ scene.frame.axes.T) @ scene.frame.extents
    swept = sweep_slides(scene.cache, points, axes, (scene.parent,), limit=scene.frame.diagonal, config=strict)
    return np.asarray(scene.smallness * np.minimum(1.0, swept.free(config.sweep.share).max(axis=1) / own))


def _flush(scene: JointScene, axes: FloatArray, free: FloatArray) -> FloatArray:
    """How close the leading face is to the outside of the body, in lengths of the part, for the free way out."""
    samples = scene.cache.samples(scene.child).points @ axes.T
    body = scene.cache.samples(scene.parent).points @ axes.T
    length = np.maximum(np.ptp(samples, axis=0), 1e-12)
    ahead = np.maximum(body.max(axis=0) - samples.max(axis=0), 0.0) / length
    behind = np.maximum(samples.min(axis=0) - body.min(axis=0), 0.0) / length
    closeness = np.clip(1.0 - np.stack([ahead, behind], axis=1) / 0.25, 0.0, 1.0)
    return np.asarray((closeness * (free > 0.1)).max(axis=1))


def _shape_cues(
    scene: JointScene, axes: FloatArray, twins: FloatArray, with_parent: Sweep, config: JointsConfig
) -> dict[str, FloatArray]:
    large = 1.0 - scene.smallness
    thin = np.abs(axes @ scene.frame.axes[scene.frame.thin])
    normal = contact_normal(scene)
    pressed = np.abs(axes @ normal) if normal is not None else np.zeros(len(axes))
    free = with_parent.free(config.sweep.share)
    rising = np.where(axes[:, 2] >= 0, free[:, 0], free[:, 1]) > 0.1 * scene.diagonal
    bearing = np.zeros(len(axes))
    if scene.bearing is not None and scene.has_bearing:
        bearing = np.abs(axes @ scene.bearing.lines[0].axis)
    rail = np.zeros(len(axes))
    if scene.bearing is not None and scene.bearing.rail is not None:
        rail = scene.mechanism * scene.prismatic_score * np.abs(axes @ scene.bearing.rail.axis)
    return {
        "thin_large": large * thin,
        "horizontal": large * (1.0 - np.abs(axes @ UP)),
        "along_bearing": bearing,
        "along_rail": rail,
        "cap": float(is_cap(scene)) * np.abs(axes @ UP),
        "thin_small": scene.smallness * thin,
        "normal_small": scene.smallness * pressed,
        "twin": _along_any(axes, twins, config),
        "lift_off": large * float(scene.panel and scene.flat and scene.on_top) * np.abs(axes @ UP) * rising,
    }


def _along_any(axes: FloatArray, directions: FloatArray, config: JointsConfig) -> FloatArray:
    """1 for each axis that no candidate tells apart from one of the directions, else 0, shape (c,)."""
    if len(directions) == 0:
        return np.zeros(len(axes))
    nearest = np.abs(axes @ directions.T).max(axis=1)
    return np.asarray(nearest >= np.cos(np.radians(config.slides.distinct_deg)), dtype=np.float64)
