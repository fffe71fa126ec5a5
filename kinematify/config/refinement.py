"""How failures of a model are weighed and fed back into the search."""

from __future__ import annotations

from kinematify.config.base import StageConfig


class FeedbackConfig(StageConfig):
    """How failures are read; what each weighs is measured (`kinematify.validation.failure_rates`)."""

    open_share: float
    """A side that is free over this share of the range is the one that opens."""
    back_share: float
    """A slide that leaves its guide, and whose way back is free over this share of its range, stands open."""
    full_turn: float
    """Ranges of turning joints count up to this [rad]."""
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
    """Candidates this far below the best are near-best and are simulated; where the chosen joint is farther below, its
    shape alone speaks against it [log odds]."""
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
