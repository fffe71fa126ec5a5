"""`kinematify fix`: what `validate` finds in a URDF, repaired where the repair is certain."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.answer import json_option, write_answer
from kinematify.cli.options import arguments_argument, examples, force_file_option, package_dirs_option
from kinematify.cli.progress import progress_reporter

if TYPE_CHECKING:
    from kinematify.refinement.repair import Fix, ModelSnapshot


@click.command(
    "fix",
    epilog=examples(
        "kinematify fix robot.urdf -o robot_fixed.urdf",
        "kinematify fix cabinet/model.urdf -o cabinet/fixed.urdf --package-dir packages",
        "kinematify fix door.urdf -o out/door.urdf --kinematics",
        "kinematify fix robot.urdf -o fixed.urdf --json - > changes.json",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@arguments_argument
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), metavar="FILE", help="File to write.")
@click.option(
    "--all",
    "everything",
    is_flag=True,
    help="Give every link collision pieces, and a mass where it has no usable one, even without a finding.",
)
@click.option(
    "--kinematics",
    is_flag=True,
    help="Change joints too: swapped limits, limits beyond a contact, a zero axis, an axis that leads into the "
    "parent. Each change is shown as a diff.",
)
@force_file_option
@package_dirs_option
@json_option
def command(*, json_to: str | None, **given: Any) -> int:
    """Write MODEL as a URDF in which certain findings of `validate` are fixed.

    MODEL is a URDF, xacro, MJCF, SDF, USD or a model folder; what the URDF does not hold of it is listed.

    Links that jam or overlap by their collision geometry alone get boxes and convex pieces, carved by the motion; a
    mass or inertia that no engine can use becomes that of the geometry; of repeated elements the first stays. Mesh
    paths are relative to the new file. Nothing else changes: no friction, no damping, no mass where there was none, no
    link or joint without a finding; comments and order stay. The command lists what it did not fix, with the reason,
    and writes no file where there is nothing to change. Its last line counts both.

    Where an engine refuses meshes in glTF or COLLADA, the new file names copies as OBJ.

    The result is validated and loaded raw again. Ends with 0; with 1 if an error stays, if an engine that opens MODEL
    does not open the result, or if fewer joints move in an engine than before, which are named; with 2 if MODEL cannot
    be used.
    """
    from kinematify.validation.isolation import load_imports

    load_imports()  # before anything loads NumPy
    from kinematify.refinement.repair import fix
    from kinematify.robot.description import notes_of

    with progress_reporter() as progress:
        done = fix(**given, progress=progress)
    if write_answer(done.as_json(), json_to):
        urdf = Path(done.before.report.model)
        for note in notes_of(urdf):
            click.echo(note)
        _say(done, urdf.name)
    return done.exit_status


def _say(done: Fix, model: str) -> None:
    from kinematify.simulation.engines import ENGINES

    click.echo(f"Wrote {done.path}" if done.written else f"Nothing is changed: {done.path} is not written.")
    for sentence in done.changes:
        click.echo(f"  {sentence}")
    for diff in done.diffs:
        click.echo(f"  {diff.title}")
        click.echo("\n".join(f"    {line}" for line in diff.lines.splitlines()))
    for sentence in done.left:
        click.echo(f"  {sentence}")
    click.echo(f"before: {_verdict(done.before)}")
    if done.written:
        click.echo(f"after:  {_verdict(done.after)}")
    for engine, (was, now) in done.regressions.items():
        click.echo(
            f"{ENGINES[engine].title} moves {now} joints of the result and {was} of {model}; no longer: "
            f"{', '.join(done.kept[engine])}. Use {model} there, or undo the changes of their links."
        )
    for engine in done.removed:
        click.echo(f"{ENGINES[engine].title} no longer opens {done.path.name}: {done.after.refusals[engine]}")
    click.echo(done.summary)


def _verdict(look: ModelSnapshot) -> str:
    from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES

    opened = [
        f"{ENGINES[name].title} {'does not open it' if name in look.refusals else 'opens it'}"
        for name in DEFAULT_ENGINES
    ]
    found = f"{look.report.verdict.upper()}, errors {look.errors}, warnings {look.warnings}"
    return f"{found}; {', '.join(opened)}" + (f"; {look.report.as_loaded}" if look.report.as_loaded else "")
