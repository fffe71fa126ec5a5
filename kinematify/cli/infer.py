"""`kinematify infer`: segmented meshes in, a model folder out."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.asking import vlm_option
from kinematify.cli.inferred import (
    describe,
    describe_lengths,
    describe_validation,
    estimates,
    load_validation,
    renamed,
    validated,
    validation_answer,
    validation_status,
)
from kinematify.cli.options import collision_option, examples, pieces_option, scale_option, up_option, with_collision
from kinematify.cli.progress import progress_reporter
from kinematify.errors import EnvironmentFault, ExitStatus, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.cli.progress import Reporter
    from kinematify.config import Config
    from kinematify.errors import KinematifyError
    from kinematify.grouping.groups import Grouping
    from kinematify.pipeline.inference import Inference
    from kinematify.processes.pool import WorkerProcess
    from kinematify.refinement.hints import Hint
    from kinematify.robot.robot import Joint
    from kinematify.validation.run.report import ValidationReport
    from kinematify.vision.ask import PieceVote

_INFERRED, _REFINED, _WRITTEN, _DRAWN = 0.4, 0.5, 0.75, 0.8
"""Shares of the whole time after the inference, the refinement, the files and the picture."""
_LONGEST = 86400.0
"""So long is waited for the engines, whose stages have limits of their own [s]."""


@click.command(
    "infer",
    short_help="Segmented meshes -> URDF with joints, axes, limits and masses.",
    epilog=examples(
        "kinematify infer examples/cabinet -o out/cabinet",
        "kinematify infer robot.glb -o out/robot --up z --base torso",
        "kinematify infer examples/cabinet -o out/cabinet --hint knob=prismatic --hint door_left:axis=z",
        "kinematify infer scan.ply --labels labels.npy -o out/scan --scale 0.001",
        "kinematify infer whole.glb --pieces group -o out/whole",
        "kinematify infer whole.glb --answer Q/answer.json -o out/whole",
        "kinematify infer whole.glb --pieces group --groups out/whole/groups.json -o out/corrected",
        "kinematify infer parts.zip -o out/parts --config paper --seed 7",
        "kinematify infer parts/ -o out/parts --vlm http://localhost:11434/v1",
        "kinematify infer examples/cabinet -o out/cabinet --force --json - > answer.json",
    ),
)
@click.argument("assembly", type=click.Path(path_type=Path))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), help="Folder to make for the model.")
@up_option
@scale_option
@click.option(
    "--labels",
    type=click.Path(path_type=Path),
    help="NPY or JSON file with the part of every face, if ASSEMBLY is one mesh.",
)
@pieces_option
@click.option(
    "--groups",
    type=click.Path(path_type=Path),
    help="groups.json of an earlier model of the same mesh, corrected: the pieces (or parts) of every part.",
)
@click.option(
    "--object",
    "number",
    type=click.IntRange(min=1),
    metavar="N",
    help="Which object, from left to right, of a mesh that shows several.",
)
@click.option(
    "--density",
    type=click.FloatRange(min=0.0, min_open=True),
    metavar="KG/M3",
    help="Density of all parts; without it materials in the files, else that of plastic, with walls where they are "
    "hollow.",
)
@click.option("--mass", "masses", multiple=True, metavar="PART=KG", help="Mass of a part. Several may be given.")
@click.option("--base", metavar="NAME", help="Part that the tree is rooted at, if the choice made is wrong.")
@click.option(
    "--hint",
    "hints",
    multiple=True,
    metavar="PART=TYPE|PART:fixed|PART:axis=x|PART:pivot=X,Y,Z|PART:range=A..B|PART:parent=LINK|PART:twin=PART",
    help="What you know of a joint: its type, the direction of its axis (or X,Y,Z), a point that a hinge goes through "
    "[m], its range [rad or m, or 0..90deg, 0..300mm], what the part hangs on, the part whose joint it mirrors or "
    "repeats. It decides. Several may be given.",
)
@click.option(
    "--config", default="default", show_default=True, metavar="NAME|FILE", help="Shipped or own configuration."
)
@click.option("--seed", type=int, help="Seed of everything random, instead of the configuration's.")
@vlm_option
@click.option(
    "--answer",
    type=click.Path(path_type=Path),
    help="Which pieces are one moving part, as a person or a chat answered `kinematify question`.",
)
@collision_option
@click.option("--force", is_flag=True, help="Replace OUT if it is a model folder.")
@click.option("--no-preview", is_flag=True, help="Write no picture.")
@click.option("--no-validation", is_flag=True, help="Do not check the model or load it into engines.")
@json_option
def command(
    *,
    assembly: Path,
    out: Path,
    up: str,
    scale: float | None,
    labels: Path | None,
    pieces: str,
    groups: Path | None,
    number: int | None,
    density: float | None,
    masses: tuple[str, ...],
    base: str | None,
    hints: tuple[str, ...],
    config: str,
    seed: int | None,
    vlm: str,
    answer: Path | None,
    collision: str | None,
    force: bool,
    no_preview: bool,
    no_validation: bool,
    json_to: str | None,
) -> int:
    """Infer the joints of ASSEMBLY and write OUT, a folder with a URDF and its meshes.

    ASSEMBLY is the object in one pose, as rigid parts: a folder with a mesh file per part (OBJ, STL, PLY, GLB, OFF,
    DAE), a GLB, glTF or DAE with a node per part, an OBJ with groups, a 3MF, a STEP, a ZIP of these, one mesh with
    --labels, or a URDF, whose joints are ignored. The pieces of a
    mesh that is not segmented are grouped into rigid parts; correct groups.json in OUT and give it with --groups to
    change them.

    OUT gets model.urdf, meshes/, inference.json (every alternative with its evidence) and preview.png.

    Where the motion of a joint fails by exact geometry, joints are chosen again once. Then OUT is checked (file,
    masses, geometry, and the file as engines load it): the last line is the verdict. The command ends with 1 if the
    model has an error, with 3 if an engine failed, or with --vlm if the vision model gave no answer. OUT is written in
    all cases.
    """
    from contextlib import ExitStack

    from kinematify.processes.lock import writing
    from kinematify.processes.pool import WorkerProcess
    from kinematify.processes.start import ONE_THREAD, environment_variables, worker_context

    with environment_variables(ONE_THREAD):
        from kinematify.assembly.load import load_assembly
        from kinematify.config import load_config
        from kinematify.model.output import check_output
        from kinematify.pipeline.infer_assembly import infer
        from kinematify.refinement import repaired

    check_output(out, overwrite=force)
    settings = load_config(config) if seed is None else load_config(config, seed=seed)
    settings = with_collision(settings, collision)
    with ExitStack() as stack:
        stack.enter_context(writing(out))
        beside = None
        if not no_validation:
            beside = WorkerProcess(worker_context())
            stack.callback(beside.stop)
            beside.submit(load_validation, _LONGEST)  # beside the inference
        progress = stack.enter_context(progress_reporter())
        use_one_thread(settings)
        progress("reading the parts", 0.0)
        given = load_assembly(
            assembly, config=settings.assembly, up=up, scale=scale, labels=labels, pieces=pieces, number=number
        )
        click.echo(describe_lengths(given), err=True)
        parts, eyes = _asked_parts(given, groups, (vlm, answer), settings, progress)
        settings = _weighing(settings, density, masses, parts)
        stated = _parsed(hints, _names(parts), base)
        base = base or (eyes.base if eyes else None)
        inference = infer(
            parts, config=settings, base=base, progress=lambda stage, done: progress(stage, _INFERRED * min(done, 0.99))
        )
        if eyes is None and any(joint.confidence < settings.vision.ask_below for joint in inference.joints):
            progress("asking about the parts" if vlm != "off" else "choosing joints", _INFERRED)
            eyes = _asked(inference.assembly, vlm, None, settings)
        inference = eyes.applied(inference) if eyes else inference
        inference = _with_hints(inference, stated)
        progress("moving every joint", _INFERRED)
        inference = repaired(inference, base=base)
        report = _written(inference, out, overwrite=force, preview=not no_preview, beside=beside, progress=progress)
        progress("done", 1.0)
    if json_to:
        write_answer({**_as_answer(inference, out), **validation_answer(report)}, json_to)
    if json_to != "-":
        blocks = (eyes.described() if eyes else "", describe(inference, out), describe_validation(report, out))
        click.echo("\n\n".join(block for block in blocks if block))
    return int(ExitStatus.FAULT) if eyes and eyes.answer.fault else validation_status(report)


def _asked_parts(
    given: Assembly, groups: Path | None, asked: tuple[str, Path | None], settings: Config, progress: Reporter
) -> tuple[Assembly | Grouping, PieceVote | None]:
    """The parts, and what a file or a model (`asked`: --vlm and --answer) said of their pieces.

    Raises:
        InputError: Both a groups file and an answer are given.
    """
    vlm, answer = asked
    if groups and answer:
        raise InputError("--groups and --answer both say which pieces are one part. Give one of them.")
    known = answer is None and (given.segmented or groups)
    progress("reading the parts" if vlm == "off" else "asking about the pieces", 0.0)
    eyes = None if known else _asked(given, vlm, answer, settings)
    if eyes is None or given.segmented:
        return grouped_parts(given, groups, settings, progress), eyes
    return eyes.grouping(settings), eyes


def _asked(given: Assembly, vlm: str, answer: Path | None, settings: Config) -> PieceVote | None:
    if answer is None and vlm == "off":  # what draws a sheet takes time to load
        return None
    from kinematify.vision.ask import ask_pieces

    return ask_pieces(given, vlm, answer, settings)


def _names(parts: Assembly | Grouping) -> Sequence[str]:
    from kinematify.grouping.groups import Grouping

    return parts.assembly.names if isinstance(parts, Grouping) else parts.names


def _weighing(settings: Config, density: float | None, masses: Sequence[str], parts: Assembly | Grouping) -> Config:
    """The settings with the density and the masses that were given.

    Raises:
        InputError: A mass is not ``PART=KG``, or there is no such part.
    """
    stated = {}
    for text in masses:
        part, _, number = text.rpartition("=")
        try:
            stated[part] = float(number)
        except ValueError:
            stated[part] = math.nan
        if part not in _names(parts) or not 0.0 < stated[part] < math.inf:
            raise InputError(
                f"--mass {text} is not the name of a part and its mass in kg, such as {_names(parts)[0]}=1.5. "
                f"The parts are {', '.join(_names(parts)[:12])}."
            )
    model = settings.model.model_copy(update={"density": density, "masses": stated})
    return settings.model_copy(update={"model": model})


def grouped_parts(
    given: Assembly, groups: Path | None, settings: Config, progress: Callable[[str, float], None]
) -> Assembly | Grouping:
    """The parts as they were given, or pieces grouped as a file says or as it is likely."""
    from kinematify.grouping.groups import group_pieces, read_groups

    if groups is not None:
        return read_groups(groups, given)
    if given.segmented:
        return given
    progress("grouping the pieces", 0.0)
    return group_pieces(given, settings.grouping)


def _parsed(hints: Sequence[str], parts: Sequence[str], base: str | None) -> Sequence[Hint]:
    if not hints:  # refinement takes a quarter of a second to load
        return ()
    from kinematify.refinement.hints import parse_hints

    return parse_hints(hints, parts, base=base)


def _with_hints(inference: Inference, stated: Sequence[Hint]) -> Inference:
    if not stated:
        return inference
    from kinematify.refinement.hints import with_hints

    return with_hints(inference, stated)


def use_one_thread(config: Config) -> None:
    """Keep torch to one thread: DW-CAVL's tensors are small, so that more threads cost time and change last digits."""
    if config.joints.method == "cavl":
        import torch

        torch.set_num_threads(1)


