"""What does `kinematify validate` say of generated objects, family by family?

The model with the known joints and the model that was inferred from the parts alone are validated; shares count models
without any error. In brackets: in how many objects a check says so. Angle, types and TED compare the inferred joints
with the known ones, as `kinematify bench` does: mean over the joints of an object, then over objects; types over all
joints.
"""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from functools import cache
from operator import itemgetter
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from benchmarks.study import Options, Study, among, explained
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.evaluation.record import grouped, table
from kinematify.evaluation.truth import score_blueprint
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.model.urdf import write_urdf
from kinematify.pipeline import infer
from kinematify.pipeline.generate import true_model
from kinematify.validation.finding import Severity
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.config.validation import ValidationSettings
    from kinematify.evaluation.record import Report
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline import Inference

_BUDGET = 1800.0
"""Seconds for one model; on a free machine it takes ten."""
_WHOSE = ("truth", "inferred")
_TITLES = (
    "family", "objects", "joints", "truth without error", "inferred without error", "errors of the truth",
    "errors of the inferred", "angle [deg]", "types", "TED", "seconds",
)  # fmt: skip


class FamiliesOptions(Options):
    """Which objects."""

    seeds: int = Field(20, ge=1, description="Objects per family.")
    families: Annotated[tuple[str, ...], among(FAMILIES)] = Field(
        (), description="Only these families, separated by commas."
    )


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """One object of a family."""

    family: str
    seed: int


def measure(options: FamiliesOptions, work: Work) -> Measured:
    """Validate and infer every object."""
    # Seeds outside: what an early stop leaves says something of every family.
    asked = [
        Drawn(family=family, seed=seed) for seed in range(options.seeds) for family in options.families or FAMILIES
    ]
    named = {f"{drawn.family} {drawn.seed}": drawn for drawn in asked}
    return list(work.each(validated_twice, named, timeout=3.0 * _BUDGET).values()), {}


def validated_twice(drawn: Drawn) -> Record:
    """Build an object, validate its true and its inferred model, and compare the joints."""
    start = time.perf_counter()
    blueprint = build(FAMILIES[drawn.family], {}, seed=drawn.seed, name=f"{drawn.family}_{drawn.seed}")
    config = load_config()
    record: Record = {"family": drawn.family, "seed": drawn.seed, "joints": len(blueprint.joints)}
    record["truth"] = _validated(true_model(blueprint, config))
    try:
        inference = infer(blueprint.assembly, config=config)
    except Exception as error:  # an object without an answer counts against its family
        fault = {"check": "no answer", "where": "", "message": f"{type(error).__name__}: {error}"}
        record |= {"inferred": {"errors": [fault], "seconds": 0.0}, "accuracy": _accuracy(blueprint, None)}
    else:
        record |= {"inferred": _validated(inference.model), "accuracy": _accuracy(blueprint, inference)}
    return {**record, "seconds": time.perf_counter() - start}


def _validated(model: KinematicModel) -> Record:
    with tempfile.TemporaryDirectory() as folder:
        write_urdf(model, Path(folder))
        report = validate(Path(folder, "model.urdf"), settings=_patient(), workers=1)
    errors = [
        {
            "check": item.check,
            "where": item.joint or item.link or " - ".join(item.pair or ()),
            "message": item.message,
        }
        for item in report.counted
        if item.severity is Severity.ERROR
    ]
    return {"errors": errors, "seconds": float(report.environment["seconds"])}


@cache
def _patient() -> ValidationSettings:
    """The shipped thresholds; what a check says of a model must not hang on how busy the machine is."""
    settings = load_settings()
    budget = settings.budget.model_copy(update={"seconds": _BUDGET})
    return settings.model_copy(update={"budget": budget})


def _accuracy(blueprint: Blueprint, inference: Inference | None) -> dict[str, float]:
    if inference is None:
        return {"angle_deg": 90.0, "types_right": 0, "ted": len(blueprint.parts)}
    score = score_blueprint(blueprint, inference)
    return {
        "angle_deg": sum(joint.angle_deg for joint in score.joints) / max(len(score.joints), 1),
        "types_right": sum(joint.type_right for joint in score.joints),
        "ted": float(score.ted.value),
    }


def report(found: Report[Record]) -> list[str]:
    """The families, the worst first, and every kind of error with an example."""
    groups = grouped(found.records, by=itemgetter("family"))
    numbers = {name: _numbers(group) for name, group in groups.items()}
    worst = sorted(groups, key=lambda name: (sum(numbers[name][w] for w in _WHOSE), -numbers[name]["angle_deg"], name))
    rows = [_row(name, numbers[name]) for name in worst]
    return [
        explained(__doc__),
        table(_TITLES, [*rows, _row("**all**", _numbers(found.records))]),
        "## One example of each error",
        "\n".join(_examples([record for name in worst for record in groups[name]])) or "None.",
    ]


def _numbers(records: Sequence[Record]) -> Record:
    joints = sum(record["joints"] for record in records)
    return {
        "objects": len(records),
        "joints": joints,
        **{whose: fmean(not record[whose]["errors"] for record in records) for whose in _WHOSE},
        **{f"{whose}_errors": _checks(records, whose) for whose in _WHOSE},
        "angle_deg": fmean(record["accuracy"]["angle_deg"] for record in records),
        "types": sum(record["accuracy"]["types_right"] for record in records) / max(joints, 1),
        "ted": fmean(record["accuracy"]["ted"] for record in records),
        "seconds": fmean(record["seconds"] for record in records),
    }


def _checks(records: Sequence[Record], whose: str) -> Counter[str]:
    """In how many objects each check has an error."""
    return Counter(check for record in records for check in sorted({e["check"] for e in record[whose]["errors"]}))


def _row(name: str, numbers: Record) -> tuple[str, ...]:
    return (
        name,
        str(numbers["objects"]),
        str(numbers["joints"]),
        *(f"{numbers[whose]:.0%}" for whose in _WHOSE),
        *(_counted(numbers[f"{whose}_errors"]) for whose in _WHOSE),
        f"{numbers['angle_deg']:.2f}",
        f"{numbers['types']:.1%}",
        f"{numbers['ted']:.2f}",
        f"{numbers['seconds']:.1f}",
    )


def _counted(checks: Mapping[str, int]) -> str:
    return ", ".join(f"{check} ({count})" for check, count in sorted(checks.items(), key=lambda item: -item[1])) or "-"


def _examples(records: Sequence[Record]) -> list[str]:
    first: dict[tuple[str, str, str], str] = {}
    for record in records:
        for whose in _WHOSE:
            for error in record[whose]["errors"]:
                place = f"{record['family']}, seed {record['seed']}, {whose}, {error['check']}, {error['where']}"
                first.setdefault((record["family"], whose, error["check"]), f"- {place}: {error['message']}")
    return list(first.values())


STUDY = Study(title="Generated objects, validated", options=FamiliesOptions, measure=measure, report=report)
