"""KV6xx: do the engines and the analytical model agree?."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check

CHECKS: tuple[Check, ...] = ()
