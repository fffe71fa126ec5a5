"""Counts of a sentence: how many of what, in which grid, and the same thing counted at several places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.language.arrangement import Mention
from kinematify.generate.procedural.language.parse import FUNCTION_WORDS, may_follow
from kinematify.generate.procedural.language.reading import nouns_of
from kinematify.generate.procedural.language.sizes import JOINING
from kinematify.generate.procedural.language.words import ARTICLES, KINDS, UNITS, singular
from kinematify.generate.procedural.layout import CELLS

if TYPE_CHECKING:
    from kinematify.generate.procedural.language.reading import ParseState
    from kinematify.generate.procedural.parameter import Parameter

_LINES = ("row", "column")
_NUMBER_ENDS = ("and", "with", "per", "each", "every")  # a number before one of them counts something else
_PLACES = {
    "left": "left", "right": "right", "top": "top", "bottom": "bottom", "above": "top", "below": "bottom",
    "over": "top", "under": "bottom", "underneath": "bottom", "beneath": "bottom", "middle": "middle",
    "center": "middle", "centre": "middle", "between": "middle", "upper": "top", "lower": "bottom",
}  # fmt: skip
"""Words for a place of its own, that distinguish one count from another of the same thing."""
_SIDES = (("either", "each", "both"), ("side", "sides", "end", "ends"))
_LEADING = ("on", "at", "to", "in", "the", "further", "more", "other", "another", "below", "above", "under", "over")
_TOGETHER = (
    ("identical",), ("equal",), ("same",), ("next", "to", "each", "other"), ("side", "by", "side"), ("in", "a", "row"),
    ("beside", "each", "other"),
)  # fmt: skip
MOST_COPIES = 12
"""Side by side."""
_ADJECTIVES = 2  # at most, between a grid and what stands in it


@dataclass(frozen=True, kw_only=True)
class _Count:
    """A noun that can be counted, where a sentence has it."""

    number: int | None
    where: range
    counting: tuple[int, ...]
    """Words of the number."""

    @property
    def first(self) -> int:
        """The first word."""
        return min((*self.counting, self.where.start))


# ---- grids ---------------------------------------------------------------------------------------------------------


def read_grids(reading: ParseState) -> None:
    """`six drawers in 3 rows and 2 columns`, `two columns of four drawers`; of what the family's name has, too."""
    for k in range(len(reading.tokens)):
        grid = _grid(reading, k)
        found = grid and _gridded(reading, k, grid[2])
        if not grid or not found:
            continue
        columns, rows, end = grid
        parameter, noun = found
        total = columns * rows
        number, counting = _number_before(reading, noun) if noun < k else (None, ())
        said = f"{total} {reading.tokens[noun].given} in {columns} columns and {rows} rows"
        reading.take(parameter.name, int(number or total), said, *counting)
        reading.take(parameter.name, total, said, *range(k, end), noun)
        reading.counted.add(noun)
        for name, lines in (("columns", columns), ("rows", rows)):
            if reading.parameter(name) is not None:
                reading.take(name, lines, f"{lines} {name}")
        reading.mentions.append(
            Mention(kind=_kind(parameter), count=total, first=min(k, noun), last=max(end - 1, noun), grid=grid[:2])
        )


def _grid(reading: ParseState, k: int) -> tuple[int, int, int] | None:
    """Columns, rows, and the word behind, of `3 rows and 2 columns` or `two columns of four` at word k."""
    line, joint = reading.text(k + 1), reading.text(k + 2)
    numbers = [token.number for token in reading.tokens[k : k + 4]]
    if len(numbers) < 4 or not numbers[0] or not numbers[3] or line not in _LINES or k in reading.used:
        return None
    other = reading.text(k + 4)
    crossed = other in _LINES and other != line
    if joint != "of" and not (crossed and joint in ("and", "by", "with", ",", "x")):
        return None
    first, second = int(numbers[0]), int(numbers[3])
    columns, rows = (first, second) if line == "column" else (second, first)
    return columns, rows, k + (5 if crossed else 4)


def _gridded(reading: ParseState, k: int, end: int) -> tuple[Parameter, int] | None:
    """Return what stands in the grid, and the word that says so: one of the next, or the nearest one before."""
    for at in (*range(end, end + _ADJECTIVES + 1), *range(k - 1, -1, -1)):
        for parameter in reading.family.parameters:
            nouns = nouns_of(parameter)
            if isinstance(parameter.default, int) and singular(reading.text(at), frozenset(nouns)) in nouns:
                return parameter, at
    return None


# ---- counts --------------------------------------------------------------------------------------------------------


def read_counts(reading: ParseState) -> None:
    """`two doors`, `3 small drawers`, `no handle`, `a grid of 3 by 2 drawers`, `half a dozen knobs`."""
    for parameter in reading.family.parameters:
        if isinstance(parameter.default, int):
            counts = _counts_of(reading, parameter)
            _take_counts(reading, parameter, counts)


