"""What the fitted choice is worth on what it was not fitted to, beside what it was, and beside the weighted cues."""

from __future__ import annotations

import zlib
from dataclasses import asdict, dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.fit.categories import category_of
from benchmarks.fit.corpora import COMPOSED, DESCRIBED, FAMILY, GENERATED, PROGRAMMED
from benchmarks.fit.examples import content_key
from benchmarks.fit.trees import (
    Seeds,
    data_key,
    fit_opening,
    fit_rigidity,
    fit_scorer,
    fit_turning,
    is_fixed,
    recipe_key,
    rigidity_odds,
    turns_known,
    turns_of,
    write_scorer,
)
from kinematify.config import load_config
from kinematify.joints.choice.judge import Posterior, agreed
from kinematify.joints.choice.opening import opening_odds
from kinematify.joints.choice.scorer import read_scorer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from benchmarks.fit.examples import Example
    from kinematify.config import ConfidenceConfig
    from kinematify.joints.choice.scorer import Scorer
    from kinematify.robot.arrays import FloatArray

_FOLDS = 5
_ONE = Seeds()
_GENERATED_SETS = {
    FAMILY: "families",
    DESCRIBED: "objects that files describe: never fitted to",
    PROGRAMMED: "objects as people program them",
    COMPOSED: "random mechanisms",
}
_RIGHT_DEG = 5.0
_RIGHT = 0.2
"""A hypothesis is right from here on: 5 deg off, or a sixteenth of the part beside the line."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """Figures over the joints of a set; each object weighs the same in those that say so."""

    joints: int
    types: float
    """Share of joints with the right type."""
    within: float
    """Share with the right type and an axis within 5 deg."""
    angle_deg: float
    """Mean over the joints; 90 where none is proposed."""
    within_per_object: float


def row_of(examples: Sequence[Example], picks: Sequence[int]) -> Row:
    """Figures of what was picked."""
    types = np.array([example.types_right[pick] for example, pick in zip(examples, picks, strict=True)], dtype=float)
    angles = np.array([example.angles[pick] for example, pick in zip(examples, picks, strict=True)])
    within = types * (angles < _RIGHT_DEG)
    by_object: dict[str, list[int]] = {}
    for k, example in enumerate(examples):
        by_object.setdefault(f"{example.origin}/{example.object}", []).append(k)
    groups = [np.array(rows) for rows in by_object.values()]
    return Row(
        joints=len(examples),
        types=float(types.mean()),
        within=float(within.mean()),
        angle_deg=float(angles.mean()),
        within_per_object=float(np.mean([within[rows].mean() for rows in groups])),
    )


def judge_left_out(
    examples: Sequence[Example], progress: Callable[[str, float], None], folder: Path | None
) -> dict[int, FloatArray]:
    """Probabilities of the hypotheses of every example by a fit that had nothing of its category.

    Categories fall into five folds; nothing of a fold is fitted to when it is evaluated. Fits are kept in `folder`.
    """
    found: dict[int, FloatArray] = {}
    folds = folds_of(examples)
    for fold in range(_FOLDS):
        progress(f"left out {fold + 1} of {_FOLDS}", fold / _FOLDS)
        judged = [k for k, at in enumerate(folds) if at == fold]
        if not judged:
            continue
        fitted = [example for example, at in zip(examples, folds, strict=True) if example.teaches and at != fold]
        scorer = kept_scorer(fitted, folder)
        found |= {k: _likely(scorer, examples[k]) for k in judged}
    return dict(enumerate(agreed_examples(examples, [found[k] for k in range(len(examples))])))


def judge_origins_held_out(
    examples: Sequence[Example], origins: Sequence[str], folder: Path | None
) -> dict[int, FloatArray]:
    """Probabilities for the examples of these corpora, by one fit that has nothing of any of them."""
    index = [k for k, example in enumerate(examples) if example.origin in origins]
    if not index:
        return {}
    scorer = kept_scorer([item for item in examples if item.teaches and item.origin not in origins], folder)
    some = [examples[k] for k in index]
    return dict(zip(index, agreed_examples(some, [_likely(scorer, item) for item in some]), strict=True))


def kept_scorer(fitted: Sequence[Example], folder: Path | None, seeds: Seeds = _ONE) -> Scorer:
    """A fit of `seeds`; read from `folder` where an interrupted run has made it of the same data."""
    if folder is None:
        return fit_scorer(fitted, seeds=seeds, provenance={})
    recipe = recipe_key(list({name for example in fitted for name in example.measured}))
    path = folder / f"{content_key(data_key(fitted), recipe, asdict(seeds))}.npz"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        aside = path.with_suffix(".part.npz")
        write_scorer(fit_scorer(fitted, seeds=seeds, provenance={}), aside)
        aside.replace(path)
    return read_scorer(path)


def _likely(scorer: Scorer, example: Example) -> FloatArray:
    """What the scorer says of the hypotheses of an edge, shape (h,)."""
    return scorer.probabilities(example.hypotheses, example.measured, example.cloud)


def agreed_examples(examples: Sequence[Example], likely: Sequence[FloatArray]) -> list[FloatArray]:
    """Probabilities after edges that are alike have agreed on a type, as the inference has it."""
    groups: dict[tuple[str, str, int], list[int]] = {}
    for k, example in enumerate(examples):
        groups.setdefault((example.origin, example.object, example.alike), []).append(k)
    found = list(likely)
    for rows in groups.values():
        for k, given in zip(rows, agreed([examples[k].kinds for k in rows], [likely[k] for k in rows]), strict=True):
            found[k] = given
    return found


@dataclass(frozen=True, kw_only=True)
class AnswersRow:
    """How well a question about the parts of a set is answered, held out by category."""

    yes: int
    found: float | None
    """Share of those for which it is yes that are taken for such."""
    no: int
    lost: float | None
    """Share of the others that are taken for such."""


def judge_rigidity_left_out(examples: Sequence[Example]) -> dict[str, AnswersRow]:
    """What is fixed, by trees whose fit had nothing of the category; by set."""
    fixed = load_config().joints.confidence.fixed
    return _answered(examples, fit_rigidity, rigidity_odds, is_fixed, float(np.log(fixed / (1.0 - fixed))))


def judge_turning_left_out(examples: Sequence[Example]) -> dict[str, AnswersRow]:
    """What goes round, by trees whose fit had nothing of the category; by set. Links in series are apart."""
    turning = [example for example in examples if turns_known(example)]

    def odds(scorer: Scorer, some: Sequence[Example]) -> FloatArray:
        return scorer.sums(turns_of(some, scorer.measurements))

    return _answered(turning, fit_turning, odds, lambda example: bool(example.is_continuous), 0.0)


def _answered(
    examples: Sequence[Example],
    fit: Callable[..., Scorer],
    odds_of: Callable[[Scorer, Sequence[Example]], FloatArray],
    answer: Callable[[Example], bool],
    least: float,
) -> dict[str, AnswersRow]:
    """Fit and ask by folds; what has more than the least log odds is taken for a yes."""
    odds = np.zeros(len(examples))
    for fitted, judged in _folds(examples):
        odds[judged] = odds_of(fit(fitted, seeds=(0,), provenance={}), [examples[k] for k in judged])
    taken, yes = odds > least, np.array([answer(example) for example in examples], dtype=bool)
    return {
        name: AnswersRow(
            yes=int(yes[index].sum()),
            found=_share(taken[index][yes[index]]),
            no=int((~yes[index]).sum()),
            lost=_share(taken[index][~yes[index]]),
        )
        for name, index in sets_of(examples).items()
    }


def judge_opening_left_out(examples: Sequence[Example]) -> dict[str, AnswersRow]:
    """Which way turns open, by trees whose fit had nothing of the category; by set."""

    def odds(scorer: Scorer, some: Sequence[Example]) -> FloatArray:
        return np.array([opening_odds(scorer, example.sides) for example in some])

    return _answered([example for example in examples if example.sides], fit_opening, odds, lambda _: True, 0.0)


def _folds(examples: Sequence[Example]) -> Iterator[tuple[list[Example], list[int]]]:
    """Of every fold, what is fitted to and the indices of what is judged."""
    folds = np.array(folds_of(examples))
    for fold in sorted(set(folds.tolist())):
        fitted = [example for example, at in zip(examples, folds, strict=True) if example.teaches and at != fold]
        yield fitted, np.flatnonzero(folds == fold).tolist()


def _share(taken: NDArray[np.bool_]) -> float | None:
    return float(taken.mean()) if len(taken) else None


def folds_of(examples: Sequence[Example]) -> list[int]:
    """The fold of each example: by the name of its category alone, so that a new category moves no other."""
    return [zlib.crc32(category_of(example).encode()) % _FOLDS for example in examples]


def judgement_of(example: Example, probabilities: FloatArray) -> Posterior:
    """What the inference would make of these probabilities, shape (h,)."""
    return Posterior(
        hypotheses=example.hypotheses,
        prior=probabilities,
        by_cues=example.by_cues,
        support=example.measured["rules_score"],
        size=example.size,
        prior_log_odds=_confidence().cues_lead,
    )


def picked(example: Example, probabilities: FloatArray) -> int:
    """What the inference would choose with these probabilities, shape (h,)."""
    return judgement_of(example, probabilities).best


@cache
def _confidence() -> ConfidenceConfig:
    """As the inference has it; read once, since tables ask for it thousands of times."""
    return load_config().joints.confidence


CAUSES = ("none proposed", "wrong type", "wrong direction", "line beside")


def cause_of(example: Example, pick: int) -> str | None:
    """Why what was picked is wrong, one of `CAUSES`; None where it is right."""
    if example.right[pick] >= _RIGHT:
        return None
    if example.right.max() < _RIGHT:
        return CAUSES[0]
    if not example.types_right[pick]:
        return CAUSES[1]
    return CAUSES[2] if example.angles[pick] >= _RIGHT_DEG else CAUSES[3]


def calibration_of(examples: Sequence[Example], likely: Sequence[FloatArray]) -> dict[str, Any]:
    """Mean confidence and share right of each fifth of the joints, least sure first, and what follows from them."""
    judged = [judgement_of(*pair) for pair in zip(examples, likely, strict=True)]
    sure = np.array([item.confidence for item in judged])
    row = [e.types_right[j.best] and e.angles[j.best] < _RIGHT_DEG for e, j in zip(examples, judged, strict=True)]
    right = np.array(row, dtype=float)
    fifths = np.array_split(np.argsort(sure, kind="stable"), 5)
    confidence, share = ([float(values[rows].mean()) for rows in fifths] for values in (sure, right))
    wrong = 1.0 - right
    return {
        "confidence": confidence,
        "right": share,
        "error": float(np.mean(np.abs(np.subtract(confidence, share)))),
        "errors_in_least_sure": float(wrong[fifths[0]].sum() / max(wrong.sum(), 1.0)),
    }


def sets_of(examples: Sequence[Example]) -> dict[str, list[int]]:
    """Name of each set that has a row of its own -> positions of its examples."""
    found: dict[str, list[int]] = {}
    for k, example in enumerate(examples):
        name = _GENERATED_SETS.get(example.origin, example.origin)
        if example.origin not in GENERATED:
            name += ", fitted to" if example.fits else ", for research only: never fitted to"
        found.setdefault(name, []).append(k)
    return found
