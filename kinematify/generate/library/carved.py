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
from kinematify.generate.library.panels import drawer, leaf
from kinematify.generate.library.steps import ARITHMETIC, MECHANISMS, SOLIDS, Step, StepRunner, public
from kinematify.generate.procedural import layout
from kinematify.generate.procedural.parameter import read_table
from kinematify.generate.procedural.pieces import bearing_pieces, fronts, leaves
from kinematify.generate.procedural.solids import X, Z, box
from kinematify.generate.procedural.workshop import Workshop
from kinematify.robot.robot import Mimic
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.pieces.fronts import Bay, Fitting

_RIM = 0.75  # height of a drawer's sides, share of the bay's
_REVEAL = 0.002  # of a front towards its neighbours, besides the clearance
_PIECES = (bearing_pieces, fronts, leaves)


def add_drawer(workshop: Workshop, name: str, parent: str, opening: Bay, fitting: Fitting) -> None:
    """Add a drawer that runs in the room behind an opening and comes out along -y.

    Strips along both sides of the room, above its rim, keep it from lifting and tipping when it is out.
    """
    edge, clearance = 0.5 * opening.wall, fitting.clearance
    lower = opening.left + edge, 0.0, opening.bottom + edge
    upper = opening.right - edge, opening.depth - opening.wall, opening.top - edge
    lap = edge - 0.5 * (clearance + _REVEAL)
    with drawn_on(workshop, clearance, fitting.rest) as d:
        drawer(d, name, parent, lower, upper, travel=0.8, lap=lap, front=opening.wall, rim=_RIM, handle=fitting.grip)
    rim = lower[2] + _RIM * (upper[2] - lower[2]) + clearance
    reach = edge + clearance + min(0.012, 0.06 * min(opening.width, opening.height))
    for low, high in (
        (opening.left + 0.5 * edge, opening.left + reach),
        (opening.right - reach, opening.right - 0.5 * edge),
    ):
        workshop.add(parent, box((low, 0.0, rim), (high, upper[1] + 0.5 * edge, opening.top - 0.5 * edge)))


def add_door(
    workshop: Workshop,
    name: str,
    parent: str,
    opening: Bay,
    fitting: Fitting,
    *,
    side: str,
    hinge: str = "edge",
) -> None:
    """Add what closes an opening and turns outwards about a line at one side of it.

    Args:
        workshop: Where it is added.
        name: Of the door.
        parent: The body that carries it; a barrel hinge leaves its other half there.
        opening: What the door covers.
        fitting: Gaps, handle and where it is.
        side: ``left`` or ``right``, or ``bottom`` of what falls open.
        hinge: ``edge`` (nothing to be seen) or ``barrel``, beside which nothing may be.
    """
    edge, reach = {"left": (-X, 1.8), "right": (X, 1.8), "bottom": (-Z, 0.5 * np.pi)}[side]
    less = 0.5 * _REVEAL
    lower = opening.left + less, -opening.wall, opening.bottom + less
    with drawn_on(workshop, fitting.clearance, fitting.rest) as d:
        leaf(
            d, name, parent, lower, (opening.right - less, 0.0, opening.top - less), hinge=edge, reach=reach,
            handle=fitting.grip, barrels=2 if hinge == "barrel" else 0,
        )  # fmt: skip


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


def carver_of(
    title: str, steps: Callable[[], Sequence[Step]], parameters: Iterable[str]
) -> Callable[[Values, Workshop], None]:
    """Return the function that builds an object from steps that carve.

    Args:
        title: In messages.
        steps: Read when the first one is built.
        parameters: Names that formulas may use, besides those of every family.
    """
    names = (*parameters, "open", "clearance")

    def build(values: Values, workshop: Workshop) -> None:
        carve(title, steps(), workshop, {name: values.value(name) for name in names})

    return build
