"""OpenPart and DrawerPull in PyBullet: the object with dynamics that can be redrawn, the hand of MuJoCo, and a robot.

Bullet keeps contacts from step to step. An episode therefore begins from a state that was saved before any step, so
that it does not depend on the episodes before.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.envs.articulated_object import held_links
from kinematify.envs.goal import ObjectState
from kinematify.envs.mujoco_worlds import POSITION, ROBOT, arm_facts, hand_facts
from kinematify.geometry.rest import overlapping_links
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.pybullet_world import load, load_at, pose_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.dynamics import Draw, JointDynamics
    from kinematify.envs.robot_plan import EnvRobot, RobotPlan
    from kinematify.envs.settings import EnvSettings
    from kinematify.robot.arrays import FloatArray

_BASE = -1
_FOLLOWER_FORCE = 1e3  # holds a joint that follows another one [N m or N]


class PybulletObject:
    """One object in a world of its own."""

    def __init__(
        self,
        articulated_object: ArticulatedObject,
        target: Target,
        dynamics: JointDynamics,
        T_world_root: FloatArray,
        settings: EnvSettings,
    ) -> None:
        """Load the file; what is in each other at rest does not collide, as in MuJoCo."""
        self.articulated_object, self.target, self._dynamics = articulated_object, target, dynamics
        mechanism = articulated_object.scene.mechanism
        self.loaded = load(mechanism, articulated_object.loaded, step=settings.time.step)
        self.client, self.body = self.loaded.client, self.loaded.body
        self.client.setPhysicsEngineParameter(
            numSolverIterations=settings.time.solver_iterations, deterministicOverlappingPairs=1
        )
        place = {name: k for k, name in enumerate(mechanism.links)}
        apart = overlapping_links(articulated_object.scene)
        self.loaded.act([(place[first], place[second]) for first, second in apart], on=False)
        names = list(mechanism.joints)
        self._leaders = [names.index(joint) for joint in articulated_object.joints]
        self._indices = self.loaded.indices
        self._leader_indices = [self._indices[k] for k in self._leaders]
        passive = {names.index(name) for name in self.loaded.passive}
        self._followers = [k for k in range(len(names)) if k not in {*self._leaders, *passive}]
        self._link = self.loaded.index_of(target.link)
        self._axis = articulated_object.declared.joint_by_name[target.joint].axis
        self._T_base = pose_of(*self.client.getBasePositionAndOrientation(self.body))
        self._links = {index: self._info(index) for index in self.loaded.link.tolist()}
        self._T_usual = self._T_root = T_world_root
        self._saved: int | None = None
        self.look()

    def _info(self, index: int) -> tuple[float, list[float], float]:
        """Mass [kg], principal moments [kg m^2] and friction of a link."""
        info = self.client.getDynamicsInfo(self.body, index)
        return float(info[0]), list(info[2]), float(info[1])

    def apply(self, drawn: Draw) -> None:
        """Redraw the object (`kinematify.envs.dynamics.draw`)."""
        client, body = self.client, self.body
        for number, index in enumerate(self.loaded.link.tolist()):
            mass, moments, friction = self._links[index]
            factor = float(drawn.mass[number])
            client.changeDynamics(
                body, index, lateralFriction=drawn.surface * friction, linearDamping=0.0, angularDamping=0.0
            )
            if index != _BASE:  # a base that is given a mass is no longer fixed
                client.changeDynamics(
                    body, index, mass=factor * mass, localInertiaDiagonal=[factor * m for m in moments]
                )
        damping, friction_of = drawn.damping * self._dynamics.damping, drawn.friction * self._dynamics.friction
        for k, index in enumerate(self._indices):
            client.changeDynamics(body, index, jointDamping=float(damping[k]))
            if k not in self._followers:
                # A motor that wants no speed and is as strong as the friction is friction.
                client.setJointMotorControl2(
                    body, index, bullet.VELOCITY_CONTROL, targetVelocity=0.0, force=float(friction_of[k])
                )
        self._T_root = drawn.T_root @ self._T_usual
        T = self._T_root @ self._T_base
        client.resetBasePositionAndOrientation(body, T[:3, 3].tolist(), quaternion_of(T[:3, :3], real_last=True))
        if self._saved is not None:
            client.removeState(self._saved)
        self._saved = None

    def place(self, leaders: FloatArray) -> None:
        """Set the joints, followers included, and stop them."""
        if self._saved is None:
            self.loaded.place(self.articulated_object.scene.mechanism.values_at_rest)
            self.loaded.find_contacts_anew()
            self._saved = self.client.saveState()
        self.client.restoreState(self._saved)
        self.loaded.place(self.articulated_object.scene.mechanism.all_values(leaders[None])[0])
        self.look()
        self.client.performCollisionDetection()

    def follow(self) -> None:
        """Let joints that mimic others follow them."""
        if not self._followers:
            return
        states = self.client.getJointStates(self.body, self._leader_indices)
        values = self.articulated_object.scene.mechanism.all_values(np.array([[state[0] for state in states]]))[0]
        for k in self._followers:
            self.client.setJointMotorControl2(
                self.body,
                self._indices[k],
                bullet.POSITION_CONTROL,
                targetPosition=float(values[k]),
                force=_FOLLOWER_FORCE,
            )

    def push(self, force: FloatArray, place: FloatArray) -> None:
        """Apply a force of the world [N] at a place of the world [m] to the part, in the next step only."""
        self.client.applyExternalForce(self.body, self._link, force.tolist(), place.tolist(), bullet.WORLD_FRAME)

    def hold_motion(self) -> tuple[FloatArray, FloatArray]:
        """Place [m] and velocity [m/s] of the hold, shape (3,) each."""
        state = self._link_state()
        hold = self._at_hold(state)
        velocity = np.array(state[6]) + np.cross(state[7], hold - np.array(state[0]))
        return hold, velocity

    def hold(self) -> FloatArray:
        """Place of the hold [m], shape (3,)."""
        return self._at_hold(self._link_state())

    def _link_state(self) -> tuple[tuple[float, ...], ...]:
        state: tuple[tuple[float, ...], ...] = self.client.getLinkState(
            self.body, self._link, computeLinkVelocity=1, computeForwardKinematics=1
        )
        return state

    def _at_hold(self, state: tuple[tuple[float, ...], ...]) -> FloatArray:
        return np.asarray(pose_of(state[4], state[5])[:3] @ np.append(self.target.point, 1.0))

    def look(self) -> None:
        """Take the state of now for `reading`."""
        states = self.client.getJointStates(self.body, self._leader_indices)
        state = self._link_state()
        T = pose_of(state[4], state[5])
        self._reading = ObjectState(
            values=np.array([s[0] for s in states]),
            speeds=np.array([s[1] for s in states]),
            hold=self._at_hold(state),
            anchor=T[:3, 3],
            axis=T[:3, :3] @ self._axis,
        )

    def reading(self) -> ObjectState:
        """Return the state of the object."""
        return self._reading

    def depth(self) -> float:
        """Deepest contact among pairs that collide [m]."""
        points = self.client.getContactPoints(self.body, self.body)
        link_of, margin = self.loaded.link_of, self.loaded.margin
        depths = [-p[8] - float(margin[link_of[p[3]]] + margin[link_of[p[4]]]) for p in points]
        return max(0.0, *depths) if depths else 0.0

    def close(self) -> None:
        """Free the world."""
        self.client.disconnect()

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the links, shape (4, 4) each."""
        values = dict(zip(self.articulated_object.joints, self._reading.values.tolist(), strict=True))
        poses = forward_kinematics(self.articulated_object.declared, values)
        return {name: self._T_root @ T for name, T in poses.items()}


