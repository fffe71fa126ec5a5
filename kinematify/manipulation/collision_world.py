"""Arm, object and floor as one collision world (coal through Pinocchio): who hits whom in a configuration.

Parts of the robot are primitives or convex hulls, those of the object its exact triangles. Everything is posed in the
frame of the robot's root link, since that is where Pinocchio has the arm.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import coal
import numpy as np
import pinocchio as pin

from kinematify.geometry.convex import convex_piece
from kinematify.geometry.scene import judged_shapes
from kinematify.manipulation.grasp import moved_bodies
from kinematify.manipulation.manipulator import hand_links
from kinematify.robot.robot import rigid_groups
from kinematify.robot.transforms import pose_at
from kinematify.robot.vectors import referenced

if TYPE_CHECKING:
    from collections.abc import Iterable

    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.kinematics import Arm
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot, Shape

FLOOR, COLUMN = "the floor", "the column"
_FAR = 50.0  # half of the floor's extent [m]
_COLUMN = (0.16, 0.16, 4.0)  # of which the upper part stands above the floor [m]
_GAP = 0.002  # between the column and what stands on it [m]
_THICKNESS, _DIRECTIONS = 1e-4, 200  # of hulls: flat parts are so thick [m], large ones keep so many corners
_ALWAYS = 0.9  # parts of the robot that collide in more than this share of configurations are built that way
_SAMPLES = 60  # configurations for what the robot's own parts always do


@dataclass(frozen=True, kw_only=True)
class Hit:
    """Two things in collision; links of the robot first."""

    kind: str
    """``self``, ``object`` or ``floor``."""
    first: str
    second: str


class CollisionWorld:
    """One arm and one object."""

    def __init__(self, arm: Arm, scene: Scene, joint: str, margin: float) -> None:
        """Gather the geometry; the robot stands at the origin until it is placed.

        Args:
            arm: The robot.
            scene: The object, in metres.
            joint: Joint of the object that is to be moved.
            margin: Between arm and object, without the hand [m].
        """
        self._arm = arm
        self._geometry = pin.GeometryModel()
        self._links: list[str] = []
        self._add_robot(arm.declared)
        robots = len(self._links)
        self._add_object(scene)
        self._bodies = range(robots, len(self._links))
        self._floor = self._add(FLOOR, coal.Box(2.0 * _FAR, 2.0 * _FAR, 2.0))
        self._column = self._add(COLUMN, coal.Box(*_COLUMN))
        moved = {robots + body for bodies in moved_bodies(scene, joint) for body in bodies}
        hand_names = hand_links(arm.declared, arm.robot)
        hand = {k for k in range(robots) if self._links[k] in hand_names}
        pairs = list(self._pairs(range(robots), hand, moved))
        for first, second, _, _ in pairs:
            self._geometry.addCollisionPair(pin.CollisionPair(first, second))
        self._kinds = [kind for _, _, kind, _ in pairs]
        self._free = pin.GeometryData(self._geometry)
        self._holding = pin.GeometryData(self._geometry)
        for k, (first, _, kind, held) in enumerate(pairs):
            for data in (self._free, self._holding):
                data.collisionRequests[k].security_margin = margin if kind == "object" and first not in hand else 0.0
            if held:
                self._holding.deactivateCollisionPair(k)
        self._data = arm.model.createData()
        self.place(np.eye(4), np.eye(4), column=False)
        self._leave_out_what_always_collides()
        self._gap = arm.robot.opening

    def place(self, T_world_base: FloatArray, T_world_object: FloatArray, *, column: bool) -> None:
        """Stand the robot somewhere, on a column if it has one; world z is up and the floor at 0."""
        back = np.linalg.inv(T_world_base)
        self._T_base_object = back @ T_world_object
        height = float(T_world_base[2, 3])
        self._put(self._floor, back @ pose_at([*T_world_base[:2, 3], -1.0 - _GAP]))
        standing = column and height > 0.0
        middle = -_GAP - 0.5 * _COLUMN[2] if standing else -10.0 * _FAR
        self._put(self._column, pose_at([0.0, 0.0, middle]))

    def pose_object(self, poses: FloatArray, gap: float) -> None:
        """Pose the bodies of the object, frame of its root, shape (B, 4, 4), and open the fingers [m]."""
        self._gap = gap
        for index, pose in zip(self._bodies, poses, strict=True):
            self._put(index, self._T_base_object @ pose)

    def free(self, q: FloatArray, *, holding: bool) -> bool:
        """True if nothing collides; what the hand holds may touch the hand."""
        data = self._holding if holding else self._free
        values = self._arm.full(q, self._gap)
        return not bool(pin.computeCollisions(self._arm.model, self._data, self._geometry, data, values, True))

    def hit(self, q: FloatArray, *, holding: bool) -> Hit | None:
        """Say what collides, if anything does."""
        data = self._holding if holding else self._free
        values = self._arm.full(q, self._gap)
        if not pin.computeCollisions(self._arm.model, self._data, self._geometry, data, values, True):
            return None
        for k, pair in enumerate(self._geometry.collisionPairs):
            if data.activeCollisionPairs[k] and data.collisionResults[k].isCollision():
                return Hit(kind=self._kinds[k], first=self._links[pair.first], second=self._links[pair.second])
        return None

    def _put(self, index: int, T: FloatArray) -> None:
        self._geometry.geometryObjects[index].placement = pin.SE3(T)

    def _add(self, name: str, shape: coal.CollisionGeometry, joint: int = 0, T: FloatArray | None = None) -> int:
        placement = pin.SE3.Identity() if T is None else pin.SE3(T)
        self._links.append(name)
        return int(
            self._geometry.addGeometryObject(pin.GeometryObject(f"{len(self._links)} {name}", joint, placement, shape))
        )

    def _add_robot(self, declared: Robot) -> None:
        model = self._arm.model
        for link in declared.links:
            frame = model.frames[model.getFrameId(link.name)]
            for shape in judged_shapes(link):
                found = _convex(shape)
                if found is not None:
                    T = np.asarray(frame.placement.homogeneous) @ found[1]
                    self._add(link.name, found[0], int(frame.parentJoint), T)

    def _add_object(self, scene: Scene) -> None:
        for body in scene.bodies:
            self._add(body.name, _triangles(body.solid.shells.vertices, body.solid.shells.faces))

    def _pairs(self, robots: Iterable[int], hand: set[int], moved: set[int]) -> Iterable[tuple[int, int, str, bool]]:
        """First, second, kind, and whether it is the hand with what it holds."""
        declared = self._arm.declared
        group = {link: k for k, g in enumerate(rigid_groups(declared)) for link in g.links}
        joined = {frozenset((group[j.parent], group[j.child])) for j in declared.joints} | {
            frozenset((k,)) for k in group.values()
        }
        fingers = {declared.joint_by_name[name].child for name in self._arm.robot.finger_joints}
        first_of = {link: self._first_joint(link) for link in group}
        for first, second in combinations(robots, 2):
            links = self._links[first], self._links[second]
            if frozenset(group[link] for link in links) not in joined and not set(links) <= fingers:
                yield first, second, "self", False
        for robot in robots:
            for body in self._bodies:
                yield robot, body, "object", robot in hand and body in moved
            if first_of[self._links[robot]] > 0:
                yield robot, self._floor, "floor", False
            if first_of[self._links[robot]] > 1:
                yield robot, self._column, "self", False

    def _first_joint(self, link: str) -> int:
        """Return how many joints of the arm lead to a link."""
        above, count = self._arm.declared.joint_above, 0
        while link in above:
            count += above[link].name in self._arm.robot.arm_joints
            link = above[link].parent
        return count

    def _leave_out_what_always_collides(self) -> None:
        """Parts of the robot that are built into each other are in collision everywhere, and no planner's business."""
        rows = self._arm.samples[:_SAMPLES]
        hits = np.zeros(len(self._kinds))
        for q in rows:
            values = self._arm.full(q, self._arm.robot.opening)
            pin.computeCollisions(self._arm.model, self._data, self._geometry, self._free, values, False)
            hits += [result.isCollision() for result in self._free.collisionResults]
        home = self._arm.full(self._arm.home, self._arm.robot.opening)
        pin.computeCollisions(self._arm.model, self._data, self._geometry, self._free, home, False)
        for k, kind in enumerate(self._kinds):
            at_home = self._free.collisionResults[k].isCollision()
            if kind == "self" and (at_home or hits[k] > _ALWAYS * len(rows)):
                for data in (self._free, self._holding):
                    data.deactivateCollisionPair(k)


