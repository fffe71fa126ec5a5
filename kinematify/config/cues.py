"""Weights and thresholds of the cues for turning, for sliding, and for which of them it is."""

from __future__ import annotations

from typing import Any

from pydantic import Field, field_validator

from kinematify.config.base import StageConfig


class CuesConfig(StageConfig):
    """A stage with a weight for each cue: a file may state some of them, and the others stay."""

    @field_validator("weights", mode="before", check_fields=False)
    @classmethod
    def _others(cls, given: Any) -> Any:
        return {**cls.model_fields["weights"].default, **given} if isinstance(given, dict) else given


class GateConfig(StageConfig):
    """When a bearing line is taken as it is: either is enough."""

    product: float = 0.06  # real bearings score above 0.07, two surfaces that happen to be round below 0.055
    """Surface score times circle score."""
    located: float = 0.15  # flat-sided parts stay below 0.12, cylinders in sockets above 0.16
    """Round area on both parts that locates the line, without flat seats (geometric mean of the shares)."""


class PanelsConfig(CuesConfig):
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
    cap: float = 1.5  # no cue may outvote three others at full strength
    """Largest influence of a single cue, in units of the score."""
    bearing_bonus: float = 4.0  # a bearing found on both parts is right to 0.1 deg; it outvotes every panel cue
    """What a bearing that passes the gate adds to its line."""
    weights: dict[str, float] = Field(
        {
            "free": 1.0,  # the unit of this scale: free over a designed range
            "crossed": -0.5,  # walls met on the way, less than a stop
            "outside": 0.5,  # doors open out of the body far more often than into it
            # a hinge keeps the parts together; a tenth of the diagonal apart counts as half a free motion
            "separation": -5.0,
            "axis_to_parent": -4.0,  # the line runs along the body that carries it
            "contact_share": 0.4,  # hinges touch; a closed panel also touches elsewhere, so weak
            "contact_radius": -0.5,  # the same, without a threshold
            "ajar_contact": 1.5,  # an open panel touches only at its hinge: decides by itself
            "handle_distance": 0.9,  # people put handles opposite hinges
            "handle_parallel": 0.6,  # a long handle runs along the hinge
            # controls and neighbour doors are opposite the hinge (clipped in code by margin_cap)
            "margin_difference": 1.0,
            "margin_here": -1.0,  # a hinge lies at the edge of the body
            "door_vertical": 0.4,  # most upright panels turn about a vertical line
            "door_tall": 0.2,  # the more so the taller they are
            "hinge_above": -0.3,  # gravity closes a flap that is hinged above, so few are
            "hinge_below": 0.0,  # drop-down doors are as common as their handles say; no opinion
            "lid_rise": 1.0,  # a lid that is opened goes up
            "lid_behind": 1.0,  # wheels are below the hinge, pedals opposite; as telling as a backrest
            "pedal": 1.0,  # a pedal tips about its inner end
            "lid_backrest": 1.0,  # tanks, columns and screens stand behind the hinge of a lid
            "thin_along": -0.7,  # a plate hardly ever turns in its own plane; discs and links of a linkage are exempt
            "length_along": 0.15,  # hinges run along long edges, a weak habit
            "half_way": -0.3,  # hinges are at corners of the slab more often than half-way through its thickness
            "centre_line": -0.7,  # a line through the middle needs a bearing, which would be seen
            "contact_line": -0.2,  # box edges are exact where both fit
            "clusters": 0.8,  # bails and drop handles turn in two pins
            "weak_bearing": -0.3,  # a bearing too weak for the gate is chance on furniture
            "mechanism_bearing": 2.0,  # but the best explanation of a compact contact in a linkage
            "compact_radius": -1.0,  # where the contact is one small patch, the axis passes it
            "round": 2.0,  # a part that is round about a line turns about it
            "square": 0.5,  # axes of machines run along their parts; lines of chance run anywhere
            "rolling": 1.5,  # what rolls turns about the middle of its disc, however tight its well
            "small_normal": 0.6,  # knobs and handles stand on the surface that they turn on
        }
    )
    """Weight of each cue of `hypotheses/panels.py`; lengths in diagonals."""


