"""The command of a study: `kinematify bench STUDY`, its options read off the study's own type."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from benchmarks.study import Options, Study


def study_command(name: str) -> click.Command | None:
    """Return the command of a study, None if there is none of this name."""
    from benchmarks.study import load_study, study_names, study_text

    if name not in study_names():
        return None
    study = load_study(name)
    options = [_option(field, info) for field, info in study.options.model_fields.items()]

    @click.option("-o", "--out", type=click.Path(path_type=Path), default=Path("results"), help="Report folder.")
    @click.option("--name", "stem", metavar="NAME", help="File name of the report, without suffix.")
    @click.option("--work", type=click.Path(path_type=Path), help="Folder of what has ended, for a run that goes on.")
    @click.option("--jobs", type=click.IntRange(min=1), help="Processes at a time; as many as there are cores.")
    @click.option("--fresh", is_flag=True, help="Measure all again.")
    @click.option("--tables", is_flag=True, help="Measure nothing; write the report anew from its JSON.")
    @json_option
    def run(**values: Any) -> int:
        return _run(name, study, values)

    command = click.command(name, help=f"{study.title}.\n\n{study_text(name)}")(run)
    command.params = [*options, *command.params]
    return command


def print_studies() -> None:
    """Print name and question of every study."""
    from benchmarks.study import study_names, study_text

    rows = [(name, study_text(name).partition("\n")[0]) for name in study_names()]
    click.echo(format_table(("study", "what it answers"), rows))


def _option(name: str, info: FieldInfo) -> click.Option:
    words = [f"--{name.replace('_', '-')}", name]
    if info.annotation is bool:
        return click.Option(words, is_flag=True, help=info.description)
    default = info.default
    shown = ",".join(map(str, default)) if isinstance(default, tuple) else default
    note = f"{info.description}" + (f"  [default: {shown}]" if shown not in (None, "") else "")
    return click.Option(words, metavar="LIST" if isinstance(default, tuple) else "VALUE", help=note)


def _run(name: str, study: Study[Any], values: dict[str, Any]) -> int:
    from benchmarks.study import RECORDS, file_stem, run_study, write_study
    from kinematify.batch.pool import WORK_FOLDER, Pool
    from kinematify.evaluation.record import as_json, load_report

    stem = values["stem"] or file_stem(name)
    if values["tables"]:
        report = load_report(values["out"] / f"{stem}.json", RECORDS)
    else:
        options = _options(study, values)
        with progress_reporter() as progress:
            pool = Pool(
                folder=values["work"] or WORK_FOLDER,
                workers=values["jobs"] or os.cpu_count() or 1,
                fresh=values["fresh"],
                progress=progress,
            )
            report = run_study(name, options, pool)
    written = write_study(report, values["out"], stem)
    faults = study.faults(report)
    if values["json_to"]:
        write_answer(as_json(report, RECORDS), values["json_to"])
    if values["json_to"] != "-":
        click.echo(f"{len(report.records)} records. Report: {', '.join(map(str, written))}")
    for fault in faults:
        click.echo(fault, err=True)
    return ExitStatus.FAILURES if faults else ExitStatus.FINE


def _options(study: Study[Any], values: dict[str, Any]) -> Options:
    """What was typed, as the study's own type; lists stand there separated by commas."""
    from pydantic import ValidationError

    given = {}
    for name, info in study.options.model_fields.items():
        value = values[name]
        if value is not None:
            given[name] = tuple(filter(None, value.split(","))) if isinstance(info.default, tuple) else value
    try:
        options: Options = study.options(**given)
    except ValidationError as error:
        first = error.errors()[0]
        option = str(first["loc"][0]).replace("_", "-")
        raise click.UsageError(f"--{option} {first['input']!r} does not fit: {first['msg']}.") from error
    return options
