"""The model behind the viewer: where its bodies stand, what they touch, and which joints are tried instead."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import Overlap
from kinematify.geometry.rest import Allowance
from kinematify.geometry.scene import read_scene, relative
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import (
    forward_kinematics,
    joint_values,
    rest_configuration,
    rigid_groups,
)
from kinematify.robot.transforms import joint_motion, rotation_about
from kinematify.validation.formats.view_data import camera_turn

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config.validation import ValidationSettings
    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Joint, RigidGroup, Robot
    from kinematify.view.alternatives import Alternative

_ARC_STEPS = 24


@dataclass(frozen=True, kw_only=True)
class Touch:
    """Two bodies whose surfaces meet in a configuration."""

    pair: tuple[str, str]
    """Top links of their groups."""
    depth: float
    """[m]."""
    tolerated: bool
    """They touch as deep at rest, or as deep as a bearing does."""


class ViewScene:
    """A model with the joints that are tried."""

    def __init__(self, robot: Robot, settings: ValidationSettings) -> None:
        """Keep the robot; collisions are prepared when first asked for."""
        self.robot = robot
        self._settings = settings
        self._tried: dict[str, Alternative] = {}

    @cached_property
    def groups(self) -> tuple[RigidGroup, ...]:
        """Links that fixed joints hold together."""
        return rigid_groups(self.robot)

    @cached_property
    def rest(self) -> dict[str, float]:
        """Value of every joint at rest [rad or m]."""
        return rest_configuration(self.robot)

    @cached_property
    def leaders(self) -> tuple[Joint, ...]:
        """Joints that have a slider."""
        return self.robot.leaders

    @cached_property
    def size(self) -> float:
        """Diagonal of the box around the model at rest [m]."""
        poses = self.poses(self.rest)
        points = [vertices @ T[:3, :3].T + T[:3, 3] for T, (vertices, _) in self._placed(poses) if len(vertices)]
        return float(np.linalg.norm(np.ptp(np.concatenate(points), axis=0))) if points else 1.0

    @cached_property
    def camera(self) -> tuple[FloatArray, FloatArray]:
        """Where to look from, and at what, shape (3,) each [m]: towards the side to which parts move."""
        poses = self.poses(self.rest)
        points = [vertices @ T[:3, :3].T + T[:3, 3] for T, (vertices, _) in self._placed(poses) if len(vertices)]
        corners = np.concatenate(points) if points else np.zeros((1, 3))
        center: FloatArray = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
        turn = camera_turn(self.robot, self.groups, list(self.meshes.values()), self.rest) + 0.5 * np.pi
        eye = center + 1.3 * self.size * np.array([np.cos(turn), np.sin(turn), 0.5])
        return eye, center

    @cached_property
    def meshes(self) -> dict[str, tuple[FloatArray, IntArray]]:
        """Vertices (V, 3) and faces (F, 3) of every group, in the frame of its top link, keyed by that."""
        zero = forward_kinematics(self.robot, {})
        return {group.top: self._mesh(group, zero) for group in self.groups}

    def range_of(self, joint: Joint) -> tuple[float, float]:
        """Ends of a slider [rad or m]: the limits, or half a turn either way where there are none."""
        if joint.kind is JointType.CONTINUOUS or not math.isfinite(joint.upper - joint.lower):
            return -math.pi, math.pi
        return joint.lower, joint.upper

    def try_joint(self, joint: str, alternative: Alternative | None) -> None:
        """Move a joint as an alternative says; None: as the file says."""
        if alternative is None:
            self._tried.pop(joint, None)
        else:
            self._tried[joint] = alternative

    def poses(self, q: Mapping[str, float]) -> dict[str, FloatArray]:
        """Pose of every link in the frame of the root link, shape (4, 4) each.

        Args:
            q: Leader -> value [rad or m].
        """
        values = joint_values(self.robot, q)
        poses: dict[str, FloatArray] = {self.robot.root: np.eye(4)}
        for joint in self.robot.joints_downward:
            motion = self._motion(joint, values[joint.name])
            poses[joint.child] = poses[joint.parent] @ joint.T_parent_child @ motion
        return poses

    def touches(self, q: Mapping[str, float]) -> list[Touch]:
        """Pairs that meet in a configuration, those that are not tolerated first.

        Args:
            q: Leader -> value [rad or m].
        """
        scene, overlap, allowance = self._collisions
        poses = self.poses(q)
        tops = [self.groups[body.group].top for body in scene.bodies]
        placed = np.stack([poses[top] for top in tops])[None] if tops else np.zeros((1, 0, 4, 4))
        found = []
        for pair in scene.pairs:
            T = relative(placed, pair)
            if not (overlap.collide(pair, T)[0] or overlap.may_contain(pair, T)[0]):
                continue
            depth = float(overlap.depth(pair, T)[0])
            tolerated = depth <= allowance.at_rest(pair) + allowance.tolerance(pair)
            found.append(Touch(pair=(tops[pair[0]], tops[pair[1]]), depth=depth, tolerated=tolerated))
        return sorted(found, key=lambda touch: (touch.tolerated, -touch.depth))

    def glyph(self, joint: Joint) -> FloatArray:
        """Line segments of a joint's axis and range in the frame of the joint at zero, shape (n, 2, 3) [m]."""
        axis, pivot, kind = self._axis(joint)
        reach = 0.18 * self.size
        lower, upper = self.range_of(joint)
        line = np.array([[pivot - reach * axis, pivot + reach * axis]])
        if kind is JointType.PRISMATIC:
            return np.array([[pivot + lower * axis, pivot + upper * axis], *self._ends(pivot, axis, lower, upper)])
        side = _across(axis)
        ring = [pivot + 0.5 * reach * (rotation_about(axis, a) @ side) for a in np.linspace(lower, upper, _ARC_STEPS)]
        arc = np.stack([np.array(ring[:-1]), np.array(ring[1:])], axis=1)
        spokes = np.array([[pivot, ring[0]], [pivot, ring[-1]]])
        return np.concatenate([line, arc, spokes])

    def _ends(self, pivot: FloatArray, axis: FloatArray, lower: float, upper: float) -> list[list[FloatArray]]:
        """Short strokes across a slide's axis at both limits."""
        stroke = 0.03 * self.size * _across(axis)
        return [[pivot + end * axis - stroke, pivot + end * axis + stroke] for end in (lower, upper)]

    def _axis(self, joint: Joint) -> tuple[FloatArray, FloatArray, JointType]:
        """Axis and a point on it in the joint's frame, and the type, as tried or as in the file."""
        tried = self._tried.get(joint.name)
        if tried is None:
            return joint.axis, np.zeros(3), joint.kind
        T_joint_root = np.linalg.inv(self._zero[joint.child])
        return T_joint_root[:3, :3] @ tried.axis, T_joint_root[:3, :3] @ tried.pivot + T_joint_root[:3, 3], tried.kind

    def _motion(self, joint: Joint, value: float) -> FloatArray:
        if joint.name not in self._tried:
            return joint.motion(value)
        axis, pivot, kind = self._axis(joint)
        return joint_motion(kind, axis, pivot, value)

    @cached_property
    def _zero(self) -> dict[str, FloatArray]:
        return forward_kinematics(self.robot, {})

    @cached_property
    def _collisions(self) -> tuple[Scene, Overlap, Allowance]:
        scene = read_scene(self.robot, self._settings.geometry)
        overlap = Overlap(scene)
        return scene, overlap, Allowance(scene, overlap)

    def _mesh(self, group: RigidGroup, zero: Mapping[str, FloatArray]) -> tuple[FloatArray, IntArray]:
        vertices, faces, start = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], 0
        T_top_root = np.linalg.inv(zero[group.top])
        for link in group.links:
            T = T_top_root @ zero[link]
            for mesh in self.robot.link_by_name[link].meshes:
                vertices.append(mesh.vertices @ T[:3, :3].T + T[:3, 3])
                faces.append(mesh.faces + start)
                start += len(mesh.vertices)
        return np.concatenate(vertices), np.concatenate(faces)

    def _placed(self, poses: Mapping[str, FloatArray]) -> list[tuple[FloatArray, tuple[FloatArray, IntArray]]]:
        return [(poses[top], mesh) for top, mesh in self.meshes.items()]


def _across(axis: FloatArray) -> FloatArray:
    """A unit direction perpendicular to an axis."""
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    across = np.cross(axis, other)
    unit: FloatArray = across / np.linalg.norm(across)
    return unit
