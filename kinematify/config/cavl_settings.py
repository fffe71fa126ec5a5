"""The distance-weighted, contact-aware virtual-linkage objective (paper section III-D)."""

from __future__ import annotations

from pydantic import Field, model_validator

from kinematify.config.base import StageConfig


class CavlConfig(StageConfig):
    """DW-CAVL: contact-aware virtual motions that rank joint candidates (III-D)."""

    volume_margin: float = 2.0e-3  # gaps of real joints reach 0.2 % of the diagonal (feasibility.md 10)
    """m_vol: distances below it count as touching."""
    sharpness: float = 4.0  # the weight falls from 0.98 at the surface to 0.02 at two margins
    """Logistic sharpness k, in units of 1 / m_vol."""
    contact_width: float = 0.01  # five margins (feasibility.md 10)
    """sigma_c: samples within this distance of the other part anchor it."""
    epsilon: float = 1.0e-6  # one sample of a million
    """epsilon_small: total weight below which a term fades out; all samples together weigh 1."""
    consistency_weight: float = 1.0  # separation and penetration of equal depth cost the same
    """lambda_c: price of separation near the contact."""
    collision_weight: float = 1.0
    """lambda_coll: price of penetration."""
    pivot_weight: float = 1.0e-4  # breaks ties along the axis; at 1 it decides alone (feasibility.md 10)
    """lambda_p: price of a pivot away from the contact centroid."""
    bounded_separation: bool = False  # as printed
    """L_cons grows no further once a sample has left the contact by `contact_width`, and samples of the contact count
    in L_coll too (DW-CAVL+; not printed)."""
    length_unit: float = 0.01  # J is about 1 where the contact is lost by its own width
    """Length that counts as 1 in J; a smaller one spreads the scores 1 / (1 + J)."""
    # small turns find the axis, large ones distinguish types
    angles_deg: list[float] = Field([-20.0, -10.0, -5.0, 5.0, 10.0, 20.0])
    """Theta of revolute candidates [deg]."""
    # what a lever arm of a tenth moves under those angles
    travels: list[float] = Field([-0.04, -0.02, -0.01, 0.01, 0.02, 0.04])
    """Theta of prismatic candidates, paired with `angles_deg`."""
    match_motion: bool = True  # unequal motions compare nothing (feasibility.md 10)
    """Turn and slide so that the contact moves equally far: by at most `angles_deg` and about `travels`."""
    least_lever: float = 0.01  # contacts on the axis itself do not move, and nothing would be compared
    """Smallest lever arm of a contact in that comparison."""
    better_direction: bool = True  # drawers and doors move one way only
    """Average over the positive or the negative half of Theta, whichever costs less; false: over all of it."""
    symmetric: bool = True  # a pin knows its axis where the socket's shell has no inside
    """Average J over both parts' fields; false: the parent's field alone, as in the paper."""
    type_ratio: float = 1.0  # neither type is preferred before the evidence of the other stages
    """zeta: revolute if s_rev > zeta s_pri."""
    random_axes: int = 4  # "a few"
    """Random directions in the paper's candidate pool."""
    pivot_offsets: list[float] = Field(
        [0.0, -0.01, 0.01]
    )  # "a handful", "slightly"; J depends on them through lambda_p alone
    """Shifts of the pivot along every candidate axis."""
    rank_points: int = 400  # ranks as 4000 do on hinges, drawers and knobs
    """Samples per part when the pool is ranked."""
    refine_points: int = 1200
    """Samples per part when the best are refined and scored."""
    top: int = 3
    """Candidates of each type that are refined."""
    refine_steps: int = 30  # converged to 0.1 deg on clean bearings
    """Gradient steps; 0 leaves the candidates where they are."""
    learning_rate: float = 0.01  # half a degree per step
    """Step of the gradient descent [rad, and fraction of the diagonal]."""
    batch_queries: int = 400000  # about 100 MB
    """Distance queries at a time; bounds the memory at about 200 bytes each."""

    @model_validator(mode="after")
    def _paired(self) -> CavlConfig:
        signs = [(angle > 0) - (angle < 0) for angle in self.angles_deg]
        if not signs or 0 in signs or signs != [(travel > 0) - (travel < 0) for travel in self.travels]:
            raise ValueError("angles_deg and travels must be pairs of equal sign, without zeros")
        return self
