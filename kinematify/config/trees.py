"""How the kinematic tree is searched."""

from __future__ import annotations

from typing import Literal

from kinematify.config.base import StageConfig


class BaseConfig(StageConfig):
    """Weights of the cues for the base link; each cue is in [0, 1], each weight the score it can reach."""

    bulk_decades: float
    """A part this many powers of ten smaller than the largest has no bulk left."""
    vertical: float
    """Axes with a larger vertical component stand upright [cosine]."""
    stand_band: float
    """Parts that begin this far above the lowest point do not stand on the ground, in diagonals."""
    stand_flat: float
    """Share of its footprint with which what stands alone must lie on the ground."""
    stand_weight: float
    """Score of what alone stands on the ground, and of what alone lies under the ceiling with all else below."""
    hang_flat: float
    """Nothing hangs where something lies on the ground with more than this share of its footprint."""
    body_share: float
    """Share of all other parts that the largest part must carry directly to be the body of an object."""
    body_weight: float
    """Score of the body of an object."""
    twin_discount: float
    """Factor on a body that has a congruent twin."""
    pedestal_rise: float
    """Height above the lowest point at which the end of a chain is no pedestal any more, in diagonals."""
    pedestal_bulk: float
    """Share of size in the score of a pedestal."""
    pedestal_low: float
    """Share of lowness in the score of a pedestal."""
    pedestal_flat: float
    """Share of a level bottom in the score of a pedestal."""
    pedestal_upright: float
    """Share of a vertical first axis in the score of a pedestal."""
    junction_weight: float
    """Score of the part where the lowest congruent limbs meet, whatever its size."""
    junction_bulk: float
    """What its size can add."""
    ground_band: float
    """Parts that begin this far above the lowest point reach the ground, in diagonals."""
    heavy_weight: float
    """Score of the largest part where it reaches the ground."""
    hub_weight: float
    """Score of the part in which most long chains meet."""


class RewardWeights(StageConfig):
    """Weights of the terms of a tree's reward; only their ratios count."""

    struct: float
    """R_struct: shallow trees of the preferred out-degree."""
    static: float
    """R_static: little gravitational torque."""
    contact: float
    """R_contact: mean weight of the edges."""
    sym: float
    """R_sym: congruent parts at equal depth on corresponding parents."""
    hier: float
    """R_hier: children no larger than parents."""
    base: float
    """Score of the root under the base rule."""
    stack: float
    """R_stack: what turns about one line hangs side by side; not in the paper's reward."""


class TopologyConfig(StageConfig):
    """How a contact graph becomes a ranked list of kinematic trees."""

    mode: Literal["mcts", "mst", "bfs"]
    """Search, maximum spanning trees alone, or breadth-first orientation alone."""
    reward: Literal["default", "paper"]
    """Our terms with joint quality, or the five terms of the paper with contact strength."""
    base_rule: Literal["scored", "degree", "given"]
    """Our scored rule, the paper's highest degree, or none: the base link has to be given, as in its Algorithm 1."""
    cluster_edges: Literal["allow", "forbid"]
    """Whether a tree may have edges inside a cluster of congruent parts."""
    weights: RewardWeights
    base: BaseConfig
    preferred_degree: int
    """``k`` of R_struct."""
    max_bases: int
    """Base links that are tried at most."""
    base_doubt: float
    """A tree with another base link whose reward is within this of the best one makes the base doubtful."""
    base_margin: float
    """A base link is tried when its score is at most this far below the best."""
    iterations: int
    """Simulations of the tree search, shared by all base links."""
    exploration: float
    """``C`` of UCT."""
    normalise_returns: bool
    """Stretch returns to [0, 1] between the worst and best seen, so that ``C`` has a meaning."""
    competitive_ratio: float
    """An edge is searched when its weight is at least this share of the weakest edge it could replace."""
    max_open_edges: int
    """Edges outside the spanning tree that are searched at most."""
    keep: int
    """Distinct trees that are kept."""
    clear_score: float
    """Score of a bearing from which on a contact is not asked what holds it."""
    stack_deg: float
    """Axes within this angle are one line [deg]."""
    stack_distance: float
    """The same for their distance, in diagonals."""
    virtual_distance: float
    """``d_max``: centroids farther apart are joined only when nothing nearer is left, in diagonals."""
    pin_score: float
    """Score of a bearing line from which two links share a pin."""
    pin_opens: float
    """How far a shared pin may come apart without a chain of joints closing there, in diagonals."""
