"""What a sentence asks for: the family, counts, sizes, choices, colours, arrangement and how far it stands open.

A grammar of small patterns over mended words, driven by what the families declare: nothing here knows a family.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.family import build, checked
from kinematify.generate.procedural.language.arrangement import layout_of
from kinematify.generate.procedural.language.counts import read_copies, read_counted_name, read_counts, read_grids
from kinematify.generate.procedural.language.openness import FRACTIONS, read_openness
from kinematify.generate.procedural.language.parts import MOTIONS, PartReader
from kinematify.generate.procedural.language.reading import ParseState, nouns_of
from kinematify.generate.procedural.language.sizes import (
    DIMENSIONS,
    SIZE_WORDS,
    read_bare_length,
    read_overall,
    read_size_words,
    read_sizes,
)
from kinematify.generate.procedural.language.words import (
    ARTICLES,
    CHOICES,
    OPENNESS,
    STOP_WORDS,
    Token,
    nearest_word,
    singular,
    tokens_of,
)
from kinematify.generate.procedural.layout import CELLS
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.language.parts import PartRequirement
    from kinematify.generate.procedural.parameter import Parameter, Value

    _Name = tuple[tuple[str, ...], Family]

_HEAD_ENDS = {"with", "having", "has", "whose", "that", "which", "featuring", "and", "made", "on", "in", ",", ":", ";"}
_HAVING = ("with", "having", "has", "whose", "featuring", "containing")
_PLACES = {
    *("left", "right", "above", "below", "under", "beneath", "over", "top", "bottom", "beside", "next", "stacked"),
    *("column", "row", "grid", "lower", "upper"),
}
_NOT = ("no", "without")
_SWINGS = {"hinged", "hinge", "hinges", "opens", "opening", "swings"}
_JOINS = ("and", "with")  # what stands on either side is told apart
_MEANING_SIGNS = ("%", "°", "/", "+")
_SUGGESTED = 3  # words at most, of those that are not known


class NotUnderstoodError(InputError):
    """A sentence names nothing that is known, or has words that are not understood."""


class NoFamilyError(NotUnderstoodError):
    """It names nothing that is known."""


@dataclass(frozen=True, kw_only=True)
class Understanding:
    """A sentence as it was understood."""

    family: str
    values: Mapping[str, Value]
    """Parameter -> value."""
    understood: tuple[str, ...]
    """One short phrase per thing that was taken up."""
    ignored: tuple[str, ...]
    """Words that were not understood, as they were written, those that stand together in one; only if lenient."""
    requirements: tuple[PartRequirement, ...]
    """What is asked of the parts that no parameter sets."""
    overall: tuple[str, float] | None
    """``width``, ``depth`` or ``height`` of the whole [m], where no parameter sets it."""
    copies: int
    """How many of it, side by side."""


def understand(sentence: str, families: Mapping[str, Family], *, lenient: bool = False) -> Understanding:
    """Find out what a sentence asks for; every word of it is understood, or the sentence is refused.

    Args:
        sentence: English.
        families: What can be built, keyed by name.
        lenient: Mend slips of spelling towards words that mean something here, and leave out what is not understood.

    Raises:
        InputError: The text is empty, too long, contradicts itself, names nothing that can be built (then the nearest
            families are named), or has words that are not understood.
    """
    vocabulary = _vocabulary(families.values())
    tokens = tokens_of(sentence, vocabulary, mend=lenient)
    names = [(_bare(word, vocabulary), family) for family in families.values() for word in family.words]
    family, where = _family(sentence, tokens, names, vocabulary)
    reading = ParseState(tokens=tokens, family=family, used=set(where), named=frozenset(where))
    reading.understood.append(family.title)
    for step in (
        read_sizes,
        read_overall,
        read_grids,
        read_counts,
        read_counted_name,
        _choices,
        _parts_it_has,
        read_bare_length,
    ):
        step(reading)
    _arrangement(reading)
    read_size_words(reading)
    _usual_of_its_kind(reading)
    parts = PartReader(reading=reading, made=_built(reading))
    parts.looks()
    read_openness(reading, parts)
    parts.read()
    read_copies(reading)
    left = _left(reading)
    if left and not lenient:
        raise NotUnderstoodError(_not_understood(reading, left, vocabulary))
    return Understanding(
        family=family.name,
        values=dict(reading.values),
        understood=tuple(reading.understood),
        ignored=left,
        requirements=tuple(parts.requirements),
        overall=reading.overall,
        copies=reading.copies,
    )


def _usual_of_its_kind(reading: ParseState) -> None:
    """A nightstand is a small cabinet with drawers alone; who counts anything counts all."""
    name = " ".join(reading.text(k) for k in sorted(reading.named))
    for key, value in reading.family.kinds.get(name, {}).items():
        if not (reading.mentions and isinstance(value, int)):
            reading.values.setdefault(key, value)


def _built(reading: ParseState) -> Blueprint:
    """The object as far as it is understood.

    Raises:
        InputError: It cannot be built; the message has the words that ask for it.
    """
    for name, value in reading.values.items():
        try:
            checked(reading.family, name, value)
        except InputError as error:
            words = reading.said.get(name)
            raise InputError(f"{error} The text says {words!r}." if words else str(error)) from error
    try:
        made = build(reading.family, reading.values)
    except InputError as error:
        raise InputError(f"{error} The text says {', '.join(map(repr, reading.said.values()))}.") from error
    for parameter in (p for p in reading.family.parameters if p.name in reading.said):
        # The layout says once more what is counted in it, and how that is arranged.
        in_layout = "layout" in reading.values and {*CELLS, "arrangement"} & {*nouns_of(parameter), parameter.name}
        if not in_layout and not _matters(reading, parameter, reading.values, made):
            made = _built_so_that_it_matters(reading, parameter)
    return made


def _built_so_that_it_matters(reading: ParseState, parameter: Parameter) -> Blueprint:
    """The object with the kind that has what was asked for: two handles are of a tap with a handle on either side.

    Raises:
        InputError: There is no such kind.
    """
    for kind in reading.family.parameters:
        for choice in kind.choices if kind.name not in reading.values else ():
            values = {**reading.values, kind.name: choice}
            made = build(reading.family, values)
            if _matters(reading, parameter, values, made):
                reading.take(kind.name, choice, f"{kind.name}: {choice}")
                return made
    raise InputError(
        f"What the text says with {reading.said[parameter.name]!r} changes nothing of such a {reading.family.title}. "
        "Say it differently or leave it out."
    )


def _matters(reading: ParseState, parameter: Parameter, values: Mapping[str, Value], made: Blueprint) -> bool:
    """Whether another value of a parameter would make another object."""
    value = values[parameter.name]
    if isinstance(value, str):
        others: list[Value] = [choice for choice in parameter.choices if choice != value]
    else:
        low, high = parameter.bounds or (value, value)
        others = [type(value)(end) for end in (value - 1, value + 1, low, high) if low <= end <= high and end != value]
    for other in others:
        try:
            if _shape(build(reading.family, {**values, parameter.name: other})) != _shape(made):
                return True
        except InputError:
            return True
    return not others


def _shape(made: Blueprint) -> tuple[object, ...]:
    joints = ((joint.child, joint.kind, tuple(joint.axis), tuple(joint.pivot), joint.upper) for joint in made.joints)
    return (*((part.name, part.mesh_hash) for part in made.parts), *joints)


def _left(reading: ParseState) -> tuple[str, ...]:
    """Words that were not understood, those that stand together in one."""
    left: list[str] = []
    together = False
    for k, token in enumerate(reading.tokens):
        if k in reading.used or token.text in STOP_WORDS:
            together = together and token.text in STOP_WORDS and k not in reading.used and token.text not in _JOINS
        elif token.is_sign and token.text not in _MEANING_SIGNS:
            together = False
        elif together:
            left[-1] = f"{left[-1]} {token.given}"
        else:
            left.append(token.given)
            together = True
    return tuple(left)


def _not_understood(reading: ParseState, left: tuple[str, ...], vocabulary: set[str]) -> str:
    known = frozenset(vocabulary)
    words = dict.fromkeys(word for phrase in left for word in phrase.split())
    near = {word: nearest_word(word, known) for word in words}
    hints = [f"{nearest} for {word}" for word, nearest in near.items() if nearest][:_SUGGESTED]
    title = reading.family.title
    return (
        f"Not understood, or not possible with a {title}: {', '.join(map(repr, left))}. Nothing else is built in its "
        f"place.{f' Perhaps you mean {chr(44).join(hints)}.' if hints else ''} Say it differently or leave it out; "
        f"`kinematify generate --list --category {reading.family.name}` shows what a {title} may have, and --lenient "
        "builds it without."
    )


def _vocabulary(families: Iterable[Family]) -> set[str]:
    """All words that mean something, singular."""
    words = (
        {word for names in DIMENSIONS.values() for word in names} | set(OPENNESS) | set(FRACTIONS) | set(COLOR_WORDS)
    )
    words |= set(SIZE_WORDS) | set(MOTIONS)
    words |= {word for material in MATERIALS.values() for word in material.words} | _PLACES
    for family in families:
        for parameter in family.parameters:
            phrases = [*nouns_of(parameter), *(w for c in parameter.choices for w in _choice_words(parameter, c))]
            words.update(word for phrase in phrases for word in phrase.split())
    return words | {word for family in families for name in family.words for word in _bare(name, words)}


def _bare(phrase: str, words: set[str]) -> tuple[str, ...]:
    """The words of a name, singular where the singular means something by itself; glasses are not made of glasses."""
    substances = {word for material in MATERIALS.values() for word in material.words}
    return tuple(singular(word, frozenset(words - substances)) for word in phrase.split())


def _choice_words(parameter: Parameter, choice: str) -> tuple[str, ...]:
    common = CHOICES.get(parameter.name, {}).get(choice, ())
    return (choice.replace("_", " "), *parameter.choice_words.get(choice, ()), *common) if choice else ()


# ---- the family ----------------------------------------------------------------------------------------------------


def _family(
    sentence: str, tokens: tuple[Token, ...], names: Sequence[_Name], vocabulary: set[str]
) -> tuple[Family, range]:
    """The family that the head of the sentence names: what stands before `with`, the last of names side by side.

    What an object has does not say what it is: a spaceship with a door is no door; nor does what it is a part of, or
    for: a door handle is no door.
    """
    end = next((k for k, token in enumerate(tokens) if k > 0 and token.text in _HEAD_ENDS), len(tokens))
    having = next((k for k, token in enumerate(tokens) if token.text in _HAVING), len(tokens))
    found = _named(tokens[:end], names) or _named(tokens[:having], names)[:1]
    if not found:
        raise NoFamilyError(_names_nothing(sentence, tokens, names))
    family, where = next((item for item in found if _counts_parts(tokens, item[0], found[-1][1])), found[0])
    for other, behind in found:
        if behind.start == where.stop:
            family, where = other, behind if other is not family else range(where.start, behind.stop)
    after = tokens[where.stop].text if where.stop < len(tokens) else ""
    if after and singular(after, frozenset(_owned(family))) in _owned(family):
        name = " ".join(token.given for token in tokens[where.start : where.stop + 1])
        raise InputError(
            f"The text {sentence[:80]!r} names {name!r}, a part of a {family.title}; only whole objects can be built."
        )
    return family, where


def _owned(family: Family) -> set[str]:
    """Nouns for what belongs to an object of a family."""
    chosen = (word for p in family.parameters if p.choices for word in (p.name, *p.words))
    return {*chosen, *(noun for p in family.parameters if isinstance(p.default, int) for noun in nouns_of(p))}


def _names_nothing(sentence: str, tokens: tuple[Token, ...], names: Sequence[_Name]) -> str:
    titles = {" ".join(words): family.title for words, family in names}
    near = [
        titles[match]
        for token in tokens
        for match in difflib.get_close_matches(token.text, titles, n=2, cutoff=0.6)
        if len(token.text) > 3
    ]
    unknown = [t.given for t in tokens if t.text not in STOP_WORDS and t.number is None and not t.is_sign]
    nearest = f"Nearest by name: {', '.join(list(dict.fromkeys(near))[:4])}. " if near else ""
    return (
        f"The text {sentence[:80]!r} names nothing that can be built: {', '.join(unknown[:8])}. {nearest}Describe one "
        "object in English; `kinematify generate --list` shows all categories."
    )


def _counts_parts(tokens: tuple[Token, ...], family: Family, where: range) -> bool:
    """Whether the words are parts of a family, counted, as in `cabinet, three doors`."""
    number = tokens[where.start - 1].number if where.start else None
    if number is None or tokens[where.start - 1].text in ARTICLES:
        return False
    noun = " ".join(tokens[i].text for i in where)
    return any(isinstance(p.default, int) and noun in nouns_of(p) for p in family.parameters)


def _named(tokens: tuple[Token, ...], names: Sequence[_Name]) -> list[tuple[Family, range]]:
    """Families that are named, longest names first where they overlap, in the order of the sentence."""
    found: list[tuple[Family, range]] = []
    taken: set[int] = set()
    for words, family in sorted(names, key=lambda item: -len(item[0])):
        for k in range(len(tokens) - len(words) + 1):
            where = range(k, k + len(words))
            if tuple(tokens[i].text for i in where) == words and not taken & set(where):
                taken.update(where)
                found.append((family, where))
    return sorted(found, key=lambda item: item[1].start)


# ---- everything else -----------------------------------------------------------------------------------------------


def _choices(reading: ParseState) -> None:
    """`with knobs`, `sliding`, `barrel hinges`."""
    known = frozenset(word for token in reading.tokens for word in [token.text])
    for parameter in reading.family.parameters:
        phrases = [(tuple(words.split()), c) for c in parameter.choices for words in _choice_words(parameter, c)]
        for words, choice in sorted(phrases, key=lambda item: -len(item[0])):  # `lifts off` before `lifts`
            for k in range(len(reading.tokens) - len(words) + 1):
                texts = tuple(reading.text(i) for i in range(k, k + len(words)))
                bare = tuple(singular(word, frozenset(words) | known) for word in texts)
                if words in (texts, bare) and _is_free(reading, range(k, k + len(words))):
                    _choose(reading, parameter, choice, range(k, k + len(words)))


def _is_free(reading: ParseState, where: range) -> bool:
    """Whether words may say a choice: not taken up, but for the object's name and for a noun that was counted."""
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
        if parameter is None or k in reading.used:
            continue
        if reading.text(k - 1) not in _NOT:
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
