"""Every check by id, grouped in families; reading it loads no engine."""

from __future__ import annotations

import difflib

from kinematify.errors import InputError
from kinematify.validation.catalogue import agreement, engines, evidence, file, geometry, meshes, physics, task
from kinematify.validation.catalogue.check import Check

__all__ = ["CATALOGUE", "FAMILIES", "Check", "find_check"]

FAMILIES = {
    "KV1": "file and tree",
    "KV2": "declared physics",
    "KV3": "kinematics by geometry",
    "KV4": "MuJoCo",
    "KV5": "PyBullet",
    "KV6": "agreement",
    "KV7": "task of a robot",
}
"""Title of each family, keyed by the beginning of its ids."""

CATALOGUE: dict[str, Check] = {
    check.id: check
    for module in (file, meshes, physics, geometry, evidence, engines, agreement, task)
    for check in sorted(module.CHECKS, key=lambda check: check.id)
}
"""Checks keyed by id, in ascending order within each module."""


def find_check(name: str) -> Check:
    """Return the check of an id, in any letter case.

    Raises:
        InputError: There is none; the message names the nearest ids.
    """
    wanted = name.strip().upper()
    if wanted in CATALOGUE:
        return CATALOGUE[wanted]
    near = difflib.get_close_matches(wanted, CATALOGUE, n=3, cutoff=0.5)
    hint = f"Did you mean {' or '.join(near)}?" if near else "`kinematify explain --list` shows all."
    raise InputError(f"There is no check {name!r}. Checks have ids such as KV301. {hint}")
