"""How exact are networks of signed distance beside grids, and what do they cost?

Errors against exact distances at 4000 points per part within 5 % of the part's diagonal of its surface, as a share of
that diagonal. Networks are trained all at once.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import torch
from pydantic import Field

from benchmarks.study import Options, Study, explained
from kinematify.assembly.load import load_assembly
from kinematify.config import load_config
from kinematify.evaluation.datasets import find_objects
from kinematify.evaluation.record import table
from kinematify.geometry.sampling import sample_surface
from kinematify.paper.sdf_grid import SignedDistanceGrid, exact_signed_distance
from kinematify.paper.sdf_neural import train_fields

if TYPE_CHECKING:
    from collections.abc import Sequence

    from benchmarks.study import Measured, Record, Work
    from kinematify.assembly.part import Part
    from kinematify.evaluation.record import Report
    from kinematify.paper.sdf import SignedDistanceField

_MODELS = ("panda", "allegro", "cabinet_41083")
_PARTS, _POINTS, _BAND = 20, 4000, 0.05


class SdfOptions(Options):
    """What is compared."""

    data: str | None = Field(None, description="Folder or set that holds the models; the benchmark's if not given.")
    threads: int = Field(2, ge=1, description="Of the networks' training.")


@dataclass(frozen=True, kw_only=True)
class Fields:
    """Models, and how their fields are made."""

    urdfs: tuple[Path, ...]
    kind: str
    threads: int


def measure(options: SdfOptions, work: Work) -> Measured:
    """Make both kinds of fields of the same parts."""
    urdfs = {item.name: item.urdf for item in find_objects(options.data)}
    chosen = tuple(urdfs[name] for name in _MODELS if name in urdfs)
    asked = {kind: Fields(urdfs=chosen, kind=kind, threads=options.threads) for kind in ("grid", "neural")}
    return list(work.each(fields_of_parts, asked, workers=1).values()), {"models": _MODELS}


def fields_of_parts(asked: Fields) -> Record:
    """Make the fields of twenty parts and compare them with exact distances."""
    torch.set_num_threads(asked.threads)
    config = load_config().sdf
    parts = [part for urdf in asked.urdfs for part in load_assembly(urdf).parts][:_PARTS]
    start = time.perf_counter()
    if asked.kind == "grid":
        grids = [SignedDistanceGrid(part, config) for part in parts]
        return _row("grid", parts, grids, time.perf_counter() - start, sum(grid.memory_bytes for grid in grids))
    networks = train_fields(parts, config.neural, seed=0)
    seconds = time.perf_counter() - start
    return _row("neural", parts, networks, seconds, sum(field.memory_bytes for field in networks))


def _row(
    kind: str, parts: Sequence[Part], fields: Sequence[SignedDistanceField], seconds: float, memory: int
) -> Record:
    errors, largest = zip(*(_errors(part, field) for part, field in zip(parts, fields, strict=True)), strict=True)
    return {
        "kind": kind, "parts": len(parts), "mean_error": float(np.mean(errors)), "worst_part": float(np.max(errors)),
        "largest": float(np.max(largest)), "seconds": seconds, "megabytes": memory / 1e6,
    }  # fmt: skip


def _errors(part: Part, field: SignedDistanceField) -> tuple[float, float]:
    """Mean and largest error within 5 % of the surface, fraction of the part's diagonal."""
    rng = np.random.default_rng(1)
    found = sample_surface(part, _POINTS, 99)
    diagonal = float(np.linalg.norm(np.ptp(part.bounds, axis=0)))
    points = found.points + rng.uniform(-_BAND, _BAND, (_POINTS, 1)) * diagonal * found.normals
    with torch.no_grad():
        values = field.value(torch.from_numpy(points)).numpy()
    error = np.abs(values - exact_signed_distance(part, points)) / diagonal
    return float(error.mean()), float(error.max())


def report(found: Report[Record]) -> list[str]:
    """One line per kind of field."""
    rows = [
        (
            row["kind"],
            *(f"{100.0 * row[name]:.3f}" for name in ("mean_error", "worst_part")),
            f"{100.0 * row['largest']:.2f}",
            f"{row['seconds']:.1f}",
            f"{row['megabytes']:.1f}",
        )
        for row in found.records
    ]
    titles = ("field", "mean error [%]", "worst part [%]", "largest error [%]", "time [s]", "memory [MB]")
    intro = f"{found.records[0]['parts']} parts of {', '.join(found.summary['models'])}. "
    return [intro + explained(__doc__), table(titles, rows)]


STUDY = Study(title="Signed distance fields: grids and networks", options=SdfOptions, measure=measure, report=report)
