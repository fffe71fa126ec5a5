"""Plain slabs, frames, carcasses and trays, without hardware, as collections of meshes have them; the front is -y."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.library.builder import ObjectBuilder
    from kinematify.generate.procedural.solids import Point
    from kinematify.robot.arrays import FloatArray


def seam(d: ObjectBuilder, size: float, thick: float) -> float:
    """Distance between faces that meet [m]; below zero where a hand that makes no holes lets one stand in the other.

    Args:
        d: The object.
        size: Of the smaller side of the part, which bounds a gap [m].
        thick: Of the part, which bounds how far it stands in the other [m].
    """
    gap = d.gap(size)
    return gap if d.style.has_bore else float(d.pick(gap, gap, 0.0, -d.draw(0.02, 0.3) * thick))


def surround(d: ObjectBuilder, name: str, wide: float, low: float, high: float, front: float, *, sill: bool) -> None:
    """What a leaf closes: a frame, a wall with an opening, or two posts, from `front` backward."""
    kind = d.pick("frame", "frame", "wall", "posts")
    side = d.draw(0.3, 1.0) if kind == "wall" else d.draw(0.03, 0.12)
    back = front + d.draw(0.05, 0.2)
    for s in (-1.0, 1.0):
        d.part(name, box((s * wide / 2, front, low), (s * (wide / 2 + side), back, high)), material="wood")
    if kind != "posts":
        d.part(name, box((-wide / 2 - side, front, high), (wide / 2 + side, back, high + side)))
    if sill or d.maybe(0.2):
        d.part(name, box((-wide / 2 - side, front, low - d.draw(0.02, 0.06)), (wide / 2 + side, back, low)))
    elif kind == "posts":
        d.part(
            name, box((-wide / 2 - side, front, low - 0.05), (wide / 2 + side, back, low - d.draw(0.0, 0.02) - 0.01))
        )
        for s in (-1.0, 1.0):
            d.part(name, box((s * wide / 2, front, low - 0.05), (s * (wide / 2 + side), back, low)))
    if kind == "frame" and d.maybe(0.3):  # a trim around it, on the far side
        trim = side + d.draw(0.02, 0.05)
        for s in (-1.0, 1.0):
            d.part(name, box((s * wide / 2, back - 0.01, low), (s * (wide / 2 + trim), back + 0.01, high)))
        d.part(name, box((-wide / 2 - trim, back - 0.01, high), (wide / 2 + trim, back + 0.01, high + trim)))


def carcass(
    d: ObjectBuilder,
    name: str,
    lower: Point,
    upper: Point,
    wall: float,
    *,
    shelves: Sequence[float] | FloatArray = (),
    uprights: Sequence[float] | FloatArray = (),
    material: str = "wood",
) -> None:
    """A body open at the front, of boards; a block for those who do not model walls.

    Args:
        d: The object.
        name: Of the body.
        lower: Its corner [m].
        upper: The other one [m].
        wall: Thickness of the boards [m].
        shelves: Heights of boards within it [m].
        uprights: Where along x it is divided [m].
        material: Of the body.
    """
    (x0, y0, z0), (x1, y1, z1) = lower, upper
    if not d.style.hollow:
        d.part(name, box(lower, upper), material=material)
        return
    for a, b in ((x0, x0 + wall), (x1 - wall, x1)):
        d.part(name, box((a, y0, z0), (b, y1, z1)), material=material)
    for a, b in ((z0, z0 + wall), (z1 - wall, z1)):
        d.part(name, box((x0, y0, a), (x1, y1, b)))
    d.part(name, box((x0, y1 - 0.5 * wall, z0), (x1, y1, z1)))
    for z in shelves:
        d.part(name, box((x0, y0 + d.pick(0.0, 0.02), z - wall / 2), (x1, y1, z + wall / 2)))
    for x in uprights:
        d.part(name, box((x - wall / 2, y0, z0), (x + wall / 2, y1, z1)))


def pull(d: ObjectBuilder, on: str, at: Point, out: FloatArray, along: FloatArray, room: float) -> None:
    """A handle on a slab: a rail, a bare rod before it, a lip, a stub or a knob; apart or none as the hand has it.

    Args:
        d: The object.
        on: What it is on.
        at: Its middle, on the surface [m].
        out: Where the surface looks.
        along: Its direction.
        room: How long it may be [m].
    """
    if d.style.grips == "none":
        return
    at = np.asarray(at, dtype=np.float64)
    length = d.pick(d.draw(0.1, 0.4), d.draw(0.5, 0.95)) * room
    thick = min(max(0.06 * length, 0.012 * room), 0.03)
    high = d.draw(1.2, 3.0) * thick
    half, top = 0.5 * length * along, at + high * out
    kind = d.pick("rail", "rail", "rod", "lip", "stub", "knob")
    if kind == "rail":
        shapes = [
            d.pick(beam(thick, thick, top - half, top + half, out), d.cylinder(thick / 2, top - half, top + half))
        ]
        shapes += [beam(0.8 * thick, 0.8 * thick, at + s * half, top + s * half, along) for s in (-0.9, 0.9)]
    elif kind == "rod":
        level = at + (thick / 2 + d.pick(0.0, d.style.gap, -0.2 * thick)) * out
        shapes = [d.cylinder(thick / 2, level - half, level + half)]
    elif kind == "lip":
        shapes = [beam(0.3 * thick, high, at + high / 2 * out - half, at + high / 2 * out + half, out)]
    elif kind == "stub":
        shapes = [beam(2.0 * thick, high, at + high / 2 * out - half / 4, at + high / 2 * out + half / 4, out)]
    else:
        shapes = [d.cylinder(0.7 * thick, at, top), ball(1.2 * thick, top)]
    if d.style.grips == "apart":
        d.fix(d.part(f"{on}_handle", *shapes, material="metal"), on)
    else:
        d.part(on, *shapes)


def slab(
    d: ObjectBuilder,
    name: str,
    parent: str,
    lower: Point,
    upper: Point,
    *,
    hinge: FloatArray,
    out: FloatArray = -Y,
    reach: float = 1.6,
    back: float = 0.0,
    inset: bool = False,
    handle: bool = True,
    glazed: float = 0.25,
    material: str | None = None,
) -> None:
    """A plain leaf between two corners that turns about an edge of its own.

    Args:
        d: The object.
        name: Of the leaf.
        parent: What carries it.
        lower: A corner [m].
        upper: The other one [m].
        hinge: From its middle to the edge about which it turns.
        out: Where it opens to.
        reach: How far it opens [rad].
        back: How far it opens to the other side [rad].
        inset: It stands in its parent, not before it.
        handle: It may have one.
        glazed: Share of the leaves that are a frame with a pane.
        material: Of the leaf; its parent's if None.
    """
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    along, across = np.abs(np.cross(hinge, out)), np.abs(hinge)
    thick, wide, length = (float((high - low) @ axis) for axis in (np.abs(out), across, along))
    play = seam(d, min(wide, length), thick)
    shrunk = (play if inset else d.gap(0.3 * wide)) * (along + across)
    low, high = low + shrunk, high - shrunk
    if not inset:
        low, high = low + play * out, high + play * out
    middle = 0.5 * (low + high)
    d.front(name, parent, material=material)
    _filled(d, name, low, high, out, "pane" if d.maybe(glazed) else d.pick("plain", "plain", "panel"))
    inward = 0.0 if d.style.has_bore else d.pick(0.0, 0.0, 0.0, d.draw(0.01, 0.05) * wide)
    half = 0.5 * float((high - low) @ across) - inward
    if handle:
        upright = d.maybe(0.8)  # most handles run along the hinge
        at = middle - d.draw(0.75, 0.93) * half * hinge + 0.5 * thick * out
        room = 0.5 * length if upright else 0.12 * wide
        pull(d, name, at, out, along if upright else across, room)
        if d.maybe(0.15):  # one on either side
            pull_back = middle - 0.85 * half * hinge - 0.5 * thick * out
            d.part(name, d.cylinder(0.02 * wide, pull_back, pull_back - 0.05 * wide * out))
    pivot = middle + half * hinge + (d.style.line - 0.5) * thick * out
    d.hinge(name, parent, np.cross(out, hinge), pivot, reach, -back)


def pane(d: ObjectBuilder, name: str, lower: Point, upper: Point, out: FloatArray = -Y, material: str = "wood") -> None:
    """A plate between two corners that is a plain slab, has a panel let in, or is a frame about a pane."""
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    d.part(name, material=material)
    _filled(d, name, low, high, out, d.pick("plain", "panel", "pane", "pane"))


def _filled(d: ObjectBuilder, name: str, low: FloatArray, high: FloatArray, out: FloatArray, kind: str) -> None:
    """Shapes of a plate: the same on both sides but for a panel."""
    flat = 1.0 - np.abs(out)
    thick = float((high - low) @ np.abs(out))
    edge = d.draw(0.08, 0.2) * float((high - low)[flat > 0.5].min()) * flat
    if kind == "panel":
        d.part(name, box(low, high))
        face = 0.5 * (low + high) + 0.5 * thick * out
        half = 0.5 * (high - low) * flat - edge
        if d.maybe():
            d.cut(name, box(face - half - d.draw(0.1, 0.4) * thick * out, face + half + thick * out))
        else:
            d.part(name, box(face - half - 0.1 * thick * out, face + half + d.draw(0.1, 0.3) * thick * out))
        return
    if kind == "plain":
        d.part(name, box(low, high))
        return
    first, second = np.eye(3)[np.flatnonzero(flat)]
    for axis in (first, second):
        d.part(name, box(low, high - ((high - low) - edge) * axis))
        d.part(name, box(low + ((high - low) - edge) * axis, high))
    filling = 0.5 * d.draw(0.1, 0.4) * thick * np.abs(out)
    middle = 0.5 * (low + high)
    half = 0.5 * (high - low) * flat - 0.9 * edge
    glass = box(middle - half - filling, middle + half + filling)
    if d.style.grips == "apart" and d.maybe():
        d.fix(d.part(f"{name}_pane", glass, material="glass"), name)
    else:
        d.part(name, glass)


def box_drawer(
    d: ObjectBuilder,
    name: str,
    parent: str,
    lower: Point,
    upper: Point,
    *,
    lap: float = 0.0,
    front: float | None = None,
) -> None:
    """A drawer in the bay between two corners, open at -y: a tray, a block or a front, before the bay or let into it.

    Args:
        d: The object.
        name: Of the drawer.
        parent: What holds it.
        lower: A corner of the bay [m].
        upper: The other one [m].
        lap: How far a front that stands before the bay covers its edges [m]; without, it is let in.
        front: Thickness of the front [m].
    """
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    size = high - low
    plate = front or d.draw(0.012, 0.025)
    play = seam(d, float(min(size[0], size[2])), plate)
    sides = play * (X + Z)
    y = low[1] - (plate + play if lap else 0.0)
    cover = lap * (X + Z) if lap else -sides
    a, b = low - cover, high + cover
    a[1], b[1] = y, y + plate
    d.front(name, parent, box(a, b))
    body_low, body_high = low + sides, high - sides - max(play, 0.0) * Y
    body_low[1] = y + 0.5 * plate
    if d.style.drawer != "front":
        wall = min(0.012, 0.08 * float(min(size[0], size[2])))
        if d.style.drawer == "tray":
            top = body_high[2] - d.draw(0.0, 0.5) * size[2]
            ends = body_high * (X + Y) + top * Z
            d.part(name, box(body_low, body_high * (X + Y) + (body_low[2] + wall) * Z))
            for axis in (X, Y):
                d.part(name, box(body_low, ends - (body_high - body_low - wall) * axis))
                d.part(name, box(body_low + (body_high - body_low - wall) * axis, ends))
        else:
            d.part(name, box(body_low, body_high))
    if not d.style.hollow and d.style.has_bore and d.style.drawer != "front":
        d.cut(parent, box(low - 1e-3 * Y, high))
    at = 0.5 * (a + b)
    at[1] = y
    level = d.pick(0.0, 0.0, d.draw(0.2, 0.4)) * float(b[2] - a[2])
    pull(d, name, at + level * Z, -Y, X, min(0.6 * float(size[0]), 4.0 * float(size[2])))
    d.slide(name, parent, -Y, d.draw(0.5, 0.95) * float(high[1] - low[1]))


def rack(d: ObjectBuilder, name: str, parent: str, lower: Point, upper: Point, *, travel: float = 0.8) -> None:
    """A tray, a sheet or a wire rack between two corners that is drawn out to -y, on ledges now and then."""
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    size = high - low
    wall = 0.03 * float(min(size[0], size[1]))
    play = seam(d, float(size[0]), wall)
    # Ledges and solid blocks alike hold it at its sides.
    a, b = low + play * X, high - play * X
    kind = d.pick("tray", "sheet", "wires", "basket")
    if kind == "sheet":
        d.part(name, box(a, [b[0], b[1], a[2] + 0.5 * wall]), material="metal")
    elif kind == "tray":
        d.part(name, box(a, b), material="metal")
        d.cut(name, box(a + wall * (X + Y) + 0.4 * wall * Z, b - wall * (X + Y) + size[2] * Z))
    else:
        wire = 0.25 * wall
        levels = [a[2] + wire] if kind == "wires" else [a[2] + wire, b[2] - wire]
        for z in levels:
            for y in (a[1] + wire, b[1] - wire):
                d.part(name, d.cylinder(wire, (a[0], y, z), (b[0], y, z)), material="metal")
            for x in (a[0] + wire, b[0] - wire):
                d.part(name, d.cylinder(wire, (x, a[1], z), (x, b[1], z)))
        for x in np.linspace(a[0] + wire, b[0] - wire, d.count(5, 12)):
            d.part(name, d.cylinder(wire, (x, a[1], levels[0]), (x, b[1], levels[0])))
            if kind == "basket":
                d.part(name, d.cylinder(wire, (x, a[1] + wire, levels[0]), (x, a[1] + wire, levels[1])))
                d.part(name, d.cylinder(wire, (x, b[1] - wire, levels[0]), (x, b[1] - wire, levels[1])))
    if d.style.hollow and d.maybe(0.6):
        under = a[2] - max(play, 0.0)
        for x, s in ((low[0], 1.0), (high[0], -1.0)):
            d.part(parent, box((x - s * wall, low[1], under - wall), (x + s * 1.5 * wall, high[1], under)))
    elif not d.style.hollow and d.style.has_bore:
        d.cut(parent, box(low - size[2] * Z - 1.0 * Y, high + size[2] * Z))
    d.slide(name, parent, -Y, travel * float(size[1]))
