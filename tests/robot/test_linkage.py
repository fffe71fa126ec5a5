"""Motion of closed chains, against lengths that can be calculated by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import linkages, loop_gaps, with_closures
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.robot import Joint, Link, LoopJoint, Robot, forward_kinematics

Y = np.array([0.0, 1.0, 0.0])


def hinge(name: str, parent: str, child: str, at: tuple[float, float], limits: tuple[float, float]) -> Joint:
    T = np.eye(4)
    T[[0, 2], 3] = at
    return Joint(name=name, kind=JointType.REVOLUTE, parent=parent, child=child, T_parent_child=T, axis=Y,
                 lower=limits[0], upper=limits[1])  # fmt: skip


def four_bar(crank: float, rocker_at: float, pin: tuple[float, float], limits: float = 3.0) -> Robot:
    """A crank that stands up at the origin, a rocker, and a bar from the crank's end to a pin on the rocker."""
    joints = (
        hinge("crank", "ground", "crank", (0, 0), (-limits, limits)),
        hinge("bar", "crank", "bar", (0, crank), (-math.inf, math.inf)),
        hinge("rocker", "ground", "rocker", (rocker_at, 0), (-3, 3)),
    )
    ends = np.array([pin[0], 0, pin[1] - crank]), np.array([pin[0] - rocker_at, 0, pin[1]])
    links = tuple(Link(name=name) for name in ("ground", "crank", "bar", "rocker"))
    loop = LoopJoint(name="pin", links=("bar", "rocker"), points=ends)
    return Robot(name="four bars", links=links, joints=joints, loops=(loop,))


def test_a_parallelogram_keeps_its_bar_level_over_its_whole_range() -> None:
    robot = four_bar(0.1, 0.2, (0.2, 0.1), limits=1.2)
    (linkage,) = linkages(robot)
    assert (linkage.mobility, linkage.driver) == (1, "crank")
    columns = dict(zip(linkage.joints, linkage.curve.T, strict=True))
    np.testing.assert_allclose(columns["rocker"], columns["crank"], atol=1e-6)
    np.testing.assert_allclose(columns["bar"], -columns["crank"], atol=1e-6)
    assert columns["crank"][[0, -1]] == pytest.approx([-1.2, 1.2], abs=1e-6)


def test_the_rocker_of_a_crank_rocker_turns_back_where_lengths_say() -> None:
    crank, bar, rocker, ground = 0.04, 0.1, 0.08, 0.11
    # The pin is where circles about the crank's end and about the rocker's foot meet.
    apart = math.hypot(ground, crank)
    along = (bar**2 - rocker**2 + apart**2) / (2 * apart)
    aside = math.sqrt(bar**2 - along**2)
    unit = np.array([ground, -crank]) / apart
    pin = np.array([0, crank]) + along * unit + aside * np.array([-unit[1], unit[0]])
    robot = four_bar(crank, ground, (float(pin[0]), float(pin[1])), limits=math.inf)
    closed = with_closures(robot)
    assert [joint.name for joint in closed.leaders] == ["crank"]
    (linkage,) = linkages(robot)
    assert linkage.turns_around
    values = np.linspace(0.0, 4.0 * math.pi, 200)
    found = LeaderMechanism(robot=closed).all_values(values[:, None])
    angles = found[:, 2]
    # Extreme where crank and bar are in line: the triangle of ground, rocker and their sum or difference.
    swing = [math.acos((ground**2 + rocker**2 - (bar + s * crank) ** 2) / (2 * ground * rocker)) for s in (1, -1)]
    assert np.ptp(angles) == pytest.approx(abs(swing[0] - swing[1]), abs=2e-3)
    gaps = [loop_gaps(closed, {"crank": float(value)})["pin"] for value in values]
    assert max(gaps) < 1e-4 * ground


def test_what_follows_along_a_curve_is_where_forward_kinematics_puts_it() -> None:
    robot = with_closures(four_bar(0.1, 0.25, (0.21, 0.12), limits=0.6))
    row = LeaderMechanism(robot=robot).all_values(np.array([[0.4]]))[0]
    poses = forward_kinematics(robot, {"crank": 0.4})
    rocker = math.atan2(poses["rocker"][0, 2], poses["rocker"][0, 0])
    assert row[2] == pytest.approx(rocker, abs=1e-9)


def test_a_chain_ends_where_a_passive_joint_reaches_its_limit() -> None:
    robot = four_bar(0.1, 0.2, (0.2, 0.1))
    short = replace(robot, joints=tuple(replace(j, upper=0.3) if j.name == "rocker" else j for j in robot.joints))
    (linkage,) = linkages(short)
    assert "rocker" in linkage.stops
    column = linkage.joints.index("rocker")
    assert linkage.curve[:, column].max() == pytest.approx(0.3, abs=1e-6)


def test_two_bars_with_a_third_pin_between_them_are_a_rigid_triangle() -> None:
    joints = (hinge("one", "ground", "one", (0, 0), (-1, 1)), hinge("two", "ground", "two", (0.1, 0), (-1, 1)))
    ends = np.array([0.05, 0, 0.08]), np.array([-0.05, 0, 0.08])
    robot = Robot(
        name="triangle",
        links=tuple(Link(name=name) for name in ("ground", "one", "two")),
        joints=joints,
        loops=(LoopJoint(name="pin", links=("one", "two"), points=ends),),
    )
    (linkage,) = linkages(robot)
    assert (linkage.mobility, linkage.driver) == (0, None)
    assert with_closures(robot) is robot
