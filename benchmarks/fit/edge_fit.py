"""`python -m benchmarks.fit.edge_fit FOLDERS -o OUT`: the edges of the tree and its base link, fitted and judged.

Edges are fitted to families, chains, and those of FOLDERS that their licence allows; the base link also to one object
of every kind of the library that a function draws. Each set is judged three times: fitted to, by a fit that has nothing
of it, and by two of which each has half of it. Of a kind of the library there is one object, so that halves are halves
of the kinds.
"""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from benchmarks.fit.corpora import GENERATED, gather_trees, real_sources, tree_sources
from benchmarks.fit.edges import fit_base, fit_edges, missed_edges, write_weights, wrong_bases
from kinematify.cli.progress import progress_reporter
from kinematify.errors import EnvironmentFault
from kinematify.evaluation.result_record import table
from kinematify.joints.choice.edges import EDGE_WEIGHTS, MEASUREMENTS, shipped_weights
from kinematify.topology.base_link import BASE_WEIGHTS, COLUMNS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from benchmarks.fit.edges import TreeExample
    from kinematify.joints.choice.edges import LinearWeights

_SEED = 0
"""Draws the generated objects."""


@click.command()
@click.argument("folders", nargs=-1, type=click.Path(path_type=Path))
@click.option("-o", "--out", type=click.Path(path_type=Path), required=True)
def command(folders: tuple[Path, ...], out: Path) -> None:
    """Write `OUT/base.json` and `OUT/edges.json`, and print what they get wrong of each set.

    That is how many objects have another base link where the tree is the true one, and how many edges the likeliest
    trees lack, whatever their root. Objects that were measured by an earlier run are read from `OUT/trees`.
    """
    sources = tree_sources() + [source for folder in folders for source in real_sources(folder)]
    with progress_reporter() as progress:
        trees = gather_trees(sources, out / "trees", seed=_SEED, workers=1, progress=progress)
    touching = [tree for tree in trees if len(tree.pairs)]
    for counted, some, fit, wrong, file, columns in (
        ("wrong base links", trees, fit_base, wrong_bases, BASE_WEIGHTS, COLUMNS),
        ("edges missed", touching, fit_edges, missed_edges, EDGE_WEIGHTS, MEASUREMENTS),
    ):
        _fit_one(counted, out / file, some, fit, wrong, columns=columns)


def _fit_one(
    counted: str,
    path: Path,
    trees: Sequence[TreeExample],
    fit: Callable[[Sequence[TreeExample], Mapping[str, Any]], LinearWeights],
    wrong: Callable[[Sequence[TreeExample], LinearWeights], int],
    *,
    columns: tuple[str, ...],
) -> None:
    """Write the weights that a fit finds, and print its table and what is wrong, held out where it can be."""
    fitted = [tree for tree in trees if tree.fits]
    facts = {
        "seed": _SEED,
        "date": datetime.now(UTC).date().isoformat(),
        "generated": Counter(tree.origin for tree in fitted if tree.origin in GENERATED),
        "real": sorted(f"{tree.origin}/{tree.object}" for tree in fitted if tree.origin not in GENERATED),
    }
    before = None
    with suppress(EnvironmentFault):
        before = shipped_weights(path.name, columns)
    weights = fit(fitted, facts)
    write_weights(weights, columns, path)
    rows, names = [], []
    for group in dict.fromkeys((tree.origin, tree.fits) for tree in trees):
        some = [tree for tree in trees if (tree.origin, tree.fits) == group]
        found = [wrong(some, each) if each else "other columns" for each in (before, weights)]
        judged = [(some, weights)]
        if group[1]:
            others = [tree for tree in fitted if tree.origin != group[0]]
            found.append(wrong(some, fit(others, {})))
            halves = some[::2], some[1::2]
            judged = [(one, fit([*others, *two], {})) for one, two in (halves, halves[::-1])]
            found.append(sum(wrong(*item) for item in judged))
        name = f"{group[0]}, {'fitted to' if group[1] else 'never fitted to'}"
        names.append(f"{name}: {' '.join(tree.object for one, by in judged for tree in one if wrong([tree], by))}")
        edges = sum(len(tree.parents) - 1 for tree in some)
        rows.append((name, f"{len(some)}", f"{edges}", *map(str, found), *[""] * (4 - len(found))))
    titles = ("set", "objects", "edges", f"{counted} before", "these", "without the set", "without a half")
    click.echo("\n".join([table(titles, rows), "Wrong are:", *names]))


if __name__ == "__main__":
    command()
