"""Objects that files describe: each file in `objects/` is a blueprint with words for it, read as a family."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import yaml
from pydantic import Field

from kinematify.generate.blueprint_file import BlueprintDescription, parents_first
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import Family
from kinematify.generate.procedural.parameter import counted
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop

_FOLDER = Path(__file__).with_name("objects")


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

    def family(self) -> Family:
        """The object as a family that leaves nothing to choose but what every family does."""
        return Family(
            name=self.category,
            title=self.title,
            words=self.words,
            parameters=tuple(
                counted(f"{word}s", count, (count, count), "Belongs to it.", words=word)
                for word, count in self.details.items()
            ),
            material=self.parts[0].material,
            part_words=self.part_words,
            build=self._build,
        )

    def _build(self, values: Values, workshop: Workshop) -> None:
        for part in self.parts:
            base = part is self.parts[0]
            color = part.color if isinstance(part.color, str) else None
            workshop.body(part.name, part.solid(), material=None if base else part.material, color=color)
        for joint in parents_first([item.joint() for item in self.joints]):
            rest = values.number("open")
            if joint.kind.turns:
                limits = None if joint.kind is JointType.CONTINUOUS else (joint.lower, joint.upper)
                workshop.turns(joint.child, joint.parent, joint.axis, joint.pivot, limits, rest=rest)
            else:
                workshop.slides(
                    joint.child, joint.parent, joint.axis, joint.pivot, (joint.lower, joint.upper), rest=rest
                )


@cache
def known_families() -> Mapping[str, Family]:
    """All families: those that programs build, then those that files describe."""
    files = sorted(_FOLDER.glob("*.yaml"))
    described = (ObjectDescription.model_validate(yaml.safe_load(file.read_text(encoding="utf-8"))) for file in files)
    return {**FAMILIES, **{item.category: item.family() for item in described}}
