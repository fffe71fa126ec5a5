"""What moves, in a page: the object with a slider per joint, and how each engine drove the joints."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from kinematify.simulation.engines import ENGINES
from kinematify.validation.formats.chart import Axes, Series, line_chart
from kinematify.validation.formats.html_frame import text
from kinematify.validation.formats.report_content import TURNING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kinematify.validation.run.report import ValidationReport
    from kinematify.validation.summary import JointCurve, JointSummary

_LINES = {"first": "solid line", "second": "dashed line", "third": "dotted line"}
_STYLES = dict(zip((name for name, engine in ENGINES.items() if engine.runs and engine.prepared), _LINES, strict=False))
_WIDTH = 275
"""Of a chart [px]: four stand side by side."""
_STEPS = 200
"""Positions of a slider."""


def viewer(index: int, scene: str) -> str:
    """Return the interactive view of a model; empty without a scene.

    Args:
        index: Of the model in the page.
        scene: JSON from `view_data`.
    """
    if not scene:
        return ""
    joints = [joint for joint in json.loads(scene)["joints"] if joint["mimic"] is None]
    data = scene.replace("<", "\\u003c")  # a name must not be able to end the script
    canvas = f'<canvas tabindex="0" role="img" aria-label="{_CANVAS}"></canvas>'
    reset = '<button type="button" class="plain" data-reset>Reset</button>'
    sliders = f'<div class="sliders"><p class="status faint">{_HELP}</p>{reset}{"".join(map(_slider, joints))}</div>'
    return (
        f'<script type="application/json" id="{scene_name(index)}">{data}</script><h3>The model, to turn and move</h3>'
        "<noscript><p>This view needs scripts; nothing else in the page does.</p></noscript>"
        f'<div class="viewer" data-scene="{scene_name(index)}">{canvas}{sliders}</div>'
    )


_CANVAS = "The model in three dimensions. Arrow keys turn it, plus and minus zoom, 0 resets."
_HELP = "Drag turns, shift and drag shifts, the wheel zooms; arrow keys, + and - do too."


def scene_name(index: int) -> str:
    """Id of the scene of a model in the page."""
    return f"scene-{index}"


def _slider(joint: dict[str, Any]) -> str:
    lower, upper = float(joint["lower"]), float(joint["upper"])
    step = (upper - lower) / _STEPS or 1.0
    name = text(str(joint["name"]))
    ends = f'min="{lower!r}" max="{upper!r}" step="{step!r}" value="{float(joint["rest"])!r}"'
    return (
        f'<div class="joint"><label>{name} <output></output><input type="range" data-joint="{name}" {ends}></label>'
        f'<button type="button" class="plain" data-play="{name}" aria-pressed="false" aria-label="Sweep {name}">'
        "Sweep</button></div>"
    )


def show_button(index: int, q: dict[str, float], links: Sequence[str], words: str, joint: str | None = None) -> str:
    """Return a button that brings the viewer of a model into a configuration and marks links, or what a joint moves."""
    shown = text(json.dumps({"q": q, "links": list(links), "joint": joint}))
    attributes = f'data-show="{shown}" data-scene="{scene_name(index)}"'
    return f'<button type="button" class="plain" {attributes}>{text(words)}</button>'


def curves(report: ValidationReport) -> str:
    """Return four charts per joint with the engines over each other; empty if none was driven."""
    if not report.curves:
        return ""
    engines = dict.fromkeys(curve.engine for curve in report.curves)
    lines = ", ".join(f"{ENGINES[engine].title}: {_LINES[_STYLES[engine]]}" for engine in engines)
    names = dict.fromkeys(curve.joint for curve in report.curves)
    known = {joint.joint: joint for joint in report.joints}
    charts = "".join(
        _joint_charts(name, [c for c in report.curves if c.joint == name], known.get(name)) for name in names
    )
    return (
        "<h3>How the engines drove the joints</h3>"
        f'<p class="faint">From rest to both ends by a servo, all other joints held. {lines}. Shaded: free travel by '
        f"exact geometry; dotted: declared limits.</p>{charts}"
    )


def _joint_charts(name: str, driven: Sequence[JointCurve], joint: JointSummary | None) -> str:
    turning = joint is None or joint.kind in TURNING
    scale, unit = (180.0 / math.pi, "deg") if turning else (1000.0, "mm")
    measures: tuple[tuple[str, str, Callable[[JointCurve], Sequence[float]]], ...] = (
        ("reached", unit, lambda c: [scale * value for value in c.reached]),
        ("behind the command", unit, lambda c: [scale * (a - b) for a, b in zip(c.commanded, c.reached, strict=True)]),
        ("torque" if turning else "force", "N m" if turning else "N", lambda c: c.force),
        ("deeper than allowed", "mm", lambda c: [1000.0 * value for value in c.depth]),
    )
    charts = "".join(
        line_chart(title, _series(driven, scale, pick), _axes(joint, scale, unit, words), width=_WIDTH, legend=False)
        for title, words, pick in measures
    )
    return f'<h4>{text(name)}</h4><div class="charts">{charts}</div>'


def _series(driven: Sequence[JointCurve], scale: float, pick: Callable[[JointCurve], Sequence[float]]) -> list[Series]:
    """One line per engine: the way to the lower end from behind, then the one to the upper end."""
    found = []
    for engine in dict.fromkeys(curve.engine for curve in driven):
        points: list[tuple[float, float]] = []
        for curve in sorted((c for c in driven if c.engine == engine), key=lambda c: c.upper):
            way = [(scale * x, y) for x, y in zip(curve.commanded, pick(curve), strict=True) if math.isfinite(y)]
            points += way if curve.upper else way[::-1]
        if points:
            found.append(Series(label=ENGINES[engine].title, points=tuple(points), style=_STYLES[engine]))
    return found


def _axes(joint: JointSummary | None, scale: float, unit: str, y: str) -> Axes:
    x = f"commanded [{unit}]"
    if joint is None:
        return Axes(x=x, y=f"[{y}]")
    free = joint.free_travel
    limits = tuple(scale * value for value in joint.declared_limits or () if math.isfinite(value))
    band = None if free is None else (scale * free[0], scale * free[1])
    return Axes(x=x, y=f"[{y}]", band=band, limits=limits)
