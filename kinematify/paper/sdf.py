"""Interface of every signed distance field, whatever is behind it (paper III-B, ``f_theta``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import torch

from kinematify.geometry.sampling import sample_surface
from kinematify.paper.sdf_grid import SignedDistanceCache
from kinematify.paper.sdf_neural import train_fields

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from torch import Tensor

    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import Config, SdfConfig
    from kinematify.contact.graph import Pair


class SignedDistanceField(Protocol):
    """Signed distance to one part in the world frame [m], negative inside, defined in the whole space.

    A field answers in float64 and is differentiable by torch with respect to the points.
    """

    def value(self, points: Tensor) -> Tensor:
        """Signed distance [m] at world points, shape (..., 3) -> (...)."""
        ...


def field_source(parts: Sequence[Part], config: SdfConfig, *, seed: int) -> Callable[[Part], SignedDistanceField]:
    """Return what gives the field of each part; grids are made when asked for, networks are trained here and at once.

    Args:
        parts: All whose fields may be asked for.
        config: Kind and sizes.
        seed: Of samples and weights of networks.
    """
    if config.kind == "grid":
        return SignedDistanceCache(config).field
    distinct = list({part.mesh_hash: part for part in parts}.values())
    trained = train_fields(distinct, config.neural, seed=seed)
    field_of = {part.mesh_hash: field for part, field in zip(distinct, trained, strict=True)}
    return lambda part: field_of[part.mesh_hash]


def field_gaps(assembly: Assembly, config: Config) -> Callable[[Pair], float]:
    """Return the minimum bidirectional distance of a pair [m], 0 where a sample of one lies inside the other.

    Args:
        assembly: The parts, world frame.
        config: `sdf`, `contact.samples` and `seed` are used.
    """
    field_of = field_source(assembly.parts, config.sdf, seed=config.seed)
    samples = [sample_surface(part, config.contact.samples, config.seed).points for part in assembly.parts]

    def gap(pair: Pair) -> float:
        a, b = pair
        both = ((samples[a], assembly.parts[b]), (samples[b], assembly.parts[a]))
        smallest = min(float(field_of(part).value(torch.from_numpy(points.copy())).min()) for points, part in both)
        return max(smallest, 0.0)

    return gap
