"""Settings of the search for the kinematic tree, and of the weight of a model's failures in it."""

from __future__ import annotations

from typing import Literal

from kinematify.config.base import StageConfig, section


class BaseConfig(StageConfig):
    """Weights of the cues for the base link; each cue is in [0, 1], each weight the score it can reach.

    With these 61 of 64 robots are right in three poses each, and 47 of 48 everyday objects; +-40 % changes little.
    """

    bulk_decades: float = 2.0  # feet and fingers are about 1 % of a trunk
    """A part this many powers of ten smaller than the largest has no bulk left."""
    vertical: float = 0.95  # 18 deg: turntables of tilted objects still count
    """Axes with a larger vertical component stand upright [cosine]."""
    stand_band: float = 0.03  # gaps under doors and lids are wider
    """Parts that begin this far above the lowest point do not stand on the ground, in diagonals."""
    stand_flat: float = 0.4  # feet of lamps, plates of taps; wheels and tips lie on a line or point
    """Share of its footprint with which what stands alone must lie on the ground."""
    stand_weight: float = 1.0  # right on all 30 objects and robots where it spoke
    """Score of what alone stands on the ground, and of what alone lies under the ceiling with all else below."""
    hang_flat: float = 0.1  # rings, and plates with feet, lie on little of their footprint
    """Nothing hangs where something lies on the ground with more than this share of its footprint."""
    body_share: float = 0.5  # half of the doors and drawers may hang on other parts
    """Share of all other parts that the largest part must carry directly to be the body of an object."""
    body_weight: float = 0.95
    """Score of the body of an object."""
    twin_discount: float = 0.7  # identical parts are limbs; two halves of a laptop still win
    """Factor on a body that has a congruent twin."""
    pedestal_rise: float = 0.5  # bases of arms lie in the lower half whatever the arm does
    """Height above the lowest point at which the end of a chain is no pedestal any more, in diagonals."""
    pedestal_bulk: float = 0.3
    """Share of size in the score of a pedestal."""
    pedestal_low: float = 0.3
    """Share of lowness in the score of a pedestal."""
    pedestal_flat: float = 0.2  # feet of bases may be rounded or in three points
    """Share of a level bottom in the score of a pedestal."""
    pedestal_upright: float = 0.2  # the first axis of most arms is vertical, that of a gripper may be
    """Share of a vertical first axis in the score of a pedestal."""
    junction_weight: float = 0.5  # above a hub: a pelvis wins over a torso
    """Score of the part where the lowest congruent limbs meet, whatever its size."""
    junction_bulk: float = 0.35
    """What its size can add."""
    ground_band: float = 0.05  # uneven floors, wheels that reach below the chassis
    """Parts that begin this far above the lowest point reach the ground, in diagonals."""
    heavy_weight: float = 0.8
    """Score of the largest part where it reaches the ground."""
    hub_weight: float = 0.5  # for what stands on nothing: hands
    """Score of the part in which most long chains meet."""


class RewardWeights(StageConfig):
    """Weights of the terms of a tree's reward; only their ratios count."""

    struct: float = 0.002  # prefers shallow trees, wrong for every arm
    """R_struct: shallow trees of the preferred out-degree."""
    static: float = 0.002  # the torque of one pose is not a structural cue
    """R_static: little gravitational torque."""
    contact: float = 1.0  # joint quality tells true edges from spurious ones; alone it gives TED 0.17 on six robots
    """R_contact: mean weight of the edges."""
    sym: float = 0.05  # decides between edges of equal quality
    """R_sym: congruent parts at equal depth on corresponding parents."""
    hier: float = 0.02  # a pelvis is smaller than its torso: a hint, not a law
    """R_hier: children no larger than parents."""
    base: float = 2.0  # the root is by far the largest cause of tree errors (feasibility.md 3)
    """Score of the root under the base rule."""
    stack: float = 0.1  # outweighs a few hundredths of quality between two fits of one line, no more
    """R_stack: what turns about one line hangs side by side; not in the paper's reward."""


