"""`kinematify erase`: a URDF with its kinematics removed."""

from __future__ import annotations

import shlex
from pathlib import Path

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import arguments_argument, examples, package_dirs_option


@click.command(
    "erase",
    epilog=examples(
        "kinematify erase franka/model.urdf -o panda-parts",
        "kinematify erase robot.urdf -o robot-parts --pose random --seed 3 --yaw 37",
        "kinematify erase go2_description/urdf/go2.urdf -o go2-parts --package-dir .",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@arguments_argument
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), help="Folder to make for the parts.")
@click.option(
    "--pose",
    type=click.Choice(["rest", "random"]),
    default="rest",
    show_default=True,
    help="Zero (or the middle of the limits where zero is outside), or each joint moved a little at random.",
)
@click.option("--seed", type=int, default=0, show_default=True, help="Seed of pose, order and names of the parts.")
@click.option("--yaw", type=float, default=0.0, show_default=True, metavar="DEG", help="Turn about the vertical axis.")
@click.option("--force", is_flag=True, help="Replace OUT if `kinematify erase` wrote it.")
@package_dirs_option
@json_option
def command(
    *,
    model: Path,
    arguments: dict[str, str],
    out: Path,
    pose: str,
    seed: int,
    yaw: float,
    force: bool,
    package_dirs: tuple[Path, ...],
    json_to: str | None,
) -> None:
    """Remove the kinematics of MODEL, a URDF or a model folder: the result is what a scan of the object would show.

    Links joined by fixed joints become one part. Order and names of the parts are shuffled. OUT is an input of
    `kinematify infer`; the ground truth is written beside it as OUT.truth.json and is never read by `infer`.
    """
    from kinematify.assembly.erasure import erase, write_erased
    from kinematify.model.output import urdf_of
    from kinematify.robot.read import read_robot

    robot = read_robot(urdf_of(model, package_dirs, arguments), package_dirs=package_dirs, geometry="shown")
    erased = erase(robot, pose=pose, seed=seed, yaw_deg=yaw)
    truth = write_erased(erased, out, overwrite=force)
    for note in robot.notes:
        click.echo(f"Note: {note}", err=True)
    answer = {"schema": 1, "out": str(out), "parts": len(erased.parts), "joints": len(erased.truth.joints)}
    if not write_answer({**answer, "truth": str(truth)}, json_to):
        return
    click.echo(
        f"{len(erased.parts)} parts in {out}, {len(erased.truth.joints)} joints erased. The ground truth: {truth}"
    )
    click.echo(f"Next: kinematify infer {shlex.quote(str(out))} -o {shlex.quote(f'{out}-model')}")
