"""Bottles: a hollow body with a neck, and a cap that turns, is pulled out or flips open."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.lids import BackEdge, add_barrels
from kinematify.generate.procedural.solids import box, cylinder, turned

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_CAP = 0.002  # wall of a cap [m]
_RIBS = 24  # around a cap
_HINGE = 0.002  # radius [m]


def _build(values: Values, workshop: Workshop) -> None:
    workshop.body("body", _vessel(values))
    {"screw": _screw, "pull": _pull, "flip": _flip}[values.choice("cap")](values, workshop)


def _neck(values: Values) -> tuple[float, float]:
    """Radius and height of the neck [m]."""
    return min(0.5 * values.number("neck"), 0.4 * values.number("width")), max(0.02, 0.08 * values.number("height"))


def _wall(values: Values) -> float:
    return min(0.003, 0.25 * _neck(values)[0])


def _vessel(values: Values) -> Manifold:
    """Body, shoulder and neck with a bead under the cap; hollow, with a floor."""
    radius, height = 0.5 * values.number("width"), values.number("height")
    (neck, tall), wall = _neck(values), _wall(values)
    shoulder = height - tall
    sides = shoulder - min(1.2 * (radius - neck) + 0.01, 0.5 * shoulder)
    foot = min(0.004, 0.2 * radius)
    outline = [(radius - foot, 0.0), (radius, foot), (radius, sides), (neck, shoulder), (neck, height)]
    outer = turned([(0.0, 0.0), *outline, (0.0, height)])
    inside = [
        (radius - wall, 2.0 * foot),
        (radius - wall, sides),
        (neck - wall, shoulder),
        (neck - wall, height + 0.01),
    ]
    inner = turned([(0.0, wall), (radius - foot - wall, wall), *inside, (0.0, height + 0.01)])
    bead = cylinder(neck + 0.0015, (0, 0, shoulder), (0, 0, shoulder + 0.002))
    return outer + bead - inner


def _screw(values: Values, workshop: Workshop) -> None:
    """A cap over the neck, with ribs around it; a bead of the neck holds its lip, as a thread would."""
    (neck, tall), height, clearance = _neck(values), values.number("height"), values.number("clearance")
    bottom, top = height - tall + 0.002 + clearance, height + clearance
    lip = (neck + clearance) / math.cos(math.pi / 48)
    bead = lip + 1e-3
    inner = (bead + clearance) / math.cos(math.pi / 48)
    outer = inner + _CAP
    held = bottom + 0.003 + clearance  # underside of the bead
    ring = cylinder(bead, (0, 0, held), (0, 0, held + 0.002)) - cylinder(neck - 1e-4, (0, 0, -1.0), (0, 0, 1.0))
    workshop.add("body", ring)
    ribs = [
        cylinder(
            0.0008, (outer * math.cos(a), outer * math.sin(a), bottom), (outer * math.cos(a), outer * math.sin(a), top)
        )
        for a in (2.0 * math.pi * k / _RIBS for k in range(_RIBS))
    ]
    hollow = cylinder(inner, (0, 0, bottom + 0.003), (0, 0, top)) + cylinder(lip, (0, 0, -1.0), (0, 0, top))
    cap = cylinder(outer, (0, 0, bottom), (0, 0, top + _CAP)) - hollow
    workshop.body("cap", cap, *ribs, material="plastic")
    workshop.turns("cap", "body", (0, 0, 1), (0, 0, height))


def _pull(values: Values, workshop: Workshop) -> None:
    """A stopper in the neck with a head above the rim."""
    (neck, tall), height = _neck(values), values.number("height")
    clearance = min(values.number("clearance"), 0.2 * neck)
    deep = 0.8 * tall
    # Polygons of equal sides and equal places: what is narrower by the clearance at a corner is so at a flat.
    plug = cylinder(
        neck - _wall(values) - clearance / math.cos(math.pi / 48), (0, 0, height - deep), (0, 0, height + 0.003)
    )
    head = cylinder(1.15 * neck, (0, 0, height + clearance), (0, 0, height + clearance + 0.6 * neck))
    knob = cylinder(0.8 * neck, (0, 0, height), (0, 0, height + clearance + 0.9 * neck))
    workshop.body("cap", plug, head, knob.trim_by_plane((0, 0, 1), height + clearance), material="plastic")
    workshop.slides("cap", "body", (0, 0, 1), (0, 0, height), (0.0, 1.2 * deep), rest=values.number("open"))


def _flip(values: Values, workshop: Workshop) -> None:
    """A flat cap on a hinge behind the mouth, with a tab in front."""
    (neck, _), height, clearance = _neck(values), values.number("height"), values.number("clearance")
    level, thick, half, y = height + clearance, 0.006, 0.6 * neck, neck + 0.001
    inner = cylinder(neck - _wall(values), (0, 0, height - 0.02), (0, 0, height + 1.0))
    workshop.add("body", box((-half, 0.5 * neck, height - 0.01), (half, y, height)) - inner)
    back = box((-half, 0, level), (half, y, level + thick))
    tab = box((-0.3 * neck, -neck - 0.004, level + 0.5 * thick), (0.3 * neck, 0, level + thick))
    workshop.body("cap", cylinder(neck, (0, 0, level), (0, 0, level + thick)), back, tab, material="plastic")
    edge = BackEdge(y=y, level=level, below=0.009, above=thick, clearance=min(clearance, 0.5 * _HINGE))
    pivot = add_barrels(workshop, ("body", "cap"), edge, (0.0,), length=1.6 * half, radius=_HINGE)
    workshop.turns("cap", "body", (-1, 0, 0), pivot, (0.0, 1.5), rest=values.number("open"))


FAMILY = family("bottle", _build)
