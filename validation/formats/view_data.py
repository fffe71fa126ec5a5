"""The object as the viewer in a page takes it: decimated meshes, joints and limits as compact JSON."""

from __future__ import annotations

import base64
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, group_mesh, rest_configuration, rigid_groups
from kinematify.robot.transforms import transformed

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Joint, RigidGroup, Robot

    Poses = dict[str, FloatArray]

_FEWEST = 1000
"""Triangles that every body keeps: a small knob must not become a wedge beside a large cabinet."""
_STEPS = 65535
_SMALLEST = 1e-9
_BEGUN = 0.05
"""Share of the range at which it is looked where a part goes: a door on its whole way ends beside the object."""
_STEEP = 0.9
"""Vertical share of a motion from which it has no side."""
_ASIDE = 0.6
"""Camera beside the direction in which parts move [rad]: a drawer seen from its front hides its own way."""


def view_data(robot: Robot, *, faces: int, colors: Mapping[str, FloatArray]) -> dict[str, Any] | None:
    """Return the object as JSON values; None if it has no geometry.

    Args:
        robot: As described; meshes in link frames.
        faces: About how many triangles the whole may have.
        colors: Of every body by its top link, sRGB in [0, 1], shape (3,).
    """
    groups = rigid_groups(robot)
    T_root_link = forward_kinematics(robot, {joint.name: 0.0 for joint in robot.joints if joint.mimic is None})
    meshes = [group_mesh(robot, group, T_root_link) for group in groups]
    total = sum(len(f) for _, f in meshes)
    if not total:
        return None
    rest = rest_configuration(robot)
    low, high = _extent(robot, groups, meshes, rest)
    bodies = [
        {
            "links": list(group.links),
            "color": np.round(colors[group.top], 3).tolist(),
            **_placed(robot, groups, index, T_root_link),
            **_packed(*_decimated(vertices, triangles, share=faces / total)),
        }
        for index, (group, (vertices, triangles)) in enumerate(zip(groups, meshes, strict=True))
    ]
    return {
        "size": float(np.linalg.norm(high - low)) or 1.0,
        "center": (0.5 * (low + high)).tolist(),
        "turn": camera_turn(robot, groups, meshes, rest),
        "bodies": bodies,
        "joints": [_joint(joint, rest[joint.name]) for joint in _moving(robot)],
    }


def _extent(
    robot: Robot,
    groups: Sequence[RigidGroup],
    meshes: Sequence[tuple[FloatArray, IntArray]],
    rest: Mapping[str, float],
) -> tuple[FloatArray, FloatArray]:
    """Corners of the box around the object at rest, in the root's frame."""
    poses = forward_kinematics(robot, rest)
    points = np.concatenate(
        [transformed(vertices, poses[group.top]) for group, (vertices, _) in zip(groups, meshes, strict=True)]
    )
    return points.min(axis=0), points.max(axis=0)


def camera_turn(
    robot: Robot,
    groups: Sequence[RigidGroup],
    meshes: Sequence[tuple[FloatArray, IntArray]],
    rest: Mapping[str, float],
) -> float:
    """Return the turn of the camera [rad], so that it looks at the side towards which the parts move.

    Args:
        robot: As described.
        groups: Links that are held together.
        meshes: Of each, in the frame of its top link.
        rest: Configuration at rest.
    """
    limited = [j for j in robot.joints if j.mimic is None and math.isfinite(j.upper - j.lower)]
    begun = {j.name: rest[j.name] + _BEGUN * (_far_end(j, rest[j.name]) - rest[j.name]) for j in limited}
    poses = forward_kinematics(robot, rest), forward_kinematics(robot, {**rest, **begun})
    way = np.zeros(3)
    for group, (vertices, _) in zip(groups, meshes, strict=True):
        if len(vertices):
            start, end = (T[group.top][:3, :3] @ vertices.mean(axis=0) + T[group.top][:3, 3] for T in poses)
            step = end - start
            if abs(step[2]) > _STEEP * np.linalg.norm(step):
                # A lid rises: its free edge is opposite to its hinge, and that is the side that opens.
                joint = robot.joint_above.get(group.top)
                hinge = start if joint is None else poses[0][group.top][:3, 3]
                step = np.linalg.norm(step) * (start - hinge) / max(float(np.linalg.norm(start - hinge)), _SMALLEST)
            way += step
    away = float(np.arctan2(way[1], way[0])) if np.linalg.norm(way[:2]) > _SMALLEST else -0.5 * math.pi
    return away + _ASIDE - 0.5 * math.pi


