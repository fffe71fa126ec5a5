"""English into a typed request: the kind, sizes, counts, looks, sides, rows, ranges and openings; the rest is listed.

A sentence is read phrase by phrase: a noun with what is before it, then what is said of it. Each phrase fills fields
of the request, and remembers which words it took. The object is built and measured; a word of content is *read* if it
is the kind's name, or if a field took it that was measured, or if a part is called so. All others are listed.
"""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.delivery import (
    CHECKS,
    BuildResult,
    count_parameter,
    deliver,
    goes_towards,
    length_names,
    moves_so,
    names_called,
    sides_meant,
    stem_of,
)
from kinematify.generate.english import OF_SOME, ROLES, WORDS, Unit, read_units, values_of, vocabulary
from kinematify.generate.kind_search import (
    key_of,
    kind_called,
    lemma,
    nearest_to,
    repaired,
    words_of,
    words_of_names,
)
from kinematify.generate.library.kind import checked
from kinematify.generate.procedural.layout import CELLS
from kinematify.generate.request import request_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.parameter import Parameter
    from kinematify.generate.request import Request

_WHERE = words_of("panel base body frame floor wall ground edge corner surface angle end hand side")
"""Nouns of places, which are no parts where something is only on them."""
_STILL = words_of("shelf compartment top back front bottom side rack frame")
"""Nouns that are open, and do not stand open."""
_NAMED = words_of("tilt pan lift swing")
"""Motions that are nouns behind an article."""
_THE = ("the", "its", "their")
_ASKING = words_of("towards aside")
_LOOKS = words_of("color material round")
_CONTENT = "qxr#csSmMNHnZwagBLWk=Te"
"""Roles of words that ask for something."""
_NOUN = (
    r"[dP_]{0,2}(?:[#qxDcsfamSgnNZwHu_o]|(?<=[mM])v|(?<=c)&(?=c))*?"
    r"(?:N(?![vpioqrLwnNZ])|H(?![piodsvqracmfSnZwN])|[nZ](?![wnNZ])|w(?![acfswnNZ])"
    r"|(?:(?<=[dcma])|(?<=mv))s(?![acfswnNZ#]))"
)
_PHRASES = {
    "sign": "[,&]",
    "clause": "R[bPf_&]*",
    "rows": "(?P<at>i?)(?P<lines>[d#]?)=(?:o(?P<per>#))?|T",
    "having": "[hW]",
    "relation": "L",
    "both_sides": "[pi]P_",
    "place_side": "[pi][dP]{0,2}(?P<side>s)_*(?![acfswnNZo])",
    "made": f"Y[^,h#q]*|[pio][pif_]*(?:(?=[qrx])|(?=c)(?!{_NOUN}))",
    "noun": f"[pio]?{_NOUN}|[pio]",
    "hinge": "H[pdP_i]*(?P<edge>s)_*",
    "verb": "(?P<words>(?:g(?!b)|[mMNSHtke])(?:[mMNSHgtkevf_dP]|b(?=[mMS])|(?<=v)&(?=v))*|(?=r|q(?:B|o?k|S)))"
    "(?:[piodfvb_]*(?P<far>[qr])(?!D)(?:B|ok|k|(?P<then>[Sv]+))?)?",
    "attribute": "(?<!#)(?:c(?![wnNZamMH])|[qxs])|a(?=[c,&])",
    "each": "P",
    "rest": ".",
}
"""What a sentence is made of, in the letters of `ROLES`; the first that fits is read by the method of its name."""
_PHRASE = "|".join(f"(?P<{name}>{pattern})" for name, pattern in _PHRASES.items())
_LIMIT = ".*?(?=[,hWRLbPpiY]|(?<!#)o|(?<!g)S(?=[^,]))"
"""Where the name of the whole ends at the latest."""
Match = re.Match[str]
Facts = dict[str, Any]
"""Of `PartRequest`; besides, `grid` (columns and rows, 0 of what nobody said), `each_side`, `round`,
`sides` (lengths of which nobody said the dimension);
and, until a noun is found, `article` and `pick` (the left one)."""
_ENDS = {"top": "raised", "bottom": "lowered"}
_OPPOSITE = {"left": "right", "right": "left"}


