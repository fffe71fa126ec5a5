"""From steps that carve to an object: verbs are the workshop's own and the pieces that many objects share."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.library.builder import drawn_on
from kinematify.generate.library.panels import add_door, add_drawer
from kinematify.generate.library.steps import ARITHMETIC, MECHANISMS, SOLIDS, Step, StepRunner, public
from kinematify.generate.procedural import layout
from kinematify.generate.procedural.parameter import read_table
from kinematify.generate.procedural.pieces import bearing_pieces, fronts, leaves
from kinematify.generate.procedural.workshop import Workshop
from kinematify.robot.robot import Mimic
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


_PIECES = (bearing_pieces, fronts, leaves)


def _mimic(leader: str, multiplier: float = 1.0) -> Mimic:
    """Return what a joint follows: the leader's child part, and how many times as far it goes."""
    return Mimic(joint=leader, multiplier=multiplier, offset=0.0)


_FOUND: Mapping[str, Any] = {name: item for module in _PIECES for name, item in public(module).items()}
_VERBS: Mapping[str, Callable[..., Any]] = {
    **{name: getattr(Workshop, name) for name in ("body", "add", "cut", "turns", "slides", "closes")},
    **{name.removeprefix("add_"): call for name, call in _FOUND.items() if name.startswith("add_")},
    "door": add_door,
    "drawer": add_drawer,
}
"""What a step does to a workshop."""
_NAMES: Mapping[str, Any] = {
    **ARITHMETIC, **_FOUND, **public(layout), **SOLIDS,
    **{name: getattr(math, name) for name in ("sin", "cos", "tan", "hypot", "degrees", "copysign")},
    **{name: getattr(np, name) for name in ("diag", "zeros", "column_stack", "abs")},
    "FRONT": bearing_pieces.FRONT, "float": float, "replace": replace, "mimic": _mimic,
    "rotation_about": rotation_about,
}  # fmt: skip
"""What formulas of solids may name."""


@cache
def _pieces() -> Sequence[Step]:
    """Return what steps that carve may call besides functions."""
    found: Sequence[Step] = read_table(Path(__file__).parents[1] / "composer" / "pieces.yaml")
    return found


def carve(title: str, steps: Sequence[Step], workshop: Workshop, given: Mapping[str, Any]) -> None:
    """Carry out steps that carve.

    Args:
        title: In messages.
        steps: In this order.
        workshop: Takes what they make.
        given: What formulas may name besides functions; `clearance` is among them.

    Raises:
        InputError: A step cannot be carried out; the message quotes it.
    """
    drawing = {name: partial(_drawn, call, given["clearance"]) for name, call in MECHANISMS.items()}
    runner = StepRunner(workshop, {**drawing, **_VERBS})
    names = {"__builtins__": {}, **_NAMES, "clearance": given["clearance"]}
    try:
        runner.run(_pieces(), names)
        names.update(given)
        runner.run(steps, names)
    except ValueError as error:
        raise InputError(f"The {title} cannot be built: {error}.") from error


def _drawn(
    mechanism: Callable[..., Any], gap: float, workshop: Workshop, name: str, *, rest: float = 0.0, **given: Any
) -> None:
    """Add a mechanism that objects in steps have, too; `clearance` where it is not that of the whole."""
    with drawn_on(workshop, given.pop("clearance", gap), rest) as builder:
        mechanism(builder, name, **given)
