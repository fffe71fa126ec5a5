"""Cues that rank the lines about which a part may turn (doors, lids, flaps, and bearings where modelled).

A panel has no bearing in most meshes, so its hinge is found from what the object is for: the panel must be free to
turn and stay with the body, people pull it by a handle far from the hinge, and it hangs or lies in the way gravity
wants. No cue decides alone: each is bounded, and the sum is compared among lines of one part.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import CENTRE, CORNER, HALF_WAY
from kinematify.joints.features.frames import UP
from kinematify.joints.features.measurements import turned_about
from kinematify.joints.features.motion_test import moving_points, turn_paths
from kinematify.joints.features.ranking import Ranked, cue_sum
from kinematify.robot.vectors import crossed, lengths_of, unit

if TYPE_CHECKING:
    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.motion_test import Sweep
    from kinematify.robot.arrays import FloatArray

WEIGHTS = {
    "free": 1.0, "crossed": -0.5, "outside": 0.5, "separation": -5.0, "axis_to_parent": -4.0, "contact_share": 0.4,
    "contact_radius": -0.5, "ajar_contact": 1.5, "handle_distance": 0.9, "handle_parallel": 0.6,
    "margin_difference": 1.0, "margin_here": -1.0, "door_vertical": 0.4, "door_tall": 0.2, "hinge_above": -0.3,
    "hinge_below": 0.0, "lid_rise": 1.0, "lid_behind": 1.0, "pedal": 1.0, "lid_backrest": 1.0, "thin_along": -0.7,
    "length_along": 0.15, "half_way": -0.3, "centre_line": -0.7, "contact_line": -0.2,
    "weak_bearing": -0.3, "mechanism_bearing": 2.0, "compact_radius": -1.0, "round": 2.0, "square": 0.5,
    "rolling": 1.5, "small_normal": 0.6,
}  # fmt: skip
"""Of each cue of a turn, lengths in diagonals. Their sum is a column of the fit, which was made with these."""
CAP, BEARING_BONUS = 1.5, 4.0  # the most that one cue says, and what a bearing that passes the gate adds


def rank_turns(scene: JointScene, lines: Hypotheses) -> Ranked:
    """Return what cues say of lines about which the child may turn, best first.

    Args:
        scene: The pair.
        lines: Turns alone.
    """
    points, config = moving_points(scene), scene.config
    limit = np.radians(config.panels.sweep_deg)
    paths = turn_paths(scene.cache, points, lines.axes, lines.pivots, limit=limit, config=config.sweep)
    with_parent = paths.against((scene.parent,))
    everything = with_parent.joined(paths.against(scene.others))
    cues = {
        **_motion_cues(scene, lines, (with_parent, everything)),
        **_contact_cues(scene, lines),
        **_handle_cues(scene, lines),
        **_margin_cues(scene, lines),
        **_gravity_cues(scene, lines, with_parent),
    }
    cues |= _shape_cues(scene, lines, near=1.0 - cues["contact_radius"])
    bonus = BEARING_BONUS * (lines.sources == "bearing")
    return Ranked(
        lines=lines,
        scores=cue_sum(cues, WEIGHTS, CAP) + bonus,
        cues=cues,
        free=everything.free(config.sweep.share),
        free_parent=with_parent.free(config.sweep.share),
    ).best_first


def _radii(points: FloatArray, lines: Hypotheses) -> FloatArray:
    """Distance of points (n, 3) from each line [m], shape (c, n)."""
    offset = points[None] - lines.pivots[:, None]
    along = np.einsum("cnk,ck->cn", offset, lines.axes)
    return np.asarray(np.sqrt(np.maximum(np.einsum("cnk,cnk->cn", offset, offset) - along**2, 0.0)))


def _reach(scene: JointScene, lines: Hypotheses) -> FloatArray:
    """Largest distance of the child from each line [m], shape (c,)."""
    points = scene.samples.points
    return np.asarray(np.maximum(_radii(points, lines).max(axis=1), 1e-12))


def outwardness(scene: JointScene, lines: Hypotheses) -> FloatArray:
    """Cosine between the first motion of the centre (turning about +) and the way out of the body, shape (c,)."""
    velocity = crossed(lines.axes, lines.arms(scene.centre))
    speed = lengths_of(velocity)
    away = scene.outward
    if not away.any():
        body = scene.body_box.mean(axis=0) @ scene.frame.axes
        away = scene.centre - body
        away = away / max(float(np.linalg.norm(away)), 1e-12)
    return velocity @ away / np.maximum(speed, 1e-9 * scene.diagonal)


def _motion_cues(scene: JointScene, lines: Hypotheses, both: tuple[Sweep, Sweep]) -> dict[str, FloatArray]:
    """Free turn, share that crosses, gap that opens behind the hinge, and whether the free way leads outwards."""
    outward, full = outwardness(scene, lines), np.radians(scene.config.panels.full_turn_deg)
    free = [np.minimum(swept.free(scene.config.sweep.share), full) for swept in both]
    mean_free = 0.5 * (free[0] + free[1]) / full
    prefer = mean_free + 0.1 * np.stack([outward, -outward], axis=1)
    best = np.argmax(prefer, axis=1)
    rows = np.arange(len(best))
    crossed = 0.5 * (both[0].crossed(0.5 * full) + both[1].crossed(0.5 * full))
    sign = np.where(best == 0, 1.0, -1.0)
    return {
        "free": mean_free[rows, best],
        "crossed": crossed[rows, best],
        "outside": (1.0 - scene.mechanism) * np.clip(sign * outward, 0.0, 1.0),
        "separation": _separation(scene, lines, sign),
    }


def _separation(scene: JointScene, lines: Hypotheses, sign: FloatArray) -> FloatArray:
    """Gap to the parent after a turn of `panels.part_deg` in the preferred direction, fraction of the diagonal."""
    points, panels = scene.samples.points, scene.config.panels
    points = points[:: max(1, len(points) // panels.separation_points)]
    before = float(scene.cache.distances(scene.parent, points).min())
    moved = turned_about(points[None], lines, sign * np.radians(panels.part_deg))
    distances = scene.cache.distances(scene.parent, moved.reshape(-1, 3)).reshape(moved.shape[:2])
    return np.asarray(np.maximum(distances.min(axis=1) - before, 0.0) / scene.diagonal)


def _contact_cues(scene: JointScene, lines: Hypotheses) -> dict[str, FloatArray]:
    """Return how close to the line the parts touch, and how close the line runs to the parent."""
    half = 0.5 * np.ptp(scene.frame.local(scene.samples.points), axis=0)
    span = np.abs(lines.axes @ scene.frame.axes.T) @ half
    foot = scene.centre - lines.arms(scene.centre)
    steps = np.linspace(-0.9, 0.9, 7)
    probes = foot[:, None] + steps[None, :, None] * (span[:, None] * lines.axes)[:, None]
    to_parent = scene.cache.distances(scene.parent, probes.reshape(-1, 3)).reshape(len(span), -1)
    share, radius = np.zeros(len(span)), np.ones(len(span))
    if len(scene.contact.points):
        relative = _radii(scene.contact.points, lines) / _reach(scene, lines)[:, None]
        share = (relative < scene.config.panels.hinge_band) @ scene.contact.weights
        radius = relative @ scene.contact.weights
    # A panel that touches its parent along one edge only stands open; then contact tells the hinge by itself.
    ajar = scene.plate and share[lines.places == CORNER].max(initial=0.0) > scene.config.panels.ajar_share
    return {
        "axis_to_parent": np.sort(to_parent, axis=1)[:, :3].mean(axis=1) / scene.diagonal,
        "contact_share": share,
        "contact_radius": radius,
        "compact_radius": scene.compact * radius,
        "ajar_contact": ajar * share,
    }


def _handle_cues(scene: JointScene, lines: Hypotheses) -> dict[str, FloatArray]:
    """A handle is far from the hinge, and a long one runs along it."""
    if scene.handle is None:
        return dict.fromkeys(("handle_distance", "handle_parallel"), np.zeros(len(lines)))
    panels, distance = scene.config.panels, lengths_of(lines.arms(scene.handle.centre)) / _reach(scene, lines)
    # Handles of tall doors are mounted either way; one that lies level in the middle is that of a door that drops.
    tall = scene.upright and _tallness(scene) > panels.tall and not _handle_in_the_middle(scene)
    return {
        "handle_distance": np.minimum(distance, 1.0),
        "handle_parallel": np.abs(lines.axes @ scene.handle.direction) * (panels.tall_handle if tall else 1.0),
    }


def _margin_cues(scene: JointScene, lines: Hypotheses) -> dict[str, FloatArray]:
    """The hinge is on the side where less of the body is left; controls and the next door are opposite."""
    frame, panels, (here, opposite) = scene.frame, scene.config.panels, np.zeros((2, len(lines)))
    if scene.panel:
        arms = -lines.arms(scene.centre) @ frame.axes.T
        arms[:, frame.thin] = 0.0
        side = np.argmax(np.abs(arms), axis=1)
        aside = arms[np.arange(len(lines)), side]
        low = frame.slab_lower - scene.body_box[0]
        high = scene.body_box[1] - frame.slab_upper
        near = np.where(aside > 0, high[side], low[side]) / scene.diagonal
        far = np.where(aside > 0, low[side], high[side]) / scene.diagonal
        at_edge = np.abs(aside) > 0.3 * frame.extents[side]
        here, opposite = np.where(at_edge, near, 0.0), np.where(at_edge, far, 0.0)
    difference = np.clip(2.0 * (opposite - here), -panels.margin_cap, panels.margin_cap)
    # A handle says directly where the free side is; then the margins are only a hint.
    factor = panels.weak_margin if scene.flat or _handle_off_centre(scene) else 1.0
    return {"margin_difference": factor * difference, "margin_here": factor * np.maximum(here, 0.0)}


def _handle_off_centre(scene: JointScene) -> bool:
    """The handle is clearly nearer to one side of the panel than to the opposite one."""
    if scene.handle is None:
        return False
    frame = scene.frame
    shift = np.abs((scene.handle.centre - scene.centre) @ frame.axes.T) / np.maximum(frame.extents, 1e-12)
    return bool(np.delete(shift, frame.thin).max() > 0.25)


def _handle_in_the_middle(scene: JointScene) -> bool:
    """A long level handle, centred between the sides of an upright panel that is as wide as its body.

    One of two doors side by side does not drop, whatever its handle.
    """
    if scene.handle is None or not scene.handle.direction.any():
        return False
    level = scene.handle.direction
    shift = abs(float((scene.handle.centre - scene.centre) @ level))
    width = float(np.abs(scene.frame.axes @ level) @ scene.frame.extents)
    body = float(np.abs(scene.frame.axes @ level) @ (scene.body_box[1] - scene.body_box[0]))
    return abs(float(level @ UP)) < 0.1 and shift < 0.1 * width and width > 0.8 * body


def _tallness(scene: JointScene) -> float:
    """Height over width of an upright panel."""
    frame = scene.frame
    plane = [k for k in range(3) if k != frame.thin]
    heights = [abs(float(frame.axes[k] @ UP)) for k in plane]
    vertical, level = (plane[0], plane[1]) if heights[0] > heights[1] else (plane[1], plane[0])
    return float(frame.extents[vertical] / max(frame.extents[level], 1e-12))


def _gravity_cues(scene: JointScene, lines: Hypotheses, with_parent: Sweep) -> dict[str, FloatArray]:
    """Doors turn about upright lines or drop down, lids rise, and a lid's hinge is where the body stands higher."""
    vertical = np.abs(lines.axes @ UP)
    arms = -lines.arms(scene.centre)
    length = lengths_of(arms)
    height = arms[:, 2] / np.maximum(length, 1e-9 * scene.diagonal)
    door = float(scene.panel and scene.upright)
    tallness = np.clip(np.log2(_tallness(scene)), -1.0, 1.0) if door else 0.0
    lid = float(scene.panel and scene.flat)
    free = with_parent.free(0.03)
    velocity = crossed(lines.axes, arms * -1.0)[:, 2] / _reach(scene, lines)
    rise = np.where(free[:, 0] >= free[:, 1], velocity, -velocity)
    pedal = scene.pedal_direction
    half = 0.5 * float(np.abs(scene.frame.axes @ pedal) @ scene.frame.extents)
    across = (vertical < 0.1) & (np.abs(lines.axes @ pedal) < 0.5)
    return {
        "door_vertical": door * (vertical > 0.9),
        "door_tall": door * tallness * (vertical > 0.9),
        "hinge_above": door * np.maximum(height, 0.0),
        "hinge_below": door * np.maximum(-height, 0.0),
        "lid_rise": lid * rise,
        "lid_backrest": lid * _body_behind(scene, arms),
        "lid_behind": -lid * (arms @ scene.front) / np.maximum(length, 1e-9 * scene.diagonal),
        # From -1 at the tip of a pedal to 1 at its end inside the body.
        "pedal": np.where(across, np.clip(-arms @ pedal / max(half, 1e-12), -1.0, 1.0), 0.0),
    }


