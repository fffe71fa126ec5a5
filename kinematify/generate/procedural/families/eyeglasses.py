"""Eyeglasses: a frame with two lenses that looks along -y, and temples that fold in behind it.

The pins lean a little, so that one folded temple rises inwards and the other sinks, and they lie one above the other.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.bearings import at, barrel
from kinematify.generate.procedural.solids import ball, box, cylinder, hull, rod, union
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_LEAN = 0.1  # of the pins [rad]
_KNUCKLE, _HINGE = 0.0018, 0.006  # radius and length of a hinge [m]
_BACK = 0.011  # from the front of the frame to the pins [m]
_THICK, _HIGH = 0.0032, 0.0038  # of a temple [m]
_RIM = 0.0025  # width of a rim [m]
_DEEP = 0.003  # thickness of the frame [m]


def _build(values: Values, workshop: Workshop) -> None:
    gap = min(values.number("clearance"), 0.3 * _KNUCKLE)
    workshop.body("frame", *_frame(values))
    for k, side in enumerate((-1.0, 1.0)):
        inner = 0.5 * values.number("width") - _THICK
        off_face = _KNUCKLE + gap + 0.5 * _LEAN * _HINGE  # so that leaning knuckles keep clear of the faces
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
    back = sorted((side * (half - _THICK), side * half))
    return box((across[0], 0, low), (across[1], _DEEP, top)) + box((back[0], 0, low), (back[1], _BACK - 0.5 * gap, top))


def _temple(values: Values, side: float, gap: float) -> Manifold:
    """Unfolded: it runs straight back and bends down a little behind the ear."""
    half, level, length = 0.5 * values.number("width"), _level(values), values.number("temple")
    x0, x1 = sorted((side * (half - _THICK), side * half))
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
    of_frame, of_temple = barrel(_HINGE, _KNUCKLE, gap, (on_frame, on_temple))
    return of_frame.transform(at(pivot, turn)), of_temple.transform(at(pivot, turn))


def _about(axis: FloatArray, pivot: FloatArray, angle: float) -> FloatArray:
    """Return the transform, shape (3, 4), that turns about a line."""
    rotation = rotation_about(axis, angle)
    return at(pivot - rotation @ pivot, rotation)


FAMILY = family("eyeglasses", _build)
