"""infer() as the command does it: what is known of an object, inference, answers about it, and its motion repaired."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.assembly.load import load_assembly
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.grouping.groups import Grouping, group_pieces, read_groups
from kinematify.pipeline.infer_assembly import infer as infer_assembly
from kinematify.refinement.hints import parse_hints, with_hints
from kinematify.refinement.loop import repaired

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import Config
    from kinematify.config.validation import ValidationSettings
    from kinematify.pipeline.infer_assembly import Progress
    from kinematify.pipeline.inference import Inference
    from kinematify.vision.ask import PieceVote

_INFERRED = 0.8
"""Share of the time after which joints are inferred."""


def infer(
    assembly: Assembly | Grouping | str | Path,
    *,
    groups: str | Path | None = None,
    answer: str | Path | None = None,
    vlm: str = "off",
    density: float | None = None,
    masses: Mapping[str, float] | None = None,
    base: str | None = None,
    hints: Sequence[str] = (),
    config: Config | None = None,
    settings: ValidationSettings | None = None,
    progress: Progress | None = None,
) -> Inference:
    """Infer the kinematic tree and all joints of an assembly, as `kinematify infer` does.

    Pieces of a mesh that is not segmented become rigid parts first. Where the motion of a joint fails by exact
    geometry, ranges end before it, and joints are chosen again once; each change is among the warnings.

    Args:
        assembly: What `kinematify.load_assembly` returns, or the file or folder that it reads.
        groups: groups.json of an earlier model of the same mesh, corrected: the pieces of every part.
        answer: Which pieces are one moving part, as a person or a chat answered `kinematify question`.
        vlm: Vision-language model that is asked the same: ``off``, ``auto`` or its address.
        density: Of all parts [kg/m^3]; what files say, or that of plastic, if absent.
        masses: Masses of parts that are known, by name [kg].
        base: Name of the part that is the base link, where it is known.
        hints: What is known of joints, as it is typed behind ``--hint``.
        config: All stages, the default ones if absent; `config.seed` makes the answer reproducible.
        settings: Of the validation of motions; the shipped ones if absent.
        progress: Called with the name of each stage and the share of the work done before it, in [0, 1].

    Raises:
        InputError: `base`, a mass or a hint names no part or cannot be read; both `groups` and `answer` are given.
        AssemblyError: The file or folder cannot become an assembly.
    """
    config, progress = config or load_config(), progress or (lambda stage, share: None)
    if isinstance(assembly, str | Path):
        assembly = load_assembly(assembly, config=config.assembly)
    if groups and answer:
        raise InputError("--groups and --answer both say which pieces are one part. Give one of them.")
    parts, vote = assembly, None
    if isinstance(parts, Assembly):
        if answer or not (parts.segmented or groups):
            progress("reading the parts" if vlm == "off" else "asking about the pieces", 0.0)
            vote = _asked(parts, vlm, answer, config)
        if groups is not None:
            parts = read_groups(Path(groups), parts)
        elif not parts.segmented:
            progress("grouping the pieces", 0.0)
            parts = vote.grouping(config) if vote else group_pieces(parts, config.grouping)
    names = (parts.assembly if isinstance(parts, Grouping) else parts).names
    model = config.model.model_copy(update={"density": density, "masses": _masses(masses or {}, names)})
    config = config.model_copy(update={"model": model})
    stated = parse_hints(hints, names, base=base)
    base = base or (vote.base if vote else None)
    inference = infer_assembly(
        parts, config=config, base=base, progress=lambda stage, done: progress(stage, _INFERRED * min(done, 0.99))
    )
    if vote is None and any(joint.confidence < config.vision.ask_below for joint in inference.joints):
        progress("choosing joints" if vlm == "off" else "asking about the parts", _INFERRED)
        vote = _asked(inference.assembly, vlm, None, config)
    inference = vote.applied(inference) if vote else inference
    inference = with_hints(inference, stated) if stated else inference
    progress("moving every joint", _INFERRED)
    return repaired(inference, base=base, settings=settings)


def _asked(given: Assembly, vlm: str, answer: str | Path | None, config: Config) -> PieceVote | None:
    if answer is None and vlm == "off":
        return None
    from kinematify.vision.ask import ask_pieces  # noqa: PLC0415 - what draws a sheet takes time to load

    return ask_pieces(given, vlm, None if answer is None else Path(answer), config)


def _masses(masses: Mapping[str, float], names: Sequence[str]) -> dict[str, float]:
    for part, mass in masses.items():
        if part not in names or not 0.0 < mass < math.inf:
            raise InputError(
                f"--mass {part}={mass:g} is not the name of a part and its mass in kg, such as {names[0]}=1.5. "
                f"The parts are {', '.join(names[:12])}."
            )
    return dict(masses)
