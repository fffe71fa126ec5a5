"""`kinematify validate`: a verdict on URDFs from anywhere, and why."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kinematify.cli.help import examples
from kinematify.cli.progress import progress_reporter
from kinematify.cli.report_files import ReportFiles

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.cli.progress import Reporter
    from kinematify.validation.outcome import Outcome
    from kinematify.validation.settings import ValidationSettings
    from kinematify.validation.suppression import Suppression

PICTURES_AT_MOST = 12
"""With more models an HTML report shows none: it would take long to make and to load."""
PICTURE_SECONDS = 15.0
"""A picture that takes longer is left out [s]; known robots take 1 to 3."""
_FOUND_ERRORS, _UNUSABLE_INPUT, _INTERRUPTED = 1, 2, 130


@click.command(
    "validate",
    short_help="URDFs from anywhere -> verdict, findings with blame and remedy.",
    epilog=examples(
        "kinematify validate model.urdf",
        "kinematify validate models/ 'more/**/*.urdf' --junit report.xml",
        "kinematify validate model.urdf --html report.html --sarif report.sarif",
        "kinematify validate robot.urdf --package-dir ~/ros/src --engines mujoco,pinocchio",
        "kinematify validate model.urdf --checks 'KV3*,KV401' --skip KV305 --budget 10",
        "kinematify validate model.urdf --suppress accepted.yaml --json - > answer.json",
    ),
)
@click.argument("models", nargs=-1, required=True, metavar="MODEL...")
@click.option(
    "--package-dir",
    "package_dirs",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Package, or folder of packages, for package:// paths; may be given more than once.",
)
@click.option("--checks", metavar="LIST", help="Only these: ids or patterns such as KV3*, separated by commas.")
@click.option("--skip", metavar="LIST", help="All but these.")
@click.option(
    "--engines",
    metavar="LIST",
    default="mujoco,pybullet,pinocchio",
    show_default=True,
    help="Engines to run, separated by commas; none: only file and geometry.",
)
@click.option(
    "--suppress", type=click.Path(path_type=Path), metavar="FILE", help="YAML list of accepted findings with reasons."
)
@click.option("--budget", type=float, metavar="SECONDS", help="Time for one model; what is left out is said.")
@click.option(
    "--config", default="validation", show_default=True, metavar="NAME|FILE", help="Shipped or own thresholds."
)
@click.option("--seed", type=int, help="Seed of the sampled configurations, instead of the configuration's.")
@click.option(
    "--jobs", type=click.IntRange(min=1), help="Processes at a time; as many as there are cores if not given."
)
@click.option("--json", "json_to", metavar="FILE", help="Report as JSON; - is stdout, and then nothing else is.")
@click.option("--junit", type=click.Path(path_type=Path), metavar="FILE", help="Report as JUnit XML.")
@click.option("--sarif", type=click.Path(path_type=Path), metavar="FILE", help="Report as SARIF 2.1.0.")
@click.option("--html", type=click.Path(path_type=Path), metavar="FILE", help="Report as one HTML file with a picture.")
def command(
    *,
    models: tuple[str, ...],
    package_dirs: tuple[Path, ...],
    checks: str | None,
    skip: str | None,
    engines: str,
    suppress: Path | None,
    budget: float | None,
    config: str,
    seed: int | None,
    jobs: int | None,
    json_to: str | None,
    junit: Path | None,
    sarif: Path | None,
    html: Path | None,
) -> int:
    """Check URDFs: the file, declared physics, collision along the motion, joints, engines and their agreement.

    MODEL is a URDF file, a folder with URDF files at any depth, or a pattern in quotes. Nothing else is needed: no
    truth, no second pose. `kinematify explain KV301` tells more about a check.

    Ends with 0 if no model has an error (warnings are allowed), with 1 if one has, with 2 if one cannot be used.
    Ctrl-C ends with 130 and leaves valid reports of what is known by then.
    """
    from kinematify.validation.models import find_models
    from kinematify.validation.suppression_file import load_suppressions

    files = ReportFiles(json=json_to, junit=junit, sarif=sarif, html=html)
    files.check()
    run = _Run(
        models=find_models(models),
        package_dirs=_existing(package_dirs),
        selected=_selected(checks, skip),
        engines=_engines(engines),
        rules=load_suppressions(suppress) if suppress is not None else (),
        settings=_settings(config, budget=budget, seed=seed),
        workers=jobs or os.cpu_count() or 1,
        with_pictures=html is not None,
    )
    try:
        with progress_reporter() as progress:
            run.all(progress)
    except KeyboardInterrupt:
        run.interrupted = True
    files.write(run.outcomes, run.pictures)
    run.say(quiet=json_to == "-")
    return run.exit_status


@dataclass(kw_only=True)
class _Run:
    """What was asked for, and what has come of it so far."""

    models: tuple[Path, ...]
    package_dirs: tuple[Path, ...]
    selected: frozenset[str]
    engines: tuple[str, ...]
    rules: tuple[Suppression, ...]
    settings: ValidationSettings
    workers: int
    with_pictures: bool
    outcomes: list[Outcome] = field(default_factory=list)
    pictures: dict[str, bytes] = field(default_factory=dict)
    interrupted: bool = False

    def all(self, progress: Reporter) -> None:
        """Validate one model after the other; each has all processes for itself."""
        for number, model in enumerate(self.models):
            label = f"{model.parent.name}/{model.name} ({number + 1} of {len(self.models)}): "
            prefix = label if len(self.models) > 1 else ""

            def tell(stage: str, fraction: float, done: int = number, prefix: str = prefix) -> None:
                progress(prefix + stage, (done + fraction) / len(self.models))

            self._one(model, tell)
            if self.interrupted:
                return

    def _one(self, model: Path, progress: Reporter) -> None:
        from kinematify.errors import InputError
        from kinematify.validation.outcome import Unusable
        from kinematify.validation.run import validate

        try:
            report = validate(
                model,
                package_dirs=self.package_dirs,
                settings=self.settings,
                selected=self.selected,
                engines=self.engines,
                suppressions=self.rules,
                workers=self.workers,
                progress=progress,
            )
        except InputError as error:
            self.outcomes.append(Unusable(model=str(model), message=str(error)))
            return
        self.outcomes.append(report)
        self.interrupted = bool(report.environment.get("interrupted"))
        readable = not any(f.check.startswith("KV1") and f.severity.value == "error" for f in report.findings)
        if self.with_pictures and readable and not self.interrupted and len(self.models) <= PICTURES_AT_MOST:
            progress("picture", 0.97)
            self.pictures[report.model] = self._picture(model)

    def _picture(self, model: Path) -> bytes:
        from kinematify.validation.formats.picture import picture_of

        return picture_of(model, self.package_dirs, self.settings, seconds=PICTURE_SECONDS)

    @property
    def exit_status(self) -> int:
        """130 after Ctrl-C, else the worst of the models."""
        if self.interrupted:
            return _INTERRUPTED
        verdicts = {outcome.verdict for outcome in self.outcomes}
        if "unusable" in verdicts:
            return _UNUSABLE_INPUT
        return _FOUND_ERRORS if "fail" in verdicts else 0

    def say(self, *, quiet: bool) -> None:
        """Tell the user: the report on stdout unless a machine reads that, what is no result on stderr."""
        from kinematify.cli.verdict import describe, describe_all, describe_unused, say
        from kinematify.validation.outcome import Unusable
        from kinematify.validation.suppression_file import unused_suppressions

        reports = [outcome for outcome in self.outcomes if not isinstance(outcome, Unusable)]
        if not quiet and self.outcomes:
            say(describe(self.outcomes[0]) if len(self.models) == 1 else describe_all(self.outcomes))
        for outcome in self.outcomes:
            if isinstance(outcome, Unusable):
                click.echo(f"Error: {outcome.message}", err=True)
        if self.interrupted:
            done = f"{len(self.outcomes)} of {len(self.models)} models"
            click.echo(f"Interrupted. What is known by now was reported ({done}, the last one in part).", err=True)
        elif unused := describe_unused(unused_suppressions(self.rules, reports)):
            click.echo(unused, err=True)


def _existing(folders: Sequence[Path]) -> tuple[Path, ...]:
    from kinematify.errors import InputError

    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"--package-dir {folder} is no folder. Give the folder of a package, or of packages.")
    return tuple(folders)


def _selected(checks: str | None, skip: str | None) -> frozenset[str]:
    from kinematify.validation.catalogue import CATALOGUE

    wanted = _matching(checks) if checks is not None else frozenset(CATALOGUE)
    left = wanted - (_matching(skip) if skip is not None else frozenset())
    if not left:
        raise click.UsageError(f"--checks {checks} and --skip {skip} leave no check. Give other patterns.")
    return left


def _matching(patterns: str) -> frozenset[str]:
    from fnmatch import fnmatchcase

    from kinematify.validation.catalogue import CATALOGUE
    from kinematify.validation.suppression_file import known_pattern

    known = [known_pattern(word) for word in patterns.split(",")]
    return frozenset(check for check in CATALOGUE if any(fnmatchcase(check, pattern) for pattern in known))


def _engines(words: str) -> tuple[str, ...]:
    from kinematify.validation.plan import ENGINES

    chosen = [word.strip().lower() for word in words.split(",")] if words.strip().lower() not in ("", "none") else []
    unknown = [word for word in chosen if word not in ENGINES]
    if unknown:
        raise click.UsageError(f"--engines names {unknown[0]!r}. Known are {', '.join(ENGINES)}; none leaves all out.")
    return tuple(engine for engine in ENGINES if engine in chosen)


def _settings(config: str, *, budget: float | None, seed: int | None) -> ValidationSettings:
    from kinematify.errors import ConfigError
    from kinematify.validation.settings import load_settings

    settings = load_settings(config)
    changes: dict[str, object] = {} if seed is None else {"seed": seed}
    if budget is not None:
        if not 0.0 < budget < float("inf"):
            raise ConfigError(f"--budget is {budget}. Give a number of seconds above 0.")
        changes["budget"] = settings.budget.model_copy(update={"seconds": budget})
    return settings.model_copy(update=changes)
