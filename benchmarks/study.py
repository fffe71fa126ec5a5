"""A study answers one question by measuring: data -> records, each made in a process of its own -> a report.

Every module of `benchmarks.studies` is one and defines `STUDY`; `kinematify bench NAME` runs it, with options that are
read off the study's own type.
"""

from __future__ import annotations

import ast
import hashlib
import importlib
import os
import pkgutil
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import click
from pydantic import AfterValidator, BaseModel, ConfigDict, TypeAdapter, ValidationError

from benchmarks import studies
from kinematify.batch.task_pool import WORK_FOLDER, Pool
from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table
from kinematify.errors import ExitStatus, InputError, OutputError
from kinematify.evaluation.result_record import Report, as_json, code_version, load_report, new_header, write_report
from kinematify.processes.pool import TaskFailure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from matplotlib.figure import Figure
    from pydantic.fields import FieldInfo

Record = dict[str, Any]
"""What was measured of one thing, as plain JSON values."""
Measured = tuple[list[Record], Record]
"""Records, and what was counted over them."""
RECORD = TypeAdapter(Record)
RECORDS = TypeAdapter(tuple[Record, ...])

_Argument = TypeVar("_Argument")


class Options(BaseModel):
    """What a study can be asked for: each field is an option of its command, with its description as help.

    A field called `seed` is drawn from, and named in the report.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)


_Options = TypeVar("_Options", bound=Options)


@dataclass(frozen=True, kw_only=True)
class Work:
    """Where a study has its records made."""

    study: str
    pool: Pool
    code: str
    failures: dict[str, TaskFailure] = field(default_factory=dict)
    """Arguments that gave no record."""

    @property
    def folder(self) -> Path:
        """For files that are needed again when a stopped study goes on."""
        return self.pool.folder / self.study

    def each(
        self,
        function: Callable[[_Argument], Record],
        arguments: Mapping[str, _Argument],
        *,
        timeout: float = 3600.0,
        workers: int | None = None,
        reuse: int = 1,
        failed: Callable[[str, TaskFailure], Record] | None = None,
    ) -> dict[str, Record]:
        """Call a function for every argument, each in a process, and return the records in the order given.

        Args:
            function: Of a module; picklable.
            arguments: By name. What they look like in Python (`repr`) decides whether an earlier record is taken up.
            timeout: Wall time for one [s].
            workers: Processes at a time; 1 where times are measured. The pool's if None.
            reuse: Arguments that a process takes one after the other.
            failed: Makes a record of a failure; without it what failed is kept in `failures` and has no record.
        """
        pool = self.pool if workers is None else replace(self.pool, workers=workers)
        names = {self._key(function, name, argument): name for name, argument in arguments.items()}
        answers = pool.run(
            {key: partial(function, arguments[name]) for key, name in names.items()},
            RECORD,
            ledger=self.study,
            timeout=timeout,
            said=lambda key, answer: names[key] + (f": {answer.message}" if isinstance(answer, TaskFailure) else ""),
            preload=(function.__module__,),
            reuse=reuse,
        )
        records: dict[str, Record] = {}
        for key, answer in answers.items():
            if not isinstance(answer, TaskFailure):
                records[names[key]] = answer
            elif failed is not None:
                records[names[key]] = failed(names[key], answer)
            else:
                self.failures[names[key]] = answer
        return records

    def _key(self, function: Callable[..., Record], name: str, argument: object) -> str:
        facts = f"{function.__module__}.{function.__qualname__} {name} {argument!r} {self.code}"
        return hashlib.sha256(facts.encode()).hexdigest()


@dataclass(frozen=True, kw_only=True)
class Study(Generic[_Options]):
    """One question and how it is answered."""

    title: str
    """Heading of the report."""
    options: type[_Options]
    measure: Callable[[_Options, Work], Measured]
    report: Callable[[Report[Record]], list[str]]
    """Blocks of Markdown, from the records alone."""
    plot: Callable[[Report[Record]], Figure] | None = None
    faults: Callable[[Report[Record]], list[str]] = lambda report: []
    """Sentences about what must not be; with any, the command ends with 1."""


def study_names() -> tuple[str, ...]:
    """Names of all studies, without importing one."""
    return tuple(module.name.replace("_", "-") for module in pkgutil.iter_modules(studies.__path__))


def study_text(name: str) -> str:
    """What the module of a study says of it, read without importing what it measures with."""
    path = Path(studies.__path__[0], f"{name.replace('-', '_')}.py")
    return ast.get_docstring(ast.parse(path.read_text("utf-8"))) or ""


def load_study(name: str) -> Study[Any]:
    """Return a study by its name.

    Raises:
        InputError: There is none of that name.
    """
    if name not in study_names():
        raise InputError(f"There is no study {name}. There are {', '.join(study_names())}.")
    study: Study[Any] = importlib.import_module(f"{studies.__name__}.{name.replace('-', '_')}").STUDY
    return study


def run_study(name: str, options: Options, pool: Pool) -> Report[Record]:
    """Run a study, taking up what an earlier run of the same code has finished.

    Args:
        name: Of `study_names`.
        options: Of the study's own type.
        pool: Where it runs.

    Raises:
        InputError: There is no such study, or nothing to measure.
        OutputError: The work folder cannot be written.
    """
    study, code = load_study(name), code_version(module=__name__)
    work = Work(study=name, pool=pool, code=code)
    try:
        work.folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"The study cannot work in {work.folder}: {error}. Give a folder that can be written with --work."
        ) from error
    records, summary = study.measure(options, work)
    if work.failures:
        summary = {**summary, "failures": {what: failure.message for what, failure in work.failures.items()}}
    if not records:
        why = summary.get("failures") or "no object, model or case was chosen"
        raise InputError(f"The study {name} has nothing to report: {why}. Ask it for more.")
    configuration = options.model_dump(mode="json")
    header = new_header(
        name, workers=pool.workers, seeds=[configuration.get("seed", 0)], configuration=configuration, code=code
    )
    return Report(header=header, records=tuple(records), summary=summary)


def write_study(report: Report[Record], folder: Path, name: str | None = None) -> tuple[Path, ...]:
    """Write JSON, Markdown and, of a study that has a plot, a picture; return the paths.

    Args:
        report: What `run_study` returned, or `load_report` read.
        folder: Made if need be.
        name: File stem; the study's name if None.

    Raises:
        EnvironmentFault: matplotlib is not installed, and there is a plot.
        OutputError: The folder cannot be written.
    """
    study = load_study(report.header.study)
    failures: Mapping[str, str] = report.summary.get("failures", {})
    missing = ["## Without a record", "\n".join(f"- {what}: {why}" for what, why in failures.items())]
    return write_report(
        report,
        RECORDS,
        [*study.report(report), *(missing if failures else [])],
        folder,
        name=name or file_stem(report.header.study),
        title=study.title,
        plot=None if study.plot is None else partial(study.plot, report),
    )


def file_stem(study: str) -> str:
    """Name of a study's files."""
    return study.replace("-", "_")


