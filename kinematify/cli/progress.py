"""Progress on stderr: one moving bar on a terminal, one plain line per stage otherwise."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Reporter = Callable[[str, float], None]


@contextmanager
def progress_reporter() -> Iterator[Reporter]:
    """Yield a function that is given the stage and the fraction done in [0, 1]; stdout stays untouched."""
    if sys.stderr.isatty():
        with _bar() as report:
            yield report
    else:
        yield _plain_lines()


@contextmanager
def _bar() -> Iterator[Reporter]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("starting", total=1.0)
        yield lambda stage, fraction: bars.update(task, description=stage, completed=fraction)


def _plain_lines() -> Reporter:
    start = time.monotonic()
    last = ""

    def report(stage: str, fraction: float) -> None:
        nonlocal last
        if stage != last:
            last = stage
            click.echo(f"[{time.monotonic() - start:6.1f} s, {fraction:4.0%}] {stage}", err=True)

    return report
