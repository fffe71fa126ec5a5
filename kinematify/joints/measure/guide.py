"""Guides of slides: how far a part can travel before it leaves what it runs in or on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kinematify.config import JointsConfig
    from kinematify.joints.measure.scene import JointScene
    from kinematify.robot.arrays import FloatArray


def guided_travel(scene: JointScene, direction: FloatArray, config: JointsConfig) -> float | None:
    """How far the child slides along `direction` before its guide lets it go [m]; None where no guide is seen.

    The guide is the surface of the contact that runs along the way. A carriage keeps all of its own surface on a long
    rail, a rod fills a short collar all the time, and both may go until that ends; of a telescope each half leaves the
    other from the start, and some of it has to stay in.

    Args:
        scene: The pair.
        direction: Unit direction of travel, shape (3,).
        config: `guide`, and `limits.drawer` as the share of the way out that a telescope goes.
    """
    travels = np.linspace(0.0, scene.diagonal, config.guide.steps + 1)
    shares = guided_share(scene, direction, travels, config)
    if shares is None or shares[0] < config.guide.kept:
        return None
    leaves = _first_below(travels, shares, config.guide.kept)
    gone = _first_below(travels, shares, config.guide.gone)
    return max(leaves, config.limits.drawer * gone)


def guided_share(
    scene: JointScene, direction: FloatArray, travels: FloatArray, config: JointsConfig
) -> FloatArray | None:
    """Share of the guide that still lies on the other part after each travel.

    Args:
        scene: The pair.
        direction: Unit direction, shape (3,).
        travels: [m], shape (n,).
        config: `guide` and the band of a contact.

    Returns:
        The larger of the shares of both parts in [0, 1], shape (n,); None where the contact is not such.
    """
    edge = scene.cache.graph.by_pair.get((min(scene.parent, scene.child), max(scene.parent, scene.child)))
    if edge is None:
        return None
    # Of small parts, the band of a contact is as wide as they are long.
    reach = edge.gap + min(config.contact_band * scene.diagonal, config.guide.band * scene.frame.diagonal)
    contact = scene.contact
    sides = (
        (scene.parent, contact.points, contact.normals, direction),
        (scene.child, contact.parent_points, contact.parent_normals, -direction),
    )
    shares = []
    for other, points, normals, motion in sides:
        along = points[np.abs(normals @ direction) < np.sin(np.radians(config.guide.along_deg))]
        guiding = along[scene.cache.distances(other, along) <= reach] if len(along) else along
        if len(guiding) < config.guide.least_samples:
            return None
        thinned = guiding[:: max(1, len(guiding) // config.guide.samples)]
        moved = (thinned[None] + travels[:, None, None] * motion).reshape(-1, 3)
        shares.append((scene.cache.distances(other, moved) <= reach).reshape(len(travels), -1).mean(axis=1))
    return np.asarray(np.maximum(*shares))


def _first_below(travels: FloatArray, shares: FloatArray, level: float) -> float:
    """Travel at which the share falls below a level, between the steps by proportion; the last one if never."""
    below = np.flatnonzero(shares < level)
    if len(below) == 0:
        return float(travels[-1])
    k = int(below[0])
    part = (shares[k - 1] - level) / max(shares[k - 1] - shares[k], 1e-12)
    return float(travels[k - 1] + part * (travels[k] - travels[k - 1]))
