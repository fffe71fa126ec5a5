"""What is not in the registry yet."""

from __future__ import annotations

from kinematify.validation.check import Check

__all__ = ["Check"]
