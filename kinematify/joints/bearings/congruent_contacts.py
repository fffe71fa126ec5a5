"""Contacts of congruent parts share their bearing: what one limb hides, another one shows (paper III-D, symmetry).

The knees of a humanoid are one design, so their bearings lie alike in the legs. Where the mesh of one knee is too
rough to tell, lines of chance win; they differ from knee to knee, and the true one does not. Every line of a contact
is therefore carried over to its twins, along the motion that lays one limb upon the other, and weighed there as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.bearing_evidence import contact_centroid, thin
from kinematify.joints.bearings.line import Line
from kinematify.joints.bearings.refine_lines import refine_line
from kinematify.joints.bearings.scores import BearingLine, EdgeBearing, best_distinct, scored_line

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import BearingConfig
    from kinematify.contact.alike import RigidMotion
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.surface import PartSurface
    from kinematify.joints.bearings.bearing_evidence import Sides
    from kinematify.robot.arrays import FloatArray


_MOST = 5  # more only repeat each other, and the cost grows with the square
"""Twins that are asked about each contact."""


def shared_by_twins(
    bearings: Mapping[Pair, EdgeBearing],
    sides: Mapping[Pair, Sides],
    surfaces: Sequence[PartSurface],
    graph: ContactGraph,
    *,
    config: BearingConfig,
) -> dict[Pair, EdgeBearing]:
    """Rank the lines of every contact that has twins by what all of them show.

    Clean parts are left alone where every contact of a group has a clear bearing, or none: there is nothing to learn.

    Args:
        bearings: What every contact shows by itself.
        sides: Evidence of the contacts, as it was fitted.
        surfaces: Derived geometry of each part.
        graph: Contacts and which parts are alike.
        config: `twins` and the tolerances, lengths in metres.

    Returns:
        The bearings of all contacts. Those whose best line is now another one say so in `follows`.
    """
    result = dict(bearings)
    for group in _groups(graph):
        if not _to_learn(group, bearings, surfaces, config):
            continue
        voters = {
            pair: _Voter(bearings[pair], sides[pair], config.for_roughness(_roughness(surfaces, pair)))
            for pair in group
        }
        for pair in group:
            twins = _twins_of(pair, group, voters, graph, surfaces[pair[0]].part.diagonal)
            if twins:
                result[pair] = _voted(voters[pair], twins, config)
    return result


def _groups(graph: ContactGraph) -> list[tuple[Pair, ...]]:
    """Contacts whose parts are alike, or the same on one side; two or more."""
    kinds: dict[tuple[int, ...], list[Pair]] = {}
    for pair in sorted(graph.by_pair):
        kinds.setdefault(tuple(sorted(graph.alike.roughly[list(pair)].tolist())), []).append(pair)
    return [tuple(pairs) for pairs in kinds.values() if len(pairs) > 1]


def _to_learn(
    group: Sequence[Pair],
    bearings: Mapping[Pair, EdgeBearing],
    surfaces: Sequence[PartSurface],
    config: BearingConfig,
) -> bool:
    clear = [bearings[pair].best_score >= config.twins.clear for pair in group]
    rough = any(_roughness(surfaces, pair) > config.rough_from for pair in group)
    return rough or (any(clear) and not all(clear))


def _roughness(surfaces: Sequence[PartSurface], pair: Pair) -> float:
    """Roughness of the rougher part of a contact [deg]."""
    return max(surfaces[part].roughness for part in pair)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Twin:
    """Another contact and how lines get there."""

    pair: Pair
    voter: _Voter
    motion: RigidMotion
    swapped: bool
    """The first part of one contact is congruent to the second of the other one."""


def _twins_of(
    pair: Pair, group: Sequence[Pair], voters: Mapping[Pair, _Voter], graph: ContactGraph, size: float
) -> list[_Twin]:
    """The contacts of a group that a motion of congruent parts lays upon this one: the nearest are asked."""
    here, kind = voters[pair], graph.alike.roughly

    def nearness(other: Pair) -> tuple[float, ...]:
        # Rounded, so that the clearest of equally near ones is asked, whatever the order of the parts.
        apart = float(np.linalg.norm(voters[other].centroid - here.centroid)) / size
        return round(apart, 3), -round(voters[other].bearing.best_score, 6), float(voters[other].centroid[2])

    twins = []
    for other in sorted((other for other in group if other != pair), key=nearness)[:_MOST]:
        found = [
            (apart, motion, there != other)
            for there in (other, other[::-1])
            if (kind[list(pair)] == kind[list(there)]).all()
            for apart, motion in graph.alike.contact_motions(pair, there, (here.centroid, voters[other].centroid))
        ]
        if found:
            _, motion, swapped = min(found, key=lambda item: item[0])
            twins.append(_Twin(pair=other, voter=voters[other], motion=motion, swapped=swapped))
    return twins


# ---- the vote --------------------------------------------------------------------------------------------------------


class _Voter:
    """One contact: its own lines, and what it says of those of others."""

    def __init__(self, bearing: EdgeBearing, sides: Sides, config: BearingConfig) -> None:
        self.bearing = bearing
        self.centroid = contact_centroid(sides)
        self._sides = thin(sides[0], config.refine_samples), thin(sides[1], config.refine_samples)
        self._config = config

    def opinion(self, line: Line) -> BearingLine:
        """Return what is known of a line, or of one next to it: motions are less exact than bearings."""
        for own in self.bearing.lines:
            if self.near(own.line, line):
                return own
        if all(len(side.weights) for side in self._sides):
            tolerances = np.full(2, self._config.normal_tolerance_sine)
            moved = refine_line(self._sides, line, tolerances, self._config)
            line = moved if self.near(moved, line, self._config.twins.slack) else line
        return scored_line(self._sides, line, self.centroid, self._config)

    def near(self, one: Line, other: Line, slack: float = 1.0) -> bool:
        """True if two lines are one at the contact, within `slack` times what keeps lines apart."""
        cosine = np.cos(np.radians(slack * self._config.apart_angle))
        offset = one.foot(self.centroid) - other.foot(self.centroid)
        close = float(np.linalg.norm(offset)) < slack * self._config.apart
        return bool(abs(float(one.axis @ other.axis)) > cosine and close)


def _voted(voter: _Voter, twins: Sequence[_Twin], config: BearingConfig) -> EdgeBearing:
    """The lines of a contact and of its twins, each with the mean of what all of them say of it."""
    own = voter.bearing
    lines = [_carried(line, twin.motion.inverse, voter.centroid) for twin in twins for line in twin.voter.bearing.lines]
    candidates = best_distinct([*own.lines, *lines], config.model_copy(update={"keep": 2 * config.keep}))
    mine = [voter.opinion(candidate.line) for candidate in candidates]
    ranked = best_distinct([_mean(line, [_opinion(twin, line.line) for twin in twins]) for line in mine], config)
    if not ranked:
        return own
    followed = not own.lines or not voter.near(ranked[0].line, own.lines[0].line)
    follows = tuple(twin.pair for twin in twins) if followed else ()
    return replace(own, lines=tuple(ranked), follows=follows)


def _carried(line: BearingLine, motion: RigidMotion, centroid: FloatArray) -> BearingLine:
    moved = Line(axis=motion.directions(line.axis), point=motion.points(line.pivot))
    return replace(line, axis=moved.axis, pivot=moved.foot(centroid))


def _opinion(twin: _Twin, line: Line) -> BearingLine:
    there = Line(axis=twin.motion.directions(line.axis), point=twin.motion.points(line.point))
    said = twin.voter.opinion(there)
    return said.exchanged if twin.swapped else said


def _mean(mine: BearingLine, others: Sequence[BearingLine]) -> BearingLine:
    everyone = [mine, *others]
    score = float(np.mean([line.score for line in everyone]))
    surfaces, rings = np.mean([(line.surfaces, line.rings) for line in everyone], axis=0).tolist()
    return replace(mine, score=score, surfaces=tuple(surfaces), rings=tuple(rings))
