"""Sentences such as `a cart with four casters, a push handle and two drawers`; every word is understood or refused."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, TypeVar

from kinematify.errors import InputError
from kinematify.generate.composer.bodies import BODIES, BodyKind
from kinematify.generate.composer.compose import BANDS, Composition, MechanismSpec, compose
from kinematify.generate.composer.mechanisms import MECHANISMS, MechanismKind
from kinematify.generate.composer.side import FACING
from kinematify.generate.procedural.family import Family
from kinematify.generate.procedural.language.counts import MOST_COPIES
from kinematify.generate.procedural.language.openness import OUT, VERBS, share_at
from kinematify.generate.procedural.language.parts import MOTIONS, PartReader, PartRequirement
from kinematify.generate.procedural.language.reading import ParseState
from kinematify.generate.procedural.language.sizes import DIMENSIONS, SIZE_WORDS, angle_at, length_at
from kinematify.generate.procedural.language.words import (
    ARTICLES,
    KINDS,
    OPENNESS,
    PURPOSES,
    STOP_WORDS,
    UNITS,
    Token,
    Words,
    tokens_of,
)
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

_Kind = TypeVar("_Kind")
_SIDES = {side: side for side in FACING} | {"rear": "back", "underside": "bottom"}
_PLACED = ("on", "at", "in")
_REPEATING = ("each", "every", "per", "both")
"""Words that count what was named before, which is not built."""
_SIDE_NOUNS = ("side", "face")
_LEVELS = {
    "underneath": "bottom",
    "below": "bottom",
    "above": "top",
    "beneath": "bottom",
    "under": "bottom",
    "overhead": "top",
}
_MOVING = ("opening", "movable", "moving", "working")
_OPENNESS = {("half", "open"): 0.5, ("open",): 1.0, ("closed",): 0.0}
_AXES = {"width": 0, "length": 0, "depth": 1, "height": 2}
_MATERIAL_WORDS = {word: name for name, material in MATERIALS.items() for word in material.words}
_HANDLES = ("handle",)
_DROPPED = ("up", "down")
"""Behind a part at the end they say that it stands open there."""
_FLANKS = ("left", "right")
_SWINGS = ("hinged", "hinge", "hinges", "open", "opens", "opening", "swings", "swinging")
_BETWEEN = ("to", "on", "at", "the", "its", "from", "towards")
_SHAPES = tuple({body.build: body.words[0] for body in reversed(BODIES)}.values())[::-1]
"""One body of each shape, for messages."""
_ENDS = ("front", "back", "rear")
"""Sides that are said before a noun; a left door is the left one of two."""
_MOST_MEMBERS = 12  # blades
_LARGER = 1.3  # times as long in all directions is large
_BARE = 2  # words of a length: number and unit
_SCALES = 3.5  # times as long as usual a body may be
_SHORTEST, _LONGEST = 0.05, 20.0  # [m]


class NoBodyError(InputError):
    """A sentence names no body of the composer."""


@dataclass(kw_only=True)
class _Look:
    """What is said before a noun."""

    count: int | None = None
    material: str | None = None
    color: str | None = None
    side: str = ""
    """Of `FACING`."""


def read_composition(sentence: str) -> Composition:
    """Find out which body and mechanisms a sentence asks for.

    Raises:
        NoBodyError: It names no body of the composer.
        InputError: It has words that are not understood; the message names them.
    """
    tokens = tokens_of(sentence, _vocabulary(), mend=False)
    reader = _Reader(tokens)
    reader.read()
    if reader.body is None:
        raise NoBodyError(
            f"The text {sentence[:80]!r} names no body that mechanisms can be placed on. There are "
            f"{', '.join(_SHAPES)}."
        )
    if reader.handles is not None and not any(item.mechanism.has_grip for item in reader.wanted):
        reader.left.append("handles")
    wanted = (*reader.wanted, *_taken_for_granted(reader))
    if reader.hinge and not any(item.hinge for item in wanted):
        reader.left.append(f"opens to the {reader.hinge}")
    if reader.left:
        raise _not_understood([*_phrases_of(tokens, reader.unread), *reader.left])
    for mechanism in reader.excluded:
        if any(wanted.mechanism is mechanism for wanted in reader.wanted):
            raise InputError(f"The text asks for a {mechanism.words[0]} and for none. Say one of both.")
    if reader.bare is not None:
        longest = max(range(len(reader.size)), key=reader.body.size.__getitem__)
        if reader.size[longest] is not None:
            raise InputError(f"The text gives the longest side of the {reader.body.words[0]} twice. Say it once.")
        reader.size[longest] = reader.bare
    for metres, usual in zip(reader.size, reader.body.size, strict=True):
        if metres is not None and metres > _SCALES * usual:
            raise InputError(f"A {reader.body.words[0]} of {metres:g} m is too large; usual is {usual:g} m there.")
    width, depth, height = reader.size
    composition = Composition(
        body=reader.body,
        said=reader.said,
        wanted=wanted,
        size=(width, depth, height),
        material=reader.of_body.material,
        color=reader.of_body.color,
        handles=(reader.handles.material, reader.handles.color) if reader.handles else (None, None),
        rest=reader.rest,
        requirements=tuple(reader.requirements),
        copies=reader.copies,
        scale=reader.scale,
    )
    return _with_what_parts_say(composition, tokens, reader) if reader.unread else composition


def _with_what_parts_say(composition: Composition, tokens: tuple[Token, ...], reader: _Reader) -> Composition:
    """Read words that name no mechanism against the parts that are built: `a flap that folds down`.

    Raises:
        InputError: They do not hold of them.
    """
    try:
        made = compose(composition)
    except InputError as error:
        raise InputError(f"{_not_understood(_phrases_of(tokens, reader.unread))} {error}") from error
    family = Family(
        name=made.family,
        title=composition.title,
        words=(composition.title,),
        parameters=(),
        build=lambda values, workshop: None,
        part_words={item.stem: item.mechanism.words for item in composition.wanted},
    )
    used = set(range(len(tokens))) - set(reader.unread)
    parts = PartReader(reading=ParseState(tokens=tokens, family=family, used=used, named=reader.named), made=made)
    parts.read()
    if left := _phrases_of(tokens, [k for k in reader.unread if k not in parts.reading.used]):
        raise _not_understood(left)
    return replace(composition, requirements=(*composition.requirements, *parts.requirements))


def _phrases_of(tokens: tuple[Token, ...], places: Sequence[int]) -> list[str]:
    """What stands at some places as it was written, neighbours together; articles alone say nothing."""
    phrases: list[list[int]] = []
    for k in places:
        if phrases and k == phrases[-1][-1] + 1:
            phrases[-1].append(k)
        elif tokens[k].text not in ARTICLES:
            phrases.append([k])
    return [" ".join(tokens[k].given for k in phrase) for phrase in phrases]


def _not_understood(left: Sequence[str]) -> InputError:
    return InputError(
        f"Not understood: {', '.join(map(repr, left))}. Nothing else is built in its place. Bodies are "
        f"{', '.join(_SHAPES)}; on them go {', '.join(mechanism.words[0] for mechanism in MECHANISMS)}."
    )


def _taken_for_granted(reader: _Reader) -> list[MechanismSpec]:
    """What the body has without being asked for."""
    body = reader.body
    if body is None:
        return []
    named = [*reader.excluded, *(item.mechanism for item in reader.wanted)]
    granted = {**body.always, **({} if reader.wanted else body.usual)}
    if any(item.mechanism.needs == "opening" for item in reader.wanted):
        granted.pop("door", None)  # something else closes it
    called = {kind: word for word, kind in body.says.items()}
    return [
        MechanismSpec(
            mechanism=kind,
            said=called.get(kind.words[0], ""),
            count=granted[kind.words[0]],
            hinge=reader.hinge if kind.words[0] == "door" else "",
        )
        for kind in MECHANISMS
        if kind.words[0] in granted and kind not in named
    ]


def names_a_body(sentence: str) -> str:
    """Return the name of the first body that a sentence names by several words that say what it is, else nothing."""
    tokens = tokens_of(sentence, _vocabulary(), mend=False)
    for k in range(len(tokens)):
        named = _longest(tuple(token.text for token in tokens[k : k + 5]), _bodies())
        if named is not None:
            return " ".join(named[0]) if len([word for word in named[0] if word not in STOP_WORDS]) > 1 else ""
    return ""


def told(composition: Composition) -> str:
    """Return a sentence that `read_composition` understands as this composition, its openness and lengths apart."""
    items = [_told(item) for item in composition.wanted]
    listed = " and ".join([*([", ".join(items[:-1])] if items[1:] else []), items[-1]])
    return f"{_phrase(1, composition.color, composition.material, composition.title)} with {listed}"


def _told(item: MechanismSpec) -> str:
    noun = item.title + ("s" if item.count > 1 else "")
    return _phrase(item.count, item.color, item.material, noun) + (f" on the {item.side} side" if item.side else "")


def _phrase(count: int, *words: str | None) -> str:
    text = " ".join(word for word in words if word)
    return f"{count if count > 1 else 'an' if text[0] in 'aeiou' else 'a'} {text}"


class _Reader:
    """Goes through a sentence once, from noun to noun."""

    def __init__(self, tokens: Sequence[Token]) -> None:
        """Begin before the first word."""
        self._tokens = tokens
        self._words = Words(tuple(tokens))
        self._look = _Look()
        self.body: BodyKind | None = None
        self.said = ""
        self.of_body = _Look()
        self.wanted: list[MechanismSpec] = []
        self.excluded: list[MechanismKind] = []
        self.handles: _Look | None = None
        self.size: list[float | None] = [None, None, None]
        self.bare: float | None = None
        """A length of the body of which is not said what it is [m]."""
        self.rest = 0.0
        self.requirements: list[PartRequirement] = []
        self.copies = 1
        self.scale = 1.0
        self.hinge = ""
        """Side of the doors that nobody named."""
        self.left: list[str] = []
        """Words that cannot be understood here, as they were written."""
        self.unread: list[int] = []
        """Words that name no mechanism; what they say of parts is read when these are there."""
        self.named: frozenset[int] = frozenset()
        """Words of the body's name."""
        self._looking: list[int] = []
        """Words of what was said of the noun to come."""

    def read(self) -> None:
        """Take up every word."""
        k = 0
        while k < len(self._tokens):
            steps = (
                self._length, self._hinged, self._opened, self._detail, self._mechanism, self._named_body,
                self._openness, self._look_of_body, self._described, self._counted,
                self._purpose, self._roughly,
            )  # fmt: skip
            taken = next((words for step in steps if (words := step(k))), 0)
            if not taken and self._tokens[k].text in MOTIONS:
                self.unread.append(k)
            elif not taken and not self._says_nothing(self._tokens[k]):
                self._described_so_far()  # of a noun that is not known here
                self.unread += [*self._looking, k]
            if self._look == _Look():
                self._looking = []
            elif taken:
                self._looking += range(k, k + taken)
            k += max(taken, 1)
        self.unread += self._looking  # it describes nothing that follows

    @staticmethod
    def _says_nothing(token: Token) -> bool:
        return token.is_sign or (token.text in STOP_WORDS and token.text not in _REPEATING) or token.text in _MOVING

    def _texts(self, k: int) -> tuple[str, ...]:
        return tuple(token.text for token in self._tokens[k : k + 5])

    def _described_so_far(self) -> _Look:
        """What was said of the noun that has come; nothing yet of the next one."""
        look, self._look = self._look, _Look()
        return look

    def _length(self, k: int) -> int:
        """`60 cm wide`."""
        number, texts = self._tokens[k].number, self._texts(k)
        if number is None or len(texts) < _BARE or texts[1] not in UNITS:
            return 0
        of_what_comes = self.body is not None and _longest(self._texts(k + _BARE + 1), self._known()) is not None
        if of_what_comes or (self.wanted and self._tokens[k - 1].text != ","):
            return 0  # it would be the length of a mechanism
        metres = number * UNITS[texts[1]]
        if not _SHORTEST <= metres <= _LONGEST:
            raise InputError(
                f"A body {' '.join(texts[:3])} cannot be built; its lengths are from {_SHORTEST:g} m to {_LONGEST:g} m."
            )
        said = texts[_BARE] if len(texts) > _BARE else ""
        name = next((name for name, words in DIMENSIONS.items() if said in words), "")
        if name in _AXES:
            self.size[_AXES[name]] = metres
            return _BARE + 1
        if name or self.bare is not None or self.wanted:
            return 0
        self.bare = metres
        return _BARE

    def _mechanism(self, k: int) -> int:
        """`drawers on the left side`; `a turntable on a table`, whose body comes behind it."""
        named = _longest(self._texts(k), self._known())
        if named is None or (self.body is None and named[0] in _bodies() and not self._stands_on(k + len(named[0]))):
            return 0
        words, mechanism = named
        look, end = self._described_so_far(), k + len(words)
        noun = self._tokens[end - 1]
        plural = noun.given != noun.text and noun.given.endswith("s")
        if words == _HANDLES and plural and look.count is None:
            self.handles = look  # those of doors and drawers, which are not counted
            return len(words)
        before = next((item for item in self.wanted if item.mechanism is mechanism), None)
        again = look.count is None and before is not None
        if again and before is not None and (opened := self._opened_by(end, before, words)):
            return len(words) + opened
        if (self.body is None and not self._stands_on(end)) or again:
            self.left.append(" ".join(words))  # a part of something else, or one that was named before
            return len(words)
        if look.count == 0:
            self.excluded.append(mechanism)
            return len(words)
        side, taken = self._side(end)
        side = side or look.side
        if side == "side":
            side = "" if mechanism.arranged == "axles" else next((s for s in mechanism.sides if s in _FLANKS), "right")
        # What goes on the front alone is at its top or bottom there.
        banded = mechanism.arranged in BANDS and side in ("top", "bottom") and side not in mechanism.sides
        self.wanted.append(
            MechanismSpec(
                mechanism=mechanism,
                said=_unusual(words, mechanism.words),
                count=look.count or (_several(mechanism) if plural else 1),
                side="" if banded else side,
                level=(1 if side == "top" else -1) if banded else 0,
                material=look.material,
                color=look.color,
            )
        )
        return len(words) + taken

    def _known(self) -> Mapping[tuple[str, ...], MechanismKind]:
        """Mechanisms by their words, as they are called on this body."""
        says = self.body.says if self.body is not None else {}
        own = {tuple(word.split()): _mechanisms()[tuple(kind.split())] for word, kind in says.items()}
        return {**own, **{words: kind for words, kind in _mechanisms().items() if words not in own}}

    def _detail(self, k: int) -> int:
        """`with two handles`, which this body has anyway; `with five blades`, of the rotor that it has or just got."""
        if self.body is None:
            return 0
        here = self.wanted[-1:] or [
            MechanismSpec(mechanism=kind) for kind in MECHANISMS if kind.words[0] in self.body.always
        ]
        count = self._look.count or 0
        for item in here if 2 <= count <= _MOST_MEMBERS and self._look == _Look(count=count) else []:
            member = _longest(self._texts(k), {_words_of(word): word for word in item.mechanism.members})
            if member is not None:
                self.wanted[-1:] = [replace(item, members=count)]
                self._look = _Look()
                return len(member[0])
        named = _longest(self._texts(k), {tuple(word.split()): n for word, n in self.body.details.items()})
        if named is None or self._look not in (_Look(count=named[1]), *([_Look()] if named[1] == 1 else [])):
            return 0
        self._look = _Look()
        return len(named[0])

    def _roughly(self, k: int) -> int:
        """`small`, of the whole."""
        word = self._words.text(k)
        if self.body is not None or word not in SIZE_WORDS:
            return 0
        self.scale *= _LARGER if SIZE_WORDS[word][0] else 1.0 / _LARGER
        return 1

    def _opened(self, k: int) -> int:
        """`door opened 45 degrees`, `drawers half open`, right behind a mechanism."""
        named = self.wanted[-1].title.replace("-", " ").split() if self.wanted else []
        noun = self._words.text(k - 1)
        return self._opened_by(k, self.wanted[-1], (noun,)) if named and noun == named[-1] else 0

    def _opened_by(self, k: int, item: MechanismSpec, words: Sequence[str]) -> int:
        """How many words from word k on say how far a mechanism stands open."""
        at = k + 1 if self._words.text(k) in ("is", "are") else k
        amount = share_at(self._words, at)
        at = amount[1] if amount else at
        state, out = self._words.text(at), (self._words.text(at), self._words.text(at + 1)) in OUT
        if at < len(self._tokens) and self._tokens[at].given in VERBS:
            return 0
        if state in _DROPPED and at + 1 == len(self._tokens):
            said = " ".join((*words, state))
            self.requirements.append(PartRequirement(nouns=(item.stem,), words=said, way=state, opened=("share", 1.0)))
            return at + 1 - k
        if state not in OPENNESS and not out:
            return 0
        opened, end = ("share", amount[0] if amount else 1.0 if out else OPENNESS[state]), at + 1 + out
        behind = end + 1 if self._words.text(end) in ("by", "to", "at") else end
        for how, measured in (("angle", angle_at), ("distance", length_at), ("share", share_at)):
            if found := measured(self._words, behind):
                opened, end = (how, found[0]), found[1]
                break
        said = " ".join((*words, *(token.given for token in self._tokens[k:end])))
        self.requirements.append(PartRequirement(nouns=(item.stem,), words=said, opened=opened))
        return end - k

    def _stands_on(self, k: int) -> bool:
        """Whether a body is named from word k on, and no other noun before it: `on a red table`."""
        if self._texts(k)[:1] != ("on",):
            return False
        behind = (self._tokens[i].text for i in range(k + 1, len(self._tokens)))
        described = (*STOP_WORDS, *(word for phrase in (*COLOR_WORDS, *_MATERIAL_WORDS) for word in phrase.split()))
        left = [word for word in behind if word not in described]
        return _longest(tuple(left[:5]), _bodies()) is not None

    def _named_body(self, k: int) -> int:
        """`cart`, once."""
        named = None if self.body is not None else _longest(self._texts(k), _bodies())
        if named is None:
            return 0
        words, self.body = named
        self.named = frozenset(range(k, k + len(words)))
        self.said = _unusual(words, self.body.words)
        self.of_body = self._described_so_far()
        self.copies = 1 if self.of_body.count is None else self.of_body.count
        its_part = _longest(self._texts(k + len(words)), _mechanisms())
        if its_part is not None:  # a cabinet door is no cabinet
            self.left.append(" ".join((*words, *its_part[0])))
        if not 1 <= self.copies <= MOST_COPIES:
            self.left.append(f"{self.of_body.count} {' '.join(words)}")
        return len(words)

    def _openness(self, k: int) -> int:
        """`half open`."""
        texts = self._texts(k)
        says_that_it_can = self._words.text(k - 1) in ("that", "which", "can")
        for words, share in _OPENNESS.items() if self._look == _Look() and not says_that_it_can else ():
            # Amid a sentence it would be said of one mechanism alone.
            if texts[: len(words)] == words and (self.body is None or texts == words):
                self.rest = share
                return len(words)
        return 0

    def _look_of_body(self, k: int) -> int:
        """`, walnut,`: what stands between commas describes the whole."""
        if self.body is None or self._words.text(k - 1) != "," or self._look != _Look():
            return 0
        end = k
        while taken := self._described(end):
            end += taken
        look = self._described_so_far()
        twice = (look.color and self.of_body.color) or (look.material and self.of_body.material)
        if end == k or (end < len(self._tokens) and not self._tokens[end].is_sign) or twice:
            return 0
        self.of_body.color = look.color or self.of_body.color
        self.of_body.material = look.material or self.of_body.material
        return end - k

    def _purpose(self, k: int) -> int:
        """`detergent drawer`."""
        return int(self._words.text(k) in PURPOSES and _longest(self._texts(k + 1), _mechanisms()) is not None)

    def _described(self, k: int) -> int:
        """`dark red`, `steel`, `hinged`."""
        texts = self._texts(k)
        for length in (2, 1):
            words = " ".join(texts[:length])
            if len(texts) >= length and words in COLOR_WORDS and self._look.color is None:
                self._look.color = COLOR_WORDS[words]
                return length
        if texts and texts[0] in _MATERIAL_WORDS and self._look.material is None:
            self._look.material = _MATERIAL_WORDS[texts[0]]
            return 1
        if texts[:1] and texts[0] in _ENDS and self._has_noun_behind(k) and not self._look.side:
            self._look.side = _SIDES[texts[0]]
            return 1
        return 0

    def _has_noun_behind(self, k: int) -> bool:
        return any(_longest(self._texts(at), self._known()) for at in (k + 1, k + 2))

    def _counted(self, k: int) -> int:
        """`four`, `no`; a number that is not whole, or a second one, is not understood."""
        number = self._tokens[k].number
        of_article = self._words.text(k - 1) in ARTICLES  # a pair, a dozen
        if self.body is None and self._words.text(k) in KINDS:
            return 0
        if number is None or number != int(number) or (self._look.count is not None and not of_article):
            return 0
        self._look.count = int(number)
        return 1

    def _side(self, k: int) -> tuple[str, int]:
        """The side that is named from word k on, and how many words that takes."""
        words = self._texts(k)
        if words and words[0] in _LEVELS and words[1:2] not in (("the",), ("a",), ("an",)):
            return _LEVELS[words[0]], 1
        place = [word for word in words[1:] if word not in ("the", "its")]
        if place[:2] == ["one", "side"] and words[0] == "on":
            return "", 1 + words.index("side")  # all on the same
        if place[:1] == ["side"] and words[0] in ("on", "at"):
            return "side", 1 + words.index("side")
        if not place or words[0] not in _PLACED or place[0] not in _SIDES:
            return "", 0
        skipped = words[1:].index(place[0])
        noun = place[1:3] if place[1:2] == ["hand"] else place[1:2]
        return _SIDES[place[0]], 2 + skipped + (len(noun) if noun and noun[-1] in _SIDE_NOUNS else 0)

    def _hinged(self, k: int) -> int:
        """`hinged on the left`, `opens to the right`, of the doors that were named last, or that it has."""
        if self._words.text(k) not in _SWINGS or self._look != _Look():
            return 0
        at = k + 1
        while self._words.text(at) in _BETWEEN:
            at += 1
        side = self._words.text(at)
        if side not in ("left", "right") or (self.wanted and self.wanted[-1].mechanism.words[0] != "door"):
            return 0
        if self.wanted:
            self.wanted[-1] = replace(self.wanted[-1], hinge=side)
        else:
            self.hinge = side
        return at + 1 - k + (self._words.text(at + 1) in _SIDE_NOUNS)


