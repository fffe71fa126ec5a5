"""Surface samples: fair by area, reproducible, independent of how the mesh is listed."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.assembly.part import Part
from kinematify.errors import AssemblyError
from kinematify.geometry.sampling import sample_surface


def part_of(mesh: trimesh.Trimesh) -> Part:
    return Part(name="part", vertices=mesh.vertices, faces=mesh.faces)


BOX = part_of(trimesh.creation.box((1.0, 2.0, 4.0)))
TORUS = part_of(trimesh.creation.torus(1.0, 0.3))


@settings(deadline=None, max_examples=25)
@given(count=st.integers(1, 3000), seed=st.integers(0, 2**31))
def test_every_large_face_gets_its_share(count: int, seed: int) -> None:
    samples = sample_surface(TORUS, count, seed)
    hits = np.bincount(samples.faces, minlength=len(TORUS.faces))
    expected = TORUS.face_areas * count / TORUS.area
    assert hits.sum() == count
    assert np.all(np.abs(hits - expected) < 1.0 + 1e-6)
    assert samples.areas.sum() == pytest.approx(TORUS.area)


def test_points_lie_on_their_faces_with_their_normals() -> None:
    samples = sample_surface(BOX, 500, 3)
    corner = BOX.vertices[BOX.faces[samples.faces, 0]]
    assert np.abs(np.einsum("nd,nd->n", samples.points - corner, samples.normals)).max() < 1e-12
    outward = np.einsum("nd,nd->n", samples.points, samples.normals)
    assert outward.min() > 0.49
    assert np.all(np.abs(samples.points) <= np.array([0.5, 1.0, 2.0]) + 1e-12)


def test_stratified_samples_integrate_better_than_random_ones() -> None:
    exact = 4.0**2 / 12.0  # mean of z^2 over the side walls of the box
    walls = [sample_surface(BOX, 1000, seed) for seed in range(20)]
    errors = [abs(np.mean(s.points[np.abs(s.normals[:, 2]) < 0.5, 2] ** 2) - exact) for s in walls]
    random_error = 4.0**2 / np.sqrt(180.0) / np.sqrt(1000 * 24 / 28)
    assert np.mean(errors) < 0.25 * random_error


def test_same_seed_same_points_and_another_seed_other_points() -> None:
    first, again, other = (sample_surface(TORUS, 200, seed).points for seed in (5, 5, 6))
    assert np.array_equal(first, again)
    assert not np.allclose(first, other)


def test_order_of_faces_and_of_their_corners_does_not_matter() -> None:
    generator = np.random.default_rng(0)
    mesh = trimesh.creation.icosphere(subdivisions=2)
    mesh.vertices += generator.normal(scale=0.01, size=mesh.vertices.shape)
    shuffled = mesh.faces[generator.permutation(len(mesh.faces))]
    rolled = np.stack([np.roll(face, generator.integers(3)) for face in shuffled])
    expected = sample_surface(part_of(mesh), 300, 1)
    actual = sample_surface(Part(name="other", vertices=mesh.vertices, faces=rolled), 300, 1)
    assert np.allclose(expected.points, actual.points, atol=1e-9)


def test_faces_without_area_are_never_chosen() -> None:
    faces = np.concatenate([[[0, 0, 1]], BOX.faces, [[2, 2, 2]]])
    samples = sample_surface(Part(name="box", vertices=BOX.vertices, faces=faces), 997, 0)
    assert samples.faces.min() >= 1
    assert samples.faces.max() <= len(BOX.faces)
    assert np.allclose(np.linalg.norm(samples.normals, axis=1), 1.0)


def test_arrays_are_read_only() -> None:
    samples = sample_surface(BOX, 10, 0)
    with pytest.raises(ValueError, match="read-only"):
        samples.points[0, 0] = 1.0


def test_a_part_without_area_is_refused_by_name() -> None:
    flat = Part(name="flat", vertices=np.zeros((3, 3)), faces=np.array([[0, 1, 2]]))
    with pytest.raises(AssemblyError, match="flat"):
        sample_surface(flat, 10, 0)


def test_no_samples_are_refused() -> None:
    with pytest.raises(ValueError, match="count"):
        sample_surface(BOX, 0, 0)
