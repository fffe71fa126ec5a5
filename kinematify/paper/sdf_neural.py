"""Signed distances as neural networks, those of all parts trained at once (paper III-B, ``f_theta``).

Each part has a network with sine activations (SIREN, Sitzmann et al. 2020) of its own; the weights of all stand in one
tensor per layer, so that a step of training is a handful of batched products whatever the number of parts. It is
trained on the paper's three kinds of samples (noisy surface points, offsets near the surface, far points of the box)
against exact distances, with the eikonal term of implicit geometric regularisation (Gropp et al. 2020).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import torch

from kinematify.geometry.sampling import sample_surface
from kinematify.paper.sdf_grid import exact_signed_distance

if TYPE_CHECKING:
    from collections.abc import Sequence

    from torch import Tensor

    from kinematify.assembly.part import Part
    from kinematify.config import NeuralSdfConfig
    from kinematify.robot.arrays import FloatArray

_STREAM = 41  # of the random numbers that only this module draws


class NeuralSignedDistanceField:
    """One part's network; outside of the box that it was trained in, the distance to the box is added."""

    def __init__(self, weights: Sequence[Tensor], biases: Sequence[Tensor], box: _Box, frequency: float) -> None:
        """Keep what was trained.

        Args:
            weights: Of each layer, shape (inputs, outputs).
            biases: Of each layer, shape (1, outputs).
            box: Where it was trained.
            frequency: Factor before the first sine.
        """
        self._weights, self._biases = [w[None] for w in weights], [b[None] for b in biases]
        self._box, self._frequency = box, frequency
        self._middle = torch.from_numpy(box.middle)
        self._half = torch.from_numpy(box.half)

    def value(self, points: Tensor) -> Tensor:
        """Signed distance [m] at world points, shape (..., 3) -> (...), differentiable."""
        local = points.to(torch.float64) - self._middle
        inside = torch.minimum(torch.maximum(local, -self._half), self._half)
        unit = (inside / self._box.scale).to(torch.float32).to(self._weights[0].device)
        found = _forward(self._weights, self._biases, unit.reshape(1, -1, 3), self._frequency)
        beyond = torch.linalg.vector_norm(local - inside + 1e-300, dim=-1)
        return torch.add(found.to(points.device, torch.float64).reshape(local.shape[:-1]) * self._box.scale, beyond)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Box:
    """Where a part's field is trained."""

    middle: FloatArray
    """World frame [m], shape (3,)."""
    half: FloatArray
    """Half of its sides, margin included [m], shape (3,)."""
    scale: float
    """Half of the part's diagonal, the unit of the network [m]."""


def train_fields(parts: Sequence[Part], config: NeuralSdfConfig, *, seed: int) -> tuple[NeuralSignedDistanceField, ...]:
    """Train the fields of some parts in one batched network.

    Args:
        parts: Meshes with positive extent.
        config: Size of the networks, samples and training.
        seed: Of samples and weights.

    Returns:
        One field per part, in their order; the same for the same seed on the same device.
    """
    if not parts:
        return ()
    device = torch.device("cuda" if config.device == "auto" and torch.cuda.is_available() else "cpu")
    boxes = [_box(part, config) for part in parts]
    found = [_samples(part, box, config, seed) for part, box in zip(parts, boxes, strict=True)]
    points = torch.from_numpy(np.stack([p for p, _ in found])).to(device, torch.float32)
    distances = torch.from_numpy(np.stack([d for _, d in found])).to(device, torch.float32)
    generator = torch.Generator().manual_seed(seed)
    weights, biases = _network(len(parts), config, generator, device)
    _train(weights, biases, (points, distances), config, generator)
    return tuple(
        NeuralSignedDistanceField(
            [w[k].detach().clone() for w in weights], [b[k].detach().clone() for b in biases], box, config.frequency
        )
        for k, box in enumerate(boxes)
    )


def _box(part: Part, config: NeuralSdfConfig) -> _Box:
    low, high = part.bounds
    diagonal = float(np.linalg.norm(high - low))
    return _Box(middle=0.5 * (low + high), half=0.5 * (high - low) + config.margin * diagonal, scale=0.5 * diagonal)


