"""Content of a picture of a model: posed meshes, joint arrows, a configuration that opens it, a good point of view."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config.validation import load_settings
from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.rest_pairs import DepthAllowance
from kinematify.geometry.scene import read_scene
from kinematify.model.urdf import link_colors, model_robot
from kinematify.render.picture import PosedMesh, camera_for
from kinematify.robot.appearance import joined, plain
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import across, transformed
from kinematify.robot.vectors import as_one, box_around

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import PreviewConfig
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.render.picture import PictureScene
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Joint, Robot

    Mesh = tuple[FloatArray, IntArray]


GLYPH_COLORS = {
    JointType.REVOLUTE: np.array([0.84, 0.10, 0.16]),
    JointType.CONTINUOUS: np.array([0.84, 0.10, 0.16]),
    JointType.PRISMATIC: np.array([0.07, 0.33, 0.86]),
}
"""sRGB of the arrows by joint type."""
_OTHER_GLYPH = {False: np.array([0.95, 0.70, 0.05]), True: np.array([0.66, 0.10, 0.70])}
"""The same on a part of nearly that colour, by whether the joint turns."""
_SAME_COLOR = 0.3
"""Distance of sRGB colours below which an arrow is lost on its part."""
_SWEEP = {JointType.REVOLUTE: np.deg2rad(250.0), JointType.CONTINUOUS: np.deg2rad(335.0)}
_CONTINUOUS_TURN = np.deg2rad(35.0)  # shows that it turns without looking like an end stop
_FREE_CHAIN = 3  # joints one behind the other: furniture has no more, arms and fingers have
_ARM_TURN = np.deg2rad(60.0)
_CHAIN_TURN = np.deg2rad(22.0)  # for models of many joints
_ARROW_LENGTHS = (0.16, 0.75)  # of the model's diagonal: never lost, never larger than the object
_OVERHANG = 1.15  # length of an axis line over that of its part
_SLIDE_OVERHANG = 0.14  # of the model's diagonal: the heads of a sliding arrow stand out of its part
_AXIS_SHARE = 0.3  # of a view's worth: how far axes lie across the line of sight
_SUNK = 0.01  # of the model's size: what is lower than at rest by more goes through the floor
_OFF_AXIS = 0.66  # of a step between views: most objects stand parallel to the axes and look flat from there


def moving_joints(model: KinematicModel) -> tuple[Joint, ...]:
    """Joints that are not fixed, in the model's order."""
    return tuple(joint for joint in model.joints if joint.kind is not JointType.FIXED)


def opened_configuration(model: KinematicModel, config: PreviewConfig, robot: Robot | None = None) -> dict[str, float]:
    """A configuration in which every joint is moved as far as it goes; in long chains less far, so that none curls up.

    What would go through the floor or another part is moved half as far.

    Args:
        model: Of all joints.
        config: How far they are moved.
        robot: The same with the shapes by which parts meet; those that are seen if absent.

    Returns:
        Joint name -> position [rad or m].
    """
    moving = moving_joints(model)
    if _longest_chain(model) <= _FREE_CHAIN:
        max_turn = np.deg2rad(config.max_turn)
    else:
        max_turn = _ARM_TURN if len(moving) <= config.chain_joints else _CHAIN_TURN
    max_slide = config.max_slide * _diagonal(model)
    q = {}
    for joint in moving:
        if joint.kind is JointType.CONTINUOUS:
            q[joint.name] = float(min(_CONTINUOUS_TURN, max_turn))
            continue
        cap = max_turn if joint.kind.turns else max_slide
        # Positive opens; the other way is taken only where nearly all of the range lies there.
        end = joint.upper if joint.upper > 0.1 * -joint.lower else joint.lower
        q[joint.name] = float(np.clip(config.moved_fraction * end, -cap, cap))
    return q | {name: 0.5 * q[name] for name in _obstructed(model, q, robot or model_robot(model))}


