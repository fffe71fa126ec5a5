"""The whole fit: corpora, weights with their provenance, and the table of what they are worth."""

from __future__ import annotations

import json
from dataclasses import asdict
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

from kinematify import __version__
from kinematify.evaluation.fitting.corpora import gather_examples, generated_sources, real_sources
from kinematify.evaluation.fitting.judged import judge_left_out, picked, row_of, sets_of
from kinematify.evaluation.fitting.trees import fit_scorer, write_scorer
from kinematify.joints.choice.scorer import WEIGHTS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kinematify.evaluation.fitting.examples import Example
    from kinematify.evaluation.fitting.judged import Row

_SEEDS = (0, 1)


def run_fit(
    folders: Sequence[Path],
    out: Path,
    *,
    rounds: int,
    composed: int,
    seed: int,
    workers: int,
    cache: Path,
    progress: Callable[[str, float], None],
) -> dict[str, Any]:
    """Fit the choice of joints, judge it left out, and write ``weights.npz``, ``choice.json`` and ``choice.md``.

    Args:
        folders: Of real objects.
        out: Where the files go.
        rounds: Objects of every generated family.
        composed: Random mechanisms.
        seed: Draws the generated objects.
        workers: Processes at a time.
        cache: Folder of what was measured, so that an interrupted run goes on.
        progress: Told what is done and the share of it.

    Returns:
        What ``choice.json`` holds.

    Raises:
        InputError: There is nothing to fit to.
        EnvironmentFault: LightGBM is not installed.
    """
    sources = generated_sources(rounds, composed) + [source for folder in folders for source in real_sources(folder)]
    examples = gather_examples(sources, cache, seed=seed, workers=workers, progress=progress)
    fitted = [example for example in examples if example.fits]
    provenance = {
        "kinematify": __version__,
        "lightgbm": _version(),
        "date": datetime.now(UTC).date().isoformat(),
        "seed": seed,
        "rounds": rounds,
        "composed": composed,
        "objects": len({(example.origin, example.object) for example in fitted}),
        "joints": len(fitted),
        "real": sorted({example.object for example in fitted if example.origin not in ("family", "composed")}),
    }
    scorer = fit_scorer(fitted, seeds=_SEEDS, provenance=provenance)
    out.mkdir(parents=True, exist_ok=True)
    write_scorer(scorer, out / WEIGHTS)
    left_out = judge_left_out(examples, progress)
    seen = [scorer.probabilities(example.kinds, example.measured) for example in examples]
    rows = {
        name: {
            "weighted cues": asdict(_row(examples, index, [example.by_cues for example in examples])),
            "left out": asdict(_row(examples, index, [picked(*pair) for pair in zip(examples, left_out, strict=True)])),
            "shipped weights": asdict(
                _row(examples, index, [picked(*pair) for pair in zip(examples, seen, strict=True)])
            ),
        }
        for name, index in sets_of(examples).items()
    }
    report = {"schema": 1, "provenance": provenance, "sets": rows}
    (out / "choice.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    (out / "choice.md").write_text(as_markdown(report), encoding="utf-8")
    return report


def _version() -> str:
    """Of LightGBM; empty where it is not installed, which the fit then says."""
    try:
        return version("lightgbm")
    except PackageNotFoundError:
        return ""


def _row(examples: Sequence[Example], index: Sequence[int], picks: Sequence[int]) -> Row:
    return row_of([examples[k] for k in index], [picks[k] for k in index])


def as_markdown(report: dict[str, Any]) -> str:
    """The table of `run_fit` as a page."""
    facts = report["provenance"]
    introduction = (
        f"Fitted to {facts['joints']} joints of {facts['objects']} objects by `kinematify fit` (seed {facts['seed']}, "
        f"LightGBM {facts['lightgbm']}, {facts['date']}). The true tree is given. Left out: trees whose fit had no "
        "object and no family of the category. Shipped weights: what ships, which has seen what it was fitted to."
    )
    lines = [
        "# The choice of joints",
        "",
        introduction,
        "",
        "| set | joints | chosen by | types right | type right and within 5 deg | the same, per object | angle [deg] |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    lines += [
        f"| {name} | {row['joints']} | {by} | {row['types']:.1%} | {row['within']:.1%} "
        f"| {row['within_per_object']:.1%} | {row['angle_deg']:.1f} |"
        for name, rows in report["sets"].items()
        for by, row in rows.items()
    ]
    return "\n".join(lines) + "\n"
