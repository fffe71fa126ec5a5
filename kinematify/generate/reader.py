"""English into a typed request: the kind, sizes, counts, looks, sides, rows, ranges and openings; the rest is listed.

A sentence is read phrase by phrase: a noun with what stands before it, then what is said of it. Every word is one of
these: the kind, a field of the request (which is measured on the object), a word of the kind's own names and
description, a word that asks for nothing by its place in the grammar, or it is listed as not read.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.delivery import (
    BuildResult,
    are_round,
    count_parameter,
    deliver,
    moves_so,
    names_called,
    stands_in,
)
from kinematify.generate.english import CLAIMS, OF_SOME, OPINION, ROLES, WORDS, Unit, read_units, values_of, vocabulary
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

_WHERE = words_of("panel base body frame floor wall ground edge corner surface angle end")
"""Nouns of places, which are no parts where something is only on them."""
_STILL = words_of("shelf compartment top back front bottom side rack frame")
"""Nouns that are open, and do not stand open."""
_NAMED = words_of("tilt pan lift swing")
"""Motions that are nouns behind an article."""
_NOUN = (
    r"[dP_]{0,2}(?:~+[^,]|~|[#qxDcsfamSgnNZwHu_]|(?<=c)&(?=c))*?"
    r"(?:N(?![vpioqrLwnNZ])|H(?![piodsvqracmfSnZwN~])|[nZ](?![wnNZ])|w(?![acfswnNZ~])"
    r"|(?:(?<=[dcm])|(?<=~v))s(?![acfswnNZ~#]))"
)
_PHRASES = {
    "sign": "[,&]",
    "clause": "R[bPf_&]*",
    "rows": "(?P<at>i?)(?P<lines>[d#]?)=(?:o(?P<per>#))?|T",
    "having": "[hW]",
    "relation": "L",
    "both_sides": "[pi]P_",
    "place_side": "[pi][dP]{0,2}(?P<side>s)(?:_*=|_*(?![acfswnNZ~]))",
    "made": f"Y[^,h#q]*|[pio][pif_]*(?:(?=[qrx])|(?=c)(?!{_NOUN}))",
    "noun": f"[pio]?{_NOUN}|[pio]",
    "hinge": "H[pdP_i]*(?P<edge>s)_*",
    "verb": "(?P<words>[mMNHSgtke](?:[mMNSHgtkevf_d]|b(?=[mMS])|(?<=v)&(?=v))*|(?=r|q(?:B|o?k|S)))"
    "(?:[piodfvb_]*(?P<far>[qr])(?!D)(?:B|ok|k|(?P<then>[Sv]+))?)?",
    "length": "D[bpiodf_,]{0,4}(?P<long>q)",
    "attribute": "[cqxs]|~+.",
    "each": "P",
    "rest": ".[wa]*",
}
"""What a sentence is made of, in the letters of `ROLES`; the first that fits is read by the method of its name."""
_PHRASE = "|".join(f"(?P<{name}>{pattern})" for name, pattern in _PHRASES.items())
_LIMIT = ".*?(?=[,hWRLbPpiY]|(?<!#)o|(?<!g)S(?=[^,]))"
"""Where the name of the whole ends at the latest."""
_TOY = 0.6
"""A toy is no larger [m]."""
Match = re.Match[str]
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
    """Of `PartRequest`; besides, `grid`, `each_side`, `article` and `bare`, a length that is not named."""
    said: list[str] = field(default_factory=list)
    """Words."""
    odd: list[str] = field(default_factory=list)
    """Words that are not read."""
    is_guess: bool = False
    """It may be a part; words not read where the object has none."""
    grid: tuple[int, int] | None = None
    """Columns and rows in which they are to stand, 0 of what nobody said how many."""


@dataclass(kw_only=True)
class Sentence:
    """A sentence that is read from left to right; what is said belongs to the last noun, or to the whole."""

    text: str
    units: list[Unit]
    request: Request = field(init=False)
    family: Kind = field(init=False)
    words: Mapping[str, Mapping[str, Any]] = field(init=False)
    """Of the kind."""
    own: set[str] = field(init=False)
    """Words of the names and of the description of the kind."""
    start: int = 0
    """Where the name begins."""
    stop: int = 0
    """Where it ends."""
    roles: str = ""
    """One letter per unit, see `_role`."""
    values: dict[str, Any] = field(default_factory=dict)
    things: dict[str, _Thing] = field(default_factory=dict)
    """By noun; the whole by an empty one."""
    ahead: dict[str, Any] = field(default_factory=dict)
    """Facts of the next noun: a row of knobs, no doors."""
    faults: list[str] = field(default_factory=list)
    """Values that the kind cannot have."""
    notes: list[str] = field(default_factory=list)
    moves: list[tuple[str, str]] = field(default_factory=list)
    """Motions of the whole, with the words that say it."""
    copies: int = 1
    subject: str = ""
    """Noun of the last part; empty for the whole."""
    several: str = ""
    """The last noun of several, of which *the left one* is one."""
    is_plural: bool = False
    """The last noun is."""
    is_hinged: bool = False
    """In a clause that says where a hinge is."""
    is_shown: bool = False
    """In a clause such as *with the lid open*."""
    fresh: bool = False
    """Nothing but attributes since the last comma, which are of the whole."""
    each: int = 1
    """How many there are of what each has such."""
    instead_of: str = ""

    # ---- the kind --------------------------------------------------------------------------------------------------

    def find_kind(self, *, nearest: bool) -> None:
        """Find the longest name of a kind before the first word that says what it has or is like.

        Raises:
            InputError: No kind is named.
        """
        words = [lemma(unit.text) if "word" in unit.means else "" for unit in self.units]
        self._assign_roles({})
        first = _match("[^wacsmSNMntDuTB~]*", self.roles, 0).end() % len(self.roles)
        limit = _match(_LIMIT, self.roles, first + 1).end()
        found = self._named(words, limit)
        for k in range(limit) if found is None else ():
            other = repaired(words[k], words_of_names()) if self.roles[k] in "wa" else None
            if other is not None:
                self.notes.append(f"Read {self._text(k)!r} as {other!r}.")
                words[k] = other
                found = self._named(words, limit)
        if found is None:
            head = self._text(first, limit) or self.text
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
        self._assign_roles(vocabulary(self.family))
        known = [*self.family.words, self.family.about, *sum(self.family.part_words.values(), ())]
        known += [word for item in self.family.parameters for word in item.nouns]
        self.own = {key for word in known for key in key_of(word) if "side" not in WORDS.get(key, ())}

    def _assign_roles(self, words: Mapping[str, Mapping[str, Any]]) -> None:
        self.words, self.roles = words, ""
        for k in range(len(self.units)):
            self.roles += self._role(k)
        self.roles += ",,,,"

    def _role(self, k: int) -> str:
        """One letter that says what a unit can be, which `_NOUN` and its like are written in."""
        word, means, before = self._text(k), self.units[k].means, self.roles[-1:] or ","
        own = self.words.get(lemma(word), {}).keys() & {"part", "length"} and "side" not in means
        role = next((role for what, role in ROLES.items() if what in means), "")
        if self.units[k].is_tied:
            role = "~"
        elif word.startswith("hinge"):
            role = "H"
        elif before in ("dwh" if word in _NAMED else "sDfc" if word in ("one", "ones") else ""):
            role = "n"  # its tilt, the left one
        elif own:
            role = "N" if "motion" in means else "n" if word == lemma(word) else "Z"
        elif word in ("in", "of"):
            role = word[0]
        elif role == "D" and "place" in means:  # across
            role = "D" if before == "q" else "p"
        elif role == "m" and word.endswith("s") and word[:-1] in WORDS:
            role = "M"
        return role or ("v" if word.endswith("ly") else "a" if re.search("[^e]ed$|ing$", word) else "w")

    def _named(self, words: list[str], limit: int) -> tuple[Kind, int, int] | None:
        for start in range(limit):
            for end in range(min(start + 6, len(words)), start, -1):
                family = kind_called(words[start:end]) if all(words[start:end]) else None
                if family is not None and "w" not in re.split("[,#qxr]", self.roles[end:limit])[0]:
                    return family, start, end
        return None

    # ---- from left to right ----------------------------------------------------------------------------------------

    def read(self) -> None:
        """Read all words but the name.

        Raises:
            InputError: They contradict each other.
        """
        head, before = lemma(self._text(self.stop - 1)), _Thing()
        self._describe(self.roles.rfind("d", 0, self.start) + 1, self.start, before)
        count, name = before.facts.pop("count", 1), self._text(self.stop - 1)
        if count > 1 and _counted(self.family, head):
            self._add(head, _Thing(facts={"count": count}))
        elif name != head and not ("pair" in before.said and any(word.endswith(name) for word in self.family.words)):
            self.copies = count
        elif "pair" not in before.said and count > 1:
            before.odd += before.said
        self._give("", before)
        k = self.stop
        while k < len(self.units):
            found = _match(_PHRASE, self.roles, k)
            k = getattr(self, f"_{found.lastgroup}")(found) or found.end()
        self._lay_out()

    def _mean(self, k: int, what: str) -> Any:
        return self.units[k].means.get(what) if 0 <= k < len(self.units) else None

    def _text(self, k: int, end: int | None = None) -> str:
        return " ".join(unit.text for unit in self.units[max(k, 0) : k + 1 if end is None else end]) if k >= 0 else ""

    def _thing(self, noun: str) -> _Thing:
        return self.things.setdefault(noun, _Thing())

    def _odd(self, words: str, noun: str = "") -> None:
        self._thing(noun).odd.append(words)

    @property
    def _owner(self) -> str:
        return "" if self.fresh else self.subject

    def _sign(self, found: Match) -> int:
        k, end = found.start(), self.roles.index(",", found.end())
        if found[0] == ",":
            self.fresh, self.is_shown, self.is_hinged, self.each = True, False, False, 1
            if OF_SOME.search(self._text(k + 1, end)):
                self._odd(self._text(k + 1, end))
                return end
        return k + 1

    def _clause(self, found: Match) -> int:
        """Read how a relative clause begins; one about use asks for nothing, one that is not known is listed."""
        verb = found.end()
        end = _match("[^,hR]*", self.roles, verb).end()
        self.is_shown = False
        if self.roles[verb] in "wa" or (self.roles[verb] == "u" and set(self.roles[verb:end]) & set("#q")):
            self._odd(self._text(verb, end), self.subject)
        if self.is_plural and self.roles[verb] == "M":
            self.subject = ""  # a fan with three blades that turns
        self.fresh = False
        return end if self.roles[verb] in "uwa" else verb

    def _rows(self, found: Match) -> None:
        """Read rows and columns, of the last part or of the next."""
        beside, is_next = self._mean(found.start(), "beside"), not found["at"] or not self.subject
        line = beside or self._mean(self.roles.index("=", found.start()), "lines")
        lines, per = (int(self._mean(found.start(name), "number") or 0) for name in ("lines", "per"))
        facts, lines = self.ahead if is_next and not beside else self._thing(self.subject).facts, max(lines, 1)
        if per:
            facts.setdefault("count", lines * per)
        each, rest = divmod(facts.get("count", 0), lines)
        facts["grid"] = (each, lines) if line == "row" else (lines, each)
        if rest:
            self._odd(self._text(found.start(), found.end()))

    def _having(self, found: Match) -> None:
        k = found.start()
        if found[0] == "W":
            self.ahead = {"count": 0} if self._span(k + 1) else {}
            if not self.ahead:
                self._odd(self._text(k, k + 2))
        self.is_shown = self._text(k) == "with" and self._text(k + 1) in ("the", "its", "their")
        self.fresh = False

    # ---- nouns -----------------------------------------------------------------------------------------------------

    def _span(self, k: int) -> tuple[int, int] | None:
        """Find where the head of a noun phrase begins and ends; None if none begins here."""
        if (found := re.compile(_NOUN).match(self.roles, k)) is None:
            return None
        end = found.end()
        for start in range(max(k, end - 4), end):
            if " ".join(map(lemma, self._text(start, end).split())) in self.words:
                return start, end
        return end - 1 - (end - 1 > k and self.roles[end - 2] in "wn"), end

    def _part(self, k: int, head: int, end: int, *, is_place: bool = False) -> str:
        """Keep what is said before a noun, of the part that it means; returns what it is called."""
        words = self._text(head, end)
        key = " ".join(key_of(words))
        thing = _Thing()
        is_choice = self._describe(k, end, thing, head=head)
        facts, ahead, self.ahead = thing.facts, self.ahead, {}
        meanings = self.words.get(key, {})
        pick, article = facts.pop("pick", ""), facts.pop("article", False) and "count" not in facts
        thing.is_guess = is_place or is_choice or "part" not in meanings
        if words in ("one", "ones") and self.several:
            key, thing.is_guess = self.several, False
            facts.pop("count", None)
        if is_place and (key in _WHERE or not (meanings or key in self.things)):
            return key
        if self._mean(end, "stroke") and "bare" in facts:  # a 10 cm jaw opening
            facts |= {"range": (0.0, facts.pop("bare")), "motion": "slide"}
        elif "bare" in facts:
            facts.setdefault("size", {}).setdefault("length", facts.pop("bare"))
        if self.each > 1 and not is_place:
            facts["count"] = facts.get("count", 1) * self.each
        facts |= ahead
        is_plural = words != lemma(words)
        noun = f"{pick} {key}".strip()
        if pick and facts.get("count") == 1:
            del facts["count"]
        elif article and noun in self.things:
            if (facts | self.things[noun].facts).keys() - {"count"}:  # a glass door above a wooden door
                thing.odd.append(words)
            facts["count"] = self.things[noun].facts.pop("count", 1) + 1
        elif "count" not in facts and not (pick or noun in self.things or is_choice or is_place):
            counted = _counted(self.family, noun)
            several = {"at_least" if counted is None or counted.default else "count": 2}
            facts |= several if is_plural else {"count": 1} if article else {}
        if key in _STILL:
            facts.pop("open", None)
        thing.said = [] if is_place or (is_choice and not facts) else [self._text(k + (self.roles[k] == "d"), end)]
        noun = self._add(noun, thing)
        if not is_place:
            self.subject, self.is_plural, self.fresh = noun, is_plural, False
            self.several = key if is_plural else self.several
        return noun

    def _describe(self, k: int, end: int, thing: _Thing, head: int | None = None) -> bool:
        """Read what stands before a noun, or before the name of the whole; returns if the noun is a choice of the kind.

        Args:
            k: Where it begins.
            end: Where the noun ends.
            thing: Gets what is said.
            head: Where the noun begins; none before the name.
        """
        stop, is_choice = end if head is None else head, False
        while k < end:
            last = next(j for j in range(k, end) if not self.units[j].is_tied or j == end - 1)
            if chosen := self._choice(k, end, thing, head):
                is_choice |= chosen > stop
                k = chosen
            elif k >= stop:
                break
            elif last > k and last < stop:
                self._tied(k, last, thing)
                k = last + 1
            else:
                k += self._modifier(k, stop, thing, is_part=head is not None)
        return is_choice

    def _modifier(self, k: int, stop: int, thing: _Thing, *, is_part: bool) -> int:  # noqa: PLR0912 - one per class
        """Read one unit before a noun; returns how many were read."""
        facts, word, behind, role = thing.facts, self._text(k), self._text(k + 1), self.roles[k]
        thing.said.append(word)
        look = "color" if self._mean(k, "color") else "material"
        if role == "#":
            number = float(self._mean(k, "number").replace(",", "."))
            one = {behind, self._text(stop)} == set(map(lemma, (behind, self._text(stop)))) and number > 1
            if one and k + 1 < stop and self.roles[k + 1] == "n":  # a six drawer dresser
                self._add(behind, _Thing(facts={"count": int(number)}))
                return 2
            if one and k + 1 < stop and self.roles[k + 1] in "wa" and is_part:  # a three spoke handle
                thing.odd.append(f"{word} {behind}")
                return 2
            if number != int(number) or "count" in facts:
                thing.odd.append(word)
            else:
                facts["count"] = int(number)
        elif role in "qx":
            return self._size(k, thing)
        elif self._mean(k, look) and not (word == "paper" and is_part):
            if facts.setdefault(look, self._mean(k, look)) != self._mean(k, look):
                thing.odd.append(word)
        elif role == "s":
            facts["pick"] = word
        elif word in ("a", "an"):
            facts["article"] = True
        elif role == "S":
            facts["open"] = float(self._mean(k, "state"))
        elif role in "mMH" and not (is_part and self._mean(k, "name")):
            if is_part:
                facts.setdefault("motion", self._mean(k, "motion"))
            else:
                self.moves.append((self._mean(k, "motion"), word))
        elif not self._asks_nothing(k, stop, is_part=is_part):
            thing.odd.append(word)
        return 1

    def _asks_nothing(self, k: int, stop: int, *, is_part: bool) -> bool:
        """True of a word before a noun that is a name of the kind's, an opinion, or what the part is for."""
        word = self._text(k)
        bare = re.search("[^e]ed$|a[lr]$", word) or self._mean(k, "form")
        known = self.roles[k] not in "wan" or lemma(word) in self.own or OPINION.match(word) is not None
        return known or (not bare and ((is_part and k == stop - 1) or self.roles[k + 1] == "c"))

    def _tied(self, k: int, last: int, thing: _Thing) -> None:
        """Read words that hyphens join: orange-handled, drop-down, half-open."""
        word, facts = self._text(last), dict[str, Any]()
        thing.said.append("-".join(self._text(k, last + 1).split()))
        for j in range(k, last + 1):
            for what in ("color", "material", "motion", "degree", "number"):
                if what in self.units[j].means:
                    facts.setdefault(what, self._mean(j, what))
        facts |= {"count": int(facts.pop("number"))} if "number" in facts else {}
        stems = (word.removesuffix("ed"), word.removesuffix("d"), word[:-3], word)
        noun = next((stem for stem in map(lemma, stems) if "part" in self.words.get(stem, {})), "")
        if noun and facts and "motion" not in facts:
            self._add(noun, _Thing(facts=facts))
        elif "degree" in facts and self._mean(last, "state"):
            thing.facts["open"] = float(facts["degree"])
        elif facts and "count" not in facts and ("motion" in facts or self._mean(last, "filler")):
            thing.facts |= facts
        elif not (CLAIMS.match(thing.said[-1]) or set(self._text(k, last + 1).split()) <= self.own):
            thing.odd.append(thing.said[-1])

    def _choice(self, k: int, end: int, thing: _Thing, head: int | None) -> int:
        """Read a value of a parameter of the kind; returns where it ends, or 0."""
        for after in range(end, k, -1):
            words = self._text(k, after)
            meanings = self.words.get(" ".join(map(lemma, words.split())), {})
            if "choice" not in meanings:
                continue
            name, value = meanings["choice"]
            behind = lemma(self._text(after)) if after < end else ""
            own = self.words.get(behind, {}).get("part") == "own" or behind in name
            is_counted = "count" in thing.facts or words != lemma(words)
            if (behind and not own and head is not None) or (meanings.get("part") and not behind and is_counted):
                continue
            if self.ahead.get("count") == 0:
                value = "no" if value == "yes" else "none"
                self.ahead = {}
            self._take(name, value, words)
            return after
        return 0

    def _add(self, noun: str, thing: _Thing) -> str:
        """Give what is said to a part; what it has otherwise is not read. Returns the noun."""
        own = self.things.setdefault(noun, _Thing(is_guess=thing.is_guess))
        facts, phrase = thing.facts, " ".join(thing.said)
        count = own.facts.get("count", facts.get("count"))
        if count != facts.get("count", count):
            if self._cell(noun) and ((facts | own.facts).keys() & {"side", "grid", "row"}):
                return self._add(f"{noun} ", thing)  # another group of the same
            if (facts | own.facts).keys() & {"side", "color", "material"}:
                own.odd.append(phrase)
                return noun
            raise InputError(f"The text says {count} and {facts['count']} of {noun!r}. Say one.")
        own.said.append(phrase)
        own.odd += thing.odd
        for name, value in facts.items():
            if name == "size":
                own.facts["size"] = {**own.facts.get("size", {}), **value}
            elif own.facts.get(name) == "move":
                own.facts[name] = value
            elif own.facts.setdefault(name, value) != value and value != "move":
                own.odd.append(phrase or str(value))
        return noun

    # ---- attributes ------------------------------------------------------------------------------------------------

    def _give(self, owner: str, thing: _Thing) -> None:
        """Give attributes to a part, or to the whole."""
        if owner:
            self._add(owner, thing)
            return
        self._thing("").odd += thing.odd
        for what, value in thing.facts.items():
            self._whole(what, value, " ".join(thing.said))

    def _fact(self, found: Match, owner: str | None = None, **facts: Any) -> None:
        said = [self._text(found.start(), found.end())]
        self._give(self._owner if owner is None else owner, _Thing(facts=facts, said=said))

    def _size(self, k: int, thing: _Thing) -> int:
        """Read a size and the dimension behind it; returns how many units were read."""
        numbers, sizes = values_of(self._text(k)), thing.facts.setdefault("size", {})
        value, si = numbers[-1]
        if self.roles[k] == "x":
            if not si:
                thing.facts |= {"count": int(numbers[0][0] * value), "grid": (int(value), int(numbers[0][0]))}
                return 1 + (self._text(k + 1) == "grid") + (self._text(k + 2) == "of")
            names = ["width", "depth", "height"]
            usual = {item.name: float(item.default) for item in self.family.parameters if item.name in names}
            if len(numbers) == 2 and "depth" not in usual:
                names.remove("depth")
                if (usual.get("width", 0.0) < usual.get("height", 0.0)) is (numbers[0][0] > 1.5 * value):
                    names.reverse()  # a door of 2 m by 0.8 m
            sizes.update(zip(names, (number for number, _ in numbers), strict=False))
            return 1
        step = k + 1 + (self.roles[k + 1 : k + 3] in ("iD", "oD"))
        if si == "m" and (name := self._mean(step, "dimension")):
            sizes[name] = value
            return step + 1 - k
        if si == "m":
            thing.facts["bare"] = value
        else:
            thing.odd.append(self._text(k))
        return 1

    def _length(self, found: Match) -> None:
        k = found.start("long")
        self._fact(found, size={self._mean(found.start(), "dimension"): values_of(self._text(k))[0][0]})

    def _attribute(self, found: Match) -> int:
        """Read a look, a size or a side that stands alone."""
        k, thing, owner = found.start(), _Thing(), self._owner
        if found[0] == "q" and "motion" in WORDS.get(owner.split(" ")[-1], ()):
            return self._range(found, k, owner)  # a gas lift of 10 cm
        if found[0][0] == "~":
            self._tied(k, found.end() - 1, thing)
        else:
            k += self._modifier(k, k, thing, is_part=False)
        side = WORDS.get(thing.facts.pop("pick", ""), {}).get("side")
        thing.facts |= {"side": side} if side and owner else {}
        if owner and "bare" in thing.facts:
            thing.facts["size"]["length"] = thing.facts.pop("bare")
        self._give(owner, thing)
        return max(k, found.end())

    def _range(self, found: Match, k: int, owner: str, how: str = "move") -> int:
        """Give a range, with the motion that its unit means; it is not read where the text says another motion."""
        numbers, words = values_of(self._text(k)), [self._text(found.start(), found.end())]
        (low, _), (value, si) = numbers[0], numbers[-1]
        low = -value if self._mean(k, "symmetric") or "B" in found[0] else low if self.roles[k] == "r" else 0.0
        if si == "m" and low > 0.0:
            low, value = 0.0, value - low
        usual = "slide" if si == "m" else "hinge"
        owner = owner or usual
        for other in (self._thing(owner).facts.get("motion", usual), usual):
            how = other if how == "move" else how
        if (how in ("slide", "lift")) is (si == "m"):
            self._add(owner, _Thing(facts={"range": tuple(sorted((low, value))), "motion": how}, said=words))
        else:
            self._add(owner, _Thing(facts={"motion": how}, odd=[f"{owner} {words[0]}"]))
        return found.end()

    def _hinge(self, found: Match) -> None:
        k, self.is_hinged = found.start(), True
        owner = self._owner if self._text(k) == "hinged" or self.roles[k - 1] not in ",&h" else ""
        self._fact(found, owner, hinge=self._mean(found.start("edge"), "side"))

    def _verb(self, found: Match) -> int:
        """Read how something moves, how far, or how it stands."""
        how, share, stands, far, k = "", None, self.is_shown, found.start("far"), found.start()
        owner = self._owner if self.roles[k] in "rq" or self._text(k).endswith("s") else self.subject
        for j in range(*found.span("words")):
            can, role = self.roles[j - 1] in "bR" and self._text(j - 1) not in ("is", "are"), self.roles[j]
            goes = self._text(j) == "open" and (can or (self.is_plural and not stands and far > 0))
            if role == "S" and not goes and (not can or self._mean(j, "state") == "0"):
                share, stands = float(self._mean(j, "state")) if share is None else share, True
            elif role == "g" and not how:
                share = float(self._mean(j, "degree"))
            elif role in "mMNHS":
                how = how or str(self._mean(j, "motion") or "move")
            stands |= role == "t"
            how = "spin" if role == "e" else how
        if far > 0 and (stands or found["then"]) and self.roles[far] == "q" and not how:
            self._fact(found, owner, open=values_of(self._text(far))[0])
        elif far > 0:
            self._range(found, far, owner, how or "move")
        elif how:
            self._fact(found, owner, motion=how)
        elif stands and share is not None:
            self._fact(found, owner, open=share)
        return found.end()

    # ---- places ----------------------------------------------------------------------------------------------------

    def _made(self, found: Match) -> None:
        """Pass over what leads to a size or a material, and what it is for or like."""

    def _both_sides(self, found: Match) -> None:
        facts = self._thing(self.subject).facts
        facts["each_side"] = True
        if "count" in facts and self._text(found.start() + 1) != "both":
            facts["count"] *= 2

    def _noun(self, found: Match) -> None:
        """Read a part, or where something is."""
        in_place = self.roles[found.start()] in "pio"
        k = found.start() + in_place
        if span := self._span(k):
            last, the = self._text(span[1] - 1), self._text(k) in ("the", "its", "their")
            is_place = bool(self._owner) and (the or (last == lemma(last) and self.roles[k] not in "d#"))
            self._part(k, *span, is_place=in_place and (is_place or lemma(last) in _WHERE))

    def _place_side(self, found: Match) -> int:
        word, side, end = self._text(found.start("side")), self._mean(found.start("side"), "side"), found.end()
        if self.fresh or not self.subject:
            if self._span(end + (self.roles[end] == "h")):
                self.ahead["side"] = side
            else:
                self._odd(f"on the {word}")
        elif self.is_hinged and self.subject.startswith(tuple(_OPPOSITE)):
            self._fact(found, hinge=side)  # the left one hinged on the left, the right one on the right
        elif self.subject == "hinge":
            del self.things[self.subject]
            self._whole("hinge", side, word)
        else:
            count = self._thing(self.subject).facts.get("count", 0)
            facts: dict[str, Any] = {"grid": (count, 1)} if found[0][-1] == "=" and count else {}
            self._fact(found, None, side=side, **facts)
        return end

    def _relation(self, found: Match) -> int:
        """Read that one part is above another, and the like."""
        k, subject, other = found.start(), self.subject, ""
        step, span, end = int(self._mean(k, "relation")), self._span(k + 1), k + 1 + (self.roles[k + 1] == "P")
        if span and subject and self.roles[k + 1] != "P":
            is_place = self._text(k + 1) in ("the", "its", "their")
            other = self._part(k + 1, *span, is_place=is_place)
            self.subject, end = subject if is_place else self.subject, span[1]
        elif subject:
            other = next((noun for noun in reversed(self.things) if noun not in ("", subject)), "")
        if other in self.things and other != subject:  # above (1) or below (-1) it
            mine, its = (self._thing(noun).facts for noun in (subject, other))
            its.setdefault("row", mine.setdefault("row", its.get("row", 10 + step) - step) + step)
        elif other in ("", subject):
            self._odd(self._text(k))
        return end

    def _each(self, found: Match) -> None:
        self.fresh = False
        if self.subject.endswith(self.several):
            self.subject = self.several or self.subject
        self.each = self._thing(self.subject).facts.get("count", 1) if self.roles[found.end()] == "h" else 1

    def _rest(self, found: Match) -> int | None:
        """Pass over what asks for nothing, and list what is not known."""
        k = found.start()
        if found[0][0] in "#B" or not self._asks_nothing(k, k, is_part=False):
            self._odd(self._text(k, found.end()), self._owner)
            return None
        if self.is_shown and self._text(k) in ("up", "out"):
            self._give(self._owner, _Thing(facts={"open": 1.0}))
        return k + 1

    # ---- settling --------------------------------------------------------------------------------------------------

    def _take(self, name: str, value: Any, words: str) -> None:
        """Set a parameter of the whole."""
        try:
            value = checked(self.family, name, value)
        except InputError as error:
            self.faults.append(f"{words}: {str(error).rstrip('.')}")
            return
        if self.values.setdefault(name, value) != value:
            self._odd(words)

    def _whole(self, what: str, value: Any, said: str) -> None:
        known = {item.name for item in self.family.parameters}
        if what == "bare":
            what, value = "size", {"width" if "width" in known else "length": value}
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
            self._add("door", _Thing(facts={what: value}, said=[said]))
        elif what == "motion":
            self.moves.append((value, said))
        elif what != "article":
            self._odd(said)

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
        if any(cell != "shelf" and facts.get("count") for cell, facts in fields):
            for cell in sorted((CELLS & counted.keys()) - dict(fields).keys()):
                self.values.setdefault(counted[cell].name, 0)
        sides = (*_OPPOSITE, "top", "bottom")
        placed = any(facts.keys() & {"row", "grid", "each_side"} or facts.get("side") in sides for _, facts in fields)
        if not placed or "layout" in self.values:
            return
        columns: dict[str, list[tuple[int, str]]] = {}
        for cell, facts in fields:
            side, both = facts.get("side", ""), facts.get("each_side", False)
            count = facts.get("count", counted[cell].default or 2) // (1 + both)
            text = f"{count}*{cell}" if count != 1 else cell
            if grid := facts.get("grid"):
                row = " | ".join([cell] * grid[0])
                text = " / ".join([f"({row})" if grid[0] > 1 else cell] * grid[1])
            level = {"top": 0, "bottom": 20}.get(side, facts.get("row", 10))
            for column in _OPPOSITE if both else [side if side in _OPPOSITE else ""] * bool(count):
                columns.setdefault(column, []).append((level, text))
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
        for noun in [noun for noun in self.things if noun.endswith(" ")]:
            first, more = self.things[noun.rstrip()], self.things.pop(noun)
            kept = {name: first.facts[name] for name in first.facts.keys() - {"row", "side", "grid"}}
            first.facts = {**kept, "count": first.facts["count"] + more.facts["count"]}
            first.odd += more.odd
        rows = sorted({thing.facts["row"] for thing in self.things.values() if "row" in thing.facts})
        sizes, parts = self._thing("").facts, {}
        for noun, thing in self.things.items():
            facts = thing.facts
            if facts.get("count") == 0 and facts.keys() - {"count", "at_least", "row"}:
                raise InputError(f"The text says that there is no {noun}, and what it is like. Say one.")
            if (name := self.words.get(noun, {}).get("length")) and "length" in facts.get("size", {}):
                self._take(name, facts.pop("size")["length"], noun)
                facts.pop("count", None)
                thing.said = []
            thing.grid, _ = facts.pop("grid", None), facts.pop("each_side", None)
            if "row" in facts:
                facts["row"] = rows.index(facts["row"]) + 1
            if noun and (facts or thing.said):  # not a choice of which nothing else is said
                parts[noun] = facts
        named = key_of(self._text(self.start, self.stop))
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
                said = " ".join(thing.said)
                unread.append(" ".join([*(word for word in thing.odd if word not in said), said]).strip())
            elif noun not in made.missing:
                unread += thing.odd
                names = names_called(self.family, made.blueprint, noun)
                if "round" in unread and are_round(made.blueprint, names or [made.blueprint.parts[0].name]):
                    unread.remove("round")
                columns, rows = (lines or len(names) for lines in thing.grid or (1, 1))
                if thing.grid and not stands_in(made.blueprint, names, columns, rows):
                    listed.append(f"{noun}: columns and rows are not {columns} and {rows}")
        low, high = made.blueprint.assembly.bounds
        if "toy" in self.text.lower().split() and (largest := float((high - low).max())) > _TOY:
            listed.append(f"toy: it is {largest:.2g} m large")
        own = self.own | {key for part in made.blueprint.parts for key in key_of(part.name.replace("_", " "))}
        return replace(
            made,
            differences=(*self.faults, *listed),
            unread=tuple(words for words in unread if words and not set(key_of(words)) <= own),
            notes=tuple(self.notes),
            facts={"text": self.text, **made.facts},
        )


def _match(pattern: str, text: str, k: int) -> Match:
    found = re.compile(pattern).match(text, k)
    assert found, "a pattern that fits everything"
    return found


def _counted(family: Kind, noun: str) -> Parameter | None:
    """The parameter that counts parts of a noun, where it may have several values."""
    item = count_parameter(family, noun)
    return item if item and item.bounds and item.bounds[0] < item.bounds[1] else None
