"""Where a command's machine-readable answer goes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.errors import OutputError

if TYPE_CHECKING:
    from collections.abc import Mapping

json_option = click.option(
    "--json", "json_to", metavar="FILE", help="Write the answer as JSON to FILE; - is stdout, and then nothing else is."
)
"""The option of every command that answers; the command calls `write_answer` with its value."""


def write_answer(answer: Mapping[str, Any], target: str | None) -> bool:
    """Write `answer` as JSON to a file, to stdout if `target` is ``-``, or nowhere if it is None.

    Returns:
        Whether people read stdout.

    Raises:
        OutputError: The file cannot be written.
    """
    if target is None:
        return True
    text = json.dumps(answer, indent=2, allow_nan=False)
    if target == "-":
        click.echo(text)
        return False
    try:
        Path(target).write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"The answer cannot be written to {target}: {error.strerror}. Give --json a file in a folder that exists "
            "and is writable, or - for stdout."
        ) from error
    return True
