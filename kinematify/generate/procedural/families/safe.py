"""Safes: thick walls, a heavy door with a lever, and a dial or a keypad."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.controls import FRONT, Mount, add_button, add_knob, grid
from kinematify.generate.procedural.pieces.fronts import Fitting, Opening, add_door, carcass
from kinematify.generate.procedural.solids import bore, cylinder, rod

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


def _build(values: Values, workshop: Workshop) -> None:
    width, height, depth = (values.number(name) for name in ("width", "height", "depth"))
    clearance, rest = values.number("clearance"), values.number("open")
    wall = 2.0 * values.number("wall")  # a door is twice as thick as the walls
    opening = Opening(left=-0.5 * width, right=0.5 * width, bottom=0.0, top=height, depth=depth, wall=wall)
    workshop.body("body", carcass(width, height, depth, [opening]))
    fitting = Fitting(clearance=clearance, grip="none", rest=rest)
    add_door(workshop, "door", "body", opening, fitting, side="left", outermost=True, hinge=values.choice("hinge"))
    front, size = -clearance - wall, min(width, height)

    def mount(x: float, z: float) -> Mount:
        return Mount(parent="door", place=(x, front, z), face=FRONT, clearance=clearance, depth=0.7 * wall)

    if values.choice("lock") == "dial":
        add_knob(workshop, "dial", mount(0.0, 0.68 * height), min(0.05, 0.12 * size), endless=True)
    else:
        pad = min(0.12, 0.3 * size)
        for k, (x, z) in enumerate(grid(12, 3, (0.75 * pad, pad))):
            cap = 0.2 * pad - 2 * clearance
            add_button(workshop, f"button_{k + 1}", mount(x, 0.68 * height + z), (cap, 0.9 * cap), travel=0.002)
    _add_lever(values, workshop, mount(0.0, 0.3 * height), min(0.12, 0.22 * size))


def _add_lever(values: Values, workshop: Workshop, mount: Mount, length: float) -> None:
    """A lever or a wheel of three spokes that draws the bolts; its shaft turns in the door."""
    radius, clearance = 0.1 * length, mount.clearance
    workshop.cut("door", mount.placed(bore(radius, clearance, (0, 0, -mount.depth), (0, 0, 1.0))))
    spokes = (90.0, 210.0, 330.0) if values.choice("handle") == "wheel" else (0.0,)
    level = clearance + 0.35 * length
    solids = [
        cylinder(radius, (0, 0, clearance - mount.depth), (0, 0, level)),
        cylinder(1.6 * radius, (0, 0, clearance), (0, 0, clearance + radius)),
    ]
    for angle in spokes:
        x, y = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        reach = (0.9 if len(spokes) > 1 else 1.3) * length
        solids.append(rod(0.7 * radius, (0, 0, level), (x * reach, y * reach, level)))
    workshop.body("handle", *(mount.placed(solid) for solid in solids), material="steel")
    workshop.turns("handle", "door", -mount.outward, mount.place, (0.0, 0.5 * math.pi), rest=values.number("open"))


FAMILY = family("safe", _build)
