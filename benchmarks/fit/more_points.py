"""`python -m benchmarks.fit.more_points FOLDERS -o OUT`: networks of points beside those that ship, fitted to more.

What they are fitted to is measured as by `python -m benchmarks.fit`; what is in `OUT/measured` is not measured again.
"""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import click
import numpy as np

from benchmarks.fit.corpora import DESCRIBED, gather_examples, generated_sources, real_sources
from benchmarks.fit.point_network import fit_points
from benchmarks.fit.trees import data_key, edge_weights, write_scorer
from kinematify.cli.progress import progress_reporter
from kinematify.evaluation.result_record import git_commit
from kinematify.joints.choice.point_network import PointNetwork
from kinematify.joints.choice.scorer import WEIGHTS, shipped_scorer

_SEEDS = (2, 3)


@click.command()
@click.argument("folders", nargs=-1, type=click.Path(path_type=Path))
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True)
def command(folders: tuple[Path, ...], out: Path) -> None:
    """Fit to FOLDERS and the library, and write `OUT/weights.npz`: the weights that ship with two networks more."""
    sources = [source for source in generated_sources(1, 80) if source.origin != DESCRIBED]
    sources += [source for folder in folders for source in real_sources(folder)]
    with progress_reporter() as progress:
        measured = gather_examples(sources, out / "measured", seed=0, workers=1, progress=progress)
    fitted = [example for example in measured if example.teaches and example.right.sum() > 1e-3]
    shipped, more = shipped_scorer(), vars(fit_points(fitted, edge_weights(fitted), seeds=_SEEDS))
    points = {name: np.concatenate([layer, more[name]]) for name, layer in vars(shipped.points).items()}
    facts = {
        "date": datetime.now(UTC).date().isoformat(),
        "commit": git_commit()[0],
        "objects": sorted({f"{example.origin}/{example.object}" for example in fitted}),
        "joints": len(fitted),
        "data": data_key(fitted),
    }
    provenance = {**shipped.provenance, "more_points": facts}
    write_scorer(replace(shipped, points=PointNetwork(**points), provenance=provenance), out / WEIGHTS)


if __name__ == "__main__":
    command()
