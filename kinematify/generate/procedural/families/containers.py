"""Containers with a lid, a cap or a handle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import STEM, BackEdge, add_barrels, barrel, castor
from kinematify.generate.procedural.pieces.fronts import handle
from kinematify.generate.procedural.solids import bore, box, cylinder, hull, ring, rod, tray, turned, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


def build_box(values: Values, workshop: Workshop) -> None:
    """Boxes with a lid: hinged, sliding in grooves, or lifted off straight."""
    {"hinged": _hinged, "sliding": _sliding, "loose": _loose}[values.choice("lid")](values, workshop)


def _hinged(values: Values, workshop: Workshop) -> None:
    """A lid that turns up about the upper back edge."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    wall, clearance = values.number("wall"), values.number("clearance")
    level = height + clearance
    workshop.body("body", tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall))
    lid = box((-0.5 * width, 0, level), (0.5 * width, depth, level + wall))
    if values.choice("top") == "round":
        lid += _vault(width, depth, level + 0.5 * wall, max(wall, min(0.35 * depth, 0.4 * height)))
    grip = box((-0.12 * width, -0.012, level), (0.12 * width, 0.1 * depth, level + 0.3 * wall))
    workshop.body("lid", lid, grip)
    pivot: tuple[float, float, float] = (0.0, depth, level)
    kind = values.choice("hinge")
    if kind != "edge":
        edge = BackEdge(y=depth, level=level, below=height, above=wall, clearance=clearance)
        whole = kind == "piano"
        places, length = ((0.0,), 0.9 * width) if whole else ((-0.3 * width, 0.3 * width), min(0.05, 0.3 * width))
        radius, knuckles = min(0.004, 0.5 * wall), 9 if whole else 3
        pivot = add_barrels(workshop, ("body", "lid"), edge, places, length=length, radius=radius, knuckles=knuckles)
    workshop.turns("lid", "body", (-1, 0, 0), pivot, (0.0, 1.9), rest=values.number("open"))


def _vault(width: float, depth: float, level: float, rise: float) -> Manifold:
    """What stands on the lid of a treasure chest: a part of a cylinder that rises over the depth."""
    radius = 0.5 * rise + 0.125 * depth * depth / rise
    centre = (0.5 * depth, level + rise - radius)
    whole = cylinder(radius, (-0.5 * width, *centre), (0.5 * width, *centre), segments=96)
    return whole.trim_by_plane((0, 0, 1), level)


def _sliding(values: Values, workshop: Workshop) -> None:
    """A lid that is drawn out along -y in grooves of the side walls, as of a pencil box."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    wall, clearance = values.number("wall"), values.number("clearance")
    level, thick, groove = height - 2.0 * wall, wall, 0.5 * wall
    body = tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall)
    half = 0.5 * width - wall + groove
    slot = box((-half, -1.0, level), (half, depth - wall + groove, level + thick))
    mouth = box((wall - 0.5 * width, -1.0, level), (0.5 * width - wall, wall + 1e-3, height + 1.0))
    workshop.body("body", body - slot - mouth)
    gap = min(clearance, 0.25 * wall)
    lid = box((gap - half, 0, level + gap), (half - gap, depth - wall + groove - gap, level + thick - gap))
    notch = box((-0.1 * width, 0.08 * depth, level), (0.1 * width, 0.08 * depth + 0.006, level + thick + 0.3 * wall))
    workshop.body("lid", lid, notch.trim_by_plane((0, 0, 1), level + 0.5 * thick))
    workshop.slides("lid", "body", (0, -1, 0), (0, 0, level), (0.0, 0.85 * depth), rest=values.number("open"))


def _loose(values: Values, workshop: Workshop) -> None:
    """A lid that reaches over the rim and is lifted off."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    wall, gap = values.number("wall"), max(values.number("clearance"), 2e-4)
    workshop.body("body", tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall))
    out = gap + wall
    skirt = max(2.0 * wall, 0.2 * height)
    lower = (-0.5 * width - out, -out, height - skirt)
    cap = box(lower, (0.5 * width + out, depth + out, height + gap + wall))
    inner = box((-0.5 * width - gap, -gap, height - skirt - 1.0), (0.5 * width + gap, depth + gap, height + gap))
    workshop.body("lid", cap - inner)
    travel = (0.0, 1.2 * skirt)
    workshop.slides("lid", "body", (0, 0, 1), (0, 0.5 * depth, height), travel, rest=values.number("open"))


_CAP = 0.002  # wall of a cap [m]
_RIBS = 24  # around a cap
_BOTTLE_HINGE = 0.002  # radius [m]


