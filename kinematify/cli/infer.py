"""`kinematify infer`: segmented meshes in, a model folder out."""

from __future__ import annotations

import math
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
from kinematify.cli.options import examples, pieces_option, scale_option, up_option
from kinematify.cli.progress import progress_reporter
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from kinematify.config import Config
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.robot import Joint

_INFERRED, _WRITTEN = 0.5, 0.8
"""Shares of the whole time after the inference and after the files and the picture."""


def _masses(_context: click.Context, _parameter: click.Parameter, given: tuple[str, ...]) -> dict[str, float]:
    """Masses [kg] by part; no number is a mass that none has."""
    masses = {}
    for text in given:
        part, _, number = text.rpartition("=")
        try:
            masses[part] = float(number)
        except ValueError:
            masses[part or text] = math.nan
    return masses


@click.command(
    "infer",
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
@click.option(
    "--mass", "masses", multiple=True, callback=_masses, metavar="PART=KG", help="Mass of a part. Several may be given."
)
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
    masses: dict[str, float],
    base: str | None,
    hints: tuple[str, ...],
    config: str,
    seed: int | None,
    vlm: str,
    answer: Path | None,
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
    from kinematify.processes.lock import writing
    from kinematify.processes.start import ONE_THREAD, environment_variables

    with environment_variables(ONE_THREAD):
        from kinematify.assembly.load import load_assembly
        from kinematify.config import load_config
        from kinematify.model.output import MODEL_FILE, check_output, write_model_folder
        from kinematify.pipeline.record import write_inference_files
        from kinematify.vision.infer_object import infer

    check_output(out, overwrite=force)
    settings = load_config(config) if seed is None else load_config(config, seed=seed)
    with writing(out), progress_reporter() as progress:
        if not no_validation:
            load_validation()
        use_one_thread(settings)
        progress("reading the parts", 0.0)
        given = load_assembly(
            assembly, config=settings.assembly, up=up, scale=scale, labels=labels, pieces=pieces, number=number
        )
        click.echo(describe_lengths(given), err=True)
        inference = infer(
            given, groups=groups, answer=answer, vlm=vlm, density=density, masses=masses, base=base, hints=hints,
            config=settings, progress=lambda stage, done: progress(stage, _INFERRED * done),
        )  # fmt: skip
        write_model_folder(
            out,
            lambda folder: write_inference_files(
                inference, folder, preview=not no_preview,
                progress=lambda stage, done: progress(stage, _INFERRED + (_WRITTEN - _INFERRED) * done),
            ),
            overwrite=force,
        )  # fmt: skip
        report = None
        if not no_validation:
            progress("checking the geometry and loading the file into engines", _WRITTEN)
            report = validated(out / MODEL_FILE)
        progress("done", 1.0)
    asked = inference.vision or {}
    if write_answer({**_as_answer(inference, out), **validation_answer(report)}, json_to):
        blocks = (asked.get("described", ""), describe(inference, out), describe_validation(report, out))
        click.echo("\n\n".join(block for block in blocks if block))
    return int(ExitStatus.FAULT) if asked.get("fault") else validation_status(report)


def use_one_thread(config: Config) -> None:
    """Keep torch to one thread: DW-CAVL's tensors are small, so that more threads cost time and change last digits."""
    if config.joints.method == "cavl":
        import torch

        torch.set_num_threads(1)


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
