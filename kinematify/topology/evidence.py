"""What is known of the joint of each contact edge before the tree is: how good the edge is, and the joint's axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.choice.edges import edge_qualities
from kinematify.robot.arrays import read_only

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.measure.pins import EdgePins
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeEvidence:
    """How good a contact is for the tree, and its best joint; the same for both directions of the edge."""

    quality: float
    """In [0, 1]."""
    axis: FloatArray | None
    """Unit direction of the best joint in the world frame, shape (3,); None where there is none. Read-only."""
    carriers: frozenset[int] = frozenset()
    """Parts that bear both ends about one line, where one end turns past the other."""

    def __post_init__(self) -> None:
        if self.axis is not None:
            axis = np.asarray(self.axis, dtype=np.float64)
            object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))


def gather_evidence(
    graph: ContactGraph, stats: Sequence[PartStats], bearings: Mapping[Pair, EdgeBearing], pins: EdgePins
) -> dict[Pair, EdgeEvidence]:
    """Evidence of every contact edge, keyed (a, b) with a < b; arguments as in `edges.edge_measurements`."""
    axes = {pair: bearing.lines[0].axis for pair, bearing in bearings.items() if bearing.lines}
    return {
        pair: EdgeEvidence(quality=quality, axis=axes.get(pair), carriers=pins.passing.get(pair, frozenset()))
        for pair, quality in edge_qualities(graph, stats, bearings, pins).items()
    }
