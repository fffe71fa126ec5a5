"""Kinds of object by what people call them: exactly, with a spelling mistake, and by meaning."""

from __future__ import annotations

import difflib
import re
from functools import cache
from typing import TYPE_CHECKING

from kinematify.generate.procedural.parameter import pairs
from kinematify.generate.registry import all_kinds, kind_named

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.generate.library.kind import Kind

_BRITISH = pairs(
    "aluminium aluminum|tyre tire|castor caster|jewellery jewelry|jewelery jewelry|vice vise|gray grey|metre meter|"
    "centimetre centimeter|millimetre millimeter|centre center|mould mold|plough plow|colour color|kerb curb|"
    "catalogue catalog|draught draft|grille grill|organiser organizer|swivelling swiveling|motorised motorized"
)
"""British or rarer spelling -> the one that names are compared in."""
_IRREGULAR = pairs(
    "leaves leaf|shelves shelf|knives knife|feet foot|halves half|axes axis|teeth tooth|sashes sash|lens lens|"
    "lenses lens"
)
_SAME = (
    "car automobile vehicle sedan hatchback van taxi jeep ambulance truck lorry bus pickup|"
    "bed cot crib bunk couch sofa settee futon|chair seat stool bench armchair throne|"
    "table desk counter workbench stand|cabinet cupboard wardrobe closet locker chest dresser sideboard|"
    "box case crate bin container trunk casket bag basket|robot manipulator arm cobot android gripper hand|"
    "lamp light lantern torch spotlight luminaire|door gate hatch barrier shutter|"
    "saw drill sander grinder planer|knife scissors shears cutter blade|"
    "bicycle bike tricycle scooter motorcycle cycle|boat ship ferry yacht canoe|"
    "plane airplane aircraft helicopter drone glider|pump compressor engine motor turbine generator|"
    "phone telephone mobile smartphone tablet|computer laptop keyboard monitor printer|pot pan kettle jug teapot|"
    "clock watch timer alarm|valve tap faucet spigot|fan blower ventilator propeller windmill turbine|"
    "cart trolley wagon dolly stroller pram barrow wheelbarrow|crane hoist lift elevator jack winch forklift|"
    "guitar piano violin trumpet trombone accordion drum|swing seesaw slide carousel toy|"
    "camera telescope binoculars|oven stove microwave toaster grill fridge freezer|ladder stairs steps scaffold|"
    "bottle jar can flask tube"
)
"""Nouns of things that do the same."""


def words_of(text: str) -> frozenset[str]:
    """Return the words of a list that is written as a text."""
    return frozenset(text.split())


def lemma(word: str) -> str:
    """Return the singular of an English noun in the spelling that names are compared in."""
    word = _BRITISH.get(word, word)
    if word in _IRREGULAR or len(word) < 4 or word.endswith(("ss", "us", "is")):
        return _IRREGULAR.get(word, word)
    if word.endswith("ies"):
        return f"{word[:-3]}y"
    if word.endswith(("ches", "shes", "xes", "sses")):
        return word[:-2]
    return _BRITISH.get(word.removesuffix("s"), word.removesuffix("s"))


def key_of(words: str | Sequence[str]) -> tuple[str, ...]:
    """Return the words of a name, each in the singular."""
    given = re.findall(r"[a-z0-9]+", words.lower()) if isinstance(words, str) else words
    return tuple(map(lemma, given))


@cache
def _names() -> Mapping[str, Kind]:
    """Every name of every kind as one word, so that a dollhouse is a doll house."""
    found: dict[str, Kind] = {}
    for family in all_kinds().values():
        for word in (*family.words, family.name.replace("_", " ")):
            found.setdefault("".join(key_of(word)), family)
    return found


def kind_called(words: Sequence[str]) -> Kind | None:
    """Return the kind that is called by these words, as `key_of` writes them; None if none is."""
    found = kind_named("_".join(words))
    return found if found and not found.like else _names().get("".join(words))


@cache
def words_of_names() -> frozenset[str]:
    """Every word of a name."""
    return frozenset(key for family in all_kinds().values() for word in family.words for key in key_of(word))


def repaired(word: str, known: frozenset[str]) -> str | None:
    """Return the known word that a word means with one letter wrong, missing or added, or its letters in another order.

    None if there is none.
    """
    if len(word) < 5 or word in known:
        return None
    near = [*difflib.get_close_matches(word, known, cutoff=0.85), *(it for it in known if sorted(it) == sorted(word))]
    return next((it for it in near if it[0] == word[0] and abs(len(it) - len(word)) < 2), None)


def nearest_kinds(text: str, count: int = 5) -> dict[Kind, str]:
    """Return the kinds that are nearest to what a text names, by its nouns, things that do the same, and parts.

    Args:
        text: A name or a sentence; the object is named before its parts.
        count: How many.

    Returns:
        Kind -> the names of it that are nearest, at most two.
    """
    words, found = list(dict.fromkeys(key_of(text))), []
    for family in all_kinds().values():
        names = sorted(family.words, key=lambda name: -_score(words, name))[:2]
        found.append((-_score(words, names[0]), len(family.name), family, " or ".join(names)))
    found.sort(key=lambda item: item[:2])
    return {family: names for _, _, family, names in found[:count]}


def nearest_to(name: str, text: str) -> dict[Kind, str]:
    """Return up to five kinds that are nearest to a name: by its last word, and by those before, or by a text."""
    head, *others = reversed(key_of(name))
    return nearest_kinds(" ".join((head, *others)), 3) | nearest_kinds(" ".join(others) or text, 2)


@cache
def _does_the_same(one: str, other: str) -> bool:
    return one != other and any(one in group.split() and other in group.split() for group in _SAME.split("|"))


def _score(words: Sequence[str], name: str) -> float:
    *others, head = key_of(name)
    alike = ((word == head) + 0.6 * _does_the_same(word, head) + 0.4 * (word in others) for word in words)
    spelt = difflib.SequenceMatcher(None, "".join(words[:1]), head).ratio()
    return 0.4 * spelt + sum(much * 0.9**k for k, much in enumerate(alike)) - 0.05 * len(others)
