"""Give parts of an object another size: by a parameter of its family, else along their own sides."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.procedural.clearance import DEEP, carried_by, depth_of, solid_of
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.language.compare import CLOSING
from kinematify.generate.procedural.language.words import stem_of
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.parameter import Parameter, Value
    from kinematify.robot.arrays import FloatArray

Resize = tuple[tuple[str, ...], str, float]
"""Names of parts, none for the whole; ``width``, ``diameter`` or another word for a size, and how large it is [m]."""
_AXES = {"width": 0, "depth": 1, "height": 2, "top": 2}
_PARAMETER = {"top": "height"}
_CLOSE, _STEPS = 2e-3, 12  # of a size; steps of a search
_FACTOR = 3.0  # so much larger or smaller a part may be
_POSES, _LOOSE, _FAR = 5, 0.002, 0.05  # in which it must be clear; farther than before from what carries it; far [m]
_ROUND = 0.05  # of a diameter, by which two sides of what is round differ
_ASIDE = 0.25  # of its length, from which on a part is beside what carries it


def size_of(bounds: FloatArray, size: str) -> float:
    """Return the size of a box [m]: along its axis of the world, else its longest side, or its least if thick."""
    extents = np.ptp(bounds, axis=0)
    return float(extents[_axis(extents, size)])


def _axis(extents: FloatArray, size: str) -> int:
    return _AXES.get(size, int(np.argmin(extents) if size == "wall" else np.argmax(extents)))


@lru_cache(maxsize=8)
def fitted_values(
    family: Family, given: tuple[tuple[str, Value], ...], seed: int | None, wanted: tuple[Resize, ...]
) -> dict[str, Value]:
    """Values of parameters, with one more for each size of parts that a parameter sets."""
    values = dict(given)
    for item in wanted:
        there = _too_large(family, values, seed, item)
        for parameter in _candidates(family, values, item) if abs(there) > _CLOSE * item[2] else ():
            found = _solved(family, values, parameter, seed, item)
            if found is not None:
                values[parameter.name] = found
                break
    return values


def _candidates(family: Family, values: Mapping[str, Value], wanted: Resize) -> list[Parameter]:
    """Lengths that are not given: of the part by its name, then of the whole, then others; of the whole its own."""
    names, size, _ = wanted
    words = {word for name in names for word in stem_of(name).split("_")}
    own = _PARAMETER.get(size, size)
    if not names:
        return [p for p in family.parameters if p.name == own]
    free = [p for p in family.parameters if p.unit == "m" and p.name not in values]
    return sorted(free, key=lambda p: (not words & set(p.name.split("_")), p.name != own))


def _too_large(family: Family, values: Mapping[str, Value], seed: int | None, wanted: Resize) -> float:
    """By how much parts, or the whole, are too large [m]; NaN where they are not there."""
    names, size, metres = wanted
    try:
        made = build(family, values, seed=seed)
    except InputError:
        return math.nan
    closed = made.moved({joint.child: -joint.value for joint in made.joints})
    whole = closed.assembly.bounds
    boxes = [part.bounds for part in closed.parts if part.name in names] if names else [whole]
    if size == "top":  # above the floor
        boxes = [np.array([whole[0], box[1]]) for box in boxes]
    return max(size_of(box, size) for box in boxes) - metres if len(boxes) >= len(names) else math.nan


def _solved(
    family: Family, values: Mapping[str, Value], parameter: Parameter, seed: int | None, wanted: Resize
) -> float | None:
    """The value of a parameter with which parts are so large; None if there is none."""

    def over(value: float) -> float:
        return _too_large(family, {**values, parameter.name: value}, seed, wanted)

    tried = sorted(map(float, {*(parameter.bounds or ()), *(parameter.usual or ()), parameter.default}))
    points = [(value, there) for value in tried if math.isfinite(there := over(value))]
    for one, other in pairwise(points):
        ends = [one, other]
        for _ in range(_STEPS if one[1] * other[1] <= 0.0 and one[1] != other[1] else 0):
            (low, under), (high, above) = ends
            value = low + (high - low) * min(max(under / (under - above), 0.1), 0.9)
            there = over(value)
            if abs(there) < _CLOSE * wanted[2]:
                return value
            ends[0 if there * under > 0.0 else 1] = (value, there)
    return None


def stretched(blueprint: Blueprint, wanted: Resize) -> Blueprint:
    """Return an object with parts so large along one side, or across where they are round.

    Raises:
        InputError: They carry others, would be of another kind, loose, or in the way of something.
    """
    names, size, metres = wanted
    closed = blueprint.moved({joint.child: -joint.value for joint in blueprint.joints})
    of = {part.name: part for part in closed.parts}
    changed = {
        name: _longer(closed, of[name], size, metres)
        for name in names
        if name in of and not math.isclose(size_of(of[name].bounds, size), metres, rel_tol=_CLOSE)
    }
    if not changed:
        return blueprint
    made = replace(closed, parts=tuple(changed.get(part.name, part) for part in closed.parts))
    for name, part in changed.items():
        carrier = solid_of(of[closed.joint_above[name].parent])
        loose = solid_of(part).min_gap(carrier, _FAR) - solid_of(of[name]).min_gap(carrier, _FAR)
        if loose > _LOOSE or _meets(made, name) > max(DEEP, _meets(closed, name)):
            raise InputError(f"There is no room for {name} with a {size or 'size'} of {metres:g} m.")
    return made.moved({joint.child: joint.value for joint in blueprint.joints})


def _longer(closed: Blueprint, part: Part, size: str, metres: float) -> Part:
    joint = closed.joint_above.get(part.name)
    extents, factor = np.ptp(part.bounds, axis=0), metres / size_of(part.bounds, size)
    closes = stem_of(part.name).rsplit("_", maxsplit=1)[-1] in CLOSING  # and would leave its opening open
    alone = size != "top" and len(carried_by(part.name, closed.joints)) == 1 and not closed.loops and not closes
    if joint is None or joint.mimic is not None or not alone or not 1.0 / _FACTOR <= factor <= _FACTOR:
        raise InputError(f"The {size or 'size'} of {part.name} cannot be {metres:g} m.")
    axes = [_axis(extents, size)]
    if size == "diameter":
        axes = [k for k in range(3) if math.isclose(extents[k], extents.max(), rel_tol=_ROUND)]
    anchor = part.bounds.mean(axis=0)
    if joint.kind.turns:
        anchor = joint.pivot
    elif joint.kind is JointType.FIXED:  # it grows away from what carries it
        aside = anchor - next(item for item in closed.parts if item.name == joint.parent).bounds.mean(axis=0)
        anchor = np.where(np.abs(aside) > _ASIDE * extents, anchor - 0.5 * np.sign(aside) * extents, anchor)
    scale = np.ones(3)
    scale[axes] = factor
    return replace(part, vertices=anchor + (part.vertices - anchor) * scale)


def _meets(made: Blueprint, name: str) -> float:
    """Return how deep a part is in others at most while it moves [m]."""
    joint, own = made.joint_above[name], {name}
    others = [solid_of(part) for part in made.parts if part.name not in own]
    solid = solid_of(next(part for part in made.parts if part.name == name))
    ends = (joint.lower, joint.upper) if math.isfinite(joint.upper - joint.lower) else (0.0, math.pi)
    poses: Sequence[float] = np.linspace(*ends, _POSES).tolist() if joint.kind is not JointType.FIXED else [0.0]
    return max(depth_of(solid.transform(joint.motion(value)[:3]), other) for value in poses for other in others)
