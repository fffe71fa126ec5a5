"""What becomes of a sentence: read, built, taken apart, inferred, moved?

Sentences are read and built by the procedural source; the inference sees the parts alone; the joints that the object
was built with are the truth. Read right: the category that a reader expects was built. Means are over the joints of an
object, then over objects; types over all joints; a joint between the wrong parts counts 90 deg. Times are wall times,
and tell little where other work shared the machine.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from itertools import islice
from operator import itemgetter
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING

import yaml
from pydantic import Field, TypeAdapter

from benchmarks.study import Options, Study, explained
from kinematify import evaluation
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.errors import InputError
from kinematify.evaluation.job import JobResult
from kinematify.evaluation.record import grouped, number, table
from kinematify.evaluation.summary import median_seconds, summarise
from kinematify.evaluation.truth import score_blueprint
from kinematify.generate.request import from_text
from kinematify.model.output import MODEL_FILE
from kinematify.pipeline import infer
from kinematify.pipeline.record import write_inference_files
from kinematify.refinement.simulate import Simulator
from kinematify.validation.finding import Severity
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.record import Report
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.pipeline import Inference
    from kinematify.validation.finding import Finding

WRONG_DEG = 10.0
_RUN = TypeAdapter(JobResult)


class EndToEndOptions(Options):
    """Which sentences."""

    sentences: tuple[Path, ...] = Field(
        (Path(evaluation.__path__[0], "sentences", "written.yaml"),),
        description="YAML lists of {text, family}, separated by commas.",
    )
    each: int | None = Field(None, ge=1, description="The first so many sentences of every category.")
    quick: bool = Field(False, description="Judge the motion by exact geometry alone, without files and engines.")


@dataclass(frozen=True, kw_only=True)
class Sentence:
    """What is asked for, and the category that a reader expects."""

    text: str
    family: str
    quick: bool


def measure(options: EndToEndOptions, work: Work) -> Measured:
    """Take every sentence the whole way."""
    asked: list[Record] = []
    for file in options.sentences:
        try:
            asked += yaml.safe_load(file.read_text(encoding="utf-8"))
        except OSError as error:
            raise InputError(
                f"The sentences {file} cannot be read ({error.strerror}). Give --sentences a file."
            ) from error
    chosen = [
        item for group in grouped(asked, by=itemgetter("family")).values() for item in islice(group, options.each)
    ]
    sentences = {
        item["text"]: Sentence(text=item["text"], family=item["family"], quick=options.quick) for item in chosen
    }
    return list(work.each(taken_all_the_way, sentences).values()), {}


def taken_all_the_way(asked: Sentence) -> Record:
    """Read, build, infer, validate and score one sentence; whatever goes wrong is its result."""
    start = time.perf_counter()
    record: Record = {
        "text": asked.text,
        "expected": asked.family,
        "family": "",
        "message": "",
        "run": None,
        "errors": [],
    }
    try:
        request = from_text(asked.text)
        record["family"] = request.family
        blueprint = request.build(seed=None)
        inference = infer(blueprint.assembly, config=load_config())
        record["errors"] = _errors(_findings(inference, quick=asked.quick))
        record["run"] = _RUN.dump_python(_scored(asked, blueprint, inference), mode="json")
    except Exception as error:
        record["message"] = f"{type(error).__name__}: {error}"
    return {**record, "seconds": time.perf_counter() - start}


def _scored(asked: Sentence, blueprint: Blueprint, inference: Inference) -> JobResult:
    """The inference as a result of `kinematify bench`."""
    return JobResult(
        object=asked.text,
        kind="procedural",
        category=asked.family,
        condition="rest",
        variant="default",
        status="ok",
        message="",
        seconds=sum(inference.timings.values()),
        stage_seconds=dict(inference.timings),
        peak_mb=inference.peak_mb,
        score=score_blueprint(blueprint, inference),
    )


def _findings(inference: Inference, *, quick: bool) -> Sequence[Finding]:
    """Those of the validation, or of the geometry in motion alone."""
    if quick:
        return Simulator(inference.model, load_settings().geometry).judge(inference.model).findings
    with tempfile.TemporaryDirectory() as folder:
        write_inference_files(inference, Path(folder), preview=False)
        return validate(Path(folder, MODEL_FILE), workers=1).counted


def _errors(findings: Iterable[Finding]) -> list[str]:
    return [
        f"{item.check} {item.joint or item.link or ' - '.join(item.pair or ())}".strip()
        for item in findings
        if item.severity is Severity.ERROR
    ]


def report(found: Report[Record]) -> list[str]:
    """Figures by category, and everything that is wrong."""
    quick = found.header.configuration.get("quick")
    judged = (
        "every joint moved by exact geometry (KV301 to KV321), no engines" if quick else "validation in the engines"
    )
    titles = (
        "category", "sentences", "read right", "joints", "types", "axis [deg]", "line [mm]", "TED", "limits (IoU)",
        "moves without error" if quick else "validated without error", "inference [s]", "all in all [s]",
    )  # fmt: skip
    groups = sorted(grouped(found.records, by=itemgetter("expected")).items())
    return [
        explained(__doc__),
        f"All in all: sentence, parts, inference, model folder and {judged}.",
        table(titles, [_row(name, group) for name, group in [*groups, ("**all**", list(found.records))]]),
        "## What is wrong",
        "\n".join(_faults(found.records)) or "Nothing.",
    ]


def _row(name: str, records: Sequence[Record]) -> tuple[str, ...]:
    runs = [_RUN.validate_python(record["run"]) for record in records if record["run"] is not None]
    values = summarise(runs).values
    joints = values.get("joints") or 0.0
    return (
        name,
        str(len(records)),
        str(sum(record["family"] == record["expected"] for record in records)),
        f"{joints:.0f}",
        f"{(values.get('types_right') or 0.0) / joints:.1%}" if joints else "-",
        number(values.get("angle_deg"), 2),
        number(values.get("line_m"), 1, 1e3),
        number(values.get("ted"), 2),
        number(values.get("limit_iou"), 2),
        f"{fmean(not record['errors'] and not record['message'] for record in records):.0%}",
        number(median_seconds(runs), 1),
        f"{fmean(record['seconds'] for record in records):.1f}",
    )


def _faults(records: Iterable[Record]) -> list[str]:
    """One line per sentence with something wrong."""
    lines = []
    for record in records:
        run = None if record["run"] is None else _RUN.validate_python(record["run"])
        said = [record["message"]] if record["message"] else []
        said += [f"read as {record['family']}"] if record["family"] not in ("", record["expected"]) else []
        for joint in run.score.joints if run is not None and run.score is not None else ():
            if not joint.matched:
                said.append(f"{joint.joint}: not in the tree")
            elif not joint.type_right or joint.angle_deg > WRONG_DEG:
                called = f"{joint.kind}, called {joint.predicted_kind}"
                said.append(f"{joint.joint}: {called}, {joint.angle_deg:.1f} deg off")
        said += [f"validation: {error}" for error in record["errors"]]
        lines += [f'- "{record["text"]}": {"; ".join(said)}'] if said else []
    return lines


STUDY = Study(title="From a sentence to a mechanism", options=EndToEndOptions, measure=measure, report=report)
