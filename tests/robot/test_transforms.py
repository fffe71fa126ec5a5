"""Rotations in all notations are those of an independent library, and read back as themselves."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from kinematify.robot.transforms import (
    quaternion_of,
    rotation_about,
    rotation_from_rpy,
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
