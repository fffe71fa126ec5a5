"""Words of a sentence: tokens, numbers, units, singulars."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.language.motions import MOTIONS

if TYPE_CHECKING:
    from collections.abc import Iterable

MAX_WORDS = 200
"""Longer texts are no description of one object."""
NUMBERS = {
    "no": 0, "without": 0, "zero": 0, "a": 1, "an": 1, "one": 1, "single": 1, "two": 2, "pair": 2, "couple": 2,
    "double": 2, "twin": 2, "both": 2, "three": 3, "triple": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8,
    "nine": 9, "ten": 10, "eleven": 11, "twelve": 12, "dozen": 12, "thirteen": 13, "fourteen": 14, "fifteen": 15,
    "sixteen": 16, "seventeen": 17, "eighteen": 18, "nineteen": 19, "twenty": 20, "thirty": 30, "forty": 40,
    "fifty": 50, "hundred": 100, "thousand": 1000, "million": 1_000_000, "billion": 1_000_000_000,
}  # fmt: skip
"""Number words; `a` and `an` count only before something that can be counted."""
ARTICLES = ("a", "an")
KINDS = ("double", "twin", "triple")
"""Before the name of an object they say its kind, not how many: a double oven is no two ovens."""
UNITS = {
    "mm": 1e-3, "millimetre": 1e-3, "millimeter": 1e-3, "cm": 1e-2, "centimetre": 1e-2, "centimeter": 1e-2,
    "dm": 0.1, "m": 1.0, "metre": 1.0, "meter": 1.0, "km": 1e3, "kilometre": 1e3, "kilometer": 1e3, "inch": 0.0254,
    "inche": 0.0254, "in": 0.0254, "foot": 0.3048, "feet": 0.3048, "ft": 0.3048,
}  # fmt: skip
"""Metres per unit."""
OPENNESS = {"closed": 0.0, "shut": 0.0, "folded": 0.0, "ajar": 0.15, "open": 1.0, "opened": 1.0, "unfolded": 1.0}
"""Words for a state, and the share of the way that they mean by themselves."""
_PURPOSE_TEXT = """
    burner cash crisper cutlery detergent emergency freezer glove main power soap start stop storage vegetable volume
    battery mail coin card ticket cable cup bottle spice fuse inspection service access charging dust filter ash crumb
    drip bread laundry trash book wine toy cat dog pet engine water paper tool food feed paint letter
    flush speed air focus tuning brake gear power heat temperature timer mode gas fuel drain feed safety parking
    release reset control measuring sample alarm brightness program rinse
    countertop tabletop benchtop cupboard child children kid kids
"""
PURPOSES = frozenset(_PURPOSE_TEXT.split())
"""What a part is for, right before its noun; it asks for nothing that could be built differently."""
NOUNS = {"handle": ("pull", "grip")}
"""How people call what several families have a parameter for, besides its name."""
CHOICES: dict[str, dict[str, tuple[str, ...]]] = {
    "hinge_side": {
        side: (f"{side} hinged", f"hinged on the {side}", f"hinged {side}", f"hinges on the {side}", f"{side} hinge")
        for side in ("left", "right")
    },
    "handle": {"knob": ("round knob",)},
}
"""How people call the choices of such a parameter."""
_STOP_TEXT = """
    a an the of with and to in on at by for from it its them their that which whose is are has have having i d ll
    we you would like want need please make me give build create generate some any this these those there be
    can could into my our each per every made very quite nice simple standard typical normal ordinary solid old new
    modern gas kitchen living room office bedroom household home bathroom containing featuring including plus
    also just only overall how about show maybe really very lot hello hi hey thanks thank looking one's let draw design
    get
