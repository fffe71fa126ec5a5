"""Settings of the choice of a joint: frames, sweeps, what the contact allows, limits."""

from __future__ import annotations

import math
from typing import Literal

from kinematify.config.base import StageConfig, section
from kinematify.config.cues import GateConfig, PanelsConfig, SlidesConfig


class FramesConfig(StageConfig):
    """Box frames of parts."""

    volume_slack: float = 0.06  # a handle tilts the smallest box by 5 to 40 deg and gains only a few percent
    """A preferred frame may hold a box larger than the smallest by this fraction."""
    handle_share: float = 0.1  # a handle faces the front with 1 to 8 % of a door's area
    """Share of the area facing the thin direction that may lie outside the slab on either side."""
    handle_gap: float = 0.3  # what reaches less far is relief, not a handle
    """An end is cut off if it reaches beyond the slab by more than this fraction of the slab's thickness."""


class SweepConfig(StageConfig):
    """Virtual motion test."""

    points: int = 300  # a wall or post narrower than 1/17 of the part may be missed
    """Points that represent the moving part."""
    shrink: float = 0.015  # parts that slide along each other touch exactly; 1.5 % clears them
    """Fraction by which they are drawn towards the part's centre."""
    hinge_zone: float = 0.22  # corners next to the hinge dig into the frame in most meshes
    """Points closer to the axis than this fraction of the part's reach are exempt."""
    grace: float = 0.003  # overlaps of touching parts are below this in the meshes that were looked at
    """Motion at the start that is not tested, fraction of the assembly's diagonal."""
    step_deg: float = 7.5  # a chord of 7.5 deg leaves its arc by 0.2 % of the radius
    """Length of the straight pieces of a turn [deg]."""
    share: float = 0.03  # a few stray points (rails, hinges) are no stop
    """A motion is blocked once more than this share of the points has hit something."""


class JournalConfig(StageConfig):
    """Pins in bores and barrels in knuckles: round surfaces of both parts that face each other."""

    faces: int = 12000  # a hinge pin has 100; a coarse share of a dense mesh still shows it
    """Faces of a part that are looked at, at most."""
    straight: float = 0.85  # within 32 deg: facets of a coarse pin
    """Cosine: the other surface lies straight before a face and looks back."""
    pairs: int = 400  # a pin that holds a tenth of the facing faces is proposed about forty times
    """Pairs of neighbouring faces that propose lines."""
    neighbours: int = 12  # the next facets around a pin
    """Nearest faces among which the second of a pair is drawn."""
    least_sine: float = 0.2  # 11 deg: pins have 6 to 32 sides
    """Sine of the angle between two normals below which they propose nothing."""
    largest: float = 0.3  # wheels and lids are round outside; what holds them is smaller
    """Largest radius as a fraction of the child's longest side."""
    normal_deg: float = 15.0  # centroids of the triangles of a 12-sided pin lie 10 deg off its facets
    """Largest angle between a face's normal and the radius [deg]."""
    radius_tolerance: float = 0.2  # a polygon with 8 sides is 8 % thinner across its flats
    """Largest deviation of a face from the radius, as a fraction of it."""
    leaning: float = 0.012  # a belt of a ball within normal_deg has 0.022, pins with bumps up to 0.007
    """Mean square of the cosine between the normals and the line beyond which the surface is a ball's."""
    sectors: int = 12  # a 12-sided pin fills them all
    """Into which a full turn is divided."""
    coverage: float = 0.7  # knuckles that are open on one side hold as well
    """Share of the sectors that must be held."""

    @property
    def normal_tolerance(self) -> float:
        """`normal_deg` [rad]."""
        return math.radians(self.normal_deg)


class ClearanceConfig(StageConfig):
    """Limits on how far the surface of a contact can turn or slide before it is stopped."""

    least_samples: int = 30  # fewer may all lie on one side of a key
    """Fewer samples of a contact say nothing."""
    samples: int = 400  # a key that takes up a tenth of the contact shows with 40
    """Samples that are followed, at most about."""
    inset: float = 0.001  # a tenth of a millimetre on a part of 10 cm: rounding, and facets of a bore
    """Samples are drawn into their own material by this fraction of the child's diagonal."""
    turn_deg: float = 45.0  # a square key in a wide pocket stops within 25
    """Angle that counts as free [deg]."""
    slide: float = 0.15  # parts that slide travel by more; buttons travel less and stop early both ways
    """Travel that counts as free, fraction of the child's diagonal."""
    share: float = 0.12  # edges and stray samples are fewer
    """The contact is stopped when more than this share of its samples has hit."""
    journal_share: float = 0.06  # a rib takes up a tenth of its bore, and each of its sides stops one way
    """The same for a contact with a journal."""
    least: float = 0.01  # clearances of small parts reach a hundredth of their size
    """Shorter travels are clearance, fraction of the child's diagonal."""
    candidates: int = 15  # the lines of one edge are ranked near each other
    """Best lines of turning among which those at one edge are looked for."""
    lines: int = 4  # the corners of a leaf at one side, and what lies between
    """Lines at the best edge that are tried."""
    edge: float = 0.12  # leaves are thinner
    """Lines within this distance are at one edge, fraction of the child's diagonal."""
    ratio: float = 1.4  # a button is stopped early both ways, but goes farther in
    """One motion is free and the other is not where it goes so many times farther."""


