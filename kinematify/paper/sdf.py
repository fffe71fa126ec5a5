"""Interface of every signed distance field, whatever is behind it (paper III-B, ``f_theta``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from kinematify.paper.sdf_grid import SignedDistanceCache
from kinematify.paper.sdf_neural import train_fields

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from torch import Tensor

    from kinematify.assembly.part import Part
    from kinematify.config import SdfConfig


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
