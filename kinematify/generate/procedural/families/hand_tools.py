"""Tools for one hand: scissors, pliers, staplers and pens."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from kinematify.generate.procedural.pieces.bearings import stub
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, ring, turned, union

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


Span = tuple[float, float]
"""Lower and upper z [m]."""


def strip(places: Sequence[tuple[float, float, float]], span: Span) -> Manifold:
    """Return a flat bar along `places`: x, y and half its width there [m], with round ends."""
    discs = [cylinder(half, (x, y, span[0]), (x, y, span[1]), segments=32) for x, y, half in places]
    return union(*(hull(one, other) for one, other in pairwise(discs)))


def disc(radius: float, span: Span) -> Manifold:
    """Return the round plate about the rivet."""
    return cylinder(radius, (0, 0, span[0]), (0, 0, span[1]))


def riveted(
    lower: Manifold, upper: Manifold, spans: tuple[Span, Span], radius: float, clearance: float
) -> tuple[Manifold, Manifold]:
    """Return the lower lever with a rivet at the origin and the upper one with the hole that turns on it.

    Args:
        lower: Owns the rivet, whose head keeps the upper one.
        upper: Lies on it.
        spans: Of both where they cross; the upper one has to be free above the origin.
        radius: Of the rivet; its head is 1.8 times as wide [m].
        clearance: Between all of them [m].
    """
    bottom, top = spans[0][0], spans[1][1]
    shaft = cylinder(radius, (0, 0, bottom + 1e-4), (0, 0, top + clearance + 1e-4))
    head = cylinder(1.8 * radius, (0, 0, top + clearance), (0, 0, top + clearance + 0.5 * radius))
    return union(lower, shaft, head), upper - bore(radius, clearance, (0, 0, bottom - 1.0), (0, 0, top + 1.0))


_SCISSORS_OPENS = 1.1  # [rad]
_HALF_GAP = 8e-4  # from the middle to a handle [m]


def build_scissors(values: Values, workshop: Workshop) -> None:
    """Scissors: two blades that cross on a rivet, with a loop behind each; they lie flat and point away, along y."""
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
    left = _scissors_lever(values, spans[0], large=values.choice("loops") == "oval")
    right = _scissors_lever(values, spans[1], large=values.choice("loops") != "round").mirror((1, 0, 0))
    lower, upper = riveted(left, right, spans, 0.022 * values.number("length"), clearance)
    workshop.body("blade_1", lower)
    workshop.body("blade_2", upper)
    workshop.turns("blade_2", "blade_1", (0, 0, 1), (0, 0, middle), (0.0, _SCISSORS_OPENS), rest=values.number("open"))


def _handle_height(values: Values) -> float:
    return max(0.045 * values.number("length"), 3.0 * values.number("thick"))


def _scissors_lever(values: Values, span: Span, *, large: bool) -> Manifold:
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


_PLIERS_OPENS = 0.55  # [rad]
_JAWS = {"flat": (0.34, 1.0, 0.75), "needle": (0.5, 0.7, 0.25), "cutting": (0.2, 1.0, 0.55)}
"""Length over the handle's, width at the joint and at the tip over the joint's radius."""


def build_pliers(values: Values, workshop: Workshop) -> None:
    """Pliers: two forged levers that cross in a lap joint; they lie flat and point away, along y."""
    thick = values.number("thick")
    clearance = min(values.number("clearance"), 0.15 * thick)
    middle = 0.5 * thick
    spans = (0.0, middle - 0.5 * clearance), (middle + 0.5 * clearance, thick)
    radius = 0.05 * values.number("length") + 0.004
    # Where they cross, each gives way to the other's round plate.
    left = _pliers_lever(values, radius, spans[0]) - disc(radius + clearance, (spans[0][1], 1.0))
    right = _pliers_lever(values, radius, spans[1]).mirror((1, 0, 0)) - disc(radius + clearance, (-1.0, spans[1][0]))
    lower, upper = riveted(left, right, spans, 0.4 * radius, clearance)
    workshop.body("lever_1", lower)
    workshop.body("lever_2", upper)
    workshop.turns("lever_2", "lever_1", (0, 0, 1), (0, 0, middle), (0.0, _PLIERS_OPENS), rest=values.number("open"))


def _pliers_lever(values: Values, radius: float, span: Span) -> Manifold:
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


_SHEET = 0.0015  # thickness of ears, arm and magazine [m]
_PIN = 0.0025  # radius [m]
_FOOT, _RISE = 0.008, 0.026  # height of the foot and of the pin above it [m]
_ANVIL = 0.0015  # thickness of the plate that bends the staples [m]
_STAPLER_STROKE, _PRESS = 0.005, 0.008  # way of the magazine's and of the arm's front when they are pressed [m]
_STAPLER_OPENS = {"magazine": 1.2, "arm": 1.3}  # [rad]


def build_stapler(values: Values, workshop: Workshop) -> None:
    """Staplers: a magazine and an arm above it, both on the pin between two ears at the back of the base."""
    length, half = values.number("length"), 0.5 * values.number("width")
    clearance = min(values.number("clearance"), 0.3 * _PIN)
    y, z = 0.88 * length, _FOOT + _RISE
    ears = [
        hull(
            box((x, y - 0.012, 0.5 * _FOOT), (x + _SHEET, y + 0.012, _FOOT)),
            cylinder(0.007, (x, y, z), (x + _SHEET, y, z)),
        )
        for x in (-half, half - _SHEET)
    ]
    back = box((-half, length - 0.02, 0), (half, length, _FOOT))
    slab = hull(cylinder(half, (0, half, 0), (0, half, _FOOT)), back)
    anvil = box((-0.4 * half, 0.006, _FOOT - 1e-4), (0.4 * half, 0.026, _FOOT + _ANVIL))
    workshop.body("base", slab, anvil, *ears, cylinder(_PIN, (-half, y, z), (half, y, z)))

    hole, rest = bore(_PIN, clearance, (-1, y, z), (1, y, z)), values.number("open")
    outer = half - _SHEET - clearance  # of the arm, which is between the ears
    inner = outer - _SHEET - clearance  # of the magazine, which is in the arm
    workshop.body("magazine", _magazine(inner, (y, z), clearance) - hole, material="steel", color="silver")
    workshop.body("arm", _arm(values, outer, inner - _SHEET - clearance, (y, z)) - hole)
    limits = -_STAPLER_STROKE / length, _STAPLER_OPENS["magazine"]
    workshop.turns("magazine", "base", (-1, 0, 0), (0, y, z), limits, rest=rest)
    limits = -_PRESS / length, _STAPLER_OPENS["arm"]
    workshop.turns("arm", "magazine", (-1, 0, 0), (0, y, z), limits, rest=rest)


def _cheeks(half: float, axis: tuple[float, float], front: float, heights: tuple[float, float]) -> list[Manifold]:
    """Sheets with the pin in them; they reach forward to `front`."""
    y, z = axis
    return [
        hull(
            box((x, front, heights[0]), (x + _SHEET, y - 0.012, heights[1])),
            cylinder(0.006, (x, y, z), (x + _SHEET, y, z)),
        )
        for x in (-half, half - _SHEET)
    ]


def _magazine(half: float, axis: tuple[float, float], clearance: float) -> Manifold:
    """A channel with a stick of staples in it, open at the top."""
    y, z = axis
    bottom, top = _FOOT + _ANVIL + clearance + _STAPLER_STROKE + 0.001, z - 0.004
    channel = box((-half, 0.004, bottom), (half, y - 0.012, top))
    room = box((_SHEET - half, 0.004 + _SHEET, bottom + _SHEET), (half - _SHEET, y, top + 1.0))
    staples = box((1e-4 - half, 0.014, bottom), (half - 1e-4, 0.6 * y, bottom + 0.4 * (top - bottom)))
    return union(channel - room, staples, *_cheeks(half, axis, y - 0.022, (bottom, top)))


def _arm(values: Values, half: float, blade: float, axis: tuple[float, float]) -> Manifold:
    """A cover with sides that straddle the magazine and a blade in front that drives the staples."""
    y, z = axis
    under, thick = z + 0.008, values.number("cover")
    front, level = 0.4 * half, 0.5 * thick
    ends = [cylinder(level, (-half, at, under + level), (half, at, under + level)) for at in (front, y)]
    top = hull(*ends, box((-half, 0.5 * y, under), (half, y, under + thick)))
    if values.choice("cover_shape") == "round":
        round_top = cylinder(min(thick, half), (0, front, under + level), (0, y - 0.01, under + level))
        top += round_top.trim_by_plane((0, 0, 1), under + level)
    sides = _cheeks(half, axis, 0.5 * y, (z - 0.002, under + level))
    driver = box((-blade, 0.0085, z - 0.003), (blade, 0.0095, under + level))
    return union(top, *sides, driver)


_CAP = 0.0012  # wall of a cap [m]
_CONE = 0.012  # length of the tip's cone [m]
_PEN_STROKE = 0.005  # of a button [m]
_SIDES = 6  # of the barrel under a cap
_TIGHT = 5e-4  # a pen has no wider gaps [m]


def build_pen(values: Values, workshop: Workshop) -> None:
    """Pens that lie along y with the tip in front: one that clicks, one with a cap, one that twists."""
    {"click": _click, "cap": _cap, "twist": _twist}[values.choice("mechanism")](values, workshop)


def _lie(values: Values, *solids: Manifold) -> Manifold:
    """Lay down what is built upright about z, the tip at z = 0 and its clip at -y."""
    return union(*solids).rotate((-90, 0, 0)).translate((0, 0, 0.5 * values.number("width")))


def _clip(values: Values, free: float, fixed: float) -> Manifold:
    """A springy strip along the barrel; `free` and `fixed` are the heights of its ends."""
    radius = 0.5 * values.number("width")
    start, end = sorted((free, fixed))
    inner, outer = radius + 0.0012, radius + 0.0024
    strip = box((-0.002, -outer, start), (0.002, -inner, end))
    foot = sorted((fixed, fixed + (0.004 if fixed < free else -0.004)))
    bead_at = free + (-0.002 if fixed < free else 0.002)
    bead = cylinder(0.001, (-0.002, -inner, bead_at), (0.002, -inner, bead_at), segments=16)
    return union(strip, bead, box((-0.002, -outer, foot[0]), (0.002, -0.8 * radius, foot[1])))


def _barrel(values: Values, length: float, radius: float) -> Manifold:
    """A round body with a cone at the tip and grooves for the fingers."""
    body = turned([(0.0, 0.0), (1.5e-3, 0.0), (radius, _CONE), (radius, length), (0.0, length)])
    grooves = [ring(radius, 3e-4, sides=8).translate((0, 0, _CONE + 0.006 + 0.003 * k)) for k in range(6)]
    return body - union(*grooves)


def _click(values: Values, workshop: Workshop) -> None:
    """A button behind the barrel that pushes the tip out in front; two splines keep it from turning."""
    length, radius, gap = values.number("length"), 0.5 * values.number("width"), min(values.number("clearance"), _TIGHT)
    end, ledge = length - 0.006, _CONE + _PEN_STROKE + 0.001
    tip, rod, collar, button = 7e-4, 0.4 * radius, 0.6 * radius, 0.42 * radius
    hole = [(tip + gap, -1.0), (tip + gap, _CONE), (collar + gap, _CONE)]
    hole += [(collar + gap, end), (button + gap, end), (button + gap, 1.0)]
    spline = 0.14 * radius, 0.76 * radius
    inner = turned([(0.0, -1.0), *hole, (0.0, 1.0)])
    inner += box((-spline[0] - gap, -spline[1] - gap, _CONE), (spline[0] + gap, spline[1] + gap, end))
    workshop.body(
        "barrel", _lie(values, _barrel(values, length, radius) - inner, _clip(values, length - 0.045, length))
    )
    top = length + _PEN_STROKE + 0.004
    refill = [(tip, 0.002), (tip, ledge), (rod, ledge), (rod, end - 0.004), (collar, end - 0.004)]
    refill += [(collar, end - gap), (button, end - gap), (button, top)]
    splines = box((-spline[0], -spline[1], end - 0.02), (spline[0], spline[1], end - gap))
    workshop.body("button", _lie(values, turned([(0.0, 0.002), *refill, (0.0, top)]), splines), material="metal")
    limits, rest = (0.0, _PEN_STROKE), values.number("open")
    workshop.slides("button", "barrel", (0, -1, 0), (0, length, radius), limits, rest=rest)


def _cap(values: Values, workshop: Workshop) -> None:
    """A cap that is drawn off the front; both have six sides there, so that it does not turn."""
    length, radius, gap = values.number("length"), 0.5 * values.number("width"), min(values.number("clearance"), _TIGHT)
    covered = 0.42 * length
    rear = cylinder(radius, (0, 0, covered), (0, 0, length))
    inner = radius - _CAP - gap
    front_half = _barrel(values, covered + 1e-3, inner) ^ cylinder(inner, (0, 0, -1.0), (0, 0, 1.0), segments=_SIDES)
    workshop.body("barrel", _lie(values, front_half, rear))
    front, end = -0.006, covered - gap
    shell = cylinder(radius, (0, 0, front), (0, 0, end)) - bore(
        inner, gap, (0, 0, -0.002), (0, 0, 1.0), segments=_SIDES
    )
    inside = cylinder(radius - 0.5 * _CAP, (0, 0, -0.002), (0, 0, end - 0.001))
    clip = _clip(values, covered - 0.006, front) - inside
    workshop.body("cap", _lie(values, shell, clip))
    travel, rest = (0.0, covered + 0.01), values.number("open")
    workshop.slides("cap", "barrel", (0, -1, 0), (0, 0, radius), travel, rest=rest)


def _twist(values: Values, workshop: Workshop) -> None:
    """The rear half turns on the front half and drives the tip."""
    length, radius, gap = values.number("length"), 0.5 * values.number("width"), min(values.number("clearance"), _TIGHT)
    middle = 0.55 * length
    _, hole, rotor = stub((0, 0, middle), (0, 0, 1), radius, gap, length=0.12 * length)
    tip = cylinder(6e-4, (0, 0, -0.002), (0, 0, _CONE), segments=16)
    workshop.body("barrel", _lie(values, _barrel(values, middle, radius) - hole, tip))
    collar = cylinder(radius + 5e-4, (0, 0, middle + gap), (0, 0, middle + gap + 0.002))
    rear = cylinder(radius, (0, 0, middle + gap), (0, 0, length))
    workshop.body("grip", _lie(values, rotor, rear, collar, _clip(values, length - 0.045, length)), material="metal")
    workshop.turns("grip", "barrel", (0, 1, 0), (0, middle, radius), (0.0, 3.0), rest=values.number("open"))
