"""KV2xx: masses, limits and collision geometry as declared."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check

CHECKS: tuple[Check, ...] = ()