class PybulletWorld:
    """What every world of an object tells; the other engine tells the same."""

    object: PybulletObject

    def draw(self, drawn: Draw) -> None:
        """Redraw the object."""
        self.object.apply(drawn)

    def reading(self) -> ObjectState:
        """Return the state of the object."""
        return self.object.reading()

    def depth(self) -> float:
        """Deepest contact of shapes that do not touch at rest [m]."""
        return self.object.depth()

    def stable(self) -> bool:
        """True if all numbers are finite."""
        reading = self.object.reading()
        return bool(np.isfinite(reading.values).all() and np.isfinite(reading.speeds).all())

    def warnings(self) -> dict[str, int]:
        """PyBullet has none."""
        return {}

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the object's links."""
        return self.object.link_poses()

    def close(self) -> None:
        """Free the world."""
        self.object.close()


class PybulletHand(PybulletWorld):
    """One object and a hand without a robot."""

    def __init__(
        self, articulated_object: ArticulatedObject, target: Target, control: str, settings: EnvSettings
    ) -> None:
        """Connect to a world of its own; `close` frees it."""
        self.facts = hand_facts(articulated_object, target, control)
        self.object = PybulletObject(
            articulated_object, target, self.facts.dynamics, articulated_object.T_world_root, settings
        )
        self.client = self.object.client
        self._control, self._substeps = control, settings.time.substeps
        self._stride = self.facts.speed * settings.time.control_step
        self._lead = self.facts.force / self.facts.stiffness
        self._wanted = np.zeros(3)

    def place(self, leaders: FloatArray) -> float:
        """Set the object's joints and stop them; the hand's spring is slack."""
        self.object.place(leaders)
        self._wanted = self.object.hold()
        return self.object.depth()

    def act(self, action: FloatArray) -> None:
        """Simulate until the next action."""
        action = np.asarray(action, dtype=np.float64)
        if self._control == POSITION:
            hold = self.object.hold()
            lead = self._wanted - hold + self._stride * action
            self._wanted = hold + np.clip(lead, -self._lead, self._lead)
        for _ in range(self._substeps):
            hold, velocity = self.object.hold_motion()
            self.object.push(self._force(action, hold, velocity), hold)
            self.object.follow()
            self.client.stepSimulation()
        self.object.look()

    def _force(self, action: FloatArray, hold: FloatArray, velocity: FloatArray) -> FloatArray:
        """Of the hand, world axes [N], shape (3,)."""
        facts = self.facts
        if self._control != POSITION:
            return facts.force * action
        spring = facts.stiffness * (self._wanted - hold) - facts.spring_damping * velocity
        return np.asarray(np.clip(spring, -facts.force, facts.force))

    def command(self) -> FloatArray:
        """From the hold to where the hand wants it [m], zero in force control, shape (3,)."""
        return self._wanted - self.object.hold() if self._control == POSITION else np.zeros(3)


