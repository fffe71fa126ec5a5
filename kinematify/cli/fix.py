"""`kinematify fix`: a URDF that engines simulate as they read it."""

from __future__ import annotations

from pathlib import Path

import click

from kinematify.cli.options import examples, package_dirs_option


@click.command(
    "fix",
    short_help="URDF -> the same URDF with collision geometry that leaves its joints free.",
    epilog=examples(
        "kinematify fix robot.urdf -o robot_fixed.urdf",
        "kinematify fix cabinet/model.urdf -o cabinet/fixed.urdf --package-dir packages",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), metavar="FILE", help="File to write.")
@package_dirs_option
def command(*, model: Path, out: Path, package_dirs: tuple[Path, ...]) -> None:
    """Write the URDF MODEL again so that engines can simulate it as it is loaded.

    Collision geometry becomes boxes and convex pieces, carved by the motion of every joint with a clearance; links
    without a usable mass get that of their geometry, and joints without friction and damping get both. Nothing else
    changes; comments and order stay. Where the surfaces themselves block a joint, the pieces do too, and it is said.
    """
    from kinematify.config import load_config
    from kinematify.config.validation import load_settings
    from kinematify.formats.fix import fix_urdf

    done = fix_urdf(model, out, load_config(), load_settings(), package_dirs=package_dirs)
    click.echo(f"Wrote {done.path}")
    for sentence in done.changes:
        click.echo(f"  {sentence}")
    for sentence in done.left:
        click.echo(f"  left: {sentence}")
