"""Worlds in PyBullet (`kinematify.simulation.world`).

Bullet keeps contacts from step to step. What is placed therefore begins from a state that was saved before any step, so
that it does not depend on what happened before.
"""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import pybullet as bullet

from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.pybullet_body import HULL_MARGIN, load, load_at, pose_of
from kinematify.simulation.world import ROBOT, ObjectState

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.pybullet_body import PybulletBody
    from kinematify.simulation.world import Grip, HeldPoint, PlacedModel, PlacedRobot, PullingHand, Variation, WorldSpec

_BASE = -1
_FOLLOWER_FORCE = 1e3  # holds a joint that follows another one [N m or N]
_STRONG = 1e5  # holds a joint where it is [N m or N]
_GAIN = 0.3  # share of an error of position that a motor makes good in a step


class PybulletWorld:
    """World in PyBullet; `close` frees the world."""

    def __init__(self, spec: WorldSpec) -> None:
        """Load both models.

        Raises:
            Unloadable: PyBullet cannot.
        """
        self._spec, self._mechanism = spec, spec.object.mechanism
        placed, mechanism = spec.object, spec.object.mechanism
        self._object = load(mechanism, placed.urdf, step=spec.step, itself=spec.grip is None)
        self.client, self._body = self._object.client, self._object.body
        self.client.setPhysicsEngineParameter(numSolverIterations=spec.iterations, deterministicOverlappingPairs=1)
        self._object.act(_indices(placed), on=False)
        names = list(mechanism.joints)
        leaders = [names.index(travel.joint) for travel in mechanism.travels]
        passive = {names.index(name) for name in self._object.passive}
        self._leaders = [self._object.indices[k] for k in leaders]
        self._followers = [k for k in range(len(names)) if k not in {*leaders, *passive}]
        self._T_base = pose_of(*self.client.getBasePositionAndOrientation(self._body))
        self._links = {index: self._link_facts(index) for index in self._object.link.tolist()}
        self._hand: PullingHand | None = None
        self._saved: int | None = None
        self._move_root(np.eye(4))
        self._robot = None if spec.robot is None else _Robot(self._object, spec.robot, spec.grip)
        if spec.point is not None:
            self._link = self._object.index_of(spec.point.link)
            self._look()

    def _link_facts(self, index: int) -> tuple[float, list[float], float]:
        """Mass [kg], principal moments [kg m^2] and friction of a link."""
        info = self.client.getDynamicsInfo(self._body, index)
        return float(info[0]), list(info[2]), float(info[1])

    def _move_root(self, T_root: FloatArray) -> None:
        self._T_root = T_root @ self._spec.object.T_world_root
        T = self._T_root @ self._T_base
        turn = quaternion_of(T[:3, :3], real_last=True)
        self.client.resetBasePositionAndOrientation(self._body, T[:3, 3].tolist(), turn)
        if self._saved is not None:
            self.client.removeState(self._saved)
        self._saved = None

    def resist(self, damping: FloatArray, friction: FloatArray) -> None:
        """Give the object's joints damping and friction, with the next `vary`."""
        self._damping, self._friction = damping, friction

    def take(self, hand: PullingHand) -> None:
        """Give the held point a hand."""
        self._hand = hand

    def vary(self, drawn: Variation) -> None:
        """Change the object."""
        client, body = self.client, self._body
        for number, index in enumerate(self._object.link.tolist()):
            mass, moments, friction = self._links[index]
            factor = float(drawn.mass[number])
            client.changeDynamics(
                body, index, lateralFriction=drawn.surface * friction, linearDamping=0.0, angularDamping=0.0
            )
            if index != _BASE:  # a base that is given a mass is no longer fixed
                client.changeDynamics(
                    body, index, mass=factor * mass, localInertiaDiagonal=[factor * m for m in moments]
                )
        damping, friction_of = drawn.damping * self._damping, drawn.friction * self._friction
        for k, index in enumerate(self._object.indices):
            client.changeDynamics(body, index, jointDamping=float(damping[k]))
            if k not in self._followers:
                # A motor that wants no speed and is as strong as the friction is friction.
                self._brake(index, float(friction_of[k]))
        self._move_root(drawn.T_root)

    def _brake(self, index: int, force: float) -> None:
        self.client.setJointMotorControl2(self._body, index, bullet.VELOCITY_CONTROL, targetVelocity=0.0, force=force)

    def place(self, values: FloatArray, robot: FloatArray | None = None) -> None:
        """Set all joints and stop them."""
        if self._saved is None:
            self._object.place(self._mechanism.values_at_rest)
            self._object.forget_contacts()
            self._saved = self.client.saveState()
        self.client.restoreState(self._saved)
        self._object.place(values)
        locked = self._spec.object.locked
        if locked:
            named = dict(zip(self._mechanism.joints, values.tolist(), strict=True))
            _hold(self._object, {name: value for name, value in named.items() if name not in self._object.passive})
            for index in self._object.indices:
                self.client.changeDynamics(self._body, index, jointDamping=0.0)
        if self._spec.point is not None:
            self._look()
        self.client.performCollisionDetection()
        if robot is not None and self._robot is not None:
            self._robot.place(robot)
            self.client.performCollisionDetection()

    def pull(self, command: FloatArray) -> None:
        """Command the hand."""
        self._pulled = np.asarray(command, dtype=np.float64)

    def command(self, values: FloatArray, speeds: FloatArray | None = None) -> None:
        """Command the motors; they are led there in the steps that follow."""
        self._arm.wanted, self._arm.speeds = values, speeds

    def step(self, count: int = 1) -> None:
        """Simulate so many steps."""
        for step in range(1, count + 1):
            if self._robot is None:
                self._push()
            else:
                self._robot.lead(step / count)
            self._follow()
            self.client.stepSimulation()
        if self._robot is not None:
            self._robot.led = self._robot.wanted
        if self._spec.point is not None:
            self._look()

    def _push(self) -> None:
        """Apply the hand's force in the next step."""
        hand, state = self._hand, self._link_state()
        assert hand is not None
        at = self._at_hold(state)
        if hand.spring:
            velocity = np.array(state[6]) + np.cross(state[7], at - np.array(state[0]))
            spring = hand.stiffness * (self._pulled - at) - hand.damping * velocity
            force = np.clip(spring, -hand.force, hand.force)
        else:
            force = hand.force * self._pulled
        self.client.applyExternalForce(self._body, self._link, force.tolist(), at.tolist(), bullet.WORLD_FRAME)

    def _follow(self) -> None:
        """Make joints that mimic others follow them, which PyBullet does not care for."""
        if not self._followers:
            return
        values = self._mechanism.all_values(self._object_leaders()[0][None])[0]
        for k in self._followers:
            self.client.setJointMotorControl2(
                self._body,
                self._object.indices[k],
                bullet.POSITION_CONTROL,
                targetPosition=float(values[k]),
                force=_FOLLOWER_FORCE,
            )

    def release(self, joints: Iterable[str]) -> None:
        """Make locked joints of the object go."""
        for name in joints:
            self._brake(self._object.indices[self._mechanism.joints.index(name)], 0.0)

    def weld(self) -> None:
        """Fix the tool to the part where it now is."""
        robot, grip, tool = self._arm.loaded, self._spec.grip, self._arm.placed.tool
        assert grip is not None
        T_world_tool = robot.frame(tool)
        T_tool, T_part = (
            np.linalg.inv(side.centre(link)) @ T_world_tool for side, link in ((robot, tool), (self._object, grip.link))
        )
        weld = self.client.createConstraint(
            robot.body,
            robot.index_of(tool),
            self._body,
            self._object.index_of(grip.link),
            bullet.JOINT_FIXED,
            [0.0, 0.0, 0.0],
            T_tool[:3, 3].tolist(),
            T_part[:3, 3].tolist(),
            *(quaternion_of(T[:3, :3], real_last=True) for T in (T_tool, T_part)),
        )
        self.client.changeConstraint(weld, maxForce=grip.weld_force)

    def _object_leaders(self) -> tuple[FloatArray, FloatArray]:
        return _motion(self._object, self._leaders)

    def _link_state(self) -> tuple[tuple[float, ...], ...]:
        state: tuple[tuple[float, ...], ...] = self.client.getLinkState(
            self._body, self._link, computeLinkVelocity=1, computeForwardKinematics=1
        )
        return state

    def _at_hold(self, state: tuple[tuple[float, ...], ...]) -> FloatArray:
        return np.asarray(pose_of(state[4], state[5])[:3] @ np.append(self._point.point, 1.0))

    @property
    def _point(self) -> HeldPoint:
        assert self._spec.point is not None
        return self._spec.point

    def _look(self) -> None:
        """Take the state of now for `state`."""
        (values, speeds), link = self._object_leaders(), self._link_state()
        T = pose_of(link[4], link[5])
        self._state = ObjectState(
            values=values,
            speeds=speeds,
            hold=self._at_hold(link),
            anchor=T[:3, 3],
            axis=T[:3, :3] @ self._point.axis,
        )

    def state(self) -> ObjectState:
        """State of the object after the last step."""
        return self._state

    def values(self) -> FloatArray:
        """Values of all joints of the object."""
        return np.array(self._object.state()[0])

    def robot_values(self) -> FloatArray:
        """Values of all joints of the robot."""
        return np.array(self._arm.loaded.state()[0])

    def driven(self) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of the robot's joints with motors."""
        return _motion(self._arm.loaded, self._arm.driven)

    def tool(self) -> FloatArray:
        """Pose of the tool."""
        return self._arm.loaded.frame(self._arm.placed.tool)

    def touch(self) -> FloatArray:
        """Force of each finger on the held body."""
        links = self._arm.placed.finger_links
        forces = np.zeros((len(links), 3))
        rows = {self._arm.loaded.index_of(link): row for row, link in enumerate(links)}
        held = {self._object.index_of(link) for link in self._point.body}
        for point in self._contacts():
            if point[3] in rows and point[4] in held:
                forces[rows[point[3]]] += point[9] * np.array(point[7])
        return np.asarray(np.linalg.norm(forces, axis=1))

    def _contacts(self) -> list[tuple[Any, ...]]:
        """Contacts of the robot with the object."""
        return list(self.client.getContactPoints(self._arm.loaded.body, self._body) or ())

    @property
    def _arm(self) -> _Robot:
        assert self._robot is not None
        return self._robot

    def link_poses(self) -> dict[str, FloatArray]:
        """World poses of the links of both."""
        leaders = [travel.joint for travel in self._mechanism.travels]
        poses = forward_kinematics(self._mechanism.robot, dict(zip(leaders, self._state.values.tolist(), strict=True)))
        found = {name: self._T_root @ T for name, T in poses.items()}
        for name in () if self._robot is None else self._robot.placed.mechanism.links:
            found[ROBOT + name] = self._arm.loaded.frame(name)
        return found

    def depth(self) -> float:
        """Deepest contact of the object with itself among pairs that collide, or with the robot."""
        link_of, margin = self._object.link_of, self._object.margin
        points = self.client.getContactPoints(self._body, self._body)
        depths = [-p[8] - float(margin[link_of[p[3]]] + margin[link_of[p[4]]]) for p in points]
        if self._robot is not None:
            depths += [float(-point[8]) - HULL_MARGIN for point in self._contacts()]
        return max(0.0, *depths) if depths else 0.0

    def deeper(self, than: float) -> tuple[float, tuple[str, str]] | None:
        """Deepest contact of the robot, if it is deeper than that."""
        deepest = min(self._contacts(), key=lambda point: point[8], default=None)
        if deepest is None or -deepest[8] - HULL_MARGIN <= than:
            return None
        sides = ((self._arm.loaded, deepest[3]), (self._object, deepest[4]))
        link, other = (side.mechanism.links[side.link_of[index]] for side, index in sides)
        return -deepest[8] - HULL_MARGIN, (link, other)

    def stable(self) -> bool:
        """True if all numbers are finite."""
        robot = () if self._robot is None else self.driven()
        return all(bool(np.isfinite(part).all()) for part in (*self._object_leaders(), *robot))

    def warnings(self) -> dict[str, int]:
        """PyBullet has none."""
        return {}

    def close(self) -> None:
        """Free the world."""
        self.client.disconnect()


