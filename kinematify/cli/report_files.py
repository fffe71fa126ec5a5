"""The report files that `kinematify validate` is asked for: looked at before the run, written after it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from kinematify.errors import OutputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.cli.progress import Reporter
    from kinematify.validation.run.outcome import Outcome
    from kinematify.validation.run.report import ValidationReport
    from kinematify.validation.suppression import Suppression


@dataclass(frozen=True, kw_only=True)
class ReportFiles:
    """Where each format goes; None where it was not asked for."""

    json: str | None
    """A file, or ``-`` for stdout."""
    junit: Path | None
    sarif: Path | None
    html: Path | None
    accept: Path | None = None
    """Rules that accept what counts now."""

    @property
    def paths(self) -> dict[str, Path]:
        """Files by the option that asked for them."""
        wanted = {
            "--json": Path(self.json) if self.json not in (None, "", "-") else None,
            "--junit": self.junit,
            "--sarif": self.sarif,
            "--html": self.html,
            "--suggest-accept": self.accept,
        }
        return {option: path for option, path in wanted.items() if path is not None}

    def check(self) -> None:
        """Find out now, not after minutes of work, whether all of them can be written.

        Raises:
            OutputError: One cannot.
        """
        for option, path in self.paths.items():
            problem = _problem(path)
            if problem:
                raise OutputError(
                    f"The report of {option} cannot be written to {path}: {problem}. Give a file in a folder that "
                    "exists and is writable."
                )
        if len({os.path.realpath(path) for path in self.paths.values()}) < len(self.paths):
            raise OutputError(f"Two of {', '.join(self.paths)} name the same file. Give each report its own.")

    def write(
        self,
        outcomes: Sequence[Outcome],
        pictures: Mapping[str, bytes],
        scenes: Mapping[str, str] | None = None,
        rules: Sequence[Suppression] = (),
    ) -> None:
        """Write what was asked for; see `as_html` for pictures and scenes, `rules` are those that hold already.

        Raises:
            OutputError: A file cannot be written.
        """
        texts = self._texts(outcomes, pictures, scenes or {}, rules)
        for option, path in self.paths.items():
            _write(option, path, texts[option])
        if self.json == "-":
            click.echo(texts["--json"], nl=False)

    def _texts(
        self,
        outcomes: Sequence[Outcome],
        pictures: Mapping[str, bytes],
        scenes: Mapping[str, str],
        rules: Sequence[Suppression],
    ) -> dict[str, str]:
        from kinematify.validation.formats.html import as_html
        from kinematify.validation.formats.junit import as_junit
        from kinematify.validation.formats.sarif import as_sarif
        from kinematify.validation.run.outcome import Unusable, as_json_text
        from kinematify.validation.run.suppression_file import suggested_suppressions, suppressions_text

        texts = {}
        if self.json:
            texts["--json"] = as_json_text(outcomes)
        if self.junit is not None:
            texts["--junit"] = as_junit(outcomes)
        if self.sarif is not None:
            texts["--sarif"] = as_sarif(outcomes)
        if self.html is not None:
            texts["--html"] = as_html(outcomes, pictures, scenes)
        if self.accept is not None:
            reports = [outcome for outcome in outcomes if not isinstance(outcome, Unusable)]
            texts["--suggest-accept"] = suppressions_text((*rules, *suggested_suppressions(reports)))
        return texts


def generated_files(folder: Path) -> ReportFiles:
    """The reports in the folder of a generated model."""
    return ReportFiles(json=str(folder / "validation.json"), junit=None, sarif=None, html=folder / "validation.html")


def report_on(folder: Path, files: ReportFiles, *, progress: Reporter | None = None) -> ValidationReport:
    """Validate the model of a folder and write its reports, with the picture of the folder if there is one."""
    from kinematify.model.output import MODEL_FILE, PREVIEW_FILE
    from kinematify.validation.formats.report_picture import scene_of
    from kinematify.validation.run import validate

    report = validate(folder / MODEL_FILE, workers=os.cpu_count() or 1, progress=progress)
    picture = folder / PREVIEW_FILE
    pictures = {report.model: picture.read_bytes()} if picture.is_file() else {}
    files.write([report], pictures, {report.model: scene_of(folder / MODEL_FILE)})
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
