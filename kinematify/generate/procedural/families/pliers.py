"""Pliers: two forged levers that cross in a lap joint; they lie flat and point away, along y."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.crossed import disc, riveted, strip
from kinematify.generate.procedural.solids import box, hull, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.pieces.crossed import Span
    from kinematify.generate.procedural.workshop import Workshop

_OPENS = 0.55  # [rad]
_JAWS = {"flat": (0.34, 1.0, 0.75), "needle": (0.5, 0.7, 0.25), "cutting": (0.2, 1.0, 0.55)}
"""Length over the handle's, width at the joint and at the tip over the joint's radius."""


def _build(values: Values, workshop: Workshop) -> None:
    thick = values.number("thick")
    clearance = min(values.number("clearance"), 0.15 * thick)
    middle = 0.5 * thick
    spans = (0.0, middle - 0.5 * clearance), (middle + 0.5 * clearance, thick)
    radius = 0.05 * values.number("length") + 0.004
    # Where they cross, each gives way to the other's round plate.
    left = _lever(values, radius, spans[0]) - disc(radius + clearance, (spans[0][1], 1.0))
    right = _lever(values, radius, spans[1]).mirror((1, 0, 0)) - disc(radius + clearance, (-1.0, spans[1][0]))
    lower, upper = riveted(left, right, spans, 0.4 * radius, clearance)
    workshop.body("lever_1", lower)
    workshop.body("lever_2", upper)
    workshop.turns("lever_2", "lever_1", (0, 0, 1), (0, 0, middle), (0.0, _OPENS), rest=values.number("open"))


def _lever(values: Values, radius: float, span: Span) -> Manifold:
    """The handle is on the left and the jaw on the right of the middle."""
    length, whole = values.number("length"), (0.0, values.number("thick"))
    share, at_joint, at_tip = _JAWS[values.choice("jaws")]
    jaw = share / (1.0 + share) * length
    back = length - jaw
    gap = 0.5 * values.number("clearance") + 2e-4
    nose = hull(
        box((gap, 0.5 * radius, 0.0), (at_joint * radius, 0.7 * radius, whole[1])),
        box((gap, 0.5 * jaw, 0.0), (0.5 * (at_joint + at_tip) * radius, 0.51 * jaw, whole[1])),
        box((gap, jaw - 1e-3, 0.0), (at_tip * radius, jaw, whole[1])),
    )
    half = 0.5 * radius
    bow = -0.4 * radius - 0.09 * back
    bar = strip(
        [(-0.6 * radius, -0.6 * radius, half), (bow, -0.45 * back, 0.8 * half), (bow, -back, 0.7 * half)], whole
    )
    made = union(disc(radius, span), nose - union(*_grooves(values, gap, jaw)), bar)
    if values.choice("grips") == "none":
        return made
    return made + strip([(bow, -0.5 * back, 1.15 * half), (bow, half - back, half)], (0.0, 1.12 * whole[1]))


def _grooves(values: Values, gap: float, jaw: float) -> list[Manifold]:
    """Cut across the inner face of the jaw."""
    count = 1 if values.choice("jaws") == "cutting" else 8
    step = 0.35 * jaw / count
    places = [0.6 * jaw + k * step for k in range(count)]
    return [box((0.0, y, -1.0), (gap + 4e-4, y + 0.4 * step, 1.0)) for y in places]


FAMILY = family("pliers", _build)