class TopologyConfig(StageConfig):
    """Settings of the way from a contact graph to a ranked list of kinematic trees."""

    mode: Literal["mcts", "mst", "bfs"] = "mcts"
    """Search, maximum spanning trees alone, or breadth-first orientation alone."""
    reward: Literal["default", "paper"] = "default"
    """Our terms with joint quality, or the five terms of the paper with contact strength."""
    base_rule: Literal["scored", "degree", "given"] = "scored"
    """Our scored rule, the paper's highest degree, or none: the base link has to be given, as in its Algorithm 1."""
    # congruent neighbours of an arm are true edges: 8 of 9 Panda parents wrong when forbidden
    cluster_edges: Literal["allow", "forbid"] = "allow"
    """Whether a tree may have edges inside a cluster of congruent parts."""
    weights: RewardWeights = section()
    base: BaseConfig = section()
    preferred_degree: int = 2
    """``k`` of R_struct."""
    max_bases: int = 4  # the true base was among the first three on 63 of 64 robots
    """Base links that are tried at most."""
    base_doubt: float = 0.03  # wrong bases of objects built in code led by less; a warning is cheap
    """A tree with another base link whose reward is within this of the best one makes the base doubtful."""
    base_margin: float = 0.3  # no true base was farther below, but for hanging fingers and cut-off arms
    """A base link is tried when its score is at most this far below the best."""
    iterations: int = 400  # exhausts nearly every real graph; 200 parts take about two seconds
    """Simulations of the tree search, shared by all base links."""
    exploration: float = 0.7  # half of the usual sqrt 2: greedy rollouts are already good
    """``C`` of UCT."""
    normalise_returns: bool = True  # trees differ in the third digit, which UCT would not see
    """Stretch returns to [0, 1] between the worst and best seen, so that ``C`` has a meaning."""
    competitive_ratio: float = 0.4  # joint fits of spurious edges reach 0.4 of true ones only by mistake
    """An edge is searched when its weight is at least this share of the weakest edge it could replace."""
    max_open_edges: int = 40  # beyond, the search would not visit them all
    """Edges outside the spanning tree that are searched at most."""
    keep: int = 8  # alternatives for simulation to choose from
    """Distinct trees that are kept."""
    clear_score: float = 0.035  # rough pins have 0.03, flat contacts up to about 0.02
    """Score of a bearing from which on a contact is not asked what holds it."""
    stack_deg: float = 2.0  # fits of one line agree to a few tenths
    """Axes within this angle are one line [deg]."""
    stack_distance: float = 5.0e-3  # bearings of different lines lie farther apart than their own walls
    """The same for their distance, in diagonals."""
    virtual_distance: float = 0.5  # half of the object; a part farther away belongs to something else
    """``d_max``: centroids farther apart are joined only when nothing nearer is left, in diagonals."""
    pin_score: float = 0.1  # pins of a gripper have 0.16 and 0.18, lines beside a bearing reach 0.01
    """Score of a bearing line from which two links share a pin."""
    pin_opens: float = 0.005  # clearances of bearings and the noise of axes stay below
    """How far a shared pin may come apart without a chain of joints closing there, in diagonals."""


class FeedbackConfig(StageConfig):
    """Settings of the reading of failures; what each weighs is measured (`kinematify.validation.failure_rates`)."""

    open_share: float = 0.9  # a side that is free for half of the range only is no side to open to: a suitcase
    """A side that is free over this share of the range is the one that opens."""
    back_share: float = 0.5  # drawers are modelled half open
    """A slide that leaves its guide, and whose way back is free over this share of its range, stands open."""
    full_turn: float = 1.5708  # doors open by a right angle
    """Ranges of turning joints count up to this [rad]."""


class RefineConfig(StageConfig):
    """The loop: infer, simulate, feed back, choose again."""

    rounds: int = 3  # nothing new fails after two rounds on nearly every object
    """Rounds at most after the first."""
    margin: float = 3.0  # one to twenty: what is less likely is not saved by a sweep
    """Candidates this far below the best are near-best and are simulated; where the chosen joint is farther below, its
    shape alone speaks against it [log odds]."""
    near_best: int = 4  # on most edges fewer differ
    """So many of them at most."""
    lead: float = 0.3  # a tie stays with the inference
    """A candidate replaces the chosen one if it leads by more [log odds]."""
    lead_elsewhere: float = 1.2  # less than any error weighs (3.0): half of the doubted axes are right
    """The same for a candidate of another type or direction [log odds]."""
    least_travel: float = 0.5  # what is blocked earlier has a wrong line or mesh; a shorter range would hide that
    """A range that is blocked may not be cut below this share of what the inference saw free."""
    least_kept: float = 0.05  # what has left its parent has no joint any more: all that is kept is all there is
    """The same of a range beyond which the part has left its parent."""
    contact_tolerance: float = 0.0025  # that of the contact stage, measured again from the meshes
    """Gap up to which two parts are held to touch when contacts are measured again, fraction of the diagonal."""
    hovering_share: float = 0.5  # single parts hang on bearings that are not modelled; half of all do not
    """If so many parts touch nothing, the tolerance is wrong, not the tree."""
    hovering_reach: float = 1.5  # gaps within one object are alike
    """The tolerance then is this multiple of the median gap to the nearest part."""
    widest_tolerance: float = 0.03  # farther apart are parts of different things
    """And at most this, fraction of the diagonal."""
    survival_weight: float = 0.5  # half of what the quality of joints weighs
    """Weight of R_sim, the mean survival of a tree's edges, in the reward of the tree search."""
    feedback: FeedbackConfig = section()