def build_bottle(values: Values, workshop: Workshop) -> None:
    """Bottles: a hollow body with a neck, and a cap that turns, is pulled out or flips open."""
    workshop.body("body", _bottle_vessel(values))
    {"screw": _screw, "pull": _pull, "flip": _flip}[values.choice("cap")](values, workshop)


def _neck(values: Values) -> tuple[float, float]:
    """Radius and height of the neck [m]."""
    return min(0.5 * values.number("neck"), 0.4 * values.number("width")), max(0.02, 0.08 * values.number("height"))


def _wall(values: Values) -> float:
    return min(0.003, 0.25 * _neck(values)[0])


def _bottle_vessel(values: Values) -> Manifold:
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
    edge = BackEdge(y=y, level=level, below=0.009, above=thick, clearance=min(clearance, 0.5 * _BOTTLE_HINGE))
    pivot = add_barrels(workshop, ("body", "cap"), edge, (0.0,), length=1.6 * half, radius=_BOTTLE_HINGE)
    workshop.turns("cap", "body", (-1, 0, 0), pivot, (0.0, 1.5), rest=values.number("open"))


_BUCKET_WALL = 0.003
_BEAD = 0.002  # how far the rim stands out [m]
_BELOW = 0.025  # from the rim down to the studs [m]


def build_bucket(values: Values, workshop: Workshop) -> None:
    """Buckets: a vessel that widens upwards, and a bail that swings on studs at its sides."""
    radius, height, clearance = 0.5 * values.number("width"), values.number("height"), values.number("clearance")
    wire = values.number("wire")
    stud, level = 1.2 * wire, height - _BELOW
    grip = 2.6 * wire if values.choice("handle") == "grip" else wire
    # The bail moves on a sphere, which has to be outside the rim even where the rim is highest.
    reach = math.hypot(radius + _BEAD + clearance, _BELOW) + wire + 5e-4
    workshop.body("body", _bucket_vessel(values))
    bend = (2.4 * stud) ** 2 / reach  # the wire bends inwards above its eyes
    eyes, holes = [], []
    for side in (-1.0, 1.0):
        eye = side * (reach - wire), side * (reach + wire)
        face = side * (reach - wire - clearance - bend)
        boss = cylinder(2.0 * stud, (side * 0.3 * radius, 0, level), (face, 0, level))
        shaft = cylinder(stud, (side * 0.3 * radius, 0, level), (eye[1] + side * (clearance + 1e-4), 0, level))
        head = cylinder(
            1.9 * stud, (eye[1] + side * clearance, 0, level), (eye[1] + side * (clearance + wire), 0, level)
        )
        workshop.add("body", boss, shaft, head)
        eyes.append(cylinder(2.2 * stud, (eye[0], 0, level), (eye[1], 0, level)))
        holes.append(bore(stud, clearance, (side * 0.5 * reach, 0, level), (side * 2.0 * reach, 0, level)))
    workshop.cut("body", _bucket_inside(values))
    lies = math.asin(min(0.9, (_BELOW + 1.2 * grip + clearance) / (0.9 * reach)))  # so that the grip is above the rim
    bail = union(*_bail(reach, wire, grip), *(eye.translate((0, 0, -level)) for eye in eyes))
    bail = bail.rotate((90.0 - math.degrees(lies), 0, 0)).translate((0, 0, level)) - union(*holes)
    workshop.body("handle", bail, material="steel")
    swing = (0.0, math.pi - 2.0 * lies)
    workshop.turns("handle", "body", (-1, 0, 0), (0, 0, level), swing, rest=values.number("open"))


def _bail(reach: float, wire: float, grip: float) -> list[Manifold]:
    """A half circle of wire that stands upright over the x axis, with a grip around its top."""
    made = [ring(reach, wire, 180.0)]
    if grip > wire:
        made.append(ring(reach, grip, 50.0).rotate((0, 0, 65.0)))
    return [solid.rotate((90.0, 0, 0)) for solid in made]


def _profile(values: Values, inset: float, bottom: float, top: float) -> list[tuple[float, float]]:
    radius = 0.5 * values.number("width")
    foot = values.number("taper") * radius
    return [(0.0, bottom), (foot - inset, bottom), (radius - inset, top), (0.0, top)]


def _bucket_inside(values: Values) -> Manifold:
    return turned(_profile(values, _BUCKET_WALL, _BUCKET_WALL, values.number("height") + 1e-4))


