"""Declared surfaces on a path on which convex pieces collide.

Pieces close what is narrower than their tolerance: a lever in a slit of a millimetre of play is stopped by pieces that
represent no surface at all, and as deep as the wall is thick.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.scene import relative

if TYPE_CHECKING:
    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray


def surfaces_meet(scene: Scene, links: tuple[str, str], leaders: FloatArray, *, tolerance: float) -> bool:
    """True if two links get into each other by their declared surfaces as well, beyond what they are at rest.

    Args:
        scene: The model as it is in the file; what is measured of a body is kept in it.
        links: Their names; what fixed joints hold to them counts as well.
        leaders: The way, rest first, rows of leaders in the order of `Mechanism.travels`, shape (n, leaders).
        tolerance: Depth that does not count [m].

    Returns:
        True also where one of them has no surface to ask.
    """
    two = replace(scene, bodies=tuple(body for body in scene.bodies if set(links) & set(body.links)))
    if len(two.bodies) != 2:
        return True
    overlap, pair = OverlapQueries(two), (0, 1)
    T = relative(two.poses(leaders), pair)
    depth = overlap.depth(pair, T)
    if float(np.max(depth - depth[0])) > tolerance:
        return True
    hit = overlap.collide(pair, T)
    through = overlap.passed(pair, T, hit, grace=2.0 * scene.settings.tolerance * two.size)
    return float(through.max()) > tolerance
