"""Families of objects with parameters that corpora draw."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.kind import all_kinds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.procedural.family import Family

_ORDER = (
    "cabinet", "serial_arm", "scara", "gantry", "gripper", "hand", "quadruped", "snake", "oven", "fridge", "table",
    "microwave", "dishwasher", "washing_machine", "safe", "laptop", "box", "window", "door", "switch_panel",
    "button_panel", "desk_lamp", "fan", "toaster", "coffee_machine", "trash_can", "toilet", "faucet",
    "office_chair", "folding_chair", "scissors", "pliers", "hexapod", "humanoid", "stapler", "bottle", "bucket",
    "pen", "clock", "excavator", "crane", "tracked_tree", "globe", "umbrella", "suitcase", "eyeglasses",
)  # fmt: skip
"""In which corpora draw them."""
FAMILIES: Mapping[str, Family] = {name: all_kinds()[name] for name in _ORDER}
"""Keyed by name."""
