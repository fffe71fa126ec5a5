"""Degraded meshes: seeded, the truth left alone, and each operator does what its name says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from objects import BUILDERS

from benchmarks.degrade import DEGRADED, OPEN_REACH, OVER_SEGMENTED, VERTEX_NOISE, DegradedParts, degraded
from benchmarks.tables import benchmark_blocks
from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.evaluation.accuracy import bench
from kinematify.evaluation.benchmark_job import CLEAN
from tests.known import part_of
from tests.secret_cabinets import request, write_object

CONFIG = load_config()


def mesh_of(part: Part) -> trimesh.Trimesh:
    return trimesh.Trimesh(part.vertices, part.faces, process=False)


def two_parts() -> Assembly:
    """A cylinder of 4,000 faces on a box."""
    pin = trimesh.creation.cylinder(radius=0.1, height=0.3, sections=1000).apply_translation((0, 0, 0.2))
    return Assembly(parts=(part_of(trimesh.creation.box((1, 1, 0.1)), "plate"), part_of(pin, "pin")), source="test")


def after(name: str, assembly: Assembly, seed: int = 3) -> DegradedParts:
    return degraded(name, assembly, CONFIG, seed=seed)


@pytest.mark.parametrize("name", [name for name in DEGRADED if not name.startswith("voxels-")])
def test_degradations_are_seeded_and_keep_every_part_in_its_place(name: str) -> None:
    assembly = BUILDERS["nested_drawer"]().assembly
    one, same = after(name, assembly), after(name, assembly)
    assert [part.mesh_hash for part in one.assembly.parts] == [part.mesh_hash for part in same.assembly.parts]
    assert set(assembly.names) <= set(one.assembly.names)
    assert [part.mesh_hash for part in one.assembly.parts] != [part.mesh_hash for part in assembly.parts]
    if name not in OVER_SEGMENTED:
        for before, part in zip(assembly.parts, one.assembly.parts, strict=True):
            assert np.abs(part.bounds - before.bounds).max() < 0.012 * assembly.diagonal


def test_each_fault_is_as_large_as_it_says() -> None:
    assembly = two_parts()
    plate, pin = assembly.parts
    noisy = after("vertex-noise", assembly).assembly.parts[1]
    assert np.std(noisy.vertices - pin.vertices) == pytest.approx(VERTEX_NOISE * assembly.diagonal, rel=0.1)
    assert len(after("faces-300", assembly).assembly.parts[1].faces) == pytest.approx(300, rel=0.05)
    assert after("faces-300", assembly).assembly.parts[0].mesh_hash == plate.mesh_hash
    assert len(after("holes", assembly).assembly.parts[1].faces) == round(0.95 * len(pin.faces))
    turned = after("flipped", assembly).assembly.parts[1]
    assert 0.4 < np.mean((turned.faces != pin.faces).any(axis=1)) < 0.6
    assert mesh_of(after("hulls", BUILDERS["nested_drawer"]().assembly).assembly.parts[0]).is_convex
    low = after("gaps", assembly).assembly
    assert low.parts[1].bounds[0, 2] - low.parts[0].bounds[1, 2] == pytest.approx(0.01 * assembly.diagonal, rel=1e-6)
    grown = after("interpenetration", assembly).assembly
    overlap = grown.parts[0].bounds[1, 2] - grown.parts[1].bounds[0, 2]
    assert overlap == pytest.approx(0.01 * assembly.diagonal, rel=1e-6)


def test_open_parts_lack_what_lies_on_their_neighbour_and_nothing_else() -> None:
    assembly = two_parts()
    pin = after("open", assembly).assembly.parts[1]
    gone = mesh_of(assembly.parts[1]).area - mesh_of(pin).area
    assert gone == pytest.approx(np.pi * 0.1**2, rel=0.01)
    assert mesh_of(pin).triangles_center[:, 2].min() > 0.05 + OPEN_REACH * assembly.diagonal


@pytest.mark.parametrize(("name", "count"), [("cut-2", 2), ("cut-3", 3)])
def test_cut_parts_meet_edge_to_edge_and_make_up_the_part(name: str, count: int) -> None:
    assembly = two_parts()
    given = after(name, assembly)
    whole = next(iter(given.pieces.values()))
    pieces = [part for part in given.assembly.parts if given.pieces.get(part.name, part.name) == whole]
    assert len(pieces) == count
    area = sum(part.area for part in pieces)
    assert area == pytest.approx(assembly.parts[assembly.names.index(whole)].area, rel=1e-9)
    together = trimesh.util.concatenate([mesh_of(part) for part in pieces])
    together.merge_vertices()
    assert together.is_watertight
    assert not any(mesh_of(part).is_watertight for part in pieces)


def test_every_kind_of_input_is_run_and_has_a_line_of_its_own(tmp_path: Path) -> None:
    """The quick inference turns everything, so that no cut comes out as fixed."""
    write_object(tmp_path / "data" / "three_parts", with_knob=True)
    wanted = request(
        tmp_path / "data",
        tmp_path / "work",
        "star",
        conditions=("rest",),
        inputs=(CLEAN, "gaps", "hulls", "cut-2"),
        degrade="benchmarks.degrade:degraded",
    )
    report = wanted()
    assert [(run.input, run.status, run.cuts, run.cuts_mended) for run in report.records] == [
        (CLEAN, "ok", 0, 0),
        ("gaps", "ok", 0, 0),
        ("hulls", "ok", 0, 0),
        ("cut-2", "ok", 1, 0),
    ]
    lines = "\n".join(benchmark_blocks(report)).splitlines()
    kind = report.records[0].kind
    rows = {
        name: line
        for name in (CLEAN, "gaps", "hulls", "cut-2")
        for line in lines
        if line.startswith(f"| {kind}, {name} ")
    }
    assert [row.split(" | ")[-1].removesuffix(" |") for row in rows.values()] == ["-", "-", "-", "0 of 1"]
    assert [line for line in lines if line.startswith("### ")][1::2] == [f"### {kind}, {name}" for name in rows]


def test_unknown_faults_are_refused_with_the_known_ones() -> None:
    with pytest.raises(InputError, match="Known are all, voxels-300"):
        bench("everyday", degrade=["gaps", "rust"])
