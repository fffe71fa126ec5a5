"""Thresholds of the cues for turning and for sliding."""

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
