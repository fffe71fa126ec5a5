"""What a page shows: a model, and what its inference tells of the joints."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.view.alternatives import Alternative
    from kinematify.view.scene import ViewScene


@dataclass(frozen=True, kw_only=True, eq=False)
class Shown:
    """A model to look at."""

    scene: ViewScene
    alternatives: Mapping[tuple[str, str], tuple[Alternative, ...]] = field(default_factory=dict)
    """Candidates of joints by (parent, child) link."""
    doubtful: tuple[str, ...] = ()
    """Links whose joints are to be looked at, the least sure first."""
