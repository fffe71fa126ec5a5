"""KV30x to KV33x: collision along the motion, by exact geometry."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check

CHECKS: tuple[Check, ...] = ()
