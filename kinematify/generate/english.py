"""English as it is written: spelling, numbers with units, and what words mean, for a kind and for all."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.kind_search import key_of, words_of
from kinematify.generate.procedural.materials import COLOR_WORDS, MATERIALS
from kinematify.generate.procedural.parameter import pairs
from kinematify.generate.request import ANGLES, UNITS, in_si

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

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
number 24: twenty_four
number 30: thirty
number 40: forty
number 45: forty_five
number 60: sixty
number 90: ninety
dimension width: width wide broad
dimension depth: deep depth
dimension height: height high tall
dimension length: length long
dimension diameter: diameter across wingspan span
dimension thickness: thickness thick
side left: left
side right: right
side front: front
side back: back rear
side top: top upper
side bottom: bottom lower underside
ordinal: first second third fourth fifth sixth
relation 1: above over
relation -1: below under beneath underneath
motion move: move moves moving open opens opening close closes closing lift lifts lifting raise raises go goes going
motion move: come comes travel travels travelling traveling adjust adjusts press presses extend extends extending
motion move: movable moveable adjustable raisable raising drops rise rises rising falls removable detachable lowers
motion move: push pushes pulls pull roll rolls lower retract retracts retractable extendable extending drop dropping pop
motion move: runs running opened_up openable aim aims aimed aiming operate operates operated
motion slide: glide glides gliding slide slides sliding telescope telescopes telescopic telescoping
motion hinge: swing swings swinging pivot pivots pivoting pivoted fold folds folding foldable flip flips flipping turn
motion hinge: rocks rocking turns turning rotate rotates rotating rotatable tip tips tipping oscillates oscillating
motion hinge: oscillate bends curls steers spread spreads leans hinged hinges hinge lean steer bend curl tippable
motion spin: spin spins spinning revolve revolves revolving
motion tilt: tilt tilts tilting recline reclines reclining reclinable tiltable
motion pan: yaws pan pans panning swivel swivels swiveling swivelling
name: move open press push pull roll drop lower hinge close pop lift
state 0: closed shut
state 0.15: ajar
state raised: raised lifted
state lowered: lowered
state 1: open opened pulled pushed propped tilted turned swung extended drawn moved folded rotated
state 1: slid reclined curled bent hinged_open flipped tipped
degree 0.5: half partly halfway half_way midway
degree 0.15: slightly
degree 1: fully wide completely
stative: starts begins stands_ standing shown starting beginning drawn left currently initially
where: up down out in back forward forwards outward outwards inward inwards away open upward upwards downward downwards
where: off through over flat apart backward backwards
towards top: up upward upwards
towards bottom: down downward downwards
towards out: out outward outwards
towards in: inward inwards
towards front: forward forwards
towards back: backward backwards
extent 0 0.6: toy
extent 0 0.3: pocket handheld tiny mini
extent 0.5 99: industrial giant huge
endless: endlessly continuously all_the_way all_the_way_round full_circle right_round
endless: round_and_round all_the_way_around right_around full_turn
stroke: travel stroke range way opening throw movement
having: whose where when show
having: with having has have featuring including plus containing holding carrying comes_with fitted_with equipped_with
without: without no lacking
relative: that which who
refers: it its they them their each both all every either
limit: to by at from up_to of through about around between limited over within
place: as on at along under to of from into through behind beside near by around inside between across against onto
place: in above over below beneath underneath opposite next_to in_front_of off beyond within
like: for like per than
both: to_either_side to_both_sides to_each_side in_either_direction in_both_directions in_each_direction each_way
both: either_way to_either_direction both_ways
aside: behind beside opposite between in_front_of next_to
beside row: side_by_side in_a_row next_to_each_other
beside column: in_a_column one_above_the_other on_top_of_each_other
in: in
of: of
lines row: row rows
lines column: column columns
det: a an the its their this these those my your our his her any some
be: is are be been being was were can could may might must should would will do does to also then so
and: and or but plus
use: hold holds store stores storing keep keeps fit fits take takes seat seats serve serves use used match matches suit
use: suits remind reminds look looks work works need needs protect protects carries carry stay stays play plays fits_in
filler: please i we you like want need make build create generate give show draw design get me us hello hi hey thanks
filler: let would wants wanted object item thing model piece side sides hand end ends kind type sort itself own u one_of
filler: approximately roughly approx exactly about around whole throughout part parts each_other altogether total s
filler: already mounted attached fixed connected placed located positioned arranged painted finished coloured colored
filler: color colour made built there here lines stacked set in_total fitted independently have design looking ones one
filler: hung edge overall ornament decoration figure model rest while line done shaped this just only very
plain: really quite rather too
plain: modern sleek contemporary minimalist vintage retro rustic antique classic elegant fancy cute beautiful nice cool
plain: robust strong durable sturdy solid professional practical simple plain standard typical normal regular usual
plain: common new old good great quality ergonomic comfortable realistic detailed basic scandinavian victorian pretty
plain: brushed polished matte matt glossy shiny heavy handy cosy cozy lovely fancy funky tidy cast wrought lacquered
plain: big large small little narrow short slim compact shallow low tall wide_ style styled freestanding free own extra
plain: industrial toy pocket handheld tiny mini giant huge home household domestic separate individual
plain: indoor outdoor american english british french german swiss italian dutch chinese japanese indian european
plain: mechanical manual manually clockwork self_standing authentic genuine functional working proper real official
plain: independent traditional identical matching bright construction compound
plain: curbside roadside
plain: benchtop tabletop desktop countertop kitchen bathroom bedroom office hospital hotel school workshop nursery lobby
material walnut: dark_wood dark_wooden dark_timber
material pine: light_wood light_wooden pale_wood pale_timber
round: round
form: round t d u l x together in_unison simultaneously synchronously at_once at_the_same_time
part: door drawer flap knob button lever caster wheel crank rotor vent lock handle lid tray shelf hook gauge needle dial
part: switch pedal seat leg arm blade window light display screen ladder mirror basket rail bell finger joint cover
part: hatch panel key roller fan gear pulley spring rope bulb stand foot mast boom bucket propeller wing sail visor
part: brake clamp jaw spout tap valve plunger piston rod nozzle hose cable plug socket cap drum turntable platform ramp
part: step armrest headrest footrest backrest handlebar tailgate hood trunk bonnet gripper camera antenna grip pull
part: holder rack frame base body pole post chain latch axle bin slot hinge
"""
"""What words mean, and the value of that."""
ROLES = pairs(
    "sign ,|in i|of o|having h|and &|dims x|range r|symmetric r|quantity q|number #|relative R|without W|relation L|"
    "lines =|beside T|both B|endless e|det d|color c|material c|side s|ordinal s|dimension D|refers P|state S|motion m|"
    "degree g|stative t|stroke k|limit p|place p|like Y|be b|where v|plain f|part w|use u|form a|filler _"
)
"""Class of a word -> the letter that stands for it in patterns; the first one counts."""
OF_SOME = re.compile(
    r"\b(?:(?:of|except) (?:which|them|these|those)|others?|another|except|only|instead|alternat\w+|respectively"
    r"|every (?:second|other)|half of|cant|cannot|dont|doesnt|isnt|not|never|(?:the|while) middle (?:one|\w+)"
    r"|one (?:\w+ )+?and one (?:\w+)$|from the (?:bottom|left|right))\b"
)
"""Clauses about some of the parts, which are not read."""
_OPINION = re.compile(r"\w{3,}(?:(?<!al)ly|ous|ful|ish|ive|some|esque)$")
"""Adverbs, and adjectives that say what somebody thinks of a thing."""
_AMBIGUOUS = words_of("none yes no top bottom left right side plain one two four off fixed beside below within")
_OF = "of|is|to be|about|with|at|around"
_NUMBER = r"\d+(?:[.,]\d+)?"
_UNIT = "|".join(sorted((re.escape(word) for word in (*UNITS, *ANGLES) if word != "in"), key=len, reverse=True))
_TIMES = rf" ?(?:x|×|by) ?{_NUMBER}(?: ?(?:{_UNIT})(?![a-z]))?"
_TOKENS = re.compile(
    rf"(?P<dims>{_NUMBER}(?: ?(?:{_UNIT}))?{_TIMES}(?:{_TIMES})?)(?![a-z0-9])"
    rf"|(?P<range>(?:(?:from|between) )?[-−]?{_NUMBER} ?(?:{_UNIT})? ?(?:(?:up |down |back )?(?:to|and|\.\.)|–|-) ?"
    rf"\+?[-−]?{_NUMBER} ?(?:{_UNIT}))(?![a-z])"
    rf"|(?P<symmetric>± ?{_NUMBER} ?(?:{_UNIT}))(?![a-z])"
    rf"|(?P<quantity>[-−]?{_NUMBER} ?(?:{_UNIT}))(?![a-z])|(?P<number>{_NUMBER}(?![a-z]))"
    rf"|(?P<word>[a-z0-9]*[a-z][a-z0-9]*)|(?P<sign>[^\sa-z0-9])"
)
_BARE = re.compile(
    rf"(?<![\dx×.-] )\b{_NUMBER}(?= (?:wide|deep|high|tall|long|broad|thick)\b)"
    rf"|(?:width|depth|height|length) {_NUMBER}(?! ?(?:{_UNIT}|[x×.,\d]))\b"
    rf"|from [-−]?{_NUMBER} to ([-−]?{_NUMBER})(?! ?(?:{_UNIT}))\b"
)
"""A size or a range without a unit."""
_BEFORE = re.compile(
    rf"\b(width|depth|height|length|diameter|thickness|span|wingspan)(?: (?:{_OF}))* ({_NUMBER} ?(?:{_UNIT}))(?![a-z])"
)
"""A size behind its name."""
_PURPOSE = re.compile(
    r"\b(?:for|so (?:that|you|i|we)|suitable for|because|to (?:store|keep|hold|put|carry|hang|serve|sort|collect|"
    r"display|make|help|sit|use|match|go with|suit)) [^,;.:]*?(?=$|[,;.:]| with | that | having | whose | which )"
)
_SPELT: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"plus ?(?:/|or)? ?minus|\+/[-−]", "±"),
    (r"[’‘′]", "'"),
    (r"[“”″]|''", '"'),
    (
        rf"({_NUMBER}) ?(?:ft|foot|feet|') ?({_NUMBER})(?: ?(?:inch(?:es)?|in\b|\")|(?= (?:wide|deep|high|tall|long)))",
        lambda found: f"{12 * float(found[1]) + float(found[2]):g} inch",
    ),
    (r"(?<=\d)'(?!\w)", " ft"),
    (r"'(?:s|m|d|ll|re|ve)?\b|(?<=s)'", ""),
    (r"(?<=\d) ?[–—-] ?(?=\d)", " to "),
    (r"(?<=\d)-(?=[a-z])|(?<=[a-z])-(?=\d)", " "),
    (
        r"\b(?:(?:\w+-)+(?:style|sized?|friendly|looking|made|grade|duty|quality|fashioned|proof|themed)|well-\w+)\b",
        "",
    ),
    (r"(?<=[a-z])-(?=[a-z])", " "),
    (r"\bw/ ?", "with "),
    (r"^((?:an? |the |my )?(?:\w+ )?)pair of ", r"\1"),
    ("&", " and "),
    (r"(?<=[a-z]{2})/(?=[a-z]{2})", " "),
    (r"(?<=\d),(?=\d{3}\b)", ""),
    (r"\bhalf an? (?=(?:met|foot|inch))", "0.5 "),
    (
        r"\b(\w+) and a half (?=(?:met|f[oe]{2}t|inch))",
        lambda found: f"{WORDS.get(found[1], {}).get('number', found[1])}.5 ",
    ),
    (r"\ba (?=(?:metre|meter|foot) (?:and|wide|high|tall|long|deep|across|in|by)\b)", "1 "),
    (r"(\d+) and a half\b", r"\1.5"),
    (
        (
            r"^(?:(?:hi|hello|hey),? )?(?:(?:(?:for|in) [^,;:.]*?,? )?(?:i|we|you|they|my|our|us)\b[^,;:.]*?"
            r"\b(?:(?:look|search|ask)(?:s|ing)? for|wants?|needs?|would like|(?:d |would )?love|d like|design(?:ing)?|"
            r"build(?:ing)?|simulat(?:e|ing)|had one of those|have one of those|after|like) (?=\S)"
            r"|(?:looking|searching) for |(?:can|could|would|will) (?:you|u|ya) (?:please )?|(?:i|we|my|our) [^,;.:]*: "
            r"|something like |something (?:\w+ )*?for [^,;:.]*[,:] )"
        ),
        "",
    ),
    (r",? ?(?:and )?(?:the )?(?:rest|others|other ones) (?:(?:are|is|stay|remain|all) )*(?:shut|closed)\b", ""),
    (
        (
            r",? (?:just )?(?:like|as) (?:they|the ones?|those|you|we|in|on|at)\b[^,;.:]*?"
            r"(?=$|[,;.:]| with | that | having | whose | which | and )"
        ),
        "",
    ),
    (
        (
            r"\b(?:pale|pastel|lime|sky|baby|powder|duck egg|mint|ice|sage|apple|lemon) "
            r"(?=(?:red|green|blue|yellow|orange|brown|pink|purple|gr[ea]y)\b)"
        ),
        "light ",
    ),
    (r"\b(?:bottle|racing|forest|hunter|midnight|oxblood|cherry|wine) (?=(?:red|green|blue)\b)", "dark "),
    (
        (
            r"\b(?:bright|signal|traffic|pillar box|fire engine|jet|snow|royal) "
            r"(?=(?:red|green|blue|yellow|orange|black|white)\b)"
        ),
        "",
    ),
    (r"^((?:an? |the )?)built in ", r"\1"),
    (
        rf"((?:rotat|turn|swivel|spin|tilt|swing)\w*(?: (?:up|down|by|to|through))*) ({_NUMBER})(?=$|[,.;]| and )",
        r"\1 \2 deg",
    ),
    (r"(\d+ ?(?:deg\w*|°)) (?:to |on )?(?:either|each|both) sides?", r"\1 either way"),
    (r"\bof travel\b", "of stroke"),
    (r"\b(?:light|pale) (?=(?:pine|beech|birch|maple|ash)\b)|\bdark (?=(?:walnut|mahogany|teak|ebony)\b)", ""),
    (r"\blight (?=(?:oak|wood|wooden|walnut)\b)", "pale "),
    (r"(?<!merry )\bgo(?:es|ing)? round(?! (?:the|a|its)\b)", "turn endlessly"),
    (rf"(±|\bat) ?({_NUMBER})(?=$|[,.;]| and )", r"\1 \2 deg"),
    (r"(?:from )?\b(?:flat|horizontal|level|closed|shut|upright|vertical) (?:up )?to (?=\d+ ?(?:deg|°))", "0 to "),
    (
        r"(?:(?<=long|wide|high|tall|deep|. cm|. mm| \d m) |\bwhen )(?:(?:when|it|is|fully) )*(?:closed|shut)\b",
        "",
    ),
    (r"(?<=\d) in (?=(?:wide|deep|high|tall|long|thick|across)\b)", " inch "),
)
"""Spelling, and how it is read."""


