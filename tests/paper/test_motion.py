"""Batches of rigid motions: agreement with single ones, gradients."""

from __future__ import annotations

import numpy as np
import torch

from kinematify.paper.contact_region import revolve, slide, unit_axis
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import joint_motion


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
