"""The place of one mechanism on a side of a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.composer.bodies import BODY
from kinematify.generate.library.builder import drawn_on
from kinematify.generate.procedural.pieces.fronts import room
from kinematify.generate.procedural.solids import bore, cylinder

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from manifold3d import Manifold

    from kinematify.generate.library.builder import ObjectBuilder
    from kinematify.generate.procedural.pieces.fronts import Bay, Fitting
    from kinematify.generate.procedural.workshop import Workshop

OUTWARD = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Turns what is built to stand on z = 0 so that it stands on the side."""
HANGING = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Turns what is built to hang from z = 0 so that it hangs from the side."""
UPSIDE_DOWN = np.diag([-1.0, 1.0, -1.0])
"""Turns a side about its normal."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Placement:
    """Where one mechanism goes."""

    workshop: Workshop
    """In the frame of the side."""
    name: str
    """Of the body that moves; further ones add to it."""
    parent: str = BODY
    """Body that carries it."""
    area: Bay
    hollow: bool
    """A room may be cut behind it."""
    fitting: Fitting
    side: str
    """Name of the side."""
    half: str = ""
    """``left`` or ``right`` where that is said of a half of the side."""
    hinge: str = ""
    """``left`` or ``right`` where that is said of a door."""
    members: int = 0
    """How many blades and the like are asked for; 0: as usual."""
    beside: int = 1
    """How many sliding doors stand in its row."""
    index: int
    """Among those of its kind on the side, from 0."""

    @property
    def middle(self) -> tuple[float, float, float]:
        """Of the area, on the surface [m]."""
        return 0.5 * (self.area.left + self.area.right), 0.0, 0.5 * (self.area.bottom + self.area.top)

    @property
    def radius(self) -> float:
        """Of the largest circle in the area [m]."""
        return 0.5 * min(self.area.width, self.area.height)

    @property
    def clearance(self) -> float:
        """[m]."""
        return self.fitting.clearance

    def drawn(self) -> AbstractContextManager[ObjectBuilder]:
        """What draws mechanisms of the library in the frame of the side."""
        return drawn_on(self.workshop, self.clearance, self.fitting.rest)

    def hollowed(self) -> None:
        """Cut the room behind the area, where there may be one."""
        if self.hollow:
            self.workshop.cut(BODY, room(self.area))

    def on_shaft(
        self,
        *solids: Manifold,
        shaft: float,
        limits: tuple[float, float] | None = None,
        material: str | None = None,
    ) -> None:
        """Add what turns clockwise about the normal through the middle, on a shaft in a bore of the body."""
        x, _, z = self.middle
        # Behind a side that may be hollow, only its wall is sure to be there.
        deep, out = (min(0.02, self.area.wall) if self.hollow else 0.8 * self.area.depth), self.clearance + 1e-3
        self.workshop.cut(BODY, bore(shaft, self.clearance, (x, deep, z), (x, -0.01, z)))
        end = deep - max(self.clearance, 1e-3)
        self.workshop.body(self.name, cylinder(shaft, (x, end, z), (x, -out, z)), *solids, material=material)
        self.workshop.turns(self.name, BODY, (0, 1, 0), self.middle, limits, rest=self.fitting.rest)
