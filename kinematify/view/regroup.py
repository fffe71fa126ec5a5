"""Parts of a model are named or merged, as on the page."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.assemble import part_names
from kinematify.errors import InputError
from kinematify.grouping.groups import Group, Grouping, grouped_as, stated_groups
from kinematify.refinement.hints import parse_hints

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.pipeline.inference import Inference


def stated_grouping(assembly: Assembly, record: dict[str, Any]) -> Grouping:
    """The grouping that a model folder states; without one every part is a piece of its own.

    Args:
        assembly: The parts of the folder.
        record: Its `inference.json`.
    """
    known = {group.name: group for group in stated_groups(record, "parts")}
    return Grouping(
        assembly=assembly,
        groups=tuple(known.get(name, Group(name=name, pieces=(name,))) for name in assembly.names),
        rejected=stated_groups(record, "rejected"),
    )


def merge_parts(grouping: Grouping, names: Sequence[str]) -> Grouping:
    """Make one part of several; it has the name of the largest.

    Raises:
        InputError: A name is no part, or nothing would move afterwards.
    """
    assembly = grouping.assembly
    for name in names:
        _check_part(assembly, name)
    if len(set(names)) < 2 or len(assembly.parts) - len(set(names)) < 1:
        raise InputError("Two parts or more are merged, and another one remains. Choose two of three or more parts.")
    inside = [name in names for name in assembly.names]
    first = inside.index(True)
    indices = [
        np.flatnonzero(inside) if k == first else np.array([k])
        for k in range(len(inside))
        if k == first or not inside[k]
    ]
    return grouped_as(grouping, indices)


def rename_part(inference: Inference, grouping: Grouping, name: str, new: str) -> Inference:
    """Give a part, and so its link, another name; nothing is inferred again.

    Args:
        inference: Of these parts.
        grouping: Of the parts.
        name: The part.
        new: Letters, digits, ``_``, ``-`` and ``.``.

    Raises:
        InputError: It is no part, or no other one can have the new name.
    """
    assembly = grouping.assembly
    _check_part(assembly, name)
    names = [new if other == name else other for other in assembly.names]
    if part_names(names) != tuple(names):
        raise InputError(
            f"{name} cannot be named {new!r}: a name consists of letters, digits, _, - and ., and no other part has it."
        )
    word = re.compile(rf"(?<![\w.-]){re.escape(name)}(?![\w-])")

    def renamed(value: Any) -> Any:
        if isinstance(value, str):
            return word.sub(new, value)
        if isinstance(value, Mapping):
            return {renamed(key): renamed(item) for key, item in value.items()}
        return type(value)(map(renamed, value)) if isinstance(value, list | tuple) else value

    found = grouped_as(grouping, [np.array([k]) for k in range(len(names))], names=names)
    swap: dict[str | None, Any] = {name: new}
    hints = [
        replace(
            hint,
            part=swap.get(hint.part, hint.part),
            parent=swap.get(hint.parent, hint.parent),
            twin=swap.get(hint.twin, hint.twin),
        )
        for hint in parse_hints(inference.hints, assembly.names)
    ]
    stated = {key: renamed(getattr(inference, key)) for key in ("warnings", "refinement", "vision")}
    texts = tuple(text for hint in hints for text in hint.texts)
    return replace(inference, assembly=found.assembly, grouping=found, hints=texts, **stated)


def _check_part(assembly: Assembly, name: str) -> None:
    if name not in assembly.names:
        raise InputError(f"There is no part {name}. The parts are {', '.join(assembly.names[:20])}.")
