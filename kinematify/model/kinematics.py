"""Forward kinematics of a model: joint positions to link frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.model.kinematic_model import Joint, KinematicModel
    from kinematify.robot.arrays import FloatArray


def forward_kinematics(model: KinematicModel, q: Mapping[str, float]) -> dict[str, FloatArray]:
    """Pose of every link at a configuration.

    Args:
        model: The model; its root frame is the world frame of the input.
        q: Joint name -> position [rad or m]; joints that are left out stand at zero.

    Returns:
        Link name -> T_world_link, shape (4, 4).

    Raises:
        ValueError: `q` names a joint that the model lacks.
    """
    unknown = set(q) - {joint.name for joint in model.joints}
    if unknown:
        raise ValueError(f"The model {model.name} has no joint {', '.join(sorted(unknown))}.")
    T_world_link = {model.root: np.asarray(model.link_by_name[model.root].T_world_link)}
    by_parent: dict[str, list[Joint]] = {}
    for joint in model.joints:
        by_parent.setdefault(joint.parent, []).append(joint)
    queue = [model.root]
    for link in queue:
        for joint in by_parent.get(link, ()):
            motion = joint_motion(joint, q.get(joint.name, 0.0))
            T_world_link[joint.child] = T_world_link[link] @ joint.T_parent_child @ motion
            queue.append(joint.child)
    return T_world_link


def joint_motion(joint: Joint, position: float) -> FloatArray:
    """Transform of the child in the joint frame at a position [rad or m], shape (4, 4); identity when fixed."""
    motion = np.eye(4)
    if joint.kind.turns:
        motion[:3, :3] = _rotation(joint.axis, position)
    elif joint.kind is JointType.PRISMATIC:
        motion[:3, 3] = position * joint.axis
    return motion


def _rotation(axis: FloatArray, angle: float) -> FloatArray:
    """Rodrigues' formula for a unit axis and an angle [rad], shape (3, 3)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation: FloatArray = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return rotation
