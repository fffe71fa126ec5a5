"""`kinematify view`: a model in a browser, with a slider per joint."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from kinematify.cli.options import (
    arguments_argument,
    complete_joints,
    examples,
    package_dirs_option,
    pieces_option,
    scale_option,
    up_option,
)
from kinematify.errors import InputError


@click.command(
    "view",
    epilog=examples(
        "kinematify view out/cabinet/model.urdf",
        "kinematify view out/cabinet",
        "kinematify view model.urdf --joint door_joint --q 0.8",
        "kinematify view model.urdf --joint door_joint --q 0.8 --png open.png",
        "kinematify view model.urdf --report report.json --port 8090",
        "kinematify view whole.glb --answer answer.json",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@arguments_argument
@click.option(
    "--joint",
    "joints",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_joints,
    help="Joint to move to the value of the --q that follows it.",
)
@click.option("--q", "values", multiple=True, type=float, metavar="VALUE", help="Its value [rad or m].")
@click.option("--png", type=click.Path(path_type=Path), metavar="FILE", help="Write a picture there, and show nothing.")
@package_dirs_option
@click.option(
    "--report",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="From `validate --json`: its findings become buttons.  [default: validation.json beside the model]",
)
@click.option(
    "--answer",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Of a mesh: where the button writes which pieces are one moving part.  [default: answer.json beside it]",
)
@up_option
@scale_option
@pieces_option
@click.option("--host", default="127.0.0.1", show_default=True, help="0.0.0.0 lets other machines in.")
@click.option(
    "--port", type=click.IntRange(0, 65535), default=8080, show_default=True, help="A free one if it is taken."
)
def command(*, model: Path, joints: tuple[str, ...], values: tuple[float, ...], **given: Any) -> int:
    """Show MODEL, a URDF, xacro, MJCF, SDF, USD, a model folder or a mesh, until Ctrl-C.

    Sliders move the joints; axes and limits are drawn; what collides is red. Where inference.json lies beside the
    model, the candidates of each joint are named, can be tried, and "Keep this" writes the model with one of them and
    shows the command that does the same. Over SSH, forward the port that is printed: ssh -L 8080:localhost:8080.

    Of a mesh that nobody segmented, the pieces are shown as `kinematify question` numbers them: click those of a moving
    part, and the line that it turns about or slides along. A button writes the answer for `infer MESH --answer`.
    """
    from kinematify.view.show_model import view

    if len(joints) != len(values):
        raise InputError(f"There are {len(joints)} --joint and {len(values)} --q. Give one value for each joint.")
    window = view(model, dict(zip(joints, values, strict=True)) or None, **given)
    if window is None:
        click.echo(f"Wrote {given['png']}")
        return 0
    for note in window.notes:
        click.echo(note)
    try:
        if given["port"] not in (0, window.port):
            click.echo(f"Port {given['port']} is in use, so {window.port} is taken.")
        click.echo(f"{window.url} shows {model.resolve()}; Ctrl-C ends it.")
        window.run()
    except KeyboardInterrupt:
        click.echo("Closed.")
    finally:
        window.close()
    return 0
