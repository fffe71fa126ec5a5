"""Compare a specification with the object that was built: what of it does not hold is reported, whoever built it."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.language.motions import BARE, MOTIONS, WAYS, goes, moves_so, turns_about_itself
from kinematify.generate.procedural.language.places import (
    MIDDLE,
    PLACES,
    chosen_by_place,
    mirrored,
    number_there,
    touch,
    wrong_place,
    wrong_relation,
)
from kinematify.generate.procedural.language.specification import HANDLES, Claim, PartSpecification
from kinematify.generate.procedural.language.words import ARTICLES, PURPOSES, lemma, stem_of
from kinematify.generate.procedural.materials import COLORS, MATERIALS
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.generate.procedural.language.specification import Specification

_SIZE = 0.02  # of a size, by which it may be off
_SYNONYMS = (
    {"door", "leaf", "gate"}, {"lid", "cover", "top", "cap", "flap"}, {"knob", "dial"}, {"wheel", "tyre", "tire"},
    {"caster", "castor", "swivel_wheel", "wheel"}, {"arm", "link", "boom"}, {"drawer", "tray"},
    {"sash", "casement", "pane"},
    {"rotor", "blade", "propeller", "fan"}, {"seat", "cushion"}, {"back", "backrest"},
    {"handle", "grip", "pull", "knob"},
    {"lever", "handle"}, {"flap", "tailgate", "door", "ramp"}, {"shade", "head"}, {"button", "key"}, {"barrel", "drum"},
    {"screen", "lid", "display"}, {"shelf", "board"}, {"jaw", "finger"}, {"pedal", "foot_pedal"}, {"rack", "basket"},
)  # fmt: skip
"""Words of which one may represent another, whatever object it is."""
_OF_ANY_OBJECT = frozenset({
    "base", "body", "frame", "top", "front", "back", "side", "bottom", "edge", "inside", "surface", "middle", "end",
    "corner", "interior", "outside", "wall", "floor", "ceiling", "table", "ground", "it", "place", "height", "size",
    "other", "same", "axis", "hinge", "joint", "rim", "pair", "set", "window", "desk", "centre", "center", "position",
    "row", "column",
    "grid", "line", "stack", "half", "way", "direction",
})  # fmt: skip
"""What every object has, and what it may stand on or hang from."""
_AROUND = (
    "wall", "floor", "ceiling", "table", "ground", "desk", "it", "row", "column", "grid", "line", "stack", "pair",
    "set", "height", "size", "way", "half", "window", "position",
)  # fmt: skip
"""What the whole may stand on, hang from or be in."""
_NOT_OF_IT = ("hinge", "joint", "rim", "window", "desk", "table", "row", "column", "grid", "line", "stack", "size")
"""Of these, what an object has only if it is built: something is between the hinges of two hinges alone."""
_OWN_PLACES = ("side", "end", "top", "bottom", "front", "back")
_LIES = ("on", "at", "in", "of", "along", "near", "onto")
"""Before these they say where something is, and no way through."""
_BESIDE_WHAT = ("between", "behind", "in front of", "inside", "through", "across", "around", "of")
Fitting = tuple[tuple[str, ...], str, str, str]
"""Names of parts; what their handle is called, its colour and its material, empty where nothing is said."""
CLOSING = ("door", "drawer", "lid", "flap", "hatch", "gate", "leaf", "sash", "shutter", "cover", "window")
"""Parts that belong into an opening, so that there are no more than openings."""
_COVERS = (
    "door", "drawer", "lid", "flap", "knob", "wheel", "caster", "handle", "button", "latch", "cover", "hatch", "switch",
    "dial", "key", "slider", "lock", "hook", "tray",
)  # fmt: skip
"""Parts whose motion does not make the whole move so: a cabinet with a door does not turn."""
_MOVING = frozenset({
    "wheel", "caster", "castor", "door", "drawer", "lid", "flap", "pedal", "button", "lever", "crank", "gate", "dial",
    "tailgate", "switch", "hatch", "shutter", "propeller", "rotor", "roller", "gear", "turntable", "plunger", "slider",
    "sash", "knob",
})  # fmt: skip
"""Parts that move wherever they are."""
_LOOKS = ("color", "material")
_MEASURED = (
    "size", "moves", "way", "range", "hinge", "place", "relation", "color", "material", "open", "like", "count",
    "answers", "only",
)  # fmt: skip
_MOTION = ("moves", "way", "hinge", "open", "range", "answers")
"""Of these, what is said of its joints."""
_NO_ANSWER = {"sprung": "joints have no springs", "stiff": "friction follows from what a joint carries"}
"""What is said of a part that is there, and can be measured of it."""
_AXES = {"width": (0, 1), "length": (0, 1, 2), "depth": (1, 0), "height": (2,), "diameter": (0, 1, 2), "": (0, 1, 2)}


@dataclass(frozen=True, kw_only=True)
class Missing:
    """Something that was asked for and that the object has not."""

    words: str
    """What was asked for, as it was written."""
    at: frozenset[int]
    reason: str = ""
    """What is there instead."""
    is_sure: bool = False
    """It was measured: what is there contradicts it."""

    def __str__(self) -> str:
        return f"{self.words} ({self.reason})" if self.reason else self.words


@dataclass(kw_only=True)
class Comparison:
    """Comparison of a specification with an object."""

    held: set[int] = field(default_factory=set)
    """Words that hold."""
    missing: list[Missing] = field(default_factory=list)
    names: dict[str, str] = field(default_factory=dict)
    """Parts that the sentence calls otherwise, by their names -> as it calls them."""
    absent: list[PartSpecification] = field(default_factory=list)
    """Parts that are not there."""
    looks: list[tuple[tuple[str, ...], str, str]] = field(default_factory=list)
    """Parts that look otherwise than asked for: their names, and the material or the colour, the other one empty."""
    counts: list[tuple[tuple[str, ...], int]] = field(default_factory=list)
    """Moving parts of which another number is asked for: their names, and how many."""
    sizes: list[tuple[tuple[str, ...], str, float]] = field(default_factory=list)
    """Parts whose size is said, or the whole where its is another one: names, which size, and how large it is [m]."""
    handles: list[Fitting] = field(default_factory=list)
    """Handles of some parts that differ from those of the others."""
    opened: list[tuple[tuple[str, ...], str, float]] = field(default_factory=list)
    """Parts that are not so far open as is asked for: their names; ``share``, ``angle`` [rad] or ``distance`` [m], and
    how much. ``range``: that they have another range than is asked for, and how long it is [rad or m]."""


@dataclass(kw_only=True)
class _Compared(Comparison):
    """An object, and what was found in it so far."""

    made: Blueprint
    nouns: Mapping[str, Sequence[str]]
    """What its parts are called besides their names -> names of parts."""
    specification: Specification

    # ---- parts by their nouns --------------------------------------------------------------------------------------

    @cached_property
    def closed(self) -> Blueprint:
        """With all joints at their zero."""
        return self.made.moved({joint.child: -joint.value for joint in self.made.joints})

    def _take_handles(self) -> None:
        for part, owner in self.specification.handles():
            every = self.parts_called(owner.noun)[0] if owner else []
            color, material = (next((str(c.value) for c in part.claims if c.about == about), "") for about in _LOOKS)
            if owner and every and "handle" in self.made.parameters:
                names = tuple(item.name for item in chosen_by_place(every, owner))
                self.handles.append((names, "none" if part.absent else part.noun, color, material))
        taken: set[str] = set()
        for k in sorted(range(len(self.handles)), key=lambda k: len(self.handles[k][0])):  # the others have another one
            names, *look = self.handles[k]
            self.handles[k] = (tuple(name for name in names if name not in taken), look[0], look[1], look[2])
            taken |= set(names)

    def parts_called(self, noun: str) -> tuple[list[Part], int]:
        """Parts that are called so, and how many words of the noun say it."""
        words = noun.split()
        for k in range(len(words)):
            if found := self._called("_".join(words[k:])):
                return found, len(words) - k
        return [], 0

    @cached_property
    def _nouns_asked(self) -> frozenset[str]:
        return frozenset(part.noun.rsplit(maxsplit=1)[-1] for part in self.specification.parts)

    def _called(self, stem: str) -> list[Part]:
        """Parts whose names say a word: as the builder calls them, exactly, at their end, by another word for it."""
        names = set(self.nouns.get(stem.replace("_", " "), ()))
        others = [other for group in _SYNONYMS if stem in group for other in sorted(group - {stem})]

        def matches() -> Iterator[Callable[[str], bool]]:
            yield lambda name: name in names or stem_of(name) in names
            for word in (stem, *others):
                if word in self._nouns_asked and word != stem:
                    continue  # it is asked for, too
                yield lambda name, word=word: word in (stem_of(name), lemma(stem_of(name)))  # type: ignore[misc]
                yield lambda name, word=word: _ends_with(name, word)  # type: ignore[misc]
            yield lambda name: stem_of(name).startswith(f"{stem}_")

        groups = ([part for part in self.made.parts if match(part.name)] for match in matches())
        there = [found for found in groups if found]
        return next((found for found in there if self._joints_of(found)), there[0] if there else [])

    def counted(self, noun: str) -> int | None:
        """Return how many a parameter says that there are, of what is no part of its own: handles, shelves, slots."""
        for word in dict.fromkeys((noun, noun.rsplit(maxsplit=1)[-1])):
            name = word.replace(" ", "_")
            for key in (name, f"{name}s", f"{name}es"):
                value = self.made.parameters.get(key)
                if isinstance(value, bool) or value is None:
                    continue
                if isinstance(value, int):
                    return value
                if isinstance(value, str) and value:
                    return 0 if value == "none" else -1 if key in HANDLES else 1
        return None

    def _numbers(self, noun: str, found: Sequence[Part]) -> set[int | None]:
        """Return how many there are: all that are called so, those of one name, or as many as a parameter says."""
        stems = Counter(stem_of(part.name) for part in found)
        words = {word for group in _SYNONYMS if noun.rsplit(maxsplit=1)[-1] in group for word in group} | {noun}
        names = {part.name for part in found}  # a finger has three links
        chains = [name for name in names if name in self.made.joint_above]
        chains = [name for name in chains if self.made.joint_above[name].parent not in names]
        numbers: set[int | None] = {len(found), *stems.values(), len(chains)}
        copies = self.specification.whole.count or 1
        numbers |= {number // copies for number in numbers if number is not None and number % copies == 0}
        return numbers if noun.rsplit(maxsplit=1)[-1] in stems else numbers | set(map(self.counted, sorted(words)))

    # ---- what is said of them --------------------------------------------------------------------------------------

    def check(self) -> Comparison:
        """Compare all that is said."""
        self._take_handles()
        for claim in self.specification.whole.claims:
            if claim.about not in ("there", "count"):
                wrong = self._whole_keeps(claim)
                if wrong is not None and claim.about == "range":
                    self._to_be_limited(claim, self._meant_by_whole(claim))
                elif wrong is not None and claim.about == "color":
                    self.looks.append((tuple(part.name for part in self._fronts()), "", claim.value))
                elif claim.about == "size" and (wrong is not None or claim.value[0] == "top"):
                    self.sizes.append(((), *claim.value))
                self._judge(claim, wrong)
        for k in self.specification.name[:-1]:  # a folding table has a part that folds
            word = self.specification.tokens[k].given
            how = MOTIONS.get(word) if word not in BARE else None
            if how and not any(moves_so(self.made, joint, how) for joint in self.made.joints):
                self._report_missing(word, (k,), "no part does")
        groups: dict[str, list[PartSpecification]] = defaultdict(list)
        for part in self.specification.parts:
            groups[part.noun.split()[-1]].append(part)
        for parts in groups.values():
            self._check_group(parts)
        return self

    def _judge(self, claim: Claim, wrong: str | None) -> None:
        """Take up that a claim holds (None), or what is wrong with it."""
        if wrong is None:
            self.held.update(claim.at)
        else:
            sure = claim.about in _MEASURED and claim.about not in ("relation", "place")
            self.missing.append(Missing(words=claim.words, at=frozenset(claim.at), reason=wrong, is_sure=sure))

    def _check_group(self, parts: Sequence[PartSpecification]) -> None:
        """Check parts of one noun together: the left door is one of two doors."""
        numbers = [number for part in parts if (number := _total(part)) is not None]
        new = len(parts) > 1 and all(map(self._is_new, parts))
        placed = all(any(claim.about == "place" for claim in part.claims) for part in parts)
        apart = len(parts) > 1 and (new or placed)
        asked = (sum(numbers) if apart else max(numbers)) if numbers else None
        every, _ = self.parts_called(parts[0].noun)
        if placed and len(numbers) == len(parts) > 1 and sum(numbers) in self._numbers(parts[0].noun, every):
            self._check_places(parts, every)
        for part in sorted(parts, key=_is_one):
            found, known = self.parts_called(part.noun)
            owners = [item for item in self.specification.parts if item.noun == part.of]
            if not found and owners and part.noun in ("front", "face", "panel"):  # which looks as its owner does
                found = chosen_by_place(self.parts_called(part.of)[0], owners[0])
            number = len(found) if found else self.counted(part.noun)
            if any(part is item for item, owner in self.specification.handles() if owner) and self._fitted(part):
                self.held.update(k for claim in part.claims for k in claim.at)
            elif part.absent:
                self._absent(part, found, number)
            elif number:
                self._account_for_modifiers(part, part.claims[0], known)
                before = len(self.missing)
                if part.of and not self._is_on_owners(part, found, number):
                    self._not_there(part)
                    continue
                self._check_number(part, found, {asked, -1, asked if apart else _total(part)}, alone=len(parts) == 1)
                chosen = self._individuals(part, found, parts, new=new)
                if part.count == 1 < len(found) == len(chosen) and known < len(part.noun.split()) and len(parts) > 1:
                    chosen = []  # which of them is not known: the hour hand of three hands
                self._check_claims(part, found, chosen, parts)
                all_meant = len(chosen) == len(found) and part.count in (None, len(found))
                if known and len(self.missing) == before and all_meant:
                    self._rename(found, "_".join(part.noun.split()[-known:]), part.noun)
            elif not (part.of and self._all_have_it(part)):
                self._not_there(part)

    def _fitted(self, part: PartSpecification) -> bool:
        """True if parts have a handle of their own, as it was asked for."""
        given = [item for item in self.handles if item[1] == ("none" if part.absent else part.noun)]
        return bool(given) and all(
            self.made.parameters.get(f"handle of {name}") == " ".join(filter(None, item[1:]))
            for item in given
            for name in item[0]
        )

    def _is_on_owners(self, part: PartSpecification, found: Sequence[Part], number: int) -> bool:
        """True if each of those that are to have a part has one: `three drawers, all with locks`."""
        specified = self.specification.owner_of(part)
        every = self.parts_called(part.of)[0] if specified else []
        owners = chosen_by_place(every, specified) if specified and every else []
        if not found:
            return number < 0 or number >= len(owners) or part.noun in self.made.parameters.values()
        carried = {name for item in found for name in (item.name, *self._carriers(item.name))}
        return all(owner.name in carried or any(touch(owner, item) for item in found) for owner in owners)

    def _not_there(self, part: PartSpecification) -> None:
        moved = any(claim.about in ("moves", "way", "hinge") for claim in part.claims)
        if part.noun.split()[-1] in _OF_ANY_OBJECT - {"window"} and not moved:
            self._account_for_modifiers(part, part.claims[0], 1)
            return
        at = frozenset(k for claim in part.claims for k in claim.at)
        words = " ".join(self.specification.tokens[k].given for k in sorted(at))
        is_named = any(lemma(self.specification.tokens[k].given) == part.noun.split()[-1] for k in at)
        reason = "" if is_named else f"no {part.noun}"
        self.missing.append(Missing(words=words, at=at, reason=reason, is_sure=moved))
        self.absent.append(part)

    def _individuals(
        self, part: PartSpecification, found: Sequence[Part], parts: Sequence[PartSpecification], *, new: bool
    ) -> list[Part]:
        """Those that are meant; of `a glass door and a steel door` the first is the glass one."""
        k, placed = parts.index(part), any(claim.value in PLACES for claim in part.claims if claim.about == "place")
        every = {item.name for other in parts for item in self.parts_called(other.noun)[0]}
        if new and found and k >= len(every):
            self._report_missing(_said(part), part.claims[0].at, f"{len(every)} built in all")
        if new and not placed and len(every) == len(found) == len(parts):
            return [found[k]]
        how = [claim.value for claim in part.claims if claim.about == "moves"]
        so = [item for item in found if any(moves_so(self.made, j, m) for j in self._joints_of([item]) for m in how)]
        if part.count is not None and len(so) == part.count < len(found):
            return so
        names = {item.name for item in found}
        own = [item for item in found if not self._carriers(item.name) & names]  # a castor carries its wheel
        before = [other for other in parts[:k] if other.is_share and part.is_share]
        taken = sum(other.count or 0 for other in before)
        chosen = {item.name for item in chosen_by_place(own[taken:] if part.is_share else own, part)}
        return [item for item in found if (self._carriers(item.name) | {item.name}) & chosen]

    def _carriers(self, name: str) -> set[str]:
        """Return what carries a part, up to the root."""
        found: set[str] = set()
        while (joint := self.made.joint_above.get(name)) is not None:
            name = joint.parent
            found.add(name)
        return found

    def _check_places(self, parts: Sequence[PartSpecification], found: Sequence[Part]) -> None:
        """Check how many are at each of several places: three wheels at the front and one at the back."""
        closed = {part.name: part.bounds.mean(axis=0) for part in self.closed.parts}
        own = [item.name for item in found if not self._carriers(item.name) & {part.name for part in found}]
        for part in parts if own else ():
            place = next(claim for claim in part.claims if claim.about == "place")
            there = number_there(closed, own, place.value)
            if there not in (None, part.count):
                self._report_missing(
                    f"{part.count} {part.noun} {place.words}", (*part.claims[0].at, *place.at), f"{there} built"
                )

    def _check_claims(
        self, part: PartSpecification, found: Sequence[Part], chosen: list[Part], parts: Sequence[PartSpecification]
    ) -> None:
        for claim in (claim for claim in part.claims[1:] if claim.about != "count"):
            meant = chosen
            if claim.about in _LOOKS and len(chosen) == len(found):  # but for those of which is said otherwise
                ones = [chosen_by_place(found, other) for other in parts if other is not part and _is_one(other)]
                meant = [item for item in chosen if not any(item in one for one in ones)] or chosen
            wrong = self._part_keeps(part, claim, meant, found)
            if (wrong is not None or claim.about == "size" or (claim.about in _LOOKS and self.looks)) and meant:
                self._to_be_changed(claim, meant)
            self._judge_part(part, claim, wrong, is_there=bool(chosen))
        still = not self._joints_of(found) and not any(self._carrying(item.name) for item in found)
        if still and self._is_usually_moving(part):
            self._report_missing(part.claims[0].words, part.claims[0].at, "it does not move")

    def _to_be_changed(self, claim: Claim, parts: Sequence[Part]) -> None:
        """Take up parts that are to look otherwise, or to be open."""
        if claim.about in _LOOKS:
            look = (claim.value, "") if claim.about == "material" else ("", claim.value)
            self.looks.append((tuple(part.name for part in parts), *look))
        elif claim.about == "open":
            self.opened.append((tuple(joint.child for joint in self._joints_of(parts)), *claim.value))
        elif claim.about == "size":
            self.sizes.append((tuple(part.name for part in parts), *claim.value))
        elif claim.about == "range":
            self._to_be_limited(claim, self._ranging(parts, claim) or self._joints_of(parts))

    def _to_be_limited(self, claim: Claim, joints: Sequence[BlueprintJoint]) -> None:
        """Take up joints that go less far than is asked for, or farther."""
        how, much = claim.value
        names = tuple(joint.child for joint in joints if joint.kind.turns is (how == "angle"))
        if names:
            self.opened.append((names, "range", much))

    def _meant_by_whole(self, claim: Claim) -> list[BlueprintJoint]:
        """Joints that a range of the whole is said of: those that move as it says, if their parts have one name."""
        said = [item.value for item in self.specification.whole.claims if item.about == "moves"]
        ways = [item.value for item in self.specification.whole.claims if item.about == "way" and item.value in WAYS]
        found = [
            joint
            for joint in self.made.joints
            if joint.kind.turns is (claim.value[0] == "angle")
            and joint.mimic is None
            and all(moves_so(self.made, joint, how) for how in said)
            and (joint.kind.turns or all(goes(self.closed, joint, way) for way in ways if math.isfinite(joint.upper)))
        ]
        found = [joint for joint in found if math.isfinite(joint.upper)] or found
        return found if len({stem_of(joint.child) for joint in found}) == 1 else []

    def _report_missing(self, words: str, at: Iterable[int], reason: str) -> None:
        """Take up what was measured and is not as it was asked for."""
        self.missing.append(Missing(words=words, at=frozenset(at), reason=reason, is_sure=True))

    def _check_number(
        self, part: PartSpecification, found: Sequence[Part], asked: set[int | None], *, alone: bool
    ) -> None:
        """Check how many there are; `a door` is one, and `legs` are several."""
        there, numbers = part.claims[0], self._numbers(part.noun, found)
        said = next((claim for claim in part.claims if claim.about == "count"), None)
        built = f"{len(found) or self.counted(part.noun)} built{'' if part.count in asked else ' in all'}"
        if said is not None and ((_is_one(part) and said.words != "single") or numbers & asked):
            self.held.update(said.at)
        elif said is not None:
            words, at = f"{said.words} {there.words}", frozenset((*said.at, there.at[-1]))
            self.missing.append(Missing(words=words, at=at, reason=built, is_sure=bool(found)))
            closes = part.noun.split()[-1] in CLOSING or self.counted(part.noun) is not None
            if part.count and self._joints_of(found) and not closes:
                self.counts.append((tuple(item.name for item in found), _total(part) or part.count))
        elif _on_sides(part) and len(found) == 1:
            self._report_missing(f"{there.words} on each side", there.at, built)
        elif part.count is None and len(found) == 1 and not self._several(part):
            self._report_missing(_said(part), there.at, "in one part")
        elif part.count == 1 and alone and not part.of and found and 1 not in numbers and not _on_sides(part):
            self._report_missing(_said(part), there.at, built)

    def _several(self, part: PartSpecification) -> bool:
        """True if one part is several of something by what it is called, or by a parameter."""
        said = part.claims[0].words.split()[-1]
        return bool(self.counted(part.noun)) or (said in self.nouns and said not in map(stem_of, self.nouns[said]))

    def _rename(self, found: Sequence[Part], noun: str, said: str) -> None:
        """Call moving parts of one name as the sentence does."""
        stems = {stem_of(part.name) for part in found}
        taken = {stem_of(part.name) for part in self.made.parts}
        moving = all(part.name in self.made.joint_above for part in found)
        if (
            moving
            and len(stems) == 1
            and not stems & set(said.split())
            and noun not in taken
            and not f"_{stem_of(found[0].name)}".endswith(f"_{noun}")
        ):
            several = len(found) > 1
            self.names |= {part.name: f"{noun}_{k}" if several else noun for k, part in enumerate(found, start=1)}

    def _all_have_it(self, part: PartSpecification) -> bool:
        """True if one part was to have something that a parameter gives to all of its kind."""
        owner = next((item for item in self.specification.parts if item.noun == part.of and item.count == 1), None)
        siblings, _ = self.parts_called(part.of)
        alike = any(claim.about == "like" for item in self.specification.parts for claim in item.claims)
        given = part.noun.split()[-1] in self.made.parameters.values() or self.counted(part.noun)
        if (
            owner is None
            or alike
            or not given
            or len(siblings) < 2
            or not any(claim.about == "place" for claim in owner.claims)
        ):
            return False
        place = next(claim.words for claim in owner.claims if claim.about == "place")
        words, at = f"{part.noun} of the {place} {part.of} alone", frozenset(part.claims[0].at)
        self.missing.append(Missing(words=words, at=at, reason=f"every {part.of} has one", is_sure=True))
        return True

    def _is_new(self, part: PartSpecification) -> bool:
        """True if an article says that a part was not named before: `a glass door and a steel door`."""
        first = min(part.claims[0].at)
        before = {token.given for token in self.specification.tokens[max(first - 3, 0) : first]}
        return part.count == 1 and bool(before & {*ARTICLES, "another"}) and "the" not in before

    def _judge_part(self, part: PartSpecification, claim: Claim, wrong: str | None, *, is_there: bool) -> None:
        if wrong is not None and claim.about != "there":
            said = part.claims[0]
            words = claim.words if set(said.at) & set(claim.at) else f"{said.words}: {claim.words}"
            sure = claim.about in _MEASURED and (is_there or claim.about in _MOTION)
            self.missing.append(Missing(words=words, at=frozenset(claim.at), reason=wrong, is_sure=sure))
        else:
            self.held.update(claim.at)

    def _absent(self, part: PartSpecification, found: Sequence[Part], number: int | None) -> None:
        at = frozenset(k for claim in part.claims for k in claim.at)
        if number or part.noun.split()[-1] in _OF_ANY_OBJECT:
            words = f"without {part.claims[0].words}"
            built = number if number and number > 0 else 1
            self.missing.append(Missing(words=words, at=at, reason=f"{built} built", is_sure=True))
        else:
            self.held |= at

    def _account_for_modifiers(self, part: PartSpecification, there: Claim, known: int) -> None:
        """Words before a noun that is there: what it is for is harmless, the others are reported."""
        words = part.noun.split()
        modifiers = max(len(words) - max(known, 1), 0)
        self.held.update(there.at[modifiers:])
        own = set(self.specification.kind.split())
        left = []
        for k, word in zip(there.at, words[:modifiers], strict=False):
            if word in PURPOSES or word in own or lemma(word) in own:
                self.held.add(k)
            else:
                left.append((k, word))
        if left:
            said = " ".join([*(word for _, word in left), words[-1]])
            reason = f"a plain {words[-1]}"
            self.missing.append(Missing(words=said, at=frozenset(k for k, _ in left), reason=reason))

    def _part_keeps(
        self, part: PartSpecification, claim: Claim, chosen: Sequence[Part], found: Sequence[Part]
    ) -> str | None:
        """Return what is wrong with a claim about some of the parts of a noun; None if it holds."""
        joints = self._joints_of(chosen)
        if not chosen and claim.about not in (*_MOTION, *_LOOKS):
            return "a solid of another part"
        if claim.about == "moves" or (claim.about in _MOTION and not joints):
            return self._joints_keep(claim, joints) if joints else "it is fixed"
        if claim.about in _MOTION:  # of each; of one that is said by no place any will do
            each = [own for item in chosen if (own := self._ranging([item], claim) or self._joints_of([item]))]
            wrong = [self._joints_keep(claim, own) for own in each]
            one = part.count == 1 and len(chosen) > 1
            return None if one and None in wrong else next(filter(None, wrong), None)
        judges: dict[str, Callable[[], str | None]] = {
            "size": lambda: self._sized(claim.value, chosen),
            "color": lambda: self._look_of(claim, chosen),
            "material": lambda: self._look_of(claim, chosen),
            "place": lambda: (
                None
                if self._is_on_other(part, claim)
                else wrong_place(self.closed, claim.value, chosen, found, on_each=_on_sides(part))
            ),
            "relation": lambda: self._related(claim, part, chosen),
            "like": lambda: mirrored(self.closed, found),
            "still": lambda: "it moves" if self._joints_of(chosen) else None,
            "only": lambda: self._others_do(part, chosen, found),
            "does": lambda: "no such motion",
        }
        return judges[claim.about]() if claim.about in judges else "nothing says so"

    def _others_do(self, part: PartSpecification, chosen: Sequence[Part], found: Sequence[Part]) -> str | None:
        """Return what is wrong with what only some of the parts are or do; None if the others do not."""
        names = {item.name for item in (chosen[: part.count] if part.count else chosen)}
        others = [item for item in found if item.name not in names]
        said = [claim for claim in part.claims if claim.about in (*_MOTION, *_LOOKS)]
        do = others and said and all(self._part_keeps(part, claim, others[:1], found) is None for claim in said)
        return f"every {part.noun} does" if do else None

    def _joints_of(self, parts: Sequence[Part]) -> list[BlueprintJoint]:
        """Joints of parts; of what is fixed, those of what it carries, else of what spins with it."""
        names = {part.name for part in parts}
        moving = [joint for joint in self.made.joints if joint.kind is not JointType.FIXED]
        above = [joint for joint in moving if joint.child in names]
        above = above or [joint for joint in moving if joint.parent in names - {self.made.root}]
        carrying = [joint for part in parts for joint in self._carrying(part.name)[:1]]
        return above or [joint for joint in carrying if joint.kind is JointType.CONTINUOUS]

    def _ranging(self, parts: Sequence[Part], claim: Claim) -> list[BlueprintJoint]:
        """Return the joints nearest to a range that move as it says: a chuck spins on a quill that goes down."""
        turns = claim.about == "range" and claim.value[0] == "angle"
        chains = [self._carrying(part.name) for part in parts] if claim.about == "range" else []
        return [joint for chain in chains for joint in [j for j in chain if j.kind.turns is turns][:1]]

    def _carrying(self, name: str) -> list[BlueprintJoint]:
        """Joints that move a part, its own first, up to a door or the like: a blade spins on an arm that goes down."""
        chain: list[BlueprintJoint] = []
        while (joint := self.made.joint_above.get(name)) is not None and not (chain and _covers(name, ())):
            chain += [joint] if joint.kind is not JointType.FIXED else []
            name = joint.parent
        return chain

    def _is_usually_moving(self, part: PartSpecification) -> bool:
        """True if a part is one that moves wherever it is, and not the handle of each door."""
        word = part.noun.split()[-1]
        return word in _MOVING and self.counted(part.noun) != -1 and word not in self.made.parameters.values()

    def _look_of(self, claim: Claim, chosen: Sequence[Part]) -> str | None:
        """Return the fault in the looks of parts: a solid of one may be of another material, as the pane of a door."""
        if chosen and (claim.about == "color" or _looks(claim, chosen) is None):
            return _looks(claim, chosen)
        word = str(claim.value).split()[-1]
        others = [item.appearance.materials[1:] for item in chosen or self.made.parts if item.appearance]
        has = [any(word in item.name.split() for item in items) for items in others]
        return (
            None
            if has and (all if chosen else any)(has)
            else "another material"
            if chosen
            else "a solid of another part"
        )

    def _joints_keep(self, claim: Claim, joints: Sequence[BlueprintJoint]) -> str | None:
        if claim.about == "moves":
            chains = (self._carrying(joint.child) for joint in joints)
            right = all(any(moves_so(self.made, joint, claim.value) for joint in chain) for chain in chains)
            return None if right else joints[0].kind.value
        if claim.about == "way":
            return None if self._any_moves(joints, claim.value) else f"{joints[0].kind.value}, another way"
        if claim.about == "hinge":
            return self._hinged(joints[0], claim.value)
        if claim.about == "answers":
            return _NO_ANSWER.get(claim.value)
        if claim.about == "range":
            return self._ranges(joints, claim.value)
        return self._opened(joints, claim.value)

    def _whole_keeps(self, claim: Claim) -> str | None:
        """Return what is wrong with a claim about the object; None if it holds."""
        own = self.specification.kind.split()
        joints = [joint for joint in self.made.joints if not _covers(joint.child, own) or claim.value == "moves"]
        if claim.value in ("turns", "spins"):
            joints = [joint for joint in joints if turns_about_itself(self.made, joint)]
        if claim.value == "tilts":  # ribs do not tilt an umbrella
            stems = Counter(stem_of(joint.child) for joint in self.made.joints)
            joints = [joint for joint in joints if stems[stem_of(joint.child)] == 1 or len(stems) == 1]
        joints_of_doors = [joint for joint in self.made.joints if joint.kind is JointType.REVOLUTE]
        judges: dict[str, Callable[[], str | None]] = {
            "moves": lambda: None if any(moves_so(self.made, item, claim.value) for item in joints) else "no part does",
            "way": lambda: None if self._any_moves(joints, claim.value) else "no part goes there",
            "place": lambda: None if self._any_moves(self.made.joints, claim.value) else "nothing says so",
            "open": lambda: self._opened(self.made.joints, claim.value),
            "size": lambda: self._sized(claim.value, ()),
            "color": lambda: _looks(claim, [*self.made.parts[:1], *self._fronts()]),
            "material": lambda: _looks(claim, self.made.parts[:1]),
            "relation": lambda: None if self._is_there(claim.value[1]) else "nothing says so",
            "range": lambda: self._ranges(self.made.joints, claim.value),
            "hinge": lambda: self._any_hinged(joints_of_doors, claim.value),
            "answers": lambda: _NO_ANSWER.get(claim.value),
            "still": lambda: "it moves",
            "does": lambda: "no such motion",
        }
        return judges[claim.about]() if claim.about in judges else "nothing says so"

    def _fronts(self) -> list[Part]:
        """Doors, drawers and lids that are of the material of the whole, and of which no other look is said."""
        said = [part for part in self.specification.parts if any(claim.about in _LOOKS for claim in part.claims)]
        own = {item.name for part in said for item in chosen_by_place(self.parts_called(part.noun)[0], part)}
        base = self.made.parts[0].density
        closing = [part for part in self.made.parts if stem_of(part.name).rsplit("_", maxsplit=1)[-1] in CLOSING]
        return [part for part in closing if part.density == base and part.name not in own]

    def _any_hinged(self, joints: Sequence[BlueprintJoint], side: str) -> str | None:
        return None if any(self._hinged(joint, side) is None for joint in joints) else "hinged on another side"

    def _is_there(self, noun: str) -> bool:
        return noun.rsplit(maxsplit=1)[-1] in _AROUND or bool(self.parts_called(noun)[0])

    def _any_moves(self, joints: Sequence[BlueprintJoint], way: str) -> bool:
        if way == "out" and any(joint.kind is JointType.PRISMATIC for joint in joints):
            return True  # a handle is pulled out upwards
        return any(math.isfinite(joint.upper) and goes(self.closed, joint, way) for joint in joints if way in WAYS)

    def _hinged(self, joint: BlueprintJoint, side: str) -> str | None:
        middle = next(part for part in self.closed.parts if part.name == joint.child).bounds.mean(axis=0)
        aside = (self.closed.joint_above[joint.child].pivot - middle) @ np.array(PLACES.get(side, (0, 0, 0)))
        return None if aside > 0.0 else "hinged on another side"

    def _ranges(self, joints: Sequence[BlueprintJoint], asked: tuple[str, float]) -> str | None:
        how, much = asked
        there = [joint.upper - joint.lower for joint in joints if joint.kind.turns is (how == "angle")]
        if any(math.isclose(way, much, rel_tol=_SIZE) for way in there):
            return None
        far = max(filter(math.isfinite, there), default=0.0)
        return f"it goes {math.degrees(far):.0f} degrees" if how == "angle" else f"it goes {far:.2g} m"

    def _opened(self, joints: Sequence[BlueprintJoint], asked: tuple[str, float]) -> str | None:
        """Return what is wrong with how far joints are open: of several, the one that is open furthest is meant."""
        how, much = asked
        there = {
            "share": [
                joint.value / (joint.upper + joint.value)
                for joint in joints
                if math.isfinite(joint.upper) and joint.upper + joint.value > 0.0
            ],
            "angle": [joint.value for joint in joints if joint.kind.turns],
            "distance": [joint.value for joint in joints if not joint.kind.turns],
        }[how]
        far = max(there, default=0.0)
        if there and math.isclose(far, much, rel_tol=_SIZE, abs_tol=1e-6):
            return None
        shown = f"{math.degrees(far):.0f} degrees" if how == "angle" else f"{far:.2g} m" if how == "distance" else ""
        return "it is closed" if far < 1e-6 else f"it is open by {shown or f'{far:.0%}'}"

    def _sized(self, asked: tuple[str, float], chosen: Sequence[Part]) -> str | None:
        name, metres = asked
        if name == "top":
            floor = float(self.closed.assembly.bounds[0, 2])
            names = {part.name for part in chosen or self.closed.parts}
            tops = [float(part.bounds[1, 2]) - floor for part in self.closed.parts if part.name in names]
            return None if math.isclose(max(tops), metres, rel_tol=_SIZE) else f"it is {max(tops):.2g} m high"
        if chosen:
            of = {part.name: part for part in self.closed.parts}
            boxes = [np.ptp(of[part.name].bounds, axis=0) for part in chosen]
        else:
            every = self.closed.parts if name not in ("width", "height", "depth") else self.closed.parts[:1]
            boxes = [np.ptp(part.bounds, axis=0) for part in every]
            boxes += [np.ptp(self.closed.assembly.bounds, axis=0), np.ptp(self.made.assembly.bounds, axis=0)]
        axes = _AXES.get(name, (0, 1, 2))
        sizes = [float(box[axis]) for box in boxes for axis in axes]
        sizes += [distance for part in chosen for distance in self._between_pins(part)]
        is_exact = bool(chosen) or name in ("width", "height", "depth")
        known = [] if is_exact else [value for value in self.made.parameters.values() if isinstance(value, float)]
        if any(abs(size / metres - 1.0) <= _SIZE for size in (*sizes, *known)):
            return None
        whole = float(np.ptp(self.closed.assembly.bounds, axis=0)[axes[0]]) if not chosen else max(sizes)
        return f"{whole:.2g} m built"

    def _between_pins(self, part: Part) -> list[float]:
        """Distances between the joints of a part, as the length of a crank is measured [m]."""
        joints = [joint for joint in self.closed.joints if part.name in (joint.parent, joint.child)]
        pins = [joint.pivot for joint in joints] + [
            loop.pivot for loop in self.closed.loops if part.name in (loop.one, loop.other)
        ]
        return [float(np.linalg.norm(one - other)) for k, one in enumerate(pins) for other in pins[:k]]

    def _is_on_other(self, part: PartSpecification, place: Claim) -> bool:
        """True if a place is one of another part: at the bottom of the handle."""
        own = _OF_ANY_OBJECT | set(self.specification.kind.split())
        behind = (claim for claim in part.claims if claim.about == "relation" and min(claim.at) == max(place.at) + 1)
        return any(claim.value[0] == "of" and claim.value[1].split()[-1] not in own for claim in behind)

    def _related(self, claim: Claim, part: PartSpecification, chosen: Sequence[Part]) -> str | None:
        preposition, noun = claim.value
        *before, last = noun.split()
        if preposition == "than":
            return "not compared"
        if preposition == "of" and min(claim.at) - 1 in part.claims[0].at and last not in _OF_ANY_OBJECT:
            return "not so built"
        others, known = self.parts_called(noun)
        if not others and self.counted(noun):
            return None  # it belongs to another part, whose solid it is
        kind, places = self.specification.kind.split(), {*PLACES, *MIDDLE}
        own = {*PURPOSES, *places, *kind, *(() if others else _OF_ANY_OBJECT)}
        strange = [word for word in (noun.split()[:-known] if others else before) if not {word, lemma(word)} & own]
        placed = [word for word in before if word in places] if others else []
        if strange or (placed and len(others) < (3 if placed[0] in MIDDLE else 2)):
            return f"no {noun}"
        if others and placed:
            said = [Claim(about="place", value=word, words=word, at=claim.at) for word in placed]
            others = chosen_by_place(others, PartSpecification(noun=noun, claims=tuple(said)))
        if others:
            return wrong_relation(preposition, chosen, others)
        # The bin, and not the pedal, of a pedal bin.
        there = last == kind[-1] or (
            last in _OF_ANY_OBJECT and not (last in _NOT_OF_IT and preposition in _BESIDE_WHAT)
        )
        through = lemma(last) in _OWN_PLACES and preposition not in _LIES
        return "nothing says so" if through else None if there else f"no {noun}"


def compare(
    specification: Specification, made: Blueprint, nouns: Mapping[str, Sequence[str]] | None = None
) -> Comparison:
    """Compare what was asked for with what was built.

    Args:
        specification: What was asked for.
        made: What was built.
        nouns: How its parts are called, besides by their names: noun, singular -> names, or names without numbers.
    """
    return _Compared(made=made, nouns=nouns or {}, specification=specification).check()


def _is_one(part: PartSpecification) -> bool:
    """True if it is one of several, by its place."""
    return part.count == 1 and any(claim.about == "place" for claim in part.claims)


def _on_sides(part: PartSpecification) -> bool:
    """True if one is asked for on either side."""
    places = [claim for claim in part.claims if claim.about == "place" and claim.value in ("side", "end")]
    said = [set(claim.words.split()) for claim in places if not claim.words.startswith("to ")]  # it moves there
    return any(words & {"each", "either", "both", "every"} for words in said)


def _total(part: PartSpecification) -> int | None:
    """Return how many there are: two on each side are four, and two on both sides are two."""
    words = {word for claim in part.claims if claim.about == "place" for word in claim.words.split()}
    doubled = _on_sides(part) and part.count and ("both" not in words or part.count % 2)
    return 2 * part.count if doubled and part.count else part.count


def _covers(name: str, own: Sequence[str]) -> bool:
    """True if a part only covers or controls something, and does not give the object its name."""
    return any(f"_{stem_of(name)}".endswith(f"_{word}") and word not in own for word in _COVERS)


def _ends_with(name: str, word: str) -> bool:
    """True if a name ends with a word; ``drawer_0_top`` is the top one of some drawers, and no top."""
    stems = [stem for stem in (stem_of(name), lemma(stem_of(name))) if f"_{stem}".endswith(f"_{word}")]
    return any(word not in PLACES or not stem.removesuffix(f"_{word}")[-1:].isdigit() for stem in stems)


def _said(part: PartSpecification) -> str:
    """A part as it was asked for: its count, what was said before its noun, and the noun."""
    first = min(part.claims[0].at)
    before = [claim for claim in part.claims[1:] if max(claim.at) < first]
    words = [claim.words for claim in sorted(before, key=lambda claim: claim.at)]
    return " ".join([*words, part.claims[0].words])


def _looks(claim: Claim, parts: Sequence[Part]) -> str | None:
    if claim.about == "color":
        wanted = COLORS[claim.value]
        same = all(part.color is not None and np.allclose(part.color, wanted, atol=0.02) for part in parts)
        return None if same else "another colour"
    same = all(
        part.density is not None and math.isclose(part.density, MATERIALS[claim.value].density) for part in parts
    )
    return None if same else "another material"
