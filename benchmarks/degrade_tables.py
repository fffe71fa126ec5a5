"""Tables of a benchmark with degraded meshes: every kind of fault beside the clean input."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.evaluation.job import CLEAN
from kinematify.evaluation.metrics import CLOSE_ANGLE
from kinematify.evaluation.record import grouped, number, table
from kinematify.evaluation.summary import summarise

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.evaluation.job import JobResult
    from kinematify.evaluation.metrics import JointScore

KINDS = {
    CLEAN: "meshes as they are",
    "voxels-300": "remeshed on a grid of 1/300 of the diagonal; open or thin parts become walls of 1.5 cells",
    "voxels-150": "the same, 1/150",
    "vertex-noise": "every vertex moved, standard deviation 0.05 % of the diagonal",
    "faces-1000": "decimated to 1,000 faces a part",
    "faces-300": "decimated to 300 faces a part",
    "hulls": "every part its convex hull",
    "holes": "5 % of the faces dropped",
    "flipped": "every second face inside out, at random",
    "gaps": "parts shrunk, so that gaps of 1 % of the diagonal open",
    "interpenetration": "parts grown by 0.5 % of the diagonal on each side, so that they stand in each other",
    "open": "no surface where a part lies on another one (up to half of its area)",
    "cut-2": "one part cut in two by a plane",
    "cut-3": "one part cut in three",
}
"""Kind of input -> what was done, for readers."""
NOT_MEANT = (CLEAN, "hulls")
"""Not in the mean: hulls have no bearings left."""

_COLUMNS = (
    ("angle [deg]", "angle_deg", 1.0, 2),
    ("matched", "angle_matched_deg", 1.0, 2),
    ("line [% of diagonal]", "line_percent", 1.0, 2),
    ("TED", "ted", 1.0, 2),
    ("root", "root", 1.0, 2),
    ("types [%]", "types", 100.0, 1),
    ("opens [%]", "opens", 100.0, 0),
    ("limits", "limit_iou", 1.0, 2),
    ("time [s]", "seconds", 1.0, 1),
)
_TITLES = [title for title, *_ in _COLUMNS]


def degraded(results: Iterable[JobResult]) -> bool:
    """Whether some of the meshes were degraded."""
    return any(result.input != CLEAN for result in results)


def degradation_sections(results: Sequence[JobResult]) -> list[list[str]]:
    """One table of all faults per kind of object, then one per fault with every object, and the wrong joints."""
    sections = []
    for kind, own in grouped(results, by=lambda result: result.kind).items():
        groups = grouped(own, by=lambda result: result.input)
        sections.append(_overview(kind, groups))
        sections += [_objects(kind, given, group) for given, group in groups.items()]
    return sections


def _overview(kind: str, groups: Mapping[str, Sequence[JobResult]]) -> list[str]:
    titles = ["input", "what was done", *_TITLES, f"within {CLOSE_ANGLE:.0f} deg [%]", "cuts fixed", "no answer"]
    rows = [[given, KINDS.get(given, ""), *_numbers(group), *_counts(group)] for given, group in groups.items()]
    meant = [given for given in groups if given not in NOT_MEANT]
    if len(meant) > 1:
        means = [_mean_of_groups([groups[given] for given in meant], metric) for _, metric, *_ in _COLUMNS]
        cells = [number(value, digits, scale) for value, (_, _, scale, digits) in zip(means, _COLUMNS, strict=True)]
        joined = [result for given in meant for result in groups[given]]
        rows.append(["**mean, hulls left out**", "", *cells, *_counts(joined)])
    return [f"### {kind}: every kind of input", table(titles, rows)]


def _objects(kind: str, given: str, results: Sequence[JobResult]) -> list[str]:
    groups = grouped(results, by=lambda result: result.object)
    rows = [
        [name, *_numbers(group), _cuts(group), "; ".join(sorted({fault for run in group for fault in _faults(run)}))]
        for name, group in groups.items()
    ]
    return [f"### {kind}: {given}", table(["object", *_TITLES, "cuts fixed", "wrong"], rows)]


def _numbers(results: Sequence[JobResult]) -> list[str]:
    values = summarise(results).values
    return [number(values.get(metric), digits, scale) for _, metric, scale, digits in _COLUMNS]


def _mean_of_groups(groups: Sequence[Sequence[JobResult]], metric: str) -> float | None:
    values = [value for group in groups if (value := summarise(group).values.get(metric)) is not None]
    return sum(values) / len(values) if values else None


def _counts(results: Sequence[JobResult]) -> list[str]:
    joints = [joint for result in results if result.score is not None for joint in result.score.joints]
    close = sum(joint.angle_deg <= CLOSE_ANGLE for joint in joints) / max(len(joints), 1)
    return [f"{100 * close:.1f}", _cuts(results), str(sum(result.status != "ok" for result in results))]


def _cuts(results: Sequence[JobResult]) -> str:
    cuts = sum(result.cuts for result in results)
    return f"{sum(result.cuts_mended for result in results)} of {cuts}" if cuts else "-"


def _faults(result: JobResult) -> list[str]:
    if result.status != "ok":
        return [f"{result.status}: {result.message}"]
    return [fault for joint in result.score.joints if (fault := _fault(joint))] if result.score is not None else []


def _fault(joint: JointScore) -> str:
    if not joint.matched:
        return f"{joint.joint} not in the tree"
    if not joint.type_right:
        return f"{joint.joint} called {joint.predicted_kind}"
    return f"{joint.joint} axis" if joint.angle_deg > CLOSE_ANGLE else ""
