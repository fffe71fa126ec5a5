"""Families of objects with parameters: files here say how people call them, what may be asked, and how one is built."""

from __future__ import annotations

import re
import textwrap
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.generate.library.assembled import builder_of
from kinematify.generate.library.carved import carver_of
from kinematify.generate.procedural.family import Family
from kinematify.generate.procedural.parameter import parse_table, phrases, read_parameter

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.generate.library.steps import Step

_ORDER = (
    "cabinet", "serial_arm", "scara", "gantry", "gripper", "hand", "quadruped", "snake", "oven", "fridge", "table",
    "microwave", "dishwasher", "washing_machine", "safe", "laptop", "box", "window", "door", "switch_panel",
    "button_panel", "desk_lamp", "fan", "toaster", "coffee_machine", "trash_can", "toilet", "faucet",
    "office_chair", "folding_chair", "scissors", "pliers", "hexapod", "humanoid", "stapler", "bottle", "bucket",
    "pen", "clock", "excavator", "crane", "tracked_tree", "globe", "umbrella", "suitcase", "eyeglasses",
)  # fmt: skip
"""In which corpora draw them."""


def _families() -> Iterator[Family]:
    for file in sorted(Path(__file__).parent.glob("*.yaml")):
        for chunk in re.split(r"^(?=\w+:$)", file.read_text(encoding="utf-8"), flags=re.MULTILINE):
            head, kind, steps = re.split(r"\n  (steps|solids):\n", chunk, maxsplit=1) if "\n" in chunk else ("", "", "")
            for name, said in (parse_table(head) or {}).items():
                yield _family(name, said, kind, steps)


def _family(name: str, said: Mapping[str, Any], kind: str, written: str) -> Family:
    """A family whose steps are only read when one is built, since they are most of a file."""

    @cache
    def steps() -> Sequence[Step]:
        found: Sequence[Step] = parse_table(textwrap.dedent(written))
        return found

    title, parameters = said["title"], said["parameters"]
    return Family(
        name=name,
        title=title,
        words=phrases(said["words"]),
        parameters=tuple(read_parameter(asked, facts) for asked, facts in parameters.items()),
        build=carver_of(title, steps, parameters) if kind == "solids" else builder_of(name, title, steps, parameters),
        material=said.get("material", "wood"),
        kinds={kind: usual for kinds, usual in said.get("kinds", {}).items() for kind in phrases(kinds)},
        part_words={part: phrases(words) for part, words in said.get("part_words", {}).items()},
    )


FAMILIES: Mapping[str, Family] = {
    family.name: family for family in sorted(_families(), key=lambda family: _ORDER.index(family.name))
}
"""Keyed by name."""