def _obstructed(model: KinematicModel, q: Mapping[str, float], robot: Robot) -> set[str]:
    """Joints that move a part through the floor or through another part in a configuration."""
    seen = {link.name for link in model.links if len(link.part.faces) > 1}  # links without geometry have one triangle
    links = (link if link.name in seen else replace(link, visuals=(), collisions=()) for link in robot.links)
    scene = read_scene(replace(robot, links=tuple(links)), load_settings().geometry)
    leaders = [travel.joint for travel in scene.travels]
    if not leaders:
        return set()
    placed = scene.poses(np.array([[q[name] for name in leaders]]))[0]
    floor, low = (
        [
            min(float((shape @ T[2, :3]).min() + T[2, 3]) for shape in body.shapes)
            for body, T in zip(scene.bodies, poses, strict=True)
        ]
        for poses in (scene.at_rest, placed)
    )
    below = [(0, k) for k, height in enumerate(low) if height < min(floor) - _SUNK * scene.size]
    meeting = DepthAllowance(scene, OverlapQueries(scene)).meeting(placed)
    pairs = [*below, *(pair for pair, _, tolerated in meeting if not tolerated)]
    return {leaders[k] for pair in pairs for k in scene.between(pair)}


def _longest_chain(model: KinematicModel) -> int:
    """Return how many joints move one behind the other at most."""
    behind = {model.root: 0}
    for joint in model.robot.joints_downward:
        behind[joint.child] = behind[joint.parent] + (joint.kind is not JointType.FIXED)
    return max(behind.values())


def posed_meshes(
    model: KinematicModel,
    q: Mapping[str, float],
    colors: Mapping[str, FloatArray],
    shades: Mapping[str, float] | None = None,
) -> dict[str, PosedMesh]:
    """Every link's mesh, set-aside visuals included, as it is at a configuration.

    Args:
        model: The model.
        q: Joint name -> position [rad or m].
        colors: Link name -> sRGB (3,).
        shades: Link name -> factor on the light of its colours; all 1 if absent.

    Returns:
        Link name -> mesh in the world frame.
    """
    T_world_link = forward_kinematics(model.robot, q)
    posed = {}
    for link in model.links:
        # No picture shows more than the mesh that the inference used, but that one has no materials.
        seen = link.visual if link.visual.appearance is not None else link.part
        parts = (seen, *(part for part in link.fixed_visuals if len(part.faces)))
        vertices, faces = as_one((part.vertices, part.faces) for part in parts)
        T_moved = T_world_link[link.name] @ np.linalg.inv(link.T_world_link)
        usual = [part.color or colors[link.name].tolist() for part in parts]
        looks = [
            part.appearance or plain((*color, 1.0), len(part.faces)) for part, color in zip(parts, usual, strict=True)
        ]
        appearance = joined(looks, [len(part.faces) for part in parts])
        posed[link.name] = PosedMesh(
            vertices=transformed(vertices, T_moved),
            faces=faces,
            color=colors[link.name],
            appearance=appearance,
            shade=1.0 if shades is None else shades[link.name],
        )
    return posed


def glyph_color(kind: JointType, part: FloatArray) -> FloatArray:
    """Return the colour of a joint's arrow, sRGB, shape (3,): another one where the part that moves has the usual one.

    Args:
        kind: A type in `GLYPH_COLORS`.
        part: Colour of the part, sRGB, shape (3,).
    """
    usual = GLYPH_COLORS[kind]
    return _OTHER_GLYPH[kind.turns] if float(np.linalg.norm(usual - part)) < _SAME_COLOR else usual


def joint_glyphs(model: KinematicModel, q: Mapping[str, float], config: PreviewConfig) -> dict[str, PosedMesh]:
    """An arrow for every joint that moves, where its axis stands at a configuration.

    Returns:
        Joint name -> arrow in the world frame.
    """
    T_world_link = forward_kinematics(model.robot, q)
    diagonal, colors = _diagonal(model), link_colors(model)
    glyphs = {}
    for joint in moving_joints(model):
        vertices, faces = _arrow_at_rest(model, joint, diagonal, config)
        # The axis is fixed in the parent; the arrow rides on the child, about the same line.
        T_moved = T_world_link[joint.child] @ np.linalg.inv(model.link_by_name[joint.child].T_world_link)
        color = glyph_color(joint.kind, colors[joint.child])
        glyphs[joint.name] = PosedMesh(vertices=transformed(vertices, T_moved), faces=faces, color=color)
    return glyphs


