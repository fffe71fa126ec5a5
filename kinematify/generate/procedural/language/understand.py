"""What a sentence asks for: the family, counts, sizes, choices, colours, arrangement and how far it stands open.

A grammar of small patterns over mended words, driven by what the families declare: nothing here knows a family.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.language.arrangement import layout_of
from kinematify.generate.procedural.language.counts import read_counted_name, read_counts, read_grids
from kinematify.generate.procedural.language.openness import FRACTIONS, OPENNESS, read_openness
from kinematify.generate.procedural.language.reading import Reading, nouns_of
from kinematify.generate.procedural.language.sizes import DIMENSIONS, read_bare_length, read_sizes
from kinematify.generate.procedural.language.words import (
    ARTICLES,
    CHOICES,
    STOP_WORDS,
    UNITS,
    Token,
    singular,
    tokens_of,
)
from kinematify.generate.procedural.layout import CELLS
from kinematify.generate.procedural.materials import COLORS, MATERIALS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.generate.procedural.family import Family, Parameter, Value

    _Name = tuple[tuple[str, ...], Family]

_HEAD_ENDS = {"with", "having", "has", "whose", "that", "which", "featuring", "and", "made", "on", "in", ",", ":", ";"}
_HAVING = ("with", "having", "has", "whose", "featuring", "containing")
_PLACES = {
    *("left", "right", "above", "below", "under", "beneath", "over", "top", "bottom", "beside", "next", "stacked"),
    *("column", "row", "grid", "lower", "upper"),
}
_NOT = ("no", "without")
_HINGES = ("hinge", "hinges", "joint", "pivot")
_SWINGING = ("swing", "swings", "swinging", "hinged", "turns", "rotates")
_STRANGE = 0.6  # of the words; with no English function word among them the text is in another language


@dataclass(frozen=True, kw_only=True)
class Understanding:
    """A sentence as it was understood."""

    family: str
    values: Mapping[str, Value]
    """Parameter -> value."""
    understood: tuple[str, ...]
    """One short phrase per thing that was taken up."""
    ignored: tuple[str, ...]
    """Words that mean nothing here, as they were written."""


def understand(sentence: str, families: Mapping[str, Family]) -> Understanding:
    """Find out what a sentence asks for.

    Args:
        sentence: English; slips of spelling are mended towards words that mean something here.
        families: What can be built, keyed by name.

    Raises:
        InputError: The text is empty, too long, not English, contradicts itself, or names nothing that can be built;
            then the nearest families are named.
    """
    vocabulary = _vocabulary(families.values())
    tokens = tokens_of(sentence, vocabulary)
    names = [(_bare(word, vocabulary), family) for family in families.values() for word in family.words]
    family, where = _family(sentence, tokens, names)
    reading = Reading(tokens=tokens, family=family, used=set(where), named=frozenset(where))
    reading.understood.append(family.title)
    for step in (
        read_sizes,
        read_grids,
        read_counts,
        read_counted_name,
        _choices,
        _parts_it_has,
        read_openness,
        read_bare_length,
        _looks,
    ):
        step(reading)
    _arrangement(reading)
    ignored = tuple(
        token.given
        for k, token in enumerate(tokens)
        if k not in reading.used and token.text not in STOP_WORDS and not token.is_sign
    )
    _refuse_what_makes_no_sense(sentence, reading, ignored)
    return Understanding(
        family=family.name,
        values=dict(reading.values),
        understood=tuple(reading.understood),
        ignored=ignored,
    )


def _refuse_what_makes_no_sense(sentence: str, reading: Reading, ignored: tuple[str, ...]) -> None:
    texts = [token.text for token in reading.tokens]
    hinge = any(word in _NOT and reading.text(k + 1) in _HINGES for k, word in enumerate(texts))
    if hinge and any(word in _SWINGING for word in texts):
        raise InputError(
            f"The text {sentence[:80]!r} asks for no hinge and for something that swings. What swings needs a hinge: "
            "leave out one of the two."
        )
    words = sum(not token.is_sign for token in reading.tokens)
    strange = sum(word.isalpha() and word not in UNITS for word in ignored)
    if strange > _STRANGE * words and not any(word in STOP_WORDS or word in _NOT for word in texts):
        raise InputError(
            f"Of the text {sentence[:80]!r} only {', '.join(reading.understood)} was understood. Describe the object "
            "in English, e.g. 'a cabinet with two doors above three drawers'."
        )


def _vocabulary(families: Iterable[Family]) -> set[str]:
    """All words that mean something, singular."""
    words = {word for names in DIMENSIONS.values() for word in names} | set(OPENNESS) | set(FRACTIONS) | set(COLORS)
    words |= {word for material in MATERIALS.values() for word in material.words} | _PLACES
    for family in families:
        for parameter in family.parameters:
            phrases = [*nouns_of(parameter), *(w for c in parameter.choices for w in _choice_words(parameter, c))]
            words.update(word for phrase in phrases for word in phrase.split())
    return words | {word for family in families for name in family.words for word in _bare(name, words)}


def _bare(phrase: str, words: set[str]) -> tuple[str, ...]:
    """The words of a name, singular where the singular means something by itself; glasses are not made of glasses."""
    substances = {word for material in MATERIALS.values() for word in material.words}
    return tuple(singular(word, frozenset(words - {word} - substances)) for word in phrase.split())


def _choice_words(parameter: Parameter, choice: str) -> tuple[str, ...]:
    common = CHOICES.get(parameter.name, {}).get(choice, ())
    return (choice.replace("_", " "), *parameter.choice_words.get(choice, ()), *common) if choice else ()


# ---- the family ----------------------------------------------------------------------------------------------------


def _family(sentence: str, tokens: tuple[Token, ...], names: Sequence[_Name]) -> tuple[Family, range]:
    """The family that the head of the sentence names: what stands before `with`, and there the last name.

    What an object has does not say what it is: a spaceship with a door is no door.
    """
    end = next((k for k, token in enumerate(tokens) if k > 0 and token.text in _HEAD_ENDS), len(tokens))
    found = _named(tokens[:end], names)
    if found:
        return next((whole for whole in found[:-1] if _counts_parts(tokens, whole[0], found[-1][1])), found[-1])
    having = next((k for k, token in enumerate(tokens) if token.text in _HAVING), len(tokens))
    anywhere = _named(tokens[:having], names)
    if anywhere:
        return anywhere[0]
    titles = {" ".join(words): family.title for words, family in names}
    near = [
        titles[match]
        for token in tokens
        for match in difflib.get_close_matches(token.text, titles, n=2, cutoff=0.6)
        if len(token.text) > 3
    ]
    nearest = list(dict.fromkeys(near or titles.values()))[:4]
    raise InputError(
        f"The text {sentence[:80]!r} names nothing that can be built. Nearest: {', '.join(nearest)}. Describe one "
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


def _choices(reading: Reading) -> None:
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


def _is_free(reading: Reading, where: range) -> bool:
    """Whether words may say a choice: not taken up, but for the object's name and for a noun that was counted."""
    taken = (reading.used - reading.named) & set(where)
    return not taken or (taken < set(where) and taken <= reading.counted)


