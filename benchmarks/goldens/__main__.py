"""`python -m benchmarks.goldens make|check`: see the package."""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from benchmarks.goldens import __doc__ as _about
from benchmarks.goldens.file import (
    KINDS,
    Goldens,
    Subject,
    differences,
    read_goldens,
    same_checkout,
    this_platform,
    write_goldens,
)
from benchmarks.goldens.subjects import SUBJECTS
from benchmarks.goldens.values import PORTABLE, digest, first_difference
from benchmarks.study import Work
from kinematify.batch.pool import Pool
from kinematify.errors import ExitStatus, InputError, KinematifyError
from kinematify.evaluation.sources import git_commit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.goldens.file import Difference, Hashes

SAMPLE_FILE = Path(__file__).with_name("sample.json")
_FILE = Path("out", "goldens.json")
_SHOWN = 40
"""Differences of a subject that are named."""


@dataclass(kw_only=True)
class _Made:
    """What a subject gave now."""

    values: dict[str, dict[str, dict[str, Any]]] = field(default_factory=dict)
    absent: dict[str, str] = field(default_factory=dict)
    failures: dict[str, str] = field(default_factory=dict)

    @property
    def hashes(self) -> dict[str, Hashes]:
        return {
            item: {kind: {name: digest(value) for name, value in found[kind].items()} for kind in KINDS}
            for item, found in self.values.items()
        }


def make_subject(name: str, *, sample: bool, jobs: int) -> _Made:
    """Make all values of a subject, each item in a process of its own."""
    subject = SUBJECTS[name]
    items, absent = subject.items(sample)
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        pool = Pool(folder=Path(folder), workers=jobs, progress=partial(_progress, name))
        work = Work(study="goldens", pool=pool, code="")
        values = work.each(subject.values, items, timeout=subject.timeout, reuse=subject.reuse)
    failures = {item: failure.message for item, failure in work.failures.items()}
    return _Made(values=values, absent=absent, failures=failures)


def _progress(subject: str, what: str, share: float) -> None:
    click.echo(f"{subject} {share:4.0%} {what}", err=True)


def _options(command: click.Command) -> click.Command:
    for option in (
        click.option("--jobs", type=click.IntRange(min=1), default=os.cpu_count() or 1, help="Processes at a time."),
        click.option("--only", type=click.Choice(list(SUBJECTS)), multiple=True, help="Only this subject; repeatable."),
        click.option("--sample", is_flag=True, help="A part of every subject, and the committed file."),
    ):
        command = option(command)
    return command


@click.group(help=_about, context_settings={"max_content_width": 100})
def cli() -> None:
    """See the package."""


@cli.command("make")
@_options
@click.option("--to", type=click.Path(path_type=Path), help=f"File to write; {_FILE} if not given.")
@click.option("--keep", type=click.Path(path_type=Path), help="Folder for the values themselves, to look at.")
def make(*, sample: bool, only: tuple[str, ...], jobs: int, to: Path | None, keep: Path | None) -> int:
    """Write goldens; with --only, those of other subjects stay in the file."""
    path, platform = to or (SAMPLE_FILE if sample else _FILE), this_platform()
    goldens = Goldens(sample=sample, platform=platform)
    if only and path.exists():
        goldens = read_goldens(path)
        if goldens.sample != sample or goldens.platform != platform:
            raise InputError(
                f"{path} holds goldens of another platform or extent, to which nothing can be added. Make all again."
            )
    commit, dirty = git_commit()
    failures: dict[str, str] = {}
    for name in only or SUBJECTS:
        found = make_subject(name, sample=sample, jobs=jobs)
        _say_absent(name, found.absent)
        failures |= {f"{name}: {item}": why for item, why in found.failures.items()}
        goldens.subjects[name] = Subject(commit=commit + "+" * dirty, items=found.hashes)
        write_goldens(goldens, path)
        for item, values in found.values.items() if keep else ():
            _kept(keep, name, item).parent.mkdir(parents=True, exist_ok=True)  # type: ignore[arg-type]
            _kept(keep, name, item).write_text(json.dumps(values, indent=1) + "\n", "utf-8")  # type: ignore[arg-type]
    counts = {
        name: sum(len(kind) for item in made.items.values() for kind in item.values())
        for name, made in goldens.subjects.items()
    }
    click.echo(f"{path}: {', '.join(f'{name} {count}' for name, count in counts.items())}.")
    return _say_failures(failures)


