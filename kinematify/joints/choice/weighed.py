"""What the weighted cues say of every joint that an edge may have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.joints.choice.kind import KindDecision
    from kinematify.joints.hypotheses.panels import RankedTurns
    from kinematify.joints.hypotheses.slides import RankedSlides
    from kinematify.joints.measure.scene import JointScene


@dataclass(frozen=True, kw_only=True, eq=False)
class WeighedJoints:
    """Every joint that one tree edge may have, weighed, before one is chosen."""

    scene: JointScene
    turns: RankedTurns
    slides: RankedSlides
    decision: KindDecision
