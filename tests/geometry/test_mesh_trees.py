"""Distances and winding numbers of many points are those of each point alone."""

import numpy as np
import trimesh

from kinematify.geometry.mesh_trees import DistanceTree, WindingTree

MESH = trimesh.creation.torus(0.3, 0.1)
POINTS = np.random.default_rng(0).uniform(-0.5, 0.5, size=(500, 3))


def test_what_is_nearest_does_not_hang_on_the_other_points() -> None:
    tree = DistanceTree(MESH.vertices, MESH.faces)
    together = tree.nearest(POINTS)
    alone = [tree.nearest(point[None]) for point in POINTS]
    for found, single in zip(together, zip(*alone, strict=True), strict=True):
        np.testing.assert_array_equal(found, np.concatenate(single))
    np.testing.assert_allclose(np.linalg.norm(POINTS - together[2], axis=1), together[0], atol=1e-12)


def test_winding_numbers_tell_inside_from_outside() -> None:
    inside = np.abs(WindingTree(MESH.vertices, MESH.faces).numbers(POINTS)) > 0.5
    np.testing.assert_array_equal(inside, MESH.contains(POINTS))


def test_no_point_has_no_answer() -> None:
    assert DistanceTree(MESH.vertices, MESH.faces).distances(np.empty((0, 3))).shape == (0,)
    assert WindingTree(MESH.vertices, MESH.faces).numbers(np.empty((0, 3))).shape == (0,)
