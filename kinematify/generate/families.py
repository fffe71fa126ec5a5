"""All kinds in Python, and the families of them that corpora draw."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.generate.library.kind import KINDS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.procedural.family import Family

_ORDER = (
    "cabinet serial_arm scara gantry gripper hand quadruped snake oven fridge table microwave dishwasher "
    "washing_machine safe laptop box window door switch_panel button_panel desk_lamp fan toaster coffee_machine "
    "trash_can toilet faucet office_chair folding_chair scissors pliers hexapod humanoid stapler bottle bucket pen "
    "clock excavator crane tracked_tree globe umbrella suitcase eyeglasses"
)
"""In which corpora draw them."""


@cache
def all_kinds() -> Mapping[str, Family]:
    """Every kind in Python, keyed by name: all modules of `kinematify.generate.kinds` are imported."""
    for file in sorted(Path(__file__).with_name("kinds").glob("[a-z]*.py")):
        import_module(f"kinematify.generate.kinds.{file.stem}")
    return {name: item for name, item in KINDS.items() if not item.like}


FAMILIES: Mapping[str, Family] = {name: all_kinds()[name] for name in _ORDER.split()}
"""Keyed by name."""
