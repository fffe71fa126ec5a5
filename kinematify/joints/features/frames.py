"""Box frames: which three directions a part is built along, how far it reaches, and what sticks out of it.

A part that is not square to the body (ajar, or tilted by joints above it) has its own frame; a part that is nearly
square to its parent takes the parent's frame, because a handle or a slanted side tilts the smallest box by 5 to 40 deg.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from kinematify.robot.vectors import crossed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config import FramesConfig
    from kinematify.geometry.sampling import SurfaceSamples
    from kinematify.robot.arrays import BoolArray, FloatArray


UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, kw_only=True, eq=False)
class BoxFrame:
    """A box around a part along three directions, and the dense slab inside it."""

    axes: FloatArray
    """Unit axes in the world frame, one per row, right-handed, shape (3, 3)."""
    lower: FloatArray
    """Lower corner of the part in this frame [m], shape (3,)."""
    upper: FloatArray
    """Upper corner of the part in this frame [m], shape (3,)."""
    slab_lower: FloatArray
    """Lower corner without what sticks out of the thin direction (handles) [m], shape (3,)."""
    slab_upper: FloatArray
    """Upper corner without what sticks out of the thin direction (handles) [m], shape (3,)."""

    @property
    def extents(self) -> FloatArray:
        """Sides of the slab [m], shape (3,)."""
        return self.slab_upper - self.slab_lower

    @property
    def thin(self) -> int:
        """Index of the shortest side of the slab."""
        return int(np.argmin(self.extents))

    @property
    def thin_axis(self) -> FloatArray:
        """Unit direction of the shortest side of the slab in the world frame, shape (3,)."""
        return np.asarray(self.axes[self.thin])

    @property
    def diagonal(self) -> float:
        """Diagonal of the whole box [m]."""
        return float(np.linalg.norm(self.upper - self.lower))

    @property
    def centre(self) -> FloatArray:
        """Centre of the slab in the world frame [m], shape (3,)."""
        return 0.5 * (self.slab_lower + self.slab_upper) @ self.axes

    @property
    def is_level_plate(self) -> bool:
        """True if the part is thin upwards, as what is trodden on."""
        sides = np.sort(self.extents)
        return bool(abs(float(self.thin_axis @ UP)) > np.cos(np.radians(30.0)) and sides[0] < 0.5 * sides[1])

    def local(self, points: FloatArray) -> FloatArray:
        """Coordinates of world points (n, 3) in this frame [m]."""
        return points @ self.axes.T


def body_axes(normals: FloatArray, areas: FloatArray) -> FloatArray:
    """Upright axes turned about z by the dominant horizontal normals, so that a turned object changes nothing.

    The angle is that of the area-weighted mean of exp(4 i theta), over 4: walls a quarter turn apart agree.

    Args:
        normals: Unit normals of surface samples, shape (n, 3).
        areas: Area of each sample [m^2], shape (n,).

    Returns:
        Unit axes, one per row, the last one up, shape (3, 3).
    """
    horizontal = np.hypot(normals[:, 0], normals[:, 1])
    theta = np.arctan2(normals[:, 1], normals[:, 0])
    weight = areas * np.where(horizontal > np.cos(np.radians(20.0)), 1.0, 0.0)
    mean = np.sum(weight * np.exp(4j * theta))
    angle = float(np.angle(mean)) / 4.0 if abs(mean) > 1e-9 * areas.sum() else 0.0
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def box_frame(
    vertices: FloatArray, samples: SurfaceSamples, preferred: Sequence[FloatArray], config: FramesConfig
) -> BoxFrame:
    """Choose a part's frame.

    Args:
        vertices: Vertices of the part, world frame [m], shape (V, 3).
        samples: Surface samples of the part.
        preferred: Axes (3, 3) to prefer in this order: the parent's, the body's.
        config: `volume_slack`, `handle_share` and `handle_gap`.

    Returns:
        The first preferred frame whose box is at most `volume_slack` larger than the smallest, else the smallest.
    """
    corners = hull_points(vertices)
    # The smallest box has a face along a large flat direction of the surface.
    tried = [_rectangle_axes(corners, normal) for normal in (*_flat_directions(samples), UP)]
    own = min(tried, key=lambda axes: _box_volume(corners, axes))
    limit = (1.0 + config.volume_slack) * _box_volume(corners, own)
    axes = next((frame for frame in preferred if _box_volume(corners, frame) <= limit), own)
    local = corners @ axes.T
    lower, upper = local.min(axis=0), local.max(axis=0)
    # What sticks out along the direction in which the bulk of the part is thinnest is cut off.
    spans = [_dense_span(lower[k], upper[k], axes[k], samples, config) for k in range(3)]
    thin = int(np.argmin([high - low for low, high in spans]))
    slab_lower, slab_upper = lower.copy(), upper.copy()
    slab_lower[thin], slab_upper[thin] = spans[thin]
    return BoxFrame(axes=axes, lower=lower, upper=upper, slab_lower=slab_lower, slab_upper=slab_upper)


def hull_points(points: FloatArray) -> FloatArray:
    """Corners of the convex hull of points (n, 3); the points themselves where they are flat."""
    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except (QhullError, ValueError):
        return np.unique(points, axis=0)


def _flat_directions(samples: SurfaceSamples, count: int = 6) -> list[FloatArray]:
    """Directions that hold most surface area, opposite ones taken together."""
    left = np.ones(len(samples.areas), dtype=bool)
    found: list[FloatArray] = []
    for _ in range(count):
        if not left.any():
            break
        normals, areas = samples.normals[left], samples.areas[left]
        probes = normals[:: max(1, len(normals) // 64)]
        near = np.abs(probes @ normals.T) > np.cos(np.radians(4.0))
        best = probes[int(np.argmax(near @ areas))]
        close = np.abs(normals @ best) > np.cos(np.radians(4.0))
        mean = np.sum(normals[close] * (areas[close] * np.sign(normals[close] @ best))[:, None], axis=0)
        found.append(mean / np.linalg.norm(mean))
        left[np.flatnonzero(left)[close]] = False
    return found


def _rectangle_axes(corners: FloatArray, normal: FloatArray) -> FloatArray:
    """Axes of the smallest rectangle around the points seen along `normal`, which becomes the last row."""
    helper = np.eye(3)[int(np.argmin(np.abs(normal)))]
    first = crossed(helper, normal)
    first /= np.linalg.norm(first)
    plane = np.stack([first, crossed(normal, first)])
    flat = corners @ plane.T
    try:
        outline = flat[ConvexHull(flat).vertices]
    except (QhullError, ValueError):
        outline = flat
    edges = np.roll(outline, -1, axis=0) - outline
    edges = edges[np.linalg.norm(edges, axis=1) > 1e-12]
    if len(edges) == 0:
        return np.stack([plane[0], plane[1], normal])
    angles = np.arctan2(edges[:, 1], edges[:, 0])
    c, s = np.cos(angles), np.sin(angles)
    u = c[:, None] * outline[:, 0] + s[:, None] * outline[:, 1]
    v = -s[:, None] * outline[:, 0] + c[:, None] * outline[:, 1]
    best = int(np.argmin(np.ptp(u, axis=1) * np.ptp(v, axis=1)))
    x_axis = c[best] * plane[0] + s[best] * plane[1]
    return np.stack([x_axis, crossed(normal, x_axis), normal])


def _box_volume(corners: FloatArray, axes: FloatArray) -> float:
    """Volume of the box around points along `axes`; flat boxes are compared as if 1/200 thick."""
    extents = np.ptp(corners @ axes.T, axis=0)
    return float(np.prod(np.maximum(extents, 0.005 * extents.max())))


def _dense_span(
    lower: float, upper: float, axis: FloatArray, samples: SurfaceSamples, config: FramesConfig
) -> tuple[float, float]:
    """Range along `axis` that holds the faces across it, less sparse ends that reach well beyond them."""
    facing = np.abs(samples.normals @ axis) > np.cos(np.radians(25.0))
    if facing.sum() < 20:
        return float(lower), float(upper)
    height = samples.points[facing] @ axis
    order = np.argsort(height)
    share = np.cumsum(samples.areas[facing][order]) / samples.areas[facing].sum()
    low = float(height[order][np.searchsorted(share, config.handle_share)])
    high = float(height[order][min(np.searchsorted(share, 1.0 - config.handle_share), len(order) - 1)])
    least = config.handle_gap * max(high - low, 0.02 * float(upper - lower))
    coordinate = samples.points @ axis
    margin = 0.1 * least

    def sparse(outside: BoolArray) -> bool:
        return bool(samples.areas[outside].sum() <= config.handle_share * samples.areas.sum())

    cut_low = low if low - lower > least and sparse(coordinate < low - margin) else float(lower)
    cut_high = high if upper - high > least and sparse(coordinate > high + margin) else float(upper)
    return cut_low, cut_high
