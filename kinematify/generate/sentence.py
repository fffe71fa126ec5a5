"""From a sentence to an object: parse it, specify what is asked for, build that, and compare.

Parsing builds nothing. What the library has is built; words of the sentence that have no effect on it are harmless
(purposes and looks, and what holds anyway) or listed as not built.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.procedural.language.contradictions import refuse_contradictions
from kinematify.generate.procedural.language.motions import GOING, MOTIONS
from kinematify.generate.procedural.language.parse import (
    FUNCTION_WORDS,
    HAVING,
    MATERIAL_WORDS,
    NOT_DONE,
    PLACES,
    parse,
    unknown_object,
)
from kinematify.generate.procedural.language.sizes import SIZE_WORDS
from kinematify.generate.procedural.language.words import (
    KINDS,
    PLAIN_WORDS,
    PURPOSES,
    STOP_WORDS,
    lemma,
    without_purposes,
    without_rough_sizes,
)
from kinematify.generate.procedural.materials import COLOR_WORDS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.generate.composer.bodies import BodyKind
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.language.compare import Comparison, Missing
    from kinematify.generate.procedural.language.specification import Specification
    from kinematify.generate.request import Request

_HOLDS = re.compile(r"[,\s]+(?:that is |which is )?holding\s+", re.IGNORECASE)
_ON_TOP = re.compile(
    r"^(?P<other>.*\S),?\s+(?:with|and|carrying)\s+(?P<one>an?\s.*\S)\s+on\s+(?:top|it|top of it|its top)\W*$",
    re.IGNORECASE,
)
_ON = re.compile(
    r"^(?P<one>.*?\S)\s+(?:(?:that is |which is )?(?:mounted|standing|sitting|placed|stands|sits)\s+)?on\s+"
    r"(?:top of )?(?P<other>(?:an?|the|its)\s.*)$",
    re.IGNORECASE,
)
_AND = re.compile(
    r"^(?P<one>(?:(?!\b(?:with|having|has|whose|that)\b).)*?\S),?\s+(?:and|next to|beside)\s+"
    r"(?P<other>(?:an?|one|two|three|four|five|six)\s.*)$",
    re.IGNORECASE,
)
_TOY = re.compile(r"\b(?:toy|model|miniature|dolls?(?:'s)?)\s+", re.IGNORECASE)
_DRAWS, _NEXT_DRAW = 20, 1_000_003
_FEW = 2  # kinds of mechanism that are put on an object before a plain body with all of them is as good
_MANNERS = frozenset({*MOTIONS, *GOING, *KINDS, *STOP_WORDS, *MATERIAL_WORDS, *COLOR_WORDS, *SIZE_WORDS})
"""Words of a name without which it names an object of the same kind."""
_SEVERAL = 400  # characters at most that may name several objects


@dataclass(frozen=True, kw_only=True)
class BuildResult:
    """Result of a request."""

    blueprint: Blueprint
    specification: Specification | None = None
    """Of a sentence."""
    not_built: tuple[str, ...] = ()
    """What was asked for and has no effect on the object."""

    @property
    def facts(self) -> dict[str, Any]:
        """Return what is known of a sentence, for ``source.json``."""
        if self.specification is None:
            return {}
        return {
            "text": self.specification.text,
            "understood": self.specification.as_json(),
            "not_built": list(self.not_built),
        }


@dataclass(frozen=True, kw_only=True)
class _Plan:
    """One way to build a specification."""

    specification: Specification
    request: Request
    blueprint: Blueprint
    """Built without a seed."""
    used: frozenset[int]
    dropped: tuple[Missing, ...]
    nouns: Mapping[str, tuple[str, ...]]
    others: tuple[_Plan, ...] = ()
    """Of a scene: what its objects miss."""

    def missing(self, blueprint: Blueprint) -> tuple[str, ...]:
        """Return what of the sentence has no effect on an object."""
        if self.others:
            return tuple(words for plan in self.others for words in plan.missing(plan.blueprint))
        return _missing(self, blueprint)

    def names(self, blueprint: Blueprint) -> Mapping[str, str]:
        """Parts that the sentence calls otherwise than an object does, as it calls them."""
        from kinematify.generate.procedural.language.compare import compare  # noqa: PLC0415 - with numpy

        return {} if self.others else compare(self.specification, blueprint, self.nouns).names

    @cached_property
    def fault(self) -> tuple[int, int]:
        """Words that are not built; where none is left, mechanisms that are put on it beyond a few."""
        words = sum(len(item.split("(")[0].split()) for item in self.missing(self.blueprint))
        return words, 0 if words else max(len(self.request.added) - _FEW, 0)


@dataclass(frozen=True, kw_only=True)
class Sentence:
    """A sentence that was parsed."""

    specifications: tuple[Specification, ...]
    """What it may mean, the likeliest first; one, but where two objects are named, or a toy."""

    @cached_property
    def plan(self) -> _Plan:
        """Return how the most of it is built.

        Raises:
            InputError: It contradicts itself, or nothing of it can be built.
        """
        best: _Plan | None = None
        reason: InputError | None = None
        for specification in self.specifications:
            try:
                refuse_contradictions(specification)
                _refuse_other_kind(specification)
                for plan in _plans(specification):
                    if best is None or plan.fault < best.fault:
                        best = plan
                    if best.fault == (0, 0):
                        return best
            except InputError as error:
                reason = reason or error
        if best is None:
            assert reason is not None, "a specification has a plan, or a reason against it"
            raise reason
        return best

    @property
    def family(self) -> str:
        """Return what is built."""
        return self.plan.request.family

    def made(self, *, seed: int | None = None) -> BuildResult:
        """Build the object, and compare it with what was asked for.

        Args:
            seed: Draws what is not asked for; of some draws the one that lacks least is taken.

        Raises:
            InputError: It contradicts itself, or nothing of it can be built.
        """
        plan = self.plan
        blueprint, missing = plan.blueprint, plan.missing(plan.blueprint)
        if seed is not None:
            blueprint, missing = _drawn(plan, seed, len(missing))
        called = blueprint.renamed(plan.names(blueprint))
        return BuildResult(blueprint=called, specification=plan.specification, not_built=missing)

    def build(self, *, seed: int | None = None) -> Blueprint:
        """Build the object as far as it can be built; see `made`."""
        return self.made(seed=seed).blueprint


def _drawn(plan: _Plan, seed: int, least: int) -> tuple[Blueprint, tuple[str, ...]]:
    """Return the draw of a seed from a plan, and what it misses; the next draw if that is more than `least` words.

    Raises:
        InputError: No draw can be built.
    """
    found: list[tuple[Blueprint, tuple[str, ...]]] = []
    reason: InputError | None = None
    for attempt in range(_DRAWS):
        try:
            blueprint = plan.request.build(seed=seed + attempt * _NEXT_DRAW)
        except InputError as error:
            reason = error
            continue
        found.append((blueprint, plan.missing(blueprint)))
        if len(found[-1][1]) <= least:
            break
    if not found:
        assert reason is not None, "each draw is built, or has a reason against it"
        raise reason
    return min(found, key=lambda item: len(item[1]))


def from_text(sentence: str) -> Sentence:
    """Parse a sentence; nothing is built.

    Args:
        sentence: English.

    Raises:
        InputError: It is empty, too long, no English, or names no kind of object that is known.
    """
    from kinematify.generate.composer.body_sentence import nouns_of_mechanisms  # noqa: PLC0415 - with the library

    asking = nouns_of_mechanisms()
    plain, purposes = without_purposes(sentence, asking)
    plain, rough = without_rough_sizes(plain, asking)
    looks = tuple(dict.fromkeys(re.findall(rf"\b(?:{'|'.join(sorted(PLAIN_WORDS))})\b", plain.lower())))
    harmless = (*looks, *purposes, *rough)
    found: list[Specification] = []
    reason: InputError | None = None
    try:
        found.append(_parsed(plain, harmless))
    except InputError as error:
        reason = error
    if _TOY.search(plain):
        named = {found[0].tokens[k].given for k in found[0].name} if found else set()
        toys = [replace(toy, is_toy=True) for toy in _may_be(_TOY.sub(" ", plain), (*harmless, "toy"))]
        found = [*found, *toys] if _TOY.search(f"{' '.join(named)} ") else [*toys, *found]
    found += _scenes(plain, harmless)
    if not found:
        assert reason is not None, "what was not parsed has a reason"
        raise reason
    return Sentence(specifications=tuple(found))


@cache
def _library() -> dict[tuple[str, ...], list[Family | BodyKind]]:
    """Names of all kinds of object, as words -> what builds them: families, bodies, then variants of families."""
    from kinematify.generate.composer.bodies import BODIES  # noqa: PLC0415 - the library takes a while to load
    from kinematify.generate.described import known_families, library  # noqa: PLC0415

    found: dict[tuple[str, ...], list[Family | BodyKind]] = {}
    families = known_families()
    variants = [(families[name], families[item.like].words) for name, item in library().items() if item.like]
    kinds: list[Family | BodyKind] = [*families.values(), *BODIES]
    for kind, words in (*((kind, kind.words) for kind in kinds), *variants):
        for word in words:
            if " with " in word:
                continue  # a table with a drawer is a table, and has a drawer
            named = found.setdefault(tuple(re.findall(r"[0-9]+|[a-z]+", word.lower())), [])
            if kind not in named:
                named.append(kind)
    return found


def kinds_of_object() -> list[str]:
    """The first name of every kind of object."""
    return sorted({" ".join(kind.words[0].split()) for kinds in _library().values() for kind in kinds})


def _parsed(text: str, harmless: tuple[str, ...]) -> Specification:
    from kinematify.generate.composer.body_sentence import nouns_of_mechanisms  # noqa: PLC0415 - with the library

    return parse(text, _library(), nouns_of_mechanisms(), harmless)


def _may_be(text: str, harmless: tuple[str, ...]) -> list[Specification]:
    """A text as a specification, if it is one."""
    try:
        return [_parsed(text, harmless)]
    except InputError:
        return []


def _scenes(text: str, harmless: tuple[str, ...]) -> Iterator[Specification]:
    """`a printer on a cart with four casters`, `a table and two chairs`: two objects, each of which is known."""
    if len(text) > _SEVERAL:
        return
    if _HOLDS.search(text):
        one, other = _HOLDS.split(text, maxsplit=1)
        yield from _joined(one, "holding", other, harmless)
        return
    for pattern, how in ((_ON_TOP, "carrying"), (_ON, "on"), (_AND, "beside")):
        found = pattern.search(text)
        if found is not None and not _names_a_part(found["other"]):
            pair = ("other", "one") if how == "carrying" else ("one", "other")
            yield from _joined(found[pair[0]], how, found[pair[1]], harmless)


def _names_a_part(text: str) -> bool:
    """True if `the door` is that of what was named before, and no object of its own."""
    from kinematify.generate.composer.body_sentence import nouns_of_mechanisms  # noqa: PLC0415 - with the library

    words = text.lower().rstrip(" .!").split()
    return words[0] in ("the", "its") and lemma(words[-1]) in nouns_of_mechanisms()


def _joined(one: str, how: str, other: str, harmless: tuple[str, ...]) -> Iterator[Specification]:
    for first in _may_be(one, harmless):
        for second in _may_be(other, ()):
            yield replace(first, scene=((how, first, second),))


# ---- how it is built -----------------------------------------------------------------------------------------------


def _plans(specification: Specification, *, alone: bool = True) -> Iterator[_Plan]:
    """Ways to build a specification: by each kind of its name.

    Raises:
        InputError: One of them contradicts itself or is absurd.
    """
    from kinematify.generate.procedural.family import Family  # noqa: PLC0415 - numpy and solids, once there is an object

    if specification.scene:
        yield from _scene_plan(specification)
        return
    name = specification.name
    for start in range(len(name)):
        words = [specification.tokens[k].given for k in name[start:]]
        needed = {k for k in name[:start] if specification.tokens[k].given not in _MANNERS}
        kinds = _library().get(tuple(words)) or _library().get((*words[:-1], lemma(words[-1]))) or []
        # Where `sliding door` cannot be double, a door can be double and sliding.
        meant = replace(specification, name=name[start:])
        reasons: list[InputError] = []
        for kind in kinds:
            try:
                plan = _family_plan(meant, kind) if isinstance(kind, Family) else _composed_plan(meant, kind, alone)
                if needed <= plan.used:  # a hand truck is no truck; a barn door is a door of a kind
                    yield plan
            except InputError as error:
                if start == 0 and isinstance(kind, Family):
                    raise
                reasons.append(error)
        if start == 0 and len(reasons) == len(kinds):
            raise reasons[0]


def _refuse_other_kind(specification: Specification) -> None:
    """Refuse what something does before its name if that is no motion: a rocking chair is another kind of chair.

    Raises:
        InputError: It is said.
    """
    from kinematify.generate.composer.body_sentence import nouns_of_mechanisms  # noqa: PLC0415 - with the library

    before = specification.name[0] - 1
    word = specification.tokens[before].given if before >= 0 else ""
    head = specification.tokens[specification.name[-1]].given
    known = {word for kind in _library() if kind[-1] == head for word in kind[:-1]}
    known |= STOP_WORDS | FUNCTION_WORDS | PURPOSES | {*MOTIONS, *GOING, *HAVING}
    stem = word.removesuffix("ing")
    if stem != word not in known | NOT_DONE and len(specification.name) == 1 and stem not in nouns_of_mechanisms():
        raise InputError(unknown_object(specification.tokens, _library()))


def _family_plan(specification: Specification, family: Family) -> _Plan:
    from kinematify.generate.procedural.language.parts import part_nouns  # noqa: PLC0415 - with solids
    from kinematify.generate.procedural.language.understand import understand  # noqa: PLC0415
    from kinematify.generate.request import Request  # noqa: PLC0415

    meant = understand(specification, family)
    request = Request(
        family=meant.family,
        values=meant.values,
        overall=meant.overall,
        copies=meant.copies,
        is_toy=specification.is_toy,
    )
    nouns = {" ".join(words): names for words, names in part_nouns(family, request.build()).items()}
    return refine_request(specification, request, nouns, used=meant.used, dropped=meant.dropped)


def _composed_plan(specification: Specification, body: BodyKind, alone: bool) -> _Plan:
    from kinematify.generate.composer.body_sentence import asked_composition  # noqa: PLC0415 - with solids
    from kinematify.generate.request import Request  # noqa: PLC0415

    composition, asked = asked_composition(specification, body, may_stand_still=not alone)
    request = Request(
        family=composition.title.replace(" ", "_"),
        values={},
        composition=composition,
        added=tuple(asked.added),
        copies=composition.copies,
        is_toy=specification.is_toy,
        how="" if alone else "in a scene",
    )
    nouns = {word: (item.stem,) for item in composition.wanted for word in item.mechanism.words}
    return refine_request(specification, request, nouns, used=frozenset(asked.used), dropped=tuple(asked.dropped))


def refine_request(
    specification: Specification,
    request: Request,
    nouns: Mapping[str, tuple[str, ...]],
    *,
    used: frozenset[int],
    dropped: tuple[Missing, ...],
) -> _Plan:
    """A plan with what a comparison asks for besides: parts, counts and sizes, then looks, states and ranges."""
    from kinematify.generate.composer.body_sentence import mechanism_for  # noqa: PLC0415 - with solids
    from kinematify.generate.procedural.language.compare import compare  # noqa: PLC0415

    made = request.build()
    compared = compare(specification, made, nouns)
    if request.composition is None:
        chosen = set(made.parameters.values())  # knobs of drawers are there, and no parts
        request = replace(request, handles=tuple(compared.handles))
        fitted = {noun for _, noun, *_ in compared.handles}
        lacking = [part for part in compared.absent if part.noun.split()[-1] not in chosen | fitted]
        added = tuple(filter(None, (mechanism_for(part, specification.owner_of(part)) for part in lacking)))
        request = replace(request, added=added)
    if (request.added and request.composition is None) or compared.counts or compared.sizes or compared.handles:
        request = _recounted(replace(request, resized=tuple(compared.sizes)), compared, specification, nouns)
        made = request.build()
        compared = compare(specification, made, nouns)  # they have looks and ranges, too
    if request.added or compared.looks or compared.opened:
        claims = [claim for part in specification.all_parts() for claim in part.claims]
        sized = any(item.about == "size" or (item.about, item.words[:4]) == ("range", "from") for item in claims)
        request = replace(
            request,
            looks=tuple(compared.looks),
            opened=tuple(compared.opened),
            may_scale=not (sized or request.is_toy or request.overall or request.composition),
        )
        made = request.build()
    return _Plan(specification=specification, request=request, blueprint=made, used=used, dropped=dropped, nouns=nouns)


def _recounted(
    request: Request, compared: Comparison, specification: Specification, nouns: Mapping[str, tuple[str, ...]]
) -> Request:
    """A request with as many parts as are asked for, where less is missing then."""
    from kinematify.generate.procedural.language.compare import compare  # noqa: PLC0415 - with numpy

    least = len(compared.missing)
    for item in compared.counts:
        other = replace(request, counts=(*request.counts, item))
        missing = len(compare(specification, other.build(), nouns).missing)
        if missing < least:
            request, least = other, missing
    return request


def _scene_plan(specification: Specification) -> Iterator[_Plan]:
    for how, first, second in specification.scene:
        one, other = (_best(item) for item in (first, second))
        request = replace(one.request, how=how, other=replace(other.request, how=""))
        made = request.build()
        if made.joints:
            yield replace(one, specification=specification, request=request, blueprint=made, others=(one, other))


def _best(specification: Specification) -> _Plan:
    """Return how the most of an object of a scene is built.

    Raises:
        InputError: Nothing of it can be.
    """
    refuse_contradictions(specification)
    return min(_plans(specification, alone=False), key=lambda plan: plan.fault)


# ---- what is not built ---------------------------------------------------------------------------------------------


def _missing(plan: _Plan, blueprint: Blueprint) -> tuple[str, ...]:
    from kinematify.generate.procedural.language.compare import Missing, compare  # noqa: PLC0415 - with numpy

    specification, tokens = plan.specification, plan.specification.tokens
    compared = compare(specification, blueprint, plan.nouns)
    taken = {*specification.name, *plan.used} - {k for item in plan.dropped for k in item.at}
    found = [item for item in plan.dropped if not item.at or not item.at <= compared.held]
    for item in compared.missing:
        if not item.is_sure and all(k in taken or _names_nothing(specification, k) for k in item.at):
            continue
        within = [other for other in found if other.at and other.at < item.at]
        if any(other.at & item.at for other in found if other not in within):
            continue
        reason = item.reason or next((other.reason for other in within), "")
        found = [other for other in found if other not in within] + [replace(item, reason=reason)]
    covered = {k for item in found for k in item.at}
    rest = [
        k for k in range(len(tokens))
        if k not in taken | covered | compared.held and not _says_nothing(specification, k)
    ]  # fmt: skip
    for phrase in _phrases(rest):
        found.append(Missing(words=" ".join(tokens[k].given for k in phrase), at=frozenset(phrase)))
    found.sort(key=lambda item: min(item.at, default=0))
    return tuple(dict.fromkeys(map(str, found)))


def _names_nothing(specification: Specification, k: int) -> bool:
    """True if a word says nothing, not even a place: `on the inside`."""
    return _says_nothing(specification, k) and specification.tokens[k].given not in PLACES


def _says_nothing(specification: Specification, k: int) -> bool:
    token = specification.tokens[k]
    before_name = k < specification.name[0] and (token.given in PURPOSES)
    return token.is_sign or token.given in STOP_WORDS or token.given in FUNCTION_WORDS or before_name


def _phrases(places: Sequence[int]) -> list[list[int]]:
    """Neighbours together."""
    phrases: list[list[int]] = []
    for k in places:
        if phrases and k == phrases[-1][-1] + 1:
            phrases[-1].append(k)
        else:
            phrases.append([k])
    return phrases
