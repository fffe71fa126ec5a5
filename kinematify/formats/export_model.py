"""A URDF in another format: the one place that knows which formats there are."""

from __future__ import annotations

import importlib
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.config.validation import load_settings
from kinematify.errors import InputError, OutputError
from kinematify.formats.content import read_content
from kinematify.formats.losses import losses
from kinematify.formats.reopen import check_target
from kinematify.model.output import check_file, urdf_of
from kinematify.processes.lock import writing
from kinematify.robot.description import notes_of
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.formats.losses import Loss

_WRITERS = {
    "mjcf": ("kinematify.formats.mjcf", "write_mjcf"),
    "usd": ("kinematify.formats.usd", "write_usd"),
    "sdf": ("kinematify.formats.sdf_format", "write_sdf"),
    "urdf": ("kinematify.formats.urdf_format", "write_urdf"),
    "glb": ("kinematify.formats.glb", "write_glb"),
    "srdf": ("kinematify.manipulation.srdf", "write_srdf"),
}
FORMATS = tuple(_WRITERS)
_SUFFIXES = {"mjcf": (".xml",), "usd": (".usd", ".usda", ".usdc")}
"""Ends of names by which the readers of a format know it, where they refuse others."""


@dataclass(frozen=True, kw_only=True)
class Exported:
    """Files that were written."""

    path: Path
    notes: tuple[str, ...]
    """What was made up or changed, one sentence each."""
    lost: tuple[Loss, ...]
    """What the format does not hold as it is, and what became of it."""

    def as_json(self) -> dict[str, Any]:
        """Path, notes and losses as plain values."""
        return {"path": str(self.path), "notes": list(self.notes), "lost": [asdict(loss) for loss in self.lost]}


def export(
    model: str | Path,
    to: str,
    out: str | Path,
    *,
    free: bool = False,
    tool: str | None = None,
    gripper: Sequence[str] = (),
    overwrite: bool = False,
    arguments: Mapping[str, str] | None = None,
    package_dirs: Sequence[str | Path] = (),
    seed: int | None = None,
    settings: ValidationSettings | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> Exported:
    """Write a URDF, xacro, MJCF, SDF or USD in another format, as `kinematify export` does.

    Args:
        model: The file, or a model folder of `kinematify infer` or `generate`.
        to: One of `FORMATS`.
        out: File to write; meshes go into a folder beside it where the format names files.
        free: The root link floats instead of being fixed to the world (mjcf, usd, sdf).
        tool: Link at the end of the arm (srdf); found by its fingers if not given.
        gripper: Joints of the fingers (srdf); found on the tool if not given.
        overwrite: Replace the file if it exists.
        arguments: Of a xacro.
        package_dirs: Where packages lie (``package://``).
        seed: Of the sampled configurations of pairs, instead of the settings'.
        settings: Of decomposition, masses and pairs; the shipped ones if None.
        progress: Called with what is being done and the share done.

    Raises:
        InputError: The model cannot be used, there is no such format, or it has no such option.
        OutputError: The file cannot be written.
        EnvironmentFault: The package that writes the format is not installed.
        ExportError: The target refuses what was written, or reads another model in it.
    """
    if to not in FORMATS:
        raise InputError(f"There is no format {to!r} to export to. Give one of {', '.join(FORMATS)}.")
    if to != "srdf" and (tool or gripper):
        raise InputError("--tool and --gripper belong to --to srdf. Leave them out.")
    if free and to in ("srdf", "glb", "urdf"):
        raise InputError("--free belongs to --to mjcf, usd or sdf. Leave it out.")
    path, known, folders = Path(out), _SUFFIXES.get(to), tuple(map(Path, package_dirs))
    check_file(path, overwrite=overwrite)
    with writing(path):
        if known and path.suffix.lower() not in known:
            raise OutputError(
                f"{path} would not be read as {to.upper()}: its name has to end with {' or '.join(known)}. "
                f"Give for example {path.with_suffix(known[0])}."
            )
        if progress is not None:
            progress("reading the model and fitting collision geometry", 0.0)
        urdf, chosen = urdf_of(Path(model), folders, arguments), load_settings(settings or "validation", seed=seed)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            if to == "srdf":
                return _srdf(urdf, path, chosen, tool=tool, gripper=gripper, package_dirs=folders)
            if to == "urdf" and path.resolve() == urdf.resolve():
                raise InputError(f"{path} is the model itself. Give another file with -o.")
            content = read_content(urdf, to, chosen, package_dirs=folders)
            _writer(to)(content, path, free=free)
            check_target(content, to, path)
            return Exported(path=path, notes=(*notes_of(urdf), *content.notes), lost=losses(content, to))
        except OSError as error:
            reason = error.strerror or str(error)
            raise OutputError(f"{path} cannot be written: {reason}. Give a file in a folder that exists.") from error


def _srdf(
    urdf: Path, path: Path, settings: ValidationSettings, *, tool: str | None, gripper: Sequence[str],
    package_dirs: Sequence[Path],
) -> Exported:  # fmt: skip
    write_srdf = _writer("srdf")
    counts = write_srdf(urdf, path, settings, tool=tool, gripper=gripper, package_dirs=package_dirs)
    unchecked = ", ".join(f"{counts[reason]} {reason.lower()}" for reason in ("Adjacent", "Default", "Always", "Never"))
    note = f"Pairs of links without checks: {unchecked}; {counts['checked']} are left to check."
    return Exported(path=path, notes=(note,), lost=())


def _writer(to: str) -> Any:
    """The function that writes a format; its package is imported only when it is asked for."""
    if to == "usd":
        require("Writing USD", "usd-core")
    module, function = _WRITERS[to]
    return getattr(importlib.import_module(module), function)
