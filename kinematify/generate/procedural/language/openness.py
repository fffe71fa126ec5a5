"""How far a sentence wants the moving parts to stand open: a share, an angle or a distance."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.language.compare import Missing
from kinematify.generate.procedural.language.parts import PLACES, PartRequirement
from kinematify.generate.procedural.language.sizes import angle_at, length_at
from kinematify.generate.procedural.language.words import OPENNESS

if TYPE_CHECKING:
    from kinematify.generate.procedural.language.parts import PartReader
    from kinematify.generate.procedural.language.reading import ParseState
    from kinematify.generate.procedural.language.words import Words
    from kinematify.generate.procedural.parameter import Value

FRACTIONS = {
    "half": 0.5, "halfway": 0.5, "quarter": 0.25, "quarters": 0.25, "third": 1.0 / 3.0, "thirds": 1.0 / 3.0,
    "all": 1.0, "slightly": 0.15, "partly": 0.4, "partially": 0.4, "fully": 1.0, "completely": 1.0, "wide": 1.0,
}  # fmt: skip
"""Words for a share of the way."""
OUT = (("pulled", "out"), ("pull", "out"), ("swung", "out"), ("slid", "out"))  # as good as opened
VERBS = ("opens", "opening")
"""They say where something goes, not that it stands open."""
_NOT_A_STATE = ("shelf", "compartment", "front", "field")  # an open shelf is no state
_CLAUSE_ENDS = (",", ";", ".", ":", "with", "and")
_FILLING = (
    "standing",
    "stands",
    "by",
    "at",
    "to",
    "of",
    "the",
    "way",
    "up",
    "about",
    "an",
    "a",
    "per",
    "cent",
    "percent",
    "%",
)
_REACH = 5  # words to either side of the state

_HOW = {"open": "share", "open_angle": "angle", "open_distance": "distance"}

_Amount = tuple[str, "Value", str, tuple[int, ...]]


def read_openness(reading: ParseState, parts: PartReader) -> None:
    """Take up `half open`, `ajar`, `opened by 30 degrees`, `the top drawer pulled out 20 cm`, `open 30 %`."""
    for k, token in enumerate(reading.tokens):
        out = (token.text, reading.text(k + 1)) in OUT
        state = token.text in OPENNESS and token.given not in VERBS and reading.text(k + 1) not in _NOT_A_STATE
        if k in reading.used or not (out or state):
            _dropped(reading, parts, k)
            continue
        share = 1.0 if out else OPENNESS[token.text]
        clause = _clause(reading, k)
        amount = _amount(reading, [i for i in clause if i not in reading.used]) if share == 1.0 else None
        name, value, said, where = amount or ("open", share, f"{share:.0%} open", ())
        fillers = [i for i in clause if reading.text(i) in _FILLING or reading.text(i) in FRACTIONS]
        words = (k, *([k + 1] if out else []), *where, *fillers)
        opened = (_HOW[name], float(value))
        if not _open_parts(reading, parts, clause, opened, words):
            reading.take(name, value, said, *words)


def _dropped(reading: ParseState, parts: PartReader, k: int) -> None:
    """`its tailgate down`, at the end of a statement: it stands open there."""
    way = reading.text(k)
    if way in ("up", "down") and reading.text(k + 1) in ("", *_CLAUSE_ENDS):
        for first, end, stems in parts.nouns():
            if end == k:
                said = parts.said(*range(first, k + 1))
                parts.require(PartRequirement(nouns=stems, words=said, way=way, opened=("share", 1.0)), k)


def _open_parts(
    reading: ParseState, parts: PartReader, clause: list[int], opened: tuple[str, float], words: tuple[int, ...]
) -> bool:
    """Take up that parts which are named stand open; False where none are, or all that open at all."""
    named = [(first, end, stems) for first, end, stems in parts.nouns() if first in clause]
    if not named:
        return False
    first, end, stems = named[-1] if named[-1][0] < words[0] else named[0]
    place = reading.text(first - 1) if reading.text(first - 1) in PLACES else ""
    said = parts.said(*({first - 1} if place else ()), *range(first, end), *words)
    wanted = PartRequirement(nouns=stems, words=said, place=place, opened=opened)
    opening = {joint.child for joint in build(reading.family, {**reading.values, "open": 1.0}).joints if joint.value}
    if set(wanted.of(parts.made)) == opening:
        reading.used.update(range(first, end))
        return False
    where = (*words, *range(first, end), *({first - 1} if place else ()))
    if not parts.require(wanted, *where):
        reading.dropped.append(Missing(words=said, at=frozenset(where), reason="it does not open so far"))
        reading.used.update(where)
    return True


def _clause(reading: ParseState, k: int) -> list[int]:
    """Words around word k that belong to the same statement."""
    places = []
    for step in (-1, 1):
        at = k + step
        while abs(at - k) <= _REACH and reading.text(at) and reading.text(at) not in _CLAUSE_ENDS:
            places.append(at)
            at += step
    return sorted(places)


def _amount(reading: ParseState, clause: list[int]) -> _Amount | None:
    """Parameter, value, words for the user and places of what a clause measures."""
    for k in clause:
        angle, length = angle_at(reading, k), length_at(reading, k)
        if angle is not None:
            return "open_angle", angle[0], f"open by {math.degrees(angle[0]):g} deg", tuple(range(k, angle[1]))
        if length is not None:
            return "open_distance", length[0], f"open by {length[0]:g} m", tuple(range(k, length[1]))
        share = share_at(reading, k)
        if share is not None:
            return "open", share[0], f"{share[0]:.0%} open", tuple(range(k, share[1]))
    return None


def share_at(reading: Words, k: int) -> tuple[float, int] | None:
    """A share at word k and the word behind it: `30 %`, `two thirds`, `half`."""
    number, after = reading.number(k), reading.text(k + 1)
    percent = after in ("%", "percent") or (after, reading.text(k + 2)) == ("per", "cent")
    if number is not None and percent:
        return number / 100.0, k + (3 if after == "per" else 2)
    if number is not None and after in ("third", "thirds", "quarter", "quarters"):
        return number * FRACTIONS[after], k + 2
    if reading.text(k) in FRACTIONS:
        return FRACTIONS[reading.text(k)], k + 1
    return None
