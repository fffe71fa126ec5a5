"""Records of the evaluation: a JSON of one form for benchmark and studies, and the Markdown beside it.

What a result depends on stands in its header: the sources that gave it, as a hash, and the commit that they are at.
"""

from __future__ import annotations

import datetime
import hashlib
import importlib.util
import json
import os
import platform
import shlex
import subprocess
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from pydantic import TypeAdapter, ValidationError

from kinematify import __version__
from kinematify.errors import EnvironmentFault, InputError, OutputError
from kinematify.versions import not_installed, package_versions

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence

    from matplotlib.figure import Figure

_PACKAGE = Path(__file__).resolve().parents[1]
NOT_INFERRING = (
    "batch", "cli", "configs", "envs", "generate", "manipulation", "refinement", "simulation", "validation", "view",
    "vision", "evaluation/nightly", "evaluation/result_record.py", "evaluation/run_benchmark.py",
    "evaluation/benchmark_summary.py",
)  # fmt: skip
"""What neither infers nor scores; configurations count by their values."""


def code_version(*, without: tuple[str, ...] = (), module: str = "") -> str:
    """Hash of the package's sources and settings: results of other code are not taken up.

    Args:
        without: Files and folders of the package, ``/`` between names, that a result does not depend on.
        module: Of another package whose sources count too.
    """
    digest = hashlib.sha256()
    origin = importlib.util.find_spec(module.partition(".")[0]) if module else None
    folders = [_PACKAGE, *(origin.submodule_search_locations or () if origin is not None else ())]
    # `validation`, `envs` and `configs` stand behind links.
    paths = (
        (Path(root, file), Path(root, file).relative_to(top).as_posix())
        for top in folders
        for root, _, files in os.walk(top, followlinks=True)
        for file in files
    )
    for path, place in sorted((path, place) for path, place in paths if path.suffix in (".py", ".yaml")):
        if not any(place == left or place.startswith(f"{left}/") for left in without):
            digest.update(place.encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def git_commit() -> tuple[str, bool]:
    """Return the commit of the sources and whether they differ from it; the version where there is no checkout."""
    commit = _git("rev-parse", "--short=7", "HEAD")
    if not (_PACKAGE.parent / ".git").exists() or not commit:
        return f"v{__version__}", False
    return commit, bool(_git("status", "--porcelain", "--untracked-files=no"))


def _git(*words: str) -> str:
    try:
        done = subprocess.run(
            ["git", "-C", str(_PACKAGE.parent), *words], capture_output=True, text=True, timeout=30, check=True
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout.strip()


SCHEMA = 2
_PACKAGES = ("kinematify", "numpy", "scipy", "torch", "trimesh", "libigl", "python-fcl", "mujoco", "pybullet", "pin")

_Record = TypeVar("_Record")
_Item = TypeVar("_Item")
_Key = TypeVar("_Key", bound="Hashable")


@dataclass(frozen=True, kw_only=True)
class Header:
    """Origin of the records: command, versions, time."""

    study: str
    """``bench``, or the name of a study."""
    command: str
    """As a user types it."""
    date: str
    """ISO."""
    commit: str
    """Of the sources; the version where there is no checkout."""
    code: str
    """Hash of the sources that the records depend on, 12 characters."""
    seeds: tuple[int, ...]
    configuration: dict[str, Any]
    """What was asked for."""
    machine: dict[str, Any]
    """``processor``, and ``workers``: processes at a time."""
    versions: dict[str, str]
    """Of Python and of packages."""
    note: str = ""
    """What a reader must know of records that were not made as the command says."""


@dataclass(frozen=True, kw_only=True)
class Report(Generic[_Record]):
    """Header and records of one run."""

    header: Header
    records: tuple[_Record, ...]
    summary: dict[str, Any] = field(default_factory=dict)
    """What was counted over the records."""
    files: tuple[Path, ...] = ()
    """That it was written to."""
    regressions: tuple[str, ...] = ()
    """What is worse than in an earlier one, a sentence each."""


def new_header(
    study: str, *, workers: int, seeds: Iterable[int], configuration: Mapping[str, Any], code: str | None = None
) -> Header:
    """Return the header of a run of this process.

    Args:
        study: Name.
        workers: Processes at a time.
        seeds: That were drawn from.
        configuration: What was asked for.
        code: Hash of the sources that the records depend on; of all if None.
    """
    program = Path(sys.argv[0]).name
    commit, changed = git_commit()
    return Header(
        study=study,
        command=shlex.join(["kinematify" if program == "__main__.py" else program, *sys.argv[1:]]),
        date=datetime.datetime.now(tz=datetime.UTC).date().isoformat(),
        commit=f"{commit} with changes" if changed else commit,
        code=(code or code_version())[:12],
        seeds=tuple(sorted(set(seeds))),
        configuration=dict(configuration),
        machine={"processor": processor(), "workers": workers},
        versions={"python": platform.python_version(), **package_versions(_PACKAGES)},
    )


def processor() -> str:
    """Count and model of the processors."""
    model = platform.processor() or platform.machine()
    facts = Path("/proc/cpuinfo")
    if facts.is_file():
        lines = facts.read_text(encoding="utf-8").splitlines()
        model = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), model)
    return f"{os.cpu_count()} x {model}"


