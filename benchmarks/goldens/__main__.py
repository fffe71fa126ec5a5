"""`python -m benchmarks.goldens make|check`: see the package."""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from benchmarks.goldens import __doc__ as about
from benchmarks.goldens.file import (
    Goldens,
    Subject,
    differences,
    other_platform,
    read_goldens,
    refuse_other_checkout,
    this_platform,
    write_goldens,
)
from benchmarks.goldens.subjects import SUBJECTS
from benchmarks.goldens.values import KINDS, PORTABLE, SPREAD, digest, first_difference
from benchmarks.study import Work
from kinematify.batch.task_pool import Pool
from kinematify.errors import ExitStatus, InputError, KinematifyError
from kinematify.evaluation.result_record import git_commit

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from benchmarks.goldens.file import Hashes

SAMPLE_FILE = Path(__file__).with_name("sample.json")
_FILE = Path("out", "goldens.json")
_TIMEOUT = 3600.0
"""Wall time for one item [s]."""
_NAMED = 40
"""Differences of a subject that are named."""


@dataclass(frozen=True, kw_only=True)
class _Made:
    """What a subject gives."""

    values: dict[str, dict[str, dict[str, Any]]]
    """By item, kind and name."""
    hashes: dict[str, Hashes]
    absent: dict[str, str]
    """Data set -> why nothing of it was made."""
    failures: dict[str, str]
    """Item -> why it was not made."""


def _make(name: str, *, sample: bool, jobs: int, only: Collection[str] | None = None) -> _Made:
    """Make all values of a subject, or some items; each in a process, so that a crash is a failure of one item."""
    subject = SUBJECTS[name]
    items, absent = subject.items(sample)
    items = {item: argument for item, argument in items.items() if only is None or item in only}

    def progress(what: str, share: float) -> None:
        click.echo(f"{name} {share:4.0%} {what}", err=True)

    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:  # nothing is taken up from an earlier run
        work = Work(study="goldens", pool=Pool(folder=Path(folder), workers=jobs, progress=progress), code="")
        values = work.each(subject.values, items, timeout=_TIMEOUT, reuse=subject.reuse)
    return _Made(
        values=values,
        hashes={
            item: {kind: {word: digest(value) for word, value in of.items()} for kind, of in found.items()}
            for item, found in values.items()
        },
        absent=absent,
        failures={f"{name}: {item}": failure.message for item, failure in work.failures.items()},
    )


def _options(command: Callable[..., int]) -> Callable[..., int]:
    for option in (
        click.option("--jobs", type=click.IntRange(min=1), default=os.cpu_count() or 1, help="Processes at a time."),
        click.option("--only", type=click.Choice(list(SUBJECTS)), multiple=True, help="Only this subject; repeatable."),
        click.option("--sample", is_flag=True, help="A part of every subject, and the committed file."),
    ):
        command = option(command)
    return command


@click.group(help=about, context_settings={"max_content_width": 100})
def cli() -> None:
    """See the package."""


@cli.command("make")
@_options
@click.option("--to", "path", type=click.Path(path_type=Path), help=f"File to write; {_FILE} if not given.")
@click.option("--keep", type=click.Path(path_type=Path), help="Folder for the values themselves, to look at.")
def make(*, sample: bool, only: tuple[str, ...], jobs: int, path: Path | None, keep: Path | None) -> int:
    """Write goldens; with --only, those of other subjects stay in the file."""
    path = path or (SAMPLE_FILE if sample else _FILE)
    goldens = Goldens(sample=sample, platform=this_platform())
    if only and path.exists():
        before = read_goldens(path)
        if (before.sample, before.platform) != (goldens.sample, goldens.platform):
            raise InputError(f"{path} is of another platform or extent; nothing can be added to it. Make all again.")
        goldens = before
    commit, dirty = git_commit()
    failures: dict[str, str] = {}
    for name in only or SUBJECTS:
        made = _make(name, sample=sample, jobs=jobs)
        goldens.subjects[name] = Subject(commit=commit + "+" * dirty, items=made.hashes)
        write_goldens(goldens, path)  # what is made is kept, whatever comes
        _say_absent(name, made, ())
        failures |= made.failures
        if keep is not None:
            for item, values in made.values.items():
                file = _kept(keep, name, item)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    return _end(failures, ExitStatus.FINE)


