"""Objects as different people program them, for the fit: recipes that draw sizes, and hands that draw the modelling."""

from __future__ import annotations

import zlib
from types import FunctionType
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.recipes import (
    appliances,
    controls,
    furniture,
    household,
    leisure,
    machines,
    openings,
    storage,
    tabletop,
    vehicles,
    wheeled,
)
from benchmarks.recipes.object_builder import ModelingStyle, ObjectBuilder

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from kinematify.generate.procedural.blueprint import Blueprint

_MODULES = (
    furniture,
    household,
    machines,
    leisure,
    vehicles,
    openings,
    appliances,
    storage,
    controls,
    tabletop,
    wheeled,
)

OBJECTS: Mapping[str, Callable[[ObjectBuilder], None]] = {
    name: recipe
    for module in _MODULES
    for name, recipe in vars(module).items()
    if isinstance(recipe, FunctionType) and recipe.__module__ == module.__name__ and not name.startswith("_")
}
"""Every public function of the modules of recipes, keyed by its name."""


def drawn_object(name: str, seed: int, hand: ModelingStyle | None = None) -> Blueprint:
    """Draw an object.

    Args:
        name: Of `OBJECTS`.
        seed: Draws sizes, and the hand where none is given.
        hand: How it is modelled.
    """
    rng = np.random.default_rng([seed, zlib.crc32(name.encode())])
    someone = ModelingStyle.drawn(rng)
    draft = ObjectBuilder(name, hand or someone, rng)
    OBJECTS[name](draft)
    return draft.blueprint()
