"""Where the file's kinematics put every link, for many configurations at once, and which links stand elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.validation.engines.loading import ENGINE_TITLES

if TYPE_CHECKING:
    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import DescribedJoint, RobotDescription
    from kinematify.validation.engines.configurations import Configurations
    from kinematify.validation.stage import OpenCheck


def link_poses(description: RobotDescription, rows: Configurations) -> FloatArray:
    """Return the pose of every link in every row, the root at the origin, shape (n, L, 4, 4)."""
    index = {name: k for k, name in enumerate(rows.links)}
    column = {name: k for k, name in enumerate(rows.joints)}
    poses = np.tile(np.eye(4), (len(rows.q), len(rows.links), 1, 1))
    for joint in description.joints_downward:
        values = rows.q[:, column[joint.name]] if joint.name in column else np.zeros(len(rows.q))
        poses[:, index[joint.child]] = poses[:, index[joint.parent]] @ joint.T_parent_child @ _motions(joint, values)
    return poses


def _motions(joint: DescribedJoint, values: FloatArray) -> FloatArray:
    """Transform of the child in the joint frame for every value [rad or m], shape (n, 4, 4)."""
    motions = np.tile(np.eye(4), (len(values), 1, 1))
    if joint.kind is JointType.PRISMATIC:
        motions[:, :3, 3] = values[:, None] * joint.axis
    elif joint.kind.turns:
        x, y, z = joint.axis
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        sine, versine = np.sin(values)[:, None, None], 1.0 - np.cos(values)[:, None, None]
        motions[:, :3, :3] += sine * cross + versine * (cross @ cross)
    return motions


def find_misplaced(
    check: OpenCheck,
    rows: Configurations,
    *,
    ours: FloatArray,
    theirs: FloatArray,
    size: float,
    settings: EngineSettings,
) -> None:
    """Add a finding for every link that an engine puts elsewhere.

    Args:
        check: Open, of the engine.
        rows: The configurations.
        ours: From `link_poses`.
        theirs: The engine's, of the same shape.
        size: Of the model [m].
        settings: The differences that are errors.
    """
    distance = np.linalg.norm(ours[..., :3, 3] - theirs[..., :3, 3], axis=-1)
    # Frobenius norm of a difference of rotations: 2 sqrt(2) sin(angle / 2); exact for small angles, unlike the trace.
    chord = np.linalg.norm(ours[..., :3, :3] - theirs[..., :3, :3], axis=(-2, -1)) / np.sqrt(8.0)
    angle = np.degrees(2.0 * np.arcsin(np.clip(chord, 0.0, 1.0)))
    check.measured |= {"rows": float(len(rows.q)), "distance": float(distance.max()), "angle_deg": float(angle.max())}
    share = np.maximum(distance / (settings.pose_distance * size), angle / settings.pose_deg)
    worst = np.argmax(share, axis=0)
    for link in np.flatnonzero(share.max(axis=0) > 1.0).tolist():
        row = int(worst[link])
        check.find(
            f"{ENGINE_TITLES[check.engine or '']} puts the link {rows.links[link]} {distance[row, link] * 1e3:.3g} mm "
            f"and {angle[row, link]:.3g} deg from where the file's kinematics put it.",
            f"Write origins and axes on the way to {rows.links[link]} as plain numbers, axes as unit vectors.",
            link=rows.links[link],
            q=rows.named(row),
            value=distance[row, link],
            limit=settings.pose_distance * size,
            unit="m",
        )
