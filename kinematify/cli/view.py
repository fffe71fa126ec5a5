"""`kinematify view`: a model in a browser, with a slider per joint."""

from __future__ import annotations

import json
import threading
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kinematify.cli.help import examples
from kinematify.cli.options import package_dirs_option

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.view.alternatives import Alternative
    from kinematify.view.scene import ViewScene
    from kinematify.view.server import Sight

_SHOWN_TITLE = 60


@click.command(
    "view",
    short_help="A model in a browser: sliders, contacts, findings, alternatives.",
    epilog=examples(
        "kinematify view out/cabinet/model.urdf",
        "kinematify view out/cabinet",
        "kinematify view model.urdf --joint door_joint --q 0.8",
        "kinematify view model.urdf --report report.json --port 8090",
    ),
)
@click.argument("model", type=click.Path(path_type=Path))
@click.option("--joint", "joints", multiple=True, metavar="NAME", help="Joint that stands at the --q behind it.")
@click.option("--q", "values", multiple=True, type=float, metavar="VALUE", help="Its value [rad or m].")
@package_dirs_option
@click.option(
    "--report",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="From `validate --json`: its findings become buttons.  [default: validation.json beside the model]",
)
@click.option("--host", default="127.0.0.1", show_default=True, help="0.0.0.0 lets other machines in.")
@click.option(
    "--port", type=click.IntRange(0, 65535), default=8080, show_default=True, help="A free one if it is taken."
)
def command(
    *,
    model: Path,
    joints: tuple[str, ...],
    values: tuple[float, ...],
    package_dirs: tuple[Path, ...],
    report: Path | None,
    host: str,
    port: int,
) -> int:
    """Show MODEL, a URDF or a model folder, until Ctrl-C.

    Sliders move the joints; axes and limits are drawn; what collides is red. Candidates of each joint can be tried
    where inference.json lies beside the model. Over SSH, forward the port that is printed: ssh -L 8080:localhost:8080.
    """
    from kinematify.errors import InputError

    if len(joints) != len(values):
        raise InputError(f"There are {len(joints)} --joint and {len(values)} --q. Give one value for each joint.")
    urdf = model / "model.urdf" if model.is_dir() else model
    scene = _scene(urdf, package_dirs)
    known = {joint.name for joint in scene.leaders}
    unknown = [name for name in joints if name not in known]
    if unknown:
        raise InputError(
            f"{urdf} has no joint {unknown[0]} that can be set. It has {', '.join(sorted(known)) or 'none'}."
        )
    record, told = urdf.parent / "inference.json", report or urdf.parent / "validation.json"
    alternatives = _alternatives(record) if record.is_file() else {}
    sights = _sights(told) if report is not None or told.is_file() else []
    _serve(scene, alternatives, sights, dict(zip(joints, values, strict=True)), host=host, port=port)
    return 0


def _scene(urdf: Path, package_dirs: Sequence[Path]) -> ViewScene:
    from kinematify.config.validation import load_settings
    from kinematify.errors import InputError
    from kinematify.robot.read import read_robot
    from kinematify.view.scene import ViewScene

    if not urdf.is_file():
        raise InputError(f"There is no file {urdf}. Give a URDF, or a model folder that `kinematify infer` wrote.")
    return ViewScene(read_robot(urdf, package_dirs=package_dirs), load_settings())


def _alternatives(record: Path) -> dict[tuple[str, str], tuple[Alternative, ...]]:
    from kinematify.view.alternatives import load_alternatives

    return load_alternatives(record)


def _sights(report: Path) -> list[Sight]:
    """Findings of a report that name a place or a configuration, errors first as in the report."""
    from kinematify.errors import InputError

    try:
        findings = json.loads(report.read_text(encoding="utf-8"))["findings"]
        return [_sight(finding) for finding in findings if finding["q"] or finding["pair"] or finding["link"]]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{report} is no report of one model ({type(error).__name__}: {error}). Give the file that `kinematify "
            "validate MODEL --json FILE` wrote."
        ) from error


def _sight(finding: dict[str, Any]) -> Sight:
    from kinematify.view.server import Sight

    place = finding["joint"] or " - ".join(finding["pair"] or ()) or finding["link"] or ""
    links = [*(finding["pair"] or ()), *([finding["link"]] if finding["link"] else [])]
    return Sight(
        title=f"{finding['severity']} {finding['check']} {place}"[:_SHOWN_TITLE],
        message=f"{finding['message']} {finding['remedy']}",
        q={name: float(value) for name, value in (finding["q"] or {}).items() if value is not None},
        links=tuple(links),
    )


def _serve(
    scene: ViewScene,
    alternatives: dict[tuple[str, str], tuple[Alternative, ...]],
    sights: list[Sight],
    start: dict[str, float],
    *,
    host: str,
    port: int,
) -> None:
    """Serve until Ctrl-C."""
    try:
        import viser
    except ImportError as error:
        from kinematify.errors import EnvironmentFault

        raise EnvironmentFault(
            "The viewer needs the package viser, which is not installed. Run `pip install kinematify[view]`."
        ) from error
    from kinematify.view.server import ModelViewer

    with redirect_stdout(StringIO()):  # a banner of its own
        server = viser.ViserServer(host=host, port=port, label="kinematify view", verbose=False)
    try:
        viewer = ModelViewer(server, scene, alternatives=alternatives, sights=sights)
        viewer.set(start)
        shown = "localhost" if host in ("127.0.0.1", "0.0.0.0") else host
        click.echo(f"http://{shown}:{server.get_port()} shows {scene.robot.path}; Ctrl-C ends it.")
        viewer.run(threading.Event())
    except KeyboardInterrupt:
        click.echo("Closed.")
    finally:
        with redirect_stdout(StringIO()):
            server.stop()
