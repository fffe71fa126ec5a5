"""What a shell completes behind options: categories, checks, and joints of a model that stands on the line already."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import click


def categories(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """Categories of objects that begin so."""
    from kinematify.generate.described import known_families

    return [name for name in known_families() if name.startswith(begun)]


def checks(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
    """Ids of checks that begin so, in either case."""
    from kinematify.validation.checks import CHECKS

    return [name for name in CHECKS if name.startswith(begun.upper())]


def joints(context: click.Context, _parameter: click.Parameter, begun: str) -> list[str]:
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