class LimitsConfig(StageConfig):
    """Limits from sweeps: an upper bound of the designed range."""

    panel_deg: float = 90.0  # sweeps often find no stop; nine doors of ten open to about a right angle
    """Largest opening of a panel [deg]."""
    blocked_deg: float = 20.0  # a panel that is free turns by 60 and more
    """A panel that turns less far is shut in by something, or its mesh overlaps its frame [deg]."""
    square_deg: float = 4.0  # frames of closed panels are square to 1 or 2 deg
    """A panel within this angle of square to its body is closed [deg]."""
    closer: float = 0.9  # the other way about, a panel leaves its body
    """Closing an open panel brings it so much nearer to its body, ratio of mean distances."""
    lying: float = 0.2  # shut lids reach a twentieth to a tenth of the distance that they have open
    """A panel that has come so near to its body lies on it, ratio of mean distances."""
    lying_deg: float = 30.0  # lower edges of screens dip into their base; handles of bags stop well before half a turn
    """Meshes at the hinge of such a panel may overlap before it gets there, by this angle [deg]."""
    unstopped_deg: float = 100.0  # arms that are stopped by what is in the mesh stop earlier on one side
    """A lever that turns farther both ways is stopped inside, where it cannot be seen [deg]."""
    lever_deg: float = 45.0  # door handles and flush levers turn by 35 to 50
    """Travel of a lever that is pressed down [deg]; about an upright axis twice this both ways."""
    drawer: float = 0.8  # 88 % of drawers travel within a quarter of this share of their length
    """Travel of a drawer as a fraction of its own length."""
    ajar: float = 0.1  # fronts stand out by their own thickness, a tenth of a drawer at most
    """A drawer whose front stands out by more than this fraction of its length is open."""
    room: float = 0.03  # clearances are a hundredth, strokes of buttons a tenth
    """A round part with this much room behind it is pressed, fraction of its diagonal."""
    one_way: float = 0.02  # pockets and grace together are shallower
    """A slide that is free farther one way by this fraction of the diagonal has an open side."""
    button: float = 0.7  # of what stands out: a cap is not pressed in whole
    """Travel of a button as a fraction of what stands out of the surface around it."""
    pressed_share: float = 0.3  # chosen on two of three sources, the third gains: results/choice.md
    """Share of a button's points that have met something where it is stopped."""
    stopped_deg: float = 10.0  # arms in mid-range turn by 45 and more
    """A turning joint that goes no farther than this the one way stands at its stop [deg]."""
    unmet_deg: float = 90.0  # everyday2 asks for 90, Infinigen and Articraft for 45; what is too small blocks
    """Either way of a lever or handle that meets nothing in half a turn [deg]."""
    least_slide: float = 5.0e-4  # buttons of a washing machine travel by 0.2 %
    """A sliding joint keeps at least this travel, fraction of the diagonal."""


class GuideConfig(StageConfig):
    """Limits on how far a part can slide before it leaves what it runs in or on."""

    steps: int = 60  # shares fall evenly, so that proportion serves between two steps
    """Travels that are looked at, up to the diagonal of the object."""
    samples: int = 150  # the share is known to a few hundredths
    """Samples of each side of the contact that are followed, at most about."""
    least_samples: int = 12  # stray samples of an edge
    """Fewer samples along the way are no guide."""
    band: float = 0.05  # clearances reach a hundredth, and two sides add up
    """Surfaces within this distance guide each other, fraction of the child's diagonal."""
    along_deg: float = 20.0  # facets of a round guide; stops stand across
    """Surface within this angle of the way runs along it [deg]."""
    kept: float = 0.85  # samples at the ends of a guide are lost early
    """A part begins to leave its guide where less than this share of the contact is left."""
    gone: float = 0.05  # stray samples stay
    """It has left it where less than this share is left."""
    runner: float = 1.5  # buttons are pressed by less than their length, collars run along rods
    """What can slide this many times its own length is no button."""


class FrontCuesConfig(StageConfig):
    """Pedals and wheels at the foot of a body."""

    small: float = 0.3  # pedals and wheels are a tenth to a fifth of their bin
    """Largest diagonal of such a part, fraction of the body's."""
    low: float = 0.2  # a shoe's height on a small bin
    """Largest height of its middle above the foot, fraction of the body's height."""
    aside: float = 0.5  # at the front or back, not under the middle
    """Least distance from the middle of the body, in halves of its narrower side."""
    agreeing: float = 0.7  # two wheels a bin's width apart sum up to about 1
    """Length of the sum of the unit directions of all such parts, at least."""


