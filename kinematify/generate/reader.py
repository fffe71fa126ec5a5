"""English into a typed request: the kind, sizes, counts, looks, sides, rows, ranges and openings; the rest is listed.

Every word belongs to one thing that is named, or to the whole. What is not read of a thing is listed with it, and not
again where the object does not have it. What was read is measured on the object.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.delivery import BuildResult, count_parameter, deliver, moves_so, names_called, stands_in
from kinematify.generate.english import OF_SOME, WORDS, Unit, read_units, values_of, vocabulary
from kinematify.generate.kind_search import (
    key_of,
    kind_called,
    lemma,
    nearest_kinds,
    repaired,
    words_of,
    words_of_names,
)
from kinematify.generate.library.kind import checked
from kinematify.generate.procedural.layout import CELLS
from kinematify.generate.request import request_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.parameter import Parameter
    from kinematify.generate.request import Request

_SURELY = words_of("hinge joint front bottom back axle motor bearing floor")
"""Nouns of which nobody can tell that an object has none."""
_WHERE = words_of("panel base body frame floor wall ground edge corner surface")
"""Nouns of places, which are no parts where something is only on them."""
_STILL = words_of("shelf compartment top back front bottom side rack frame")
"""Nouns that are open, and do not stand open."""
_OPPOSITE = {"left": "right", "right": "left"}


def read_sentence(text: str, *, nearest: bool = False) -> Sentence:
    """Read a sentence; nothing is built.

    Args:
        text: English.
        nearest: Take the nearest kind where none is named.

    Raises:
        InputError: It is empty, too long, no English, contradicts itself, or names no kind that is known; the message
            names the nearest.
    """
    sentence = Sentence(text=text, units=read_units(text))
    sentence.find_kind(nearest=nearest)
    sentence.read()
    sentence.fill()
    return sentence


@dataclass(kw_only=True)
class _Thing:
    """What is said of the parts of one name, or of the whole."""

    facts: dict[str, Any] = field(default_factory=dict)
    """Of `PartRequest`; besides, `grid` and, while they wait for a noun, `article`, `without`, `pick` and `bare`."""
    said: list[str] = field(default_factory=list)
    """Words."""
    odd: list[str] = field(default_factory=list)
    """Words that are not read."""
    grid: tuple[int, int] | None = None
    """Columns and rows in which they are to stand."""
    is_guess: bool = False
    """It may be a part; words not read where the object has none."""
    is_counted: bool = True
    """Its number is said by more than an article."""


@dataclass(kw_only=True)
class Sentence:
    """A sentence that is read from left to right: what is said waits for a noun, else it goes to the last one."""

    text: str
    units: list[Unit]
    request: Request = field(init=False)
    family: Kind = field(init=False)
    words: Mapping[str, Mapping[str, Any]] = field(init=False)
    """Of the kind."""
    start: int = 0
    """Where the name begins."""
    stop: int = 0
    """Where it ends."""
    values: dict[str, Any] = field(default_factory=dict)
    things: dict[str, _Thing] = field(default_factory=dict)
    """By noun; the whole by an empty one."""
    waiting: _Thing = field(default_factory=_Thing)
    faults: list[str] = field(default_factory=list)
    """Values that the kind cannot have."""
    notes: list[str] = field(default_factory=list)
    moves: list[tuple[str, str]] = field(default_factory=list)
    """Motions of the whole, with the words that say it."""
    copies: int = 1
    subject: str = ""
    """Noun of the last part; empty for the whole."""
    fresh: bool = False
    """Nothing but attributes since the last comma."""
    relation: tuple[str, int] | None = None
    instead_of: str = ""

    # ---- the kind --------------------------------------------------------------------------------------------------

    def find_kind(self, *, nearest: bool) -> None:
        """Find the longest name of a kind before the first word that says what it has or is like.

        Raises:
            InputError: No kind is named.
        """
        words = [lemma(unit.text) if "word" in unit.means else "" for unit in self.units]
        empty = [not word or self._is(k, "filler plain") for k, word in enumerate(words)]
        first = empty.index(False) if False in empty else 0
        limit = next((k for k in range(first + 1, len(words)) if self._ends_name(k)), len(words))
        found = self._named(words, limit)
        for k in range(limit) if found is None else ():
            other = None if empty[k] else repaired(words[k], words_of_names())
            if other is not None:
                self.notes.append(f"Read {self._text(k)!r} as {other!r}.")
                words[k] = other
                found = self._named(words, limit)
        if found is None:
            head = " ".join(unit.text for unit in self.units[first:limit]) or self.text
            near = nearest_kinds(head)
            if not nearest:
                raise InputError(
                    f"No kind of object is called {head!r}. The nearest are "
                    f"{', '.join(family.words[0] for family in near)}. Say one of these, take the nearest with "
                    "--nearest, or ask a language model with --source llm."
                )
            self.notes.append(f"There is no kind {head!r}: built is the nearest, a {near[0].title}.")
            self.instead_of, found = head, (near[0], 0, limit)
        self.family, self.start, self.stop = found
        self.words = vocabulary(self.family)

    def _named(self, words: list[str], limit: int) -> tuple[Kind, int, int] | None:
        for start in range(limit):
            for end in range(min(start + 6, len(words)), start, -1):
                family = kind_called(words[start:end]) if all(words[start:end]) else None
                after = next((k for k in range(end, limit) if not words[k] or self._is_noun(k)), limit)
                if family is not None and (after == limit or not words[after]):
                    return family, start, end
        return None

    def _ends_name(self, k: int) -> bool:
        if self._is(k, "state") and not self._is(k - 1, "degree") and self._text(k + 1) not in ("", "top"):
            return True
        counted = self._text(k) == "of" and not self._is(k - 1, "number")
        return counted or self._is(k, "sign having without refers relation ends")

    def _is_noun(self, k: int) -> bool:
        """True if a word goes on with a name, so that another thing is named: a laptop bag."""
        known = "state degree dimension color material motion side number filler plain"
        return not self._is(k, known) and self._text(k) != "toy" and not self._text(k).endswith("ed")

    # ---- from left to right ----------------------------------------------------------------------------------------

    def read(self) -> None:
        """Read all words but the name.

        Raises:
            InputError: They contradict each other.
        """
        k = 0
        while k < self.start:
            k = self._one(k)
        count, head = self.waiting.facts.pop("count", 1), lemma(self._text(self.stop - 1))
        if not {"single", "double", "twin", "dual", "triple"} & set(self.waiting.said):
            self.copies = max(count, 1)
        elif _counted(self.family, head):
            self.things[head] = _Thing(facts={"count": count})
        else:
            self.waiting.odd += self.waiting.said
        self._settle("")
        self.subject, self.fresh, k = "", False, self.stop
        while k < len(self.units):
            clause = next((j for j in range(k + 1, len(self.units)) if self._text(j) in ",;."), len(self.units))
            text = " ".join(unit.text for unit in self.units[k:clause]).lstrip(",; ")
            if (k == self.stop or self._text(k) in ",;.") and OF_SOME.search(text):
                self._settle()
                self._thing("").odd.append(text)
                k = clause
            else:
                k = self._one(k)
        self._settle()
        self._lay_out()

    def _one(self, k: int) -> int:
        """Read what begins at a unit; returns where to go on."""
        readers = (
            self._sign, self._measure, self._number, self._known, self._has_such, self._look, self._having,
            self._state, self._dimension, self._relate, self._side, self._filler,
        )  # fmt: skip
        return next((after for read in readers if (after := read(k))), 0) or self._unknown(k)

    def _is(self, k: int, classes: str) -> bool:
        return 0 <= k < len(self.units) and not self.units[k].means.keys().isdisjoint(classes.split())

    def _mean(self, k: int, what: str) -> Any:
        return self.units[k].means.get(what) if 0 <= k < len(self.units) else None

    def _text(self, k: int) -> str:
        return self.units[k].text if 0 <= k < len(self.units) else ""

    def _thing(self, noun: str) -> _Thing:
        return self.things.setdefault(noun, _Thing())

    def _wait(self, k: int, what: str, value: Any) -> None:
        facts, words = self.waiting.facts, self._text(k)
        self.waiting.said.append(words)
        if facts.setdefault(what, value) != value and value != "move":
            self.waiting.odd.append(words)

    def _sign(self, k: int) -> int:
        word = self._mean(k, "sign")
        if word and word in ",;:.()":
            self._settle()
            self.fresh = True
        elif word and word not in "\"'?!":
            self.waiting.odd.append(word)
        return k + 1 if word else 0

    def _number(self, k: int) -> int:
        said, after = self._mean(k, "number"), self._text(k + 1)
        count = self.things[self.subject].facts.get("count", 0) if self.subject else 0
        if line := self._mean(k, "beside"):
            self._stand(line, self._text(k))
            return k + 1
        if said is None or (self._text(k) == "one" and after in ("", "of", "side", "end")):
            return 0
        value = float(said.replace(",", "."))
        if self._is(k + 1, "lines"):
            if value and count and count % value == 0:
                columns = int(value) if after.startswith("column") else int(count / value)
                self.things[self.subject].facts["grid"] = (columns, count // columns)
            else:
                self.waiting.odd.append(f"{self._text(k)} {after}")
            return k + 2
        if value != int(value) or "count" in self.waiting.facts or self._text(k) == "zero":
            self.waiting.odd.append(self._text(k))
        else:
            self._wait(k, "count", int(value))
            if self._text(k - 1) == "of" and (line := self._text(k - 2)) in ("row", "column"):
                self.waiting.facts["grid"] = _grid(line, int(value))
        return k + 1 + (after == "of")

    def _stand(self, line: str, words: str) -> None:
        """Set the last parts in one row or column."""
        facts = self._thing(self.subject).facts
        if count := facts.get("count"):
            facts["grid"] = _grid(line, count)
        else:
            self.waiting.odd.append(words)

    # ---- nouns -----------------------------------------------------------------------------------------------------

    def _known(self, k: int) -> int:
        """Read a word of the kind, or a noun of a part."""
        for after in (k + 4, k + 3, k + 2, k + 1):
            words = " ".join(unit.text for unit in self.units[k:after])
            meanings = self.words.get(" ".join(map(lemma, words.split())), {})
            if meanings and after <= len(self.units) and not (after == k + 1 and self._is_adverb(k, meanings)):
                readers = (self._length, self._choice, self._compound, self._part)
                return next((then for read in readers if (then := read(k, after, words, meanings))), 0)
        return 0

    def _length(self, k: int, after: int, words: str, meanings: Mapping[str, Any]) -> int:
        name, bare = meanings.get("length"), self.waiting.facts.get("bare", ())
        j = next((j for j in range(after, after + 4) if not self._is(j, "filler sign")), after)
        if not name or not (bare or self._is(j, "quantity")):
            return 0
        self._take(name, values_of(self._text(j))[0][0] if self._is(j, "quantity") else bare[0], words)
        if self._is(j, "quantity"):
            return j + 1
        del self.waiting.facts["bare"]
        return after

    def _choice(self, k: int, after: int, words: str, meanings: Mapping[str, Any]) -> int:
        """Read a value of a parameter, such as the word before a noun that is the kind's own."""
        waits, behind = self.waiting.facts, lemma(self._text(after))
        name, value = meanings.get("choice", ("", ""))
        own = self.words.get(behind, {}).get("part") or behind in name
        other = not own if self._is_part(after) else self._is(after, "word") and not self._is_read(after)
        if not name or (other and k > self.stop and ("part" not in meanings or self._is_part(after))):
            return 0
        if meanings.get("part") and ("count" in waits or words != lemma(words)):
            return 0
        if words.startswith("hinge") and self._is(after, "side place"):
            return 0
        if waits.pop("without", False):
            value = "no" if value == "yes" else "none"
        self._take(name, value, words)
        if self._is_part(after):
            return after
        noun, first = " ".join(key_of(words)), key_of(words)[0]
        if count := waits.pop("count", 0):  # a three finger gripper
            counted = first if _counted(self.family, first) else noun
            self._add(counted, words, _Thing(facts={"count": count}), is_guess=counted == noun)
        for look in ("color", "material") if name == "handle" else ():
            if look in waits:
                self.values[f"handle_{look}"] = waits.pop(look)
        self._settle()
        self.subject, self.fresh = noun, False
        self.things.setdefault(noun, _Thing(is_guess=True))
        return after

    def _compound(self, k: int, after: int, words: str, meanings: Mapping[str, Any]) -> int:
        """Read a noun before another one, which it only describes."""
        del k, meanings
        if not self._is_part(after) or words != lemma(words) or self._is(after, "motion"):
            return 0
        one = lemma(self._text(after)) == self._text(after) and words not in self.things
        if one and self.waiting.facts.get("count", 1) > 1:  # a two blade rotor
            self._add(" ".join(key_of(words)), words, _Thing(facts={"count": self.waiting.facts.pop("count")}))
        else:
            self.waiting.odd.append(words)
        return after

    def _part(self, k: int, after: int, words: str, meanings: Mapping[str, Any]) -> int:
        if not meanings.keys() & {"part", "length"}:
            return 0
        if self._is(after, "stroke") and "bare" in self.waiting.facts:  # a 10 cm jaw opening
            value, si = self.waiting.facts.pop("bare")
            self.waiting.facts["range"] = (0.0, value, si)
            if self.fresh and self.subject:
                self._settle(self.subject)
                return after
        self._noun(k, words, is_guess="part" not in meanings)
        return after

    def _is_part(self, k: int) -> bool:
        return "part" in self.words.get(lemma(self._text(k)), {})

    def _is_adverb(self, k: int, meanings: Mapping[str, Any]) -> bool:
        """True for a verb, for a word such as back behind one, and for a side behind a preposition."""
        before = self._text(k - 1)
        several = before != lemma(before) and self._is_part(k - 1) and "choice" not in meanings
        verb = self._is(k - 1, "verbal") or several
        return (
            (self._is(k, "motion") and verb)
            or (self._is(k, "where") and self._is(k - 1, "motion state"))
            or (self._is(k, "side") and self._is_placed(k))
        )

    def _is_placed(self, k: int) -> bool:
        places = ("on", "at", "along", "across", "in" if self._is(k + 1, "lines") else "on")
        return self._text(k - 1) in places or (
            self._text(k - 1) in ("the", "its", "their", "either", "each", "both") and self._text(k - 2) in places
        )

    def _has_such(self, k: int) -> int:
        """Read a word such as four-bladed or orange-handled."""
        word = self._text(k)
        stems = (word[:-2], word[:-1], word[:-3]) if word.endswith("ed") and not self._is(k, "state material") else ()
        noun = next((lemma(stem) for stem in stems if "part" in self.words.get(lemma(stem), {})), "")
        if not noun or not self.waiting.facts.keys() & {"count", "color", "material"}:
            return 0
        self.waiting.facts.pop("article", None)
        self._add(noun, word)
        return k + 1

    def _noun(self, k: int, words: str, *, is_guess: bool) -> None:
        """Read a noun, which may only say where something else is: on the panel."""
        the = self._text(k - 1) in ("the", "its", "their") and "count" not in self.waiting.facts
        is_place = the and self._is(k - 2, "place where") and bool(self.subject)
        if is_place:
            self._settle(self.subject)
        said, self.waiting, before_name = self.waiting, _Thing(), k < self.start
        waits, noun = said.facts, " ".join(key_of(words))
        pick, without = waits.pop("pick", ""), waits.pop("without", False)
        article = waits.pop("article", False) and "count" not in waits
        if without and noun in _SURELY:
            self._thing("").odd.append(f"without {words}")
        if (is_place and noun in _WHERE) or (without and noun in _SURELY):
            return
        if before_name and "count" in waits:  # the looks before it are of the whole
            self.waiting.facts = {name: waits.pop(name) for name in ("color", "material") if name in waits}
        elif before_name and not waits:
            self.waiting.odd = [*said.odd, words]
            return
        noun = f"{pick} {noun}".strip()
        if without:
            waits["count"] = 0
        elif waits.get("count") == 1 and pick:
            del waits["count"]
        elif "count" not in waits and not (pick or noun in self.things or before_name):
            waits |= self._implied(noun, words, article=article)
        if noun in _STILL:
            waits.pop("open", None)
        self._add(noun, words, said, is_guess=is_guess or is_place)
        self.things[noun].is_counted &= not article
        if self.relation is not None:
            self._rows(self.relation[0], noun, self.relation[1])
            self.relation = None
        if not before_name and not is_place:
            self.subject, self.fresh = noun, False

    def _implied(self, noun: str, words: str, *, article: bool) -> dict[str, int]:
        """How many parts a noun without a number means."""
        if lemma(words) == words:
            return {"count": 1} if article else {}
        counted = _counted(self.family, noun)
        return {"at_least" if counted is None or counted.default else "count": 2}

    def _add(self, noun: str, words: str, waiting: _Thing | None = None, *, is_guess: bool = False) -> None:
        """Give what waits to a part; what it has otherwise is not read."""
        if waiting is None:
            waiting, self.waiting = self.waiting, _Thing()
        own = self.things.setdefault(noun, _Thing(is_guess=is_guess))
        facts, phrase = waiting.facts, " ".join(filter(None, [*waiting.said, words]))
        own.said.append(phrase)
        own.odd += waiting.odd
        if "bare" in facts:
            facts.setdefault("size", {}).setdefault("length", facts.pop("bare")[0])
        if not own.is_counted and "count" in facts:
            own.is_counted = True
            own.facts.pop("count", None)
        count = own.facts.get("count", facts.get("count"))
        if count != facts.get("count", count):
            if (facts | own.facts).keys() & {"side", "color", "material"} or " per " in self.text:
                own.odd.append(phrase)
                return
            raise InputError(f"The text says {count} and {facts['count']} of {noun!r}. Say one.")
        for name, value in facts.items():
            if name == "size":
                own.facts["size"] = {**own.facts.get("size", {}), **value}
            elif own.facts.setdefault(name, value) != value and "move" not in (own.facts[name], value):
                own.odd.append(phrase)

    # ---- attributes ------------------------------------------------------------------------------------------------

    def _look(self, k: int) -> int:
        is_noun = self._text(k) in ("mirror", "iron", "paper") and not self._noun_follows(k + 1)
        for what in ("color", "material"):
            if (value := self._mean(k, what)) and not is_noun:
                self._wait(k, what, value)
                return k + 1
        return 0

    def _having(self, k: int) -> int:
        if not self._is(k, "having without"):
            return 0
        self._settle()
        if self._is(k, "without"):
            self.waiting.facts["without"] = True
        else:
            self.fresh = False
        return k + 1

    def _state(self, k: int) -> int:
        """Read a state or a motion."""
        state, motion, step = self._mean(k, "state"), self._mean(k, "motion"), k + 1
        if self._is(k, "degree") and (self._is(step, "state") or self._is(k - 1, "state")):
            value = 0.0 if self._mean(step, "state") == "0" else float(self._mean(k, "degree"))
            if not self._then_measured(step):
                self.waiting.facts["open"] = value
                self.waiting.said.append(self._text(k))
            return step + self._is(step, "state") + self._is(step + 1, "where")
        if state and self._is(k - 1, "verbal"):
            self._wait(k, "motion", "move")
        elif state and not (self._text(k) == "open" and self._text(k - 1) == "can"):
            if not self._then_measured(step):
                self._wait(k, "open", float(state))
        elif self._names_motion(k):
            self._noun(k, self._text(k), is_guess=True)
        elif motion:
            place = 0
            if self._text(k).startswith("hinge"):
                place = next((j for j in range(step, step + 3) if self._is(j, "side")), 0)
                place *= all(self._is(j, "place filler refers") for j in range(step, place)) and (
                    place > step or self._text(place) in _OPPOSITE or self._text(place + 1) in ("side", "edge")
                )
            if place:
                self._wait(place, "hinge", self._mean(place, "side"))
                return place + 1 + (self._text(place + 1) in ("side", "edge"))
            self._wait(k, "motion", motion)
        else:
            return 0
        return step + self._is(step, "where")

    def _names_motion(self, k: int) -> bool:
        before = self._text(k - 1) in ("whose", "its", "the", "a")
        return before and self._text(k) in ("tilt", "pan", "lift", "swing") and not self._is(k + 1, "where")

    def _dimension(self, k: int) -> int:
        name, waits = self._mean(k, "dimension"), self.waiting.facts
        if not name:
            return 0
        if "bare" in waits:
            waits.setdefault("size", {})[name] = waits.pop("bare")[0]
            return k + 1
        for j in range(k + 1, k + 4):
            if self._is(j, "quantity") and (value := values_of(self._text(j))[0])[1] == "m":
                waits.setdefault("size", {})[name] = value[0]
                self.waiting.said.append(self._text(j))
                return j + 1
            if self._text(j) not in ("of", "is", ":", "=", "a", "about", "around"):
                break
        return k + 1

    def _measure(self, k: int) -> int:
        """Read a size, a range or an opening."""
        if not self._is(k, "dims range symmetric quantity"):
            return 0
        numbers = values_of(self._text(k))
        value, si = numbers[-1]
        step = k + 1
        if self._is(k, "dims"):
            if not si:
                rows, columns = int(numbers[0][0]), int(value)
                self._wait(k, "count", rows * columns)
                self.waiting.facts["grid"] = (columns, rows)
                return step + (self._text(step) == "grid") + (self._text(k + 2) == "of")
            names = ["width", "depth", "height"]
            usual = {item.name: float(item.default) for item in self.family.parameters if item.name in names}
            if len(numbers) == 2 and "depth" not in usual:
                names.remove("depth")
                if (usual.get("width", 0.0) < usual.get("height", 0.0)) is (numbers[0][0] > value):
                    names.reverse()  # a door of 2 m by 0.8 m
            sizes = dict(zip(names, (number for number, _ in numbers), strict=False))
            self.waiting.facts.setdefault("size", {}).update(sizes)
            return step
        both, verb = self._is(step, "both"), self._verb(k)
        after = step + (self._text(step) == "of")
        if self._is(k, "range"):
            low = numbers[0][0]
            self._wait(k, "range", (0.0, value - low, si) if si == "m" and low > 0.0 else (low, value, si))
        elif self._is(k, "symmetric") or both:
            self._wait(k, "range", (-value, value, si))
        elif verb == "state":
            self._wait(k, "open", (value, si))
        elif (verb == "motion" and not self._is(step, "dimension")) or self._is(after, "stroke"):
            self._wait(k, "range", (min(value, 0.0), max(value, 0.0), si))
            return after + self._is(after, "stroke")
        else:
            self.waiting.said.append(self._text(k))
            if si == "m":
                self.waiting.facts["bare"] = (value, si)
            else:
                self.waiting.odd.append(self._text(k))
            return step + (self._text(step) in ("in", "of") and self._is(step + 1, "dimension"))
        return step + both

    def _verb(self, k: int) -> str:
        """What a quantity says: a ``state``, a ``motion`` or neither, by the nearest verb before it in the clause."""
        for j in range(k - 1, max(k - 7, self.stop - 1), -1):
            verbal = self._is(j, "motion state")
            if not self._is(j, "word") or self._is(j, "having") or (not verbal and lemma(self._text(j)) in self.words):
                return ""
            can = any(self._is(i, "asks") for i in range(j - 3, j))
            if self._is(j, "state") and not (can and (self._text(j) == "open" or self._text(j - 1) == "be")):
                return "state"
            if verbal or self._is(j, "stroke"):
                return "motion"
        return ""

    def _then_measured(self, k: int) -> bool:
        j = next((j for j in range(k, len(self.units)) if not self._is(j, "filler where")), len(self.units))
        return self._is(j, "quantity") and not self._is(j + 1, "dimension")

    # ---- places ----------------------------------------------------------------------------------------------------

    def _side(self, k: int) -> int:
        side, word, before, after = self._mean(k, "side"), self._text(k), self._text(k - 1), self._text(k + 1)
        if self._is(k, "ordinal") or (side and not self._is_placed(k) and self._noun_follows(k + 1)):
            self._wait(k, "pick", word)
            return k + 1
        if not side:
            return 0
        if word in _OPPOSITE and after == "of" and self.subject:
            self._wait(k, "side", word)
            self._settle(self.subject)
            self.waiting.facts["side"] = _OPPOSITE[word]
        elif word in _OPPOSITE and after == "hinged":
            self._wait(k, "hinge", word)
            return k + 2
        elif word == "underneath" or self._is_placed(k):
            leads = self.fresh or not self.subject
            step = k + 1 + (after in ("side", "hand", "end", "edge", "row")) + (self._text(k + 2) == "side")
            if after == "row" and not leads:
                self._stand(after, "row")
            if leads and not self._noun_follows(step):
                self.waiting.odd.append(f"on the {word}")
                return step
            self._wait(k, "side", side)
            if not leads:
                self._settle(self.subject)
            return step
        elif "article" in self.waiting.facts or self._is(k - 1, "having refers") or before == "the":
            self._noun(k, word, is_guess=True)
        elif not self._is(k - 1, "motion"):
            self.waiting.odd.append(word)
        return k + 1

    def _noun_follows(self, k: int) -> bool:
        for j in range(k, k + 4):
            if self._is_part(j):
                return True
            if not (self._is(j, "color material number motion plain") or self._text(j) in ("a", "an")):
                return j == k and self._is(j, "word") and not self._is_read(j)
        return False

    def _relate(self, k: int) -> int:
        """Read that one part is above another, and the like."""
        if not (relation := self._mean(k, "relation")):
            return 0
        others = [noun for noun in self.things if noun not in ("", self.subject)]
        back = self._is(k + 1, "refers sign") or self._text(k + 1) in ("", "and")
        if not self.subject or (back and not others):
            self.waiting.odd.append(self._text(k))
            return k + 1
        self._settle(self.subject)
        if back:
            self._rows(self.subject, others[-1], int(relation))
        else:
            self.relation = (self.subject, int(relation))
        return k + 1 + self._is(k + 1, "refers")

    def _rows(self, one: str, other: str, step: int) -> None:
        """Put one part above (1) or below (-1) another."""
        mine, its = (self.things[noun].facts for noun in (one, other))
        its.setdefault("row", mine.setdefault("row", its.get("row", 10 + step) - step) + step)

    def _filler(self, k: int) -> int:
        word = self._text(k)
        if self._is(k, "filler refers stroke lines"):
            if word in ("whose", "which", "that") or (word == "and" and not self._is(k + 1, "color material where")):
                self._settle()
            if word in ("a", "an"):
                self.waiting.facts.setdefault("article", True)
            self.fresh = self.fresh and (word == "all" or not self._is(k, "refers"))
        elif self._is(k, "where both"):
            moving = any(self._is(j, "motion state where") for j in range(k - 5, k))
            shape = word == "round" and self._is(k + 1, "color material part")
            self.waiting.odd += [] if moving and not shape else [word]
        elif not self._is(k, "plain"):
            return 0
        return k + 1

    def _unknown(self, k: int) -> int:
        """Words that are not known: a noun of a part if one is expected, which the object tells."""
        last = next((j for j in range(k + 1, len(self.units)) if not self._is(j, "word") or self._is_read(j)), None)
        last = len(self.units) if last is None else last
        if k < self.start:
            last = min(last, self.start)
        words = " ".join(unit.text for unit in self.units[k:last])
        begins = self._text(k - 1) in ("and", "whose", "its", "the", ",") or self._is(k - 1, "having")
        expected = begins or self.waiting.facts.keys() - {"color", "material"}
        behind = last + 2 - self._is_part(last + 1)  # hour and minute hands
        paired = self._text(last) == "and" and self._is_part(behind) and not self._is_read(last + 1)
        paired = paired and "count" not in self.waiting.facts
        follows = self._is_part(last) or paired or (self._is(last, "color material") and self._noun_follows(last + 1))
        counted = f"{self._text(k - 1)}-{self._text(k)}"
        if follows and self._is(k - 1, "number") and counted in self.text.lower():  # a three-spoke handle
            self.waiting.facts.pop("count", None)
            words = f"{self._text(k - 1)} {words}"
        if expected and not follows and not self._is(k - 1, "verbal") and k >= self.stop:
            self._noun(k, words, is_guess=True)
        else:
            self.waiting.odd.append(words)
        return last

    def _is_read(self, k: int) -> bool:
        known = "filler having refers where relation color material motion state side number plain dimension"
        return self._is(k, known) or lemma(self._text(k)) in self.words

    # ---- settling --------------------------------------------------------------------------------------------------

    def _take(self, name: str, value: Any, words: str) -> None:
        """Set a parameter of the whole."""
        try:
            value = checked(self.family, name, value)
        except InputError as error:
            self.faults.append(f"{words}: {str(error).rstrip('.')}")
            return
        if self.values.setdefault(name, value) != value:
            self.waiting.odd.append(words)

    def _settle(self, owner: str | None = None) -> None:
        """Give what waits to a part, or to the whole."""
        owner = ("" if self.fresh else self.subject) if owner is None else owner
        facts, said = self.waiting.facts, " ".join(self.waiting.said)
        facts.pop("article", None)
        if facts.keys() & {"without", "count", "pick"} or ("bare" in facts and self.waiting.odd):
            self.waiting = _Thing(odd=[*self.waiting.odd, said or "without"])
        elif "range" in facts and not owner:
            facts.setdefault("motion", "hinge" if facts["range"][2] == "rad" else "slide")
            owner = facts["motion"].replace("move", "hinge" if facts["range"][2] == "rad" else "slide")
        if owner:
            self._add(owner, "")
        else:
            waiting, self.waiting = self.waiting, _Thing()
            self._thing("").odd += waiting.odd
            for what, value in waiting.facts.items():
                self._whole(what, value, said)

    def _whole(self, what: str, value: Any, said: str) -> None:
        known = {item.name for item in self.family.parameters}
        if what == "bare":
            what, value = "size", {"width" if "width" in known else "length": value[0]}
        if what == "size":
            sizes = self._thing("").facts
            for name, size in value.items():
                if sizes.setdefault(name, size) != size:
                    raise InputError(f"The text says that the {name} is {sizes[name]:g} m and {size:g} m. Say one.")
        elif what in ("color", "material"):
            self._take(what, value, said)
        elif what == "open":
            number, unit = value if isinstance(value, tuple) else (value, "")
            self._take({"rad": "open_angle", "m": "open_distance", "": "open"}[unit], number, said)
        elif what == "hinge" and "hinge_side" in known:
            self._take("hinge_side", value, said)
        elif what == "hinge":
            self._add("door", said, _Thing(facts={what: value}))
        elif what == "motion":
            self.moves.append((value, said))
        else:
            self._thing("").odd.append(said)

    # ---- layouts of fronts -----------------------------------------------------------------------------------------

    def _cell(self, noun: str) -> str:
        """The field of a layout that a noun means; empty if the kind has no layout, or none of the noun."""
        counted = _counted(self.family, noun) if any(item.name == "layout" for item in self.family.parameters) else None
        own = "" if counted is None else lemma(counted.name)
        return own if own in CELLS else ""

    def _lay_out(self) -> None:
        """Write the layout of a front whose fields are placed; fields that are not named are left out."""
        counted = {lemma(item.name): item for item in self.family.parameters if isinstance(item.default, int)}
        fields = [(cell, thing.facts) for noun, thing in self.things.items() if (cell := self._cell(noun))]
        if any(cell != "shelf" and facts.get("count") != 0 for cell, facts in fields):
            for cell, item in counted.items():
                if cell in CELLS and cell not in dict(fields) and any("count" in facts for _, facts in fields):
                    self.values.setdefault(item.name, 0)
        sides = (*_OPPOSITE, "top", "bottom")
        placed = any(facts.keys() & {"row", "grid"} or facts.get("side") in sides for _, facts in fields)
        if not placed or "layout" in self.values:
            return
        columns: dict[str, list[tuple[int, str]]] = {}
        for cell, facts in fields:
            count = facts.get("count", counted[cell].default or 2)
            text = f"{count}*{cell}" if count != 1 else cell
            if grid := facts.get("grid"):
                row = " | ".join([cell] * grid[0])
                text = " / ".join([f"({row})" if grid[0] > 1 else cell] * grid[1])
            side = facts.get("side", "")
            level = {"top": 0, "bottom": 20}.get(side, facts.get("row", 10))
            if count:
                columns.setdefault(side if side in _OPPOSITE else "", []).append((level, text))
            if cell == "shelf":
                for name in ("row", "side"):
                    facts.pop(name, None)
        texts = {side: " / ".join(text for _, text in sorted(rows)) for side, rows in columns.items()}
        if len(texts) == 1 and "" not in texts:
            texts[_OPPOSITE[next(iter(texts))]] = "panel"
        ordered = [texts[side] for side in ("left", "", "right") if side in texts]
        self.values["layout"] = " | ".join(f"({text})" for text in ordered) if len(ordered) > 1 else ordered[0]

    # ---- the end ---------------------------------------------------------------------------------------------------

    def fill(self) -> None:
        """Make the request of what was read.

        Raises:
            InputError: It contradicts itself.
        """
        rows = sorted({thing.facts["row"] for thing in self.things.values() if "row" in thing.facts})
        sizes, parts = self._thing("").facts, {}
        for noun, thing in self.things.items():
            facts = thing.facts
            if facts.get("count") == 0 and facts.keys() - {"count", "at_least", "row"}:
                raise InputError(f"The text says that there is no {noun}, and what it is like. Say one.")
            thing.grid = facts.pop("grid", None)
            row = {"row": rows.index(facts["row"]) + 1} if "row" in facts else {}
            if "range" in facts:
                *facts["range"], si = facts["range"]
                if facts.get("motion", "move") == "move":
                    facts["motion"] = "slide" if si == "m" else "hinge"
                elif (facts["motion"] in ("slide", "lift")) is not (si == "m"):
                    del facts["range"]
                    thing.odd.append(" ".join(filter(None, thing.said)))
            if noun and (facts or thing.said):  # not a choice of which nothing else is said
                parts[noun] = {**facts, **row}
        named = key_of([unit.text for unit in self.units[self.start : self.stop]])
        usual = next((said for word, said in self.family.usual.items() if key_of(word) == named), {})
        stated = {*sizes, *(item.name for noun in parts if (item := _counted(self.family, noun)))}
        values = {
            "kind": self.family.name,
            "parameters": {**{name: value for name, value in usual.items() if name not in stated}, **self.values},
            "size": sizes,
            "parts": parts,
            "copies": self.copies,
            "instead_of": self.instead_of,
        }
        self.request = request_of(values, source=f"text {self.text!r}")

    def made(self, *, seed: int | None = None) -> BuildResult:
        """Build the object and measure it.

        Raises:
            InputError: Nothing can be built.
        """
        made = deliver(self.request, seed=seed)
        lost = {noun for noun in made.missing if self.things[noun].is_guess}
        listed = [why for why in made.differences if not any(why.startswith(f"{noun}: a") for noun in lost)]
        joints = [joint for joint in made.blueprint.joints if joint.mimic is None]
        some = {"pan": any, "tilt": any, "spin": any}
        unread = [said for how, said in self.moves if not some.get(how, all)(moves_so(joint, how) for joint in joints)]
        for noun, thing in self.things.items():
            if noun in lost:
                unread.append(" ".join(filter(None, dict.fromkeys([*thing.odd, *thing.said]))))
            elif noun not in made.missing:
                unread += thing.odd
                names = names_called(self.family, made.blueprint, noun)
                if thing.grid and not stands_in(made.blueprint, names, *thing.grid):
                    listed.append("{}: columns and rows are not {} and {}".format(noun, *thing.grid))
        known = (*self.family.words, *(part.name.replace("_", " ") for part in made.blueprint.parts))
        known += tuple(word for item in self.family.parameters for word in item.nouns)
        known += tuple(word for said in self.family.part_words.values() for word in said)
        own = {key for name in known for key in key_of(name)} - {word for word in WORDS if "side" in WORDS[word]}
        return replace(
            made,
            differences=(*self.faults, *listed),
            unread=tuple(words for words in unread if words and not set(key_of(words)) <= own),
            notes=tuple(self.notes),
            facts={"text": self.text, **made.facts},
        )


def _counted(family: Kind, noun: str) -> Parameter | None:
    """The parameter that counts parts of a noun, where it may have several values."""
    item = count_parameter(family, noun)
    return item if item and item.bounds and item.bounds[0] < item.bounds[1] else None


def _grid(line: str, count: int) -> tuple[int, int]:
    return (count, 1) if line == "row" else (1, count)
