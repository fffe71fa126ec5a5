"""What a sentence asks of parts, beyond what a parameter sets: that they are there, how they move, look and stand open.

It is read against the parts that were built; what does not hold of them is not understood.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.procedural.blueprint import BlueprintJoint
from kinematify.generate.procedural.language.motions import (
    DONE,
    GOING,
    MOTIONS,
    WAYS,
    goes,
    moves_so,
    turns_about_itself,
)
from kinematify.generate.procedural.language.reading import nouns_of
from kinematify.generate.procedural.language.words import PURPOSES, STOP_WORDS, UNITS, singular
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS, of_one_material, surface_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.language.reading import ParseState

_OF_PARTS_ALONE = ("folds", "moves")
"""Said of the whole they are about another kind of object: a bicycle that folds has more than a handlebar."""
PLACES = {
    "left": (-1, 0, 0), "right": (1, 0, 0), "top": (0, 0, 1), "upper": (0, 0, 1), "uppermost": (0, 0, 1),
    "bottom": (0, 0, -1), "lower": (0, 0, -1), "lowest": (0, 0, -1), "front": (0, -1, 0), "rear": (0, 1, 0),
}  # fmt: skip
_HANDLES = ("handle", "knob", "pull", "grip")
"""Words for handles, which are no parts of their own."""
_LINKS = ("that", "which", "whose", "is", "are", "to", "can", "be", "the", "in", "on", "at")  # between noun and verb
_ANYHOW = ("over", "open", "apart", "around", "round", "freely", "away", "together", "aside")
"""Behind a verb they say nothing about where to."""
_OF = ("of", "in", "made", "from", "is", "are")  # between a noun and what it is made of


@dataclass(frozen=True, kw_only=True)
class PartRequirement:
    """What is asked of the parts of one name."""

    nouns: tuple[str, ...]
    """Names of parts without their numbers, any of them; one word represents the end of a longer name."""
    words: str
    """As it was said."""
    place: str = ""
    """``top``: only the one that is furthest there."""
    count: int | None = None
    at_least: int = 1
    moves: str = ""
    """Of `MOTIONS`."""
    way: str = ""
    """Where they go when they open."""
    look: tuple[str, str] | None = None
    """Material and colour, empty where nothing is said."""
    opened: tuple[str, float] | None = None
    """``share``, ``angle`` [rad] or ``distance`` [m], and how much."""

    def of(self, blueprint: Blueprint) -> list[str]:
        """The parts that are meant."""
        found = [part for part in blueprint.parts if _is_called(part.name, self.nouns)]
        if self.place and found:
            toward = np.array(PLACES[self.place], dtype=np.float64)
            reach = [float(part.bounds.mean(axis=0) @ toward) for part in found]
            found = [part for part, far in zip(found, reach, strict=True) if far > max(reach) - 1e-6]
        return [part.name for part in found]

    def applied(self, blueprint: Blueprint) -> Blueprint:
        """Return the object with what is asked for.

        Raises:
            InputError: Its parts are not as they are asked for.
        """
        names = self.of(blueprint)
        fits = len(names) == self.count if self.count is not None else len(names) >= self.at_least
        joints = [blueprint.joint_above[name] for name in names if name in blueprint.joint_above]
        moved = self.moves or self.way or self.opened
        fits = fits and not (moved and len(joints) < len(names))
        fits = fits and (not self.moves or all(moves_so(blueprint, joint, self.moves) for joint in joints))
        fits = fits and all(goes(blueprint, joint, self.way) for joint in joints if self.way)
        if not fits:
            raise InputError(f"Asked for is {self.words!r}, but {_described(blueprint, names)}.")
        if self.look is not None:
            blueprint = looking(blueprint, names, *self.look)
        return blueprint if self.opened is None else _opened(blueprint, joints, *self.opened, self.words)


@dataclass(kw_only=True)
class PartReader:
    """Reads what is left of a sentence against the object as it would be built."""

    reading: ParseState
    made: Blueprint
    requirements: list[PartRequirement] = field(default_factory=list)

    def noun_at(self, k: int) -> tuple[int, tuple[str, ...]] | None:
        """The word behind a noun for parts at word k, and the names of these parts; none in the object's own name."""
        if k in self.reading.named or k - 1 in self.reading.named:  # a laptop screen is no laptop
            return None
        for words, stems in sorted(self._nouns.items(), key=lambda item: -len(item[0])):
            texts = tuple(singular(self.reading.text(i), frozenset(words)) for i in range(k, k + len(words)))
            if texts == words:
                return k + len(words), stems
        return None

    def nouns(self) -> Iterator[tuple[int, int, tuple[str, ...]]]:
        """Every noun for parts: its first word, the word behind, and the names of the parts."""
        for k in range(len(self.reading.tokens)):
            found = self.noun_at(k)
            if found is not None:
                yield k, *found

    @cached_property
    def _nouns(self) -> dict[tuple[str, ...], tuple[str, ...]]:
        """How parts may be called -> their names without numbers."""
        return part_nouns(self.reading.family, self.made)

    def require(self, requirement: PartRequirement, *where: int) -> bool:
        """Take a requirement up if it holds of what is built; its words are then understood."""
        try:
            requirement.applied(self.made)
        except InputError:
            return False
        self.requirements.append(requirement)
        self.reading.used.update(where)
        return True

    def said(self, *where: int) -> str:
        """Words of the sentence as they were written."""
        return " ".join(self.reading.tokens[i].given for i in sorted(where))

    def read(self) -> None:
        """Take up how parts move, where they go, and that they are there."""
        for k, end, stems in self.nouns():
            self._movement_before(k, end, stems)
            self._movement_behind(k, end, stems)
            self._purpose(k)
        self._movement_of_some_part()
        for k, end, stems in self.nouns():
            if k > min(self.reading.named) and not self.reading.used & set(range(k, end)):
                self._presence(k, end, stems)

    def _movement_before(self, k: int, end: int, stems: tuple[str, ...]) -> None:
        """`sliding doors`, `a telescopic handle`."""
        for at in (k - 1, k - 2):
            word = self.reading.text(at)
            if at not in self.reading.used and word in MOTIONS:
                said = self.said(at, *range(k, end))
                self.require(PartRequirement(nouns=stems, words=said, moves=MOTIONS[word]), at)

    def _purpose(self, k: int) -> None:
        """`detergent drawer`; an oven door is the door of an oven."""
        own = {word for name in self.reading.family.words for word in name.split()}
        if self.reading.text(k - 1) in PURPOSES | own:
            self.reading.used.add(k - 1)

    def _movement_of_some_part(self) -> None:
        """`a fan that oscillates`, `a swivel chair`: the one part of a name does; ribs do not tilt an umbrella."""
        names = Counter(stem_of(part.name) for part in self.made.parts)
        for k in range(len(self.reading.tokens)):
            behind = self.reading.text(k - 1) in ("that", "which", "be")
            said = self._verb(k)
            if said is None or not (behind or k + 1 in self.reading.named):
                continue
            moves, ways, where = said
            if moves in _OF_PARTS_ALONE:
                continue
            for way in ways:
                stems = {
                    stem_of(joint.child)
                    for joint in self.made.joints
                    if "wheel" not in joint.child  # what rolls does not make the whole turn
                    and (behind or moves not in ("turns", "spins") or turns_about_itself(self.made, joint))
                    and (not moves or moves_so(self.made, joint, moves))
                    and (not way or goes(self.made, joint, way))
                }
                stems = {stem for stem in stems if names[stem] == 1}
                wanted = PartRequirement(nouns=tuple(sorted(stems)), words=self.said(*where), moves=moves, way=way)
                if stems and self.require(wanted, *where):
                    break

    def _verb(self, k: int) -> tuple[str, list[str], list[int]] | None:
        """How something moves by the verb at word k, where to (what goes up and down does one of both), and words."""
        verb = self.reading.text(k)
        moves = MOTIONS.get(verb, DONE.get(verb, "") if self.reading.text(k - 1) == "be" else "")
        if k in self.reading.used or not (moves or verb in GOING):
            return None
        to = k + 1
        while self.reading.text(to) in ("to", "the", "on", "at", "towards"):
            to += 1
        way, back = (self.reading.text(i).removesuffix("s") for i in (to, to + 2))
        if way not in WAYS:  # it may have said the hinge's side already
            anyhow = [to] if self.reading.text(to) in _ANYHOW else []
            moves = moves or ("moves" if verb.startswith("open") else "")
            return (moves, [""], [k, *anyhow]) if moves else None
        both = self.reading.text(to + 1) == "and" and back in WAYS
        return moves, [way, back] if both else [way], [k, to, *([to + 2] if both else [])]

    def _movement_behind(self, k: int, end: int, stems: tuple[str, ...]) -> None:
        """`a handle that turns`, `whose door opens downwards`, `a door hinged on the left`."""
        place = self.reading.text(k - 1) if self.reading.text(k - 1) in PLACES else ""
        at = end
        while self.reading.text(at) in _LINKS:
            at += 1
        if (found := self._verb(at)) is None:
            return
        moves, ways, where = found
        said = self.said(*range(k, max(where) + 1))
        for way in ways:
            if self.require(PartRequirement(nouns=stems, words=said, place=place, moves=moves, way=way), *where):
                return

    def _presence(self, k: int, end: int, stems: tuple[str, ...]) -> None:
        """`with seat and lid`, `two temples`, `a bucket`."""
        before, where = k - 1, list(range(k, end))
        place = self.reading.text(before) if self.reading.text(before) in PLACES and before >= 0 else ""
        if place:
            where.append(before)
            before -= 1
        number = self.reading.number(before) if before >= 0 and before not in self.reading.used else None
        if number is not None:
            where.append(before)
        plural = self.reading.tokens[end - 1].given != self.reading.tokens[end - 1].text or (
            singular(self.reading.text(end - 1), frozenset(word for stem in stems for word in stem.split("_")))
            != self.reading.text(end - 1)
        )
        count = int(number) if number is not None else None if plural else 1
        noun = "_".join(singular(self.reading.text(i), frozenset(stems)) for i in range(k, end))
        for meant in (stems, (noun,)):  # two wheels may be all or those that are called no more than that
            wanted = PartRequirement(nouns=meant, words=self.said(*where), place=place, count=count, at_least=2)
            if meant[0] in stems and self.require(wanted, *where):
                break

    def looks(self) -> None:
        """Colours and materials, of the whole object or of some of its parts."""
        k = 0
        while k < len(self.reading.tokens):
            span = self._look(k)
            if span is None:
                k += 1
                continue
            end, material, color = span
            self._look_taken(k, end, material, color)
            k = end

    def _look(self, k: int) -> tuple[int, str, str] | None:
        """The word behind, material and colour of the words for a look that begin at word k."""
        end, material, color = k, "", ""
        while end not in self.reading.used:
            pair = f"{self.reading.text(end)} {self.reading.text(end + 1)}"
            word = self.reading.text(end)
            if word == "mirror" and self.reading.text(end + 1) in ("", "on", "with", ","):
                break  # a mirror is meant
            of = next((name for name, item in MATERIALS.items() if word in item.words), "")
            if pair in COLOR_WORDS and not color:
                color, end = COLOR_WORDS[pair], end + 2
            elif word in COLOR_WORDS and not color:
                color, end = COLOR_WORDS[word], end + 1
            elif of and material in ("", of):
                material, end = of, end + 1
            else:
                break
        return (end, material, color) if end > k else None

    def _look_taken(self, k: int, end: int, material: str, color: str) -> None:
        where = range(k, end)
        if self.reading.text(end) in _HANDLES and self.reading.parameter("handle") and self.noun_at(end) is None:
            for name, value in (("handle_material", material), ("handle_color", color)):
                if value:
                    self.reading.take(name, value, f"handles: {value}", *where)
            return
        stems = self._looked_at(k, end)
        if stems:
            self.require(
                PartRequirement(nouns=stems, words=f"{self.said(*where)} {stems[0]}", look=(material, color)), *where
            )
        elif stems is not None:
            for name, value in (("material", material), ("color", color)):
                if value:
                    said = f"made of {value}" if name == "material" else value
                    self.reading.take(name, value, said, *where)

    def _looked_at(self, k: int, end: int) -> tuple[str, ...] | None:
        """Names of the parts that a look at words k to `end` is about; none of them: all; None: of what is no part."""
        for at in range(end, end + 3):
            found, word = self.noun_at(at), self.reading.text(at)
            if found is not None and found[0] not in self.reading.named:
                return found[1]
            if at in self.reading.named or found is not None:  # an oak 6-drawer dresser is of oak
                return ()
            if not word or word in STOP_WORDS or self.reading.tokens[at].is_sign:
                break
            if self.reading.number(at) is None and word not in UNITS and at > min(self.reading.named):
                return None
        at = k - 1
        while self.reading.text(at) in _OF:
            at -= 1
        if at < k - 1:
            for first, behind, stems in self.nouns():
                if behind == at + 1 and first not in self.reading.named:
                    return stems
        return ()


