"""The stages up to the contact graph: what is accepted, surfaces, contacts, signed distance."""

from __future__ import annotations

from typing import Literal

from kinematify.config.base import StageConfig, section


class AssemblyConfig(StageConfig):
    """Limits on what is accepted as input."""

    max_parts: int = 2000  # the contact graph of more parts does not fit the memory budget of 3 GB
    """More parts than this are refused."""
    max_faces: int = 20000000  # about 1 GB of float64 vertices and int64 faces
    """Faces of all parts together; more are refused."""
    max_part_faces: int = 100000  # a mesh of more faces carries no extra evidence at the sampling density used
    """A part with more faces is simplified to this number for inference (output keeps the original)."""
    min_vertices: int = 4  # fewer than a tetrahedron encloses nothing
    """A part with fewer distinct vertices is set aside (paper III-B: too few vertices)."""
    min_extent: float = 1.0e-5  # below the precision of float32 mesh files
    """A part whose largest extent is below this fraction of the assembly's diagonal is set aside."""
    max_archive_bytes: int = 2000000000  # stops decompression bombs; far above any real assembly
    """Size of a mesh file, and unpacked size of a ZIP [bytes]."""
    weld: float = 1.0e-7  # the rounding of float32 mesh files; real features are a thousand times larger
    """Vertices closer than this fraction of their mesh's diagonal are merged."""
    duplicate: float = 1.0e-6  # a part exported twice agrees to rounding; left and right twins stand apart
    """Two parts whose vertices agree within this fraction of the assembly's diagonal are the same part twice."""
    smallest: float = 0.002  # a gear of a watch; what is smaller was divided by a thousand once too often
    """Objects whose longest side is shorter are asked about: their unit may not be the metre [m]."""
    largest: float = 20.0  # a lorry with its trailer; a spoon in millimetres is larger
    """Objects whose longest side is longer are in millimetres if no unit is stated, else asked about [m]."""


class SurfaceConfig(StageConfig):
    """Derived geometry of a part's surface."""

    crease_angle: float = 30.0  # cylinders down to 12 segments stay smooth, chamfers of 45 deg stay sharp
    """Faces that meet at a larger dihedral angle form a sharp edge [deg]."""


class ContactConfig(StageConfig):
    """Which parts touch, and where; lengths as fractions of the assembly's diagonal."""

    tolerance: float = 2.5e-3  # full recall of true contacts on 14 robots and 48 everyday objects (feasibility.md 2)
    """Largest gap that counts as contact."""
    near: float = 0.01  # lids over rims, hands of clocks: half of `band`, so that samples show the joint
    """Parts with a larger gap up to this are bridged: one may hang on the other, though something else touches it."""
    bridge_ratio: float = 1.5  # clearances of one object are alike; a drawer pulled out hangs as near to its neighbour
    """Where parts touch nothing, gaps up to this many times the smallest one count as contact."""
    strength: Literal["area", "proximity"] = "area"  # gaps of right and wrong contacts are alike (feasibility.md 2)
    """Of a contact: its area beside the largest one, or exp(-gap / tolerance)."""
    band: float = 0.02  # evidence about a joint lies within a few bearing radii of the contact
    """Samples farther from the other part than this say nothing about the joint."""
    samples: int = 4000  # per side of a contact; axis error is limited by tessellation, not by this, from 2000 up
    """Surface samples per side of a contact."""
    cluster_samples: int = 1500  # spacing well below the tolerance of the Chamfer distance
    """Surface samples per part for comparing shapes."""
    cluster_tolerance: float = 0.03  # of the part's diagonal; sampling noise alone is about half of this
    """Largest Chamfer distance of congruent parts, as a fraction of the part's diagonal."""


class GroupingConfig(StageConfig):
    """Which pieces of a mesh that is not segmented are one rigid part."""

    share: float = 0.5  # the best F1 of moving parts with the category held out (results/grouping.md)
    """A set of pieces moves if it is likelier than this share of the likeliest one."""
    threshold: float = 0.2  # of 4 held-out objects without a likelier set, none had a right joint (results/grouping.md)
    """Probability below which no set moves."""
    fixed: float = 0.5  # of 18 such sets of earlier runs, 3 moved (results/grouping.md)
    """A set that is likelier than this fixed to its parent, judged by its joint, is merged with it again."""
    sure: float = 0.5  # of 5 held-out objects below it, none had a right joint (results/grouping.md)
    """A mesh without a joint of this confidence is reported as one that may be rigid."""
    crumb: float = 0.012  # screws and letters; the smallest button of the benchmark is twice as large
    """Pieces with a smaller diagonal, as a fraction of the assembly's, ride on the nearest one."""