@cli.command("check")
@_options
@click.option("--from", "path", type=click.Path(path_type=Path), help=f"File to compare with; {_FILE} if not given.")
@click.option("--show", type=click.Path(path_type=Path), help="Folder that `make --keep` wrote, to say what differs.")
@click.option("--portable", is_flag=True, help="Compare only what is the same on all platforms, and no numbers.")
def check(
    *, sample: bool, only: tuple[str, ...], jobs: int, path: Path | None, show: Path | None, portable: bool
) -> int:
    """Compare what the code makes now with goldens.

    Ends with 0 if all is the same, 1 if something differs, 2 if it cannot be compared, 3 if something was not made.
    """
    path = path or (SAMPLE_FILE if sample else _FILE)
    goldens = read_goldens(path)
    if (other := other_platform(goldens.platform, this_platform())) and not portable:
        if path != SAMPLE_FILE:
            raise InputError(
                f"The goldens in {path} are of another platform, where numbers have other last bits: {other}. Make "
                "them here with the code before the change, or compare with --portable what is the same everywhere."
            )
        click.echo(f"The committed sample is of another platform: {other}.")
        portable = True
    if goldens.sample and not sample:
        raise InputError(f"{path} holds a sample. Compare with --sample, or make all goldens.")
    if unknown := [name for name in only or SUBJECTS if name not in goldens.subjects]:
        raise InputError(f"{path} holds no goldens of {', '.join(unknown)}. Make them with the code before the change.")
    kinds = (PORTABLE,) if portable else KINDS
    failures: dict[str, str] = {}
    compared = different = 0
    for name in only or SUBJECTS:
        before = goldens.subjects[name].items
        if not any(hashes.get(kind) for hashes in before.values() for kind in kinds):
            continue  # nothing of it is the same everywhere
        made = _make(name, sample=sample, jobs=jobs)
        absent = [item for item in before if item.split("/")[0] in made.absent]
        # Items of the file that were not made are missing, but for those beyond the sample and those that failed.
        beyond = {item for item in before if item not in made.hashes and sample and not goldens.sample}
        left = {*absent, *beyond, *(failure.split(": ", 1)[1] for failure in made.failures)}
        before = {item: hashes for item, hashes in before.items() if item not in left}
        differ = list(differences(before, made.hashes, kinds))
        if scattered := {item for item, kind, _, how in differ if kind == SPREAD and how == "changed"}:
            again = _make(name, sample=sample, jobs=jobs, only=scattered)
            failures |= again.failures
            spread = {(*of, "changed") for *of, _ in differences(made.hashes, again.hashes, (SPREAD,))}
            click.echo(
                f"{name}: {len(spread.intersection(differ))} tolerated, which two runs here give differently, too."
            )
            differ = [difference for difference in differ if difference not in spread]
        compared += sum(len(hashes.get(kind, {})) for hashes in before.values() for kind in kinds)
        different += len(differ)
        failures |= made.failures
        _say_absent(name, made, absent)
        _say_differences(name, differ, made, show)
    if portable:
        click.echo("Not compared: numbers, which have other last bits on other platforms.")
    if not compared and not failures:
        raise InputError("Nothing was compared; what is said above is absent. Set KINEMATIFY_BENCH to the models.")
    click.echo(f"{compared} goldens compared, {different} differences.")
    return _end(failures, ExitStatus.FAILURES if different else ExitStatus.FINE)


def _say_absent(name: str, made: _Made, items: Sequence[str]) -> None:
    for place, why in made.absent.items():
        listed = ", ".join(item for item in items if item.startswith(f"{place}/"))
        click.echo(f"{name}: not compared: {listed or place}. {why}")


def _say_differences(name: str, differ: Sequence[tuple[str, str, str, str]], made: _Made, show: Path | None) -> None:
    for item, kind, word, how in differ[:_NAMED]:
        click.echo(f"{name}: {how}: {item}: {word}")
        if show is not None and how == "changed":
            try:
                before = json.loads(_kept(show, name, item).read_text("utf-8"))[kind][word]
            except (OSError, KeyError) as error:
                click.echo(f"    {show} does not hold its earlier value: {error}")
            else:
                click.echo(f"    {first_difference(before, made.values[item][kind][word])}")
    if len(differ) > _NAMED:
        click.echo(f"{name}: and {len(differ) - _NAMED} more")


def _end(failures: dict[str, str], status: int) -> int:
    for item, why in failures.items():
        click.echo(f"Not made: {item}: {why}", err=True)
    return ExitStatus.FAULT if failures else status


def _kept(folder: Path, subject: str, item: str) -> Path:
    return folder / subject / f"{re.sub(r'[^0-9A-Za-z._-]+', '_', item)}.json"


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    try:
        refuse_other_checkout()
        status = cli.main(arguments, prog_name="python -m benchmarks.goldens", standalone_mode=False)
    except click.ClickException as error:
        error.show()
        return ExitStatus.UNUSABLE
    except KinematifyError as error:
        click.echo(f"Error: {error}", err=True)
        return error.exit_status
    return status if isinstance(status, int) else ExitStatus.FINE


if __name__ == "__main__":
    sys.exit(run())
