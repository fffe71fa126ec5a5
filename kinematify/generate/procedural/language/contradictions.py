"""Refuse what nobody can build: contradictions, sizes of nothing, and what no rigid object is or does."""

from __future__ import annotations

from collections import defaultdict
from itertools import pairwise
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.language.words import UNITS, lemma

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.generate.procedural.language.specification import Claim, PartSpecification, Specification

    _Fault = tuple[str, str]

_NO_OBJECT_TEXT = """
    fly flies flying sing sings singing think thinks thinking dream dreams dreaming talk talks talking swim swims
    swimming eat eats eating sleep sleeps sleeping dance dances dancing cry cries breathe breathes breathing laugh
    laughs invisible infinite endless weightless massless dimensionless imaginary abstract immaterial telepathic
    magical never nowhere teleport teleports teleporting levitate levitates levitating
"""
_NO_OBJECT = frozenset(_NO_OBJECT_TEXT.split())
"""What no rigid object is or does."""
_NO_THING_TEXT = """
    monday tuesday wednesday thursday friday saturday sunday january february april june july august september october
    november december yesterday tomorrow eternity infinity echo dream thought idea opinion joy sorrow anger happiness
    sadness laughter silence hope fear freedom justice truth luck wisdom patience courage envy regret imagination
    nostalgia gossip rumour rumor love hate soul conscience consciousness democracy philosophy
"""
_NO_THING = frozenset(_NO_THING_TEXT.split())
"""What is no thing at all, so that nothing consists of it or has it."""
_NO_SOLID_TEXT = """
    water air smoke light fog steam fire sound music time nothing milk gas soup juice tea coffee wine beer oil honey
    mist cloud clouds rain wind breath shadow shadows flame flames lightning moonlight sunlight sunshine gravity
    electricity magic noise laughter tears blood jelly vacuum heat cold
"""
_ABSTRACT = ("ness", "ity", "ism", "hood", "ship", "dom", "tion", "sion")
"""How words end for what is no thing."""
_NO_SOLID = frozenset(_NO_SOLID_TEXT.split()) | _NO_THING
"""What no part can be made of."""
_MADE = (("made", "of"), ("out", "of"), ("made", "from"), ("entirely", "of"), ("only", "of"), ("completely", "of"))
_OPPOSITE_TEXT = """
    transparent opaque, rigid flexible, hollow solid, full empty, fixed movable, fixed sliding, tall short, wide narrow,
    big small, large small, thick thin, deep shallow, straight curved, long short, vertical horizontal,
    heavy weightless, wheeled wheelless, hinged hingeless, moving motionless, locked unlocked, visible hidden
"""
_OPPOSITES = {frozenset(pair.split()) for pair in _OPPOSITE_TEXT.split(",")}
_AGAINST = {
    "left": "right",
    "top": "bottom",
    "upper": "lower",
    "front": "back",
    "uppermost": "lowest",
    "inner": "outside",
}
_AGAINST |= {other: one for one, other in _AGAINST.items()} | {"rear": "front", "bottom": "top"}
"""Places that exclude each other."""
_LARGER = ("larger", "bigger", "taller", "wider", "longer", "higher", "deeper", "thicker", "heavier")
_LEAVES = ("door", "lid", "flap", "gate", "cover", "window", "shutter", "hatch", "sash", "leaf", "tailgate", "drawer")
"""What closes an opening, and goes round no more than once."""
_ROUND = 6.2832  # [rad]
_SHAPES = ("round", "circular", "square", "triangular", "hexagonal", "spherical", "cubic", "circle")
_BEARINGS = ("hinge", "joint", "axis", "axle", "pivot", "rail", "slide", "bearing", "guide")
_SLIDES = ("drawer",)
"""They slide, whatever carries them."""
_OTHER_WAY = ("spins", "turns", "swings", "tilts", "flips")
_ONE_OF = {"size": "sizes", "open": "states", "hinge": "sides"}
_SIDE_BY_SIDE = {"width": "side by side", "height": "on top of"}
"""Sizes that add up, by how parts stand."""
_SHOWN = 3


def refuse_contradictions(specification: Specification) -> None:
    """Check that a specification can hold.

    Raises:
        InputError: It contradicts itself, or asks for what no object is; three lines at most.
    """
    faults = list(_faults(specification))
    if faults:
        article = "an" if specification.kind[:1] in "aeiou" else "a"
        said = "; ".join(f"{words!r} ({reason})" for words, reason in faults[:_SHOWN])
        raise InputError(
            f'This cannot be built: {said}.\nThe nearest sentence that works: "{article} {specification.kind}".'
        )


