"""Judge a blueprint as it is drawn, in its own fields: what a language model can correct."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

from kinematify.config import load_config
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.procedural.clearance import DEEP, depth_of, moving_with, solid_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import linkages

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from manifold3d import Manifold

    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.robot.linkage import Linkage

_APART = 0.002  # [m] a fixed part may be so far from what carries it
_SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)  # of a joint's range
_TURN = 2.0 * math.pi  # of a joint without limits [rad]
_MOST = 10  # findings at once


def drawn_findings(blueprint: Blueprint) -> list[str]:
    """Return the faults of a blueprint as drawn, before its collision shapes are made; one line for each cause.

    Parts that overlap by more than 2 mm at zero or along the motion of one joint, fixed parts that touch nothing,
    closed chains that no joint can drive. Values of joints are counted from the zero of the blueprint.
    """
    solids = {part.name: solid_of(part) for part in blueprint.parts}
    chains = list(linkages(true_model(blueprint, load_config()).robot)) if blueprint.loops else []
    return [*_loose(blueprint, solids), *_overlaps(blueprint, solids, chains), *_stuck_chains(chains)][:_MOST]


def _stuck_chains(chains: Sequence[Linkage]) -> Iterable[str]:
    """Closed chains that no one joint can drive."""
    for chain in chains:
        if chain.driver is None:
            bars = ", ".join(name.removesuffix("_joint") for name in chain.joints)
            yield (
                f"The closed chain of {bars} has {chain.mobility} motions, but must have one: check the axes, the "
                "pivots and the number of its bars, and give a range to the joint that drives it alone."
            )


def _motions(blueprint: Blueprint, chains: Sequence[Linkage]) -> Iterator[tuple[str, dict[str, float]]]:
    """Each joint that leads, at values of its range; the bars of a closed chain go where its driver takes them."""
    chained = {name.removesuffix("_joint"): chain for chain in chains for name in chain.joints}
    for joint in blueprint.joints:
        if joint.kind is JointType.FIXED or joint.mimic is not None:
            continue
        rows = [{joint.child: _value(joint, share)} for share in _SHARES]
        if chain := chained.get(joint.child):
            names = [name.removesuffix("_joint") for name in chain.joints]
            curve = chain.curve if chain.driver == f"{joint.child}_joint" else chain.curve[:0]
            picked = (curve[round(share * (len(curve) - 1))] for share in _SHARES if len(curve))
            rows = [dict(zip(names, map(float, row), strict=True)) for row in picked]
        unit = "rad" if joint.kind.turns else "m"
        for values in rows:
            yield f'With the joint of "{joint.child}" at {joint.value + values[joint.child]:.3g} {unit}', values


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
    done = {frozenset(pair) for pair in _fixed_together(blueprint)}
    for where, values in (("Where they are drawn", dict[str, float]()), *_motions(blueprint, chains)):
        moving = {part for name in values for part in moving_with(name, blueprint.joints)} or set(solids)
        there = {part.name: solid_of(part) for part in blueprint.moved(values).parts}
        for one, other in combinations(sorted(solids), 2):
            pair = frozenset((one, other))
            # parts that one joint moves stay as they are to each other
            if pair in done or not pair & moving or (len(values) == 1 and pair <= moving):
                continue
            deep = depth_of(there[one], there[other])
            if deep > DEEP:
                done.add(pair)
                yield (
                    f'{where}, "{one}" and "{other}" are {_millimetres(deep)} deep in each other. Make room with '
                    '"subtract", move one of them ("xyz"), or correct "pivot", "axis", "lower" or "upper" of the joint.'
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


def _millimetres(metres: float) -> str:
    return f"{1000.0 * metres:.0f} mm"