def _bucket_vessel(values: Values) -> Manifold:
    """Solid as yet; the studs reach into it."""
    radius, height = 0.5 * values.number("width"), values.number("height")
    bead = cylinder(radius + _BEAD, (0, 0, height - 0.006), (0, 0, height))
    return turned(_profile(values, 0.0, 0.0, height)) + bead


_TRASH_CAN_WALL = 0.004
_BASE = 0.06  # height of the solid foot that holds a pedal [m]
_PEDAL = 0.2  # way of the pedal [rad]


def build_trash_can(values: Values, workshop: Workshop) -> None:
    """Trash cans: a pedal and a hinged lid, a flap that swings both ways, or a lid that is lifted off."""
    {"pedal": _pedal, "swing": _swing, "lift": _lift}[values.choice("lid")](values, workshop)


def _bin(values: Values, foot: float) -> Manifold:
    """A round or a square bin, its axis at the origin, with a floor at the height of its foot."""
    half, height = 0.5 * values.number("width"), values.number("height")
    if values.choice("shape") == "square":
        lower, upper = (-half, -half, foot), (half, half, height)
        return tray(lower, upper, _TRASH_CAN_WALL) + box((-half, -half, 0), (half, half, foot))
    inner = cylinder(half - _TRASH_CAN_WALL, (0, 0, foot + _TRASH_CAN_WALL), (0, 0, height + 1.0))
    return cylinder(half, (0, 0, 0), (0, 0, height)) - inner


def _cover(values: Values, grow: float, bottom: float, top: float) -> Manifold:
    """A plate of the shape of the bin, wider by `grow` on all sides."""
    half = 0.5 * values.number("width") + grow
    if values.choice("shape") == "square":
        return box((-half, -half, bottom), (half, half, top))
    return cylinder(half, (0, 0, bottom), (0, 0, top))


def _pedal(values: Values, workshop: Workshop) -> None:
    half, height = 0.5 * values.number("width"), values.number("height")
    clearance, rest = values.number("clearance"), values.number("open")
    level, thick, seat = height + clearance, 0.012, 0.04
    workshop.body("body", _bin(values, _BASE), box((-seat, 0.8 * half, height - 0.03), (seat, half + 0.002, height)))
    workshop.cut("body", _trash_can_inside(half, height))
    back = box((-seat, 0.0, level), (seat, half + 0.002, level + thick))
    workshop.body("lid", _cover(values, 0.0, level, level + thick), back)
    edge = BackEdge(y=half + 0.002, level=level, below=0.03, above=thick, clearance=clearance)
    pivot = add_barrels(workshop, ("body", "lid"), edge, (0.0,), length=2.0 * seat, radius=0.004)
    workshop.turns("lid", "body", (-1, 0, 0), pivot, (0.0, 1.5), rest=rest)
    _add_pedal(workshop, half, clearance, rest)


def _trash_can_inside(half: float, height: float) -> Manifold:
    """Keeps the seat of the hinge from reaching into the bin."""
    return cylinder(half - _TRASH_CAN_WALL, (0, 0, _BASE + _TRASH_CAN_WALL), (0, 0, height + 1.0))


def _add_pedal(workshop: Workshop, half: float, clearance: float, rest: float) -> None:
    """A lever on a pin across a slot of the foot; its end in front goes down."""
    wide, level, radius = 0.025, 0.036, 0.005
    back, tip = -half + 0.06, -half - 0.05
    slot = box((-wide, -2.0 * half, 0.006), (wide, back + 3.0 * radius, _BASE - 0.006))
    pin = (-wide - 0.01, back, level), (wide + 0.01, back, level)
    hole = (pin[0][0] - 2e-3, back, level), (pin[1][0] + 2e-3, back, level)
    workshop.cut("body", slot, bore(radius, clearance, *hole))
    inner = wide - max(clearance, 5e-4)
    arm = box((-inner, tip + 0.02, level - radius), (inner, back, level + radius))
    plate = box((-1.6 * wide, tip, level - radius), (1.6 * wide, tip + 0.035, level + radius))
    hub = cylinder(1.4 * radius, (-inner, back, level), (inner, back, level))
    workshop.body("pedal", arm, plate, hub, cylinder(radius, *pin), material="steel")
    workshop.turns("pedal", "body", (1, 0, 0), (0, back, level), (0.0, _PEDAL), rest=rest)