def _faults(specification: Specification) -> Iterator[_Fault]:
    for part in specification.all_parts():
        yield from _two_values(part)
        yield from _two_places(part)
        yield from _too_far(part, specification)
        yield from _moves_closed(part, specification)
    yield from _present_and_absent(specification)
    yield from _larger_parts(specification)
    words = [token.given for token in specification.tokens]
    for k, word in enumerate(words):
        if word in _NO_OBJECT and k not in specification.name:
            yield word, "no object with links and joints is or does that"
        unreal = word in _NO_SOLID or word.endswith(_ABSTRACT)
        if unreal and tuple(words[max(k - 2, 0) : k]) in _MADE:
            yield f"made of {word}", "parts are solid"
        elif {lemma(word), word.removesuffix("es")} & _NO_THING and specification.tokens[k - 1].number is not None:
            yield f"{words[k - 1]} {word}", "no object has that"
    for k in range(1, len(words) - 2):
        broken = words[k : k + 3] == ["and", "a", "half"] and specification.tokens[k - 1].number is not None
        if broken and words[k + 3 : k + 4] and lemma(words[k + 3]) not in UNITS:
            yield " ".join(words[k - 1 : k + 4]), "parts are counted by whole numbers"
    yield from _opposites(words)
    yield from _larger_than_all(specification, words)
    for one, other in pairwise(words):
        if one in _SHAPES and other in _SHAPES and one != other:
            yield f"{one} {other}", "these shapes exclude each other"
    for part in specification.parts:
        for claim in part.claims:
            if part.noun in _SLIDES and claim.about == "moves" and claim.value in _OTHER_WAY:
                yield f"{claim.words} {part.noun}", f"a {part.noun} slides"


def _opposites(words: Sequence[str]) -> Iterator[_Fault]:
    """`transparent opaque`, `both rigid and flexible`; doors that are tall and short may be several."""
    for k in range(len(words) - 1):
        joined = words[k + 1] in ("and", "but", "yet") and k + 2 < len(words)
        other = k + 2 if joined else k + 1
        behind = words[other + 1] if other + 1 < len(words) else ""
        if frozenset((words[k], words[other])) in _OPPOSITES and lemma(behind) == behind:
            yield " ".join(words[k : other + 1]), "these exclude each other"


def _larger_than_all(specification: Specification, words: Sequence[str]) -> Iterator[_Fault]:
    """Return what is larger than itself, or than the whole that it is a part of."""
    own = specification.kind.split()[-1]
    for k, word in enumerate(words[:-1]):
        behind = next((other for other in words[k + 2 :] if other not in ("the", "its", "whole")), "")
        if word in _LARGER and words[k + 1] == "than" and k > specification.name[-1] and behind == own:
            yield " ".join(words[k : k + 4]), f"nothing of a {own} is larger than all of it"
        if words[k + 1] in ("itself", "themselves") and word in ("than", "in", "inside", "on", "under", "above", "of"):
            yield f"{word} {words[k + 1]}", "nothing is so beside itself"


def _too_far(part: PartSpecification, specification: Specification) -> Iterator[_Fault]:
    """A door that turns round more than once, a drawer that is pulled out farther than its cabinet is deep."""
    deep = [c for c in specification.whole.claims if c.about == "size" and c.value[0] == "depth"]
    ranges = {claim.value[0]: claim for claim in part.claims if claim.about == "range"}
    for claim in (claim for claim in part.claims if claim.about in ("open", "range")):
        how, much = claim.value
        most = ranges.get(how)
        if claim.about == "open" and ((most and much > most.value[1] * 1.001) or (how == "share" and much > 1.0)):
            yield f"{part.noun} {claim.words}", f"it goes {most.words}" if most else "no more than all of it is open"
        if how == "angle" and much > _ROUND and part.noun.split()[-1] in _LEAVES:
            yield f"{part.noun} {claim.words}", "it goes round less than once"
        is_out = claim.about == "open" and how == "distance" and part.noun in _SLIDES
        if is_out and deep and much > deep[0].value[1]:
            yield f"{part.noun} {claim.words}", f"the {specification.kind} is {deep[0].words}"


def _moves_closed(part: PartSpecification, specification: Specification) -> Iterator[_Fault]:
    """Return what is fixed and swings, what is locked and open, what is open in a closed object."""
    said = {claim.about: claim for claim in part.claims}
    opened = next((claim for claim in part.claims if claim.about == "open" and claim.value[1] > 0.0), None)
    moves = opened or next((claim for claim in part.claims if claim.about in ("moves", "way", "range", "hinge")), None)
    if "still" in said and moves:
        yield f"{said['still'].words} {part.noun}, {moves.words}", "what is fixed does not move"
    locked = [item.of or specification.kind for item in specification.parts if item.claims[0].words == "locked"]
    if opened and {part.noun, specification.kind} & set(locked):
        yield f"locked {part.noun} {opened.words}", "what is locked is closed"
    closed = next((c for c in specification.whole.claims if c.about == "open" and c.value[1] == 0.0), None)
    if opened and closed and part is not specification.whole:
        yield f"{closed.words} {specification.kind}, {part.noun} {opened.words}", "what is closed has nothing open"


