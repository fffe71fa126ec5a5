"""One run of a night, the unit of the history: an object inferred in one pose, or one of its models validated.

Runs of two nights are compared where their scenario is the same: the hash of all that they depend on besides the object
and the code under test. The values of the inference's own configuration are part of the method: tuning them is what a
night judges. Its name is part of the scenario; so are the thresholds of the validation, since they say what is wrong.
"""

from __future__ import annotations

import hashlib
import json
import tempfile
import time
from collections import defaultdict
from dataclasses import asdict, dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING, Any, Literal

from pydantic import TypeAdapter

from kinematify.config import load_config
from kinematify.config.nightly_settings import NightlySettings
from kinematify.config.validation import load_settings
from kinematify.evaluation.benchmark_job import erased_item, imported, shown_parts
from kinematify.evaluation.benchmark_summary import summarise
from kinematify.evaluation.datasets import CONDITIONS, BenchObject
from kinematify.manipulation.plan_request import TaskRequest
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity, Status
from kinematify.validation.formats.report_content import where
from kinematify.validation.run import validate
from kinematify.validation.run.report import severity_counts

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.metrics import JointScore, ObjectScore
    from kinematify.validation.finding import CheckResult, Finding
    from kinematify.validation.run.report import ValidationReport

SCHEMA = 2
AS_LOADED, OPENED, JOINTS = "as_loaded", "opened", "joints"
"""Shares of joints that move in the untouched file, and of ranges that an arm opens; number of joints."""
GATES: dict[str, tuple[float, float]] = {
    "angle_deg": (-1.0, 0.1),
    "line_m": (-1.0, 1.0e-4),
    "ted": (-1.0, 0.5),
    "types": (1.0, 0.001),  # one wrong joint of 30 is 0.03
    "root": (1.0, 0.5),
    "limit_iou": (1.0, 0.01),  # the grid of a sweep moves a limit by less
    "opens": (1.0, 0.001),
    AS_LOADED: (1.0, 0.001),
    OPENED: (1.0, 0.05),  # plans follow the seed, but numeric libraries may turn them
    JOINTS: (1.0, 0.5),  # a joint less is a lost one
}
"""Metric -> whether more is better (1) or worse (-1), and the largest loss against the compared night that is none.

The inference is deterministic: these values cover other versions of numeric libraries alone.
"""
ACCURACY = tuple(GATES)[:7]
PULLED = "pulled"
"""Source of a validation in which an arm opens the published model."""
_ANGLE = 5.0  # as S2O and others count an axis as wrong [deg]
_LINE = 0.02  # of the object's diagonal
_LIMITS = 0.5  # they are upper bounds by nature
_TRIED = " opened"
"""After the name of a joint, in what KV705 measures."""
_STATES = ("fail", "warn", "blocked", "pass", "skipped")
"""Of a family, the worst first; skipped only where nothing else is left, for much does not apply to every model."""


@dataclass(frozen=True, kw_only=True)
class Problem:
    """One thing that is wrong; known again in another night by its id."""

    id: str
    """Check or aspect, then the place, e.g. ``KV312 [mujoco] hinge_1`` or ``axis hinge_1``."""
    check: str
    """Key of the check (``KV312``, ``KV804 [mujoco]``) or aspect of a joint (``axis``) that it belongs to."""
    severity: Literal["error", "warning"]
    text: str
    """A sentence with the numbers, which may change from night to night."""


