"""KV604: do the engines and the exact geometry see the same pairs of links in contact?"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.simulation.engines import ENGINES
from kinematify.validation.check import CauseScope, check
from kinematify.validation.checks.follow import IN_ENGINES
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.configurations import EnginePoses
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.engine_results import EngineResults

_TOLD_PAIRS = 10
"""The deepest so many disagreements are findings, all of them are counted."""


@dataclass(frozen=True, kw_only=True)
class _Overlap:
    links: tuple[int, int]
    depth: float
    """[m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _View:
    """Contacts that one engine, or the exact geometry, sees."""

    engine: str | None
    title: str
    overlaps: dict[tuple[int, int, int], _Overlap]
    """Deepest overlap, keyed by row, body, body: engines differ in which of two welded links they name."""


@dataclass(frozen=True, kw_only=True)
class _Disagreement:
    sees: _View
    misses: _View
    row: int
    overlap: _Overlap


@check(
    "KV604",
    title="Engines see the same collisions",
    fails="An engine sees a collision that the exact geometry does not have",
    severity=Severity.WARNING,
    cause=Cause.PHYSICS,
    follows={**IN_ENGINES, "KV802": CauseScope.PAIR},
    prepared=True,
)
def contacts_differ(result: OpenCheck, left: EngineResults) -> None:
    """Pairs of links that overlap in one engine by more than agreement.contact_depth and do not touch in the other,
    and either against the exact geometry, in the same configurations.

    Why it matters: A motion that is free in one engine is blocked in the other: margins, hulls or lost shapes
    differ.

    Remedy: Give the two links collision geometry of boxes, cylinders, spheres or convex meshes.
    """
    # of every pair of bodies the deepest overlap that one source sees and another has no contact for
    engines = [engine for engine in left.chosen if ENGINES[engine].runs]
    if len(engines) + (left.exact is not None) < 2:
        result.skip("fewer than two sources of contacts were asked for")
        return
    views = [
        view for engine in engines if engine in left.engines for view in _views(left, left.engines[engine], engine)
    ]
    exact = [] if left.exact is None else _views(left, left.exact, None)
    none = np.zeros(len(left.rows.links))
    # convex pieces of links reach so far beyond the surface [m], which the exact geometry does not
    reach = np.array([left.prepared.link_by_name[name].gap for name in left.rows.links]) if exact and views else none
    found = [item for sees, misses in permutations(views, 2) for item in _unseen(left, sees, misses, none)]
    for true in exact:
        for view in views:
            found += _unseen(left, view, true, reach) + _unseen(left, true, view, none)
    worst: dict[tuple[int, int], _Disagreement] = {}
    for item in sorted(found, key=lambda item: -item.overlap.depth):
        first, second = sorted(left.body[list(item.overlap.links)].tolist())
        worst.setdefault((first, second), item)
    result.measured["pairs"] = float(len(worst))
    if left.exact is None:
        result.reason = "only the engines were compared with each other: the geometry stage left no contacts"
    for item in list(worst.values())[:_TOLD_PAIRS]:
        _tell(result, left, item)
    left.say_absent(result, engines, [view.engine for view in views if view.engine])


def _views(left: EngineResults, poses: EnginePoses, engine: str | None) -> list[_View]:
    """The contacts that a source left; none if it left none."""
    if poses.contacts is None or poses.contact_depth is None:
        return []
    bodies = np.sort(left.body[poses.contacts[:, 1:]], axis=1)
    overlaps: dict[tuple[int, int, int], _Overlap] = {}
    for index in np.argsort(poses.contact_depth).tolist():  # the deepest comes last and stays
        row, first, second = poses.contacts[index].tolist()
        overlap = _Overlap(links=(first, second), depth=float(poses.contact_depth[index]))
        overlaps[row, int(bodies[index, 0]), int(bodies[index, 1])] = overlap
    title = "the exact geometry" if engine is None else ENGINES[engine].title
    return [_View(engine=engine, title=title, overlaps=overlaps)]


def _unseen(left: EngineResults, sees: _View, misses: _View, slack: FloatArray) -> list[_Disagreement]:
    """Overlaps deeper than the limit, and the slack of both links, that the other does not see at all."""
    limit = _limit(left)
    return [
        _Disagreement(sees=sees, misses=misses, row=key[0], overlap=overlap)
        for key, overlap in sees.overlaps.items()
        if key not in misses.overlaps and overlap.depth > limit + float(slack[list(overlap.links)].sum())
    ]


def _limit(left: EngineResults) -> float:
    return max(left.settings.contact_depth, left.settings.contact_share * left.size)


def _tell(result: OpenCheck, left: EngineResults, item: _Disagreement) -> None:
    first, second = (left.rows.links[index] for index in item.overlap.links)
    depth = item.overlap.depth
    result.find(
        f"In {item.sees.title}, {first} and {second} are {depth * 1e3:.1f} mm deep in each other, without any "
        f"contact between them in {item.misses.title}.",
        "Give both links collision geometry of boxes, cylinders, spheres or convex meshes, which every engine treats "
        "alike.",
        pair=(first, second),
        engine=item.sees.engine or item.misses.engine,
        q=left.rows.named(item.row),
        value=depth,
        limit=_limit(left),
        unit="m",
    )
