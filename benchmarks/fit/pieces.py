"""The fit of what groups pieces: which two are one part, and which sets of pieces are one moving part.

Objects with known parts are merged and split into connected pieces, as a mesh is that nobody segmented. Trees are
fitted in two steps: to pairs of neighbours, and to sets of pieces, which read what the first step says of pairs of
objects of other categories. `python -m benchmarks.fit.pieces -o OUT FOLDERS` writes the weights that ship, the
weights with categories held out, and a table of both.
"""

from __future__ import annotations

import datetime
import json
import pickle
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from benchmarks.fit.categories import ALIKE
from benchmarks.fit.corpora import GENERATED, CorpusSource, generated_sources, opened_object, real_sources
from benchmarks.fit.trees import boosted_logistic, trees_alone, write_scorer
from kinematify.assembly.part import Part
from kinematify.assembly.pieces import connected_sheets
from kinematify.config import load_config
from kinematify.evaluation.result_record import git_commit, grouped, table
from kinematify.grouping.groups import PieceWeights, odds_of, select
from kinematify.grouping.pair_measurements import MeasuredPieces, measure_pieces
from kinematify.grouping.piece_sets import Candidate, measure_candidates, propose
from kinematify.joints.choice.scorer import MOVING_WEIGHTS, PIECES_WEIGHTS, read_scorer
from kinematify.robot.raw_mesh import RawMesh
from kinematify.robot.weld import weld

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.config import GroupingConfig
    from kinematify.joints.choice.scorer import Scorer
    from kinematify.robot.arrays import BoolArray, FloatArray

_FOLDS = 5
_PURE = 0.9
"""Pieces of which less lies in one part teach nothing about pairs."""
_ENOUGH = 0.5
_MOST_PIECES, _PIECES_PER_PART = 200, 1.3
_SAME = {"learning_rate": 0.05, "num_leaves": 15, "min_data_in_leaf": 40, "feature_fraction": 0.3}
_MOVES = {
    **_SAME,
    "num_leaves": 7,
    "min_data_in_leaf": 30,
    "min_sum_hessian_in_leaf": 1e-3,
    "feature_fraction": 0.08,
    "bagging_fraction": 0.5,
    "lambda_l2": 30.0,
    "objective": "cross_entropy",
}
_SAME_ROUNDS, _MOVES_ROUNDS = 150, 250
_SEEDS = (0, 1, 2, 3)
"""Of the trees for sets of pieces, which are averaged."""
_GENERATED_SHARE = 0.5
"""Weight of a generated object beside a real one."""
_OF_NAME = {name: category for category, names in ALIKE.items() for name in names} | {
    "refrigerator": "fridge",
    "drawer": "drawer_cabinet",
    "trash": "trash_can",
}


def category_of_piece(category: str) -> str:
    """The word that real objects of the same kind carry."""
    return _OF_NAME.get(category, category)


@dataclass(frozen=True, kw_only=True, eq=False)
class PiecesExample:
    """One object, merged and split into pieces."""

    name: str
    origin: str
    category: str
    fits: bool
    measured: MeasuredPieces
    areas: FloatArray
    """Surface of every piece, shape (n,)."""
    triangles: FloatArray
    """Triangles that every piece has of every true part, shape (n, parts)."""
    moving: BoolArray
    """Parts that move, shape (parts,)."""

    @cached_property
    def pure(self) -> BoolArray:
        """Pairs of which both pieces are of one part each, shape (m,)."""
        share = self.triangles.max(axis=1) / self.triangles.sum(axis=1)
        return np.asarray((share[self.measured.pairs] > _PURE).all(axis=1))

    @cached_property
    def one(self) -> BoolArray:
        """Pairs that are of one part, shape (m,)."""
        part = self.triangles.argmax(axis=1)
        return np.asarray(part[self.measured.pairs[:, 0]] == part[self.measured.pairs[:, 1]])

    def overlaps(self, candidates: Sequence[Candidate]) -> FloatArray:
        """IoU of the triangles of sets of pieces with every moving part, shape (c, moving parts)."""
        member = np.zeros((len(candidates), len(self.areas)))
        for row, candidate in enumerate(candidates):
            member[row, list(candidate)] = 1.0
        common = member @ self.triangles
        union = (member @ self.triangles.sum(axis=1))[:, None] + self.triangles.sum(axis=0) - common
        return np.asarray((common / union)[:, self.moving])


