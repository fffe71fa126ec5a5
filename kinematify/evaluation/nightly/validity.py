"""One validation of a night: the published model of an object, or what is inferred from its parts at rest."""

from __future__ import annotations

import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING, Literal

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.evaluation.benchmark_job import erased_item, imported, shown_parts
from kinematify.evaluation.datasets import CONDITIONS, BenchObject
from kinematify.evaluation.nightly.runs import AS_LOADED, JOINTS, OPENED, PULLED, Problem, Run
from kinematify.manipulation.plan_request import PULL, TaskRequest
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.report_content import where
from kinematify.validation.formats.report_picture import scene_of
from kinematify.validation.run import validate
from kinematify.validation.run.outcome import severity_counts, status_counts

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from kinematify.validation.finding import CheckResult, Finding
    from kinematify.validation.run.report import ValidationReport

_OPENED = " opened"
"""After the name of a joint, in what KV705 measures."""
_STATES = ("fail", "warn", "blocked", "pass", "skipped")
"""Of a family, the worst first; skipped only where nothing else is left, for much does not apply to every model."""


@dataclass(frozen=True, kw_only=True)
class NightValidation:
    """Models to validate in a night."""

    item: BenchObject
    scenario: tuple[str, str]
    source: str
    """``truth``: the file as it is; ``inferred``: what `kinematify infer` writes of its parts at rest; `PULLED`."""
    infer: str
    """Function under test, as ``module:name``."""
    infer_config: str
    validation_config: str
    engines: tuple[str, ...]
    checks: tuple[str, ...]
    """Ids or patterns."""
    budget: float
    """[s]."""
    pages: Path | None
    """Folder for the page of the model; None for none."""

    def run(self, status: str, seconds: float, message: str = "") -> Run:
        """Return a run of this validation that has nothing to tell yet."""
        return Run(
            scenario=self.scenario[0],
            series=self.scenario[1],
            object=self.item.name,
            kind=self.item.kind,
            category=self.item.category,
            what="validation",
            case=self.source,
            status=status,
            message=message,
            seconds=round(seconds, 3),
        )


def run_validation(validation: NightValidation) -> Run:
    """Validate the model."""
    with tempfile.TemporaryDirectory(prefix="kinematify-", ignore_cleanup_errors=True) as folder:
        urdf, package_dirs = validation.item.urdf, validation.item.package_dirs
        if validation.source == "inferred":
            urdf, package_dirs = _inferred(validation, Path(folder)), ()
        selected = [check for check in CHECKS if any(fnmatchcase(check, word) for word in validation.checks)]
        settings = load_settings(validation.validation_config)
        patient = settings.budget.model_copy(update={"seconds": validation.budget})
        start = time.perf_counter()
        report = validate(
            urdf,
            package_dirs=tuple(map(str, package_dirs)),
            settings=settings.model_copy(update={"budget": patient}),
            selected=selected,
            engines=validation.engines,
            task=TaskRequest(kind=PULL) if validation.source == PULLED else None,
            workers=1,
        )
        if validation.pages is not None:
            _write_page(validation, urdf, report, validation.pages)
        return kept(validation, report, time.perf_counter() - start, selected)


def _write_page(validation: NightValidation, urdf: Path, report: ValidationReport, folder: Path) -> None:
    """Write the page that `kinematify validate --html` would, but for the picture, which takes seconds."""
    package_dirs = validation.item.package_dirs if validation.source == "truth" else ()
    named = replace(report, model=f"{validation.item.name}, {validation.source} model")
    scene = scene_of(urdf, package_dirs)
    folder.mkdir(parents=True, exist_ok=True)
    page = folder / page_name(validation.item.name, validation.source)
    page.write_text(as_html([named], {}, {named.model: scene}), encoding="utf-8")


def page_name(item: str, source: str) -> str:
    """File of the page of a model; names of objects may hold what no file name can."""
    plain = "".join(letter if letter.isascii() and (letter.isalnum() or letter in "._-") else "-" for letter in item)
    return f"{plain}-{source}.html"


def _inferred(validation: NightValidation, folder: Path) -> Path:
    """Write the model that the inference makes of the anonymous parts of an object at rest."""
    parts = shown_parts(erased_item(validation.item, CONDITIONS[0]))
    inference = imported(validation.infer)(parts, config=load_config(validation.infer_config))
    return write_model(simulable_model(inference.model, inference.config).robot, folder)


def kept(validation: NightValidation, report: ValidationReport, seconds: float, selected: Collection[str]) -> Run:
    """Return what a night keeps of a report: what is wrong, what did not run, and counts.

    Args:
        validation: That was asked for; checks of other engines are omitted.
        report: Of the model.
        seconds: That it took.
        selected: Checks that were asked for; others are omitted.
    """
    asked = [check for check in report.checks if check.check in selected]
    checks = [check for check in asked if check.engine is None or check.engine in validation.engines]
    severities, statuses = severity_counts(report), status_counts(report)
    counts = {f"{severity.value}s": severities.get(severity, 0) for severity in Severity}
    counts |= {status.value: statuses.get(status, 0) for status in Status}
    left = {
        check_key(check): f"{check.status.value}: {check.reason or 'no reason given'}"
        for check in checks
        if check.status in (Status.SKIPPED, Status.BLOCKED)
    }
    return replace(
        validation.run(report.verdict, seconds),
        values={
            **{name: float(count) for name, count in counts.items()},
            **_shares(checks),
            JOINTS: float(len(report.joints)),
        },
        problems=_problems(checks),
        not_run=left,
        families=_families(checks),
    )


def _shares(checks: Sequence[CheckResult]) -> dict[str, float]:
    """Shares of joints that move as loaded, in the engine that moves the fewest, and of ranges that an arm opens."""
    moved = [item.measured for item in checks if item.check == "KV804" and item.measured.get("joints")]
    opened = [
        value
        for item in checks
        if item.check == "KV705"
        for name, value in item.measured.items()
        if name.endswith(_OPENED)
    ]
    found = {AS_LOADED: min(item["right"] / item["joints"] for item in moved)} if moved else {}
    return found | ({OPENED: fmean(opened)} if opened else {})


def check_key(item: CheckResult | Finding) -> str:
    """Id of a check with its engine, as problems and skipped checks name it."""
    return f"{item.check} [{item.engine}]" if item.engine else item.check


def _problems(checks: Sequence[CheckResult]) -> tuple[Problem, ...]:
    """Errors and warnings; where a check says the same of one place twice, a number distinguishes the two."""
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
