"""Where the robot stands: places around the part, each with a grasp, the most promising first.

How promising a place is follows from how near the arm's own samples come to the poses that it must reach, which is
asked for all places at once.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.convex import convex_hull
from kinematify.manipulation.grasp import moved_bodies
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.robot.transforms import pose_at, transformed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config.planning_settings import PlanSettings
    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.grasp import Grasp
    from kinematify.manipulation.kinematics import Arm
    from kinematify.robot.arrays import FloatArray, IntArray

_FLIP = np.diag([-1.0, -1.0, 1.0, 1.0])  # half a turn about the approach direction holds as well
_GRASP_RANK, _PLACE_RANK = 0.01, 0.02  # dearness of one more try with the same grasp, or the same place [m]
_SINKS = 0.005  # a part that folds down gets so much lower than it was [m]
_ALIKE = np.cos(np.radians(30.0))
_COLUMN_WIDTH, _ON_FLOOR = 0.14, 0.01  # of what a robot stands on; lower ones stand on the floor [m]
_PLINTH = 0.4  # what swings down ends so far above the floor [m]: room for a hand below the handle of an oven door
_TABLETOP = 0.6  # what measures less along every axis stands on a table as high as a plinth [m]: laptops, boxes
_STEPS = 25  # poses in which a pull is planned, both ends included
_GRASPS, _PER_DIRECTION = 14, 3  # that are planned with, of nearly the same direction: the ends of a bar and its middle
_HEIGHT_STEP = 0.05  # columns have heights of multiples of this [m]
_FOOTPRINT = 0.16  # from the object at rest to the arm's base [m]: half of that and a hand's width
_PLACES = 480  # that are looked at closely, 2 to 20 ms each; with 160 it depends on the seed whether a house door opens
_QUALITY = 0.06  # a grasp of no quality at all may be so much easier to reach [m]


@dataclass(frozen=True, kw_only=True, eq=False)
class ObjectMotion:
    """The object while one of its joints moves and the others rest; world z is up, the floor at 0."""

    T_world_object: FloatArray
    """Root link, shape (4, 4)."""
    values: FloatArray
    """Of the joint [rad or m], from rest to the open end, shape (k,)."""
    link_poses: FloatArray
    """Child link of the joint, world frame, shape (k, 4, 4)."""
    body_poses: FloatArray
    """All bodies, frame of the root link, shape (k, B, 4, 4)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RobotPlacement:
    """A place of the robot with a grasp."""

    T_world_base: FloatArray
    """Root link of the robot, shape (4, 4)."""
    grasp: Grasp
    T_link_tool: FloatArray
    """The grasp or the same after half a turn, shape (4, 4)."""


def standing_at(x: float, y: float, z: float, yaw: float) -> FloatArray:
    """Pose of an upright robot at a place [m], turned by `yaw` [deg], shape (4, 4)."""
    T = np.eye(4)
    cosine, sine = np.cos(np.radians(yaw)), np.sin(np.radians(yaw))
    T[:2, :2] = [[cosine, -sine], [sine, cosine]]
    T[:3, 3] = x, y, z
    return T


def column_mesh(height: float) -> tuple[FloatArray, IntArray] | None:
    """Return what a robot stands on whose root link is so high [m], as pictures show it; None on the floor.

    Returns:
        Vertices in the frame of the root link [m], shape (8, 3), and faces, shape (12, 3).
    """
    if height < _ON_FLOOR:
        return None
    box = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-1.0, 0.0)])
    return convex_hull(box * [_COLUMN_WIDTH, _COLUMN_WIDTH, height])


def object_motion(scene: Scene, joint: str, end: float) -> ObjectMotion:
    """Stand the object in the world and move one joint from rest to a value.

    An object whose part swings down to the floor, such as an oven to be built in, stands on a plinth, and a small
    object on a table.

    Args:
        scene: The object, in metres.
        joint: One of its leading joints.
        end: Value at the end [rad or m].
    """
    leader = [travel.joint for travel in scene.travels].index(joint)
    values = np.linspace(scene.travels[leader].rest, end, _STEPS)
    rows = np.tile(scene.mechanism.rest, (_STEPS, 1))
    rows[:, leader] = values
    box = object_box(scene)
    body_poses = scene.poses(rows)
    lowest = np.array([_lowest(scene, joint, poses) for poses in body_poses])
    sinks = float(lowest.min()) < float(lowest[0]) - _SINKS
    raised = sinks or float(np.ptp(box, axis=0).max()) < _TABLETOP
    bottom = min(float(box[0, 2]), float(lowest.min()) - _PLINTH) if raised else float(box[0, 2])
    T_world_object = pose_at([*(-0.5 * box.sum(axis=0)[:2]), -bottom])
    names = [travel.joint for travel in scene.travels]
    child = scene.model.joint_by_name[joint].child
    links = [forward_kinematics(scene.model, dict(zip(names, row.tolist(), strict=True)))[child] for row in rows]
    return ObjectMotion(
        T_world_object=T_world_object,
        values=values,
        link_poses=T_world_object @ np.stack(links),
        body_poses=body_poses,
    )


def _lowest(scene: Scene, joint: str, poses: FloatArray) -> float:
    """Lowest point of what a joint moves, bodies at `poses` (B, 4, 4), frame of the root link [m]."""
    moved = [body for bodies in moved_bodies(scene, joint) for body in bodies]
    corners = [transformed(corners, poses[body])[:, 2].min() for body in moved for corners in scene.bodies[body].shapes]
    return float(min(corners, default=np.inf))


def object_box(scene: Scene) -> FloatArray:
    """Lowest and highest corner at rest, frame of the root link [m], shape (2, 3)."""
    corners = np.concatenate(
        [
            transformed(corners, T)
            for body, T in zip(scene.bodies, scene.at_rest, strict=True)
            for corners in body.shapes
        ]
    )
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