def _body_behind(scene: JointScene, arms: FloatArray) -> FloatArray:
    """Return how much more of the body stands above the lid on the hinge's side than opposite, in [-1, 1]."""
    samples = scene.parent_samples
    above = samples.points[:, 2] > scene.bounds[1, 2]
    if above.mean() < 0.02:
        return np.zeros(len(arms))
    level = arms.copy()
    level[:, 2] = 0.0
    side = np.sign((samples.points[above] - scene.centre) @ unit(level, 1e-9 * scene.diagonal).T)
    return np.asarray(side.mean(axis=0))


def _shape_cues(scene: JointScene, lines: Hypotheses, near: FloatArray) -> dict[str, FloatArray]:
    """Where on the box the line lies and how it runs; for small parts, the normal of the contact.

    A round part that touches only far from its own axis (a porthole on its hinge) does not turn about that axis.
    """
    frame = scene.frame
    thin = np.abs(lines.axes @ frame.thin_axis)
    off = lengths_of(lines.arms(scene.centre)) / float(frame.extents.max())
    built = np.concatenate([frame.axes, scene.parent_frame.axes])
    nearest = np.minimum(np.abs(lines.axes @ built.T).max(axis=1), 1.0)
    along = np.abs(lines.axes @ frame.axes.T) @ frame.extents / max(float(frame.extents.max()), 1e-12)
    place, source = lines.places, lines.sources
    turned = np.maximum(_roundness(scene, lines), scene.disc * (place == CENTRE) * (thin > 0.99))
    turned *= 1.0 - scene.compact * (1.0 - near)
    by_contact = (source == "weak_bearing") | (source == "contact_axis")
    stands = (place == CENTRE) | (by_contact if scene.mechanism > 0.5 else source == "contact_axis")
    values, vectors = scene.contact.facing
    normal = np.abs(lines.axes @ vectors[:, 2]) * float(values[2])
    return {
        "thin_along": thin * (1.0 - turned) * (1.0 - scene.mechanism),
        "length_along": along,
        "half_way": 1.0 * (place == HALF_WAY),
        "centre_line": 1.0 * (place == CENTRE),
        "contact_line": 1.0 * (source == "contact_line"),
        "weak_bearing": (1.0 - scene.mechanism) * (source == "weak_bearing"),
        "mechanism_bearing": scene.mechanism * (source == "weak_bearing") * _bearing_ratio(scene, lines) * near,
        "small_normal": max(scene.smallness, scene.compact) * normal * stands,
        "round": turned,
        "rolling": 1.0 * ((thin > np.cos(np.radians(10.0))) & (off < 0.1) & scene.rolls),
        "square": scene.mechanism * by_contact * np.interp(np.degrees(np.arccos(nearest)), (4.0, 8.0), (1.0, 0.0)),
    }


def _bearing_ratio(scene: JointScene, lines: Hypotheses) -> FloatArray:
    """Score of each bearing line over that of the best one; 0 for other lines."""
    scores = iter(line.score for line in scene.lines)
    best = max([1e-12, *(line.score for line in scene.lines)])
    return np.array([next(scores) / best if source in ("bearing", "weak_bearing") else 0.0 for source in lines.sources])


def _roundness(scene: JointScene, lines: Hypotheses) -> FloatArray:
    """Share of the child's area across the line's direction that turns into itself about the line, from 0.5 to 1."""
    samples = scene.samples
    result = np.zeros(len(lines.axes))
    for c, (axis, pivot) in enumerate(zip(lines.axes, lines.pivots, strict=True)):
        lateral = np.abs(samples.normals @ axis) < 0.9
        if lateral.sum() < 30:
            continue
        offset = samples.points[lateral] - pivot
        radial = offset - (offset @ axis)[:, None] * axis
        miss = np.abs(np.einsum("ij,ij->i", crossed(axis, unit(radial)), samples.normals[lateral]))
        result[c] = np.clip(2.0 * float((miss < np.sin(np.radians(12.0))).mean()) - 1.0, 0.0, 1.0)
    return result