@dataclass(frozen=True, kw_only=True)
class Run:
    """Result of one run."""

    scenario: str
    """Hash of all that makes two runs comparable: pose, thresholds, but neither the files nor the code under test."""
    content: str
    """Hash of the object's files."""
    object: str
    kind: str
    what: Literal["accuracy", "validation"]
    case: str
    """Condition of the benchmark, or ``truth``, ``inferred`` or ``pulled``."""
    status: str
    """``ok``, ``error``, ``timeout``, ``crash``, ``unreadable``; of a validation its verdict, if it came to one."""
    message: str = ""
    """Why there is no answer; empty if there is one."""
    seconds: float = 0.0
    """Wall time [s]."""
    values: dict[str, float | None] = field(default_factory=dict)
    """Metrics of `GATES`, and counts of findings."""
    problems: tuple[Problem, ...] = ()
    not_run: dict[str, str] = field(default_factory=dict)
    """Check -> why it was skipped or blocked, with that word in front."""
    families: dict[str, str] = field(default_factory=dict)
    """Family of checks -> ``pass``, ``warn``, ``fail``, ``skipped`` or ``blocked``, the worst of its checks."""

    @property
    def place(self) -> tuple[str, str, str]:
        """Object, what, case: the same in every night."""
        return self.object, self.what, self.case

    @property
    def answered(self) -> bool:
        """False where nothing can be said of it: the truth is unreadable, or the validator itself fell over."""
        return self.status not in ("unreadable", "unusable") and not (
            self.what == "validation" and self.status in ("error", "timeout", "crash")
        )

    @property
    def reported(self) -> bool:
        """True if there is something to tell of it."""
        return bool(self.problems) or not self.answered


RUN = TypeAdapter(Run)


def digest(facts: Any) -> str:
    """Twelve characters that represent plain values."""
    return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:12]


def accuracy_run(result: JobResult, item: BenchObject, settings: NightlySettings) -> Run:
    """Return a result with its metrics and, as problems, every joint that is wrong in some respect."""
    condition = next(asdict(condition) for condition in CONDITIONS if condition.name == result.condition)
    values = summarise([result]).values
    # Six digits behind the point: what is below is the noise of numeric libraries.
    known = {name: None if (value := values.get(name)) is None else round(value, 6) for name in ACCURACY}
    joints = {} if result.score is None else {JOINTS: float(len(result.score.joints))}
    return Run(
        scenario=digest([SCHEMA, condition, Path(settings.infer_config).stem, item.gripper_joints]),
        content=item.content_hash,
        object=result.object,
        kind=result.kind,
        what="accuracy",
        case=result.condition,
        status=result.status,
        message=result.message,
        seconds=round(result.seconds, 3),
        values={**known, **joints},
        problems=tuple(_joint_problems(result.score)) if result.score is not None else (),
    )


def _joint_problems(score: ObjectScore) -> Iterator[Problem]:
    if not score.root_right:
        yield Problem(
            id="root", check="root", severity="error", text="The root of the tree is another part than in truth."
        )
    for joint in score.joints:
        for aspect, text in _wrong_aspects(joint, score.diagonal):
            yield Problem(id=f"{aspect} {joint.joint}", check=aspect, severity="error", text=text)


def _wrong_aspects(joint: JointScore, diagonal: float) -> Iterator[tuple[str, str]]:
    if not joint.matched:
        yield "parent", f"No joint was found between {joint.parent} and {joint.child}."
        return
    if not joint.type_right:
        yield "type", f"It is {joint.kind} and was inferred as {joint.predicted_kind}."
        return
    if joint.angle_deg > _ANGLE:
        yield "axis", f"The axis is off by {joint.angle_deg:.1f} deg."
    if joint.line_m is not None and joint.line_m > _LINE * diagonal:
        yield "line", f"The axis passes {1e3 * joint.line_m:.3g} mm beside the true one."
    if joint.limit_iou < _LIMITS:
        yield "limits", f"The limits overlap with the true ones by {max(0.0, joint.limit_iou):.0%}."
    if joint.opens is False:
        yield "opens", "The positive direction closes it."


@dataclass(frozen=True, kw_only=True)
class ModelJob:
    """Model to validate in a night; small and picklable."""

    item: BenchObject
    source: str
    """``truth``: the file as it is; ``inferred``: what `kinematify infer` writes of its parts at rest; `PULLED`."""
    settings: NightlySettings
    infer: str
    """Function under test, as ``module:name``."""

    def run(self, status: str, seconds: float, message: str = "") -> Run:
        """Return a run of this validation without any detail."""
        asked, inferred = self.settings, self.source == "inferred"
        thresholds = load_settings(asked.validation_config).model_dump(mode="json")
        config = Path(asked.infer_config).stem if inferred else None
        return Run(
            scenario=digest([SCHEMA, self.source, config, asked.engines, asked.checks, thresholds]),
            content=self.item.content_hash,
            object=self.item.name,
            kind=self.item.kind,
            what="validation",
            case=self.source,
            status=status,
            message=message,
            seconds=round(seconds, 3),
        )


