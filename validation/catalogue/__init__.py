"""Every check by id, grouped in families; reading it loads no engine."""

from __future__ import annotations

import difflib

from kinematify.errors import InputError
from kinematify.validation.catalogue import agreement, task
from kinematify.validation.check import FAMILIES, Check
from kinematify.validation.checks import CHECKS

__all__ = ["CATALOGUE", "FAMILIES", "Check", "find_check"]

CATALOGUE: dict[str, Check] = dict(
    sorted(
        {
            **CHECKS,
            **{c.id: c for m in (agreement, task) for c in m.CHECKS},
        }.items()
    )
)
"""Checks keyed by id, in ascending order."""


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
