"""Weighted statistics of the region in which two parts touch (paper III-D, first paragraphs)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import torch
from scipy.spatial import cKDTree

from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from torch import Tensor

    from kinematify.contact.graph import ContactSamples
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactRegion:
    """The contact region ``C``: samples of both parts with weights that decay with the distance to the other part."""

    first: ContactSamples
    """Samples of one part; at least one."""
    second: ContactSamples
    """Samples of the other part; at least one."""
    width: float
    """Standard deviation of the decay [m]."""

    @cached_property
    def points(self) -> FloatArray:
        """Both parts' samples, world frame [m], shape (n, 3)."""
        return np.concatenate([self.first.points, self.second.points])

    @cached_property
    def weights(self) -> FloatArray:
        """Share of every sample, shape (n,), sum 1: its area, decayed beyond the smallest distance."""
        distances = np.concatenate([self.first.distances, self.second.distances])
        areas = np.concatenate([self.first.areas, self.second.areas])
        decayed = areas * np.exp(-0.5 * ((distances - distances.min()) / self.width) ** 2)
        return np.asarray(decayed / decayed.sum(), dtype=np.float64)

    @cached_property
    def centroid(self) -> FloatArray:
        """mu_c, world frame [m], shape (3,)."""
        return np.asarray(self.weights @ self.points, dtype=np.float64)

    @cached_property
    def principal_axes(self) -> FloatArray:
        """Eigenvectors of the covariance Sigma in rows, smallest variance first, shape (3, 3).

        Each points to the side on which the region reaches farther, so that they turn with the object.
        """
        local = self.points - self.centroid
        _, vectors = np.linalg.eigh((self.weights[:, None] * local).T @ local)
        skew = self.weights @ (local @ vectors) ** 3
        return np.asarray((vectors * np.where(skew < 0.0, -1.0, 1.0)).T, dtype=np.float64)

    @cached_property
    def normal(self) -> FloatArray:
        """Unit contact normal: the mean of the difference vectors between nearest points, shape (3,).

        Where all nearest points coincide, the mean face normal takes its place, and where that vanishes as well, the
        direction of smallest variance.
        """
        forward = self.second.points[cKDTree(self.second.points).query(self.first.points)[1]] - self.first.points
        backward = self.second.points - self.first.points[cKDTree(self.first.points).query(self.second.points)[1]]
        differences = self.weights @ np.concatenate([forward, backward])
        normals = self.weights @ np.concatenate([self.first.normals, -self.second.normals])
        for candidate, least in ((differences, 1e-9 * self.width), (normals, 1e-9)):
            length = float(np.linalg.norm(candidate))
            if length > least:
                return np.asarray(candidate / length, dtype=np.float64)
        return np.asarray(self.principal_axes[0], dtype=np.float64)

    @cached_property
    def radius(self) -> float:
        """Mean distance of the region from its centroid [m]."""
        return float(self.weights @ lengths_of(self.points - self.centroid))

    def lever(self, axis: FloatArray, pivot: FloatArray) -> float:
        """Mean distance of the region from a line [m]: how far the contact moves per radian."""
        return float(self.weights @ lengths_of(crossed(axis, self.points - pivot)))


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
