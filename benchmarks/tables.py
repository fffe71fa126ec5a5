"""Benchmark results as Markdown, the paper's numbers beside ours, every wrong joint named."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from statistics import fmean, median
from typing import TYPE_CHECKING

from benchmarks.paper import ABLATION, TABLE_I, PaperRow, mean_over_robots
from kinematify.evaluation.benchmark_job import CLEAN
from kinematify.evaluation.benchmark_summary import Summary, summarise, summarise_types
from kinematify.evaluation.metrics import CLOSE_ANGLE
from kinematify.evaluation.result_record import grouped, number, table

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.metrics import JointScore
    from kinematify.evaluation.result_record import Report

CLOSE_LINE = 0.05
"""An axis line counts as found within this share of the object's diagonal."""
READING = """\
Every number is the mean over an object's joints, then over its conditions, then over objects. A joint whose
parent-child pair is not in the predicted tree counts 90 deg (`matched` leaves those out), a wrong type and a limit
overlap of 0; a run without an answer counts as if nothing had been predicted. `given type`: the best kept candidate of
the true type. Line: distance between the axis lines at the child part, turning joints only. Pivot: distance between the
pivots, as in the paper; along the axis it only tells where the source put its origin. Types: continuous counts as
revolute; strict: not. Limits: overlap of the ranges. Opens: the positive direction is the one in which a one-sided
joint opens. TED: rooted, unordered, unit costs, a node's label is the identity of its part; `no labels` compares shapes
alone. Parents: parts with a wrong parent, the root included. Two joints in series through a link without geometry
stand between the same two parts: one of them is always missing from a tree over the parts. Chance level of the
axis angle: 57.3 deg. Time and memory are those of one worker process with one thread."""


@dataclass(frozen=True, kw_only=True)
class Column:
    """How a metric is printed."""

    title: str
    metric: str
    digits: int
    scale: float = 1.0
    paper: str = ""
    """Field of `PaperRow` printed before our number, if any."""


COLUMNS = (
    Column(title="angle [deg] paper / ours", metric="angle_deg", digits=2, paper="angle_deg"),
    Column(title="matched", metric="angle_matched_deg", digits=2),
    Column(title="given type", metric="angle_given_type_deg", digits=2),
    Column(title="line [mm]", metric="line_m", digits=2, scale=1000.0),
    Column(title="line [% of diagonal]", metric="line_percent", digits=3),
    Column(title="pivot [m] paper / ours", metric="pivot_m", digits=3, paper="position_m"),
    Column(title="TED paper / ours", metric="ted", digits=2, paper="ted"),
    Column(title="no labels", metric="ted_unlabelled", digits=2),
    Column(title="parents", metric="parent_errors", digits=2),
    Column(title="root", metric="root", digits=2),
    Column(title="types [%]", metric="types", digits=1, scale=100.0),
    Column(title="strict [%]", metric="types_strict", digits=1, scale=100.0),
    Column(title="limits", metric="limit_iou", digits=2),
    Column(title="opens [%]", metric="opens", digits=0, scale=100.0),
    Column(title="time [s]", metric="seconds", digits=1),
    Column(title="peak [MB]", metric="peak_mb", digits=0),
)


def motion_rates(results: Iterable[JobResult], *, macro: bool = False) -> list[float] | None:
    """Shares of joints whose motion is right: M, MA and MAO of S2O, over the joints of a true tree; None without any.

    Over all joints (micro), or the mean of the shares of each category (macro). MA: type right and axis within
    `CLOSE_ANGLE`; MAO: and, of turning joints, the axis line within `kinematify.evaluation.metrics.CLOSE_ORIGIN`. A
    joint counts once for each run of its object. Parent and child must be right too: a joint between the wrong parts
    has no type.
    """
    joints = [(result.category, joint) for result in results if result.score for joint in result.score.joints]
    groups = grouped(joints, by=lambda pair: pair[0] if macro else "").values()
    if not joints:
        return None
    return [
        fmean(fmean(getattr(joint, key) for _, joint in group) for group in groups)
        for key in ("type_right", "axis_right", "origin_right")
    ]


