"""What `kinematify validate` says on a terminal: the verdict first, then what is wrong, the worst first."""

from __future__ import annotations

import os
import re
import shutil
import sys
import textwrap
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.text import (
    FAMILY_HEADINGS,
    JOINT_HEADINGS,
    NEXT_BEST_HEADINGS,
    configuration,
    family_rows,
    follow_words,
    joint_rows,
    measure,
    next_best_rows,
    printable,
    title,
    where,
)
from kinematify.validation.outcome import Unusable, counted_words, severity_counts, status_counts

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from kinematify.validation.causes import Told
    from kinematify.validation.finding import Finding
    from kinematify.validation.outcome import Outcome
    from kinematify.validation.report import ValidationReport
    from kinematify.validation.suppression import Suppression

MANY = 3
"""From so many findings on that differ in names and numbers only, they are a table."""
_COLORS = {"pass": "green", "warn": "yellow", "fail": "red", "unusable": "red"}
_SEVERITY_COLORS = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.NOTE: "blue"}
_WIDEST = 120
_SCREEN = 30
"""Lines of a report that nobody has to scroll for."""
_LONGEST = 120
"""Lines of a report unless everything is asked for."""
_PLACES = 6
"""So many places where the same was found are named."""
_CALL = re.compile(r"(?:mujoco\.MjModel\.from_xml_path|p\.loadURDF)\([^()]*\)")
"""How plain code loads a file."""
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def say(text: str) -> None:
    """Print on stdout; with colours on a terminal only, and not if the user does not want any."""
    colored = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
    encoding = sys.stdout.encoding or "utf-8"
    click.echo(text.encode(encoding, "replace").decode(encoding), color=colored)


def describe(outcome: Outcome, *, everything: bool = False) -> str:
    """One model: what is wrong and what to do, on a screen where that is possible, or everything that is known."""
    if isinstance(outcome, Unusable):
        return f"{_verdict_line(outcome)}\n{_wrapped(printable(outcome.message))}"
    return "\n\n".join(block for block in (_full if everything else _short)(outcome) if block)


def _full(report: ValidationReport) -> list[str]:
    """All findings with their places, numbers, consequences and code; families, joints, and what did not run."""
    return [
        "\n".join(_first_lines(report)),
        format_table(FAMILY_HEADINGS, family_rows(report)),
        "\n".join(_reasons(report, (Status.SKIPPED, Status.BLOCKED))),
        *(_group_text(group) for group in _groups(report.told)),
        _joint_table(report),
        _next_best(report),
    ]


def _short(report: ValidationReport) -> list[str]:
    """Errors and warnings with their remedies.

    Where they fill more than a screen, warnings are told without; what is beyond the longest report is counted.
    """
    told = [item for item in report.told if item.finding.suppressed is None]
    groups = _groups([item for item in told if item.finding.severity is not Severity.NOTE])
    head = ["\n".join(_first_lines(report)), "\n".join(_reasons(report, (Status.BLOCKED,)))]
    foot = [_next_best(report), _notes(told), _more(report)]
    texts = [_short_text(group) for group in groups]
    if _height([*head, *texts, *foot]) > _SCREEN:
        texts = [
            _short_text(group) if group[0].finding.severity is Severity.ERROR else _group_line(group, 0)
            for group in groups
        ]
    shown = len(texts)
    while shown and _height([*head, *texts[:shown], *foot]) > _LONGEST:
        shown -= 1
    left = sum(map(len, groups[shown:]))
    return [*head, *texts[:shown], f"{counted_words(left, 'more finding')}: --all tells them." if left else "", *foot]


def _height(blocks: Sequence[str]) -> int:
    """Lines of blocks with an empty one between any two."""
    return sum(block.count("\n") + 2 for block in blocks if block)


def _notes(told: Sequence[Told]) -> str:
    """How many notes there are, by check."""
    counts = Counter(item.finding.check for item in told if item.finding.severity is Severity.NOTE)
    listed = ", ".join(f"{check}{f' ({count})' if count > 1 else ''}" for check, count in sorted(counts.items()))
    return _wrapped(f"{counted_words(counts.total(), 'note')}: {listed}.") if counts else ""


def _more(report: ValidationReport) -> str:
    """What the whole report has besides."""
    code = ", plain code that shows what engines do" if any(item.reproduction for item in report.findings) else ""
    told = [item.finding for item in report.told if item.finding.suppressed is None]
    worst = next((found.check for severity in Severity for found in told if found.severity is severity), "KV301")
    return _wrapped(
        f"--all tells everything: notes, each place and number, what follows from what{code}, the joints, the checks "
        f"that did not run. kinematify explain {worst} tells what a check looks at."
    )