_MARGIN = 1e-3  # Bullet inflates convex hulls by it [m]
_STRONG = 1e4  # holds joints that are neither of the arm nor of the fingers [N m or N]
_GAIN = 0.3  # share of an error of position that a motor makes good in a step


class PybulletArm(PybulletWorld):
    """One object and a robot."""

    def __init__(
        self,
        articulated_object: ArticulatedObject,
        target: Target,
        robot: EnvRobot,
        plan: RobotPlan,
        settings: EnvSettings,
    ) -> None:
        """Connect to a world of its own; `close` frees it."""
        facts = arm_facts(articulated_object, target, robot, plan)
        self.object = PybulletObject(articulated_object, target, facts.dynamics, plan.T_world_object, settings)
        self.client = self.object.client
        self._articulated_object, self._robot, self._substeps = articulated_object, robot, settings.time.substeps
        self._load(plan, settings)
        self._held = [self.object.loaded.index_of(name) for name in held_links(articulated_object, target)]
        forces = np.full(len(robot.robot.finger_joints), settings.robot.grip_force)
        self._forces = np.concatenate([robot.strongest, forces]).tolist()
        self._wanted = np.zeros(len(self._forces))

    def _load(self, plan: RobotPlan, settings: EnvSettings) -> None:
        client, names = self.client, self._robot.robot
        loaded = load_at(client, self._robot.mechanism, self._robot.loaded, plan.T_world_base, itself=True)
        self._loaded, self.body = loaded, loaded.body
        joints = dict(zip(loaded.mechanism.joints, loaded.indices, strict=True))
        driven = (*names.arm_joints, *names.finger_joints)
        self._joints = [joints[name] for name in driven]
        for index in loaded.link.tolist():
            client.changeDynamics(self.body, index, lateralFriction=settings.robot.friction)
        rest = rest_configuration(self._robot.mechanism.robot)
        for name, index in joints.items():
            if name not in driven:
                client.resetJointState(self.body, index, rest.get(name, 0.0))
                client.setJointMotorControl2(
                    self.body, index, bullet.POSITION_CONTROL, targetPosition=rest.get(name, 0.0), force=_STRONG
                )
        self._lay_floor()

    def _lay_floor(self) -> None:
        """The robot meets the floor, the object stands on it."""
        shape = self.client.createCollisionShape(bullet.GEOM_PLANE)
        floor = self.client.createMultiBody(0.0, shape)
        for name in self._articulated_object.scene.mechanism.links:
            self.client.setCollisionFilterPair(floor, self.object.body, _BASE, self.object.loaded.index_of(name), 0)

    def place(self, leaders: FloatArray, arm: FloatArray) -> float:
        """Set the object's joints and those of the arm, fingers apart, and stop all."""
        self.object.place(leaders)
        self._wanted = np.concatenate([arm, self._robot.finger_values(1.0)])
        for index, value in zip(self._joints, self._wanted.tolist(), strict=True):
            self.client.resetJointState(self.body, index, value)
        self._drive(self._wanted)
        self.client.performCollisionDetection()
        return self.depth()

    def act(self, arm: FloatArray, fingers: FloatArray) -> None:
        """Simulate until the next action, motors led smoothly to these values."""
        before, wanted = self._wanted, np.concatenate([arm, fingers])
        for step in range(1, self._substeps + 1):
            self._drive(before + step / self._substeps * (wanted - before))
            self.object.follow()
            self.client.stepSimulation()
        self._wanted = wanted
        self.object.look()

    def _drive(self, values: FloatArray) -> None:
        count = len(self._joints)
        self.client.setJointMotorControlArray(
            self.body,
            self._joints,
            bullet.POSITION_CONTROL,
            targetPositions=values.tolist(),
            forces=self._forces,
            positionGains=[_GAIN] * count,
            velocityGains=[1.0] * count,
        )

    def joints(self) -> tuple[FloatArray, FloatArray]:
        """Values and speeds of the arm's joints and then of the fingers'."""
        states = self.client.getJointStates(self.body, self._joints)
        return np.array([state[0] for state in states]), np.array([state[1] for state in states])

    def tool(self) -> FloatArray:
        """Pose of the tool, shape (4, 4)."""
        return self._loaded.frame(self._robot.robot.tool)

    def touch(self) -> FloatArray:
        """Force of each finger on the part [N], shape (fingers,)."""
        forces = np.zeros((len(self._robot.finger_links), 3))
        rows = {self._loaded.index_of(link): row for row, link in enumerate(self._robot.finger_links)}
        for point in self.client.getContactPoints(self.body, self.object.body) or ():
            if point[3] in rows and point[4] in self._held:
                forces[rows[point[3]]] += point[9] * np.array(point[7])
        return np.asarray(np.linalg.norm(forces, axis=1))

    def depth(self) -> float:
        """Deepest contact of the object with itself or the robot [m]."""
        points = self.client.getContactPoints(self.body, self.object.body)
        return max([super().depth(), *(float(-point[8]) - _MARGIN for point in points or ())])

    def stable(self) -> bool:
        """True if all numbers are finite."""
        return super().stable() and bool(np.isfinite(self.joints()).all())

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the links of object and robot."""
        return {
            **super().link_poses(),
            **{ROBOT + name: self._loaded.frame(name) for name in self._loaded.mechanism.links},
        }