def is_right(joint: JointScore, diagonal: float) -> bool:
    """Whether parent, type and axis are right.

    Args:
        joint: Against the truth.
        diagonal: Of the object [m].
    """
    close = joint.angle_deg <= CLOSE_ANGLE and (joint.line_m is None or joint.line_m <= CLOSE_LINE * diagonal)
    return joint.matched and joint.type_right and close


def median_seconds(results: Iterable[JobResult]) -> float | None:
    """Return the median over objects of the mean inference time [s], None without results."""
    objects = grouped(results, by=lambda result: result.object).values()
    return median(fmean(run.seconds for run in runs) for runs in objects) if objects else None


def condition_group(name: str) -> str:
    """Return the column that a condition belongs to: seeds of the random configuration share one."""
    return "random" if name.startswith("random") else name


def benchmark_blocks(report: Report[JobResult], baseline: Report[JobResult] | None = None) -> list[str]:
    """Return the tables of a report as blocks of Markdown.

    Args:
        report: What a run gave.
        baseline: An earlier report to compare with.
    """
    sections = [[READING]]
    variants = grouped(report.records, by=lambda result: result.variant)
    for variant, results in variants.items():
        sections.append([f"## Configuration: {variant}"])
        degraded = any(result.input != CLEAN for result in results)
        sections += _degradation_sections(results) if degraded else _variant_sections(results)
    if len(variants) > 1:
        sections.append(_ablation(variants))
    if baseline is not None:
        sections.append(comparison(report, baseline))
    sections.append(_failures(report.records))
    return ["\n\n".join(blocks) for blocks in sections if blocks]


def _variant_sections(results: Sequence[JobResult]) -> list[list[str]]:
    kinds = _by_kind(results)
    sections = []
    if robots := kinds.get("robot"):
        sections += [_robot_table(robots), _without_gripper(robots)]
    if everyday := kinds.get("everyday"):
        mean = _row("**mean**", everyday, paper=TABLE_I["everyday"])
        sections += [
            ["### Everyday objects", table(["", "joints", *(column.title for column in COLUMNS)], [mean])],
            _category_table(everyday),
            _object_table("Everyday objects, each", everyday),
        ]
    if generated := kinds.get("procedural"):
        sections.append(_family_table(generated))
    if other := [result for result in results if result.kind not in ("robot", "everyday", "procedural")]:
        sections.append(_object_table("Other objects, each", other))
    return [
        *sections,
        _motion_table(results),
        _condition_table(results),
        _type_table(results),
        _stage_table(results),
        _joint_errors(results),
    ]


def _degradation_sections(results: Sequence[JobResult]) -> list[list[str]]:
    """Every kind of input beside the clean one, then each with all objects, and the wrong joints."""
    groups = grouped(results, by=lambda result: f"{result.kind}, {result.input}")
    rows = [[*_row(name, group), _cuts_fixed(group)] for name, group in groups.items()]
    overview = ["### Kinds of input", table(["input", "joints", *_plain_titles(), "cuts fixed"], rows)]
    singly = [[_object_table(name, group), _joint_errors(group)] for name, group in groups.items()]
    return [overview, *(section for sections in singly for section in sections)]


def _cuts_fixed(results: Iterable[JobResult]) -> str:
    fixed, cuts = (sum(counts) for counts in zip(*((run.cuts_mended, run.cuts) for run in results), strict=True))
    return f"{fixed} of {cuts}" if cuts else "-"


def _motion_table(results: Sequence[JobResult]) -> list[str]:
    """Shares that other methods publish (S2O: M, MA, MAO)."""
    rows = [
        (
            name,
            *(number(value, 1, 100.0) for value in rates),
        )
        for name, macro in (("micro: all joints", False), ("macro: mean over categories", True))
        if (rates := motion_rates(results, macro=macro)) is not None
    ]
    titles = ("", "type (M) [%]", f"and axis within {CLOSE_ANGLE:g} deg (MA)", "and origin (MAO)")
    note = (
        "Origin: axis line within 0.1 of the moving part's diagonal; slides have none. A wrong parent counts as wrong."
    )
    return ["### Motion, as S2O counts it", table(titles, rows), note]