def _written(
    inference: Inference, out: Path, *, overwrite: bool, preview: bool, beside: WorkerProcess | None, progress: Reporter
) -> ValidationReport | KinematifyError | None:
    """Write the model folder, its picture while engines load the model, and return what is wrong with the model."""
    from kinematify.model.output import MODEL_FILE, write_model_folder
    from kinematify.pipeline.record import write_inference_files, write_preview

    found: Any = None

    def write(folder: Path) -> None:
        nonlocal found
        progress("fitting collision geometry and writing the files", _REFINED)
        write_inference_files(inference, folder, preview=False)
        if beside is not None:
            beside.submit(partial(validated, folder / MODEL_FILE), _LONGEST)
        if preview:
            progress("drawing the picture", _WRITTEN)
            write_preview(inference, folder)
        if beside is not None:
            progress("checking the geometry and loading the file into engines", _DRAWN)
            found = _last_answer(beside)

    write_model_folder(out, write, overwrite=overwrite)
    from kinematify.processes.pool import TaskFailure

    if not isinstance(found, TaskFailure):
        answer: ValidationReport | KinematifyError | None = found
        return answer
    return EnvironmentFault(f"The engines ended before they had answered: {found.message}.")


def _last_answer(worker: WorkerProcess) -> Any:
    """Return the answer to the second of two tasks; the first one loads what that needs."""
    from kinematify.processes.pool import wait_for

    alive = True
    for _ in range(2):
        if alive:
            wait_for([worker])
            answer, alive = worker.result()
    return answer


def _as_answer(inference: Inference, out: Path) -> dict[str, Any]:
    return {
        "schema": 1,
        "out": str(out),
        "files": sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()),
        "base": inference.model.root,
        "lengths": inference.assembly.lengths,
        "renamed": renamed(inference.assembly),
        "joints": [_joint_answer(inference, joint) for joint in inference.model.joints],
        "set_aside": [{"name": item.part.name, "reason": item.reason} for item in inference.assembly.set_aside],
        "warnings": list(inference.warnings),
        "closed_chains": [chain.description for chain in inference.closed_chains],
        "seconds": dict(inference.timings),
        "vision": None if inference.vision is None else dict(inference.vision),
    }


def _joint_answer(inference: Inference, joint: Joint) -> dict[str, Any]:
    return {
        "name": joint.name,
        "type": joint.kind.value,
        "parent": joint.parent,
        "child": joint.child,
        "axis": joint.axis.tolist(),
        "lower": joint.lower if math.isfinite(joint.lower) else None,
        "upper": joint.upper if math.isfinite(joint.upper) else None,
        **{key: getattr(estimates(inference)[joint.child], key) for key in ("confidence", "stops")},
    }
