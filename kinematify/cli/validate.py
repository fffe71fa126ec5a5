"""`kinematify validate`: a verdict on URDFs from anywhere, and why."""

from __future__ import annotations

import os
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.options import examples, listed, package_dirs_option, sampling_seed_option, say
from kinematify.cli.progress import progress_reporter
from kinematify.cli.report_files import report_paths, write_reports
from kinematify.errors import ConfigError, ExitStatus, InputError, OutputError
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.plan_request import TaskRequest
    from kinematify.validation.finding import Suppression
    from kinematify.validation.formats.report_picture import Drawing
    from kinematify.validation.run.outcome import Outcome


_QUICK = "KV1*,KV2*,KV30*,KV31*,KV32*,KV801,KV802,KV803,KV804"
"""Checks of `--quick`."""
_COARSE = {"points": 450}
"""Settings of its sweeps: half of the usual points."""
_PICTURES = 12
"""With more models an HTML report shows none: it would take long to make and to load."""
_PICTURE_SECONDS = 15.0
"""A picture that takes longer is omitted [s]; known robots take 1 to 3."""


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
@click.option("--checks", metavar="LIST", help="Only these: ids or patterns such as KV3*, separated by commas.")
@click.option("--skip", metavar="LIST", help="All but these.")
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
@click.option(
    "--fail-on",
    type=click.Choice([item.value for item in reversed(Severity)]),
    default=Severity.ERROR.value,
    show_default=True,
    help="Least severity of a finding that ends the command with 1.",
)
@click.option(
    "--engines",
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
@click.option(
    "--jobs", type=click.IntRange(min=1), help="Processes at a time; as many as there are cores if not given."
)
@click.option(
    "--task",
    type=click.Choice(["pull"]),
    help="A robot opens every joint (KV7xx), with a film.",
)
@click.option(
    "--robot", type=click.Path(path_type=Path), metavar="FILE", help="URDF of the robot, if not the built-in arm."
)
@click.option("--tool", metavar="LINK", help="Link of the robot that carries the fingers.")
@click.option("--gripper", metavar="JOINTS", help="Joints of its fingers, separated by commas; found if not given.")
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
@click.option("--json", "json_to", metavar="FILE", help="Report as JSON; - is stdout, and then nothing else is.")
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
    from kinematify.robot.description import form_of
    from kinematify.validation.models import find_models
    from kinematify.validation.run import validate
    from kinematify.validation.run.outcome import Unusable
    from kinematify.validation.run.suppression_file import load_suppressions

    files = report_paths(given)
    folders, quick = _existing(given["package_dirs"]), given["quick"]
    task = _task(given, files, folders)
    words = given["models"]
    models = find_models([word for word in words if ":=" not in word])
    arguments = dict(word.split(":=", 1) for word in words if ":=" in word)
    selected = _selected(given["checks"] or (_QUICK if quick else None), given["skip"], contract=given["contract"])
    engines = ("mujoco",) if quick else _engines(given["engines"])
    rules = load_suppressions(given["suppress"]) if given["suppress"] is not None else ()
    settings = _settings(given["config"], budget=given["budget"], seed=given["seed"], quick=quick)
    several, quiet = len(models) > 1, given["json_to"] == "-"
    outcomes: list[Outcome] = []
    drawings: dict[str, Drawing] = {}
    interrupted = False
    try:
        with progress_reporter() as progress:
            for number, model in enumerate(models):
                place = f"{model.parent.name}/{model.name} ({number + 1} of {len(models)}): " if several else ""

                def report(stage: str, share: float, done: int = number, prefix: str = place) -> None:
                    progress(prefix + stage, (done + share) / len(models))

                try:
                    outcomes.append(
                        validate(
                            model,
                            package_dirs=folders,
                            arguments=arguments if form_of(model) == "xacro" else None,
                            settings=settings,
                            selected=selected,
                            engines=engines,
                            named=not quick,
                            suppressions=rules,
                            task=_task_of(task, model, several=several),
                            workers=given["jobs"] or os.cpu_count() or 1,
                            progress=report,
                        )
                    )
                except InputError as error:
                    outcomes.append(Unusable(model=str(model), message=str(error)))
                if several and not quiet:
                    say(f"{describe_briefly(outcomes[-1])}\n")
                interrupted = _is_interrupted(outcomes[-1])
                if interrupted:
                    break
                if given["html"] is not None and len(models) <= _PICTURES and _can_be_drawn(outcomes[-1]):
                    from kinematify.validation.formats.report_picture import drawing_of

                    report("picture", 0.97)
                    drawings[outcomes[-1].model] = drawing_of(model, folders, settings, seconds=_PICTURE_SECONDS)
    except KeyboardInterrupt:
        interrupted = True
    write_reports(files, outcomes, drawings, rules, to_stdout=quiet)
    _print(outcomes, len(models), rules, quiet=quiet, interrupted=interrupted, everything=given["everything"])
    if interrupted:
        return ExitStatus.INTERRUPTED
    found = {item.status_at(Severity(given["fail_on"])) for item in outcomes}
    order = (ExitStatus.UNUSABLE, ExitStatus.FAILURES, ExitStatus.FAULT)
    return next((status for status in order if status in found), ExitStatus.FINE)


def _is_interrupted(outcome: Outcome) -> bool:
    from kinematify.validation.run.outcome import Unusable

    return not isinstance(outcome, Unusable) and bool(outcome.environment.get("interrupted"))


def _can_be_drawn(outcome: Outcome) -> bool:
    """True if the file and its meshes can be read."""
    from kinematify.validation.run.outcome import Unusable

    return not isinstance(outcome, Unusable) and not any(
        item.check.startswith("KV1") and item.severity is Severity.ERROR for item in outcome.findings
    )


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
    from kinematify.validation.run.outcome import Unusable
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


def _task(given: dict[str, Any], files: dict[str, Path], package_dirs: tuple[Path, ...]) -> TaskRequest | None:
    """Return what the options ask of a robot; it is read once, so that what is wrong with it is said at once.

    Raises:
        InputError: There is no such robot, tool or gripper.
        OutputError: Films cannot be written where they should go.
    """
    if given["task"] is None:
        for name in ("robot", "tool", "gripper", "grasp", "base", "scale", "films"):
            if given[name]:
                raise click.UsageError(f"--{name} belongs to a task. Give --task pull with it.")
        return None
    beside = next((path.absolute().parent for path in files.values()), None)
    films = beside if given["films"] is None else given["films"].absolute()
    if films is not None and not films.is_dir():
        raise OutputError(f"--films {films} is no folder. Give a folder that exists.")
    from kinematify.manipulation.manipulator import robot_of
    from kinematify.manipulation.plan_request import TaskRequest

    request = TaskRequest(
        robot=given["robot"] and given["robot"].absolute(),
        tool=given["tool"],
        gripper=listed(given["gripper"]),
        package_dirs=package_dirs,
        grasp=given["grasp"] or None,
        base=given["base"] or None,
        scale=given["scale"],
        films=films,
    )
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        robot_of(request, Path(folder))
    return request


def _task_of(task: TaskRequest | None, model: Path, *, several: bool) -> TaskRequest | None:
    """The task with names of films that distinguish the models."""
    stem = f"{model.absolute().parent.name}_{model.stem}" if several else model.stem
    return None if task is None else replace(task, stem=f"{stem}_{task.stem}")


def _existing(folders: Sequence[Path]) -> tuple[Path, ...]:
    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"--package-dir {folder} is no folder. Give the folder of a package, or of packages.")
    return tuple(folders)


