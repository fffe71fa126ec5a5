"""Light switches: rockers or toggles side by side in a plate, and dimmers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_knob
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, rod

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_DEPTH = 0.034  # of the housing [m]
_POCKET = 0.024  # depth of the room behind a switch [m]
_PIVOT = 0.009  # depth of its pins [m]
_PIN = 0.003  # radius of the pins [m]
_TILT = {"rocker": 0.12, "toggle": 0.35}
"""From the middle to either end [rad]."""


def _build(values: Values, workshop: Workshop) -> None:
    rockers, dimmers = values.count("rockers"), values.count("dimmers")
    pitch, height = values.number("pitch"), values.number("height")
    half = 0.5 * pitch * (rockers + dimmers) + 0.006
    plate = box((-half, 0, 0), (half, 0.004, height))
    housing = box((0.004 - half, 0.001, 0.004), (half - 0.004, _DEPTH, height - 0.004))
    workshop.body("plate", plate, housing)
    for k in range(rockers):
        _add_switch(values, workshop, k, (k + 0.5) * pitch - half + 0.006)
    clearance = values.number("clearance")
    for k in range(dimmers):
        place = ((rockers + k + 0.5) * pitch - half + 0.006, 0.0, 0.5 * height)
        mount = Mount(parent="plate", place=place, face=FRONT, clearance=clearance, depth=0.02)
        add_knob(workshop, f"dimmer_{k + 1}", mount, 0.36 * pitch, rest=values.number("open"))


def _add_switch(values: Values, workshop: Workshop, k: int, x: float) -> None:
    """A switch on pins that lie along x, tilted to its lower end."""
    kind, clearance = values.choice("kind"), values.number("clearance")
    half, level = 0.5 * values.number("pitch") - 0.008, 0.5 * values.number("height")
    if kind == "rocker":
        solid, room = _rocker(half, 0.36 * values.number("height"), clearance)
    else:
        half = min(half, 0.01)
        solid, room = _toggle(half, clearance)
    reach, tight = half + 0.0055, min(clearance, 0.5 * _PIN)
    pins = cylinder(_PIN, (-reach, 0, 0), (reach, 0, 0))
    place = (x, _PIVOT, level)
    workshop.cut("plate", room.translate(place))
    workshop.cut("plate", bore(_PIN, tight, (-reach - tight, 0, 0), (reach + tight, 0, 0)).translate(place))
    tilt = _TILT[kind]
    name = f"rocker_{k + 1}"
    workshop.body(name, (solid + pins).rotate((math.degrees(tilt), 0, 0)).translate(place))
    workshop.turns(name, "plate", (-1, 0, 0), place, (0.0, 2.0 * tilt), rest=values.number("open"))


def _rocker(half: float, high: float, clearance: float) -> tuple[Manifold, Manifold]:
    """A wedge with a ridge in its middle, level about its pins, and the room that it needs."""
    edge = high * math.tan(_TILT["rocker"]) - _PIVOT - 0.003
    ridge = box((-half, -_PIVOT - 0.003, -1e-3), (half, 0.004, 1e-3))
    wedge = hull(ridge, box((-half, edge, -high), (half, edge + 0.003, high)))
    reach = math.hypot(high, edge) + clearance
    wide = half + clearance
    return wedge, box((-wide, -1.0, -reach), (wide, _POCKET - _PIVOT, reach))


def _toggle(half: float, clearance: float) -> tuple[Manifold, Manifold]:
    """A stick on a hub, and the room that it needs."""
    hub = cylinder(0.006, (-half, 0, 0), (half, 0, 0))
    stick = hull(rod(0.0035, (0, 0, 0), (0, -0.01, 0)), rod(0.0045, (0, -0.022, 0), (0, -0.024, 0)))
    wide = half + clearance
    return hub + stick, box((-wide, -1.0, -0.012 - clearance), (wide, 0.008 + clearance, 0.012 + clearance))


FAMILY = family("switch_panel", _build)
