"""Kinds that a blueprint lists: a file in `kinds/` holds one, and says how people call it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from kinematify.generate.library.kind import Kind
from kinematify.generate.procedural.blueprint_file import (
    MIRRORS,
    BlueprintDescription,
    Name,
    Repetition,
    Vector,
)
from kinematify.generate.procedural.parameter import Parameter, details_of, parse_table, phrases

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from kinematify.generate.procedural.blueprint import BlueprintJoint
    from kinematify.generate.procedural.builder import ObjectBuilder
    from kinematify.generate.procedural.parameter import Value
    from kinematify.robot.arrays import FloatArray


_NO_LENGTHS = phrases("rpy, axis, mimic, count, revolute, sides, upright, counts, details, walls, unit")
"""Fields of which nothing is a length."""


class CopyDescription(BaseModel):
    """More of a part elsewhere, with its joint and all that it carries; ``wheel_1`` is followed by ``wheel_2``."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    like: Name
    moved: tuple[Vector, ...] = ()
    """One more for each [m]."""
    mirrored: Literal["x", "y", "z"] | None = None
    """One more across the plane through the world's origin that this axis is normal to."""
    repeated: Repetition | None = None
    """How often it stands there in all; the first one moves where it is repeated over a way."""

    def transforms(self, counts: Mapping[str, int]) -> list[FloatArray]:
        """Where they are, seen from the first as it is given, which is the first of them, each of shape (3, 4)."""
        found = [np.eye(3, 4)] if self.repeated is None else self.repeated.transforms(counts)
        found += [np.column_stack([np.eye(3), step]) for step in self.moved]
        if self.mirrored:
            normal = np.array(MIRRORS[self.mirrored])
            found.append(np.column_stack([np.eye(3) - 2.0 * np.outer(normal, normal), np.zeros(3)]))
        return found


class CountParameters(BaseModel):
    """Names and counts of a blueprint in a request."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    title: str = ""
    """A few words for lists; the first of its words if empty."""
    words: tuple[str, ...] = Field(min_length=1)
    """How people call it, singular."""
    part_words: dict[str, tuple[str, ...]] = Field({})
    """How people call its parts, besides their names."""
    details: dict[str, int] = Field({})
    """Word for what belongs to a part -> how many of it there are."""

    walls: float | None = None
    """Of `Kind`."""

    unit: int = 1
    """How many of the file's lengths are a metre: 1000 where it is in millimetres."""

    category: Name
    counts: dict[str, dict[str, Any]] = Field({})
    """Word for what repeats -> how often it may; named where a shape or a copy is repeated."""

    def as_kind(self, make: Callable[..., None]) -> Kind:
        """The object as a kind that leaves nothing to choose but its counts and what every kind does."""
        return Kind(
            name=self.category,
            title=self.title or self.words[0],
            words=self.words,
            parameters=details_of(self.details) + tuple(_repeated(word, said) for word, said in self.counts.items()),
            walls=self.walls,
            part_words=self.part_words,
            make=make,
        )


class ObjectDescription(CountParameters, BlueprintDescription):
    """A blueprint that sentences may ask for; its first part is the base link."""

    category: Name = "described"
    copies: tuple[CopyDescription, ...] = ()
    """In this order; a later one may take up what an earlier one made."""

    def _refuse_unknown_count(self, repetition: Repetition) -> None:
        if isinstance(repetition.count, str) and repetition.count not in self.counts:
            raise ValueError(f"there is no count {repetition.count!r}; there are {', '.join(self.counts) or 'none'}")

    @model_validator(mode="after")
    def _copies_by_known_counts(self) -> ObjectDescription:
        for copy in self.copies:
            if copy.repeated is not None:
                self._refuse_unknown_count(copy.repeated)
        return self

    def make(self, builder: ObjectBuilder, values: Mapping[str, Value]) -> None:
        """Add the object to a builder; see `Kind.make`."""
        counts = {word: int(values[f"{word}s"]) for word in self.counts}
        looks = {part.name: (part.material, part.color) for part in self.parts}
        solids = {part.name: part.solid(counts) for part in self.parts}
        joints = {joint.child: joint.joint() for joint in self.joints}
        for copy in self.copies:
            carried = _carried(copy.like, joints)
            given = {name: (solids[name], joints[name]) for name in carried}
            for k, transform in enumerate(copy.transforms(counts)):
                names: dict[str, str] = {}
                for name in carried:
                    own = name.startswith(copy.like) and copy.like in names
                    copied = name.replace(copy.like, names[copy.like], 1) if own else _next_name(name, solids)
                    names[name] = name if k == 0 else copied
                    solid, joint = given[name]
                    looks[names[name]], solids[names[name]] = looks[name], solid.transform(transform)
                    joints[names[name]] = _joint_elsewhere(joint, names, transform)
        for name, solid in solids.items():
            builder.part(name, solid, look=looks[name])
        for joint in joints.values():
            builder.add_joint(joint)
        builder.arrange(str(values["material"]), str(values["color"]), float(values["open"]))


def _repeated(word: str, said: Mapping[str, Any]) -> Parameter:
    """The count of what a blueprint repeats."""
    words, bounds = (word, *said.get("words", ())), tuple(said["bounds"])
    return Parameter(name=f"{word}s", default=said["count"], bounds=bounds, help="So many.", words=words, drawn=False)


def _carried(name: str, joints: Mapping[str, BlueprintJoint]) -> list[str]:
    """A part and all that stands on it, parents first."""
    found = [name]
    for part in found:  # grows while it is walked
        found += [joint.child for joint in joints.values() if joint.parent == part]
    return found


def _next_name(name: str, taken: Mapping[str, object]) -> str:
    stem = name.rstrip("0123456789_")
    return next(found for k in range(2, len(taken) + 3) if (found := f"{stem}_{k}") not in taken)


def _joint_elsewhere(joint: BlueprintJoint, names: Mapping[str, str], transform: FloatArray) -> BlueprintJoint:
    """A joint of a copy; seen in a mirror, a turn goes round the other way."""
    turn = transform[:, :3]
    sense = np.linalg.det(turn) if joint.kind.turns else 1.0
    follows = joint.mimic and replace(joint.mimic, joint=names.get(joint.mimic.joint, joint.mimic.joint))
    return replace(
        joint,
        parent=names.get(joint.parent, joint.parent),
        child=names[joint.child],
        axis=sense * turn @ joint.axis,
        pivot=transform @ np.append(joint.pivot, 1.0),
        mimic=follows,
    )


def _in_metres(values: Any, unit: float) -> Any:
    """Divide all that is a length."""
    if isinstance(values, dict):
        return {key: item if key in _NO_LENGTHS else _in_metres(item, unit) for key, item in values.items()}
    if isinstance(values, list):
        return [_in_metres(item, unit) for item in values]
    return values if isinstance(values, str) else values / unit


def kind_in(file: Path) -> Kind:
    """Return the kind of a file, of which all but its heading is only read once one is built."""
    text = file.read_text(encoding="utf-8")

    @cache
    def described() -> ObjectDescription:
        table = _in_metres(parse_table(text), said.unit)
        return ObjectDescription.model_validate({"name": file.stem, "category": file.stem, **table})

    said = CountParameters.model_validate({"category": file.stem, **parse_table(text.partition("\nparts:\n")[0])})
    return said.as_kind(lambda *given: described().make(*given))
