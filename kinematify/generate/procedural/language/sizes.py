"""Sizes of a sentence: lengths with units, two or three of them multiplied, and angles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.language.reading import nouns_of
from kinematify.generate.procedural.language.words import OPENNESS, UNITS, singular

if TYPE_CHECKING:
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.language.reading import ParseState
    from kinematify.generate.procedural.language.words import Words
    from kinematify.generate.procedural.parameter import Parameter

DIMENSIONS = {
    "width": ("wide", "width", "across", "broad"),
    "depth": ("deep", "depth"),
    "height": ("high", "tall", "height"),
    "length": ("long", "length"),
    "diameter": ("diameter",),
    "wall": ("thick", "thickness"),
    "reach": ("reach",),
}
"""Words for a size, keyed by the parameter that they mean."""
SIZE_WORDS = {
    "small": (0, ()), "mini": (0, ()), "tiny": (0, ()), "little": (0, ()), "compact": (0, ()), "big": (1, ()),
    "huge": (1, ()), "large": (1, ()), "tall": (1, ("height",)), "low": (0, ("height",)), "wide": (1, ("width",)),
    "narrow": (0, ("width",)), "long": (1, ("length", "width")),
}  # fmt: skip
"""Words for a size without a number: which end of what is usual, and of which sizes; of all where none is named."""
OVERALL = ("width", "depth", "height")
"""Sizes of a whole, along x, y and z."""
_CLEARLY = 1.5  # times as long as any other side
JOINING = ("x", "by")
"""Between numbers that are multiplied."""
_INSTEAD = {
    "width": ("diameter", "span"),
    "length": ("width",),
    "diameter": ("width", "span"),
    "reach": ("length",),
}
"""What a word for a size means in families that do not have its first sense, the likelier first."""
_DEGREES = {"degree": math.pi / 180.0, "degrees": math.pi / 180.0, "deg": math.pi / 180.0, "°": math.pi / 180.0,
            "radian": 1.0, "radians": 1.0, "rad": 1.0}  # fmt: skip


def read_sizes(reading: ParseState) -> None:
    """Take up all sizes of a sentence but how far something stands open."""
    _angles(reading)
    _lengths(reading)
    _products(reading)
    _refuse_sizes_without_unit(reading)


def read_size_words(reading: ParseState) -> None:
    """`a small box`, `a tall, narrow cupboard`: an end of what is usual, for what was not said in numbers."""
    first = min(reading.named)
    for k, token in enumerate(reading.tokens[:first]):
        between = reading.tokens[k + 1 : first]
        if token.text not in SIZE_WORDS or k in reading.used or any(reading.number(k) for k in range(k + 1, first)):
            continue
        end, names = SIZE_WORDS[token.text]
        meant = [
            p
            for p in reading.family.parameters
            if p.unit == "m" and p.usual and (p.name in names or (not names and p.name in DIMENSIONS))
        ]
        for parameter in meant[:1] if names else meant:
            if parameter.name not in reading.values and parameter.usual is not None:
                reading.values[parameter.name] = parameter.usual[end]
        if meant and not any(item.text in ("with", "and") for item in between):
            reading.used.add(k)


def read_overall(reading: ParseState) -> None:
    """`1.7 m tall`, of what has no such parameter: the whole is made so large."""
    if any(p.unit == "m" and p.name in reading.said for p in reading.family.parameters):
        return  # which scaling would change
    for k in range(len(reading.tokens)):
        length = length_at(reading, k) if k not in {*reading.used, *reading.of_parts} else None
        word = reading.text(length[1]) if length else ""
        name = next((name for name in OVERALL if word in DIMENSIONS[name]), "")
        if length and name and reading.overall is None and not any(p.name == name for p in reading.family.parameters):
            reading.overall = (name, length[0])
            reading.used.update(range(k, length[1] + 1))


def length_at(reading: Words, k: int) -> tuple[float, int] | None:
    """A number with a unit at word k: metres, and the word behind it; `6 ft 2 in` is one length."""
    number, unit = reading.number(k), reading.text(k + 1)
    if number is not None and unit not in UNITS:  # 180 cm high, 80 wide, 40 deep
        alone = reading.text(k)[0].isdigit() and reading.text(k + 2) in ("", ",", "and", "with", ".")
        before = [reading.text(at) for at in range(k) if reading.text(at) in UNITS and reading.number(at - 1)]
        is_size = alone and before and any(unit in words for words in DIMENSIONS.values())
        return (round(number * UNITS[before[-1]], 9), k + 1) if is_size else None
    if number is None:
        return None
    if unit == "in" and (reading.text(k + 2) in ("diameter", "total") or not reading.text(k)[0].isdigit()):
        return None  # two in front
    metres, end = number * UNITS[unit], k + 2
    if unit in ("foot", "feet", "ft") and reading.text(end + 1) in ("inch", "inche", "in") and reading.number(end):
        metres, end = metres + (reading.number(end) or 0.0) * UNITS["inch"], end + 2
    if reading.text(end) == "in" and reading.text(end + 1) == "diameter":
        end += 1
    return round(metres, 9), end


def angle_at(reading: Words, k: int) -> tuple[float, int] | None:
    """A number with a unit of angle at word k: radians, and the word behind it; `6 degrees of freedom` is none."""
    number, unit = reading.number(k), reading.text(k + 1)
    if number is None or unit not in _DEGREES or reading.text(k + 2) == "of":
        return None
    return number * _DEGREES[unit], k + 2


def _angles(reading: ParseState) -> None:
    """`tilted by 23 degrees`, in families that have such an angle."""
    for parameter in reading.family.parameters:
        names = (parameter.name, f"{parameter.name}ed", *parameter.words)
        for k in range(len(reading.tokens) if parameter.unit == "rad" else 0):
            angle = angle_at(reading, k)
            if angle is None:
                continue
            for at in (angle[1], k - 1, k - 2, k - 3):
                if reading.text(at) in names:
                    said = f"{parameter.name} {math.degrees(angle[0]):g} deg"
                    reading.take(parameter.name, angle[0], said, *range(min(k, at), max(angle[1], at + 1)))
                    break


def _lengths(reading: ParseState) -> None:
    """`80 cm wide`, `a height of 2 m`, `0.3 m in diameter`; what is long and wide is so deep as it is wide."""
    there = {p.name for p in reading.family.all_parameters if p.unit == "m"}
    said = {name for token in reading.tokens for name, words in DIMENSIONS.items() if token.text in words}
    both = {"length", "width"} <= said and "length" not in there
    k = 0
    while k < len(reading.tokens):
        length = length_at(reading, k)
        if length is None:
            k += 1
            continue
        metres, end = length
        for at in (end, end + 1, k - 1, k - 2):
            name = _dimension(reading, reading.text(at), metres) if at not in reading.used else None
            if name is not None and k in reading.of_parts and not _is_named_for(reading, name, reading.of_parts[k]):
                continue
            if both and reading.text(at) in (*DIMENSIONS["length"], *DIMENSIONS["width"]):
                is_long, has_depth = reading.text(at) in DIMENSIONS["length"], "depth" in there - said
                name = ("width" if is_long else "depth") if has_depth else None if is_long else name
            if name is not None and not _is_of_a_part(reading, at + 1):
                reading.take(name, metres, f"{name} {metres:g} m", *range(min(k, at), max(end, at + 1)))
                break
        k = end


def _is_named_for(reading: ParseState, name: str, noun: str) -> bool:
    """True if a parameter is of a part by its name, or by what people call it."""
    parameter = reading.parameter(name)
    return noun in name.split("_") or bool(parameter and any(noun in words.split() for words in parameter.words))


def _is_of_a_part(reading: ParseState, k: int) -> bool:
    """True if what stands before word k is said of a part: `60 cm wide drawers`."""
    parts = {noun for p in reading.family.parameters if isinstance(p.default, int) for noun in nouns_of(p)}
    return k not in reading.named and singular(reading.text(k), frozenset(parts)) in parts


def read_bare_length(reading: ParseState) -> None:
    """`6 inch pliers`, `a fridge, 180 cm`: of what has one length or diameter, or one side that is clearly longest."""
    name = next((name for name in ("length", "diameter") if reading.parameter(name) is not None), None)
    for k in range(len(reading.tokens)):
        length = length_at(reading, k) if k not in {*reading.used, *reading.ranges, *reading.of_parts} else None
        if length is None:
            continue
        metres, end = length
        if name is None and _is_of_whole(reading, k, end):
            longest = _longest_side(reading.family)
            if longest and reading.parameter(longest) is None and reading.overall is None:
                reading.overall = (longest, metres)
                reading.used.update(range(k, end))
                continue
            name = longest or None
        if name is not None and name not in reading.values:
            reading.take(name, metres, f"{name} {metres:g} m", *range(k, end))


def _is_of_whole(reading: ParseState, k: int, end: int) -> bool:
    """True if a length at words k to `end` stands before the object's name or by itself, and says not how far it opens.

    Screens are measured across their diagonal, which is no side.
    """
    around = {reading.text(i) for i in range(k - 3, end + 3)}
    stands_alone = end <= min(reading.named) or reading.text(end) in ("", ",", ";", ".", "with")
    return stands_alone and not around & {*OPENNESS, "out"} and reading.parameter("screen") is None


def _longest_side(family: Family) -> str:
    """The side of such an object that is clearly its longest, as a person's height is; empty if there is none."""
    sides = {p.name: float(p.default) for p in family.parameters if p.name in OVERALL}
    if not sides:
        extents = np.ptp(build(family, {}).assembly.bounds, axis=0)
        sides = dict(zip(OVERALL, map(float, extents), strict=True))
    first, *others = sorted(sides, key=lambda name: -sides[name])
    return first if not others or sides[first] > _CLEARLY * sides[others[0]] else ""


