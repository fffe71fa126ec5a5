"""Distances and winding numbers of many points are those of each point alone."""

import numpy as np
import trimesh

from kinematify.geometry.mesh_trees import WindingTree
from kinematify.geometry.solid import Solid

MESH = trimesh.creation.torus(0.3, 0.1)
POINTS = np.random.default_rng(0).uniform(-0.5, 0.5, size=(500, 3))


def test_winding_numbers_tell_inside_from_outside() -> None:
    inside = np.abs(WindingTree(MESH.vertices, MESH.faces).numbers(POINTS)) > 0.5
    np.testing.assert_array_equal(inside, MESH.contains(POINTS))


def test_the_deepest_point_of_a_set_is_the_deepest_of_all_alone() -> None:
    boxes = [trimesh.creation.box((1.0, 1.0, 1.0)).apply_translation((shift, 0.0, 0.0)) for shift in (0.0, 0.6)]
    both = trimesh.util.concatenate(boxes)
    solid = Solid(np.array(both.vertices), np.array(both.faces), unit=1.0, hole=0.01, points=90)
    sets = np.random.default_rng(1).uniform(-0.7, 1.3, size=(50, 8, 3))
    alone = solid.deepest(sets.reshape(-1, 1, 3)).reshape(50, 8)
    assert len(np.flatnonzero(alone)) > 50
    np.testing.assert_array_equal(solid.deepest(sets), alone.max(axis=1))
    np.testing.assert_array_equal(solid.contains(sets.reshape(-1, 3)), alone.reshape(-1) > 0.0)
