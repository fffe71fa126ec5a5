"""Mechanisms that are placed on a side of a body, each with its own bearing, clearance and limits.

How people call them and where they go is in ``mechanisms.yaml``, how each is built in ``mechanism_steps.yaml``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.generate.library.carved import carve
from kinematify.generate.procedural.parameter import phrases, read_table

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.generate.composer.place import Placement
    from kinematify.generate.library.steps import Step


@cache
def _steps() -> Mapping[str, Sequence[Step]]:
    """Return how each is built, keyed by name."""
    found: Mapping[str, Sequence[Step]] = read_table(Path(__file__).with_name("mechanism_steps.yaml"))
    return found


def _built(name: str, place: Placement) -> None:
    """Build a mechanism at a place as its steps say."""
    carve(name, (*_steps()["shared"], *_steps()[name]), place.workshop, place.named)


@dataclass(frozen=True, kw_only=True)
class MechanismKind:
    """A kind of mechanism."""

    words: tuple[str, ...]
    """How people call it, singular; the first one names it."""
    sides: tuple[str, ...]
    """Where it may go, the usual one first."""
    build: Callable[[Placement], None]
    arranged: str = "grid"
    """``row`` beside each other over the full height, ``stack`` one below the other, ``grid``, ``foot`` beside each
    other below all that, ``corners`` below the body, ``axles`` along its lower edges, ``over`` a side or its lid,
    ``alone`` on a side, ``apart`` on a side with at most what is over it, or ``edge``, which takes no room."""
    weight: float = 1.0
    """Share of a side's height beside the others."""
    least: tuple[float, float] = (0.04, 0.04)
    """Width and height that one needs [m]."""
    needs: str = ""
    """``room`` to run in, which must be cut behind it, or at least an ``opening`` that it closes; an open ``mouth``, a
    ``round mouth``, ``height`` above the floor, a ``post`` that ends there, or ``legs``."""
    most: int = 60
    """On one body."""
    moves: bool = True
    has_grip: bool = False
    """A handle of its own, which may be of another look."""
    members: tuple[str, ...] = ()
    """What it has several of, which may be counted: the blades of a rotor."""
    halves: bool = False
    """On the left or the right is said of the half of a side that it covers."""
    on_parts: Callable[[Placement], None] | None = None
    """How it is built on a door, a lid or the like, where that is otherwise."""


def _kind(said: Mapping[str, Any]) -> MechanismKind:
    listed = {name: phrases(said[name]) for name in ("words", "members") if name in said}
    pairs = {name: tuple(said[name]) for name in ("sides", "least") if name in said}
    built = {name: partial(_built, said[name]) for name in ("build", "on_parts") if name in said}
    return MechanismKind(**{**said, **listed, **pairs, **built})


MECHANISMS = tuple(_kind(said) for said in read_table(Path(__file__).with_name("mechanisms.yaml")))
"""All mechanisms; no word stands twice."""
