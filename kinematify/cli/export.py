"""`kinematify export`: a URDF as another format."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import (
    arguments_argument,
    examples,
    force_file_option,
    listed,
    package_dirs_option,
    sampling_seed_option,
)
from kinematify.cli.progress import progress_reporter
from kinematify.cli.table import format_table


@click.command(
    "export",
    epilog=examples(
        "kinematify export model.urdf --to mjcf -o model.xml",
        "kinematify export out/cabinet --to mjcf -o cabinet.xml --json losses.json",
        "kinematify export model.urdf --to usd -o model.usda",
        "kinematify export model.urdf --to urdf -o for_engines.urdf",
        "kinematify export dog/model.urdf --to sdf -o dog.sdf --free",
        "kinematify export fetch/model.urdf --to srdf -o fetch.srdf --tool gripper_link",
        "kinematify export robot.urdf --to srdf -o robot.srdf --tool hand --gripper left_finger,right_finger",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@arguments_argument
@click.option(
    "--to",
    required=True,
    type=click.Choice(["mjcf", "usd", "sdf", "urdf", "glb", "srdf"]),
    help="Format to write.",
)
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), metavar="FILE", help="File to write.")
@click.option("--free", is_flag=True, help="The root link floats; it is fixed to the world if not given.")
@click.option("--tool", metavar="LINK", help="Link at the end of the arm; found by its fingers if not given.")
@click.option(
    "--gripper",
    callback=listed,
    metavar="JOINTS",
    help="Joints of the fingers, separated by commas; found on the tool if not given.",
)
@force_file_option
@json_option
@package_dirs_option
@sampling_seed_option
def command(*, json_to: str | None, **given: Any) -> int:
    """Write MODEL, a URDF, xacro, MJCF, SDF, USD or a model folder, in another format.

    The answer lists what the format cannot express, and what was written instead.

    mjcf, usd, sdf: links, joints, limits, masses, colours and collision pieces for MuJoCo, Isaac Sim and Gazebo. Where
    the meshes that collide are not convex, the pieces are those that `kinematify fix` makes, carved by the motion. Only
    pairs that interpenetrate at rest do not collide. mjcf, sdf and urdf have their meshes in a folder beside the file.

    urdf: the same model with these pieces; `kinematify fix` keeps the document's comments and order, too.

    glb: visual geometry in a tree of nodes with the joints as origins, for viewers and game engines.

    srdf: planning groups, end effector and named poses for MoveIt, and the pairs of links that it need not check, each
    with its reason: neighbours, in contact at rest, always or never in contact in sampled configurations.
    """
    from kinematify.formats.export_model import export

    with progress_reporter() as progress:
        done = export(**given, progress=progress)
    if not write_answer(done.as_json(), json_to):
        return 0
    click.echo(f"Wrote {done.path}")
    for sentence in done.notes:
        click.echo(f"  {sentence}")
    if done.lost:
        rows = [(loss.what, str(loss.count), loss.became) for loss in done.lost]
        click.echo(
            "\n" + format_table((f"changed or lost in {given['to'].upper()}", "count", "what became of it"), rows)
        )
    return 0
