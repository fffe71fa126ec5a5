"""Journals: a pin in a bore, a barrel in its knuckles, a shaft in its boss; hinge hardware where it is modelled.

A bearing (`joints.bearings`) asks for round surface on both parts, which two round outlines that merely lie on each
other have as well: a seat on its bowl, a porthole on its mouth. A journal asks for more: the two round surfaces must
*face* each other across the clearance, nearly all around one line. However small it is beside the part, it holds it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from kinematify.contact.graph import pair
from kinematify.geometry.sampling import SurfaceSamples
from kinematify.joints.bearings.line import meeting_lines
from kinematify.joints.bearings.refine_lines import line_frames
from kinematify.robot.vectors import crossed, lengths_of, triangle_normals, unit

if TYPE_CHECKING:
    from kinematify.config import JointsConfig, JournalConfig
    from kinematify.joints.features.workspace import PartCache
    from kinematify.robot.arrays import FloatArray

_LEAST = 6  # faces all around: fewer are the sides of a box


@dataclass(frozen=True, kw_only=True, eq=False)
class Journal:
    """A line about which surface of a child is held by surface of its parent, world frame."""

    axis: FloatArray
    """Unit direction, shape (3,)."""
    pivot: FloatArray
    """Point on the line, in the middle of what is held [m], shape (3,)."""
    radius: float
    """Of the surface that is held [m]."""
    coverage: float
    """Share of the full circle of directions in which it is held, in [0, 1]."""
    span: float
    """How far apart along the line its ends are held [m]."""


def held_journal(cache: PartCache, parent: int, child: int, size: float, config: JointsConfig) -> Journal | None:
    """Return what the parent holds the child by, within the band of their contact; None where they have none.

    Args:
        cache: The parts.
        parent: Index of the parent.
        child: Index of the child.
        size: Largest extent of the child [m].
        config: The band of contacts, and tolerances of journals.
    """
    edge = cache.graph.by_pair.get(pair(parent, child))
    if edge is None:
        return None
    facing = facing_faces(cache, parent, child, edge.gap + config.contact_band * cache.diagonal, config.journal)
    return find_journal(facing, size, config.journal)


def facing_faces(cache: PartCache, parent: int, child: int, reach: float, config: JournalConfig) -> SurfaceSamples:
    """Centroids, normals and areas of the child's faces before which the parent's nearest surface lies and looks back.

    Normals may point either way: many meshes are not oriented.

    Args:
        cache: Distance trees of the parts.
        parent: Index of the parent.
        child: Index of the child.
        reach: Largest gap [m].
        config: Tolerance and the largest number of faces that are looked at.
    """
    part = cache.assembly.parts[child]
    corners = part.vertices[part.faces]
    centroids = corners.mean(axis=1)
    lower, upper = cache.assembly.parts[parent].bounds
    near = np.flatnonzero(((centroids > lower - reach) & (centroids < upper + reach)).all(axis=1))
    near = near[:: max(1, -(-len(near) // config.faces))]
    area_normals = 0.5 * triangle_normals(corners[near])
    areas = lengths_of(area_normals)
    near, area_normals, areas = near[areas > 0], area_normals[areas > 0], areas[areas > 0]
    points, normals = centroids[near], area_normals / areas[:, None]
    distance, closest, other = cache.closest(parent, points)
    ahead = np.abs(np.einsum("ij,ij->i", closest - points, normals)) > config.straight * distance
    opposite = np.abs(np.einsum("ij,ij->i", other, normals)) > config.straight
    keep = (distance < reach) & ahead & opposite
    return SurfaceSamples(points=points[keep], normals=normals[keep], areas=areas[keep], faces=near[keep])


def find_journal(facing: SurfaceSamples, size: float, config: JournalConfig) -> Journal | None:
    """Find the line about which the child is held all around over the longest span.

    Args:
        facing: Faces that look at the parent.
        size: Largest extent of the child [m].
        config: Tolerances.
    """
    if len(facing.areas) < _LEAST:
        return None
    # Lines where normals of neighbouring faces meet, and how far the first ones lie from them (`meeting_lines`).
    rng, tree = np.random.default_rng(0), cKDTree(facing.points)
    first = rng.integers(len(facing.areas), size=config.pairs)
    neighbours = tree.query(facing.points[first], k=min(config.neighbours, len(facing.areas)))[1]
    second = np.take_along_axis(neighbours, rng.integers(neighbours.shape[1], size=(config.pairs, 1)), axis=1)[:, 0]
    once = np.sort(np.unique(first * len(tree.data) + second, return_index=True)[1])
    lines, along = meeting_lines(facing.points, facing.normals, (first[once], second[once]), config.least_sine)
    radii = np.abs(along)
    keep = radii < config.largest * size
    tried = zip(line_frames(lines.axes[keep]), lines.points[keep], radii[keep], strict=True)
    found = [held for line in tried if (held := _journal(facing, *line, config)) is not None]
    best = max(found, key=lambda held: held.coverage * held.span, default=None)
    return None if best is None else _refined(facing, best, config)


def _journal(
    facing: SurfaceSamples, frame: FloatArray, pivot: FloatArray, radius: float, config: JournalConfig
) -> Journal | None:
    """The journal about the last axis of a frame (3, 3) with surface at about this radius, if that is round."""
    *basis, axis = frame
    fits = _fitting(facing, axis, pivot, radius, config)
    if np.count_nonzero(fits) < max(_LEAST, config.coverage * config.sectors):
        return None
    offset = facing.points[fits] - pivot
    angle = np.arctan2(offset @ basis[1], offset @ basis[0])
    sector = np.floor((angle + np.pi) / (2.0 * np.pi) * config.sectors).astype(np.int64) % config.sectors
    coverage = float(np.count_nonzero(np.bincount(sector))) / config.sectors
    if coverage < config.coverage:
        return None
    height = offset @ axis
    return Journal(
        axis=axis,
        pivot=pivot + 0.5 * float(height.min() + height.max()) * axis,
        radius=radius,
        coverage=coverage,
        span=float(np.ptp(height)) + radius,
    )


def _fitting(
    facing: SurfaceSamples, axis: FloatArray, pivot: FloatArray, radius: float, config: JournalConfig
) -> FloatArray:
    """Which faces lie at a radius and look along it, shape (n,)."""
    offset = facing.points - pivot
    radial = offset - (offset @ axis)[:, None] * axis
    length = lengths_of(radial)
    along = np.abs(np.einsum("ij,ij->i", radial, facing.normals)) > np.cos(config.normal_tolerance) * length
    return np.asarray(along & (np.abs(length - radius) < config.radius_tolerance * radius))


def _refined(facing: SurfaceSamples, journal: Journal, config: JournalConfig) -> Journal | None:
    """Least squares: the direction least along the fitting normals, then the point where the normals meet.

    None for a belt of a ball, whose normals lean along every line: it turns about any of them.
    """
    axis, pivot = journal.axis, journal.pivot
    for _ in range(3):
        fits = _fitting(facing, axis, pivot, journal.radius, config)
        points, normals, weights = facing.points[fits], facing.normals[fits], facing.areas[fits]
        if len(points) < _LEAST:
            break
        weights = weights / weights.sum()
        leaning, directions = np.linalg.eigh((normals * weights[:, None]).T @ normals)
        if leaning[0] > config.leaning:
            return None
        axis = directions[:, 0]
        tangents = unit(crossed(axis, normals))
        system = (tangents * weights[:, None]).T @ tangents
        aim = (tangents * weights[:, None]).T @ np.einsum("ij,ij->i", tangents, points)
        along = float(pivot @ axis)
        pivot = np.linalg.lstsq(system, aim, rcond=1e-6)[0]
        pivot = pivot + (along - float(pivot @ axis)) * axis
    return replace(journal, axis=axis, pivot=pivot)
