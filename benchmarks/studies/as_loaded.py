"""Do files work in engines as they are?

Objects of the benchmark are inferred from their parts alone and written; generated ones are written with the joints
that they were built with, and inferred: of these `joints right` has those whose tree, types and axes (within 5 deg and
2 % of the diagonal) are as built; models of others are taken as they are, and after `kinematify fix`. Each file is
judged by the checks KV8xx of `kinematify validate`: it is loaded with the engine's own defaults, left alone under
gravity, and each joint is pushed by a hand over what exact geometry leaves free of its range. A model works in an
engine in which no check complains; `blocked` counts the joints of which less is free than is declared: the others of
those that move reach both ends. Inferred models are repaired as `kinematify infer` does. PyBullet is
asked with `URDF_USE_SELF_COLLISION`; without that flag, its default, links pass through each other. The plain code of
complaints about models of others is run as it is in the report; `shown` counts those where it shows what is said.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from functools import partial
from operator import itemgetter
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from benchmarks.expectations import load_sentences
from benchmarks.study import Options, Study, among, explained
from kinematify.config import load_config
from kinematify.evaluation.benchmark_job import erased_item, shown_parts
from kinematify.evaluation.datasets import CONDITIONS, find_objects
from kinematify.evaluation.metrics import score_blueprint
from kinematify.evaluation.result_record import grouped, table
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.reader import read_sentence
from kinematify.generate.registry import FAMILIES, all_kinds, build
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.pipeline.infer_assembly import infer
from kinematify.refinement.loop import repaired
from kinematify.refinement.repair import fix
from kinematify.simulation.engines import ENGINES
from kinematify.validation.checks import checks_of
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run import validate
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.config import Config
    from kinematify.evaluation.datasets import BenchObject
    from kinematify.evaluation.result_record import Report
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.inference import Inference
    from kinematify.validation.finding import CheckResult, Finding

_SHOWN = 0.1
"""How far what the code of a finding prints may be from what the finding says, as a fraction of it."""
_RIGHT_DEG, _RIGHT_LINE = 5.0, 0.02
"""How far the axis of an inferred joint may be from the true one: angle, and distance as a fraction of the diagonal."""
_DEEP = 5e-3
"""Overlap at rest that is counted [m]."""
_FREE_TRAVEL = "KV310"
"""Its stage measures how far every joint is free."""


class AsLoadedOptions(Options):
    """Which objects, in which engines, and which collision geometry."""

    data: tuple[str, ...] = Field(("everyday",), description="Sets or folders of objects to infer.")
    given: tuple[str, ...] = Field((), description="Sets or folders of models to take as they are, and after fix.")
    seeds: int = Field(1, ge=0, description="Objects per family of the generator.")
    families: Annotated[tuple[str, ...], among(FAMILIES)] = Field(
        (), description="Only these families, separated by commas."
    )
    inferred: int = Field(0, ge=0, description="Objects per family of the generator that are inferred.")
    described: int = Field(0, ge=0, description="Seeds of each object that a file describes.")
    sentences: int = Field(0, ge=0, description="Seeds of each of sixty sentences.")
    engines: Annotated[tuple[str, ...], among(ENGINES)] = Field(
        ("mujoco", "pybullet"), description="Engines, separated by commas."
    )
    collision: Literal["auto", "mesh"] = Field("auto", description="Collision geometry that is written.")


@dataclass(frozen=True, kw_only=True)
class TriedFile:
    """One file to try, and how it comes about."""

    made: Literal["inferred", "as given", "after fix", "exact"]
    engines: tuple[str, ...]
    collision: str
    item: BenchObject | None = None
    """None for an object of the generator."""
    family: str = ""
    """Empty where a sentence says it."""
    sentence: str = ""
    seed: int = 0


def measure(options: AsLoadedOptions, work: Work) -> Measured:
    """Write every object and try it in every engine."""
    case = partial(TriedFile, engines=options.engines, collision=options.collision)
    inferred = {item.name: item for data in options.data for item in find_objects(data)}
    given = {item.name: item for data in options.given for item in find_objects(data)}
    cases = {f"{name} inferred": case(made="inferred", item=item) for name, item in inferred.items()}
    for name, item in given.items():
        cases[f"{name} as given"] = case(made="as given", item=item)
        cases[f"{name} after fix"] = case(made="after fix", item=item)
    for seed in range(options.seeds):
        for family in options.families or FAMILIES:
            cases[f"{family} {seed}"] = case(made="exact", family=family, seed=seed)
    for seed in range(options.inferred):
        for family in options.families or FAMILIES:
            cases[f"{family} {seed} inferred"] = case(made="inferred", family=family, seed=seed)
    for seed in range(options.described):
        for family in sorted(all_kinds().keys() - set(FAMILIES)):
            cases[f"{family} {seed}"] = case(made="exact", family=family, seed=seed)
    for seed in range(options.sentences):
        for number, said in enumerate(load_sentences("fresh"), start=1):
            cases[f"sentence {number} {seed}"] = case(made="exact", sentence=said["text"], seed=seed)
    return list(work.each(tried_as_loaded, cases, timeout=1800.0, reuse=20).values()), {
        "versions": package_versions(ENGINES[engine].packages[0] for engine in options.engines)
    }


def tried_as_loaded(case: TriedFile) -> Record:
    """Infer, build, fix or take a model, and try it."""
    config = load_config()
    config = config.model_copy(update={"collision": config.collision.model_copy(update={"mode": case.collision})})
    if case.item is None:
        made_by = "generated" if case.family in FAMILIES else "described by files"
        facts = {
            "set": f"{'from a sentence' if case.sentence else made_by}, {case.made}",
            "object": f"{case.family or case.sentence} {case.seed}",
        }
        blueprint = _generated(case)
        if case.made == "exact":
            return {**facts, **_written(true_model(blueprint, config), config, case.engines, powered=True)}
        inference = infer(blueprint.assembly, config=config)
        right = "right" if _joints_right(blueprint, inference) else "wrong"
        facts["set"] += f", joints {right}"
        return {**facts, **_written(inference.model, config, case.engines)}
    facts = {"set": f"{case.item.urdf.parents[1].name}, {case.made}", "object": case.item.name}
    if case.made == "inferred":
        model = repaired(infer(shown_parts(erased_item(case.item, CONDITIONS[0])), config=config)).model
        return {**facts, **_written(model, config, case.engines)}
    if case.made == "as given":
        return {**facts, **_judged(case.item.urdf, case.engines, case.item.package_dirs, run_code=True)}
    with tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        fixed = fix(case.item.urdf, Path(folder) / "model.urdf", config=config, package_dirs=case.item.package_dirs)
        seconds = time.process_time() - start
        return {**facts, "seconds": seconds, **_judged(fixed.path, case.engines, case.item.package_dirs, run_code=True)}


def _joints_right(blueprint: Blueprint, inference: Inference) -> bool:
    score, diagonal = score_blueprint(blueprint, inference), blueprint.assembly.diagonal
    return score.parent_errors == 0 and all(
        joint.type_right and joint.angle_deg <= _RIGHT_DEG and (joint.line_m or 0.0) <= _RIGHT_LINE * diagonal
        for joint in score.joints
    )


def _generated(case: TriedFile) -> Blueprint:
    if case.sentence:
        return read_sentence(case.sentence).made(seed=case.seed).blueprint
    return build(case.family, seed=case.seed, name=f"{case.family}_{case.seed}")


def _written(model: KinematicModel, config: Config, engines: Sequence[str], *, powered: bool = False) -> Record:
    start = time.process_time()
    made = simulable_model(model, config, powered=powered)
    seconds = time.process_time() - start
    with tempfile.TemporaryDirectory() as folder:
        tried = _judged(write_model(made.robot, Path(folder)), engines)
    return {
        "blocked": len({item.joint for item in made.collision.blocked}) if made.collision is not None else 0,
        "pieces": [len(link.collisions) for link in made.robot.links],
        "seconds": seconds,
        **tried,
    }


def _judged(urdf: Path, engines: Sequence[str], package_dirs: Sequence[Path] = (), *, run_code: bool = False) -> Record:
    """What `kinematify validate` says of a file as it is loaded, by engine."""
    checks = checks_of("KV80")
    report = validate(
        urdf,
        package_dirs=package_dirs,
        engines=engines,
        selected={_FREE_TRAVEL, *(check.id for check in checks)},
        workers=1,
    )
    return {
        "as_loaded": report.as_loaded,
        "worlds": {engine: _world(report.checks, engine, run_code=run_code) for engine in engines},
    }


def _world(checks: Sequence[CheckResult[Finding]], engine: str, *, run_code: bool) -> Record:
    """The judgement of one engine."""
    judged = [check for check in checks if check.check.startswith("KV80") and check.engine == engine]
    measured = {name: value for check in judged for name, value in check.measured.items()}
    counted = [item for check in judged for item in check.findings if item.severity is not Severity.NOTE]
    return {
        "joints": measured.get("joints", 0.0),
        "right": measured.get("right", measured.get("read", 0.0)),
        "refused": any(item.check == "KV801" and item.joint is None for item in counted),
        "deepest": measured.get("deepest", 0.0),
        "unfinished": [f"{check.check}: {check.reason}" for check in judged if check.status is Status.BLOCKED],
        "findings": [[item.check, item.joint, item.message] for item in counted],
        **({"shown": [shown(item) for item in counted]} if run_code else {}),
    }


def shown(finding: Finding) -> bool:
    """Whether the code of a finding, run by itself, shows what the finding says: its value, an end, a joint's lack."""
    code = finding.reproduction or "print()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300.0, check=False)
    lines = [line.split() for line in done.stdout.splitlines() if line.strip()]
    if finding.value is None:
        read = {
            line[0]: " ".join(f"{float(end):.4g}" for end in line[1:]) for line in lines if line[0] == finding.joint
        }
        refused = done.returncode != 0
        return refused if finding.joint is None else not refused and read.get(finding.joint, "") not in finding.message
    tolerance = _SHOWN * max(abs(finding.value), abs(finding.limit or 0.0))
    return any(abs(float(word) - finding.value) <= tolerance for word in (lines or [[]])[-1])


