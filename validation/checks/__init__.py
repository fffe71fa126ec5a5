"""Every check: a function each, in one module per family. Reading them loads no engine."""

from __future__ import annotations

import difflib

from kinematify.errors import InputError
from kinematify.validation.check import REGISTRY, Check
from kinematify.validation.checks import (  # noqa: F401 - each registers its checks
    as_loaded,
    collision_geometry,
    contract,
    declared_limits,
    declared_masses,
    drives,
    evidence,
    file_joints,
    file_names,
    file_numbers,
    file_references,
    file_shapes,
    file_text,
    file_tree,
    inertias,
    loops,
    meshes,
    motion,
    rest,
    semantics,
    several_joints,
    task,
    twins,
    unit_sizes,
)

__all__ = ["CHECKS", "checks_of", "find_check"]

CHECKS: dict[str, Check] = dict(sorted(REGISTRY.items()))
"""All checks keyed by id, in ascending order."""


def checks_of(*beginnings: str) -> tuple[Check, ...]:
    """Return the checks whose id begins in one of these ways, in ascending order."""
    return tuple(check for name, check in CHECKS.items() if name.startswith(beginnings))


def find_check(name: str) -> Check:
    """Return the check of an id, in any letter case.

    Raises:
        InputError: There is none; the message names the nearest ids.
    """
    wanted = name.strip().upper()
    if wanted in CHECKS:
        return CHECKS[wanted]
    near = difflib.get_close_matches(wanted, CHECKS, n=3, cutoff=0.5)
    hint = f"Did you mean {' or '.join(near)}?" if near else "`kinematify explain --list` shows all."
    raise InputError(f"There is no check {name!r}. Checks have ids such as KV301. {hint}")
