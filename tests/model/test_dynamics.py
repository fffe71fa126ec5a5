"""Friction, damping and weight of the joints that are written."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from kinematify.model.dynamics import HAND_TORQUE, joint_load, mass_matrix, with_dynamics
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Inertial, Joint, Link, Mimic, Robot


def body(name: str, mass: float, center: tuple[float, float, float]) -> Link:
    return Link(
        name=name, inertial=Inertial(mass=mass, center_of_mass=np.array(center), tensor=0.01 * mass * np.eye(3))
    )


def hinge(child: str, parent: str, axis: tuple[float, float, float], lower: float, upper: float) -> Joint:
    return Joint(
        name=f"{child}_joint",
        kind=JointType.REVOLUTE,
        parent=parent,
        child=child,
        T_parent_child=np.eye(4),
        axis=np.array(axis),
        lower=lower,
        upper=upper,
        effort=100.0,
        velocity=3.0,
    )


def lid(mass: float, lower: float) -> Robot:
    """Its middle is 0.5 m beside the hinge; it opens upwards."""
    return Robot(
        name="box",
        links=(body("base", 10.0, (0.0, 0.0, 0.0)), body("lid", mass, (0.5, 0.0, 0.0))),
        joints=(hinge("lid", "base", (0.0, -1.0, 0.0), lower, 1.5),),
    )


def test_the_load_is_weight_times_arm() -> None:
    robot = lid(2.0, -0.5)
    load = joint_load(robot, robot.joints[0])
    assert load.largest == pytest.approx(2.0 * 9.81 * 0.5)
    assert load.inertia == pytest.approx(2.0 * 0.5**2 + 0.02)


@pytest.mark.parametrize("aside", [-1.0e-4, 0.0, 1.0e-4])
def test_a_limit_holds_what_stands_on_its_head_on_one_side_alone(aside: float) -> None:
    robot = lid(2.0, 0.0)
    upright = replace(robot, links=(robot.links[0], body("lid", 2.0, (aside, 0.0, 0.5))))
    pull = 2.0 * 9.81 * 0.5 * np.sin(0.1)
    assert joint_load(upright, upright.joints[0]).at_rest == pytest.approx(pull, rel=0.01), "over its hinge it falls"


@pytest.mark.parametrize("mass", [0.5, 5.0, 200.0])
@pytest.mark.parametrize("lower", [0.0, -0.5])
def test_a_hand_lifts_what_friction_holds(mass: float, lower: float) -> None:
    made = with_dynamics(lid(mass, lower))
    load, joint = joint_load(made, made.joints[0]), made.joints[0]
    assert joint.friction is not None
    assert joint.friction >= load.at_rest
    assert load.largest + joint.friction < HAND_TORQUE


def test_what_is_too_heavy_for_a_hand_has_a_motor_where_it_may() -> None:
    by_hand, powered = (with_dynamics(lid(200.0, 0.0), powered=flag) for flag in (False, True))
    masses = [robot.link_by_name["lid"].inertial.mass for robot in (by_hand, powered)]
    assert masses[0] < 5.0
    assert masses[1] == 200.0
    assert powered.joints[0].effort > joint_load(powered, powered.joints[0]).largest


def test_what_leads_others_has_the_effort_to_move_them() -> None:
    alone = lid(0.5, 0.0)
    other = replace(
        hinge("other", "base", (0.0, -1.0, 0.0), 0.0, 1.5), mimic=Mimic(joint="lid_joint", multiplier=2.0, offset=0.0)
    )
    both = replace(alone, links=(*alone.links, body("other", 0.5, (0.5, 0.0, 0.0))), joints=(*alone.joints, other))
    single, leader = (with_dynamics(robot).joints[0].effort for robot in (alone, both))
    assert single is not None
    assert single < 100.0
    assert leader == pytest.approx(min(3.0 * single, 100.0), rel=0.01), "its own load, and twice that of its follower"


@pytest.mark.parametrize("links", [4, 11, 20])
def test_damping_of_a_long_chain_stays_stable_where_it_is_that_of_the_last_step(links: int) -> None:
    names = [f"link_{k}" for k in range(links)]
    moved = np.eye(4)
    moved[0, 3] = 1.0
    chain = Robot(
        name="chain",
        links=tuple(body(name, 1.0, (0.5, 0.0, 0.0)) for name in names),
        joints=tuple(
            replace(hinge(child, parent, (0.0, 0.0, 1.0), -1.0, 1.0), T_parent_child=moved)
            for parent, child in pairwise(names)
        ),
    )
    made = with_dynamics(chain)
    damping = np.diag([joint.damping or 0.0 for joint in made.joints])
    decay = np.linalg.eigvals(np.linalg.solve(mass_matrix(made), damping)) / 240.0
    assert np.abs(decay).max() < 1.05
    assert damping.min(where=np.eye(links - 1, dtype=bool), initial=np.inf) > 0.0
