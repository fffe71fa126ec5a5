"""Report files that `kinematify validate` is asked for: looked at before the run, written after it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.errors import OutputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.cli.progress import Reporter
    from kinematify.validation.finding import Suppression
    from kinematify.validation.formats.report_picture import Drawing
    from kinematify.validation.run.outcome import Outcome
    from kinematify.validation.run.report import ValidationReport


_OPTIONS = {
    "json_to": "--json", "junit": "--junit", "sarif": "--sarif", "html": "--html", "suggest_accept": "--suggest-accept",
}  # fmt: skip
"""Names of values -> the options that ask for a file."""


def report_paths(given: Mapping[str, Any]) -> dict[str, Path]:
    """Files by the option that asked for them; found out now, not after minutes of work, whether they can be written.

    Args:
        given: Values of the options, None or ``-`` for no file.

    Raises:
        OutputError: One cannot.
    """
    wanted = {option: Path(given[name]) for name, option in _OPTIONS.items() if given[name] not in (None, "", "-")}
    for option, path in wanted.items():
        if problem := _problem(path):
            raise OutputError(
                f"The report of {option} cannot be written to {path}: {problem}. Give a file in a folder that "
                "exists and is writable."
            )
    if len({os.path.realpath(path) for path in wanted.values()}) < len(wanted):
        raise OutputError(f"Two of {', '.join(wanted)} name the same file. Give each report its own.")
    return wanted


def write_reports(
    files: Mapping[str, Path],
    outcomes: Sequence[Outcome],
    drawings: Mapping[str, Drawing],
    rules: Sequence[Suppression] = (),
    *,
    to_stdout: bool = False,
) -> None:
    """Write what was asked for.

    Args:
        files: As `report_paths` returns them.
        outcomes: In the order of the models.
        drawings: Picture and scene of a model, by its path as given; may lack some.
        rules: That hold already, for a file of accepted findings.
        to_stdout: Print the JSON.

    Raises:
        OutputError: A file cannot be written.
    """
    if not files and not to_stdout:
        return  # what writes them takes time to load
    from kinematify.validation.formats.html import as_html
    from kinematify.validation.formats.junit import as_junit
    from kinematify.validation.formats.sarif import as_sarif
    from kinematify.validation.run.outcome import Unusable, as_json_text
    from kinematify.validation.run.suppression_file import suggested_suppressions, suppressions_text

    pictures = {model: drawn.picture for model, drawn in drawings.items()}
    scenes = {model: drawn.scene for model, drawn in drawings.items()}
    reports = [outcome for outcome in outcomes if not isinstance(outcome, Unusable)]
    texts: dict[str, Callable[[], str]] = {
        "--json": lambda: as_json_text(outcomes),
        "--junit": lambda: as_junit(outcomes),
        "--sarif": lambda: as_sarif(outcomes),
        "--html": lambda: as_html(outcomes, pictures, scenes),
        "--suggest-accept": lambda: suppressions_text((*rules, *suggested_suppressions(reports))),
    }
    for option, path in files.items():
        _write(option, path, texts[option]())
    if to_stdout:
        click.echo(texts["--json"](), nl=False)


def report_on(folder: Path, progress: Reporter, done: float) -> ValidationReport:
    """Validate the model of a folder and write its reports, with the picture of the folder if there is one.

    Args:
        folder: Of a model.
        progress: Called with each stage and the share done.
        done: Share of all work that is done before.
    """
    from kinematify.model.output import MODEL_FILE, PREVIEW_FILE
    from kinematify.validation.formats.report_picture import Drawing, scene_of
    from kinematify.validation.run import validate

    report = validate(
        folder / MODEL_FILE,
        workers=os.cpu_count() or 1,
        progress=lambda stage, share: progress(f"validation: {stage}", done + (1.0 - done) * share),
    )
    picture = folder / PREVIEW_FILE
    drawing = Drawing(picture=picture.read_bytes() if picture.is_file() else b"", scene=scene_of(folder / MODEL_FILE))
    files = {"--json": folder / "validation.json", "--html": folder / "validation.html"}
    write_reports(files, [report], {report.model: drawing})
    return report


def _problem(path: Path) -> str:
    """Why a file cannot be written there; empty if it can."""
    if path.is_dir():
        return "it is a folder"
    if path.exists():
        return "" if os.access(path, os.W_OK) else "it is read-only"
    folder = path.parent
    if not folder.is_dir():
        return f"there is no folder {folder}"
    return "" if os.access(folder, os.W_OK | os.X_OK) else f"the folder {folder} is read-only"


def _write(option: str, path: Path, text: str) -> None:
    """Write beside the file first, so that an earlier report is not lost to a full disk; not for pipes and devices."""
    replaced = not path.exists() or path.is_file()
    target = path.with_name(f".{path.name}.{os.getpid()}") if replaced else path
    try:
        target.write_text(text, encoding="utf-8", errors="replace")
        if replaced:
            target.replace(path.resolve())
    except OSError as error:
        raise OutputError(
            f"The report of {option} cannot be written to {path}: {error.strerror}. Give a file in a folder that "
            "exists and is writable."
        ) from error
    finally:
        if replaced:
            target.unlink(missing_ok=True)
