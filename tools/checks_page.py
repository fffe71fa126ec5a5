"""Print `docs/checks.md`, the page of all checks: `python -m tools.checks_page > docs/checks.md`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from kinematify.validation.check import FAMILIES, FeedbackRow
from kinematify.validation.checks import CHECKS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.check import Check


def as_markdown(checks: Sequence[Check]) -> str:
    """Return the page `docs/checks.md`."""
    lines = [
        "# Checks of `kinematify validate`",
        "",
        "Written by `python -m tools.checks_page > docs/checks.md`; change `validation/checks/`, not this page.",
        "",
        "An id stays the same for ever. The severity is the worst that a check reports. Words in `this_form` are",
        "settings of [kinematify/config/validation.py](../kinematify/config/validation.py).",
    ]
    for prefix, family in FAMILIES.items():
        members = sorted((check for check in checks if check.id.startswith(prefix)), key=lambda check: check.id)
        if members:
            lines += ["", f"## {prefix}xx: {family}", "", *_index(members)]
            lines += [line for check in members for line in ("", *_section(check))]
    lines += ["", "## What `kinematify refine` makes of findings", "", *_feedback(checks)]
    return "\n".join(lines) + "\n"


def _index(checks: Sequence[Check]) -> list[str]:
    rows = [
        f"| [{check.id}](#{check.id.lower()}) | {_cell(check.title)} | {check.severity.value} | {check.cause.value} "
        f"| {', '.join(check.engines) or '-'} |"
        for check in checks
    ]
    return ["| id | check | severity | cause | engines |", "|---|---|---|---|---|", *rows]


def _feedback(checks: Sequence[Check]) -> list[str]:
    table = ["| signal | checks |", "|---|---|"]
    for row in FeedbackRow:
        inside = {check.id for check in checks if check.feedback is row}
        whole = [
            family for family in FAMILIES if {check.id for check in checks if check.id.startswith(family)} <= inside
        ]
        single = [f"[{name}](#{name.lower()})" for name in sorted(inside) if not name.startswith(tuple(whole))]
        table.append(f"| {row.value} | {', '.join([f'{family}xx' for family in whole] + single)} |")
    return table


def _section(check: Check) -> list[str]:
    return [
        f"### {check.id}",
        f"- **{check.title}**; else: {check.fails}",
        f"- Verifies: {check.verifies}",
        f"- Why it matters: {check.matters}",
        f"- Remedy: {check.remedy}",
        *([f"- May follow from: {_causes(check)}"] if check.follows else []),
    ]


def _causes(check: Check) -> str:
    """Checks that can be the cause, with what both must be about."""
    return ", ".join(f"[{name}](#{name.lower()}) ({shared.value})" for name, shared in check.follows.items())


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    sys.stdout.write(as_markdown(list(CHECKS.values())))
