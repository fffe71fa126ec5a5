"""Castors: a fork on a stem that turns, and a wheel in the fork."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.solids import bore, box, cylinder, off, union

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.robot.arrays import FloatArray

STEM = 0.006
"""Radius of a castor's stem [m]; it reaches 22 mm above the fork."""
_TREAD = 0.011  # half the width of a wheel [m]


def castor(axle: FloatArray, top: float, wheel: float, clearance: float) -> tuple[Manifold, Manifold]:
    """Return a fork whose stem stands on the z axis and whose pin carries a wheel, and that wheel.

    Args:
        axle: Middle of the pin [m], shape (3,); its y is how far the wheel trails.
        top: Upper face of the fork, where the stem begins [m]; above the wheel.
        wheel: Radius of the wheel [m].
        clearance: Between both [m].
    """
    tight = min(clearance, 0.0015)
    y, inner, outer = axle[1], _TREAD + tight, _TREAD + 0.006
    crown = box((-outer, y - 0.012, 2.0 * wheel + 0.004), (outer, 0.012, top))
    cheeks = [box((x, y - 0.01, wheel - 0.01), (x + outer - inner, y + 0.01, top)) for x in (-outer, inner)]
    ends = off(axle, 1e-3 - outer, 0, 0), off(axle, outer - 1e-3, 0, 0)
    stem = cylinder(STEM, (0, 0, top - 0.005), (0, 0, top + 0.022))
    tyre = cylinder(wheel, off(axle, -_TREAD, 0, 0), off(axle, _TREAD, 0, 0))
    roller = tyre - bore(0.004, tight, off(axle, -0.1, 0, 0), off(axle, 0.1, 0, 0))
    return union(crown, stem, cylinder(0.004, *ends), *cheeks), roller
