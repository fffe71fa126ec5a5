"""Families by what they are; the function ``build_NAME`` of one of these modules builds the family NAME."""

from __future__ import annotations

from kinematify.generate.procedural.families import (
    appliances,
    arms,
    bathroom,
    belongings,
    building,
    containers,
    furniture,
    hand_tools,
    machines,
    small_appliances,
    walkers,
)
from kinematify.generate.procedural.family import described_families

_MODULES = (
    appliances, arms, bathroom, belongings, building, containers, furniture, hand_tools, machines, small_appliances,
    walkers,
)  # fmt: skip

FAMILIES = described_families(
    {
        name.removeprefix("build_"): build
        for module in _MODULES
        for name, build in vars(module).items()
        if name.startswith("build_")
    }
)
"""Keyed by name."""
