"""Worlds of the environments: the object with the dynamics of its joints, and a hand or a robot."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config.validation import load_settings
from kinematify.envs.goal import CONTROL_STEP, STEP
from kinematify.envs.joint_dynamics import full_force, joint_dynamics
from kinematify.geometry.rest_pairs import overlapping_links
from kinematify.manipulation.manipulator import effort_limits
from kinematify.robot.robot import fixed_together
from kinematify.simulation.engines import open_engine
from kinematify.simulation.mujoco_engine import mechanics
from kinematify.simulation.world import HeldPoint, PlacedModel, PlacedRobot, PullingHand, WorldSpec

if TYPE_CHECKING:
    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.robot_plan import EnvRobot, RobotPlan
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.engine import Engine

LAG = 0.08  # with this share of the way between hand and part the spring pulls with full force
"""Distance between hand and part at which the spring has full force, share of the way."""
HAND_SPEED = 1.2  # below what counts as thrown
"""Full speed of the hand in position control [ways/s]."""
_DAMPING_RATIO = 2.0  # of the hand's spring, times mass and frequency: neither swings nor creeps
_WAY_SAMPLES = 9
_FILTER_SHARE = 0.6  # of the time between actions: servos are led smoothly to a new target


class Servos:
    """Of the robot of DrawerPull."""

    servo_frequency = 8.0
    """[Hz]."""
    armature = 0.1
    """Inertia of motors over that of the links."""
    finger_inertia = 1.0
    """[kg]."""
    grip_force = 60.0  # grippers of research arms exert 40 to 140 N
    """Of each finger at most [N]."""
    friction = 1.0  # rubber on varnish
    """Of the robot's surfaces."""


@dataclass(frozen=True, kw_only=True, eq=False)
class WorldFacts:
    """Facts that worlds are opened from, in any engine."""

    spec: WorldSpec
    dynamics: tuple[FloatArray, FloatArray]
    """Damping and friction of all joints (`joint_dynamics`)."""

    hand: PullingHand | None = None
    """What pulls where there is no robot."""

    def opened(self, engine: str) -> Engine:
        """Open a world, with the hand if there is one."""
        world = open_engine(engine, self.spec)
        world.resist(*self.dynamics, self.hand)
        return world


@dataclass(frozen=True, kw_only=True, eq=False)
class HandFacts(WorldFacts):
    """The same with a hand."""

    hand: PullingHand
    inertia: float
    """That the joint moves at most [kg m^2 or kg]."""


@lru_cache(maxsize=16)
def hand_facts(articulated_object: ArticulatedObject, target: Target, *, spring: bool) -> HandFacts:
    """Describe the world of a hand, once per process."""
    mechanism = articulated_object.scene.mechanism
    spec = WorldSpec(
        step=STEP,
        object=_placed(articulated_object, articulated_object.T_world_root),
        point=_point(articulated_object, target),
    )
    dynamics = _dynamics(articulated_object, spec)

    def moved(values: FloatArray) -> FloatArray:
        """Inertia and holding torque of the joint and of all that follow it, at values of it, shape (2, n)."""
        found = []
        for value in values:
            leaders = mechanism.rest.copy()
            leaders[target.leader] = value
            matrix, bias = mechanics(spec, leaders)
            leads = mechanism.leads_at(leaders)[:, target.leader]
            found.append((float(leads @ matrix @ leads), float(leads @ bias)))
        return np.array(found).T

    leads = mechanism.leads_at(mechanism.rest)[:, target.leader]
    along, gravity = moved(np.linspace(target.closed, target.opened, _WAY_SAMPLES))
    force = full_force(
        target,
        inertia=along,
        gravity=gravity,
        damping=float(leads**2 @ dynamics[0]),
        friction=float(np.abs(leads) @ dynamics[1]),
    )
    inertia = float(moved(np.array([target.closed, target.opened]))[0].max())
    stiffness = force / (LAG * target.way)
    damping = float(_DAMPING_RATIO * np.sqrt(stiffness * inertia) / target.path_ratio)
    hand = PullingHand(spring=spring, force=force, stiffness=stiffness, damping=damping)
    return HandFacts(spec=spec, dynamics=dynamics, hand=hand, inertia=inertia)


@lru_cache(maxsize=8)
def arm_facts(articulated_object: ArticulatedObject, target: Target, robot: EnvRobot, plan: RobotPlan) -> WorldFacts:
    """Describe the world of a robot, once per process."""
    driven = {*robot.robot.arm_joints, *robot.robot.finger_joints}
    mechanism = robot.scene.mechanism
    spec = WorldSpec(
        step=STEP,
        object=_placed(articulated_object, plan.T_world_object),
        robot=PlacedRobot(
            urdf=robot.loaded,
            mechanism=mechanism,
            T_world_root=plan.T_world_base,
            apart=overlapping_links(robot.scene),
            locked={travel.joint: travel.rest for travel in mechanism.travels if travel.joint not in driven},
            arm=robot.robot.arm_joints,
            fingers=robot.robot.finger_joints,
            strongest=effort_limits(robot.arm.declared, robot.robot, load_settings().task.execution.effort),
            postures=(plan.reach[0], plan.pull[0], plan.pull[-1]),
            tool=robot.robot.tool,
            settings=Servos,
            smoothing=_FILTER_SHARE * CONTROL_STEP,
        ),
        point=_point(articulated_object, target),
    )
    return WorldFacts(spec=spec, dynamics=_dynamics(articulated_object, spec))


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
        body=fixed_together(articulated_object.declared, target.link),
    )


def _dynamics(articulated_object: ArticulatedObject, spec: WorldSpec) -> tuple[FloatArray, FloatArray]:
    """Damping and friction by what joints move and carry: MuJoCo tells that, whatever engine is asked for."""
    matrix, bias = mechanics(spec, articulated_object.scene.mechanism.rest)
    return joint_dynamics(articulated_object, np.diag(matrix).copy(), bias)
