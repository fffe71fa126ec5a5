"""What a sentence asks for: the family, counts, sizes, choices, colours, arrangement and how far it stands open.

A grammar of small patterns over mended words, driven by what the families declare: nothing here knows a family.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.sources.procedural.language.arrangement import Mention, layout_of
from kinematify.sources.procedural.language.words import ARTICLES, STOP_WORDS, UNITS, Token, singular, tokens_of
from kinematify.sources.procedural.layout import CELLS
from kinematify.sources.procedural.materials import COLORS, MATERIALS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from kinematify.sources.procedural.family import Family, Parameter, Value

    _Name = tuple[tuple[str, ...], Family]

DIMENSIONS = {
    "width": ("wide", "width", "across", "broad"),
    "depth": ("deep", "depth"),
    "height": ("high", "tall", "height"),
    "length": ("long", "length"),
    "diameter": ("diameter",),
    "wall": ("thick", "thickness"),
}
"""Words for a size, keyed by the parameter that they mean."""
OPENNESS = {"closed": 0.0, "shut": 0.0, "folded": 0.0, "ajar": 0.15, "open": 1.0, "opened": 1.0, "unfolded": 1.0}
_FRACTIONS = {"half": 0.5, "halfway": 0.5, "quarter": 0.25, "slightly": 0.15, "partly": 0.4, "fully": 1.0, "wide": 1.0}
_HEAD_ENDS = {"with", "having", "has", "whose", "that", "which", "featuring", "and", "made", "on", "in", ",", ":", ";"}
_PLACES = {
    *("left", "right", "above", "below", "under", "beneath", "over", "top", "bottom", "beside", "next", "stacked"),
    *("column", "row", "grid", "lower", "upper"),
}
_OPENABLE = ("door", "lid", "drawer", "flap", "cover", "leaf", "window")
_JOINING = ("x", "by")
_NOT = ("no", "without")
_HINGES = ("hinge", "hinges", "joint", "pivot")
_SWINGING = ("swing", "swings", "swinging", "hinged", "turns", "rotates")
_STRANGE = 0.6  # of the words; with no English function word among them the text is in another language
_LINES = ("row", "column")
_NUMBER_ENDS = ("and", "with", "per", "each", "every")  # a number before one of them counts something else


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


@dataclass(kw_only=True)
class _Reading:
    """A sentence being read; words that were taken up are marked."""

    tokens: tuple[Token, ...]
    family: Family
    values: dict[str, Value] = field(default_factory=dict)
    understood: list[str] = field(default_factory=list)
    used: set[int] = field(default_factory=set)
    named: frozenset[int] = frozenset()
    """Where the family is named; a choice may be part of its name."""
    mentions: list[Mention] = field(default_factory=list)

    def text(self, k: int) -> str:
        """Word k, empty beyond the end."""
        return self.tokens[k].text if 0 <= k < len(self.tokens) else ""

    def take(self, name: str, value: Value, said: str, *where: int) -> None:
        """Set a parameter; two different values for one are a contradiction."""
        before = self.values.get(name)
        if before is not None and before != value:
            raise InputError(
                f"The text asks for {name} = {before} and for {name} = {value}. Say one of them for a "
                f"{self.family.title}."
            )
        if before is None:
            self.understood.append(said)
        self.values[name] = value
        self.used.update(where)

    def parameter(self, name: str) -> Parameter | None:
        """The family's parameter of a name."""
        return next((p for p in self.family.all_parameters if p.name == name), None)


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
    reading = _Reading(tokens=tokens, family=family, used=set(where), named=frozenset(where))
    reading.understood.append(family.title)
    _counted_name(reading, where)
    for step in (_sizes, _products, _grids, _counts, _choices, _parts_it_has, _openness, _looks):
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


def _refuse_what_makes_no_sense(sentence: str, reading: _Reading, ignored: tuple[str, ...]) -> None:
    texts = [token.text for token in reading.tokens]
    hinge = any(word in _NOT and reading.text(k + 1) in _HINGES for k, word in enumerate(texts))
    if hinge and any(word in _SWINGING for word in texts):
        raise InputError(
            f"The text {sentence[:80]!r} asks for no hinge and for something that swings. What swings needs a hinge: "
            "leave out one of the two."
        )
    words = sum(not token.is_sign for token in reading.tokens)
    if len(ignored) > _STRANGE * words and not any(word in STOP_WORDS for word in texts):
        raise InputError(
            f"Of the text {sentence[:80]!r} only {', '.join(reading.understood)} was understood. Describe the object "
            "in English, e.g. 'a cabinet with two doors above three drawers'."
        )


