"""The fit of the choice: examples, trees and tables, on a few random mechanisms."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from benchmarks.fit import network, point_network
from benchmarks.fit.categories import ALIKE
from benchmarks.fit.corpora import gather_examples, generated_sources
from benchmarks.fit.cross_validation import cause_of
from benchmarks.fit.drawn import corpus_kinds
from benchmarks.fit.run import run_fit
from kinematify.joints.choice.scorer import WEIGHTS

if TYPE_CHECKING:
    from pathlib import Path


def silent(what: str, share: float) -> None:
    """No progress."""


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What was measured of the first mechanisms."""
    return tmp_path_factory.mktemp("measured")


def test_examples_know_which_hypothesis_is_right_and_are_measured_once(measured: Path) -> None:
    sources = generated_sources(0, 2)
    first = gather_examples(sources, measured, seed=0, workers=1, progress=silent)
    written = {path: path.stat().st_mtime_ns for path in measured.iterdir()}
    second = gather_examples(sources, measured, seed=0, workers=1, progress=silent)
    assert {path: path.stat().st_mtime_ns for path in measured.iterdir()} == written
    for a, b in zip(first, second, strict=True):
        best = int(np.argmax(a.right))
        assert a.types_right[best]
        assert a.angles[best] < 5.0
        assert a.target.sum() == pytest.approx(1.0)
        np.testing.assert_array_equal(a.right, b.right)


def test_what_is_right_has_no_cause_and_what_is_wrong_one(measured: Path) -> None:
    example = gather_examples(generated_sources(0, 1), measured, seed=0, workers=1, progress=silent)[0]
    assert cause_of(example, int(np.argmax(example.right))) is None
    assert cause_of(example, int(np.argmin(example.types_right))) == "wrong type"
    assert cause_of(replace(example, right=np.zeros_like(example.right)), 0) == "none proposed"


def test_categories_name_recipes_and_families_once_and_no_category_is_of_another() -> None:
    named = [name for names in ALIKE.values() for name in names]
    assert len(named) == len(set(named))
    assert set(named) <= set(corpus_kinds())
    assert not set(named) & set(ALIKE)


def test_a_small_fit_writes_weights_and_tables_and_the_same_again(
    measured: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("lightgbm", reason="the extra `fit` is not installed")
    for part in (network, point_network):
        monkeypatch.setitem(part.PARAMETERS, "epochs", 2)
    once, again = tmp_path / "once", tmp_path / "again"
    for out in (once, again):
        report = run_fit(
            [],
            out,
            rounds=0,
            composed=4,
            seed=0,
            workers=1,
            cache=measured,
            per_category=None,
            hold_out=(),
            skip=(),
            progress=silent,
        )
        assert set(report["sets"]) == {"random mechanisms"}
    assert "held out by category" in (once / "choice.md").read_text()
    first, second = (np.load(out / WEIGHTS) for out in (once, again))
    for name in first.files:
        if name != "facts":  # they hold the date
            np.testing.assert_array_equal(first[name], second[name])
