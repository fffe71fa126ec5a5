"""Evidence of bearings and rails, and the quality of an edge."""

from __future__ import annotations

import math

from kinematify.config.base import StageConfig, section


class RailConfig(StageConfig):
    """Fit of the direction along which a contact is extruded."""

    pairs: int = 150  # guides have few directions, so few proposals find them
    """Random pairs of normals per side."""
    tolerance: float = 3.0  # as for bearings
    """Angle by which a normal may leave the plane across the direction [deg]."""
    edge_tolerance: float = 2.0  # straight edges carry no tessellation error
    """Angle by which a guiding edge may leave the direction [deg]."""
    edge_floor: float = 0.1  # as circle_floor
    """What a rail without guiding edges keeps of its score, against one with nothing but such edges."""
    refine_steps: int = 4  # least squares on unit normals converges at once
    """Rounds of refinement."""

    @property
    def tolerance_sine(self) -> float:
        """Sine of `tolerance`."""
        return math.sin(math.radians(self.tolerance))

    @property
    def edge_tolerance_sine(self) -> float:
        """Sine of `edge_tolerance`."""
        return math.sin(math.radians(self.edge_tolerance))


class BearingTwinsConfig(StageConfig):
    """Contacts of congruent parts share their bearing."""

    clear: float = 0.03  # chance lines of clean robots score up to 0.02
    """Where each contact of a group has a line of this score, nothing is shared."""
    slack: float = 3.0  # 6 deg and 1 % of the diagonal: what motions between rough meshes miss by
    """How far a line may move when it settles at a twin, in units of `apart_angle` and `apart`."""


