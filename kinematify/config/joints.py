"""How a joint is chosen: frames, sweeps, panels, slides, kind, limits."""

from __future__ import annotations

import math
from typing import Literal

from kinematify.config.base import StageConfig


class FramesConfig(StageConfig):
    """Box frames of parts."""

    volume_slack: float
    """A preferred frame may hold a box larger than the smallest by this fraction."""
    handle_share: float
    """Share of the area facing the thin direction that may lie outside the slab on either side."""
    handle_gap: float
    """An end is cut off if it reaches beyond the slab by more than this fraction of the slab's thickness."""


class SweepConfig(StageConfig):
    """Virtual motion test."""

    points: int
    """Points that stand for the moving part."""
    shrink: float
    """Fraction by which they are drawn towards the part's centre."""
    hinge_zone: float
    """Points closer to the axis than this fraction of the part's reach are exempt."""
    grace: float
    """Motion at the start that is not tested, fraction of the assembly's diagonal."""
    step_deg: float
    """Length of the straight pieces of a turn [deg]."""
    share: float
    """A motion is blocked once more than this share of the points has hit something."""


class GateConfig(StageConfig):
    """When a bearing line is taken as it is: either is enough."""

    product: float
    """Surface score times circle score."""
    located: float
    """Round area on both parts that locates the line, without flat seats (geometric mean of the shares)."""


class PanelsConfig(StageConfig):
    """Candidate lines and cues of turning joints."""

    sweep_deg: float
    """Turn that is tested either way [deg]."""
    full_turn_deg: float
    """Free turn beyond which more is no better [deg]."""
    part_deg: float
    """Turn after which the part must still be near its parent [deg]."""
    separation_points: int
    """Points that measure the gap after the turn."""
    bearings: int
    """Bearing lines among the candidates."""
    least_contact: int
    """Contact samples needed to propose lines from the contact."""
    cluster_gap: float
    """Gap between two contact zones, fraction of the part's longest side."""
    hinge_band: float
    """Contact within this fraction of the part's reach counts as being at the line."""
    ajar_share: float
    """A panel with more of its contact at one edge stands open."""
    tall: float
    """Height over width above which an upright panel is tall."""
    tall_handle: float
    """What remains of the direction of a handle on a tall panel."""
    margin_cap: float
    """Largest effect of the difference of margins."""
    weak_margin: float
    """What remains of the difference of margins for lids, and where a handle is clearly off centre."""
    cap: float
    """Largest influence of a single cue, in units of the score."""
    bearing_bonus: float
    """What a bearing that passes the gate adds to its line."""
    weights: dict[str, float]
    """Weight of each cue of `hypotheses/panels.py`; lengths in diagonals."""


class SlidesConfig(StageConfig):
    """Candidate directions and cues of sliding joints."""

    sweep: float
    """Travel that is tested either way, fraction of the diagonal."""
    useful_share: float
    """Free travel beyond which more is no better, fraction of the part's length that way."""
    useful_least: float
    """The same as a fraction of the diagonal, for parts that are short that way."""
    short_travel: float
    """Travel on which crossings are counted, fraction of the diagonal."""
    distinct_deg: float
    """Directions closer than this are one [deg]."""
    cap: float
    """Largest influence of a single cue, in units of the score."""
    weights: dict[str, float]
    """Weight of each cue of `hypotheses/slides.py`; lengths in diagonals."""


class KindConfig(StageConfig):
    """Log odds of sliding against turning."""

    bias: float
    """Log odds of sliding before any evidence."""
    cap: float
    """Largest influence of a single cue."""
    box_none: float
    """Depth over the smaller side of the front up to which a part inside its body is no drawer."""
    box_full: float
    """The same from which it is one."""
    pulled_none: float
    """`box_none` of parts that are not inside their body."""
    pulled_full: float
    """`box_full` of them."""
    shaft: float
    """Share of the directions in which the walls of a shaft stand, at least."""
    sunk_none: float
    """Depth of a plate below the outside of its body at which it may be a door, in diagonals."""
    sunk_full: float
    """Depth from which it is none."""
    deep_none: float
    """Length over width up to which a round contact is a bearing."""
    deep_full: float
    """Length over width from which it is that of a telescope."""
    drawn: float
    """Share of that length by which the part can be drawn out."""
    bars_equal: float
    """Least score of a second bearing beside the best one, as a share of its score."""
    bars_apart: float
    """Least distance between the two [fraction of the child's diagonal]."""
    bars_deg: float
    """A part that turns by more about the best one does not run on both [deg]."""
    plunger_even: float
    """Eccentricity up to which a round plug bears no pointer."""
    plunger_least: float
    """Least room behind a plug that is pressed [fraction of its diagonal]."""
    plunger_most: float
    """Largest: with more, it would fall in."""
    stuck_candidates: int
    """Turning candidates that must all be blocked before a part counts as fixed."""
    stuck_factor: float
    """Room up to this many times the thresholds below is looked at again, without grace."""
    stuck_deg: float
    """Turn below which a part counts as stuck [deg]."""
    stuck_slide: float
    """Travel below which a part counts as stuck, fraction of its own diagonal."""
    weights: dict[str, float]
    """Weight of each cue of `choice/kind.py`; positive for sliding."""


