"""Means of benchmark results: over conditions for each object, then over objects."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import asdict, dataclass
from statistics import fmean
from typing import TYPE_CHECKING, Any

from kinematify.evaluation.metrics import CLOSE_ANGLE
from kinematify.evaluation.result_record import grouped
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from kinematify.evaluation.benchmark_job import JobResult
    from kinematify.evaluation.metrics import JointScore, ObjectScore

    Numbers = Mapping[str, float | None]


@dataclass(frozen=True, kw_only=True)
class Summary:
    """Numbers of a group of results."""

    objects: int
    runs: int
    failed_runs: int
    """Inferences that gave no answer; they are scored as if they had predicted nothing."""
    unscored_runs: int
    """Runs whose truth could not be read; they are in no mean."""
    values: Numbers
    """Metric -> mean over objects of the mean over runs; None where no run has a value. `joints` and `types_right` are
    sums over objects, `peak_mb` is the largest."""


_SUMMED = ("joints", "types_right")


def summarise(results: Iterable[JobResult], *, with_gripper: bool = True) -> Summary:
    """Return the numbers of a group.

    Args:
        results: Runs of one configuration.
        with_gripper: False leaves out gripper fingers, as the paper's counts do.
    """
    by_object: dict[str, list[Numbers]] = defaultdict(list)
    runs = list(results)
    for result in runs:
        if result.score is not None:
            by_object[result.object].append(_numbers(result, result.score, with_gripper))
    objects = [_per_metric(group) for group in by_object.values()]
    return Summary(
        objects=len(by_object),
        runs=len(runs),
        failed_runs=sum(run.status != "ok" for run in runs),
        unscored_runs=sum(run.score is None for run in runs),
        values=_per_metric(objects, sums=_SUMMED) if objects else {},
    )


def _per_metric(rows: Sequence[Numbers], sums: Sequence[str] = ()) -> Numbers:
    values: dict[str, float | None] = {name: _mean(row[name] for row in rows) for name in rows[0]}
    values.update({name: sum(row[name] or 0.0 for row in rows) for name in sums})
    peaks = [row["peak_mb"] for row in rows]
    values["peak_mb"] = max((peak for peak in peaks if peak is not None), default=None)
    return values


@dataclass(frozen=True, kw_only=True)
class TypeSummary:
    """All joints of one true type together, each run's joint counting once."""

    kind: str
    joints: int
    types_right: float
    """Share."""
    angle_deg: float
    angle_given_type_deg: float
    close: float
    """Share of joints within `CLOSE_ANGLE`."""
    close_given_type: float


def summarise_types(results: Iterable[JobResult]) -> tuple[TypeSummary, ...]:
    """Return one row for turning and one for sliding joints, and one for all."""
    joints = [joint for result in results if result.score is not None for joint in result.score.joints]
    groups: dict[str, Callable[[JointScore], bool]] = {
        "revolute or continuous": lambda joint: joint.kind != JointType.PRISMATIC,
        "prismatic": lambda joint: joint.kind == JointType.PRISMATIC,
        "all": lambda joint: True,
    }
    chosen = {kind: [joint for joint in joints if belongs(joint)] for kind, belongs in groups.items()}
    return tuple(_type_summary(kind, group) for kind, group in chosen.items() if group)


def _type_summary(kind: str, joints: Sequence[JointScore]) -> TypeSummary:
    return TypeSummary(
        kind=kind,
        joints=len(joints),
        types_right=fmean(joint.type_right for joint in joints),
        angle_deg=fmean(joint.angle_deg for joint in joints),
        angle_given_type_deg=fmean(joint.angle_given_type_deg for joint in joints),
        close=fmean(joint.angle_deg <= CLOSE_ANGLE for joint in joints),
        close_given_type=fmean(joint.angle_given_type_deg <= CLOSE_ANGLE for joint in joints),
    )


def summaries(results: Iterable[JobResult]) -> list[dict[str, Any]]:
    """Return plain values of every configuration, kind of object and input, with gripper fingers and without."""
    groups = grouped(results, by=lambda result: (result.variant, result.kind, result.input))
    return [
        {
            "variant": variant,
            "kind": kind,
            "input": given,
            "with_gripper": asdict(summarise(group)),
            "without_gripper": asdict(summarise(group, with_gripper=False)),
            "types": [asdict(summary) for summary in summarise_types(group)],
        }
        for (variant, kind, given), group in groups.items()
    ]


def _numbers(result: JobResult, score: ObjectScore, with_gripper: bool) -> Numbers:
    joints = [joint for joint in score.joints if with_gripper or not joint.gripper]
    ted = score.ted if with_gripper else score.ted_without_gripper
    return {
        "joints": float(len(joints)),
        **_axis_numbers(joints, score.diagonal),
        "types_right": float(sum(joint.type_right for joint in joints)),
        "types": _mean(joint.type_right for joint in joints),
        "types_strict": _mean(joint.type_right_strict for joint in joints),
        "limit_iou": _mean(joint.limit_iou for joint in joints),
        "opens": _mean(joint.opens for joint in joints),
        "ted": float(ted.value),
        "ted_exact": float(ted.exact),
        "ted_unlabelled": float(score.ted_unlabelled.value),
        "parent_errors": float(score.parent_errors),
        "root": float(score.root_right),
        "seconds": result.seconds,
        "peak_mb": result.peak_mb,
    }


def _axis_numbers(joints: Sequence[JointScore], diagonal: float) -> Numbers:
    line = _mean(joint.line_m for joint in joints)
    return {
        "matched": _mean(joint.matched for joint in joints),
        "angle_deg": _mean(joint.angle_deg for joint in joints),
        "angle_matched_deg": _mean(joint.angle_deg for joint in joints if joint.matched),
        "angle_given_type_deg": _mean(joint.angle_given_type_deg for joint in joints),
        "line_m": line,
        "line_percent": None if line is None else 100.0 * line / diagonal,
        "line_joints": float(sum(joint.line_m is not None for joint in joints)),
        "pivot_m": _mean(joint.pivot_m for joint in joints),
    }


def _mean(values: Iterable[float | None]) -> float | None:
    """Mean of the values that exist."""
    known = [value for value in values if value is not None]
    return fmean(known) if known else None
