"""The benchmark's results as runs of a night."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.evaluation.nightly.record import Problem, Run
from kinematify.evaluation.summary import summarise

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.evaluation.job import JobResult
    from kinematify.evaluation.metrics import JointScore, ObjectScore
    from kinematify.evaluation.nightly.settings import NightlySettings

LESS_IS_BETTER = ("angle_deg", "line_m", "ted")
MORE_IS_BETTER = ("types", "root", "limit_iou", "opens")
AS_LOADED, OPENED = "as_loaded", "opened"
"""Metrics of a validation: shares of joints that move as loaded, and of ranges that an arm opens."""
METRICS = (*LESS_IS_BETTER, *MORE_IS_BETTER)
UNITS = {"angle_deg": "deg", "line_m": "m"}


def accuracy_run(result: JobResult, scenario: str, settings: NightlySettings) -> Run:
    """Return a result with its metrics and, as problems, every joint that is wrong in some respect.

    Args:
        result: Of one object in one condition.
        scenario: Hash of what it may be compared with.
        settings: From when on a joint is wrong.
    """
    values = summarise([result]).values
    return Run(
        scenario=scenario,
        object=result.object,
        kind=result.kind,
        category=result.category,
        what="accuracy",
        case=result.condition,
        status=result.status,
        message=result.message,
        seconds=round(result.seconds, 3),
        values={metric: _rounded(values.get(metric)) for metric in METRICS},
        problems=tuple(_problems(result.score, settings)) if result.score is not None else (),
    )


def _rounded(value: float | None) -> float | None:
    """Six digits behind the point: what is below is the noise of numeric libraries, and would only make diffs."""
    return None if value is None else round(value, 6)


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
