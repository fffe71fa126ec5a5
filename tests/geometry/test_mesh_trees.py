"""Distances and winding numbers of many points are those of each point alone."""

import numpy as np
import trimesh

from kinematify.geometry.mesh_trees import WindingTree

MESH = trimesh.creation.torus(0.3, 0.1)
POINTS = np.random.default_rng(0).uniform(-0.5, 0.5, size=(500, 3))


def test_winding_numbers_tell_inside_from_outside() -> None:
    inside = np.abs(WindingTree(MESH.vertices, MESH.faces).numbers(POINTS)) > 0.5
    np.testing.assert_array_equal(inside, MESH.contains(POINTS))