def _place_before(reading: ParseState, k: int) -> str | None:
    """The place that is said right before a noun: `the left door`, `an upper drawer`."""
    return _PLACES.get(reading.text(k - 1))


def _is_one(reading: ParseState, where: range) -> bool:
    """`left door`, in the singular and at a place, is one, and so is `whose door`."""
    last = reading.tokens[where.stop - 1]
    if reading.text(where.start - 1) == "whose":
        return last.given == last.text
    if reading.text(where.start - 2) == "the":  # the upper one of those that there are
        return False
    return _place_before(reading, where.start) is not None and last.given == last.text


def _counts_of(reading: ParseState, parameter: Parameter) -> list[_Count]:
    """Every place where a sentence names what a parameter counts, in its order."""
    found: list[_Count] = []
    for noun in sorted(nouns_of(parameter), key=len, reverse=True):
        words = tuple(noun.split())
        for k in range(len(reading.tokens) - len(words) + 1):
            where = range(k, k + len(words))
            read = tuple(singular(reading.text(i), frozenset(words)) for i in where)
            if read == words and not reading.used & set(where):
                number, counting = _number_before(reading, k)
                of_the_whole = number is None or reading.text(counting[-1]) in ARTICLES
                if of_the_whole and k < min(reading.named):  # a sash window is a kind of window
                    continue
                behind = reading.text(where.stop)
                named = behind.isalpha() and behind not in FUNCTION_WORDS and not may_follow(reading.tokens, where.stop)
                if named and of_the_whole:  # a drawer unit is no drawer
                    number, counting = None, ()
                whole = None if number is None else _whole(reading, number, where.stop - 1)
                found.append(_Count(number=whole, where=where, counting=counting))
                reading.used.update((*where, *counting))
    found.sort(key=lambda count: count.where.start)
    if all(count.number is None for count in found):
        found = [replace(count, number=1) if _is_one(reading, count.where) else count for count in found]
    return _with_those_left_out(reading, found)


def _with_those_left_out(reading: ParseState, counts: list[_Count]) -> list[_Count]:
    """`two drawers on the left and one on the right`: the second count leaves its noun out."""
    more = []
    for count in (c for c in counts if c.number is not None and _place(reading, c.where.stop)):
        for k in range(count.where.stop + 1, len(reading.tokens) - 1):
            number = reading.number(k)
            if _names_something_else(reading, k, counts, count):
                break
            bare = number is not None and k not in reading.used and reading.text(k) not in (*ARTICLES, "no")
            if bare and reading.text(k + 1) in _LEADING and _place(reading, k + 1):
                more.append(_Count(number=int(number or 0), where=range(k, k + 1), counting=(k,)))
                reading.used.add(k)
    return sorted([*counts, *more], key=lambda count: count.where.start)


def _names_something_else(reading: ParseState, k: int, counts: list[_Count], count: _Count) -> bool:
    """True if word k belongs to another thing that is counted, which a bare number behind it would mean."""
    if any(other.first <= k < other.where.stop for other in counts if other is not count):
        return True
    nouns = {noun for p in reading.family.parameters if isinstance(p.default, int) for noun in nouns_of(p)}
    return singular(reading.text(k), frozenset(nouns)) in nouns


def _take_counts(reading: ParseState, parameter: Parameter, counts: list[_Count]) -> None:
    """Counts at several places add up; elsewhere two of one thing must agree."""
    numbered = [count for count in counts if count.number is not None]
    places = [_place(reading, c.where.stop) or _place_before(reading, c.where.start) for c in numbered]
    apart = len(numbered) > 1 and all(places) and len(set(places)) == len(places)
    # `a glass door and a steel door` are two.
    articles = all(count.counting and reading.text(count.counting[0]) in ARTICLES for count in numbered)
    apart = apart or (len(numbered) > 1 and articles)
    totals = [_total(reading, count) for count in numbered]
    if apart:
        total = sum(totals)
        words = [i for count in numbered for i in (*count.counting, *count.where)]
        reading.take(parameter.name, total, f"{total} {parameter.name}", *words)
    for count, total in zip(numbered, totals, strict=True):
        if not apart:
            reading.take(parameter.name, total, f"{total} {parameter.name}", *count.counting, *count.where)
    stated = dict(zip(numbered, totals, strict=True))
    if counts and not numbered and parameter.default == 0 and parameter.usual:
        some = int(parameter.usual[1])  # `with wheels` are as many as there may well be
        reading.take(parameter.name, some, f"{some} {parameter.name}")
    for count in counts:
        reading.counted.update(count.where)
        reading.mentions += _mentions(reading, parameter, count, stated.get(count))


