"""KV34x to KV36x: does the geometry of two links explain the joint between them?."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check

CHECKS: tuple[Check, ...] = ()
