"""Place mechanisms on a body: sides are chosen and divided, the body grows where they need more room."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.composer.bodies import BODIES, BodyKind, Size
from kinematify.generate.composer.place import Placement
from kinematify.generate.composer.placed_mechanisms import MECHANISMS, MechanismKind
from kinematify.generate.composer.side import columns, rows
from kinematify.generate.procedural.pieces.fronts import Fitting
from kinematify.generate.procedural.workshop import Workshop

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.generate.composer.side import BodySide
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.pieces.fronts import Bay

BANDS = ("grid", "row", "stack", "foot")
"""How mechanisms are arranged that divide a side, from its top."""
MOST = 60
"""Mechanisms of an object."""
_WALL = 0.018  # [m]
_LARGEST = 8.0  # of a body that grows with what is placed on it [m]
_GROWTH = 1.15  # at a time
_TURNING = 6.4  # room across two casters that face each other, in radii of their wheels
_COVERING = ("row", "stack", "over", "alone")
_NEEDS = {
    "room": "room behind it",
    "opening": "an opening to close",
    "mouth": "an open top",
    "height": "a body that is tall without it",
    "round mouth": "a round body that is open at the top",
    "post": "a post that ends there",
    "legs": "a body of two legs",
}
_ENDS = ("round mouth", "legs")  # where nothing else goes
_LOW = 0.2  # [m] below it nothing folds under a body
_MOST_KINDS = 4  # of mechanisms on an object that is drawn
_ANOTHER = 1_000_003  # the next seed where nothing that was drawn fits


@dataclass(frozen=True, kw_only=True)
class MechanismSpec:
    """One kind of mechanism on an object."""

    mechanism: MechanismKind
    said: str = ""
    """Word for it, where it is not the usual one."""
    count: int = 1
    side: str = ""
    """Of `FACING`; its usual one if empty."""
    level: int = 0
    """1: above all others on its side, -1: below them."""
    hinge: str = ""
    """``left`` or ``right``, of a door."""
    members: int = 0
    """Blades and the like of each; 0: as usual."""
    carrier: str = ""
    """What carries it, as it is called: ``each door``, ``the left door``; the body if empty."""
    material: str | None = None
    color: str | None = None

    @property
    def title(self) -> str:
        """Return what it is called, singular."""
        return self.said or self.mechanism.words[0]

    @property
    def stem(self) -> str:
        """Name of its parts without their numbers."""
        return self.title.replace(" ", "_").replace("-", "_")


@dataclass(frozen=True, kw_only=True)
class Composition:
    """An object: a body and what is placed on it."""

    body: BodyKind
    wanted: tuple[MechanismSpec, ...]
    said: str = ""
    """Word for the body, where it is not the usual one."""
    size: tuple[float | None, float | None, float | None] = (None, None, None)
    """Width, depth and height [m]; as large as is needed where None."""
    material: str | None = None
    color: str | None = None
    handles: tuple[str | None, str | None] = (None, None)
    """Material and colour of the handles of doors and drawers; metal if nothing is said."""
    rest: float = 0.0
    """Share of the way that moving parts stand open."""
    copies: int = 1
    """How many, side by side."""
    scale: float = 1.0
    """Of lengths that are not asked for, to the usual ones."""

    @property
    def title(self) -> str:
        """Return what the object is called."""
        return self.said or self.body.words[0]


def compose(
    composition: Composition,
    *,
    name: str = "",
    clearance: float = 0.001,
    seed: int | None = None,
    may_stand_still: bool = False,
) -> Blueprint:
    """Build an object with its exact joints.

    Args:
        composition: What it is.
        name: Of the object; the first word of its body if empty.
        clearance: Gap between parts that move past each other [m].
        seed: Draws lengths of the body that are not asked for, about the usual ones; none takes these.
        may_stand_still: It need not move, since something that does goes with it.

    Raises:
        InputError: Nothing moves, a side is not there or taken, or there is no room; the message names what.
    """
    if not may_stand_still and not any(wanted.mechanism.moves for wanted in composition.wanted):
        raise InputError(f"Nothing of this {composition.title} would move. Ask for a part that does, e.g. a drawer.")
    layout = _laid_out(composition, seed)
    fitting = Fitting(clearance=clearance, grip="bar", rest=composition.rest)
    numbers: Counter[str] = Counter()
    here: Counter[tuple[str, str]] = Counter()
    lids: dict[str, str] = {}
    for name_of_side, item, area in layout.placed:
        side, word = layout.sides[name_of_side], item.stem
        numbers[word] += 1
        place = Placement(
            workshop=layout.workshop.from_frame(side.T_world_side, material=item.material, color=item.color),
            name=f"{word}_{numbers[word]}",
            area=area,
            hollow=side.hollow,
            fitting=fitting,
            side=name_of_side,
            half=item.side if item.mechanism.halves else "",
            hinge=item.hinge,
            members=item.members,
            beside=item.count if item.mechanism.halves else 1,
            index=here[name_of_side, word],
        )
        here[name_of_side, word] += 1
        if item.mechanism.words[0] == "lid":
            lids[name_of_side] = place.name
        if item.mechanism.arranged == "over" and name_of_side in lids:
            place = _on_lid(place, lids[name_of_side])
        item.mechanism.build(place)
    details = {f"{word.replace(' ', '_')}s": count for word, count in composition.body.details.items()}
    placed = {f"{word}s": count for word, count in numbers.items()}
    parameters = {"seed": seed, "size": layout.size, **details, **placed}
    rng = np.random.default_rng(0)
    named = name or composition.title.replace(" ", "_")
    return layout.workshop.finish(named, parameters, style="clean", clearance=clearance, rng=rng)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Layout:
    """A body, and where everything goes on it."""

    workshop: Workshop
    """With the body alone."""
    size: Size
    sides: dict[str, BodySide]
    placed: list[tuple[str, MechanismSpec, Bay]]
    """Name of the side, what goes there, and the rectangle that it takes."""


def _laid_out(composition: Composition, seed: int | None) -> _Layout:
    """Make the body as large as what is placed on it needs."""
    if (count := sum(wanted.count for wanted in composition.wanted)) > MOST:
        raise InputError(f"{count} mechanisms are asked for; at most {MOST} can be placed on one body.")
    body = composition.body
    drawn = np.ones(3) if seed is None else np.random.default_rng(seed).uniform(0.85, 1.2, size=3)
    width, depth, height = (
        float(usual * share * composition.scale) if asked is None else asked
        for usual, share, asked in zip(body.size, drawn, composition.size, strict=True)
    )
    size: Size = (width, depth, height)
    while True:
        workshop = _workshop(composition)
        sides = body.build(workshop, size, wall := min(_WALL, 0.08 * min(size)))
        if body.roomy and not all(_has_place(item, sides) for item in composition.wanted):
            workshop = _workshop(composition)
            sides = body.roomy(workshop, size, wall)
        try:
            placed = [
                (side, item, area)
                for side, wanted in _by_side(composition, sides).items()
                for item, area in _arranged(side, sides[side], wanted, body.fine)
            ]
        except _TooSmallError as error:
            growth = [_GROWTH if k in error.axes and composition.size[k] is None else 1.0 for k in range(3)]
            size = (size[0] * growth[0], size[1] * growth[1], size[2] * growth[2])
            if max(growth) == 1.0 or max(size) > _LARGEST:
                raise InputError(f"There is no room for {error}. Ask for fewer, or for a larger body.") from None
        else:
            return _Layout(workshop=workshop, size=size, sides=sides, placed=placed)


def _workshop(composition: Composition) -> Workshop:
    return Workshop(
        composition.title.replace(" ", "_"),
        material=composition.material or composition.body.material,
        color=composition.color,
        handles=(composition.handles[0] or "metal", composition.handles[1]),
    )


def _has_place(wanted: MechanismSpec, sides: dict[str, BodySide]) -> bool:
    return any(side in sides and _fits(wanted.mechanism, sides[side]) for side in wanted.mechanism.sides)


class _TooSmallError(Exception):
    """A side has no room; `axes` of the body would have to grow."""

    def __init__(self, what: str, axes: set[int]) -> None:
        super().__init__(what)
        self.axes = axes


def draw_composition(seed: int) -> Composition:
    """Draw a body with one to four kinds of mechanism that it can carry."""
    rng = np.random.default_rng(seed)
    body = BODIES[int(rng.integers(len(BODIES)))]
    always = [kind for kind in MECHANISMS if kind.words[0] in body.always]
    wanted = [MechanismSpec(mechanism=kind, count=body.always[kind.words[0]]) for kind in always]
    for k in rng.permutation(len(MECHANISMS))[: int(rng.integers(2, 9))]:
        asked = MechanismSpec(mechanism=MECHANISMS[int(k)], count=int(rng.choice([1, 2, 2, 3, 4])))
        if asked.mechanism in always:
            continue
        try:
            _laid_out(Composition(body=body, wanted=(*wanted, asked)), None)
        except InputError:
            continue
        wanted.append(asked)
        if len(wanted) == _MOST_KINDS:
            break
    moves = any(item.mechanism.moves for item in wanted)
    return Composition(body=body, wanted=tuple(wanted)) if moves else draw_composition(seed + _ANOTHER)


def _known() -> str:
    return ", ".join(mechanism.words[0] for mechanism in MECHANISMS)


def _on_lid(place: Placement, lid: str) -> Placement:
    """The same place on the lid that covers the side."""
    level = place.clearance + place.area.wall
    return replace(place, workshop=place.workshop.turned(np.eye(3), (0, -level, 0)), parent=lid, hollow=True)


def _by_side(composition: Composition, sides: dict[str, BodySide]) -> dict[str, list[MechanismSpec]]:
    """Return what goes on which side; wheels and other pairs are divided between left and right."""
    found: dict[str, list[MechanismSpec]] = {side: [] for side in sides}
    body = composition.title
    for asked in sorted(composition.wanted, key=lambda item: item.mechanism.arranged == "grid"):
        # The front doors of a van are on its sides.
        in_front = asked.side == "front" and not any(
            side == "front" and _fits(asked.mechanism, sides[side]) for side in sides
        )
        wanted = replace(asked, side="") if in_front and asked.mechanism.words[0] == "door" else asked
        kind, usual = wanted.mechanism, _usual_sides(wanted, sides, body)
        by_pairs = kind.arranged == "axles" or (kind.words[0] == "door" and not wanted.side and usual[0] == "left")
        if by_pairs or (kind.arranged == "over" and wanted.count == 2 and {"left", "right"} <= sides.keys()):
            if wanted.count % 2:
                raise InputError(f"{wanted.count} {wanted.title}s are asked for; on a {body} they come in pairs.")
            for side in ("left", "right"):
                found[side].append(replace(wanted, count=wanted.count // 2))
        else:
            found[usual[0] if _says_half(wanted) else wanted.side or _freest(usual, found, kind)].append(wanted)
    for side, items in found.items():
        _refuse_crowded(side, items)
    return {side: items for side, items in found.items() if items}


def _usual_sides(wanted: MechanismSpec, sides: dict[str, BodySide], body: str) -> list[str]:
    """Sides of a body where a mechanism may go, the usual one first."""
    kind, what = wanted.mechanism, wanted.title
    if wanted.count < 1:
        raise InputError(f"{wanted.count} {what}s cannot be built. Ask for one at least, or leave it out.")
    usual = [side for side in kind.sides if side in sides and _fits(kind, sides[side])]
    if not usual:
        behind = f", and a {what} needs {_NEEDS[kind.needs]}" if kind.needs else ""
        raise InputError(f"There is no place for a {what} on a {body}. It has {', '.join(sides)}{behind}.")
    if wanted.count > kind.most:
        raise InputError(f"{wanted.count} {what}s are asked for; a {body} takes {kind.most}.")
    if wanted.side and kind.arranged == "axles":
        raise InputError(f"{what.capitalize()}s go on both sides of a {body}, not on the {wanted.side} alone.")
    if wanted.side and wanted.side not in usual and not _says_half(wanted):
        raise InputError(f"A {what} goes on the {' or '.join(usual)} of a {body}, not on the {wanted.side}.")
    return usual


def _says_half(wanted: MechanismSpec) -> bool:
    return wanted.mechanism.halves and wanted.side in ("left", "right")


def _refuse_crowded(side: str, items: Sequence[MechanismSpec]) -> None:
    lids = sum(item.count for item in items if item.mechanism.words[0] == "lid")
    over = next((item.mechanism.words[0] for item in items if item.mechanism.arranged == "over"), None)
    if over and lids > 1:
        raise InputError(f"A {over} goes on one lid, but there are {lids}. Ask for one lid.")
    alone = next((item.mechanism for item in items if item.mechanism.arranged in ("alone", "apart")), None)
    crowd = [item.mechanism for item in items if item.mechanism is not alone]
    if alone and any(alone.arranged == "alone" or other.arranged != "over" for other in crowd):
        others = ", ".join(other.words[0] for other in crowd)
        raise InputError(
            f"A {alone.words[0]} needs the {side} for itself, but there are also: {others}. Leave one out."
        )


def _fits(kind: MechanismKind, side: BodySide) -> bool:
    if kind.needs in ("round mouth", "legs", "post") or side.end in _ENDS:
        return kind.needs == side.end
    if kind.arranged == "axles":
        return side.axles is not None
    if kind.needs == "height":
        return bool(side.T_world_side[2, 3] > _LOW)
    if kind.needs == "mouth":
        return side.is_open
    if kind.needs:
        return side.hollow or (side.is_open and kind.needs == "opening")
    return not side.is_open or kind.arranged == "over"


def _freest(usual: Sequence[str], found: dict[str, list[MechanismSpec]], kind: MechanismKind) -> str:
    """The usual side, or for what takes little room the first one that nothing covers."""
    if kind.arranged == "grid":
        for side in usual:
            if side != "top" or not any(other.mechanism.arranged in _COVERING for other in found[side]):
                return side
    return usual[0]


def _arranged(
    name: str, side: BodySide, wanted: Sequence[MechanismSpec], fine: float
) -> list[tuple[MechanismSpec, Bay]]:
    """Every single mechanism of a side with the rectangle that it takes; what fills the side comes first."""
    placed = []
    least = {item.mechanism.words: tuple(fine * length for length in item.mechanism.least) for item in wanted}
    on_axles = [item.count for item in wanted if item.mechanism.arranged == "axles"]
    wheels = _axles(side, side.axles, sum(on_axles)) if side.axles is not None and on_axles else []
    bands = _bands([item for item in wanted if item.mechanism.arranged in BANDS])
    for band, strip in zip(bands, rows(side.area, [weight for weight, _ in bands]) if bands else [], strict=True):
        free = _beside_wheels(strip, wheels) if band[1][0].mechanism.arranged == "grid" else strip
        if free.width <= 0.0 or free.height <= 0.0:
            raise _TooSmallError(_too_small(band[1][0].mechanism, wanted, name), {1, 2})
        for item, cell in _divided(band[1], free):
            needed = least[item.mechanism.words]
            if cell.width < needed[0] or cell.height < needed[1]:
                axes = {0 if name in ("front", "back", "top", "bottom") else 1} if cell.width < needed[0] else set()
                if cell.height < needed[1]:
                    axes.add(1 if name in ("top", "bottom") else 2)
                raise _TooSmallError(_too_small(item.mechanism, wanted, name), axes)
            placed.append((item, cell))
    for item in wanted:
        if item.mechanism.arranged == "axles" and side.axles is not None:
            placed += [(item, cell) for cell in _axles(side, side.axles, item.count)]
        elif item.mechanism.arranged == "corners":
            cells = _corners(side.area, item.count)
            if cells[0].width < least[item.mechanism.words][0]:
                raise _TooSmallError(_too_small(item.mechanism, wanted, name), {0, 1})
            placed += [(item, cell) for cell in cells]
        elif item.mechanism.arranged in ("edge", "over", "alone", "apart"):
            if side.area.width < least[item.mechanism.words][0] or side.area.height < least[item.mechanism.words][1]:
                raise _TooSmallError(_too_small(item.mechanism, wanted, name), {0, 1 if name == "top" else 2})
            placed += [(item, side.area)] * item.count
    return placed


def _too_small(mechanism: MechanismKind, wanted: Sequence[MechanismSpec], side: str) -> str:
    count = sum(item.count for item in wanted if item.mechanism is mechanism)
    return f"{count} {mechanism.words[0]}{'s' if count > 1 else ''} on the {side}"


def _bands(wanted: Sequence[MechanismSpec]) -> list[tuple[float, list[MechanismSpec]]]:
    """Strips of a side from the top, with their weights: controls, what stands in a row, stacks, what is trodden."""
    found: list[tuple[float, list[MechanismSpec]]] = []
    for level in sorted({item.level for item in wanted}, reverse=True):
        here = [item for item in wanted if item.level == level]
        by_kind = {kind: [item for item in here if item.mechanism.arranged == kind] for kind in BANDS}
        if controls := by_kind["grid"]:
            found.append((max(item.mechanism.weight for item in controls), controls))
        if standing := by_kind["row"]:
            found.append((3.0, standing))
        for item in by_kind["stack"]:
            in_a_row = item.mechanism.halves and not item.side
            found += [(item.mechanism.weight, [replace(item, count=item.count if in_a_row else 1)])] * (
                1 if in_a_row else item.count
            )
        if trodden := by_kind["foot"]:
            found.append((trodden[0].mechanism.weight, trodden))
    return found


def _divided(wanted: Sequence[MechanismSpec], strip: Bay) -> list[tuple[MechanismSpec, Bay]]:
    """One cell each: in one row where that leaves them nearly square, else in several rows."""
    each = [item for item in wanted for _ in range(item.count)]
    if wanted[0].mechanism.arranged != "grid":
        return list(zip(each, columns(strip, len(each)), strict=True))
    lines = max(1, round(math.sqrt(len(each) * strip.height / strip.width)))
    across = -(-len(each) // lines)
    cells = [cell for line in rows(strip, [1.0] * -(-len(each) // across)) for cell in columns(line, across)]
    return list(zip(each, cells, strict=False))


def _axles(side: BodySide, line: Bay, count: int) -> list[Bay]:
    """Squares in which wheels stand, along the lower edge of a side; on a vehicle they leave room for its doors."""
    pitch = line.width / max(count - 1, 1)
    radius = min(0.42 * pitch, 0.2 * line.width, max(2.0 * line.height, 0.04)) if count > 1 else 0.2 * line.width
    places = np.linspace(line.left, line.right, count) if count > 1 else np.array([0.5 * (line.left + line.right)])
    if side.ahead and count > 2:
        leading = max(count // 2, 1) if count > 3 else 1
        ends = (line.right, line.left) if side.ahead > 0.0 else (line.left, line.right)
        doors = (side.area.right, side.area.left) if side.ahead > 0.0 else (side.area.left, side.area.right)
        numbers = np.array([leading, count - leading])
        pitch = 2.1  # radii
        radius = min(radius, *(np.abs(np.subtract(ends, doors)) / (pitch * (numbers - 1) + 1.1)))
        steps = pitch * radius * side.ahead
        places = np.concatenate([ends[0] - steps * np.arange(numbers[0]), ends[1] + steps * np.arange(numbers[1])])
    middle = line.bottom + 0.5 * line.height
    return [
        replace(line, left=x - radius, right=x + radius, bottom=middle - radius, top=middle + radius)
        for x in map(float, places)
    ]


def _beside_wheels(strip: Bay, wheels: Sequence[Bay]) -> Bay:
    """Return what wheels leave free of a strip: the middle between two, what is above them where there are others."""
    if not wheels or strip.bottom >= wheels[0].top:
        return strip
    if len(wheels) == 2:
        return replace(strip, left=max(strip.left, wheels[0].right), right=min(strip.right, wheels[1].left))
    return replace(strip, bottom=wheels[0].top)


def _corners(area: Bay, count: int) -> list[Bay]:
    """Squares near the corners of an area, then along its longer edges; what stands in them may turn about itself."""
    across = -(-count // 2)
    half = min(0.05, area.height / _TURNING, 2.0 * area.width / (_TURNING * max(across, 2)))
    inset = 1.5 * half
    xs = np.linspace(area.left + inset, area.right - inset, across) if across > 1 else np.zeros(1)
    # An odd one is missing behind, where the others then stand between those in front.
    behind = xs if count % 2 == 0 else 0.5 * (xs[1:] + xs[:-1])
    spots = [(float(x), area.bottom + inset) for x in behind] + [(float(x), area.top - inset) for x in xs]
    if count == 1:
        spots = [(0.0, 0.5 * (area.bottom + area.top))]
    return [replace(area, left=x - half, right=x + half, bottom=z - half, top=z + half) for x, z in spots]
