"""Request of a specification to a family: its parameters, and what it cannot have.

Driven by what the families declare: nothing here knows a family.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.family import build, checked
from kinematify.generate.procedural.language.arrangement import layout_of
from kinematify.generate.procedural.language.counts import read_copies, read_counted_name, read_counts, read_grids
from kinematify.generate.procedural.language.motions import MOTIONS
from kinematify.generate.procedural.language.openness import FRACTIONS
from kinematify.generate.procedural.language.parts import part_nouns
from kinematify.generate.procedural.language.reading import ParseState, nouns_of
from kinematify.generate.procedural.language.sizes import (
    DIMENSIONS,
    SIZE_WORDS,
    read_bare_length,
    read_overall,
    read_size_words,
    read_sizes,
)
from kinematify.generate.procedural.language.words import CHOICES, KINDS, NUMBERS, OPENNESS, singular, tokens_of
from kinematify.generate.procedural.layout import CELLS
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.language.compare import Missing
    from kinematify.generate.procedural.language.specification import Specification
    from kinematify.generate.procedural.parameter import Parameter, Value

_PLACES = {
    *("left", "right", "above", "below", "under", "beneath", "over", "top", "bottom", "beside", "next", "stacked"),
    *("column", "row", "grid", "lower", "upper"),
}
_NOT = ("no", "without")
_SWINGS = {"hinged", "hinge", "hinges", "opens", "opening", "swings"}
_DOUBLED = ("leaf", "sash", "door")
_OPEN = {"share": "open", "angle": "open_angle", "distance": "open_distance"}
_LESS = 0.95  # so much smaller, a size makes another object
_ABSURD = 4.0  # times out of its range, something is no such object


@dataclass(frozen=True, kw_only=True)
class Understanding:
    """A sentence as it was understood."""

    family: str
    values: Mapping[str, Value]
    """Parameter -> value."""
    used: frozenset[int]
    """Words that were taken up."""
    dropped: tuple[Missing, ...]
    """What such an object cannot have."""
    overall: tuple[str, float] | None
    """``width``, ``depth`` or ``height`` of the whole [m], where no parameter sets it."""
    copies: int
    """How many of it, side by side."""


def understand(specification: Specification, family: Family) -> Understanding:
    """Find out how a family builds what is asked for.

    Args:
        specification: What is asked for.
        family: What builds it.

    Raises:
        InputError: It contradicts itself, or asks for sizes or counts that no such object comes near.
    """
    vocabulary = vocabulary_of(family)
    tokens = tokens_of(specification.text, vocabulary)
    ranges = [item for part in specification.all_parts() for item in part.claims if item.about == "range"]
    apart = {k for part, owner in specification.handles() if owner for claim in part.claims for k in claim.at}
    reading = ParseState(
        tokens=tokens,
        family=family,
        used=set(specification.name),
        named=frozenset(specification.name),
        apart=frozenset(apart) if any(p.name == "handle" and p.choices for p in family.parameters) else frozenset(),
        ranges=frozenset(k for item in ranges for k in item.at),
        of_parts={
            k: part.noun.split()[-1]
            for part in specification.parts
            for claim in part.claims
            if claim.about == "size"
            for k in claim.at
        },
    )
    counting = (read_sizes, read_overall, read_grids, read_counts, read_counted_name)
    for step in (*counting, _double, _choices, _parts_it_has, read_bare_length):
        step(reading)
    _arrangement(reading)
    read_size_words(reading)
    _usual_of_its_kind(reading)
    made = _built(reading)
    _said_of_whole(reading, specification)
    _looks_of_handles(reading, specification, made)
    read_copies(reading)
    return Understanding(
        family=family.name,
        values=dict(reading.values),
        used=frozenset(reading.used),
        dropped=tuple(reading.dropped),
        overall=reading.overall,
        copies=reading.copies,
    )


def _double(reading: ParseState) -> None:
    """`a double gate` has two leaves."""
    for k in range(min(reading.named)):
        counts = [p for p in reading.family.parameters if isinstance(p.default, int)]
        parameter = next((p for p in counts if set(_DOUBLED) & set(nouns_of(p))), None)
        if reading.text(k) in KINDS and k not in reading.used and parameter and parameter.name not in reading.values:
            reading.take(parameter.name, NUMBERS[reading.text(k)], reading.text(k), k)


def _said_of_whole(reading: ParseState, specification: Specification) -> None:
    """Colour, material and openness of the object."""
    for claim in specification.whole.claims:
        name, value = claim.about, claim.value
        if name == "open":
            how, value = claim.value
            name = _OPEN[how]
        elif name not in ("material", "color"):
            continue
        if not reading.used & set(claim.at):
            reading.take(name, value, claim.words, *claim.at)


def _looks_of_handles(reading: ParseState, specification: Specification, made: Blueprint) -> None:
    """`brass knobs`, of what has handles that are no parts of their own."""
    nouns = part_nouns(reading.family, made)
    for part, owner in specification.handles():
        word = part.noun.split()[-1]
        if owner or (word,) in nouns or reading.parameter("handle") is None:
            continue
        for claim in part.claims:
            if claim.about in ("material", "color"):
                reading.take(f"handle_{claim.about}", claim.value, claim.words, *claim.at)


def _usual_of_its_kind(reading: ParseState) -> None:
    """A nightstand is a small cabinet with drawers alone; who counts anything counts all."""
    name = " ".join(reading.text(k) for k in sorted(reading.named))
    for key, value in reading.family.kinds.get(name, {}).items():
        if not (reading.mentions and isinstance(value, int)):
            reading.values.setdefault(key, value)


def _built(reading: ParseState) -> Blueprint:
    """The object as far as it can be built; what it cannot have is dropped.

    Raises:
        InputError: No such object comes near what is asked for.
    """
    for name, value in list(reading.values.items()):
        try:
            checked(reading.family, name, value)
        except InputError as error:
            _refuse_absurd(reading, name, value)
            reading.drop(name, _range(reading.parameter(name)) or str(error))
    made = _buildable(reading)
    for parameter in (p for p in reading.family.parameters if p.name in reading.said):
        # The layout says once more what is counted in it, and how that is arranged.
        in_layout = "layout" in reading.values and {*CELLS, "arrangement"} & {*nouns_of(parameter), parameter.name}
        if not in_layout and not _matters(reading, parameter, reading.values, made):
            made = _built_so_that_it_matters(reading, parameter, made)
    return made


def _refuse_absurd(reading: ParseState, name: str, value: Value) -> None:
    """Refuse what lies far out of the range of such objects.

    Raises:
        InputError: It does.
    """
    parameter = reading.parameter(name)
    if parameter is None or parameter.bounds is None or isinstance(value, str):
        return
    low, high = parameter.bounds
    if not low / _ABSURD <= float(value) <= high * _ABSURD or value <= 0:
        raise InputError(
            f"The text says {reading.said.get(name, name)!r}: a {reading.family.title} has {_range(parameter)}.\n"
            f'The nearest sentence that works: "a {reading.family.words[0]}".'
        )


def _range(parameter: Parameter | None) -> str:
    if parameter is None or parameter.bounds is None:
        return ""
    low, high = parameter.bounds
    return f"{parameter.name} from {low:g} to {high:g}{f' {parameter.unit}' if parameter.unit else ''}"


def _buildable(reading: ParseState) -> Blueprint:
    """The object without what cannot go together, the last said first.

    Raises:
        InputError: Not even what is usual can be built.
    """
    while True:
        try:
            return build(reading.family, reading.values)
        except InputError as error:
            unsaid = [name for name, value in reading.values.items() if name not in reading.said and value == 0]
            if unsaid and len(reading.said) <= 1:
                del reading.values[unsaid[-1]]  # who names a shelf may want doors, too
                continue
            if not reading.said or reading.values[next(reversed(reading.said))] == 0:
                raise InputError(f"{error} The text says {', '.join(map(repr, reading.said.values()))}.") from error
            reading.drop(next(reversed(reading.said)), str(error).split(". ", maxsplit=1)[0])


def _built_so_that_it_matters(reading: ParseState, parameter: Parameter, made: Blueprint) -> Blueprint:
    """The object with the kind that has what was asked for: two handles are of a tap with a handle on either side."""
    for kind in _spoken(reading.family):
        for choice in kind.choices if kind.name not in reading.values else ():
            values = {**reading.values, kind.name: choice}
            other = build(reading.family, values)
            if _matters(reading, parameter, values, other):
                reading.take(kind.name, choice, f"{kind.name}: {choice}")
                return other
    reading.drop(parameter.name, "not of this kind")
    return made


def _matters(reading: ParseState, parameter: Parameter, values: Mapping[str, Value], made: Blueprint) -> bool:
    """True if another value of a parameter would make another object: any other choice, one of the next numbers."""
    value = values[parameter.name]
    if isinstance(value, str):
        others: list[Value] = [choice for choice in parameter.choices if choice != value]
    else:
        low, high = parameter.bounds or (value, value)
        near = (value - 1, value + 1) if isinstance(value, int) else (_LESS * value, value / _LESS)
        others = [end for end in near if low <= end <= high]
        others += [type(value)(end) for end in (low, high) if end != value and len(others) < len(near)]
    return not others or any(_differs(reading, {**values, parameter.name: other}, made) for other in others)


def _differs(reading: ParseState, values: Mapping[str, Value], made: Blueprint) -> bool:
    try:
        return _shape(build(reading.family, values)) != _shape(made)
    except InputError:
        return True


def _shape(made: Blueprint) -> tuple[object, ...]:
    joints = ((joint.child, joint.kind, tuple(joint.axis), tuple(joint.pivot), joint.upper) for joint in made.joints)
    return (*((part.name, part.mesh_hash) for part in made.parts), *joints)


def vocabulary_of(family: Family) -> frozenset[str]:
    """All words that mean something of a family, singular."""
    words = {word for names in DIMENSIONS.values() for word in names} | {*OPENNESS, *FRACTIONS, *COLOR_WORDS}
    words |= {*SIZE_WORDS, *MOTIONS, *_PLACES, *(word for item in MATERIALS.values() for word in item.words)}
    for parameter in family.parameters:
        phrases = [*nouns_of(parameter), *(w for c in parameter.choices for w in _choice_words(parameter, c))]
        words.update(word for phrase in phrases for word in phrase.split())
    return frozenset(words | {word for name in family.words for word in name.split()})


def _choice_words(parameter: Parameter, choice: str) -> tuple[str, ...]:
    common = CHOICES.get(parameter.name, {}).get(choice, ())
    return (choice.replace("_", " "), *parameter.choice_words.get(choice, ()), *common) if choice else ()


def handle_choice(family: Family, noun: str) -> str:
    """The choice of handles that a noun says; empty where it says none."""
    parameter = next((p for p in family.parameters if p.name == "handle" and p.choices), None)
    said = [(words, c) for c in parameter.choices for words in _choice_words(parameter, c)] if parameter else []
    fits = [item for item in said if f" {noun} ".find(f" {item[0]} ") >= 0]
    return max(fits, key=lambda item: len(item[0]), default=("", ""))[1]


def _spoken(family: Family) -> list[Parameter]:
    """Parameters that a sentence may set; how it is modelled is none: a door of solid oak."""
    return [parameter for parameter in family.parameters if parameter.name != "modeling"]


def _choices(reading: ParseState) -> None:
    """`with knobs`, `sliding`, `barrel hinges`."""
    known = frozenset(word for token in reading.tokens for word in [token.text])
    for parameter in _spoken(reading.family):
        phrases = [(tuple(words.split()), c) for c in parameter.choices for words in _choice_words(parameter, c)]
        for words, choice in sorted(phrases, key=lambda item: -len(item[0])):  # `lifts off` before `lifts`
            for k in range(len(reading.tokens) - len(words) + 1):
                texts = tuple(reading.text(i) for i in range(k, k + len(words)))
                bare = tuple(singular(word, frozenset(words) | known) for word in texts)
                if words in (texts, bare) and _is_free(reading, range(k, k + len(words))):
                    _choose(reading, parameter, choice, range(k, k + len(words)))


def _is_free(reading: ParseState, where: range) -> bool:
    """True if words may say a choice: not taken up, but for the object's name and for a noun that was counted."""
    if reading.apart & set(where):
        return False
    taken = (reading.used - reading.named) & set(where)
    return not taken or (taken < set(where) and taken <= reading.counted)


