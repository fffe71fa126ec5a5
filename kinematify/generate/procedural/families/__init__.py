"""Families by what they are: `families.yaml` has their steps, or a function ``build_NAME`` here builds NAME."""

from __future__ import annotations

from kinematify.generate.library.assembled import builder_of
from kinematify.generate.procedural.families import (
    appliances,
    arms,
    bathroom,
    belongings,
    building,
    containers,
    furniture,
    machines,
    small_appliances,
    walkers,
)
from kinematify.generate.procedural.family import described_families

_MODULES = (
    appliances, arms, bathroom, belongings, building, containers, furniture, machines, small_appliances,
    walkers,
)  # fmt: skip

FAMILIES = described_families(
    {
        name.removeprefix("build_"): build
        for module in _MODULES
        for name, build in vars(module).items()
        if name.startswith("build_")
    },
    builder_of,
)
"""Keyed by name."""