def report(found: Report[Record]) -> list[str]:
    """Models and joints that work, by set and engine, and every complaint."""
    pieces = [count for record in found.records for count in record.get("pieces", ())]
    seconds = [record["seconds"] for record in found.records if "seconds" in record]
    facts = [
        f"Collision pieces of a link: median {median(pieces):.0f}, most {max(pieces)}." if pieces else "",
        f"Time of a processor to fit them: median {median(seconds):.1f} s, most {max(seconds):.1f} s an object."
        if seconds
        else "",
    ]
    return [
        explained(__doc__),
        "## Works in",
        works_in(found),
        " ".join(facts).strip(),
        "## What does not work",
        "\n".join(_failing(found.records)) or "Nothing.",
    ]


def works_in(found: Report[Record]) -> str:
    """Return the table of engines with their versions and the date, in which as many models of a set work."""
    groups = grouped(found.records, by=itemgetter("set"))
    rows = [
        _row(found, name, engine, group)
        for name, group in groups.items()
        for engine in ENGINES
        if engine in group[0]["worlds"]
    ]
    headings = (
        "set", "engine", "version", "date", "models that work", "joints that move", "blocked", "reach both ends",
        "refused", f"deeper than {1e3 * _DEEP:g} mm at rest", "shown",
    )  # fmt: skip
    return table(headings, rows)