def _meanings() -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    said = [(name, "color", color) for name, color in COLOR_WORDS.items()]
    said += [(word, "material", name) for name, item in MATERIALS.items() for word in (name, *item.words)]
    for line in _TABLE.strip().splitlines():
        (what, _, value), words = (head := line.split(": "))[0].partition(" "), head[1].split()
        said += [(word.replace("_", " ").strip(), what, value or word) for word in words]
    for word, what, meaning in said:
        found.setdefault(word, {})[what] = meaning
    return found


WORDS: dict[str, dict[str, Any]] = _meanings()
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
    _refuse_unreadable(text, plain)
    for pattern, instead in _SPELT:
        plain = re.sub(pattern, instead, plain)
    plain = re.sub(
        rf"\b({'|'.join(_NUMBERS)}) (?=(?:{_UNIT})\b(?! (?:plate|pedal|rest|board)))",
        lambda found: f"{_NUMBERS[found[1]]} ",
        plain,
    )
    plain = _BARE.sub(lambda found: _with_unit(found, plain), plain)
    plain = _BEFORE.sub(r"\2 \1", plain)
    for purpose in _PURPOSE.findall(plain):
        asks = {what for word in key_of(purpose) for what in WORDS.get(word, ())} & {"motion", "number"}
        plain = plain if asks or re.search(r"\d", purpose) else plain.replace(purpose, " ")
    raw = [(str(found.lastgroup), found[0]) for found in _TOKENS.finditer(plain)]
    units, k = list[Unit](), 0
    while k < len(raw):
        kind, word = raw[k]
        for length in (4, 3, 2, 1):
            said = " ".join(item[1] for item in raw[k : k + length])
            if length == 1 or said in WORDS:
                break
        means = WORDS.get(said, {}) if kind == "word" else {kind: said}
        if kind == "word":
            means = {"word": word, **(means or {"plain": word} if _OPINION.match(said) else means)}
        units.append(Unit(said, means))
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
    shown = repr(text[:80])
    if not plain.strip():
        raise InputError("The text is empty. Describe an object, e.g. 'a cabinet with two doors above three drawers'.")
    if not letters or sum(letter.isascii() for letter in letters) < 0.8 * len(letters):
        raise InputError(f"The text {shown} is not English as far as can be seen. Describe the object in English.")
    if len(plain.split()) > LONGEST:
        raise InputError(f"The text has {len(plain.split())} words; at most {LONGEST} describe one object.")
    minus = r"(?<!plus/)(?<!plus )(?<!or )\bminus"
    if re.search(rf"{minus} (?!{_NUMBER} ?(?:{_UNIT}))|\bnegative\b|(?:^|\s)-\s?\d+ (?!to |{_UNIT})[a-z]+", plain):
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
    if item.name in ("modeling", "layout", "style"):
        return
    name = item.name.replace("_", " ")
    if "yes" in item.choices or ("none" in item.choices and len(item.choices) == 2):
        yes = next(value for value in item.choices if value not in ("no", "none"))
        yield from ((word, yes) for word in (name, *item.words))
    for choice in item.choices:
        plain = () if choice in _AMBIGUOUS or not choice else (choice, f"{choice} {name}")
        yield from ((word, choice) for word in (*plain, *item.choice_words.get(choice, ())))