class BearingConfig(StageConfig):
    """Fit of bearing lines to a contact edge."""

    fade: float = 7.0e-3  # real bearings lie within a few clearances and wall thicknesses of the contact
    """Distance to the other part over which evidence fades, fraction of the assembly's diagonal."""
    fade_part: float = 0.05  # finger-sized parts have finger-sized bearings
    """The same as a fraction of the smaller part's diagonal; the smaller of the two counts."""
    negligible: float = 1.0e-3  # below, a sample cannot change a score in its third digit
    """Samples with less than this fraction of the largest weight are dropped."""
    pairs: int = 1000  # a bearing that covers 10 % of the near area is proposed about ten times
    """Random pairs of normals per side."""
    circles: int = 400  # as many again from edges, which survive where round area is small
    """Circles through feature edges per side."""
    directed_pairs: int = 0  # normals of clean parts give the direction better than the shape of the part
    """Random pairs per side and main direction of the parts, for lines along it."""
    directed_angle: float = 8.0  # the tolerance of normals of rough parts
    """Lines that run this near to a main direction may as well run along it [deg]; of rough parts only."""
    directed_bonus: float = 1.2  # designed axes run along the parts; what clearly runs askew still may
    """Factor on the score of a line along it against one that is off it."""
    coarse_samples: int = 250  # ranks 3000 lines well enough to keep the true one among the shortlist
    """Samples per side for the first scoring of all lines."""
    shortlist: int = 20  # the true line was within the first 10 by area wherever it had round area
    """Distinct lines, best by area, that are refined."""
    shortlist_circles: int = 10  # knees and ankles in boxy housings show only as a few circles
    """Distinct lines, best by circles, that are refined as well."""
    shortlist_directed: int = 3  # where all lines are weak, those of chance would fill the list
    """Distinct lines along each main direction, best by area, that are refined as well."""
    keep: int = 8  # alternatives for the type decision and for feedback
    """Distinct lines kept per edge."""
    apart_angle: float = 2.0  # below the normals' tolerance the refinement leads to the same line
    """Lines closer than this in direction [deg] and closer than `apart` at the contact are one line."""
    apart: float = 3.0e-3  # below the width of a bearing; parallel axes of one contact lie farther apart
    """The distance that goes with it, fraction of the assembly's diagonal; proposals use twice both."""
    normal_tolerance: float = 3.0  # above the smooth-normal error of 16-segment cylinders, far below 90 deg confusions
    """Angle between a normal and the meridian plane that still counts as consistent [deg]."""
    fine_tolerance: float = 0.5  # the last rounds ignore blends and draft angles
    """The same in the last round of refinement [deg]."""
    refine_steps: int = 8  # converged to 1e-3 deg on clean meshes
    """Rounds of refinement."""
    refine_samples: int = 500  # enough to rank the shortlist; the last rounds use all
    """Samples per side in all rounds but the last two."""
    flange_weight: float = 0.15  # flat seats support a bearing but do not locate it (feasibility.md 4)
    """Weight of area perpendicular to the axis against area around it."""
    circle_tolerance: float = 3.0  # as for normals
    """Angle by which a piece of edge may miss the tangent of a circle [deg]."""
    circle_cell: float = 4.0e-3  # coaxial edges within a chamfer's width are one circle (feasibility.md 4)
    """Radii and heights that differ by less belong to one circle, fraction of the diagonal."""
    least_arc: float = 0.2  # shorter arcs are fillets of plates
    """Shortest arc that counts, in full turns."""
    circle_floor: float = 0.1  # decimated and remeshed parts lose their edges but not their roundness
    """What an edge without any circle keeps of its score, against a full circle."""
    circle_weight: float = 0.5  # edges and area locate the line about equally well
    """Weight of edge pieces against area in the refinement."""
    turned_support: float = 0.5  # half of the surface turns into itself: a wheel with spokes, a knob with a pointer
    """A part whose whole surface turns into itself to this share may turn about its own axis."""
    turned_length: float = 1.2  # beyond, a rod, which may be hinged at its end
    """Largest length along the axis of such a part, in diameters."""
    turned_score: float = 0.05  # one-sided evidence ranks below nearly every two-sided bearing
    """Score of a fully round part without any bearing on the other side."""
    turned_samples: int = 500  # a whole-part axis is well determined
    """Samples, and pairs of normals, for the axis of a whole part."""
    rough_from: float = 3.4  # designed parts reach 0.5 to 3.4, few more
    """Roughness of a part's surface from which the tolerances grow [deg]."""
    rough_to: float = 4.8  # voxels of 1/150 of the diagonal reach 3 to 7, 300 faces a part 3 to 9
    """Roughness at which they are those of noisy parts [deg]."""
    rough_normal_tolerance: float = 6.0  # what is left of the steps of voxels and of facets after averaging
    """`normal_tolerance` there [deg]."""
    rough_directed_pairs: int = 60  # a bearing with a tenth of the rough area is proposed about once per direction
    """`directed_pairs` for parts that are any rougher than `rough_from`."""
    rough_turned_support: float = 0.35  # wheels of 700 voxel faces reach 0.42, clean ones 0.73
    """`turned_support` at `rough_to`."""
    noisy_normal_tolerance: float = 8.0  # vertex noise of 0.05 % of the diagonal leaves 3 to 8 deg after averaging
    """`normal_tolerance` where a part's vertices are noisy [deg]."""
    noisy_fine_tolerance: float = 2.0  # narrower, a round would follow single samples
    """`fine_tolerance` there [deg]."""
    noisy_circle_tolerance: float = 10.0  # edges of a few millimetres wander as much
    """`circle_tolerance` there [deg]."""
    noisy_least_arc: float = 0.1  # noise breaks edges into pieces
    """`least_arc` there: noise breaks edges into pieces."""
    twins: BearingTwinsConfig = section()
    """Votes of congruent contacts."""
    rail: RailConfig = section()
    """The counterpart for sliding joints, fitted to the same samples."""

    def in_metres(self, diagonal: float) -> BearingConfig:
        """The same with `fade`, `apart` and `circle_cell` in metres, for an assembly with this diagonal [m]."""
        lengths = {name: getattr(self, name) * diagonal for name in ("fade", "apart", "circle_cell")}
        return self.model_copy(update=lengths)

    def for_roughness(self, roughness: float) -> BearingConfig:
        """The same with the tolerances of parts of some roughness [deg], infinite for noisy ones."""
        share = min(max((roughness - self.rough_from) / (self.rough_to - self.rough_from), 0.0), 1.0)
        if share <= 0.0:
            return self
        normal = self.rough_normal_tolerance if math.isfinite(roughness) else self.noisy_normal_tolerance
        rough = {
            "normal_tolerance": normal,
            "fine_tolerance": self.noisy_fine_tolerance,
            "circle_tolerance": self.noisy_circle_tolerance,
            "least_arc": self.noisy_least_arc,
            "turned_support": self.rough_turned_support,
        }
        between = {name: (1.0 - share) * getattr(self, name) + share * value for name, value in rough.items()}
        return self.model_copy(update={**between, "directed_pairs": self.rough_directed_pairs})

    @property
    def normal_tolerance_sine(self) -> float:
        """Sine of `normal_tolerance`."""
        return math.sin(math.radians(self.normal_tolerance))

    @property
    def fine_tolerance_sine(self) -> float:
        """Sine of `fine_tolerance`."""
        return math.sin(math.radians(self.fine_tolerance))

    @property
    def circle_tolerance_sine(self) -> float:
        """Sine of `circle_tolerance`."""
        return math.sin(math.radians(self.circle_tolerance))
