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
from kinematify.generate.procedural.language.compare import Missing
from kinematify.generate.procedural.language.counts import MOST_COPIES
from kinematify.generate.procedural.language.motions import MOTIONS
from kinematify.generate.procedural.language.openness import OUT, VERBS, share_at
from kinematify.generate.procedural.language.parts import PartReader, PartRequirement
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

    from kinematify.generate.procedural.language.specification import PartSpecification, Specification

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


@dataclass(frozen=True, kw_only=True)
class Composed:
    """What a specification asks of the composer."""

    composition: Composition
    used: frozenset[int]
    """Words that were taken up."""
    dropped: tuple[Missing, ...]
    """What has no place on the body."""


@dataclass(kw_only=True)
class _Look:
    """What is said before a noun."""

    count: int | None = None
    material: str | None = None
    color: str | None = None
    side: str = ""
    """Of `FACING`."""


def read_composition(specification: Specification, body: BodyKind, *, may_stand_still: bool = False) -> Composed:
    """Find out which mechanisms go on a body; what has no place there is dropped.

    Args:
        specification: What is asked for.
        body: Of the object's name.
        may_stand_still: It need not move.

    Raises:
        InputError: It contradicts itself, asks for absurd sizes, or nothing of it would move.
    """
    tokens = tokens_of(specification.text, _vocabulary())
    reader = _Reader(tokens, body, specification.name)
    reader.read()
    if reader.handles is not None and not any(item.mechanism.has_grip for item in reader.wanted):
        reader.drop("handles")
    wanted = (*reader.wanted, *_taken_for_granted(reader))
    if reader.hinge and not any(item.hinge for item in wanted):
        reader.drop(f"opens to the {reader.hinge}")
    for mechanism in reader.excluded:
        if any(wanted.mechanism is mechanism for wanted in reader.wanted):
            raise InputError(f"The text asks for a {mechanism.words[0]} and for none. Say one of both.")
    if reader.bare is not None:
        longest = max(range(len(reader.size)), key=body.size.__getitem__)
        if reader.size[longest] is not None:
            raise InputError(f"The text gives the longest side of the {body.words[0]} twice. Say it once.")
        reader.size[longest] = reader.bare
    for metres, usual in zip(reader.size, body.size, strict=True):
        if metres is not None and metres > _SCALES * usual:
            raise InputError(f"A {body.words[0]} of {metres:g} m is too large; usual is {usual:g} m there.")
    width, depth, height = reader.size
    composition = _fitting(
        Composition(
            body=body,
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
        ),
        reader,
        may_stand_still=may_stand_still,
    )
    unread = list(reader.unread)
    if unread:
        composition, unread = _with_what_parts_say(composition, tokens, reader, may_stand_still)
    used = frozenset(range(len(tokens))) - set(unread)
    return Composed(composition=composition, used=used, dropped=tuple(reader.dropped))


def _fitting(composition: Composition, reader: _Reader, *, may_stand_still: bool) -> Composition:
    """The composition without mechanisms that have no place on its body, the last said first.

    Raises:
        InputError: Nothing of it would move.
    """
    first: InputError | None = None
    while True:
        try:
            compose(composition, may_stand_still=may_stand_still)
        except InputError as error:
            first = first or error
            if (asked := _unkept(composition, may_stand_still)) is not None:
                reader.drop(asked.words, reason=str(error).rsplit(", but ", maxsplit=1)[-1].rstrip("."))
                kept = tuple(item for item in composition.requirements if item is not asked)
                composition = replace(composition, requirements=kept)
                continue
            items = [item for item in reader.wanted if item in composition.wanted]
            if not items:
                raise first from None
            alone = [item for item in items if _fits_without(composition, item)]
            last = (alone or items)[-1]
            reader.drop(
                last.title, *reader.places.get(id(last), ()), reason=str(error).split(". ", maxsplit=1)[0].rstrip(".")
            )
            rest = tuple(item for item in composition.wanted if item is not last)
            composition = replace(
                composition,
                wanted=rest or tuple(_taken_for_granted(reader, nothing_wanted=True)),
                requirements=tuple(item for item in composition.requirements if last.stem not in item.nouns),
            )
        else:
            return composition


def _unkept(composition: Composition, may_stand_still: bool) -> PartRequirement | None:
    """The requirement without which the composition can be built, if it is one of these alone."""
    for item in composition.requirements:
        rest = tuple(other for other in composition.requirements if other is not item)
        try:
            compose(replace(composition, requirements=rest), may_stand_still=may_stand_still)
        except InputError:
            continue
        return item
    return None


def _fits_without(composition: Composition, item: MechanismSpec) -> bool:
    try:
        compose(replace(composition, wanted=tuple(other for other in composition.wanted if other is not item)))
    except InputError:
        return False
    return True


def _with_what_parts_say(
    composition: Composition, tokens: tuple[Token, ...], reader: _Reader, may_stand_still: bool
) -> tuple[Composition, list[int]]:
    """Read words that name no mechanism against the parts that are built, `a flap that folds down`; what is left."""
    made = compose(composition, may_stand_still=may_stand_still)
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
    left = [k for k in reader.unread if k not in parts.reading.used]
    return replace(composition, requirements=(*composition.requirements, *parts.requirements)), left


