"""Bodies that mechanisms are placed on: what stands still, and which of its sides may carry something."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.generate.composer.side import side_of
from kinematify.generate.procedural.parameter import phrases
from kinematify.generate.procedural.pieces.fronts import Opening
from kinematify.generate.procedural.solids import box, cylinder, rounded_box

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

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
    material: str = "steel"
    always: Mapping[str, int] = field(default_factory=dict)
    """First word of a mechanism without which it would not be called so -> how many, if nothing else is said."""
    usual: Mapping[str, int] = field(default_factory=dict)
    """The same of what it has if nothing at all is asked for."""


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
    doorway = Opening(left=-0.2 * depth, right=0.2 * depth, bottom=sill, top=rail, depth=0.4 * width, wall=wall)
    return {side: _flank(side, size, doorway, low, 0.5 * (front + back)) for side in ("left", "right")}


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
    return side_of(name, (sign * 0.5 * width, middle, 0), doorway, axles=along)


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
        "top": side_of("top", (0, start, height), _area(post, 0.0, post, 0.2 * height, 0.002), hollow=False),
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


BODIES = (
    Body(
        words=phrases("cabinet, cupboard, locker, sideboard, kiosk, shoe cabinet, display cabinet"),
        size=(0.7, 0.45, 0.9),
        build=_block,
        material="wood",
    ),
    Body(
        words=phrases("control box, console, housing, machine housing, lab box, instrument box"),
        size=(0.4, 0.22, 0.3),
        build=_block,
    ),
    Body(words=phrases("wardrobe, armoire, closet"), size=(1.2, 0.6, 2.0), build=_block, material="wood"),
    Body(
        words=phrases("tv stand, tv unit, tv bench, tv lowboard, lowboard"),
        size=(1.5, 0.4, 0.5),
        build=_block,
        material="wood",
    ),
    Body(
        words=phrases("vending machine, ticket machine"),
        size=(0.9, 0.8, 1.8),
        build=_block,
        usual={"door": 1, "button": 6, "flap": 1},
        material="metal",
    ),
    Body(words=phrases("printer, copier"), size=(0.5, 0.45, 0.35), build=_block, usual={"lid": 1, "tray": 1}),
    Body(
        words=phrases("mobile robot, mobile base, robot base"),
        size=(0.45, 0.45, 0.25),
        build=_block,
        usual={"wheel": 2, "caster": 1},
    ),
    Body(
        words=phrases("cart, trolley, tool cart, tool trolley, utility cart, serving cart"),
        size=(0.75, 0.45, 0.7),
        build=_block,
        usual={"caster": 4, "push handle": 1},
    ),
    Body(words=phrases("platform, dolly, base plate"), size=(0.8, 0.5, 0.1), build=_block),
    Body(
        words=phrases("crate, tub, toolbox, tool box, bin, wheelie bin, container, chest"),
        size=(0.55, 0.35, 0.32),
        build=_tub,
        material="plastic",
    ),
    Body(words=phrases("table, desk, workbench, counter"), size=(1.2, 0.6, 0.75), build=_table, material="wood"),
    Body(
        words=phrases("folding table, camping table, trestle table, table top"),
        size=(1.5, 0.7, 0.72),
        build=_top,
        material="wood",
        always={"leg": 4},
    ),
    Body(
        words=phrases("scissor lift, lift table, scissor table, scissor lift platform, lifting table"),
        size=(0.9, 0.5, 0.15),
        build=_block,
        always={"lifting platform": 1},
    ),
    Body(
        words=phrases("refrigerator, fridge"), size=(0.6, 0.6, 1.8), build=_block, usual={"door": 2}, material="metal"
    ),
    Body(words=phrases("filing cabinet, file cabinet"), size=(0.45, 0.6, 1.1), build=_block),
    Body(words=phrases("tool chest, rolling tool chest, tool cabinet"), size=(0.7, 0.45, 0.9), build=_block),
    Body(words=phrases("electrical panel, fuse box, breaker box, switch cabinet"), size=(0.5, 0.2, 0.7), build=_block),
    Body(words=phrases("barn, shed, garden shed, hut"), size=(3.0, 4.0, 2.6), build=_block, material="wood"),
    Body(words=phrases("dresser, drawer unit"), size=(0.9, 0.45, 0.9), build=_block, material="wood"),
    Body(
        words=phrases("pickup truck, pickup, truck, lorry, toy truck"),
        size=(1.8, 4.6, 1.75),
        build=_truck,
        material="plastic",
        always={"wheel": 4},
        usual={"door": 2, "flap": 1},
    ),
    Body(words=phrases("car, toy car"), size=(0.8, 1.8, 0.6), build=_car, always={"wheel": 4}),
    Body(words=phrases("drum, barrel, tank"), size=(0.5, 0.5, 0.7), build=_drum),
    Body(words=phrases("column, post, pedestal, stand"), size=(0.36, 0.36, 1.0), build=_column),
    Body(words=phrases("control panel, panel, board"), size=(0.6, 0.2, 0.45), build=_panel),
    Body(words=phrases("frame, portal, doorway"), size=(1.0, 0.12, 2.1), build=_frame, material="wood"),
)
"""All bodies; no word stands twice."""
