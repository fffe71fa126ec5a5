"""A candidate or a parent of the viewer becomes that of the model folder."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.errors import InputError
from kinematify.grouping.groups import GROUPS_FILE, Group, Grouping, stated_groups
from kinematify.model.output import check_output, write_model_folder
from kinematify.pipeline.infer_assembly import infer
from kinematify.refinement.folder import open_model_folder, read_record, stored_state, write_refined
from kinematify.refinement.hints import AXES, Hint, with_hints
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from kinematify.assembly.part import Assembly
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.arrays import FloatArray
    from kinematify.view.alternatives import JointAlternative

_ALONG = np.cos(np.radians(1.0))


@dataclass(frozen=True, kw_only=True)
class SavedEdit:
    """Files that were written."""

    hints: tuple[str, ...]
    """Of the joint that was chosen, as they are typed behind ``--hint``."""
    command: str
    """That infers the same model from its parts."""
    warnings: tuple[str, ...]
    """What the geometry says against it, one sentence each."""


class ModelFolder:
    """A model folder in which joints are chosen again; the inference is made when the first one is."""

    def __init__(self, folder: Path) -> None:
        """Keep the place; nothing is read yet."""
        self.folder = folder
        self._state: Inference | None = None
        self._before: list[tuple[Inference, dict[Path, bytes]]] = []
        """Model and content of the folder before each choice."""

    def keep(self, part: str, chosen: JointAlternative) -> SavedEdit:
        """Make a part move as a candidate says, and write the model.

        Raises:
            InputError: The folder holds no model of this version, or it was changed by hand.
            OutputError: The folder cannot be written; it is as it was.
        """
        return self._keep(lambda before: hint_of(part, chosen, _kind_of(before, part)))

    def state(self, hint: Hint) -> SavedEdit:
        """Follow a hint, and write the model; errors as those of `keep`, and that the hint cannot be followed."""
        return self._keep(lambda _: hint)

    def _keep(self, hint_for: Callable[[Inference], Hint]) -> SavedEdit:
        before = self._current_state()
        hint = hint_for(before)
        return self._write(before, with_hints(before, [hint]), hint.texts)

    def _current_state(self) -> Inference:
        """The model as it is in the folder."""
        check_output(self.folder, overwrite=True)
        if self._state is None:
            assembly, config = open_model_folder(self.folder)
            record = read_record(self.folder)
            inference = infer(assembly, config=config, base=record["trees"][0]["root"])
            left = stored_state(inference, record)
            self._state = replace(left, grouping=_stated_grouping(assembly, record)) if record["groups"] else left
        return self._state

    def _write(self, before: Inference, after: Inference, hints: tuple[str, ...]) -> SavedEdit:
        files = {file.relative_to(self.folder): file.read_bytes() for file in self.folder.rglob("*") if file.is_file()}
        write_refined(after, self.folder, preview=True)
        self._before.append((before, files))
        self._state = after
        new = tuple(warning for warning in after.warnings if warning not in before.warnings)
        return SavedEdit(hints=hints, command=self._command(after), warnings=new)

    @property
    def can_undo(self) -> bool:
        """True if a joint was chosen here."""
        return bool(self._before)

    def undo(self) -> None:
        """Write the folder as it was before the last choice, byte for byte.

        Raises:
            InputError: Nothing was chosen.
            OutputError: The folder cannot be written; it is as it was.
        """
        if not self.can_undo:
            raise InputError("Nothing was chosen here that could be taken back. Choose a candidate first.")
        before, files = self._before[-1]

        def restore(staging: Path) -> None:
            for name, content in files.items():
                (staging / name).parent.mkdir(parents=True, exist_ok=True)
                (staging / name).write_bytes(content)

        write_model_folder(self.folder, restore, overwrite=True)
        self._before.pop()
        self._state = before

    def _command(self, inference: Inference) -> str:
        hints = [word for text in inference.hints for word in ("--hint", text)]
        source, out = (inference.assembly.source, *inference.assembly.options), str(self.folder)
        groups = [] if inference.grouping is None else ["--groups", str(self.folder / GROUPS_FILE)]
        return shlex.join(["kinematify", "infer", *source, "-o", out, "--force", *groups, *hints])


def _stated_grouping(assembly: Assembly, record: dict[str, Any]) -> Grouping:
    """The grouping that a model folder states: its parts, and its `inference.json`."""
    known = {group.name: group for group in stated_groups(record, "parts")}
    return Grouping(
        assembly=assembly,
        groups=tuple(known.get(name, Group(name=name, pieces=(name,))) for name in assembly.names),
        rejected=stated_groups(record, "rejected"),
    )


def hint_of(part: str, chosen: JointAlternative, before: JointType) -> Hint:
    """Return the hint that says what a candidate is.

    Args:
        part: Name of the part that moves.
        chosen: The candidate.
        before: Type of the joint as it is: what turns without end goes on doing so.
    """
    if chosen.kind is JointType.FIXED:
        return Hint(part=part, kind=JointType.FIXED)
    named = next((name for name, way in AXES.items() if abs(float(chosen.axis @ np.array(way))) > _ALONG), None)
    axis = named if named is not None and chosen.limits is None else _numbers(chosen.axis)
    limits = None if chosen.limits is None else _numbers(np.array(chosen.limits)).replace(",", "..")
    if not chosen.kind.turns:
        return Hint(part=part, kind=JointType.PRISMATIC, axis=axis, limits=limits)
    kind = before if before.turns and not chosen.by_hand else chosen.kind
    return Hint(part=part, kind=kind, axis=axis, pivot=_numbers(chosen.pivot), limits=limits)


def _numbers(values: FloatArray) -> str:
    return ",".join(f"{value:.6g}" for value in values.round(6) + 0.0)


def _kind_of(inference: Inference, part: str) -> JointType:
    names = inference.assembly.names
    return next((joint.kind for joint in inference.joints if names[joint.child] == part), JointType.FIXED)
