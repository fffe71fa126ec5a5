"""What every signed distance field offers, whatever stands behind it (paper III-B, ``f_theta``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from torch import Tensor


class SignedDistanceField(Protocol):
    """Signed distance to one part in the world frame [m], negative inside, defined in the whole space.

    A field answers in float64 and is differentiable by torch with respect to the points.
    """

    def value(self, points: Tensor) -> Tensor:
        """Signed distance [m] at world points, shape (..., 3) -> (...)."""
        ...
