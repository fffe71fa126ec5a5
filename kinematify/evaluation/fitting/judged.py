"""What the fitted choice is worth on what it was not fitted to, beside what it was, and beside the weighted cues."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config import load_config
from kinematify.evaluation.fitting.corpora import COMPOSED, FAMILY
from kinematify.evaluation.fitting.trees import fit_scorer
from kinematify.joints.choice.judge import Judgement

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.evaluation.fitting.examples import Example
    from kinematify.robot.arrays import FloatArray

_FOLDS = 5
_RIGHT_DEG = 5.0


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
    types_per_object: float
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
        types_per_object=float(np.mean([types[rows].mean() for rows in groups])),
        within_per_object=float(np.mean([within[rows].mean() for rows in groups])),
    )


def judge_left_out(examples: Sequence[Example], progress: Callable[[str, float], None]) -> list[FloatArray]:
    """Probabilities of the hypotheses of every example by trees whose fit had none of its category.

    Categories are dealt into five groups. Of each group in turn nothing is fitted, neither real objects nor families
    of that name.
    """
    found: dict[int, FloatArray] = {}
    for fold in range(_FOLDS):
        progress(f"left out {fold + 1} of {_FOLDS}", fold / _FOLDS)
        fitted = [example for example in examples if example.fits and _fold(example.category) != fold]
        scorer = fit_scorer(fitted, seeds=(0,), provenance={})
        for k, example in enumerate(examples):
            if _fold(example.category) == fold:
                found[k] = scorer.probabilities(example.kinds, example.measured)
    return [found[k] for k in range(len(examples))]


def picked(example: Example, probabilities: FloatArray) -> int:
    """What the inference would choose with these probabilities, shape (h,)."""
    judged = Judgement(
        hypotheses=example.hypotheses,
        likely=probabilities,
        by_cues=max(example.by_cues, 1),
        support=example.measured["rules_score"],
        size=example.size,
        lead=load_config().joints.confidence.cues_lead,
    )
    return judged.best if example.by_cues else 0


def _fold(category: str) -> int:
    return zlib.crc32(category.encode()) % _FOLDS


def sets_of(examples: Sequence[Example]) -> dict[str, list[int]]:
    """Name of each set that has a row of its own -> positions of its examples."""
    found: dict[str, list[int]] = {}
    for k, example in enumerate(examples):
        name = {FAMILY: "generated families", COMPOSED: "random mechanisms"}.get(example.origin, example.origin)
        if example.origin not in (FAMILY, COMPOSED):
            name += ", fitted to" if example.fits else ", for research only: never fitted to"
        found.setdefault(name, []).append(k)
    return found
