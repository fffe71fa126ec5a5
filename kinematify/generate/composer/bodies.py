"""Bodies that mechanisms are placed on: what stands still, and which of its sides may carry something."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from kinematify.generate.composer.side import side_of
from kinematify.generate.procedural.parameter import phrases
from kinematify.generate.procedural.pieces.fronts import Opening
from kinematify.generate.procedural.solids import ball, box, cylinder, hull, ring, rounded_box

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from manifold3d import Manifold

    from kinematify.generate.composer.side import Side
    from kinematify.generate.procedural.workshop import Workshop

BODY = "body"
"""Name of the base link."""
Size = tuple[float, float, float]
"""Width, depth and height [m]."""


@dataclass(frozen=True, kw_only=True)
class Body:
    """A kind of body."""

    words: tuple[str, ...]
    """How people call it, singular; the first one names the category."""
    size: Size
    """If none is asked for."""
    build: Callable[[Workshop, Size, float], dict[str, Side]]
    """Adds the base link of a size with walls of a thickness [m] and returns its sides by name."""
    roomy: Callable[[Workshop, Size, float], dict[str, Side]] | None = None
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


def _area(width: float, bottom: float, top: float, depth: float, wall: float) -> Opening:
    """The middle of a rectangle, without a rim as wide as the wall is thick."""
    half = 0.5 * width - wall
    return Opening(left=-half, right=half, bottom=bottom + wall, top=top - wall, depth=depth, wall=wall)


def _block(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A closed body; rooms are cut where something closes them."""
    width, depth, height = size
    foot = min(0.3 * height, 0.04)  # solid, for what is screwed in from below
    workshop.body(BODY, rounded_box((-0.5 * width, 0, 0), (0.5 * width, depth, height), 0.8 * wall))
    low = Opening(left=-0.4 * depth, right=0.4 * depth, bottom=0.0, top=foot, depth=foot, wall=wall)
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


