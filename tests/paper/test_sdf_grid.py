"""Signed distances against closed formulas, on grids and exactly, on closed, open and overlapping meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
import torch
import trimesh

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.paper.sdf_grid import (
    SignedDistanceGrid,
    exact_signed_distance,
)
from tests.known import part_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.robot.arrays import FloatArray

CONFIG = load_config().sdf.model_copy(
    update={"resolution": 48, "margin": 0.1, "band_cells": 2.0, "cache_bytes": 10_000_000}
)


def around(part: Part, count: int = 4000, room: float = 0.08) -> FloatArray:
    reach = room * part.diagonal
    return np.random.default_rng(0).uniform(part.bounds[0] - reach, part.bounds[1] + reach, (count, 3))


def sphere_distance(points: FloatArray) -> FloatArray:
    return np.linalg.norm(points, axis=1) - 1.0


def box_distance(points: FloatArray) -> FloatArray:
    beyond = np.abs(points) - np.array([0.5, 1.0, 1.5])
    return np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)


def torus_distance(points: FloatArray) -> FloatArray:
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - 1.0, points[:, 2]) - 0.3


SOLIDS = {
    "sphere": (part_of(trimesh.creation.icosphere(subdivisions=4)), sphere_distance, 2e-3),
    "box": (part_of(trimesh.creation.box((1.0, 2.0, 3.0))), box_distance, 1e-12),
    "torus": (
        part_of(trimesh.creation.torus(1.0, 0.3, major_sections=96, minor_sections=64)),
        torus_distance,
        2e-3,
    ),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_exact_distance_has_its_sign(name: str) -> None:
    part, formula, faceting = SOLIDS[name]
    points = around(part)
    expected = formula(points)
    assert np.abs(exact_signed_distance(part, points) - expected).max() <= faceting


@pytest.mark.parametrize("name", SOLIDS)
def test_grid_agrees_with_the_formula_in_value_sign_and_gradient(name: str) -> None:
    part, formula, _ = SOLIDS[name]
    grid, points = SignedDistanceGrid(part, CONFIG), around(part)
    leaf = torch.from_numpy(points).requires_grad_()
    values = grid.value(leaf)
    (gradients,) = torch.autograd.grad(values.sum(), leaf)
    expected = formula(points)
    errors = np.abs(values.detach().numpy() - expected) / part.diagonal
    assert errors.mean() < 1.5e-3
    assert errors.max() < 0.02
    clear = np.abs(expected) > grid.spacing
    assert np.array_equal(values.detach().numpy()[clear] < 0.0, expected[clear] < 0.0)
    true_gradients = central_differences(formula, points)
    cosines = np.einsum("nd,nd->n", gradients.numpy(), true_gradients)
    assert np.median(cosines) > 0.99
    assert np.mean(cosines > 0.9) > 0.9


def central_differences(formula: Callable[[FloatArray], FloatArray], points: FloatArray) -> FloatArray:
    step = 1e-5
    shifts = step * np.eye(3)
    return np.stack([(formula(points + s) - formula(points - s)) / (2.0 * step) for s in shifts], axis=1)


def test_outside_of_the_grid_the_field_goes_on_growing() -> None:
    part, formula, _ = SOLIDS["sphere"]
    grid = SignedDistanceGrid(part, CONFIG)
    directions = np.random.default_rng(1).normal(size=(50, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    along = [grid.value(torch.from_numpy(radius * directions)).numpy() for radius in np.linspace(1.2, 20.0, 40)]
    assert np.all(np.diff(along, axis=0) > 0.0)
    assert np.all(along[-1] >= formula(20.0 * directions) - 0.01)
    assert np.all(along[-1] < 1.2 * formula(20.0 * directions))


def test_an_open_shell_has_the_inside_that_it_encloses() -> None:
    sphere = trimesh.creation.icosphere(subdivisions=4)
    upper = sphere.triangles_center[:, 2] > 0.0
    bowl = part_of(sphere.submesh([np.flatnonzero(upper)], append=True))
    probes = np.array([[0.0, 0.0, 0.9], [0.0, 0.0, -0.2], [0.0, 0.0, 1.2]])
    expected = np.array([-0.1, np.sqrt(1.04), 0.2])
    assert np.abs(exact_signed_distance(bowl, probes) - expected).max() < 0.06
    assert np.abs(SignedDistanceGrid(bowl, CONFIG).value(torch.from_numpy(probes)).numpy() - expected).max() < 0.06
