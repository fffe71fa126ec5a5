"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from kinematify.config import Config

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

collision_option = click.option(
    "--collision",
    type=click.Choice(["auto", "mesh"]),
    help="Collision geometry: boxes and convex pieces carved by the motion (auto, the configuration's), or the visual "
    "meshes, of which engines take the hulls.",
)


def with_collision(config: Config, mode: str | None) -> Config:
    """A configuration with the collision geometry that was asked for, if any was."""
    if mode is None:
        return config
    return config.model_copy(update={"collision": config.collision.model_copy(update={"mode": mode})})


def listed(words: str | None) -> tuple[str, ...]:
    """The words of an option that takes several, separated by commas; none if it was not given."""
    return tuple(word.strip() for word in (words or "").split(",") if word.strip())
