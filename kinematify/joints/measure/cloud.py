"""Points around one edge, for the network that looks at shapes: of child, parent, the rest, and what the child carries.

Whole surfaces thinly, and the places where child and parent are nearest to each other more densely.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.geometry.sampling import SurfaceSamples
    from kinematify.joints.measure.workspace import PartCache
    from kinematify.robot.arrays import FloatArray, IntArray

    BoolArray = NDArray[np.bool_]

CHILD, PARENT, OTHER, CARRIED = range(4)

_CHILD, _PARENT, _OTHERS, _CARRIED = 160, 112, 64, 32
_NEAREST = 48  # of child and of parent, besides
_TRIED = 640  # samples among which the nearest are looked for
_AROUND_PARENT, _AROUND_OTHERS = 0.5, 0.7  # how far from the child's box points may lie, in diagonals of the child


@dataclass(frozen=True, kw_only=True, eq=False)
class Cloud:
    """Points of one edge, world frame."""

    points: FloatArray
    """[m], shape (m, 3)."""
    normals: FloatArray
    """Unit normals, outwards, shape (m, 3)."""
    gaps: FloatArray
    """Distance of the child's points from the parent and of all others from the child, in diagonals, shape (m,)."""
    labels: IntArray
    """CHILD, PARENT, OTHER or CARRIED, shape (m,)."""
    centre: FloatArray
    """Mean of the child's samples [m], shape (3,)."""
    parent_centre: FloatArray
    """The same of the parent [m], shape (3,)."""
    unit: float
    """Diagonal of the child's box [m]."""
    sizes: FloatArray
    """Logarithms of the child's diagonal over those of the parent and of the whole, shape (2,)."""


def point_cloud(cache: PartCache, parent: int, child: int, others: Sequence[int], unit: float) -> Cloud:
    """Sample the parts of one edge.

    Args:
        cache: Samples and distances of the parts.
        parent: Part that carries the child.
        child: Part that moves.
        others: Every other part that does not move with the child.
        unit: Diagonal of the child's box [m].
    """
    carried = [part for part in range(len(cache.assembly.parts)) if part not in {parent, child, *others}]
    own, its = cache.samples(child), cache.samples(parent)
    low, high = cache.assembly.parts[child].bounds
    beside = np.flatnonzero(_within(its.points, low, high, _AROUND_PARENT * unit))
    beside = beside if len(beside) >= _NEAREST else np.arange(len(its.points))
    every = np.arange(len(own.points))
    chosen = [
        (own, np.concatenate([_thinned(every, _CHILD), _nearest(cache, parent, own, every)]), parent, CHILD),
        (its, np.concatenate([_thinned(beside, _PARENT), _nearest(cache, child, its, beside)]), child, PARENT),
    ]
    points = [samples.points[index] for samples, index, _, _ in chosen]
    normals = [samples.normals[index] for samples, index, _, _ in chosen]
    gaps = [cache.distances(to, samples.points[index]) for samples, index, to, _ in chosen]
    labels = [np.full(len(index), label) for _, index, _, label in chosen]
    for parts, count, label in ((others, _OTHERS, OTHER), (carried, _CARRIED, CARRIED)):
        if not parts:
            continue
        some = [cache.samples(part) for part in parts]
        places, faces = (np.concatenate([getattr(item, name) for item in some]) for name in ("points", "normals"))
        index = _thinned(np.flatnonzero(_within(places, low, high, _AROUND_OTHERS * unit)), count)
        points.append(places[index])
        normals.append(faces[index])
        gaps.append(cache.distances(child, places[index]))
        labels.append(np.full(len(index), label))
    parent_low, parent_high = cache.assembly.parts[parent].bounds
    reaches = np.array([np.linalg.norm(parent_high - parent_low), cache.diagonal])
    return Cloud(
        points=np.concatenate(points),
        normals=np.concatenate(normals),
        gaps=np.concatenate(gaps) / unit,
        labels=np.concatenate(labels),
        centre=own.points.mean(axis=0),
        parent_centre=its.points.mean(axis=0),
        unit=unit,
        sizes=np.log(unit / reaches),
    )


def _within(points: FloatArray, low: FloatArray, high: FloatArray, slack: float) -> BoolArray:
    """Which points lie within a box that is grown by `slack` on all sides, shape (n,)."""
    return np.asarray(((points > low - slack) & (points < high + slack)).all(axis=1))


def _thinned(index: IntArray, count: int) -> IntArray:
    """At most `count` of the positions, spread evenly: samples lie in the order of a space-filling curve."""
    return index[:: max(1, -(-len(index) // count))]


def _nearest(cache: PartCache, part: int, samples: SurfaceSamples, index: IntArray) -> IntArray:
    """Those of the samples at the positions `index` that are nearest to a part."""
    tried = _thinned(index, _TRIED)
    order = np.argsort(cache.distances(part, samples.points[tried]), kind="stable")
    return tried[order[:_NEAREST]]
