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

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.config import BaseConfig
    from kinematify.contact.graph import Pair
    from kinematify.geometry.part_stats import PartStats
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.topology.edge_evidence import EdgeEvidence


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
    evidence: Mapping[Pair, EdgeEvidence],
    config: BaseConfig,
) -> tuple[BaseCandidate, ...]:
    """Rank all parts by how well they would serve as base link, best first.

    Args:
        edges: The undirected spanning tree of the best joints.
        stats: Size and support of every part, world frame, z up.
        clusters: Groups of congruent parts.
        evidence: Best joint of each edge, keyed (a, b) with a < b; its axis tells a turntable from a hinge.
        config: Weights and limits of the cues.

    Returns:
        One candidate per part. Ties go to the larger part, then to the lower index.
    """
    skeleton = Skeleton(edges, stats, clusters, evidence, config)
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
        evidence: Mapping[Pair, EdgeEvidence],
        config: BaseConfig,
    ) -> None:
        """Measure the tree once."""
        self.config = config
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
        lower = np.min([item.bounds[0] for item in stats], axis=0)
        upper = np.max([item.bounds[1] for item in stats], axis=0)
        self.bottom = np.array([item.bottom for item in stats])
        self.rise = (self.bottom - lower[2]) / max(float(np.linalg.norm(upper - lower)), 1e-12)
        self.low = self.rise <= config.stand_band
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
        share: FloatArray = np.clip(1 + np.log10(self.bulk) / self.config.bulk_decades, 0, 1)
        return share

    def _upright_share(self, part: int, evidence: Mapping[Pair, EdgeEvidence]) -> float:
        """Share of a part's joints whose axis is vertical."""
        axes = [item.axis for other in self.neighbours[part] if (item := evidence.get(pair(part, other))) is not None]
        return float(np.mean([axis is not None and abs(axis[2]) > self.config.vertical for axis in axes] or [0.0]))


def stand(skeleton: Skeleton) -> FloatArray:
    """Globes, taps, lamps, staplers: what alone reaches the ground, and lies flat on it, carries all the rest."""
    flat = skeleton.flat > skeleton.config.stand_flat
    alone = skeleton.low & flat & ~skeleton.twin & (skeleton.low.sum() == 1)
    return np.where(alone, skeleton.config.stand_weight, 0.0)


def canopy(skeleton: Skeleton) -> FloatArray:
    """Ceiling fans, hanging lamps: nothing lies flat on the ground, and one part lies flat above all others."""
    highest = int(skeleton.top.argmax())
    others = np.delete(skeleton.top, highest)
    hangs = len(others) > 0 and others.max() < skeleton.middle[highest]
    flat = skeleton.flat_above[highest] > skeleton.config.stand_flat and not skeleton.twin[highest]
    stands = (skeleton.flat[skeleton.low] > skeleton.config.hang_flat).any()
    score = np.zeros(skeleton.n)
    score[highest] = skeleton.config.stand_weight * float(hangs and flat and not stands)
    return score


def body(skeleton: Skeleton) -> FloatArray:
    """Furniture, appliances, tools: one large body carries doors, drawers and knobs, most of them directly."""
    reach = skeleton.distance.max(axis=1)
    share = skeleton.degree / max(skeleton.n - 1, 1)
    compact = reach.min() <= 2 and share[int(skeleton.bulk.argmax())] >= skeleton.config.body_share
    alone = np.where(skeleton.twin, skeleton.config.twin_discount, 1.0)
    score: FloatArray = skeleton.config.body_weight * skeleton.bulk * alone * compact
    return score


def pedestal(skeleton: Skeleton) -> FloatArray:
    """Arms: the base ends a chain, is one of a kind, low, large, flat below, and often carries a turntable.

    Fingers end chains too, but come as congruent twins; a tool is small and has no flat bottom near the ground.
    """
    weights = skeleton.config
    low = np.clip(1 - skeleton.rise / weights.pedestal_rise, 0, 1)
    score = (
        weights.pedestal_bulk * skeleton.relative_bulk()
        + weights.pedestal_low * low
        + weights.pedestal_flat * skeleton.flat
        + weights.pedestal_upright * skeleton.upright
    )
    return np.where((skeleton.degree == 1) & ~skeleton.twin, score, 0.0)


def limb_junction(skeleton: Skeleton) -> FloatArray:
    """Legged and wheeled machines stand on congruent feet or wheels; where those limbs meet is the base."""
    lowest = int(skeleton.bottom.argmin())
    score = np.zeros(skeleton.n)
    for cluster in skeleton.clusters:
        if lowest in cluster:
            junction = _steiner_centre(skeleton, np.asarray(cluster))
            weights = skeleton.config
            strength = weights.junction_weight + weights.junction_bulk * skeleton.relative_bulk()[junction]
            score[junction] = strength * _limbs_carry(skeleton, junction) * (junction not in cluster)
    return score


def heavy_foot(skeleton: Skeleton) -> FloatArray:
    """Mobile bases and stands: a large part on the ground that is not one of several alike."""
    grounded = skeleton.rise <= skeleton.config.ground_band
    stands = 0.5 + 0.5 * skeleton.flat
    return np.where(grounded & ~skeleton.twin, skeleton.config.heavy_weight * skeleton.bulk * stands, 0.0)


def hub(skeleton: Skeleton) -> FloatArray:
    """Hands touch no ground: the palm is where most chains of two or more links meet."""
    counts = np.array([skeleton.long_branches(part) for part in range(skeleton.n)])
    chains = np.where(counts >= 3, counts / max(counts.max(), 1), 0.0)
    return skeleton.config.hub_weight * chains * (0.5 + 0.5 * skeleton.relative_bulk())


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
