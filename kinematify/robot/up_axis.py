"""Which way COLLADA meshes stand: readers differ in whether they heed the up axis of a file, and so do authors."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.robot import UpAxis, forward_kinematics, rest_configuration

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import LinkMesh, Robot

_CLOSES = 0.25
"""The axis is heeded where that leaves less than this share of the gaps."""
_GAP = 0.01
"""Where gaps are smaller than this fraction of the model's size, nothing speaks against the usual reading."""
_POINTS = 800
"""Points of a link that gaps are measured between."""


def upright_reading(ignored: Robot, heeded: Robot) -> Robot:
    """Return the reading of a model in which its links meet, with what was measured.

    Over the published models that state such an axis, links meet with it ignored in five files of six, as RViz reads
    them; in the sixth they are a tenth of the model apart that way.

    Args:
        ignored: The model with all meshes as their numbers stand.
        heeded: The same with meshes turned upright whose files say that they lie.
    """
    apart = _mean_gap(ignored), _mean_gap(heeded)
    size = float(np.linalg.norm(np.ptp(np.concatenate(list(_points(ignored).values())), axis=0)))
    closes = apart[1] < _CLOSES * apart[0] and apart[0] > _GAP * size
    reading = UpAxis(heeded=closes, gap_ignored=apart[0], gap_heeded=apart[1])
    if not closes:
        return replace(ignored, up_axis=reading)
    note = "The up axis that COLLADA meshes state is heeded, because the links meet only then."
    return replace(heeded, notes=(*heeded.notes, note), up_axis=reading)


def _mean_gap(robot: Robot) -> float:
    """Mean distance at rest of links from what carries them [m]; 0 where nothing carries anything."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second, and few files state an axis

    points, gaps = _points(robot), []
    for joint in robot.joints:
        parent = joint.parent
        while parent not in points and parent in robot.joint_above:
            parent = robot.joint_above[parent].parent
        if parent in points and joint.child in points:
            gaps.append(float(cKDTree(points[parent]).query(points[joint.child])[0].min()))
    return float(np.mean(gaps)) if gaps else 0.0


def _points(robot: Robot) -> dict[str, FloatArray]:
    """Return points on what is seen of each link at rest, in the frame of the root [m], shape (k, 3) each."""
    poses = forward_kinematics(robot, rest_configuration(robot))
    points = {}
    for link in robot.links:
        on = [_on_surface(shape.mesh) for shape in link.visuals or link.collisions if len(shape.mesh.faces)]
        if on:
            T_root_link = poses[link.name]
            points[link.name] = np.concatenate(on) @ T_root_link[:3, :3].T + T_root_link[:3, 3]
    return points


def _on_surface(mesh: LinkMesh) -> FloatArray:
    """Return points drawn uniformly by area, the same on the same faces wherever they stand [m], shape (k, 3)."""
    draw = np.random.default_rng(0)
    corners = mesh.vertices[mesh.faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    if not areas.sum() > 0.0:
        return mesh.vertices[:_POINTS]
    face = corners[draw.choice(len(areas), _POINTS, p=areas / areas.sum())]
    root, share = np.sqrt(draw.random((_POINTS, 1))), draw.random((_POINTS, 1))
    points: FloatArray = face[:, 0] * (1.0 - root) + face[:, 1] * root * (1.0 - share) + face[:, 2] * root * share
    return points
