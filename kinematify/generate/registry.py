"""All kinds: those in Python, and those that a blueprint lists; only what is asked for is loaded."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.library.kind import KINDS, MODELING, Kind, checked
from kinematify.generate.procedural.builder import CAREFUL, ObjectBuilder
from kinematify.generate.procedural.parameter import phrases
from kinematify.generate.procedural.solids import SEGMENTS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.parameter import Parameter, Value

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
    kind: str | Kind, given: Mapping[str, Value] | None = None, *, seed: int | None = None, name: str = ""
) -> Blueprint:
    """Build an object of a kind.

    Args:
        kind: Its name, or the kind.
        given: Parameter -> value in metres, radians, counts or words; others take their default, or what the seed
            draws from their usual range.
        seed: Draws what is not given; none takes the defaults.
        name: Of the object; the kind's if empty.

    Raises:
        InputError: There is no such kind, or a parameter is unknown or out of its bounds; the message names the nearest
            or the bounds.
    """
    found = kind_named(kind) if isinstance(kind, str) else kind
    if found is None:
        raise InputError(f"There is no kind {kind!r}. `kinematify generate --list` shows all.")
    rng, kind = np.random.default_rng(seed), found
    asked = {key: checked(kind, key, value) for key, value in (given or {}).items()}
    values = {p.name: _drawn(p, rng) if seed is not None and p.drawn else p.default for p in kind.all_parameters}
    values.update(asked)
    look = (str(values["material"]) or kind.carved_from, str(values["color"]) or None)
    builder = ObjectBuilder(
        kind.name,
        replace(CAREFUL, **{"gap": float(values["clearance"]), **_differences(kind, values)}),
        None if seed is None else rng,
        carves=bool(kind.carved_from),
        look=look if kind.carved_from else ("plastic", None),
        handles=(str(values["handle_material"]), str(values["handle_color"]) or None),
    )
    kind.make(builder, values)
    if not builder.joints:
        counts = ", ".join(p.name for p in kind.parameters if isinstance(p.default, int))
        raise InputError(f"Nothing of this {kind.title} would move. Ask for one of {counts} at least.")
    return builder.finish(
        name,
        {"seed": seed, **values},
        mesh_style=str(values["style"]),
        clearance=float(values["clearance"]),
        seed=seed,
        walls=kind.walls,
    )


def _differences(kind: Kind, values: Mapping[str, Value]) -> Mapping[str, Any]:
    """Its modelling style differs from the careful way in these."""
    if "modeling" in values:
        return MODELING[str(values["modeling"])]
    return {"sides": SEGMENTS, "knob": "pointer"} if kind.carved_from else {"sides": SEGMENTS}


def _drawn(parameter: Parameter, rng: np.random.Generator) -> Value:
    """Draw a value; always the same number of draws, so that giving one parameter does not change the others."""
    share = float(rng.random())
    if parameter.choices and parameter.name not in ("material", "color"):
        return parameter.choices[int(share * len(parameter.choices))]
    if parameter.usual is None:
        return parameter.default
    low, high = parameter.usual
    if isinstance(parameter.default, int):
        return int(low) + int(share * (int(high) - int(low) + 1))
    return low + share * (high - low)


@cache
def kind_named(name: str) -> Kind | None:
    """Return the kind of a name, None if there is none; of those in Python only its module is imported."""
    if name not in KINDS:
        if (file := _FOLDER / f"{name}.yaml").exists():
            from kinematify.generate.described import kind_in  # noqa: PLC0415 - the schema takes a tenth of a second

            return kind_in(file)
        for module in _modules().get(name, ()):
            import_module(f"kinematify.generate.kinds.{module}")
    return KINDS.get(name)


@cache
def _modules() -> Mapping[str, list[str]]:
    """Function -> the modules of kinds that have one of this name."""
    found: dict[str, list[str]] = {}
    for module in sorted(_FOLDER.glob("[a-z]*.py")):
        for name in re.findall(r"^def (\w+?)_?\(", module.read_text(encoding="utf-8"), re.MULTILINE):
            found.setdefault(name, []).append(module.stem)
    return found


@cache
def all_kinds() -> Mapping[str, Kind]:
    """Every kind, keyed by name: those of corpora, then the others by their module or file."""
    for file in _FOLDER.glob("[a-z]*.py"):
        import_module(f"kinematify.generate.kinds.{file.stem}")
    drawn = {item.name: item.module for item in KINDS.values() if not item.like}
    found = drawn | {file.stem: file.stem for file in _FOLDER.glob("*.yaml")}
    others = sorted((name for name in found if name not in FAMILIES), key=found.__getitem__)
    return {name: kind for name in (*FAMILIES, *others) if (kind := kind_named(name))}
