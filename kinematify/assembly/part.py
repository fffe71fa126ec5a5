"""Parts and assemblies: what every later stage works on."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from kinematify.robot.arrays import ReadOnlyArrays, read_only
from kinematify.robot.vectors import box_around, highest, lengths_of, lowest, referenced, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.appearance import Appearance
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.exact_faces import ExactFaces


@dataclass(frozen=True, kw_only=True, eq=False)
class Part(ReadOnlyArrays):
    """One rigid part: a triangle mesh in world coordinates (paper III-A, ``M_i``)."""

    name: str
    """Unique, XML-safe name; becomes the link name."""
    vertices: FloatArray
    """Vertex positions in the world frame [m], shape (V, 3). Read-only."""
    faces: IntArray
    """Vertex indices of triangles, shape (F, 3). Read-only."""
    color: tuple[float, float, float] | None = None
    """sRGB in [0, 1] where the source knows it, the mean of several; models and pictures choose one otherwise."""
    appearance: Appearance | None = None
    """Materials of the faces where the source knows more than one colour."""
    density: float | None = None
    """[kg/m^3] where the source knows it."""
    walls: float | None = None
    """Mass of its walls, if it is hollow, over their surface [kg/m^2], where the source knows it."""
    exact: ExactFaces | None = None
    """Cylinders and planes, world frame [m], where a CAD file states them."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.appearance is not None and len(self.appearance.material_of_face) != len(self.faces):
            object.__setattr__(self, "appearance", None)  # it is of other faces than those that replaced them

    @cached_property
    def mesh_hash(self) -> str:
        """Hash of the geometry alone (not the name); key of every per-mesh cache."""
        digest = hashlib.sha256(self.vertices.tobytes())
        digest.update(self.faces.tobytes())
        return digest.hexdigest()

    @cached_property
    def bounds(self) -> FloatArray:
        """Axis-aligned bounds in the world frame [m], shape (2, 3): lower corner, upper corner."""
        used = referenced(self.vertices, self.faces)
        return read_only(np.stack([lowest(used), highest(used)]), np.float64)

    @property
    def diagonal(self) -> float:
        """Length of the bounding box diagonal [m]."""
        return float(np.linalg.norm(self.bounds[1] - self.bounds[0]))

    @cached_property
    def face_areas(self) -> FloatArray:
        """Area of every triangle [m^2], shape (F,)."""
        return read_only(0.5 * lengths_of(triangle_normals(self.vertices[self.faces])), np.float64)

    @property
    def area(self) -> float:
        """Surface area [m^2]."""
        return float(self.face_areas.sum())

    @cached_property
    def centroid(self) -> FloatArray:
        """Area-weighted surface centroid in the world frame [m], shape (3,) (paper III-A, ``c_i``)."""
        centres = self.vertices[self.faces].mean(axis=1)
        return read_only(np.average(centres, axis=0, weights=self.face_areas), np.float64)


@dataclass(frozen=True, kw_only=True)
class ExcludedPart:
    """A degenerate mesh that takes no part in the inference but is kept as a fixed visual."""

    part: Part
    """The mesh as it was given; may be flat, tiny or have too few vertices."""
    reason: str
    """One sentence for the user."""
    nearest: str
    """Name of the part that it is attached to."""


@dataclass(frozen=True, kw_only=True)
class Assembly:
    """A set of rigid parts in one static configuration (paper III-A), z up, metres, world frame."""

    parts: tuple[Part, ...]
    """At least two parts with unique names."""
    source: str
    """Where it came from, for messages and the record."""
    set_aside: tuple[ExcludedPart, ...] = ()
    """Degenerate input, by name and reason; nothing disappears silently."""
    original_names: Mapping[str, str] = field(default_factory=dict)
    """Part name -> name in the input."""
    warnings: tuple[str, ...] = ()
    """What the user should know about the input, one sentence each."""
    originals: Mapping[str, Part] = field(default_factory=dict)
    """Part name -> full mesh, for parts that were simplified for the inference; the output shows these."""
    lengths: str = "metres"
    """In which unit the input was read, and why, for reports."""
    options: tuple[str, ...] = ()
    """Words of the command line, such as ``--up z``, with which the source was read."""
    segmented: bool = True
    """False where the parts are pieces of a mesh, of which several may be one rigid part."""

    @property
    def names(self) -> tuple[str, ...]:
        """Part names in order."""
        return tuple(part.name for part in self.parts)

    @cached_property
    def bounds(self) -> FloatArray:
        """Axis-aligned bounds of all parts in the world frame [m], shape (2, 3)."""
        return read_only(box_around([part.bounds for part in self.parts]), np.float64)

    @cached_property
    def diagonal(self) -> float:
        """Smallest diagonal of an upright box around all parts [m]; the unit of most tolerances.

        For an object that stands square to the world it is that of the bounding box. Unlike that, it stays the same
        when the object is turned about z.
        """
        height = float(self.bounds[1, 2] - self.bounds[0, 2])
        plan = [referenced(part.vertices, part.faces)[:, :2] for part in self.parts]
        points = np.concatenate(plan)
        try:
            _, widths = rectangles_around(points)
        except QhullError:  # all points on one line, or as good as
            return math.hypot(height, float(np.linalg.norm(np.ptp(points, axis=0))))
        return math.hypot(height, float(np.sqrt((widths[0] ** 2 + widths[1] ** 2).min())))


def rectangles_around(points: FloatArray) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Directions of the sides of the hull of points in the plane (n, 2), shape (m, 2), and widths along and across.

    Raises:
        QhullError: All points are on one line, or as good as.
    """
    corners = points[ConvexHull(points).vertices]
    sides = np.roll(corners, -1, axis=0) - corners
    along = sides / np.linalg.norm(sides, axis=1)[:, None]
    across = along @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    return along, (np.ptp(corners @ along.T, axis=0), np.ptp(corners @ across.T, axis=0))