def _swing(values: Values, workshop: Workshop) -> None:
    """A flap in the mouth on two pins in the side walls."""
    half, height, clearance = 0.5 * values.number("width"), values.number("height"), values.number("clearance")
    level = height - 0.3 * half
    inner, radius = half - _TRASH_CAN_WALL, 0.004
    if values.choice("shape") == "square":
        reach = inner - clearance - 0.002
        flap = box((-reach, -reach, level - 0.003), (reach, reach, level + 0.003))
    else:  # a round flap is narrower than the mouth, so that it does not meet the wall when it hangs down
        reach = 0.97 * inner - clearance
        flap = cylinder(reach, (0, 0, level - 0.003), (0, 0, level + 0.003))
    ridge = box((-0.5 * reach, -0.008, level), (0.5 * reach, 0.008, level + 0.012))
    pin = (-half - 0.002, 0, level), (half + 0.002, 0, level)
    steepest = math.asin(min(0.93, 0.95 * (level - _TRASH_CAN_WALL) / (reach + 0.01)))  # above the floor
    workshop.body("body", _bin(values, 0.0))
    workshop.cut("body", bore(radius, clearance, (-2.0 * half, 0, level), (2.0 * half, 0, level)))
    workshop.body("flap", flap, ridge, cylinder(radius, *pin))
    workshop.turns("flap", "body", (1, 0, 0), (0, 0, level), (-steepest, steepest), rest=values.number("open"))


def _lift(values: Values, workshop: Workshop) -> None:
    """A lid with a skirt around the rim and a handle."""
    height, gap = values.number("height"), values.number("clearance")
    skirt = 0.1 * height
    top = height + gap + _TRASH_CAN_WALL
    cap = _cover(values, gap + 1.5 * _TRASH_CAN_WALL, height - skirt, top) - _cover(values, gap, -1.0, height + gap)
    grip = [
        solid.rotate((-90, 0, 0)).translate((0, 0, top)) for solid in handle("knob", (0, 0, 0), along="x", length=0)
    ]
    workshop.body("body", _bin(values, 0.0))
    workshop.body("lid", cap, *grip)
    workshop.slides("lid", "body", (0, 0, 1), (0, 0, height), (0.0, 1.2 * skirt), rest=values.number("open"))


_SUITCASE_WALL = 0.003
_ROUND = 0.04  # radius of the corners [m]
_WHEEL = 0.02  # radius [m]
_FORK = 0.056  # height of a wheel with its fork [m]
_SUITCASE_HINGE = 0.004  # radius [m]
_TUBE = 0.006  # radius of the drawn handle's tubes [m]
_GRIP = 0.021  # height of the grip above the shells when it is pushed in [m]
_OPENS = 1.7  # [rad]


def build_suitcase(values: Values, workshop: Workshop) -> None:
    """Suitcases that stand upright: two shells on a hinge at the left, wheels, and a handle that is drawn out."""
    clearance, rest = values.number("clearance"), values.number("open")
    deep = 0.5 * values.number("depth")
    workshop.body("body", _shell(values, 0.0, deep), *_side_handle(values))
    workshop.body("front", _shell(values, -clearance, -deep))
    workshop.turns("front", "body", (0, 0, -1), _add_hinges(values, workshop), (0.0, _OPENS), rest=rest)
    if values.choice("handle") == "trolley":
        _add_trolley(values, workshop)
    _add_wheels(values, workshop)


def _bottom(values: Values) -> float:
    """Underside of the shells [m]."""
    return _FORK + values.number("clearance")


def _top(values: Values) -> float:
    """Upper side of the shells, below the grip where there is one [m]."""
    return values.number("height") - (_GRIP if values.choice("handle") == "trolley" else 0.0)


def _shell(values: Values, mouth: float, back: float) -> Manifold:
    """One half, open at y = `mouth`, with grooves in its broad face."""
    sign = 1.0 if back > mouth else -1.0
    width = values.number("width")
    outer = hull(_plate(values, 0.0, mouth, back - sign * 0.012), _plate(values, 0.012, mouth, back))
    hollow = _plate(values, _SUITCASE_WALL + 0.009, mouth - sign, back - sign * _SUITCASE_WALL)
    shallow = sorted((back - sign * 0.0015, back + sign))
    grooves = [
        box((x - 0.004, shallow[0], 0.0), (x + 0.004, shallow[1], 9.0))
        for x in (width * share for share in (-0.3, -0.15, 0.0, 0.15, 0.3))
    ]
    return outer - hollow - union(*grooves)


def _plate(values: Values, inset: float, start: float, end: float) -> Manifold:
    """The outline of the front, rounded at its corners, between two depths."""
    half, bottom, top = 0.5 * values.number("width") - inset, _bottom(values) + inset, _top(values) - inset
    radius = _ROUND - inset
    places = [(x, z) for x in (radius - half, half - radius) for z in (bottom + radius, top - radius)]
    return hull(*(cylinder(radius, (x, start, z), (x, end, z), segments=32) for x, z in places))


