"""Lengths as people read them."""

from __future__ import annotations

_METRES_FROM = 1.0


def length_text(length: float) -> str:
    """Return a length [m] with three digits and its unit: millimetres below a metre, then metres, then kilometres."""
    size = abs(length)
    if size >= 1000.0:
        return f"{length / 1000.0:.3g} km"
    return f"{length:.3g} m" if size >= _METRES_FROM else f"{1000.0 * length:.3g} mm"


def range_text(lower: float, upper: float) -> str:
    """Return a range of a slide [m] in one unit, whole millimetres below a metre: `0 to 420 mm`, `-0.5 to 1.2 m`."""
    if max(abs(lower), abs(upper)) >= _METRES_FROM:
        return f"{lower:z.3g} to {upper:z.3g} m"
    return f"{1000.0 * lower:z.0f} to {1000.0 * upper:z.0f} mm"
