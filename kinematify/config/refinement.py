"""How failures of a model are weighed and fed back into the search."""

from __future__ import annotations

from kinematify.config.base import StageConfig


class FeedbackConfig(StageConfig):
    """What each kind of failure weighs, in log odds, the unit of the scores of candidates."""

    warning_share: float
    """Weight of a warning, as a share of that of an error."""
    open_share: float
    """A side that is free over this share of the range is the one that opens."""
    back_share: float
    """A slide that leaves its guide, and whose way back is free over this share of its range, stands open."""
    full_turn: float
    """Ranges of turning joints count up to this [rad]."""
    blocked_line: float
    """Against a line about which the part is blocked to both sides at once (KV310)."""
    blocked_type: float
    """The same against its type."""
    derailed_line: float
    """Against a line along which the part leaves its parent (KV320)."""
    derailed_type: float
    """The same against its type."""
    sibling_edge: float
    """Against a parent, where the part runs into another body (KV311)."""
    hovering_edge: float
    """Against a parent that the part does not touch (KV303, KV341)."""
    evidence_line: float
    """Against a line where another one fits better (KV342 to KV344)."""
    evidence_type: float
    """Against a type where the other one fits better (KV345)."""
    stuck_line: float
    """Against a line that an engine cannot drive to its end though no hull is in the way (KV405, KV505)."""
    unstable_line: float
    """Against a line that escapes its limits or gains energy though masses and rest are fine (KV407 to KV409)."""
    sinking_line: float
    """Against a line along which the part sinks (KV404)."""
    task_line: float
    """Against a line that no robot can pull through (KV703 to KV706)."""
    placements: int
    """Places of the robot that must have failed before that counts."""


class RefineConfig(StageConfig):
    """The loop: infer, simulate, feed back, choose again."""

    rounds: int
    """Rounds at most after the first."""
    seconds_factor: float
    """Time for all rounds by geometry, as a multiple of that of the inference."""
    seconds_least: float
    """The same, at least [s]."""
    margin: float
    """Candidates this far below the best are near-best and are simulated [log odds]."""
    near_best: int
    """So many of them at most."""
    lead: float
    """A candidate replaces the chosen one if it leads by more [log odds]."""
    lead_elsewhere: float
    """The same for a candidate of another type or direction [log odds]."""
    least_travel: float
    """A range that is blocked may not be cut below this share of what the inference saw free."""
    least_kept: float
    """The same of a range beyond which the part has left its parent."""
    contact_tolerance: float
    """Gap up to which two parts are held to touch when contacts are measured again, fraction of the diagonal."""
    hovering_share: float
    """If so many parts touch nothing, the tolerance is wrong, not the tree."""
    hovering_reach: float
    """The tolerance then is this multiple of the median gap to the nearest part."""
    widest_tolerance: float
    """And at most this, fraction of the diagonal."""
    twin_lead: float
    """Twins are told what most of them are if their common evidence leads by so much [log odds]."""
    survival_weight: float
    """Weight of R_sim, the mean survival of a tree's edges, in the reward of the tree search."""
    feedback: FeedbackConfig
