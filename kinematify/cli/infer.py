"""`kinematify infer`: segmented meshes in, a model folder out."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.inferred import (
    describe,
    describe_validation,
    estimates,
    renamed,
    validation_answer,
    validation_status,
)
from kinematify.cli.options import (
    examples,
    jobs_option,
    pieces_option,
    preview_option,
    scale_option,
    up_option,
    validation_option,
    vlm_option,
)
from kinematify.cli.progress import progress_reporter
from kinematify.errors import ExitStatus

if TYPE_CHECKING:
    from kinematify.pipeline.inference import Inference
    from kinematify.robot.robot import Joint


def _masses(_context: click.Context, _parameter: click.Parameter, given: tuple[str, ...]) -> dict[str, float] | None:
    """Masses [kg] by part; no number is a mass that none has."""
    masses = {}
    for text in given:
        part, _, number = text.rpartition("=")
        try:
            masses[part] = float(number)
        except ValueError:
            masses[part or text] = math.nan
    return masses or None


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
@jobs_option
@vlm_option
@click.option(
    "--answer",
    type=click.Path(path_type=Path),
    help="Which pieces are one moving part, as a person or a chat answered `kinematify question`.",
)
@click.option("--force", "overwrite", is_flag=True, help="Replace OUT if it is a model folder.")
@preview_option
@validation_option
@json_option
def command(*, out: Path, json_to: str | None, **given: Any) -> int:
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
    from kinematify.processes.start import ONE_THREAD, environment_variables

    with environment_variables(ONE_THREAD):
        from kinematify.vision.infer_object import infer
    with progress_reporter() as progress:

        def show(stage: str, done: float) -> None:
            if stage.startswith("Lengths: "):  # which stays to be read
                click.echo(stage, err=True)
            else:
                progress(stage, done)

        inference = infer(out=out, **given, progress=show)
    asked = inference.vision or {}
    if write_answer({**_as_answer(inference, out), **validation_answer(inference.report)}, json_to):
        blocks = (
            asked.get("described", ""), describe(inference, out), describe_validation(inference.report, out)
        )  # fmt: skip
        click.echo("\n\n".join(block for block in blocks if block))
    return int(ExitStatus.FAULT) if asked.get("fault") else validation_status(inference.report)


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
