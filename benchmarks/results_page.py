"""`python -m benchmarks.results_page`: figures and dates of the reports in README.md and docs/results.md."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.fit.corpora import may_be_fitted_to
from benchmarks.tables import motion_rates
from kinematify.errors import InputError
from kinematify.evaluation.datasets import find_objects
from kinematify.evaluation.result_record import load_report, number, replace_text, table
from kinematify.evaluation.run_benchmark import RESULTS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.evaluation.benchmark_job import JobResult

_DATED = re.compile(r"^- date: ([\d-]+), commit (\w+)", flags=re.MULTILINE)
_LINK = re.compile(r"\]\(\.\./(results/\w+\.md)\)")
_FIGURES = ("objects", "joints", "type (M) [%]", "and axis (MA) [%]", "and origin (MAO) [%]", "macro M / MA / MAO [%]")


@dataclass(frozen=True, kw_only=True)
class _Row:
    """A row of the README's figures: a report, and which of its objects."""

    title: str
    report: str
    fitted: bool | None = None
    """Of a set that is fitted to in part: the objects that were, or those that were not; None takes all."""


_ROWS = (
    _Row(title="held-out, never chosen by: 63 of PartNet-Mobility (kitchen)", report="kitchen"),
    _Row(title="held-out, never chosen by: 54 of another maker (kinart)", report="kinart"),
    _Row(title="not fitted to, but looked at as measurements went: 23 for research", report="everyday2", fitted=False),
    _Row(title="not fitted to, but seen while measurements were designed: 48 of PartNet-Mobility", report="everyday"),
    _Row(title="held-out, weights until 2026-11-28: 231 objects of a generator (Infinigen)", report="infinigen"),
    _Row(
        title="held-out, weights until 2026-11-28: 32 objects that language models programmed (Articraft)",
        report="articraft",
    ),
    _Row(title="in-sample: 43 objects of various authors", report="everyday2", fitted=True),
    _Row(title="in-sample: the six robots of the paper", report="robots"),
)


def write_results_page(root: Path) -> None:
    """Write the figures of reports whose JSON is there into `README.md`, dates and commits into `docs/results.md`.

    Args:
        root: Folder of the checkout.

    Raises:
        InputError: A report, a mark or the benchmark data is missing, or a linked table does not say when it was made.
    """
    results = root / "results"
    readme = root / "README.md"
    _replace(readme, "figures", _figures(results, _between(readme, "figures")[1]))
    page = root / "docs" / "results.md"
    _replace(page, "tables", dated(_between(page, "tables")[1], root))


def dated(rows: str, root: Path) -> str:
    """Fill the columns date and commit of the rows of a table from the tables that they link.

    Args:
        rows: Markdown rows ``| question | links | date | commit |``, the first two of them heading and rule.
        root: Folder of the checkout.

    Raises:
        InputError: A linked table is missing or does not say when it was made.
    """
    head, rule, *body = rows.strip().splitlines()
    filled = []
    for row in body:
        question, links = row.strip("| ").split(" | ")[:2]
        made = [_made(root / path) for path in _LINK.findall(links)]
        filled.append(f"| {question} | {links} | {_joined(made, 0)} | {_joined(made, 1)} |")
    return "\n".join([head, rule, *filled])


def _joined(made: Sequence[tuple[str, str]], column: int) -> str:
    return ", ".join(dict.fromkeys(one[column] for one in made))


def _made(report: Path) -> tuple[str, str]:
    """Date and commit at the top of a table."""
    found = _DATED.search(report.read_text(encoding="utf-8")) if report.is_file() else None
    if found is None:
        raise InputError(
            f"{report} does not say when it was made: it is missing, or has no line `- date: ..., commit ...`. "
            "Make it again with its command, or remove its row."
        )
    return found[1], found[2]


def _figures(results: Path, before: str) -> str:
    """The table anew; a row whose report is not there (large JSON is not kept) stays as it was."""
    old = {cells[0]: cells for line in before.splitlines() if (cells := tuple(line.strip("| ").split(" | ")))}
    rows = []
    for row in _ROWS:
        path = results / f"{row.report}.json"
        if not path.is_file() and row.title in old:
            rows.append(old[row.title])
            continue
        report = load_report(path, RESULTS)
        chosen = [run for run in report.records if row.fitted is None or run.object in _fitted(row)]
        rows.append((row.title, *_cells(chosen)))
    return table(("", *_FIGURES), rows)


def _fitted(row: _Row) -> set[str]:
    """Names of the objects of a set whose licence lets them be fitted to, or the others."""
    facts = {item.name: item.urdf.with_name("source.json") for item in find_objects(row.report)}
    return {name for name, path in facts.items() if may_be_fitted_to(json.loads(path.read_text())) == row.fitted}


def _cells(runs: Sequence[JobResult]) -> tuple[str, ...]:
    micro, macro = motion_rates(runs), motion_rates(runs, macro=True)
    if micro is None or macro is None:
        raise InputError("A report of the README's figures has no joints. Make it again with its command.")
    scores = {run.object: run.score for run in runs if run.score is not None}
    return (
        str(len(scores)),
        str(sum(len(score.joints) for score in scores.values())),
        *(number(share, 1, 100.0) for share in micro),
        " / ".join(number(mean, 1, 100.0) for mean in macro),
    )


def _between(page: Path, mark: str) -> tuple[str, str, str]:
    begin, end = f"<!-- {mark}:begin -->", f"<!-- {mark}:end -->"
    try:
        before, rest = page.read_text(encoding="utf-8").split(begin)
        inside, after = rest.split(end)
    except (OSError, ValueError) as error:
        raise InputError(
            f"{page} cannot be filled: {error}. Call the command in a checkout; the page must hold the marks {begin} "
            f"and {end} once."
        ) from error
    return before + begin, inside, end + after


def _replace(page: Path, mark: str, text: str) -> None:
    before, _, after = _between(page, mark)
    replace_text(page, f"{before}\n{text}\n{after}")


if __name__ == "__main__":
    write_results_page(Path())
