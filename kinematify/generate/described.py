"""Objects that files describe: each file in `objects/` is a blueprint with words for it, read as a family."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from kinematify.generate.blueprint_file import (
    MIRRORS,
    BlueprintDescription,
    Name,
    Repetition,
    Vector,
    parents_first,
)
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import Family
from kinematify.generate.procedural.parameter import counted, read_table
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.procedural.blueprint import BlueprintJoint
    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop
    from kinematify.robot.arrays import FloatArray

_FOLDER = Path(__file__).with_name("objects")


class CopyDescription(BaseModel):
    """More of a part elsewhere, with its joint and all that it carries; ``wheel_1`` is followed by ``wheel_2``."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    like: Name
    moved: tuple[Vector, ...] = ()
    """One more for each [m]."""
    mirrored: Literal["x", "y", "z"] | None = None
    """One more across the plane through the world's origin that this axis is normal to."""
    around: int = Field(1, ge=1, le=60)
    """So many in all, evenly about the world's z axis."""
    repeated: Repetition | None = None
    """How often it stands there in all; the first one moves where it is repeated over a way."""

    def transforms(self, counts: Mapping[str, int]) -> list[FloatArray]:
        """Where they are, seen from the first as it is given, which is the first of them, each of shape (3, 4)."""
        found = [np.eye(3, 4)] if self.repeated is None else self.repeated.transforms(counts)
        found += [np.column_stack([np.eye(3), step]) for step in self.moved]
        if self.mirrored:
            normal = np.array(MIRRORS[self.mirrored])
            found.append(np.column_stack([np.eye(3) - 2.0 * np.outer(normal, normal), np.zeros(3)]))
        for k in range(1, self.around):
            turn = rotation_about(np.array([0.0, 0.0, 1.0]), 2.0 * math.pi * k / self.around)
            found.append(np.column_stack([turn, np.zeros(3)]))
        return found


class CountDescription(BaseModel):
    """A number that a sentence may ask for."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    usual: int
    """If nothing is said."""
    range: tuple[int, int]
    """Fewest and most."""
    words: tuple[str, ...] = ()
    """How people call what is counted, besides the name of the count."""


class ObjectDescription(BlueprintDescription):
    """A blueprint that sentences may ask for; its first part is the base link."""

    title: str
    """A few words for lists."""
    words: tuple[str, ...] = Field(min_length=1)
    """How people call it, singular."""
    part_words: dict[str, tuple[str, ...]] = Field({})
    """How people call its parts, besides their names."""
    details: dict[str, int] = Field({})
    """Word for what belongs to a part -> how many of it there are."""
    counts: dict[str, CountDescription] = Field({})
    """Word for what repeats -> how often it may; named where a shape or a copy is repeated."""
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

    def family(self) -> Family:
        """The object as a family that leaves nothing to choose but its counts and what every family does."""
        return Family(
            name=self.category,
            title=self.title,
            words=self.words,
            parameters=tuple(
                counted(f"{word}s", count, (count, count), "Belongs to it.", words=word)
                for word, count in self.details.items()
            )
            + tuple(
                counted(
                    f"{word}s", said.usual, said.range, "So many.", words=", ".join((word, *said.words)), drawn=False
                )
                for word, said in self.counts.items()
            ),
            material=self.parts[0].material,
            part_words=self.part_words,
            build=self._build,
        )

    def _build(self, values: Values, workshop: Workshop) -> None:
        counts = {word: values.count(f"{word}s") for word in self.counts}
        looks = {part.name: part for part in self.parts}
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
        base = self.parts[0].name
        for name, solid in solids.items():
            look = looks[name]
            own = isinstance(look.color, str) and not (name == base and values.choice("color"))
            workshop.body(
                name, solid, material=None if name == base else look.material, color=str(look.color) if own else None
            )
        for joint in parents_first(list(joints.values())):
            workshop.hang(joint, values.number("open"))


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


@cache
def known_families() -> Mapping[str, Family]:
    """All families: those that programs build, then those that files describe."""
    files = sorted(_FOLDER.glob("*.yaml"))
    described = (ObjectDescription.model_validate(read_table(file)) for file in files)
    return {**FAMILIES, **{item.category: item.family() for item in described}}
