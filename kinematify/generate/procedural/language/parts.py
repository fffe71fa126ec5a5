"""Parts of what was built: how they may be called, how they look, and how far they are open."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from kinematify.errors import InputError
from kinematify.generate.procedural.language.reading import nouns_of
from kinematify.generate.procedural.language.words import stem_of
from kinematify.generate.procedural.materials import MATERIALS, of_one_material, surface_of
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.family import Family


def part_nouns(family: Family, made: Blueprint) -> dict[tuple[str, ...], tuple[str, ...]]:
    """Return how the parts of an object may be called, singular words -> their names without numbers."""
    stems = {stem_of(part.name) for part in made.parts}
    found: dict[tuple[str, ...], set[str]] = {}
    for stem in stems:
        words = tuple(stem.split("_"))
        for k in range(len(words)):
            found.setdefault(words[k:], set()).add(stem)
    for parameter in family.parameters:
        own = parameter.name.removesuffix("s") if isinstance(parameter.default, int) else ""
        of = {stem for stem in stems if stem in (own, *nouns_of(parameter))} if own else set()
        for noun in nouns_of(parameter) if of else ():
            found.setdefault(tuple(noun.split()), set()).update(of)
    for stem, others in family.part_words.items():
        for noun in others if stem_of(stem) in stems else ():
            found.setdefault(tuple(noun.split()), set()).add(stem_of(stem))
    return {words: tuple(sorted(names)) for words, names in found.items()}


def looking(blueprint: Blueprint, names: Sequence[str], material: str, color: str) -> Blueprint:
    """Paint parts, or make them of another material; handles keep their own look."""

    def look(part: Part) -> Part:
        appearance = part.appearance
        assert appearance is not None, "what is generated has an appearance"
        own = appearance.materials[0].name.split()[-1]  # behind its colour
        surface = surface_of(material or own, color or None)
        new = of_one_material(surface, part.vertices, part.faces)
        return replace(
            part,
            color=surface.color[:3],
            density=MATERIALS[material].density if material else part.density,
            appearance=replace(
                new,
                materials=(surface, *appearance.materials[1:]),
                material_of_face=appearance.material_of_face,
                uv=appearance.uv if new.uv is None else new.uv,
            ),
        )

    return replace(blueprint, parts=tuple(look(part) if part.name in names else part for part in blueprint.parts))


def opened(blueprint: Blueprint, names: Sequence[str], how: str, much: float) -> Blueprint:
    """Return an object with the joints of some parts open by a ``share``, an ``angle`` [rad] or a ``distance`` [m].

    By a ``range`` their ways are so long [rad or m]: from their lower limit, or evenly about the middle where the joint
    is symmetric now. They go farther than before only where nothing is in the way; see `may_go`.

    Raises:
        InputError: One of them goes less far.
    """
    if how == "range":
        return _ranged(blueprint, names, much)
    values = {}
    for name in names:
        joint = blueprint.joint_above[name]
        value = much * (joint.upper + joint.value) if how == "share" else much
        turns = joint.kind.turns
        if how != "share" and turns is (how == "distance"):
            continue
        if joint.kind is JointType.FIXED or not (math.isfinite(value) and value <= joint.upper + joint.value + 1e-9):
            raise InputError(f"The joint of {name} does not open so far.")
        values[name] = value - joint.value
    return blueprint.moved(values)


def _ranged(blueprint: Blueprint, names: Sequence[str], much: float) -> Blueprint:
    """Return an object with the ranges of some joints so long [rad or m].

    Raises:
        InputError: Something is in the way of one of them, or it would leave its guide.
    """
    from kinematify.generate.procedural.clearance import may_go  # noqa: PLC0415 - with solids

    joints = list(blueprint.joints)
    for k, joint in enumerate(joints):
        if joint.child not in names:
            continue
        is_open = not math.isfinite(joint.upper - joint.lower)
        lower = 0.0 if is_open else joint.lower
        if math.isclose(joint.lower, -joint.upper):
            lower = -0.5 * much
        farther = not is_open and much > joint.upper - joint.lower
        if much <= 0.0 or (farther and not may_go(blueprint, joint.child, lower, lower + much)):
            raise InputError(f"The joint of {joint.child} does not go so far.")
        kind = JointType.REVOLUTE if joint.kind is JointType.CONTINUOUS else joint.kind
        joints[k] = replace(joint, kind=kind, lower=lower, upper=lower + much)
    return replace(blueprint, joints=tuple(joints))
