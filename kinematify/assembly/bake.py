"""A rigid group of links as one mesh in the world frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.appearance import joined
from kinematify.robot.mesh_file import RawMesh
from kinematify.robot.weld import weld

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import RigidGroup, Robot

_WELD = 1e-9
"""Vertices closer than this fraction of their mesh's diagonal are one: equal but for rounding."""


def baked(robot: Robot, group: RigidGroup, T_world_link: Mapping[str, FloatArray]) -> RawMesh:
    """Return all meshes of a group that has geometry as one, in the world frame [m].

    It is named after the group's first link with geometry: those above it are frames such as ``world``.

    Args:
        robot: The robot.
        group: One of its rigid groups.
        T_world_link: Pose of every link, shape (4, 4).
    """
    name = next(link for link in group.links if robot.link_by_name[link].has_geometry)
    vertices, faces, looks, count = [], [], [], 0
    for link in group.links:
        transform = T_world_link[link]
        for mesh in robot.link_by_name[link].meshes:
            # Welded in the link frame, where equal vertices are still equal to the last digit.
            points, triangles, kept = weld(mesh.vertices, mesh.faces, _WELD)
            vertices.append(points @ transform[:3, :3].T + transform[:3, 3])
            faces.append(triangles + count)
            looks.append(None if mesh.appearance is None else mesh.appearance.of_faces(kept))
            count += len(points)
    return RawMesh(
        name=name,
        vertices=np.concatenate(vertices),
        faces=np.concatenate(faces),
        appearance=joined(looks, [len(part) for part in faces]),
    )