class Places:
    """All places of one robot beside one object."""

    def __init__(self, arm: Arm, motion: ObjectMotion, box: FloatArray, settings: PlanSettings) -> None:
        """Keep what is given.

        Args:
            arm: The robot.
            motion: What the hand must follow.
            box: Of the object at rest, frame of its root link [m], shape (2, 3).
            settings: Directions, distances and heights.
        """
        self._arm, self._motion, self._settings = arm, motion, settings
        self._box = box + motion.T_world_object[:3, 3]

    def ranked(self, grasps: Sequence[Grasp], given: FloatArray | None = None) -> list[RobotPlacement]:
        """Return the most promising pairs of place and grasp, the best first.

        Args:
            grasps: The best first.
            given: The robot stands there, shape (4, 4); anywhere if None.
        """
        found: list[tuple[float, int, int, RobotPlacement]] = []
        for number, grasp in enumerate(self._diverse(grasps)):
            for T_link_tool in (grasp.T_link_grasp, grasp.T_link_grasp @ _FLIP):
                tools = self._motion.link_poses[self._looked_at] @ T_link_tool
                bases = self._bases(tools[:, :3, 3].mean(axis=0)) if given is None else given[None]
                if not len(bases):
                    continue
                found += [
                    (far + _QUALITY * (1.0 - grasp.score), number, spot, RobotPlacement(
                        T_world_base=bases[spot], grasp=grasp, T_link_tool=T_link_tool))
                    for spot, far in enumerate(self._far(bases, tools))
                ]  # fmt: skip
        found.sort(key=lambda item: item[0])
        return [place for _, place in sorted(self._spread(found), key=lambda item: item[0])][:_PLACES]

    def _diverse(self, grasps: Sequence[Grasp]) -> list[Grasp]:
        """The best grasps, but of each approach direction a few: what one cannot follow, another one may."""
        chosen: list[Grasp] = []
        for grasp in grasps:
            approach = grasp.T_link_grasp[:3, 2]
            alike = sum(float(other.T_link_grasp[:3, 2] @ approach) > _ALIKE for other in chosen)
            if alike < _PER_DIRECTION:
                chosen.append(grasp)
        return chosen[:_GRASPS]

    def _spread(self, found: list[tuple[float, int, int, RobotPlacement]]) -> list[tuple[float, RobotPlacement]]:
        """Make further tries of the same grasp, or of the same place, dearer."""
        grasps, spots = Counter[int](), Counter[tuple[int, int]]()
        dearer = []
        for cost, grasp, spot, place in found:
            more = _GRASP_RANK * grasps[grasp] + _PLACE_RANK * spots[grasp, spot]
            grasps[grasp] += 1
            spots[grasp, spot] += 1
            dearer.append((cost + more, place))
        return dearer

    @property
    def _looked_at(self) -> list[int]:
        last = len(self._motion.values) - 1
        return [0, last // 2, last]

    def _far(self, bases: FloatArray, tools: FloatArray) -> list[float]:
        """For every base (n, 4, 4) how far the arm's samples are from the hardest pose of the tool (k, 4, 4)."""
        targets = np.linalg.inv(bases)[:, None] @ tools[None]
        far: list[float] = self._arm.distances(targets.reshape(-1, 4, 4)).reshape(len(bases), -1).max(axis=1).tolist()
        return far

    def _bases(self, middle: FloatArray) -> FloatArray:
        """Poses of the robot around a point, the arm facing it, clear of the object, shape (n, 4, 4)."""
        settings, arm = self._settings, self._arm
        found = []
        for bearing in 2.0 * np.pi * np.arange(settings.bearings) / settings.bearings:
            outward = np.array([np.cos(bearing), np.sin(bearing)])
            yaw = bearing + np.pi - arm.forward
            turned = standing_at(0.0, 0.0, 0.0, float(np.degrees(yaw)))
            for distance in settings.distances:
                place = middle[:2] + distance * arm.reach * outward - turned[:2, :2] @ arm.shoulder[:2]
                if not self._clear(place):
                    continue
                for height in self._heights(float(middle[2])):
                    T = turned.copy()
                    T[:3, 3] = *place, height
                    found.append(T)
        return np.stack(found) if found else np.empty((0, 4, 4))

    def _clear(self, place: FloatArray) -> bool:
        beyond = np.maximum(np.maximum(self._box[0, :2] - place, place - self._box[1, :2]), 0.0)
        return float(np.linalg.norm(beyond)) > _FOOTPRINT

    def _heights(self, level: float) -> list[float]:
        """Heights of the root link above the floor [m]."""
        if not self.on_column:
            return [self._standing]
        wanted = [level + share * self._arm.reach - float(self._arm.shoulder[2]) for share in self._settings.heights]
        return sorted({max(0.0, _HEIGHT_STEP * round(height / _HEIGHT_STEP)) for height in wanted})

    @cached_property
    def on_column(self) -> bool:
        """A robot that is nothing but an arm stands on a column; one with wheels or legs stands as it is."""
        robot = self._arm.robot
        own = {*robot.arm_joints, *robot.finger_joints}
        joints = self._arm.declared.joints
        return all(j.name in own or j.mimic is not None for j in joints if j.kind is not JointType.FIXED)

    @cached_property
    def _standing(self) -> float:
        """Height of the root link at which the robot's lowest point is on the floor [m]."""
        robot = self._arm.declared
        poses = forward_kinematics(robot, rest_configuration(robot))
        lowest = [
            transformed(mesh.vertices, poses[link.name])[:, 2].min()
            for link in robot.links
            for mesh in link.meshes
            if len(mesh.vertices)
        ]
        return -float(min(lowest, default=0.0))
