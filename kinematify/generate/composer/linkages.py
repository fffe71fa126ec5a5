"""Mechanisms of several bars: cantilever trays, a scissor lift, a gripper, and what folds out on a fork.

As all mechanisms, each is built in the frame of its side. Bars of a closed chain follow their leader by a fixed
multiple, which is exact for parallelograms and scissors; the pin that closes the chain is given beside it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.composer.bodies import BODY
from kinematify.generate.composer.place import HANGING, OUTWARD
from kinematify.generate.procedural.pieces.bearings import fork, fork_room
from kinematify.generate.procedural.pieces.jaws import add_jaws, jaw_rail
from kinematify.generate.procedural.solids import ball, bore, box, cylinder, hull, ring, tray, union
from kinematify.robot.robot import Mimic

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.composer.place import Placement
    from kinematify.generate.procedural.workshop import Workshop

_HEAD = 1.2  # radius of a stick's head in radii of its pin's knuckle
_QUARTER = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""A quarter turn about z, clockwise."""
_PIN = 0.004  # radius of the pins of trays [m]
_PLATE = 0.004  # thickness of their arms [m]
_SPACING = 0.05  # between both arms of a tray [m]
_FLAT = math.radians(10.0)  # angle of the arms of a scissor lift that is down
_STEEP = math.radians(55.0)  # and up


def stick(
    parent: str,
    frame: Workshop,
    name: str,
    width: float,
    clearance: float,
    *,
    long: float,
    limits: tuple[float, float] = (-0.8, 0.8),
    head: Manifold | None = None,
) -> float:
    """Add a fork at the origin of a frame and a stick that stands up in it.

    Args:
        parent: The body that carries it.
        frame: z is up along the stick, x along the pin.
        name: Of the stick.
        width: Of the fork [m].
        clearance: In the fork [m].
        long: From the pin to the end [m].
        limits: [rad].
        head: What is on its end, made about the origin; a ball that fits if None.

    Returns:
        The height of its end [m].
    """
    radius = 0.22 * width
    gap = min(clearance, 0.15 * radius)
    level = fork_room(radius, gap) + 0.5 * radius
    forked, tongue = fork(width, radius, gap, level + 1e-3)
    frame.add(parent, forked.translate((0, 0, level)))
    end = (0, 0, level + long)
    head = head or ball(_HEAD * radius, (0, 0, 0))
    frame.body(
        name, tongue.translate((0, 0, level)), cylinder(0.6 * radius, (0, 0, 2.0 * level), end), head.translate(end)
    )
    frame.turns(name, parent, (1, 0, 0), (0, 0, level), limits)
    return level + long


def add_pedal(place: Placement) -> None:
    """A plate on a stick that is trodden down."""
    width = min(0.05, 0.5 * place.area.height, 0.4 * place.area.width)
    tread = box((-width, -0.1 * width, -1.2 * width), (width, 0.15 * width, 0.6 * width))
    frame = place.workshop.turned(OUTWARD, place.middle)
    stick(BODY, frame, place.name, width, place.clearance, long=3.0 * width, limits=(0.0, 0.3), head=tread)


def add_hook(place: Placement) -> None:
    """A stick that ends in a hook and folds down."""
    width = min(0.04, 0.5 * place.area.height, 0.8 * place.radius)
    wire, bend = 0.132 * width, 0.45 * width
    # A half circle from the end of the stick upwards, its plane across the pin.
    curl = ring(bend, wire, 180.0).transform([[0, 0, 1, 0], [1, 0, 0, bend], [0, 1, 0, 0]])
    tip = ball(wire, (0, 2.0 * bend, 0))
    frame = place.workshop.turned(OUTWARD, place.middle)
    stick(BODY, frame, place.name, width, place.clearance, long=width, limits=(0.0, 1.2), head=curl + tip)