class SeamConfig(StageConfig):
    """Where one part was cut in two."""

    join: bool = True  # segmentations cut shells in two
    """Infer with such pieces as one part; false: with the parts as they are given."""
    tolerance: float = 1.0e-5  # labels cut along edges of the mesh: both sides have the same vertices
    """Distance at which two rims coincide, fraction of the assembly's diagonal."""
    through_smooth: float = 0.95  # doors cut out of one shell turn a corner somewhere
    """Share of a common rim over which the surface goes on, from which it is a cut if it is also complete."""
    through_planar: float = 2.0e-3  # planes of the cut; the rims of moulded doors bend by a hundredth of their size
    """A cut lies in a plane within this share of its own size (root mean square)."""
    through_complete: float = 0.9  # doors flush in their body have rims of their own in the plane of the seam
    """Share of the rims of both pieces in that plane that must coincide."""
    # labels of a door in a flat front have 1; a cut lengthways through a thin board up to 0.9
    through_facing: float = 0.9
    """Cosine between surface and plane up to which the plane crosses it."""
    ragged: float = 6.0  # twice around a square door is 5.7; parts that move have up to 2, ragged cuts 5 to 1000
    """Length over which two rims coincide and the surface goes on, in diagonals of the smaller part, that no outline of
    a door has: a cut along the edges of a mesh, through the base link too."""
    share: float = 0.5  # a cut that goes through a part is about as long as it is wide
    """Length over which two rims coincide and the surface goes on, in diagonals of the smaller part, from which a
    straight line is a cut."""


class NeuralSdfConfig(StageConfig):
    """Signed distances as networks (III-B); lengths in the training are half diagonals of the part."""

    width: int = 64
    """Units of a layer."""
    layers: int = 3
    """Layers with sines."""
    frequency: float = 15.0  # parts are a few shapes, not photographs
    """Factor before every sine."""
    margin: float = 0.1
    """Room around the part in which it is trained, fraction of the part's diagonal."""
    surface_samples: int = 12000
    """Noisy surface points of a part, and as many offsets."""
    far_samples: int = 8000
    """Points of a part's box."""
    noise: float = 0.005
    """Standard deviation of the first kind, fraction of the part's diagonal."""
    offset: float = 0.05  # the band in which contacts are judged
    """Largest offset of the second kind along the normal, fraction of the part's diagonal."""
    steps: int = 400  # 0.27 % after 300, where 0.5 % was asked for
    """Of training."""
    batch: int = 512
    """Points of a part in a step."""
    rate: float = 2.0e-3
    """Learning rate at the start; it falls to a hundredth along a cosine."""
    near: float = 0.1
    """Points within this distance of the surface count more [half diagonals]."""
    near_weight: float = 2.0
    """So much more at the surface."""
    eikonal_weight: float = 0.02  # distances are given: it only smooths
    """Of the eikonal term."""
    eikonal_batch: int = 128
    """Points at which it is asked for."""
    eikonal_every: int = 2
    """In one of so many steps."""
    device: Literal["auto", "cpu"] = "auto"
    """auto takes a GPU where there is one."""


class SdfConfig(StageConfig):
    """Fields of signed distances (III-B)."""

    # exact, a hundred times quicker to make, and finer near the surface (results/sdf.md)
    kind: Literal["grid", "neural"] = "grid"
    """Exact distances on a grid, or the paper's networks."""
    neural: NeuralSdfConfig = section()
    resolution: int = 48  # error 0.1 % of the part's diagonal; finer would still not resolve gaps of 0.01 to 0.2 %
    """Cells along the longest side of a part's grid."""
    margin: float = 0.1  # a turn of 20 deg carries most of a contact no farther out
    """Room around the part, fraction of the part's own diagonal."""
    band_cells: float = 2.0  # the interpolation of winding numbers needs 1.8
    """Distances are exact within this many cells of the surface, at least 2; beyond, to half a cell."""
    cache_bytes: int = 400000000  # 200 parts of 2 MB at the very most, an eighth of the memory budget of 3 GB
    """Grids kept in memory [bytes]."""
