"""Objects of the library as different people model them, for the fit: sizes are drawn, and a style of modelling."""

from __future__ import annotations

import zlib
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.generate.library.kind import KINDS
from kinematify.generate.procedural.builder import ModelingStyle, ObjectBuilder
from kinematify.generate.registry import all_kinds
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.library.kind import Kind
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.generate.procedural.parameter import Parameter, Value
    from kinematify.robot.arrays import FloatArray

_SEEDS = "library 4"
"""Namespace of the seeds: another one wherever the order of the draws changes."""


@cache
def corpus_kinds() -> Mapping[str, Kind]:
    """All kinds, and other ways to build some of them, keyed by name."""
    for file in sorted(Path(__file__).with_name("variants").glob("[a-z]*.py")):
        import_module(f"benchmarks.fit.variants.{file.stem}")
    return {**all_kinds(), **{name: item for name, item in KINDS.items() if item.like}}


DRAWN = tuple(sorted(name for name, item in corpus_kinds().items() if item.draw))
"""Names of the objects that a function draws, in any style of modelling."""


def drawn_object(name: str, seed: int, style: ModelingStyle | None = None) -> Blueprint:
    """Draw an object, turned about z by quarters and mirrored at random: no side is the front of everything.

    Args:
        name: Of `DRAWN`.
        seed: Draws sizes, and the style where none is given.
        style: How it is modelled.

    Raises:
        InputError: It cannot be built with what is drawn.
    """
    rng = np.random.default_rng([seed, zlib.crc32(f"{_SEEDS} {name}".encode())])
    someone = style_of_somebody(rng)
    built = _drawn_by(corpus_kinds()[name], style or someone, rng)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    mirrored = bool(rng.random() < 0.5)
    quarters = np.linalg.matrix_power(turn, int(rng.integers(4)))
    placed: FloatArray = quarters @ np.diag([-1.0 if mirrored else 1.0, 1.0, 1.0])
    parts = tuple(
        replace(part, vertices=part.vertices @ placed.T, faces=part.faces[:, ::-1] if mirrored else part.faces)
        for part in built.parts
    )
    return replace(built, parts=parts, joints=tuple(_seen(joint, placed, mirrored) for joint in built.joints))


def style_of_somebody(rng: np.random.Generator) -> ModelingStyle:
    """Draw how a person models."""

    def one_of(*options: Any) -> Any:
        return options[int(rng.integers(len(options)))]

    return ModelingStyle(
        gap=one_of(0.0, 0.0, 0.0005, 0.002, 0.005, 0.01),
        has_bore=one_of(True, False),
        hollow=one_of(True, True, False),
        sides=one_of(8, 12, 16, 24, 32, 48),
        grips=one_of("merged", "merged", "apart", "none"),
        barrels=one_of(True, False, False),
        max_penetration=one_of(0.0, 0.0, 0.2, 0.5),
        line=one_of(0.0, 0.5, 0.5, 1.0),
        drawer=one_of("tray", "tray", "block", "front"),
        wheel=one_of("disc", "disc", "tyre", "spokes"),
        knob=one_of("plain", "plain", "pointer", "bar", "ball", "star"),
        initial_opening=one_of(0.0, 0.0, 0.0, 0.1, 0.3, 0.6),
        rounded=one_of(False, False, False, True),
    )


def _drawn_by(family: Kind, style: ModelingStyle, rng: np.random.Generator) -> Blueprint:
    """An object of a kind that is drawn, with everything drawn."""
    assert family.draw is not None, family.name
    builder = ObjectBuilder(family.name, style, rng)
    taken = family.draw.__code__.co_varnames[: family.draw.__code__.co_argcount]
    given = {item.name: _some(item, builder) for item in family.parameters if item.name in taken}
    family.make(builder, {**given, "material": "", "color": "", "open": 0.0})
    return builder.finish()


def _some(asked: Parameter, builder: ObjectBuilder) -> Value:
    """A value for one more object of a corpus."""
    if asked.bounds is not None:
        low, high = asked.usual or asked.bounds
        return builder.count(int(low), int(high)) if isinstance(asked.default, int) else builder.draw(low, high)
    return str(builder.pick(*asked.choices)) if asked.yes is None else "yes" if builder.maybe(asked.yes) else "no"


def _seen(joint: BlueprintJoint, placed: FloatArray, mirrored: bool) -> BlueprintJoint:
    axis = placed @ joint.axis
    # In a mirror, what turns to the left turns to the right.
    turned_round = mirrored and joint.kind is not JointType.PRISMATIC
    return replace(joint, axis=-axis if turned_round else axis, pivot=placed @ joint.pivot)