def _robot_table(results: Sequence[JobResult]) -> list[str]:
    rows = [_row(name, group, paper=TABLE_I.get(name)) for name, group in _by_object(results).items()]
    of_paper = [result for result in results if result.object in TABLE_I]
    if of_paper:
        six = len(_by_object(of_paper)) == len(TABLE_I) - 1
        rows.append(_row("**mean, robots of the paper**", of_paper, paper=mean_over_robots() if six else None))
    if len(of_paper) < len(results):
        rows.append(_row("**mean, all robots**", results))
    return ["### Robots", table(["object", "joints", *(column.title for column in COLUMNS)], rows)]


def _without_gripper(results: Sequence[JobResult]) -> list[str]:
    """Robots whose fingers the paper does not count, once more without them."""
    fingered = {
        result.object
        for result in results
        if result.score is not None and any(joint.gripper for joint in result.score.joints)
    }
    if not fingered:
        return []
    columns = [column for column in COLUMNS if column.metric not in ("ted_unlabelled", "parent_errors", "root")]
    groups = {name: group for name, group in _by_object(results).items() if name in fingered}
    rows = [
        _row(name, group, paper=TABLE_I.get(name), columns=columns, with_gripper=False)
        for name, group in groups.items()
    ]
    note = "The paper's 13 joints of Fetch count its two fingers as one; both are left out here."
    return [
        "### Robots without gripper fingers",
        table(["object", "joints", *(column.title for column in columns)], rows),
        note,
    ]


def _category_table(results: Sequence[JobResult]) -> list[str]:
    groups = grouped(results, by=lambda result: result.category)
    rows = [_row(category, group) for category, group in sorted(groups.items())]
    return ["### Everyday objects by category", table(["category", "joints", *_plain_titles()], rows)]


def _family_table(results: Sequence[JobResult]) -> list[str]:
    """Generated objects by family: first those with the most wrong types, among them the largest axis angles."""
    groups = grouped(results, by=lambda result: result.category)

    def goodness(family: str) -> tuple[float, float, str]:
        values = summarise(groups[family]).values
        return values.get("types") or 0.0, -(values.get("angle_deg") or 0.0), family

    worst_first = sorted(groups, key=goodness)
    rows = [_row(family, groups[family]) for family in worst_first]
    rows.append(_row("**mean over objects**", results))
    return ["### Generated objects by family, worst first", table(["family", "joints", *_plain_titles()], rows)]


def _object_table(title: str, results: Sequence[JobResult]) -> list[str]:
    rows = [_row(name, group) for name, group in _by_object(results).items()]
    rows.append(_row("**mean**", results))
    return [f"### {title}", table(["object", "joints", *_plain_titles()], rows)]


def _plain_titles() -> list[str]:
    return [column.title.replace(" paper / ours", "") for column in COLUMNS]


def _condition_table(results: Sequence[JobResult]) -> list[str]:
    """Angle, TED, types and line per condition; random is the mean of its seeds."""
    conditions = list(grouped(results, by=lambda result: condition_group(result.condition)))
    metrics = (("angle [deg]", "angle_deg", 2, 1.0), ("line [mm]", "line_m", 2, 1000.0), ("TED", "ted", 2, 1.0))
    titles = ["object", *(f"{title} {condition}" for title, *_ in metrics for condition in conditions)]
    singly = [result for result in results if result.kind != "procedural"]  # of those there are hundreds
    means = {f"**mean, {kind}**": group for kind, group in _by_kind(results).items()}
    groups = {**_by_object(singly), **means}
    rows = []
    for name, group in groups.items():
        runs = grouped(group, by=lambda result: condition_group(result.condition))
        cells = {condition: summarise(runs.get(condition, [])) for condition in conditions}
        numbers = (
            number(cells[condition].values.get(metric), digits, scale)
            for _, metric, digits, scale in metrics
            for condition in conditions
        )
        rows.append([name, *numbers])
    return ["### By condition", table(titles, rows)]


