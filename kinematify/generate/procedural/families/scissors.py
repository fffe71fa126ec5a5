"""Scissors: two blades that cross on a rivet, with a loop behind each; they lie flat and point away, along y."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.crossed import disc, riveted, strip
from kinematify.generate.procedural.solids import box, hull

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.pieces.crossed import Span
    from kinematify.generate.procedural.workshop import Workshop

_OPENS = 1.1  # [rad]
_HALF_GAP = 8e-4  # from the middle to a handle [m]


def _build(values: Values, workshop: Workshop) -> None:
    thick = values.number("thick")
    clearance = min(values.number("clearance"), 0.3 * thick)
    middle = 0.5 * _handle_height(values)
    spans = (
        (middle - 0.5 * clearance - thick, middle - 0.5 * clearance),
        (
            middle + 0.5 * clearance,
            middle + 0.5 * clearance + thick,
        ),
    )
    # Both are drawn with the handle on the left and the cutting edge on the left of the blade; one is turned over.
    left = _lever(values, spans[0], large=values.choice("loops") == "oval")
    right = _lever(values, spans[1], large=values.choice("loops") != "round").mirror((1, 0, 0))
    lower, upper = riveted(left, right, spans, 0.022 * values.number("length"), clearance)
    workshop.body("blade_1", lower)
    workshop.body("blade_2", upper)
    workshop.turns("blade_2", "blade_1", (0, 0, 1), (0, 0, middle), (0.0, _OPENS), rest=values.number("open"))


def _handle_height(values: Values) -> float:
    return max(0.045 * values.number("length"), 3.0 * values.number("thick"))


def _lever(values: Values, span: Span, *, large: bool) -> Manifold:
    """A blade, flat in its layer, and a loop that is as high as both layers."""
    length, share = values.number("length"), values.number("blade")
    wide, back = 0.05 * length, (1.0 - share) * length
    blade = hull(
        disc(0.9 * wide, span),
        box((-0.2 * wide, 0.55 * share * length, span[0]), (0.75 * wide, 0.55 * share * length + 1e-3, span[1])),
        box((0.05 * wide, share * length - 1e-3, span[0]), (0.2 * wide, share * length, span[1])),
    )
    radius = min(0.17 * length, 0.28 * back)
    stretch = min(0.6 * radius, back - 2.0 * radius - 2.0 * wide) if large else 0.0
    wall, whole = 0.3 * radius, (0.0, _handle_height(values))
    x = -radius - _HALF_GAP
    ends = (x, radius - back), (x, radius - back + stretch)
    ring, hole = (strip([(*end, r) for end in ends], s) for r, s in ((radius, whole), (radius - wall, (-1.0, 1.0))))
    top = (x, ends[1][1] + radius - 0.5 * wall)
    neck = strip([(*top, 0.6 * wall), (0.45 * x, 0.5 * (top[1] - 1.5 * wide), 0.55 * wall)], whole)
    shank = strip([(0.0, 0.0, 0.9 * wide), (*top, 0.4 * wall)], span)
    over = box((-_HALF_GAP, -2.0 * length, -1.0), (length, -1.1 * wide, 1.0))
    behind = box((-length, -1.4 * wide, -1.0), (length, length, 1.0))
    return blade + (shank - over) + (neck - over - behind) + (ring - hole - over)


FAMILY = family("scissors", _build)