def _vocabulary(families: Iterable[Family]) -> set[str]:
    """All words that mean something, singular."""
    words = {word for names in DIMENSIONS.values() for word in names} | set(OPENNESS) | set(_FRACTIONS) | set(COLORS)
    words |= {word for material in MATERIALS.values() for word in material.words} | _PLACES
    for family in families:
        for parameter in family.parameters:
            phrases = [*_nouns(parameter), *(w for c in parameter.choices for w in _choice_words(parameter, c))]
            words.update(word for phrase in phrases for word in phrase.split())
    return words | {word for family in families for name in family.words for word in _bare(name, words)}


def _bare(phrase: str, words: set[str]) -> tuple[str, ...]:
    """The words of a name, singular where the singular means something by itself; glasses are not made of glasses."""
    substances = {word for material in MATERIALS.values() for word in material.words}
    return tuple(singular(word, frozenset(words - {word} - substances)) for word in phrase.split())


def _nouns(parameter: Parameter) -> tuple[str, ...]:
    """What a count or a size is called, singular."""
    own = parameter.name.replace("_", " ")
    return (own.removesuffix("s") if isinstance(parameter.default, int) else own, *parameter.words)


def _choice_words(parameter: Parameter, choice: str) -> tuple[str, ...]:
    return (choice.replace("_", " "), *parameter.choice_words.get(choice, ())) if choice else ()


# ---- the family ----------------------------------------------------------------------------------------------------


def _family(sentence: str, tokens: tuple[Token, ...], names: Sequence[_Name]) -> tuple[Family, range]:
    """The family that the head of the sentence names: what stands before `with`, and there the last name."""
    end = next((k for k, token in enumerate(tokens) if k > 0 and token.text in _HEAD_ENDS), len(tokens))
    found = _named(tokens[:end], names)
    if found:
        return next((whole for whole in found[:-1] if _counts_parts(tokens, whole[0], found[-1][1])), found[-1])
    anywhere = _named(tokens, names)
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
        f"The text {sentence[:80]!r} names nothing that can be built. Nearest: {', '.join(nearest)}. `kinematify "
        "generate --list` shows all categories."
    )


def _counts_parts(tokens: tuple[Token, ...], family: Family, where: range) -> bool:
    """Whether the words are parts of a family, counted, as in `cabinet, three doors`."""
    number = tokens[where.start - 1].number if where.start else None
    if number is None or tokens[where.start - 1].text in ARTICLES:
        return False
    noun = " ".join(tokens[i].text for i in where)
    return any(isinstance(p.default, int) and noun in _nouns(p) for p in family.parameters)


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


# ---- sizes ---------------------------------------------------------------------------------------------------------


def _sizes(reading: _Reading) -> None:
    """`80 cm wide`, `a height of 2 m`, `0.3 m in diameter`."""
    k = 0
    while k < len(reading.tokens):
        length = _length(reading, k)
        if length is None:
            k += 1
            continue
        metres, end = length
        for at in (end, end + 1, k - 1, k - 2):
            name = _dimension(reading, reading.text(at)) if at not in reading.used else None
            if name is not None:
                reading.take(name, metres, f"{name} {metres:g} m", *range(min(k, at), max(end, at + 1)))
                break
        k = end


def _length(reading: _Reading, k: int) -> tuple[float, int] | None:
    """A number with a unit at word k: metres, and the word behind it."""
    number, unit = reading.tokens[k].number, reading.text(k + 1)
    if number is None or unit not in UNITS or (unit == "in" and reading.text(k + 2) in ("diameter", "total")):
        return None
    if reading.text(k + 2) == "in" and reading.text(k + 3) == "diameter":
        return round(number * UNITS[unit], 9), k + 3
    return round(number * UNITS[unit], 9), k + 2


def _dimension(reading: _Reading, word: str) -> str | None:
    """The parameter that a word for a size means in this family."""
    lengths = [p for p in reading.family.all_parameters if p.unit == "m"]
    own = next((p.name for p in lengths if word and word in p.words), None)
    if own is not None:
        return own
    name = next((name for name, words in DIMENSIONS.items() if word in words), None)
    if name == "length" and reading.parameter("length") is None:
        name = "width"
    return name if name is not None and reading.parameter(name) is not None else None


