"""Evidence of bearings and rails, and the quality of an edge."""

from __future__ import annotations

import math

from kinematify.config.base import StageConfig


class RailConfig(StageConfig):
    """Fit of the direction along which a contact is extruded."""

    pairs: int
    """Random pairs of normals per side."""
    tolerance: float
    """Angle by which a normal may leave the plane across the direction [deg]."""
    edge_tolerance: float
    """Angle by which a guiding edge may leave the direction [deg]."""
    edge_floor: float
    """What a rail without guiding edges keeps of its score, against one with nothing but such edges."""
    refine_steps: int
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

    clear: float
    """Where each contact of a group has a line of this score, nothing is shared."""
    samples: int
    """Points per part that are laid upon each other."""
    tolerance: float
    """Largest mean distance between them, fraction of the smaller part's diagonal."""
    alike: float
    """Rough parts whose spreads along their principal axes differ by more are no twins, fraction of the largest."""
    reach: float
    """Contacts that lie farther apart after the motion are no twins, fraction of the part's diagonal."""
    slack: float
    """How far a line may move when it settles at a twin, in units of `apart_angle` and `apart`."""
    most: int
    """Twins that are asked about each contact."""


class BearingConfig(StageConfig):
    """Fit of bearing lines to a contact edge."""

    fade: float
    """Distance to the other part over which evidence fades, fraction of the assembly's diagonal."""
    fade_part: float
    """The same as a fraction of the smaller part's diagonal; the smaller of the two counts."""
    negligible: float
    """Samples with less than this fraction of the largest weight are dropped."""
    pairs: int
    """Random pairs of normals per side."""
    circles: int
    """Circles through feature edges per side."""
    directed_pairs: int
    """Random pairs per side and main direction of the parts, for lines along it."""
    directed_angle: float
    """Lines that run this near to a main direction may as well run along it [deg]; of rough parts only."""
    directed_bonus: float
    """Factor on the score of a line along it against one that is off it."""
    coarse_samples: int
    """Samples per side for the first scoring of all lines."""
    shortlist: int
    """Distinct lines, best by area, that are refined."""
    shortlist_circles: int
    """Distinct lines, best by circles, that are refined as well."""
    shortlist_directed: int
    """Distinct lines along each main direction, best by area, that are refined as well."""
    keep: int
    """Distinct lines kept per edge."""
    apart_angle: float
    """Lines closer than this in direction [deg] and closer than `apart` at the contact are one line."""
    apart: float
    """The distance that goes with it, fraction of the assembly's diagonal; proposals use twice both."""
    normal_tolerance: float
    """Angle between a normal and the meridian plane that still counts as consistent [deg]."""
    fine_tolerance: float
    """The same in the last round of refinement [deg]."""
    refine_steps: int
    """Rounds of refinement."""
    refine_samples: int
    """Samples per side in all rounds but the last two."""
    flange_weight: float
    """Weight of area perpendicular to the axis against area around it."""
    circle_tolerance: float
    """Angle by which a piece of edge may miss the tangent of a circle [deg]."""
    circle_cell: float
    """Radii and heights that differ by less belong to one circle, fraction of the diagonal."""
    least_arc: float
    """Shortest arc that counts, in full turns."""
    circle_floor: float
    """What an edge without any circle keeps of its score, against a full circle."""
    circle_weight: float
    """Weight of edge pieces against area in the refinement."""
    turned_support: float
    """A part whose whole surface turns into itself to this share may turn about its own axis."""
    turned_length: float
    """Largest length along the axis of such a part, in diameters."""
    turned_score: float
    """Score of a fully round part without any bearing on the other side."""
    turned_samples: int
    """Samples, and pairs of normals, for the axis of a whole part."""
    rough_from: float
    """Roughness of a part's surface from which the tolerances grow [deg]."""
    rough_to: float
    """Roughness at which they are those of noisy parts [deg]."""
    rough_normal_tolerance: float
    """`normal_tolerance` there [deg]."""
    rough_directed_pairs: int
    """`directed_pairs` for parts that are any rougher than `rough_from`."""
    rough_turned_support: float
    """`turned_support` at `rough_to`."""
    noisy_normal_tolerance: float
    """`normal_tolerance` where a part's vertices are noisy [deg]."""
    noisy_fine_tolerance: float
    """`fine_tolerance` there [deg]."""
    noisy_circle_tolerance: float
    """`circle_tolerance` there [deg]."""
    noisy_least_arc: float
    """`least_arc` there: noise breaks edges into pieces."""
    twins: BearingTwinsConfig
    """Votes of congruent contacts."""
    rail: RailConfig
    """The counterpart for sliding joints, fitted to the same samples."""

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
