"""Which part is the base link, by a scored rule that knows how machines stand.

No single cue finds the base (feasibility.md 3): it is the end of an arm, the hub of a hand, the junction of legs.
The rule therefore asks seven physical questions, each a function that returns one value in [0, 1] per part,
and ranks the parts by their best answer. Only the vertical direction of the world is used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import shortest_path

from kinematify.contact.graph import pair
from kinematify.robot.vectors import box_around

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kinematify.contact.graph import Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.topology.edge_evidence import TreeEvidence


# Weights of the cues for the base link; each cue is in [0, 1], each weight the score it can reach. With these 61 of 64
# robots are right in three poses each, and 47 of 48 everyday objects; +-40 % changes little.
BULK_DECADES = 2.0  # feet and fingers are about 1 % of a trunk
"""A part this many powers of ten smaller than the largest has no bulk left."""
VERTICAL = 0.95  # 18 deg: turntables of tilted objects still count
"""Axes with a larger vertical component stand upright [cosine]."""
STAND_BAND = 0.03  # gaps under doors and lids are wider
"""Parts that begin this far above the lowest point do not stand on the ground, in diagonals."""
STAND_FLAT = 0.4  # feet of lamps, plates of taps; wheels and tips lie on a line or point
"""Share of its footprint with which what stands alone must lie on the ground."""
STAND_WEIGHT = 1.0  # right on all 30 objects and robots where it spoke
"""Score of what alone stands on the ground, and of what alone lies under the ceiling with all else below."""
HANG_FLAT = 0.1  # rings, and plates with feet, lie on little of their footprint
"""Nothing hangs where something lies on the ground with more than this share of its footprint."""
BODY_SHARE = 0.5  # half of the doors and drawers may hang on other parts
"""Share of all other parts that the largest part must carry directly to be the body of an object."""
BODY_WEIGHT = 0.95
"""Score of the body of an object."""
TWIN_DISCOUNT = 0.7  # identical parts are limbs; two halves of a laptop still win
"""Factor on a body that has a congruent twin."""
PEDESTAL_RISE = 0.5  # bases of arms lie in the lower half whatever the arm does
"""Height above the lowest point at which the end of a chain is no pedestal any more, in diagonals."""
PEDESTAL_BULK = 0.3
"""Share of size in the score of a pedestal."""
PEDESTAL_LOW = 0.3
"""Share of lowness in the score of a pedestal."""
PEDESTAL_FLAT = 0.2  # feet of bases may be rounded or in three points
"""Share of a level bottom in the score of a pedestal."""
PEDESTAL_UPRIGHT = 0.2  # the first axis of most arms is vertical, that of a gripper may be
"""Share of a vertical first axis in the score of a pedestal."""
JUNCTION_WEIGHT = 0.5  # above a hub: a pelvis wins over a torso
"""Score of the part where the lowest congruent limbs meet, whatever its size."""
JUNCTION_BULK = 0.35
"""What its size can add."""
GROUND_BAND = 0.05  # uneven floors, wheels that reach below the chassis
"""Parts that begin this far above the lowest point reach the ground, in diagonals."""
HEAVY_WEIGHT = 0.8
"""Score of the largest part where it reaches the ground."""
HUB_WEIGHT = 0.5  # for what stands on nothing: hands
"""Score of the part in which most long chains meet."""


@dataclass(frozen=True, kw_only=True)
class BaseCandidate:
    """A part that may be the base link."""

    part: int
    score: float
    """In [0, 1]; comparable within one assembly."""
    reason: str
    """Why, one sentence for the record."""


def rank_bases(
    edges: Iterable[Pair],
    stats: Sequence[PartStats],
    clusters: Sequence[Sequence[int]],
    evidence: TreeEvidence,
) -> tuple[BaseCandidate, ...]:
    """Rank all parts by how well they would serve as base link, best first.

    Args:
        edges: The undirected spanning tree of the best joints.
        stats: Size and support of every part, world frame, z up.
        clusters: Groups of congruent parts.
        evidence: Of the contacts; the axis of their best joint tells a turntable from a hinge.

    Returns:
        One candidate per part. Ties go to the larger part, then to the lower index.
    """
    skeleton = Skeleton(edges, stats, clusters, evidence)
    cues = (
        ("It alone touches the ground.", stand(skeleton)),
        ("It alone reaches the ceiling, and all the rest hangs below.", canopy(skeleton)),
        ("It carries most other parts directly and is the largest.", body(skeleton)),
        ("It is the standing end of a chain.", pedestal(skeleton)),
        ("It joins the limbs that stand lowest.", limb_junction(skeleton)),
        ("It is a large part that reaches the ground.", heavy_foot(skeleton)),
        ("Most long chains meet in it.", hub(skeleton)),
    )
    values = np.stack([value for _, value in cues])
    scores = values.max(axis=0)
    order = sorted(range(len(stats)), key=lambda i: (-round(scores[i], 9), -skeleton.hull[i], i))
    return tuple(
        BaseCandidate(part=i, score=float(scores[i]), reason=cues[int(values[:, i].argmax())][0]) for i in order
    )


class Skeleton:
    """Arrays that the cues share: the undirected tree, sizes, heights and which parts have a twin."""

    def __init__(
        self,
        edges: Iterable[Pair],
        stats: Sequence[PartStats],
        clusters: Sequence[Sequence[int]],
        evidence: TreeEvidence,
    ) -> None:
        """Measure the tree once."""
        self.clusters = clusters
        self.n = len(stats)
        self.neighbours: list[list[int]] = [[] for _ in stats]
        for a, b in edges:
            self.neighbours[a].append(b)
            self.neighbours[b].append(a)
        self.degree = np.array([len(items) for items in self.neighbours])
        self.distance = _tree_distances(self.neighbours)
        self.hull = np.array([item.hull_volume for item in stats])
        self.bulk = self.hull / self.hull.max()
        self.flat = np.array([item.flat_bottom for item in stats])
        self.flat_above = np.array([item.flat_top for item in stats])
        self.top = np.array([item.top for item in stats])
        self.middle = np.array([float(item.centroid[2]) for item in stats])
        lower, upper = box_around([item.bounds for item in stats])
        self.bottom = np.array([item.bottom for item in stats])
        self.rise = (self.bottom - lower[2]) / max(float(np.linalg.norm(upper - lower)), 1e-12)
        self.low = self.rise <= STAND_BAND
        self.upright = np.array([self._upright_share(i, evidence) for i in range(self.n)])
        self.twin = np.zeros(self.n, dtype=bool)
        self.twin[[part for cluster in clusters for part in cluster]] = True

    def branch_depth(self, part: int, neighbour: int) -> int:
        """Links on the longest chain that leaves `part` through `neighbour`."""
        beyond = self.distance[neighbour] < self.distance[part]
        return int(self.distance[part][beyond].max())

    def long_branches(self, part: int) -> int:
        """Number of chains of two or more links that leave a part."""
        return sum(self.branch_depth(part, item) >= 2 for item in self.neighbours[part])

    def relative_bulk(self) -> FloatArray:
        """Hull volume on a logarithmic scale: 1 for the largest part, 0 at `bulk_decades` below it, shape (n,)."""
        share: FloatArray = np.clip(1 + np.log10(self.bulk) / BULK_DECADES, 0, 1)
        return share

    def _upright_share(self, part: int, evidence: TreeEvidence) -> float:
        """Share of a part's joints whose axis is vertical."""
        edges = [pair(part, other) for other in self.neighbours[part] if pair(part, other) in evidence.quality]
        axes = (evidence.axes.get(edge) for edge in edges)
        return float(np.mean([axis is not None and abs(axis[2]) > VERTICAL for axis in axes] or [0.0]))


