"""How inference time grows with the number of parts, on an object built in code.

The object is a trunk of links, each carrying a branch of four more; every joint is a vertical pin in a bushing, and
each link stands one step higher than the one that carries it.
"""

from __future__ import annotations

import json
import math
import time
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np
import trimesh

from kinematify.assembly.part import Assembly, Part
from kinematify.errors import EnvironmentFault

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kinematify.config import Config
    from kinematify.pipeline import Inference
    from kinematify.robot.arrays import FloatArray

    Infer = Callable[..., Inference]

SIZES = (10, 50, 100, 200)
"""Numbers of parts that are measured."""
BRANCH = 4
"""Links of the branch that every trunk link carries."""

_LENGTH = 0.3
"""Distance between the two axes of a link [m]."""
_STEP = 0.06
"""How much higher a link stands than the one that carries it [m]."""
_PIN_RADIUS = 0.02
_BUSHING_RADII = (0.0203, 0.035)
_BUSHING_HEIGHT = 0.04
_BAR = (0.03, 0.015)
"""Width and height of a bar [m]."""
_SEGMENTS = 48


@dataclass(frozen=True, kw_only=True)
class ScalingPoint:
    """One measured size."""

    parts: int
    faces: int
    seconds: float
    """Wall time of the inference [s]."""
    pairs_right: int
    """Tree edges, of `parts - 1`, that join parts which are jointed in truth: a quick wrong answer is worth nothing."""
    stage_seconds: dict[str, float]


@dataclass(frozen=True, kw_only=True)
class ScalingReport:
    """Times over sizes and the fitted law ``seconds = factor * parts ** exponent``."""

    config: str
    points: tuple[ScalingPoint, ...]
    exponent: float
    factor: float


def chain_and_branch(parts: int) -> tuple[Assembly, tuple[int, ...]]:
    """Build the object and return it with the true parent of every part, -1 for the root.

    Args:
        parts: Number of links, at least 2.
    """
    built: list[Part] = []
    parents: list[int] = []
    trunk_parent = -1
    base = np.zeros(3)
    while len(built) < parts:
        trunk = len(built)
        built.append(_link(trunk, base, np.array([1.0, 0.0, 0.0]), side_bushing=True))
        parents.append(trunk_parent)
        carrier, place = trunk, base + _side_seat()
        for _ in range(min(BRANCH, parts - len(built))):
            parents.append(carrier)
            carrier = len(built)
            built.append(_link(carrier, place + _up(), np.array([0.0, 1.0, 0.0]), side_bushing=False))
            place = place + _up() + np.array([0.0, _LENGTH, 0.0])
        trunk_parent, base = trunk, base + np.array([_LENGTH, 0.0, 0.0]) + _up()
    return Assembly(parts=tuple(built), source=f"chain and branch of {parts} parts"), tuple(parents)


def measure_scaling(config: Config, infer: Infer, sizes: Sequence[int] = SIZES) -> ScalingReport:
    """Time `infer` on objects of growing size.

    Args:
        config: Configuration of the inference.
        infer: `kinematify.pipeline.infer`, or another function of the same form.
        sizes: Numbers of parts; at least two different ones.
    """
    # Caches and lazy imports of the first call are no matter of size.
    infer(chain_and_branch(min(sizes))[0], config=config)
    points = tuple(_measure(size, config, infer) for size in sizes)
    slope, offset = np.polyfit(
        np.log([point.parts for point in points]), np.log([point.seconds for point in points]), 1
    )
    return ScalingReport(config=config.name, points=points, exponent=float(slope), factor=math.exp(float(offset)))


def write_scaling(report: ScalingReport, folder: Path) -> tuple[Path, Path, Path]:
    """Write ``scaling.json``, ``scaling.md`` and ``scaling.png`` and return their paths.

    Raises:
        EnvironmentFault: matplotlib is not installed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    paths = (folder / "scaling.json", folder / "scaling.md", folder / "scaling.png")
    paths[0].write_text(json.dumps(asdict(report), indent=1) + "\n", encoding="utf-8")
    paths[1].write_text(_markdown(report), encoding="utf-8")
    _plot(report, paths[2])
    return paths


def _up() -> FloatArray:
    return np.array([0.0, 0.0, _STEP])


def _side_seat() -> FloatArray:
    """Bushing of a trunk link's branch, beside the middle of its bar."""
    return np.array([0.5 * _LENGTH, 2.0 * _BUSHING_RADII[1], 0.0])


