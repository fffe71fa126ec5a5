"""Parts of a model are merged or split on the page, before its joints are inferred again."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.assemble import part_names
from kinematify.assembly.part import Part
from kinematify.assembly.pieces import connected_sheets
from kinematify.errors import InputError
from kinematify.grouping.groups import Group, Grouping, joined_pieces, stated_groups
from kinematify.robot.raw_mesh import RawMesh

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.assembly.part import Assembly


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
    return _with_parts(grouping, joined_pieces(assembly, indices), indices)


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


def _check_part(assembly: Assembly, name: str) -> None:
    if name not in assembly.names:
        raise InputError(f"There is no part {name}. The parts are {', '.join(assembly.names[:20])}.")


def _with_parts(grouping: Grouping, assembly: Assembly, indices: Sequence[Any]) -> Grouping:
    groups = [
        Group(
            name=part.name,
            pieces=tuple(piece for k in index for piece in grouping.groups[k].pieces),
            moves=grouping.groups[index[0]].moves if len(index) == 1 else None,
        )
        for part, index in zip(assembly.parts, indices, strict=True)
    ]
    return replace(grouping, assembly=assembly, groups=tuple(groups))


class GroupPanel:
    """Two parts that were clicked last, with buttons that merge or split them, below the other buttons of the page."""

    def __init__(
        self,
        gui: Any,
        *,
        merge: Callable[[str, str], object],
        split: Callable[[str], object],
        free: Callable[[Sequence[str]], object],
        rejected: Sequence[Group],
    ) -> None:
        """Add the folder.

        Args:
            gui: Of viser.
            merge: Makes one part of two.
            split: Makes the pieces of a part parts.
            free: Makes one part of pieces that were taken for fixed.
            rejected: Sets of pieces that may move.
        """
        self._clicked: list[str] = []
        sets = {f"{group.name} ({group.moves:.0%}), {len(group.pieces)} pieces": group.pieces for group in rejected}
        with gui.add_folder("Parts as they were grouped", expand_by_default=False):
            gui.add_markdown("Click two parts to merge them, or one to split it.")
            self._merge = gui.add_button("Merge", disabled=True)
            self._split = gui.add_button("Split", disabled=True)
            if sets:
                may = gui.add_dropdown("May move", tuple(sets))
                gui.add_button("It is a moving part").on_click(lambda _: free(sets[may.value]))
        self._merge.on_click(lambda _: merge(*self._clicked))
        self._split.on_click(lambda _: split(self._clicked[-1]))

    def click(self, name: str) -> None:
        """Choose a part; the one before it remains chosen as well."""
        self._clicked = [*(other for other in self._clicked if other != name), name][-2:]
        self._split.disabled, self._split.label = False, f"Split {name} into its pieces"
        self._merge.disabled = len(self._clicked) < 2
        if not self._merge.disabled:
            self._merge.label = f"Merge {' and '.join(self._clicked)}"