def _choose(reading: ParseState, parameter: Parameter, choice: str, where: range) -> None:
    """Take a choice, with the noun behind it that it describes."""
    nouns = {word for noun in nouns_of(parameter) for word in (noun, f"{noun}s")}
    places = list(where)
    if reading.text(where.stop) in nouns:
        places.append(where.stop)
    places += [i for i in range(len(reading.tokens)) if reading.text(i) == parameter.name]
    if "none" in parameter.choices and reading.text(where.start - 1) in _NOT:
        reading.take(parameter.name, "none", f"no {parameter.name}", where.start - 1, *places)
    else:
        reading.take(parameter.name, choice, f"{parameter.name}: {choice}", *places)


def _parts_it_has(reading: ParseState) -> None:
    """`with a lid`: what every object of the family has, and only its kind could be chosen; `no handle`."""
    chosen = {name: p for p in reading.family.parameters if p.choices for name in (p.name, *p.words)}
    for k, token in enumerate(reading.tokens):
        parameter = chosen.get(token.text)
        if parameter is None or k in reading.used | reading.apart:
            continue
        if reading.text(k - 1) not in _NOT and parameter.default == "none":
            kind = next(choice for choice in parameter.choices if choice != "none")
            reading.take(parameter.name, kind, f"{parameter.name}: {kind}", k)
        elif reading.text(k - 1) not in _NOT:
            reading.used.add(k)
        elif "none" in parameter.choices:
            reading.take(parameter.name, "none", f"no {token.text}", k - 1, k)


def _arrangement(reading: ParseState) -> None:
    """Doors above drawers, columns, what is on the left: for families that have a layout."""
    if reading.parameter("layout") is None or "layout" in reading.values:
        return
    words = [token.text for token in reading.tokens]
    for k, word in enumerate(words):
        if word in ("left", "right") and _SWINGS & set(words[max(k - 4, 0) : k]):
            words[k] = ""  # the side of a hinge
    layout, used = layout_of(words, reading.mentions)
    if layout:
        reading.take("layout", layout, f"arranged as {layout}", *used)
    if reading.mentions:
        # Who names the doors and no drawers wants none.
        named = {mention.kind for mention in reading.mentions}
        for parameter in (p for p in reading.family.parameters if isinstance(p.default, int)):
            cell = CELLS.keys() & set(nouns_of(parameter))
            if cell and not cell & named and (parameter.bounds or (0,))[0] <= 0:
                reading.values[parameter.name] = 0
