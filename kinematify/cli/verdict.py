"""Terminal output of `kinematify validate`: the verdict first, then what is wrong, the worst first."""

from __future__ import annotations

import os
import re
import shutil
import textwrap
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kinematify.cli.table import format_table
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.report_content import (
    block_of,
    blocks,
    family_table,
    joint_table,
    places,
    printable,
    reasons,
    summary_words,
    title,
    where,
)
from kinematify.validation.run.report import Unusable, contract_words, counted_words, severity_counts, status_counts

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kinematify.validation.finding import Finding, Suppression
    from kinematify.validation.formats.report_content import FindingBlock, Table
    from kinematify.validation.run.conclusion import FindingGroup
    from kinematify.validation.run.report import Outcome, ValidationReport

MANY = 3
"""From so many findings on that differ in names and numbers only, they are a table."""
_COLORS = {"pass": "green", "warn": "yellow", "fail": "red", "unusable": "red"}
_SEVERITY_COLORS = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.NOTE: "blue"}
_WIDEST = 120
_SCREEN = 20
"""Lines of a report that nobody has to scroll for."""
_LONGEST = 60
"""Lines of a report unless everything is asked for."""
_CALL = re.compile(r"(?:mujoco\.MjModel\.from_xml_path|p\.loadURDF)\([^()]*\)")
"""How plain code loads a file."""


def describe(outcome: Outcome, *, everything: bool = False) -> str:
    """One model: what is wrong and what to do, on a screen where that is possible, or everything that is known."""
    if isinstance(outcome, Unusable):
        return f"{_verdict(outcome)}\n{_wrapped(printable(outcome.message))}"
    return "\n\n".join(block for block in (_full if everything else _short)(outcome) if block)


def _full(report: ValidationReport) -> list[str]:
    """All findings with their places, numbers, consequences and code; families, joints, and what did not run."""
    return [
        _first_lines(report),
        _table(family_table(report)),
        _reasons(report, Status.SKIPPED, Status.BLOCKED),
        *(_long_text(block, report.model) for block in blocks(report.groups, together=MANY)),
        _table(joint_table(report)),
    ]


def _short(report: ValidationReport) -> list[str]:
    """Errors and warnings with their remedies.

    Where they fill more than a screen, warnings are a line each without remedies, and those of one check in several
    engines share it; so do errors where the report is too long still. What is beyond the longest report is counted.
    """
    groups = [item for item in report.groups if item.finding.suppressed is None]
    errors, warnings = ([t for t in groups if t.finding.severity is s] for s in (Severity.ERROR, Severity.WARNING))
    head = [_first_lines(report), _reasons(report, Status.BLOCKED)]
    foot = ["\n".join(text for text in (_notes(groups), _more(report)) if text)]
    model = report.model
    paragraphs = [_short_text(block, model) for block in blocks(errors, alike=False)]
    full = [*head, *paragraphs, *(_short_text(block, model) for block in blocks(warnings, alike=False)), *foot]
    if _height(full) <= _SCREEN:
        return full
    listed = blocks(warnings, alike=False, by_engine=False)
    if _height([*head, *paragraphs, *(_line(block, model) for block in listed), *foot]) > _LONGEST:
        paragraphs, listed = [], [*blocks(errors, alike=False, by_engine=False), *listed]
    lines = [_line(block, model, 0) for block in listed]
    shown = len(lines)
    while shown and _height([*head, *paragraphs, "\n".join(lines[:shown]), *foot]) > _LONGEST - 2:
        shown -= 1
    left = sum(len(block.findings) for block in listed[shown:])
    lines[shown:] = [f"{counted_words(left, 'more finding')}: --all lists them."] if left else []
    return [*head, *paragraphs, "\n".join(lines), *foot]


def _height(blocks: Sequence[str]) -> int:
    """Lines of blocks with an empty one between any two."""
    return sum(block.count("\n") + 2 for block in blocks if block)


