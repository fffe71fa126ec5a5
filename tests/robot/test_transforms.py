"""Rotations in all notations are those of an independent library, and read back as themselves."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from kinematify.robot.transforms import (
    quaternion_of,
    rotation_about,
    rotation_from_quaternion,
    rotation_from_rpy,
    rotation_from_x,
    rpy_of,
)

angles = st.one_of(st.floats(-np.pi, np.pi), st.sampled_from([0.0, 0.5 * np.pi, -0.5 * np.pi, np.pi, 1e-9, -1e-12]))
turns = st.tuples(angles, angles, angles).map(np.array)


@given(turns)
def test_rotations_are_those_of_scipy(rpy: np.ndarray) -> None:
    rotation = Rotation.from_euler("xyz", rpy).as_matrix()
    np.testing.assert_allclose(rotation_from_rpy(rpy), rotation, atol=1e-14)
    expected = Rotation.from_matrix(rotation).as_quat(canonical=True, scalar_first=True)
    found = quaternion_of(rotation)
    assert found[0] >= 0.0
    assert abs(found @ expected) > 1.0 - 1e-12  # w = 0 leaves the sign open
    np.testing.assert_array_equal(quaternion_of(rotation, real_last=True), [*found[1:], found[0]])
    vector = Rotation.from_euler("xyz", rpy).as_rotvec()
    angle = float(np.linalg.norm(vector))
    if angle > 0.0:
        np.testing.assert_allclose(rotation_about(vector / angle, angle), rotation, atol=1e-12)


@given(turns)
def test_rotations_read_back_as_themselves(rpy: np.ndarray) -> None:
    rotation = rotation_from_rpy(rpy)
    np.testing.assert_allclose(rotation_from_rpy(rpy_of(rotation)), rotation, atol=1e-9)
    np.testing.assert_allclose(rotation_from_quaternion(3.0 * quaternion_of(rotation)), rotation, atol=1e-12)


@given(turns)
def test_x_is_taken_to_any_direction(rpy: np.ndarray) -> None:
    axis = rotation_from_rpy(rpy)[:, 0]
    rotation = rotation_from_x(axis)
    np.testing.assert_allclose(rotation @ [1.0, 0.0, 0.0], axis, atol=1e-11)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) > 0.0


def test_many_quaternions_are_read_at_once() -> None:
    quaternions = np.random.default_rng(1).normal(size=(2, 5, 4))
    found = rotation_from_quaternion(quaternions)
    assert found.shape == (2, 5, 3, 3)
    expected = Rotation.from_quat(quaternions.reshape(-1, 4), scalar_first=True).as_matrix()
    np.testing.assert_allclose(found.reshape(-1, 3, 3), expected, atol=1e-14)
