"""Parts and assemblies: measures that every later stage relies on."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.assembly.part import Assembly, Part


def placed(mesh: trimesh.Trimesh, yaw: float, shift: np.ndarray) -> Assembly:
    turn = trimesh.transformations.rotation_matrix(yaw, [0, 0, 1])[:3, :3]
    pieces = mesh.split(only_watertight=False)
    return Assembly(
        parts=tuple(
            Part(name=f"p{i}", vertices=np.asarray(piece.vertices) @ turn.T + shift, faces=np.asarray(piece.faces))
            for i, piece in enumerate(pieces)
        ),
        source="built",
    )


@pytest.fixture(scope="module")
def furniture() -> trimesh.Trimesh:
    body = trimesh.creation.box(extents=[0.8, 0.4, 1.2])
    door = trimesh.creation.box(extents=[0.7, 0.02, 1.1])
    door.apply_translation([0.0, -0.25, 0.0])
    return trimesh.util.concatenate([body, door])


@settings(deadline=None, max_examples=30)
@given(yaw=st.floats(-7.0, 7.0), x=st.floats(-5.0, 5.0))
def test_the_diagonal_stays_the_same_when_an_object_is_turned_about_z_or_moved(furniture, yaw, x):
    still = placed(furniture, 0.0, np.zeros(3)).diagonal
    assert placed(furniture, yaw, np.array([x, 2.0, -x])).diagonal == pytest.approx(still, rel=1e-9)


def test_the_diagonal_of_what_stands_square_to_the_world_is_that_of_its_bounding_box(furniture):
    assembly = placed(furniture, 0.0, np.zeros(3))
    expected = np.linalg.norm(assembly.bounds[1] - assembly.bounds[0])
    assert assembly.diagonal == pytest.approx(expected)


def test_parts_on_one_line_have_a_diagonal_too():
    flat = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [3.0, 0.0, 0.0], [3.0, 0.0, 4.0]])
    parts = tuple(Part(name=name, vertices=flat, faces=np.array([[0, 1, 2], [1, 2, 3]])) for name in "ab")
    assert Assembly(parts=parts, source="built").diagonal == pytest.approx(5.0)