def _notes(groups: Sequence[FindingGroup]) -> str:
    """Return how many notes there are, by check."""
    counts = Counter(item.finding.check for item in groups if item.finding.severity is Severity.NOTE)
    listed = ", ".join(f"{check}{f' ({count})' if count > 1 else ''}" for check, count in sorted(counts.items()))
    return _wrapped(f"{counted_words(counts.total(), 'note')}: {listed}.") if counts else ""


def _more(report: ValidationReport) -> str:
    """Return what the whole report has besides."""
    findings = [item.finding for item in report.groups if item.finding.suppressed is None]
    worst = next((found.check for severity in Severity for found in findings if found.severity is severity), "KV301")
    return f"--all: notes, places, consequences, code, joints, checks. kinematify explain {worst}: what it checks."


def describe_table(outcomes: Sequence[Outcome]) -> str:
    """All models, a row each, and how many keep the contract, if that was asked for."""
    headings = ("model", "verdict", "errors", "warnings", "notes", "failed", "skipped", "blocked", "seconds")
    table = format_table(headings, [_summary_row(outcome) for outcome in outcomes])
    contract = contract_words([outcome.checks for outcome in outcomes if not isinstance(outcome, Unusable)])
    return "\n".join(filter(None, (table, contract)))


def describe_briefly(report: Outcome) -> str:
    """Every error of one model in full, the warnings by what they are about, a line each, and the verdict last."""
    if isinstance(report, Unusable):
        return describe(report)
    groups = [item for item in report.groups if item.finding.suppressed is None]
    errors = blocks((item for item in groups if item.finding.severity is Severity.ERROR), alike=False)
    warnings: dict[tuple[str, str | None], list[FindingGroup]] = {}
    for item in groups:
        if item.finding.severity is Severity.WARNING:
            warnings.setdefault((item.finding.check, item.finding.engine), []).append(item)
    lines = [*(_line(block, report.model) for block in errors)]
    lines += [f"  {_heading(block_of(group), report.model)}{_times(len(group))}" for group in warnings.values()]
    loaded = report.as_loaded or "as loaded: not known, see what did not run"
    lines += [_reasons(report, Status.BLOCKED), loaded, f"{_verdict(report)}: {summary_words(report)}"]
    return "\n".join(filter(None, lines))


def describe_unused(rules: Iterable[Suppression]) -> str:
    """Name the suppressions that covered nothing; empty if there are none."""
    names = [f"{rule.check} at {rule.where}" for rule in rules]
    if not names:
        return ""
    return _wrapped(f"Note: these suppressions cover no finding and can go: {', '.join(names)}.")


def _first_lines(report: ValidationReport) -> str:
    """The verdict, and what the file does as it is loaded."""
    return "\n".join(
        filter(
            None, (f"{_verdict(report)}: {summary_words(report)}", report.as_loaded, contract_words([report.checks]))
        )
    )


def _verdict(outcome: Outcome) -> str:
    return f"{click.style(outcome.verdict.upper(), fg=_COLORS[outcome.verdict], bold=True)}  {printable(outcome.model)}"


def _reasons(report: ValidationReport, *statuses: Status) -> str:
    return "\n".join(_wrapped(printable(reason), 2, 4) for reason in reasons(report, statuses))


def _short_text(block: FindingBlock, model: str) -> str:
    """Return what is wrong, where else, what to do, and what follows from it."""
    follows = f"{block.follows}." if block.follows else ""
    return _paragraphs(block, model, block.message, block.also, block.remedy, follows, _plain_call(block))


def _plain_call(block: FindingBlock) -> str:
    """The call of an engine that shows a finding or what follows from it; its code goes on with `--all`."""
    first = [item for item in block.consequences if item.follows_from is block.findings[0]]
    codes = [item.reproduction for item in (block.findings[0], *first) if item.reproduction is not None]
    call = _CALL.search(codes[0]) if codes else None
    return "" if call is None else f"To see it: {call.group()} and what --all prints."