def _products(reading: _Reading) -> None:
    """`20 x 15 x 10 cm` is width, depth and height."""
    for k in range(len(reading.tokens)):
        numbers, places, at = [], [], k
        while reading.tokens[at : at + 1] and reading.tokens[at].number is not None and at not in reading.used:
            numbers.append(float(reading.tokens[at].number or 0.0))
            places.append(at)
            unit = reading.text(at + 1) if reading.text(at + 1) in UNITS else ""
            at += 2 if unit else 1
            if reading.text(at) not in _JOINING or len(numbers) == 3:
                break
            at += 1
        units = [reading.text(i) for i in range(k, at + 1) if reading.text(i) in UNITS]
        if len(numbers) == 3 and units:
            scale = UNITS[units[-1]]
            for name, number in zip(("width", "depth", "height"), numbers, strict=True):
                if reading.parameter(name) is not None:
                    size = round(number * scale, 9)
                    reading.take(name, size, f"{name} {size:g} m", *range(k, at + 1))


# ---- grids ---------------------------------------------------------------------------------------------------------


def _grids(reading: _Reading) -> None:
    """`six drawers in 3 rows and 2 columns`, `two columns of four drawers`; of what the family's name has, too."""
    for k in range(len(reading.tokens)):
        grid = _grid(reading, k)
        found = grid and _gridded(reading, k, grid[2])
        if not grid or not found:
            continue
        columns, rows, end = grid
        parameter, noun = found
        total = columns * rows
        number, first = _number_before(reading, noun) if noun < k else (None, k)
        said = f"{total} {parameter.name} in {columns} columns and {rows} rows"
        reading.take(parameter.name, number or total, said, *range(first, k))
        reading.take(parameter.name, total, said, *range(k, end), noun)
        reading.mentions.append(
            Mention(kind=_kind(parameter), count=total, first=min(k, noun), last=max(end - 1, noun), grid=grid[:2])
        )


def _grid(reading: _Reading, k: int) -> tuple[int, int, int] | None:
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


def _gridded(reading: _Reading, k: int, end: int) -> tuple[Parameter, int] | None:
    """What stands in the grid, and the word that says so: the next word, or the nearest one before."""
    for at in (end, *range(k - 1, -1, -1)):
        for parameter in reading.family.parameters:
            nouns = _nouns(parameter)
            if isinstance(parameter.default, int) and singular(reading.text(at), frozenset(nouns)) in nouns:
                return parameter, at
    return None


# ---- counts --------------------------------------------------------------------------------------------------------


def _counts(reading: _Reading) -> None:
    """`two doors`, `3 small drawers`, `no handle`, `a grid of 3 by 2 drawers`, `half a dozen knobs`."""
    counted = [p for p in reading.family.parameters if isinstance(p.default, int)]
    for parameter in counted:
        for noun in sorted(_nouns(parameter), key=len, reverse=True):
            words = tuple(noun.split())
            for k in range(len(reading.tokens) - len(words) + 1):
                where = range(k, k + len(words))
                read = tuple(singular(reading.text(i), frozenset(words)) for i in where)
                if read == words and not reading.used & set(where):
                    _count(reading, parameter, where)


def _count(reading: _Reading, parameter: Parameter, where: range) -> None:
    """Take up a noun that can be counted, with the number before it if there is one."""
    number, first = _number_before(reading, where.start)
    if number is not None:
        reading.take(parameter.name, number, f"{number} {parameter.name}", *range(first, where.stop))
    reading.used.update(where)
    count = reading.values.get(parameter.name, parameter.default)
    reading.mentions.append(
        Mention(kind=_kind(parameter), count=int(count), first=min(first, where.start), last=where.stop - 1)
    )


def _counted_name(reading: _Reading, where: range) -> None:
    """`a double door` has two of what a door is made of, where the family counts them by its own name."""
    name = " ".join(reading.text(i) for i in where)
    number, first = _number_before(reading, where.start)
    if (reading.text(where.start - 2), reading.text(where.start - 1)) == ("pair", "of"):  # of glasses, of scissors
        reading.used.add(where.start - 2)
    parameter = next((p for p in reading.family.parameters if isinstance(p.default, int) and name in _nouns(p)), None)
    if parameter is not None and number is not None and number > 1:
        counting = [k for k in range(first, where.start) if reading.tokens[k].number is not None]
        reading.take(parameter.name, number, f"{number} {parameter.name}", *counting)


def _kind(parameter: Parameter) -> str:
    """The cell of a layout that a parameter counts, else its noun."""
    return next((noun for noun in _nouns(parameter) if noun in CELLS), _nouns(parameter)[0])


