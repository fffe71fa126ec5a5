"""Desk lamps: arms on pins one after the other, and a shade at the end."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import bent_fork, stub
from kinematify.generate.procedural.pieces.controls import TOP, Mount, add_button, add_knob
from kinematify.generate.procedural.solids import ball, cylinder, rod

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_LEANS = {1: (0.0, 0.9), 2: (0.0, 0.3, 1.3), 3: (0.0, -0.4, 0.8, 1.6)}
"""Of the post, the arms and the head's neck, from the upright towards the front [rad]; by hinges."""
_SWINGS = ((-0.3, 0.4), (-0.25, 0.6), (-0.4, 0.5))
"""Of the hinges, counted from the head, positive upwards [rad]."""
_RADIUS = 0.011  # of the hinges [m]


def _build(values: Values, workshop: Workshop) -> None:
    hinges, clearance, rest = min(values.count("joints"), 3), values.number("clearance"), values.number("open")
    foot, length = values.number("base"), values.number("arm")
    workshop.body("base", cylinder(foot, (0, 0, 0), (0, 0, 0.02)), cylinder(0.6 * foot, (0, 0, 0.019), (0, 0, 0.028)))
    _add_switch(values, workshop)
    parent, pivot = "base", np.array([0.0, 0.0, 0.08 if hinges > 1 else 0.03 + 0.8 * length])
    if values.count("joints") > hinges:
        boss, hole, rotor = stub((0, 0, 0.045), (0, 0, 1), 0.016, clearance, length=0.018)
        workshop.add("base", boss)
        workshop.cut("base", hole)
        parent = "post"
        workshop.body(parent, rotor)
        workshop.turns(parent, "base", (0, 0, 1), (0, 0, 0.045), (-2.5, 2.5))
        pivot[2] += 0.02
        start = (0.0, 0.0, 0.06)
    else:
        start = (0.0, 0.0, 0.02)
    workshop.add(parent, cylinder(0.9 * _RADIUS, start, pivot - (0.0, 0.0, 2.0 * _RADIUS)))
    leans = _LEANS[hinges]
    for k in range(hinges):
        last = k + 1 == hinges
        forked, tongue = bent_fork(pivot, (leans[k], leans[k + 1]), 0.026, _RADIUS, clearance)
        workshop.add(parent, forked)
        along = np.array([0.0, -math.sin(leans[k + 1]), math.cos(leans[k + 1])])
        end = pivot + (0.02 + values.number("shade") if last else length) * along
        begin, stop = pivot + 1.6 * _RADIUS * along, end - (0.0 if last else 2.0 * _RADIUS) * along
        name = "head" if last else f"arm_{k + 1}"
        workshop.body(name, tongue, rod(0.55 * _RADIUS, begin, stop))
        if last:
            workshop.add(name, *_shade(values, end, leans[k + 1] + 0.5 * math.pi))
        workshop.turns(name, parent, (-1, 0, 0), pivot, _SWINGS[hinges - 1 - k], rest=rest)
        parent, pivot = name, end


def _shade(values: Values, neck: FloatArray, lean: float) -> list[Manifold]:
    """A hollow cone that hangs on the neck with a bulb in it; its mouth looks where `lean` says."""
    wide, deep = values.number("shade"), 1.1 * values.number("shade")
    cone = Manifold.cylinder(deep, 0.35 * wide, wide, 48)
    inner = Manifold.cylinder(deep, 0.35 * wide - 0.002, wide - 0.002, 48).translate((0, 0, 0.004))
    bulb = ball(0.3 * wide, (0, 0, 0.45 * deep)) + cylinder(0.12 * wide, (0, 0, 0.002), (0, 0, 0.4 * deep))
    socket = cylinder(0.3 * wide, (0, 0, -0.03), (0, 0, 0.002))
    made = [cone - inner, bulb, socket]
    return [solid.translate((0, 0, 0.01)).rotate((math.degrees(lean), 0, 0)).translate(neck) for solid in made]


def _add_switch(values: Values, workshop: Workshop) -> None:
    """A button or a knob in front of the post."""
    clearance, foot = values.number("clearance"), values.number("base")
    mount = Mount(parent="base", place=(0, -0.8 * foot, 0.02), face=TOP, clearance=clearance, depth=0.012)
    if values.choice("switch") == "button":
        add_button(workshop, "button", mount, (0.016, 0.012), travel=0.003)
    elif values.choice("switch") == "knob":
        add_knob(workshop, "knob", mount, 0.12 * foot, rest=values.number("open"))


FAMILY = family("desk_lamp", _build)
