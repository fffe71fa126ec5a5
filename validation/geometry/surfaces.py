"""What the declared surfaces say of a way on which convex pieces collide.

Pieces close what is narrower than their tolerance: a lever in a slit of a millimetre of play is stopped by pieces that
stand for no surface at all, and as deep as the wall is thick.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import Overlap
from kinematify.geometry.scene import judged_shapes, read_scene, relative
from kinematify.robot.robot import rigid_groups

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.config.validation import GeometrySettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link, Robot, Shape


def surfaces_meet(
    model: Robot,
    links: tuple[str, str],
    leaders: FloatArray,
    *,
    tolerance: float,
    settings: GeometrySettings,
    shapes_of: Callable[[Link], tuple[Shape, ...]] = judged_shapes,
) -> bool:
    """Whether two links get into each other by their declared surfaces as well, beyond what they are at rest.

    Args:
        model: As it is in the file.
        links: Their names; what fixed joints hold to them counts as well.
        leaders: The way, rest first, rows of leaders in the order of `Mechanism.travels`, shape (n, leaders).
        tolerance: Depth that does not count [m].
        settings: Of the exact geometry; how points are drawn.
        shapes_of: Which surfaces; those that collide if absent.

    Returns:
        True also where one of them has no surface to ask.
    """
    kept = {name for group in rigid_groups(model) if set(links) & set(group.links) for name in group.links}
    others = {link.name: replace(link, visuals=(), collisions=()) for link in model.links if link.name not in kept}
    scene = read_scene(
        replace(model, links=tuple(others.get(link.name, link) for link in model.links)), settings, shapes_of
    )
    if len(scene.bodies) != 2:
        return True
    overlap, pair = Overlap(scene), (0, 1)
    T = relative(scene.poses(leaders), pair)
    hit = overlap.collide(pair, T)
    depth = overlap.depth(pair, T)
    through = overlap.passed(pair, T, hit, grace=2.0 * settings.tolerance * scene.size)
    return bool(max(float(np.max(depth - depth[0])), float(through.max())) > tolerance)
