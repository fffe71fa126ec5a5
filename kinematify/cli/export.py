"""`kinematify export`: a URDF as another format."""

from __future__ import annotations

from pathlib import Path

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
    "form",
    required=True,
    type=click.Choice(["mjcf", "usd", "sdf", "urdf", "glb", "srdf"]),
    help="Format to write.",
)
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), metavar="FILE", help="File to write.")
@click.option("--free", is_flag=True, help="The root link floats; it is fixed to the world if not given.")
@click.option("--tool", metavar="LINK", help="Link at the end of the arm; found by its fingers if not given.")
@click.option(
    "--gripper", metavar="JOINTS", help="Joints of the fingers, separated by commas; found on the tool if not given."
)
@force_file_option
@json_option
@package_dirs_option
@sampling_seed_option
def command(
    *,
    model: Path,
    arguments: dict[str, str],
    form: str,
    out: Path,
    free: bool,
    tool: str | None,
    gripper: str | None,
    force: bool,
    json_to: str | None,
    package_dirs: tuple[Path, ...],
    seed: int | None,
) -> None:
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
    from kinematify.config.validation import load_settings
    from kinematify.formats.export_model import export
    from kinematify.model.output import check_file, urdf_of
    from kinematify.processes.lock import writing

    if form != "srdf" and (tool or gripper):
        raise click.UsageError("--tool and --gripper belong to --to srdf. Leave them out.")
    if free and form in ("srdf", "glb", "urdf"):
        raise click.UsageError("--free belongs to --to mjcf, usd or sdf. Leave it out.")
    check_file(out, overwrite=force)
    model = urdf_of(model, package_dirs, arguments)
    joints = listed(gripper)
    settings = load_settings() if seed is None else load_settings(seed=seed)
    with writing(out), progress_reporter() as progress:
        progress("reading the model and fitting collision geometry", 0.0)
        out.parent.mkdir(parents=True, exist_ok=True)
        done = export(
            model,
            form,
            out,
            free=free,
            tool=tool,
            gripper=joints,
            package_dirs=package_dirs,
            settings=settings,
        )
    if not write_answer(done.as_json(), json_to):
        return
    click.echo(f"Wrote {done.path}")
    for sentence in done.notes:
        click.echo(f"  {sentence}")
    if done.lost:
        rows = [(loss.what, str(loss.count), loss.became) for loss in done.lost]
        click.echo("\n" + format_table((f"changed or lost in {form.upper()}", "count", "what became of it"), rows))