def best_azimuth(model: KinematicModel, scenes: Sequence[PictureScene], config: PreviewConfig) -> float:
    """The side from which moving parts, the room that they sweep and their axes are seen best.

    Args:
        model: The model, for its axes.
        scenes: At rest and moved, the meshes of moving parts first in each.
        config: Views to try.

    Returns:
        Where the camera should stand, from x towards y [rad].
    """
    moving = moving_joints(model)
    axes = np.array([joint.axis for joint in moving]).reshape(-1, 3)

    def worth(azimuth: float) -> float:
        size = (config.probe_pixels, round(config.probe_pixels * config.panel_height / config.panel_width))
        probe = camera_for(scenes, azimuth, config, size=size, margin=2.0)
        shown = np.stack([scene.mesh_of_pixel(probe).ravel() for scene in scenes])
        part = np.arange(len(moving))[:, None, None]
        at_rest, swept = (shown[0] == part[:, 0]).sum(axis=1), (shown == part).any(axis=1).sum(axis=1)
        # The root weighs large parts less, so that a knob counts beside a door.
        seen = float((np.sqrt(at_rest) + np.sqrt(swept)).sum())
        across = np.sqrt(1.0 - np.clip(axes @ probe.forward, -1.0, 1.0) ** 2)
        return seen * (1.0 - _AXIS_SHARE + _AXIS_SHARE * float(across.mean() if len(across) else 1.0))

    step = 2.0 * np.pi / config.azimuths
    return max((step * (index + _OFF_AXIS) for index in range(config.azimuths)), key=worth)


def _arrow_at_rest(
    model: KinematicModel, joint: Joint, diagonal: float, config: PreviewConfig
) -> tuple[FloatArray, IntArray]:
    """Arrow of a joint at zero configuration, world frame; beside its part's middle."""
    link = model.link_by_name[joint.child]
    axis = link.T_world_link[:3, :3] @ joint.axis
    used = link.part.vertices[link.part.faces.reshape(-1)]
    along = (used - link.T_world_link[:3, 3]) @ axis
    low, high = float(along.min()), float(along.max())
    # Arrows of many joints must leave room for each other.
    crowd = min(1.0, float(np.sqrt(config.chain_joints / len(moving_joints(model)))))
    shortest, longest = _ARROW_LENGTHS[0] * crowd * diagonal, _ARROW_LENGTHS[1] * diagonal
    radius = config.glyph_radius * crowd * diagonal
    if joint.kind is JointType.PRISMATIC:
        middle = 0.5 * (used.min(axis=0) + used.max(axis=0))
        length = min(max(high - low, 0.0) + 2.0 * _SLIDE_OVERHANG * crowd * diagonal, longest)
        return sliding_arrow(middle, axis, length, radius)
    center = link.T_world_link[:3, 3] + 0.5 * (low + high) * axis
    length = float(np.clip(_OVERHANG * (high - low), shortest, longest))
    return turning_arrow(center, axis, length, radius, _SWEEP[joint.kind])


def _diagonal(model: KinematicModel) -> float:
    low, high = box_around([link.part.bounds for link in model.links])
    return float(np.linalg.norm(high - low))


_SEGMENTS = 20  # around a shaft a few pixels thick
_ARC_STEPS = 48
_HEAD_RADIUS = 3.0  # all in radii of the shaft
_HEAD_LENGTH = 9.0
_ARC_RADIUS = 9.0
_ARC_THICKNESS = 0.75


