"""Sentences with what a reader expects of them, and what of that an object does not keep.

Independent of the parser: looked at is what was built. Fronts look along -y, so that left is -x.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kinematify.generate.procedural.layout import parse_layout, stacked
from kinematify.generate.procedural.materials import COLOR_WORDS, COLORS, MATERIALS
from kinematify.generate.registry import all_kinds
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint

GROUPS = {
    **dict.fromkeys(("written", "other_words", "stranger"), "written beside the first parser"),
    **dict.fromkeys(("new", "fresh"), "new ones, before it was looked at"),
    **{f"heldout_{k}": "of people who walk in" for k in range(1, 7)},
    "heldout_7": "without sight of the library",
    **{f"heldout_{k}": "committed before the grammar of that day was opened" for k in (8, 9, 10, 11)},
    **{f"heldout_{k}": "of an author who worked on neither, twice" for k in (12, 13)},
    **{f"heldout_{k}": "without sight of library and code, twice" for k in (14, 15)},
    "composed": "mechanisms on a body, with its words at hand",
    "senseless": "what nobody can build",
}
"""Name of each list -> what it is, ten at most."""
SETS = tuple(GROUPS)
"""Names of the lists."""
_FOLDER = Path(__file__).with_name("sentences")
_SIZE = 0.02  # of a size, by which it may be off
_ANGLE_DEG = 0.1
_CALLED = {
    "arm": ("arm", "link"), "blade": ("blade", "rotor"), "carriage": ("carriage", "bridge", "ram"),
    "casement": ("sash",), "gate": ("gate", "door", "leaf"), "turntable": ("turntable", "lazy_susan"),
    "caster": ("castor", "caster", "swivel_wheel"), "door": ("door", "leaf", "sliding_door"),
    "globe": ("ball",), "handle": ("handle", "lever"), "lid": ("lid", "screen"), "needle": ("gauge", "needle"),
    "flap": ("flap", "flap_door", "tilting_flap", "compartment"), "seat": ("seat", "swing"),
    "switch": ("rocker", "switch", "lever"), "tailgate": ("flap", "tailgate"), "wheel": ("wheel", "tyre"),
}  # fmt: skip
"""How a reader calls what the models call otherwise."""
_HANDLES = ("handle", "knob")
"""What may belong to a part instead of being one."""
_KINDS = {
    "wood": tuple(name for name, item in MATERIALS.items() if item.surface == "grain"),
    "metal": tuple(name for name, item in MATERIALS.items() if item.surface == "metal" and name != "mirror"),
}
"""What is of a material that is said in general."""


def load_sentences(name: str) -> list[dict[str, Any]]:
    """Return a list of sentences, each with what is expected of it; see `SETS`."""
    items: list[dict[str, Any]] = yaml.safe_load((_FOLDER / f"{name}.yaml").read_text(encoding="utf-8"))
    return items


def broken_expectations(expected: Mapping[str, Any], made: Blueprint, closed: Blueprint) -> list[str]:
    """Return what of an expectation an object does not keep, in words.

    Args:
        expected: One item of `load_sentences`.
        made: The object.
        closed: The same with all its joints at their zero.
    """
    if "refuse" in expected or expected.get("impossible"):
        return ["built, though nobody can"]
    found = []
    for key, wanted in expected.items():
        if key in _PLAIN:
            found += _PLAIN[key](made, closed, wanted)
        elif key in _OF_PARTS:
            for noun, value in wanted.items():
                found += [f"{key} {noun}: {why}" for why in _OF_PARTS[key](_parts(closed, noun), made, value)]
        elif key != "text":
            raise ValueError(f"Nobody knows how to check {key!r} of the sentence {expected['text']!r}.")
    return found


# ---- what is expected of the whole ---------------------------------------------------------------------------------


def _family(made: Blueprint, closed: Blueprint, wanted: str) -> list[str]:
    return [] if wanted == made.family else [f"built is a {made.family}"]


def _object(made: Blueprint, closed: Blueprint, wanted: list[str]) -> list[str]:
    family = all_kinds().get(made.family)
    kind = made.family.replace("_", " ")
    names = (*family.words, kind) if family else (kind,)
    called = any(f" {name}".endswith(f" {word}") for name in names for word in wanted)
    return [] if called else [f"built is a {made.family}"]


def _prefixed(made: Blueprint, closed: Blueprint, wanted: dict[str, int]) -> list[str]:
    counts = {stem: len([part for part in made.parts if _stem(part.name) == stem]) for stem in wanted}
    return [f"{counts[stem]} of {stem}" for stem, number in wanted.items() if counts[stem] != number]


def _number_of_joints(made: Blueprint, closed: Blueprint, wanted: int | dict[str, int]) -> list[str]:
    if isinstance(wanted, int):
        return [] if len(made.joints) == wanted else [f"{len(made.joints)} joints"]
    counts = {kind: len([joint for joint in made.joints if _of_kind(joint, kind)]) for kind in wanted}
    return [f"{counts[kind]} {kind} joints" for kind, number in wanted.items() if counts[kind] != number]


def _size(made: Blueprint, closed: Blueprint, wanted: dict[str, float]) -> list[str]:
    base = np.ptp(closed.parts[0].bounds, axis=0)
    every = np.ptp(closed.assembly.bounds, axis=0)
    axes = {"width": 0, "depth": 1, "height": 2, "x": 0, "y": 1, "z": 2}
    found = []
    for name, size in wanted.items():
        axis = axes.get(name.split()[-1], int(np.argmax(every[:2])))  # a length lies along the longer side
        extents = (base[axis], every[axis])
        if all(abs(extent / size - 1.0) > _SIZE for extent in extents):
            found.append(f"{name} {extents[0]:.3f} m")
    return found


def _above(made: Blueprint, closed: Blueprint, wanted: list[list[str]]) -> list[str]:
    return [f"{one} not above {other}" for one, other in wanted if not _beyond(closed, one, other, 2, 1.0)]


def _left_of(made: Blueprint, closed: Blueprint, wanted: list[list[str]]) -> list[str]:
    return [f"{one} not left of {other}" for one, other in wanted if not _beyond(closed, one, other, 0, -1.0)]


def _beyond(closed: Blueprint, one: str, other: str, axis: int, sign: float) -> bool:
    places = [[sign * part.bounds.mean(axis=0)[axis] for part in _parts(closed, noun)] for noun in (one, other)]
    return all(places) and bool(min(places[0]) > max(places[1]))


def _open(made: Blueprint, closed: Blueprint, wanted: float) -> list[str]:
    shares = [joint.value / (joint.upper + joint.value) for joint in made.joints if math.isfinite(joint.upper)]
    return [] if wanted == 0.0 or np.isclose(shares, wanted).any() else [f"open by {max(shares):.2f}"]


def _turned(made: Blueprint, closed: Blueprint, wanted: float) -> list[str]:
    angles = [math.degrees(joint.value) for joint in made.joints if joint.kind.turns]
    return [] if any(abs(angle - wanted) < _ANGLE_DEG for angle in angles) else [f"turned by {angles}"]


def _values(made: Blueprint, closed: Blueprint, wanted: dict[str, Any]) -> list[str]:
    there = made.parameters
    return [
        f"{name} {there.get(name)}"
        for name, value in wanted.items()
        if not (
            math.isclose(there.get(name, math.nan), value) if isinstance(value, float) else there.get(name) == value
        )
    ]


def _material(made: Blueprint, closed: Blueprint, wanted: str | dict[str, str]) -> list[str]:
    if isinstance(wanted, str):
        return _values(made, closed, {"material": wanted})
    return _looks(made, wanted, _is_of_material)


def _color(made: Blueprint, closed: Blueprint, wanted: str | dict[str, str]) -> list[str]:
    if isinstance(wanted, str):
        return _values(made, closed, {"color": wanted})
    return _looks(made, wanted, _is_of_color)


def _handle(made: Blueprint, closed: Blueprint, wanted: str) -> list[str]:
    return _values(made, closed, {"handle": wanted})


def _looks(made: Blueprint, wanted: dict[str, str], fits: Callable[[Part, str], bool]) -> list[str]:
    found = []
    for noun, name in wanted.items():
        parts = [made.parts[0]] if noun == "all" else _parts(made, noun)
        if not parts and noun in _HANDLES:
            if not _handles_look(made, COLOR_WORDS.get(name, name)):
                found.append(f"{noun} not {name}")
        elif not parts or not all(fits(part, name) for part in parts):
            found.append(f"{noun} not {name}")
    return found


def _handles_look(made: Blueprint, name: str) -> bool:
    """Whether all that is of another look than its part is of a material or colour."""
    others = [item for part in made.parts if part.appearance for item in part.appearance.materials[1:]]
    return bool(others) and all(item.name.startswith(name) for item in others)


def _is_of_color(part: Part, name: str) -> bool:
    return name in COLOR_WORDS and bool(part.color == COLORS[COLOR_WORDS[name]])


def _is_of_material(part: Part, name: str) -> bool:
    return part.density in {MATERIALS[kind].density for kind in _KINDS.get(name, (name,)) if kind in MATERIALS}


def _layout(made: Blueprint, closed: Blueprint, wanted: str) -> list[str]:
    there = str(made.parameters["layout"]) or stacked(
        [(int(made.parameters[f"{cell}s"]), cell) for cell in ("door", "drawer")]
    )
    return [] if parse_layout(wanted) == parse_layout(there) else [f"layout {there}"]


def _columns(made: Blueprint, closed: Blueprint, wanted: list[int]) -> list[str]:
    places = [round(float(part.bounds.mean(axis=0)[0]), 6) for part in _parts(closed, "drawer")]
    stacks = [places.count(place) for place in sorted(set(places))]
    return [] if stacks == wanted else [f"columns {stacks}"]


def _side(made: Blueprint, closed: Blueprint, wanted: str) -> list[str]:
    door = _parts(closed, "door")[0]
    aside = closed.joint_above[door.name].pivot[0] - door.bounds.mean(axis=0)[0]
    return [] if (aside < 0.0) == (wanted == "left") else [f"the hinge is not on the {wanted}"]


def _has(made: Blueprint, closed: Blueprint, wanted: list[str]) -> list[str]:
    return [f"no {noun}" for noun in wanted if not _is_there(made, noun)]


def _lacks(made: Blueprint, closed: Blueprint, wanted: list[str]) -> list[str]:
    return [f"a {noun}" for noun in wanted if _is_there(made, noun)]


def _is_there(made: Blueprint, noun: str) -> bool:
    chosen = [value for name, value in made.parameters.items() if _is_last_word(noun, name.removesuffix("s"))]
    return bool(_parts(made, noun)) or any(value not in ("none", 0) for value in chosen)


def _is_last_word(word: str, name: str) -> bool:
    return f"_{name}".endswith(f"_{word}")


def _count(made: Blueprint, closed: Blueprint, wanted: int) -> list[str]:
    standing = [part for part in made.parts[1:] if made.joint_above[part.name].kind is JointType.FIXED]
    bodies = sum(_pieces(part) for part in (made.parts[0], *standing))
    return [] if bodies == wanted else [f"{bodies} of them"]


def _pieces(part: Part) -> int:
    starts, ends = np.repeat(part.faces[:, 0], 2), part.faces[:, 1:].reshape(-1)
    edges = coo_array((np.ones(len(starts)), (starts, ends)), shape=2 * (len(part.vertices),))
    return int(connected_components(edges)[0])


# ---- what is expected of parts -------------------------------------------------------------------------------------


def _moving(parts: list[Part], made: Blueprint, wanted: int) -> list[str]:
    moving = [part for part in parts if part.name in made.joint_above]
    return [] if len(moving) == wanted else [f"{len(moving)} of them"]


def _joint(parts: list[Part], made: Blueprint, wanted: str) -> list[str]:
    joints = [made.joint_above[part.name] for part in parts if part.name in made.joint_above]
    if joints and all(_of_kind(joint, wanted) for joint in joints):
        return []
    return [joints[0].kind.value if joints else "none"]


def _range(parts: list[Part], made: Blueprint, wanted: float) -> list[str]:
    ways = [made.joint_above[part.name].upper - made.joint_above[part.name].lower for part in parts]
    return [] if any(math.isclose(way, wanted, rel_tol=_SIZE) for way in ways) else [f"goes {ways}"]


def _opened(parts: list[Part], made: Blueprint, wanted: float) -> list[str]:
    joints = [made.joint_above[part.name] for part in parts]
    values = [math.degrees(joint.value) if joint.kind.turns else joint.value for joint in joints]
    return [] if any(math.isclose(value, wanted, rel_tol=1e-6) for value in values) else [f"open by {values}"]


def _where(parts: list[Part], made: Blueprint, wanted: str) -> list[str]:
    sign = -1.0 if wanted == "left" else 1.0
    middle = made.parts[0].bounds.mean(axis=0)[0]
    aside = [sign * (part.bounds.mean(axis=0)[0] - middle) for part in parts]
    return [] if aside and min(aside) > 0.0 else [f"not on the {wanted}"]


def _kinds(parts: list[Part], made: Blueprint, wanted: dict[str, int]) -> list[str]:
    joints = [made.joint_above[part.name] for part in parts if part.name in made.joint_above]
    counts = {kind: len([joint for joint in joints if _of_kind(joint, kind)]) for kind in wanted}
    return [f"{counts[kind]} {kind}" for kind, number in wanted.items() if counts[kind] != number]


def _part_looks(parts: list[Part], made: Blueprint, wanted: dict[str, int]) -> list[str]:
    counts = {
        name: len([part for part in parts if _is_of_color(part, name) or _is_of_material(part, name)])
        for name in wanted
    }
    return [f"{counts[name]} {name}" for name, number in wanted.items() if counts[name] != number]


def _hinges(parts: list[Part], made: Blueprint, wanted: dict[str, int]) -> list[str]:
    aside = [made.joint_above[part.name].pivot[0] - part.bounds.mean(axis=0)[0] for part in parts]
    counts = {"left": len([x for x in aside if x < 0.0]), "right": len([x for x in aside if x > 0.0])}
    return [f"{counts[side]} hinged on the {side}" for side, number in wanted.items() if counts[side] != number]


def _of_kind(joint: BlueprintJoint, kind: str) -> bool:
    if kind == "horizontal hinge":
        return joint.kind is JointType.REVOLUTE and abs(joint.axis[2]) < _SIZE
    return joint.kind.turns if kind == "revolute" else joint.kind.value == kind


def _parts(made: Blueprint, noun: str) -> list[Part]:
    """Parts that a reader calls so: their name without a number; where there is none, its last word."""
    called = (noun, *_CALLED.get(noun, ()))
    exact = [part for part in made.parts if _stem(part.name) in called]
    return exact or [part for part in made.parts if any(_is_last_word(stem, _stem(part.name)) for stem in called)]


def _stem(name: str) -> str:
    """A name without its number and its side."""
    return re.sub(r"(?:_(?:\d+|left|right))+$", "", name).rstrip("0123456789_")


_PLAIN: dict[str, Callable[[Blueprint, Blueprint, Any], list[str]]] = {
    "family": _family, "object": _object, "parts": _prefixed, "joints": _number_of_joints, "size": _size,
    "above": _above, "left_of": _left_of, "open": _open, "turned": _turned, "values": _values,
    "material": _material, "color": _color, "colour": _color, "handle": _handle, "layout": _layout,
    "columns": _columns, "side": _side, "has": _has, "lacks": _lacks, "count": _count,
}  # fmt: skip
_OF_PARTS: dict[str, Callable[[list[Part], Blueprint, Any], list[str]]] = {
    "moving": _moving, "joint": _joint, "range": _range, "opened": _opened, "where": _where, "kinds": _kinds,
    "looks": _part_looks, "hinges": _hinges,
}  # fmt: skip