def among(known: Iterable[str]) -> AfterValidator:
    """Return what refuses a word of a list that is not among the known ones."""
    words = tuple(known)

    def checked(given: tuple[str, ...]) -> tuple[str, ...]:
        unknown = [word for word in given if word not in words]
        if unknown:
            raise ValueError(f"{unknown[0]!r} is none of {', '.join(words)}")
        return given

    return AfterValidator(checked)


def explained(doc: str | None) -> str:
    """Return what the docstring of a study's module says below its question."""
    return (doc or "").partition("\n\n")[2].strip()


def study_command(name: str) -> click.Command | None:
    """Return the command of a study, None if there is none of this name."""
    if name not in study_names():
        return None
    study = load_study(name)
    options = [_option(field, info) for field, info in study.options.model_fields.items()]

    @click.option("-o", "--out", type=click.Path(path_type=Path), default=Path("results"), help="Report folder.")
    @click.option("--name", "stem", metavar="NAME", help="File name of the report, without suffix.")
    @click.option("--work", type=click.Path(path_type=Path), help="Folder of what has ended, for a run that goes on.")
    @click.option("--jobs", type=click.IntRange(min=1), help="Processes at a time; as many as there are cores.")
    @click.option("--fresh", is_flag=True, help="Measure all again.")
    @click.option("--tables", is_flag=True, help="Measure nothing; write the report again from its JSON.")
    @json_option
    def run(**values: Any) -> int:
        return _run(name, study, values)

    command = click.command(name, help=f"{study.title}.\n\n{study_text(name)}")(run)
    command.params = [*options, *command.params]
    return command


def print_studies() -> None:
    """Print name and question of every study."""
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
    if write_answer(as_json(report, RECORDS), values["json_to"]):
        click.echo(f"{len(report.records)} records. Report: {', '.join(map(str, written))}")
    for fault in faults:
        click.echo(fault, err=True)
    return ExitStatus.FAILURES if faults else ExitStatus.FINE


def _options(study: Study[Any], values: dict[str, Any]) -> Options:
    """What was typed, as the study's own type; lists stand there separated by commas."""
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
