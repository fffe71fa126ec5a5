"""Benchmark reports on disk: Markdown for people, JSON for the comparison with a later run."""

from __future__ import annotations

import json
import os
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, ValidationError

from kinematify.errors import InputError, OutputError
from kinematify.evaluation.job import JobResult
from kinematify.evaluation.run import BenchmarkReport
from kinematify.evaluation.summary import summarise, summarise_types
from kinematify.evaluation.tables import markdown

if TYPE_CHECKING:
    from collections.abc import Sequence

SCHEMA = 1
_RESULTS = TypeAdapter(tuple[JobResult, ...])


def write_report(
    report: BenchmarkReport, folder: Path, *, name: str = "bench", baseline: BenchmarkReport | None = None
) -> tuple[Path, Path]:
    """Write ``<name>.md`` and ``<name>.json`` into a folder and return their paths.

    Args:
        report: What `run_benchmark` returned.
        folder: Made if need be; earlier files of the same name are replaced.
        name: File stem and title.
        baseline: An earlier report; adds a table of what has changed.

    Raises:
        OutputError: The folder cannot be written.
    """
    texts = {".md": markdown(report, name, baseline), ".json": json.dumps(as_json(report), indent=1) + "\n"}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for suffix, text in texts.items():
            _replace(folder / f"{name}{suffix}", text)
    except OSError as error:
        raise OutputError(
            f"The report cannot be written to {folder}: {error}. Give a folder that can be written."
        ) from error
    return folder / f"{name}.md", folder / f"{name}.json"


def as_json(report: BenchmarkReport) -> dict[str, Any]:
    """Return the report as plain JSON values: header, means per configuration and kind, every run."""
    return {
        "schema": SCHEMA,
        "header": report.header,
        "summaries": _summaries(report),
        "results": _RESULTS.dump_python(report.results, mode="json"),
    }


def load_report(path: Path) -> BenchmarkReport:
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
        return BenchmarkReport(header=values["header"], results=_RESULTS.validate_python(values["results"]))
    except (OSError, ValueError, KeyError, TypeError, ValidationError) as error:
        raise InputError(
            f"{path} is not a benchmark report: {error}. Give a JSON file that `kinematify bench` has written."
        ) from error


def _summaries(report: BenchmarkReport) -> list[dict[str, Any]]:
    summaries = []
    for variant in report.header["variants"]:
        results = [result for result in report.results if result.variant == variant]
        for kind, given in dict.fromkeys((result.kind, result.input) for result in results):
            group = [result for result in results if (result.kind, result.input) == (kind, given)]
            summaries.append({"variant": variant, "kind": kind, "input": given, **_group_numbers(group)})
    return summaries


def _group_numbers(results: Sequence[JobResult]) -> dict[str, Any]:
    return {
        "with_gripper": asdict(summarise(results)),
        "without_gripper": asdict(summarise(results, with_gripper=False)),
        "types": [asdict(summary) for summary in summarise_types(results)],
    }


def _replace(path: Path, text: str) -> None:
    """Write aside, then rename: a reader never sees half a report."""
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    aside.write_text(text, encoding="utf-8")
    aside.replace(path)
