"""Batches of rigid motions: agreement with single ones, gradients."""

from __future__ import annotations

import numpy as np
import torch
from hypothesis import given
from hypothesis import strategies as st

from kinematify.paper.contact_region import cross_matrix, revolve, rotation_matrix, slide, unit_axis
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import joint_motion

directions = st.tuples(*[st.floats(-10.0, 10.0)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) > 0.1)


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
            for kind, moved in ((JointType.REVOLUTE, turned), (JointType.PRISMATIC, slid)):
                matrix = joint_motion(kind, axes[k].numpy(), pivots[k].numpy(), float(motions[m]))
                assert np.allclose(moved[k, m], (homogeneous @ matrix.T)[:, :3])


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
