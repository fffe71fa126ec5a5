"""How far a confidence can be believed: reliability of the joints of a benchmark, by what the method said of each.

A joint is right if its parent, its type (continuous counts as revolute) and its axis are: within 5 deg, and, where it
turns, within 5 % of the object's diagonal.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.evaluation.summary import CLOSE_ANGLE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from kinematify.evaluation.job import JobResult
    from kinematify.evaluation.metrics import JointScore

CLOSE_LINE = 0.05
"""An axis line counts as found within this share of the object's diagonal."""
BINS = 10
LEAST = 0.2
"""Share of the joints, those of least confidence, whose share of the errors is told."""


@dataclass(frozen=True, kw_only=True)
class Judged:
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


def judged_joints(results: Iterable[JobResult]) -> list[Judged]:
    """All joints with a confidence; those that have none stand for no answer."""
    return [
        Judged(
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


def is_right(joint: JointScore, diagonal: float) -> bool:
    """Whether parent, type and axis are right.

    Args:
        joint: Against the truth.
        diagonal: Of the object [m].
    """
    close = joint.angle_deg <= CLOSE_ANGLE and (joint.line_m is None or joint.line_m <= CLOSE_LINE * diagonal)
    return joint.matched and joint.type_right and close


def reliability(joints: Sequence[Judged]) -> Reliability:
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


def write_calibration(
    joints: Sequence[Judged], header: Mapping[str, Any], folder: Path, *, name: str = "calibration"
) -> tuple[Path, ...]:
    """Write ``<name>.json``, ``<name>.md`` and ``<name>.png``, and return their paths."""
    found = reliability(joints)
    folder.mkdir(parents=True, exist_ok=True)
    facts = {"schema": 1, "header": dict(header), **asdict(found), "judged": [asdict(joint) for joint in joints]}
    (folder / f"{name}.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    (folder / f"{name}.md").write_text(_markdown(found, joints, header, name), encoding="utf-8")
    _plot(found, folder / f"{name}.png")
    return tuple(folder / f"{name}{suffix}" for suffix in (".md", ".json", ".png"))


def _markdown(found: Reliability, joints: Sequence[Judged], header: Mapping[str, Any], name: str) -> str:
    wrong = sorted((joint for joint in joints if not joint.right), key=lambda joint: -joint.confidence)
    lines = [
        "# Calibration of the confidence",
        "",
        f"- command: `{header['command']}`",
        f"- date: {header['date']}, code {header['code']}",
        f"- {header['objects']} generated objects of seed {header['corpus_seed']}, {found.joints} joints",
        f"- conditions {', '.join(header['conditions'])}",
        "",
        (__doc__ or "").strip().partition("\n\n")[2],
        "",
        "| | |",
        "| --- | --- |",
        f"| joints right | {found.right:.1%} |",
        f"| mean confidence | {found.mean_confidence:.1%} |",
        f"| expected calibration error, bins of as many joints | {found.ece:.3f} |",
        f"| expected calibration error, bins of equal width | {found.ece_width:.3f} |",
        f"| share of the errors among the {LEAST:.0%} of joints of least confidence | {found.errors_in_least:.1%} |",
        f"| the same, had the order been perfect | {found.best_errors_in_least:.1%} |",
        f"| a right joint has more confidence than a wrong one | {found.auc:.1%} |",
        "",
        f"![Reliability curve]({name}.png)",
        "",
        "| confidence, mean of the bin | joints | right |",
        "| --- | --- | --- |",
        *(f"| {item.confidence:.2f} | {item.joints} | {item.right:.1%} |" for item in found.bins),
        "",
        "Wrong joints of most confidence:",
        "",
        "| object | joint | confidence |",
        "| --- | --- | --- |",
        *(f"| {joint.object} | {joint.joint} | {joint.confidence:.2f} |" for joint in wrong[:15]),
    ]
    return "\n".join(lines) + "\n"


def _plot(found: Reliability, path: Path) -> None:
    # A plotting library that only this page needs.
    import matplotlib as mpl  # noqa: PLC0415

    mpl.use("Agg")
    import matplotlib.pyplot as plt  # noqa: PLC0415

    figure, axes = plt.subplots(figsize=(4.6, 4.4), dpi=110, layout="constrained")
    axes.plot([0, 1], [0, 1], color="0.7", linewidth=1)
    said = [item.confidence for item in found.bins]
    axes.plot(said, [item.right for item in found.bins], marker="o", color="#2a6fb0")
    for item in found.bins:
        axes.annotate(str(item.joints), (item.confidence, item.right), (4, -11), textcoords="offset points", fontsize=7)
    axes.set(xlim=(0, 1.02), ylim=(0, 1.02), xlabel="confidence", ylabel="share of joints right")
    axes.set_title(f"{found.joints} joints, ECE {found.ece:.3f}", fontsize=10)
    figure.savefig(path)
    plt.close(figure)
