"""Surface samples: fair by area, reproducible, independent of how the mesh is listed."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from kinematify.assembly.part import Part
from kinematify.errors import AssemblyError
from kinematify.geometry.sampling import sample_surface
from tests.known import part_of

BOX = part_of(trimesh.creation.box((1.0, 2.0, 4.0)))
TORUS = part_of(trimesh.creation.torus(1.0, 0.3))


def test_points_lie_on_their_faces_with_their_normals() -> None:
    samples = sample_surface(BOX, 500, 3)
    corner = BOX.vertices[BOX.faces[samples.faces, 0]]
    assert np.abs(np.einsum("nd,nd->n", samples.points - corner, samples.normals)).max() < 1e-12
    outward = np.einsum("nd,nd->n", samples.points, samples.normals)
    assert outward.min() > 0.49
    assert np.all(np.abs(samples.points) <= np.array([0.5, 1.0, 2.0]) + 1e-12)


def test_same_seed_same_points_and_another_seed_other_points() -> None:
    first, again, other = (sample_surface(TORUS, 200, seed).points for seed in (5, 5, 6))
    assert np.array_equal(first, again)
    assert not np.allclose(first, other)


def test_a_part_without_area_is_refused_by_name() -> None:
    flat = Part(name="flat", vertices=np.zeros((3, 3)), faces=np.array([[0, 1, 2]]))
    with pytest.raises(AssemblyError, match="flat"):
        sample_surface(flat, 10, 0)
