"""Files of reports: looked at before a run, written after it."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from kinematify.config.validation import load_settings
from kinematify.errors import OutputError
from kinematify.model.output import MODEL_FILE, PREVIEW_FILE
from kinematify.validation.finding import Severity
from kinematify.validation.run import validate
from kinematify.validation.run.report import Unusable, as_json_text
from kinematify.validation.run.suppression_file import suggested_suppressions, suppressions_text

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from kinematify.validation.finding import Suppression
    from kinematify.validation.formats.report_picture import Drawing
    from kinematify.validation.run.report import Outcome, ValidationReport


_PICTURES = 12
"""With more models an HTML report shows none: it would take long to make and to load."""
_PICTURE_SECONDS = 15.0
"""A picture that takes longer is omitted [s]; known robots take 1 to 3."""


def report_paths(**wanted: str | Path | None) -> dict[str, Path]:
    """Files by kind of report; found out now, not after minutes of work, whether they can be written.

    Args:
        wanted: As `write_reports` takes them; ``-`` is no file.

    Raises:
        OutputError: One cannot be written, or two are the same.
    """
    files = {kind: Path(path) for kind, path in wanted.items() if path not in (None, "", "-")}
    for kind, path in files.items():
        if problem := _problem(path):
            raise _unwritable(kind, path, problem)
    if len({os.path.realpath(path) for path in files.values()}) < len(files):
        raise OutputError(f"Two of {', '.join(map(_option, files))} name the same file. Give each report its own.")
    return files


def write_reports(
    outcomes: Sequence[Outcome],
    *,
    json: str | Path | None = None,
    junit: str | Path | None = None,
    sarif: str | Path | None = None,
    html: str | Path | None = None,
    suggest_accept: str | Path | None = None,
    rules: Sequence[Suppression] = (),
    package_dirs: Sequence[Path] = (),
    drawings: Mapping[str, Drawing] | None = None,
) -> None:
    """Write what `kinematify.validate` returned, as `kinematify validate` does.

    Args:
        outcomes: Reports, in the order of the models.
        json: File; ``-`` is stdout.
        junit: File for JUnit XML.
        sarif: File for SARIF 2.1.0.
        html: File for a page with a 3-D view of the model.
        suggest_accept: File for a list of the present findings, for review; with ``suppress`` they no longer count.
        rules: That hold already, for that list.
        package_dirs: Where packages lie, for the picture of the page.
        drawings: Pictures and scenes of the page, by the model's path as given; drawn here if absent.

    Raises:
        OutputError: A file cannot be written.
        KeyboardInterrupt: Ctrl-C while the models are drawn; all files are written without.
    """
    files = report_paths(json=json, junit=junit, sarif=sarif, html=html, suggest_accept=suggest_accept)
    if not files and json != "-":
        return  # what makes them takes time to load
    from kinematify.validation.formats.html import as_html  # noqa: PLC0415
    from kinematify.validation.formats.junit import as_junit  # noqa: PLC0415
    from kinematify.validation.formats.sarif import as_sarif  # noqa: PLC0415

    drawn, stopped = dict(drawings or {}), False
    if html and drawings is None and len(outcomes) <= _PICTURES:
        from kinematify.validation.formats.report_picture import drawing_of  # noqa: PLC0415

        try:
            for outcome in filter(_can_be_drawn, outcomes):
                place = Path(outcome.model)
                drawn[outcome.model] = drawing_of(place, package_dirs, load_settings(), seconds=_PICTURE_SECONDS)
        except KeyboardInterrupt:
            stopped = True
    pictures = {model: item.picture for model, item in drawn.items()}
    scenes = {model: item.scene for model, item in drawn.items()}
    reports = [outcome for outcome in outcomes if not isinstance(outcome, Unusable)]
    texts: dict[str, Callable[[], str]] = {
        "json": lambda: as_json_text(outcomes),
        "junit": lambda: as_junit(outcomes),
        "sarif": lambda: as_sarif(outcomes),
        "html": lambda: as_html(outcomes, pictures, scenes),
        "suggest_accept": lambda: suppressions_text((*rules, *suggested_suppressions(reports))),
    }
    for kind, path in files.items():
        _write(kind, path, texts[kind]())
    if json == "-":
        sys.stdout.write(texts["json"]())
        sys.stdout.flush()
    if stopped:
        raise KeyboardInterrupt


def report_on(folder: Path, progress: Callable[[str, float], None], done: float) -> ValidationReport:
    """Validate the model of a folder and write its reports, with the picture of the folder if there is one.

    Args:
        folder: Of a model.
        progress: Called with each stage and the share done.
        done: Share of all work that is done before.
    """
    report = validate(
        folder / MODEL_FILE, progress=lambda stage, share: progress(f"validation: {stage}", done + (1.0 - done) * share)
    )
    from kinematify.validation.formats.report_picture import Drawing, scene_of  # noqa: PLC0415

    picture = folder / PREVIEW_FILE
    drawing = Drawing(picture=picture.read_bytes() if picture.is_file() else b"", scene=scene_of(folder / MODEL_FILE))
    write_reports(
        [report],
        json=folder / "validation.json",
        html=folder / "validation.html",
        drawings={report.model: drawing},
    )
    return report


def _can_be_drawn(outcome: Outcome) -> bool:
    """True if the file and its meshes can be read."""
    return not isinstance(outcome, Unusable) and not outcome.interrupted and not any(
        item.check.startswith("KV1") and item.severity is Severity.ERROR for item in outcome.findings
    )  # fmt: skip


def _option(kind: str) -> str:
    return f"--{kind.replace('_', '-')}"


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


def _unwritable(kind: str, path: Path, problem: str | None) -> OutputError:
    return OutputError(
        f"The report of {_option(kind)} cannot be written to {path}: {problem}. Give a file in a folder that exists "
        "and is writable."
    )


def _write(kind: str, path: Path, text: str) -> None:
    """Write beside the file first, so that an earlier report is not lost to a full disk; not for pipes and devices."""
    replaced = not path.exists() or path.is_file()
    target = path.with_name(f".{path.name}.{os.getpid()}") if replaced else path
    try:
        target.write_text(text, encoding="utf-8", errors="replace")
        if replaced:
            target.replace(path.resolve())
    except OSError as error:
        raise _unwritable(kind, path, error.strerror) from error
    finally:
        if replaced:
            target.unlink(missing_ok=True)
