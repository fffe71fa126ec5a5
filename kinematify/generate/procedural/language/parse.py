"""Parse a sentence into a `Specification`: noun phrases, what is said of them, and where they are; nothing is built.

The kind of object is the noun at the end of the first noun phrase. What comes behind `with`, `and`, `whose` or `where`
is a part; a verb, a place, a size or a colour belongs to the part that was named last, and behind a comma to the
object.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.procedural.language.motions import BARE, DONE, GOING, LINES, MOTIONS, PARTICLES, WAYS
from kinematify.generate.procedural.language.openness import NOT_A_STATE, PULLED, amount_at, measured_at
from kinematify.generate.procedural.language.sizes import DIMENSIONS, SIZE_WORDS, length_at
from kinematify.generate.procedural.language.specification import Claim, PartSpecification, Specification
from kinematify.generate.procedural.language.words import (
    ARTICLES,
    KINDS,
    NUMBERS,
    OPENNESS,
    PLAIN_WORDS,
    PURPOSES,
    STOP_WORDS,
    UNITS,
    Words,
    lemma,
    nouns_in,
    tokens_of,
)
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from kinematify.generate.procedural.language.words import Token

_WITH = ("with", "having", "has", "have", "featuring", "including", "containing", "plus", "carrying", "holding")
_JOINERS = ("and", ",", ";", ":", ".", "or", "but", "also", "as", "well", "then", "except")
_RELATIVE = ("that", "which", "who")
_PREPOSITIONS = (
    "on", "at", "in", "inside", "under", "underneath", "below", "beneath", "above", "over", "behind", "beside",
    "between", "about", "across",
    "next", "than", "around", "along", "from", "to", "into", "of", "for", "by", "through", "onto", "against", "near",
)  # fmt: skip
_AT = ("on", "at", "in", "to", "near", "from", "against", "by", "along", "onto")
"""Before a place they say that something is there."""
_BEGINS_PART = (*_WITH, *_RELATIVE, "whose", "where", "without", *_JOINERS)
_BEING = ("is", "are", "can", "could", "be", "may", "will", "each", "all", "both", "it", "they", "being", "also")
_CAN = ("be", "can", "to", "may")
_GOES = ("go", "goes", "opens", "come", "comes")
_ANYHOW = ("away", "aside", "open", "over")
"""Behind a particle they say no direction: a swing-away arm."""
_ANGLES = ("degree", "degrees", "deg")
_BY = ("by", "through", "over")
_MOVED = frozenset({*WAYS, *MOTIONS, *DONE, *GOING, *OPENNESS} - {"closed", "shut"})
"""Words behind which they say how far."""
_STILL = ("fixed", "immovable", "stationary", "immobile", "motionless")
"""Before a noun they say that it does not move."""
_TRAVEL = ("travel", "stroke", "throw", "movement", "motion", "lift")
"""How far something goes, as a noun."""
_DYNAMICS = {
    tuple(words.split()): value
    for value, phrases in {
        "held": "stays open, stay open, stays up, stay up, stays in place, stay in place, stays put, stay put, holds "
        "its position, hold their position, stays where it is, stay where they are",
        "damped": "soft close, soft closing, slow close, slow closing, softly closing, damped, closes softly",
        "sprung": "self closing, closes by itself, close by themselves, closes automatically, shuts by itself, sprung, "
        "spring loaded, closes itself, returns by itself, springs back",
        "stiff": "stiff",
    }.items()
    for words in phrases.replace("\n", " ").split(", ")
}
"""How a joint answers to a push."""
_TO_BOTH = tuple(
    tuple(words.split())
    for words in (
        "to either side", "to each side", "to both sides", "on either side", "either way", "each way",
        "in either direction", "in both directions", "in each direction", "left and right", "up and down",
    )
)  # fmt: skip
"""Behind how far something goes: it goes so far twice."""
_PRONOUNS = ("it", "them", "these", "those")
_DROPPED = ("up", "down")
"""Behind a part at the end of a statement they say that it is open there."""
_HELD = ("propped", "held", "standing", "stands", "stand", "left", "wedged", "stays", "stay", "locked")
"""Before a state they say nothing more."""
_BACK = ("lowered", "retracted", "collapsed")
"""Behind a share they say how far something is back at its lower limit."""
_DETERMINERS = (
    "a", "an", "the", "its", "their", "some", "any", "each", "every", "both", "all", "other", "another", "either",
)  # fmt: skip
PLACES = (
    "left", "right", "top", "bottom", "front", "back", "rear", "upper", "lower", "middle", "side", "underside",
    "inside", "first",
    "outside", "center", "centre", "corner", "end", "uppermost", "lowest", "outer", "inner", "central", "underneath",
)  # fmt: skip
_ORDINALS = ("second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth")
LEVELS = {
    "underneath": "bottom", "below": "bottom", "beneath": "bottom", "under": "bottom", "above": "top", "over": "top",
    "overhead": "top",
}  # fmt: skip
"""Places that are said without a noun behind them: `with a drawer below`."""
_ALONE = {"inside": "inside", "behind": "back", "between": "between"}
"""The same, of which none is a level."""
MATERIAL_WORDS = {word: name for name, material in MATERIALS.items() for word in material.words}
_UNDER_WHOLE = ("wheel", "caster", "castor", "leg", "foot", "roller", "runner", "base", "stand", "track", "skid")
_HINGES = ("front", "rear", "top", "bottom")
"""Where something is hinged that is no way to go."""
_PIECES = ("half", "part", "piece", "section", "leaf")
"""What is in two of them is two."""
_GROUPS = ("row", "column", "stack", "grid", "pair", "set", "bank", "line")
"""What is counted behind them is counted in each."""
_ADJUSTABLE = ("adjustable", "variable", "changeable")
_MEASURES = {"height": "up", "angle": "", "length": "", "width": "", "tilt": "", "reach": "", "position": ""}
FUNCTION_WORDS = frozenset(
    {*_BEGINS_PART, *_PREPOSITIONS, *_BEING, *_DETERMINERS, "other", "way", "flat", "one", "ones", "side"}
)
"""Words that say how others belong together."""
_NO_NOUN = frozenset({*PLAIN_WORDS, "way", "one", "ones", "stacked"})
_DONE_ENDS = ("ed", "ing")
_QUOTED = 15  # words of a sentence in a message
_SHORTEST_DONE = 5
NOT_DONE = frozenset({"spring", "string", "bearing", "railing", "awning", "ceiling", "building", "painting"})
"""Nouns that end as verbs do."""
HAVING: dict[str, tuple[str, int | None]] = {
    "lockable": ("lock", 1), "locking": ("lock", 1), "locked": ("lock", 1), "rolling": ("caster", None),
}  # fmt: skip
"""Adjectives -> what has to be there, and how many; None is some."""
_STATES = (
    "half", "way", "halfway", "slightly", "partly", "fully", "wide", "apart", "x", "about", "degree", "degrees", "ajar",
)  # fmt: skip
"""Behind the name of an object they say how far it stands open."""


@dataclass
class _Draft:
    """A part while it is read."""

    nouns: list[int] = field(default_factory=list)
    count: int | None = 1
    claims: list[Claim] = field(default_factory=list)
    of: str = ""


def parse(
    sentence: str,
    kinds: Collection[tuple[str, ...]],
    mechanisms: Collection[str] = (),
    harmless: tuple[str, ...] = (),
) -> Specification:
    """Parse a sentence about one object.

    Args:
        sentence: English.
        kinds: The names of all kinds of object, singular, as words.
        mechanisms: Nouns of what may be named before the object that carries it: `a turntable on a table`.
        harmless: What was omitted of it already, see `Specification.harmless`.

    Raises:
        InputError: It is empty, too long, no English, or names no kind of object that is known.
    """
    tokens = tokens_of(sentence, ())
    name = head_of(tokens, kinds, mechanisms)
    if not name:
        raise InputError(unknown_object(tokens, kinds))
    return _specified(sentence, tokens, name, harmless, mechanisms)


def parse_any(sentence: str) -> Specification:
    """Parse a sentence about an object of any kind: its name is the noun that ends the first noun phrase.

    Raises:
        InputError: It is empty, too long, or no English.
    """
    tokens = tokens_of(sentence, ())
    boundaries = (*_BEGINS_PART, *_PREPOSITIONS)
    end = next((k for k, token in enumerate(tokens) if k and token.given in boundaries), len(tokens))
    nouns = [k for k in range(end) if not may_follow(tokens, k)] or [max(end - 1, 0)]
    return _specified(sentence, tokens, (nouns[-1],), ())


def _specified(
    sentence: str,
    tokens: tuple[Token, ...],
    name: tuple[int, ...],
    harmless: tuple[str, ...],
    mechanisms: Collection[str] = (),
) -> Specification:
    reader = _Parser(tokens, name, mechanisms)
    reader.read()
    return Specification(
        text=sentence,
        tokens=tokens,
        name=name,
        whole=reader.finished(reader.whole, " ".join(lemmas(tokens, name))),
        parts=(
            *(reader.finished(part, reader.noun(part)) for part in reader.parts if part.nouns),
            *(replace(part, of="" if of is reader.whole else reader.noun(of)) for of, part in reader.implied),
        ),
        harmless=harmless,
    )


# ---- which object --------------------------------------------------------------------------------------------------


def lemmas(tokens: Sequence[Token], at: Sequence[int]) -> list[str]:
    """Words at some places, the last one singular."""
    given = [tokens[k].given for k in at]
    return [*given[:-1], lemma(given[-1])] if given else []


def names_at(tokens: Sequence[Token], start: int, kinds: Collection[tuple[str, ...]]) -> range:
    """The longest name of a kind that begins at a word; empty if there is none."""
    for length in range(min(6, len(tokens) - start), 0, -1):
        words = tuple(token.given for token in tokens[start : start + length])
        if words in kinds or (*words[:-1], lemma(words[-1])) in kinds:
            return range(start, start + length)
    return range(0)


def head_of(
    tokens: Sequence[Token], kinds: Collection[tuple[str, ...]], mechanisms: Collection[str]
) -> tuple[int, ...]:
    """The words that name the object: the last known name of the first noun phrase, if no unknown noun follows it."""
    found: list[range] = []
    k = 0
    while k < len(tokens):
        name = names_at(tokens, k, kinds)
        if name and (not found or not _counts(tokens, name.start) or _counts(tokens, found[-1].start)):
            found.append(name)
            k = name.stop
            continue
        if name:
            break
        text = tokens[k].given
        carried = text == "on" and not found and k > 0 and lemma(tokens[k - 1].given) in mechanisms
        carried = carried or (text == "of" and not found)  # a pair of stools
        carried = carried or (text == "in" and tokens[k - 1].given == "built")
        carried = carried or (text == "," and not found and all(may_follow(tokens, at) for at in range(k)))
        if k > 0 and (text in _BEGINS_PART or text in _PREPOSITIONS) and not carried:
            break
        if found and not may_follow(tokens, k):
            return ()
        k += 1
    return tuple(found[-1]) if found else ()


def _counts(tokens: Sequence[Token], k: int) -> bool:
    """True if a number stands before word k, and no article."""
    before = tokens[k - 1] if k else None
    return before is not None and before.number is not None and before.given not in (*ARTICLES, *KINDS)


def may_follow(tokens: Sequence[Token], k: int) -> bool:
    """True if a word behind a name leaves it the head: a size, a state, a look or a verb, no other noun."""
    token = tokens[k]
    word = token.given
    known = (
        word in STOP_WORDS
        or lemma(word) in UNITS
        or word in UNITS
        or word in COLOR_WORDS
        or word in MATERIAL_WORDS
        or word in OPENNESS
    )
    known = known or token.number is not None or token.is_sign or word in MOTIONS or word in DONE or word in GOING
    known = known or any(word in words for words in DIMENSIONS.values()) or word in PLACES or word in SIZE_WORDS
    done = word.endswith(_DONE_ENDS) and len(word) > _SHORTEST_DONE and word not in NOT_DONE
    return known or done or word in _STATES


def unknown_object(tokens: Sequence[Token], kinds: Collection[tuple[str, ...]]) -> str:
    """Say that no such object is known, with the nearest sentence that works."""
    end = next((k for k, token in enumerate(tokens) if k and token.given in _BEGINS_PART), len(tokens))
    content = [token.given for token in tokens[:end] if token.given not in STOP_WORDS and token.number is None]
    content = [word for word in content if word.isalpha()]
    nearest = _nearest(content, kinds)
    said = " ".join(content) or " ".join(token.given for token in tokens[:8])
    return (
        f"{' '.join(token.given for token in tokens[:_QUOTED])!r} names no kind of object that is known: there is no "
        f"{said!r}. `kinematify generate --list` shows all kinds.\n"
        f'The nearest sentence that works: "{"an" if nearest[0] in "aeiou" else "a"} {nearest}".'
    )


def _nearest(content: Sequence[str], kinds: Collection[tuple[str, ...]]) -> str:
    """The name of a kind that is most like some words: it ends with one of them, else it is spelled alike."""
    names = sorted(" ".join(kind) for kind in kinds)
    for word in reversed(content):
        ends = [name for name in names if name.split()[-1] == lemma(word)]
        if ends:
            return min(ends, key=lambda name: (len(name.split()), name))
    for word in reversed(content):
        near = difflib.get_close_matches(word, names, n=1, cutoff=0.7)
        if near:
            return near[0]
    return "cabinet with two doors"


def _dimension(word: str) -> str:
    return next((name for name, words in DIMENSIONS.items() if word in words), "")


# ---- its parts -----------------------------------------------------------------------------------------------------


class _Parser(Words):
    """Goes through a sentence once; every word belongs to the part that was named last, or to the object."""

    def __init__(self, tokens: tuple[Token, ...], name: Sequence[int], mechanisms: Collection[str]) -> None:
        """Begin before the first word."""
        super().__init__(tokens)
        self.name = name
        self.mechanisms = mechanisms
        self.whole = _Draft(nouns=list(name))
        self.parts: list[_Draft] = []
        self.pending: list[Claim] = []
        """Said of a part whose noun is still to come."""
        self.implied: list[tuple[_Draft, PartSpecification]] = []
        """By an adjective of a part."""
        self.current = self.whole
        self.subject = self.whole
        """Of the verbs to come."""

    def given(self, k: int) -> str:
        """Word k as it was written, empty beyond the ends."""
        return self.tokens[k].given if 0 <= k < len(self.tokens) else ""

    def noun(self, part: _Draft) -> str:
        """Return what a part is called, singular."""
        words = lemmas(self.tokens, part.nouns)
        of = nouns_in(words[-1]) if words else ()
        return " ".join([*words[:-1], *([noun for noun in of if noun in self.mechanisms] or words[-1:])[:1]])

    def finished(self, part: _Draft, noun: str) -> PartSpecification:
        """A part that was read."""
        there = Claim(about="there", value=True, words=self.said(part.nouns), at=tuple(part.nouns))
        return PartSpecification(noun=noun, count=part.count, claims=(there, *part.claims), of=part.of)

    def said(self, where: Sequence[int]) -> str:
        """Words as they were written."""
        return " ".join(self.given(k) for k in sorted(where))

    def claim(self, part: _Draft, about: str, value: Any, *where: int) -> None:
        """Take up what is said of a part."""
        part.claims.append(Claim(about=about, value=value, words=self.said(where), at=tuple(where)))

    def read(self) -> None:
        """Take up every word."""
        on = (k for k in range(1, self.name[0]) if self.given(k) == "on" and self._is_mechanism(k - 1))
        k = next(on, -1) + 1
        if k:  # a turntable on a red table
            self._part(0)
            self.current = self.subject = self.whole
        k = self._noun_phrase(k, self.whole)
        while k < len(self.tokens):
            k = max(self._part(k + 2) if self._says(k, ("of", "which")) else self._clause(k), k + 1)

    def _is_mechanism(self, k: int) -> bool:
        """True if a word, as in `wheels` or `wheeled`, names a mechanism."""
        return any(noun in self.mechanisms for noun in nouns_in(self.given(k)))

    def _clause(self, k: int) -> int:
        """Return what begins at word k: another part, or what is said of the last one."""
        word = self.given(k)
        if self._is_share(k):
            return self._share(k)
        if word in ("without", "minus"):
            return self._part(k + 1, count=0, of=self._individual(k))
        if word in _WITH:
            individual = self._individual(k)
            if individual is None and word in ("with", "featuring", "including", "plus"):
                self.subject = self.whole
            return self._part(k + 1, of=individual)
        if word in ("whose", "where", "while"):
            owner = self.current if word == "whose" and self.current is not self.whole else None
            return self._part(k + 1, of=owner)
        if word in _RELATIVE:
            if self._is_of_one(k + 1) and self.current.count != 1:  # two doors that is; a cabinet with two doors
                self.current = self.whole
            self.subject = self.current
            return k + 1
        return self._joined(k) if word in _JOINERS else self._said_behind(k)

    def _is_of_one(self, k: int) -> bool:
        """True if a verb is of one thing: `is`, `opens`."""
        word = self.given(k)
        return word in ("is", "has") or (word.endswith("s") and (word in MOTIONS or word in GOING))

    def _joined(self, k: int) -> int:
        """Return what stands behind `and` or a comma: another part, or what is said of the object."""
        if self._is_share(k + 1):
            return self._share(k + 1)
        if begins := self._place_first(k + 1):
            return self._part(begins)
        if self.given(k) == "," and self._is_about_whole(k + 1):
            self.current = self.subject = self.whole
            return k + 1
        if self.given(k + 1) == "it" and self.current.count != 1:
            self.current = self.subject = self.whole
            return k + 2
        owners = [part for part in self.parts if self.current.of and self.noun(part) == self.current.of]
        adds = self.given(k) == "and" and self.given(k - 1) != "," and self.given(k + 1) in ARTICLES
        if owners and adds and self._begins_noun(k + 1):  # each with a vent and a lock
            end = self._part(k + 1, of=owners[-1])
            if self.noun(self.current).split()[-1:] in (["door"], ["drawer"]):
                self.current.of = ""
            return end
        return self._part(k + 1) if self._begins_noun(k + 1) else k + 1

    def _place_first(self, k: int) -> int:
        """`on the left a door`: a place that is said before its part; where that begins, or 0."""
        at = k + 1
        while self.given(at) in _DETERMINERS:
            at += 1
        if self.given(k) not in _AT or self.given(at) not in PLACES:
            return 0
        end = at + 1 + (self.given(at + 1) in ("side", "hand", "end"))
        begins = end + (self.given(end) in (",", "is", "are"))
        counted = begins < len(self.tokens) and self.tokens[begins].number is not None
        if not counted or not self._begins_noun(begins):
            return 0
        self.claim(_Draft(claims=self.pending), "place", self.given(at), *range(k, end))
        return begins

    def _individual(self, k: int) -> _Draft | None:
        """The part that `with` at word k is about: `the left one with a knob`, `two doors, each with a vent`."""
        placed = any(claim.about == "place" and max(claim.at) < k for claim in self.current.claims)
        before = k - 1
        while before > 0 and self.given(before) in ("of", "them", "which", "these"):
            before -= 1
        each = self.given(before) in ("each", "both", "all")
        is_one = placed and self.current.count == 1 and self.given(k - 1) != ","
        return self.current if self.current is not self.whole and (each or is_one) else None

    def _is_about_whole(self, k: int) -> bool:
        """True if what stands behind a comma is a size, a look or a state alone."""
        end = k
        while end < len(self.tokens) and self.given(end) not in (*_BEGINS_PART, "."):
            end += 1
        words = [self.given(i) for i in range(k, end)]
        units = (*UNITS, *_ANGLES)
        plain = [w for w in words if not self._is_adjective(w) and w not in units and lemma(w) not in units]
        plain = [w for w in plain if w not in STOP_WORDS and not w[:1].isdigit() and w not in NUMBERS]
        sizes = {word for names in DIMENSIONS.values() for word in names}
        units_behind = [k for k in range(k, end) if {self.given(k + 1), lemma(self.given(k + 1))} & set(units)]
        someone = [i for i in range(k, end) if self.given(i) in NUMBERS and self.given(i) not in ARTICLES]
        if self.given(k) in ("each", "both", "all") or set(someone) - set(units_behind):
            return False
        if self.given(k) in ARTICLES and any(self._is_mirror(i) for i in range(k, end)):
            return False
        return bool(words) and not [w for w in plain if w not in sizes and w not in ("x", "by", "half", "made")]

    def _is_adjective(self, word: str) -> bool:
        """True if a word is of a look, a size or a state."""
        return (
            word in COLOR_WORDS or word in MATERIAL_WORDS or word in SIZE_WORDS or word in OPENNESS
            or word in PLAIN_WORDS or word in ("dark", "light")
        )  # fmt: skip

    def _begins_noun(self, k: int) -> bool:
        """True if a noun phrase begins at word k, and no verb phrase: `and tilts`, `and can be folded`."""
        word = self.given(k)
        if word in _BEING or not word or self.tokens[k].is_sign or word in _BEGINS_PART or word in _PREPOSITIONS:
            return word in ("each", "all", "both") and self._begins_noun(k + 1)
        if length_at(self, k) and not self._noun_behind(k):
            return False
        verb = word in MOTIONS or word in DONE or word in GOING or word in OPENNESS
        verb = verb or word in PULLED
        return not verb or self._noun_behind(k)

    def _noun_behind(self, k: int) -> bool:
        """True if a noun follows word k before the clause ends: `sliding door`, not `slides out`."""
        for at in range(k + 1, min(k + 6, len(self.tokens))):
            word = self.given(at)
            ends = word in _BEGINS_PART or word in _PREPOSITIONS or word in _BEING or word in _GOES
            if ends or self.tokens[at].is_sign:
                return False
            if word in ("one", "ones", "degrees"):  # swings 20 degrees either way
                return word != "degrees"
            if (
                word.removesuffix("s") in WAYS
                or word in PLACES
                or word in _DETERMINERS
                or self._is_adjective(word)
                or word in (*UNITS, *_ANGLES)
            ):
                continue
            if self.tokens[at].number is None and not any(word in words for words in DIMENSIONS.values()):
                return word not in MOTIONS or self._noun_behind(at)
        return False

    def _has(self, k: int, part: _Draft) -> bool:
        """True if a word says that a part has another one: what is lockable has a lock."""
        noun, count = HAVING.get(self.given(k), ("", 1))
        without = self.given(k).removesuffix("less")
        if without != self.given(k) and without in self.mechanisms:
            noun, count = without, 0  # doorless
        if not noun or (count is None and part is not self.whole):  # a rolling door has no casters
            return False
        there = Claim(about="there", value=True, words=self.given(k), at=(k,))
        self.implied.append((part, PartSpecification(noun=noun, count=count, claims=(there,))))
        return True

    def _part(self, k: int, *, count: int | None = 1, of: _Draft | None = None) -> int:
        """A noun phrase that names a part; what has no noun is said of the part before."""
        if self._is_share(k):
            return self._share(k)
        part = _Draft(count=count, of=self.noun(of) if of is not None else "")
        named = next((item for item in reversed(self.parts) if not item.of and item.count != 1), None)
        alone = self.given(k + 1) in PLACES and self.given(k + 2) in (*_BEING, *_WITH)
        if named is not None and count and self.given(k) == "the" and alone:  # of which the lowest is lockable
            part.nouns = list(named.nouns)
            self.claim(part, "place", self.given(k + 1), k + 1)
            self.parts.append(part)
            self.current = self.subject = part
            return k + 2
        end = self._noun_phrase(k, part)
        again = [at for at in range(k, end) if self.given(at) in ("one", "ones") or self.tokens[at].given in NUMBERS]
        if not part.nouns and again and self.parts and self.given(again[0]) not in ARTICLES:
            # `two on the left and one on the right`
            part.nouns = list(next((item for item in reversed(self.parts) if not item.of), self.parts[-1]).nouns)
        if not part.nouns and self.given(end - 1) == "other" and self.current is not self.whole:
            return self._the_other(end)
        if part.nouns:
            part.claims, self.pending = [*self.pending, *part.claims], []
            self.parts.append(part)
            self.current = self.subject = part
        elif self._is_one_of_copies(part, again) or (
            self.given(end) == "and" and self.given(k - 1) in _WITH and self._begins_noun(end + 1)
        ):
            self.pending = part.claims  # red and blue knobs; the middle one has a red door
        else:
            self.current.claims += [claim for claim in part.claims if claim.about != "count"]
        return end

    def _the_other(self, k: int) -> int:
        """`one door hinged on the left and the other on the right`: what is said of the first holds of another one."""
        before = self.current
        other = _Draft(nouns=list(before.nouns), of=before.of)
        self.parts.append(other)
        self.current = self.subject = other
        at = next((at for at in range(k, k + 3) if self.given(at) in WAYS), k)
        if any(claim.about == "hinge" for claim in before.claims) and at > k:
            self.claim(other, "hinge", self.given(at), *range(k, at + 1))
            return at + 1
        return k

    def _is_one_of_copies(self, part: _Draft, again: Sequence[int]) -> bool:
        """True if one of several objects is meant by its place, so that what it has is there."""
        placed = any(claim.about == "place" for claim in part.claims)
        return bool(again) and placed and self.current is self.whole and (self.whole.count or 1) > 1

    def _is_share(self, k: int) -> bool:
        """True if word k begins `two of which`, `half of them`, `all but one`, `one of glass`, `two red`."""
        counted = [part for part in self.parts if (part.count or 0) > 1]
        return bool(counted) and self._shared(k)[0] > 0

    def _shared(self, k: int) -> tuple[int, int]:
        """Return how many of those that were named last are meant at word k, and the word behind; none: 0."""
        every = next((part.count or 0 for part in reversed(self.parts) if (part.count or 0) > 1), 0)
        number = self.tokens[k].number if k < len(self.tokens) and self.given(k) not in ARTICLES else None
        if self.given(k) == "all" and self.number(k + 1):  # all five of them
            return self._shared(k + 1)
        if (self.given(k), self.given(k + 1)) == ("all", "but") and k + 2 < len(self.tokens):
            return every - int(self.tokens[k + 2].number or every), k + 3
        if self.given(k) == "half" and every % 2 == 0:
            number = every // 2
        if number is None:
            return 0, k
        if self.given(k + 1) == "of" and self.given(k + 2) in ("which", "them", "these", "those"):
            return int(number), k + 3
        at = k + 1
        while self.given(at) in ("of", "in", "made", "is", "are", "painted"):
            at += 1
        look = _Draft()
        behind = at + self._look_or_size(at, look)
        ends = self.given(behind) in ("", "and", ",", ".", ";")
        is_look = any(claim.about in ("color", "material") for claim in look.claims)
        return (int(number), k + 1) if is_look and ends and self.given(k) != "half" else (0, k)

    def _share(self, k: int) -> int:
        """Some of the parts that were named last, the first ones that are not in another share; the word behind."""
        count, end = self._shared(k)
        every = next(part for part in reversed(self.parts) if (part.count or 0) > 1)
        every = next(part for part in self.parts if part.nouns == every.nouns and part.of == every.of)
        some = _Draft(nouns=list(every.nouns), count=count, of=every.of)
        self.current = self.subject = every
        if some.count != every.count:
            self.claim(some, "count", some.count, k)
            self.claim(some, "place", "first", *range(k, end))
            self.parts.append(some)
            self.current = self.subject = some
        return end

    def _noun_phrase(self, k: int, part: _Draft) -> int:
        """`two small red drawers`: count, looks, sizes and motions before the noun; the word behind."""
        start = k
        while k < len(self.tokens):
            word = self.given(k)
            if part is self.whole and k in self.name:
                k = self.name[-1] + 1
                return k
            ends = word in _BEGINS_PART or (word in _PREPOSITIONS and k > start) or self.tokens[k].is_sign
            if ends and not (part is self.whole and k < self.name[0]):
                break
            named = bool(part.nouns) or self.given(k - 1) in ("one", "ones")
            if named and (
                word in _BEING
                or word in (*PULLED, *_HELD)
                or self._verb_at(k)
                or word in WAYS
                or word in PLACES
                or any(self._says(k, words) for words in _DYNAMICS)
            ):
                break
            taken = self._open(k, part) or self._look_or_size(k, part) or self._described(k, part)
            if word in ("every", "each", "either") and part is not self.whole:
                part.count = None
            taken = taken or int(self._has(k, part)) or self._answers(k, part)
            if word == "only" and part is not self.whole:
                self.claim(part, "only", True, k)
            if not taken and word.isalpha() and word not in _DETERMINERS and word not in _NO_NOUN:
                if word in STOP_WORDS and part.nouns:
                    break
                if word not in STOP_WORDS and part is not self.whole:
                    part.nouns.append(k)
            k += taken or 1
        if part.nouns and part.count == 1 and part is not self.whole:
            last = self.given(part.nouns[-1])
            numbered = any(claim.about == "count" for claim in part.claims)
            if lemma(last) != last and not numbered:
                part.count = None
        return k

    def _verb_at(self, k: int) -> bool:
        word, before = self.given(k), self.given(k - 1)
        if word in BARE and before == lemma(before) and before not in _BEING:
            return False  # a scissor lift
        return (word in MOTIONS or word in DONE or word in GOING) and not self._noun_behind(k)

    def _described(self, k: int, part: _Draft) -> int:
        """A count, a place or a motion before the noun; how many words."""
        word, behind = self.given(k), self.given(k + 1)
        if self.tokens[k].number is not None:
            return self._counted(k, part)
        some = behind in NUMBERS and behind not in ARTICLES
        placed = part is not self.whole and (self._noun_behind(k) or behind in ("one", "ones") or some)
        if taken := (self._ordinal(k, part) if placed else 0) or self._adjustable(k, part):
            return taken
        if word in PLACES and placed:
            self.claim(part, "place", word, k)
        elif word in PARTICLES and behind in WAYS and (part is not self.whole or k < self.name[0]):
            self.claim(part, "way", behind, k, k + 1)
            return 2
        elif word in LINES and behind in MOTIONS and self._noun_behind(k + 1):
            self.claim(part, "way", word, k)
        elif word in PARTICLES and word in MOTIONS and behind in _ANYHOW and self._noun_behind(k + 1):
            self.claim(part, "moves", MOTIONS[word], k, k + 1)
            return 2
        elif word in _STILL and (part is self.whole or self._noun_behind(k)):
            self.claim(part, "still", word, k)
        elif word in MOTIONS and (part is self.whole or self._noun_behind(k)):
            self.claim(part, "moves", MOTIONS[word], k)
        else:
            return 0
        return 1

    def _ordinal(self, k: int, part: _Draft) -> int:
        """`the second one from the top`; how many words."""
        word, behind = self.given(k), self.given(k + 1)
        if word not in _ORDINALS or self.given(k - 1) != "the" or behind == "hand":  # of a clock
            return 0
        end = k + 1 + (behind in ("one", "ones"))
        side = self.given(end + 2) if (self.given(end), self.given(end + 1)) == ("from", "the") else ""
        at = range(k, end + 3) if side in PLACES else range(k, end)
        self.claim(part, "place", f"{_ORDINALS.index(word) + 2} {side if side in PLACES else ''}", *at)
        return len(at)

    def _open(self, k: int, part: _Draft) -> int:
        """`half open`, `ajar`, `opened by 30 degrees`, `pulled out 20 cm`, `open 30 %`; how many words."""
        before = measured_at(self, k)
        at = before[2] if before else k
        while before and self.given(at) in ("of", "the", "way"):
            at += 1
        while self.given(at) in _HELD and self.given(at + 1) in OPENNESS:
            at += 1
        word = self.given(at)
        turned = part is not self.whole and word in DONE and self.given(at - 1) != "be" and amount_at(self, at + 1)
        raised = before is not None and before[0] == "share" and word in DONE and not self._noun_behind(at)
        raised = raised or bool(turned and turned[0] != "share")
        can_be = word == "pull" and self._noun_behind(at)  # pull-out shelves; doors open upwards
        can_be = can_be or (word == "open" and before is None and self.given(at + 1).removesuffix("s") in WAYS)
        if not (raised or word in (*OPENNESS, *PULLED)) or self.given(at + 1) in NOT_A_STATE or can_be:
            return 0
        is_in = word in PULLED and self.given(at + 1) == "in"
        if raised:  # what tilts is no door
            self.claim(part, "moves", DONE[word], at)
        how, much = before[:2] if before else ("share", 0.0 if is_in else OPENNESS.get(word, 1.0))
        if before and (OPENNESS.get(word) == 0.0 or word in _BACK):
            how, much = "share", 1.0 - much if how == "share" else 0.0  # fully closed
        end = at + 1 + (is_in or self.given(at + 1) in ("out", "up"))
        if amount := amount_at(self, end) if (how, much) == ("share", 1.0) else None:
            how, much, end = amount
        self.claim(part, "open", (how, much), *range(k, end))
        return end - k

    def _answers(self, k: int, part: _Draft) -> int:
        """`soft-close`, `stays open`, `spring-loaded`; how many words."""
        words = next((words for words in _DYNAMICS if self._says(k, words)), ())
        if words and amount_at(self, k + len(words)):  # stays open at 80 degrees
            return 0
        if words:
            self.claim(part, "answers", _DYNAMICS[words], *range(k, k + len(words)))
        return len(words)

    def _range(self, k: int) -> int:
        """`from 70 to 120 cm`, `up to 45 degrees`, said of how something moves; how many words."""
        first, at = None, k + 1
        begins = self.given(k) in ("from", "between")
        if begins:
            first = measured_at(self, k + 1)
            at = first[2] if first else k + 2
            at += self.given(at) in _DROPPED  # from 65 cm up to 1.3 m
        joins = {"between": "and", "from": "to", "up": "to"}.get(self.given(k))
        high = measured_at(self, at + 1) if joins and self.given(at) == joins else None
        if high is None or high[0] == "share":
            return 0
        low = first[1] if first else 0.0
        number, bare = self.tokens[at + 1].number, self.tokens[k + 1].number
        if begins and first is None and bare is not None and number:
            low = bare / number * high[1]  # of the same unit
        if low >= high[1]:
            return 0
        self.claim(self.subject, "range", (high[0], high[1] - low), *range(k, high[2]))
        rises = any((c.about, c.value) in (("way", "up"), ("moves", "rises")) for c in self.subject.claims)
        rises = rises or (self.subject is self.whole and any(self.given(at) in _ADJUSTABLE for at in self.name))
        if low and rises:
            self.claim(self.subject, "size", ("top", low), *range(k, high[2]))  # above the floor
        return high[2] - k

    def _counted(self, k: int, part: _Draft) -> int:
        """`four`, `no`; an article counts nothing."""
        word, number = self.given(k), self.tokens[k].number or 0.0
        says_its_kind = self.given(k + 1) == "of"
        if part is self.whole:  # a two-door wardrobe is no two wardrobes
            between = range(k + 1, self.name[0])
            says_its_kind = word in KINDS or not all(may_follow(self.tokens, at) for at in between)
            if number and word not in (*KINDS, *ARTICLES) and k + 1 < self.name[0] and self._is_mechanism(k + 1):
                counted = _Draft(nouns=[k + 1], count=int(number))
                self.claim(counted, "count", int(number), k)
                self.parts.append(counted)
                return 2
        if word not in ARTICLES and not says_its_kind and number == int(number):
            part.count = 0 if part.count == 0 else int(number)
            self.claim(part, "count", int(number), k)
        return 1

    def _adjustable(self, k: int, part: _Draft) -> int:
        """`adjustable height`, `height adjustable`: something of it goes up, or moves."""
        one, other = self.given(k), self.given(k + 1)
        noun = lemma(other) if one in _ADJUSTABLE else one if other in _ADJUSTABLE else ""
        if noun not in _MEASURES:
            return 0
        way = _MEASURES[noun]
        self.claim(part if part.nouns else self.whole, "way" if way else "moves", way or "moves", k, k + 1)
        return 2

    def _look_or_size(self, k: int, part: _Draft) -> int:
        """A colour, a material or a length with its dimension; how many words."""
        pair, word = f"{self.given(k)} {self.given(k + 1)}", self.given(k)
        for words, number in ((pair, 2), (word, 1)):
            if words in COLOR_WORDS:
                self.claim(part, "color", COLOR_WORDS[words], *range(k, k + number))
                return number
        if word == "mirrored" and not self._noun_behind(k):
            self.claim(part, "like", "mirrored", k)
            return 1
        is_purpose = word in PURPOSES and self._noun_behind(k)  # a paper tray
        if word in MATERIAL_WORDS and not is_purpose and not self._is_mirror(k):
            self.claim(part, "material", MATERIAL_WORDS[word], k)
            return 1
        return self._size(k, part)

    def _is_mirror(self, k: int) -> bool:
        """True if a mirror is meant, and not what something is made of."""
        return self.given(k) == "mirror" and not self._noun_behind(k)

    def _size(self, k: int, part: _Draft) -> int:
        """`60 cm wide`, `a height of 2 m`, `15 cm`; how many words."""
        length = length_at(self, k)
        if length is None:
            return 0
        metres, end = length
        if self.given(end) == "of" and self.given(end + 1) in _TRAVEL:  # with 60 cm of travel
            self.claim(part, "range", ("distance", metres), *range(k, end + 2))
            return end + 2 - k
        behind, before = (_dimension(self.given(at)) for at in (end, k - 2))
        if self._says(end, ("to", "the")) and self.given(end + 2) in WAYS:  # which slides 1.2 m to the left
            self.claim(part, "range", ("distance", metres), *range(k, end))
            return end - k
        if self.given(k - 1) == "of" and self.given(k - 2) in _TRAVEL:  # with a travel of 60 cm
            self.claim(part, "range", ("distance", metres), *range(k - 2, end))
        elif behind:
            self.claim(part, "size", (behind, metres), *range(k, end + 1))
            return end + 1 - k
        elif before and self.given(k - 1) == "of":
            self.claim(part, "size", (before, metres), *range(k - 2, end))
        elif not {self.given(k - 1), self.given(end)} & {"x", "by", "to"}:
            self.claim(part, "size", ("", metres), *range(k, end))
        return end - k

    def _said_behind(self, k: int) -> int:
        """Return what is said of a part behind its noun: a verb, a place, a state, a look, or what it stands on."""
        word, part, before = self.given(k), self.current, self.given(k - 1)
        able = word in OPENNESS and before in (*_RELATIVE, *_CAN)
        taken = 0 if able else self._answers(k, part) or self._open(k, part) or (self._range(k) if word == "up" else 0)
        taken = taken or self._look_or_size(k, part) or self._adjustable(k, self.whole)
        if taken:
            return k + taken
        if tuple(self.given(at) for at in range(k, k + 3)) == ("side", "by", "side"):
            return k + 3
        goes = self.given(k + 1).removesuffix("s") in WAYS
        does = word in GOING and (word not in OPENNESS or goes or before in (*_RELATIVE, *_CAN))
        if word in MOTIONS or does or (word in DONE and before == "be"):
            return self._verb(k)
        if word in _PREPOSITIONS:
            return self._than(k) if word == "than" else self._preposition(k)
        if able:
            self.claim(part, "moves", "moves", k)
        elif word in _DROPPED and self.given(k + 1) in ("", *_BEGINS_PART):
            self.claim(part, "way", word, k)
            self.claim(part, "open", ("share", 1.0), k)
        elif word in WAYS:
            self.claim(part, "place", word, k)
        elif self._has(k, part):
            pass
        elif before in (*_RELATIVE, "can") and word.isalpha() and word not in FUNCTION_WORDS | STOP_WORDS:
            self.claim(self.subject, "does", word, k)
        return k + 1

    def _verb(self, k: int) -> int:
        """`slides out`, `opens downwards`, `hinged on the left`: how the subject moves, and where to."""
        word, subject, end = self.given(k), self.subject, k + 1
        moves = MOTIONS.get(word, DONE.get(word, ""))
        if self.given(end) in ("the", "its", "a", "an", "both", "all") and (behind := self._moves_other(k, moves)):
            return behind
        while self.given(end) in ("to", "the", "on", "at", "towards", "sideways"):
            end += 1
        way = self.given(end).removesuffix("s")
        far = self._far(end + 1 if way in WAYS else k + 1)
        if word in ("hinged", "hinges", "hinge") and self.given(end) in _HINGES:
            self.claim(subject, "hinge", self.given(end), k, end)
            return end + 1
        if way in WAYS and not (way == "up" and self.given(end + 1) == "to"):
            both = self.given(end + 1) == "and" and self.given(end + 2).removesuffix("s") in WAYS
            if word in ("hinged", "hinges", "hinge"):
                self.claim(subject, "hinge", way, k, end)
            else:
                self.claim(subject, "way", way, k, end, *((end + 2,) if both else ()))
                if moves in ("slides", "swings"):  # a tray that swings out does not slide
                    self.claim(subject, "moves", moves, k)
            return far or end + (3 if both else 1)
        self.claim(subject, "moves", moves or "moves", k)
        return far or k + 1

    def _moves_other(self, k: int, moves: str) -> int:
        """`a crank that raises the bucket by 1 m`: what the subject moves; the word behind it, or 0."""
        other = _Draft()
        end = self._noun_phrase(k + 1, other)
        if not other.nouns:
            return 0
        self.claim(other, "moves", moves or "moves", k)
        self.parts.append(other)
        self.current = self.subject = other
        return self._far(end + (self.given(end) in _BY)) or end

    def _far(self, k: int) -> int:
        """`3 m`, `by 90 degrees`, `through 45 degrees to either side`, of the subject; the word behind it, or 0."""
        amount = None if (self.given(k - 1), self.given(k)) == ("up", "to") else amount_at(self, k)
        if amount is None or amount[0] == "share" or _dimension(self.given(amount[2])):
            return 0
        how, much, end = amount
        both = next((words for words in _TO_BOTH if self._says(end, words)), ())
        much, end = (2.0 * much, end + len(both)) if both else (much, end)
        way, back = self.given(end).removesuffix("s"), measured_at(self, end + 2)
        if back and back[0] == how and self.given(end + 1) == "and" and way in WAYS:  # 30 degrees left and 20 right
            other = self.given(back[2]).removesuffix("s")
            much, end = (much + back[1], back[2] + 1) if other in WAYS and other != way else (much, end)
        self.claim(self.subject, "range", (how, much), *range(k, end))
        return end

    def _says(self, k: int, words: Sequence[str]) -> bool:
        return tuple(self.given(k + n) for n in range(len(words))) == tuple(words)

    def _than(self, k: int) -> int:
        """`wider than the right one`."""
        other = _Draft()
        end = max(self._noun_phrase(k + 1, other), k + 1)
        self.claim(self.current, "relation", ("than", self.noun(other) or "other"), *range(k, end))
        return end

    def _preposition(self, k: int) -> int:
        """`on the left side`, `under the bed`, `of glass`, `on four casters`."""
        at = k + 1
        while (
            self.given(at) in (*_DETERMINERS, "of", "one", "top")
            and self.given(at + 1)
            and not (self.given(at) == "top" and self.given(at + 1) != "of")
        ):
            at += 1
        if taken := self._range(k):
            return k + taken
        if self.given(k) in _BY and self.given(k - 1) in _MOVED and (end := self._far(k)):
            return end
        word = self.given(at)
        sided = self.given(at + 1) in ("side", "hand", "end", "edge")
        of_other = self.given(at + 1) == "of" and word == "front" and self.given(k) == "in"
        if word in PLACES and not of_other and (sided or not self._noun_behind(at)) and self.given(k) in _AT:
            self.claim(self.current, "place", word, *range(k, at + 1))
            return at + (2 if sided else 1)
        if word in MATERIAL_WORDS and self.given(k) in ("of", "in", "from"):
            return k + 1
        target = _Draft()
        in_front = tuple(self.given(at) for at in range(k, k + 3)) == ("in", "front", "of")
        end = self._noun_phrase(k + (3 if in_front else 1), target)
        back = self.given(k) in LEVELS and self.given(k + 1) in _PRONOUNS
        if back and self.current in self.parts[1:]:
            target.nouns = self.parts[self.parts.index(self.current) - 1].nouns  # what was named before
        noun = self.noun(target)
        if target.nouns and noun.split()[-1] in _UNDER_WHOLE and self.given(k) in ("on", "onto"):
            self.parts.append(target)
            self.current = self.subject = target
        elif target.nouns:
            how = "each" if self.given(k + 1) in ("each", "every") else "in front of" if in_front else self.given(k)
            counted = next((claim for claim in target.claims if claim.about == "count"), None)
            if noun in _PIECES and counted and how in ("in", "into") and self.current is not self.whole:
                self.current.count = target.count  # a lid in two halves
                self.claim(self.current, "count", target.count, *counted.at, *target.nouns)
                return max(end, k + 1)
            in_grid = k > 0 and self.tokens[k - 1].number is not None  # three by two drawers
            looks = {k for claim in target.claims if claim.about in ("color", "material", "size") for k in claim.at}
            apart = bool(counted or looks) and not in_grid and noun.split()[-1] not in PLACES
            apart = apart and not {lemma(self.given(k - 1)), noun} & set(_GROUPS)
            placed = [claim.value for claim in target.claims if claim.about == "place" and claim.value.isalpha()]
            self.claim(
                self.current,
                "relation",
                (how, " ".join([*placed, noun])),
                *(at for at in range(k, end) if at not in looks),
            )
            if apart:
                self.parts.append(target)
        else:
            self.current.claims += target.claims
            alone = end == k + 1 or (end == k + 2 and self.given(k + 1) in _PRONOUNS)
            place = {**LEVELS, **_ALONE}.get(self.given(k), "") if alone else ""
            if place:
                self.claim(self.current, "place", place, *range(k, end))
        return max(end, k + 1)
