"""Weighted statistics of the region in which two parts touch (paper III-D, first paragraphs)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
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
