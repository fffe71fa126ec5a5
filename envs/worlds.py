"""Worlds of the environments: the object with the dynamics of its joints, and a hand or a robot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, cast

import numpy as np

from kinematify.config.validation import load_settings
from kinematify.envs.articulated_object import held_links
from kinematify.envs.joint_dynamics import full_force, joint_dynamics
from kinematify.envs.settings import SETTINGS
from kinematify.geometry.rest_pairs import overlapping_links
from kinematify.manipulation.manipulator import effort_limits
from kinematify.simulation.engines import open_world
from kinematify.simulation.world import HeldPoint, PlacedModel, PlacedRobot, PullingHand, WorldSpec

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.joint_dynamics import JointDynamics
    from kinematify.envs.robot_plan import EnvRobot, RobotPlan
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.mujoco_world import MujocoWorld
    from kinematify.simulation.world import EngineWorld

_DAMPING_RATIO = 2.0  # of the hand's spring, times mass and frequency: neither swings nor creeps
_WAY_SAMPLES = 9
_FILTER_SHARE = 0.6  # of the time between actions: servos are led smoothly to a new target


@dataclass(frozen=True, kw_only=True, eq=False)
class WorldFacts:
    """Facts that worlds are opened from, in any engine."""

    spec: WorldSpec
    dynamics: JointDynamics

    def opened(self, engine: str) -> EngineWorld:
        """Open a world."""
        world = open_world(engine, self.spec)
        world.resist(self.dynamics.damping, self.dynamics.friction)
        return world


@dataclass(frozen=True, kw_only=True, eq=False)
class HandFacts(WorldFacts):
    """Abilities of the hand."""

    hand: PullingHand
    inertia: float
    """That the joint moves at most [kg m^2 or kg]."""
    speed: float
    """Of the hand with a full action in position control [m/s]."""

    def opened(self, engine: str) -> EngineWorld:
        """Open a world with the hand."""
        world = super().opened(engine)
        world.take(self.hand)
        return world


@lru_cache(maxsize=16)
def hand_facts(articulated_object: ArticulatedObject, target: Target, *, spring: bool) -> HandFacts:
    """Describe the world of a hand, once per process."""
    settings, mechanism = SETTINGS, articulated_object.scene.mechanism
    spec = WorldSpec(
        step=settings.time.step,
        object=_placed(articulated_object, articulated_object.T_world_root),
        point=_point(articulated_object, target),
    )
    loads = _Loads(articulated_object, spec)
    dynamics = loads.dynamics()
    along = np.tile(mechanism.rest, (_WAY_SAMPLES, 1))
    along[:, target.leader] = np.linspace(target.closed, target.opened, _WAY_SAMPLES)
    moved = [loads.moved(row, target.leader) for row in along]
    ends = np.tile(mechanism.rest, (2, 1))
    ends[:, target.leader] = target.closed, target.opened
    leads = mechanism.leads_at(mechanism.rest)[:, target.leader]
    force = full_force(
        target,
        settings.hand,
        inertia=np.array([inertia for inertia, _ in moved]),
        gravity=np.array([gravity for _, gravity in moved]),
        damping=float(leads**2 @ dynamics.damping),
        friction=float(np.abs(leads) @ dynamics.friction),
    )
    inertia = max(loads.moved(row, target.leader)[0] for row in ends)
    stiffness = force / (settings.hand.lag * target.way)
    damping = float(_DAMPING_RATIO * np.sqrt(stiffness * inertia) / target.path_ratio)
    hand = PullingHand(spring=spring, force=force, stiffness=stiffness, damping=damping)
    speed = settings.hand.speed * target.way
    return HandFacts(spec=spec, dynamics=dynamics, hand=hand, inertia=inertia, speed=speed)


@lru_cache(maxsize=8)
def arm_facts(articulated_object: ArticulatedObject, target: Target, robot: EnvRobot, plan: RobotPlan) -> WorldFacts:
    """Describe the world of a robot, once per process."""
    settings, driven = SETTINGS, {*robot.robot.arm_joints, *robot.robot.finger_joints}
    spec = WorldSpec(
        step=settings.time.step,
        object=_placed(articulated_object, plan.T_world_object),
        robot=PlacedRobot(
            urdf=robot.loaded,
            mechanism=robot.mechanism,
            T_world_root=plan.T_world_base,
            apart=overlapping_links(robot.scene),
            locked={travel.joint: travel.rest for travel in robot.mechanism.travels if travel.joint not in driven},
            arm=robot.robot.arm_joints,
            fingers=robot.robot.finger_joints,
            strongest=effort_limits(robot.arm.declared, robot.robot, load_settings().task.execution.effort),
            postures=(plan.reach[0], plan.pull[0], plan.pull[-1]),
            tool=robot.robot.tool,
            settings=settings.robot,
            smoothing=_FILTER_SHARE * settings.time.control_step,
        ),
        point=_point(articulated_object, target),
    )
    return WorldFacts(spec=spec, dynamics=_Loads(articulated_object, spec).dynamics())


def _placed(articulated_object: ArticulatedObject, T_world_root: FloatArray) -> PlacedModel:
    """The object; what is in each other at rest does not collide."""
    scene = articulated_object.scene
    apart = overlapping_links(scene)
    return PlacedModel(
        urdf=articulated_object.loaded, mechanism=scene.mechanism, T_world_root=T_world_root, apart=apart
    )


def _point(articulated_object: ArticulatedObject, target: Target) -> HeldPoint:
    return HeldPoint(
        link=target.link,
        point=target.point,
        axis=articulated_object.declared.joint_by_name[target.joint].axis,
        body=held_links(articulated_object, target),
    )


class _Loads:
    """Loads that joints move and carry, which MuJoCo computes whatever engine is asked for."""

    def __init__(self, articulated_object: ArticulatedObject, spec: WorldSpec) -> None:
        self._object = articulated_object
        self._world = cast("MujocoWorld", open_world("mujoco", spec))

    def dynamics(self) -> JointDynamics:
        """Damping and friction of all joints."""
        matrix, bias = self._world.mechanics(self._object.scene.mechanism.rest)
        return joint_dynamics(self._object, np.diag(matrix).copy(), bias, SETTINGS.object)

    def moved(self, leaders: FloatArray, leader: int) -> tuple[float, float]:
        """Inertia and holding torque of a joint and of all that follow it."""
        matrix, bias = self._world.mechanics(leaders)
        leads = self._object.scene.mechanism.leads_at(leaders)[:, leader]
        return float(leads @ matrix @ leads), float(leads @ bias)