class JournalConfig(StageConfig):
    """Pins in bores and barrels in knuckles: round surfaces of both parts that face each other."""

    faces: int
    """Faces of a part that are looked at, at most."""
    straight: float
    """Cosine: the other surface lies straight before a face and looks back."""
    pairs: int
    """Pairs of neighbouring faces that propose lines."""
    neighbours: int
    """Nearest faces among which the second of a pair is drawn."""
    least_sine: float
    """Sine of the angle between two normals below which they propose nothing."""
    largest: float
    """Largest radius as a fraction of the child's longest side."""
    normal_deg: float
    """Largest angle between a face's normal and the radius [deg]."""
    radius_tolerance: float
    """Largest deviation of a face from the radius, as a fraction of it."""
    leaning: float
    """Mean square of the cosine between the normals and the line beyond which the surface is a ball's."""
    sectors: int
    """Into which a full turn is divided."""
    coverage: float
    """Share of the sectors that must be held."""

    @property
    def normal_tolerance(self) -> float:
        """`normal_deg` [rad]."""
        return math.radians(self.normal_deg)


class ClearanceConfig(StageConfig):
    """How far the surface of a contact can turn or slide before it is stopped."""

    least_samples: int
    """Fewer samples of a contact say nothing."""
    samples: int
    """Samples that are followed, at most about."""
    inset: float
    """Samples are drawn into their own material by this fraction of the child's diagonal."""
    turn_deg: float
    """Angle that counts as free [deg]."""
    slide: float
    """Travel that counts as free, fraction of the child's diagonal."""
    share: float
    """The contact is stopped when more than this share of its samples has hit."""
    journal_share: float
    """The same for a contact with a journal."""
    least: float
    """Shorter travels are clearance, fraction of the child's diagonal."""
    candidates: int
    """Best lines of turning among which those at one edge are looked for."""
    lines: int
    """Lines at the best edge that are tried."""
    edge: float
    """Lines within this distance are at one edge, fraction of the child's diagonal."""
    ratio: float
    """One motion is free and the other is not where it goes so many times farther."""


class LimitsConfig(StageConfig):
    """Limits from sweeps: an upper bound of the designed range."""

    panel_deg: float
    """Largest opening of a panel [deg]."""
    blocked_deg: float
    """A panel that turns less far is shut in by something, or its mesh overlaps its frame [deg]."""
    square_deg: float
    """A panel within this angle of square to its body is closed [deg]."""
    closer: float
    """Closing an open panel brings it so much nearer to its body, ratio of mean distances."""
    lying: float
    """A panel that has come so near to its body lies on it, ratio of mean distances."""
    lying_deg: float
    """Meshes at the hinge of such a panel may overlap before it gets there, by this angle [deg]."""
    hinge_off: float
    """A bearing farther from the middle of a panel than this fraction of its thickness lies at one face."""
    even: float
    """A part whose mean lies nearer to its line than this fraction of its reach is even about it: no lever."""
    unstopped_deg: float
    """A lever that turns farther both ways is stopped inside, where it cannot be seen [deg]."""
    lever_deg: float
    """Travel of a lever that is pressed down [deg]; about an upright axis twice this both ways."""
    drawer: float
    """Travel of a drawer as a fraction of its own length."""
    ajar: float
    """A drawer whose front stands out by more than this fraction of its length is open."""
    room: float
    """A round part with this much room behind it is pressed, fraction of its diagonal."""
    one_way: float
    """A slide that is free farther one way by this fraction of the diagonal has an open side."""
    button: float
    """Travel of a button as a fraction of what stands out of the surface around it."""
    stopped_deg: float
    """A turning joint that goes no farther than this the one way stands at its stop [deg]."""
    least_deg: float
    """A turning joint keeps at least this range [deg]."""
    least_slide: float
    """A sliding joint keeps at least this travel, fraction of the diagonal."""


class GuideConfig(StageConfig):
    """How far a part can slide before it leaves what it runs in or on."""

    steps: int
    """Travels that are looked at, up to the diagonal of the object."""
    samples: int
    """Samples of each side of the contact that are followed, at most about."""
    least_samples: int
    """Fewer samples along the way are no guide."""
    band: float
    """Surfaces within this distance guide each other, fraction of the child's diagonal."""
    along_deg: float
    """Surface within this angle of the way runs along it [deg]."""
    kept: float
    """A part begins to leave its guide where less than this share of the contact is left."""
    gone: float
    """It has left it where less than this share is left."""
    runner: float
    """What can slide this many times its own length is no button."""


