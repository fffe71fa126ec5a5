"""Lengths as people read them."""

from __future__ import annotations

_METRES_FROM, _WHOLE_FROM = 1.0, 0.01


def length_text(length: float) -> str:
    """Return a length [m] with three digits and its unit: millimetres below a metre, then metres, then kilometres."""
    size = abs(length)
    if size >= 1000.0:
        return f"{length / 1000.0:.3g} km"
    return f"{length:.3g} m" if size >= _METRES_FROM else f"{1000.0 * length:.3g} mm"


def range_text(lower: float, upper: float) -> str:
    """Return a range of a slide [m] in one unit, `0 to 420 mm`, `-0.5 to 1.2 m`; below 10 mm with two digits."""
    longest = max(abs(lower), abs(upper))
    if longest >= _METRES_FROM:
        return f"{lower:z.3g} to {upper:z.3g} m"
    form = "z.0f" if longest >= _WHOLE_FROM else "z.2g"
    return f"{1000.0 * lower:{form}} to {1000.0 * upper:{form}} mm"
