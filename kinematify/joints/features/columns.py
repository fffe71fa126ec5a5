"""Everything that is known of the hypotheses of one edge, as one array with a row each: the input of the choice."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import SLIDE, TURN, joined
from kinematify.joints.features.measurements import MeasuredHypotheses, measure_groups
from kinematify.joints.features.slide_cues import rank_slides
from kinematify.joints.features.turn_cues import rank_turns
from kinematify.joints.features.type_cues import type_cues, type_odds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.measurements import Values
    from kinematify.joints.features.ranking import Ranked
    from kinematify.robot.arrays import FloatArray

CUES, VERDICTS = "cues", "verdicts"
"""Groups of what was measured for the weighted cues, and of what these say; the others are `measurements.GROUPS`."""
TYPE = "type_"
"""Before the names of the cues of the type."""
_ODDS = 8.0  # what cues say of the type counts no more than this


@dataclass(frozen=True, kw_only=True, eq=False)
class Features:
    """The hypotheses of one edge with all that is measured of them."""

    scene: JointScene
    hypotheses: Hypotheses
    """Fixed, every turn and every slide, those of a kind in the order in which cues rank them."""
    groups: Mapping[str, Values]
    """Shape (h,) each, by group and name; NaN or absent where a measurement does not apply."""
    free_parent: FloatArray
    """Free motion towards + and - against the parent alone [rad, or fraction of the diagonal], shape (h, 2)."""

    @cached_property
    def columns(self) -> Values:
        """All groups by name."""
        return {name: value for values in self.groups.values() for name, value in values.items()}

    @property
    def type_cues(self) -> dict[str, float]:
        """Return what speaks for sliding or for turning."""
        cues = self.groups[VERDICTS].items()
        return {name.removeprefix(TYPE): float(value[0]) for name, value in cues if name.startswith(TYPE)}

    @property
    def by_cues(self) -> int:
        """Position of the moving hypothesis that the weighted cues alone would choose."""
        slides = self.columns["rules_odds"][-1] > 0.0
        return 1 + int(slides * (self.hypotheses.kinds == TURN).sum())


def features_of(scene: JointScene, proposed: Hypotheses, rivals: int | None = None) -> Features:
    """Measure the hypotheses of an edge.

    Args:
        scene: The pair.
        proposed: Its joints, of which those that were given have no say in the type.
        rivals: So many of each type, which cues rank first, are measured beside those that were given; all if absent.
    """
    turns = rank_turns(scene, proposed.at(np.flatnonzero(proposed.kinds == TURN))).first(rivals)
    slides = rank_slides(scene, proposed.at(np.flatnonzero(proposed.kinds == SLIDE))).first(rivals)
    m = MeasuredHypotheses(scene, joined(proposed.at(np.array([0])), turns.lines, slides.lines))
    return Features(
        scene=scene,
        hypotheses=m.hypotheses,
        groups={**measure_groups(m), CUES: _cues(m, turns, slides), VERDICTS: _verdicts(m, turns, slides)},
        free_parent=np.concatenate([np.zeros((1, 2)), turns.free_parent, slides.free_parent]),
    )


def _cues(m: MeasuredHypotheses, turns: Ranked, slides: Ranked) -> Values:
    """The cues of turns and of slides before any weight, as measurements like others; NaN where none applies, (h,)."""
    scene, others = m.scene, len(slides.scores)
    facts = {"has_bearing": scene.has_bearing, "mechanism": scene.mechanism, "smallness": scene.smallness}
    return {
        **{
            f"{kind}_{name}": np.pad(value, around, constant_values=np.nan)
            for kind, found, around in (("turn", turns, (1, others)), ("slide", slides, (1 + len(turns.scores), 0)))
            for name, value in {
                "room": found.free.max(axis=1),
                "room_parent": found.free_parent.max(axis=1),
                **found.cues,
            }.items()
        },
        **{name: m.of_each(value) for name, value in facts.items()},
    }


def _verdicts(m: MeasuredHypotheses, turns: Ranked, slides: Ranked) -> Values:
    """Return what the weighted sums of cues say of each hypothesis, and the cues of the type, (h,) each.

    They were written while objects were looked at. Half of what is fitted does not see them.
    """
    cues = type_cues(m.scene, turns.proposed, slides.proposed)
    odds = float(np.clip(type_odds(cues), -_ODDS, _ODDS))
    return {
        "rules_score": np.concatenate([[np.nan], *(found.scores - found.scores.max() for found in (turns, slides))]),
        "rules_odds": np.repeat([0.0, -odds, odds], [1, len(turns.scores), len(slides.scores)]),
        **{f"{TYPE}{name}": m.of_each(value) for name, value in cues.items()},
    }
