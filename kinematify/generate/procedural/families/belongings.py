"""Things that a person owns: laptops, clocks, globes, umbrellas and eyeglasses."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.pieces.bearings import BackEdge, add_barrels, at, barrel, fork, stub
from kinematify.generate.procedural.pieces.controls import grid
from kinematify.generate.procedural.solids import ball, bore, box, cylinder, hull, ring, rod, union
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray


_RADIUS = 0.005  # of the hinges [m]
_LAPTOP_OPENS = 2.2  # [rad]


def build_laptop(values: Values, workshop: Workshop) -> None:
    """Laptops: a screen that is hinged at the back edge of a slab with keys."""
    width, depth = values.number("width"), values.number("depth")
    base, screen = values.number("base"), values.number("screen")
    clearance = values.number("clearance")
    back = depth - 2.0 * _RADIUS - clearance - 0.001  # behind it stand the barrels
    level = base + clearance
    slab = box((-0.5 * width, 0, 0), (0.5 * width, back, base))
    keys = [
        box((x - 0.007, y - 0.007, -0.002), (x + 0.007, y + 0.007, 0.002)).translate((0, 0.58 * back, base))
        for x, y in grid(48, 12, (min(0.9 * width, 0.3), min(0.4 * depth, 0.1)))
    ]
    pad = box((-0.18 * width, 0.06 * back, base - 0.0005), (0.18 * width, 0.3 * back, base + 0.01))
    lid = box((-0.5 * width, 0, level), (0.5 * width, back, level + screen))
    # The lid is hollow below where the keys stand up.
    hollow = box((-0.46 * width, 0.04 * back, level - 1.0), (0.46 * width, 0.96 * back, level + 0.0025))
    workshop.body("base", slab - pad, *keys)
    workshop.body("screen", lid - hollow)
    edge = BackEdge(y=back, level=level, below=base, above=screen, clearance=clearance)
    places, knuckles = (-0.32 * width, 0.32 * width), values.count("knuckles")
    pivot = add_barrels(
        workshop, ("base", "screen"), edge, places, length=0.16 * width, radius=_RADIUS, knuckles=knuckles
    )
    workshop.turns("screen", "base", (-1, 0, 0), pivot, (0.0, _LAPTOP_OPENS), rest=values.number("open"))


_FOOT = 0.014  # thickness of the foot [m]
_LATITUDES = (-40.0, 0.0, 40.0)  # of the raised lines [deg]


def build_globe(values: Values, workshop: Workshop) -> None:
    """Globes: a ball that turns on an inclined axis in a meridian, which may turn on its foot."""
    radius, clearance = 0.5 * values.number("diameter"), values.number("clearance")
    arc, pin = 0.02 * radius + 0.0025, 0.015 * radius + 0.0015
    reach = 1.03 * radius + 2.0 * clearance + arc + 0.004
    low, tilt = 2.0 * _FOOT + values.number("post"), values.number("tilt")
    level = low + reach
    carrier = _add_stand(values, workshop, low, arc)

    def tilted(*solids: Manifold) -> Manifold:
        return union(*solids).rotate((0, math.degrees(tilt), 0)).translate((0, 0, level))

    ends = [side * (1.02 * radius + clearance) for side in (-1.0, 1.0)]
    meridian = ring(reach, arc, 360.0 if values.choice("mount") == "ring" else 180.0)
    meridian = meridian.rotate((0, 0, -90.0)).rotate((90.0, 0, 0))  # in the x-z plane, on the side of +x
    wide = pin + clearance + 0.003
    bosses = [cylinder(wide, (0, 0, end), (0, 0, math.copysign(reach + arc + 0.002, end))) for end in ends]
    hole = bore(pin, clearance, (0, 0, -2.0 * reach), (0, 0, 2.0 * reach))
    workshop.add(carrier, tilted(union(meridian, *bosses) - hole))

    lines = [_latitude(radius, math.radians(angle)) for angle in _LATITUDES]
    hubs = [cylinder(wide, (0, 0, 0.9 * end), (0, 0, math.copysign(1.02 * radius, end))) for end in ends]
    tips = reach + arc + 0.004
    shaft = cylinder(pin, (0, 0, -tips), (0, 0, tips))
    workshop.body("ball", tilted(ball(radius, (0, 0, 0), segments=64), *lines, *hubs, shaft), color="blue")
    axis = (math.sin(tilt), 0, math.cos(tilt))
    workshop.turns("ball", carrier, axis, (0, 0, level))


def _add_stand(values: Values, workshop: Workshop, low: float, arc: float) -> str:
    """A foot and a post up to the meridian; returns the body that the post belongs to."""
    radius, clearance = 0.5 * values.number("diameter"), values.number("clearance")
    wide, start = 3.0 * arc, 1.5 * _FOOT
    workshop.body(
        "base",
        cylinder(0.62 * radius, (0, 0, 0), (0, 0, _FOOT), segments=64),
        cylinder(0.5 * radius, (0, 0, 0), (0, 0, start), segments=64),
    )
    if values.choice("foot") == "fixed":
        workshop.add("base", cylinder(0.5 * wide, (0, 0, _FOOT), (0, 0, low)))
        return "base"
    boss, hole, rotor = stub((0, 0, start + 0.01), (0, 0, 1), wide, clearance, length=0.012)
    workshop.add("base", boss)
    workshop.cut("base", hole)
    workshop.body("meridian", rotor, cylinder(0.5 * wide, (0, 0, start + 0.01 + clearance), (0, 0, low)))
    workshop.turns("meridian", "base", (0, 0, 1), (0, 0, start + 0.01))
    return "meridian"


def _latitude(radius: float, angle: float) -> Manifold:
    """A raised line around the ball."""
    return ring(radius * math.cos(angle), 0.008 * radius, sides=8).translate((0, 0, radius * math.sin(angle)))


_SHAFT = 0.005  # radius [m]
_GRIP = 0.13  # height of the handle [m]
_UMBRELLA_KNUCKLE = 0.003  # radius of a slat's hinge [m]
_UMBRELLA_HINGE = 0.009  # length of a slat's hinge [m]
_UMBRELLA_OPENS = 1.3  # [rad]


def build_umbrella(values: Values, workshop: Workshop) -> None:
    """Umbrellas that stand on their handle: slats that spread from a crown, and a runner on the shaft."""
    count, top = values.count("ribs"), values.number("height") - 0.05
    gap = min(values.number("clearance"), 0.15 * _UMBRELLA_KNUCKLE)
    # As many hinges as there are slats stand around the shaft and leave room for the runner between them.
    circle = max(0.026, 0.5 * (_UMBRELLA_HINGE + 0.003) / math.tan(math.pi / count) + _UMBRELLA_KNUCKLE)
    above = top + 2.5 * _UMBRELLA_KNUCKLE
    crown = cylinder(circle + 1.2 * _UMBRELLA_KNUCKLE, (0, 0, above), (0, 0, above + 0.006))
    point = rod(0.6 * _SHAFT, (0, 0, top), (0, 0, top + 0.05 - 0.6 * _SHAFT))
    shaft = cylinder(_SHAFT, (0, 0, 0.5 * _GRIP), (0, 0, above + 0.012), segments=32)
    workshop.body("shaft", *_handle(values), shaft, point, crown)
    _add_runner(values, workshop, top)
    forked, tongue = (
        half.rotate((180, 0, 0)) for half in fork(_UMBRELLA_HINGE, _UMBRELLA_KNUCKLE, gap, 3.0 * _UMBRELLA_KNUCKLE)
    )
    slat = tongue + _slat(values, circle, top - _GRIP - 0.02)
    for k in range(count):
        angle = 2.0 * math.pi * k / count
        name, degrees = f"rib_{k + 1}", math.degrees(angle)
        workshop.add("shaft", forked.translate((0, -circle, top)).rotate((0, 0, degrees)))
        workshop.body(name, slat.translate((0, -circle, top)).rotate((0, 0, degrees)))
        axis = (-math.cos(angle), -math.sin(angle), 0)
        pivot = (circle * math.sin(angle), -circle * math.cos(angle), top)
        workshop.turns(name, "shaft", axis, pivot, (0.0, _UMBRELLA_OPENS), rest=values.number("open"))


def _slat(values: Values, circle: float, longest: float) -> Manifold:
    """A thin plate that hangs from the origin, as wide as its neighbours allow while all hang down."""
    gap = max(values.number("clearance"), 5e-4)
    half = (circle - 0.001) * math.tan(math.pi / values.count("ribs")) - gap
    low, start = -min(values.number("reach"), longest), -2.0 * _UMBRELLA_KNUCKLE
    return hull(
        box((-0.25 * _UMBRELLA_HINGE, -0.001, start - 0.01), (0.25 * _UMBRELLA_HINGE, 0.001, start)),
        box((-half, -0.001, 0.7 * low), (half, 0.001, 0.3 * low)),
        box((-0.3 * half, -0.001, low), (0.3 * half, 0.001, low + 0.002)),
    )


def _handle(values: Values) -> list[Manifold]:
    """A straight grip, or a crook whose lowest place is the ground."""
    if values.choice("handle") == "straight":
        return [cylinder(0.013, (0, 0, 0), (0, 0, _GRIP), segments=32)]
    bend, thick = 0.03, 0.009
    level = bend + thick
    hook = ring(bend, thick, 180.0).rotate((-90, 0, 0)).translate((bend, 0, level))
    return [
        hook,
        cylinder(thick, (0, 0, level - 1e-4), (0, 0, _GRIP), segments=32),
        rod(thick, (2.0 * bend, 0, level), (2.0 * bend, 0, level + 0.012)),
    ]


def _add_runner(values: Values, workshop: Workshop, top: float) -> None:
    """A sleeve that is pushed up the shaft."""
    clearance, start, tall = values.number("clearance"), _GRIP + 0.03, 0.04
    sleeve = cylinder(0.012, (0, 0, start), (0, 0, start + tall)) + cylinder(
        0.015, (0, 0, start + tall - 0.006), (0, 0, start + tall)
    )
    # A rib of the shaft in a groove of the sleeve: the slats would keep it from turning, were they strung.
    gap, rib = min(clearance, 0.002), box((-0.0015, 0, start - 0.01), (0.0015, _SHAFT + 0.003, top - 0.01))
    groove = box((-0.0015 - gap, 0, 0), (0.0015 + gap, _SHAFT + 0.003 + gap, 2.0 * top))
    workshop.add("shaft", rib)
    workshop.body("runner", sleeve - bore(_SHAFT, gap, (0, 0, 0), (0, 0, 2.0 * top)) - groove, material="plastic")
    way = 0.9 * (top - 0.02 - start - tall)
    workshop.slides("runner", "shaft", (0, 0, 1), (0, 0, start), (0.0, way), rest=values.number("open"))


_LEAN = 0.1  # of the pins [rad]
_EYEGLASSES_KNUCKLE, _EYEGLASSES_HINGE = 0.0018, 0.006  # radius and length of a hinge [m]
_BACK = 0.011  # from the front of the frame to the pins [m]
_EYEGLASSES_THICK, _HIGH = 0.0032, 0.0038  # of a temple [m]
_RIM = 0.0025  # width of a rim [m]
_DEEP = 0.003  # thickness of the frame [m]


def build_eyeglasses(values: Values, workshop: Workshop) -> None:
    """Eyeglasses: a frame with two lenses that looks along -y, and temples that fold in behind it.

    The pins lean a little, so that one folded temple rises inwards and the other sinks: they lie one above the other.
    """
    gap = min(values.number("clearance"), 0.3 * _EYEGLASSES_KNUCKLE)
    workshop.body("frame", *_frame(values))
    for k, side in enumerate((-1.0, 1.0)):
        inner = 0.5 * values.number("width") - _EYEGLASSES_THICK
        off_face = (
            _EYEGLASSES_KNUCKLE + gap + 0.5 * _LEAN * _EYEGLASSES_HINGE
        )  # so that leaning knuckles keep clear of the faces
        pivot = np.array([side * (inner - off_face), _BACK, _level(values)])
        of_frame, of_temple = _hinge(pivot, side, off_face, gap)
        workshop.add("frame", _end(values, side, gap), of_frame)
        axis = side * np.array([_LEAN, 0.0, -1.0]) / math.hypot(_LEAN, 1.0)
        opened = _temple(values, side, gap) + of_temple
        name = f"temple_{k + 1}"
        workshop.body(name, opened.transform(_about(axis, pivot, -0.5 * math.pi)))
        workshop.turns(name, "frame", axis, pivot, (0.0, 0.5 * math.pi), rest=values.number("open"))


def _level(values: Values) -> float:
    """Height of the temples, above the middle of the lenses [m]."""
    return 0.7 * values.number("lens")


def _frame(values: Values) -> list[Manifold]:
    """Rims with lenses, a bridge and two pads for the nose."""
    high, bridge = values.number("lens"), values.number("bridge")
    wide = 0.5 * (values.number("width") - bridge) - 0.007
    made: list[Manifold] = []
    for side in (-1.0, 1.0):
        x = side * 0.5 * (bridge + wide)
        outer, inner = (_outline(values, x, wide, inset) for inset in (0.0, _RIM))
        lens = _outline(values, x, wide, 0.5 * _RIM, start=0.3 * _DEEP, end=0.7 * _DEEP)
        pad = (side * 0.4 * bridge, 0.007, 0.35 * high)
        root = (side * (0.5 * bridge + 0.5 * _RIM), 0.5 * _DEEP, 0.5 * high)
        made += [outer - inner, lens, ball(0.0025, pad, segments=16), rod(0.0007, root, pad)]
    arch = [(s * (0.5 * bridge + 0.4 * _RIM), 0.5 * _DEEP, z) for s, z in ((-1.0, 0.62 * high), (1.0, 0.62 * high))]
    top = (0.0, 0.5 * _DEEP, 0.7 * high)
    return [*made, *(hull(*(ball(0.45 * _DEEP, end, segments=16) for end in (one, top))) for one in arch)]


def _outline(
    values: Values, x: float, wide: float, inset: float, *, start: float | None = None, end: float = _DEEP
) -> Manifold:
    """A rounded plate of the shape of a lens, smaller by `inset`."""
    begin = (0.0 if inset == 0.0 else -1.0) if start is None else start
    stop = end if start is not None or inset == 0.0 else 1.0
    high = values.number("lens")
    radius = (0.5 if values.choice("shape") == "round" else 0.25) * min(wide, high) - 1e-4
    places = [
        (x + sx * (0.5 * wide - radius), 0.5 * high + sz * (0.5 * high - radius)) for sx in (-1, 1) for sz in (-1, 1)
    ]
    return hull(*(cylinder(radius - inset, (px, begin, pz), (px, stop, pz)) for px, pz in places))


def _end(values: Values, side: float, gap: float) -> Manifold:
    """The corner of the frame, from the rim outwards and back to the hinge."""
    half, level = 0.5 * values.number("width"), _level(values)
    low, top = level - 0.6 * _HIGH, level + 0.6 * _HIGH
    across = sorted((side * (half - 0.013), side * half))
    back = sorted((side * (half - _EYEGLASSES_THICK), side * half))
    return box((across[0], 0, low), (across[1], _DEEP, top)) + box((back[0], 0, low), (back[1], _BACK - 0.5 * gap, top))


def _temple(values: Values, side: float, gap: float) -> Manifold:
    """Unfolded: it runs straight back and bends down a little behind the ear."""
    half, level, length = 0.5 * values.number("width"), _level(values), values.number("temple")
    x0, x1 = sorted((side * (half - _EYEGLASSES_THICK), side * half))
    bend, drop = _BACK + 0.72 * length, 0.3 * _LEAN * values.number("width")
    low, top = level - 0.5 * _HIGH, level + 0.5 * _HIGH
    joint = box((x0, bend, low), (x1, bend + 1e-3, top))
    tip = box((x0, _BACK + length - 1e-3, low - drop), (x1, _BACK + length, top - drop))
    return union(box((x0, _BACK + 0.5 * gap, low), (x1, bend + 1e-3, top)), hull(joint, tip))


def _hinge(pivot: FloatArray, side: float, off_face: float, gap: float) -> tuple[Manifold, Manifold]:
    """Both halves of a barrel about a leaning pin, for the frame and for the unfolded temple."""
    x0, x1 = sorted((side * (off_face - 1e-4), side * (off_face + 5e-4)))
    on_frame, on_temple = (x0, x1, -gap - 0.004, -gap - 1.6e-3), (x0, x1, gap + 1.6e-3, gap + 0.004)
    turn = np.array([[1.0, 0.0, -_LEAN], [0.0, math.hypot(_LEAN, 1.0), 0.0], [_LEAN, 0.0, 1.0]]) / math.hypot(
        _LEAN, 1.0
    )
    of_frame, of_temple = barrel(_EYEGLASSES_HINGE, _EYEGLASSES_KNUCKLE, gap, (on_frame, on_temple))
    return of_frame.transform(at(pivot, turn)), of_temple.transform(at(pivot, turn))


def _about(axis: FloatArray, pivot: FloatArray, angle: float) -> FloatArray:
    """Return the transform, shape (3, 4), that turns about a line."""
    rotation = rotation_about(axis, angle)
    return at(pivot - rotation @ pivot, rotation)
