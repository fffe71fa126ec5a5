"""How well the best joint of a contact edge explains the contact: the evidence that the tree search weighs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.config import QualityConfig
    from kinematify.contact.graph import ContactEdge
    from kinematify.joints.bearing import EdgeBearing


def edge_quality(edge: ContactEdge, bearing: EdgeBearing | None, config: QualityConfig) -> float:
    """Quality of a contact edge in [0, 1].

    The score of the best bearing or, discounted, of the rail, saturated; contact strength fills what they leave open,
    so that it only decides among edges without either. A bridge, which touches nothing, keeps a little of that.
    """
    score = 0.0
    if bearing is not None:
        rail = bearing.rail.score if bearing.rail is not None else 0.0
        score = max(bearing.lines[0].score if bearing.lines else 0.0, config.rail_weight * rail)
    bearing_share = score / (score + config.half_score)
    touching = float(edge.strength**config.strength_power)
    if edge.bridge:
        touching *= config.bridge_share
    return bearing_share + (1.0 - bearing_share) * config.contact_weight * touching