@cli.command("check")
@_options
@click.option("--from", "source", type=click.Path(path_type=Path), help=f"File to compare with; {_FILE} if not given.")
@click.option(
    "--show", type=click.Path(path_type=Path), help="Folder that `make --keep` wrote: say where values differ."
)
@click.option("--portable", is_flag=True, help="On another platform compare what is the same on all, and no numbers.")
def check(
    *, sample: bool, only: tuple[str, ...], jobs: int, source: Path | None, show: Path | None, portable: bool
) -> int:
    """Compare what the code makes now. Ends with 0 if all is the same, 1 if not, 2 if it cannot be compared, 3 if
    something could not be made.
    """
    path = source or (SAMPLE_FILE if sample else _FILE)
    goldens = read_goldens(path)
    kinds = (PORTABLE,) if portable else KINDS
    if (others := goldens.platform.differences(this_platform())) and not portable:
        raise InputError(
            f"The goldens in {path} are of another platform ({'; '.join(others)}), where numbers have other last bits. "
            "Make them here with the code before the change, or compare with --portable what is the same everywhere."
        )
    if goldens.sample and not sample:
        raise InputError(f"{path} holds a sample. Compare with --sample, or make all goldens.")
    missing = [name for name in only or SUBJECTS if name not in goldens.subjects]
    if missing:
        raise InputError(f"{path} holds no goldens of {', '.join(missing)}. Make them with the code before the change.")
    counts = {"same": 0, "different": 0}
    failures: dict[str, str] = {}
    for name in only or SUBJECTS:
        found = make_subject(name, sample=sample, jobs=jobs)
        before = goldens.subjects[name].items
        now = found.hashes
        if goldens.sample != sample:  # of all goldens a sample
            before = {item: hashes for item, hashes in before.items() if item in now or item in found.failures}
        left = [item for item in before if any(item.startswith(f"{place}/") for place in found.absent)]
        before = {item: hashes for item, hashes in before.items() if item not in left}
        _say_absent(name, found.absent, left)
        failures |= {f"{name}: {item}": why for item, why in found.failures.items()}
        differ = [item for item in differences(before, now, kinds) if item.item not in found.failures]
        counts["different"] += len(differ)
        counts["same"] += sum(len(now[item][kind]) for item in now for kind in kinds) - sum(
            item.how != "missing" for item in differ
        )
        _say_differences(name, differ, found, show)
    if portable:
        click.echo("Not compared: numbers, which have other last bits on other platforms (--portable was given).")
    click.echo(f"{counts['same']} goldens are the same, {counts['different']} differ.")
    if not sum(counts.values()) and not failures:
        raise InputError("Nothing could be compared: see above what is absent.")
    return _say_failures(failures) or (ExitStatus.FAILURES if counts["different"] else ExitStatus.FINE)


def _say_absent(name: str, absent: dict[str, str], items: Sequence[str] = ()) -> None:
    for place, why in absent.items():
        of = [item for item in items if item.startswith(f"{place}/")]
        click.echo(f"{name}: not compared: {place}{f' ({len(of)} items)' if of else ''}: {why}")


def _say_differences(name: str, differ: Sequence[Difference], found: _Made, show: Path | None) -> None:
    for item in differ[:_SHOWN]:
        click.echo(f"{name}: {item.how}: {item.item}: {item.name}{' (portable)' if item.kind == PORTABLE else ''}")
        if show is not None and item.how == "changed":
            try:
                before = json.loads(_kept(show, name, item.item).read_text("utf-8"))[item.kind][item.name]
            except (OSError, KeyError) as error:
                click.echo(f"    its earlier value is not in {show}: {error}")
            else:
                now = json.loads(json.dumps(found.values[item.item][item.kind][item.name]))
                click.echo(f"    {first_difference(before, now) or 'the kept value is not the golden one'}")
    if len(differ) > _SHOWN:
        click.echo(f"{name}: and {len(differ) - _SHOWN} more")


def _say_failures(failures: dict[str, str]) -> int:
    for item, why in failures.items():
        click.echo(f"Not made: {item}: {why}", err=True)
    return ExitStatus.FAULT if failures else ExitStatus.FINE


def _kept(folder: Path, subject: str, item: str) -> Path:
    return folder / subject / f"{re.sub(r'[^0-9A-Za-z._-]+', '_', item)}.json"


def run(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit status."""
    try:
        same_checkout()
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
