"""KV4xx and KV5xx: behaviour in MuJoCo and PyBullet."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check

CHECKS: tuple[Check, ...] = ()