def _mentions(reading: ParseState, parameter: Parameter, count: _Count, total: int | None) -> list[Mention]:
    """The mention of a count; one for each side if it stands on either."""
    kind, last = _kind(parameter), count.where.stop - 1
    if total is None:
        known = int(reading.values.get(parameter.name, parameter.default))
        return [Mention(kind=kind, count=known, first=count.first, last=last, stated=False)]
    if not _on_both_sides(reading, count.where.stop) or total % 2:
        return [Mention(kind=kind, count=total, first=count.first, last=last)]
    reading.used.update(range(count.where.stop, count.where.stop + 3))
    half = total // 2
    return [Mention(kind=kind, count=half, first=count.first, last=last + 3, across=side) for side in (-1, 1)]


def _total(reading: ParseState, count: _Count) -> int:
    """Return how many a count means: one door on either side is two doors, and so is two doors on both sides."""
    number = count.number or 0
    if _on_both_sides(reading, count.where.stop) and (number % 2 or reading.text(count.where.stop + 1) == "each"):
        return 2 * number
    return number


def _on_both_sides(reading: ParseState, k: int) -> bool:
    which, side = _SIDES
    return reading.text(k) in ("on", "at") and reading.text(k + 1) in which and reading.text(k + 2) in side


def _place(reading: ParseState, k: int) -> str | None:
    """The place that is said right behind a noun: `on the left`, `below`, `at the top`."""
    for at in range(k, k + 4):
        if reading.text(at) in _PLACES:
            return _PLACES[reading.text(at)]
        if reading.text(at) not in _LEADING:
            return None
    return None


def read_counted_name(reading: ParseState) -> None:
    """`a double door` has two of what a door is made of, where the family counts them by its own name."""
    where = range(min(reading.named), max(reading.named) + 1)
    names = (" ".join(reading.text(i) for i in where), *(reading.text(i) for i in where))
    number, counting = _number_before(reading, where.start)
    if (reading.text(where.start - 2), reading.text(where.start - 1)) == ("pair", "of"):  # of glasses, of scissors
        reading.used.add(where.start - 2)
    counted = (p for p in reading.family.parameters if isinstance(p.default, int))
    parameter = next((p for p in counted if set(names) & set(nouns_of(p))), None)
    if parameter is not None and number is not None and number > 1:
        whole = _whole(reading, number, where.stop - 1)
        reading.take(parameter.name, whole, f"{whole} {parameter.name}", *counting)


def read_copies(reading: ParseState) -> None:
    """`two nightstands`, `three identical nightstands next to each other`."""
    number, counting = _number_before(reading, min(reading.named))
    if number is None or {reading.text(counting[-1]), reading.text(counting[-1] + 1)} & {*ARTICLES, *UNITS, *KINDS}:
        return
    if _whole(reading, number, max(reading.named)) <= 1:
        return
    if number > MOST_COPIES:
        raise InputError(
            f"The text asks for {number:g} {reading.tokens[max(reading.named)].given}; at most {MOST_COPIES} are "
            "built side by side."
        )
    reading.copies = int(number)
    reading.used.update(counting)
    for phrase in _TOGETHER:
        for k in range(len(reading.tokens) - len(phrase) + 1):
            where = range(k, k + len(phrase))
            if tuple(reading.text(i) for i in where) == phrase and not reading.used & set(where):
                reading.used.update(where)


def _whole(reading: ParseState, number: float, k: int) -> int:
    """The number that counts the noun at word k, which cannot be broken."""
    if number != int(number):
        raise InputError(
            f"The text asks for {number:g} {reading.tokens[k].given}; only a whole number of them can be built."
        )
    return int(number)


def _kind(parameter: Parameter) -> str:
    """The cell of a layout that a parameter counts, else its noun."""
    return next((noun for noun in nouns_of(parameter) if noun in CELLS), nouns_of(parameter)[0])


def _number_before(reading: ParseState, k: int) -> tuple[float | None, tuple[int, ...]]:
    """The number that counts the noun at word k, and its words; what describes the noun between them is left."""
    at = k - 1
    while at >= 0 and k - at <= 3:
        token = reading.tokens[at]
        if token.number is not None and at not in reading.used and reading.text(at + 1) not in UNITS:
            before, factor = reading.text(at - 1), reading.number(at - 2)
            if before in JOINING and at >= 2 and factor is not None:
                return token.number * factor, (at - 2, at - 1, at)
            if token.text == "dozen" and reading.text(at - 2) == "half":
                return 6, (at - 2, at - 1, at)
            if token.text == "dozen":
                times = reading.number(at - 1) if at else None
                return 12 * int(times or 1), (at - 1, at) if times else (at,)
            return token.number, (at - 1, at) if before in ARTICLES else (at,)
        if token.number is not None or token.is_sign or at in reading.used or token.text in _NUMBER_ENDS:
            return None, ()
        at -= 1
    return None, ()
