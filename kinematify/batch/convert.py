"""One object, from its files to its results: what a worker does."""

from __future__ import annotations

import io
import posixpath
import re
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image

from kinematify.assembly.load import load_assembly
from kinematify.batch.batch_inputs import content_hash, fetched, publish
from kinematify.batch.manifest import ObjectRecord
from kinematify.config import Config
from kinematify.config.validation import ValidationSettings
from kinematify.errors import InputError, KinematifyError, OutputError
from kinematify.formats.export_model import export
from kinematify.model.output import MODEL_FILE
from kinematify.pipeline.infer_assembly import StageClock, peak_mb
from kinematify.pipeline.record import write_inference_files
from kinematify.processes.pool import sentence
from kinematify.refinement.loop import refine
from kinematify.robot.joint_type import JointType
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Severity
from kinematify.validation.formats.html import as_html
from kinematify.validation.formats.report_picture import drawing_of
from kinematify.validation.run import validate
from kinematify.validation.run.report import as_json_text
from kinematify.vision.infer_object import infer

if TYPE_CHECKING:
    from kinematify.batch.batch_inputs import Source
    from kinematify.validation.finding import Finding
    from kinematify.validation.run.report import ValidationReport

STEPS = ("infer", "refine", "validate", "export")
"""What can be done with an object, in this order."""
FORMATS = {"mjcf": "model.xml", "usd": "model.usda", "sdf": "model.sdf", "glb": "model.glb"}
"""Formats of the step ``export`` and their files."""
REPORT_FILE = "validation.json"
VIEW_FILE, THUMBNAIL_FILE = "report.html", "thumbnail.jpg"
_ERRORS = 3
_DRAWING_SECONDS = 20.0
_THUMBNAIL = (320, 320)


@dataclass(frozen=True, kw_only=True)
class Conversion:
    """Conversion asked for, of every object alike; small and picklable."""

    steps: tuple[str, ...]
    formats: tuple[str, ...]
    config: Config
    settings: ValidationSettings
    reading: dict[str, Any]
    """Arguments of `load_assembly`."""
    vlm: str
    """Model that is asked about the pieces of a mesh: ``off``, ``auto`` or its address."""
    hash: str
    """Of all of these."""


def convert(source: Source, conversion: Conversion, place: str, staging: str) -> ObjectRecord:
    """Do all steps with an object; every exception becomes a record, so that one object never ends the run.

    Args:
        source: The object.
        conversion: What is to be done.
        place: Path or URL of the folder for its results, which appears when all steps are done.
        staging: Folder in which results lie unfinished; on the disk of `place`, if that is on one.
    """
    clock, known = StageClock(None), dict[str, Any]()
    start = time.perf_counter()
    _forget_peak()
    try:
        with tempfile.TemporaryDirectory(prefix=".", dir=staging, ignore_cleanup_errors=True) as folder:
            _do_steps(source, conversion, place, folder=Path(folder), clock=clock, known=known)
    except Exception as error:
        given = isinstance(error, InputError | _Unreadable) and not isinstance(error, OutputError)
        known["status"] = "unusable" if given else "error"
        known["error"] = str(error) if isinstance(error, KinematifyError | _Unreadable) else sentence(error)
    return ObjectRecord(
        object=source.name,
        source=source.place,
        **{"status": "ok", **known},
        seconds=time.perf_counter() - start,
        step_seconds=clock.seconds,
        peak_mb=_peak_mb(),
        configuration=conversion.hash,
    )


class _Unreadable(Exception):
    """The files of the object cannot be read."""


def _do_steps(
    source: Source, conversion: Conversion, place: str, *, folder: Path, clock: StageClock, known: dict[str, Any]
) -> None:
    """Do the steps, and write down what is known after each of them."""
    steps, made = conversion.steps, folder / "made"
    made.mkdir()
    with clock.stage("read", 0.0):
        try:
            known["content"] = content_hash(source.place)
            model = fetched(source.place, folder)
        except OSError as error:
            raise _Unreadable(f"{source.place} cannot be read: {error.strerror or error}.") from error
    if "infer" in steps:
        with clock.stage("infer", 0.0):
            config = conversion.config
            assembly = load_assembly(model, config=config.assembly, **conversion.reading)
            known["parts"] = len(assembly.parts)
            known["faces"] = sum(len(part.faces) for part in assembly.parts)
            inference = infer(assembly, vlm=conversion.vlm, config=config, settings=conversion.settings)
            known["asked"] = (inference.vision or {}).get("described", "")
            known["parts"] = len(inference.assembly.parts)  # pieces of a mesh are fewer parts
            known["lengths"], known["warnings"] = assembly.lengths, tuple(inference.warnings)
        if "refine" in steps:
            with clock.stage("refine", 0.0):
                inference = refine(inference, settings=conversion.settings).inference
        with clock.stage("write", 0.0):
            write_inference_files(inference, made, preview=False)
        known["joints"] = sum(joint.kind is not JointType.FIXED for joint in inference.model.joints)
        model = made / MODEL_FILE
    if "validate" in steps:
        with clock.stage("validate", 0.0):
            report = validate(model, settings=conversion.settings, workers=1)
            report = replace(report, model=posixpath.join(place, MODEL_FILE) if "infer" in steps else source.place)
            (made / REPORT_FILE).write_text(as_json_text([report]), encoding="utf-8")
            _draw(report, model, conversion.settings, made)
        known["verdict"] = report.verdict
        errors = [item for item in report.counted if item.severity is Severity.ERROR and item.follows_from is None]
        known["errors"] = tuple(dict.fromkeys(map(_place_words, errors)))[:_ERRORS]
    if "export" in steps:
        with clock.stage("export", 0.0):
            for form in conversion.formats:
                export(model, form, made / FORMATS[form], settings=conversion.settings)
    with clock.stage("store", 0.0):
        publish(made, place)


def _draw(report: ValidationReport, model: Path, settings: ValidationSettings, made: Path) -> None:
    """Write the page of the model, to turn and move, and a small picture for the page of all objects."""
    drawing = drawing_of(model, (), settings, seconds=_DRAWING_SECONDS)
    scenes = {report.model: drawing.scene} if drawing.scene else {}
    (made / VIEW_FILE).write_text(as_html([report], {report.model: drawing.picture}, scenes), encoding="utf-8")
    if drawing.picture:
        with Image.open(io.BytesIO(drawing.picture)) as picture:
            picture.thumbnail(_THUMBNAIL)
            picture.convert("RGB").save(made / THUMBNAIL_FILE, quality=80)


def _place_words(finding: Finding) -> str:
    place = finding.joint or " and ".join(finding.pair or ()) or finding.link
    return CHECKS[finding.check].fails + (f" ({place})" if place else "")


def _forget_peak() -> None:
    """Reset the peak memory of the process, where the kernel can: a worker takes many objects."""
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")


def _peak_mb() -> float:
    """Most resident memory of this process since `_forget_peak` [MB]."""
    with suppress(OSError):
        status = Path("/proc/self/status").read_text(encoding="ascii")
        return float(re.findall(r"^VmHWM:\s*(\d+) kB$", status, re.MULTILINE)[0]) / 1024.0
    return peak_mb()
