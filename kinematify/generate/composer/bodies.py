"""Bodies that mechanisms are placed on: what stands still, and which of its sides may carry something."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.generate.composer.side import side_of
from kinematify.generate.procedural.parameter import phrases, read_table
from kinematify.generate.procedural.pieces.fronts import Bay
from kinematify.generate.procedural.solids import ball, box, cylinder, hull, ring, rounded_box

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from manifold3d import Manifold

    from kinematify.generate.composer.side import BodySide
    from kinematify.generate.procedural.workshop import Workshop

BODY = "body"
"""Name of the base link."""
Size = tuple[float, float, float]
"""Width, depth and height [m]."""


@dataclass(frozen=True, kw_only=True)
class BodyKind:
    """A kind of body."""

    words: tuple[str, ...]
    """How people call it, singular; the first one names the category."""
    size: Size
    """If none is asked for."""
    build: Callable[[Workshop, Size, float], dict[str, BodySide]]
    """Adds the base link of a size with walls of a thickness [m] and returns its sides by name."""
    roomy: Callable[[Workshop, Size, float], dict[str, BodySide]] | None = None
    """The same of one that has room for more kinds of mechanisms, where the usual one has none."""
    material: str = "steel"
    always: Mapping[str, int] = field(default_factory=dict)
    """First word of a mechanism without which it would not be called so -> how many, if nothing else is said."""
    usual: Mapping[str, int] = field(default_factory=dict)
    """The same of what it has if nothing at all is asked for."""
    says: Mapping[str, str] = field(default_factory=dict)
    """Word -> first word of the mechanism that it means on this body: the door of an oven is a flap."""
    details: Mapping[str, int] = field(default_factory=dict)
    """Word for what belongs to the body itself -> how many of it there are."""
    fine: float = 1.0
    """Room that mechanisms need here, as a share of what they need elsewhere."""


def _area(width: float, bottom: float, top: float, depth: float, wall: float) -> Bay:
    """The middle of a rectangle, without a rim as wide as the wall is thick."""
    half = 0.5 * width - wall
    return Bay(left=-half, right=half, bottom=bottom + wall, top=top - wall, depth=depth, wall=wall)


def _block(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A closed body; rooms are cut where something closes them."""
    width, depth, height = size
    foot = min(0.3 * height, 0.04)  # solid, for what is screwed in from below
    workshop.body(BODY, rounded_box((-0.5 * width, 0, 0), (0.5 * width, depth, height), 0.8 * wall))
    low = Bay(left=-0.4 * depth, right=0.4 * depth, bottom=0.0, top=foot, depth=foot, wall=wall)
    upright, flat = _area(width, foot, height, depth, wall), _area(width, 0.0, depth, height, wall)
    beside = _area(depth, foot, height, min(0.4 * width, wall), wall)
    return {
        "front": side_of("front", (0, 0, 0), upright),
        "back": side_of("back", (0, depth, 0), _area(width, foot, height, wall, wall), hollow=False),
        "left": side_of("left", (-0.5 * width, 0.5 * depth, 0), beside, hollow=False, axles=low),
        "right": side_of("right", (0.5 * width, 0.5 * depth, 0), beside, hollow=False, axles=low),
        "top": side_of("top", (0, 0, height), flat),
        "bottom": side_of("bottom", (0, depth, 0), _area(width, 0.0, depth, foot, 0.01), hollow=False),
    }


