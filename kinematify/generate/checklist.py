"""A checklist of what a sentence asks for, as typed facts that geometry measures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field, ValidationError

from kinematify.errors import InputError
from kinematify.generate.delivery import closed, fits_size, names_called, part_faults
from kinematify.generate.library.kind import Kind
from kinematify.generate.request import PartRequest

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.generate.procedural.blueprint import Blueprint

_RELATIONS = {
    "above": (2, 1), "below": (2, -1), "left of": (0, -1), "right of": (0, 1), "behind": (1, 1), "in front of": (1, -1),
}  # fmt: skip


class Fact(PartRequest):
    """One thing that is asked for."""

    phrase: str = Field(description="Words of the user.")
    parts: tuple[str, ...] = Field((), description="Names of the parts that are it; none for the whole.")
    relation: Literal["above", "below", "left of", "right of", "behind", "in front of"] | None = None
    to: tuple[str, ...] = Field((), description="Names of the parts that the relation is to.")


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
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise InputError(f"A fact of the checklist cannot be used: {place}: {first['msg']}.") from error


def broken_facts(blueprint: Blueprint, facts: Sequence[Fact], family: Kind | None = None) -> list[str]:
    """Return what of a checklist does not hold of an object, one line each; one joint serves one fact of motion."""
    kind = family or Kind(name="object", title="object", words=("object",), parameters=(), make=lambda *_: None)
    found = [line for fact in facts for line in _broken(blueprint, fact, kind)]
    moving: dict[tuple[str, ...], str] = {}
    for fact in facts:
        names = tuple(sorted(_names(blueprint, fact.parts, kind)))
        if names and (fact.motion or fact.range) and moving.setdefault(names, fact.phrase) != fact.phrase:
            found.append(f"{fact.phrase!r}: {', '.join(names)} already serves {moving[names]!r}")
    return found


def _names(blueprint: Blueprint, nouns: Sequence[str], kind: Kind) -> set[str]:
    own = {part.name for part in blueprint.parts}
    return {name for noun in nouns for name in ([noun] if noun in own else names_called(kind, blueprint, noun))}


def _broken(blueprint: Blueprint, fact: Fact, kind: Kind) -> Iterator[str]:
    names = sorted(_names(blueprint, fact.parts, kind))
    if fact.parts and not names and fact.count != 0:
        yield f"{fact.phrase!r}: no part is called {' or '.join(fact.parts)}"
        return
    if not fact.parts:
        for size, wanted in fact.size.items():
            if not fits_size(blueprint, size, wanted):
                yield f"{fact.phrase!r}: the {size} of the whole is not {wanted:.3g} m"
        return
    yield from (f"{fact.phrase!r}: {why}" for why in part_faults(kind, blueprint, fact.parts[0], names, fact))
    others = _names(blueprint, fact.to, kind)
    if fact.relation and others:
        axis, sign = _RELATIONS[fact.relation]
        middle = {part.name: sign * float(np.mean(part.bounds, axis=0)[axis]) for part in closed(blueprint).parts}
        if min(middle[name] for name in names) <= max(middle[name] for name in others):
            yield f"{fact.phrase!r}: {', '.join(names)} is not {fact.relation} {', '.join(sorted(others))}"
