"""Kinds of objects in Python: a function with bounded parameters that draws with a builder, and the registry of all.

```python
@kind("moka pot", words="stovetop espresso maker, espresso pot", radius=length(0.035, 0.055), height=length(0.13, 0.2))
def moka_pot(b: ObjectBuilder, radius: float, height: float) -> None:
    b.part("pot", b.cylinder(radius, (0, 0, 0), (0, 0, height)), material="metal")
    b.part("lid", b.cylinder(radius, (0, 0, height + 0.001), (0, 0, height + 0.02)), material="metal")
    b.hinge("lid", parent="pot", axis=-X, pivot=(0, radius, height + 0.001), upper=1.7)
```

The name of the function is the name of the kind, less a ``_`` at its end. A function whose first parameter is a
`Workshop` carves instead: what it adds and cuts takes effect at once. Whether it names `open` or `clearance` besides
its parameters decides if it is given them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError
from kinematify.generate.library.builder import CAREFUL, ObjectBuilder
from kinematify.generate.procedural import parameter as parameters_of
from kinematify.generate.procedural.blueprint_file import parents_first
from kinematify.generate.procedural.family import Family, Values
from kinematify.generate.procedural.parameter import Parameter, details_of, phrases
from kinematify.generate.procedural.solids import SEGMENTS
from kinematify.generate.procedural.workshop import Workshop

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import BlueprintJoint
    from kinematify.generate.procedural.parameter import Value, Words
    from kinematify.generate.procedural.workshop import Look

MODELING: dict[str, dict[str, Any]] = {
    "careful": {},
    "gaps": {"gap": 0.005},
    "touching": {"gap": 0.0},
    "solid": {"has_bore": False, "hollow": False, "gap": 0.0},
    "overlapping": {"has_bore": False, "max_penetration": 0.3, "gap": 0.0},
}
"""How a drawn object is modelled -> what differs from the careful way, in which everything moves freely."""
KINDS: dict[str, Family] = {}
"""Kinds whose modules are imported, keyed by name."""
_HELP = "As the object has it."
_Range = tuple[float, float]


# ---- parameters ------------------------------------------------------------------------------------------------------


def length(low: float, high: float, *, unit: str = "m", default: float | None = None, **facts: Any) -> Parameter:
    """Return a bounded length [m].

    Args:
        low: The least that can be built.
        high: The most.
        unit: Another one, of what is no length.
        default: The middle if absent.
        facts: `usual` (the bounds that a seed draws from, all if absent), `help`, `words` and `drawn` of `Parameter`.
    """
    middle = float(f"{0.5 * (low + high):.3g}") if default is None else default
    return parameters_of.number("", middle, (low, high), **{"help": _HELP, "usual": (low, high), "unit": unit, **facts})


def angle(low: float, high: float, **facts: Any) -> Parameter:
    """Return a bounded angle [rad]; arguments as of `length`."""
    return length(low, high, unit="rad", **facts)


def share(low: float, high: float, **facts: Any) -> Parameter:
    """Return a bounded number without a unit; arguments as of `length`."""
    return length(low, high, unit="", **facts)


def whole(low: int, high: int, *, default: int | None = None, **facts: Any) -> Parameter:
    """Return a bounded count; arguments as of `length`."""
    middle = int(0.5 * (low + high)) if default is None else default
    return parameters_of.number("", middle, (low, high), **{"help": _HELP, "usual": (low, high), **facts})


def choice(choices: Sequence[str] | Mapping[str, str], *, help: str = _HELP, **facts: Any) -> Parameter:
    """Return one of several, the first if nothing is said; a mapping gives words for each."""
    return parameters_of.choice("", choices, help, **facts)


def yes(chance: float, *, help: str = _HELP, **facts: Any) -> Parameter:
    """Return what holds or not, in a share of what seeds draw."""
    usual = ("yes", "no") if chance >= 0.5 else ("no", "yes")
    return replace(parameters_of.choice("", usual, help, **facts), yes=chance)


# ---- kinds -----------------------------------------------------------------------------------------------------------


def kind(
    called: str,
    *,
    words: str = "",
    title: str = "",
    like: str = "",
    material: str = "plastic",
    part_words: Mapping[str, Words] | None = None,
    details: Mapping[str, int] | None = None,
    usual: Mapping[str, Mapping[str, Value]] | None = None,
    styles: bool = True,
    walls: float | None = None,
    **parameters: Parameter,
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Return a decorator that registers the function that draws a kind of object.

    Args:
        called: How people call it, singular.
        words: Other names, split at their commas.
        title: A few words for lists; `called` if empty.
        like: The kind that it is another way to build, which `all_kinds` leaves out; empty of a kind of its own.
        material: Of its base.
        part_words: Name of a part without its number -> how else people call it.
        details: Word for what belongs to a part -> how many of it there are.
        usual: Names, split at their commas -> what is usual of those that are called so.
        styles: It may be modelled in any of `MODELING`; of what is drawn alone.
        walls: Of `Family`.
        parameters: What may be asked for, under its name.
    """
    asked = tuple(replace(item, name=name) for name, item in parameters.items())

    def register(draw: Callable[..., None]) -> Callable[..., None]:
        name = draw.__name__.rstrip("_")
        if name in KINDS:
            raise ValueError(f"two kinds are called {name}")
        code = draw.__code__
        taken = code.co_varnames[1 : code.co_argcount]
        carves = draw.__annotations__[code.co_varnames[0]] == "Workshop"
        modeling = choice(tuple(MODELING), help="How it is modelled.", drawn=False)
        KINDS[name] = Family(
            name=name,
            title=title or called,
            words=(called, *phrases(words)),
            parameters=(
                *asked,
                *details_of(details or {}),
                *([replace(modeling, name="modeling")] if styles and not carves else ()),
            ),
            build=_carver(draw, taken) if carves else _drawer(draw, taken, name),
            material=material,
            walls=walls,
            kinds={word: what for group, what in (usual or {}).items() for word in phrases(group)},
            part_words={part: phrases(said) for part, said in (part_words or {}).items()},
            like=like,
            module=draw.__module__.rpartition(".")[2],
            draw=draw if styles and not carves else None,
        )
        return draw

    return register


def _carver(draw: Callable[..., None], taken: Sequence[str]) -> Callable[[Values, Workshop], None]:
    def build(values: Values, workshop: Workshop) -> None:
        draw(workshop, **{name: values.value(name) for name in taken})

    return build


def _drawer(draw: Callable[..., None], taken: Sequence[str], name: str) -> Callable[[Values, Workshop], None]:
    def build(values: Values, workshop: Workshop) -> None:
        differs = MODELING[values.choice("modeling")] if values.has("modeling") else {"sides": SEGMENTS}
        style = replace(CAREFUL, **{"gap": values.number("clearance"), **differs})
        builder = ObjectBuilder(name, style, workshop, values.rng if values.drawn else None)
        carry_out(draw, builder, {key: values.value(key) for key in taken}, values, workshop)

    return build


def carry_out(
    draw: Callable[..., None], builder: ObjectBuilder, given: Mapping[str, Value], values: Values, workshop: Workshop
) -> None:
    """Draw an object with what is given, and put it together in a workshop.

    Raises:
        InputError: It cannot be built.
    """
    switched = {name: value == "yes" if value in ("yes", "no") else value for name, value in given.items()}
    try:
        draw(builder, **switched)
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
        workshop.add_joint(joint, values.number("open"))