def _tub(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _coffer(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A box that is open at the top, above a closed lower half that may hold drawers."""
    width, depth, height = size
    sides = _block(workshop, size, wall)
    floor = 0.55 * height
    workshop.cut(BODY, box((wall - 0.5 * width, wall, floor), (0.5 * width - wall, depth - wall, height + wall)))
    front = _area(width, min(0.3 * height, 0.04), floor, depth, wall)
    sides["front"] = side_of("front", (0, 0, 0), front)
    sides["top"] = side_of("top", (0, 0, height), sides["top"].area, is_open=True)
    return sides


def _wagon(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A bed with walls, open at the back, and a drawbar."""
    width, depth, height = size
    sides = _block(workshop, size, wall)
    floor = 0.4 * height
    workshop.cut(BODY, box((wall - 0.5 * width, wall, floor), (0.5 * width - wall, depth + wall, height + wall)))
    bar = 0.03 * depth
    workshop.add(BODY, box((-bar, -0.35 * depth, 0.1 * height), (bar, 1e-3, 0.1 * height + 1.5 * bar)))
    gate = Opening(left=-0.5 * width, right=0.5 * width, bottom=floor, top=height, depth=wall, wall=wall)
    sides["back"] = side_of("back", (0, depth, 0), gate, is_open=True)
    return {name: sides[name] for name in ("left", "right", "back")}


def _slab(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """Something flat that lies there, with its controls on top."""
    width, depth, height = size
    workshop.body(BODY, rounded_box((-0.5 * width, 0, 0), (0.5 * width, depth, height), 0.1 * min(width, depth)))
    rim = 0.06 * min(width, depth)
    return {"top": side_of("top", (0, 0, height), _area(width, 0.0, depth, 0.8 * height, rim), hollow=False)}


def _van(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A van that looks along -y: doors for those in front, and a hold with doors behind."""
    sides, (width, depth, height) = _bus(workshop, size, wall), size
    doorway = Opening(
        left=-0.09 * depth, right=0.09 * depth, bottom=0.2 * height, top=0.9 * height, depth=0.4 * width, wall=wall
    )
    low = _low(size)
    behind = _area(width, 0.18 * height, 0.95 * height, 0.4 * depth, wall)
    flanks = {name: _flank(name, size, doorway, low, 0.32 * depth) for name in ("left", "right")}
    return {**sides, **flanks, "back": side_of("back", (0, depth, 0), behind)}


def _bus(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A bus that looks along -y: windows all around, and doors on its right."""
    width, depth, height = size
    half, sill = 0.5 * width, 0.15 * height
    workshop.body(BODY, box((-half, 0, sill), (half, depth, height)))
    panes = [box((-0.85 * half, -2e-3, 0.55 * height), (0.85 * half, 1e-3, 0.9 * height))]
    workshop.add(BODY, *workshop.painted(*panes, material="plastic", color="dark grey"))
    doorway = Opening(
        left=-0.1 * depth, right=0.1 * depth, bottom=0.2 * height, top=0.92 * height, depth=0.3 * width, wall=wall
    )
    flank = side_of("left", (-half, 0.5 * depth, 0), _area(depth, 0.5 * height, height, 0.1, wall), axles=_low(size))
    right = replace(_flank("right", size, doorway, _low(size), 0.3 * depth), ahead=0.0)  # its doors are short
    roof = side_of("top", (0, 0.15 * depth, height), _area(width, 0.0, 0.8 * depth, 0.1, wall), hollow=False)
    return {"left": replace(flank, hollow=False), "right": right, "top": roof}


def _low(size: Size) -> Opening:
    """Where the wheels of a bus or a van stand, from the middle of its side."""
    width, depth, height = size
    along = 0.38 * depth
    return Opening(left=-along, right=along, bottom=0.1 * height, top=0.18 * height, depth=0.2 * width, wall=0.05)


def _stool(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _trestle(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _pot(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A round vessel with two ears, open at the top."""
    width, _, height = size
    sides = _vessel(workshop, size)
    for x in (-0.5 * width, 0.5 * width):
        ear = ring(0.12 * width, 0.006).translate((x, 0.5 * width, 0.75 * height))
        workshop.add(BODY, ear - cylinder(0.47 * width, (0, 0.5 * width, 0), (0, 0.5 * width, height)))
    return sides


def _kettle(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _vessel(workshop: Workshop, size: Size) -> dict[str, Side]:
    width, _, height = size
    radius, middle, thick = 0.5 * width, 0.5 * width, 0.04 * width
    workshop.body(BODY, cylinder(radius, (0, middle, 0), (0, middle, height)))
    workshop.cut(BODY, cylinder(radius - thick, (0, middle, thick), (0, middle, 2.0 * height)))
    mouth = Opening(left=-radius, right=radius, bottom=-radius, top=radius, depth=thick, wall=thick)
    return {"top": side_of("top", (0, middle, height), mouth, is_open=True, end="round mouth")}


def _turbine(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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
    area = Opening(left=-reach, right=reach, bottom=height - reach, top=height + reach, depth=depth, wall=half)
    return {"front": side_of("front", (0, 0, 0), area, hollow=False)}


def _table(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _top(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A board at its height, which stands on what is folded out below it."""
    width, depth, height = size
    thick = max(wall, 0.025)
    workshop.body(BODY, rounded_box((-0.5 * width, 0, height - thick), (0.5 * width, depth, height), 0.04))
    return {
        "top": side_of("top", (0, 0, height), _area(width, 0.0, depth, thick, 0.5 * thick), hollow=False),
        "bottom": side_of("bottom", (0, depth, height - thick), _area(width, 0.0, depth, thick, 0.02), hollow=False),
    }


def _beside(name: str, size: Size, apron: float, wall: float) -> Side:
    width, depth, height = size
    area = _area(depth, height - apron, height, wall, wall)
    return side_of(name, ((-0.5 if name == "left" else 0.5) * width, 0.5 * depth, 0), area, hollow=False)


def _truck(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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
    doorway = Opening(
        left=-0.45 * (bed - cab),
        right=0.45 * (bed - cab),
        bottom=0.45 * height,
        top=0.94 * height,
        depth=0.42 * width,
        wall=wall,
    )
    low = Opening(left=-0.33 * depth, right=0.33 * depth, bottom=0.17 * height, top=0.27 * height, depth=0.3, wall=wall)
    gate = Opening(left=-half, right=half, bottom=0.42 * height, top=rail, depth=wall, wall=wall)
    return {
        "left": _flank("left", size, doorway, low, 0.5 * (cab + bed)),
        "right": _flank("right", size, doorway, low, 0.5 * (cab + bed)),
        "back": side_of("back", (0, depth, 0), gate, is_open=True),
        "front": side_of("front", (0, 0, 0), _area(width, sill, 0.6 * height, 0.2, wall), hollow=False),
        "hood": side_of("top", (0, 0, 0.6 * height), _area(0.9 * width, sheet, cab - sheet, 0.12 * height, wall)),
        "top": side_of("top", (0, cab, height), _area(width, 0.0, bed - cab, wall, wall), hollow=False),
    }


def _car(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A car with bonnet, cabin and boot; it looks along -y."""
    width, depth, height = size
    half, sill, rail = 0.5 * width, 0.25 * height, 0.62 * height
    front, back = 0.3 * depth, 0.78 * depth
    cabin = box((-0.9 * half, front, rail - 0.01), (0.9 * half, back, height))
    workshop.body(BODY, box((-half, 0, sill), (half, depth, rail)), cabin)
    low = Opening(left=-0.32 * depth, right=0.32 * depth, bottom=sill, top=rail, depth=0.3 * width, wall=wall)
    doorway = Opening(left=-0.18 * depth, right=0.18 * depth, bottom=sill, top=rail, depth=0.4 * width, wall=wall)
    flanks = {side: _flank(side, size, doorway, low, 0.5 * depth) for side in ("left", "right")}
    inside = 0.5 * (rail - sill)
    return {
        **flanks,
        "hood": side_of("top", (0, 0, rail), _area(0.9 * width, 0.02 * depth, front - 0.02 * depth, inside, wall)),
        "trunk": side_of("top", (0, 0, rail), _area(0.9 * width, back + 0.02 * depth, 0.98 * depth, inside, wall)),
    }


def _flank(name: str, size: Size, doorway: Opening, axles: Opening, middle: float) -> Side:
    """A side of a truck or a car, its x counted from the middle of its door."""
    width, depth, _ = size
    sign = -1.0 if name == "left" else 1.0
    shift = sign * (0.5 * depth - middle)
    along = Opening(
        left=axles.left + shift,
        right=axles.right + shift,
        bottom=axles.bottom,
        top=axles.top,
        depth=axles.depth,
        wall=axles.wall,
    )
    return replace(side_of(name, (sign * 0.5 * width, middle, 0), doorway, axles=along), ahead=-sign)


def _drum(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _column(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _panel(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
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


def _frame(workshop: Workshop, size: Size, wall: float) -> dict[str, Side]:
    """A portal: two posts, a lintel and a threshold around an opening."""
    width, depth, height = size
    bar = max(0.06, 2.0 * wall)
    outer = box((-0.5 * width, 0, 0), (0.5 * width, depth, height))
    workshop.body(BODY, outer - box((bar - 0.5 * width, -1, bar), (0.5 * width - bar, depth + 1, height - bar)))
    covered = 0.7 * bar
    area = Opening(
        left=covered - 0.5 * width,
        right=0.5 * width - covered,
        bottom=covered,
        top=height - covered,
        depth=depth,
        wall=wall,
    )
    return {"front": side_of("front", (0, 0, 0), area, is_open=True)}


def _kinds(
    build: Callable[[Workshop, Size, float], dict[str, Side]],
    rows: str,
    *,
    roomy: Callable[[Workshop, Size, float], dict[str, Side]] | None = None,
    material: str = "steel",
    always: Mapping[str, int] | None = None,
    usual: Mapping[str, int] | None = None,
    says: Mapping[str, str] | None = None,
    details: Mapping[str, int] | None = None,
    fine: float = 1.0,
) -> Iterator[Body]:
    """Bodies that are built alike, one a line: width, depth and height [m], then the words for it.

    Behind `has` stands what it usually has, a mechanism and how many, where nothing is asked for; behind `always` what
    it has whatever is asked for.
    """
    for row in rows.strip().splitlines():
        width, depth, height, *described = row.split()
        words, _, kept = " ".join(described).partition(" always ")
        words, _, had = words.partition(" has ")
        kind, _, number = (had or kept).rpartition(" ")
        yield Body(
            words=phrases(words),
            size=(float(width), float(depth), float(height)),
            build=build,
            roomy=roomy,
            material=material,
            always={kind: int(number)} if kept else always or {},
            usual={kind: int(number)} if had else usual or {},
            says=says or {},
            details=details or {},
            fine=fine,
        )


_FURNITURE = """
0.7 0.45 0.9 cabinet, cupboard, locker, sideboard, kiosk, shoe cabinet, display cabinet, shoe rack has door 2
0.9 0.45 0.8 aquarium stand, fish tank stand, media console, media cabinet, media unit, hi-fi stand, kitchen island \
    has door 2
0.6 0.4 1.2 bar cabinet, liquor cabinet, wine cabinet, curio cabinet, china cabinet, hutch, gun cabinet, linen \
    cabinet has door 2
0.5 0.2 0.6 medicine cabinet, key cabinet, first aid cabinet, wall cabinet, spice cabinet, spice rack has door 1
0.7 0.5 0.85 vanity, vanity unit, washstand, sink unit, changing table, baby changing table, island, reception desk \
    has drawer 2
0.5 0.4 0.55 night table, end table, night stand, printer stand, plant stand has drawer 1
1.2 0.6 2.0 wardrobe, armoire, closet, garderobe, linen closet has door 2
1.5 0.4 0.5 tv stand, tv unit, tv bench, tv lowboard, lowboard, entertainment center, entertainment unit, media bench \
    has drawer 2
3.0 4.0 2.6 barn, shed, garden shed, hut, cabin, garage, stable, playhouse, tiny house, house has door 2
0.6 0.5 0.7 dollhouse, doll house, rabbit hutch, chicken coop, dog house, doghouse, kennel, bird house, birdhouse \
    has door 2
0.9 0.45 0.9 dresser, drawer unit, tallboy dresser, lingerie chest, apothecary cabinet, card catalog, map cabinet \
    has drawer 3
0.9 0.9 2.1 phone booth, telephone booth, shower cabin, shower enclosure, sauna, elevator, elevator cabin, lift cabin \
    has door 1
0.8 0.3 1.8 bookshelf, book shelf, shelving unit, display shelf, wall shelf, storage shelf has door 2
0.9 0.45 0.9 buffet, storage cabinet, utility cabinet, base cabinet, sink cabinet, under sink cabinet, vanity \
    cabinet, bathroom vanity, chemical cabinet, lab cabinet, record cabinet, toy cabinet, craft cabinet has \
    door 2
0.8 0.4 1.8 larder, pantry cupboard, broom closet, broom cupboard, trophy case, trophy cabinet, showcase, display \
    case, gym locker, school locker, tool locker, parcel locker, pie safe has door 2
0.35 0.25 0.25 desk organizer, desk organiser, organizer, organiser, drawer organizer, jewelry cabinet, jewellery \
    cabinet, advent calendar, tea cabinet, sewing cabinet, puzzle box, seed box has drawer 3
2.0 2.0 2.2 greenhouse, hen house, henhouse, tree house, treehouse, tool shed, bike shed, outhouse, portable \
    toilet, cottage, log cabin, summer house, summerhouse, ticket booth, photo booth, sauna cabin, wendy house, \
    guard house, cat house has door 1
"""
_MACHINES = """
0.4 0.22 0.3 control box, console, housing, machine housing, lab box, instrument box, junction box, control unit \
    has button 6
0.5 0.2 0.7 electrical panel, fuse box, breaker box, switch cabinet, electrical cabinet, distribution board \
    has door 1
0.45 0.6 1.1 filing cabinet, file cabinet has drawer 4
0.7 0.45 0.9 tool chest, rolling tool chest, tool cabinet, rolling cabinet, tool storage cabinet has drawer 5
0.6 0.8 2.0 server rack, rack cabinet, server cabinet, network cabinet, charging station, charging cabinet has door 1
0.7 0.7 1.7 arcade machine, arcade cabinet, jukebox, slot machine, atm, cash machine, gumball machine, pinball \
    machine has button 6
0.35 0.35 1.1 water dispenser, water cooler, fuel pump, gas pump, parking meter, hand sanitizer station \
    has button 2
0.35 0.25 0.2 radio, amplifier, stereo, speaker, loudspeaker, hi-fi, receiver, oscilloscope, power supply, generator \
    has knob 2
0.3 0.35 0.4 coffee grinder, juicer, popcorn machine, ice cream maker, bread maker, air fryer, humidifier \
    has knob 1
0.15 0.05 0.2 thermostat, intercom, doorbell, alarm panel, keypad, light switch panel, timer has button 4
0.5 0.45 0.5 3d printer, incubator, autoclave, centrifuge, fume hood, glove box, kiln, air conditioner, heater \
    has door 1
0.6 0.6 0.85 drum washer, tumble dryer, dryer, clothes dryer, compactor has door 1
0.4 0.4 0.5 soda machine, soda fountain, coffee vending machine, slush machine, ice machine, ice maker, \
    dehumidifier, air purifier, space heater, fan heater, electric heater, juice dispenser, cotton candy machine, \
    foot massager has knob 2
0.5 0.5 1.5 self checkout, parking ticket machine, info kiosk, photo kiosk, charging point, ev charger, voting \
    machine, check in kiosk, claw machine has button 6
0.4 0.3 0.15 cd player, dvd player, tape recorder, cassette player, boombox, guitar amp, guitar amplifier, game \
    console, signal generator, function generator, multimeter, spectrum analyzer, hot plate, hotplate, magnetic \
    stirrer, water bath, battery charger, answering machine, laminator, fax machine has knob 2
0.5 0.5 0.6 spectrometer, lab oven, drying oven, muffle furnace, thermocycler, pcr machine, sterilizer, vacuum \
    chamber, glovebox, biosafety cabinet, laminar flow cabinet, fume cupboard, laboratory balance, lab balance, \
    analytical balance, sandblasting cabinet, dehydrator has door 1
0.5 0.6 1.6 control cabinet, switchgear, plc cabinet, evidence locker, ice box, meat locker, \
    proofing cabinet has door 1
0.5 0.35 0.5 welder, welding machine, air compressor, compressor, power unit, inverter, pc, computer, desktop \
    computer, pc tower, computer tower has button 2
"""
BODIES = (
    *_kinds(_block, _FURNITURE, material="wood"),
    *_kinds(_block, _MACHINES),
    *_kinds(
        _block,
        "0.9 0.8 1.8 vending machine, ticket machine, snack machine, drinks machine",
        usual={"door": 1, "button": 6, "flap": 1},
        material="metal",
    ),
    *_kinds(_block, "0.5 0.45 0.35 printer, copier, scanner, photocopier, laser printer", usual={"lid": 1, "tray": 1}),
    *_kinds(_block, "0.42 0.42 0.3 cash register, till, cash drawer", always={"drawer": 1}, usual={"button": 12}),
    *_kinds(
        _block,
        "0.4 0.3 0.35 mailbox, letterbox, letter box, mail box, post box, postbox, parcel box, drop box",
        always={"flap": 1},
        says={"door": "flap"},
    ),
    *_kinds(
        _block,
        """
        0.6 0.6 0.85 stove, oven, cooker, range cooker, kitchen range, gas range
        0.6 0.6 0.85 dishwasher
        0.45 0.35 0.28 toaster oven, mini oven, pizza oven
        0.8 0.6 1.0 baking oven, fireplace, wood stove, pellet stove
        0.8 0.7 0.9 electric oven, bread oven, stone oven, wood fired oven, wood burner, wood burning stove, electric \
    cooker, gas stove oven, induction stove, masonry heater
        """,
        always={"flap": 1},
        says={"oven door": "flap", "door": "flap"},
    ),
    *_kinds(
        _block,
        """
        0.6 0.6 0.85 washing machine, washer, front loader
        0.5 0.4 0.3 microwave, microwave oven
        0.4 0.4 0.5 safe, gun safe, strongbox, wall safe, hotel safe
        """,
        always={"door": 1},
    ),
    *_kinds(
        _block,
        """
        0.45 0.45 0.25 mobile robot, mobile base, robot base, delivery robot
        0.5 0.5 0.25 agv, automated guided vehicle, amr, robot car, robot platform, wheeled robot, rover, mars rover, \
    mobile platform, warehouse robot, line follower, line following robot, drive base, chassis, robot chassis, \
    delivery bot, wheeled base, robot cart, transport robot, cleaning robot
        """,
        usual={"wheel": 2, "caster": 1},
    ),
    *_kinds(
        _block,
        """
        0.75 0.45 0.7 cart, trolley, tool cart, tool trolley, utility cart, serving cart, medical cart, bar cart
        0.6 0.45 0.9 kitchen trolley, kitchen cart, hospital cart, crash cart, cleaning cart, luggage trolley
        0.75 0.45 0.8 workshop trolley, workshop cart, tool trolley cart, mechanic cart, tea trolley, tea cart, \
    drinks trolley, dessert cart, food cart, hot dog cart, ice cream cart, mail cart, book cart, library cart, av \
    cart, tv cart, projector cart, laptop cart, computer cart, instrument trolley, surgical trolley, surgical cart, \
    medicine trolley, medication cart, janitor cart, housekeeping cart, linen cart, hotel cart, airline trolley, \
    rolling cart, roll cart, craft cart, art cart, equipment cart, dish cart, drinks cart, service cart, service \
    trolley, tool wagon
        """,
        usual={"caster": 4, "push handle": 1},
    ),
    *_kinds(_block, "0.8 0.5 0.1 platform, dolly, base plate, pallet, moving dolly, plant dolly, furniture dolly"),
    *_kinds(
        _block,
        "0.22 0.8 0.05 skateboard, longboard",
        material="wood",
        always={"wheel": 4},
        details={"deck": 1, "board": 1},
    ),
    *_kinds(
        _tub,
        """
        0.55 0.35 0.32 crate, tub, toolbox, tool box, bin, wheelie bin, container, chest, trunk, treasure chest, box \
    has lid 1
        1.1 0.45 0.5 storage bench, ottoman, hope chest, blanket chest, toy box, toy chest, window seat, bench has \
    lid 1
        1.0 0.6 0.85 chest freezer, freezer chest, deep freezer, ice cream freezer, dumpster, compost bin, composter \
    has lid 1
        0.6 0.4 0.4 cooler, cool box, ice chest, esky, picnic basket, basket, laundry basket, hamper, laundry hamper \
    has lid 1
        0.25 0.15 0.1 lunch box, lunchbox, pencil case, pencil box, music box, tin, gift box, ring box, glasses case \
    has lid 1
        0.45 0.3 0.2 bread box, bread bin, briefcase, instrument case, record case, camera case, cash box, file box \
    always lid 1
        1.0 0.5 0.5 linen chest, dowry chest, blanket box, storage bin, recycling bin, recycling box, deck box, \
    cushion box, coffer, sandbox, sand box, log box, coal box, feed bin, storage chest, storage trunk, pirate chest, \
    steamer trunk always lid 1
        0.4 0.3 0.25 sewing basket, wicker basket, bait box, fishing box, ammo box, ammunition box, first aid box, \
    first aid kit, medicine box, shoe box, shoebox, hat box, packing box, moving box, shipping box, \
    shipping crate, pet carrier, transport box, flight case, equipment case, road case, tool case, drill case, vanity \
    case, beauty case, humidor, cooler box, litter box, picnic hamper, keepsake box, memory box, toy crate, tool \
    crate always lid 1
        0.9 0.35 0.15 violin case, guitar case, trumpet case, saxophone case, gun case, rifle case, keyboard case, \
    poker case, chess box always lid 1
        2.0 0.7 0.5 coffin, sarcophagus, cold frame, planter box, sleeping pod always lid 1
        0.12 0.08 0.06 pill box, snuff box, trinket box, soap box, spice box, card box, seed tin, sardine tin, \
    cigarette case, cufflink box, earbud case, charging case, contact lens case always lid 1
        """,
        roomy=_coffer,
        material="plastic",
    ),
    *_kinds(
        _coffer,
        """
        0.7 0.5 0.9 grill, barbecue, bbq, barbecue grill, smoker, fire pit has lid 1
        1.0 2.0 0.5 bed, storage bed, daybed, platform bed, captain bed
        1.4 2.0 0.5 single bed, double bed, twin bed, king bed, kids bed, child bed, children bed, guest bed, trundle \
    bed, ottoman bed, cot, crib, doll bed, toddler bed
        """,
    ),
    *_kinds(
        _coffer,
        "0.4 0.28 0.3 jewelry box, jewellery box, sewing box, tackle box, makeup box, makeup case, tea box, cigar box",
        material="wood",
    ),
    *_kinds(
        _tub,
        """
        0.5 0.75 0.5 stroller, baby stroller, pram, baby carriage, pushchair, buggy
        0.55 0.8 0.5 shopping cart, shopping trolley, laundry cart, laundry trolley, supermarket trolley, luggage cart
        """,
        always={"wheel": 4, "push handle": 1},
        says={"handlebar": "push handle", "handle": "push handle"},
        details={"basket": 1},
        material="metal",
    ),
    *_kinds(
        _wagon,
        """
        1.2 2.2 0.8 trailer, cargo trailer, flatbed trailer, car trailer, utility trailer
        0.5 0.9 0.4 wagon, toy wagon, pull wagon, pull cart, handcart, hand cart, beach wagon, garden cart
        1.0 1.6 0.7 hay wagon, hay cart, horse cart, bike trailer, bicycle trailer, dog trailer, boat trailer, farm \
    trailer, farm cart, luggage wagon, pony cart, ox cart
        """,
        always={"wheel": 4},
        details={"drawbar": 1, "bed": 1, "pull handle": 1, "handle": 1},
    ),
    *_kinds(
        _van,
        """
        1.9 4.8 2.1 van, delivery van, cargo van, transporter, ambulance, minivan, camper, camper van, motorhome
        2.3 6.5 3.0 delivery truck, moving truck, fire truck, fire engine, garbage truck, ice cream truck
        1.9 4.8 2.2 mail van, post van, police van, food truck, panel van, rv, bakery van, news van
        0.2 0.5 0.25 toy van, toy ambulance, toy fire truck
        """,
        material="plastic",
        always={"wheel": 4},
        usual={"door": 2},
        details={"window": 1, "windshield": 1, "windscreen": 1},
    ),
    *_kinds(
        _bus,
        """
        2.5 9.0 3.0 bus, school bus, coach, city bus, tour bus
        2.6 12.0 3.4 tram, streetcar, train, railway carriage, subway car, train carriage, metro car
        2.2 6.0 2.7 minibus, trolleybus, shuttle bus, airport shuttle, locomotive, tram car, cable car, monorail
        0.2 0.7 0.25 toy bus, toy train, toy tram
        """,
        material="plastic",
        always={"wheel": 4},
        usual={"door": 1},
        details={"window": 1, "windshield": 1, "windscreen": 1},
    ),
    *_kinds(
        _table,
        """
        1.2 0.6 0.75 table, desk, workbench, counter, writing desk, work table, dining table, lab bench
        1.1 0.6 0.5 coffee table, cocktail table, sofa table, tea table
        1.0 0.4 0.8 console table, hallway table, entry table, dressing table, vanity table, sewing table, potting \
    bench
        0.7 0.5 0.7 school desk, side table, card table, chess table, occasional table, picnic table
        1.6 0.8 0.75 conference table, meeting table, kitchen table, breakfast table, bistro table, poker table, pool \
    table, billiard table, ping pong table, lab table, laboratory table, operating table, massage table, \
    examination table, packing table, welding table, prep table, butcher block, train table, play table, altar, \
    laboratory bench, carpenter bench, woodworking bench, workshop bench, tool bench, work bench, garden table
        1.2 0.6 0.75 computer desk, office desk, gaming desk, student desk, drawing table, drafting table, art desk, \
    craft table, sewing desk, teacher desk, kids desk, children desk, kids table, reception table, nail table, makeup \
    table, bathroom table
        """,
        material="wood",
        details={"leg": 4, "top": 1},
    ),
    *_kinds(
        _top,
        "1.5 0.7 0.72 folding table, camping table, trestle table, table top, foldable table, fold up table",
        material="wood",
        always={"leg": 4},
    ),
    *_kinds(
        _trestle,
        """
        1.4 0.7 0.7 standing desk, sit stand desk, height adjustable desk, adjustable desk, lift desk, standing table
        0.8 0.4 0.7 overbed table, hospital table, height adjustable table, adjustable table, lectern
        """,
        always={"desktop": 1},
        details={"leg": 2, "foot": 2},
    ),
    *_kinds(
        _block,
        "0.9 0.5 0.15 scissor lift, lift table, scissor table, scissor lift platform, lifting table",
        always={"lifting platform": 1},
    ),
    *_kinds(
        _block,
        "0.6 0.6 1.8 refrigerator, fridge, freezer, wine cooler",
        always={"door": 1},
        usual={"door": 2},
        material="metal",
    ),
    *_kinds(
        _truck,
        """
        1.8 4.6 1.75 pickup truck, pickup, truck, lorry, toy truck, toy pickup, ute
        2.0 6.0 2.2 flatbed truck, flatbed, monster truck, pick up truck, toy lorry, cattle truck
        """,
        material="plastic",
        always={"wheel": 4},
        usual={"door": 2, "flap": 1},
        details={"bed": 1, "cab": 1, "headlight": 2},
    ),
    *_kinds(
        _car,
        """
        0.8 1.8 0.6 car, toy car, sedan, race car, sports car, golf cart, taxi
        1.7 4.2 1.45 convertible, coupe, hatchback, suv, jeep, racing car, police car, station wagon, limousine, \
    electric car, family car, race kart, kart, go kart, pedal car, rc car, remote control car, model car, vintage \
    car, old car, muscle car, cab, hot rod, patrol car
        """,
        always={"wheel": 4},
    ),
    *_kinds(
        _drum,
        """
        0.5 0.5 0.7 drum, barrel, tank, oil drum, rain barrel, keg, boiler, water heater, water tank
        0.6 0.6 0.9 oil barrel, wine barrel, beer keg, water barrel, gas tank, fuel tank, propane tank, gas bottle, \
    gas cylinder, fire hydrant, hydrant, pressure vessel, expansion tank, silo, water butt, fermenter, milk churn, \
    pressure tank, chemical reactor, septic tank, diving bell
        """,
    ),
    *_kinds(
        _pot,
        """
        0.26 0.26 0.18 pot, cooking pot, stock pot, stockpot, saucepan, casserole, dutch oven, pressure cooker, soup \
    pot
        0.24 0.24 0.22 rice cooker, slow cooker, ice bucket, jar, cookie jar, sugar bowl, canister, tureen, urn
        0.2 0.2 0.2 stew pot, crock pot, pasta pot, cauldron, fondue pot, bean pot, sauce pot, honey jar, jam jar, \
    storage jar, ginger jar, tea caddy, tea tin, biscuit tin, cookie tin, biscuit barrel, candy jar, mason jar, \
    coffee can, coffee canister, diaper pail, ash bucket, powder jar, sugar pot, butter dish, soup tureen, flour bin, \
    biscuit jar, pickle jar, soup kettle, trash pail, steamer pot, rice pot
        """,
        always={"round lid": 1},
        says={"lid": "round lid"},
        details={"handle": 2, "ear": 2},
        fine=0.3,
    ),
    *_kinds(
        _kettle,
        """
        0.18 0.18 0.2 kettle, tea kettle, teapot, water kettle, coffee pot, jug, pitcher, watering can, tankard
        0.12 0.12 0.2 milk jug, cream jug, creamer, coffee jug, measuring jug, beer stein, stein, beer mug, carafe, \
    thermos jug, moka pot, decanter, syrup jug, gravy boat, tea pot, oil can, water jug, milk pitcher, water pitcher, \
    beer pitcher
        """,
        always={"round lid": 1},
        says={"lid": "round lid"},
        details={"spout": 1, "handle": 1},
        fine=0.3,
    ),
    *_kinds(
        _column,
        """
        0.36 0.36 1.0 column, post, pedestal, stand, pole, floor stand, microphone stand, music stand, lamp post
        0.4 0.4 1.7 coat rack, coat stand, hat stand, coat tree, hall tree, clothes stand, totem, signpost
        0.3 0.3 1.5 street light, street lamp, flagpole, flag pole, camera stand, light stand, plinth, bollard, sign \
    post, traffic light, parking pole, clothes tree, bus stop, telephone pole, charging pole, cat scratching post, \
    scratching post, totem pole, lamp pole, maypole
        """,
    ),
    *_kinds(
        _column,
        "0.24 0.2 0.2 monitor, computer monitor, display, tv, television, flat screen tv, computer screen",
        always={"screen": 1},
        details={"stand": 1, "foot": 1},
        material="plastic",
    ),
    *_kinds(
        _stool,
        """
        0.38 0.38 0.7 bar stool, stool, barstool, swivel stool, swivel bar stool, counter stool, pub stool
        0.34 0.34 0.45 piano stool, work stool, drafting stool, lab stool, vanity stool, saddle stool
        0.36 0.36 0.6 kitchen stool, drum stool, drum throne, rotating stool, bar chair, artist stool, milking stool, \
    massage stool, doctor stool, dentist stool, shop stool, revolving stool, spinning stool, cobbler stool
        """,
        always={"seat": 1},
        details={"footrest": 1, "foot ring": 1, "post": 1, "base": 1, "foot rest": 1},
    ),
    *_kinds(
        _turbine,
        "0.1 0.1 1.2 wind turbine, windmill, wind generator, pinwheel, wind wheel",
        always={"rotor": 1},
        details={"tower": 1, "mast": 1, "nacelle": 1},
    ),
    *_kinds(
        _panel,
        """
        0.6 0.2 0.45 control panel, panel, board, switchboard, dashboard, instrument panel, pegboard, busy board
        0.8 0.2 0.4 wall panel, coat hook rack, key rack, wall rack, hook rail, key holder, coat hook board has hook 4
        0.9 0.2 0.6 light switch panel board, instrument board, activity board, fuse panel, tool board, cockpit \
    panel, operator panel, display board, notice board, sensory board, alarm board, game board
        """,
    ),
    *_kinds(
        _slab,
        """
        0.05 0.18 0.02 remote, remote control, tv remote, garage door opener, walkie talkie
        0.08 0.15 0.015 calculator, phone, mobile phone, cell phone, telephone, smartphone, pager, pocket calculator
        0.36 0.13 0.02 keyboard, computer keyboard, piano keyboard, synthesizer, label maker
        0.16 0.1 0.03 game controller, gamepad, joystick controller, video game controller
        0.4 0.3 0.06 mixing desk, mixer console, sound mixer, mixing console, dj controller, drum machine, effects \
    pedal
        0.15 0.1 0.02 stopwatch, mp3 player, music player, walkman, handheld console, handheld game console, game \
    boy, numpad, numeric keypad, key fob, midi keyboard, midi controller, launchpad, digital piano, electric piano, \
    toy piano, electronic keyboard, card reader, card terminal, pos terminal, payment terminal, baby monitor, gps \
    device, pocket radio, arcade stick, fight stick, tv controller, universal remote, graphing calculator, stage \
    piano
        """,
        material="plastic",
        usual={"button": 12},
        fine=0.3,
    ),
    *_kinds(
        _frame,
        "2.6 0.15 2.2 garage door, roller shutter door, overhead garage door, roll up garage door",
        always={"sash": 1},
        says={"door": "sash"},
    ),
    *_kinds(
        _frame,
        """
        1.0 0.12 2.1 frame, portal, doorway, door frame, archway, gateway, serving hatch has door 1
        1.0 0.12 2.1 doorframe, wall opening, arch, portal frame, gate frame, shop front, shopfront, barn front, \
    stable front
        """,
        material="wood",
    ),
)
"""All bodies; no word stands twice."""
