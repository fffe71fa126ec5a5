"""The distance-weighted, contact-aware virtual-linkage objective (paper section III-D)."""

from __future__ import annotations

from pydantic import model_validator

from kinematify.config.base import StageConfig


class CavlConfig(StageConfig):
    """DW-CAVL: contact-aware virtual motions that rank joint candidates (III-D)."""

    volume_margin: float
    """m_vol: distances below it count as touching."""
    sharpness: float
    """Logistic sharpness k, in units of 1 / m_vol."""
    contact_width: float
    """sigma_c: samples within this distance of the other part anchor it."""
    epsilon: float
    """epsilon_small: total weight below which a term fades out; all samples together weigh 1."""
    consistency_weight: float
    """lambda_c: price of separation near the contact."""
    collision_weight: float
    """lambda_coll: price of penetration."""
    pivot_weight: float
    """lambda_p: price of a pivot away from the contact centroid."""
    bounded_separation: bool
    """L_cons grows no further once a sample has left the contact by `contact_width`, and samples of the contact count
    in L_coll too (DW-CAVL+; not printed)."""
    length_unit: float
    """Length that counts as 1 in J; a smaller one spreads the scores 1 / (1 + J)."""
    angles_deg: list[float]
    """Theta of revolute candidates [deg]."""
    travels: list[float]
    """Theta of prismatic candidates, paired with `angles_deg`."""
    match_motion: bool
    """Turn and slide so that the contact moves equally far: by at most `angles_deg` and about `travels`."""
    least_lever: float
    """Smallest lever arm of a contact in that comparison."""
    better_direction: bool
    """Average over the positive or the negative half of Theta, whichever costs less; false: over all of it."""
    symmetric: bool
    """Average J over both parts' fields; false: the parent's field alone, as in the paper."""
    type_ratio: float
    """zeta: revolute if s_rev > zeta s_pri."""
    random_axes: int
    """Random directions in the paper's candidate pool."""
    pivot_offsets: list[float]
    """Shifts of the pivot along every candidate axis."""
    rank_points: int
    """Samples per part when the pool is ranked."""
    refine_points: int
    """Samples per part when the best are refined and scored."""
    top: int
    """Candidates of each type that are refined."""
    refine_steps: int
    """Gradient steps; 0 leaves the candidates where they are."""
    learning_rate: float
    """Step of the gradient descent [rad, and fraction of the diagonal]."""
    batch_queries: int
    """Distance queries at a time; bounds the memory at about 200 bytes each."""

    @model_validator(mode="after")
    def _paired(self) -> CavlConfig:
        signs = [(angle > 0) - (angle < 0) for angle in self.angles_deg]
        if not signs or 0 in signs or signs != [(travel > 0) - (travel < 0) for travel in self.travels]:
            raise ValueError("angles_deg and travels must be pairs of equal sign, without zeros")
        return self
