"""English into a typed request: the kind, sizes, counts, looks, sides, rows, ranges and openings; the rest is listed.

Nothing is guessed: what is not read is returned as words not read, and what was read is measured on the object.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from kinematify.errors import InputError
from kinematify.generate.delivery import BuildResult, deliver, moves_so, nouns_of
from kinematify.generate.kind_search import (
    key_of,
    kind_called,
    lemma,
    nearest_kinds,
    repaired,
    words_of,
    words_of_names,
)
from kinematify.generate.procedural.family import checked
from kinematify.generate.procedural.layout import CELLS
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS
from kinematify.generate.request import ANGLES, UNITS, PartRequest, Request

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.parameter import Parameter

LONGEST = 200
"""Words at most."""
_COUNTED = (
    "zero|one single|two pair couple double twin dual|three triple|four|five|six|seven|eight|nine|ten|eleven|"
    "twelve dozen|thirteen|fourteen|fifteen|sixteen|seventeen|eighteen|nineteen|twenty"
)
_NUMBERS = {word: number for number, words in enumerate(_COUNTED.split("|")) for word in words.split()}
_NUMBERS |= {"thirty": 30, "forty": 40, "sixty": 60, "ninety": 90}
_KINDS = words_of("single double twin dual triple")
"""Before a name they say which kind, and not how many."""
_MEANINGS = (
    "width wide width broad|depth deep depth|height high tall height|length long length|diameter diameter across|"
    "thickness thick thickness"
)
_DIMENSIONS = {word: name for name, *words in map(str.split, _MEANINGS.split("|")) for word in words}
_SIDES = {side: side for side in ["left", "right", "front", "back", "top", "bottom"]}
_SIDES |= {"rear": "back", "underside": "bottom", "underneath": "bottom", "upper": "top", "lower": "bottom"}
_OPPOSITE = {"left": "right", "right": "left"}
_ORDINALS = words_of("first second third fourth fifth sixth")
_ABOVE, _BELOW = words_of("above over"), words_of("below under beneath")
_VERBS = (
    "move open opens opening close closes closing move moves moving lift lifts lifting raise raises go goes going come "
    "comes travel travels travelling traveling adjust adjusts press presses extend extends movable moveable adjustable "
    "raisable raising drops|"
    "slide slide slides sliding pull pulls telescope telescopes telescopic telescoping retract retracts retractable|"
    "hinge hinge hinges hinged swing swings swinging pivot pivots pivoting pivoted fold folds folding foldable flip "
    "flips flipping turn turns turning rotate rotates rotating rotatable drop tip tips tipping|"
    "spin spin spins spinning revolve revolves revolving|tilt tilt tilts tilting recline reclines reclining|"
    "pan pan pans panning swivel swivels swiveling swivelling"
)
_MOTIONS = {word: motion for motion, *words in map(str.split, _VERBS.split("|")) for word in words}
_STROKES = words_of("travel stroke range way")
_DONE = {"closed": 0.0, "shut": 0.0, "ajar": 0.15} | dict.fromkeys(
    words_of(
        "open opened pulled pushed propped raised lowered lifted tilted turned swung extended drawn moved folded "
        "rotated"
    ),
    1.0,
)
"""States -> share of the way that they mean by themselves."""
_DEGREES = {"half": 0.5, "partly": 0.5, "halfway": 0.5, "fully": 1.0, "wide": 1.0, "completely": 1.0, "slightly": 0.15}
_WHERE_TO = words_of("up down out in back forward forwards outward outwards inward away open upwards downwards off")
_HAVING = words_of("with having has have featuring including plus")
_REFERS = words_of("it its they them their that which whose each both all")
_VERBAL = words_of("that which can to may all both each be")
_SAYS_NOTHING = words_of(
    "a an the of and to in on at by for from is are be been being can may could must i we you like want need "
    "please make build create generate give show draw design get me us my our your some one any this these those "
    "there made out into as so would will let have standing side hand end object item thing model piece set also "
    "then kind type sort hi hello hey thanks where when while itself own u about approximately roughly approx around "
    "exactly inside along wants wanted do must plain stacked colour color"
)
_PLAIN = words_of(
    "modern sleek contemporary minimalist vintage retro rustic antique classic elegant stylish fancy cute cosy "
    "cozy beautiful pretty lovely nice cool sturdy robust strong durable solid heavy duty professional practical "
    "simple standard typical normal ordinary regular usual common new old good great quality ergonomic comfortable "
    "realistic detailed basic scandinavian victorian industrial traditional brushed polished matte matt glossy "
    "shiny painted lacquered big large huge small little tiny mini narrow short slim compact shallow quite very "
    "really just portable electric electrical household kitchen garden office bathroom bedroom living room hallway "
    "workshop hotel home commercial domestic outdoor indoor style styled wall identical matching freestanding free "
    "mounted independently endlessly freely smoothly easily continuously gently slowly quickly separately individually "
    "daughter son wife husband mother father grandmother child kid friend"
)
"""Looks, sizes without a number and places of use, which ask for no shape and no motion that could be measured."""
_OF_SOME = re.compile(
    r"\b(?:(?:of|except) (?:which|them|these|those)|other|another|except|only|instead|alternat\w+|respectively|others"
    r"|every (?:second|other)|half of|cant|cannot|dont|doesnt|isnt|not|never"
    r"|(?:the|while) (?:\w+ )?(?:left|right|top|bottom|first|second|third|fourth|last|"
    r"middle|upper|lower|front|rear|back) (?:one|half))\b"
)
"""Clauses about some of the parts, which are not read."""
_PARTS = words_of(
    "door drawer flap knob button lever caster wheel crank rotor vent lock handle lid tray shelf hook gauge needle "
    "dial switch pedal seat leg arm blade window light display screen ladder mirror basket rail bell finger joint "
    "cover hatch panel key roller fan gear pulley spring rope bulb stand foot mast boom bucket propeller wing sail "
    "visor brake clamp jaw spout tap valve plunger piston rod nozzle hose cable plug socket cap drum turntable "
    "platform ramp step armrest headrest footrest backrest handlebar tailgate hood trunk bonnet gripper camera "
    "antenna grip"
)
"""Nouns of parts that many kinds have."""
_NO_PARTS = words_of("hinge joint front bottom back axle motor bearing floor")
"""Nouns of which nobody can tell that an object has none."""
_NO_NOUNS = words_of("row column rows columns line middle center")
_AT = words_of("on at along under to of from into through behind beside near by around inside")
"""Before *the* and a noun they say a place."""
_AMBIGUOUS = words_of("none yes no top bottom left right side plain one two four off fixed beside below within")
_NUMBER = r"\d+(?:[.,]\d+)?"
_UNIT = "|".join(sorted((re.escape(word) for word in (*UNITS, *ANGLES) if word != "in"), key=len, reverse=True))
_TIMES = rf" ?(?:x|×|by) ?{_NUMBER}(?: ?(?:{_UNIT})(?![a-z]))?"
_TOKENS = re.compile(
    rf"(?P<dims>{_NUMBER}(?: ?(?:{_UNIT}))?{_TIMES}(?:{_TIMES})?)(?![a-z0-9])"
    rf"|(?P<range>(?:from )?[-−]?{_NUMBER} ?(?:{_UNIT})? ?(?:up |down )?(?:to|and|\.\.) ?"
    rf"\+?[-−]?{_NUMBER} ?(?:{_UNIT}))(?![a-z])"
    rf"|(?P<both>(?:±|\+/-|plus or minus) ?{_NUMBER} ?(?:{_UNIT}))(?![a-z])"
    rf"|(?P<quantity>[-−]?{_NUMBER} ?(?:{_UNIT}))(?![a-z])|(?P<number>{_NUMBER})|(?P<word>[a-z]+)|(?P<sign>[^\sa-z0-9])"
)
_BARE = re.compile(
    rf"(?<![\dx×.-] )\b{_NUMBER}(?= (?:wide|deep|high|tall|long|broad|thick)\b)"
    rf"|from [-−]?{_NUMBER} to ([-−]?{_NUMBER})(?! ?(?:{_UNIT}))\b"
)
"""A size or a range without a unit."""
_SYMMETRIC = re.compile(r"(?:to|in|on) (?:either|each|both) (?:sides?|directions?|way)|each way|either way")
_PURPOSE = re.compile(
    r"\b(?:for|to (?:store|keep|hold|put|carry|hang|serve|sort|collect|display)) [^,;.:]*?"
    r"(?=$|[,;.:]| with | and | that | having )"
)


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str


def read_sentence(text: str, *, nearest: bool = False) -> Sentence:
    """Read a sentence; nothing is built.

    Args:
        text: English.
        nearest: Take the nearest kind where none is named.

    Raises:
        InputError: It is empty, too long, no English, contradicts itself, or names no kind that is known; the message
            names the nearest.
    """
    plain = re.sub(r"['’](?:s|m|d|ll|re|ve)?\b|(?<=s)['’]", "", " ".join(text.lower().split()))
    plain = re.sub(r"\bw/ ?", "with ", re.sub(r"(?<=\w)-(?=[a-z])|(?<=[a-z])-(?=\w)", " ", plain)).replace("&", " and ")
    _refuse_unreadable(text, plain)
    plain = re.sub(r"(?<=\d),(?=\d{3}\b)", "", plain)
    plain = re.sub(rf"\b({'|'.join(_NUMBERS)}) (?=(?:{_UNIT})\b)", lambda found: f"{_NUMBERS[found[1]]} ", plain)
    plain = re.sub(r"^((?:an? |the )?)built in ", r"\1", re.sub(r"^for (?:my|our|the) \w+,? (?=an? )", "", plain))
    plain = re.sub(r"(?<=\d) in (?=(?:wide|deep|high|tall|long|thick)\b)", " inch ", plain)
    plain = _BARE.sub(lambda found: _with_unit(found, plain), plain)
    purposes = [item[0].strip() for item in _PURPOSE.finditer(plain)]
    purposes = [
        item for item in purposes if not (set(key_of(item)) & {*_PARTS, *_MOTIONS, *_NUMBERS} or re.search(r"\d", item))
    ]
    for purpose in purposes:
        plain = plain.replace(purpose, " ")
    tokens = [_Token(str(found.lastgroup), found[0]) for found in _TOKENS.finditer(plain)]
    sentence = Sentence(text=text, tokens=tokens, harmless=purposes)
    sentence.find_kind(nearest=nearest)
    sentence.read()
    try:
        sentence.fill()
        return sentence
    except ValidationError as error:
        first = error.errors()[0]
        where = " of ".join(map(str, reversed(first["loc"])))
        raise InputError(f"The text {text!r} cannot be built: {where}: {first['msg']}.") from error


def _with_unit(found: re.Match[str], text: str) -> str:
    """Return a size or a range with the unit of the one before it: 1600 mm wide and 750 high."""
    units = [
        unit
        for unit in re.findall(rf"\d ?({_UNIT})(?![a-z])", text[: found.start()])
        if (unit in ANGLES) is bool(found[1])
    ]
    return f"{found[0]} {units[-1]}" if units else found[0]


def _refuse_unreadable(text: str, plain: str) -> None:
    letters = [letter for letter in plain if letter.isalpha()]
    shown = repr(text if len(text) < 80 else f"{text[:77]}...")
    if not plain.strip():
        raise InputError("The text is empty. Describe an object, e.g. 'a cabinet with two doors above three drawers'.")
    if not letters or sum(letter.isascii() for letter in letters) < 0.8 * len(letters):
        raise InputError(f"The text {shown} is not English as far as can be seen. Describe the object in English.")
    if len(plain.split()) > LONGEST:
        raise InputError(f"The text has {len(plain.split())} words; at most {LONGEST} describe one object.")
    if re.search(rf"\bminus (?!{_NUMBER} ?(?:{_UNIT}))|\bnegative\b|(?:^|\s)-\s?\d+ (?!to |{_UNIT})[a-z]+", plain):
        raise InputError(f"The text {shown} asks for a negative number. Give counts above zero.")


@dataclass(kw_only=True)
class Sentence:
    """A sentence that is read clause by clause: attributes wait for their noun, else go to the last one."""

    text: str
    tokens: list[_Token]
    request: Request = field(init=False)
    family: Family = field(init=False)
    usual: Mapping[str, Any] = field(init=False)
    start: int = 0
    """Where the name begins."""
    stop: int = 0
    """Where it ends."""
    values: dict[str, Any] = field(default_factory=dict)
    sizes: dict[str, float] = field(default_factory=dict)
    parts: dict[str, dict[str, Any]] = field(default_factory=dict)
    implied: set[str] = field(default_factory=set)
    """Nouns whose number is only said by an article."""
    guessed: dict[str, str] = field(default_factory=dict)
    """Nouns that may be parts -> the words that say it; words not read where the object has none."""
    faults: list[str] = field(default_factory=list)
    """Values that the kind cannot have."""
    unread: list[str] = field(default_factory=list)
    harmless: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    moves: list[tuple[str, str]] = field(default_factory=list)
    """Motions of the whole, with the words that say it."""
    copies: int = 1
    waiting: dict[str, Any] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)
    """Words of what waits."""
    subject: str = ""
    """Noun of the last part; empty for the whole."""
    fresh: bool = False
    """Nothing but attributes since the last comma."""
    relation: tuple[str, int] | None = None
    instead_of: str = ""
    times: int = 1
    """Of each part that was named before."""
    is_before: bool = True
    """Its name is still to come."""

    # ---- the kind --------------------------------------------------------------------------------------------------

    def find_kind(self, *, nearest: bool) -> None:
        """Find the longest name of a kind before the first word that says what it has or is like.

        Raises:
            InputError: No kind is named.
        """
        words = [lemma(token.text) if token.kind == "word" else "" for token in self.tokens]
        first = next((k for k, word in enumerate(words) if word and word not in _SAYS_NOTHING | _PLAIN), 0)
        limit = next((k for k in range(first + 1, len(words)) if self._ends_name(k)), len(words))
        found = self._named(words, limit)
        for k in range(limit) if found is None else ():
            other = None if words[k] in _SAYS_NOTHING | _PLAIN else repaired(words[k], words_of_names())
            if other is not None:
                self.notes.append(f"Read {self.tokens[k].text!r} as {other!r}.")
                words[k] = other
                found = self._named(words, limit)
        if found is None:
            head = " ".join(token.text for token in self.tokens[first:limit]) or self.text
            near = nearest_kinds(head)
            if not nearest:
                raise InputError(
                    f"No kind of object is called {head!r}. The nearest are "
                    f"{', '.join(family.words[0] for family in near)}. Say one of these, take the nearest with "
                    "--nearest, or ask a language model with --source llm."
                )
            self.notes.append(f"There is no kind {head!r}: built is the nearest, a {near[0].title}.")
            self.family, self.instead_of, self.start, self.stop = near[0], head, 0, limit
        else:
            self.family, self.start, self.stop = found
        own = key_of([token.text for token in self.tokens[self.start : self.stop]])
        self.usual = next((said for word, said in self.family.kinds.items() if key_of(word) == own), {})

    def _named(self, words: list[str], limit: int) -> tuple[Family, int, int] | None:
        for start in range(limit):
            for end in range(min(start + 6, len(words)), start, -1):
                family = kind_called(words[start:end]) if all(words[start:end]) else None
                if family is not None and not any(self._is_noun(k) for k in range(end, limit)):
                    return family, start, end
        return None

    def _ends_name(self, k: int) -> bool:
        word = self.tokens[k].text
        ends = (
            _HAVING | _REFERS | _ABOVE | _BELOW | words_of("on made without where mounted standing next and in for at")
        )
        before, after = self._text(k - 1), self._text(k + 1)
        state = word in _DONE and before not in _DEGREES and after not in ("", "top")
        return self.tokens[k].kind == "sign" or word in ends or state or (word == "of" and before not in _NUMBERS)

    def _is_noun(self, k: int) -> bool:
        """True if a word goes on with a name, so that another thing is named: a laptop bag."""
        word = self.tokens[k].text
        known = {*_DONE, *_DEGREES, *_DIMENSIONS, *COLOR_WORDS, *_MOTIONS, *_SIDES, *_NUMBERS}
        plain = self.tokens[k].kind != "word" or _material(word)
        return not plain and word not in _SAYS_NOTHING | _PLAIN | known | {"toy"}

    # ---- clauses ---------------------------------------------------------------------------------------------------

    def read(self) -> None:
        """Read all words but the name.

        Raises:
            InputError: They contradict each other.
        """
        self.words = _vocabulary(self.family)
        k = 0
        while k < self.start:
            k = self._one(k, self.start)
        count = self.waiting.pop("count", 1)
        if count > 1 and _KINDS & set(self.said):
            head = self.tokens[self.stop - 1].text
            if _counted(self.family, head) is not None:
                self.parts[lemma(head)] = {"count": count}
            else:
                self.unread += _KINDS & set(self.said)
        elif count > 1 and "grid" not in self.waiting:
            self.copies = count
        self._settle("")
        self.subject, self.fresh, self.is_before, k = "", False, False, self.stop
        while k < len(self.tokens):
            ends = (j for j in range(k + 1, len(self.tokens)) if self.tokens[j].text in ",;.")
            clause = next(ends, len(self.tokens))
            text = " ".join(token.text for token in self.tokens[k:clause])
            if self._at_start(k) and _OF_SOME.search(text):
                self._settle(self._owner())
                self.unread.append(text.lstrip(",; "))
                k = clause
            else:
                k = self._one(k, len(self.tokens))
        self._settle(self._owner())
        self._lay_out()

    def _at_start(self, k: int) -> bool:
        return k == self.stop or self.tokens[k].text in ",;."

    def _owner(self) -> str:
        return "" if self.fresh else self.subject

    def _one(self, k: int, end: int) -> int:
        """Read what begins at a token; returns where to go on."""
        token, word = self.tokens[k], self.tokens[k].text
        if token.kind == "sign":
            if word in ",;:.()":
                self._settle(self._owner())
                self.fresh, self.times = True, 1
            elif word not in "\"'?!":
                self.unread.append(word)
            return k + 1
        if token.kind in ("dims", "range", "both", "quantity"):
            return self._measure(k)
        if token.kind == "number" or (word in _NUMBERS and not (word == "one" and self._text(k + 1) in ("", "of"))):
            value = float(word.replace(",", ".")) if token.kind == "number" else _NUMBERS[word]
            if self._grid(k, int(value)):
                return k + 2
            if value != int(value) or "count" in self.waiting or (not value and token.kind != "number"):
                self.unread.append(word)
            else:
                self._wait("count", word, int(value))
            return k + 1 + (self._text(k + 1) == "of")
        for length in range(min(4, end - k), 0, -1):
            key = tuple(lemma(item.text) if item.kind == "word" else "" for item in self.tokens[k : k + length])
            meanings = self.words.get(key, {})
            if meanings and not (length == 1 and self._is_adverb(k, meanings)):
                return self._known(k, length, meanings)
        return self._plain_word(k, end)

    def _has_such(self, k: int) -> int:
        """Read a word such as four-bladed or orange-handled."""
        word = self.tokens[k].text
        stems = (word[:-2], word[:-1], word[:-3]) if word.endswith("ed") and word not in _DONE else ()
        noun = next((stem for stem in stems if (lemma(stem),) in self.words), "")
        if not noun or not self.waiting.keys() & {"count", "color", "material"} or _material(word):
            return 0
        self.waiting.pop("article", None)
        self._add(lemma(noun), self.waiting, " ".join([*self.said, word]))
        self.waiting, self.said = {}, []
        return k + 1

    def _is_adverb(self, k: int, meanings: Mapping[str, tuple[str, str]]) -> bool:
        """True for a verb, for a word such as back behind one, and for a side behind a preposition."""
        word, before = self.tokens[k].text, self._text(k - 1)
        several = before != lemma(before) and (lemma(before),) in self.words and "choice" not in meanings
        if f"{word} {self._text(k + 1)}" in COLOR_WORDS or (word in _MOTIONS and (before in _VERBAL or several)):
            return True
        return (word in _WHERE_TO and (before in _MOTIONS or before in _DONE)) or (
            word in _SIDES and self._is_placed(k)
        )

    def _is_placed(self, k: int) -> bool:
        before = self._text(k - 1)
        places = ("on", "at", "along")
        return before in places or (before in ("the", "its", "their") and self._text(k - 2) in places)

    def _known(self, k: int, length: int, meanings: Mapping[str, tuple[str, str]]) -> int:
        words = " ".join(item.text for item in self.tokens[k : k + length])
        after = k + length
        counted = "count" in self.waiting or words != lemma(words)
        if "length" in meanings:
            j = next(
                (j for j in range(after, min(after + 3, len(self.tokens))) if self._text(j) not in ("of", "is", ":")),
                after,
            )
            if j < len(self.tokens) and self.tokens[j].kind == "quantity":
                self._take(meanings["length"][0], _values(self.tokens[j].text)[0][0], words)
                return j + 1
            if "bare" in self.waiting:
                self._take(meanings["length"][0], self.waiting.pop("bare")[0], words)
                self.said.clear()
                return after
        if "choice" in meanings and not (meanings.get("part", ("", ""))[0] and counted):
            name, value = meanings["choice"]
            if self.waiting.pop("without", False):
                value = "no" if value == "yes" else "none"
            self._take(name, value, words)
            if self._noun_follows(after):
                return after
            if "count" in self.waiting and _counted(self.family, first := words.split()[0]) is not None:
                self._add(lemma(first), {"count": self.waiting.pop("count")}, words)  # a three finger gripper
            if "count" in self.waiting and name != "handle":
                self.guessed[noun := " ".join(key_of(words))] = f"{self.waiting['count']} {words}"
                self._add(noun, {"count": self.waiting.pop("count")}, words)
            self.unread += [str(count)] if (count := self.waiting.pop("count", 1)) != 1 else []
            for look in ("color", "material") if name == "handle" else ():
                if look in self.waiting:
                    self.values[f"handle_{look}"] = self.waiting.pop(look)
            self._settle(self._owner())
            self.subject, self.fresh = " ".join(key_of(words)), False
            return after
        follows = after < len(self.tokens) and "part" in self.words.get((lemma(self._text(after)),), {})
        if follows and words == lemma(words) and self._text(after) not in _MOTIONS:  # a burner knob
            self.harmless.append(words)
        else:
            self._place_or_noun(k, words, guessed=False)
        return after

    def _place_or_noun(self, k: int, words: str, *, guessed: bool) -> None:
        """Read a noun, which may only say where something else is: on the panel."""
        place = "count" not in self.waiting and self._text(k - 1) in ("the", "its", "their")
        if place := place and self._text(k - 2) in _AT and bool(self.subject):
            self._settle(self.subject)
        self._noun(" ".join(key_of(words)), words, guessed=guessed or place, is_place=place)

    def _plain_word(self, k: int, end: int) -> int:
        readers = (self._has_such, self._look, self._having, self._state, self._place, self._filler)
        return next((after for read in readers if (after := read(k))), 0) or self._unknown(k, end)

    def _look(self, k: int) -> int:
        word = self.tokens[k].text
        color = two if (two := f"{word} {self._text(k + 1)}") in COLOR_WORDS else word
        if color in COLOR_WORDS:
            self._wait("color", color, COLOR_WORDS[color])
            return k + len(color.split())
        if word in ("dark", "light") and _material(self._text(k + 1)):
            self.harmless.append(word)
            return k + 1
        if not _material(word) or (word in ("mirror", "iron", "paper") and not self._noun_follows(k + 1)):
            return 0
        self._wait("material", word, _material(word))
        return k + 1

    def _having(self, k: int) -> int:
        word = self.tokens[k].text
        if word not in _HAVING and word not in ("without", "no", "lacking"):
            return 0
        each = self._text(k - 1) == "each" and word in _HAVING
        self.times = self.parts.get(self.subject, {}).get("count", 1) if each else 1
        self._settle(self._owner())
        if word in _HAVING:
            self.fresh = False
        else:
            self.waiting["without"] = True
        return k + 1

    def _state(self, k: int) -> int:
        word, after = self.tokens[k].text, self._text(k + 1)
        if word in _DEGREES and (after in _DONE or word == "halfway"):
            if self._then_measured(k + 1):
                return k + 1
            shut = after in ("closed", "shut") and word == "fully"
            self._wait("open", f"{word} {after}", 0.0 if shut else _DEGREES[word])
            return k + 2 + (self._text(k + 2) in _WHERE_TO)
        if word in _DONE and self._text(k - 1) in _VERBAL:
            self._wait("motion", word, "move")
        elif word in _DONE:
            if not self._then_measured(k + 1):
                self._wait("open", word, _DONE[word])
            return k + 1 + (after in _WHERE_TO)
        elif (
            word in ("tilt", "pan", "lift", "swing")
            and self._text(k - 1) in ("whose", "its", "the", "a")
            and after not in _WHERE_TO
        ):
            self._noun(word, word, guessed=True)
        elif word in _MOTIONS and word not in ("hinged", "hinges", "hinge"):
            self._wait("motion", word, _MOTIONS[word])
        else:
            return 0
        return k + 1

    def _place(self, k: int) -> int:
        word = self.tokens[k].text
        if word in _DIMENSIONS:
            return self._dimension(k)
        if word in _ABOVE or word in _BELOW:
            return self._relate(k)
        if word in ("hinged", "hinges", "hinge"):
            if place := re.match(
                r"(?:(?:on|at|along|from|to) )?(?:(?:the|its) )?(left|right|top|bottom|front|back)\b", self._rest(k + 1)
            ):
                self._wait("hinge", f"{word} {place[0]}", place[1])
                after = k + 1 + len(place[0].split())
                return after + (self._text(after) in ("side", "edge"))
            self._wait("motion", word, "hinge")
            return k + 1
        if word in _SIDES or word in _ORDINALS:
            return self._side(k)
        return self._beside(k) if word == "side" and self._text(k + 1) == "by" else 0

    def _filler(self, k: int) -> int:
        word, after = self.tokens[k].text, self._text(k + 1)
        if word in _WHERE_TO - _SAYS_NOTHING:
            near = {self._text(j) for j in range(k - 3, k)}
            self.unread += [] if near & {*_MOTIONS, *_DONE, *_WHERE_TO, "pull", "roll", "push"} else [word]
        elif word in _SAYS_NOTHING | _REFERS | _STROKES:
            if word == "and" and not (after in COLOR_WORDS or _material(after) or after in _WHERE_TO):
                self._settle(self._owner())
            if word in ("a", "an"):
                self.waiting.setdefault("article", True)
            if word in ("whose", "which", "that"):
                self._settle(self._owner())
            self.fresh = self.fresh and word not in _REFERS - {"all"}
        elif word in _NO_NOUNS:
            self.unread += [f"{self.waiting.pop('count')} {word}"] if "count" in self.waiting else []
            self.waiting.pop("article", None)
        elif word in _PLAIN:
            self.harmless.append(word)
        else:
            return 0
        return k + 1

    def _unknown(self, k: int, end: int) -> int:
        """Words that are not known: a noun of a part if one is expected, which the object tells."""
        last = k + 1
        while last < end and self.tokens[last].kind == "word" and not self._is_read(last):
            last += 1
        words = " ".join(item.text for item in self.tokens[k:last])
        before = self._text(k - 1)
        expected = self.waiting.keys() - {"color", "material"} or before in (
            *_HAVING,
            "and",
            "whose",
            "its",
            "the",
            ",",
        )
        follows = last < end and "part" in self.words.get((lemma(self.tokens[last].text),), {})
        if expected and not follows and before not in _VERBAL and k >= self.stop:
            self._place_or_noun(k, words, guessed=True)
        else:
            self.unread.append(words)
        return last

    def _is_read(self, k: int) -> bool:
        word = self.tokens[k].text
        known = (
            word in _SAYS_NOTHING | _HAVING | _REFERS | _WHERE_TO | _ABOVE | _BELOW
            or word in COLOR_WORDS
            or _material(word)
        )
        return bool(known) or word in {*_MOTIONS, *_DONE, *_SIDES, *_NUMBERS} or (lemma(word),) in self.words

    # ---- attributes ------------------------------------------------------------------------------------------------

    def _wait(self, what: str, words: str, value: Any) -> None:
        if self.waiting.setdefault(what, value) != value and value != "move":
            self.unread.append(words)
        else:
            self.said.append(words)

    def _take(self, name: str, value: Any, words: str) -> None:
        """Set a parameter of the whole."""
        try:
            value = checked(self.family, name, value)
        except InputError as error:
            self.faults.append(f"{words}: {str(error).rstrip('.')}")
            return
        if self.values.setdefault(name, value) != value:
            self.unread.append(words)

    def _settle(self, owner: str) -> None:
        """Give what waits to a part, or to the whole."""
        facts, said = self.waiting, " ".join(self.said)
        self.waiting, self.said = {}, []
        facts.pop("article", None)
        if facts.keys() & {"without", "count", "pick", "bare"}:
            self.unread.append(said or "without")
        elif owner and facts:
            self._add(owner, facts, said)
        else:
            for what, value in facts.items():
                self._whole(what, value, said)

    def _whole(self, what: str, value: Any, said: str) -> None:
        if what == "size":
            for name, size in value.items():
                if self.sizes.setdefault(name, size) != size:
                    raise InputError(
                        f"The text says that the {name} is {self.sizes[name]:g} m and {size:g} m. Say one."
                    )
        elif what in ("color", "material"):
            self._take(what, value, said)
        elif what == "open":
            unit = value[1] if isinstance(value, tuple) else ""
            self._take({"rad": "open_angle", "m": "open_distance", "": "open"}[unit], value[0] if unit else value, said)
        elif what == "hinge":
            sided = any(item.name == "hinge_side" for item in self.family.parameters)
            self._add("door", {what: value}, said) if not sided else self._take("hinge_side", value, said)
        elif what == "motion":
            self.moves.append((value, said))
        elif what == "range":
            self._add("hinge" if "deg" in said or "rad" in said or "°" in said else "slide", {what: value}, said)
        else:
            self.unread.append(said)

    def _add(self, noun: str, facts: Mapping[str, Any], said: str) -> None:
        own = self.parts.setdefault(noun, {})
        if noun in self.guessed and said not in self.guessed[noun]:
            self.guessed[noun] += f" {said}"
        if noun in self.implied and "count" in facts:
            self.implied.discard(noun)
            own.pop("count", None)
        if "count" in facts and own.get("count", facts["count"]) != facts["count"]:
            if facts.keys() & {"side", "color", "material"} or own.keys() & {"side", "color", "material"}:
                self.unread.append(said)
                return
            if " per " in self.text:  # of each of what is not read
                self.unread.append(said)
                return
            raise InputError(f"The text says {own['count']} and {facts['count']} of {noun!r}. Say one.")
        for name, value in facts.items():
            if name == "size":
                own["size"] = {**own.get("size", {}), **value}
            elif own.setdefault(name, value) != value and "move" not in (own[name], value):
                self.unread.append(said)

    def _noun(self, noun: str, words: str, *, guessed: bool = False, is_place: bool = False) -> None:
        facts, said = self.waiting, " ".join([*self.said, words])
        self.waiting, self.said = {}, []
        before_name = self.is_before
        pick = facts.pop("pick", "")
        article = facts.pop("article", False) and "count" not in facts
        without = facts.pop("without", False)
        if (before_name and "count" not in facts) or "bare" in facts or (without and noun in _NO_PARTS):
            self.unread.append(words if before_name else said)
            self.waiting = {name: facts[name] for name in ("color", "material") if name in facts and before_name}
            return
        if before_name:
            self.waiting = {name: facts.pop(name) for name in ("color", "material") if name in facts}
        noun = f"{pick} {noun}".strip()
        if without:
            facts["count"] = 0
        elif "count" not in facts and not pick and noun not in self.parts:
            head = words.rsplit(maxsplit=1)[-1]
            if lemma(head) != head:
                facts["at_least"] = 2
                counted = _counted(self.family, noun)
                facts |= {"count": 2} if counted is not None and not counted.default else {}
            elif article:
                facts["count"] = 1
        elif facts.get("count") == 1 and pick:
            del facts["count"]
        if "count" in facts:
            facts["count"] *= self.times
        if guessed and noun not in self.parts:
            self.guessed[noun] = said
        self._add(noun, facts, said)
        if article:
            self.implied.add(noun)
        if self.relation is not None:
            self._rows(self.relation[0], noun, self.relation[1])
            self.relation = None
        if not before_name and not is_place:
            self.subject, self.fresh = noun, False

    def _dimension(self, k: int) -> int:
        name = _DIMENSIONS[self.tokens[k].text]
        if self.waiting.get("bare", (0.0, ""))[1] == "m":
            self.waiting.setdefault("size", {})[name] = self.waiting.pop("bare")[0]
            return k + 1
        for j in range(k + 1, min(k + 4, len(self.tokens))):
            if self.tokens[j].kind == "quantity" and (values := _values(self.tokens[j].text))[0][1] == "m":
                self.waiting.setdefault("size", {})[name] = values[0][0]
                self.said.append(self.tokens[j].text)
                return j + 1
            if self._text(j) not in ("of", "is", ":", "=", "a"):
                break
        self.harmless.append(self.tokens[k].text)
        return k + 1

    def _measure(self, k: int) -> int:
        """Read a size, a range or an opening."""
        token = self.tokens[k]
        numbers = _values(token.text)
        value, si = numbers[-1]
        if token.kind == "dims" and not si:
            rows, columns = int(numbers[0][0]), int(value)
            self._wait("count", token.text, rows * columns)
            self.waiting["grid"] = (columns, rows)
            return k + 1 + (self._text(k + 1) == "grid") + (self._text(k + 2) == "of")
        if token.kind == "dims":
            flat = not any(item.name == "depth" for item in self.family.parameters)
            names = ("width", "height") if len(numbers) == 2 and flat else ("width", "depth", "height")
            self.waiting.setdefault("size", {}).update(zip(names, (number for number, _ in numbers), strict=False))
            self.said.append(token.text)
            return k + 1
        behind = _SYMMETRIC.match(self._rest(k + 1))
        verb = self._verb(k)
        if token.kind == "range":
            low = numbers[0][0]
            self._wait("range", token.text, (0.0, value - low) if si == "m" and low > 0.0 else (low, value))
        elif token.kind == "both" or behind:
            self._wait("range", token.text, (-value, value))
        elif verb == "state":
            self._wait("open", token.text, (value, si))
        elif verb == "motion" and self._text(k + 1) not in _DIMENSIONS:
            self._wait("range", token.text, (min(value, 0.0), max(value, 0.0)))
        else:
            self.waiting["bare"] = (value, si)
            self.said.append(token.text)
            return k + 1 + (self._text(k + 1) == "in" and self._text(k + 2) == "diameter")
        return k + 1 + (len(behind[0].split()) if behind else 0)

    def _verb(self, k: int) -> str:
        """What a quantity says: a ``state``, a ``motion`` or neither, by the nearest verb before it in the clause."""
        for j in range(k - 1, max(k - 7, self.stop - 1), -1):
            word = self.tokens[j].text
            verbal = word in _MOTIONS or word in _DONE
            if self.tokens[j].kind != "word" or word in _HAVING or (not verbal and (lemma(word),) in self.words):
                return ""
            can = any(self._text(i) in ("can", "may", "could", "to", "that", "which") for i in range(j - 3, j))
            if word in _DONE and not (can and (word == "open" or self._text(j - 1) == "be")):
                return "state"
            if verbal or word in _STROKES:
                return "motion"
        return ""

    def _then_measured(self, k: int) -> bool:
        j = k
        while self._text(j) and self._text(j) in _SAYS_NOTHING | _WHERE_TO:
            j += 1
        return j < len(self.tokens) and self.tokens[j].kind == "quantity" and self._text(j + 1) not in _DIMENSIONS

    # ---- places ----------------------------------------------------------------------------------------------------

    def _side(self, k: int) -> int:
        word, before, after = self.tokens[k].text, self._text(k - 1), self._text(k + 1)
        if word in _OPPOSITE and after == "of" and self.subject:
            self._wait("side", word, word)
            self._settle(self.subject)
            self.waiting["side"] = _OPPOSITE[word]
        elif word in _OPPOSITE and after == "hinged":
            self._wait("hinge", word, word)
            return k + 2
        elif word in _ORDINALS or (not self._is_placed(k) and self._noun_follows(k + 1)):
            self._wait("pick", word, word)
        elif word == "underneath" or self._is_placed(k):
            leads = self.fresh or not self.subject
            self._wait("side", word, _SIDES[word])
            step = k + 1 + (after in ("side", "hand", "end")) + (self._text(k + 2) == "side")
            if not leads:
                self._settle(self.subject)
            elif not self._noun_follows(step):
                self.unread.append(f"on the {word}")
                del self.waiting["side"]
            return step
        elif before in ("a", "an", "the", "whose", "its", *_HAVING) and self._text(k - 2) not in ("to", "from", "in"):
            self._noun(word, word, guessed=True)
        elif before not in _MOTIONS:
            self.unread.append(word)
        return k + 1

    def _noun_follows(self, k: int) -> bool:
        for j in range(k, min(k + 4, len(self.tokens))):
            word = self.tokens[j].text
            if "part" in self.words.get((lemma(word),), {}):
                return True
            looks = (
                word in COLOR_WORDS or word in _NUMBERS or word in _MOTIONS or word in ("a", "an") or _material(word)
            )
            if not (looks or self.tokens[j].kind == "number"):
                return self.tokens[j].kind == "word" and j == k and not self._is_read(j) and word not in _PLAIN
        return False

    def _relate(self, k: int) -> int:
        step, after = 1 if self.tokens[k].text in _ABOVE else -1, self._text(k + 1)
        others = [noun for noun in self.parts if noun != self.subject]
        back = after in _REFERS or not after or self.tokens[k + 1].kind == "sign" or after == "and"
        if not self.subject or (back and not others):
            self.unread.append(self.tokens[k].text)
            return k + 1
        self._settle(self.subject)
        if back:
            self._rows(self.subject, others[-1], step)
        else:
            self.relation = (self.subject, step)
        return k + 1 + (after in _REFERS)

    def _rows(self, one: str, other: str, step: int) -> None:
        """Put one part above (1) or below (-1) another."""
        mine, its = (self.parts[noun].get("row") for noun in (one, other))
        row = mine or ((its - step) if its else 10)
        self.parts[one]["row"] = row
        self.parts[other].setdefault("row", row + step)

    def _grid(self, k: int, number: int) -> bool:
        """Read in two columns, in three rows."""
        word, count = self._text(k + 1), self.parts.get(self.subject, {}).get("count", 0)
        if (
            word not in ("columns", "column", "rows", "row")
            or not self._cell(self.subject)
            or not number
            or count % number
        ):
            return False
        columns = number if word.startswith("column") else count // number
        self.parts[self.subject]["grid"] = (columns, count // columns)
        return True

    def _beside(self, k: int) -> int:
        own = self.parts.get(self.subject, {})
        if self._text(k + 2) == "side" and self._cell(self.subject) and own.get("count"):
            own["grid"] = (own["count"], 1)
        else:
            self.unread.append("side by side")
        return k + 3

    def _cell(self, noun: str) -> str:
        """The field of a layout that a noun means; empty if the kind has no layout, or none of the noun."""
        counted = _counted(self.family, noun) if any(item.name == "layout" for item in self.family.parameters) else None
        own = "" if counted is None else lemma(counted.name)
        return own if own in CELLS else ""

    def _lay_out(self) -> None:
        """Write the layout of a front whose fields are placed; fields that are not named are left out."""
        counted = {lemma(item.name): item for item in self.family.parameters if isinstance(item.default, int)}
        fields = {noun: cell for noun in self.parts if (cell := self._cell(noun))}
        if not fields:
            return
        if any(cell != "shelf" and self.parts[noun].get("count") != 0 for noun, cell in fields.items()):
            named = any("count" in self.parts[noun] for noun in fields)
            for cell, item in counted.items():
                if cell in CELLS and cell not in fields.values() and named:
                    self.values.setdefault(item.name, 0)
        placed = {
            noun: self.parts[noun].keys() & {"row", "grid"} or self.parts[noun].get("side") in _OPPOSITE
            for noun in fields
        }
        if not any(placed.values()) or "layout" in self.values:
            return
        columns: dict[str, list[tuple[int, str]]] = {}
        for noun, cell in fields.items():
            part = self.parts[noun]
            count = part.get("count", counted[cell].default or 2)
            text = _grid(cell, *part["grid"]) if "grid" in part else f"{count}*{cell}" if count != 1 else cell
            if count:
                columns.setdefault(part["side"] if part.get("side") in _OPPOSITE else "", []).append(
                    (part.get("row", 10), text)
                )
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
        rows = sorted({part["row"] for part in self.parts.values() if "row" in part})
        parts = {}
        for noun, part in self.parts.items():
            if part.get("count") == 0 and part.keys() - {"count", "at_least", "row"}:
                raise InputError(f"The text says that there is no {noun}, and what it is like. Say one.")
            if part.pop("grid", None) and not self._cell(noun):
                self.unread.append(f"grid of {noun}")
            row = {"row": rows.index(part["row"]) + 1} if "row" in part else {}
            parts[noun] = PartRequest.model_validate({**part, **row})
        counted = {item.name for noun in parts if (item := _counted(self.family, noun))} if parts else set()
        usual = {name: value for name, value in self.usual.items() if name not in counted}
        request = Request(
            kind=self.family.name,
            parameters={**usual, **self.values},
            size=self.sizes,  # type: ignore[arg-type]  # by names of `_DIMENSIONS`
            parts=parts,
            copies=self.copies,
            instead_of=self.instead_of,
        )
        self.request = request.checked()

    def made(self, *, seed: int | None = None) -> BuildResult:
        """Build the object and measure it.

        Raises:
            InputError: Nothing can be built.
        """
        made = deliver(self.request, seed=seed)
        lost = [noun for noun in made.missing if noun in self.guessed]
        listed = [why for why in made.differences if not any(why.startswith(f"{noun}: a") for noun in lost)]
        joints = [joint for joint in made.blueprint.joints if joint.mimic is None]
        unread = [*self.unread, *(self.guessed[noun] for noun in lost)]
        unread += [said for motion, said in self.moves if not all(moves_so(joint, motion) for joint in joints)]
        names = (*self.family.words, *(part.name.replace("_", " ") for part in made.blueprint.parts))
        own = {key for name in names for key in key_of(name)} - {*_SIDES}
        return replace(
            made,
            differences=(*self.faults, *listed),
            unread=tuple(words for words in unread if words and not set(key_of(words)) <= own),
            harmless=tuple(self.harmless),
            notes=tuple(self.notes),
            facts={"text": self.text, **made.facts},
        )

    def _text(self, k: int) -> str:
        return self.tokens[k].text if 0 <= k < len(self.tokens) else ""

    def _rest(self, k: int) -> str:
        return " ".join(token.text for token in self.tokens[k : k + 6])


def _values(text: str) -> list[tuple[float, str]]:
    """Numbers of a text in metres or radians, each with its unit or that of the last one."""
    found = re.findall(rf"([-−]?{_NUMBER})(?: ?({_UNIT})(?![a-z]))?", text)
    scales = {unit: (scale, "m") for unit, scale in UNITS.items()} | {
        unit: (scale, "rad") for unit, scale in ANGLES.items()
    }
    last = scales.get(found[-1][1], (1.0, ""))
    read = []
    for number, unit in found:
        scale, si = scales.get(unit, last)
        read.append((scale * float(number.replace(",", ".").replace("−", "-")), si))
    return read


def _material(word: str) -> str:
    return next((name for name, substance in MATERIALS.items() if word in (name, *substance.words)), "")


def _counted(family: Family, noun: str) -> Parameter | None:
    """The parameter that counts parts of a noun, where it may have several values."""
    for item in family.parameters:
        names = {key_of(word) for word in (*nouns_of(item), item.name)}
        if isinstance(item.default, int) and key_of(noun) in names and item.bounds and item.bounds[0] < item.bounds[1]:
            return item
    return None


def _grid(kind: str, columns: int, rows: int) -> str:
    row = " | ".join([kind] * columns)
    return " / ".join([f"({row})" if columns > 1 else kind] * rows)


def _vocabulary(family: Family) -> dict[tuple[str, ...], dict[str, tuple[str, str]]]:
    """Words of a kind -> what they may mean: a ``part``, or a ``length`` or ``choice`` with parameter and value."""
    found: dict[tuple[str, ...], dict[str, tuple[str, str]]] = {(noun,): {"part": ("", "")} for noun in _PARTS}
    said = [
        (word, "part", ("own", ""))
        for stem, others in family.part_words.items()
        for word in (stem.replace("_", " "), *others)
    ]
    for item in family.parameters:
        if isinstance(item.default, int):
            said += [(word, "part", ("own", "")) for word in nouns_of(item)]
        elif item.unit == "m":
            said += [
                (word, "length", (item.name, "")) for word in nouns_of(item) if word not in {*_DIMENSIONS, *_SIDES}
            ]
        said += [(word, "choice", (item.name, value)) for word, value in _choices(item)]
    for word, what, meaning in said:
        found.setdefault(key_of(word), {})[what] = meaning
    return found


def _choices(item: Parameter) -> Iterator[tuple[str, str]]:
    if item.name in ("modeling", "layout", "style") or not item.choices:
        return
    name = item.name.replace("_", " ")
    if "yes" in item.choices or ("none" in item.choices and len(item.choices) == 2):
        yield from (
            (word, next(value for value in item.choices if value not in ("no", "none"))) for word in (name, *item.words)
        )
    for choice in item.choices:
        plain = () if choice in _AMBIGUOUS or not choice else (choice, f"{choice} {name}")
        yield from ((word, choice) for word in (*plain, *item.choice_words.get(choice, ())))