def _convex(shape: Shape) -> tuple[coal.CollisionGeometry, FloatArray] | None:
    """A shape as a convex body and its pose in the link's frame; None if it has no extent."""
    if shape.kind == "box":
        return coal.Box(*shape.size), shape.T_link_shape
    if shape.kind == "sphere":
        return coal.Sphere(*shape.size), shape.T_link_shape
    if shape.kind in ("cylinder", "capsule"):
        kind = coal.Cylinder if shape.kind == "cylinder" else coal.Capsule
        return kind(shape.size[0], shape.size[1]), shape.T_link_shape
    if not len(shape.mesh.faces):
        return None
    corners = referenced(shape.mesh.vertices, shape.mesh.faces)
    piece = convex_piece(corners, thickness=_THICKNESS, directions=_DIRECTIONS)
    tree = _triangles(piece.vertices, piece.faces)
    tree.buildConvexRepresentation(False)
    return tree.convex, np.eye(4)


def _triangles(vertices: FloatArray, faces: IntArray) -> coal.BVHModelOBBRSS:
    tree = coal.BVHModelOBBRSS()
    tree.beginModel(len(faces), len(vertices))
    corners, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for vertex in vertices:
        corners.append(vertex)
    for face in faces.tolist():
        triangles.append(coal.Triangle(*face))
    tree.addSubModel(corners, triangles)
    tree.endModel()
    return tree