def stand(skeleton: Skeleton) -> FloatArray:
    """Globes, taps, lamps, staplers: what alone reaches the ground, and lies flat on it, carries all the rest."""
    flat = skeleton.flat > STAND_FLAT
    alone = skeleton.low & flat & ~skeleton.twin & (skeleton.low.sum() == 1)
    return np.where(alone, STAND_WEIGHT, 0.0)


def canopy(skeleton: Skeleton) -> FloatArray:
    """Ceiling fans, hanging lamps: nothing lies flat on the ground, and one part lies flat above all others."""
    highest = int(skeleton.top.argmax())
    others = np.delete(skeleton.top, highest)
    hangs = len(others) > 0 and others.max() < skeleton.middle[highest]
    flat = skeleton.flat_above[highest] > STAND_FLAT and not skeleton.twin[highest]
    stands = (skeleton.flat[skeleton.low] > HANG_FLAT).any()
    score = np.zeros(skeleton.n)
    score[highest] = STAND_WEIGHT * float(hangs and flat and not stands)
    return score


def body(skeleton: Skeleton) -> FloatArray:
    """Furniture, appliances, tools: one large body carries doors, drawers and knobs, most of them directly."""
    reach = skeleton.distance.max(axis=1)
    share = skeleton.degree / max(skeleton.n - 1, 1)
    compact = reach.min() <= 2 and share[int(skeleton.bulk.argmax())] >= BODY_SHARE
    alone = np.where(skeleton.twin, TWIN_DISCOUNT, 1.0)
    score: FloatArray = BODY_WEIGHT * skeleton.bulk * alone * compact
    return score


