"""`kinematify validate`: a verdict on URDFs from anywhere, and why."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kinematify.cli.options import examples, package_dirs_option, sampling_seed_option
from kinematify.cli.progress import progress_reporter
from kinematify.cli.report_files import ReportFiles
from kinematify.validation.finding import Severity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.config.validation import ValidationSettings


_QUICK = "KV1*,KV2*,KV30*,KV31*,KV32*,KV801,KV802,KV803,KV804"
"""Checks of `--quick`."""
_COARSE = {"points": 450}
"""Settings of its sweeps: half of the usual points."""


@click.command(
    "validate",
    short_help="URDFs from anywhere -> verdict, findings with cause and remedy.",
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
        "kinematify validate cup.urdf --task pour --into bowl.urdf",
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
    type=click.Choice(["pull", "pour"]),
    help="A robot opens every joint, or pours from a cup (KV7xx), with a film.",
)
@click.option("--into", type=click.Path(path_type=Path), metavar="FILE", help="Container to pour into, a URDF.")
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
def command(
    *,
    models: tuple[str, ...],
    package_dirs: tuple[Path, ...],
    checks: str | None,
    skip: str | None,
    quick: bool,
    contract: bool,
    fail_on: str,
    engines: str | None,
    suppress: Path | None,
    suggest_accept: Path | None,
    budget: float | None,
    config: str,
    seed: int | None,
    jobs: int | None,
    task: str | None,
    into: Path | None,
    robot: Path | None,
    tool: str | None,
    gripper: str | None,
    grasp: tuple[float, float, float] | None,
    base: tuple[float, float, float, float] | None,
    scale: float | None,
    films: Path | None,
    everything: bool,
    json_to: str | None,
    junit: Path | None,
    sarif: Path | None,
    html: Path | None,
) -> int:
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
    from kinematify.cli.task_options import TaskOptions
    from kinematify.cli.validation_run import ValidationRun
    from kinematify.validation.models import find_models
    from kinematify.validation.run.suppression_file import load_suppressions

    files = ReportFiles(json=json_to, junit=junit, sarif=sarif, html=html, accept=suggest_accept)
    files.check()
    options = TaskOptions(
        task=task, robot=robot, tool=tool, gripper=gripper, grasp=grasp, base=base, scale=scale, films=films, into=into
    )
    asked = options.request(files, _existing(package_dirs))
    run = ValidationRun(
        models=find_models([word for word in models if ":=" not in word]),
        arguments=dict(word.split(":=", 1) for word in models if ":=" in word),
        package_dirs=_existing(package_dirs),
        selected=_selected(checks or (_QUICK if quick else None), skip, contract=contract),
        engines=("mujoco",) if quick else _engines(engines),
        fail_on=Severity(fail_on),
        quick=quick,
        quiet=json_to == "-",
        rules=load_suppressions(suppress) if suppress is not None else (),
        settings=_settings(config, budget=budget, seed=seed, quick=quick),
        workers=jobs or os.cpu_count() or 1,
        with_pictures=html is not None,
        everything=everything,
        task=asked,
    )
    try:
        with progress_reporter() as progress:
            run.run(progress)
    except KeyboardInterrupt:
        run.interrupted = True
    files.write(run.outcomes, run.pictures, run.scenes, run.rules)
    run.print()
    return run.exit_status


def _existing(folders: Sequence[Path]) -> tuple[Path, ...]:
    from kinematify.errors import InputError

    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"--package-dir {folder} is no folder. Give the folder of a package, or of packages.")
    return tuple(folders)


def _selected(checks: str | None, skip: str | None, *, contract: bool) -> frozenset[str]:
    from kinematify.validation.run.loaded_findings import CONTRACT

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
    from kinematify.errors import ConfigError

    settings = load_settings(config)
    changes: dict[str, object] = {} if seed is None else {"seed": seed}
    if quick:
        changes["geometry"] = settings.geometry.model_copy(update=_COARSE)
    if budget is not None:
        if not 0.0 < budget < float("inf"):
            raise ConfigError(f"--budget is {budget}. Give a number of seconds above 0.")
        changes["budget"] = settings.budget.model_copy(update={"seconds": budget})
    return settings.model_copy(update=changes)
