"""What `kinematify explain` tells about a check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.validation.finding import Blame, Severity


@dataclass(frozen=True, kw_only=True)
class Check:
    """A check as the documentation knows it; ids are stable for ever."""

    id: str
    """``KVnnn``; the first digit is the family."""
    title: str
    """A few words, as in a table."""
    severity: Severity
    """The worst that it reports."""
    blame: Blame
    """What it usually blames."""
    engines: tuple[str, ...] = ()
    """Engines that it runs in; empty: none."""
    verifies: str
    """What is looked at and what counts as wrong, thresholds by their setting's name."""
    matters: str
    """What goes wrong in practice if it is ignored."""
    remedy: str
    """How to mend it."""
