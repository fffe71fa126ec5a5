"""All kinds: those in Python, and those that a blueprint lists; only what is asked for is loaded."""

from __future__ import annotations

import re
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.library.kind import KINDS, Kind, built
from kinematify.generate.procedural.parameter import phrases

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.parameter import Value

FAMILIES = phrases(
    "cabinet, serial_arm, scara, gantry, gripper, hand, quadruped, snake, oven, fridge, table, microwave, "
    "dishwasher, washing_machine, safe, laptop, box, window, door, switch_panel, button_panel, desk_lamp, fan, "
    "toaster, coffee_machine, trash_can, toilet, faucet, office_chair, folding_chair, scissors, pliers, hexapod, "
    "humanoid, stapler, bottle, bucket, pen, clock, excavator, crane, tracked_tree, globe, umbrella, suitcase, "
    "eyeglasses"
)
"""Names of the kinds that corpora draw, in this order."""
_FOLDER = Path(__file__).with_name("kinds")


def build(
    kind: str | Kind, parameters: Mapping[str, Value] | None = None, *, seed: int | None = None, name: str = ""
) -> Blueprint:
    """Build an object of a kind.

    Args:
        kind: Its name, or the kind.
        parameters: As `built` takes them; texts of numbers are read.
        seed: Draws what is not given; none takes the defaults.
        name: Of the object; the kind's if empty.

    Raises:
        InputError: There is no such kind, or a parameter is unknown or out of its bounds.
    """
    found = kind_named(kind) if isinstance(kind, str) else kind
    if found is None:
        raise InputError(f"There is no kind {kind!r}. `kinematify generate --list` shows all.")
    return built(found, parameters or {}, seed=seed, name=name)


@cache
def kind_named(name: str) -> Kind | None:
    """Return the kind of a name, None if there is none; of those in Python only its module is imported."""
    if name not in KINDS:
        if (file := _FOLDER / f"{name}.yaml").exists():
            from kinematify.generate.described import kind_in  # noqa: PLC0415 - the schema takes a tenth of a second

            return kind_in(file)
        begins = re.compile(rf"^def {re.escape(name)}_?\(", re.MULTILINE)
        for module in sorted(_FOLDER.glob("[a-z]*.py")):
            if begins.search(module.read_text(encoding="utf-8")):
                import_module(f"kinematify.generate.kinds.{module.stem}")
    return KINDS.get(name)


@cache
def all_kinds() -> Mapping[str, Kind]:
    """Every kind, keyed by name: those of corpora, then the others by their module or file."""
    for file in _FOLDER.glob("[a-z]*.py"):
        import_module(f"kinematify.generate.kinds.{file.stem}")
    drawn = {item.name: item.module for item in KINDS.values() if not item.like}
    found = drawn | {file.stem: file.stem for file in _FOLDER.glob("*.yaml")}
    others = sorted((name for name in found if name not in FAMILIES), key=found.__getitem__)
    return {name: kind for name in (*FAMILIES, *others) if (kind := kind_named(name))}
