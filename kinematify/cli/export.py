"""`kinematify export`: a URDF as another format."""

from __future__ import annotations

from pathlib import Path

import click

from kinematify.cli.help import examples


@click.command(
    "export",
    short_help="URDF -> SRDF for MoveIt.",
    epilog=examples(
        "kinematify export robot.urdf --to srdf -o robot.srdf",
        "kinematify export fetch/model.urdf --to srdf -o fetch.srdf --tool gripper_link",
        "kinematify export robot.urdf --to srdf -o robot.srdf --tool hand --gripper left_finger,right_finger",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@click.option("--to", "form", required=True, type=click.Choice(["srdf"]), help="Format to write.")
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), metavar="FILE", help="File to write.")
@click.option("--tool", metavar="LINK", help="Link at the end of the arm; found by its fingers if not given.")
@click.option(
    "--gripper", metavar="JOINTS", help="Joints of the fingers, separated by commas; found on the tool if not given."
)
@click.option(
    "--package-dir",
    "package_dirs",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder in which package:// names are looked up; may be given more than once.",
)
@click.option("--seed", type=int, help="Seed of the sampled configurations, instead of the configuration's.")
def command(
    *,
    model: Path,
    form: str,
    out: Path,
    tool: str | None,
    gripper: str | None,
    package_dirs: tuple[Path, ...],
    seed: int | None,
) -> None:
    """Write the URDF MODEL in another format.

    srdf: planning groups, end effector and named poses for MoveIt, and the pairs of links that it need not check, each
    with its reason: neighbours, in contact at rest, always or never in contact in sampled configurations.
    """
    from kinematify.errors import OutputError
    from kinematify.validation.settings import load_settings
    from kinematify.validation.task.srdf import write_srdf

    del form  # there is one so far, and click has checked it
    settings = load_settings() if seed is None else load_settings(seed=seed)
    joints = tuple(word.strip() for word in (gripper or "").split(",") if word.strip())
    try:
        counts = write_srdf(model, out, settings, tool=tool, gripper=joints, package_dirs=package_dirs)
    except OSError as error:
        raise OutputError(f"{out} cannot be written: {error.strerror}. Give a file in a folder that exists.") from error
    told = ", ".join(f"{counts[reason]} {reason.lower()}" for reason in ("Adjacent", "Default", "Always", "Never"))
    click.echo(f"{out}: {told}; {counts['checked']} pairs of links are left to check.")
