"""What both engines tell of the object after a step; leading axes are environments, if there are several."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray


@dataclass(slots=True, eq=False)
class Reading:
    """State of the object, world frame."""

    values: FloatArray
    """Joints that lead [rad or m], shape (..., J)."""
    speeds: FloatArray
    """Their speeds [rad/s or m/s], shape (..., J)."""
    hold: FloatArray
    """Point at which the part is held [m], shape (..., 3)."""
    anchor: FloatArray
    """Origin of the joint that is opened [m], shape (..., 3)."""
    axis: FloatArray
    """Its axis, unit, shape (..., 3)."""
