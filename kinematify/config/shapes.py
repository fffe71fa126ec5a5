"""The stages up to the contact graph: what is accepted, surfaces, contacts, signed distance."""

from __future__ import annotations

from typing import Literal

from kinematify.config.base import StageConfig


class AssemblyConfig(StageConfig):
    """Limits on what is accepted as input."""

    max_parts: int
    """More parts than this are refused."""
    max_faces: int
    """Faces of all parts together; more are refused."""
    max_part_faces: int
    """A part with more faces is simplified to this number for inference (output keeps the original)."""
    min_vertices: int
    """A part with fewer distinct vertices is set aside (paper III-B: too few vertices)."""
    min_extent: float
    """A part whose largest extent is below this fraction of the assembly's diagonal is set aside."""
    max_archive_bytes: int
    """Size of a mesh file, and unpacked size of a ZIP [bytes]."""
    weld: float
    """Vertices closer than this fraction of their mesh's diagonal are merged."""
    duplicate: float
    """Two parts whose vertices agree within this fraction of the assembly's diagonal are the same part twice."""
    smallest: float
    """Objects whose longest side is shorter are asked about: their unit may not be the metre [m]."""
    largest: float
    """Objects whose longest side is longer are asked about as well [m]."""


class SurfaceConfig(StageConfig):
    """Derived geometry of a part's surface."""

    crease_angle: float
    """Faces that meet at a larger dihedral angle form a sharp edge [deg]."""


class ContactConfig(StageConfig):
    """Which parts touch, and where; lengths as fractions of the assembly's diagonal."""

    tolerance: float
    """Largest gap that counts as contact."""
    near: float
    """Parts with a larger gap up to this are bridged: one may hang on the other, though something else touches it."""
    bridge_ratio: float
    """Where parts touch nothing, gaps up to this many times the smallest one count as contact."""
    strength: Literal["area", "proximity"]
    """Of a contact: its area beside the largest one, or exp(-gap / tolerance)."""
    band: float
    """Samples farther from the other part than this say nothing about the joint."""
    samples: int
    """Surface samples per side of a contact."""
    cluster_samples: int
    """Surface samples per part for comparing shapes."""
    cluster_tolerance: float
    """Largest Chamfer distance of congruent parts, as a fraction of the part's diagonal."""


class SeamConfig(StageConfig):
    """Where one part was cut in two."""

    join: bool
    """Infer with such pieces as one part; false: with the parts as they are given."""
    tolerance: float
    """Distance at which two rims coincide, fraction of the assembly's diagonal."""
    through_smooth: float
    """Share of a common rim over which the surface goes on, from which it is a cut if it is also complete."""
    through_planar: float
    """A cut lies in a plane within this share of its own size (root mean square)."""
    through_complete: float
    """Share of the rims of both pieces in that plane that must coincide."""
    through_facing: float
    """Cosine between surface and plane up to which the plane crosses it."""
    ragged: float
    """Length over which two rims coincide and the surface goes on, in diagonals of the smaller part, that no outline of
    a door has: a cut along the edges of a mesh, through the base link too."""
    share: float
    """Length over which two rims coincide and the surface goes on, in diagonals of the smaller part, from which the
    two are one part, however the seam runs; not asked of the base link."""
    smooth: float
    """Share of the common rim over which the surface goes on, from which the same holds."""


class NeuralSdfConfig(StageConfig):
    """Signed distances as networks (III-B); lengths in the training are half diagonals of the part."""

    width: int
    """Units of a layer."""
    layers: int
    """Layers with sines."""
    frequency: float
    """Factor before every sine."""
    margin: float
    """Room around the part in which it is trained, fraction of the part's diagonal."""
    surface_samples: int
    """Noisy surface points of a part, and as many offsets."""
    far_samples: int
    """Points of a part's box."""
    noise: float
    """Standard deviation of the first kind, fraction of the part's diagonal."""
    offset: float
    """Largest offset of the second kind along the normal, fraction of the part's diagonal."""
    steps: int
    """Of training."""
    batch: int
    """Points of a part in a step."""
    rate: float
    """Learning rate at the start; it falls to a hundredth along a cosine."""
    near: float
    """Points within this distance of the surface count more [half diagonals]."""
    near_weight: float
    """So much more at the surface."""
    eikonal_weight: float
    """Of the eikonal term."""
    eikonal_batch: int
    """Points at which it is asked for."""
    eikonal_every: int
    """In one of so many steps."""
    device: Literal["auto", "cpu"]
    """auto takes a GPU where there is one."""


class SdfConfig(StageConfig):
    """Fields of signed distances (III-B)."""

    kind: Literal["grid", "neural"]
    """Exact distances on a grid, or the paper's networks."""
    neural: NeuralSdfConfig
    resolution: int
    """Cells along the longest side of a part's grid."""
    margin: float
    """Room around the part, fraction of the part's own diagonal."""
    band_cells: float
    """Distances are exact within this many cells of the surface, at least 2; beyond, to half a cell."""
    cache_bytes: int
    """Grids kept in memory [bytes]."""
