"""`kinematify view`: a model in a browser, with a slider per joint."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.options import (
    arguments_argument,
    complete_joints,
    examples,
    package_dirs_option,
    pieces_option,
    scale_option,
    up_option,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.view.inference_view import FindingMarker
    from kinematify.view.piece_page import PiecePage
    from kinematify.view.server import ModelViewer
    from kinematify.view.window import Window

_SHOWN_TITLE = 60


@click.command(
    "view",
    epilog=examples(
        "kinematify view out/cabinet/model.urdf",
        "kinematify view out/cabinet",
        "kinematify view model.urdf --joint door_joint --q 0.8",
        "kinematify view model.urdf --joint door_joint --q 0.8 --png open.png",
        "kinematify view model.urdf --report report.json --port 8090",
        "kinematify view whole.glb --answer answer.json",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@arguments_argument
@click.option(
    "--joint",
    "joints",
    multiple=True,
    metavar="NAME",
    shell_complete=complete_joints,
    help="Joint to move to the value of the --q that follows it.",
)
@click.option("--q", "values", multiple=True, type=float, metavar="VALUE", help="Its value [rad or m].")
@click.option("--png", type=click.Path(path_type=Path), metavar="FILE", help="Write a picture there, and show nothing.")
@package_dirs_option
@click.option(
    "--report",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="From `validate --json`: its findings become buttons.  [default: validation.json beside the model]",
)
@click.option(
    "--answer",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Of a mesh: where the button writes which pieces are one moving part.  [default: answer.json beside it]",
)
@up_option
@scale_option
@pieces_option
@click.option("--host", default="127.0.0.1", show_default=True, help="0.0.0.0 lets other machines in.")
@click.option(
    "--port", type=click.IntRange(0, 65535), default=8080, show_default=True, help="A free one if it is taken."
)
def command(
    *,
    model: Path,
    arguments: dict[str, str],
    joints: tuple[str, ...],
    values: tuple[float, ...],
    png: Path | None,
    package_dirs: tuple[Path, ...],
    report: Path | None,
    answer: Path | None,
    up: str,
    scale: float | None,
    pieces: str,
    host: str,
    port: int,
) -> int:
    """Show MODEL, a URDF, xacro, MJCF, SDF, USD, a model folder or a mesh, until Ctrl-C.

    Sliders move the joints; axes and limits are drawn; what collides is red. Where inference.json lies beside the
    model, the candidates of each joint are named, can be tried, and "Keep this" writes the model with one of them and
    shows the command that does the same. Over SSH, forward the port that is printed: ssh -L 8080:localhost:8080.

    Of a mesh that nobody segmented, the pieces are shown as `kinematify question` numbers them: click those of a moving
    part, and the line that it turns about or slides along. A button writes the answer for `infer MESH --answer`.
    """
    from functools import partial

    from kinematify.cli.asking import asked_question, infer_command
    from kinematify.errors import InputError
    from kinematify.robot.mesh_paths import CAD_SUFFIXES, MESH_SUFFIXES
    from kinematify.versions import require
    from kinematify.view.window import Window, model_window

    if model.suffix.lower() in (*CAD_SUFFIXES, *MESH_SUFFIXES):
        if joints or png or report:
            raise InputError(f"{model} is a mesh and has no joints: --joint, --png and --report are for models.")
        out = answer or model.with_name("answer.json")
        if out.exists():
            raise InputError(f"The answer {out} exists. Give another file with --answer, or remove it.")
        require("The viewer", "viser")
        from kinematify.view.piece_page import PiecePage

        page = partial(
            PiecePage, question=asked_question(model, up, scale, pieces), out=out, command=infer_command(model, out)
        )
        return _serve(Window(page, host=host, port=port), model, port)
    from kinematify.model.output import urdf_of
    from kinematify.robot.description import notes_of

    if len(joints) != len(values):
        raise InputError(f"There are {len(joints)} --joint and {len(values)} --q. Give one value for each joint.")
    if png is not None:
        _draw(model, png, dict(zip(joints, values, strict=True)), package_dirs, arguments)
        return 0
    urdf = urdf_of(model, package_dirs, arguments)
    findings = report or urdf.parent / "validation.json"
    sights = _sights(findings) if report is not None or findings.is_file() else []
    for note in notes_of(urdf):
        click.echo(note)
    window = model_window(urdf, package_dirs=package_dirs, sights=sights, host=host, port=port)
    known = window.viewer.values
    unknown = [name for name in joints if name not in known]
    if unknown:
        window.close()
        raise InputError(
            f"{urdf} has no joint {unknown[0]} that can be set. It has {', '.join(sorted(known)) or 'none'}."
        )
    window.viewer.set(dict(zip(joints, values, strict=True)))
    return _serve(window, urdf if model.is_dir() else model, port)


def _serve(window: Window[ModelViewer] | Window[PiecePage], shown: Path, port: int) -> int:
    """Serve a page until Ctrl-C."""
    try:
        if port and window.port != port:
            click.echo(f"Port {port} is in use, so {window.port} is taken.")
        click.echo(f"{window.url} shows {shown.resolve()}; Ctrl-C ends it.")
        window.run()
    except KeyboardInterrupt:
        click.echo("Closed.")
    finally:
        window.close()
    return 0


def _draw(
    model: Path, png: Path, q: Mapping[str, float], package_dirs: tuple[Path, ...], arguments: dict[str, str]
) -> None:
    from kinematify.errors import OutputError
    from kinematify.view.loaded import load

    picture = load(model, package_dirs=package_dirs, arguments=arguments).picture(q)
    try:
        picture.save(png, format="PNG")
    except OSError as error:
        raise OutputError(f"The picture {png} cannot be written: {error.strerror}. Give another file.") from error
    click.echo(f"Wrote {png}")


def _sights(report: Path) -> list[FindingMarker]:
    """Findings of a report that name a place or a configuration, errors first as in the report."""
    from kinematify.errors import InputError

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
    from kinematify.view.inference_view import FindingMarker

    place = finding["joint"] or " - ".join(finding["pair"] or ()) or finding["link"] or ""
    links = [*(finding["pair"] or ()), *([finding["link"]] if finding["link"] else [])]
    title = titles.get(finding["check"], finding["check"])
    return FindingMarker(
        title=f"{place}: {title}"[:_SHOWN_TITLE],
        message=f"{finding['message']} {finding['remedy']} ({finding['severity']} {finding['check']})",
        q={name: float(value) for name, value in (finding["q"] or {}).items() if value is not None},
        links=tuple(links),
    )