def pieces_example(source: CorpusSource) -> PiecesExample | None:
    """Merge one object and measure its pieces; None where it cannot be read or has too few or too many pieces."""
    found = opened_object(source, 0)
    if found is None:
        return None
    starts = np.cumsum([0, *(len(part.vertices) for part in found.parts)])
    whole = RawMesh(
        name="whole",
        vertices=np.concatenate([part.vertices for part in found.parts]).astype(np.float32).astype(np.float64),
        faces=np.concatenate([part.faces + start for part, start in zip(found.parts, starts, strict=False)]),
    )
    tolerance = load_config().assembly.weld
    pieces = [Part(name=m.name, vertices=m.vertices, faces=m.faces) for m in connected_sheets(whole, tolerance)]
    # A generated object with a piece per part teaches that nothing is to be joined.
    least = _PIECES_PER_PART * len(found.parts) if source.origin in GENERATED else 2
    if not least <= len(pieces) <= _MOST_PIECES:
        return None
    return PiecesExample(
        name=source.name,
        origin=source.origin,
        category=category_of_piece(found.category),
        fits=found.fits or source.origin in GENERATED,
        measured=measure_pieces(pieces),
        areas=np.array([piece.area for piece in pieces]),
        triangles=_triangles(whole, pieces, [len(part.faces) for part in found.parts], tolerance),
        moving=np.array(found.truth.parents) >= 0,
    )


def _triangles(whole: RawMesh, pieces: Sequence[Part], counts: Sequence[int], tolerance: float) -> FloatArray:
    """Triangles that each piece has of each part; a piece keeps the order of the welded mesh."""
    vertices, faces, kept = weld(whole.vertices, whole.faces, tolerance)
    part = np.repeat(np.arange(len(counts)), counts)[kept]
    centres = {centre: row for row, centre in enumerate(map(tuple, vertices[faces].mean(axis=1)))}
    found = np.zeros((len(pieces), len(counts)))
    for row, piece in enumerate(pieces):
        of = [centres[centre] for centre in map(tuple, piece.vertices[piece.faces].mean(axis=1))]
        found[row] = np.bincount(part[of], minlength=len(counts))
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class _Proposed:
    """Sets of pieces of one object and what is measured of them."""

    candidates: list[Candidate]
    columns: FloatArray
    names: tuple[str, ...]
    overlaps: FloatArray


def fit_pairs(examples: Sequence[PiecesExample]) -> Scorer:
    """Fit which pairs of pieces are one part, to examples that may be fitted to."""
    used = [item for item in examples if item.fits and item.pure.any()]
    columns = np.concatenate([item.measured.columns[item.pure] for item in used]).astype(np.float32)
    one = np.concatenate([item.one[item.pure] for item in used])
    weights = _weights(used, [int(item.pure.sum()) for item in used])
    boosters = boosted_logistic(columns, one, weights, _SAME, seeds=(0,), rounds=_SAME_ROUNDS)
    return trees_alone(used[0].measured.names, boosters, _provenance(used))


def fit_moving(examples: Sequence[PiecesExample], proposed: Sequence[_Proposed]) -> Scorer:
    """Fit which sets of pieces are a moving part: the IoU with one, where it is above a half."""
    used = [(item, of) for item, of in zip(examples, proposed, strict=True) if item.fits and of.candidates]
    columns = np.concatenate([of.columns for _, of in used]).astype(np.float32)
    best = np.concatenate([of.overlaps.max(axis=1, initial=0.0) for _, of in used])
    right = np.where(best > _ENOUGH, best, 0.0)
    items = [item for item, _ in used]
    weights = _weights(items, [len(of.candidates) for _, of in used])
    boosters = boosted_logistic(columns, right, weights, _MOVES, seeds=_SEEDS, rounds=_MOVES_ROUNDS)
    return trees_alone(used[0][1].names, boosters, _provenance(items))


