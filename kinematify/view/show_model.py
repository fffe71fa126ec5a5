"""`kinematify.view`: the page of a model or of a mesh, or a picture."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinematify.errors import InputError, OutputError
from kinematify.model.output import urdf_of
from kinematify.robot.description import notes_of
from kinematify.robot.mesh_paths import CAD_SUFFIXES, MESH_SUFFIXES
from kinematify.versions import require
from kinematify.view.inference_view import FindingMarker
from kinematify.view.window import Window, model_window

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.view.piece_page import PiecePage
    from kinematify.view.server import ModelViewer

_SHOWN_TITLE = 60


def view(
    model: str | Path,
    q: Mapping[str, float] | None = None,
    *,
    arguments: Mapping[str, str] | None = None,
    png: str | Path | None = None,
    package_dirs: Sequence[str | Path] = (),
    report: str | Path | None = None,
    answer: str | Path | None = None,
    up: str = "auto",
    scale: float | None = None,
    pieces: str = "auto",
    host: str = "127.0.0.1",
    port: int = 8080,
) -> Window[ModelViewer] | Window[PiecePage] | None:
    """Start to show a model or the pieces of a mesh in a browser, as `kinematify view` does, or draw a picture.

    Args:
        model: URDF, xacro, MJCF, SDF, USD, model folder or mesh, or a name of robot_descriptions.
        q: Where joints are first, by name [rad or m].
        arguments: Of a xacro.
        png: Picture to write; nothing is shown then.
        package_dirs: Where packages lie (``package://``).
        report: From ``validate --json``: its findings become buttons; validation.json beside the model if absent.
        answer: Of a mesh: where a button writes which pieces are one moving part; answer.json beside it if absent.
        up: Axis of a mesh that points up, as `kinematify.load_assembly` takes it; so are the next two.
        scale: Metres per unit.
        pieces: How parts come about.
        host: ``0.0.0.0`` lets other machines in.
        port: Another one is taken if it is not free.

    Returns:
        The window: `run` serves it until Ctrl-C, `run_aside` beside the caller, `close` ends it. None for a picture.

    Raises:
        InputError: The model or the report cannot be read, or there is no such joint.
        OutputError: The picture cannot be written.
        EnvironmentFault: viser is not installed.
    """
    model, folders = Path(model), tuple(map(Path, package_dirs))
    if model.suffix.lower() in (*CAD_SUFFIXES, *MESH_SUFFIXES):
        if q or png or report:
            raise InputError(f"{model} is a mesh and has no joints: --joint, --png and --report are for models.")
        out = model.with_name("answer.json") if answer is None else Path(answer)
        if out.exists():
            raise InputError(f"The answer {out} exists. Give another file with --answer, or remove it.")
        require("The viewer", "viser")
        from kinematify.view.piece_page import PiecePage  # noqa: PLC0415  # needs viser
        from kinematify.vision.piece_question import asked_question, infer_command  # noqa: PLC0415

        question = asked_question(model, up, scale, pieces)
        page = partial(PiecePage, question=question, out=out, command=infer_command(model, out))
        return Window(page, host=host, port=port)
    if png is not None:
        from kinematify.view.loaded import load  # noqa: PLC0415  # with the renderer

        picture = load(model, package_dirs=folders, arguments=arguments).picture(q)
        try:
            picture.save(png, format="PNG")
        except OSError as error:
            raise OutputError(f"The picture {png} cannot be written: {error.strerror}. Give another file.") from error
        return None
    urdf = urdf_of(model, folders, arguments)
    findings = urdf.parent / "validation.json" if report is None else Path(report)
    sights = _sights(findings) if report is not None or findings.is_file() else []
    window = model_window(urdf, package_dirs=folders, sights=sights, host=host, port=port)
    known = window.viewer.values
    unknown = [name for name in q or {} if name not in known]
    if unknown:
        window.close()
        raise InputError(
            f"{urdf} has no joint {unknown[0]} that can be set. It has {', '.join(sorted(known)) or 'none'}."
        )
    window.viewer.set(dict(q or {}))
    window.notes = notes_of(urdf)
    return window


def _sights(report: Path) -> list[FindingMarker]:
    """Findings of a report that name a place or a configuration, errors first as in the report."""
    try:
        stated = json.loads(report.read_text(encoding="utf-8"))
        titles = {check["check"]: check["title"] for check in stated.get("checks", ())}
        findings = stated["findings"]
        return [_sight(finding, titles) for finding in findings if finding["q"] or finding["pair"] or finding["link"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{report} is no report of one model ({type(error).__name__}: {error}). Give the file that `kinematify "
            "validate MODEL --json FILE` wrote."
        ) from error


def _sight(finding: dict[str, Any], titles: Mapping[str, str]) -> FindingMarker:
    place = finding["joint"] or " - ".join(finding["pair"] or ()) or finding["link"] or ""
    links = [*(finding["pair"] or ()), *([finding["link"]] if finding["link"] else [])]
    title = titles.get(finding["check"], finding["check"])
    return FindingMarker(
        title=f"{place}: {title}"[:_SHOWN_TITLE],
        message=f"{finding['message']} {finding['remedy']} ({finding['severity']} {finding['check']})",
        q={name: float(value) for name, value in (finding["q"] or {}).items() if value is not None},
        links=tuple(links),
    )
