"""Leaves, drawers, frames, carcasses and trays, as the hand at work draws them; the front is -y where none is named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold

from kinematify.generate.procedural.pieces.bearing_pieces import barrel
from kinematify.generate.procedural.solids import X, Y, Z, ball, beam, box, point

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.procedural.builder import ObjectBuilder
    from kinematify.generate.procedural.pieces.fronts import Bay
    from kinematify.generate.procedural.solids import Point
    from kinematify.robot.arrays import FloatArray

_RIM = 0.75  # height of a drawer's sides, share of the bay's
_REVEAL = 0.002  # of a front towards its neighbours, besides the clearance


def seam(d: ObjectBuilder, size: float, thick: float) -> float:
    """Distance between faces that meet [m]; below zero where a hand that makes no holes lets one stand in the other.

    Args:
        d: The object.
        size: Of the smaller side of the part, which bounds a gap [m].
        thick: Of the part, which bounds how far it stands in the other [m].
    """
    gap = d.gap(size)
    return gap if d.style.has_bore else float(d.pick(gap, gap, 0.0, -d.draw(0.02, 0.3) * thick))


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
        d.part(name, box(lower, upper), look=material)
        return
    for a, b in ((x0, x0 + wall), (x1 - wall, x1)):
        d.part(name, box((a, y0, z0), (b, y1, z1)), look=material)
    for a, b in ((z0, z0 + wall), (z1 - wall, z1)):
        d.part(name, box((x0, y0, a), (x1, y1, b)))
    d.part(name, box((x0, y1 - 0.5 * wall, z0), (x1, y1, z1)))
    for z in shelves:
        d.part(name, box((x0, y0 + d.pick(0.0, 0.02), z - wall / 2), (x1, y1, z + wall / 2)))
    for x in uprights:
        d.part(name, box((x - wall / 2, y0, z0), (x + wall / 2, y1, z1)))


def grip(
    d: ObjectBuilder, on: str, at: Point, out: FloatArray, along: FloatArray, length: float, kind: str = ""
) -> None:
    """A handle on a part: a bar on posts, a bare rod, a block, an edge, stub, plate, cup or knob; apart or none.

    Args:
        d: The object.
        on: What it is on.
        at: Its middle, on the surface [m].
        out: Where the surface looks.
        along: Its direction.
        length: How long it is [m].
        kind: ``bar``, ``knob``, ``cup``, ``edge`` or the like, or ``none``; drawn if empty.
    """
    if d.style.grips == "none" or kind == "none":
        return
    at = point(at) - (0.0 if d.style.grips == "apart" else 1e-3) * out
    kind = kind or d.pick("bar", "bar", "block", "rod", "edge", "stub", "knob", "plate")
    thick, half = min(0.12 * length, d.pick(0.016, 0.03)), 0.5 * length * along
    high = d.draw(1.5, 3.0) * thick
    top = at + high * out
    if kind == "bar":
        shapes = [d.pick(d.cylinder(0.5 * thick, top - half, top + half), beam(thick, thick, top - half, top + half))]
        shapes += [d.cylinder(0.4 * thick, at + s * 0.8 * half, top + s * 0.8 * half) for s in (-1.0, 1.0)]
    elif kind == "rod":
        level = at + (0.5 * thick + d.pick(0.0, d.style.gap, -0.2 * thick)) * out
        shapes = [d.cylinder(0.5 * thick, level - half, level + half)]
    elif kind == "knob":
        shapes = [d.cylinder(0.6 * thick, at, top), ball(thick, top)]
    elif kind == "cup":
        half = min(0.5 * length, 0.04) * along
        bowl = d.cylinder(0.03, at - half, at + half) - d.cylinder(0.025, at - 0.94 * half, at + 0.94 * half)
        before = bowl.trim_by_plane(out, float(at @ out))
        shapes = [before.trim_by_plane(np.cross(along, out), float(at @ np.cross(along, out)))]
    else:
        wide, share = {"block": (1.0, 1.0), "edge": (0.3, 1.0), "stub": (2.0, 0.25), "plate": (0.2, 1.0)}[kind]
        middle, edge = at + 0.5 * high * out, top + 0.4 * thick * np.cross(out, along)
        shapes = [beam(wide * thick, high, middle - share * half, middle + share * half, out)]
        if kind == "plate":
            shapes.append(beam(thick, 0.25 * thick, edge - half, edge + half, out))
    if d.style.grips == "apart":
        d.fix(d.part(f"{on}_grip", *shapes, look="metal"), on)
    else:
        d.part(on, *d.painted(*shapes))


def leaf(
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
    handle: bool | str = True,
    glazed: float = 0.0,
    barrels: int = 0,
    material: str | None = None,
) -> None:
    """A door, lid or flap: a plate between two corners that turns about an edge of its own and opens outward.

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
        handle: It may have one, or has one of a kind of `grip`.
        glazed: Share of the leaves that are a frame with a pane; of the others some have a panel. Zero: all are plain.
        barrels: So many barrel hinges hold it, which both parts have a share of; 0: as this hand draws hinges.
        material: Of the leaf; its parent's if None.
    """
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    along, across = np.abs(np.cross(hinge, out)), np.abs(hinge)
    thick, wide, length = (float((high - low) @ axis) for axis in (np.abs(out), across, along))
    play = seam(d, min(wide, length), thick)
    shrunk = (play if inset else d.gap(min(wide, length))) * (along + across)
    before = 0.0 if inset else play * out
    low, high = low + shrunk + before, high - shrunk + before
    kind = "pane" if glazed and d.maybe(glazed) else d.pick("plain", "plain", "panel") if glazed else "plain"
    d.front(name, parent, material=material)
    filled(d, name, low, high, out, kind)
    inward = 0.0 if d.style.has_bore or barrels else d.pick(0.0, 0.0, 0.0, d.draw(0.01, 0.05) * wide)
    middle, half = 0.5 * (low + high), 0.5 * float((high - low) @ across) - inward
    if barrels:
        plate = middle, half * hinge, 0.5 * length * along, thick * out
        pivot = _knuckles(d, name, parent, plate, play, barrels, inset=inset)
    else:
        pivot = middle + half * hinge + ((0.5 if d.style.barrels else d.style.line - 0.5) * thick) * out
    if d.style.barrels and not barrels:
        radius = min(0.6 * thick, 0.03 * wide)
        for at in (pivot - 0.3 * length * along, pivot + 0.3 * length * along):
            ends = at - 0.06 * length * along, at + 0.06 * length * along
            d.part(d.pick(name, name, parent), d.cylinder(radius, *ends))
    if inset and d.style.has_bore:  # its inner free edge would meet the border when it opens
        free = middle - half * hinge
        less = thick**2 / wide * hinge
        outer, inner = free + 0.5 * thick * out, free - 0.5 * thick * out
        corners = [at + s * length * along for at in (outer, inner, inner + less) for s in (-1.0, 1.0)]
        d.cut(name, Manifold.hull_points(np.array(corners)))
    if handle:
        lengthwise = d.maybe(0.8)  # most handles run along the hinge; cups lie
        if handle == "cup":
            lengthwise = abs(hinge[2]) > 0.5
        room = 0.8 * length if lengthwise else 0.24 * wide
        share = min(d.draw(0.68, 0.86), 1.0 - min(0.05 / half, 0.5))  # clear of a leaf beside it that opens
        at = middle - share * half * hinge + 0.5 * thick * out
        size = min(room, d.pick(min(d.draw(0.2, 0.9) * room, 0.3), min(0.25 * wide, 0.15)))
        grip(d, name, at, out, along if lengthwise else across, size, "" if handle is True else handle)
        if d.maybe(0.15) and not d.style.has_bore:  # one on either side, into what is behind
            behind = middle - 0.85 * half * hinge - 0.5 * thick * out
            d.part(name, d.cylinder(0.02 * wide, behind, behind - 0.05 * wide * out))
    d.hinge(name, parent, np.cross(out, hinge), pivot, reach, -back)


_KNUCKLE = 0.004  # radius of a barrel hinge [m]


def _knuckles(
    d: ObjectBuilder,
    name: str,
    parent: str,
    plate: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
    play: float,
    count: int,
    *,
    inset: bool,
) -> FloatArray:
    """Hold a leaf by barrels beside its edge that clasp both parts; returns a point on the pins.

    Args:
        d: The object.
        name: Of the leaf.
        parent: What carries it.
        plate: Middle of the leaf, and from there to its hinged edge, to its end along that, and through it [m].
        play: Between both [m].
        count: Of barrels.
        inset: They stand before the flush faces of both; otherwise beside the leaf.
    """
    middle, to_edge, to_end, through = plate
    r, thick, half = _KNUCKLE, float(np.linalg.norm(through)), float(np.linalg.norm(to_end))
    gap = d.gap(10.0 * r)
    into, inward, along = -to_edge / np.linalg.norm(to_edge), -through / thick, to_end / half
    if inset:
        pivot = middle + to_edge - 0.5 * play * into - (0.5 * thick + r + gap) * inward
        near, far, face = 0.5 * play + 0.6 * r, 0.5 * play + 3.0 * r, (r + gap - 2e-4, r + gap + 1e-4)
        on_parent, on_leaf = (-far, -near, *face), (near, far, *face)
    else:
        aside = r + 0.003 + gap  # so that the parent's halves pass the leaf
        pivot = middle + to_edge - aside * into
        on_parent = (r - 0.002, r + 0.0043, 0.5 * thick + play + 0.005, 0.5 * thick + play + 0.02)
        on_leaf = (aside, aside + 0.02, -0.5 * thick, 0.003 - 0.5 * thick)
    halves = barrel(min(15.0 * r, half), r, gap, (on_parent, on_leaf))
    for share in np.linspace(-0.7, 0.7, count):
        place = np.column_stack([into, inward, along, pivot + share * to_end])
        for part, solid in zip((parent, name), halves, strict=True):
            d.part(part, solid.transform(place))
    return pivot


def filled(d: ObjectBuilder, name: str, low: FloatArray, high: FloatArray, out: FloatArray, kind: str) -> None:
    """Fill a plate between two corners: a ``plain`` slab, one with a ``panel``, or a frame about a ``pane``."""
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
        d.fix(d.part(f"{name}_pane", glass, look="glass"), name)
    else:
        d.part(name, *d.painted(glass, look="glass"))


def drawer(
    d: ObjectBuilder,
    name: str,
    parent: str,
    lower: Point,
    upper: Point,
    *,
    out: FloatArray = -Y,
    travel: float = 0.75,
    lap: float | None = None,
    front: float | None = None,
    rim: float = 1.0,
    handle: bool | str = True,
    material: str | None = None,
) -> None:
    """A tray, a block or a front in the bay between two corners, which ends at the front; it comes out.

    Args:
        d: The object.
        name: Of the drawer.
        parent: What holds it.
        lower: A corner of the bay [m].
        upper: The other one [m].
        out: Where it comes out.
        travel: How far, in depths of the bay.
        lap: How far a front that stands before the bay covers its edges [m]; 0: it is let in, None: a little.
        front: Thickness of the front [m].
        rim: Height of what is behind the front, share of the bay's.
        handle: It may have one, or has one of a kind of `grip`.
        material: Of the drawer; its parent's if None.
    """
    low, high = np.minimum(lower, upper), np.maximum(lower, upper)
    ahead, sides, size = np.abs(out), 1.0 - np.abs(out), high - low
    deep, least = float(size @ ahead), float(size[sides > 0.5].min())
    plate = front or min(0.03, 0.06 * deep)
    play = seam(d, least, plate)
    reach, lap = 0.5 * size * sides, 0.02 * least if lap is None else lap
    middle = 0.5 * (low + high)
    face = middle + 0.5 * deep * out
    d.bore(parent, box(middle - 0.5 * deep * out - reach, face + 1e-3 * deep * out + reach))
    behind = face + (play if lap else -plate) * out
    cover = reach + (lap or -play) * sides
    d.front(name, parent, box(behind - cover, behind + plate * out + cover), material=material)
    if d.style.drawer != "front":
        back, half = middle - (0.5 * deep - max(play, 0.0)) * out, reach - play * sides
        d.part(name, box(back - half, behind + 0.5 * plate * out + half - 2.0 * (1.0 - rim) * half * Z))
        if d.style.drawer == "tray":
            wall = min(0.06 * least, plate)
            inner = half - wall * sides
            d.cut(name, box(back + wall * out - inner, behind - wall * out + inner + 2.0 * wall * Z))
    if handle:
        along = np.array([1.0, 1.0, 0.0]) * sides
        along /= max(float(np.linalg.norm(along)), 1e-9)
        kind = "" if handle is True else handle
        grip(d, name, behind + plate * out, out, along, min(0.35 * float(size @ along), 0.2), kind)
    d.slide(name, parent, out, travel * deep)


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
        d.part(name, box(a, [b[0], b[1], a[2] + 0.5 * wall]), look="metal")
    elif kind == "tray":
        d.part(name, box(a, b), look="metal")
        d.cut(name, box(a + wall * (X + Y) + 0.4 * wall * Z, b - wall * (X + Y) + size[2] * Z))
    else:
        wire = 0.25 * wall
        levels = [a[2] + wire] if kind == "wires" else [a[2] + wire, b[2] - wire]
        for z in levels:
            for y in (a[1] + wire, b[1] - wire):
                d.part(name, d.cylinder(wire, (a[0], y, z), (b[0], y, z)), look="metal")
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


def add_drawer(
    b: ObjectBuilder, name: str, parent: str, opening: Bay, *, handle: str = "none", opened: float = 0.0
) -> None:
    """Add a drawer that runs in the room behind an opening and comes out along -y.

    Strips along both sides of the room, above its rim, keep it from lifting and tipping when it is out.

    Args:
        b: Where it is added.
        name: Of the drawer.
        parent: What holds it.
        opening: What it covers.
        handle: Of a kind of `grip`.
        opened: Share of the way that it stands open.
    """
    edge, clearance = 0.5 * opening.wall, b.style.gap
    lower = opening.left + edge, 0.0, opening.bottom + edge
    upper = opening.right - edge, opening.depth - opening.wall, opening.top - edge
    lap = edge - 0.5 * (clearance + _REVEAL)
    with b.fitted(opened) as d:
        drawer(d, name, parent, lower, upper, travel=0.8, lap=lap, front=opening.wall, rim=_RIM, handle=handle)
    rim = lower[2] + _RIM * (upper[2] - lower[2]) + clearance
    reach = edge + clearance + min(0.012, 0.06 * min(opening.width, opening.height))
    for low, high in (
        (opening.left + 0.5 * edge, opening.left + reach),
        (opening.right - reach, opening.right - 0.5 * edge),
    ):
        b.part(parent, box((low, 0.0, rim), (high, upper[1] + 0.5 * edge, opening.top - 0.5 * edge)))


def add_door(
    b: ObjectBuilder,
    name: str,
    parent: str,
    opening: Bay,
    *,
    side: str,
    hinge: str = "edge",
    handle: str = "none",
    opened: float = 0.0,
) -> None:
    """Add what closes an opening and turns outwards about a line at one side of it.

    Args:
        b: Where it is added.
        name: Of the door.
        parent: What carries it; a barrel hinge leaves its other half there.
        opening: What it covers.
        side: ``left`` or ``right``, or ``bottom`` of what falls open.
        hinge: ``edge`` (nothing to be seen) or ``barrel``, beside which nothing may be.
        handle: Of a kind of `grip`.
        opened: Share of the way that it stands open.
    """
    edge, reach = {"left": (-X, 1.8), "right": (X, 1.8), "bottom": (-Z, 0.5 * np.pi)}[side]
    less = 0.5 * _REVEAL
    lower = opening.left + less, -opening.wall, opening.bottom + less
    with b.fitted(opened) as d:
        leaf(
            d, name, parent, lower, (opening.right - less, 0.0, opening.top - less), hinge=edge, reach=reach,
            handle=handle, barrels=2 if hinge == "barrel" else 0,
        )  # fmt: skip
