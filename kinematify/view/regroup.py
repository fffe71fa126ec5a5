"""Parts of a model are named, merged or split, as on the page."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.assemble import part_names
from kinematify.assembly.part import Part
from kinematify.assembly.pieces import connected_sheets
from kinematify.errors import InputError
from kinematify.grouping.groups import Group, Grouping, grouped_as, stated_groups
from kinematify.refinement.hints import parse_hints
from kinematify.robot.raw_mesh import RawMesh

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


def split_part(grouping: Grouping, name: str, *, tolerance: float, apart: Sequence[str] = ()) -> Grouping:
    """Make the connected pieces of a part parts of their own.

    Args:
        grouping: Parts and their pieces.
        name: The part.
        tolerance: Fraction of its diagonal below which vertices are one.
        apart: Names of the pieces that become one part, while the others remain together; none: every piece is a part.

    Raises:
        InputError: It is no part, or one connected piece.
    """
    assembly = grouping.assembly
    _check_part(assembly, name)
    place = assembly.names.index(name)
    whole = assembly.originals.get(name, assembly.parts[place])
    mesh = RawMesh(name=name, vertices=whole.vertices, faces=whole.faces, appearance=whole.appearance)
    sheets = connected_sheets(mesh, tolerance)
    stated = grouping.groups[place].pieces
    if len(sheets) < 2 or (apart and len(sheets) != len(stated)):
        raise InputError(
            f"The part {name} consists of {len(sheets)} connected piece{'s' if len(sheets) > 1 else ''}, so that it "
            "cannot be split so. Give --labels with the part of every face."
        )
    of_piece = stated if len(sheets) == len(stated) else [f"{name}_{k}" for k in range(1, len(sheets) + 1)]
    others = [other for other in assembly.names if other != name]
    new = part_names([*others, *of_piece])[len(others) :]
    pieces = [
        Part(
            name=piece,
            vertices=sheet.vertices,
            faces=sheet.faces,
            color=whole.color,
            appearance=sheet.appearance,
            density=whole.density,
        )
        for piece, sheet in zip(new, sheets, strict=True)
    ]
    parts = (*assembly.parts[:place], *pieces, *assembly.parts[place + 1 :])
    main = max(pieces, key=lambda piece: piece.area).name
    split = replace(
        assembly,
        parts=parts,
        originals={key: part for key, part in assembly.originals.items() if key != name},
        set_aside=tuple(replace(item, nearest=main) if item.nearest == name else item for item in assembly.set_aside),
    )
    groups = [Group(name=own, pieces=(piece,)) for own, piece in zip(new, of_piece, strict=True)]
    found = replace(grouping, assembly=split, groups=(*grouping.groups[:place], *groups, *grouping.groups[place + 1 :]))
    if not apart:
        return found
    for side in (True, False):
        together = [own for own, piece in zip(new, of_piece, strict=True) if (piece in apart) is side]
        found = merge_parts(found, together) if len(together) > 1 else found
    return found


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
