"""The place of one mechanism on a side of a body."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from kinematify.generate.composer.bodies import BODY

if TYPE_CHECKING:
    from kinematify.generate.procedural.pieces.fronts import Bay, Fitting
    from kinematify.generate.procedural.workshop import Workshop


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
        """Middle of the area, on the surface [m]."""
        return 0.5 * (self.area.left + self.area.right), 0.0, 0.5 * (self.area.bottom + self.area.top)

    @property
    def radius(self) -> float:
        """Radius of the largest circle in the area [m]."""
        return 0.5 * min(self.area.width, self.area.height)

    @property
    def clearance(self) -> float:
        """[m]."""
        return self.fitting.clearance

    @property
    def named(self) -> dict[str, Any]:
        """Names for steps: what is said of the place, its middle `x`, `z`, and how `deep` holes may go [m]."""
        x, _, z = self.middle
        # Behind a side that may be hollow, only its wall is sure to be there.
        deep = min(0.02, self.area.wall) if self.hollow else 0.8 * self.area.depth
        workshop = self.workshop
        return {
            **{item.name: getattr(self, item.name) for item in fields(self)},
            "x": x, "z": z, "radius": self.radius, "clearance": self.clearance, "rest": self.fitting.rest, "deep": deep,
            "above_floor": workshop.above_floor, "as_handle": workshop.as_handle, "painted": workshop.painted,
        }  # fmt: skip
