"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path

import click

package_dirs_option = click.option(
    "--package-dir",
    "package_dirs",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Package, or folder of packages, for package:// paths; may be given more than once.",
)

sampling_seed_option = click.option(
    "--seed", type=int, help="Seed of the sampled configurations, instead of the configuration's."
)


def listed(words: str | None) -> tuple[str, ...]:
    """The words of an option that takes several, separated by commas; none if it was not given."""
    return tuple(word.strip() for word in (words or "").split(",") if word.strip())