def _taken_for_granted(reader: _Reader, *, nothing_wanted: bool = False) -> list[MechanismSpec]:
    """What the body has without being asked for."""
    body = reader.body
    named = [*reader.excluded, *(item.mechanism for item in reader.wanted)]
    granted = {**body.always, **({} if reader.wanted and not nothing_wanted else body.usual)}
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

    def __init__(self, tokens: Sequence[Token], body: BodyKind, name: Sequence[int]) -> None:
        """Begin before the first word; the body's name stands at some words."""
        self._tokens = tokens
        self._words = Words(tuple(tokens))
        self._look = _Look()
        self.body = body
        self.named = frozenset(name)
        self._past_name = False
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
        self.dropped: list[Missing] = []
        """What has no place here."""
        self.places: dict[int, range] = {}
        """Words of what is wanted, by the id of it."""
        self.unread: list[int] = []
        """Words that name no mechanism; what they say of parts is read when these are there."""
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
                if self._past_name:
                    self._described_so_far()  # of a noun that is not known here
                    self.unread += self._looking
                self.unread.append(k)
            if self._look == _Look():
                self._looking = []
            elif taken:
                self._looking += range(k, k + taken)
            k += max(taken, 1)
        self.unread += self._looking  # it describes nothing that follows

    def drop(self, words: str, *where: int, reason: str = "") -> None:
        """Build without something that was asked for."""
        self.dropped.append(Missing(words=words, at=frozenset(where), reason=reason))

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
        of_what_comes = self._past_name and _longest(self._texts(k + _BARE + 1), self._known()) is not None
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
        if named is None or k in self.named:
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
        if again or (not self._past_name and not self._stands_on(end)):
            self.drop(" ".join(words), *range(k, end))  # a part of something else, or one that was named before
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
        wanted = MechanismSpec(
            mechanism=mechanism,
            said=_unusual(words, mechanism.words),
            count=look.count or (_several(mechanism) if plural else 1),
            side="" if banded else side,
            level=(1 if side == "top" else -1) if banded else 0,
            material=look.material,
            color=look.color,
        )
        self.wanted.append(wanted)
        self.places[id(wanted)] = range(k, end)
        return len(words) + taken

    def _known(self) -> Mapping[tuple[str, ...], MechanismKind]:
        """Mechanisms by their words, as they are called on this body."""
        says = self.body.says
        own = {tuple(word.split()): _mechanisms()[tuple(kind.split())] for word, kind in says.items()}
        return {**own, **{words: kind for words, kind in _mechanisms().items() if words not in own}}

    def _detail(self, k: int) -> int:
        """`with two handles`, which this body has anyway; `with five blades`, of the rotor that it has or just got."""
        if not self._past_name:
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
        if self._past_name or word not in SIZE_WORDS:
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
        if self._past_name or k != min(self.named):
            return 0
        self._past_name = True
        words = tuple(self._tokens[i].text for i in sorted(self.named))
        self.said = _unusual(words, self.body.words)
        self.of_body = self._described_so_far()
        self.copies = 1 if self.of_body.count is None else self.of_body.count
        if not 1 <= self.copies <= MOST_COPIES:
            raise InputError(
                f"The text asks for {self.copies} {' '.join(words)}; at most {MOST_COPIES} are built side by side."
            )
        return len(words)

    def _openness(self, k: int) -> int:
        """`half open`."""
        texts = self._texts(k)
        says_that_it_can = self._words.text(k - 1) in ("that", "which", "can")
        for words, share in _OPENNESS.items() if self._look == _Look() and not says_that_it_can else ():
            # Amid a sentence it would be said of one mechanism alone.
            if texts[: len(words)] == words and (not self._past_name or texts == words):
                self.rest = share
                return len(words)
        return 0

    def _look_of_body(self, k: int) -> int:
        """`, walnut,`: what stands between commas describes the whole."""
        if not self._past_name or self._words.text(k - 1) != "," or self._look != _Look():
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
        if not self._past_name and self._words.text(k) in KINDS:
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


def mechanism_for(part: PartSpecification) -> MechanismSpec | None:
    """The mechanism that a part asks for, which an object has not; none if it belongs to another part."""
    words, said = part.noun.split(), {claim.about: claim.value for claim in part.claims}
    kinds = (_mechanisms().get(tuple(words[k:])) for k in range(len(words)))
    kind = next((kind for kind in kinds if kind is not None and kind.arranged == "grid"), None)
    related = [claim.value[1] for claim in part.claims if claim.about == "relation"]
    if kind is None or part.of or part.absent or (related and related[0].split()[-1] not in _SIDES):
        return None
    return MechanismSpec(
        mechanism=kind,
        said=words[-1],
        count=min(part.count or _several(kind), _MOST_MEMBERS),
        side=_SIDES.get(said.get("place", ""), ""),
        material=said.get("material"),
        color=said.get("color"),
    )


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
