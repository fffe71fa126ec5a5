"""Moving parts of an object, as the hand at work draws it: wheels, knobs, levers, rods; leaves and drawers are panels.

`out` is the direction in which a surface looks, a unit vector along an axis of the world.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, block, box, point, rounded_block

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.builder import ObjectBuilder
    from kinematify.generate.procedural.solids import Point
    from kinematify.robot.arrays import FloatArray


def case(
    d: ObjectBuilder,
    name: str,
    lower: Point,
    upper: Point,
    *,
    opening: Point | None = None,
    wall: float | None = None,
    material: str = "wood",
) -> None:
    """A block, or for those who model walls a hollow box, open where `opening` points to."""
    low, high = point(lower), point(upper)
    size = high - low
    thick = wall or 0.06 * float(size.min())
    whole = rounded_block(size, 0.15 * thick).translate(0.5 * (low + high)) if d.style.rounded else box(low, high)
    d.part(name, whole, look=material)
    if d.style.hollow and opening is not None:
        out = np.asarray(opening)
        d.cut(name, box(low + thick + np.minimum(2 * out * thick, 0), high - thick + np.maximum(2 * out * thick, 0)))


def legs(d: ObjectBuilder, name: str, lower: Point, upper: Point, thick: float) -> None:
    """Four legs at the corners of a box, square or round."""
    (x0, y0, z0), (x1, y1, z1) = lower, upper
    h = 0.5 * thick
    for x in (x0 + h, x1 - h):
        for y in (y0 + h, y1 - h):
            foot, top = (x, y, z0), (x, y, z1)
            d.part(name, d.cylinder(h, foot, top) if d.style.sides > 12 else beam(thick, thick, foot, top))


def wheel(
    d: ObjectBuilder,
    name: str,
    parent: str,
    middle: Point,
    radius: float,
    wide: float,
    out: FloatArray,
    *,
    axle: float = 0.0,
    material: str = "rubber",
) -> None:
    """A wheel that spins about `out`; `axle` is how far the parent lies behind its inner face [m]."""
    at = point(middle)
    inner, outer = at - 0.5 * wide * out, at + 0.5 * wide * out
    if d.style.wheel == "disc":
        d.part(name, d.cylinder(radius, inner, outer), look=material)
    elif d.style.wheel == "tyre":
        wire = min(0.5 * wide, 0.3 * radius)
        d.part(
            name,
            d.torus(radius - wire, wire, at, out),
            d.cylinder(radius - wire, at - 0.3 * wide * out, at + 0.3 * wide * out),
        )
    else:
        d.part(name, d.tube(radius, 0.82 * radius, inner, outer), d.cylinder(0.22 * radius, inner, outer))
        side = np.roll(out, 1)
        up = np.cross(out, side)
        for k in range(d.count(3, 6)):
            angle = 2.0 * np.pi * k / 5
            d.part(
                name,
                beam(
                    0.5 * wide, 0.12 * radius, at, at + 0.9 * radius * (np.cos(angle) * side + np.sin(angle) * up), out
                ),
            )
    if axle > 0.0:
        stub = d.cylinder(0.15 * radius, inner - (axle + 0.02 * radius) * out, inner if d.style.has_bore else at)
        if d.style.has_bore:
            d.part(name, d.cylinder(0.15 * radius, inner - (axle - d.gap(radius)) * out, at))
        else:
            d.part(d.pick(parent, name), stub)
    d.spin(name, parent, out, at)


def knob(
    d: ObjectBuilder,
    name: str,
    parent: str,
    at: Point,
    radius: float,
    out: FloatArray,
    *,
    high: float | None = None,
    reach: float | None = None,
    deep: float | None = None,
    material: str = "plastic",
) -> None:
    """A knob or dial on a surface, turned clockwise.

    Args:
        d: The object.
        name: Of the knob.
        parent: What carries it.
        at: Its middle, on the surface [m].
        radius: Of the knob [m].
        out: Where the surface looks.
        high: How far it stands out [m]; by 0.7 radii if None.
        reach: How far it turns [rad]; without end if None.
        deep: How far its shaft reaches into what carries it [m]; by 0.6 of its height if None.
        material: Of the knob.
    """
    at, high = point(at), high or 0.7 * radius
    gap = d.gap(radius)
    foot = at + (gap - d.style.max_penetration * high) * out
    top = at + high * out
    side = _across(out, (1.0, 1.0))[1]
    d.part(name, look=material)
    if d.style.has_bore:  # it turns in a hole of its parent
        shaft, deep, foot = 0.3 * radius, deep or 0.6 * high, at + gap * out
        d.cut(parent, d.cylinder(shaft + 1.5 * d.gap(shaft), at - deep * out, at + shaft * out))
        d.part(name, d.cylinder(shaft, at - (deep - max(gap, 1e-3 * deep)) * out, at + (gap + 0.2 * shaft) * out))
    kind = d.style.knob
    if kind == "bar":
        d.part(
            name, beam(0.4 * radius, high, 0.5 * (foot + top) - radius * side, 0.5 * (foot + top) + radius * side, out)
        )
        d.part(name, d.cylinder(0.55 * radius, foot, foot + 0.4 * (top - foot)))
    elif kind == "ball":
        d.part(name, d.cylinder(0.4 * radius, foot, top), ball(0.8 * radius, top))
    elif kind == "star":
        arms = [np.cos(a) * side + np.sin(a) * np.cross(out, side) for a in np.arange(5) * 2 * np.pi / 5]
        d.part(name, d.cylinder(0.5 * radius, foot, top))
        d.part(
            name,
            *(beam(0.3 * radius, 0.6 * high, 0.5 * (foot + top), 0.5 * (foot + top) + radius * a, out) for a in arms),
        )
    else:
        d.part(name, d.cylinder(radius, foot, top), look=material)
    if kind == "pointer":
        d.part(name, beam(0.16 * radius, 0.4 * high, top, top + 0.95 * radius * side, out))
    if reach is None:
        d.spin(name, parent, -out, at)
    else:
        d.hinge(name, parent, -out, at, reach)


def button(
    d: ObjectBuilder,
    name: str,
    parent: str,
    at: Point,
    size: tuple[float, float],
    high: float,
    out: FloatArray,
    *,
    is_round: bool = False,
    material: str = "plastic",
) -> None:
    """A button of a width and a height that stands out of a surface and is pressed in."""
    at = point(at)
    gap = d.gap(min(size))
    deep = 0.8 * high if d.style.has_bore else d.style.max_penetration * high
    low, high_end = at + (0.0 if deep else gap) * out - deep * out, at + high * out
    if is_round:
        d.bore(parent, d.cylinder(0.5 * size[0] + 1.5 * gap, at - (deep + high) * out, at + 0.05 * high * out))
        d.part(name, d.cylinder(0.5 * size[0], low, high_end), look=material)
    else:
        wide, tall = _across(out, size)
        half, flat = 0.5 * (wide + tall), 1.0 - np.abs(out)
        d.bore(parent, box(at - half - gap * flat - (deep + high) * out, at + half + gap * flat + 0.05 * high * out))
        d.part(name, box(low - half, high_end + half), look=material)
    d.slide(name, parent, -out, 0.7 * high, ajar=False)


def lever(
    d: ObjectBuilder,
    name: str,
    parent: str,
    at: Point,
    out: FloatArray,
    along: Point,
    length: float,
    *,
    reach: float = 0.8,
    lower: float = 0.0,
    through: float = 0.0,
    material: str = "metal",
) -> None:
    """A bar that lies along a surface and turns about its normal at one end, as a door handle does.

    Args:
        d: The object.
        name: Of the lever.
        parent: What carries it.
        at: Where it turns, on the surface [m].
        out: Where the surface looks.
        along: Direction of the bar.
        length: Of the bar [m].
        reach: How far it turns [rad]; anticlockwise seen from outside if positive.
        lower: Its other limit, in the same sense as `reach` [rad].
        through: Thickness of a leaf that it goes through, with another bar behind it [m].
        material: Of the lever.
    """
    at, direction = point(at), point(along)
    thick = 0.12 * length
    gap, far = d.gap(thick), d.draw(1.0, 2.0) * thick
    bar = d.pick(d.rod, d.cylinder)
    for face, away in ((at, out), (at - through * out, -out))[: 2 if through else 1]:
        level = face + far * away
        d.part(name, bar(0.5 * thick, level, level + length * direction), look=material)
        d.part(name, d.cylinder(0.45 * thick, face + (gap - (2.0 * thick if d.style.has_bore else 0.0)) * away, level))
        d.bore(parent, d.cylinder(0.45 * thick + 1.5 * gap, face - 2.5 * thick * away, face + thick * away))
    d.hinge(name, parent, np.sign(reach) * out, at, abs(reach), lower)


def arm(
    d: ObjectBuilder,
    name: str,
    parent: str,
    start: Point,
    end: Point,
    thick: float,
    axis: FloatArray,
    *,
    lower: float = -1.0,
    upper: float = 1.0,
    side: float | None = None,
) -> None:
    """A link of a chain that turns about `axis` at `start`: beside what carries it, or in it.

    Args:
        d: The object.
        name: Of the link.
        parent: What carries it.
        start: Its joint [m].
        end: Its other end [m].
        thick: Of the bar [m].
        axis: Of the joint.
        lower: Limit [rad].
        upper: Limit [rad].
        side: How far beside the plane of the joint it lies, along the axis [m]; careful hands lay it beside its parent.
    """
    beside = (thick + d.gap(thick) if d.style.has_bore else 0.0) if side is None else side
    a, b = point(start) + beside * axis, point(end) + beside * axis
    half = 0.5 * thick * axis
    kind = d.pick("beam", "beam", "rod", "plate")
    if kind == "rod" and not d.style.has_bore:
        d.part(name, d.rod(0.5 * thick, a, b), look="metal")
    else:
        wide = thick if kind == "beam" else 1.4 * thick
        d.part(name, beam(wide, 0.9 * thick, a, b, axis), look="metal")
        d.part(name, *(d.cylinder(0.5 * wide, p - 0.45 * thick * axis, p + 0.45 * thick * axis) for p in (a, b)))
    if d.style.has_bore:
        gap = d.gap(thick)
        d.part(name, d.cylinder(0.2 * thick, a - 2.4 * half, a))
        d.cut(
            parent, d.cylinder(0.2 * thick + 1.5 * gap, np.asarray(start) - 3.0 * half, np.asarray(start) + 3.0 * half)
        )
    elif d.style.barrels:
        d.part(d.pick(name, parent), d.cylinder(0.2 * thick, a - 2.5 * half, a + 1.5 * half))
    d.hinge(name, parent, axis, start, upper, lower)


def plunger(
    d: ObjectBuilder,
    name: str,
    parent: str,
    start: Point,
    end: Point,
    radius: float,
    *,
    travel: float,
) -> None:
    """A rod that slides along itself, from `end` inside its parent outward past `start`.

    `start` lies outside and `end` inside; positive motion draws it out.
    """
    a, b = point(start), point(end)
    out = (a - b) / float(np.linalg.norm(a - b))
    gap = d.gap(radius)
    d.part(name, d.cylinder(radius, a, b), look="metal")
    d.bore(parent, d.cylinder(radius + 1.5 * gap, a, b - gap * out))
    d.slide(name, parent, out, travel)


def rotor(
    d: ObjectBuilder,
    name: str,
    parent: str,
    at: Point,
    out: FloatArray,
    radius: float,
    blades: int,
    *,
    wide: float = 0.15,
) -> None:
    """Blades about a hub in front of a surface."""
    at = point(at)
    hub = 0.14 * radius
    gap = d.gap(hub)
    foot = at + (gap - d.style.max_penetration * hub) * out
    d.part(name, d.cylinder(hub, foot, at + 1.6 * hub * out))
    if d.maybe():
        d.part(name, d.cone(hub, 0.2 * hub, at + 1.6 * hub * out, at + 2.6 * hub * out))
    side = np.roll(out, 1)
    tilt = d.draw(0.0, 0.5)
    for angle in np.arange(blades) * 2.0 * np.pi / blades:
        along = np.cos(angle) * side + np.sin(angle) * np.cross(out, side)
        flat = np.cos(tilt) * out + np.sin(tilt) * np.cross(out, along)
        middle = at + hub * out
        d.part(name, beam(wide * radius, 0.3 * hub, middle + 0.5 * hub * along, middle + radius * along, flat))
    d.spin(name, parent, -out, at)


def caster(
    d: ObjectBuilder,
    name: str,
    parent: str,
    top: Point,
    high: float,
    *,
    fork: str | None = None,
    deep: float | None = None,
) -> None:
    """A fork that swivels below a point and a wheel in it, whose radius is 0.38 of the height.

    Args:
        d: The object.
        name: Of the wheel.
        parent: What stands on it.
        top: Where it swivels, on the underside of that [m].
        high: From there to the floor [m].
        fork: Name of the fork; the wheel's with ``_fork`` if None.
        deep: How far its stem reaches up [m]; by 0.3 of its height if None.
    """
    at = point(top)
    radius, deep = 0.38 * high, deep or 0.3 * high
    wide = 0.5 * radius
    axle = at + np.array([0.4 * radius, 0.0, -(high - radius)])
    gap = d.gap(high)
    fork = fork or f"{name}_fork"
    plate = at - 0.16 * high * Z
    d.part(
        fork,
        d.cylinder(0.35 * radius, at - gap * Z, plate),
        block(plate, (1.6 * radius, 1.8 * wide, 0.1 * high)),
        look="steel",
    )
    d.part(name, d.cylinder(radius, axle - 0.45 * wide * Y, axle + 0.45 * wide * Y), look="rubber")
    if d.style.has_bore:
        d.cut(parent, d.cylinder(0.2 * radius + 1.5 * gap, at - 0.1 * high * Z, at + (deep + 0.02 * high) * Z))
        d.part(fork, d.cylinder(0.2 * radius, at - 0.1 * high * Z, at + deep * Z))
        d.part(fork, d.cylinder(0.1 * radius, axle - 0.8 * wide * Y, axle + 0.8 * wide * Y))
        d.cut(name, d.cylinder(0.1 * radius + 1.5 * gap, axle - wide * Y, axle + wide * Y))
    for side in (-1.0, 1.0):
        leg = axle + side * 0.8 * wide * Y
        d.part(fork, beam(0.5 * radius, 0.3 * wide, np.array([leg[0], leg[1], plate[2]]), leg - 0.3 * radius * Z, Y))
    d.spin(fork, parent, Z, at)
    d.spin(name, fork, Y, axle)


def crank(
    d: ObjectBuilder,
    name: str,
    parent: str,
    at: Point,
    out: FloatArray,
    length: float,
    *,
    spins: bool = True,
) -> None:
    """A shaft out of a surface, an arm across and a grip, which may turn by itself."""
    at = point(at)
    thick = 0.1 * length
    along = np.roll(out, 1)
    level = at + 0.35 * length * out
    gap = d.gap(thick)
    start = at - (0.3 * length if d.style.has_bore else -gap) * out
    d.bore(parent, d.cylinder(0.5 * thick + 1.5 * gap, start - gap * out, at + 1e-3 * length * out))
    d.part(
        name,
        d.cylinder(0.5 * thick, start, level),
        beam(thick, 0.8 * thick, level - 0.6 * thick * along, level + length * along, out),
        look="metal",
    )
    foot = level + 0.9 * length * along + (0.4 * thick + gap) * out
    handle = d.cylinder(0.7 * thick, foot, foot + 0.5 * length * out)
    if spins and d.maybe(0.4):
        d.part(f"{name}_grip", handle, look="wood")
        d.spin(f"{name}_grip", name, out, foot)
    else:
        low = foot - (0.4 * thick + gap) * out
        d.part(name, d.cylinder(0.7 * thick, low, foot + 0.5 * length * out))
    d.spin(name, parent, -out, at)


def bail(
    d: ObjectBuilder,
    name: str,
    parent: str,
    start: Point,
    end: Point,
    high: float,
    thick: float,
    up: FloatArray,
    *,
    lower: float = -1.5,
    upper: float = 1.5,
) -> None:
    """A bow over the line from `start` to `end`, about which it swings."""
    a, b = point(start), point(end)
    along = (b - a) / float(np.linalg.norm(b - a))
    gap = d.gap(thick)
    a, b = a - (0.5 * thick + gap) * along, b + (0.5 * thick + gap) * along
    r = 0.5 * thick

    def bar(start: FloatArray, end: FloatArray) -> Manifold:
        return d.cylinder(r, start, end) if d.style.sides > 12 else beam(2 * r, 2 * r, start, end)

    posts = [bar(foot - 0.8 * thick * up, foot + high * up) for foot in (a, b)]
    d.part(name, *posts, bar(a + high * up - r * along, b + high * up + r * along), look="metal")
    if d.style.has_bore:
        d.part(
            name,
            d.cylinder(0.3 * thick, a, a + 1.5 * thick * along),
            d.cylinder(0.3 * thick, b, b - 1.5 * thick * along),
        )
        d.cut(parent, d.cylinder(0.3 * thick + 1.5 * gap, a, a + (1.5 * thick + gap) * along))
        d.cut(parent, d.cylinder(0.3 * thick + 1.5 * gap, b, b - (1.5 * thick + gap) * along))
    d.hinge(name, parent, along, 0.5 * (a + b), upper, lower)


def in_fork(d: ObjectBuilder, name: str, parent: str, middle: Point, radius: float, wide: float, top: float) -> None:
    """A wheel about x between two cheeks of its parent that come down from a height, without an axle."""
    at = point(middle)
    play = max(d.pick(d.style.gap, 0.1 * wide, 0.3 * wide), 0.0005)
    sheet = d.draw(0.15, 0.4) * wide
    length = d.draw(0.3, 0.6) * radius
    for s in (-1.0, 1.0):
        x = at[0] + s * (wide / 2 + play)
        d.part(
            parent, box((x, at[1] - length, at[2] - d.draw(0.1, 0.5) * radius), (x + s * sheet, at[1] + length, top))
        )
    reach = wide / 2 + play + sheet
    bridge = max(top - 0.3 * wide, at[2] + radius + play)
    d.part(parent, box((at[0] - reach, at[1] - length, bridge), (at[0] + reach, at[1] + length, bridge + 0.3 * wide)))
    wheel(d, name, parent, at, radius, wide, X)


def _across(out: FloatArray, size: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Vectors of a width and a height across `out`; upright surfaces have their height along z."""
    if abs(out[2]) > 0.5:
        return np.array([size[0], 0.0, 0.0]), np.array([0.0, size[1], 0.0])
    flat = np.array([abs(out[1]), abs(out[0]), 0.0])
    return size[0] * flat, np.array([0.0, 0.0, size[1]])