def describe_all(outcomes: Sequence[Outcome]) -> str:
    """Errors and warnings of each of several models in a line each, and a table of all models at the end."""
    blocks = [_brief(outcome) for outcome in outcomes]
    rows = [_summary_row(outcome) for outcome in outcomes]
    headings = ("model", "verdict", "errors", "warnings", "notes", "failed", "skipped", "blocked", "seconds")
    return "\n\n".join([*blocks, format_table(headings, rows)])


def describe_briefly(report: ValidationReport) -> str:
    """The verdict of one model, every error in full, and the warnings by what they are about, a line each."""
    told = [item for item in report.told if item.finding.suppressed is None]
    errors = _groups([item for item in told if item.finding.severity is Severity.ERROR])
    warnings: dict[tuple[str, str | None], list[Finding]] = {}
    for item in told:
        if item.finding.severity is Severity.WARNING:
            warnings.setdefault((item.finding.check, item.finding.engine), []).append(item.finding)
    lines = [*_first_lines(report), *map(_group_line, errors)]
    lines += [f"  {_heading(group[0])}{_times(len(group))}" for group in warnings.values()]
    return "\n".join(lines)


def describe_unused(rules: Iterable[Suppression]) -> str:
    """Name the suppressions that covered nothing; empty if there are none."""
    names = [f"{rule.check} at {rule.where}" for rule in rules]
    if not names:
        return ""
    return _wrapped(f"Note: these suppressions cover no finding and can go: {', '.join(names)}.")


def _first_lines(report: ValidationReport) -> list[str]:
    """The verdict, and what the file does as it is loaded."""
    return [_verdict_line(report), *([report.as_loaded] if report.as_loaded else [])]


def _verdict_line(outcome: Outcome) -> str:
    word = click.style(outcome.verdict.upper(), fg=_COLORS[outcome.verdict], bold=True)
    if isinstance(outcome, Unusable):
        return f"{word}  {printable(outcome.model)}"
    severities, statuses = severity_counts(outcome), status_counts(outcome)
    found = ", ".join(counted_words(severities.get(item, 0), item.value) for item in Severity)
    ran = statuses.get(Status.PASS, 0) + statuses.get(Status.FAIL, 0)
    left = [f"{statuses[item]} {item.value}" for item in (Status.SKIPPED, Status.BLOCKED) if statuses.get(item)]
    suppressed = len(outcome.findings) - len(outcome.counted)
    parts = [
        found,
        *([f"{counted_words(suppressed, 'finding')} suppressed"] if suppressed else []),
        ", ".join([f"{ran} of {len(outcome.checks)} checks ran", *left]),
        f"{float(outcome.environment.get('seconds', 0.0)):.1f} s",
        *([_unfinished(outcome)] if outcome.unfinished else []),
        *(["interrupted: partial"] if outcome.environment.get("interrupted") else []),
    ]
    return f"{word}  {printable(outcome.model)}: {'; '.join(parts)}"


def _unfinished(report: ValidationReport) -> str:
    status = ", exit status 3" if report.exit_status == ExitStatus.FAULT else ""
    return f"{counted_words(len(report.unfinished), 'check')} not finished{status}"


def _reasons(report: ValidationReport, statuses: Collection[Status]) -> list[str]:
    """Why checks of some statuses did not run, or were not finished, a line for each reason."""
    grouped: dict[tuple[Status, str], list[str]] = {}
    for check in report.checks:
        if check.status in statuses or check.unfinished:
            grouped.setdefault((check.status, check.reason or "no reason given"), []).append(check.check)
    return [
        _wrapped(printable(f"{status.value} ({', '.join(dict.fromkeys(checks))}): {reason}"), 2, 4)
        for (status, reason), checks in grouped.items()
    ]


def _groups(told: Sequence[Told]) -> list[list[Told]]:
    """Findings that say the same of different places, in the order of the first of each."""
    grouped: dict[tuple[object, ...], list[Told]] = {}
    for item in told:
        finding = item.finding
        key = (finding.check, finding.engine, finding.severity, finding.blame, finding.suppressed)
        grouped.setdefault((*key, _pattern(finding)), []).append(item)
    return list(grouped.values())


def _pattern(finding: Finding) -> str:
    """Message and remedy without the names and numbers of this finding."""
    text = f"{finding.message} {finding.remedy}"
    names = {finding.joint, finding.link, *(finding.pair or ()), *(finding.q or ())} - {None, ""}
    for name in sorted(map(str, names), key=len, reverse=True):
        text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", "@", text)
    return _NUMBER.sub("#", text)


def _short_text(group: Sequence[Told]) -> str:
    """What is wrong, where else, what to do, and what follows from it."""
    first = group[0].finding
    follows = follow_words(item for told in group for item in told.consequences)
    lines = [
        _heading(first, f", {len(group)} times" if len(group) > 1 else ""),
        _wrapped(printable(first.message), 2, 2),
        *([_wrapped(printable(f"Also: {_others(group)}."), 2, 2)] if len(group) > 1 else []),
        _wrapped(f"Remedy: {printable(first.remedy)}", 2, 2),
        *([_wrapped(f"Follows from it: {follows}.", 2, 2)] if follows else []),
        *_plain_call(group[0]),
    ]
    return "\n".join(lines)


