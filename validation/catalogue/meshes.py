"""KV15x: the mesh files."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check

CHECKS: tuple[Check, ...] = ()