def _side_handle(values: Values) -> list[Manifold]:
    """A grip on the right side of the half that stays."""
    x, y = 0.5 * values.number("width"), 0.25 * values.number("depth")
    level = 0.5 * (_bottom(values) + _top(values))
    ends = [(y, level - 0.06), (y, level + 0.06)]
    posts = [rod(0.006, (x - 1e-3, *end), (x + 0.022, *end)) for end in ends]
    return [
        rod(0.007, (x + 0.022, *ends[0]), (x + 0.022, *ends[1])),
        *(p.trim_by_plane((1, 0, 0), x - 2e-3) for p in posts),
    ]


def _add_hinges(values: Values, workshop: Workshop) -> tuple[float, float, float]:
    """Barrels at the left side of both halves; returns a point on the pins."""
    clearance, bottom, top = values.number("clearance"), _bottom(values), _top(values)
    face, reach = _SUITCASE_HINGE + clearance, 3.0 * _SUITCASE_HINGE
    deep = (face - 1e-4, face + 2e-4)
    on_body = (*deep, clearance + 0.2 * reach, clearance + reach)
    on_front = (*deep, -reach, -0.2 * reach)
    x = -0.5 * values.number("width") - face
    for share in (0.25, 0.75):
        halves = barrel(0.05, _SUITCASE_HINGE, clearance, (on_body, on_front))
        for name, half in zip(("body", "front"), halves, strict=True):
            workshop.add(name, half.translate((x, -clearance, bottom + share * (top - bottom))))
    return x, -clearance, bottom


def _add_trolley(values: Values, workshop: Workshop) -> None:
    """Two tubes in sleeves at the back, with a grip above the top."""
    clearance, top, bottom = values.number("clearance"), _top(values), _bottom(values)
    x, y = 0.22 * values.number("width"), 0.5 * values.number("depth") - 0.022
    low, grip = bottom + 0.05, top + 0.012
    tubes = []
    for side in (-x, x):
        workshop.add("body", cylinder(_TUBE + clearance + 0.003, (side, y, bottom + 0.02), (side, y, top)))
        tubes.append(cylinder(_TUBE, (side, y, low + clearance), (side, y, grip)))
    for side in (-x, x):
        workshop.cut("body", bore(_TUBE, clearance, (side, y, low), (side, y, top + 1.0)))
    bar = rod(0.009, (-x, y, grip), (x, y, grip))
    workshop.body("handle", *tubes, bar, material="metal")
    way = 0.75 * (top - low)
    workshop.slides("handle", "body", (0, 0, 1), (0, y, top), (0.0, way), rest=values.number("open"))


def _add_wheels(values: Values, workshop: Workshop) -> None:
    """Castors under both halves, or two wheels that only roll and feet beside them."""
    count, clearance, bottom = values.count("wheels"), values.number("clearance"), _bottom(values)
    x, y = 0.5 * values.number("width") - 0.07, 0.25 * values.number("depth")
    back, front = [("body", -x, y), ("body", x, y)], [("front", -x, -y), ("front", x, -y)]
    places = {2: back, 3: [*back, ("front", 0.0, -y)], 4: [*back, *front]}[count]
    for k, (parent, px, py) in enumerate(places):
        axle = np.array([0.0, -0.4 * _WHEEL, _WHEEL])
        fork, roller = (solid.translate((px, py, 0)) for solid in castor(axle, _FORK, _WHEEL, clearance))
        boss = cylinder(STEM + clearance + 0.004, (px, py, bottom), (px, py, bottom + 0.028))
        workshop.add(parent, boss)
        carrier = parent
        if count == 2:
            workshop.add(parent, fork, cylinder(0.012, (px, py, _FORK - 1e-3), (px, py, bottom + 1e-3)))
        else:
            carrier = f"castor_{k + 1}"
            workshop.cut(parent, bore(STEM, clearance, (px, py, bottom - 0.01), (px, py, bottom + 0.024)))
            workshop.body(carrier, fork, material="plastic")
            workshop.turns(carrier, parent, (0, 0, 1), (px, py, bottom))
        workshop.body(f"wheel_{k + 1}", roller, material="rubber")
        workshop.turns(f"wheel_{k + 1}", carrier, (1, 0, 0), (px, py - 0.4 * _WHEEL, _WHEEL))
    if count == 2:
        feet = [box((s * x - 0.012, -y - 0.012, 0), (s * x + 0.012, 0.012 - y, bottom + 1e-3)) for s in (-1, 1)]
        workshop.add("front", *feet)
