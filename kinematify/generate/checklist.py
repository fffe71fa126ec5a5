"""A checklist of what a sentence asks for, as typed facts that geometry measures."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field, ValidationError

from kinematify.errors import InputError
from kinematify.generate.delivery import (
    OWN_LOOK,
    SHOWN,
    closed,
    is_coupled,
    names_called,
    part_faults,
    size_faults,
    stem_of,
)
from kinematify.generate.library.kind import Kind
from kinematify.generate.procedural.blueprint_file import problems
from kinematify.generate.procedural.materials import MATERIALS
from kinematify.generate.request import PartRequest, listed

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint

_RELATIONS = {
    "above": (2, 1), "below": (2, -1), "left of": (0, -1), "right of": (0, 1), "behind": (1, 1), "in front of": (1, -1),
}  # fmt: skip
"""Axis and sign."""


class Fact(PartRequest):
    """One thing that is asked for."""

    phrase: str = Field(description="Words of the user.")
    parts: tuple[str, ...] = Field((), description="Names of the parts that are it; none for the whole.")
    relation: (
        Literal["above", "below", "left of", "right of", "behind", "in front of", "between", "inside", "coupled to"]
        | None
    ) = Field(
        None,
        description="Of the middle of each of them to the middles of all others; inside: to their box; coupled to: one "
        "joint leads all of both.",
    )
    to: tuple[str, ...] = Field((), description="Names of the parts that the relation is to.")
    extended: bool = Field(False, description="The size of the whole is not that closed, but with all joints at upper.")


def read_facts(values: Any) -> tuple[Fact, ...]:
    """Return the facts of a checklist.

    Raises:
        InputError: One of them does not fit.
    """
    if not isinstance(values, list) or not values:
        raise InputError('The answer has no "checklist". List each thing that the user asks for as a fact.')
    try:
        return tuple(Fact.model_validate(item) for item in values)
    except ValidationError as error:
        raise InputError(f"A fact of the checklist cannot be used: {problems(error)}.") from error


def broken_facts(blueprint: Blueprint, facts: Sequence[Fact], family: Kind | None = None) -> list[str]:
    """Return what of a checklist does not hold of an object, one line each; one joint serves one fact of motion.

    A fact that says how far something moves may be beside one that says how it does.
    """
    kind = family or Kind(name="object", title="object", words=("object",), parameters=(), make=lambda *_: None)
    found = [f"{fact.phrase!r}: {why}" for fact in facts for why in _broken(blueprint, fact, kind)]
    moving: dict[tuple[Any, ...], str] = {}
    for fact in facts:
        names = sorted(_names(blueprint, fact.parts, kind))
        if names and (fact.motion or fact.range):
            other = moving.setdefault((*names, fact.range is None), fact.phrase)
            if other != fact.phrase:
                found.append(
                    f"{fact.phrase!r}: {', '.join(names)} already serves {other!r}; if both say the same motion, make "
                    "them one fact, else give it a part of its own"
                )
    return found


def _names(blueprint: Blueprint, nouns: Sequence[str], kind: Kind) -> set[str]:
    own = {part.name for part in blueprint.parts}
    return {name for noun in nouns for name in ([noun] if noun in own else names_called(kind, blueprint, noun))}


def _broken(blueprint: Blueprint, fact: Fact, kind: Kind) -> Iterator[str]:
    shut = closed(blueprint)
    names, to = (_names(blueprint, nouns, kind) for nouns in (fact.parts, fact.to))
    parts, its = ([part for part in shut.parts if part.name in some] for some in (names, to))
    if fact.parts:
        if not names and fact.count != 0:
            there = dict.fromkeys(stem_of(part.name) for part in shut.parts)
            yield f"no part is called {' or '.join(fact.parts)}; there are {listed(list(there))}"
            return
        yield from part_faults(kind, blueprint, fact.parts[0], sorted(names), fact)
    else:
        yield from size_faults(_extended(blueprint) if fact.extended else blueprint, fact.size)
        parts = [part for part in shut.parts if not _look(part).endswith(OWN_LOOK)]
    coupled = is_coupled(blueprint, [*names, *to])
    if (
        fact.relation
        and parts
        and not (its and (coupled if fact.relation == "coupled to" else _stand(fact.relation, parts, its)))
    ):
        others = [part.name for part in its] or [f"{' or '.join(fact.to)}, which is no part"]
        yield f"{listed([part.name for part in parts])}: not {fact.relation} {listed(others)}"
    if (fact.color or fact.material) and parts:
        other = [part for part in parts if not _looks_so(part, fact)]
        share = sum(part.area for part in other) / sum(part.area for part in parts)
        if other and (fact.parts or share > SHOWN):
            wanted = " ".join(filter(None, (fact.color, fact.material)))
            yield f"{wanted} was asked for, it is {listed(sorted(set(map(_look, other))))}"


def _extended(blueprint: Blueprint) -> Blueprint:
    """The object as if it were closed with all joints at their upper ends."""
    ends = (replace(joint, value=-joint.upper if math.isfinite(joint.upper) else 0.0) for joint in blueprint.joints)
    return replace(blueprint, joints=tuple(ends))


def _look(part: Part) -> str:
    return part.appearance.materials[0].name if part.appearance else ""


def _looks_so(part: Part, fact: Fact) -> bool:
    """True if a part has the colour and the material of a fact; oak is wood, and steel is metal."""
    look = _look(part)
    made_of = look.split()[-1]
    group = {"grain": "wood", "metal": "metal"}.get(MATERIALS[made_of].surface)
    return (fact.color or "") in look and fact.material in (None, made_of, group)


def _stand(relation: str, parts: Sequence[Part], others: Sequence[Part]) -> bool:
    """True if the middle of each of some parts is so to the middles of all others, or inside of their box."""
    boxes = np.array([part.bounds for part in others])
    reached = boxes if relation == "inside" else boxes.mean(axis=1, keepdims=True)
    low, high = reached.min(axis=(0, 1)), reached.max(axis=(0, 1))
    middles = np.array([part.bounds.mean(axis=0) for part in parts])
    axis, sign = _RELATIONS.get(relation, (slice(3), 0))
    if relation == "between":
        axis = (high - low).argmax()
    at, ends = middles[:, axis], np.array([low, high])[:, axis]
    inside = (at - ends[0]) * (ends[1] - at) > 0.0
    return bool(np.all(sign * at > (sign * ends).max() if sign else inside))
