"""Options that several commands share, what a shell completes behind them, and examples under the help of a command."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import click


def _package_dirs(context: click.Context, _parameter: click.Parameter, given: tuple[Path, ...]) -> tuple[Path, ...]:
    """Folders as given; ``NAME=DIR`` becomes a folder that has the package under its name, as engines look for it."""
    folders = []
    for folder in given:
        name, equals, place = str(folder).partition("=")
        if equals and not folder.is_dir():
            if not Path(place).is_dir() or name != Path(name).name:
                raise click.BadParameter(f"{folder} names no folder. Give DIR, or NAME=DIR with the package's name.")
            holder = Path(context.with_resource(tempfile.TemporaryDirectory(prefix="kinematify-packages-")))
            (holder / name).symlink_to(Path(place).resolve())
            folders.append(holder)
        else:
            folders.append(folder)
    return tuple(folders)


package_dirs_option = click.option(
    "--package-dir",
    "package_dirs",
    multiple=True,
    type=click.Path(path_type=Path),
    callback=_package_dirs,
    metavar="[NAME=]DIR",
    help="Package, or folder of packages, for package:// paths, or the package NAME; may be given more than once.",
)


def _arguments(_context: click.Context, _parameter: click.Parameter, given: tuple[str, ...]) -> dict[str, str] | None:
    """Arguments of a xacro, by name."""
    wrong = next((word for word in given if not word.partition(":=")[0] or ":=" not in word), None)
    if wrong is not None:
        raise click.BadParameter(f"{wrong!r} is no NAME:=VALUE. Give one model, and arguments if it is a xacro.")
    return {name: value for name, _, value in (word.partition(":=") for word in given)} or None


arguments_argument = click.argument("arguments", nargs=-1, metavar="[NAME:=VALUE]...", callback=_arguments)
"""What follows a xacro."""

jobs_option = click.option(
    "--jobs", type=click.IntRange(min=1), help="Processes at a time; as many as there are cores if not given."
)

force_file_option = click.option("--force", "overwrite", is_flag=True, help="Replace the file of -o if it exists.")

preview_option = click.option(
    "--no-preview", "preview", is_flag=True, flag_value=False, default=True, help="Write no picture."
)

validation_option = click.option(
    "--no-validation",
    "validation",
    is_flag=True,
    flag_value=False,
    default=True,
    help="Skip the validation, which takes most of the time.",
)

sampling_seed_option = click.option(
    "--seed", type=int, help="Seed of the sampled configurations, instead of the configuration's."
)


def _metres(_context: click.Context, _parameter: click.Parameter, given: str) -> float | None:
    """Metres per unit; None for ``auto``: what the file states."""
    try:
        return None if given == "auto" else float(given)
    except ValueError as error:
        raise click.BadParameter(f"{given!r} is no number; give auto, or metres per unit: 0.001 for mm.") from error


up_option = click.option(
    "--up",
    type=click.Choice(["auto", "z", "y", "x", "-z", "-y", "-x"]),
    default="auto",
    show_default=True,
    help="Axis of the input that points up (-z: it lies upside down); auto: y for glTF, what COLLADA says, else z.",
)
scale_option = click.option(
    "--scale",
    callback=_metres,
    default="auto",
    show_default=True,
    metavar="auto|NUMBER",
    help="Metres per unit of the input; auto: the unit that a file states, else metres.",
)

pieces_option = click.option(
    "--pieces",
    type=click.Choice(["auto", "group", "cut", "keep"]),
    default="auto",
    show_default=True,
    help="How parts come about. auto: pieces of one mesh are grouped into rigid parts, other files have a part per "
    "node or group; group: these are grouped too; cut: after cuts where surfaces fold inwards; keep: all pieces.",
)

vlm_option = click.option(
    "--vlm",
    default="off",
    show_default=True,
    metavar="off|auto|URL",
    help="Ask a vision-language model which pieces move together, and how: a chat interface, or that of "
    "KINEMATIFY_VLM_URL. One question an object, none where parts are given and no joint is doubtful.",
)


def listed(_context: click.Context, _parameter: click.Parameter, words: str | None) -> tuple[str, ...]:
    """The words of an option that takes several, separated by commas; none if it was not given."""
    return tuple(word.strip() for word in (words or "").split(",") if word.strip())


def examples(*lines: str) -> str:
    """Return an epilog that shows `lines` as they are, one below the other."""
    return "\n".join(("\b", "Examples:", *(f"  {line}" for line in lines)))  # \b keeps click from re-flowing


def complete_categories(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """Categories of objects that begin so."""
    from kinematify.generate.registry import all_kinds

    return [name for name in all_kinds() if name.startswith(begun)]


def complete_checks(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """Ids of checks that begin so, in either case."""
    from kinematify.validation.checks import CHECKS

    return [name for name in CHECKS if name.startswith(begun.upper())]


def complete_joints(context: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """Joints that move of the model that was named; none where it cannot be read."""
    from kinematify.errors import InputError
    from kinematify.robot.read import read_robot

    # A line that ends with an option is not parsed to its end: the model is then among the words that are left.
    for word in (context.params.get("model"), *context.args):
        path = Path(word or "")
        try:
            robot = read_robot(path / "model.urdf" if path.is_dir() else path, geometry="none")
        except InputError:
            continue
        return [joint.name for joint in robot.leaders if joint.name.startswith(begun)]
    return []


def say(text: str) -> None:
    """Print on stdout; with colours on a terminal only, and not if the user does not want any."""
    colored = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
    encoding = sys.stdout.encoding or "utf-8"
    click.echo(text.encode(encoding, "replace").decode(encoding), color=colored)