def _selected(checks: str | None, skip: str | None, *, contract: bool) -> frozenset[str]:
    from kinematify.validation.run.loaded_words import CONTRACT

    parts, wanted = _matching(f"{CONTRACT}*"), _matching(checks or "*")
    if contract:
        wanted |= parts
    elif CONTRACT not in (checks or "").upper():
        wanted -= parts
    left = wanted - (_matching(skip) if skip is not None else frozenset())
    if not left:
        raise click.UsageError(f"--checks {checks} and --skip {skip} leave no check. Give other patterns.")
    return left


def _matching(patterns: str) -> frozenset[str]:
    from fnmatch import fnmatchcase

    from kinematify.validation.checks import CHECKS
    from kinematify.validation.run.suppression_file import known_pattern

    known = [known_pattern(word) for word in patterns.split(",")]
    return frozenset(check for check in CHECKS if any(fnmatchcase(check, pattern) for pattern in known))


def _engines(words: str | None) -> tuple[str, ...]:
    from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES

    if words is None:
        return DEFAULT_ENGINES
    chosen = [word.strip().lower() for word in words.split(",")] if words.strip().lower() not in ("", "none") else []
    unknown = [word for word in chosen if word not in ENGINES]
    if unknown:
        raise click.UsageError(f"--engines names {unknown[0]!r}. Known are {', '.join(ENGINES)}; none leaves all out.")
    return tuple(engine for engine in ENGINES if engine in chosen)


def _settings(config: str, *, budget: float | None, seed: int | None, quick: bool) -> ValidationSettings:
    from kinematify.config.validation import load_settings

    settings = load_settings(config)
    changes: dict[str, object] = {} if seed is None else {"seed": seed}
    if quick:
        changes["geometry"] = settings.geometry.model_copy(update=_COARSE)
    if budget is not None:
        if not 0.0 < budget < float("inf"):
            raise ConfigError(f"--budget is {budget}. Give a number of seconds above 0.")
        changes["budget"] = settings.budget.model_copy(update={"seconds": budget})
    return settings.model_copy(update=changes)
