"""`kinematify.validate`: one model, with the options of the command."""

from __future__ import annotations

import tempfile
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from kinematify.config.validation import load_settings
from kinematify.errors import ConfigError, InputError, KinematifyError
from kinematify.robot.description import form_of
from kinematify.simulation.engines import DEFAULT_ENGINES, ENGINES
from kinematify.validation.checks import CHECKS
from kinematify.validation.isolation import load_imports
from kinematify.validation.models import find_models
from kinematify.validation.run import validate as run_checks
from kinematify.validation.run.needs import needed, stages_of
from kinematify.validation.run.report import CONTRACT, ISAAC
from kinematify.validation.run.suppression_file import known_pattern, load_suppressions

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.config.validation import ValidationSettings
    from kinematify.validation.run.report import ValidationReport

QUICK = ("KV1*", "KV2*", "KV30*", "KV31*", "KV32*", "KV801", "KV802", "KV803", "KV804")
"""Checks of `quick`."""
_COARSE = {"points": 450}
"""Settings of its sweeps: half of the usual points."""
WRITTEN = ("KV1*", "KV2*", "KV30*", "KV31*", "KV32*", "KV33*", "KV80*")
"""Checks of a model that was just inferred: file, masses, exact geometry, the file as loaded; no second inference."""


def validate(
    model: str | Path,
    *,
    arguments: Mapping[str, str] | None = None,
    package_dirs: Sequence[str | Path] = (),
    checks: Sequence[str] = (),
    skip: Sequence[str] = (),
    quick: bool = False,
    contract: bool = False,
    isaac: bool = False,
    engines: Sequence[str] | None = None,
    suppress: str | Path | None = None,
    budget: float | None = None,
    config: str | Path | ValidationSettings = "validation",
    seed: int | None = None,
    jobs: int | None = None,
    task: Literal["pull"] | None = None,
    robot: str | Path | None = None,
    tool: str | None = None,
    gripper: Sequence[str] = (),
    grasp: tuple[float, float, float] | None = None,
    base: tuple[float, float, float, float] | None = None,
    scale: float | None = None,
    films: str | Path | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> ValidationReport:
    """Check a model as `kinematify validate` does: file, declared physics, collision along the motion, joints, engines.

    Args:
        model: URDF, xacro, MJCF, SDF or USD, a folder with one, or a name of robot_descriptions.
        arguments: Of a xacro.
        package_dirs: Where packages lie (``package://``).
        checks: Only these, ids or patterns such as ``KV3*``; all but those of the contract and of Isaac Sim if
            empty. Those of file and meshes always run, and their errors count.
        skip: All but these.
        quick: File, meshes, declared physics, each joint in motion by exact geometry, and the file in MuJoCo.
        contract: Also ask whether it rests on a floor in MuJoCo and its motors move its joints there.
        isaac: Also list names that Isaac Sim changes, and its order of the joints.
        engines: Engines to run; all that are installed if absent, only file and geometry if empty.
        suppress: YAML list of accepted findings with reasons: they do not count.
        budget: Processor time for each stage [s].
        config: Thresholds: a shipped name, a file or the settings.
        seed: Of the sampled configurations, instead of the configuration's.
        jobs: Processes at a time; as many as there are cores if absent.
        task: What a robot is to do with the object (KV7xx).
        robot: URDF of the robot of the task; the built-in arm if absent.
        tool: Link of the robot that carries the fingers.
        gripper: Joints of its fingers; found if not given.
        grasp: Where to hold the object, frame of its root link [units of the file].
        base: Place of the robot, x, y, z [m] and yaw [deg], frame of the object's root link; found if not given.
        scale: Metres per unit of the object; found if not given.
        films: Folder for films of the task; none are made if absent.
        progress: Called with the stage that ended and the fraction done.

    Returns:
        The report; after an interrupt a partial one that says so. `kinematify.write_reports` makes files of it.

    Raises:
        InputError: The model is no description at all, or there is no such check, engine, robot, tool or gripper.
        EnvironmentFault: An engine was asked for that is not installed, or a task without what plans it.
    """
    found = find_models([str(model)])
    if len(found) > 1:
        raise InputError(f"{model} holds {len(found)} models. Give one of them, such as {found[0]}.")
    folders = _existing("--package-dir", *package_dirs)
    request = None
    if task is not None:
        from kinematify.manipulation.manipulator import robot_of  # noqa: PLC0415 - geometry loads slowly
        from kinematify.manipulation.plan_request import TaskRequest  # noqa: PLC0415

        request = TaskRequest(
            robot=None if robot is None else Path(robot).absolute(), tool=tool, gripper=tuple(gripper),
            package_dirs=folders, grasp=grasp, base=base, scale=scale,
            films=None if films is None else _existing("--films", films)[0].absolute(),
            stem=f"{found[0].absolute().parent.name}_{found[0].stem}_{task}",
        )  # fmt: skip
        with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
            robot_of(request, Path(folder))  # what is wrong with it is said before anything runs
    return run_checks(
        found[0],
        package_dirs=folders,
        arguments=arguments if form_of(found[0]) == "xacro" else None,
        settings=_settings(config, budget=budget, seed=seed, quick=quick),
        selected=_selected(checks or (QUICK if quick else ()), skip, contract=contract, isaac=isaac),
        engines=("mujoco",) if quick else _engines(engines),
        named=not quick,
        suppressions=() if suppress is None else load_suppressions(Path(suppress)),
        task=request,
        workers=jobs,
        progress=progress,
    )


def start_validation() -> None:
    """Start to load what `validated` needs on another core, if its processes cannot be forked from this one."""
    load_imports(ahead=needed(stages_of(DEFAULT_ENGINES), _selected(WRITTEN, ())))


def validated(urdf: Path) -> ValidationReport | KinematifyError:
    """Return what is wrong with a model that was just written, or why that is not known."""
    try:
        return validate(urdf, checks=WRITTEN)
    except KinematifyError as error:
        return error


def _existing(option: str, *folders: str | Path) -> tuple[Path, ...]:
    paths = tuple(map(Path, folders))
    for path in paths:
        if not path.is_dir():
            raise InputError(f"{option} {path} is no folder. Give a folder that exists.")
    return paths


def _selected(
    checks: Sequence[str], skip: Sequence[str], *, contract: bool = False, isaac: bool = False
) -> frozenset[str]:
    wanted = _matching(checks or ["*"])
    for family, asked in ((CONTRACT, contract), (ISAAC, isaac)):
        if asked:
            wanted |= _matching([f"{family}*"])
        elif not any(family in word.upper() for word in checks):
            wanted -= _matching([f"{family}*"])
    left = wanted - _matching(skip)
    if not left:
        raise InputError(
            f"--checks {','.join(checks)} and --skip {','.join(skip)} leave no check. Give other patterns."
        )
    return left


def _matching(patterns: Sequence[str]) -> frozenset[str]:
    known = [known_pattern(word) for word in patterns]
    return frozenset(check for check in CHECKS if any(fnmatchcase(check, pattern) for pattern in known))


def _engines(words: Sequence[str] | None) -> tuple[str, ...]:
    if words is None:
        return DEFAULT_ENGINES
    unknown = [word for word in words if word not in ENGINES]
    if unknown:
        raise InputError(f"--engines names {unknown[0]!r}. Known are {', '.join(ENGINES)}; none leaves all out.")
    return tuple(engine for engine in ENGINES if engine in words)


def _settings(
    config: str | Path | ValidationSettings, *, budget: float | None, seed: int | None, quick: bool
) -> ValidationSettings:
    settings = load_settings(config, seed=seed)
    changes: dict[str, object] = {}
    if quick:
        changes["geometry"] = settings.geometry.model_copy(update=_COARSE)
    if budget is not None:
        if not 0.0 < budget < float("inf"):
            raise ConfigError(f"--budget is {budget}. Give a number of seconds above 0.")
        changes["budget"] = settings.budget.model_copy(update={"seconds": budget})
    return settings.model_copy(update=changes)
