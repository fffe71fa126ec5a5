"""Networks of signed distance against exact distances, as a field, and in the place of the grid."""

from __future__ import annotations

import numpy as np
import pytest
import torch
import trimesh

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.geometry.sampling import sample_surface
from kinematify.paper.sdf import field_source
from kinematify.paper.sdf_grid import exact_signed_distance
from kinematify.paper.sdf_neural import NeuralSignedDistanceField, train_fields

CONFIG = load_config().sdf.neural.model_copy(update={"device": "cpu"})


def part(mesh: trimesh.Trimesh, name: str) -> Part:
    return Part(name=name, vertices=np.array(mesh.vertices), faces=np.array(mesh.faces))


@pytest.fixture(scope="module")
def parts() -> tuple[Part, ...]:
    """A ball, a box that is long and far from the origin, and an L of two boards."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.2)
    box = trimesh.creation.box((2.0, 0.4, 0.3)).apply_translation((50.0, -20.0, 3.0))
    board = trimesh.creation.box((1.0, 0.1, 1.0)).apply_translation((0.0, 0.45, 0.5))
    angle = trimesh.boolean.union([trimesh.creation.box((1.0, 1.0, 0.1)), board])
    return part(ball, "ball"), part(box, "box"), part(angle, "angle")


@pytest.fixture(scope="module")
def fields(parts: tuple[Part, ...]) -> tuple[NeuralSignedDistanceField, ...]:
    torch.set_num_threads(1)
    return train_fields(parts, CONFIG, seed=0)


def near_points(item: Part) -> np.ndarray:
    """Within 5 % of the diagonal of the surface."""
    rng = np.random.default_rng(7)
    found = sample_surface(item, 2000, 5)
    diagonal = np.linalg.norm(np.ptp(item.bounds, axis=0))
    return np.asarray(found.points + rng.uniform(-0.05, 0.05, (2000, 1)) * diagonal * found.normals)


def test_error_near_the_surface_is_below_half_a_percent_of_the_diagonal(
    parts: tuple[Part, ...], fields: tuple[NeuralSignedDistanceField, ...]
) -> None:
    for item, field in zip(parts, fields, strict=True):
        points = near_points(item)
        error = np.abs(field.value(torch.from_numpy(points)).detach().numpy() - exact_signed_distance(item, points))
        assert error.mean() <= 0.005 * np.linalg.norm(np.ptp(item.bounds, axis=0))


def test_gradient_is_that_of_the_value_and_about_one(fields: tuple[NeuralSignedDistanceField, ...]) -> None:
    points = torch.tensor([[0.25, 0.0, 0.02], [0.0, 0.19, 0.0], [0.1, 0.1, -0.2]], dtype=torch.float64)
    leaf = points.clone().requires_grad_()
    values = fields[0].value(leaf)
    (gradients,) = torch.autograd.grad(values.sum(), leaf)
    assert values.dtype == gradients.dtype == torch.float64
    step = 1e-3
    for axis in range(3):
        shift = step * torch.eye(3, dtype=torch.float64)[axis]
        slope = (fields[0].value(points + shift) - fields[0].value(points - shift)) / (2.0 * step)
        assert torch.allclose(slope, gradients[:, axis], atol=0.02)
    assert torch.allclose(gradients.norm(dim=-1), torch.ones(3, dtype=torch.float64), atol=0.15)


def test_configuration_chooses_between_grid_and_network(parts: tuple[Part, ...]) -> None:
    sdf = load_config().sdf
    quick = sdf.model_copy(update={"kind": "neural", "neural": CONFIG.model_copy(update={"steps": 5})})
    twins = [parts[0], Part(name="twin", vertices=parts[0].vertices, faces=parts[0].faces)]
    source = field_source(twins, quick, seed=0)
    assert isinstance(source(twins[0]), NeuralSignedDistanceField)
    assert source(twins[0]) is source(twins[1])  # one shape is trained once
    assert not isinstance(field_source(twins, sdf, seed=0)(twins[0]), NeuralSignedDistanceField)
    assert load_config("paper").sdf.kind == "neural"
    assert train_fields((), CONFIG, seed=0) == ()