"""
_PLAIN_TEXT = """
    sleek contemporary minimalist minimalistic vintage retro rustic antique classic classical elegant stylish fancy
    cute cozy cosy beautiful pretty lovely cool sturdy robust strong durable solid heavy duty cheap affordable premium
    luxury luxurious professional practical functional handy versatile ergonomic comfortable realistic detailed basic
    regular usual common everyday generic scandinavian victorian farmhouse industrial traditional style styled design
    designed look looking kind type sort brand brushed polished matte glossy shiny painted lacquered varnished worn
    galvanised galvanized
    weathered dusty clean well built good great best high quality lightweight portable electric electrical electronic
    manual home family professional commercial domestic sized size motorized motorised hydraulic pneumatic digital
    outdoor indoor garden patio playground hallway entryway hotel restaurant shop library basement attic nursery
    playroom workshop wireless smart colorful colourful comfy stackable bright japanese swedish danish german british
    italian chinese automatic cordless rechargeable insulated waterproof washable foam padded upholstered handmade
    custom original
"""
PLAIN_WORDS = frozenset(_PLAIN_TEXT.split())
"""What something is like, where that asks for no shape and no motion; reported as of no effect."""
STOP_WORDS = frozenset(_STOP_TEXT.split()) | PLAIN_WORDS
"""Words that ask for nothing that could be built differently; every other word is understood or refused."""

_TOKEN = re.compile(r"\d+(?:[.,]\d+)?(?:e\d+)?|[a-z]+|[,;:.]|[^\sa-z0-9]")
_NUMBERED = re.compile(r"(?:_(?:\d+|left|right))+$")
_BODY_CM = {
    "ankle": 15, "knee": 50, "hip": 90, "waist": 100, "chest": 130, "shoulder": 145, "head": 175, "man": 175,
    "ceiling": 240, "floor to ceiling": 240, "desk": 75, "table": 75, "counter": 90,
}  # fmt: skip
"""What people measure heights by."""
_WRITTEN = (
    (r"['’](?:m|re|ve|s)\b", ""),
    (r"(?<=s)['’](?=\s)", ""),
    (r"\bw/o\b", "without"),
    (r"\bw/", "with"),
    ("&", "and"),
    (r"\bcarrying(?= handle)", "carry"),
    (r"\b(?:one|each)? ?(?:above|below|under|over|on top of) (?:the|each|one) (?:other|another)\b", "stacked"),
    (r"\b(in|on|of|for|to) both\b(?! sides)(?= \w+s\b)", r"\1 each"),
    *((rf"\b{body}[ -](?:high|tall)\b", f"{cm} cm tall") for body, cm in _BODY_CM.items()),
    (r"\b(?<!garage )(doors?|shutters?) (?:that|which) (?:can )?rolls? up\b", r"roll up \1"),
    (r"\b(?:at (?:the )?(?:most|least)|no (?:more|less|fewer) than|exactly|precisely)\b", ""),
    (r"\b(doors?|panels?|windows?|lids?|shutters?) (?:that|which) (?:can )?slides?(?: open)?\b", r"sliding \1"),
)
"""Signs that people write for words."""
_DOES = rf"(?:{'|'.join(sorted({*MOTIONS, 'open', 'close', 'lock', 'pull', 'push'}))})\b"
"""Verbs that ask for a motion, and say no purpose."""
_PURPOSE = re.compile(
    r"(?<!look)(?<!looking)(?<!search)(?<!searching)(?<!asking)(?<!wish)\s(?:for (?!sliding|opening|turning|moving)"
    r"|to (?:keep|store|put|hold|carry|use|hang|sit|cook|play|work|make|sort|hide|collect|display|serve|read)\b"
    rf"|(?:that|which) (?:i|we|you|my|kids|people|one) (?:can|could|may|use|put|keep|want|need)\b(?! {_DOES})"
    r"|where (?:i|we|you|my)\b)"
    r"[^,;.:]*?(?=\s*(?:$|[,;.:]|\b(?:with|and|that|which|having|whose|has|featuring|including|made|on|in)\b))",
    re.IGNORECASE,
)
_MANNER = re.compile(
    r"\b(?:in )?(?:an? )?[\w.]+[ -](?:style|styled|fashioned)\b|\bfree[ -]?standing\b"
    r"|\b(?:wall|floor|ceiling)[ -]mounted\b",
    re.IGNORECASE,
)
_ROUGHLY = (
    "big", "large", "huge", "small", "little", "tiny", "mini", "wide", "narrow", "tall", "long", "short", "deep",
    "shallow", "slim",
)  # fmt: skip
"""Sizes of parts without a number; parts have the sizes that fit."""
_NO_UNIT = "".join(
    rf"(?<!\b{unit} )" for unit in ("cm", "mm", "m", "metre", "metres", "meter", "meters", "inch", "feet")
)
_ROUGH_PART = re.compile(
    rf"(?<![\d.]){_NO_UNIT}\b(?P<size>(?:{'|'.join(_ROUGHLY)})\s+)(?P<noun>[a-z]+)\b", re.IGNORECASE
)
_HAVING = re.compile(r"(\b(?:with|having|has|featuring|including|plus)\b|,)", re.IGNORECASE)
_IRREGULAR = {"leaves": "leaf", "shelves": "shelf", "knives": "knife", "feet": "foot",
              "halves": "half", "wolves": "wolf", "axes": "axis", "dice": "die",
              "knobs": "knob", "glasses": "glasses"}  # fmt: skip
_ONLY_PLURAL = frozenset({
    "scissors", "pliers", "tongs", "shears", "tweezers", "binoculars", "headphones", "nippers", "scales", "stairs",
    "goggles", "chess", "lens", "bus", "gas", "canvas", "glasses", "sunglasses", "eyeglasses", "spectacles", "forceps",
})  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Token:
    """One word, number or sign."""

    text: str
    """As it is read: lower case, singular."""
    given: str
    """As it was written, in lower case."""

    @property
    def number(self) -> float | None:
        """Its value, if it is a number or a number word."""
        if self.text in NUMBERS:
            return float(NUMBERS[self.text])
        try:
            return float(self.text.replace(",", "."))
        except ValueError:
            return None

    @property
    def is_sign(self) -> bool:
        """True for punctuation."""
        return not self.text[0].isalnum() and self.number is None


def without_purposes(sentence: str, asking: frozenset[str]) -> tuple[str, tuple[str, ...]]:
    """Leave out what something is for and like: `for my kitchen`, `to keep shoes in`, `retro-style`.

    Args:
        sentence: What somebody asks for.
        asking: Nouns, singular, that ask for something to be built: `for a sliding drawer` stays.

    Returns:
        What is left, and what was omitted, which asks for no shape and no motion: it has no number and none of these.
    """
    found = [match for match in _PURPOSE.finditer(sentence) if not _asks(match[0], asking) and match.start() > 0]
    found += [match for match in _MANNER.finditer(sentence) if not any(_overlap(match, other) for other in found)]
    found.sort(key=lambda match: match.start())
    for match in reversed(found):
        sentence = f"{sentence[: match.start()]} {sentence[match.end() :]}"
    return sentence, tuple(match[0].strip() for match in found)


def without_rough_sizes(sentence: str, parts: frozenset[str]) -> tuple[str, tuple[str, ...]]:
    """Leave out how large parts are where no number says it: `with two big drawers and a small door`.

    Args:
        sentence: What somebody asks for.
        parts: Nouns, singular, of parts.

    Returns:
        What is left, and what was omitted with the noun that it was said of; sizes of the whole stay.
    """
    whole, having, rest = _HAVING.split(sentence, maxsplit=1) if _HAVING.search(sentence) else (sentence, "", "")
    found = [item for item in _ROUGH_PART.finditer(rest) if singular(item["noun"].lower(), parts) in parts]
    for item in reversed(found):
        rest = rest[: item.start("size")] + rest[item.start("noun") :]
    return f"{whole}{having}{rest}", tuple(f"{item['size'].strip()} {item['noun']}" for item in found)


def _overlap(one: re.Match[str], other: re.Match[str]) -> bool:
    return one.start() < other.end() and other.start() < one.end()


def _asks(clause: str, asking: frozenset[str]) -> bool:
    words = [word for word in clause.lower().split() if word not in ARTICLES]
    return any(word in NUMBERS or singular(word, asking) in asking or any(map(str.isdigit, word)) for word in words)


class Words:
    """A sentence by its words; beyond its ends there are none."""

    def __init__(self, tokens: tuple[Token, ...]) -> None:
        """Keep the words."""
        self.tokens = tokens

    def text(self, k: int) -> str:
        """Word k, empty beyond the ends."""
        return self.tokens[k].text if 0 <= k < len(self.tokens) else ""

    def number(self, k: int) -> float | None:
        """The number at word k, if there is one."""
        return self.tokens[k].number if 0 <= k < len(self.tokens) else None


def tokens_of(sentence: str, vocabulary: Iterable[str]) -> tuple[Token, ...]:
    """Split a sentence into tokens; what a vocabulary has only in the singular is read in the singular.

    Raises:
        InputError: The text is empty, too long, or not written in Latin letters.
    """
    lowered = sentence.lower()
    if re.search(r"\bminus\b|(?:^|\s)-\s?\d", lowered):
        raise InputError(f"The text {_shown(sentence)} asks for a negative number. Give counts and sizes above zero.")
    for sign, word in _WRITTEN:
        lowered = re.sub(sign, f" {word} ", lowered)
    lowered = re.sub(r"\b[1-9]\d{0,2}(?:,\d{3})+\b", lambda number: number[0].replace(",", ""), lowered)
    text = re.sub(r"(?<=\d)x(?=\d)", " x ", lowered.replace("×", " x ").replace("-", " ")).strip()
    if not text:
        raise InputError("The text is empty. Describe an object, e.g. 'a cabinet with two doors above three drawers'.")
    letters = [c for c in text if c.isalpha()]
    if sum(c.isascii() for c in letters) < 0.8 * len(letters) or not letters:
        raise InputError(
            f"The text {_shown(sentence)} is not English as far as can be seen. Describe the object in English."
        )
    found = _TOKEN.findall(text)
    if len(found) > MAX_WORDS:
        raise InputError(
            f"The text has {len(found)} words; at most {MAX_WORDS} describe one object. Say the kind of object, what "
            "it has and how large it is."
        )
    known = frozenset(vocabulary)
    read = [singular(word, known) for word in found]
    return tuple(Token(text=word, given=given) for word, given in zip(read, found, strict=True))


def lemma(word: str) -> str:
    """Return the singular of an English noun, by its ending."""
    if word in _IRREGULAR or len(word) < 4 or word.endswith(("ss", "us", "is")) or word in _ONLY_PLURAL:
        return _IRREGULAR.get(word, word)
    if word.endswith("ies"):
        return f"{word[:-3]}y"
    if word.endswith(("ches", "shes", "xes", "sses")):
        return word[:-2]
    return word.removesuffix("s")


def nouns_in(word: str) -> tuple[str, ...]:
    """Nouns, singular, that a word may be of: `wheels`, `wheeled`, `legged`, `handled`."""
    stem = word.removesuffix("ed")
    return (lemma(word), stem, f"{stem}e", stem[:-1]) if stem != word else (lemma(word),)


def stem_of(name: str) -> str:
    """A part's name without its number and its side."""
    return _NUMBERED.sub("", name)


def singular(word: str, known: frozenset[str]) -> str:
    """Return the singular of a plural that the vocabulary has only in the singular."""
    if word in known or word in STOP_WORDS or word in NUMBERS:
        return word
    for candidate in (
        _IRREGULAR.get(word, ""),
        word.removesuffix("s"),
        word.removesuffix("es"),
        word.removesuffix("ed"),
    ):
        if candidate and (candidate in known or candidate in UNITS):
            return candidate
    return word


def _shown(sentence: str) -> str:
    return repr(sentence if len(sentence) < 80 else sentence[:77] + "...")