def _weights(examples: Sequence[PiecesExample], rows: Sequence[int]) -> FloatArray:
    """So that neither objects of many rows nor categories of many objects dominate, one for each row."""
    of_category = Counter((item.origin, item.category) for item in examples)
    weights = [
        (_GENERATED_SHARE if item.origin in GENERATED else 1.0)
        * count**-0.5
        * of_category[item.origin, item.category] ** -0.25
        for item, count in zip(examples, rows, strict=True)
    ]
    found = np.repeat(weights, rows)
    return np.asarray(found / found.mean())


def _provenance(examples: Sequence[PiecesExample]) -> dict[str, Any]:
    return {"objects": len(examples), "origins": dict(Counter(item.origin for item in examples))}


def _propose(example: PiecesExample, pairs: Scorer) -> _Proposed:
    measured = example.measured
    odds = odds_of(pairs, measured.columns, measured.names)
    candidates = propose(measured, odds)
    if not candidates:
        return _Proposed(candidates=[], columns=np.empty((0, 0)), names=(), overlaps=np.empty((0, 0)))
    columns, names = measure_candidates(measured, odds, example.areas, candidates)
    return _Proposed(candidates=candidates, columns=columns, names=names, overlaps=example.overlaps(candidates))


def fold_of(categories: Sequence[str]) -> dict[str, int]:
    """Fold in which each category is held out."""
    words = sorted(set(categories))
    np.random.default_rng(0).shuffle(words)
    return {word: number % _FOLDS for number, word in enumerate(words)}


class HeldOut:
    """Weights in which the categories of one fold are held out, read from a folder."""

    def __init__(self, folder: Path) -> None:
        """Open what `write_all` wrote."""
        self.folder = folder
        self.folds: dict[str, int] = json.loads((folder / "folds.json").read_text(encoding="utf-8"))

    def weights_of(self, category: str) -> PieceWeights:
        """The weights for objects of a category."""
        fold = self.folder / f"fold_{self.folds.get(category, 0)}"
        return PieceWeights(pairs=read_scorer(fold / PIECES_WEIGHTS), moving=read_scorer(fold / MOVING_WEIGHTS))


def write_all(examples: Sequence[PiecesExample], out: Path) -> list[str]:
    """Fit with each fold held out and to all; write the weights, and return the blocks of a report."""
    folds = fold_of([item.category for item in examples])
    out.mkdir(parents=True, exist_ok=True)
    (out / "folds.json").write_text(json.dumps(folds, indent=1) + "\n", encoding="utf-8")
    outside = [[item for item in examples if folds[item.category] != fold] for fold in range(_FOLDS)]
    pairs = [fit_pairs(group) for group in outside]
    proposed = [_propose(item, pairs[folds[item.category]]) for item in examples]
    likely: list[NDArray[Any]] = [np.empty(0)] * len(examples)
    for fold in range(_FOLDS):
        rows = [k for k, item in enumerate(examples) if folds[item.category] != fold]
        moving = fit_moving([examples[k] for k in rows], [proposed[k] for k in rows])
        for k, item in enumerate(examples):
            if folds[item.category] == fold:
                likely[k] = _likely(moving, proposed[k])
        _write(out / f"fold_{fold}", pairs[fold], moving)
    # What ships reads pairs as they were held out, as it will meet them.
    shipped = fit_moving(examples, proposed)
    _write(out, fit_pairs(examples), shipped)
    seen = [_likely(shipped, of) for of in proposed]
    config = load_config().grouping
    return [
        (
            "Moving parts among the sets of pieces that are chosen, before joints are inferred (IoU of triangles > .5):"
            " precision, recall and F1 with the category held out, F1 in-sample beside it."
        ),
        _table(examples, proposed, likely, seen, config),
    ]