def part_nouns(family: Family, made: Blueprint) -> dict[tuple[str, ...], tuple[str, ...]]:
    """How the parts of an object may be called, singular words -> their names without numbers."""
    stems = {stem_of(part.name) for part in made.parts}
    found: dict[tuple[str, ...], set[str]] = {}
    for stem in stems:
        words = tuple(stem.split("_"))
        for k in range(len(words)):
            found.setdefault(words[k:], set()).add(stem)
    for parameter in family.parameters:
        own = parameter.name.removesuffix("s") if isinstance(parameter.default, int) else ""
        of = {stem for stem in stems if stem in (own, *nouns_of(parameter))} if own else set()
        for noun in nouns_of(parameter) if of else ():
            found.setdefault(tuple(noun.split()), set()).update(of)
    for stem, others in family.part_words.items():
        for noun in others if stem in stems else ():
            found.setdefault(tuple(noun.split()), set()).add(stem)
    return {words: tuple(sorted(names)) for words, names in found.items()}


def stem_of(name: str) -> str:
    """A part's name without its number."""
    return name.rstrip("0123456789_")


def _is_called(name: str, nouns: Sequence[str]) -> bool:
    return stem_of(name) in nouns


def looking(blueprint: Blueprint, names: Sequence[str], material: str, color: str) -> Blueprint:
    """Paint parts, or make them of another material; handles keep their own look."""

    def look(part: Part) -> Part:
        appearance = part.appearance
        assert appearance is not None, "what is generated has an appearance"
        own = appearance.materials[0].name.split()[-1]  # behind its colour
        surface = surface_of(material or own, color or None)
        new = of_one_material(surface, part.vertices, part.faces)
        return replace(
            part,
            color=surface.color[:3],
            density=MATERIALS[material].density if material else part.density,
            appearance=replace(
                new,
                materials=(surface, *appearance.materials[1:]),
                material_of_face=appearance.material_of_face,
                uv=appearance.uv if new.uv is None else new.uv,
            ),
        )

    return replace(blueprint, parts=tuple(look(part) if part.name in names else part for part in blueprint.parts))


def _opened(blueprint: Blueprint, joints: Sequence[BlueprintJoint], how: str, much: float, words: str) -> Blueprint:
    """Return the object with some joints open."""
    values = {}
    for joint in joints:
        value = much * joint.upper if how == "share" else much
        if not (math.isfinite(value) and joint.lower <= value <= joint.upper + 1e-9):
            raise InputError(
                f"Asked for is {words!r}, but the joint of {joint.child} goes no further than {_way(joint)}."
            )
        if joint.kind.turns is (how == "distance") and how != "share":
            unit = "an angle" if joint.kind.turns else "a length"
            raise InputError(f"Asked for is {words!r}, but how far {joint.child} opens is {unit}.")
        values[joint.child] = value
    return blueprint.moved(values)


def _way(joint: BlueprintJoint) -> str:
    return f"{math.degrees(joint.upper):.0f} degrees" if joint.kind.turns else f"{joint.upper:.3g} m"


def _described(blueprint: Blueprint, names: Sequence[str]) -> str:
    if not names:
        return "the object has no such part"
    joints = (blueprint.joint_above.get(name) for name in names)
    kinds = [f"{joint.child} ({joint.kind.value})" for joint in joints if joint is not None]
    return f"what is built has {', '.join(kinds or names)}"
