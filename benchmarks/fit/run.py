"""The whole fit: corpora, weights with their provenance, and the table of what they are worth."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import asdict, replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from benchmarks.fit.corpora import (
    DESCRIBED,
    GENERATED,
    broken_sources,
    gather_examples,
    generated_sources,
    real_sources,
    with_spares,
)
from benchmarks.fit.cross_validation import (
    CAUSES,
    agreed_examples,
    calibration_of,
    cause_of,
    judge_left_out,
    judge_opening_left_out,
    judge_origins_held_out,
    judge_rigidity_left_out,
    judge_turning_left_out,
    kept_scorer,
    picked,
    row_of,
    sets_of,
)
from benchmarks.fit.trees import (
    Seeds,
    data_key,
    fit_opening,
    fit_rigidity,
    fit_turning,
    is_fixed,
    lightgbm_module,
    opening_recipe_key,
    recipe_key,
    rigidity_recipe_key,
    turning_recipe_key,
    turns_known,
    write_scorer,
)
from kinematify import __version__
from kinematify.evaluation.result_record import git_commit, table
from kinematify.joints.choice.scorer import OPENING_WEIGHTS, RIGID_WEIGHTS, TURNING_WEIGHTS, WEIGHTS, shipped_scorer

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from benchmarks.fit.examples import Example
    from kinematify.robot.arrays import FloatArray

    Likely = Mapping[str, Mapping[int, FloatArray]]

FIXED_HEAD, DESCRIBED_SET = "fixed", "described"
"""What a fit can skip: weights that stay as they are, and objects that only judge."""
_SEEDS = (0, 1, 2, 3)
SHIPPED = Seeds(trees=_SEEDS, networks=(0, 1, 2, 3, 4, 5), points=(0, 1))
_LEAST = 10  # joints below which calibration says nothing


def run_fit(
    folders: Sequence[Path],
    out: Path,
    *,
    rounds: int,
    composed: int,
    seed: int,
    workers: int,
    cache: Path,
    per_category: int | None,
    hold_out: Sequence[str],
    skip: Sequence[str],
    progress: Callable[[str, float], None],
) -> dict[str, Any]:
    """Fit the choice of joints, judge it held out, and write ``weights.npz``, ``choice.json`` and ``choice.md``.

    Args:
        folders: Of real objects.
        out: Where the files go.
        rounds: Objects of every generated family.
        composed: Random mechanisms.
        seed: Draws the generated objects.
        workers: Processes at a time.
        cache: Folder of what was measured and of held-out fits, so that an interrupted run goes on.
        per_category: Objects of each category of a folder that are fitted to; the others judge. None for all.
        hold_out: Folders of objects that are also judged by a fit that has nothing of any of them.
        skip: Of `FIXED_HEAD` and `DESCRIBED_SET`: what is neither measured, fitted nor judged.
        progress: Called with what is done and the share of it.

    Returns:
        What ``choice.json`` holds.

    Raises:
        InputError: There is nothing to fit to.
        EnvironmentFault: LightGBM is not installed.
    """
    sources = generated_sources(rounds, composed) + [source for folder in folders for source in real_sources(folder)]
    sources = [source for source in sources if source.origin != DESCRIBED or DESCRIBED_SET not in skip]
    sources += [] if FIXED_HEAD in skip else broken_sources(sources)
    examples = gather_examples(sources, cache, seed=seed, workers=workers, progress=progress)
    drawn = {"seed": seed, "rounds": rounds, "composed": composed, "per_category": per_category}
    examples = with_spares(examples, per_category)
    return fit_and_judge(examples, out, drawn=drawn, held_out=hold_out, skip=skip, progress=progress)


def fit_and_judge(
    examples: Sequence[Example],
    out: Path,
    *,
    drawn: Mapping[str, int | None],
    held_out: Sequence[str],
    skip: Sequence[str],
    progress: Callable[[str, float], None],
) -> dict[str, Any]:
    """What `run_fit` does of examples that are measured; `drawn` says how many were generated."""
    everything, examples = examples, [example for example in examples if not example.broken]
    fitted = [example for example in examples if example.teaches]
    provenance = {
        "kinematify": __version__,
        "lightgbm": lightgbm_module().__version__,
        "date": datetime.now(UTC).date().isoformat(),
        "commit": git_commit()[0],
        **drawn,
        "objects": len({(example.origin, example.object) for example in fitted}),
        "joints": len(fitted),
        "data": data_key(fitted),
        "recipe": recipe_key(list({name for example in fitted for name in example.measured})),
        "real": sorted({example.object for example in fitted if example.origin not in GENERATED}),
    }
    fits = out / "fits"
    scorer = replace(kept_scorer(fitted, fits, SHIPPED), provenance=provenance)
    write_scorer(scorer, out / WEIGHTS)
    heads: list[tuple[str, Any, Any, list[Example]]] = [
        (OPENING_WEIGHTS, fit_opening, opening_recipe_key, [example for example in fitted if example.sides]),
        (TURNING_WEIGHTS, fit_turning, turning_recipe_key, [example for example in fitted if turns_known(example)]),
    ]
    if FIXED_HEAD not in skip:
        taught = [example for example in everything if example.teaches]
        heads.append((RIGID_WEIGHTS, fit_rigidity, rigidity_recipe_key, taught))
    for name, fit, key, some in heads:
        beside = fit(some, seeds=_SEEDS, provenance={})
        facts = {"joints": len(some), "fixed": sum(map(is_fixed, some)), "recipe": key(beside.measurements)}
        write_scorer(replace(beside, provenance={**provenance, **facts}), out / name)
    likely = {"held out by category": judge_left_out(examples, progress, fits)}
    likely["held out with its source"] = judge_origins_held_out(examples, held_out, fits)
    before = shipped_scorer()
    for name, each in (("weights before", before), ("these weights, in-sample", scorer)):
        given = [each.probabilities(example.hypotheses, example.measured, example.cloud) for example in examples]
        likely[name] = dict(enumerate(agreed_examples(examples, given)))
    report = {
        "schema": 2,
        "provenance": provenance,
        "sets": {name: _rows(examples, index, likely) for name, index in sets_of(examples).items()},
        "calibration": _calibration(examples, likely["held out by category"]),
        "rigidity": {}
        if FIXED_HEAD in skip
        else {name: asdict(row) for name, row in judge_rigidity_left_out(everything).items()},
        "opening": {name: asdict(row) for name, row in judge_opening_left_out(examples).items()},
        "turning": {name: asdict(row) for name, row in judge_turning_left_out(examples).items()},
    }
    (out / "choice.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    (out / "choice.md").write_text(as_markdown(report), encoding="utf-8")
    return report


def _rows(examples: Sequence[Example], index: Sequence[int], likely: Likely) -> dict[str, Any]:
    """Figures and causes of errors of one set by what chose."""
    some = [examples[k] for k in index]
    found = {}
    for by, given in likely.items():
        if all(k in given for k in index):
            chosen = [picked(examples[k], given[k]) for k in index]
            causes = Counter(filter(None, map(cause_of, some, chosen)))
            found[by] = asdict(row_of(some, chosen)) | {"causes": causes}
    return found


def _calibration(examples: Sequence[Example], likely: Mapping[int, FloatArray]) -> dict[str, Any]:
    """Of real objects, but of robots, which are all sure and right."""
    index = [k for k, example in enumerate(examples) if example.origin not in (*GENERATED, "robots")]
    return calibration_of([examples[k] for k in index], [likely[k] for k in index]) if len(index) >= _LEAST else {}


def _percent(share: float | None) -> str:
    return "" if share is None else f"{share:.1%}"


def as_markdown(report: dict[str, Any]) -> str:
    """The table of `run_fit` as a page."""
    facts = report["provenance"]
    most = facts["per_category"]
    real = "" if most is None else f", at most {most} objects of a category of each folder; the others judge"
    introduction = (
        f"Fitted to {facts['joints']} joints of {facts['objects']} objects by `python -m benchmarks.fit` "
        f"(seed {facts['seed']}, LightGBM {facts['lightgbm']}): {facts['rounds']} object of each kind of the library, "
        f"{facts['composed']} random mechanisms{real}. The true tree is given. Held out by category: the fit had no "
        "object and no family of the category, and one seed; with its source: it had nothing of the sets that have "
        "this row. Weights before: what shipped until this fit, which has seen other objects. In-sample: these "
        "weights have seen what is called fitted to. Errors: no right joint was "
        "proposed; type; direction given the type; line beside the right one, which counts as right in the columns "
        "before."
    )
    made = f"- date: {facts['date']}, commit {facts['commit']}"
    blocks = ["# The choice of joints", made, introduction, _choice_table(report["sets"])]
    found = report["calibration"]
    if found:
        pairs = zip(found["confidence"], found["right"], strict=True)
        fifths = ", ".join(f"{sure:.2f} ({right:.2f})" for sure, right in pairs)
        blocks.append(
            "Held out by category, real objects but robots: the least sure fifth holds "
            f"{found['errors_in_least_sure']:.0%} of the errors. Mean confidence of each fifth, and share right: "
            f"{fifths}. Calibration error: {found['error']:.3f}."
        )
    for key, title, *what in (
        ("rigidity", "Whether a part is fixed", "pieces broken off", "moving parts"),
        ("opening", "Which way a turn opens, of the true line", "open one way", "others"),
        ("turning", "Which turns go round, of the true line", "go round", "turn between stops"),
    ):
        if any(row["yes"] for row in report[key].values()):
            counted = [
                (name, f"{row['yes']}", _percent(row["found"]), f"{row['no']}", _percent(row["lost"]))
                for name, row in report[key].items()
            ]
            blocks += [f"{title}, held out by category:", table(("set", what[0], "found", what[1], "lost"), counted)]
    return "\n\n".join(blocks) + "\n"


def _choice_table(sets: Mapping[str, Any]) -> str:
    """Figures and causes of errors of sets, by what chose."""
    head = ("set", "joints", "chosen by", "types right", "type right and within 5 deg", "the same, per object")
    rows = [
        (
            name,
            f"{row['joints']}",
            by,
            *(f"{row[key]:.1%}" for key in ("types", "within", "within_per_object")),
            f"{row['angle_deg']:.1f}",
            *(f"{row['causes'].get(cause, 0)}" for cause in CAUSES),
        )
        for name, by_what in sets.items()
        for by, row in by_what.items()
    ]
    return table((*head, "angle [deg]", *CAUSES), rows)