def _type_table(results: Sequence[JobResult]) -> list[str]:
    """Joints by true type, each joint of each run counting once."""
    rows = [
        [
            f"{kind}, {summary.kind}",
            str(summary.joints),
            number(summary.types_right, 1, 100.0),
            number(summary.angle_deg, 2),
            number(summary.close, 1, 100.0),
            number(summary.angle_given_type_deg, 2),
            number(summary.close_given_type, 1, 100.0),
        ]
        for kind, group in _by_kind(results).items()
        for summary in summarise_types(group)
    ]
    close = f"within {CLOSE_ANGLE:.0f} deg [%]"
    titles = ["true type", "joints x runs", "types [%]", "angle [deg]", close]
    titles += ["angle given type", f"{close} given type"]
    return ["### By true joint type", table(titles, rows)]


def _stage_table(results: Sequence[JobResult]) -> list[str]:
    """Mean seconds of every stage per object, over runs with an answer, and the largest memory."""
    answered = [result for result in results if result.status == "ok"]
    stages = list(dict.fromkeys(stage for result in answered for stage in result.stage_seconds))
    rows = [
        [
            kind,
            *(number(fmean(run.stage_seconds.get(stage, 0.0) for run in runs), 2) for stage in stages),
            number(median_seconds(runs), 2),
            number(max(run.seconds for run in runs), 2),
            number(max(run.peak_mb or 0.0 for run in runs), 0),
        ]
        for kind, runs in _by_kind(answered).items()
    ]
    titles = ["objects", *stages, "whole, median", "whole, longest", "peak [MB]"]
    return ["### Time by stage [s]", table(titles, rows)]


def _joint_errors(results: Sequence[JobResult]) -> list[str]:
    """Every joint with a wrong parent, type or axis, worst first; conditions with the same fault share a line."""
    faults: dict[tuple[str, str, str], list[tuple[float, str, str]]] = defaultdict(list)
    for result in results:
        for joint in result.score.joints if result.score is not None else ():
            kind = _fault(joint)
            if kind:
                faults[result.object, joint.joint, kind].append((joint.angle_deg, result.condition, joint.kind))
    if not faults:
        return ["### Wrong joints", "None."]
    ordered = sorted(faults.items(), key=lambda entry: (-max(angle for angle, *_ in entry[1]), entry[0]))
    rows = [
        [item, joint, runs[0][2], kind, number(max(angle for angle, *_ in runs), 1), ", ".join(run[1] for run in runs)]
        for (item, joint, kind), runs in ordered
    ]
    titles = ["object", "joint", "true type", "fault", "angle [deg]", "conditions"]
    return ["### Wrong joints, worst first", table(titles, rows)]


def _fault(joint: JointScore) -> str:
    if not joint.matched:
        return "not in the tree"
    faults = [] if joint.type_right else [f"called {joint.predicted_kind}"]
    if joint.angle_deg > CLOSE_ANGLE:
        faults.append("axis")
    return ", ".join(faults)


def _ablation(variants: Mapping[str, Sequence[JobResult]]) -> list[str]:
    """All configurations side by side on what the paper's ablation shows."""
    rows = []
    for variant, results in variants.items():
        groups = {
            "everyday": [result for result in results if result.kind == "everyday"],
            "robots": [result for result in results if result.kind == "robot"],
            **{name: group for name, group in _by_object(results).items() if name in TABLE_I},
        }
        for name, group in groups.items():
            if group:
                rows.append([variant, name, *_ablation_cells(variant, name, summarise(group))])
    titles = ["configuration", "objects", "angle [deg] paper / ours", "pivot [m] paper / ours", "TED paper / ours"]
    return ["## Configurations beside the paper's ablation", table([*titles, "types [%]", "time [s]"], rows)]