def _plain_call(told: Told) -> list[str]:
    """The call of an engine that shows a finding or what follows from it; its code goes on with `--all`."""
    codes = [item.reproduction for item in (told.finding, *told.consequences) if item.reproduction is not None]
    call = _CALL.search(codes[0]) if codes else None
    return [] if call is None else [_wrapped(f"To see it: {printable(call.group())} and what --all prints.", 2, 2)]


def _others(group: Sequence[Told]) -> str:
    """Where else the same was found."""
    places = list(dict.fromkeys(where(item.finding) for item in group[1:]))
    more = len(places) - _PLACES
    return "; ".join(places[:_PLACES]) + (f" and {more} more" if more > 0 else "")


def _group_text(group: Sequence[Told]) -> str:
    if len(group) < MANY:
        return "\n\n".join(map(_finding_text, group))
    first = group[0].finding
    table = format_table(("where", "at", "measured", "line"), [_group_row(item.finding) for item in group])
    lines = [
        _heading(first, f", {len(group)} times"),
        _wrapped(f"For example: {printable(first.message)}", 2, 2),
        _wrapped(f"Remedy: {printable(first.remedy)}", 2, 2),
        *_consequences([item for told in group for item in told.consequences]),
        *_reproduction(first),
        *_suppressed(first),
        textwrap.indent(table, "  "),
    ]
    return "\n".join(lines)


def _consequences(findings: Sequence[Finding]) -> list[str]:
    """What follows from a finding, a paragraph each, with the code that shows the first in an engine."""
    if not findings:
        return []
    lines = [_wrapped(f"{title(item)}: {printable(item.message)}", 4, 6) for item in findings]
    shown = next((item for item in findings if item.reproduction is not None), None)
    return ["  Follows from it:", *lines, *([] if shown is None else _reproduction(shown))]


def _group_row(finding: Finding) -> tuple[str, ...]:
    cells = (where(finding), configuration(finding.q), measure(finding), str(finding.line or ""))
    return tuple(printable(cell) or "-" for cell in cells)


def _finding_text(told: Told) -> str:
    finding = told.finding
    at = configuration(finding.q)
    facts = [
        where(finding),
        f"at {at}" if at else "",
        measure(finding),
        f"line {finding.line}" if finding.line is not None else "",
    ]
    shown = "; ".join(fact for fact in facts if fact)
    lines = [
        _heading(finding),
        *([_wrapped(printable(shown), 2, 2)] if shown else []),
        _wrapped(printable(finding.message), 2, 2),
        _wrapped(f"Remedy: {printable(finding.remedy)}", 2, 2),
        *_consequences(told.consequences),
        *_reproduction(finding),
        *_suppressed(finding),
    ]
    return "\n".join(lines)


def _heading(finding: Finding, more: str = "") -> str:
    severity = click.style(finding.severity.value, fg=_SEVERITY_COLORS[finding.severity], bold=True)
    return f"{severity} {title(finding)} (blames {finding.blame.value}){more}"


def _reproduction(finding: Finding) -> list[str]:
    """The code that shows it, as it can be copied: no line is broken."""
    if finding.reproduction is None:
        return []
    return ["  To see it:", textwrap.indent(printable(finding.reproduction.rstrip("\n")), "    ")]


def _suppressed(finding: Finding) -> list[str]:
    if finding.suppressed is None:
        return []
    return [_wrapped(f"Suppressed, does not count: {printable(finding.suppressed)}", 2, 2)]


def _joint_table(report: ValidationReport) -> str:
    rows = [tuple(map(printable, row)) for row in joint_rows(report)]
    return format_table(JOINT_HEADINGS, rows) if rows else ""


def _next_best(report: ValidationReport) -> str:
    """What the inference would have chosen next where a joint failed; nothing if it left no record beside the model."""
    rows = [tuple(map(printable, row)) for row in next_best_rows(report)]
    folder = Path(report.model).parent
    more = f"kinematify refine {folder} simulates them and chooses again."
    return f"{format_table(NEXT_BEST_HEADINGS, rows)}\n{more}" if rows else ""


def _brief(outcome: Outcome) -> str:
    if isinstance(outcome, Unusable):
        return describe(outcome)
    lines = _first_lines(outcome)
    told = [item for item in outcome.told if item.finding.suppressed is None]
    lines += map(_group_line, _groups([item for item in told if item.finding.severity is not Severity.NOTE]))
    return "\n".join(lines)


def _group_line(group: Sequence[Told], indent: int = 2) -> str:
    first = group[0].finding
    about = where(first)
    message = f"{about}: {first.message}" if about else first.message
    return _wrapped(f"{_heading(first)}{_times(len(group))}: {printable(message)}", indent, indent + 2)


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