def _number_before(reading: _Reading, k: int) -> tuple[int | None, int]:
    """The number that counts the noun at word k, and the word that it begins at."""
    at = k - 1
    while at >= 0 and k - at <= 3:
        token = reading.tokens[at]
        if token.number is not None and at not in reading.used:
            number, first = int(token.number), at
            if reading.text(at - 1) in _JOINING and at >= 2 and reading.tokens[at - 2].number is not None:
                return number * int(reading.tokens[at - 2].number or 1), at - 2
            if token.text == "dozen":
                number = 6 if reading.text(at - 2) == "half" else 12 * _plain_number(reading, at - 1)
                first = at - 2 if reading.text(at - 2) == "half" else at - 1
            if reading.text(at - 1) in ARTICLES:
                first = at - 1
            return number, first
        if token.is_sign or at in reading.used or token.text in _NUMBER_ENDS:
            return None, k
        at -= 1
    return None, k


def _plain_number(reading: _Reading, k: int) -> int:
    number = reading.tokens[k].number if k >= 0 else None
    return int(number) if number else 1


# ---- everything else -----------------------------------------------------------------------------------------------


def _choices(reading: _Reading) -> None:
    """`with knobs`, `sliding`, `barrel hinges`."""
    known = frozenset(word for token in reading.tokens for word in [token.text])
    for parameter in reading.family.parameters:
        phrases = [(tuple(words.split()), c) for c in parameter.choices for words in _choice_words(parameter, c)]
        for words, choice in sorted(phrases, key=lambda item: -len(item[0])):  # `lifts off` before `lifts`
            for k in range(len(reading.tokens) - len(words) + 1):
                texts = tuple(reading.text(i) for i in range(k, k + len(words)))
                bare = tuple(singular(word, frozenset(words) | known) for word in texts)
                if words in (texts, bare) and not (reading.used - reading.named) & set(range(k, k + len(words))):
                    where = list(range(k, k + len(words)))
                    if reading.text(where[-1] + 1) in (parameter.name, f"{parameter.name}s"):
                        where.append(where[-1] + 1)
                    where += [i for i in range(len(reading.tokens)) if reading.text(i) == parameter.name]
                    if "none" in parameter.choices and reading.text(k - 1) in _NOT:
                        reading.take(parameter.name, "none", f"no {parameter.name}", k - 1, *where)
                        continue
                    reading.take(parameter.name, choice, f"{parameter.name}: {choice}", *where)


def _parts_it_has(reading: _Reading) -> None:
    """`with a lid`: what every object of the family has, and only its kind could be chosen; `no handle`."""
    chosen = {name: p for p in reading.family.parameters if p.choices for name in (p.name, *p.words)}
    for k, token in enumerate(reading.tokens):
        parameter = chosen.get(token.text)
        if parameter and "none" in parameter.choices and reading.text(k - 1) in _NOT:
            reading.take(parameter.name, "none", f"no {token.text}", k - 1, k)
        elif parameter:
            reading.used.add(k)


def _openness(reading: _Reading) -> None:
    """`half open`, `closed`, `ajar`; an open shelf is not meant."""
    if reading.parameter("open") is None:
        return
    for k, token in enumerate(reading.tokens):
        if token.text not in OPENNESS or k in reading.used or reading.text(k + 1) in ("shelf", "compartment", "front"):
            continue
        share, first = OPENNESS[token.text], k
        if reading.text(k - 1) == "fully":
            first = k - 1
        if share == 1.0:
            for before in (k - 1, k - 2):
                if reading.text(before) in _FRACTIONS:
                    share, first = _FRACTIONS[reading.text(before)], before
            if reading.text(k + 1) in _FRACTIONS and reading.text(k + 1) != "wide":
                share = _FRACTIONS[reading.text(k + 1)]
                reading.used.update((k + 1, k + 2) if reading.text(k + 2) == "way" else (k + 1,))
        reading.take("open", share, f"{share:.0%} open", *range(first, k + 1))
        if reading.text(first - 1) in _OPENABLE:  # `its door ajar`: what stands so is one of the moving parts
            reading.used.add(first - 1)


def _looks(reading: _Reading) -> None:
    """Colours and materials."""
    for k, token in enumerate(reading.tokens):
        if k in reading.used:
            continue
        if token.text in COLORS:
            reading.take("color", token.text, token.text, k)
        for name, material in MATERIALS.items():
            if token.text in material.words:
                reading.take("material", name, f"made of {name}", k)


def _arrangement(reading: _Reading) -> None:
    """Doors above drawers, columns, what is on the left: for families that have a layout."""
    if reading.parameter("layout") is None or "layout" in reading.values:
        return
    layout, used = layout_of([token.text for token in reading.tokens], reading.mentions)
    if layout:
        reading.take("layout", layout, f"arranged as {layout}", *used)
    if reading.mentions:
        # Who names the doors and no drawers wants none.
        for parameter in reading.family.parameters:
            if _kind(parameter) in CELLS and all(mention.kind != _kind(parameter) for mention in reading.mentions):
                reading.values[parameter.name] = 0
