"""From sentences to mechanisms, as in the paper's table: results/end_to_end.{json,md}.

Every sentence goes through `kinematify generate`: it is read, built from boards, hinges and bearings, its parts alone
are inferred, and the model is validated. The joints that it was built with are the truth. A stopped run goes on.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import multiprocessing
import tempfile
import time
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING, Any

import yaml
from pydantic import TypeAdapter

from kinematify.cli.generation import Generation
from kinematify.config.validation import load_settings
from kinematify.evaluation.job import JobResult
from kinematify.evaluation.ledger import Ledger
from kinematify.evaluation.studies.generated.job import code_version
from kinematify.evaluation.summary import median_seconds, summarise
from kinematify.generate.procedural.request import from_text
from kinematify.refinement.simulate import Simulator
from kinematify.validation.environment import environment
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kinematify.validation.finding import Finding

TITLES = ("category", "sentences", "read right", "joints", "types", "axis [deg]", "line [mm]", "TED", "limits (IoU)",
          "inference [s]", "all in all [s]")  # fmt: skip
WRONG_DEG = 10.0
_JUDGED = {False: "validation in the engines", True: "every joint moved by exact geometry (KV301 to KV321), no engines"}


@dataclass(frozen=True, kw_only=True)
class SentenceResult:
    """What came of a sentence."""

    key: str
    text: str
    expected: str
    """Category that a reader of the sentence expects."""
    family: str
    """Category that was built; empty if it was not understood."""
    message: str
    """Why there is no model; empty otherwise."""
    run: JobResult | None
    """The inference, scored against the joints that the object was built with."""
    errors: tuple[str, ...]
    """Errors of the validation, check and joint or link."""
    seconds: float
    """From the sentence to the verdict [s]."""


def main() -> None:
    """Run all sentences, or those that are missing."""
    arguments = _arguments()
    asked = _asked(arguments.sentences, arguments.each)
    keys = {_key(text, quick=arguments.quick): (text, family) for text, family in asked}
    start = time.perf_counter()
    # Not a pool of `multiprocessing`, whose processes must not start others, as validation does.
    context = multiprocessing.get_context("spawn")
    with (
        Ledger(arguments.work / "end_to_end.jsonl", TypeAdapter(SentenceResult)) as ledger,
        ProcessPoolExecutor(arguments.workers, mp_context=context) as pool,
    ):
        found = ledger.read()
        missing = [(key, *words, arguments.quick) for key, words in keys.items() if key not in found]
        for number, future in enumerate(as_completed([pool.submit(run_sentence, *job) for job in missing]), start=1):
            result = future.result()
            ledger.append(result)
            found[result.key] = result
            print(f"{number} of {len(missing)}: {result.text}: {result.message or _brief(result)}", flush=True)
    facts = environment(load_settings(), seconds=time.perf_counter() - start, interrupted=False)
    _write([found[key] for key in keys], facts, arguments)


def run_sentence(key: str, text: str, expected: str, quick: bool) -> SentenceResult:
    """Read, build, infer, validate and score one sentence; whatever goes wrong is its result.

    Args:
        key: Of the result.
        text: The sentence.
        expected: Category that a reader expects.
        quick: Judge the motion of the model by exact geometry alone, without files and engines.
    """
    start = time.perf_counter()
    family, message, run, errors = "", "", None, ()
    try:
        request = from_text(text)
        family = request.family
        with tempfile.TemporaryDirectory() as folder:
            generation = Generation(request, None, Path(folder) / "model", preview=False, validated=not quick)
            generation.all(lambda stage, done: None, overwrite=False)
        run, errors = _scored(generation, key, text), _errors(_findings(generation))
    except Exception as error:  # the other sentences must not wait for it
        message = f"{type(error).__name__}: {error}"
    return SentenceResult(
        key=key, text=text, expected=expected, family=family, message=message, run=run, errors=errors,
        seconds=time.perf_counter() - start,
    )  # fmt: skip


def _scored(generation: Generation, key: str, text: str) -> JobResult:
    """The inference as a result of `kinematify bench`."""
    inference = generation.inference
    return JobResult(
        key=key, object=text, kind="procedural", category=generation.request.family, condition="rest",
        variant="default", status="ok", message="", seconds=sum(inference.timings.values()),
        stage_seconds=dict(inference.timings), peak_mb=inference.peak_mb, score=generation.score(),
    )  # fmt: skip


def _findings(generation: Generation) -> Sequence[Finding]:
    """Those of the validation, or of the geometry in motion where there was none."""
    if generation.report is not None:
        return generation.report.counted
    model = generation.inference.model
    return Simulator(model, load_settings().geometry).judge(model).findings


def _errors(findings: Sequence[Finding]) -> tuple[str, ...]:
    return tuple(
        f"{item.check} {item.joint or item.link or ' - '.join(item.pair or ())}".strip()
        for item in findings
        if item.severity is Severity.ERROR
    )


def _asked(files: Sequence[Path], each: int | None) -> list[tuple[str, str]]:
    """Sentences with the category that they mean, the first `each` of every category."""
    by_family: dict[str, list[str]] = defaultdict(list)
    for file in files:
        for item in yaml.safe_load(file.read_text(encoding="utf-8")):
            by_family[item["family"]].append(item["text"])
    return [(text, family) for family, texts in by_family.items() for text in islice(texts, each)]


def _key(text: str, *, quick: bool) -> str:
    """Results are taken up if neither the code nor the object that the sentence means has changed."""
    try:
        blueprint = from_text(text).build()
    except Exception:  # the worker meets the same and tells it
        return f"{code_version()} {quick} {text}"
    digest = hashlib.sha256(repr(sorted(blueprint.parameters.items())).encode())
    for part in blueprint.parts:
        digest.update(part.mesh_hash.encode())
    return f"{code_version()} {quick} {digest.hexdigest()[:12]} {text}"


def _brief(result: SentenceResult) -> str:
    return f"{'errors' if result.errors else 'validated'}, {result.seconds:.1f} s"


# ---- tables --------------------------------------------------------------------------------------------------------


def _write(results: Sequence[SentenceResult], facts: dict[str, Any], arguments: argparse.Namespace) -> None:
    groups: dict[str, list[SentenceResult]] = defaultdict(list)
    for result in results:
        groups[result.expected].append(result)
    rows = {name: _numbers(group) for name, group in sorted(groups.items())} | {"**all**": _numbers(results)}
    command = f"python benchmarks/end_to_end.py {' '.join(path.as_posix() for path in arguments.sentences)}"
    command += "" if arguments.each is None else f" --each {arguments.each}"
    command += " --quick" if arguments.quick else ""
    titles = [*TITLES[:9], "moves without error" if arguments.quick else "validated without error", *TITLES[9:]]
    table = [titles, ["---"] * len(titles), *(_cells(name, numbers) for name, numbers in rows.items())]
    text = [
        "# From a sentence to a mechanism", "",
        f"- command: `{command}`",
        f"- {', '.join(f'{name} {facts[name]}' for name in ('kinematify', 'python', 'platform') if name in facts)}", "",
        "Sentences are read and built by the procedural source; the inference sees the parts alone; the joints that",
        "the object was built with are the truth. Read right: the category that a reader expects was built. Means",
        "are over the joints of an object, then over objects; types over all joints; a joint between the wrong parts",
        f"counts 90 deg. All in all: sentence, parts, inference, model folder and {_JUDGED[arguments.quick]}.",
        "Times are wall times, and tell little where other work shared the machine.", "",
        *(f"| {' | '.join(cells)} |" for cells in table), "",
        "## What is wrong", "", *(_faults(results) or ["Nothing."]),
    ]  # fmt: skip
    arguments.output.mkdir(parents=True, exist_ok=True)
    (arguments.output / "end_to_end.md").write_text("\n".join(text) + "\n", encoding="utf-8")
    record = {"schema": 1, "command": command, "environment": facts, "categories": rows,
              "sentences": TypeAdapter(list[SentenceResult]).dump_python(list(results), mode="json")}  # fmt: skip
    (arguments.output / "end_to_end.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    print("\n".join(text))


def _numbers(results: Sequence[SentenceResult]) -> dict[str, float | None]:
    runs = [result.run for result in results if result.run is not None]
    values = summarise(runs).values
    joints = values.get("joints") or 0.0
    return {
        "sentences": len(results),
        "read_right": sum(result.family == result.expected for result in results),
        "joints": joints,
        "types": (values.get("types_right") or 0.0) / joints if joints else None,
        **{name: values.get(name) for name in ("angle_deg", "line_m", "ted", "limit_iou")},
        "passed": fmean(not result.errors and not result.message for result in results),
        "inference_s": median_seconds(runs),
        "seconds": fmean(result.seconds for result in results),
    }


def _cells(name: str, numbers: dict[str, float | None]) -> tuple[str, ...]:
    shown = (("types", 100.0, "{:.1f} %"), ("angle_deg", 1.0, "{:.2f}"), ("line_m", 1e3, "{:.1f}"),
             ("ted", 1.0, "{:.2f}"), ("limit_iou", 1.0, "{:.2f}"), ("passed", 100.0, "{:.0f} %"),
             ("inference_s", 1.0, "{:.1f}"), ("seconds", 1.0, "{:.1f}"))  # fmt: skip
    cells = ["-" if (value := numbers[key]) is None else form.format(scale * value) for key, scale, form in shown]
    counts = [f"{numbers[key]:.0f}" for key in ("sentences", "read_right", "joints")]
    return (name, *counts, *cells)


def _faults(results: Iterable[SentenceResult]) -> list[str]:
    """One line per sentence with something wrong."""
    lines = []
    for result in results:
        joints = result.run.score.joints if result.run is not None and result.run.score is not None else ()
        wrong = [f"{j.joint}: {_fault(j.kind, j.predicted_kind, j.angle_deg)}" for j in joints
                 if not j.type_right or j.angle_deg > WRONG_DEG]  # fmt: skip
        said = [result.message] if result.message else []
        said += [f"read as {result.family}"] if result.family not in {"", result.expected} else []
        said += [*wrong, *(f"validation: {error}" for error in result.errors)]
        lines += [f'- "{result.text}": {"; ".join(said)}'] if said else []
    return lines


def _fault(kind: str, predicted: str | None, angle_deg: float) -> str:
    if predicted is None:
        return "not in the tree"
    return f"{kind}, called {predicted}, {angle_deg:.1f} deg off"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sentences", nargs="*", type=Path, default=[Path("tests/procedural/sentences.yaml")],
                        help="YAML lists of {text, family}")  # fmt: skip
    parser.add_argument("--each", type=int, metavar="N", help="the first N sentences of every category")
    parser.add_argument("--quick", action="store_true", help="judge motion by exact geometry alone, without engines")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--work", type=Path, default=Path(tempfile.gettempdir()) / "kinematify-end-to-end",
                        help="folder for the results so far")  # fmt: skip
    parser.add_argument("-o", "--output", type=Path, default=Path("results"))
    return parser.parse_args()


if __name__ == "__main__":
    main()