def _tub(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A box that is open at the top."""
    width, depth, height = size
    sides = _block(workshop, size, wall)
    floor = max(wall, min(0.3 * height, 0.04))
    inside = (0.5 * width - wall, depth - wall, height + wall)
    workshop.cut(BODY, box((-inside[0], wall, floor), inside))
    shallow = _area(width, floor, height, wall, wall)
    sides["front"] = side_of("front", (0, 0, 0), shallow, hollow=False)
    sides["top"] = side_of("top", (0, 0, height), sides["top"].area, is_open=True)
    return sides


def _coffer(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A box that is open at the top, above a closed lower half that may hold drawers."""
    width, depth, height = size
    sides = _block(workshop, size, wall)
    floor = 0.55 * height
    workshop.cut(BODY, box((wall - 0.5 * width, wall, floor), (0.5 * width - wall, depth - wall, height + wall)))
    front = _area(width, min(0.3 * height, 0.04), floor, depth, wall)
    sides["front"] = side_of("front", (0, 0, 0), front)
    sides["top"] = side_of("top", (0, 0, height), sides["top"].area, is_open=True)
    return sides


def _wagon(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A bed with walls, open at the back, and a drawbar."""
    width, depth, height = size
    sides = _block(workshop, size, wall)
    floor = 0.4 * height
    workshop.cut(BODY, box((wall - 0.5 * width, wall, floor), (0.5 * width - wall, depth + wall, height + wall)))
    bar = 0.03 * depth
    workshop.add(BODY, box((-bar, -0.35 * depth, 0.1 * height), (bar, 1e-3, 0.1 * height + 1.5 * bar)))
    gate = Bay(left=-0.5 * width, right=0.5 * width, bottom=floor, top=height, depth=wall, wall=wall)
    sides["back"] = side_of("back", (0, depth, 0), gate, is_open=True)
    return {name: sides[name] for name in ("left", "right", "back")}


def _slab(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """Something flat that lies there, with its controls on top."""
    width, depth, height = size
    workshop.body(BODY, rounded_box((-0.5 * width, 0, 0), (0.5 * width, depth, height), 0.1 * min(width, depth)))
    rim = 0.06 * min(width, depth)
    return {"top": side_of("top", (0, 0, height), _area(width, 0.0, depth, 0.8 * height, rim), hollow=False)}


def _van(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A van that looks along -y: doors for those in front, and a hold with doors behind."""
    sides, (width, depth, height) = _bus(workshop, size, wall), size
    doorway = Bay(
        left=-0.09 * depth, right=0.09 * depth, bottom=0.2 * height, top=0.9 * height, depth=0.4 * width, wall=wall
    )
    low = _low(size)
    behind = _area(width, 0.18 * height, 0.95 * height, 0.4 * depth, wall)
    flanks = {name: _flank(name, size, doorway, low, 0.32 * depth) for name in ("left", "right")}
    return {**sides, **flanks, "back": side_of("back", (0, depth, 0), behind)}


def _bus(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A bus that looks along -y: windows all around, and doors on its right."""
    width, depth, height = size
    half, sill = 0.5 * width, 0.15 * height
    workshop.body(BODY, box((-half, 0, sill), (half, depth, height)))
    panes = [box((-0.85 * half, -2e-3, 0.55 * height), (0.85 * half, 1e-3, 0.9 * height))]
    workshop.add(BODY, *workshop.painted(*panes, material="plastic", color="dark grey"))
    doorway = Bay(
        left=-0.1 * depth, right=0.1 * depth, bottom=0.2 * height, top=0.92 * height, depth=0.3 * width, wall=wall
    )
    flank = side_of("left", (-half, 0.5 * depth, 0), _area(depth, 0.5 * height, height, 0.1, wall), axles=_low(size))
    right = replace(_flank("right", size, doorway, _low(size), 0.3 * depth), ahead=0.0)  # its doors are short
    roof = side_of("top", (0, 0.15 * depth, height), _area(width, 0.0, 0.8 * depth, 0.1, wall), hollow=False)
    return {"left": replace(flank, hollow=False), "right": right, "top": roof}


def _low(size: Size) -> Bay:
    """Where the wheels of a bus or a van stand, from the middle of its side."""
    width, depth, height = size
    along = 0.38 * depth
    return Bay(left=-along, right=along, bottom=0.1 * height, top=0.18 * height, depth=0.2 * width, wall=0.05)


def _stool(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A post on a round foot, with a ring for the feet."""
    width, _, height = size
    radius, post, middle = 0.5 * width, 0.07 * width, 0.5 * width
    ring_at = (0, middle, 0.4 * height)
    workshop.body(
        BODY,
        cylinder(radius, (0, middle, 0), (0, middle, 0.03)),
        cylinder(post, (0, middle, 0.02), (0, middle, height)),
        ring(0.7 * radius, 0.01).translate(ring_at),
        box((-0.7 * radius, middle - 0.008, ring_at[2] - 0.008), (0.7 * radius, middle + 0.008, ring_at[2] + 0.008)),
        material="metal",
    )
    square = 1.4 * post
    area = _area(square, -0.5 * square, 0.5 * square, 0.1, 1e-3)
    return {"top": side_of("top", (0, middle, height), area, hollow=False, end="post")}


def _trestle(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """Two hollow legs on feet, for a top that goes up and down in them."""
    width, depth, height = size
    leg = 0.035
    solids = []
    for x in (-0.35 * width, 0.35 * width):
        solids += [box((x - 0.04, 0, 0), (x + 0.04, depth, 0.04)), _upright(x, depth, 0.0, height, leg)]
    beam = box(
        (-0.35 * width, 0.5 * depth - 0.02, 0.3 * height), (0.35 * width, 0.5 * depth + 0.02, 0.3 * height + 0.06)
    )
    workshop.body(BODY, *solids, beam, material="metal")
    return {
        "top": side_of("top", (0, 0, height), _area(width, 0.0, depth, 0.7 * height, 1e-3), hollow=False, end="legs")
    }


def _upright(x: float, depth: float, bottom: float, top: float, half: float) -> Manifold:
    return box((x - half, 0.5 * depth - half, bottom), (x + half, 0.5 * depth + half, top))


def _pot(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A round vessel with two ears, open at the top."""
    width, _, height = size
    sides = _vessel(workshop, size)
    for x in (-0.5 * width, 0.5 * width):
        ear = ring(0.12 * width, 0.006).translate((x, 0.5 * width, 0.75 * height))
        workshop.add(BODY, ear - cylinder(0.47 * width, (0, 0.5 * width, 0), (0, 0.5 * width, height)))
    return sides


def _kettle(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A round vessel with a spout on the left and a handle on the right."""
    width, _, height = size
    radius, middle = 0.5 * width, 0.5 * width
    sides = _vessel(workshop, size)
    inside = cylinder(0.94 * radius, (0, middle, 0), (0, middle, 2.0 * height))
    spout = hull(
        ball(0.2 * radius, (-0.9 * radius, middle, 0.45 * height)),
        ball(0.09 * radius, (-1.5 * radius, middle, 0.85 * height)),
    )
    grip = (
        ring(0.35 * height, 0.05 * height, 180.0).rotate((90, 90, 0)).translate((0.97 * radius, middle, 0.5 * height))
    )
    workshop.add(BODY, spout - inside, *workshop.as_handle(grip - inside))
    return sides


def _vessel(workshop: Workshop, size: Size) -> dict[str, BodySide]:
    width, _, height = size
    radius, middle, thick = 0.5 * width, 0.5 * width, 0.04 * width
    workshop.body(BODY, cylinder(radius, (0, middle, 0), (0, middle, height)))
    workshop.cut(BODY, cylinder(radius - thick, (0, middle, thick), (0, middle, 2.0 * height)))
    mouth = Bay(left=-radius, right=radius, bottom=-radius, top=radius, depth=thick, wall=thick)
    return {"top": side_of("top", (0, middle, height), mouth, is_open=True, end="round mouth")}


def _turbine(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A tall mast with a nacelle; what turns before it is larger than it is."""
    width, depth, height = size
    long, half = 2.0 * width, 0.5 * width
    workshop.body(
        BODY,
        cylinder(width, (0, depth, 0), (0, depth, 0.04 * height)),
        cylinder(0.4 * width, (0, depth, 0), (0, depth, height)),
        box((-half, 0, height - half), (half, depth + long, height + half)),
    )
    reach = 0.4 * height
    area = Bay(left=-reach, right=reach, bottom=height - reach, top=height + reach, depth=depth, wall=half)
    return {"front": side_of("front", (0, 0, 0), area, hollow=False)}


def _table(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A board on four legs with an apron that may hold drawers."""
    width, depth, height = size
    leg, apron = max(0.05, wall), 0.28 * height
    legs = [
        rounded_box((x, y, 0), (x + leg, y + leg, height), 0.5 * wall)
        for x in (-0.5 * width, 0.5 * width - leg)
        for y in (0.0, depth - leg)
    ]
    top = rounded_box((-0.5 * width, 0, height - apron), (0.5 * width, depth, height), 0.5 * wall)
    workshop.body(BODY, top, *legs)
    return {
        "front": side_of("front", (0, 0, 0), _area(width - 2 * leg, height - apron, height, depth, wall)),
        "top": side_of("top", (0, 0, height), _area(width, 0.0, depth, 2 * wall, wall), hollow=False),
        "left": _beside("left", size, apron, wall),
        "right": _beside("right", size, apron, wall),
        "bottom": side_of("bottom", (0, depth, 0), _area(width, 0.0, depth, height, 0.5 * leg - 0.02), hollow=False),
    }


def _top(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A board at its height, which stands on what is folded out below it."""
    width, depth, height = size
    thick = max(wall, 0.025)
    workshop.body(BODY, rounded_box((-0.5 * width, 0, height - thick), (0.5 * width, depth, height), 0.04))
    return {
        "top": side_of("top", (0, 0, height), _area(width, 0.0, depth, thick, 0.5 * thick), hollow=False),
        "bottom": side_of("bottom", (0, depth, height - thick), _area(width, 0.0, depth, thick, 0.02), hollow=False),
    }


def _beside(name: str, size: Size, apron: float, wall: float) -> BodySide:
    width, depth, height = size
    area = _area(depth, height - apron, height, wall, wall)
    return side_of(name, ((-0.5 if name == "left" else 0.5) * width, 0.5 * depth, 0), area, hollow=False)


def _truck(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A pickup: bonnet, cab and an open bed; it looks along -y."""
    width, depth, height = size
    half, sill, rail = 0.5 * width, 0.14 * height, 0.66 * height
    cab, bed = 0.26 * depth, 0.58 * depth
    frame = box((-half, 0, sill), (half, depth, 0.42 * height))
    bonnet = box((-half, 0, sill), (half, cab + 0.01, 0.6 * height))
    cabin = box((-half, cab, sill), (half, bed, height))
    board = 0.035 * width
    walls = [box((x, bed - 0.01, sill), (x + board, depth, rail)) for x in (-half, half - board)]
    workshop.body(BODY, frame, bonnet, cabin, *walls)
    rail_wide, sheet, deck = 0.2 * width, 0.06 * width, 0.42 * height
    workshop.cut(
        BODY,
        box((rail_wide - half, rail_wide, 0), (half - rail_wide, depth - rail_wide, deck - sheet)),
        box((rail_wide - half, rail_wide, 0), (half - rail_wide, bed - sheet, deck + 1e-3)),
        box((sheet - half, sheet, deck), (half - sheet, cab - sheet, 0.6 * height - sheet)),
        box((sheet - half, cab + sheet, deck), (half - sheet, bed - sheet, height - sheet)),
    )
    workshop.add(
        BODY,
        *workshop.painted(
            box((-0.85 * half, cab - 4e-3, 0.66 * height), (0.85 * half, cab + 1e-3, 0.94 * height)),
            box((-0.8 * half, bed - 1e-3, 0.7 * height), (0.8 * half, bed + 4e-3, 0.92 * height)),
            material="plastic",
            color="dark grey",
        ),
        *workshop.painted(
            *(
                cylinder(0.05 * height, (x, 1e-3, 0.5 * height), (x, -0.01, 0.5 * height))
                for x in (-0.7 * half, 0.7 * half)
            ),
            material="ceramic",
        ),
    )
    doorway = Bay(
        left=-0.45 * (bed - cab),
        right=0.45 * (bed - cab),
        bottom=0.45 * height,
        top=0.94 * height,
        depth=0.42 * width,
        wall=wall,
    )
    low = Bay(left=-0.33 * depth, right=0.33 * depth, bottom=0.17 * height, top=0.27 * height, depth=0.3, wall=wall)
    gate = Bay(left=-half, right=half, bottom=0.42 * height, top=rail, depth=wall, wall=wall)
    return {
        "left": _flank("left", size, doorway, low, 0.5 * (cab + bed)),
        "right": _flank("right", size, doorway, low, 0.5 * (cab + bed)),
        "back": side_of("back", (0, depth, 0), gate, is_open=True),
        "front": side_of("front", (0, 0, 0), _area(width, sill, 0.6 * height, 0.2, wall), hollow=False),
        "hood": side_of("top", (0, 0, 0.6 * height), _area(0.9 * width, sheet, cab - sheet, 0.12 * height, wall)),
        "top": side_of("top", (0, cab, height), _area(width, 0.0, bed - cab, wall, wall), hollow=False),
    }


def _car(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A car with bonnet, cabin and boot; it looks along -y."""
    width, depth, height = size
    half, sill, rail = 0.5 * width, 0.25 * height, 0.62 * height
    front, back = 0.3 * depth, 0.78 * depth
    cabin = box((-0.9 * half, front, rail - 0.01), (0.9 * half, back, height))
    workshop.body(BODY, box((-half, 0, sill), (half, depth, rail)), cabin)
    low = Bay(left=-0.32 * depth, right=0.32 * depth, bottom=sill, top=rail, depth=0.3 * width, wall=wall)
    doorway = Bay(left=-0.18 * depth, right=0.18 * depth, bottom=sill, top=rail, depth=0.4 * width, wall=wall)
    flanks = {side: _flank(side, size, doorway, low, 0.5 * depth) for side in ("left", "right")}
    inside = 0.5 * (rail - sill)
    return {
        **flanks,
        "hood": side_of("top", (0, 0, rail), _area(0.9 * width, 0.02 * depth, front - 0.02 * depth, inside, wall)),
        "trunk": side_of("top", (0, 0, rail), _area(0.9 * width, back + 0.02 * depth, 0.98 * depth, inside, wall)),
    }


def _flank(name: str, size: Size, doorway: Bay, axles: Bay, middle: float) -> BodySide:
    """A side of a truck or a car, its x counted from the middle of its door."""
    width, depth, _ = size
    sign = -1.0 if name == "left" else 1.0
    shift = sign * (0.5 * depth - middle)
    along = Bay(
        left=axles.left + shift,
        right=axles.right + shift,
        bottom=axles.bottom,
        top=axles.top,
        depth=axles.depth,
        wall=axles.wall,
    )
    return replace(side_of(name, (sign * 0.5 * width, middle, 0), doorway, axles=along), ahead=-sign)


def _drum(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """An upright cylinder with a flat boss in front."""
    width, _, height = size
    radius = 0.5 * width
    boss = 0.3 * radius
    workshop.body(
        BODY,
        cylinder(radius, (0, radius, 0), (0, radius, height)),
        box((-0.6 * radius, -0.02, 0.3 * height), (0.6 * radius, radius, 0.7 * height)),
    )
    square = 1.35 * radius
    return {
        "front": side_of(
            "front", (0, -0.02, 0), _area(1.2 * radius, 0.3 * height, 0.7 * height, boss, 0.005), hollow=False
        ),
        "top": side_of("top", (0, radius, height), _area(square, -0.5 * square, 0.5 * square, height, wall)),
    }


def _column(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A square post on a foot."""
    width, depth, height = size
    post = 0.35 * width
    low = 0.06 * height
    workshop.body(
        BODY,
        box((-0.5 * width, 0, 0), (0.5 * width, depth, low)),
        box((-0.5 * post, 0.5 * (depth - post), 0), (0.5 * post, 0.5 * (depth + post), height)),
    )
    face, start = _area(post, 0.3 * height, height, 0.4 * post, 0.005), 0.5 * (depth - post)
    foot = min(low, 0.04)
    return {
        "front": side_of("front", (0, start, 0), face, hollow=False),
        "back": side_of("back", (0, start + post, 0), face, hollow=False),
        "left": side_of("left", (-0.5 * post, 0.5 * depth, 0), face, hollow=False),
        "right": side_of("right", (0.5 * post, 0.5 * depth, 0), face, hollow=False),
        "top": side_of(
            "top", (0, start, height), _area(post, 0.0, post, 0.2 * height, 0.002), hollow=False, end="post"
        ),
        "bottom": side_of("bottom", (0, depth, 0), _area(width, 0.0, depth, foot, 0.01), hollow=False),
    }


def _panel(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """An upright plate on two feet."""
    width, depth, height = size
    thick = max(wall, 0.024)
    feet = [box((x, -0.5 * depth, 0), (x + 0.06, 0.5 * depth, 0.03)) for x in (-0.5 * width, 0.5 * width - 0.06)]
    workshop.body(BODY, box((-0.5 * width, 0, 0), (0.5 * width, thick, height)), *feet)
    area = _area(width, 0.04, height, thick, 0.02)
    return {
        "front": side_of("front", (0, 0, 0), area, hollow=False),
        "back": side_of("back", (0, thick, 0), area, hollow=False),
    }


def _frame(workshop: Workshop, size: Size, wall: float) -> dict[str, BodySide]:
    """A portal: two posts, a lintel and a threshold around an opening."""
    width, depth, height = size
    bar = max(0.06, 2.0 * wall)
    outer = box((-0.5 * width, 0, 0), (0.5 * width, depth, height))
    workshop.body(BODY, outer - box((bar - 0.5 * width, -1, bar), (0.5 * width - bar, depth + 1, height - bar)))
    covered = 0.7 * bar
    area = Bay(
        left=covered - 0.5 * width,
        right=0.5 * width - covered,
        bottom=covered,
        top=height - covered,
        depth=depth,
        wall=wall,
    )
    return {"front": side_of("front", (0, 0, 0), area, is_open=True)}


_SHAPES = {
    build.__name__.strip("_"): build
    for build in (
        _block, _tub, _coffer, _wagon, _slab, _van, _bus, _stool, _trestle, _pot, _kettle, _turbine, _table, _top,
        _truck, _car, _drum, _column, _panel, _frame,
    )
}  # fmt: skip


def _kinds(group: Mapping[str, Any]) -> Iterator[BodyKind]:
    """Bodies that are built alike; what one kind says of itself goes before what its group says."""
    fields = {name: value for name, value in group.items() if name not in ("shape", "roomy", "kinds")}
    for kind in group["kinds"]:
        said = {**fields, **kind}
        yield BodyKind(
            **{**said, "words": phrases(said["words"]), "size": tuple(said["size"])},
            build=_SHAPES[group["shape"]],
            roomy=_SHAPES[group["roomy"]] if "roomy" in group else None,
        )


BODIES = tuple(body for group in read_table(Path(__file__).with_name("bodies.yaml")) for body in _kinds(group))
"""All bodies; no word stands twice."""
