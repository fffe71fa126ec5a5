"""From steps to an object: they are carried out, and what they draw goes into a workshop as bodies and joints."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from kinematify.errors import InputError
from kinematify.generate.library.builder import CAREFUL, ObjectBuilder
from kinematify.generate.library.steps import Step, run_steps
from kinematify.generate.procedural.blueprint_file import BlueprintDescription, parents_first
from kinematify.generate.procedural.solids import SEGMENTS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import BlueprintJoint
    from kinematify.generate.procedural.blueprint_file import PartDescription
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

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
        builder = ObjectBuilder(name, style, values.rng if values.drawn else None)
        said = carried_out(steps(), builder, {key: values.value(key) for key in names})
        try:
            built = BlueprintDescription.model_validate(said)
        except ValidationError as error:
            reason = error.errors(include_url=False)[0]
            raise InputError(
                f"The {title} cannot be built so: {reason['msg']} at {'.'.join(map(str, reason['loc']))}."
            ) from error
        solids = {part.name: part.solid({}) for part in built.parts}
        joints = [replace(joint.joint(), value=joint.value) for joint in built.joints]
        put_together(solids, {part.name: part for part in built.parts}, joints, values, workshop)
        for loop in built.loops:
            workshop.closes(*loop.parts, loop.pivot)

    return build


def carried_out(steps: Sequence[Step], builder: ObjectBuilder, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return what steps describe, as a blueprint file says it.

    Raises:
        InputError: A step cannot be carried out; the message quotes it.
    """
    switched = {name: value == "yes" if value in ("yes", "no") else value for name, value in values.items()}
    try:
        run_steps(steps, builder, switched)
    except ValueError as error:
        raise InputError(f"The object {builder.name} cannot be built: {error}.") from error
    return builder.description()


def put_together(
    solids: Mapping[str, Manifold],
    looks: Mapping[str, PartDescription],
    joints: Sequence[BlueprintJoint],
    values: Values,
    workshop: Workshop,
) -> None:
    """Add parts and joints to a workshop; a joint whose `value` is not zero stands there unless it is to be open.

    The base link takes the material and the colour that are asked for, and so does what looks like it.
    """
    base = looks[next(iter(solids))]
    for name, solid in solids.items():
        look = looks[name]
        like_base = (look.material, look.color) == (base.material, base.color)
        asked = (values.choice("material"), values.choice("color")) if like_base else ("", "")
        color = look.color if isinstance(look.color, str) else None
        workshop.body(name, solid, material=None if asked[0] else look.material, color=asked[1] or color)
    for joint in parents_first(joints):
        share = joint.value / joint.upper if joint.value else 0.0
        workshop.hang(replace(joint, value=0.0), values.number("open") or share)