def _far_end(joint: Joint, value: float) -> float:
    """The limit that is farther from a value."""
    return max(joint.lower, joint.upper, key=lambda end: abs(end - value))


def _placed(robot: Robot, groups: Sequence[RigidGroup], index: int, T_root_link: Poses) -> dict[str, Any]:
    """On which body a body hangs, by which joint, and where at zero; bodies stand behind those that carry them."""
    joint = robot.joint_above.get(groups[index].top)
    if joint is None:
        return {"parent": -1, "joint": -1, "T": np.eye(4).ravel().tolist()}
    parent = next(k for k, group in enumerate(groups) if joint.parent in group.links)
    T = np.linalg.inv(T_root_link[groups[parent].top]) @ T_root_link[joint.parent] @ joint.T_parent_child
    number = [item.name for item in _moving(robot)].index(joint.name)
    return {"parent": parent, "joint": number, "T": np.round(T, 9).ravel().tolist()}


def _moving(robot: Robot) -> list[Joint]:
    return [joint for joint in robot.joints_downward if joint.kind is not JointType.FIXED]


def _joint(joint: Joint, rest: float) -> dict[str, Any]:
    endless = joint.kind is JointType.CONTINUOUS or not math.isfinite(joint.upper - joint.lower)
    lower, upper = (-math.pi, math.pi) if endless else (joint.lower, joint.upper)
    mimic = joint.mimic
    return {
        "name": joint.name,
        "kind": "prismatic" if joint.kind is JointType.PRISMATIC else joint.kind.value,
        "axis": joint.axis.tolist(),
        "lower": lower,
        "upper": upper,
        "rest": rest,
        "mimic": None
        if mimic is None
        else {"joint": mimic.joint, "multiplier": mimic.multiplier, "offset": mimic.offset},
    }


def _decimated(vertices: FloatArray, faces: IntArray, *, share: float) -> tuple[FloatArray, IntArray]:
    """The same surface with about a share of its triangles, at least `_FEWEST`; small meshes stay as they are."""
    wanted = max(_FEWEST, int(share * len(faces)))
    if len(faces) <= wanted:
        return vertices, faces
    import fast_simplification  # noqa: PLC0415  # `kinematify view` starts without it

    unique, index = np.unique(vertices, axis=0, return_inverse=True)
    welded = index.reshape(-1)[faces]
    points, fewer = fast_simplification.simplify(unique, welded, target_count=wanted)
    if not len(fewer):  # better shown as it was
        return vertices, faces
    return np.asarray(points, dtype=np.float64), np.asarray(fewer, dtype=np.int64)


def _packed(vertices: FloatArray, faces: IntArray) -> dict[str, Any]:
    """Corners on a grid of 16 bits, both arrays in base64."""
    if not len(faces):
        return {"f": "", "v": "", "wide": False, "lo": [0.0] * 3, "step": [0.0] * 3}
    used, index = np.unique(faces, return_inverse=True)
    corners = vertices[used]
    low = corners.min(axis=0)
    step = np.maximum(np.ptp(corners, axis=0) / _STEPS, _SMALLEST)
    wide = len(used) > _STEPS
    return {
        "v": _base64(np.round((corners - low) / step).astype("<u2")),
        "f": _base64(index.reshape(-1).astype("<u4" if wide else "<u2")),
        "wide": wide,
        "lo": low.tolist(),
        "step": step.tolist(),
    }


def _base64(values: np.ndarray[Any, Any]) -> str:
    return base64.b64encode(values.tobytes()).decode("ascii")