def _several(mechanism: MechanismKind) -> int:
    """How many are meant that are not counted: what stands on wheels has four."""
    return 4 if mechanism.arranged in ("axles", "corners") else 2


def _unusual(words: tuple[str, ...], names: Sequence[str]) -> str:
    said = next((name for name in names if _words_of(name) == words), " ".join(words))
    return "" if said == names[0] else said


def _longest(texts: tuple[str, ...], named: Mapping[tuple[str, ...], _Kind]) -> tuple[tuple[str, ...], _Kind] | None:
    return next(((words, kind) for words, kind in named.items() if texts[: len(words)] == words), None)


def _words_of(name: str) -> tuple[str, ...]:
    """A name as a sentence is split: `3d` is two words."""
    return tuple(re.findall(r"[0-9]+|[a-z]+", name))


@cache
def _bodies() -> dict[tuple[str, ...], BodyKind]:
    return _by_words((word, body) for body in BODIES for word in body.words)


@cache
def _mechanisms() -> dict[tuple[str, ...], MechanismKind]:
    return _by_words((word, mechanism) for mechanism in MECHANISMS for word in mechanism.words)


def _by_words(named: Iterable[tuple[str, _Kind]]) -> dict[tuple[str, ...], _Kind]:
    """Keyed by the words of the names, the longest first."""
    found = {_words_of(word): kind for word, kind in named}
    return dict(sorted(found.items(), key=lambda item: -len(item[0])))


@cache
def nouns_of_mechanisms() -> frozenset[str]:
    """Nouns, singular, that ask for a mechanism: of a hand wheel the wheel."""
    return frozenset(words[-1] for words in _mechanisms())


@cache
def _vocabulary() -> frozenset[str]:
    details = [tuple(word.split()) for body in BODIES for word in (*body.details, *body.says)]
    members = [_words_of(word) for kind in MECHANISMS for word in kind.members]
    nouns = {word for words in (*_bodies(), *_mechanisms(), *details, *members) for word in words}
    sizes = {word for words in DIMENSIONS.values() for word in words}
    looks = {word for phrase in (*COLOR_WORDS, *_MATERIAL_WORDS) for word in phrase.split()}
    opens = {word for words in _OPENNESS for word in words}
    return frozenset(
        nouns
        | sizes
        | set(SIZE_WORDS)
        | looks
        | opens
        | {*MOTIONS, *OPENNESS, *_SIDES, *_SIDE_NOUNS, *_LEVELS, *_MOVING}
    )