def turning_arrow(center: FloatArray, axis: FloatArray, length: float, radius: float, sweep: float) -> Mesh:
    """An axis line with a circular arrow around its upper end, right-handed about the axis.

    Args:
        center: Middle of the line, world frame [m], shape (3,).
        axis: Unit direction, shape (3,).
        length: Of the line [m].
        radius: Of the line [m].
        sweep: Angle that the circular arrow covers [rad].
    """
    tip = center + 0.5 * length * axis
    tail = center - 0.5 * length * axis
    ring = tip - 0.12 * length * axis
    return as_one([_tube(np.stack([tail, tip]), np.full(2, radius)), _circular_arrow(ring, axis, radius, sweep)])


def sliding_arrow(center: FloatArray, axis: FloatArray, length: float, radius: float) -> Mesh:
    """A straight arrow with a head at each end, the larger one in the positive direction.

    Args:
        center: Middle, world frame [m], shape (3,).
        axis: Unit direction, shape (3,).
        length: From tip to tip [m].
        radius: Of the shaft [m].
    """
    tip, tail = center + 0.5 * length * axis, center - 0.5 * length * axis
    head = _HEAD_LENGTH * radius * axis
    path = np.stack([tail, tail + 0.7 * head, tail + 0.7 * head, tip - head, tip - head, tip])
    radii = radius * np.array([0.0, 0.7 * _HEAD_RADIUS, 1.0, 1.0, _HEAD_RADIUS, 0.0])
    return _tube(path, radii)


def _circular_arrow(center: FloatArray, axis: FloatArray, radius: float, sweep: float) -> Mesh:
    side = across(axis)
    ring = _ARC_RADIUS * radius
    head = 0.75 * _HEAD_LENGTH / _ARC_RADIUS  # [rad] along the ring
    angles = np.linspace(0.0, sweep - head, _ARC_STEPS)
    tips = np.linspace(sweep - head, sweep, 5)
    turns = np.concatenate([angles, tips])
    path = center + ring * (np.cos(turns)[:, None] * side + np.sin(turns)[:, None] * np.cross(axis, side))
    radii = np.concatenate([np.full(len(angles), _ARC_THICKNESS), np.linspace(0.85 * _HEAD_RADIUS, 0.0, len(tips))])
    return _tube(path, radii * radius)


def _tube(path: FloatArray, radii: FloatArray) -> Mesh:
    """A tube of changing radius along a path (n, 3) with flat ends."""
    tangents = np.gradient(path, axis=0)
    # Where a point is doubled (a step in radius) the neighbours still give a direction.
    tangents /= np.maximum(np.linalg.norm(tangents, axis=1, keepdims=True), 1e-300)
    turns = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS, endpoint=False)
    sides = np.empty_like(path)
    side = across(tangents[0])
    for index, tangent in enumerate(tangents):
        side = side - (side @ tangent) * tangent  # carried along the path, so that rings do not twist
        sides[index] = side = side / np.sqrt(side @ side)
    other = np.cross(tangents, sides)
    circles = np.cos(turns)[:, None] * sides[:, None] + np.sin(turns)[:, None] * other[:, None]
    rings = path[:, None] + radii[:, None, None] * circles
    vertices = np.concatenate([rings.reshape(-1, 3), path[:1], path[-1:]])
    return vertices, _tube_faces(len(path))


@cache
def _tube_faces(count: int) -> IntArray:
    ring = np.arange(_SEGMENTS)
    following = (ring + 1) % _SEGMENTS
    low = _SEGMENTS * np.arange(count - 1)[:, None] + ring
    beside, high = low - ring + following, low + _SEGMENTS
    sides = np.stack([low, beside, beside + _SEGMENTS, low, beside + _SEGMENTS, high], axis=2).reshape(-1, 3)
    foot = np.stack([following, ring, np.full(_SEGMENTS, count * _SEGMENTS)], axis=1)
    head = foot[:, [1, 0, 2]] + [(count - 1) * _SEGMENTS, (count - 1) * _SEGMENTS, 1]
    return np.concatenate([sides, foot, head])