def as_json(report: Report[_Record], adapter: TypeAdapter[tuple[_Record, ...]]) -> dict[str, Any]:
    """Return the report as plain JSON values."""
    return {
        "schema": SCHEMA,
        **asdict(report.header),
        "summary": report.summary,
        "records": adapter.dump_python(report.records, mode="json"),
    }


def load_report(path: Path, adapter: TypeAdapter[tuple[_Record, ...]]) -> Report[_Record]:
    """Read a report that `write_report` has written.

    Raises:
        InputError: The file does not exist or is not such a report.
    """
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
        if values["schema"] != SCHEMA:
            raise InputError(
                f"The benchmark report {path} has schema {values['schema']}, this version reads {SCHEMA}. Run the "
                "benchmark again to get a new one."
            )
        records = adapter.validate_python(values["records"])
        header = TypeAdapter(Header).validate_python({name: values.get(name, "") for name in Header.__annotations__})
        return Report(header=header, records=records, summary=values["summary"])
    except (OSError, ValueError, KeyError, TypeError, AttributeError, ValidationError) as error:
        raise InputError(
            f"{path} is not a benchmark report: {error}. Give a JSON file that `kinematify bench` has written."
        ) from error


def write_report(
    report: Report[_Record],
    adapter: TypeAdapter[tuple[_Record, ...]],
    blocks: Iterable[str],
    folder: Path,
    *,
    name: str,
    title: str,
    plot: Callable[[], Figure] | None = None,
) -> tuple[Path, ...]:
    """Write ``<name>.md``, ``<name>.json`` and, of a report that has a plot, ``<name>.png``; return their paths.

    Args:
        report: What a run gave.
        adapter: Of its records.
        blocks: Paragraphs, headings and tables of the Markdown.
        folder: Made if need be; earlier files of the same name are replaced.
        name: File stem.
        title: Heading.
        plot: Draws the picture.

    Raises:
        EnvironmentFault: matplotlib is not installed, and there is a plot.
        OutputError: The folder cannot be written.
    """
    picture = [f"![{title}]({name}.png)"] if plot is not None else []
    texts = {
        ".md": document(report.header, title, [*blocks, *picture]),
        ".json": json.dumps(as_json(report, adapter), indent=1) + "\n",
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for suffix, text in texts.items():
            replace_text(folder / f"{name}{suffix}", text)
        if plot is not None:
            plot().savefig(folder / f"{name}.png", dpi=120)
    except ImportError as error:
        raise EnvironmentFault(not_installed("Markdown and JSON are written; the plot", "matplotlib")) from error
    except OSError as error:
        raise OutputError(
            f"The report cannot be written to {folder}: {error}. Give a folder that can be written."
        ) from error
    return tuple(folder / f"{name}{suffix}" for suffix in (*texts, *([".png"] if plot is not None else [])))


def document(header: Header, title: str, blocks: Iterable[str]) -> str:
    """Return a Markdown document with the command at its top."""
    versions = ", ".join(f"{'Python' if name == 'python' else name} {at}" for name, at in header.versions.items())
    asked = "; ".join(
        f"{name} {_words(value)}" for name, value in header.configuration.items() if value not in (None, "")
    )
    facts = [
        f"- command: `{header.command}`",
        f"- date: {header.date}, commit {header.commit}" + (f", code {header.code}" if header.code else ""),
        *([f"- {asked}; seeds {_words(header.seeds)}"] if asked else []),
        *([f"- machine: {header.machine['processor']}, {header.machine['workers']} workers"] if header.machine else []),
        *([f"- {versions}"] if versions else []),
        *([f"- {header.note}"] if header.note else []),
    ]
    return "\n\n".join([f"# {title}", "\n".join(facts), *(block for block in blocks if block)]) + "\n"


def _words(value: Any) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list | tuple) else str(value)


def table(titles: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table; what a cell holds cannot break it."""
    cells = [list(titles), ["---"] * len(titles)]
    cells += [[cell.replace("|", "\\|").replace("\n", " ") for cell in row] for row in rows]
    return "\n".join(f"| {' | '.join(row)} |" for row in cells)


def grouped(items: Iterable[_Item], *, by: Callable[[_Item], _Key]) -> dict[_Key, list[_Item]]:
    """Return items by key, in order of appearance."""
    groups: dict[_Key, list[_Item]] = {}
    for item in items:
        groups.setdefault(by(item), []).append(item)
    return groups


def number(value: float | None, digits: int, scale: float = 1.0) -> str:
    """Return a number as tables show it, a dash for none."""
    return "-" if value is None else f"{value * scale:.{digits}f}"


def replace_text(path: Path, text: str) -> None:
    """Write aside, then rename: a reader never sees half a file."""
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    aside.write_text(text, encoding="utf-8")
    aside.replace(path)