def add_leg(place: Placement) -> None:
    """A leg that folds inwards under the body; those on the left lie beside those on the right."""
    x, _, z = place.middle
    inwards = 1.0 if x < 0.0 else -1.0
    long = place.workshop.above_floor(place.middle)
    radius, gap = 0.012, min(place.clearance, 0.0015)
    level = fork_room(radius, gap) + 0.5 * radius
    # Its y runs along the body's width, so that the pin, its x, lies across; it hangs along -z.
    below = place.workshop.turned(HANGING, (x, 0.0, z - 0.03 * inwards))
    across = below.turned(_QUARTER, (0, 0, 0))
    forked, tongue = (half.rotate((180, 0, 0)).translate((0, 0, -level)) for half in fork(0.05, radius, gap, 0.04))
    across.add(BODY, forked ^ box((-1, -1, -1), (1, 1, 1e-3)))
    shaft = box((-0.0115, -radius, -long), (0.0115, radius, -level - 0.03))
    across.body(place.name, tongue, shaft)
    across.turns(place.name, BODY, (inwards, 0, 0), (0, 0, -level), (0.0, 0.5 * math.pi))


def add_gripper(place: Placement) -> None:
    """Two parallel jaws on a rail."""
    frame, half = place.workshop.turned(OUTWARD, place.middle), min(0.06, 0.8 * place.radius)
    frame.add(BODY, union(*jaw_rail(half)).translate((0, 0, -1e-3)))
    add_jaws(frame, f"{place.name}_finger", BODY, half, 0.07, clearance=place.clearance, rest=place.fitting.rest)


def add_cantilever_tray(place: Placement) -> None:
    """A tray that two parallel arms lift out over an edge: the first to the front, the second to the back.

    The four bars are a parallelogram, so that the tray stays level: it turns back as far as its arms turn.
    """
    area, gap, name = place.area, place.clearance, place.name
    frame = place.workshop.turned(OUTWARD, place.middle)
    sign = -1.0 if place.index == 0 else 1.0
    inside, deep = 0.5 * area.width, 0.5 * area.height
    outer = inside - gap - _PLATE  # of the arms' inner faces
    tall, low = min(0.07, 0.6 * deep), 0.02
    rise = low + gap + 0.5 * tall
    # Where it leans over the edge, the outer arm must not touch the wall that it comes out of.
    reach = (0.5 * deep - 0.5 * _SPACING - 3.2 * _PIN - 1e-3) / (1.0 + low / rise)
    near, far = sorted((sign * 0.5 * gap, sign * deep))
    end = outer - gap
    middle = sign * 0.5 * deep
    arms: list[tuple[str, tuple[float, float]]] = []
    for number, aside in ((1, -0.5), (2, 0.5)):
        upper = (middle + aside * _SPACING, gap + 0.5 * tall)
        lower = (upper[0] + sign * reach, upper[1] - rise)
        bars = [_bar(x, lower, upper) for x in (outer, -outer - _PLATE)]
        rod = cylinder(_PIN, (-outer - 1e-3, *upper), (outer + 1e-3, *upper))
        holes = bore(_PIN, gap, (-2.0 * inside, *lower), (2.0 * inside, *lower))
        for side in (-1.0, 1.0):
            pin = cylinder(_PIN, (side * (inside + 1e-3), *lower), (side * (outer - 1e-3), *lower))
            frame.add(BODY, pin)
        arm = f"{name}_arm_{number}"
        follows = Mimic(joint=arms[0][0], multiplier=1.0, offset=0.0) if arms else None
        frame.body(arm, *(bar - holes for bar in bars), rod, material="metal")
        turn = 2.0 * math.atan2(reach, rise)
        frame.turns(arm, BODY, (-sign, 0, 0), (0.0, *lower), (0.0, turn), rest=place.fitting.rest, follows=follows)
        arms.append((arm, upper))
    (first, upper), (second, other) = arms
    box_of_it = tray((-end, near, gap), (end, far, gap + tall), 0.003)
    holes = [bore(_PIN, gap, (-2.0 * inside, *pivot), (2.0 * inside, *pivot)) for pivot in (upper, other)]
    frame.body(name, box_of_it - union(*holes))
    back = Mimic(joint=first, multiplier=-1.0, offset=0.0)
    frame.turns(name, first, (-sign, 0, 0), (0.0, *upper), (-turn, 0.0), follows=back)
    frame.closes(second, name, (0.0, *other))


def _bar(x: float, start: tuple[float, float], end: tuple[float, float]) -> Manifold:
    """A flat bar with round ends between two points y, z, from x on."""
    return hull(*(cylinder(2.2 * _PIN, (x, *point), (x + _PLATE, *point)) for point in (start, end)))


