"""Noisy meshes are distinguished from designs, their normals are averaged, and bearings are still found on them."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from benchmarks.degrade import voxels as voxels_of
from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.geometry.surface import FACETED, PartSurface, part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_bearings

CONFIG = load_config()


def fine(mesh: trimesh.Trimesh, edge: float) -> trimesh.Trimesh:
    return trimesh.Trimesh(*trimesh.remesh.subdivide_to_size(mesh.vertices, mesh.faces, edge))


def part_of(mesh: trimesh.Trimesh, noise: float, name: str = "part") -> Part:
    mesh = trimesh.Trimesh(mesh.vertices, mesh.faces)  # one vertex at each place
    moved = mesh.vertices + noise * np.random.default_rng(0).normal(size=mesh.vertices.shape)
    return Part(name=name, vertices=moved, faces=mesh.faces)


DESIGNS = {
    "box": trimesh.creation.box((1, 1, 1)),
    "ball": trimesh.creation.icosphere(subdivisions=4),
    "ring": trimesh.creation.torus(1.0, 0.3),
    "pipe": trimesh.creation.annulus(0.4, 0.5, 1.0),
}


@pytest.mark.parametrize("name", DESIGNS)
def test_designs_are_not_noisy_and_keep_their_normals(name: str) -> None:
    surface = PartSurface(part_of(DESIGNS[name], 0.0), crease_angle=0.52)
    assert not surface.noisy
    np.testing.assert_array_equal(surface.surface_normals, surface.face_normals[0])


def test_the_bearing_of_a_noisy_pin_is_found() -> None:
    pin = fine(trimesh.creation.cylinder(radius=0.1, height=0.6, sections=40), 0.02)
    sleeve = fine(trimesh.creation.annulus(0.102, 0.2, 0.3, sections=40), 0.02)
    parts = tuple(part_of(mesh, 0.0015, name) for mesh, name in ((pin, "pin"), (sleeve, "sleeve")))
    assembly = Assembly(parts=parts, source="test")
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    assert all(surface.noisy for surface in surfaces)
    graph = build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=0)
    best = fit_bearings(assembly, surfaces, graph, config=CONFIG.bearing, seed=0)[0, 1].lines[0]
    assert abs(best.axis[2]) > np.cos(np.radians(2.0))
    assert np.linalg.norm(best.pivot[:2]) < 0.01
    assert best.surface > 0.2


def pin_in_sleeve(sections: int) -> Assembly:
    """A pin that turns in a sleeve, askew."""
    turn = trimesh.transformations.rotation_matrix(0.5, [1.0, 0.3, 0.0])
    pin = trimesh.creation.cylinder(radius=0.1, height=0.6, sections=sections)
    sleeve = trimesh.creation.annulus(0.105, 0.2, 0.3, sections=sections)
    meshes = [mesh.apply_transform(turn) for mesh in (pin, sleeve)]
    parts = tuple(Part(name=name, vertices=m.vertices, faces=m.faces) for name, m in zip("ab", meshes, strict=True))
    return Assembly(parts=parts, source="test")


def test_remeshed_parts_are_rough_and_designed_ones_are_not() -> None:
    design = pin_in_sleeve(64)
    assert all(surface.roughness < FACETED for surface in part_surfaces(design, config=CONFIG.surface))
    voxels = voxels_of(30)(design, np.random.default_rng(0))
    assert all(surface.roughness > FACETED for surface in part_surfaces(voxels, config=CONFIG.surface))
