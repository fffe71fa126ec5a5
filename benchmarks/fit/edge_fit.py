"""`python -m benchmarks.fit.edge_fit FOLDERS -o OUT`: the edges of the tree, fitted and judged.

Fitted to families, chains, and those of FOLDERS that their licence allows. Each set is judged three times: fitted to,
by a fit that has nothing of it, and by two of which each has half of it.
"""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import click

from benchmarks.fit.corpora import GENERATED, gather_trees, real_sources, tree_sources
from benchmarks.fit.edges import fit_edges, missed_edges, write_edge_weights
from kinematify.cli.progress import progress_reporter
from kinematify.evaluation.result_record import table
from kinematify.joints.choice.edges import EDGE_WEIGHTS, shipped_edge_weights


@click.command()
@click.argument("folders", nargs=-1, type=click.Path(path_type=Path))
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True)
def command(folders: tuple[Path, ...], out: Path) -> None:
    """Write `OUT/edges.json` and print how many edges of each set the likeliest trees lack, whatever their root."""
    sources = tree_sources() + [source for folder in folders for source in real_sources(folder)]
    with progress_reporter() as progress:
        trees = gather_trees(sources, out / "trees", seed=0, workers=1, progress=progress)
    fitted = [tree for tree in trees if tree.fits]
    facts = {
        "date": datetime.now(UTC).date().isoformat(),
        "real": sorted(f"{tree.origin}/{tree.object}" for tree in fitted if tree.origin not in GENERATED),
    }
    weights = fit_edges(fitted, facts)
    write_edge_weights(weights, out / EDGE_WEIGHTS)
    rows = []
    for group in dict.fromkeys((tree.origin, tree.fits) for tree in trees):
        some = [tree for tree in trees if (tree.origin, tree.fits) == group]
        missed = [missed_edges(some, each) for each in (shipped_edge_weights(), weights)]
        if group[1]:
            others = [tree for tree in fitted if tree.origin != group[0]]
            missed.append(missed_edges(some, fit_edges(others, {})))
            halves = some[::2], some[1::2]
            by_halves = [missed_edges(one, fit_edges([*others, *two], {})) for one, two in (halves, halves[::-1])]
            missed.append(sum(by_halves))
        name = f"{group[0]}, {'fitted to' if group[1] else 'never fitted to'}"
        edges = sum(len(tree.parents) - 1 for tree in some)
        rows.append((name, f"{len(some)}", f"{edges}", *map(str, missed), *[""] * (4 - len(missed))))
    click.echo(table(("set", "objects", "edges", "missed before", "these", "without the set", "without a half"), rows))


if __name__ == "__main__":
    command()
