"""The object in PyBullet: contacts that count, dynamics that can be redrawn, and its state.

Bullet keeps contacts from step to step. An episode therefore begins from a state that was saved before any step, so
that it does not depend on the episodes before.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet

from kinematify.envs.reading import Reading
from kinematify.geometry.rest import overlapping_links
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.pybullet_world import load, pose_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.dynamics import Draw, JointDynamics
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
        self._loaded = load(mechanism, articulated_object.loaded, step=settings.time.step)
        self.client, self.body = self._loaded.client, self._loaded.body
        bullet.setPhysicsEngineParameter(
            numSolverIterations=settings.time.solver_iterations, deterministicOverlappingPairs=1,
            physicsClientId=self.client,
        )  # fmt: skip
        place = {name: k for k, name in enumerate(mechanism.links)}
        apart = overlapping_links(articulated_object.scene)
        self._loaded.act([(place[first], place[second]) for first, second in apart], on=False)
        names = list(mechanism.joints)
        self._leaders = [names.index(joint) for joint in articulated_object.joints]
        self._indices = self._loaded.indices
        self._leader_indices = [self._indices[k] for k in self._leaders]
        self._followers = [k for k in range(len(names)) if k not in self._leaders]
        self._link = int(self._loaded.link[mechanism.links.index(target.link)])
        self._axis = articulated_object.declared.joint_by_name[target.joint].axis
        self._T_base = pose_of(*bullet.getBasePositionAndOrientation(self.body, physicsClientId=self.client))
        self._links = {index: self._info(index) for index in self._loaded.link.tolist()}
        self._T_usual = self._T_root = T_world_root
        self._saved: int | None = None
        self.look()

    def link_index(self, name: str) -> int:
        """PyBullet's index of a link."""
        return int(self._loaded.link[self.articulated_object.scene.mechanism.links.index(name)])

    def _info(self, index: int) -> tuple[float, list[float], float]:
        """Mass [kg], principal moments [kg m^2] and friction of a link."""
        info = bullet.getDynamicsInfo(self.body, index, physicsClientId=self.client)
        return float(info[0]), list(info[2]), float(info[1])

    def apply(self, drawn: Draw) -> None:
        """Redraw the object (`kinematify.envs.dynamics.draw`)."""
        client, body = self.client, self.body
        for number, index in enumerate(self._loaded.link.tolist()):
            mass, moments, friction = self._links[index]
            factor = float(drawn.mass[number])
            bullet.changeDynamics(
                body, index, lateralFriction=drawn.surface * friction, linearDamping=0.0, angularDamping=0.0,
                physicsClientId=client,
            )  # fmt: skip
            if index != _BASE:  # a base that is given a mass is no longer fixed
                bullet.changeDynamics(
                    body, index, mass=factor * mass, localInertiaDiagonal=[factor * m for m in moments],
                    physicsClientId=client,
                )  # fmt: skip
        damping, friction_of = drawn.damping * self._dynamics.damping, drawn.friction * self._dynamics.friction
        for k, index in enumerate(self._indices):
            bullet.changeDynamics(body, index, jointDamping=float(damping[k]), physicsClientId=client)
            if k not in self._followers:
                # A motor that wants no speed and is as strong as the friction is friction.
                bullet.setJointMotorControl2(
                    body, index, bullet.VELOCITY_CONTROL, targetVelocity=0.0, force=float(friction_of[k]),
                    physicsClientId=client,
                )  # fmt: skip
        self._T_root = drawn.T_root @ self._T_usual
        T = self._T_root @ self._T_base
        bullet.resetBasePositionAndOrientation(
            body, T[:3, 3].tolist(), quaternion_of(T[:3, :3], real_last=True), physicsClientId=client
        )
        if self._saved is not None:
            bullet.removeState(self._saved, physicsClientId=client)
        self._saved = None

    def place(self, leaders: FloatArray) -> None:
        """Set the joints, followers included, and stop them."""
        if self._saved is None:
            self._loaded.place(
                self.articulated_object.scene.mechanism.all_values(self.articulated_object.scene.mechanism.rest[None])[
                    0
                ]
            )
            self._loaded.find_contacts_anew()
            self._saved = bullet.saveState(physicsClientId=self.client)
        bullet.restoreState(self._saved, physicsClientId=self.client)
        self._loaded.place(self.articulated_object.scene.mechanism.all_values(leaders[None])[0])
        self.look()
        bullet.performCollisionDetection(physicsClientId=self.client)

    def follow(self) -> None:
        """Let joints that mimic others follow them."""
        if not self._followers:
            return
        states = bullet.getJointStates(self.body, self._leader_indices, physicsClientId=self.client)
        values = self.articulated_object.scene.mechanism.all_values(np.array([[state[0] for state in states]]))[0]
        for k in self._followers:
            bullet.setJointMotorControl2(
                self.body, self._indices[k], bullet.POSITION_CONTROL, targetPosition=float(values[k]),
                force=_FOLLOWER_FORCE, physicsClientId=self.client,
            )  # fmt: skip

    def push(self, force: FloatArray, place: FloatArray) -> None:
        """Apply a force of the world [N] at a place of the world [m] to the part, in the next step only."""
        bullet.applyExternalForce(
            self.body, self._link, force.tolist(), place.tolist(), bullet.WORLD_FRAME, physicsClientId=self.client
        )

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
        state: tuple[tuple[float, ...], ...] = bullet.getLinkState(
            self.body, self._link, computeLinkVelocity=1, computeForwardKinematics=1, physicsClientId=self.client
        )
        return state

    def _at_hold(self, state: tuple[tuple[float, ...], ...]) -> FloatArray:
        return np.asarray(pose_of(state[4], state[5])[:3] @ np.append(self.target.point, 1.0))

    def look(self) -> None:
        """Take the state of now for `reading`."""
        states = bullet.getJointStates(self.body, self._leader_indices, physicsClientId=self.client)
        state = self._link_state()
        T = pose_of(state[4], state[5])
        self._reading = Reading(
            values=np.array([s[0] for s in states]),
            speeds=np.array([s[1] for s in states]),
            hold=self._at_hold(state),
            anchor=T[:3, 3],
            axis=T[:3, :3] @ self._axis,
        )

    def reading(self) -> Reading:
        """Return the state of the object."""
        return self._reading

    def depth(self) -> float:
        """Deepest contact among pairs that collide [m]."""
        points = bullet.getContactPoints(self.body, self.body, physicsClientId=self.client)
        link_of, margin = self._loaded.link_of, self._loaded.margin
        depths = [-p[8] - float(margin[link_of[p[3]]] + margin[link_of[p[4]]]) for p in points]
        return max(0.0, *depths) if depths else 0.0

    def close(self) -> None:
        """Free the world."""
        self._loaded.disconnect()

    def link_poses(self) -> Mapping[str, FloatArray]:
        """World poses of the links, shape (4, 4) each."""
        values = dict(zip(self.articulated_object.joints, self._reading.values.tolist(), strict=True))
        poses = forward_kinematics(self.articulated_object.declared, values)
        return {name: self._T_root @ T for name, T in poses.items()}


class PybulletWorld:
    """What every world of an object tells; see `kinematify.envs.worlds.World`."""

    object: PybulletObject

    def draw(self, drawn: Draw) -> None:
        """Redraw the object."""
        self.object.apply(drawn)

    def reading(self) -> Reading:
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
