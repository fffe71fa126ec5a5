"""How well the best joint of a contact edge explains the contact: the evidence that the tree search weighs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.config import QualityConfig
    from kinematify.contact.graph import ContactEdge
    from kinematify.joints.hypotheses.bearing_line import EdgeBearing


def edge_quality(edge: ContactEdge, bearing: EdgeBearing | None, config: QualityConfig) -> float:
    """Quality of a contact edge in [0, 1].

    The score of the best bearing, saturated; contact strength fills what it leaves open, so that it only decides among
    edges without one. Rails do not count, for the flat faces of neighbouring boxes look like them. A bridge, which
    touches nothing, keeps a little of its contact's share.
    """
    score = bearing.lines[0].score if bearing is not None and bearing.lines else 0.0
    bearing_share = score / (score + config.half_score)
    touching = float(edge.strength**config.strength_power)
    if edge.bridge:
        touching *= config.bridge_share
    return bearing_share + (1.0 - bearing_share) * config.contact_weight * touching
