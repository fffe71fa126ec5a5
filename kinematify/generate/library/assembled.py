"""From steps to an object: they are carried out, and what they draw goes into a workshop as bodies and joints."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.library.builder import CAREFUL, ObjectBuilder
from kinematify.generate.library.steps import Step, run_steps
from kinematify.generate.procedural.blueprint_file import parents_first
from kinematify.generate.procedural.solids import SEGMENTS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import BlueprintJoint
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Look, Workshop

MODELING: dict[str, dict[str, Any]] = {
    "careful": {},
    "gaps": {"gap": 0.005},
    "touching": {"gap": 0.0},
    "solid": {"has_bore": False, "hollow": False, "gap": 0.0},
    "overlapping": {"has_bore": False, "max_penetration": 0.3, "gap": 0.0},
}
"""How an object in steps is modelled -> what differs from the careful way, in which everything moves freely."""


def builder_of(
    name: str, title: str, steps: Callable[[], Sequence[Step]], parameters: Iterable[str]
) -> Callable[[Values, Workshop], None]:
    """Return the function that builds a family in steps.

    Args:
        name: Of the family.
        title: In messages.
        steps: In this order; read when the first one is built.
        parameters: Names that formulas may use; of a family with ``modeling`` they build in that style.
    """
    names = tuple(parameters)

    def build(values: Values, workshop: Workshop) -> None:
        differs = MODELING[values.choice("modeling")] if values.has("modeling") else {"sides": SEGMENTS}
        style = replace(CAREFUL, **{"gap": values.number("clearance"), **differs})
        builder = ObjectBuilder(name, style, workshop, values.rng if values.drawn else None)
        carried_out(steps(), builder, {key: values.value(key) for key in names}, values, workshop)

    return build


def carried_out(
    steps: Sequence[Step], builder: ObjectBuilder, given: Mapping[str, Any], values: Values, workshop: Workshop
) -> None:
    """Add to a workshop what steps draw.

    Args:
        steps: In this order.
        builder: Takes what they draw.
        given: What formulas may name.
        values: As for `put_together`.
        workshop: Where it is added.

    Raises:
        InputError: A step cannot be carried out; the message quotes it.
    """
    switched = {name: value == "yes" if value in ("yes", "no") else value for name, value in given.items()}
    try:
        run_steps(steps, builder, switched)
        solids = builder.solids()
    except ValueError as error:
        raise InputError(f"The object {builder.name} cannot be built: {error}.") from error
    put_together(solids, builder.looks, builder.joints, values, workshop)
    for loop in builder.loops:
        workshop.closes(*loop)


def put_together(
    solids: Mapping[str, Manifold],
    looks: Mapping[str, Look],
    joints: Sequence[BlueprintJoint],
    values: Values,
    workshop: Workshop,
) -> None:
    """Add parts and joints to a workshop; joints stand at their `value` unless they are to be open.

    The base link takes the material and the colour that are asked for, and so does what looks like it.
    """
    base = looks[next(iter(solids))]
    for name, solid in solids.items():
        material, color = looks[name]
        asked = (values.choice("material"), values.choice("color")) if looks[name] == base else ("", "")
        workshop.body(name, solid, material=None if asked[0] else material, color=asked[1] or color)
    for joint in parents_first(joints):
        workshop.hang(joint, values.number("open"))