def _link(index: int, base: FloatArray, along: FloatArray, *, side_bushing: bool) -> Part:
    """A bar that hangs its pin into the bushing below and carries a bushing at its far end."""
    bushings = [base + _LENGTH * along]
    pieces = [_bar(base, base + (_LENGTH - _BUSHING_RADII[0] - 0.005) * along)]
    if side_bushing:
        middle = base + np.array([0.5 * _LENGTH, 0.0, 0.0])
        pieces.append(_bar(middle, middle + np.array([0.0, _BUSHING_RADII[1], 0.0])))
        bushings.append(base + _side_seat())
    pieces += [_bushing(place) for place in bushings]
    pieces.append(_pin(base))
    starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
    return Part(
        name=f"part_{index:03d}",
        vertices=np.concatenate([piece.vertices for piece in pieces]),
        faces=np.concatenate([piece.faces + start for piece, start in zip(pieces, starts, strict=False)]),
    )


def _bar(start: FloatArray, end: FloatArray) -> trimesh.Trimesh:
    extents = np.where(np.abs(end - start) > 0.0, np.abs(end - start), _BAR[0])
    extents[2] = _BAR[1]
    bar: trimesh.Trimesh = trimesh.creation.box(extents=extents)
    bar.apply_translation(0.5 * (start + end))
    return bar


def _bushing(centre: FloatArray) -> trimesh.Trimesh:
    inner, outer = _BUSHING_RADII
    bushing: trimesh.Trimesh = trimesh.creation.annulus(
        r_min=inner, r_max=outer, height=_BUSHING_HEIGHT, sections=_SEGMENTS
    )
    bushing.apply_translation(centre)
    return bushing


def _pin(base: FloatArray) -> trimesh.Trimesh:
    """From the bar at `base` down through the bushing one step below."""
    height = _STEP + 0.5 * _BUSHING_HEIGHT
    pin: trimesh.Trimesh = trimesh.creation.cylinder(radius=_PIN_RADIUS, height=height, sections=_SEGMENTS)
    pin.apply_translation(base - np.array([0.0, 0.0, 0.5 * height]))
    return pin


def _measure(size: int, config: Config, infer: Infer) -> ScalingPoint:
    assembly, parents = chain_and_branch(size)
    start = time.perf_counter()
    inference = infer(assembly, config=config)
    seconds = time.perf_counter() - start
    true_pairs = {frozenset(pair) for pair in enumerate(parents) if pair[1] >= 0}
    return ScalingPoint(
        parts=size,
        faces=sum(len(part.faces) for part in assembly.parts),
        seconds=seconds,
        pairs_right=sum(frozenset(edge) in true_pairs for edge in inference.trees[0].edges()),
        stage_seconds=dict(inference.timings),
    )


def _markdown(report: ScalingReport) -> str:
    rows = [
        f"| {point.parts} | {point.faces} | {point.seconds:.2f} | {point.pairs_right}/{point.parts - 1} |"
        for point in report.points
    ]
    head = [
        "# Inference time over the number of parts",
        "",
        f"Chain and branch of pins in bushings, configuration {report.config}.",
        f"Fit: seconds = {report.factor:.3g} * parts^{report.exponent:.2f} (allowed: 1.5).",
        "",
        "| parts | faces | time [s] | jointed pairs found |",
        "| --- | --- | --- | --- |",
    ]
    return "\n".join([*head, *rows, "", "![time over parts](scaling.png)"]) + "\n"


def _plot(report: ScalingReport, path: Path) -> None:
    try:
        from matplotlib.figure import Figure  # noqa: PLC0415  an optional package
    except ImportError as error:
        raise EnvironmentFault(
            "The scaling plot needs matplotlib, which is not installed. Run `pip install kinematify[bench]`."
        ) from error
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.add_subplot()
    parts = np.array([point.parts for point in report.points])
    seconds = np.array([point.seconds for point in report.points])
    axes.loglog(parts, seconds, "o-", label="measured")
    axes.loglog(parts, report.factor * parts**report.exponent, "--", label=f"fit: parts^{report.exponent:.2f}")
    axes.loglog(parts, seconds[0] * (parts / parts[0]) ** 1.5, ":", label="allowed growth: parts^1.5")
    axes.set_xlabel("parts")
    axes.set_ylabel("inference time [s]")
    axes.legend()
    axes.grid(visible=True, which="both", alpha=0.3)
    figure.savefig(path, dpi=120)