class RailsConfig(StageConfig):
    """When the rail of a contact speaks for sliding.

    On 14 robots every slide but one scores above 0.10, every hinge below 0.12 or with less lead.
    """

    score_none: float = 0.12
    """Rail score up to which it says nothing."""
    score_full: float = 0.15
    """Rail score from which it says all it can."""
    lead_none: float = 3.0  # no hinge of a machine with a rail of 0.10 leads by more than 1.5
    """The same for the rail's score over that of the best bearing line."""
    lead_full: float = 4.5  # a lift of voxels of 1/150 of the diagonal leads by 4.6, clean guides by 8 and more
    """Full where the lead is at least this."""
    pin_deg: float = 15.0  # lifts and telescopes are stopped within 12 deg, pins turn by 17 or more
    """Free turn about a line along the rail beyond which the rail is a pin [deg]."""
    least_travel: float = 0.5  # of a useful length; boxy knuckles that overlap are stopped at a quarter
    """Free travel along the rail below which a part that turns freely is not on it, in useful lengths."""
    rounded_lead: float = 1.5  # the fingers of sliding grippers lead by 4 to 40, of hinged ones by 0.6 or by little
    """Below this lead a pair of end parts is hinged, not sliding."""
    # voxels leave neither rails nor edges of sliding fingers: up to 0.009; hinged ones keep 0.07
    rounded_least: float = 0.012
    """Where the best bearing line scores less, the contact shows nothing round."""


class ConfidenceConfig(StageConfig):
    """Probability that a joint is right (`results/choice.md`)."""

    cues_lead: float = 0.75  # with less, furniture that the cues were written for loses; with more, all else
    """Log odds that what the weighted cues would choose keeps over the fitted probabilities."""
    fixed: float = 0.9  # of 1,673 parts that move 3 are lost, with 0.82 12; of 194 that do not 105 are found, not 136
    """How likely a part must be fixed to be taken for it."""
    name_weight: float = 3.5  # "drawer", "wheel" and "foot" weigh this much; anonymous names nothing
    """Log odds that a part's name adds to the kind of joint that it speaks of."""


class JointsConfig(StageConfig):
    """Choice of each joint's type, axis, direction and limits."""

    # 0.05 deg on robots, where DW-CAVL alone reaches 0.3 to 17 (feasibility.md 4)
    method: Literal["geometry", "cavl"] = "geometry"
    """Bearings, panels and slides, or the paper's DW-CAVL alone."""
    samples: int = 2000  # spacing of 2 to 3 % of a part's size: finer than any cue looks
    """Surface samples per part."""
    confidence: ConfidenceConfig = section()
    alternatives: int = 12  # simulation feedback chooses among them; more are never near the best
    """Distinct candidates kept per type."""
    contact_band: float = 0.004  # gaps of real hinges reach 0.2 % of the diagonal; twice that
    """Contact samples within this distance beyond the gap count as touching, fraction of the diagonal."""
    small_full: float = 0.14  # buttons and knobs are below a seventh of the body
    """A part below this fraction of its parent's diagonal is small."""
    small_none: float = 0.24  # doors and drawers are above a quarter of it
    """A part above this fraction of its parent's diagonal is not small."""
    panel_thinness: float = 0.36  # doors 0.02 to 0.15, with bins behind them 0.33; drawers above 0.4
    """A panel is thinner than this fraction of its second side."""
    thick_door: float = 0.55  # half of a pair of fridge doors: 0.5; levers are as thick as high
    """So is an upright one below this, if it is thin beside the geometric mean of its other sides."""
    upright_cosine: float = 0.5  # within 30 deg of upright
    """A panel whose thin direction is less vertical than this is upright."""
    spread_full: float = 0.2  # joints of machines touch over a tenth to a third of the link
    """Contact spread below this fraction of the child's half diagonal is compact."""
    spread_none: float = 0.38  # panels and drawers touch over two fifths and more of their size
    """Contact spread above this fraction of the child's half diagonal is not compact."""
    serial_depth: int = 3  # furniture has a part on a door at most
    """A tree with this many joints in series is a linkage."""
    flat_cosine: float = 0.8  # within 37 deg of level: lids slope
    """A panel whose thin direction is more vertical than this is flat."""
    frames: FramesConfig = section()
    sweep: SweepConfig = section()
    gate: GateConfig = section()
    panels: PanelsConfig = section()
    slides: SlidesConfig = section()
    rails: RailsConfig = section()
    limits: LimitsConfig = section()
    journal: JournalConfig = section()
    clearance: ClearanceConfig = section()
    guide: GuideConfig = section()
    front_cues: FrontCuesConfig = section()
