"""Pieces that are boxes, cylinders or spheres, wherever they stand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.geometry.convex import ConvexPiece, convex_hull, convex_piece
from kinematify.model.collision import fitted_shape
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

R = rotation_about(np.array([0.0, 0.6, 0.8]), 0.7)
PLACE = np.array([0.3, -0.2, 0.5])


def placed(points: FloatArray) -> ConvexPiece:
    return convex_piece(points @ R.T + PLACE, thickness=1e-6, directions=1000)


def prism(radius: float, length: float, corners: int, top: float = 1.0) -> FloatArray:
    """About z; `top` scales its upper end."""
    turn = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    ring = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    ends = [(ring, -0.5 * length), (top * ring, 0.5 * length)]
    return np.concatenate([np.column_stack([points, np.full(corners, z)]) for points, z in ends])


def ball(radius: float, count: int = 400) -> FloatArray:
    points = np.random.default_rng(0).normal(size=(count, 3))
    return radius * points / np.linalg.norm(points, axis=1)[:, None]


@pytest.mark.parametrize(("radius", "length"), [(0.3, 0.05), (0.02, 0.8), (0.1, 0.1 * np.sqrt(3.0))])
def test_a_prism_with_many_sides_is_a_cylinder(radius: float, length: float) -> None:
    shape, beyond = fitted_shape(placed(prism(radius, length, 48)), 1.0)
    assert shape.kind == "cylinder"
    assert shape.size == pytest.approx((radius, length))
    assert np.allclose(shape.T_link_shape[:3, 3], PLACE)
    assert abs(shape.T_link_shape[:3, 2] @ R[:, 2]) == pytest.approx(1.0)
    assert np.linalg.det(shape.T_link_shape[:3, :3]) == pytest.approx(1.0)
    assert beyond == pytest.approx(radius * (1.0 - np.cos(np.pi / 48)))


def test_corners_on_a_sphere_are_a_sphere() -> None:
    shape, beyond = fitted_shape(placed(ball(0.1)), 1.0)
    assert shape.kind == "sphere"
    assert shape.size == pytest.approx((0.1,))
    assert 0.0 < beyond < 0.01


def test_what_would_reach_too_far_stays_a_mesh() -> None:
    assert fitted_shape(placed(prism(0.3, 0.05, 48)), 1e-4)[0].kind == "mesh"
    assert fitted_shape(placed(ball(0.1)), 1e-4)[0].kind == "mesh"


ROUND = prism(0.1, 0.3, 48)


@pytest.mark.parametrize("points", [prism(0.1, 0.3, 6), prism(0.1, 0.3, 48, top=0.9), ROUND[ROUND[:, 0] > -0.02]])
def test_what_is_not_round_stays_a_mesh(points: FloatArray) -> None:
    assert fitted_shape(placed(points), 0.01)[0].kind == "mesh"


def test_slivers_are_not_written() -> None:
    wedge = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 0.5 + 0.5 * x)])
    more = [[0.5, 0.0, 0.0], [0.25, 1.0, 0.0], [1.0, 1.0, 1.0 - 2e-5], [0.5, 0.3, 0.75]]
    vertices, faces = convex_hull(np.concatenate([wedge, more]))
    shape, _ = fitted_shape(ConvexPiece(vertices=vertices, faces=faces), 1e-4)
    assert shape.kind == "mesh"
    assert len(shape.mesh.vertices) == 8
    assert np.linalg.norm(shape.mesh.vertices[:, None] - wedge, axis=2).min(axis=1).max() < 1e-4


def test_a_cube_is_a_box_and_not_round() -> None:
    corners = np.array([[x, y, z] for x in (0.0, 0.1) for y in (0.0, 0.1) for z in (0.0, 0.1)])
    shape, beyond = fitted_shape(placed(corners), 1.0)
    assert shape.kind == "box"
    assert beyond == 0.0
