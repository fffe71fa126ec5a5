"""`kinematify explain`: what a check verifies, why it matters, how to fix what it finds."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import complete_checks, examples
from kinematify.cli.table import format_table

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from kinematify.validation.check import Check

_WIDTH = 100


@click.command(
    "explain",
    epilog=examples(
        "kinematify explain KV301",
        "kinematify explain kv301 kv401 --json -",
        "kinematify explain --list",
    ),
)
@click.argument("checks", nargs=-1, metavar="[CHECK]...", shell_complete=complete_checks)
@click.option("--list", "as_list", is_flag=True, help="Table of all checks.")
@json_option
def command(*, checks: tuple[str, ...], as_list: bool, json_to: str | None) -> None:
    """Explain each CHECK, by its id such as KV301; an unknown one is answered with the nearest.

    Without CHECK, --json writes all of them.
    """
    from kinematify.validation.checks import CHECKS, find_check

    if checks and as_list:
        raise click.UsageError("--list shows all checks. Leave the ids or the option out.")
    if not (checks or as_list or json_to):
        raise click.UsageError("Give the id of a check, such as KV301, or --list.")
    chosen = [find_check(name) for name in checks] or list(CHECKS.values())
    if not write_answer({"schema": 1, "checks": [_as_answer(check) for check in chosen]}, json_to):
        return
    if as_list:
        click.echo(_as_table(chosen))
    elif checks:
        click.echo("\n\n".join(map(_describe, chosen)))


def _as_table(checks: Sequence[Check]) -> str:
    rows = [(check.id, check.severity.value, check.cause.value, _engines(check), check.title) for check in checks]
    return format_table(("id", "severity", "cause", "engines", "check"), sorted(rows))


def _describe(check: Check) -> str:
    from kinematify.validation.check import FAMILIES

    family = f"{check.id[:3]}xx, {FAMILIES[check.id[:3]]}"
    facts = f"severity {check.severity.value}, cause {check.cause.value}, engines {_engines(check)}"
    texts = (
        ("Family", f"{family}; {facts}"),
        ("Verifies", check.verifies),
        ("Why it matters", check.matters),
        ("Remedy", check.remedy),
    )
    return "\n".join(
        [f"{check.id}  {check.title}; else: {check.fails}", *(_filled(f"{name}: {text}") for name, text in texts)]
    )


def _filled(text: str) -> str:
    return textwrap.fill(text, _WIDTH, initial_indent="  ", subsequent_indent="  ", break_long_words=False)


def _engines(check: Check) -> str:
    return ", ".join(check.engines) or "-"


def _as_answer(check: Check) -> dict[str, Any]:
    return {
        "id": check.id,
        "title": check.title,
        "fails": check.fails,
        "severity": check.severity.value,
        "cause": check.cause.value,
        "engines": list(check.engines),
        "verifies": check.verifies,
        "matters": check.matters,
        "remedy": check.remedy,
        "follows": {name: shared.value for name, shared in check.follows.items()},
    }
