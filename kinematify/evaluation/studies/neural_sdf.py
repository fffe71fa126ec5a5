"""Networks of signed distance against grids: accuracy near the surface, time and memory: results/sdf.{json,md}."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import torch

from kinematify import load_assembly
from kinematify.config import load_config
from kinematify.geometry.sampling import sample_surface
from kinematify.paper.sdf_grid import SignedDistanceGrid, exact_signed_distance
from kinematify.paper.sdf_neural import train_fields

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.paper.sdf import SignedDistanceField

_MODELS = ("robots/panda", "robots/allegro", "everyday/cabinet_41083")
_PARTS, _POINTS, _BAND = 20, 4000, 0.05


def main() -> None:
    """Make both kinds of fields of twenty parts and compare them with exact distances."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, help="folder of the benchmark")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--output", type=Path, default=Path("results"))
    arguments = parser.parse_args()
    torch.set_num_threads(arguments.threads)
    config = load_config().sdf
    parts = [part for name in _MODELS for part in load_assembly(arguments.data / name / "model.urdf").parts][:_PARTS]
    rows = []
    start = time.perf_counter()
    grids = [SignedDistanceGrid(part, config) for part in parts]
    rows.append(_row("grid", parts, grids, time.perf_counter() - start, sum(grid.memory_bytes for grid in grids)))
    start = time.perf_counter()
    networks = train_fields(parts, config.neural, seed=0)
    seconds = time.perf_counter() - start
    rows.append(_row("neural", parts, networks, seconds, sum(field.memory_bytes for field in networks)))
    _write(rows, arguments.output, arguments.threads)


def _row(
    kind: str, parts: Sequence[Part], fields: Sequence[SignedDistanceField], seconds: float, memory: int
) -> dict[str, float | str]:
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


def _write(rows: list[dict[str, float | str]], folder: Path, threads: int) -> None:
    introduction = (
        f"`python benchmarks/neural_sdf.py ../shared/bench`: {rows[0]['parts']} parts of {', '.join(_MODELS)}, "
        f"{threads} threads. Errors against exact distances at {_POINTS} points per part within {_BAND:.0%} of the "
        "part's diagonal of its surface, as a share of that diagonal. Networks are trained all at once."
    )
    lines = [
        "# Signed distance fields: grids and networks",
        "",
        introduction,
        "",
        "| field | mean error [%] | worst part [%] | largest error [%] | time [s] | memory [MB] |",
        "| --- | --- | --- | --- | --- | --- |",
        *(
            f"| {row['kind']} | {100.0 * float(row['mean_error']):.3f} | {100.0 * float(row['worst_part']):.3f} | "
            f"{100.0 * float(row['largest']):.2f} | {float(row['seconds']):.1f} | {float(row['megabytes']):.1f} |"
            for row in rows
        ),
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "sdf.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "sdf.json").write_text(json.dumps({"schema": 1, "rows": rows}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
