"""Examples under the help of a command."""

from __future__ import annotations


def examples(*lines: str) -> str:
    """Return an epilog that shows `lines` as they are, one below the other."""
    return "\n".join(("\b", "Examples:", *(f"  {line}" for line in lines)))  # \b keeps click from re-flowing
