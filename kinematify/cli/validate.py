"""`kinematify validate`: a verdict on URDFs from anywhere, and why."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.options import examples, jobs_option, listed, package_dirs_option, sampling_seed_option, say
from kinematify.cli.progress import progress_reporter
from kinematify.errors import DescriptionError, ExitStatus
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.validation.finding import Suppression
    from kinematify.validation.run.report import Outcome


_REPORTS = ("json", "junit", "sarif", "html", "suggest_accept")
_OF_A_TASK = ("robot", "tool", "gripper", "grasp", "base", "scale", "films")


def _engines(context: click.Context, parameter: click.Parameter, words: str | None) -> tuple[str, ...] | None:
    """Engines by name; none for ``none``."""
    if words is None:
        return None
    return tuple(word.lower() for word in listed(context, parameter, words) if word.lower() != "none")


@click.command(
    "validate",
    epilog=examples(
        "kinematify validate model.urdf",
        "kinematify validate models/ 'more/**/*.urdf' --junit report.xml",
        "kinematify validate models/ --quick --fail-on warning",
        "kinematify validate model.urdf --html report.html --sarif report.sarif",
        "kinematify validate robot.urdf --package-dir ~/ros/src --engines mujoco,pinocchio",
        "kinematify validate model.urdf --checks 'KV3*,KV801' --skip KV305 --budget 10",
        "kinematify validate model.urdf --suggest-accept accepted.yaml",
        "kinematify validate model.urdf --suppress accepted.yaml --json - > answer.json",
        "kinematify validate cabinet.urdf --task pull",
        "kinematify validate cabinet.urdf --task pull --robot fetch.urdf --tool gripper_link --checks 'KV7*'",
    ),
)
@click.argument("models", nargs=-1, required=True, metavar="MODEL... [NAME:=VALUE]...")
@package_dirs_option
@click.option(
    "--checks", callback=listed, metavar="LIST", help="Only these: ids or patterns such as KV3*, separated by commas."
)
@click.option("--skip", callback=listed, metavar="LIST", help="All but these.")
@click.option(
    "--quick",
    is_flag=True,
    help="File, meshes, declared physics, each joint in motion by exact geometry, and the file in MuJoCo: seconds.",
)
@click.option(
    "--contract",
    is_flag=True,
    help="Also ask whether it rests on a floor in MuJoCo and its motors move its joints there.",
)
@click.option("--isaac", is_flag=True, help="Also list names that Isaac Sim changes, and its order of the joints.")
@click.option(
    "--fail-on",
    type=click.Choice([item.value for item in reversed(Severity)]),
    default=Severity.ERROR.value,
    show_default=True,
    help="Least severity of a finding that ends the command with 1.",
)
@click.option(
    "--engines",
    callback=_engines,
    metavar="LIST",
    show_default="all that are installed",
    help="Engines to run, separated by commas; none: only file and geometry.",
)
@click.option(
    "--suppress", type=click.Path(path_type=Path), metavar="FILE", help="YAML list of accepted findings with reasons."
)
@click.option(
    "--suggest-accept",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the present findings as such a list, for review; with --suppress they no longer count.",
)
@click.option(
    "--budget",
    type=float,
    metavar="SECONDS",
    help="Processor time for each stage of a model; the report lists what was not finished.",
)
@click.option(
    "--config", default="validation", show_default=True, metavar="NAME|FILE", help="Shipped or own thresholds."
)
@sampling_seed_option
@jobs_option
@click.option(
    "--task",
    type=click.Choice(["pull"]),
    help="A robot opens every joint (KV7xx), with a film.",
)
@click.option(
    "--robot", type=click.Path(path_type=Path), metavar="FILE", help="URDF of the robot, if not the built-in arm."
)
@click.option("--tool", metavar="LINK", help="Link of the robot that carries the fingers.")
@click.option(
    "--gripper",
    callback=listed,
    metavar="JOINTS",
    help="Joints of its fingers, separated by commas; found if not given.",
)
@click.option(
    "--grasp", type=float, nargs=3, metavar="X Y Z", help="Where to hold the object: root frame, units of the file."
)
@click.option(
    "--base",
    type=float,
    nargs=4,
    metavar="X Y Z YAW",
    help="Place of the robot [m, deg] in the object's root frame; found if not given.",
)
@click.option("--scale", type=float, metavar="FACTOR", help="Metres per unit of the object; found if not given.")
@click.option(
    "--films",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder of the films of the task.  [default: beside the first report; no films without a report]",
)
@click.option(
    "--all", "everything", is_flag=True, help="Also show notes, all places and numbers, joints, and skipped checks."
)
@click.option("--json", metavar="FILE", help="Report as JSON; - is stdout, and then nothing else is.")
@click.option("--junit", type=click.Path(path_type=Path), metavar="FILE", help="Report as JUnit XML.")
@click.option("--sarif", type=click.Path(path_type=Path), metavar="FILE", help="Report as SARIF 2.1.0.")
@click.option(
    "--html",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Report as one HTML file, with a 3-D view of the model.",
)
def command(**given: Any) -> int:
    """Check URDFs: the file, declared physics, collision along the motion, joints, engines and their agreement.

    MODEL is a URDF, xacro, MJCF, SDF or USD file, a folder with URDF files at any depth, or a pattern in quotes;
    NAME:=VALUE is an argument of the xacros. Nothing else is needed: no ground truth, no second pose.
    `kinematify explain KV301` shows more about a check.

    Ends with 0 if no model has an error (warnings are allowed unless --fail-on says otherwise), with 1 if one has, with
    2 if one cannot be used, with 3 if there is no error and something that was asked for was not finished (the report
    shows how to finish it). Findings begin with FILE:LINE.
    Ctrl-C ends with 130 and leaves valid reports of what is known by then.
    """
    from kinematify.validation.isolation import load_imports

    load_imports()  # before anything loads NumPy
    from kinematify.cli.verdict import describe_briefly
    from kinematify.validation.formats.report_files import report_paths, write_reports
    from kinematify.validation.models import find_models
    from kinematify.validation.run.model_validation import validate
    from kinematify.validation.run.report import Unusable
    from kinematify.validation.run.suppression_file import load_suppressions

    words, everything, fail_on = given.pop("models"), given.pop("everything"), Severity(given.pop("fail_on"))
    wanted = {name: given.pop(name) for name in _REPORTS}
    files, quiet = report_paths(**wanted), wanted["json"] == "-"
    if given["task"] is None:
        for name in _OF_A_TASK:
            if given[name]:
                raise click.UsageError(f"--{name} belongs to a task. Give --task pull with it.")
    elif given["films"] is None:
        given["films"] = next((path.absolute().parent for path in files.values()), None)
    models = find_models([word for word in words if ":=" not in word])
    given["arguments"] = dict(word.split(":=", 1) for word in words if ":=" in word)
    rules = load_suppressions(given["suppress"]) if given["suppress"] is not None else ()
    several = len(models) > 1
    outcomes: list[Outcome] = []
    interrupted = False
    try:
        with progress_reporter() as progress:
            for number, model in enumerate(models):
                shown = Path(*model.parts[-2:])
                place = f"{shown} ({number + 1} of {len(models)}): " if several else ""

                def report(stage: str, share: float, done: int = number, prefix: str = place) -> None:
                    progress(prefix + stage, (done + share) / len(models))

                try:
                    outcomes.append(validate(model, **given, progress=report))
                except DescriptionError as error:
                    outcomes.append(Unusable(model=str(model), message=str(error)))
                if several and not quiet:
                    say(f"{describe_briefly(outcomes[-1])}\n")
                interrupted = outcomes[-1].interrupted
                if interrupted:
                    break
    except KeyboardInterrupt:
        interrupted = True
    write_reports(outcomes, **wanted, rules=rules, package_dirs=given["package_dirs"])
    _print(outcomes, len(models), rules, quiet=quiet, interrupted=interrupted, everything=everything)
    if interrupted:
        return ExitStatus.INTERRUPTED
    found = {item.status_at(fail_on) for item in outcomes}
    order = (ExitStatus.UNUSABLE, ExitStatus.FAILURES, ExitStatus.FAULT)
    return next((status for status in order if status in found), ExitStatus.FINE)


def _print(
    outcomes: Sequence[Outcome],
    models: int,
    rules: Sequence[Suppression],
    *,
    quiet: bool,
    interrupted: bool,
    everything: bool,
) -> None:
    """Print the report on stdout unless a machine reads that, and what is no result on stderr."""
    from kinematify.cli.verdict import describe, describe_table, describe_unused
    from kinematify.validation.run.report import Unusable
    from kinematify.validation.run.suppression_file import unused_suppressions

    reports = [outcome for outcome in outcomes if not isinstance(outcome, Unusable)]
    if models > 1 and not quiet:
        say(describe_table(outcomes))
    elif reports and not quiet:
        say(describe(reports[0], everything=everything))
    else:
        for outcome in outcomes:
            if isinstance(outcome, Unusable):
                click.echo(f"Error: {outcome.message}", err=True)
    if interrupted:
        done = f"{len(outcomes)} of {models} models"
        click.echo(f"Interrupted. What is known by now was reported ({done}, the last one in part).", err=True)
    elif unused := describe_unused(unused_suppressions(rules, reports)):
        click.echo(unused, err=True)