class _Robot:
    """A robot in the world of an object."""

    def __init__(self, beside: PybulletBody, placed: PlacedRobot, grip: Grip | None) -> None:
        """The robot meets the object and the floor; the object stands on the floor."""
        client, self.placed = beside.client, placed
        loaded = load_at(client, placed.mechanism, placed.urdf, placed.T_world_root, itself=grip is None)
        self.loaded, joints = loaded, dict(zip(placed.mechanism.joints, loaded.indices, strict=True))
        self.driven = [joints[name] for name in placed.driven]
        self.wanted = self.led = np.zeros(len(self.driven))
        """What is commanded, and what the motors have been led to."""
        self.speeds: FloatArray | None = None
        grips = np.full(len(placed.fingers), placed.settings.grip_force)
        self._forces = np.concatenate([placed.strongest, grips]).tolist()
        for index in loaded.link.tolist():
            client.changeDynamics(loaded.body, index, lateralFriction=placed.settings.friction)
        rest = zip(placed.mechanism.joints, placed.mechanism.values_at_rest.tolist(), strict=True)
        _hold(loaded, {name: value for name, value in rest if name not in placed.driven})
        for hand, part in () if grip is None else product(grip.hand, grip.part):
            first, second = loaded.index_of(hand), beside.index_of(part)
            client.setCollisionFilterPair(loaded.body, beside.body, first, second, 0)
        floor = client.createMultiBody(0.0, client.createCollisionShape(bullet.GEOM_PLANE))
        for index in beside.link.tolist():
            client.setCollisionFilterPair(floor, beside.body, _BASE, index, 0)

    def place(self, values: FloatArray) -> None:
        """Set the joints with motors, and hold them."""
        for index, value in zip(self.driven, values.tolist(), strict=True):
            self.loaded.client.resetJointState(self.loaded.body, index, value)
        self.wanted = self.led = np.asarray(values)
        self.lead(1.0)

    def lead(self, share: float) -> None:
        """Lead the motors a share of the way to what is commanded."""
        count = len(self.driven)
        speeds: dict[str, list[float]] = {}
        if self.speeds is not None:
            speeds["targetVelocities"] = [*self.speeds.tolist(), *[0.0] * (count - len(self.speeds))]
        self.loaded.client.setJointMotorControlArray(
            self.loaded.body,
            self.driven,
            bullet.POSITION_CONTROL,
            targetPositions=(self.led + share * (self.wanted - self.led)).tolist(),
            forces=self._forces,
            positionGains=[_GAIN] * count,
            velocityGains=[1.0] * count,
            **speeds,
        )


def _indices(placed: PlacedModel) -> list[tuple[int, int]]:
    """Pairs of links that do not act on each other."""
    place = {name: k for k, name in enumerate(placed.mechanism.links)}
    return [(place[first], place[second]) for first, second in placed.apart]


def _motion(body: PybulletBody, joints: list[int]) -> tuple[FloatArray, FloatArray]:
    """Values and speeds of joints."""
    states = body.client.getJointStates(body.body, joints)
    return np.array([state[0] for state in states]), np.array([state[1] for state in states])


def _hold(side: PybulletBody, values: Mapping[str, float]) -> None:
    """Set joints and hold them there."""
    joints = dict(zip(side.mechanism.joints, side.indices, strict=True))
    for name, value in values.items():
        side.client.resetJointState(side.body, joints[name], value)
        side.client.setJointMotorControl2(
            side.body,
            joints[name],
            bullet.POSITION_CONTROL,
            targetPosition=value,
            targetVelocity=0.0,
            force=_STRONG,
            positionGain=_GAIN,
            velocityGain=1.0,
        )
