"""Judge a blueprint as it is drawn, in its own fields: what a language model can correct."""

from __future__ import annotations

import math
from itertools import combinations, product
from typing import TYPE_CHECKING

from kinematify.config import load_config
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.procedural.clearance import DEEP, depth_of, moving_with, solid_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import linkages, loop_gaps

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.robot.linkage import Linkage
    from kinematify.robot.robot import Robot

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
    robot = true_model(blueprint, load_config()).robot if blueprint.loops else None
    chains = [] if robot is None else list(linkages(robot))
    stuck = [] if robot is None else list(_stuck_chains(robot, chains))
    torn = () if robot is None or chains else _torn_loops(blueprint, robot)
    return [*_loose(blueprint, solids), *_overlaps(blueprint, solids, chains), *stuck, *torn][:_MOST]


def _stuck_chains(robot: Robot, chains: Sequence[Linkage]) -> Iterable[str]:
    """Chains whose pins do not meet where they are drawn, or that no one joint can drive."""
    gaps = loop_gaps(robot, {})
    for loop in robot.loops:
        if gaps[loop.name] > _TORN:
            one, other = loop.links
            yield f'The pin of "{one}" and "{other}" is {_millimetres(gaps[loop.name])} apart: move it.'
    for chain in chains:
        if chain.driver is None:
            bars = ", ".join(name.removesuffix("_joint") for name in chain.joints)
            yield (
                f"The closed chain of {bars} has {chain.mobility} motions, but must have one: check the axes, the "
                "pivots and the number of its bars, and give a range to the joint that drives it alone."
            )


def _motions(blueprint: Blueprint, chains: Sequence[Linkage]) -> Iterator[tuple[BlueprintJoint, dict[str, float]]]:
    """Each joint that leads, at values of its range; the bars of a closed chain go where its driver takes them."""
    chained = {name.removesuffix("_joint"): chain for chain in chains for name in chain.joints}
    for joint in blueprint.joints:
        chain = chained.get(joint.child)
        if joint.kind is JointType.FIXED or joint.mimic is not None:
            continue
        if chain is None:
            yield from ((joint, {joint.child: _value(joint, share)}) for share in _SHARES)
        elif chain.driver == f"{joint.child}_joint":
            names = [name.removesuffix("_joint") for name in chain.joints]
            rows = [chain.curve[round(share * (len(chain.curve) - 1))] for share in _SHARES]
            yield from ((joint, dict(zip(names, map(float, row), strict=True))) for row in rows)


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


def _overlaps(blueprint: Blueprint, solids: Mapping[str, Manifold], chains: Sequence[Linkage]) -> Iterable[str]:
    reported = {(min(pair), max(pair)) for pair in _fixed_together(blueprint)}
    for one, other in combinations(sorted(solids), 2):
        deep = 0.0 if (one, other) in reported else depth_of(solids[one], solids[other])
        if deep > DEEP:
            reported.add((one, other))
            yield (
                f'The parts "{one}" and "{other}" are {_millimetres(deep)} deep in each other where they are drawn. '
                'Make room with "subtract", or move one of them ("xyz").'
            )
    for joint, values in _motions(blueprint, chains):
        moving = {part for name in values for part in moving_with(name, blueprint.joints)}
        moved = blueprint.moved(values)
        where = {part.name: solid_of(part) for part in moved.parts}
        for name, other in product(moving, solids):
            pair = (min(name, other), max(name, other))
            if name == other or pair in reported or (other in moving and len(values) == 1):
                continue
            deep = depth_of(where[name], where[other])
            if deep > DEEP:
                reported.add(pair)
                at = f"{values[joint.child]:.2g} {'rad' if joint.kind.turns else 'm'}"
                yield (
                    f'When the joint of "{joint.child}" is at {at}, "{name}" is {_millimetres(deep)} deep in "{other}".'
                    ' Make room with "subtract", move its "pivot", negate its "axis", or end its range ("lower", '
                    '"upper") before.'
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


def _torn_loops(blueprint: Blueprint, robot: Robot) -> Iterable[str]:
    """Loops whose bars all follow, but not to where their pins are."""
    worst = dict.fromkeys((loop.name for loop in robot.loops), 0.0)
    for _, values in _motions(blueprint, ()):
        gaps = loop_gaps(robot, {f"{name}_joint": value for name, value in values.items()})
        worst = {name: max(gap, gaps[name]) for name, gap in worst.items()}
    for loop in robot.loops:
        if worst[loop.name] > _TORN:
            yield (
                f'The loop of "{loop.links[0]}" and "{loop.links[1]}" comes apart by '
                f'{_millimetres(worst[loop.name])} in motion. Check "mimic" (leader, multiplier) and the pivots of its '
                'bars, or leave "mimic" out of them.'
            )


def _millimetres(metres: float) -> str:
    return f"{1000.0 * metres:.0f} mm"
