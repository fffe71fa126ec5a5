"""Journals: hinge pins are found among large flat contacts, and round outlines that only meet are none."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold

from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.generate.procedural.pieces.bearing_pieces import barrel
from kinematify.generate.procedural.solids import bore, box, cylinder
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.features.journal import Journal, facing_faces, find_journal
from kinematify.joints.features.workspace import PartCache

CONFIG = load_config()


def part(name: str, solid: Manifold) -> Part:
    mesh = solid.to_mesh64()
    return Part(name=name, vertices=mesh.vert_properties[:, :3], faces=mesh.tri_verts)


def journal_of(parent: Manifold, child: Manifold, *, reach: float = 0.003) -> Journal | None:
    assembly = Assembly(parts=(part("parent", parent), part("child", child)), source="test")
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    graph = build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=0)
    cache = PartCache(assembly, graph, samples=500, seed=0)
    facing = facing_faces(cache, 0, 1, reach, CONFIG.joints.journal)
    size = float(np.ptp(assembly.parts[1].vertices, axis=0).max())
    return find_journal(facing, size, CONFIG.joints.journal)


def test_the_pin_of_a_door_is_found_although_it_is_a_hundredth_of_the_contact() -> None:
    gap = 0.001
    of_body, of_door = barrel(0.06, 0.004, gap, ((-0.02, -0.003, 0.002, 0.02), (0.003, 0.02, -0.004, 0.004)))
    body = box((-0.02, 0.005, -0.4), (0.5, 0.4, 0.4)) + of_body
    door = box((0.004, -0.015, -0.4), (0.5, 0.005 - gap, 0.4)) - cylinder(0.0055, (0, 0, -1), (0, 0, 1)) + of_door
    found = journal_of(body, door)
    assert found is not None
    assert np.degrees(np.arccos(abs(found.axis[2]))) < 0.2
    assert np.linalg.norm(found.pivot[:2]) < 1e-4
    assert 0.001 < found.radius < 0.006


def test_a_round_lid_on_a_round_pot_is_no_journal() -> None:
    pot = cylinder(0.2, (0, 0, 0), (0, 0, 0.3)) - cylinder(0.19, (0, 0, 0.01), (0, 0, 1))
    lid = cylinder(0.2, (0, 0, 0.301), (0, 0, 0.32))
    assert journal_of(pot, lid) is None


def test_a_drawer_in_its_box_is_no_journal() -> None:
    body = box((0, 0, 0), (0.4, 0.4, 0.2)) - box((0.02, -1, 0.02), (0.38, 0.38, 0.18))
    assert journal_of(body, box((0.021, -0.02, 0.021), (0.379, 0.379, 0.179))) is None


@pytest.mark.parametrize("sides", [12, 24, 48])
def test_coarse_pins_are_found_as_well(sides: int) -> None:
    body = box((-0.1, -0.1, -0.1), (0.1, 0.1, 0)) - bore(0.01, 0.0005, (0, 0, -0.08), (0, 0, 1), segments=sides)
    pin = cylinder(0.01, (0, 0, -0.07), (0, 0, 0.1), segments=sides)
    found = journal_of(body, pin)
    assert found is not None
    assert np.degrees(np.arccos(abs(found.axis[2]))) < 0.5
