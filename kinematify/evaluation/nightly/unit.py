"""One validation of a night in a process of its own: ``python -m kinematify.evaluation.nightly.unit REQUEST ANSWER``.

Whatever happens to it, the night goes on.
"""

from __future__ import annotations

import ctypes
import importlib
import signal
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from pydantic import TypeAdapter

from kinematify.assembly.erase import erase
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.evaluation.nightly.record import Problem
from kinematify.model.urdf import write_urdf
from kinematify.robot.read import read_robot
from kinematify.validation.catalogue import CATALOGUE
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.picture import scene_of
from kinematify.validation.formats.text import where
from kinematify.validation.outcome import severity_counts, status_counts
from kinematify.validation.run import validate

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.validation.finding import CheckResult, Finding
    from kinematify.validation.report import ValidationReport

_DIE_WITH_PARENT = 1  # PR_SET_PDEATHSIG of prctl(2)
_STATES = ("fail", "warn", "blocked", "pass", "skipped")
"""Of a family, the worst first; skipped only where nothing else is left, for much does not apply to every model."""


@dataclass(frozen=True, kw_only=True)
class UnitRequest:
    """What to validate."""

    urdf: str
    package_dirs: tuple[str, ...]
    source: str
    """``truth``: the file as it is; ``inferred``: what the inference makes of its parts at rest."""
    infer: str
    """Function under test, as ``module:name``."""
    infer_config: str
    validation_config: str
    engines: tuple[str, ...]
    checks: tuple[str, ...]
    """Ids or patterns."""
    budget: float
    """[s]."""
    title: str
    """Of the model, as a page names it."""
    page: str
    """File for the page of the model; empty for none."""


@dataclass(frozen=True, kw_only=True)
class UnitAnswer:
    """The part of a validation report that a night keeps."""

    status: str
    seconds: float
    message: str = ""
    values: dict[str, float | None] = field(default_factory=dict)
    problems: tuple[Problem, ...] = ()
    not_run: dict[str, str] = field(default_factory=dict)
    families: dict[str, str] = field(default_factory=dict)


REQUEST = TypeAdapter(UnitRequest)
ANSWER = TypeAdapter(UnitAnswer)


def main(request_file: str, answer_file: str) -> None:
    """Answer a request; the answer appears whole or not at all."""
    _die_with_the_night()
    request = REQUEST.validate_json(Path(request_file).read_bytes())
    start = time.perf_counter()
    try:
        answer = _answer(request)
    except Exception as error:  # the boundary of a unit: one bad object never ends the night
        seconds = round(time.perf_counter() - start, 3)
        answer = UnitAnswer(status="error", seconds=seconds, message=f"{type(error).__name__}: {error}")
    aside = Path(f"{answer_file}.partly")
    aside.write_bytes(ANSWER.dump_json(answer))
    aside.replace(answer_file)


