"""Gaps between parts as the paper measures them (III-B): samples of either surface in the other part's field."""

from __future__ import annotations

from typing import TYPE_CHECKING

import torch

from kinematify.geometry.sampling import sample_surface
from kinematify.paper.sdf import field_source

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import Pair


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