def pedestal(skeleton: Skeleton) -> FloatArray:
    """Arms: the base ends a chain, is one of a kind, low, large, flat below, and often carries a turntable.

    Fingers end chains too, but come as congruent twins; a tool is small and has no flat bottom near the ground.
    """
    low = np.clip(1 - skeleton.rise / PEDESTAL_RISE, 0, 1)
    score = (
        PEDESTAL_BULK * skeleton.relative_bulk()
        + PEDESTAL_LOW * low
        + PEDESTAL_FLAT * skeleton.flat
        + PEDESTAL_UPRIGHT * skeleton.upright
    )
    return np.where((skeleton.degree == 1) & ~skeleton.twin, score, 0.0)


def limb_junction(skeleton: Skeleton) -> FloatArray:
    """Legged and wheeled machines stand on congruent feet or wheels; where those limbs meet is the base."""
    lowest = int(skeleton.bottom.argmin())
    score = np.zeros(skeleton.n)
    for cluster in skeleton.clusters:
        if lowest in cluster:
            junction = _steiner_centre(skeleton, np.asarray(cluster))
            strength = JUNCTION_WEIGHT + JUNCTION_BULK * skeleton.relative_bulk()[junction]
            score[junction] = strength * _limbs_carry(skeleton, junction) * (junction not in cluster)
    return score


def heavy_foot(skeleton: Skeleton) -> FloatArray:
    """Mobile bases and stands: a large part on the ground that is not one of several alike."""
    grounded = skeleton.rise <= GROUND_BAND
    stands = 0.5 + 0.5 * skeleton.flat
    return np.where(grounded & ~skeleton.twin, HEAVY_WEIGHT * skeleton.bulk * stands, 0.0)


def hub(skeleton: Skeleton) -> FloatArray:
    """Hands touch no ground: the palm is where most chains of two or more links meet."""
    counts = np.array([skeleton.long_branches(part) for part in range(skeleton.n)])
    chains = np.where(counts >= 3, counts / max(counts.max(), 1), 0.0)
    return HUB_WEIGHT * chains * (0.5 + 0.5 * skeleton.relative_bulk())


def _limbs_carry(skeleton: Skeleton, junction: int) -> float:
    """1 where the limbs below a junction can carry the machine, less where a single part hangs down between them.

    Arms that hang beside a column reach lower than it, too, but the column then lies below their shoulders.
    """
    singles = skeleton.rise[~skeleton.twin]
    span = skeleton.rise[junction]
    if span <= 0 or len(singles) == 0:
        return 1.0
    return 1.0 - float(np.clip((span - singles.min()) / span, 0, 1))


def _steiner_centre(skeleton: Skeleton, members: IntArray) -> int:
    """Part with the smallest longest distance to the members; nearest in total, then largest, on a tie."""
    to_members = skeleton.distance[:, members]
    keys = zip(to_members.max(axis=1), to_members.sum(axis=1), -skeleton.hull, range(skeleton.n), strict=True)
    return int(min(keys)[-1])


def _tree_distances(neighbours: Sequence[Sequence[int]]) -> IntArray:
    """Number of edges between every two parts, shape (n, n)."""
    rows = [a for a, items in enumerate(neighbours) for _ in items]
    columns = [b for items in neighbours for b in items]
    matrix = csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(len(neighbours),) * 2)
    distances: IntArray = shortest_path(matrix, unweighted=True).astype(np.int64)
    return distances
