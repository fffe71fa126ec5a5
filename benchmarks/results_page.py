"""The page of results, written from the reports of a folder."""

from __future__ import annotations

from typing import TYPE_CHECKING

from benchmarks.paper import ABLATION, TABLE_I, PaperRow, mean_over_robots
from benchmarks.studies.refine import sentence
from benchmarks.study import load_study_report
from kinematify.errors import InputError
from kinematify.evaluation.record import load_report, number, replace_text, table
from kinematify.evaluation.run import RESULTS
from kinematify.evaluation.summary import CLOSE_ANGLE, condition_group, median_seconds, summarise

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.evaluation.job import JobResult

_TITLES = (
    "", "joints", "axis angle [deg]", "axis line [mm]", "tree edits (TED)", "types right", "time [s]",
    "paper: angle, TED",
)  # fmt: skip


def write_results_page(page: Path, results: Path) -> None:
    """Replace what stands between the marks ``results`` and ``refine``.

    Args:
        page: The file.
        results: Folder with the reports robots, everyday, ablation_robots, ablation_everyday and refine.

    Raises:
        InputError: A report or a mark is missing.
    """
    try:
        text = page.read_text(encoding="utf-8")
        for mark, blocks in (("results", _accuracy(results)), ("refine", _refinement(results))):
            begin, end = f"<!-- {mark}:begin -->", f"<!-- {mark}:end -->"
            before, after = text[: text.index(begin)], text[text.index(end) :]
            text = f"{before}{begin}\n" + "\n\n".join(blocks) + f"\n{after}"
    except (OSError, ValueError) as error:
        raise InputError(
            f"The results cannot be put into {page}: {error}. Call the command in a checkout; the page must hold "
            "the marks results:begin, results:end, refine:begin and refine:end."
        ) from error
    replace_text(page, text)


def _accuracy(results: Path) -> list[str]:
    robots, everyday = (load_report(results / f"{name}.json", RESULTS) for name in ("robots", "everyday"))
    ablation = [load_report(results / f"ablation_{name}.json", RESULTS) for name in ("robots", "everyday")]
    names = sorted({run.object for run in robots.records})
    of = {name: [run for run in robots.records if run.object == name] for name in names}
    count = len({run.object for run in everyday.records})
    rows = [
        *(_row(TABLE_I[name].label, of[name], TABLE_I[name]) for name in names),
        _row("**six robots**", robots.records, mean_over_robots()),
        _row(f"**{count} everyday objects**", everyday.records, TABLE_I["everyday"]),
    ]
    return [
        table(_TITLES, rows),
        (
            "Means over the poses rest, three random ones and one turned by 37 deg, from parts without names, by\n"
            "geometry alone. The paper's everyday objects are others. A joint between the wrong parts counts 90 deg."
        ),
        _by_condition("Robots", robots.records) + "\n" + _by_condition("Everyday objects", everyday.records),
        _faults(robots.records) + "\n" + _faults(everyday.records),
        _ablation([run for report in ablation for run in report.records]),
        (
            f"Made by `{robots.header.command}` and `{everyday.header.command}` at commit {robots.header.commit},\n"
            "written here by `kinematify bench --results-page`."
        ),
    ]


def _row(name: str, runs: Sequence[JobResult], paper: PaperRow) -> tuple[str, ...]:
    values = summarise(runs).values
    return (
        name,
        number(values["joints"], 0),
        number(values["angle_deg"], 2),
        number(values["line_m"], 1, 1e3),
        number(values["ted"], 2),
        f"{number(values['types'], 0, 100.0)} %",
        number(median_seconds(runs), 1),
        f"{paper.angle_deg:.2f}, {paper.ted:.2f}",
    )


def _by_condition(title: str, runs: Sequence[JobResult]) -> str:
    parts = []
    for group in dict.fromkeys(condition_group(run.condition) for run in runs):
        values = summarise([run for run in runs if condition_group(run.condition) == group]).values
        angle, ted, types = number(values["angle_deg"], 2), number(values["ted"], 2), number(values["types"], 0, 100.0)
        parts.append(f"{group} {angle} deg, TED {ted}, types {types} %")
    return f"{title} by condition: {'; '.join(parts)}."


def _faults(runs: Sequence[JobResult]) -> str:
    wrong: dict[str, set[str]] = {}
    for run in runs:
        for joint in run.score.joints if run.score is not None else ():
            if joint.angle_deg > CLOSE_ANGLE or not joint.type_right:
                wrong.setdefault(run.object, set()).add(joint.joint)
    named = ", ".join(f"{name} ({len(joints)})" for name, joints in sorted(wrong.items()))
    return f"Objects with a joint that is wrong in at least one run (joints): {named or 'none'}."


def _ablation(runs: Sequence[JobResult]) -> str:
    """The paper's method as we built it (`--config paper`) beside the numbers that the paper gives."""
    rows = []
    for variant, theirs in ABLATION.items():
        cells = []
        for name in ("everyday", "fetch", "panda"):
            values = summarise([r for r in runs if r.variant == variant and name in (r.object, r.kind)]).values
            angle, _, ted = theirs[name]
            ours = f"{number(values['angle_deg'], 1)}, {number(values['ted'], 2)}"
            cells.append(f"{ours} (paper: {angle:.1f}, {ted:.2f})")
        rows.append((variant, *cells))
    return table(("`--config paper`, at rest: angle [deg], TED", "everyday", "Fetch", "Panda"), rows)


def _refinement(results: Path) -> list[str]:
    return [sentence(load_study_report(results, "refine"))]
