"""Numbers and names in findings about geometry."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.geometry.scene import Scene
    from kinematify.robot.robot import Robot


UNSEEN = "Only the collision geometry does so; the visible surfaces stay clear."
BARELY = "Only the collision geometry does so that deep; the visible surfaces do not get so far into each other."
UNFELT = "What is visible does so; one of the two has no collision geometry, and no engine stops them."
SLIMMER = "Make the collision geometry of the two links follow the visible one more closely; the joint may be right."


def length(metres: float) -> str:
    """A length as people say it."""
    return f"{metres * 1e3:.3g} mm" if abs(metres) < 1.0 else f"{metres:.3g} m"


def joint_value(value: float, *, turns: bool) -> str:
    """The value of a joint as a file has it, with degrees beside radians."""
    return f"{value + 0.0:.4g} rad ({np.degrees(value) + 0.0:.3g} deg)" if turns else f"{value + 0.0:.4g} m"


def configuration(scene: Scene, values: Mapping[int, float]) -> dict[str, float]:
    """Rest with some leaders elsewhere, every joint by name [rad or m]."""
    row = scene.mechanism.rest.copy()
    for leader, value in values.items():
        row[leader] = value
    return dict(zip(scene.mechanism.joints, scene.mechanism.all_values(row[None])[0].tolist(), strict=True))


def in_document_order(model: Robot, first: str, second: str) -> tuple[str, str]:
    """Names of two links in the order of the document."""
    names = [link.name for link in model.links]
    return (first, second) if names.index(first) < names.index(second) else (second, first)