def add_scissor_lift(place: Placement) -> None:
    """A platform on two pairs of crossed arms: the one pair turns on the body and the other one on it, twice as far."""
    area, gap, name = place.area, place.clearance, place.name
    frame = place.workshop.turned(OUTWARD, place.middle)
    wide, bar, pin = 0.5 * area.height, 0.012, 0.005
    long = 0.85 * area.width
    left = -0.5 * long * math.cos(_FLAT)
    low = 2.0 * bar
    foot, top = (left, low), (-left, low + long * math.sin(_FLAT))
    slot, head = (-left, low), (left, low + long * math.sin(_FLAT))
    centre = (0.0, 0.5 * (low + head[1]))
    lug, plate = 0.008, 0.006
    outer = wide - lug - gap  # outer face of the outer arms
    inner = outer - plate - gap
    lugs = [_lug((sign * (outer + gap), sign * wide), foot, 0.0, bar) for sign in (-1.0, 1.0)]
    pins = [_across(pin, foot, sign * (outer + gap + 1e-3), sign * (outer - plate)) for sign in (-1.0, 1.0)]
    frame.add(BODY, *lugs, *pins)
    lower, upper = f"{name}_arm_1", f"{name}_arm_2"
    outer_arms = [_arm((sign * outer, sign * (outer - plate)), foot, top, bar) for sign in (-1.0, 1.0)]
    rods = [_across(pin, point, -outer + 1e-3, outer - 1e-3) for point in (centre, top)]
    frame.body(lower, *(arm - _across(pin, foot, -1.0, 1.0, gap) for arm in outer_arms), *rods, material="metal")
    rise = _STEEP - _FLAT
    frame.turns(lower, BODY, (0, -1, 0), _flat(foot), (0.0, rise), rest=place.fitting.rest)
    holes = union(_across(pin, centre, -1.0, 1.0, gap), _across(pin, head, -1.0, 1.0, gap))
    inner_arms = [_arm((sign * inner, sign * (inner - plate)), slot, head, bar) for sign in (-1.0, 1.0)]
    frame.body(
        upper, *(arm - holes for arm in inner_arms), _across(pin, slot, -inner + 1e-3, inner - 1e-3), material="metal"
    )
    frame.turns(
        upper,
        lower,
        (0, -1, 0),
        _flat(centre),
        (-2.0 * rise, 0.0),
        follows=Mimic(joint=lower, multiplier=-2.0, offset=0.0),
    )
    level = head[1] + 2.0 * bar
    hung = [
        _lug((sign * (inner - plate - gap), sign * (inner - plate - gap - lug)), head, level, bar)
        for sign in (-1.0, 1.0)
    ]
    pins = [_across(pin, head, sign * (inner - plate - gap - lug), sign * inner) for sign in (-1.0, 1.0)]
    deck = box((-0.5 * area.width, -wide, level), (0.5 * area.width, wide, level + 0.02))
    frame.body(name, deck, *hung, *pins)
    frame.turns(
        name, upper, (0, -1, 0), _flat(head), (0.0, rise), follows=Mimic(joint=lower, multiplier=1.0, offset=0.0)
    )


def _flat(point: tuple[float, float]) -> tuple[float, float, float]:
    return point[0], 0.0, point[1]


def _across(
    radius: float, point: tuple[float, float], start: float, end: float, clearance: float | None = None
) -> Manifold:
    """A pin along y through a point x, z; a bore for it if there is a clearance."""
    ends = (point[0], start, point[1]), (point[0], end, point[1])
    return cylinder(radius, *ends) if clearance is None else bore(radius, clearance, *ends)


def _arm(span: tuple[float, float], start: tuple[float, float], end: tuple[float, float], bar: float) -> Manifold:
    """A bar between two points x, z that reaches from one y to another."""
    return hull(*(_across(bar, point, *span) for point in (start, end)))


def _lug(span: tuple[float, float], pivot: tuple[float, float], level: float, bar: float) -> Manifold:
    """A plate around a pin, from one y to another, that stands on a level or hangs from it."""
    low, high = sorted(span)
    base = box((pivot[0] - 1.5 * bar, low, level - 1e-3), (pivot[0] + 1.5 * bar, high, level + 1e-3))
    return hull(_across(bar, pivot, low, high), base)
