"""One module per family; `FAMILIES` lists them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.sources.procedural.families import cabinet

if TYPE_CHECKING:
    from kinematify.sources.procedural.family import Family

FAMILIES: dict[str, Family] = {family.name: family for family in (cabinet.FAMILY,)}
"""Keyed by name."""
