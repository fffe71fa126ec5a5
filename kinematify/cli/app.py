"""The `kinematify` command: finds the subcommand and turns every exception into a message and an exit status.

`ExitStatus` says what the numbers mean.
"""

from __future__ import annotations

import importlib
import sys
import traceback
from typing import TYPE_CHECKING, NoReturn

import click
from click.exceptions import NoSuchCommand

from kinematify import __version__
from kinematify.errors import ExitStatus, KinematifyError
from kinematify.processes.start import keep_memory

if TYPE_CHECKING:
    from collections.abc import Sequence

COMMANDS = {
    "generate": "A sentence, a request or a photo -> a model; sentences and requests work offline.",
    "infer": "Segmented meshes -> URDF with joints, axes, limits and masses.",
    "question": "A picture of numbered pieces and a question: which of them move together.",
    "refine": "Simulate an inferred model and choose the joints that fail again.",
    "validate": "URDFs from anywhere -> verdict, findings with cause and remedy.",
    "explain": "What a check of `validate` verifies, why, and how to fix what it finds.",
    "fix": "URDF -> the same URDF, repaired where validate finds something.",
    "view": "A model in a browser, to move; a mesh, to click its pieces.",
    "export": "URDF -> MJCF, USD, SDF, GLB, SRDF, URDF.",
    "erase": "URDF -> anonymous part meshes, and the ground truth in a file beside them.",
    "batch": "A library of assets -> models, resumable, on one machine or many.",
    "bench": "Accuracy on models with known joints, beside the paper's.",
    "nightly": "Benchmark and validation, compared with the night before.",
    "doctor": "Versions, engines, what is missing and how to install it.",
    "mcp": "The commands as tools for coding agents (Model Context Protocol).",
}
"""Each is a module of this package that defines `command`, here with what it does."""


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command line and end the process with the exit status."""
    keep_memory()
    sys.exit(run(arguments))


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit status; no exception passes but those that end the interpreter.

    Args:
        arguments: Words after `kinematify`; those of the process if absent.
    """
    asked: dict[str, bool] = {}  # of the error boundary
    try:
        status = cli.main(arguments, prog_name="kinematify", standalone_mode=False, obj=asked)
    except click.ClickException as error:
        error.show()
        return ExitStatus.UNUSABLE
    except click.Abort:
        _say("Interrupted. Nothing half-written was left: a result appears at its place only when it is complete.")
        return ExitStatus.INTERRUPTED
    except KinematifyError as error:
        _say(f"Error: {error}", with_traceback="traceback" in asked)
        return error.exit_status
    except Exception as error:  # the boundary itself: whatever is left is a defect of ours
        _say(_crash_message(error, shown="traceback" in asked), with_traceback="traceback" in asked)
        return ExitStatus.FAULT
    return status if isinstance(status, int) else 0


def _say(message: str, *, with_traceback: bool = False) -> None:
    if with_traceback:
        click.echo(traceback.format_exc(), err=True, nl=False)
    click.echo(message, err=True)


def _crash_message(error: Exception, *, shown: bool) -> str:
    what = f"Error: Kinematify failed unexpectedly with {type(error).__name__}: {error}. This is a defect of ours."
    if shown:
        return f"{what} Please report it with the traceback above, the command, and what `kinematify doctor` prints."
    return f"{what} Run the same command with --traceback to see where, and report it with what that prints."


class _LazyGroup(click.Group):
    """A group that imports a command's module when the command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Commands in the order of the work, not of the alphabet."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import and return the command, None if there is none of this name."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = importlib.import_module(f"kinematify.cli.{cmd_name}").command
        if _TRACEBACK not in command.params:
            command.params.append(_TRACEBACK)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands; importing all of them would take longer than the rest."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, or say which one may have been meant; click looks among the loaded ones only."""
        try:
            return super().resolve_command(ctx, args)
        except NoSuchCommand as error:
            raise NoSuchCommand(error.command_name, possibilities=list(COMMANDS), ctx=ctx) from None


def _ask_for_traceback(ctx: click.Context, _parameter: click.Parameter, value: bool) -> None:
    if value:
        ctx.find_root().obj["traceback"] = True


_TRACEBACK = click.Option(
    ["--traceback"],
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_ask_for_traceback,
    help="Show the Python traceback of an error.",
)


@click.command(
    cls=_LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit status: 0 fine; 1 ran and found failures; 2 unusable input or arguments; 3 an engine or the "
    "environment failed. `kinematify COMMAND --help` shows examples.",
)
@click.version_option(__version__, prog_name="kinematify")
def cli() -> None:
    """A shape goes in, a mechanism that works in simulation comes out.

    Start with `kinematify infer ASSEMBLY -o OUT`: it takes the segmented meshes of an object (a folder with one
    mesh per part, a GLB, a ZIP, a URDF) and writes a URDF with joints, axes, limits and masses.
    """
