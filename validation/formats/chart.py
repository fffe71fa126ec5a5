"""Line charts as SVG that follow the page's colours, print, and can be read without scripts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.validation.formats.html_frame import text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    Point = tuple[float, float]

_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 8, 8, 26
_DOT = 2.6


@dataclass(frozen=True, kw_only=True)
class Series:
    """One line."""

    label: str
    points: tuple[Point, ...]
    style: str = "first"
    """``first``, ``second`` which is dashed too, or ``third`` which is dotted, so that colour is not needed."""
    links: tuple[tuple[str, str], ...] = ()
    """Title and address of each point, where points are marked."""


@dataclass(frozen=True, kw_only=True)
class Axes:
    """Labels of the axes of a chart."""

    x: str
    y: str
    ticks: tuple[tuple[float, str], ...] = ()
    """Places and words on the horizontal axis; its ends in numbers if there are none."""
    band: tuple[float, float] | None = None
    """Range of x that is shaded."""
    limits: tuple[float, ...] = ()
    """Values of x that are marked by a dotted line."""


def line_chart(
    title: str, series: Sequence[Series], axes: Axes, *, width: int = 300, height: int = 150, legend: bool = True
) -> str:
    """Return a figure with its title and legend; empty if there is no point at all.

    Args:
        title: Of the figure.
        series: Lines over the same axes.
        axes: Their words.
        width: Of the drawing [px].
        height: Of the drawing [px].
        legend: Whether the lines are distinguished.
    """
    points = [point for line in series for point in line.points]
    if not points:
        return ""
    inside = [*axes.limits, *(axes.band or ())]
    x, low_x, high_x = _scale([p[0] for p in points] + inside, _LEFT, width - _RIGHT)
    y, low_y, high_y = _scale([p[1] for p in points] + [0.0], height - _BOTTOM, _TOP)
    ends = axes.ticks or ((low_x, f"{low_x:.3g}"), (high_x, f"{high_x:.3g}"))
    shapes = [
        _band(axes.band, x, height) if axes.band else "",
        f'<path class="axis" d="M{_LEFT} {_TOP}V{height - _BOTTOM}H{width - _RIGHT}"/>',
        *(f'<path class="limit" d="M{x(v):.1f} {_TOP}V{height - _BOTTOM}"/>' for v in axes.limits),
        *(_label(x(v), height - _BOTTOM + 11, words, _anchor(x(v), width)) for v, words in ends),
        *(_label(_LEFT - 4, y(v) + 4, f"{v:.3g}", "end") for v in dict.fromkeys((low_y, high_y))),
        _label((_LEFT + width) / 2, height - 3, axes.x, "middle"),
        *(_line(line, x, y) for line in series),
    ]
    names = f" ({', '.join(f'{line.label} {_dash(line)}' for line in series)})" if legend and len(series) > 1 else ""
    spans = "; ".join(
        f"{s.label}: {min(p[1] for p in s.points):.3g} to {max(p[1] for p in s.points):.3g}" for s in series
    )
    return (
        f"<figure><figcaption>{text(title)} {text(axes.y)}{text(names)}</figcaption>"
        f'<svg width="{width}" height="{height}" viewBox="0 0 {width} {height}" role="group" '
        f'aria-label="{text(f"{title}, {axes.y}: {spans}")}">{"".join(shapes)}</svg></figure>'
    )


def sparkline(values: Sequence[Point], *, width: int = 90, height: int = 22) -> str:
    """Return a small line without axes; the numbers are beside it."""
    if not values:
        return ""
    x, _, _ = _scale([p[0] for p in values], 3, width - 3)
    y, _, _ = _scale([p[1] for p in values], height - 3, 3)
    last = values[-1]
    path = "L".join(f"{x(a):.1f} {y(b):.1f}" for a, b in values)
    return (
        f'<svg width="{width}" height="{height}" viewBox="0 0 {width} {height}" aria-hidden="true">'
        f'<path class="first" d="M{path}"/><circle class="dot" r="{_DOT}" cx="{x(last[0]):.1f}" cy="{y(last[1]):.1f}"/>'
        "</svg>"
    )


def _scale(values: Sequence[float], start: float, end: float) -> tuple[Callable[[float], float], float, float]:
    low, high = min(values), max(values)
    way = high - low
    if way <= 0.0:
        return (lambda value: 0.5 * (start + end)), low, high
    return (lambda value: start + (end - start) * (value - low) / way), low, high


def _line(line: Series, x: Callable[[float], float], y: Callable[[float], float]) -> str:
    places = [(x(a), y(b)) for a, b in line.points]
    path = "L".join(f"{a:.1f} {b:.1f}" for a, b in places)
    dots = "".join(
        f'<a href="{text(href)}"><circle class="dot" r="{_DOT}" cx="{a:.1f}" cy="{b:.1f}"><title>{text(title)}</title>'
        "</circle></a>"
        for (a, b), (title, href) in zip(places, line.links, strict=False)
    )
    return f'<path class="{line.style}" d="M{path}"/>{dots}'


def _band(band: tuple[float, float], x: Callable[[float], float], height: int) -> str:
    left, right = x(band[0]), x(band[1])
    return (
        f'<rect class="band" x="{left:.1f}" y="{_TOP}" width="{right - left:.1f}" height="{height - _BOTTOM - _TOP}"/>'
    )


def _label(x: float, y: float, words: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{text(words)}</text>'


def _anchor(x: float, width: int) -> str:
    """Words at the right end grow to the left, so that none is cut off."""
    return "end" if x > width - 2 * _RIGHT else "start" if x < _LEFT + _RIGHT else "middle"


def _dash(line: Series) -> str:
    return {"second": "- -", "third": ". ."}.get(line.style, "\N{EM DASH}")