def read_sentence(text: str, *, nearest: bool = False) -> Sentence:
    """Read a sentence; the usual object is built where a bare size has no named dimension.

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
class Sentence:
    """A sentence that is read from left to right; what is said belongs to the last noun, or to the whole."""

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
    roles: str = ""
    """One letter per unit, see `_role`."""
    taken: dict[int, str] = field(default_factory=dict)
    """Unit -> the noun of which it says something, empty for the whole; ``-`` asks for nothing, ``!`` is not read."""
    values: Facts = field(default_factory=dict)
    things: dict[str, Facts] = field(default_factory=dict)
    """By noun; the whole by an empty one."""
    ahead: Facts = field(default_factory=dict)
    """Facts of the next noun: a row of knobs, no doors."""
    notes: list[str] = field(default_factory=list)
    moves: list[tuple[str, Any, Sequence[int]]] = field(default_factory=list)
    """Motions and form of the whole, with the units that say it."""
    subject: str = ""
    """Noun of the last part; empty for the whole."""
    several: str = ""
    """The last noun of several, of which *the left one* is one."""
    is_plural: bool = False
    """The last noun is."""
    is_shown: bool = False
    """In a clause such as *with the lid open*."""
    fresh: bool = False
    """Nothing but attributes since the last comma, which are of the whole."""
    each: str = ""
    """Each of what has what follows."""
    instead_of: str = ""

    # ---- the kind --------------------------------------------------------------------------------------------------

    def find_kind(self, *, nearest: bool) -> None:
        """Find the longest name of a kind before the first word that says what it has or is like.

        Raises:
            InputError: No kind is named.
        """
        words = [lemma(unit.text) if "word" in unit.means else "" for unit in self.units]
        self._assign_roles({})
        first = _match("[^wacsmSNMntDuTB]*", self.roles, 0).end() % len(self.roles)
        limit = _match(_LIMIT, self.roles, first + 1).end()
        of = _match("o[^,hWRLbPpiYqxr]*|", self.roles, limit).end()  # a stack of machines
        if not (found := self._named(words, limit) or self._named(words, of)):
            names = words_of_names()
            slips = {w: repaired(w, names) for w, role in zip(words, self.roles, strict=False) if role in "wa"}
            found = self._named([slips.get(w) or w for w in words], limit)
            read = words[found[1] : found[2]] if found else ()
            self.notes += [f"Read {word!r} as {slips[word]!r}." for word in read if slips.get(word)]
        if not found:
            head = re.split(r" (?=[\d±])", self._text(first, of))[0] or self.text
            near = nearest_to(head, self.text)
            if not nearest:
                raise InputError(
                    f"No kind of object is called {head!r}. The nearest are "
                    f"{'; '.join(near.values())}. Say one of these, take the nearest with "
                    "--nearest, or ask a language model with --source llm."
                )
            family = next(iter(near))
            self.notes.append(f"There is no kind {head!r}: built is the nearest, a {family.title}.")
            self.instead_of, found = head, (family, 0, limit)
        self.family, self.start, self.stop = found
        self._assign_roles(vocabulary(self.family))
        self._take(range(self.start, self.stop))

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
        if word.startswith("hinge"):
            role = "H"
        elif before in ("dwh" if word in _NAMED else "sDfcP" if word in ("one", "ones") else ""):
            role = "n"  # its tilt, the left one
        elif own:
            role = "N" if "motion" in means else "n" if word == lemma(word) else "Z"
        elif role == "h" and word.endswith("ing") and before in "#dc":
            role = "_"  # two carrying handles
        elif role == "m" and word.endswith("s") and word[:-1] in WORDS:
            role = "M"
        return role or ("a" if re.search("[^e]ed$|ing$", word) else "w")

    def _named(self, words: list[str], limit: int) -> tuple[Kind, int, int] | None:
        for start in range(limit):
            for end in range(min(start + 6, len(words)), start, -1):
                family = kind_called(words[start:end]) if all(words[start:end]) else None
                if not family:
                    continue
                behind, known = re.split("[,#qxr]", self.roles[end:limit])[0], key_of(" ".join(family.words))
                if all(role != "w" or words[end + k] in known for k, role in enumerate(behind)):
                    return family, start, end + len(behind) * ("w" in behind)  # a hexapod walking robot
        return None

    # ---- from left to right ----------------------------------------------------------------------------------------

    def read(self) -> None:
        """Read all words but the name.

        Raises:
            InputError: They contradict each other.
        """
        begin = self.roles.rfind("d", 0, self.start) + 1
        self._take(range(begin if self.roles.count("d", 0, begin) < 2 else 0), "-")
        facts, used = self._described(begin, self.start)[:2]
        if facts.pop("count", 1) != 1:  # two chairs
            used = [k for k in used if self.roles[k] != "#"]
        self._add("", used, **facts)
        k = self.stop
        while k < len(self.units):
            found = _match(_PHRASE, self.roles, k)
            k = max(getattr(self, f"_{found.lastgroup}")(found) or found.end(), k + 1)
        self._lay_out()

    def _mean(self, k: int, what: str) -> Any:
        return self.units[k].means.get(what) if 0 <= k < len(self.units) else None

    def _text(self, k: int, end: int | None = None) -> str:
        return " ".join(unit.text for unit in self.units[max(k, 0) : k + 1 if end is None else end]) if k >= 0 else ""

    def _take(self, units: Iterable[int], noun: str = "") -> None:
        for k in units:
            self.taken.setdefault(k, noun)

    @property
    def _owner(self) -> str:
        return "" if self.fresh else self.subject

    def _state(self, k: int) -> float | str:
        state = self._mean(k, "state")
        return state if state in _ENDS.values() else float(state)

    def _sign(self, found: Match) -> int:
        k, end = found.start(), self.roles.index(",", found.end())
        if found[0] == ",":
            self.fresh |= not re.match("qD?,[^,]*qD,", self.roles[max(k - 2, 0) : k + 5].lstrip("#nNZ"))
            self.is_shown, self.each = False, ""
            if OF_SOME.search(self._text(k + 1, end)):
                self._take(range(k + 1, end), "!")
                return end
        return k + 1

    def _clause(self, found: Match) -> int:
        """Read how a relative clause begins, and pass over one that says no fact; its words are listed."""
        verb = found.end()
        self.is_shown = self.fresh = False
        return _match("[^,hR]*", self.roles, verb).end() if self.roles[verb] in "uwa" else verb

    def _rows(self, found: Match) -> None:
        """Read rows and columns, of the last part or of the next."""
        beside = self._mean(found.start(), "beside")
        is_next = not (self.subject and (beside or found["at"]))
        line = beside or self._mean(self.roles.index("=", found.start()), "lines")
        lines, per = (int(self._mean(found.start(name), "number") or 0) for name in ("lines", "per"))
        lines = max(lines, 1)
        facts = self.ahead if is_next else self.things.setdefault(self.subject, {})
        if per:
            facts.setdefault("count", lines * per)
        each, rest = divmod(facts.get("count", 0), lines)
        facts["grid"] = (each, lines) if line == "row" else (lines, each)
        if not rest:
            self._take(range(*found.span()), self.subject if not is_next else "")

    def _having(self, found: Match) -> None:
        k = found.start()
        self.ahead = {"count": 0} if found[0] == "W" and self._span(k + 1) else {}
        self._take([k] * len(self.ahead))
        self.is_shown = bool(re.match("with (the|its|their)|show", self._text(k, k + 2)))
        self.fresh = False

    # ---- nouns -----------------------------------------------------------------------------------------------------

    def _span(self, k: int) -> tuple[int, int] | None:
        """Find where the head of a noun phrase begins and ends; None if none begins here."""
        if (found := re.compile(_NOUN).match(self.roles, k)) is None:
            return None
        end = found.end()
        known = (it for it in range(max(k, end - 4), end) if " ".join(key_of(self._text(it, end))) in self.words)
        return next(known, end - 1 - (end - 1 > k and self.roles[end - 2] in "wn")), end

    def _part(self, k: int, head: int, end: int, *, is_place: bool = False) -> str:
        """Keep what is said before a noun, of the part that it means; returns what it is called."""
        words = self._text(head, end)
        key = " ".join(key_of(words))
        facts, used, is_choice = self._described(k, end, head)
        is_one_of = head > k and self.roles[head - 1] == "w" and not self._cell(key)  # a jockey wheel
        pick, article = facts.pop("pick", ""), facts.pop("article", False) and not (is_one_of or "count" in facts)
        if words in ("one", "ones") and self.several:
            key = self.several
            if words == "one":
                facts.pop("count", None)
            words = key if words == "one" else f"{key}s"
        is_place &= "count" not in facts
        if is_place and not is_choice and (key in _WHERE or not (key in self.words or key in self.things)):
            self._take(range(head, end) if key in _WHERE else (), "-")
            return key
        if self.each and not is_place:
            if times := self.things.get(self.each, {}).get("count"):
                facts["count"] = facts.get("count", 1) * times
            else:
                self._take(range(k, end), "!")
        facts |= self.ahead
        self.ahead, is_plural = {}, words != lemma(words)
        noun = f"{pick} {words}" if pick else key
        if "count" not in facts and not (pick or noun in self.things or is_choice or is_place):
            counted = _counted(self.family, noun)
            several = {"at_least" if not counted or counted.default else "count": 2}
            facts |= several if is_plural else {"count": 1} if article else {}
        if key in _STILL:
            facts.pop("open", None)
        if facts or not is_choice:
            noun = self._add(noun, [*used, *range(head if key in self.words else end - 1, end)], **facts)
        if not is_place:
            self.subject, self.is_plural, self.fresh = noun, is_plural, False
            self.several = key if is_plural else self.several
        return noun

    def _described(self, k: int, end: int, head: int | None = None) -> tuple[Facts, list[int], bool]:
        """Read what is before a noun, or before the name of the whole.

        Args:
            k: Where it begins.
            end: Where the noun ends.
            head: Where the noun begins; none before the name.

        Returns:
            Facts, the units that say them, and if the noun is a choice of the kind.
        """
        stop, is_choice, facts, used = end if head is None else head, False, Facts(), list[int]()
        while k < end:
            if chosen := self._choice(k, end, facts, head):
                is_choice |= chosen > stop
                k = chosen
            elif k >= stop:
                break
            else:
                k += self._modifier(k, stop, facts, used, is_part=head is not None)
        return facts, used, is_choice

    def _modifier(self, k: int, stop: int, facts: Facts, used: list[int], *, is_part: bool) -> int:
        """Read one unit before a noun; returns how many were read."""
        word, behind, role = self._text(k), self._text(k + 1), self.roles[k]
        said: Facts = {}
        if role == "#":
            number = self._mean(k, "number")
            if (
                k + 1 < stop
                and behind == lemma(behind)
                and number != "1"
                and self._text(stop) == lemma(self._text(stop))
            ):
                nouns = (behind, behind.removesuffix("ed"), behind.removesuffix("d"))
                if noun := next((it for it in nouns if "part" in self.words.get(it, ())), ""):
                    self._add(noun, [k, k + 1], count=int(float(number)))  # a six drawer dresser, two wheeled
                return 1 + (self.roles[k + 1] in "nwa")  # or a three spoke handle, of which nothing is known
            said = {"count": int(number)} if number.isdigit() else {}
        elif role in "qx":
            return self._size(k, facts, used)
        elif role == "s":
            facts["pick"] = f"{facts.pop('pick', '')} {word}".strip()
            used.append(k)
        elif word in ("a", "an"):
            said = {"article": True}
        elif role == "S":
            said = {"open": float(self._mean(k - 1, "degree") or 0.0) or self._state(k)}
            used += [k - 1] if self.roles[k - 1] == "g" else []
        elif looks := _LOOKS & self.units[k].means.keys():
            said = {what: self._mean(k, what) for what in looks}
        elif role in "mMH" and not (is_part and self._mean(k, "name") and not self._mean(k + 1, "towards")):
            said = {"motion": self._mean(k, "motion")}
            if towards := self._mean(k + 1, "towards"):
                said["towards"] = towards
                used.append(k + 1)
        used += [k] * (said == {name: facts.setdefault(name, value) for name, value in said.items()} != {})
        return 1

    def _choice(self, k: int, end: int, facts: Facts, head: int | None) -> int:
        """Read a value of a parameter of the kind; returns where it ends, or 0."""
        for after in range(end, k, -1):
            words = self._text(k, after)
            meanings = self.words.get(" ".join(key_of(words)), {})
            if "choice" not in meanings:
                continue
            name, value = meanings["choice"]
            behind = lemma(self._text(after)) if after < end else ""
            own = self.words.get(behind, {}).get("part") == "own" or behind in name
            counts = meanings.get("part") and ("count" in facts or words != lemma(words))
            if not own and head is not None if behind else counts:
                continue
            if self.ahead.get("count") == 0:
                value = "no" if value == "yes" else "none"
                self.ahead = {}
            self._set(name, value, range(k, after))
            return after
        return 0

    def _add(self, noun: str, units: Sequence[int], **facts: Any) -> str:
        """Give what is said to a part, or to the whole; what it has otherwise is not read. Returns the noun."""
        if not noun:
            for what, value in facts.items():
                self._whole(what, value, units)
            return noun
        own = self.things.setdefault(noun, {})
        count = own.get("count", facts.get("count"))
        if count != facts.get("count", count):
            if self._cell(noun) and ((facts | own).keys() & {"side", "grid", "row"}):
                return self._add(f"{noun} ", units, **facts)  # another group of the same
            if (facts | own).keys() & {"side", "color", "material"}:
                return noun
            raise InputError(f"The text says {count} and {facts['count']} of {noun!r}. Say one.")
        fits = True
        if len(facts.get("sides", "")) == 1 and length_names(self.family, noun, "length"):
            facts["size"] = {**facts.get("size", {}), "length": facts.pop("sides")[0]}
        for name, value in facts.items():
            if name == "size":
                own["size"] = {**own.get("size", {}), **value}
            elif own.get(name) == "move":
                own[name] = value
            else:
                fits &= own.setdefault(name, value) in (value, "move") or value == "move"
        self._take(units if fits else (), noun)
        return noun

    # ---- attributes ------------------------------------------------------------------------------------------------

    def _fact(self, found: Match, owner: str | None = None, **facts: Any) -> None:
        self._add(self._owner if owner is None else owner, range(*found.span()), **facts)

    def _size(self, k: int, facts: Facts, used: list[int]) -> int:
        """Read a size and the dimension behind it; returns how many units were read."""
        numbers, step = values_of(self._text(k)), k + 1 + (self.roles[k + 1 : k + 3] in ("iD", "oD"))
        if numbers[-1][1] != "m":
            return 1
        used.append(k)
        if self.roles[k] == "q" and (name := self._mean(step, "dimension")):
            facts.setdefault("size", {})[name] = numbers[0][0]
            used.append(step)
            return step + 1 - k
        facts["sides"] = tuple(number for number, _ in numbers)
        return 1

    def _attribute(self, found: Match) -> int:
        """Read a look, a size or a side that is alone."""
        k, facts, used, owner = found.start(), Facts(), list[int](), self._owner
        k += self._modifier(k, k, facts, used, is_part=False)
        side = WORDS.get(facts.pop("pick", ""), {}).get("side")
        if side and owner:
            facts["towards" if self.roles[found.start() - 1] in "mM" else "side"] = side
        self._add(owner, used if facts else (), **facts)
        return k

    def _range(self, found: Match, k: int, owner: str, how: str, **facts: Any) -> None:
        """Give a range, with the motion that its unit means; it is not read where the text says another motion."""
        numbers = values_of(self._text(k))
        (low, _), (value, si) = numbers[0], numbers[-1]
        low = -value if self._mean(k, "symmetric") or "B" in found[0] else low if self.roles[k] == "r" else 0.0
        usual = "slide" if si == "m" else "hinge"
        owner = owner or (how if how in ("pan", "tilt") else usual)
        for other in (self.things.get(owner, {}).get("motion", usual), usual):
            how = other if how == "move" else how
        if (how in ("slide", "lift")) is (si == "m") and (si == "rad" or low <= 0.0):  # how high it is, is not read
            self._add(owner, range(*found.span()), range=tuple(sorted((low, value))), motion=how, **facts)

    def _hinge(self, found: Match) -> None:
        self._fact(found, hinge=self._mean(found.start("edge"), "side"))

    def _verb(self, found: Match) -> int:
        """Read how something moves, how far, or how it is shown."""
        how, share, stands, far, k = "", None, self.is_shown, found.start("far"), found.start()
        is_whole = self.roles[k] in "rq" or self._text(k).endswith("s") or "P" in found[0]
        owner = self._owner if is_whole else self.subject
        for j in range(*found.span("words")):
            before, role = j - 1 - (self.roles[j - 1] == "P"), self.roles[j]
            can = self.roles[before] in "bR" and self._text(before) not in ("is", "are")
            goes = self._text(j) == "open" and (can or (self.is_plural and not stands and far > 0))
            if role == "S" and not goes and (not can or self._mean(j, "state") == "0"):
                state, stands = self._state(j), True
                if share and not state:  # open and closed
                    return found.end()
                share = state if share in (None, 1.0) else share
            elif role == "g" and not how:
                share = float(self._mean(j, "degree"))
            elif role in "mMNHS":
                how = how or str(self._mean(j, "motion") or "move")
            elif role == "e":  # turns, or is folded, all the way
                how, share = ("spin", None) if share is None else (how, 1.0)
            stands |= role == "t"
        heads = [side for j in range(k, found.end()) if (side := self._mean(j, "towards"))]
        facts: Facts = {"towards": heads[0]} if heads and (how or share) else {}
        if not (share is None or owner or how) and (place := re.search("s[^,hR]*$", self.roles[:k])):
            self._take(range(place.start(), found.end()), "!")  # the top half is open
        elif far > 0 and (stands or found["then"]) and self.roles[far] == "q" and not how:
            self._fact(found, owner, open=values_of(self._text(far))[0])
        elif far > 0:
            self._range(found, far, owner, how or "move", **facts)
        elif how:
            self._fact(found, owner, motion=how, **facts)
        elif stands and share is not None:
            self._fact(found, owner, open=share, **facts)
        return found.end()

    # ---- places ----------------------------------------------------------------------------------------------------

    def _made(self, found: Match) -> None:
        """Pass over what leads to a size or a material, and what it is for or like; a look like another is not read."""
        self._take(range(*found.span()), "-!"["Y" in found[0] and self._text(found.start() - 1).endswith("ed")])

    def _both_sides(self, found: Match) -> None:
        self._fact(found, self.subject, each_side=True)
        if "count" in (facts := self.things.get(self.subject, {})) and self._text(found.start() + 1) != "both":
            facts["count"] *= 2

    def _noun(self, found: Match) -> None:
        """Read a part, or where something is."""
        in_place = self.roles[found.start()] in "pio"
        k = found.start() + in_place
        if span := self._span(k):
            last = self._text(span[1] - 1)
            is_place = bool(self._owner) and (
                self._text(k) in _THE or (last == lemma(last) and self.roles[k] not in "d#")
            )
            noun = self._part(k, *span, is_place=in_place and (is_place or lemma(last) in _WHERE))
            if self._text(k) in ("each", "every"):
                self.each = noun if self.roles[span[1]] == "h" else ""
                self._take(range(k, span[1] * in_place), "!")  # a knob on each door

    def _place_side(self, found: Match) -> None:
        side = self._mean(found.start("side"), "side")
        is_way = self._text(found.start()) == "to" and self.roles[found.start() - 1] in "mMaSv&q"  # slides to the left
        self._fact(found, **{"towards" if is_way else "side": side})

    def _relation(self, found: Match) -> int:
        """Read that one part is above another, and the like."""
        k, subject, other = found.start(), self.subject, ""
        step, span, end = int(self._mean(k, "relation")), self._span(k + 1), k + 1 + (self.roles[k + 1] == "P")
        if span and subject and self.roles[k + 1] != "P":
            is_place = self._text(k + 1) in _THE
            other = self._part(k + 1, *span, is_place=is_place)
            self.subject, end = subject if is_place else self.subject, span[1]
        elif subject:
            other = next((noun for noun in reversed(self.things) if noun not in ("", subject)), "")
        if self._text(k + 1) in ("each", "every"):
            self._take(range(k, end), "!")
        elif "" not in {subject, other} <= self.things.keys() and other != subject:  # above (1) or below (-1) it
            mine, its = (self.things[noun] for noun in (subject, other))
            its.setdefault("row", mine.setdefault("row", its.get("row", 10 + step) - step) + step)
            self._take([k], subject)
        return end

    def _each(self, found: Match) -> None:
        self.fresh = False
        self.each = self.subject if self.roles[found.end()] == "h" else ""
        if self._text(found.start()) == "each" and self.subject and not self.is_plural:
            self._take([found.start()], "!")  # a boom and a bucket each move

    def _rest(self, found: Match) -> None:
        """Pass over a word, or read in which direction what was named moves, or that it is shown up or down."""
        side = self._mean(found.start(), "towards")
        if side in _ENDS and self.is_shown and self._owner:
            self._fact(found, open=_ENDS[side])
        elif side and "motion" in self.things.get(self._owner, ()):
            self._fact(found, towards=side)

    # ---- the whole -------------------------------------------------------------------------------------------------

    def _set(self, name: str, value: Any, units: Iterable[int]) -> None:
        """Set a parameter of the whole; words for what it cannot be are not read."""
        with suppress(InputError):
            value = checked(self.family, name, value)
            if self.values.setdefault(name, value) == value:
                self._take(units)

    def _whole(self, what: str, value: Any, units: Sequence[int]) -> None:
        if what == "sides":
            what, value = "size", dict(zip(sides_meant(self.family, value), value, strict=False))
        if what == "size" and value:
            sizes = self.things.setdefault("", {})
            for name, size in value.items():
                if sizes.setdefault(name, size) != size:
                    raise InputError(f"The text says that the {name} is {sizes[name]:g} m and {size:g} m. Say one.")
            self._take(units)
        elif what in ("color", "material"):
            self._set(what, value, [k for k in units if what in self.units[k].means])
        elif what == "open":
            if isinstance(value, tuple):
                self._add("hinge" if value[1] == "rad" else "slide", units, open=value)
            elif isinstance(value, str):
                self._add("move", units, open=value)
            else:
                self._set("open", value, units)
        elif what == "hinge":
            self._add("door", units, hinge=value)
        elif what in ("motion", "towards", "round"):
            self.moves.append((what, value, units))
            self._take(units)

    # ---- layouts of fronts -----------------------------------------------------------------------------------------

    def _cell(self, noun: str) -> str:
        """The field of a layout that a noun means; empty if the kind has no layout, or none of the noun."""
        counted = _counted(self.family, noun) if any(item.name == "layout" for item in self.family.parameters) else None
        own = lemma(counted.name) if counted else ""
        return own if own in CELLS else ""

    def _lay_out(self) -> None:
        """Write the layout of a front whose fields are placed; fields that are not named are left out."""
        counted = {lemma(item.name): item for item in self.family.parameters if isinstance(item.default, int)}
        fields = [(cell, facts) for noun, facts in self.things.items() if (cell := self._cell(noun))]
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
            level = {"top": 0, "bottom": 20}.get(side, int(facts.get("row", 10)))
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
            kept = {name: first[name] for name in first.keys() - {"row", "side", "grid"}}
            self.things[noun.rstrip()] = {**kept, "count": first["count"] + more["count"]}
        rows = sorted({facts["row"] for facts in self.things.values() if "row" in facts})
        sizes, parts = self.things.pop("", {}), {}
        for noun, facts in list(self.things.items()):
            if facts.get("count") == 0 and facts.keys() - {"count", "at_least", "row"}:
                raise InputError(f"The text says that there is no {noun}, and what it is like. Say one.")
            if (name := self.words.get(noun, {}).get("length")) and len(facts.get("sides", "")) == 1:
                self._set(name, facts["sides"][0], [k for k, owner in self.taken.items() if owner == noun])
                del self.things[noun]
                continue
            if "row" in facts:
                facts["row"] = rows.index(facts["row"]) + 1
            parts[noun] = {name: value for name, value in facts.items() if name not in CHECKS}
        named = key_of(self._text(self.start, self.stop))
        usual = next((said for word, said in self.family.usual.items() if key_of(word) == named), {})
        stated = {*sizes, *(item.name for noun in parts if (item := _counted(self.family, noun)))}
        self.request = request_of(
            {
                "kind": self.family.name,
                "parameters": {**{name: value for name, value in usual.items() if name not in stated}, **self.values},
                "size": sizes,
                "parts": parts,
                "instead_of": self.instead_of,
            },
            source=f"text {self.text!r}",
        )

    def made(self, *, seed: int | None = None) -> BuildResult:
        """Build the object and measure it.

        Raises:
            InputError: Nothing can be built.
        """
        made = deliver(self.request, seed=seed)
        blueprint, taken = made.blueprint, dict(self.taken)
        there = {key for part in blueprint.parts for key in key_of(stem_of(part.name).replace("_", " "))}
        lost = {noun for noun in made.unmeasured if self.things[noun] or not there.issuperset(key_of(noun))}
        listed = [why for why in made.differences if why.split(":")[0] not in lost]
        for what, value, units in self.moves:
            if not self._holds(what, value, self._text(units[0]), blueprint):
                taken |= dict.fromkeys(units, "!")
        for noun, facts in self.things.items():
            if noun not in lost and (names := names_called(self.family, blueprint, noun)):
                for what, (holds, why) in CHECKS.items():
                    if what in facts and not holds(blueprint, names, facts[what]):
                        listed.append(f"{noun}: {why.format(facts[what])}")
        large = np.ptp(blueprint.assembly.bounds, axis=0).max()
        for k in range(self.stop + 1) if not self.request.size else ():
            smallest, largest = map(float, (self._mean(k, "extent") or f"0 {large}").split())
            if not smallest <= large <= largest:
                listed.append(f"{self._text(k)}: it is {large:.2g} m large")
        return replace(
            made,
            differences=tuple(listed),
            unread=tuple(self._unread(taken, lost, there)),
            notes=tuple(self.notes),
            facts={"text": self.text, **made.facts},
        )

    def _holds(self, what: str, value: Any, word: str, made: Blueprint) -> bool:
        """True if what is said of the whole is so; that it folds or rocks is only known of a kind that says so."""
        if what in CHECKS:
            return CHECKS[what][0](made, [made.parts[0].name], value)
        if value == "hinge" and not re.match("turn|rotat|swing|hing|pivot", word):
            about = (*self.family.words, self.family.about, *self.family.part_words)
            return any(word[:4] in said.lower() for said in about)
        some = any if value in ("pan", "tilt", "spin") or what == "towards" else all
        return some(
            moves_so(joint, value) if what == "motion" else goes_towards(made, joint, value)
            for joint in made.joints
            if joint.mimic is None
        )

    def _unread(self, taken: Mapping[int, str], lost: set[str], there: set[str]) -> Iterator[str]:
        """Words of content that nothing took, or a noun that is no part; a quotation with the words between them."""
        quoted = [list[int]()]
        for k, role in enumerate(self.roles[: len(self.units)]):
            owner, words = taken.get(k), key_of(self._text(k))
            is_known = {word.removesuffix("ed") for word in words} <= there
            asks = role in _CONTENT or _ASKING & self.units[k].means.keys()
            if owner == "!" or (asks and (owner in lost or (owner is None and not is_known))):
                quoted[-1].append(k)
            elif asks:
                quoted.append([])
        for units in filter(None, quoted):
            yield re.sub(r" (?=[^\w\s'\"±.~-])", "", self._text(units[0], units[-1] + 1))


def _match(pattern: str, text: str, k: int) -> Match:
    found = re.compile(pattern).match(text, k)
    assert found
    return found


def _counted(family: Kind, noun: str) -> Parameter | None:
    """The parameter that counts parts of a noun, where it may have several values."""
    item = count_parameter(family, noun)
    return item if item and item.bounds and item.bounds[0] < item.bounds[1] else None
