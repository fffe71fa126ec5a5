"""Cases of corruption: every kind on every base, and what `kinematify validate` makes of it."""

from __future__ import annotations

import json
import tempfile
import time
import traceback
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.corruption import meshes, text
from kinematify.config.validation import load_settings
from kinematify.errors import InputError
from kinematify.simulation.engines import DEFAULT_ENGINES
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.junit import as_junit
from kinematify.validation.formats.sarif import as_sarif
from kinematify.validation.run import validate
from kinematify.validation.run.report import Unusable, as_json_text

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from benchmarks.corruption.bases import Base
    from benchmarks.study import Record
    from kinematify.validation.run.report import Outcome, ValidationReport

KINDS = (*text.CORRUPTIONS, *meshes.CORRUPTIONS)
_BUILT_SHARE = 0.5
"""Share of the model with a mesh of every format; the rest is drawn from all."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A corrupted model."""

    number: int
    kind: str
    base: str
    urdf: Path


def write_case(number: int, seed: int, bases: Sequence[Base], folder: Path) -> Case:
    """Write the corrupted model of a number into an empty folder."""
    random = np.random.default_rng([seed, number])
    kind = KINDS[number % len(KINDS)]
    base = bases[0] if random.random() < _BUILT_SHARE else bases[int(random.integers(len(bases)))]
    names = sorted(base.meshes)
    harmed = names[int(random.integers(len(names)))] if kind in meshes.CORRUPTIONS and names else None
    for name, path in base.meshes.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(path.read_bytes())
    urdf = folder / "model.urdf"
    if harmed is not None:
        meshes.CORRUPTIONS[kind](folder / harmed, random)
        urdf.write_bytes(base.text)
    else:
        # A model without mesh files loses bytes of its text instead.
        urdf.write_bytes(text.CORRUPTIONS.get(kind, text.flip_bits)(base.text, random))
    return Case(number=number, kind=kind, base=base.name, urdf=urdf)


READY = ("passes", "fails", "no URDF")
"""Outcomes that are right."""


@dataclass(frozen=True, kw_only=True)
class CorruptionTask:
    """One corrupted model to be written and validated."""

    number: int
    seed: int
    bases: tuple[Base, ...]
    seconds: float
    """Time budget of the validation."""
    selected: tuple[str, ...]
    """Ids of the checks."""


def run_case(task: CorruptionTask) -> Record:
    """Write and validate one corrupted model in this process."""
    with tempfile.TemporaryDirectory(prefix="corrupted-", ignore_cleanup_errors=True) as folder:
        case = write_case(task.number, task.seed, task.bases, Path(folder))
        start = time.perf_counter()
        facts = {"number": task.number, "kind": case.kind, "base": case.base}
        try:
            facts |= _validated(case.urdf, task)
        except Exception:
            facts |= {"outcome": "error", "message": traceback.format_exc()[-1500:]}
        return {**facts, "seconds": time.perf_counter() - start}


def _validated(urdf: Path, task: CorruptionTask) -> Record:
    settings = load_settings()
    hurried = settings.model_copy(update={"budget": settings.budget.model_copy(update={"seconds": task.seconds})})
    try:
        asked = {engine for check in task.selected for engine in CHECKS[check].engines}
        engines = [engine for engine in DEFAULT_ENGINES if engine in asked]
        report = validate(urdf, settings=hurried, selected=task.selected, engines=engines, workers=1)
    except InputError as error:
        _write_all(Unusable(model=str(urdf), message=str(error)))
        return {"outcome": "no URDF", "message": str(error)[:200]}
    _write_all(report)
    errors = Counter(finding.check for finding in report.findings if finding.severity is Severity.ERROR)
    outcome = "fails" if report.verdict == "fail" else "passes"
    return {"outcome": outcome, "message": "", "errors": dict(errors), "unexplained": _unexplained(report)}


def _write_all(outcome: Outcome) -> None:
    """Every format must be able to hold what was found."""
    json.loads(as_json_text([outcome]))
    json.loads(as_sarif([outcome]))
    as_junit([outcome]).encode()
    as_html([outcome], {}).encode()


def _unexplained(report: ValidationReport) -> list[str]:
    """Reasons of blocked checks that are no consequence of what was found: something inside gave way."""
    usual = ("the pre-check found", "a mesh cannot be used", "the meshes cannot be used")
    first: dict[str, str] = {}
    for check in report.checks:
        reason = check.reason or ""
        if check.status is Status.BLOCKED and not reason.startswith(usual):
            first.setdefault(reason, f"{check.check} {check.engine or ''}: {reason}"[:400])
    return list(first.values())
