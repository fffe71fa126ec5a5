"""Settings of the search for the kinematic tree, and of the weight of a model's failures in it."""

from __future__ import annotations

from typing import Literal

from kinematify.config.base import StageConfig, section


class RewardWeights(StageConfig):
    """Weights of the terms of a tree's reward; only their ratios count."""

    struct: float = 1.0
    """R_struct, of the paper's reward alone: shallow trees of the preferred out-degree, which no arm has."""
    static: float = 1.0
    """R_static, of the paper's reward alone: little gravitational torque, which is of one pose and not of the tree."""
    contact: float = 1.0  # joint quality tells true edges from spurious ones; alone it gives TED 0.17 on six robots
    """R_contact: mean weight of the edges."""
    sym: float = 0.05  # decides between edges of equal quality
    """R_sym: congruent parts at equal depth on corresponding parents."""
    hier: float = 0.02  # a pelvis is smaller than its torso: a hint, not a law
    """R_hier: children no larger than parents."""
    stack: float = 0.1  # outweighs a few hundredths of quality between two fits of one line, no more
    """R_stack: what turns about one line hangs side by side; not in the paper's reward."""


class TopologyConfig(StageConfig):
    """Settings of the way from a contact graph to a ranked list of kinematic trees."""

    mode: Literal["mcts", "mst", "bfs"] = "mcts"
    """Search, maximum spanning trees alone, or breadth-first orientation alone."""
    reward: Literal["default", "paper"] = "default"
    """Our terms with joint quality, or the five terms of the paper with contact strength."""
    base_rule: Literal["scored", "degree", "given"] = "scored"
    """Our fitted choice, the paper's highest degree, or none: the base link is given, as in its Algorithm 1."""
    # congruent neighbours of an arm are true edges: 8 of 9 Panda parents wrong when forbidden
    cluster_edges: Literal["allow", "forbid"] = "allow"
    """Whether a tree may have edges inside a cluster of congruent parts."""
    weights: RewardWeights = section()
    preferred_degree: int = 2
    """``k`` of R_struct."""
    base_doubt: float = 0.2  # of 38 wrong bases 20 are doubted then, of 1,159 right ones 42
    """A part that is the base link with this probability, beside the chosen one, makes the base doubtful."""
    iterations: int = 400  # exhausts nearly every real graph; 200 parts take about two seconds
    """Simulations of the tree search."""
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
