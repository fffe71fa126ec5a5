"""Load on fingers that hold by friction.

Engines see a part as convex pieces that may reach millimetres beyond its surface, which closes the gap behind a handle.
Fingers that hold by friction therefore act on one piece only: what lies between the pads of the exact part, as one
convex body. That they have room beside the part was looked at with its true surface.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from trimesh.intersections import slice_faces_plane

from kinematify.geometry.convex import convex_hull, thickened
from kinematify.geometry.scene import judged_shapes
from kinematify.manipulation.grasp_search import FINGER_WIDTH
from kinematify.robot.robot import fixed_together, forward_kinematics
from kinematify.robot.transforms import transformed
from kinematify.robot.vectors import referenced

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.manipulation.grasp import Grasp
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot

_THIN = 1e-3  # sheets are made so thick [m]


def grip_piece(model: Robot, link: str, values: Mapping[str, float], grasp: Grasp) -> tuple[FloatArray, IntArray]:
    """Cut out what lies between the pads and return its convex hull.

    Args:
        model: The object.
        link: Link in whose frame the grasp is stated.
        values: Leading joints of the object [rad or m].
        grasp: How it is held.

    Returns:
        Vertices in the frame of the link [m], shape (V, 3), and faces (F, 3). Where nothing lies between the pads, a
        block as thick as the grasp says.
    """
    high = np.array([0.5 * FINGER_WIDTH, 0.5 * grasp.spread, 0.5 * FINGER_WIDTH])
    low = -high
    back = np.asarray(np.linalg.inv(grasp.T_link_grasp), dtype=np.float64)
    points = _clipped(transformed(_triangles(model, link, grasp.held, values), back), low, high)
    if not len(points):
        size = np.array([high[0], 0.5 * grasp.width, high[2]])
        points = size * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    vertices, faces = convex_hull(thickened(points, _THIN))
    return transformed(vertices, grasp.T_link_grasp), faces


def _triangles(model: Robot, link: str, held: str, values: Mapping[str, float]) -> FloatArray:
    """Corners of all faces of the held body, frame of the link, shape (F, 3, 3)."""
    poses = forward_kinematics(model, values)
    found = [np.empty((0, 3, 3))]
    for name in fixed_together(model, held):
        declared = model.link_by_name[name]
        T = np.linalg.inv(poses[link]) @ poses[name]
        for shape in judged_shapes(declared):
            found.append(transformed(shape.mesh.vertices, T)[shape.mesh.faces])
    return np.concatenate(found)


def _clipped(triangles: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Corners of what is left of triangles (F, 3, 3) inside a box, shape (n, 3)."""
    vertices, faces = triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)
    for normal, bound in zip((*np.eye(3), *-np.eye(3)), (*low, *-high), strict=True):
        vertices, faces, _ = slice_faces_plane(vertices, faces, normal, bound * normal)  # type: ignore[no-untyped-call]
    return np.asarray(referenced(vertices, faces))