def _two_values(part: PartSpecification) -> Iterator[_Fault]:
    said: dict[tuple[str, str], Claim] = {}
    for claim in part.claims:
        name, value = claim.value if claim.about in ("size", "open") else ("", claim.value)
        name = "" if claim.about == "open" else name
        if claim.about == "size" and value <= 0.0:
            yield claim.words, "a size is above zero"
        if claim.about not in _ONE_OF or (claim.about == "size" and not name):
            continue  # two lengths whose direction is not said
        before = said.setdefault((claim.about, name), claim)
        other = before.value[1] if claim.about in ("size", "open") else before.value
        if other != value and (claim.about != "open" or 0.0 in (other, value)):
            of = f" for the {name}" if name else ""
            yield f"{before.words}, {claim.words}", f"two {_ONE_OF[claim.about]}{of} of one {part.noun}"


def _two_places(part: PartSpecification) -> Iterator[_Fault]:
    """A hinge that is on one side, and hinged on the other; a left door on the right."""
    noun = max(part.claims[0].at)
    before = [claim for claim in part.claims if claim.about == "place" and max(claim.at) < noun and part.count == 1]
    behind = [claim for claim in part.claims if claim.about == "place" and min(claim.at) > noun]
    for one in before:
        for other in behind:
            if _AGAINST.get(one.value) == other.value:
                yield f"{one.words} {part.noun} {other.words}", "these places exclude each other"
    sides = {claim.value: claim for claim in part.claims if claim.about in ("place", "hinge")}
    if part.noun == "hinge" and part.count == 1 and {"left", "right"} <= sides.keys():
        yield f"{sides['left'].words}, {sides['right'].words}", "one hinge is on one side"


def _present_and_absent(specification: Specification) -> Iterator[_Fault]:
    by_noun: dict[str, list[PartSpecification]] = defaultdict(list)
    for part in specification.parts:
        by_noun[part.noun].append(part)
    moving = any(claim.about in ("moves", "way") for part in specification.all_parts() for claim in part.claims)
    for noun, parts in by_noun.items():
        absent = [part for part in parts if part.absent]
        *_, last = specification.kind.partition(" of ")[2].split() or [specification.kind]
        if absent and noun.split()[-1] in ("part", "joint"):
            yield f"no {absent[0].claims[0].words}", "something of every object that is built moves"
        elif absent and (len(absent) < len(parts) or noun == lemma(last)):
            yield f"no {noun}", f"it asks for a {noun}, too"
        elif absent and noun.rsplit(maxsplit=1)[-1] in _BEARINGS and moving:
            yield absent[0].claims[0].words, "what has no joint does not move"
        counted = [part for part in parts if any(claim.about == "count" for claim in part.claims) and not part.of]
        numbers = {part.count for part in counted if part.count is not None}
        placed = any(claim.about in ("place", "relation") for part in parts for claim in part.claims)
        of_kind = any(max(part.claims[0].at) < specification.name[0] for part in counted)  # a one-armed lamp
        if len(numbers) > 1 and not placed and (1 not in numbers or of_kind) and 0 not in numbers:
            yield " and ".join(f"{number} {noun}s" for number in sorted(numbers)), "two counts of one thing"
        every = max((number for part in counted if (number := part.count) and not part.is_share), default=0)
        for part in counted:
            if part.is_share and every < (part.count or 0):
                yield f"{part.count} of the {noun}s", f"there are only {every} {noun}s"
        for claim in (claim for part in parts for claim in part.claims if claim.about == "place"):
            if every and claim.value[0].isdigit() and int(claim.value.split()[0]) > every:
                yield f"{claim.words} of the {noun}s", f"there are only {every} {noun}s"


def _larger_parts(specification: Specification) -> Iterator[_Fault]:
    whole = {claim.value[0]: claim for claim in specification.whole.claims if claim.about == "size"}
    for part in specification.parts:
        for claim in (claim for claim in part.claims if claim.about == "size" and claim.value[0] in whole):
            size, together = whole[claim.value[0]], _SIDE_BY_SIDE.get(claim.value[0], "-") in specification.text
            alike = [other.count or 1 for other in specification.parts if other.noun == part.noun]
            count = part.count or max(alike) if together else 1
            if claim.value[0] and count * claim.value[1] > size.value[1] * 1.001:
                yield f"{part.noun} {claim.words}", f"the {specification.kind} is {size.words}"