class SlidesConfig(CuesConfig):
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
    cap: float = 2.5  # the twin direction alone may outvote two cues
    """Largest influence of a single cue, in units of the score."""
    weights: dict[str, float] = Field(
        {
            "travel_parent": 1.0,  # the unit of this scale: free by a useful length
            "travel_all": 0.3,  # other parts may be moved away first
            "one_way": 0.6,  # drawers stop at the back
            "flush": 0.6,  # the front of a drawer is the front of the body
            "crossed": -0.5,  # walls met on the way
            "thin_large": -0.4,  # plates slide in their plane
            "horizontal": 0.5,  # gravity holds what slides level
            # a round guide also guides a slide; a direction from a bearing is right even when the type is not
            "along_bearing": 1.5,
            "along_rail": 2.5,  # a guide is to a slide what a bearing is to a turn
            "lift_off": 1.0,  # a lid on top that can rise is lifted
            "cap": 2.5,  # a lid that reaches over the rim all round comes off upwards; sweeps shrink it into the rim
            "small_way": 1.0,  # what sits in a pocket moves in and out of it
            "thin_small": 0.7,  # buttons are pressed along their thin side
            "normal_small": 0.7,  # and across the surface that they sit on
            "twin": 2.5,  # fingers of a gripper close on each other
        }
    )
    """Weight of each cue of `hypotheses/slides.py`; lengths in diagonals."""


class KindConfig(CuesConfig):
    """Log odds of sliding against turning."""

    bias: float = -0.8  # two of three joints turn
    """Log odds of sliding before any evidence."""
    cap: float = 3.0  # no cue may outvote two others at full strength
    """Largest influence of a single cue."""
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
    weights: dict[str, float] = Field(
        {
            "drawer": 3.0,  # a box inside a cavity that leaves one way only
            "box_pulled": 1.0,  # a box that can leave level, seen half out
            "box_inside": 1.5,  # boxes inside bodies are drawers
            "blocked_turn": 2.0,  # what cannot turn but can travel slides
            "carriage": 2.5,  # what travels in a shaft slides
            "telescope": 3.0,  # a rod deep in a tube is drawn out; the friction of so long a bearing is for holding
            "guided": 3.0,  # a collar that stays on its column while it travels is a lift
            "panel": -2.0,  # plates hinge
            "tray": 3.0,  # a level plate under a roof slides
            "turntable": -2.0,  # a level disc inside turns
            "bearing": -1.5,  # a bearing is made for turning
            "mechanism": -1.5,  # nine joints of ten in linkages turn
            "button": 1.6,  # small parts without a bearing are pressed: 20 of 24
            "round_small": -1.5,  # round, as high as wide: a knob
            "flat_cap": 0.5,  # flat: a button
            "round_lid": 2.5,  # round lids on top are lifted
            "on_moving_part": -1.0,  # small parts of doors are handles and locks
            "capped": 3.0,  # a skirt on all four sides leaves no edge to turn about
            "latch": -2.5,  # what lies across a seam holds it shut, and is swung away
            "keyed": 3.0,  # what cannot turn but can slide slides, whatever its shape
            "retained": -2.5,  # what cannot slide but can turn turns
            "row": 2.4,  # three or more equal small parts are keys
            "edge_contact": -2.0,  # a plate that touches along one edge hangs on it
            "rocker": -2.5,  # a folded front is made to tip
            "pedal": -2.5,  # what is trodden on tips, it is not pushed in
            "wheel": -3.0,  # discs on the floor roll
            "gripper": 3.0,  # facing fingers at the end of a chain
            "rail": 3.0,  # outweighs bias and mechanism together
            "sliding_pair": 3.0,  # panels that can pass each other
        }
    )
    """Weight of each cue of `choice/kind.py`; positive for sliding."""
