"""Signed distance fields of an assembly's parts, of the kind that the configuration names (paper III-B)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.paper.sdf_grid import SignedDistanceCache
from kinematify.paper.sdf_neural import train_fields

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.assembly.part import Part
    from kinematify.config import SdfConfig
    from kinematify.paper.sdf import SignedDistanceField


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
