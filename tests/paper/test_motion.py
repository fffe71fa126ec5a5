"""Rigid motions: laws of rotations, agreement of torch and numpy, gradients."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from kinematify.paper.motion import (
    cross_matrix,
    prismatic_transform,
    revolute_transform,
    revolve,
    rotation_matrix,
    slide,
    unit_axis,
)

coordinates = st.floats(-10.0, 10.0)
vectors = st.tuples(coordinates, coordinates, coordinates).map(np.array)
directions = vectors.filter(lambda vector: np.linalg.norm(vector) > 0.1)
angles = st.floats(-10.0, 10.0)


@given(directions, vectors, angles)
def test_a_revolute_motion_is_rigid_keeps_its_axis_and_has_an_inverse(
    axis: np.ndarray, pivot: np.ndarray, angle: float
) -> None:
    transform = revolute_transform(axis, pivot, angle)
    assert np.allclose(transform[:3, :3] @ transform[:3, :3].T, np.eye(3))
    assert np.linalg.det(transform[:3, :3]) == pytest.approx(1.0)
    for point in (pivot, pivot + axis):
        assert np.allclose(transform @ [*point, 1.0], [*point, 1.0], atol=1e-9)
    assert np.allclose(revolute_transform(axis, pivot, -angle) @ transform, np.eye(4), atol=1e-9)
    assert np.allclose(revolute_transform(axis, pivot, angle + 2.0 * np.pi), transform, atol=1e-9)
    assert np.allclose(revolute_transform(-axis, pivot, -angle), transform, atol=1e-9)


@given(directions, angles)
def test_the_rotation_is_the_one_of_an_independent_library(axis: np.ndarray, angle: float) -> None:
    expected = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix()
    assert np.allclose(revolute_transform(axis, np.zeros(3), angle)[:3, :3], expected, atol=1e-9)


@given(directions, st.floats(-10.0, 10.0))
def test_a_prismatic_motion_moves_by_its_distance_and_has_an_inverse(axis: np.ndarray, distance: float) -> None:
    transform = prismatic_transform(axis, distance)
    assert np.array_equal(transform[:3, :3], np.eye(3))
    assert np.linalg.norm(transform[:3, 3]) == pytest.approx(abs(distance))
    assert np.allclose(prismatic_transform(axis, -distance) @ transform, np.eye(4))


@pytest.mark.parametrize("axis", [np.zeros(3), np.array([np.nan, 0.0, 1.0])])
def test_an_axis_without_direction_is_refused(axis: np.ndarray) -> None:
    with pytest.raises(ValueError, match="direction"):
        revolute_transform(axis, np.zeros(3), 1.0)
    with pytest.raises(ValueError, match="direction"):
        prismatic_transform(axis, 1.0)


def batch() -> tuple[torch.Tensor, ...]:
    generator = torch.Generator().manual_seed(0)
    points, pivots, free = (torch.randn((n, 3), generator=generator, dtype=torch.float64) for n in (7, 4, 4))
    return points, pivots, free, torch.tensor([-1.0, 0.3, 2.0], dtype=torch.float64)


def test_batches_agree_with_single_matrices() -> None:
    points, pivots, free, motions = batch()
    axes = unit_axis(free)
    turned, slid = revolve(points, pivots, axes, motions), slide(points, axes, motions)
    assert turned.shape == slid.shape == (4, 3, 7, 3)
    homogeneous = np.concatenate([points.numpy(), np.ones((7, 1))], axis=1)
    for k in range(4):
        for m in range(3):
            matrix = revolute_transform(axes[k].numpy(), pivots[k].numpy(), float(motions[m]))
            assert np.allclose(turned[k, m], (homogeneous @ matrix.T)[:, :3])
            matrix = prismatic_transform(axes[k].numpy(), float(motions[m]))
            assert np.allclose(slid[k, m], (homogeneous @ matrix.T)[:, :3])


def test_every_candidate_may_have_its_own_motions() -> None:
    points, pivots, free, motions = batch()
    axes, own = unit_axis(free), torch.arange(1.0, 5.0, dtype=torch.float64)[:, None] * motions
    for k in range(4):
        one = slice(k, k + 1)
        assert torch.allclose(revolve(points, pivots, axes, own)[one], revolve(points, pivots[one], axes[one], own[k]))
        assert torch.allclose(slide(points, axes, own)[one], slide(points, axes[one], own[k]))


def test_gradients_agree_with_differences() -> None:
    points, pivots, free, motions = (tensor.requires_grad_() for tensor in batch())
    assert torch.autograd.gradcheck(lambda x, p, a, t: revolve(x, p, unit_axis(a), t), (points, pivots, free, motions))
    assert torch.autograd.gradcheck(lambda x, a, t: slide(x, unit_axis(a), t), (points, free, motions))


@given(directions)
def test_the_jacobian_of_the_unit_axis_is_that_of_the_paper(free: np.ndarray) -> None:
    a = torch.from_numpy(free.astype(np.float64))
    length = a.norm()
    expected = (torch.eye(3, dtype=torch.float64) - torch.outer(a, a) / length**2) / length
    assert torch.allclose(torch.autograd.functional.jacobian(unit_axis, a), expected, atol=1e-12)


def test_cross_matrix_is_the_cross_product() -> None:
    _, pivots, free, _ = batch()
    assert torch.allclose(torch.einsum("kij,kj->ki", cross_matrix(free), pivots), torch.linalg.cross(free, pivots))
    identity = rotation_matrix(unit_axis(free), torch.zeros(4, dtype=torch.float64))
    assert torch.allclose(identity, torch.eye(3, dtype=torch.float64).expand(4, 3, 3))