def _likely(moving: Scorer, of: _Proposed) -> FloatArray:
    return 1.0 / (1.0 + np.exp(-odds_of(moving, of.columns, of.names))) if of.candidates else np.empty(0)


def _write(folder: Path, pairs: Scorer, moving: Scorer) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    write_scorer(pairs, folder / PIECES_WEIGHTS)
    write_scorer(moving, folder / MOVING_WEIGHTS)


def _table(
    examples: Sequence[PiecesExample],
    proposed: Sequence[_Proposed],
    likely: Sequence[FloatArray],
    seen: Sequence[FloatArray],
    config: GroupingConfig,
) -> str:
    rows = list(zip(examples, proposed, likely, seen, strict=True))
    sets = {**grouped(rows, by=lambda row: row[0].origin + ("" if row[0].fits else ", never fitted to")), "all": rows}
    lines = []
    for name, group in sets.items():
        held_out = np.sum([_found(item, of, unseen, config) for item, of, unseen, _ in group], axis=0)
        in_sample = np.sum([_found(item, of, fitted, config) for item, of, _, fitted in group], axis=0)
        true, chosen, hit = held_out
        lines.append(
            (
                name, str(len(group)), str(int(true)), str(int(chosen)), f"{hit / max(chosen, 1):.2f}",
                f"{hit / max(true, 1):.2f}", f"{2 * hit / (true + chosen):.2f}",
                f"{2 * in_sample[2] / (in_sample[0] + in_sample[1]):.2f}",
            )
        )  # fmt: skip
    return table(("set", "objects", "move", "chosen", "precision", "recall", "F1", "F1 in-sample"), lines)


def _found(item: PiecesExample, of: _Proposed, likely: FloatArray, config: GroupingConfig) -> tuple[int, int, int]:
    """Parts that move, sets that are chosen, and parts that one of these matches."""
    moving = int(item.moving.sum())
    chosen = select(of.candidates, likely, config)[0] if of.candidates else []
    hit = int((of.overlaps[chosen].max(axis=0) > _ENOUGH).sum()) if chosen and moving else 0
    return moving, len(chosen), hit


def _kept_example(source: CorpusSource, cache: Path | None) -> PiecesExample | None:
    """The example of an object, measured once where there is a cache; an emptied folder measures again."""
    if cache is None:
        return pieces_example(source)
    path = cache / f"{source.origin}__{source.name}__{source.number}.pkl"
    if path.exists():
        kept: PiecesExample | None = pickle.loads(path.read_bytes())
        return kept
    cache.mkdir(parents=True, exist_ok=True)
    example = pieces_example(source)
    path.write_bytes(pickle.dumps(example))
    return example


def _some(sources: Sequence[CorpusSource], most: int) -> list[CorpusSource]:
    places = np.linspace(0, len(sources) - 1, min(most, len(sources))).round().astype(int)
    return [sources[k] for k in places]


@click.command()
@click.argument("folders", nargs=-1, type=click.Path(path_type=Path, exists=True))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), help="Folder for weights and table.")
@click.option("--rounds", type=int, default=1, help="Objects of every family, recipe and blueprint.")
@click.option("--most", type=int, default=90, help="Objects of a folder; of more, evenly drawn ones.")
@click.option("--cache", type=click.Path(path_type=Path), help="Folder that keeps what was measured of each object.")
def main(folders: tuple[Path, ...], out: Path, rounds: int, most: int, cache: Path | None) -> None:
    """Fit to FOLDERS of objects and to generated ones."""
    real = [source for folder in folders for source in _some(real_sources(folder), most)]
    sources = [*real, *generated_sources(rounds, 0)]
    examples = [example for source in sources if (example := _kept_example(source, cache)) is not None]
    blocks = write_all(examples, out)
    today = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    made = f"- date: {today}, commit {git_commit()[0]}, {len(examples)} objects"
    text = "\n\n".join(["# Which pieces are one moving part", made, *blocks]) + "\n"
    (out / "grouping.md").write_text(text, encoding="utf-8")
    click.echo(text)


if __name__ == "__main__":
    main()