def _samples(part: Part, box: _Box, config: NeuralSdfConfig, seed: int) -> tuple[FloatArray, FloatArray]:
    """Points and exact distances in the units of the network, shapes (n, 3) and (n,): the paper's three kinds.

    The noise of the first kind has two widths, so that the zero level is learned sharply.
    """
    rng = np.random.default_rng([seed, _STREAM])
    near, far = config.surface_samples, config.far_samples
    surface = sample_surface(part, 2 * near, seed)
    on = surface.points + rng.normal(size=surface.points.shape) * config.noise * 2.0 * box.scale
    offset = rng.uniform(-1.0, 1.0, (len(surface.points), 1)) * config.offset * 2.0 * box.scale
    off = surface.points + offset * surface.normals
    away = box.middle + rng.uniform(-1.0, 1.0, (far, 3)) * box.half
    points = np.concatenate([on[:near], off[near : 2 * near], away])
    return (points - box.middle) / box.scale, exact_signed_distance(part, points) / box.scale


def _network(
    count: int, config: NeuralSdfConfig, generator: torch.Generator, device: torch.device
) -> tuple[list[Tensor], list[Tensor]]:
    """Weights (P, inputs, outputs) and biases (P, 1, outputs), drawn as SIREN asks."""
    sizes = [3, *[config.width] * config.layers, 1]
    weights, biases = [], []
    for layer, (inputs, outputs) in enumerate(pairwise(sizes)):
        bound = 1.0 / inputs if layer == 0 else math.sqrt(6.0 / inputs) / (config.frequency if layer else 1.0)
        draw = torch.rand((count, inputs, outputs), generator=generator) * 2.0 - 1.0
        weights.append((draw * bound).to(device).requires_grad_())
        shift = torch.rand((count, 1, outputs), generator=generator) * 2.0 - 1.0
        biases.append(
            (shift / math.sqrt(inputs) / (1.0 if layer == 0 else config.frequency)).to(device).requires_grad_()
        )
    return weights, biases


def _forward(weights: Sequence[Tensor], biases: Sequence[Tensor], points: Tensor, frequency: float) -> Tensor:
    """Values of all networks at their own points, (P, N, 3) -> (P, N)."""
    hidden = points
    for weight, bias in zip(weights[:-1], biases[:-1], strict=True):
        hidden = torch.sin(frequency * torch.baddbmm(bias, hidden, weight))
    return torch.baddbmm(biases[-1], hidden, weights[-1]).squeeze(-1)


def _train(
    weights: list[Tensor], biases: list[Tensor], samples: tuple[Tensor, Tensor], config: NeuralSdfConfig,
    generator: torch.Generator,
) -> None:  # fmt: skip
    """Minimise the clamped distance error and the eikonal term; every part sees batches of its own points."""
    points, distances = samples
    optimizer = torch.optim.Adam([*weights, *biases], lr=config.rate)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, config.steps, eta_min=0.01 * config.rate)
    count = points.shape[1]
    for step in range(config.steps):
        rows = torch.randint(count, (config.batch,), generator=generator).to(points.device)
        batch, wanted = points[:, rows], distances[:, rows]
        loss = _distance_loss(_forward(weights, biases, batch, config.frequency), wanted, config)
        if step % config.eikonal_every == 0:
            some = batch[:, : config.eikonal_batch].detach().requires_grad_()
            values = _forward(weights, biases, some, config.frequency)
            (gradient,) = torch.autograd.grad(values.sum(), some, create_graph=True)
            loss = loss + config.eikonal_weight * ((gradient.norm(dim=-1) - 1.0) ** 2).mean()
        optimizer.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        optimizer.step()
        schedule.step()


def _distance_loss(found: Tensor, wanted: Tensor, config: NeuralSdfConfig) -> Tensor:
    """Mean absolute error, near the surface counted more, since contacts are judged there."""
    near = torch.exp(-wanted.abs() / config.near)
    return ((found - wanted).abs() * (1.0 + config.near_weight * near)).mean()
