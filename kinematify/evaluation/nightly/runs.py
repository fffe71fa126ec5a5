"""One run of a night, the unit of the history: an object inferred in one pose, or one of its models validated.

Runs of two nights may be compared where their scenario is the same: the hash of all that they depend on besides the
code under test. The values of the inference's own configuration are part of the method: tuning them is what a night
judges, and must not start a new series behind which a regression hides. Its name is part of the scenario; so are the
thresholds of the validation, since they say what is wrong.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import TypeAdapter

from kinematify.evaluation.benchmark_summary import summarise
from kinematify.manipulation.plan_request import PULL

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.config.nightly_settings import NightlySettings
    from kinematify.config.validation import ValidationSettings
    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.datasets import BenchObject, Condition
    from kinematify.evaluation.metrics import JointScore, ObjectScore

SCHEMA = 1
"""Number of the layout of `night.json` and `runs.jsonl`; raised when a reader of the old one would go wrong."""

What = Literal["accuracy", "validation"]
RunKey = tuple[str, str, str]
"""Object, what, case: the same in every night."""


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
    """Hash of all that makes two runs comparable: input, pose, thresholds, but not the code under test."""
    series: str = ""
    """The same without the input: a run of a changed input is compared with the last one of its series."""
    object: str
    kind: str
    category: str
    what: What
    case: str
    """Condition of the benchmark, or ``truth``, ``inferred`` or ``pulled``."""
    status: str
    """``ok``, ``error``, ``timeout``, ``crash``, ``unreadable``; of a validation its verdict, if it came to one."""
    message: str = ""
    """Why there is no answer; empty if there is one."""
    seconds: float = 0.0
    """Wall time [s]."""
    values: dict[str, float | None] = field(default_factory=dict)
    """Metrics of the benchmark, or counts of findings and checks."""
    problems: tuple[Problem, ...] = ()
    not_run: dict[str, str] = field(default_factory=dict)
    """Check -> why it was skipped or blocked, with that word in front."""
    families: dict[str, str] = field(default_factory=dict)
    """Family of checks -> ``pass``, ``warn``, ``fail``, ``skipped`` or ``blocked``, the worst of its checks."""

    @property
    def place(self) -> RunKey:
        """Return the key of the run."""
        return self.object, self.what, self.case

    @property
    def answered(self) -> bool:
        """False where nothing can be said of it: the truth is unreadable, or the validator itself fell over."""
        return self.status not in ("unreadable", "unusable") and not (
            self.what == "validation" and self.status in ("error", "timeout", "crash")
        )


RUN = TypeAdapter(Run)


PULLED = "pulled"
"""Source of a validation in which an arm opens the published model."""
_JUDGES = ("problem_angle", "problem_line", "problem_limits")
"""Settings that say from when on a joint is wrong."""


def accuracy_scenario(item: BenchObject, condition: Condition, settings: NightlySettings) -> tuple[str, str]:
    """Hashes of an object in a condition, with its content and without."""
    return _scenario(
        item,
        {
            "version": settings.version,
            "gripper": item.gripper_joints,
            "condition": asdict(condition),
            "config": Path(settings.infer_config).stem,
            "judges": {name: getattr(settings, name) for name in _JUDGES},
        },
    )


def validation_scenario(
    item: BenchObject, source: str, settings: NightlySettings, thresholds: ValidationSettings
) -> tuple[str, str]:
    """Hashes of a model of an object under the thresholds of the validation, with its content and without."""
    return _scenario(
        item,
        {
            "version": settings.version,
            "source": source,
            "config": Path(settings.infer_config).stem if source == "inferred" else None,
            "engines": list(settings.engines),
            "checks": [f"{PULL} within {settings.pull_budget:g} s"] if source == PULLED else list(settings.checks),
            "thresholds": thresholds.model_dump(mode="json"),
        },
    )


def _scenario(item: BenchObject, facts: dict[str, Any]) -> tuple[str, str]:
    return digest({**facts, "content": item.content_hash}), digest(facts)


def digest(facts: Any) -> str:
    """Twelve characters that represent plain values."""
    return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:12]


LESS_IS_BETTER = ("angle_deg", "line_m", "ted")
MORE_IS_BETTER = ("types", "root", "limit_iou", "opens")
AS_LOADED, OPENED = "as_loaded", "opened"
"""Metrics of a validation: shares of joints that move as loaded, and of ranges that an arm opens."""
JOINTS = "joints"
"""Number of joints of the object: fewer in a changed input are lost ones."""
UNITS = {"angle_deg": "deg", "line_m": "m"}


def accuracy_run(result: JobResult, scenario: tuple[str, str], settings: NightlySettings) -> Run:
    """Return a result with its metrics and, as problems, every joint that is wrong in some respect.

    Args:
        result: Of one object in one condition.
        scenario: Hashes of what it may be compared with, see `accuracy_scenario`.
        settings: From when on a joint is wrong.
    """
    values = summarise([result]).values
    joints = {} if result.score is None else {JOINTS: float(len(result.score.joints))}
    return Run(
        scenario=scenario[0],
        series=scenario[1],
        object=result.object,
        kind=result.kind,
        category=result.category,
        what="accuracy",
        case=result.condition,
        status=result.status,
        message=result.message,
        seconds=round(result.seconds, 3),
        # Six digits behind the point: what is below is the noise of numeric libraries, and would only make diffs.
        values={
            metric: None if (value := values.get(metric)) is None else round(value, 6)
            for metric in (*LESS_IS_BETTER, *MORE_IS_BETTER)
        }
        | dict[str, float | None](joints),
        problems=tuple(_problems(result.score, settings)) if result.score is not None else (),
    )


def _problems(score: ObjectScore, settings: NightlySettings) -> Iterator[Problem]:
    if not score.root_right:
        yield _problem("root", "", "The root of the tree is another part than in truth.")
    for joint in score.joints:
        yield from _joint_problems(joint, score.diagonal, settings)


def _joint_problems(joint: JointScore, diagonal: float, settings: NightlySettings) -> Iterator[Problem]:
    name = joint.joint
    if not joint.matched:
        yield _problem("parent", name, f"No joint was found between {joint.parent} and {joint.child}.")
        return
    if not joint.type_right:
        yield _problem("type", name, f"It is {joint.kind} and was inferred as {joint.predicted_kind}.")
        return
    if joint.angle_deg > settings.problem_angle:
        yield _problem("axis", name, f"The axis is off by {joint.angle_deg:.1f} deg.")
    if joint.line_m is not None and joint.line_m > settings.problem_line * diagonal:
        yield _problem("line", name, f"The axis passes {1e3 * joint.line_m:.3g} mm beside the true one.")
    if joint.limit_iou < settings.problem_limits:
        yield _problem("limits", name, f"The limits overlap with the true ones by {max(0.0, joint.limit_iou):.0%}.")
    if joint.opens is False:
        yield _problem("opens", name, "The positive direction closes it.")


def _problem(aspect: str, joint: str, text: str) -> Problem:
    return Problem(id=f"{aspect} {joint}".strip(), check=aspect, severity="error", text=text)
