"""`python -m benchmarks.confidence REPORT...`: how far the confidence of joints is from the share that is right."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
import numpy as np

from kinematify.cli.options import examples
from kinematify.evaluation.result_record import load_report, number, table
from kinematify.evaluation.run_benchmark import RESULTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from kinematify.evaluation.metrics import JointScore

_FIFTHS = 5


def confidence_table(sets: Mapping[str, Iterable[JointScore]]) -> str:
    """A row for each set and one for all of them together: mean confidence and share right by fifths, and the error.

    Right: parent, type and axis. The error is the mean over the fifths, least sure first, of the distance between mean
    confidence and share right. Joints whose part is the root of what was inferred have no confidence.

    Args:
        sets: Joints against the truth, by the name of the row.
    """
    of_sets = {name: [joint for joint in joints if joint.confidence is not None] for name, joints in sets.items()}
    rows = of_sets | {"together": [joint for joints in of_sets.values() for joint in joints]}
    titles = ["", "joints", *["confidence (right) of the least sure fifth", "2nd", "3rd", "4th", "surest"], "error"]
    return table(titles, [_row(name, joints) for name, joints in rows.items() if len(joints) >= _FIFTHS])


def _row(name: str, joints: list[JointScore]) -> tuple[str, ...]:
    sure = np.array([joint.confidence for joint in joints], dtype=float)
    right = np.array([joint.axis_right for joint in joints], dtype=float)
    fifths = np.array_split(np.argsort(sure, kind="stable"), _FIFTHS)
    means = [(float(sure[rows].mean()), float(right[rows].mean())) for rows in fifths]
    error = float(np.mean([abs(said - share) for said, share in means]))
    return (
        name,
        str(len(joints)),
        *(f"{number(said, 2)} ({number(share, 2)})" for said, share in means),
        f"{error:.3f}",
    )


@click.command(epilog=examples("python -m benchmarks.confidence results/kitchen.json results/kinart.json"))
@click.argument("reports", nargs=-1, required=True, type=click.Path(path_type=Path))
def command(reports: tuple[Path, ...]) -> None:
    """Print how right the confidence is in the JSON REPORTS of `kinematify bench`, each and together."""
    records = {path.stem: load_report(path, RESULTS).records for path in reports}
    click.echo(
        confidence_table(
            {name: [joint for run in runs if run.score for joint in run.score.joints] for name, runs in records.items()}
        )
    )


if __name__ == "__main__":
    command(prog_name="python -m benchmarks.confidence")
