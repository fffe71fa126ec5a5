"""`kinematify nightly`: benchmark and validation, compared with the night before and with the baseline."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import examples, jobs_option
from kinematify.cli.progress import progress_reporter
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from kinematify.evaluation.nightly.comparison import Change
    from kinematify.evaluation.nightly.run_night import NightResult

_SHOWN = 20
"""Changes of a class that the terminal shows; the page has all."""


@click.command(
    "nightly",
    epilog=examples(
        "kinematify nightly",
        "kinematify nightly models/ -o out/nights",
        "kinematify nightly --config my_nightly.yaml -o results/nightly",
        "kinematify nightly --objects panda --objects 'cabinet_*' -o out/nights",
        "kinematify nightly --accept 2026-01-31-0a1b2c3",
        "kinematify nightly --smoke",
    ),
)
@click.option("--config", default="nightly", show_default=True, metavar="NAME|FILE", help="What to run, and the gates.")
@click.option(
    "-o",
    "--out",
    type=click.Path(path_type=Path),
    help="Folder of all nights.  [default: results/nightly; with --smoke out/nightly-smoke]",
)
@click.argument("data", required=False)
@click.option(
    "--objects",
    multiple=True,
    metavar="GLOB",
    help="Only objects of such a name, category or kind; may be given more than once.",
)
@click.option("--baseline", metavar="NIGHT", help="Compare with this night, not the accepted one.")
@click.option("--accept", "accepted", metavar="NIGHT", help="Make a night the baseline, and run nothing.")
@click.option("--smoke", is_flag=True, help="Two objects of the built-in generator, in about half a minute.")
@jobs_option
@json_option
def command(*, accepted: str | None, json_to: str | None, **given: Any) -> int:
    """Infer every object of the benchmark, validate the models, and report what changed since earlier nights.

    DATA is a folder with URDF files at any depth, or a word that `kinematify bench` takes; without it the configuration
    says what runs. Writes a folder OUT/DATE-COMMIT with JSON, JSON lines, JUnit and a page, and OUT/index.html with a
    line for each night. A run that was killed at any point goes on where it stopped. Ends with 1 if quality became
    worse than in the accepted night, or than in the night before where none was accepted; times are only reported. An
    object whose files changed is compared with its last result.
    """
    from kinematify.evaluation.nightly.run_night import accept, nightly

    if accepted is not None:
        folder = accept(given["out"], accepted, smoke=given["smoke"])
        click.echo(f"{accepted} is the baseline of {folder} from now on.")
        return 0
    with progress_reporter() as progress:
        result = nightly(**given, progress=progress)
    from kinematify.evaluation.nightly.comparison import CHANGES

    night, changes = result.night, CHANGES.dump_python(result.night.changes, mode="json")
    facts = {**night.header, "gate": night.gate, "changes": changes}
    if write_answer({**facts, "folder": str(result.place), "notices": list(result.notices)}, json_to):
        click.echo(_described(result))
    for notice in result.notices:
        click.echo(notice, err=True)
    return ExitStatus.FAILURES if result.night.gate == "fail" else 0


def _described(result: NightResult) -> str:
    """The verdict, what changed by class, and where to look."""
    from kinematify.evaluation.nightly.comparison import ChangeKind

    night = result.night
    header = night.header
    size = f"{header['objects']} objects, {header['runs']} runs, {header['seconds'] / 60.0:.1f} min"
    compared = header["compared"] or "nothing: it is the first night"
    lines = [f"{night.gate}: night {night.name}, {size}, compared with {compared}"]
    for kind in ChangeKind:
        found = [change for change in night.changes if change.kind is kind]
        if found:
            lines.append(f"  {kind.value}: {len(found)}")
        if kind not in (ChangeKind.STILL_FAILING, ChangeKind.NEW_SERIES):
            lines += [f"    {_line(change)}" for change in found[:_SHOWN]]
            lines += [f"    and {len(found) - _SHOWN} more, see the page"] if len(found) > _SHOWN else []
    lines += ["  nothing changed"] if not night.changes else []
    return "\n".join([*lines, f"Pages: {result.place / 'index.html'} and {result.place.parent / 'index.html'}"])


def _line(change: Change) -> str:
    mark = "FAILS " if change.gate else ""
    return f"{mark}{change.object}, {change.what} {change.case}: {change.subject} {change.text}".replace(":  ", ": ")
