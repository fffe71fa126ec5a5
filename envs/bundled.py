"""Objects that come with the package: built in code when they are asked for, nothing is downloaded."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.registry import FAMILIES, build
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model

if TYPE_CHECKING:
    from pathlib import Path

PREFIX = "bundled:"
"""What a `model` keyword begins with that names a bundled object."""
FAMILY_PREFIX = "procedural:"
"""What a `model` keyword begins with that names a family of `kinematify generate`, built with its usual sizes; a seed
behind the name, ``procedural:FAMILY:SEED``, draws them."""


BUNDLED = {
    "drawers": ("cabinet width=0.5 height=0.6 depth=0.45 doors=0 drawers=3", "drawer_2_joint"),
    "nightstand": ("cabinet width=0.45 height=0.5 depth=0.4 doors=1 drawers=1", "drawer_1_joint"),
    "dresser": ("cabinet width=0.9 height=0.8 depth=0.45 layout=2*(2*drawer)", "drawer_1_joint"),
    "pedestal": ("cabinet width=0.4 height=0.65 depth=0.5 doors=0 drawers=2", "drawer_1_joint"),
    "desk": ("table drawers=1", "drawer_1_joint"),
    "cabinet": ("cabinet", "door_1_joint"),
    "door": ("door", "leaf_1_joint"),
    "fridge": ("fridge", "door_1_joint"),
    "microwave": ("microwave", "door_joint"),
    "oven": ("oven", "door_joint"),
    "dishwasher": ("dishwasher", "door_joint"),
    "box": ("box", "lid_joint"),
    "laptop": ("laptop", "screen_joint"),
    "safe": ("safe", "door_joint"),
}
"""Family with what it is asked for, as `kinematify generate` takes it, and the joint that is opened; keyed by name."""
DEFAULT = "drawers"


def write_bundled(model: str, folder: Path) -> tuple[Path, str]:
    """Write the object of a `model` keyword with one of both prefixes, with its exact joints.

    Args:
        model: The keyword.
        folder: It does not exist yet.

    Returns:
        Its URDF, and the joint that is opened if none is asked for.

    Raises:
        InputError: There is no such object; the message names the nearest.
        OSError: It cannot be written.
    """
    family, settings, joint, seed = _found(model)
    folder.mkdir(parents=True)
    config = load_config()
    built = true_model(build(family, settings, seed=seed), config)
    return write_model(simulable_model(built, config).robot, folder), joint


def _found(model: str) -> tuple[str, dict[str, str], str, int | None]:
    """Family, what it is asked for, joint, and the seed that draws what is left open."""
    prefix = PREFIX if model.startswith(PREFIX) else FAMILY_PREFIX
    name = model.removeprefix(prefix)
    name, _, seed = name.partition(":")
    if prefix == FAMILY_PREFIX and name in FAMILIES and (seed.isdecimal() or not seed):
        return name, {}, "auto", int(seed) if seed else None
    if prefix == PREFIX and name in BUNDLED:
        (family, *words), joint = BUNDLED[name][0].split(), BUNDLED[name][1]
        return family, dict(word.split("=", 1) for word in words), joint, None
    names = list(BUNDLED if prefix == PREFIX else FAMILIES)
    near = difflib.get_close_matches(name, names, n=1)
    hint = f"Did you mean {prefix}{near[0]}? " if near else ""
    raise InputError(f"There is no object {model}. {hint}There are {', '.join(names)}.")
