"""Solids of parts, how deep they are in each other, and whether a joint may go farther than it was designed to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold, Mesh

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint

DEEP, _NOISE = 0.002, 1e-5  # [m] parts may be so deep in each other; of a depth from one pose to another
_STEP_TURN, _STEPS = math.radians(4.0), 12  # between poses that are looked at; of a slide, so many poses
_NEAR, _LOOSE = 0.02, 0.005  # of a slide's diagonal: so near is its guide, and so much farther it may be
_LEFT = 0.15  # of its range, that it has to spare


def solid_of(part: Part) -> Manifold:
    """The solid that a part's mesh encloses."""
    # Corners that two faces share stand twice in a mesh with sharp edges.
    mesh = Mesh(np.asarray(part.vertices, dtype=np.float32), np.asarray(part.faces, dtype=np.uint32))
    mesh.merge()
    return Manifold(mesh)


def depth_of(one: Manifold, other: Manifold) -> float:
    """Return how deep two solids are in each other: the least extent of what they share [m]."""
    shared = one ^ other
    if shared.is_empty():
        return 0.0
    return max(_least_extent(piece) for piece in shared.decompose())


def _least_extent(piece: Manifold) -> float:
    box = np.array(piece.bounding_box()).reshape(2, 3)
    area = piece.surface_area()
    # A thin shell about a pin has a large box: its thickness is its volume by half its surface.
    return min(float((box[1] - box[0]).min()), 2.0 * piece.volume() / area if area else 0.0)


def carried_by(name: str, joints: Sequence[BlueprintJoint]) -> set[str]:
    """Names of a part and of all that stands on it."""
    found = [name]
    for part in found:  # grows while it is walked
        found += [joint.child for joint in joints if joint.parent == part]
    return set(found)


def moving_with(name: str, joints: Sequence[BlueprintJoint]) -> set[str]:
    """Names of all parts that move with the joint above a part: what it carries, and what its followers carry."""
    leaders = [name, *(joint.child for joint in joints if joint.mimic is not None and joint.mimic.joint == name)]
    return {part for leader in leaders for part in carried_by(leader, joints)}


def may_go(blueprint: Blueprint, name: str, lower: float, upper: float) -> bool:
    """True if a joint with limits may have wider ones: nothing comes in the way, and a slide stays in its guide.

    Parts may be as deep in each other as they are within the present range, or by 2 mm. A slide stays guided if it is
    no farther from what does not move, even 15 % beyond the new end. A joint of a closed chain may not: the chain
    would come apart.

    Args:
        blueprint: The object.
        name: Child part of the joint.
        lower: Lower limit that is asked for [rad or m].
        upper: Upper limit that is asked for [rad or m].
    """
    joint = blueprint.joint_above[name]
    if blueprint.loops or joint.mimic is not None:
        return False
    moving = moving_with(name, blueprint.joints)
    still = {part.name: solid_of(part) for part in blueprint.parts if part.name not in moving}
    within = [joint.lower, 0.5 * (joint.lower + joint.upper), joint.upper]
    now = [_moving_solids(blueprint, name, value, moving) for value in within]
    pairs = [(one, other) for one in sorted(moving) for other in sorted(still)]
    allowed = {pair: max(DEEP, *(_pair_depth(solids, still, pair) for solids in now)) for pair in pairs}
    for value in _beyond(joint, lower, upper):
        there = _moving_solids(blueprint, name, value, moving)
        if any(_pair_depth(there, still, pair) > deep + _NOISE for pair, deep in allowed.items()):
            return False
    if joint.kind.turns:
        return True
    guides = list(still.values())
    size = float(np.linalg.norm(np.ptp(next(part for part in blueprint.parts if part.name == name).bounds, axis=0)))
    gap = max(_gap(solids[name], guides, _NEAR * size) for solids in now)
    spare = _LEFT * (upper - lower)
    ends = (lower - spare if lower < joint.lower else lower, upper + spare if upper > joint.upper else upper)
    farther = [_moving_solids(blueprint, name, value, {name})[name] for value in ends]
    is_guided = gap < _NEAR * size
    return is_guided and all(_gap(solid, guides, _NEAR * size) <= gap + _LOOSE * size for solid in farther)


def _beyond(joint: BlueprintJoint, lower: float, upper: float) -> Iterator[float]:
    """Values outside the present range, as far as the new limits [rad or m]."""
    for limit, end in ((joint.lower, min(lower, joint.lower)), (joint.upper, max(upper, joint.upper))):
        steps = math.ceil(abs(end - limit) / _STEP_TURN) if joint.kind.turns else _STEPS
        yield from np.linspace(limit, end, steps + 1)[1:] if end != limit else ()


def _moving_solids(blueprint: Blueprint, name: str, value: float, moving: Collection[str]) -> dict[str, Manifold]:
    parts = blueprint.moved({name: value}).parts
    return {part.name: solid_of(part) for part in parts if part.name in moving}


def _pair_depth(moving: Mapping[str, Manifold], still: Mapping[str, Manifold], pair: tuple[str, str]) -> float:
    one, other = moving[pair[0]], still[pair[1]]
    boxes = np.array([one.bounding_box(), other.bounding_box()]).reshape(2, 2, 3)
    apart = bool((boxes[0, 0] > boxes[1, 1]).any() or (boxes[1, 0] > boxes[0, 1]).any())
    return 0.0 if apart else depth_of(one, other)


def _gap(solid: Manifold, others: Collection[Manifold], most: float) -> float:
    return min((float(solid.min_gap(other, most)) for other in others), default=most)
