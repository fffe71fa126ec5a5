"""Inferences with a fault in them, for the nightly: named by ``planted_inferences:...`` as the function under test."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from quick_inference import star

from kinematify.pipeline.infer_assembly import infer

if TYPE_CHECKING:
    from types import SimpleNamespace

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.pipeline.inference import Inference


def sound(assembly: Assembly, *, config: Config) -> Inference:
    """As it is."""
    return infer(assembly, config=config)


def without_axis_evidence(assembly: Assembly, *, config: Config) -> Inference:
    """Nothing that the geometry says of an axis arrives: all are the same skew direction."""
    found = infer(assembly, config=config)
    skew = np.array([1.0, 2.0, 2.0]) / 3.0
    return replace(found, joints=tuple(replace(joint, axis=skew) for joint in found.joints))


def with_limits_in_degrees(assembly: Assembly, *, config: Config) -> Inference:
    """Limits are written in the wrong unit: three times as far as the sweep found."""
    found = infer(assembly, config=config)
    return replace(found, joints=tuple(replace(joint, upper=3.0 * joint.upper) for joint in found.joints))


def slow_on_three_parts(assembly: Assembly, *, config: Config) -> SimpleNamespace:
    if len(assembly.parts) == 3:
        time.sleep(1.3)
    return star(assembly, config=config)


def crashing_on_three_parts(assembly: Assembly, **given: Any) -> SimpleNamespace:
    if len(assembly.parts) == 3:
        raise RuntimeError("one bad object")
    return star(assembly, **given)