def _paragraphs(block: FindingBlock, model: str, *words: str) -> str:
    count = len(block.findings)
    heading = _heading(block, model) + (f", {count} times" if count > 1 else "")
    return "\n".join([heading, *(_wrapped(printable(text), 2, 2) for text in words if text)])


def _long_text(block: FindingBlock, model: str) -> str:
    """Return what is wrong, what to do, what follows from it and the code that shows it; many places as a table."""
    many = len(block.findings) > 1
    example = f"For example: {block.message}" if many else block.message
    lines = [
        _paragraphs(block, model, "" if many else block.facts, example, block.remedy),
        *_consequences(block.consequences),
        *_code(block.code),
        *([_wrapped(printable(block.suppressed), 2, 2)] if block.suppressed else []),
        *([textwrap.indent(_table(places(block), "-"), "  ")] if many else []),
    ]
    return "\n".join(lines)


def _consequences(findings: Sequence[Finding]) -> list[str]:
    """Return what follows from a finding, a paragraph each, with the code that shows the first in an engine."""
    if not findings:
        return []
    lines = [_wrapped(f"{title(item)}: {printable(item.message)}", 4, 6) for item in findings]
    shown = next((item.reproduction for item in findings if item.reproduction is not None), "")
    return ["  Follows from it:", *lines, *_code(shown)]


def _heading(block: FindingBlock, model: str) -> str:
    """File and line, as compilers name them, with severity, check and cause."""
    line, path = block.findings[0].line, Path(model)
    near = not path.is_absolute() or path.is_relative_to(Path.cwd())
    place = printable(os.path.relpath(path) if near else path.name) + (f":{line}" if line else "")
    severity = click.style(block.severity.value, fg=_SEVERITY_COLORS[block.severity], bold=True)
    return f"{place}: {severity} {block.title} {block.cause}"


def _code(text: str) -> list[str]:
    """The code that shows it, as it can be copied: no line is broken."""
    return ["  To see it:", textwrap.indent(printable(text.rstrip("\n")), "    ")] if text else []


def _table(table: Table, empty: str = "") -> str:
    rows = [tuple(printable(cell) or empty for cell in row) for row in table.rows]
    return format_table(table.headings, rows) if rows else ""


def _line(block: FindingBlock, model: str, indent: int = 0) -> str:
    first = block.findings[0]
    names = {first.joint, first.link, *(first.pair or ())} - {None}
    about = "" if all(str(name) in first.message for name in names) else where(first)
    message = " ".join(text for text in (f"{about}: {block.message}" if about else block.message, block.also) if text)
    return _wrapped(f"{_heading(block, model)}{_times(len(block.findings))}: {printable(message)}", indent, indent + 2)


def _times(count: int) -> str:
    return f" ({count} times)" if count > 1 else ""


def _summary_row(outcome: Outcome) -> tuple[str, ...]:
    if isinstance(outcome, Unusable):
        return (printable(outcome.model), outcome.verdict, *([""] * 7))
    severities, statuses = severity_counts(outcome), status_counts(outcome)
    return (
        printable(outcome.model),
        outcome.verdict,
        *(str(severities.get(item, 0)) for item in Severity),
        *(str(statuses.get(item, 0)) for item in (Status.FAIL, Status.SKIPPED, Status.BLOCKED)),
        f"{float(outcome.environment.get('seconds', 0.0)):.1f}",
    )


def _wrapped(text: str, first: int = 0, rest: int = 0) -> str:
    """Fill lines as wide as the terminal, indented by `first` and `rest`; no number, name or path is broken."""
    return textwrap.fill(
        text,
        width=min(shutil.get_terminal_size((_WIDEST, 24)).columns, _WIDEST),
        initial_indent=" " * first,
        subsequent_indent=" " * rest,
        break_long_words=False,
        break_on_hyphens=False,
    )
