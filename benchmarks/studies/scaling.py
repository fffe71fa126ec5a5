"""How does inference time grow with the number of parts?

The object is a trunk of links, each carrying a branch of four more; every joint is a vertical pin in a bushing, and
each link stands one step higher than the one that carries it. Time is that of the processor, which other programs
hardly change; memory is the largest that the process has had.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import trimesh
from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.evaluation.benchmark_job import INFER, imported
from kinematify.evaluation.result_record import table
from kinematify.pipeline.infer_assembly import peak_mb

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from benchmarks.study import Measured, Record, Work
    from kinematify.evaluation.result_record import Report
    from kinematify.robot.arrays import FloatArray

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
ALLOWED = 1.2
"""Largest exponent."""


class ScalingOptions(Options):
    """What is timed."""

    config: str = Field("default", description="Configuration of the inference.")
    sizes: tuple[int, ...] = Field((10, 50, 100, 200), min_length=2, description="Numbers of parts, two at least.")


@dataclass(frozen=True, kw_only=True)
class Sized:
    """One object to be timed."""

    parts: int
    config: str
    infer: str = INFER
    """Function under test, as ``module:name``."""


def measure(options: ScalingOptions, work: Work) -> Measured:
    """Time the inference, one size after the other, and fit ``seconds = factor * parts ** exponent``."""
    asked = {f"{parts} parts": Sized(parts=parts, config=options.config) for parts in options.sizes}
    points = list(work.each(timed, asked, workers=1).values())
    return points, fitted(points)


def timed(asked: Sized) -> Record:
    """Infer the joints of one object; pairs count that are jointed in truth: a quick wrong answer is worth nothing."""
    infer, config = imported(asked.infer), load_config(asked.config)
    infer(chain_and_branch(2)[0], config=config)  # caches and lazy imports of the first call are no matter of size
    assembly, parents = chain_and_branch(asked.parts)
    start = time.process_time()
    inference = infer(assembly, config=config)
    seconds = time.process_time() - start
    true_pairs = {frozenset(pair) for pair in enumerate(parents) if pair[1] >= 0}
    return {
        "parts": asked.parts,
        "faces": sum(len(part.faces) for part in assembly.parts),
        "seconds": seconds,
        "memory": peak_mb(),
        "pairs_right": sum(frozenset(edge) in true_pairs for edge in inference.trees[0].edges()),
        "stage_seconds": dict(inference.timings),
    }


def fitted(points: Sequence[Record]) -> Record:
    """Return ``exponent`` and ``factor`` of the law that fits the times best."""
    slope, offset = np.polyfit(
        np.log([point["parts"] for point in points]), np.log([point["seconds"] for point in points]), 1
    )
    return {"exponent": float(slope), "factor": math.exp(float(offset))}


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


def report(found: Report[Record]) -> list[str]:
    """Times over sizes, and the law."""
    rows = [
        (
            str(p["parts"]),
            str(p["faces"]),
            f"{p['seconds']:.2f}",
            f"{p['memory']:.0f}",
            f"{p['pairs_right']}/{p['parts'] - 1}",
        )
        for p in found.records
    ]
    first, last = found.records[0], found.records[-1]
    memory = (last["memory"] - first["memory"]) / (last["parts"] - first["parts"])
    law = f"{found.summary['factor']:.3g} * parts^{found.summary['exponent']:.2f}"
    return [
        explained(__doc__),
        f"Fit: seconds = {law} (allowed: {ALLOWED}). Every part more takes {memory:.2f} MB.",
        table(("parts", "faces", "time [s]", "memory [MB]", "jointed pairs found"), rows),
    ]


def plot(found: Report[Record]) -> Figure:
    """Times over sizes, with the law and what is allowed."""
    from matplotlib.figure import Figure  # noqa: PLC0415  an optional package

    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.add_subplot()
    parts = np.array([point["parts"] for point in found.records])
    seconds = np.array([point["seconds"] for point in found.records])
    exponent, factor = found.summary["exponent"], found.summary["factor"]
    axes.loglog(parts, seconds, "o-", label="measured")
    axes.loglog(parts, factor * parts**exponent, "--", label=f"fit: parts^{exponent:.2f}")
    allowed = seconds[0] * (parts / parts[0]) ** ALLOWED
    axes.loglog(parts, allowed, ":", label=f"allowed growth: parts^{ALLOWED}")
    axes.set_xlabel("parts")
    axes.set_ylabel("processor time [s]")
    axes.legend()
    axes.grid(visible=True, which="both", alpha=0.3)
    return figure


STUDY = Study(
    title="Inference time over the number of parts", options=ScalingOptions, measure=measure, report=report, plot=plot
)