def _choose(reading: Reading, parameter: Parameter, choice: str, where: range) -> None:
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


def _parts_it_has(reading: Reading) -> None:
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


def _looks(reading: Reading) -> None:
    """Colours and materials of the object; those of its handles cannot be chosen, and are left to be told."""
    found = [(k, name, value, said) for k in range(len(reading.tokens)) for name, value, said in _look(reading, k)]
    whole = [item for item in found if item[0] + 1 not in reading.used - reading.named]
    for name in ("color", "material"):
        looks = [item for item in whole if item[1] == name]
        # `white doors` say what a cabinet looks like, unless it was said of the cabinet itself.
        looks = looks or [item for item in found if item[1] == name and item[0] + 1 in reading.counted]
        for k, _, value, said in looks:
            reading.take(name, value, said, k)


def _look(reading: Reading, k: int) -> list[tuple[str, str, str]]:
    """Parameter, value and words for the user of a colour or material at word k."""
    word = reading.text(k)
    if k in reading.used:
        return []
    colors = [("color", word, word)] if word in COLORS else []
    return colors + [("material", name, f"made of {name}") for name, item in MATERIALS.items() if word in item.words]


def _arrangement(reading: Reading) -> None:
    """Doors above drawers, columns, what is on the left: for families that have a layout."""
    if reading.parameter("layout") is None or "layout" in reading.values:
        return
    layout, used = layout_of([token.text for token in reading.tokens], reading.mentions)
    if layout:
        reading.take("layout", layout, f"arranged as {layout}", *used)
    if reading.mentions:
        # Who names the doors and no drawers wants none.
        named = {mention.kind for mention in reading.mentions}
        for parameter in (p for p in reading.family.parameters if isinstance(p.default, int)):
            cell = CELLS.keys() & set(nouns_of(parameter))
            if cell and not cell & named and (parameter.bounds or (0,))[0] <= 0:
                reading.values[parameter.name] = 0
