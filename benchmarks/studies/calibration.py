"""How far the confidence of a joint can be believed, on objects of a seed that nothing was fitted on.

A joint is right if its parent, its type (continuous counts as revolute) and its axis are: within 5 deg, and, where it
turns, within 5 % of the object's diagonal. The joints are inferred from the parts alone.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np
from pydantic import Field

from benchmarks.study import Options, Study, explained
from benchmarks.tables import is_right
from kinematify.batch.corpus import write_corpus
from kinematify.evaluation.record import table
from kinematify.evaluation.run import BenchmarkRequest, run_benchmark

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.figure import Figure

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.job import JobResult
    from kinematify.evaluation.record import Report

BINS = 10
LEAST = 0.2
"""Share of the joints, those of least confidence, whose share of the errors is reported."""


class CalibrationOptions(Options):
    """Which objects."""

    count: int = Field(180, ge=1, description="Generated objects.")
    seed: int = Field(
        1213, description="Draws them; the confidence was fitted on 5417, and 909 was looked at meanwhile."
    )
    conditions: tuple[str, ...] = Field(("rest",), description="Poses, separated by commas.")


def measure(options: CalibrationOptions, work: Work) -> Measured:
    """Write the objects, infer them and compare."""
    corpus = work.folder / f"{options.seed}-{options.count}"
    pool = work.pool
    write_corpus(corpus, options.count, seed=options.seed, progress=pool.progress, workers=pool.workers)
    request = BenchmarkRequest(
        data=corpus,
        conditions=options.conditions,
        work_folder=work.folder,
        fresh=pool.fresh,
        workers=pool.workers,
        timeout=300.0,
    )
    joints = judged_joints(run_benchmark(request, pool.progress).records)
    return [asdict(joint) for joint in joints], asdict(reliability(joints))


@dataclass(frozen=True, kw_only=True)
class ScoredJoint:
    """A joint with what was said of it."""

    object: str
    category: str
    joint: str
    confidence: float
    right: bool


@dataclass(frozen=True, kw_only=True)
class Bin:
    """Joints of like confidence."""

    joints: int
    confidence: float
    """Mean."""
    right: float
    """Share."""


@dataclass(frozen=True, kw_only=True)
class Reliability:
    """How far confidences can be believed."""

    joints: int
    right: float
    """Share."""
    mean_confidence: float
    ece: float
    """Expected calibration error: mean distance between confidence and share of right ones, over bins of as many joints
    each."""
    ece_width: float
    """The same over bins of equal width in confidence."""
    errors_in_least: float
    """Share of all errors among the `LEAST` joints of least confidence."""
    best_errors_in_least: float
    """What a perfect order would reach: 1, or less where more than `LEAST` of the joints are wrong."""
    auc: float
    """Probability that a right joint has more confidence than a wrong one."""
    bins: tuple[Bin, ...]
    """Of equal width."""


def judged_joints(results: Iterable[JobResult]) -> list[ScoredJoint]:
    """All joints with a confidence; those that have none represent no answer."""
    return [
        ScoredJoint(
            object=result.object,
            category=result.category,
            joint=joint.joint,
            confidence=joint.confidence,
            right=is_right(joint, result.score.diagonal),
        )
        for result in results
        if result.score is not None
        for joint in result.score.joints
        if joint.confidence is not None
    ]


def reliability(joints: Sequence[ScoredJoint]) -> Reliability:
    """Compare what was said with what was right.

    Args:
        joints: At least one.
    """
    said = np.array([joint.confidence for joint in joints])
    right = np.array([joint.right for joint in joints], dtype=np.float64)
    order = np.argsort(said, kind="stable")
    equal = np.array_split(order, min(BINS, len(order)))
    width = np.minimum((said * BINS).astype(int), BINS - 1)
    wide = [np.flatnonzero(width == index) for index in range(BINS) if (width == index).any()]
    wrong = 1.0 - right
    few = max(round(LEAST * len(order)), 1)
    return Reliability(
        joints=len(joints),
        right=float(right.mean()),
        mean_confidence=float(said.mean()),
        ece=_calibration_error(said, right, equal),
        ece_width=_calibration_error(said, right, wide),
        errors_in_least=float(wrong[order[:few]].sum() / max(wrong.sum(), 1.0)),
        best_errors_in_least=float(min(few / max(wrong.sum(), 1.0), 1.0)),
        auc=_auc(said, right),
        bins=tuple(
            Bin(joints=len(rows), confidence=float(said[rows].mean()), right=float(right[rows].mean())) for rows in wide
        ),
    )


def _calibration_error(said: np.ndarray, right: np.ndarray, groups: Sequence[np.ndarray]) -> float:
    return float(sum(abs(said[rows].mean() - right[rows].mean()) * len(rows) for rows in groups) / len(said))


def _auc(said: np.ndarray, right: np.ndarray) -> float:
    good, bad = said[right > 0], said[right == 0]
    if not len(good) or not len(bad):
        return 1.0
    above = (good[:, None] > bad).mean() + 0.5 * (good[:, None] == bad).mean()
    return float(above)


def report(found: Report[Record]) -> list[str]:
    """The figures, the curve as a table, and the wrong joints of most confidence."""
    summary, joints = found.summary, found.records
    wrong = sorted((joint for joint in joints if not joint["right"]), key=lambda joint: -joint["confidence"])
    figures = (
        ("joints right", f"{summary['right']:.1%}"),
        ("mean confidence", f"{summary['mean_confidence']:.1%}"),
        ("expected calibration error, bins of as many joints", f"{summary['ece']:.3f}"),
        ("expected calibration error, bins of equal width", f"{summary['ece_width']:.3f}"),
        (
            f"share of the errors among the {LEAST:.0%} of joints of least confidence",
            f"{summary['errors_in_least']:.1%}",
        ),
        ("the same, had the order been perfect", f"{summary['best_errors_in_least']:.1%}"),
        ("a right joint has more confidence than a wrong one", f"{summary['auc']:.1%}"),
    )
    bins = [(f"{b['confidence']:.2f}", str(b["joints"]), f"{b['right']:.1%}") for b in summary["bins"]]
    shown = [(joint["object"], joint["joint"], f"{joint['confidence']:.2f}") for joint in wrong[:15]]
    return [
        f"{len({joint['object'] for joint in joints})} objects, {len(joints)} joints. " + explained(__doc__),
        table(("", ""), figures),
        table(("confidence, mean of the bin", "joints", "right"), bins),
        "Wrong joints of most confidence:",
        table(("object", "joint", "confidence"), shown),
    ]


def plot(found: Report[Record]) -> Figure:
    """The reliability curve."""
    from matplotlib.figure import Figure  # noqa: PLC0415  an optional package

    figure = Figure(figsize=(4.6, 4.4), layout="constrained")
    axes = figure.add_subplot()
    axes.plot([0, 1], [0, 1], color="0.7", linewidth=1)
    bins = found.summary["bins"]
    axes.plot([b["confidence"] for b in bins], [b["right"] for b in bins], marker="o", color="#2a6fb0")
    for b in bins:
        place = (b["confidence"], b["right"])
        axes.annotate(str(b["joints"]), place, (4, -11), textcoords="offset points", fontsize=7)
    axes.set(xlim=(0, 1.02), ylim=(0, 1.02), xlabel="confidence", ylabel="share of joints right")
    axes.set_title(f"{found.summary['joints']} joints, ECE {found.summary['ece']:.3f}", fontsize=10)
    return figure


STUDY = Study(
    title="Calibration of the confidence", options=CalibrationOptions, measure=measure, report=report, plot=plot
)