def _dimension(reading: ParseState, word: str, metres: float) -> str | None:
    """The parameter that a word for a size means in this family; of several, the first that can be so large."""
    lengths = {p.name: p for p in reading.family.all_parameters if p.unit == "m"}
    meant = [p.name for p in lengths.values() if word and word in (*p.words, p.name)]
    for name in (name for name, words in DIMENSIONS.items() if word in words):
        meant += [item for item in (name, *_INSTEAD.get(name, ())) if item in lengths]
    return next((name for name in meant if _holds(lengths[name], metres)), meant[0] if meant else None)


def _holds(parameter: Parameter, metres: float) -> bool:
    low, high = parameter.bounds or (-math.inf, math.inf)
    return low <= metres <= high


def _products(reading: ParseState) -> None:
    """`20 x 15 x 10 cm` is width, depth and height; two numbers leave out the height, or the depth if there is none."""
    for k in range(len(reading.tokens)):
        numbers, places, at = [], [], k
        while reading.number(at) is not None and at not in reading.used:
            numbers.append(float(reading.number(at) or 0.0))
            places.append(at)
            unit = reading.text(at + 1) if reading.text(at + 1) in UNITS else ""
            at += 2 if unit else 1
            if reading.text(at) not in JOINING or len(numbers) == 3:
                break
            at += 1
        units = [reading.text(i) for i in range(k, at + 1) if reading.text(i) in UNITS]
        free = (name for name in ("width", "depth", "height") if name not in reading.values)
        names = [name for name in free if reading.parameter(name) is not None]
        if len(numbers) < 2 or not units or len(numbers) > len(names):
            continue
        end = at + 1 if reading.text(at) in UNITS else at
        for name, number, place in zip(names, numbers, places, strict=False):
            own = reading.text(place + 1)
            size = round(number * UNITS[own if own in UNITS else units[-1]], 9)
            reading.take(name, size, f"{name} {size:g} m", *range(k, end))


def _refuse_sizes_without_unit(reading: ParseState) -> None:
    """`80 wide` may be centimetres or millimetres."""
    for k, token in enumerate(reading.tokens):
        behind = _dimension(reading, reading.text(k + 1), 0.0)
        before = _dimension(reading, reading.text(k - 2), 0.0) if reading.text(k - 1) == "of" else None
        if token.given[0].isdigit() and k not in {*reading.used, *reading.of_parts} and (behind or before):
            raise InputError(
                f"The text says {token.given} for the {behind or before} and no unit. Write for example "
                f"'{token.given} cm'; mm, cm, m, inches and feet are known."
            )
