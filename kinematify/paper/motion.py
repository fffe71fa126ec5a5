"""Rigid motions of joints as differentiable batches (paper III-D)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import torch

if TYPE_CHECKING:
    from torch import Tensor


def unit_axis(free: Tensor) -> Tensor:
    """Unit axis u = a / |a| for an unconstrained a, shape (..., 3); torch derives the paper's Jacobian from it."""
    unit: Tensor = free / torch.linalg.vector_norm(free, dim=-1, keepdim=True)
    return unit


def cross_matrix(axes: Tensor) -> Tensor:
    """Cross-product matrix: [u]_x with [u]_x v = u x v, shape (..., 3) -> (..., 3, 3)."""
    x, y, z = axes.unbind(-1)
    zero = torch.zeros_like(x)
    rows = [torch.stack(row, -1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))]
    return torch.stack(rows, -2)


def rotation_matrix(axes: Tensor, angles: Tensor) -> Tensor:
    """R(u, theta) = cos I + sin [u]_x + (1 - cos) u u^T.

    Args:
        axes: Unit axes, shape (..., 3).
        angles: Angles [rad], shape that broadcasts with that of `axes` without its last dimension.

    Returns:
        Rotations, shape (..., 3, 3).
    """
    cos, sin = torch.cos(angles)[..., None, None], torch.sin(angles)[..., None, None]
    outer = axes[..., :, None] * axes[..., None, :]
    identity = torch.eye(3, dtype=axes.dtype, device=axes.device)
    return cos * identity + sin * cross_matrix(axes) + (1.0 - cos) * outer


def revolve(points: Tensor, pivots: Tensor, axes: Tensor, angles: Tensor) -> Tensor:
    """Turn points by every angle about every axis: y = p + R(u, theta) (x - p).

    Args:
        points: World frame, shape (N, 3).
        pivots: Points on the axes, world frame, shape (K, 3).
        axes: Unit axes, world frame, shape (K, 3).
        angles: [rad], shape (K, M), or (M,) for the same angles about every axis.

    Returns:
        Moved points, shape (K, M, N, 3), in the unit of `points`.
    """
    rotations = rotation_matrix(axes[:, None, :], angles)
    about = pivots[:, None, None, :]
    return about + torch.einsum("kmij,knj->kmni", rotations, points - pivots[:, None, :])


def slide(points: Tensor, axes: Tensor, distances: Tensor) -> Tensor:
    """Shift points by every distance along every axis: y = x + t u.

    Args:
        points: World frame, shape (N, 3).
        axes: Unit axes, world frame, shape (K, 3).
        distances: In the unit of `points`, shape (K, M), or (M,) for the same distances along every axis.

    Returns:
        Moved points, shape (K, M, N, 3), in the unit of `points`.
    """
    shifts = distances[..., None] * axes[:, None, :]
    return points + shifts[:, :, None, :]
