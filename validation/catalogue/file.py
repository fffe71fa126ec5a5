"""KV10x to KV14x: the file and the tree, before any mesh is opened."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check

CHECKS: tuple[Check, ...] = ()
