"""The model behind the viewer: where its bodies stand, what they touch, and which joints are tried instead."""

from __future__ import annotations

import colorsys
import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.appearance import Material, joined, plain, surfaces
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import (
    forward_kinematics,
    group_mesh,
    joint_values,
    rest_configuration,
    rigid_groups,
)
from kinematify.robot.transforms import across, joint_motion, rotation_about, transformed
from kinematify.robot.vectors import box_around
from kinematify.validation.formats.view_data import camera_turn

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from kinematify.geometry.rest_pairs import DepthAllowance
    from kinematify.geometry.scene import Scene
    from kinematify.render.picture import PosedMesh
    from kinematify.robot.appearance import Appearance, Rgba, Surface
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Joint, RigidGroup, Robot
    from kinematify.view.alternatives import JointAlternative

_ARC_STEPS = 24
_SWEEP = 36


class ViewScene:
    """A model with the joints that are tried."""

    def __init__(self, robot: Robot, read_solid: Callable[[], Robot] | None = None) -> None:
        """Keep the robot; collisions are prepared when first asked for.

        Args:
            robot: What is seen.
            read_solid: Reads the robot with its collision geometry; None: `robot` has it.
        """
        self.robot = robot
        self._read_solid = read_solid or (lambda: robot)
        self._tried: dict[str, JointAlternative] = {}

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
        low, high = self.extent(self.rest)
        return float(np.linalg.norm(high - low)) or 1.0

    def extent(self, q: Mapping[str, float]) -> FloatArray:
        """Return the corners of the model in a configuration, frame of the root link [m], shape (2, 3)."""
        return box_around(list(self._corners(q).values()) or np.zeros((1, 2, 3)))

    def _corners(self, q: Mapping[str, float]) -> dict[str, FloatArray]:
        """Lower and upper corner of every group in a configuration, frame of the root link [m], shape (2, 3) each."""
        poses = self.poses(q)
        placed = {top: transformed(points, poses[top]) for top, (points, _) in self.meshes.items() if len(points)}
        return {top: np.stack([points.min(axis=0), points.max(axis=0)]) for top, points in placed.items()}

    @cached_property
    def camera(self) -> tuple[FloatArray, FloatArray]:
        """Where to look from, and at what, shape (3,) each [m]: towards the side to which parts move."""
        center: FloatArray = self.extent(self.rest).mean(axis=0)
        turn = camera_turn(self.robot, self.groups, list(self.meshes.values()), self.rest) + 0.5 * np.pi
        eye = center + 1.0 * self.size * np.array([np.cos(turn), np.sin(turn), 0.5])
        return eye, center

    @cached_property
    def meshes(self) -> dict[str, tuple[FloatArray, IntArray]]:
        """Vertices (V, 3) and faces (F, 3) of every group, in the frame of its top link, keyed by that."""
        return {group.top: self._mesh(group)[:2] for group in self.groups}

    @cached_property
    def surfaces(self) -> dict[str, tuple[Surface, ...]]:
        """Return what is seen of every group by material, in the frame of its top link, keyed by that.

        Where the model states no colour at all, every group has one of its own.
        """
        return {
            top: surfaces(vertices, faces, appearance or plain(color, len(faces)))
            for top, vertices, faces, appearance, color in self._bodies
        }

    def posed(self, q: Mapping[str, float]) -> tuple[PosedMesh, ...]:
        """Return what is seen of every group in a configuration, frame of the root link, for pictures."""
        from kinematify.render.picture import PosedMesh  # noqa: PLC0415  # loads the ray caster

        poses = self.poses(q)
        return tuple(
            PosedMesh(
                vertices=transformed(vertices, poses[top]),
                faces=faces,
                color=np.array(color[:3]),
                appearance=appearance,
            )
            for top, vertices, faces, appearance, color in self._bodies
        )

    @cached_property
    def _bodies(self) -> list[tuple[str, FloatArray, IntArray, Appearance | None, Rgba]]:
        """Groups that are seen: top link, vertices, faces, appearance, and the colour of what states none."""
        stated = any(mesh.appearance is not None for link in self.robot.links for mesh in link.meshes)
        return [
            (group.top, *mesh, Material().color if stated else _color(index))
            for index, group in enumerate(self.groups)
            if len((mesh := self._mesh(group))[1])
        ]

    @cached_property
    def bounds(self) -> dict[str, FloatArray]:
        """Lower and upper corner of every group at zero, frame of the root link [m], shape (2, 3) each."""
        return self._corners({})

    def group_of(self, link: str) -> str:
        """Top link of the group that holds a link."""
        return next(group.top for group in self.groups if link in group.links)

    @cached_property
    def ground(self) -> float:
        """Height of the lowest point at rest, frame of the root link [m]."""
        return float(self.extent(self.rest)[0, 2])

    def range_of(self, joint: Joint) -> tuple[float, float]:
        """Ends of a slider [rad or m]: the limits, or half a turn either way where there are none.

        A joint that is tried as another type may turn by a quarter, or slide by half of the model's size, either way.
        """
        tried = self._tried.get(joint.name)
        if tried is not None and tried.limits is not None:
            return tried.limits
        if tried is not None and tried.kind.turns != joint.kind.turns:
            reach = 0.5 * math.pi if tried.kind.turns else 0.5 * self.size
            return -reach, reach
        if self.kind_of(joint) is JointType.CONTINUOUS or not math.isfinite(joint.upper - joint.lower):
            return -math.pi, math.pi
        return joint.lower, joint.upper

    def kind_of(self, joint: Joint) -> JointType:
        """Type of a joint as it is tried, or as in the file."""
        tried = self._tried.get(joint.name)
        return joint.kind if tried is None else tried.kind

    @property
    def tried_joints(self) -> tuple[str, ...]:
        """Joints that do not move as the file says."""
        return tuple(self._tried)

    def tried(self, joint: str) -> JointAlternative | None:
        """Return what a joint is tried as; None: as the file says."""
        return self._tried.get(joint)

    def line_of(self, joint: Joint) -> tuple[FloatArray, FloatArray]:
        """Axis and a point on it, as tried or as in the file, frame of the root link at zero [m], shape (3,) each."""
        tried = self._tried.get(joint.name)
        return self.line_in_file(joint) if tried is None else (tried.axis, tried.pivot)

    def line_in_file(self, joint: Joint) -> tuple[FloatArray, FloatArray]:
        """Axis and a point on it as in the file, frame of the root link at zero [m], shape (3,) each."""
        T = self._zero[joint.child]
        return T[:3, :3] @ joint.axis, T[:3, 3]

    def try_joint(self, joint: str, alternative: JointAlternative | None) -> None:
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

    def prepare_collisions(self) -> None:
        """Read the collision geometry, which `touches` does else when it is first asked.

        Raises:
            InputError: It cannot be read.
        """
        _ = self._collisions

    def touches(self, q: Mapping[str, float]) -> list[tuple[tuple[str, str], float, bool]]:
        """Pairs whose surfaces meet in a configuration, those that are not tolerated first.

        Args:
            q: Leader -> value [rad or m].

        Returns:
            Of each pair the top links of both groups, the depth [m], and whether it is tolerated: they touch as deep at
            rest, or as deep as a bearing does.
        """
        scene, allowance = self._collisions
        poses = self.poses(q)
        tops = [self.groups[body.group].top for body in scene.bodies]
        placed = np.array([poses[top] for top in tops])
        meeting = allowance.meeting(placed)
        found = [((tops[a], tops[b]), depth, tolerated) for (a, b), depth, tolerated in meeting]
        return sorted(found, key=lambda touch: (touch[2], -touch[1]))

    def free_range(self, joint: Joint) -> tuple[float, float]:
        """Return how far a joint moves as it is tried until something collides, all others at rest [rad or m].

        Looked for in `_SWEEP` steps from zero to half a turn, or by the model's size, in both directions.
        """
        turns = self.kind_of(joint).turns
        reach = math.pi if turns else self.size
        ends = []
        for direction in (-1.0, 1.0):
            free = 0.0
            for step in range(1, _SWEEP + 1):
                value = direction * reach * step / _SWEEP
                if not all(tolerated for *_, tolerated in self.touches({**self.rest, joint.name: value})):
                    break
                free = value
            ends.append(free)
        if ends[0] == ends[1]:
            return self.range_of(joint)
        return ends[0], ends[1]

    def glyph(self, joint: Joint) -> FloatArray:
        """Line segments of a joint's axis and range in the frame of the joint at zero, shape (n, 2, 3) [m]."""
        axis, pivot, kind = self._axis(joint)
        if kind is JointType.FIXED:
            return np.array([[pivot, pivot]])
        reach = 0.18 * self.size
        lower, upper = self.range_of(joint)
        line = np.array([[pivot - reach * axis, pivot + reach * axis]])
        if kind is JointType.PRISMATIC:
            return np.array([[pivot + lower * axis, pivot + upper * axis], *self._ends(pivot, axis, lower, upper)])
        side = across(axis)
        ring = [pivot + 0.5 * reach * (rotation_about(axis, a) @ side) for a in np.linspace(lower, upper, _ARC_STEPS)]
        arc = np.stack([np.array(ring[:-1]), np.array(ring[1:])], axis=1)
        spokes = np.array([[pivot, ring[0]], [pivot, ring[-1]]])
        return np.concatenate([line, arc, spokes])

    def _ends(self, pivot: FloatArray, axis: FloatArray, lower: float, upper: float) -> list[list[FloatArray]]:
        """Short strokes across a slide's axis at both limits."""
        stroke = 0.03 * self.size * across(axis)
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
    def _collisions(self) -> tuple[Scene, DepthAllowance]:
        from kinematify.config.validation import load_settings  # noqa: PLC0415  # what is seen first needs none of these
        from kinematify.geometry.overlap import OverlapQueries  # noqa: PLC0415
        from kinematify.geometry.rest_pairs import DepthAllowance  # noqa: PLC0415
        from kinematify.geometry.scene import read_scene  # noqa: PLC0415

        scene = read_scene(self._read_solid(), load_settings().geometry)
        return scene, DepthAllowance(scene, OverlapQueries(scene))

    def _mesh(self, group: RigidGroup) -> tuple[FloatArray, IntArray, Appearance | None]:
        meshes = [mesh for link in group.links for mesh in self.robot.link_by_name[link].meshes]
        looks = joined([mesh.appearance for mesh in meshes], [len(mesh.faces) for mesh in meshes])
        return *group_mesh(self.robot, group, self._zero), looks


def _color(index: int) -> Rgba:
    """A light grey for the root, then hues that differ from one body to the next, sRGB and opacity."""
    if index == 0:
        return 0.78, 0.77, 0.75, 1.0
    return *colorsys.hls_to_rgb((0.08 + 0.61803398875 * index) % 1.0, 0.62, 0.5), 1.0
