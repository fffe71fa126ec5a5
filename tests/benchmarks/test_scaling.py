"""The object that times are measured on, and the fit."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import pytest
import quick_inference
import trimesh

from benchmarks.studies import scaling
from benchmarks.studies.scaling import chain_and_branch
from benchmarks.study import write_study
from kinematify.assembly.part import Assembly, Part
from kinematify.config import Config
from kinematify.evaluation.result_record import Report, new_header


def distance(a: Part, b: Part) -> float:
    manager = trimesh.collision.CollisionManager()
    manager.add_object("a", trimesh.Trimesh(a.vertices, a.faces, process=False))
    return float(manager.min_distance_single(trimesh.Trimesh(b.vertices, b.faces, process=False)))


def test_only_jointed_parts_come_close() -> None:
    assembly, parents = chain_and_branch(12)
    assert parents == (-1, 0, 1, 2, 3, 0, 5, 6, 7, 8, 5, 10)
    tolerance = 0.0025 * assembly.diagonal
    for child in range(12):
        for other in range(child):
            gap = distance(assembly.parts[other], assembly.parts[child])
            assert gap > 0.0
            assert (gap < tolerance) == (parents[child] == other), (other, child, gap)


@pytest.mark.parametrize("parts", [2, 10, 51, 200])
def test_object_has_as_many_parts_as_asked(parts: int) -> None:
    assembly, parents = chain_and_branch(parts)
    assert len(assembly.parts) == len(parents) == parts
    assert len(set(assembly.names)) == parts
    assert all(parent < child for child, parent in enumerate(parents))


class Clock:
    """A clock that an inference sets forward, so that the machine's load cannot."""

    now = 0.0

    def process_time(self) -> float:
        return self.now

    def quadratic(self, assembly: Assembly, *, config: Config) -> SimpleNamespace:
        self.now += 2e-5 * len(assembly.parts) ** 2
        return quick_inference.star(assembly, config=config)


def test_exponent_is_fitted_and_the_report_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(scaling, "time", clock)
    monkeypatch.setattr(scaling, "imported", lambda name: clock.quadratic)
    points = [scaling.timed(scaling.Sized(parts=parts, config="default")) for parts in (40, 80, 120)]
    summary = scaling.fitted(points)
    assert summary["exponent"] == pytest.approx(2.0)
    # A star on an inner trunk link joins it with its branch and the two trunk links beside it.
    assert [point["pairs_right"] for point in points] == [3, 3, 3]
    header = new_header("scaling", workers=1, seeds=[0], configuration={"sizes": [40, 80, 120]})
    page, data, picture = write_study(Report(header=header, records=tuple(points), summary=summary), tmp_path)
    assert json.loads(data.read_text())["records"][0]["parts"] == 40
    assert "parts^" in page.read_text()
    assert picture.read_bytes().startswith(b"\x89PNG")
