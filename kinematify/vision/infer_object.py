"""`kinematify.infer`: parts, inference, answers and hints, motion repaired, and the folder that is written."""

from __future__ import annotations

import math
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.assembly.load import load_assembly
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.grouping.groups import Grouping, group_pieces, read_groups
from kinematify.model.output import MODEL_FILE, check_output, write_model_folder
from kinematify.pipeline.infer_assembly import infer as infer_assembly
from kinematify.pipeline.record import write_inference_files
from kinematify.processes.forked import using_processes
from kinematify.processes.lock import writing
from kinematify.refinement.hints import parse_hints, with_hints
from kinematify.refinement.loop import repaired
from kinematify.robot.lengths import length_text
from kinematify.validation.run.model_validation import start_validation, validated

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import Config
    from kinematify.config.validation import ValidationSettings
    from kinematify.pipeline.infer_assembly import Progress
    from kinematify.pipeline.inference import Inference
    from kinematify.vision.ask import PieceVote

_CHOSEN = 0.8
"""Share of the inference after which joints are inferred."""
_INFERRED, _WRITTEN = 0.5, 0.8
"""Shares of the whole time after the inference, and after the files and the picture."""


def infer(
    assembly: Assembly | Grouping | str | Path,
    out: str | Path | None = None,
    *,
    up: str = "auto",
    scale: float | None = None,
    labels: str | Path | None = None,
    pieces: str = "auto",
    groups: str | Path | None = None,
    number: int | None = None,
    density: float | None = None,
    masses: Mapping[str, float] | None = None,
    base: str | None = None,
    hints: Sequence[str] = (),
    config: str | Path | Config = "default",
    seed: int | None = None,
    jobs: int | None = None,
    vlm: str = "off",
    answer: str | Path | None = None,
    overwrite: bool = False,
    preview: bool = True,
    validation: bool = True,
    settings: ValidationSettings | None = None,
    progress: Progress | None = None,
) -> Inference:
    """Infer the kinematic tree and all joints of an assembly, as `kinematify infer` does.

    Pieces of a mesh that is not segmented become rigid parts first. Where the motion of a joint fails by exact
    geometry, ranges end before it, and joints are chosen again once; each change is among the warnings.

    Args:
        assembly: What `kinematify.load_assembly` returns, or the file or folder that it reads.
        out: Folder to make for the model, which is then validated: `Inference.report`. Nothing is written if absent.
        up: Axis of a file that points up, as `kinematify.load_assembly` takes it; so are the next three and `number`.
        scale: Metres per unit of a file.
        labels: File with the part of every face of a mesh.
        pieces: How parts come about.
        groups: groups.json of an earlier model of the same mesh, corrected: the pieces of every part.
        number: Which object of a mesh that shows several.
        density: Of all parts [kg/m^3]; what files say, or that of plastic, if absent.
        masses: Masses of parts that are known, by name [kg].
        base: Name of the part that is the base link, where it is known.
        hints: What is known of joints, as it is typed behind ``--hint``.
        config: All stages: a shipped name, a file or the configuration; its seed makes the answer reproducible.
        seed: Of everything random, instead of the configuration's.
        jobs: Processes at a time; as many as there are cores if absent. The answer is the same for any number.
        vlm: Vision-language model that is asked which pieces are one part: ``off``, ``auto`` or its address.
        answer: The same, as a person or a chat answered `kinematify question`.
        overwrite: Replace `out` if it is a model folder.
        preview: Draw a picture into `out`.
        validation: Validate the model in `out`.
        settings: Of the validation of motions; the shipped ones if absent.
        progress: Called with the name of each stage and the share of the work done before it, in [0, 1].

    Raises:
        InputError: `base`, a mass or a hint names no part or cannot be read; both `groups` and `answer` are given.
        AssemblyError: The file or folder cannot become an assembly.
        OutputError: `out` exists and must not be replaced, or cannot be written.
        EnvironmentFault: A process died or failed.
    """
    chosen, folder = load_config(config, seed=seed), None if out is None else Path(out)
    show, share = progress or (lambda stage, done: None), 1.0 if folder is None else _INFERRED

    def report(stage: str, done: float) -> None:
        show(stage, share * done)

    if folder is not None:
        check_output(folder, overwrite=overwrite)
    if chosen.joints.method == "cavl":  # its tensors are small: more threads cost time and change last digits
        import torch  # noqa: PLC0415 - of the paper alone

        torch.set_num_threads(1)
    with using_processes(jobs), nullcontext() if folder is None else writing(folder):
        if folder is not None and validation:
            start_validation()
        if isinstance(assembly, str | Path):
            report("reading the parts", 0.0)
            assembly = load_assembly(
                assembly, config=chosen.assembly, up=up, scale=scale, labels=labels, pieces=pieces, number=number
            )
            show(_lengths(assembly), 0.0)
        parts, vote = _parts(assembly, chosen, report, vlm=vlm, groups=groups, answer=answer)
        names = (parts.assembly if isinstance(parts, Grouping) else parts).names
        model = chosen.model.model_copy(update={"density": density, "masses": _masses(masses or {}, names)})
        chosen = chosen.model_copy(update={"model": model})
        stated = parse_hints(hints, names, base=base)
        base = base or (vote.base if vote else None)
        inference = infer_assembly(
            parts, config=chosen, base=base, progress=lambda stage, done: report(stage, _CHOSEN * min(done, 0.99))
        )
        if vote is None and any(joint.confidence < chosen.vision.ask_below for joint in inference.joints):
            report("choosing joints" if vlm == "off" else "asking about the parts", _CHOSEN)
            vote = _asked(inference.assembly, vlm, None, chosen)
        inference = vote.applied(inference) if vote else inference
        inference = with_hints(inference, stated) if stated else inference
        report("moving every joint", _CHOSEN)
        inference = repaired(inference, settings=settings)
        if folder is not None:
            write_model_folder(
                folder,
                lambda place: write_inference_files(
                    inference, place, preview=preview,
                    progress=lambda stage, done: show(stage, _INFERRED + (_WRITTEN - _INFERRED) * done),
                ),
                overwrite=overwrite,
            )  # fmt: skip
        if folder is None or not validation:
            return inference
        show("checking the geometry and loading the file into engines", _WRITTEN)
        inference = replace(inference, report=validated(folder / MODEL_FILE))
        show("done", 1.0)
        return inference


def _lengths(assembly: Assembly) -> str:
    """Return the size of an object and how its lengths were read."""
    size = " x ".join(length_text(float(side)) for side in assembly.bounds[1] - assembly.bounds[0])
    return f"Lengths: {size} (x, y, z), read as {assembly.lengths}"


def _parts(
    given: Assembly | Grouping,
    config: Config,
    progress: Progress,
    *,
    vlm: str,
    groups: str | Path | None,
    answer: str | Path | None,
) -> tuple[Assembly | Grouping, PieceVote | None]:
    """The rigid parts of what was read, and what was answered about its pieces."""
    if groups and answer:
        raise InputError("--groups and --answer both say which pieces are one part. Give one of them.")
    vote = None
    if isinstance(given, Assembly):
        if answer or not (given.segmented or groups):
            progress("reading the parts" if vlm == "off" else "asking about the pieces", 0.0)
            vote = _asked(given, vlm, answer, config)
        if groups is not None:
            return read_groups(Path(groups), given), vote
        if not given.segmented:
            progress("grouping the pieces", 0.0)
            return (vote.grouping(config) if vote else group_pieces(given, config.grouping)), vote
    return given, vote


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
