"""Thresholds of the cues for turning, for sliding, and for which of them it is."""

from __future__ import annotations

from kinematify.config.base import StageConfig


class GateConfig(StageConfig):
    """When a bearing line is taken as it is: either is enough."""

    product: float = 0.06  # real bearings score above 0.07, two surfaces that happen to be round below 0.055
    """Surface score times circle score."""
    located: float = 0.15  # flat-sided parts stay below 0.12, cylinders in sockets above 0.16
    """Round area on both parts that locates the line, without flat seats (geometric mean of the shares)."""


class PanelsConfig(StageConfig):
    """Candidate lines and cues of turning joints."""

    sweep_deg: float = 90.0  # a quarter turn distinguishes hinge sides
    """Turn that is tested either way [deg]."""
    full_turn_deg: float = 75.0  # designed ranges of doors start near 75 deg
    """Free turn beyond which more is no better [deg]."""
    part_deg: float = 40.0  # far enough to see a wrong line leave the body
    """Turn after which the part must still be near its parent [deg]."""
    separation_points: int = 150  # the hinge side of a part shows with a point every 8 % of its size
    """Points that measure the gap after the turn."""
    bearings: int = 3  # the true line was among the first three wherever a bearing exists
    """Bearing lines among the candidates."""
    least_contact: int = 20  # fewer points do not span a line
    """Contact samples needed to propose lines from the contact."""
    cluster_gap: float = 0.3  # two pins or hinges lie at least a third of the part apart
    """Gap between two contact zones, fraction of the part's longest side."""
    hinge_band: float = 0.12  # hinges take up to an eighth of a door
    """Contact within this fraction of the part's reach counts as being at the line."""
    ajar_share: float = 0.85  # a closed panel touches along three or four edges, an open one along one
    """A panel with more of its contact at one edge stands open."""
    tall: float = 1.1  # doors that are taller than wide hang on a side, whatever their handle
    """Height over width above which an upright panel is tall."""
    tall_handle: float = 0.2  # handles of tall doors are mounted either way
    """What remains of the direction of a handle on a tall panel."""
    margin_cap: float = 0.5  # body boxes are rough, so a margin weighs at most half a free motion
    """Largest effect of the difference of margins."""
    weak_margin: float = 0.3  # margins of lids and of doors with a clear handle were right about as often as wrong
    """What remains of the difference of margins for lids, and where a handle is clearly off centre."""


class SlidesConfig(StageConfig):
    """Candidate directions and cues of sliding joints."""

    sweep: float = 0.6  # longer than any drawer is deep
    """Travel that is tested either way, fraction of the diagonal."""
    useful_share: float = 0.6  # drawers travel by 0.67 to 0.91 of their length, sliding windows by half
    """Free travel beyond which more is no better, fraction of the part's length that way."""
    useful_least: float = 0.1  # sideways play of thin parts is below
    """The same as a fraction of the diagonal, for parts that are short that way."""
    short_travel: float = 0.12  # a third of a drawer: what crosses on the first third crosses
    """Travel on which crossings are counted, fraction of the diagonal."""
    distinct_deg: float = 5.0  # closer directions are the same within the accuracy of box frames
    """Directions closer than this are one [deg]."""


class KindConfig(StageConfig):
    """Log odds of sliding against turning."""

    box_none: float = 0.25  # leaves have up to a tenth
    """Depth over the smaller side of the front up to which a part inside its body is no drawer."""
    box_full: float = 0.5  # one drawer behind the whole front of a cabinet is half as deep as wide
    """The same from which it is one."""
    pulled_none: float = 0.4  # doors of fridges reach as far
    """`box_none` of parts that are not inside their body."""
    pulled_full: float = 0.9
    """`box_full` of them."""
    shaft: float = 0.6  # four sides of six
    """Share of the directions in which the walls of a shaft stand, at least."""
    sunk_none: float = 0.05  # sashes lie in the middle of a frame a twentieth as deep as wide
    """Depth of a plate below the outside of its body at which it may be a door, in diagonals."""
    sunk_full: float = 0.15  # a third of the height of a toaster
    """Depth from which it is none."""
    deep_none: float = 2.0  # bearings are about as long as wide
    """Length over width up to which a round contact is a bearing."""
    deep_full: float = 4.0  # gas springs are held over five times their width
    """Length over width from which it is that of a telescope."""
    drawn: float = 0.3  # flanges and heads stop pins sooner
    """Share of that length by which the part can be drawn out."""
    bars_equal: float = 0.7  # bores of one drawing score alike; bolts score a tenth of what turns
    """Least score of a second bearing beside the best one, as a share of its score."""
    bars_apart: float = 0.05  # lines of one bore found twice lie within a thousandth
    """Least distance between the two [fraction of the child's diagonal]."""
    bars_deg: float = 30.0  # thin ropes are passed by 16 deg before enough samples are in them
    """A part that turns by more about the best one does not run on both [deg]."""
    plunger_even: float = 0.012  # pointers and marks of knobs make 0.015 and more
    """Eccentricity up to which a round plug bears no pointer."""
    plunger_least: float = 0.1  # clearances behind knobs reach 0.08
    """Least room behind a plug that is pressed [fraction of its diagonal]."""
    plunger_most: float = 0.7  # hollow bodies have several
    """Largest: with more, it would fall in."""
    stuck_candidates: int = 30  # nearly all lines: over-segmentation must be beyond doubt
    """Turning candidates that must all be blocked before a part counts as fixed."""
    stuck_factor: float = 8.0  # grace and chance samples let a held part seem to move by a few percent
    """Room up to this many times the thresholds below is looked at again, without grace."""
    stuck_deg: float = 3.0  # the shrinkage of the moving part alone gives up to 2 deg
    """Turn below which a part counts as stuck [deg]."""
    stuck_slide: float = 0.012  # and up to 1 % of its size
    """Travel below which a part counts as stuck, fraction of its own diagonal."""
