"""Judge a blueprint as it is drawn, in its own fields: what a language model can correct."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.clearance import DEEP, depth_of, moving_with, solid_of
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from manifold3d import Manifold

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint

_APART = 0.002  # [m] a fixed part may be so far from what carries it
_TORN = 0.002  # [m] a pin may come apart so far
_SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)  # of a joint's range
_TURN = 2.0 * math.pi  # of a joint without limits [rad]
_MOST = 10  # findings at once


def drawn_findings(blueprint: Blueprint) -> list[str]:
    """Return the faults of a blueprint as drawn, before its collision shapes are made; one line for each cause.

    Parts that overlap by more than 2 mm at zero or along the motion of one joint, fixed parts that touch nothing,
    loops that come apart.
    """
    solids = {part.name: solid_of(part) for part in blueprint.parts}
    return [*_loose(blueprint, solids), *_overlaps(blueprint, solids), *_torn_loops(blueprint)][:_MOST]


def _loose(blueprint: Blueprint, solids: Mapping[str, Manifold]) -> Iterable[str]:
    for joint in blueprint.joints:
        one, other = solids[joint.parent], solids[joint.child]
        if joint.kind is not JointType.FIXED or one.is_empty() or other.is_empty():
            continue
        gap = one.min_gap(other, 1.0)
        if gap > _APART:
            yield (
                f'The fixed part "{joint.child}" is {_millimetres(gap)} away from its parent "{joint.parent}". Move '
                'its shapes ("xyz") until they touch it.'
            )


def _overlaps(blueprint: Blueprint, solids: Mapping[str, Manifold]) -> Iterable[str]:
    reported = {(min(pair), max(pair)) for pair in _fixed_together(blueprint)}
    for one, other in combinations(sorted(solids), 2):
        deep = 0.0 if (one, other) in reported else depth_of(solids[one], solids[other])
        if deep > DEEP:
            reported.add((one, other))
            yield (
                f'The parts "{one}" and "{other}" are {_millimetres(deep)} deep in each other where they are drawn. '
                'Make room with "subtract", or move one of them ("xyz").'
            )
    for joint in blueprint.joints:
        if joint.kind is JointType.FIXED or joint.mimic is not None:
            continue
        for share in _SHARES:
            moving = moving_with(joint.child, blueprint.joints)
            values = {joint.child: _value(joint, share)}
            moved = blueprint.moved(values)
            where = {part.name: solid_of(part) for part in moved.parts if part.name in moving}
            for name, solid in where.items():
                for other in set(solids) - moving:
                    pair = (min(name, other), max(name, other))
                    if pair in reported:
                        continue
                    deep = depth_of(solid, solids[other])
                    if deep > DEEP:
                        reported.add(pair)
                        value = values[joint.child]
                        at = f"{value:.2g} {'rad' if joint.kind.turns else 'm'}"
                        yield (
                            f'When the joint of "{joint.child}" is at {at}, "{name}" is {_millimetres(deep)} deep in '
                            f'"{other}". Make room with "subtract", move its "pivot", negate its "axis", or end its '
                            'range ("lower", "upper") before.'
                        )


def _fixed_together(blueprint: Blueprint) -> Iterable[tuple[str, str]]:
    """Pairs of parts that do not move past each other: they may overlap."""
    group = {part.name: part.name for part in blueprint.parts}
    for joint in blueprint.joints:
        if joint.kind is JointType.FIXED:
            group[joint.child] = group[joint.parent]
    return ((one, other) for one, other in combinations(group, 2) if group[one] == group[other])


def _value(joint: BlueprintJoint, share: float) -> float:
    lower = joint.lower if math.isfinite(joint.lower) else 0.0
    upper = joint.upper if math.isfinite(joint.upper) else _TURN
    return lower + share * (upper - lower)


def _torn_loops(blueprint: Blueprint) -> Iterable[str]:
    for loop in blueprint.loops:
        home = {part.name: part for part in blueprint.parts}
        worst = 0.0
        for leader in (
            joint for joint in blueprint.joints if joint.mimic is None and joint.kind is not JointType.FIXED
        ):
            for share in _SHARES:
                moved = blueprint.moved({leader.child: _value(leader, share)})
                there = {part.name: part for part in moved.parts}
                pins = [_carried_point(home[name], there[name], loop.pivot) for name in (loop.one, loop.other)]
                worst = max(worst, float(np.linalg.norm(pins[0] - pins[1])))
        if worst > _TORN:
            yield (
                f'The loop of "{loop.one}" and "{loop.other}" comes apart by {_millimetres(worst)} in motion. '
                'Check "mimic" (leader, multiplier) and the pivots of its bars; a pin that slides needs a slider.'
            )


def _carried_point(home: Part, there: Part, point: np.ndarray) -> np.ndarray:
    """A point that moves with a part, from its home pose to another."""
    before, after = home.vertices - home.vertices.mean(axis=0), there.vertices - there.vertices.mean(axis=0)
    u, _, vt = np.linalg.svd(before.T @ after)
    turn = (u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt).T
    moved: np.ndarray = turn @ (point - home.vertices.mean(axis=0)) + there.vertices.mean(axis=0)
    return moved


def _millimetres(metres: float) -> str:
    return f"{1000.0 * metres:.0f} mm"