def validation_run(job: ModelJob) -> Run:
    """Validate the model."""
    asked = job.settings
    patterns = ["KV7*"] if job.source == PULLED else asked.checks
    selected = [check for check in CHECKS if any(fnmatchcase(check, word) for word in patterns)]
    with tempfile.TemporaryDirectory(prefix="kinematify-", ignore_cleanup_errors=True) as folder:
        urdf, package_dirs = job.item.urdf, tuple(map(str, job.item.package_dirs))
        if job.source == "inferred":
            parts = shown_parts(erased_item(job.item, CONDITIONS[0]))
            inference = imported(job.infer)(parts, config=load_config(asked.infer_config))
            urdf, package_dirs = write_model(simulable_model(inference.model, inference.config).robot, Path(folder)), ()
        settings = load_settings(asked.validation_config)
        patient = settings.budget.model_copy(update={"seconds": asked.budget})
        start = time.perf_counter()
        report = validate(
            urdf,
            package_dirs=package_dirs,
            settings=settings.model_copy(update={"budget": patient}),
            selected=selected,
            engines=tuple(asked.engines),
            task=TaskRequest() if job.source == PULLED else None,
            workers=1,
        )
        return _kept(job.run(report.verdict, time.perf_counter() - start), report, selected, asked.engines)


def _kept(run: Run, report: ValidationReport, selected: Sequence[str], engines: Sequence[str]) -> Run:
    """Return what a night keeps of a report: what is wrong, what did not run, and counts."""
    checks = [item for item in report.checks if item.check in selected and item.engine in (None, *engines)]
    counted = severity_counts(report)
    left = {
        _key(check): f"{check.status.value}: {check.reason or 'no reason given'}"
        for check in checks
        if check.status in (Status.SKIPPED, Status.BLOCKED)
    }
    families: dict[str, set[str]] = defaultdict(set)
    for check in checks:
        families[check.check[:3]].add(_state(check))
    return replace(
        run,
        values={
            **{f"{severity.value}s": float(counted.get(severity, 0)) for severity in Severity},
            **_shares(checks),
            JOINTS: float(len(report.joints)),
        },
        problems=_problems(checks),
        not_run=left,
        families={family: min(states, key=_STATES.index) for family, states in families.items()},
    )


def _shares(checks: Sequence[CheckResult[Finding]]) -> dict[str, float]:
    """Shares of joints that move as loaded, in the engine that moves the fewest, and of ranges that an arm opens."""
    moved = [item.measured for item in checks if item.check == "KV804" and item.measured.get("joints")]
    tried = [item.measured.items() for item in checks if item.check == "KV705"]
    opened = [value for measured in tried for name, value in measured if name.endswith(_TRIED)]
    found = {AS_LOADED: min(item["right"] / item["joints"] for item in moved)} if moved else {}
    return found | ({OPENED: fmean(opened)} if opened else {})


def _key(check: CheckResult[Finding]) -> str:
    """Id of a check with its engine, as problems and skipped checks name it."""
    return f"{check.check} [{check.engine}]" if check.engine else check.check


def _problems(checks: Sequence[CheckResult[Finding]]) -> tuple[Problem, ...]:
    """Errors and warnings; where a check says the same of one place twice, a number distinguishes the two."""
    seen: dict[str, int] = defaultdict(int)
    problems = []
    for check in checks:
        for finding in check.findings:
            if finding.severity is Severity.NOTE or finding.suppressed is not None:
                continue
            # The finding may name another engine than the check, but the check decides what is skipped.
            name = f"{_key(check)} {where(finding)}".strip()
            seen[name] += 1
            number = f" ({seen[name]})" if seen[name] > 1 else ""
            severity: Literal["error", "warning"] = "error" if finding.severity is Severity.ERROR else "warning"
            problems.append(Problem(id=name + number, check=_key(check), severity=severity, text=finding.message))
    return tuple(problems)


def _state(check: CheckResult[Finding]) -> str:
    if check.status is not Status.FAIL:
        return check.status.value
    errors = any(finding.severity is Severity.ERROR and finding.suppressed is None for finding in check.findings)
    return "fail" if errors else "warn"
