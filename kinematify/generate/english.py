"""English as it is written: spelling, numbers with units, and what words mean, for a kind and for all."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.kind_search import key_of, words_of
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS
from kinematify.generate.request import ANGLES, UNITS, in_si

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.parameter import Parameter

LONGEST = 200
"""Words at most."""
_TABLE = """
number 0: zero
number 1: one single
number 2: two pair couple double twin dual
number 3: three triple
number 4: four
number 5: five
number 6: six
number 7: seven
number 8: eight
number 9: nine
number 10: ten
number 11: eleven
number 12: twelve dozen
number 13: thirteen
number 14: fourteen
number 15: fifteen
number 16: sixteen
number 17: seventeen
number 18: eighteen
number 19: nineteen
number 20: twenty
number 30: thirty
number 40: forty
number 60: sixty
number 90: ninety
dimension width: width wide broad
dimension depth: deep depth
dimension height: height high tall
dimension length: length long
dimension diameter: diameter across wingspan
dimension thickness: thickness thick
side left: left
side right: right
side front: front
side back: back rear
side top: top upper
side bottom: bottom lower underside underneath
ordinal: first second third fourth fifth sixth
relation 1: above over
relation -1: below under beneath
motion move: move moves moving open opens opening close closes closing lift lifts lifting raise raises go goes going
motion move: come comes travel travels travelling traveling adjust adjusts press presses extend extends extending
motion move: movable moveable adjustable raisable raising drops rises rise rising falls removable detachable lowers
motion slide: slide slides sliding pull pulls roll telescope telescopes telescopic telescoping retract retracts
motion slide: retractable
motion hinge: swing swings swinging pivot pivots pivoting pivoted fold folds folding foldable flip flips flipping turn
motion hinge: turns turning rotate rotates rotating rotatable drop tip tips tipping oscillates oscillating
motion hinge: bends curls steers spread spreads leans hinged hinges hinge
motion spin: spin spins spinning revolve revolves revolving
motion tilt: tilt tilts tilting recline reclines reclining rocks rocking
motion pan: yaws pan pans panning swivel swivels swiveling swivelling
state 0: closed shut
state 0.15: ajar
state 1: open opened pulled pushed propped raised lowered lifted tilted turned swung extended drawn moved folded rotated
degree 0.5: half partly halfway half_way midway
degree 0.15: slightly
degree 1: fully wide completely
where: up down out in back forward forwards outward outwards inward away open upwards downwards off through round
stroke: travel stroke range way opening throw
having: with having has have featuring including plus containing holding
without: without no lacking
refers: it its they them their that which whose each both all every
ends: on made where mounted standing next and in for at to from by as like
verbal: that which can to may all both each be
asks: it they that which can could may to
both: to_either_side to_both_sides to_each_side in_either_direction in_both_directions in_each_direction each_way
both: either_way to_either_direction
place: on at along under to of from into through behind beside near by around inside between
beside row: side_by_side in_a_row
beside column: in_a_column
lines: row rows
lines: column columns
filler: a an the of and to in on at by for from is are be been being can may could must i we you like want need please
filler: make build create generate give show draw design get me us my our your some any this these those there made out
filler: into as so would will let have standing side hand end ends object item thing model piece set also then kind type
filler: sort hi hello hey thanks where when while itself own u about approximately roughly approx around exactly inside
filler: along wants wanted do must plain stacked colour color through between up_to one_of way edge line middle center
filler: whole throughout part parts one
plain: modern sleek contemporary minimalist vintage retro rustic antique classic elegant stylish fancy cute cosy cozy
plain: beautiful pretty lovely nice cool sturdy robust strong durable solid heavy duty professional practical simple
plain: standard typical normal ordinary regular usual common new old good great quality ergonomic comfortable realistic
plain: detailed basic scandinavian victorian industrial traditional brushed polished matte matt glossy shiny painted
plain: lacquered big large huge small little tiny mini narrow short slim compact shallow quite very really just
plain: portable electric electrical household kitchen garden office bathroom bedroom living room hallway workshop hotel
plain: home commercial domestic outdoor indoor style styled wall identical matching freestanding free mounted
plain: independently endlessly freely smoothly easily continuously gently slowly quickly separately individually
plain: daughter son wife husband mother father grandmother child kid friend vertical vertically horizontal
plain: horizontally upright dark light
part: door drawer flap knob button lever caster wheel crank rotor vent lock handle lid tray shelf hook gauge needle dial
part: switch pedal seat leg arm blade window light display screen ladder mirror basket rail bell finger joint cover
part: hatch panel key roller fan gear pulley spring rope bulb stand foot mast boom bucket propeller wing sail visor
part: brake clamp jaw spout tap valve plunger piston rod nozzle hose cable plug socket cap drum turntable platform ramp
part: step armrest headrest footrest backrest handlebar tailgate hood trunk bonnet gripper camera antenna grip
"""
"""What words mean, and the value of that."""
OF_SOME = re.compile(
    r"\b(?:(?:of|except) (?:which|them|these|those)|other|another|except|only|instead|alternat\w+|respectively|others"
    r"|every (?:second|other)|(?:first|second|third|fourth|fifth|sixth|last|topmost|lowest) from|half of|cant|cannot"
    r"|dont|doesnt|isnt|not|never"
    r"|(?:the|while) (?:\w+ )?(?:left|right|top|bottom|first|second|third|fourth|last|"
    r"middle|upper|lower|front|rear|back) (?:one|half))\b"
)
"""Clauses about some of the parts, which are not read."""
_AMBIGUOUS = words_of("none yes no top bottom left right side plain one two four off fixed beside below within")
_NUMBER = r"\d+(?:[.,]\d+)?"
_UNIT = "|".join(sorted((re.escape(word) for word in (*UNITS, *ANGLES) if word != "in"), key=len, reverse=True))
_TIMES = rf" ?(?:x|×|by) ?{_NUMBER}(?: ?(?:{_UNIT})(?![a-z]))?"
_TOKENS = re.compile(
    rf"(?P<dims>{_NUMBER}(?: ?(?:{_UNIT}))?{_TIMES}(?:{_TIMES})?)(?![a-z0-9])"
    rf"|(?P<range>(?:(?:from|between) )?[-−]?{_NUMBER} ?(?:{_UNIT})? ?(?:up |down )?(?:to|and|\.\.) ?"
    rf"\+?[-−]?{_NUMBER} ?(?:{_UNIT}))(?![a-z])"
    rf"|(?P<symmetric>(?:±|\+/-|plus or minus) ?{_NUMBER} ?(?:{_UNIT}))(?![a-z])"
    rf"|(?P<quantity>[-−]?{_NUMBER} ?(?:{_UNIT}))(?![a-z])|(?P<number>{_NUMBER})|(?P<word>[a-z]+)|(?P<sign>[^\sa-z0-9])"
)
_BARE = re.compile(
    rf"(?<![\dx×.-] )\b{_NUMBER}(?= (?:wide|deep|high|tall|long|broad|thick)\b)"
    rf"|from [-−]?{_NUMBER} to ([-−]?{_NUMBER})(?! ?(?:{_UNIT}))\b"
)
"""A size or a range without a unit."""
_PURPOSE = re.compile(
    r"\b(?:for|to (?:store|keep|hold|put|carry|hang|serve|sort|collect|display)) [^,;.:]*?"
    r"(?=$|[,;.:]| with | and | that | having )"
)
_SPELT = (
    (r"['’](?:s|m|d|ll|re|ve)?\b|(?<=s)['’]", ""),
    (r"(?<=\w)-(?=[a-z])|(?<=[a-z])-(?=\w)", " "),
    (r"\bw/ ?", "with "),
    ("&", " and "),
    (r"(?<=\d),(?=\d{3}\b)", ""),
    (r"^for (?:my|our|the) \w+,? (?=an? )", ""),
    (r"^((?:an? |the )?)built in ", r"\1"),
    (r"(?<=\d) in (?=(?:wide|deep|high|tall|long|thick)\b)", " inch "),
)
"""Spelling, and how it is read."""


def _meanings() -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    said = [(name, "color", color) for name, color in COLOR_WORDS.items()]
    said += [(word, "material", name) for name, item in MATERIALS.items() for word in (name, *item.words.split())]
    for line in _TABLE.strip().splitlines():
        (what, _, value), words = (head := line.split(": "))[0].partition(" "), head[1].split()
        said += [(word.replace("_", " "), what, value or word) for word in words]
    for word, what, meaning in said:
        found.setdefault(word, {})[what] = meaning
    return found


WORDS = _meanings()
_NUMBERS = {word: int(said["number"]) for word, said in WORDS.items() if "number" in said}


@dataclass(frozen=True)
class Unit:
    """A word, a number, a sign, or some words that mean one thing."""

    text: str
    means: Mapping[str, Any]


def read_units(text: str) -> list[Unit]:
    """Return the words, numbers and signs of a sentence, without what it is for.

    Raises:
        InputError: It is empty, too long, no English, or asks for a negative number.
    """
    plain = " ".join(text.lower().split())
    for pattern, instead in _SPELT[:4]:
        plain = re.sub(pattern, instead, plain)
    _refuse_unreadable(text, plain)
    for pattern, instead in _SPELT[4:]:
        plain = re.sub(pattern, instead, plain)
    plain = re.sub(rf"\b({'|'.join(_NUMBERS)}) (?=(?:{_UNIT})\b)", lambda found: f"{_NUMBERS[found[1]]} ", plain)
    plain = _BARE.sub(lambda found: _with_unit(found, plain), plain)
    for purpose in _PURPOSE.findall(plain):
        asks = {what for word in key_of(purpose) for what in WORDS.get(word, ())} & {"part", "motion", "number"}
        plain = plain if asks or re.search(r"\d", purpose) else plain.replace(purpose, " ")
    raw = [(str(found.lastgroup), found[0]) for found in _TOKENS.finditer(plain)]
    units, k = list[Unit](), 0
    while k < len(raw):
        kind, word = raw[k]
        for length in (3, 2, 1):
            said = " ".join(item[1] for item in raw[k : k + length])
            if length == 1 or said in WORDS:
                break
        means = WORDS.get(said, {}) if kind == "word" else {kind: said}
        units.append(Unit(said, {"word": word, **means} if kind == "word" else means))
        k += length
    return units


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


def values_of(text: str) -> list[tuple[float, str]]:
    """Numbers of a text in metres or radians, each with its unit or that of the last one."""
    found = re.findall(rf"([-−]?{_NUMBER})(?: ?({_UNIT})(?![a-z]))?", text)
    return [in_si(number.replace(",", "."), unit or found[-1][1]) for number, unit in found]


def vocabulary(family: Kind) -> dict[str, dict[str, Any]]:
    """Words of a kind -> what they may mean: a ``part``, or a ``length`` or ``choice`` with parameter and value."""
    found: dict[str, dict[str, Any]] = {noun: {"part": ""} for noun, means in WORDS.items() if "part" in means}
    said: list[tuple[str, str, Any]] = [
        (word, "part", "own")
        for stem, others in family.part_words.items()
        for word in (stem.replace("_", " "), *others)
    ]
    for item in family.parameters:
        if isinstance(item.default, int):
            said += [(word, "part", "own") for word in item.nouns]
        elif item.unit == "m":
            said += [
                (word, "length", item.name)
                for word in item.nouns
                if not WORDS.get(word, {}).keys() & {"dimension", "side"}
            ]
        said += [(word, "choice", (item.name, value)) for word, value in _choices(item)]
    for word, what, meaning in said:
        found.setdefault(" ".join(key_of(word)), {})[what] = meaning
    return found


def _choices(item: Parameter) -> Iterator[tuple[str, str]]:
    if item.name in ("modeling", "layout", "style") or not item.choices:
        return
    name = item.name.replace("_", " ")
    if "yes" in item.choices or ("none" in item.choices and len(item.choices) == 2):
        yes = next(value for value in item.choices if value not in ("no", "none"))
        yield from ((word, yes) for word in (name, *item.words))
    for choice in item.choices:
        plain = () if choice in _AMBIGUOUS or not choice else (choice, f"{choice} {name}")
        yield from ((word, choice) for word in (*plain, *item.choice_words.get(choice, ())))
