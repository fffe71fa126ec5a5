"""Motions of joints: laws of rigid motions, and agreement with an independent library."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Joint
from kinematify.robot.transforms import joint_motion

coordinates = st.floats(-10.0, 10.0)
vectors = st.tuples(coordinates, coordinates, coordinates).map(np.array)
directions = vectors.filter(lambda vector: np.linalg.norm(vector) > 0.1).map(lambda v: v / np.linalg.norm(v))
angles = st.floats(-10.0, 10.0)


@given(directions, vectors, angles)
def test_a_revolute_motion_is_rigid_keeps_its_axis_and_has_an_inverse(
    axis: np.ndarray, pivot: np.ndarray, angle: float
) -> None:
    transform = joint_motion(JointType.REVOLUTE, axis, pivot, angle)
    assert np.allclose(transform[:3, :3] @ transform[:3, :3].T, np.eye(3))
    assert np.linalg.det(transform[:3, :3]) == pytest.approx(1.0)
    for point in (pivot, pivot + axis):
        assert np.allclose(transform @ [*point, 1.0], [*point, 1.0], atol=1e-9)
    assert np.allclose(joint_motion(JointType.REVOLUTE, axis, pivot, -angle) @ transform, np.eye(4), atol=1e-9)
    assert np.allclose(joint_motion(JointType.REVOLUTE, axis, pivot, angle + 2.0 * np.pi), transform, atol=1e-9)
    assert np.allclose(joint_motion(JointType.REVOLUTE, -axis, pivot, -angle), transform, atol=1e-9)


@given(directions, st.floats(-10.0, 10.0))
def test_a_prismatic_motion_moves_by_its_distance_and_has_an_inverse(axis: np.ndarray, distance: float) -> None:
    transform = joint_motion(JointType.PRISMATIC, axis, np.ones(3), distance)
    assert np.array_equal(transform[:3, :3], np.eye(3))
    assert np.linalg.norm(transform[:3, 3]) == pytest.approx(abs(distance))
    assert np.allclose(joint_motion(JointType.PRISMATIC, axis, np.ones(3), -distance) @ transform, np.eye(4))


@pytest.mark.parametrize(
    ("end", "endless"),
    [
        (math.inf, True),
        (10.0, True),
        (9.42478, True),
        (8 * math.pi, True),
        (2 * math.pi, False),
        (355.0, False),
        (3.49, False),
    ],
)
def test_a_hinge_is_endless_where_its_limits_say_that_there_are_none(end: float, endless: bool) -> None:
    joint = Joint(
        name="a", kind=JointType.REVOLUTE, parent="b", child="c", T_parent_child=np.eye(4), lower=-end, upper=end
    )
    assert joint.endless is endless
    assert replace(joint, lower=0.0).endless is False
    assert replace(joint, kind=JointType.PRISMATIC).endless is False