def _ablation_cells(variant: str, name: str, summary: Summary) -> list[str]:
    paper = ABLATION.get(variant, {}).get(name)
    ours = [("angle_deg", 2), ("pivot_m", 3), ("ted", 2)]
    cells = [
        _beside(None if paper is None else paper[place], number(summary.values.get(metric), digits))
        for place, (metric, digits) in enumerate(ours)
    ]
    types, seconds = summary.values.get("types"), summary.values.get("seconds")
    return [*cells, number(types, 1, 100.0), number(seconds, 1)]


_COMPARED = (
    ("angle [deg]", "angle_deg", 1.0),
    ("line [mm]", "line_m", 1000.0),
    ("TED", "ted", 1.0),
    ("types [%]", "types", 100.0),
    ("time [s]", "seconds", 1.0),
)
"""Title, metric and scale of what is compared with an earlier report."""


def comparison(report: Report[JobResult], baseline: Report[JobResult]) -> list[str]:
    """Return a table of what has changed since an earlier report, object by object.

    Only runs that both reports hold are compared. Changes below a hundredth of the printed unit are omitted.
    """
    before = {(result.object, result.condition, result.variant): result for result in baseline.records}
    pairs = [
        (before[key], result)
        for result in report.records
        if (key := (result.object, result.condition, result.variant)) in before
    ]
    groups: dict[str, list[tuple[JobResult, JobResult]]] = defaultdict(list)
    for old, new in pairs:
        groups[f"{new.object}, {new.variant}"].append((old, new))
        groups[f"**mean, {new.kind}, {new.variant}**"].append((old, new))
    rows = []
    for name, group in groups.items():
        old_values, new_values = (summarise(pair[side] for pair in group).values for side in (0, 1))
        cells = [_change(old_values.get(metric), new_values.get(metric), scale) for _, metric, scale in _COMPARED]
        if any(cells[:-1]) or name.startswith("**"):
            rows.append([name, *cells])
    title = f"## Change since {baseline.header.date}, commit {baseline.header.commit}"
    return [title, f"{len(pairs)} runs in both.", table(["object", *(name for name, *_ in _COMPARED)], rows)]


def _change(old: float | None, new: float | None, scale: float) -> str:
    if old is None or new is None:
        return "" if old is new else f"{number(old, 2, scale)} -> {number(new, 2, scale)}"
    if abs(new - old) * scale < 0.01:
        return ""
    return f"{number(old, 2, scale)} -> {number(new, 2, scale)}"


def _failures(results: Sequence[JobResult]) -> list[str]:
    rows = [
        [result.object, result.condition, result.variant, result.status, result.message]
        for result in results
        if result.status != "ok"
    ]
    if not rows:
        return ["## Runs without an answer", "None."]
    titles = ["object", "condition", "configuration", "what", "message"]
    return ["## Runs without an answer", table(titles, rows)]


def _row(
    name: str,
    results: Sequence[JobResult],
    *,
    paper: PaperRow | None = None,
    columns: Iterable[Column] = COLUMNS,
    with_gripper: bool = True,
) -> list[str]:
    summary = summarise(results, with_gripper=with_gripper)
    cells = [_cell(column, summary.values, paper) for column in columns]
    return [name, number(summary.values.get("joints"), 0), *cells]


def _cell(column: Column, values: Mapping[str, float | None], paper: PaperRow | None) -> str:
    ours = number(values.get(column.metric), column.digits, column.scale)
    if column.metric == "types" and values.get("joints"):
        ours += f" ({values['types_right']:g}/{values['joints']:g})"
    if column.metric == "ted" and values.get("ted_exact", 1.0) != 1.0:
        # Where the search for the exact distance ended early, the value is an upper bound.
        ours = f"<= {ours}"
    return _beside(getattr(paper, column.paper), ours) if paper is not None and column.paper else ours


def _beside(paper: float | None, ours: str) -> str:
    return ours if paper is None else f"{paper:.2f} / {ours}"


def _by_object(results: Iterable[JobResult]) -> dict[str, list[JobResult]]:
    return grouped(results, by=lambda result: result.object)


def _by_kind(results: Iterable[JobResult]) -> dict[str, list[JobResult]]:
    return grouped(results, by=lambda result: result.kind)