def _row(found: Report[Record], name: str, engine: str, records: Sequence[Record]) -> tuple[str, ...]:
    tried = [record["worlds"][engine] for record in records]
    right, joints = (sum(one[name] for one in tried) for name in ("right", "joints"))
    seen = [item for one in tried for item in one.get("shown", ())]
    return (
        name,
        ENGINES[engine].title,
        found.summary["versions"][ENGINES[engine].packages[0]],
        found.header.date,
        f"{sum(not one['findings'] and not one['unfinished'] for one in tried)} of {len(tried)}",
        f"{right:.0f} of {joints:.0f}",
        str(blocked := sum(record.get("blocked", 0) for record in records)),
        f"{(right - blocked) / max(joints, 1.0):.1%}",
        str(sum(one.get("refused", False) for one in tried)),
        str(sum(one.get("deepest", 0.0) > _DEEP for one in tried)),
        f"{sum(seen)} of {len(seen)}" if seen else "",
    )


def _failing(records: Sequence[Record]) -> Iterator[str]:
    for record in records:
        for engine, tried in record["worlds"].items():
            for check, _, message in tried["findings"]:
                yield f"- {record['set']}, {record['object']}, {engine}, {check}: {message}"
            for reason in tried["unfinished"]:
                yield f"- {record['set']}, {record['object']}, {engine}, {reason}"


def faults(found: Report[Record]) -> list[str]:
    """Complaints that their own code does not show."""
    return [
        f"{record['object']}, {engine}, {check}: its code does not show that {message}"
        for record in found.records
        for engine, tried in record["worlds"].items()
        for (check, _, message), seen in zip(tried["findings"], tried.get("shown", tried["findings"]), strict=True)
        if not seen
    ]


STUDY = Study(
    title="The files as they are loaded", options=AsLoadedOptions, measure=measure, report=report, faults=faults
)