def _die_with_the_night() -> None:
    """A night that is killed takes its validations with it, so that they do not slow down the one that resumes."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_DIE_WITH_PARENT, signal.SIGKILL)


def _answer(request: UnitRequest) -> UnitAnswer:
    with tempfile.TemporaryDirectory(prefix="kinematify-", ignore_cleanup_errors=True) as folder:
        urdf, package_dirs = Path(request.urdf), request.package_dirs
        if request.source == "inferred":
            urdf, package_dirs = _inferred(request, Path(folder)), ()
        selected = [check for check in CATALOGUE if any(fnmatchcase(check, word) for word in request.checks)]
        start = time.perf_counter()
        report = validate(
            urdf,
            package_dirs=package_dirs,
            settings=_patient(load_settings(request.validation_config), request.budget),
            selected=selected,
            engines=request.engines,
            workers=1,
        )
        if request.page:
            _write_page(request, urdf, tuple(map(Path, package_dirs)), report)
        return kept(report, time.perf_counter() - start, selected, request.engines)


def _write_page(request: UnitRequest, urdf: Path, package_dirs: tuple[Path, ...], report: ValidationReport) -> None:
    """Write the page that `kinematify validate --html` would, but for the picture, which takes seconds."""
    named = replace(report, model=request.title)
    scene = scene_of(urdf, package_dirs)
    Path(request.page).parent.mkdir(parents=True, exist_ok=True)
    Path(request.page).write_text(as_html([named], {}, {named.model: scene}), encoding="utf-8")


def _inferred(request: UnitRequest, folder: Path) -> Path:
    """Write the model that the inference makes of the anonymous parts of an object at rest."""
    package_dirs = tuple(map(Path, request.package_dirs))
    erased = erase(read_robot(Path(request.urdf), package_dirs=package_dirs, geometry="shown"), pose="rest", seed=0)
    module, _, name = request.infer.partition(":")
    infer = getattr(importlib.import_module(module), name)
    inference = infer(Assembly(parts=erased.parts, source="nightly"), config=load_config(request.infer_config))
    write_urdf(inference.model, folder)
    return folder / "model.urdf"


def _patient(settings: ValidationSettings, seconds: float) -> ValidationSettings:
    budget = settings.budget.model_copy(update={"seconds": seconds, "stage_seconds": seconds})
    return settings.model_copy(update={"budget": budget})


def kept(report: ValidationReport, seconds: float, selected: Collection[str], engines: Collection[str]) -> UnitAnswer:
    """Return what a night keeps of a report: what is wrong, what did not run, and counts.

    Args:
        report: Of one model.
        seconds: That it took.
        selected: Checks that were asked for; others are left out.
        engines: That were asked for; likewise.
    """
    asked = [check for check in report.checks if check.check in selected]
    checks = [check for check in asked if check.engine is None or check.engine in engines]
    severities, statuses = severity_counts(report), status_counts(report)
    counts = {f"{severity.value}s": severities.get(severity, 0) for severity in Severity}
    counts |= {status.value: statuses.get(status, 0) for status in Status}
    left = {
        check_key(check): f"{check.status.value}: {check.reason or 'no reason given'}"
        for check in checks
        if check.status in (Status.SKIPPED, Status.BLOCKED)
    }
    return UnitAnswer(
        status=report.verdict,
        seconds=round(seconds, 3),
        values={name: float(count) for name, count in counts.items()},
        problems=_problems(checks),
        not_run=left,
        families=_families(checks),
    )


def check_key(item: CheckResult | Finding) -> str:
    """Id of a check with its engine, as problems and skipped checks name it."""
    return f"{item.check} [{item.engine}]" if item.engine else item.check


def _problems(checks: Sequence[CheckResult]) -> tuple[Problem, ...]:
    """Errors and warnings; where a check says the same of one place twice, a number tells the two apart."""
    seen: dict[str, int] = defaultdict(int)
    problems = []
    for check in checks:
        for finding in check.findings:
            if finding.severity is Severity.NOTE or finding.suppressed is not None:
                continue
            # The finding may name another engine than the check, but the check decides what is skipped.
            name = f"{check_key(check)} {where(finding)}".strip()
            seen[name] += 1
            number = f" ({seen[name]})" if seen[name] > 1 else ""
            severity: Literal["error", "warning"] = "error" if finding.severity is Severity.ERROR else "warning"
            problems.append(Problem(id=name + number, check=check_key(check), severity=severity, text=finding.message))
    return tuple(problems)


def _families(checks: Sequence[CheckResult]) -> dict[str, str]:
    """State of each family of checks, the worst of its checks."""
    found: dict[str, set[str]] = defaultdict(set)
    for check in checks:
        found[check.check[:3]].add(_state(check))
    return {family: next(state for state in _STATES if state in states) for family, states in found.items()}


def _state(check: CheckResult) -> str:
    if check.status is not Status.FAIL:
        return check.status.value
    errors = any(finding.severity is Severity.ERROR and finding.suppressed is None for finding in check.findings)
    return "fail" if errors else "warn"


if __name__ == "__main__":
    main(*sys.argv[1:])
