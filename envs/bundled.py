"""Objects that come with the package: built in code when they are asked for, nothing is downloaded."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.delivery import build_kind
from kinematify.generate.families import FAMILIES
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model

if TYPE_CHECKING:
    from pathlib import Path

PREFIX = "bundled:"
"""What a `model` keyword begins with that names a bundled object."""
FAMILY_PREFIX = "procedural:"
"""What a `model` keyword begins with that names a family of `kinematify generate`, built with its usual sizes; a seed
behind the name, ``procedural:FAMILY:SEED``, draws them."""


@dataclass(frozen=True, kw_only=True)
class BundledObject:
    """A family with what it is asked for."""

    family: str
    settings: dict[str, str]
    joint: str
    """Joint that is opened if none is asked for."""
    seed: int | None = None
    """Draws what the settings leave open."""


def _bundled(family: str, joint: str, **settings: str) -> BundledObject:
    return BundledObject(family=family, settings=settings, joint=joint)


BUNDLED: dict[str, BundledObject] = {
    "drawers": _bundled("cabinet", "drawer_2_joint", width="0.5", height="0.6", depth="0.45", doors="0", drawers="3"),
    "nightstand": _bundled(
        "cabinet", "drawer_1_joint", width="0.45", height="0.5", depth="0.4", doors="1", drawers="1"
    ),
    "dresser": _bundled("cabinet", "drawer_1_joint", width="0.9", height="0.8", depth="0.45", layout="2*(2*drawer)"),
    "pedestal": _bundled("cabinet", "drawer_1_joint", width="0.4", height="0.65", depth="0.5", doors="0", drawers="2"),
    "desk": _bundled("table", "drawer_1_joint", drawers="1"),
    "cabinet": _bundled("cabinet", "door_1_joint"),
    "door": _bundled("door", "leaf_1_joint"),
    "fridge": _bundled("fridge", "door_1_joint"),
    "microwave": _bundled("microwave", "door_joint"),
    "oven": _bundled("oven", "door_joint"),
    "dishwasher": _bundled("dishwasher", "door_joint"),
    "box": _bundled("box", "lid_joint"),
    "laptop": _bundled("laptop", "screen_joint"),
    "safe": _bundled("safe", "door_joint"),
}
"""Keyed by name."""
DEFAULT = "drawers"


def find_bundled(model: str) -> BundledObject:
    """Return what a `model` keyword with one of both prefixes represents.

    Raises:
        InputError: There is no such object; the message names the nearest.
    """
    prefix = PREFIX if model.startswith(PREFIX) else FAMILY_PREFIX
    name = model.removeprefix(prefix)
    name, _, seed = name.partition(":")
    if prefix == FAMILY_PREFIX and name in FAMILIES and (seed.isdecimal() or not seed):
        return BundledObject(family=name, settings={}, joint="auto", seed=int(seed) if seed else None)
    if prefix == PREFIX and name in BUNDLED:
        return BUNDLED[name]
    names = list(BUNDLED if prefix == PREFIX else FAMILIES)
    near = difflib.get_close_matches(name, names, n=1)
    hint = f"Did you mean {prefix}{near[0]}? " if near else ""
    raise InputError(f"There is no object {model}. {hint}There are {', '.join(names)}.")


def write_bundled(bundled: BundledObject, folder: Path) -> Path:
    """Write the object with its exact joints into a folder that does not exist yet, and return its URDF.

    Raises:
        OSError: It cannot be written.
    """
    folder.mkdir(parents=True)
    config = load_config()
    model = true_model(build_kind(bundled.family, bundled.settings, seed=bundled.seed), config)
    return write_model(simulable_model(model, config).robot, folder)
