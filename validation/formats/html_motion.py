"""What moves, in a page: the object with a slider per joint."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from kinematify.validation.formats.html_frame import text

if TYPE_CHECKING:
    from collections.abc import Sequence

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
