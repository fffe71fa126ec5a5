"""`kinematify bench --refine`: what simulation and choosing again are worth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from kinematify.cli.answer import write_answer
from kinematify.cli.progress import progress_reporter
from kinematify.cli.refine import TIERS
from kinematify.cli.table import format_table
from kinematify.cli.words import words_of

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.evaluation.run import BenchmarkRequest


def measure_refinement(
    request: BenchmarkRequest, *, tiers: str, perturb: str, out: Path, name: str, json_to: str | None
) -> None:
    """Run the ablation of the refinement, write its report and print its table.

    Raises:
        InputError: There is no such data, object or condition.
        OutputError: The work folder or the report cannot be written.
    """
    from kinematify.evaluation.perturb import CLEAN, PERTURBATIONS
    from kinematify.evaluation.refining import run_refining_benchmark
    from kinematify.evaluation.refining_report import TIER_HEADINGS, harmed, tier_rows, write_refining_report
    from kinematify.evaluation.run import header_of

    wanted = words_of(tiers, TIERS, "--tiers")
    inputs = (CLEAN,) if perturb == "none" else (CLEAN, *words_of(perturb, PERTURBATIONS, "--perturb"))
    with progress_reporter() as progress:
        results = run_refining_benchmark(request, tiers=wanted, perturbations=inputs, progress=progress)
    header = header_of(request, results)
    paths = write_refining_report(results, header, out, name=name)
    rows = harmed(results)
    if json_to:
        write_answer({"schema": 1, "header": header, "rows": [list(row) for row in tier_rows(results)]}, json_to)
    if json_to != "-":
        click.echo(format_table(TIER_HEADINGS, tier_rows(results)))
        worse = "; ".join(f"{row[0]} ({row[1]}, {row[2]}): {row[3]}" for row in rows)
        click.echo(f"\nHarm: {worse or 'none'}.\n\nReport: {paths[0]} and {paths[1]}")
