"""What there are goldens of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from benchmarks.goldens import generated, models, surface
from benchmarks.goldens.values import Values


@dataclass(frozen=True, kw_only=True)
class GoldenSubject:
    """One kind of goldens."""

    items: Callable[[bool], tuple[dict[str, Any], dict[str, str]]]
    """All, or a sample: arguments of `values` by name, and why a data set is absent."""
    values: Callable[[Any], dict[str, Values]]
    """Makes the values of one item, in a process."""
    reuse: int = 1
    """Items that a process takes one after the other."""


SUBJECTS = {
    "inference": GoldenSubject(items=models.inference_items, values=models.inference_values),
    "findings": GoldenSubject(items=models.finding_items, values=models.finding_values),
    "features": GoldenSubject(items=models.feature_items, values=models.feature_values),
    "families": GoldenSubject(items=generated.family_items, values=generated.family_values, reuse=100),
    "objects": GoldenSubject(items=generated.object_items, values=generated.family_values, reuse=100),
    "requests": GoldenSubject(items=generated.request_items, values=generated.request_values, reuse=100),
    "episodes": GoldenSubject(items=generated.episode_items, values=generated.episode_values),
    "surface": GoldenSubject(items=surface.surface_items, values=surface.surface_values),
}
"""By name, in the order in which they are made."""