class RockersConfig(StageConfig):
    """Plates whose front is folded across the middle."""

    facing_deg: float
    """Surface within this angle of the thin direction belongs to the front or back [deg]."""
    least_share: float
    """Share of a part's area that its front has at least."""
    least_samples: int
    """Samples of each half."""
    least_deg: float
    """Lean of each half, to opposite sides [deg]."""
    even_deg: float
    """Surface within this angle of the middle lean of its half is even [deg]."""
    whole: float
    """Share of each half that is even."""


class FrontCuesConfig(StageConfig):
    """Pedals and wheels at the foot of a body."""

    small: float
    """Largest diagonal of such a part, fraction of the body's."""
    low: float
    """Largest height of its middle above the foot, fraction of the body's height."""
    aside: float
    """Least distance from the middle of the body, in halves of its narrower side."""
    agreeing: float
    """Length of the sum of the unit directions of all such parts, at least."""


class CompoundConfig(StageConfig):
    """Joints that are one mechanism together."""

    meeting: float
    """How near axes come to one point, fraction of the object's diagonal."""
    spread: float
    """Volume that three unit axes span, at least: 1 for right angles, 0 in one plane."""
    square: float
    """Cosine up to which two axes count as square; also how near to opposite the axes of fingers are."""
    cross: float
    """Largest diagonal of the part between the axes of a universal joint, fraction of either neighbour's."""
    beside: float
    """How far fingers may stand beside each other, fraction of their distance along the axis."""
    coaxial: float
    """How far the middle of a body may be from the line of its cap, fraction of the neck's radius."""


class RailsConfig(StageConfig):
    """When the rail of a contact speaks for sliding."""

    score_none: float
    """Rail score up to which it says nothing."""
    score_full: float
    """Rail score from which it says all it can."""
    lead_none: float
    """The same for the rail's score over that of the best bearing line."""
    lead_full: float
    """Full where the lead is at least this."""
    pin_deg: float
    """Free turn about a line along the rail beyond which the rail is a pin [deg]."""
    least_travel: float
    """Free travel along the rail below which a part that turns freely is not on it, in useful lengths."""
    rounded_lead: float
    """Below this lead a pair of end parts is hinged, not sliding."""
    rounded_least: float
    """Where the best bearing line scores less, the contact shows nothing round."""


class ConfidenceConfig(StageConfig):
    """How likely a joint is right (`results/choice.md`, `kinematify bench calibration`)."""

    cues_lead: float
    """Log odds that what the weighted cues would choose keeps over the fitted probabilities."""
    fold_lead: float
    """The same where they choose the fold of a rocker."""
    fixed: float
    """How likely a part must be fixed to be taken for it."""
    name_weight: float
    """Log odds that a part's name adds to the kind of joint that it speaks of."""


class JointsConfig(StageConfig):
    """Choice of each joint's type, axis, direction and limits."""

    method: Literal["geometry", "cavl"]
    """Bearings, panels and slides, or the paper's DW-CAVL alone."""
    samples: int
    """Surface samples per part."""
    confidence: ConfidenceConfig
    alternatives: int
    """Distinct candidates kept per type."""
    contact_band: float
    """Contact samples within this distance beyond the gap count as touching, fraction of the diagonal."""
    small_full: float
    """A part below this fraction of its parent's diagonal is small."""
    small_none: float
    """A part above this fraction of its parent's diagonal is not small."""
    panel_thinness: float
    """A panel is thinner than this fraction of its second side."""
    thick_door: float
    """So is an upright one below this, if it is thin beside the geometric mean of its other sides."""
    upright_cosine: float
    """A panel whose thin direction is less vertical than this is upright."""
    spread_full: float
    """Contact spread below this fraction of the child's half diagonal is compact."""
    spread_none: float
    """Contact spread above this fraction of the child's half diagonal is not compact."""
    serial_depth: int
    """A tree with this many joints in series is a linkage."""
    flat_cosine: float
    """A panel whose thin direction is more vertical than this is flat."""
    frames: FramesConfig
    sweep: SweepConfig
    gate: GateConfig
    panels: PanelsConfig
    slides: SlidesConfig
    kind: KindConfig
    rails: RailsConfig
    limits: LimitsConfig
    journal: JournalConfig
    clearance: ClearanceConfig
    guide: GuideConfig
    rockers: RockersConfig
    front_cues: FrontCuesConfig
    compound: CompoundConfig
