"""Warnings of an inference, one sentence each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.pipeline.congruent_joints import carried
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.alike import AlikeParts
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from kinematify.joints.candidate import JointEstimate
    from kinematify.robot.arrays import FloatArray


def warnings_of(
    assembly: Assembly,
    graph: ContactGraph,
    bearings: Mapping[Pair, EdgeBearing],
    trees: Sequence[KinematicTree],
    joints: Sequence[JointEstimate],
    *,
    config: Config,
) -> tuple[str, ...]:
    """Everything to tell of an inference; what was already reported of the assembly comes first."""
    return (
        *assembly.warnings,
        *_doubtful_base(assembly, trees[0], config.topology.base_doubt),
        *floating_parts(assembly, graph, trees[0]),
        *_compound_joints(assembly, joints, graph),
        *_followed_twins(assembly, joints, bearings),
        *unlike_twins(assembly, graph, trees[0], joints),
        *missed_linkages(assembly, graph, bearings, joints, config),
    )


def missed_linkages(
    assembly: Assembly,
    graph: ContactGraph,
    bearings: Mapping[Pair, EdgeBearing],
    joints: Sequence[JointEstimate],
    config: Config,
) -> list[str]:
    """Warn of parts that only parallel links carry, turning on one body, where no pins close a linkage."""
    above = {joint.child: joint for joint in joints}
    said = []
    for part in above:
        touched = {edge.a + edge.b - part for edge in graph.edges if part in (edge.a, edge.b) and not edge.bridge}
        arms = [above[arm] for arm in sorted(touched) if arm in above and above[arm].kind.turns]
        pins = [
            arm
            for arm in arms
            if (found := bearings.get(pair(part, arm.child)))
            and found.lines
            and found.lines[0].score >= config.topology.pin_score
        ]
        if len(arms) < 2 or len(arms) < len(touched) or len(pins) > 1:
            continue
        if len({arm.parent for arm in arms}) == 1 and all(_parallel(arm, arms[0]) for arm in arms):
            names = [assembly.names[arm.child] for arm in arms]
            said.append(
                f"{assembly.names[part]} touches {' and '.join(names)}, which turn about parallel axes: it may be part "
                f"of a linkage that was not found. If it turns on them, give --hint {assembly.names[part]}:"
                f"parent={names[0]} --hint {assembly.names[part]}=revolute; a loop joint to the others needs pins."
            )
    return said


def _parallel(one: JointEstimate, other: JointEstimate | BearingLine) -> bool:
    """True if two lines have one direction, to 1 deg."""
    return bool(abs(float(one.axis @ other.axis)) > math.cos(math.radians(1.0)))


def _doubtful_base(assembly: Assembly, tree: KinematicTree, doubt: float) -> list[str]:
    """Warn where another part may be the base link."""
    names = assembly.names
    order = sorted(range(len(tree.standing)), key=lambda part: -tree.standing[part])
    rivals = [f"{names[part]} ({tree.standing[part]:.0%})" for part in order if tree.standing[part] >= doubt]
    if len(rivals) < 2:
        return []
    return [f"The base link is not certain: {' or '.join(rivals)}. {names[tree.root]} was chosen; --base chooses."]


def floating_parts(assembly: Assembly, graph: ContactGraph, tree: KinematicTree) -> list[str]:
    """Warn of tree edges between parts that do not touch."""
    warnings = []
    for parent, child in tree.edges():
        edge = graph.by_pair.get(pair(parent, child))
        if edge is None or edge.bridge:
            gap = "" if edge is None else f" ({edge.gap / assembly.diagonal:.2%} of the object's diagonal apart)"
            name, above = assembly.names[child], assembly.names[parent]
            touched = [item for item in graph.edges if child in (item.a, item.b) and not item.bridge]
            if touched:
                other = assembly.names[touched[0].a + touched[0].b - child]
                warnings.append(
                    f"The parent of {name} is {above}, which it does not touch{gap}. If its parent is what it touches, "
                    f"give --hint {name}:parent={other}."
                )
            else:
                warnings.append(f"{name} touches nothing; its parent is {above}, the nearest part{gap}.")
    return warnings


def _compound_joints(assembly: Assembly, joints: Sequence[JointEstimate], graph: ContactGraph) -> list[str]:
    """Tell of joints that are one mechanism together."""
    found = compounds(assembly, joints, graph.alike)
    return [described(compound, assembly.names) for compound in found]


def _followed_twins(
    assembly: Assembly, joints: Sequence[JointEstimate], bearings: Mapping[Pair, EdgeBearing]
) -> list[str]:
    """Tell which joints took their line from congruent ones."""
    said = []
    for joint in joints:
        bearing = bearings.get(pair(joint.parent, joint.child))
        if bearing is None or not bearing.follows or not _parallel(joint, bearing.lines[0]):
            continue
        models = [f"{assembly.names[one]} and {assembly.names[other]}" for one, other in bearing.follows]
        own = f"{assembly.names[joint.parent]} and {assembly.names[joint.child]}"
        said.append(f"{own} turn as their congruent twins do ({'; '.join(models)})")
    if not said:
        return []
    return [f"{'. '.join(said)}. Their own contact, which is rough, shows another line than that of all these parts."]


_SAME_END, _SAME_PLACE = 0.1, 0.02  # shares of the wider range and of the part's diagonal within which joints are alike


def unlike_twins(
    assembly: Assembly, graph: ContactGraph, tree: KinematicTree, joints: Sequence[JointEstimate]
) -> list[str]:
    """Warn of congruent parts with mirrored or repeated contacts whose joints differ, and name what they differ in."""
    joint_of, said = {joint.child: joint for joint in joints}, []
    for group in graph.alike.edges(tree):
        alike = [joint_of[child] for _, child in group]
        model = max(alike, key=lambda joint: joint.confidence)
        unlike: dict[str, list[str]] = {}
        for joint in alike:
            # What is the same as it stands needs no motion, which takes longer to find.
            if joint is not model and _difference(model, joint, math.inf):
                size = assembly.parts[joint.child].diagonal
                found = (_difference(item, joint, size) for item in carried(assembly, graph, model, joint))
                first = next(found, "")
                if first and all(found):
                    unlike.setdefault(first, []).append(assembly.names[joint.child])
        said += [
            f"{', '.join(names)} and {assembly.names[model.child]} are congruent and have the same contacts, but their "
            f"joints differ in {aspect}. If they move alike, give --hint {names[0]}:twin={assembly.names[model.child]}."
            for aspect, names in unlike.items()
        ]
    return said


def _difference(one: JointEstimate, other: JointEstimate, size: float) -> str:
    """In what two joints differ of which one was carried over to the place of the other; empty if in nothing."""
    if one.kind is not other.kind:
        return "type"
    cosine = float(one.axis @ other.axis)
    if one.kind is not JointType.FIXED and abs(cosine) < math.cos(math.radians(5.0)):
        return "the direction of their axes"
    if one.kind.turns and np.linalg.norm(np.cross(other.pivot - one.pivot, one.axis)) > _SAME_PLACE * size:
        return "the place of their axes"
    ends = (one.lower, one.upper) if cosine > 0.0 else (-one.upper, -one.lower)
    widest = _SAME_END * max(one.upper - one.lower, other.upper - other.lower)
    apart = max(abs(ends[0] - other.lower), abs(ends[1] - other.upper)) if math.isfinite(widest) else 0.0
    return "range" if apart > widest else ""


def cut_parts(assembly: Assembly, groups: Sequence[Sequence[int]], mains: Sequence[int]) -> list[str]:
    """Tell of parts that were cut into pieces."""
    warnings = []
    for main, group in zip(mains, groups, strict=True):
        others = [assembly.names[piece] for piece in group if piece != main]
        if others:
            warnings.append(
                f"{' and '.join(others)} and {assembly.names[main]} are one part that was cut apart: their open rims "
                "coincide, and the surface goes on. They are fixed to each other."
            )
    return warnings


_MEETING = 2.0e-3  # fits of bearings are within a thousandth of the diagonal
"""How near axes come to one point, fraction of the object's diagonal."""
_SPREAD = 0.5  # wrists and hips are square; axes within 30 deg of a plane are a bent arm
"""Volume that three unit axes span, at least: 1 for right angles, 0 in one plane."""
_SQUARE = 0.1  # 6 deg
"""Cosine up to which two axes count as square; also how near to opposite the axes of fingers are."""
_CROSS = 0.6  # a cross is smaller than the forks around it
"""Largest diagonal of the part between the axes of a universal joint, fraction of either neighbour's."""
_BESIDE = 0.1  # fingers face each other; drawers that open to both sides do so too, and rarely
"""How far fingers may be beside each other, fraction of their distance along the axis."""


class CompoundKind(StrEnum):
    """Kind of a group of joints."""

    BALL = "ball"
    UNIVERSAL = "universal"
    FINGERS = "fingers"


@dataclass(frozen=True, kw_only=True)
class Compound:
    """Several joints that are one mechanism."""

    kind: CompoundKind
    children: tuple[int, ...]
    """Indices of the parts that the joints move, from the base outward."""


def compounds(assembly: Assembly, joints: Sequence[JointEstimate], alike: AlikeParts) -> tuple[Compound, ...]:
    """Find joints that are one mechanism together, which a tree of single joints cannot say.

    A cross between two forks makes a universal joint, three axes through one point make a ball joint, two fingers that
    close on each other are driven as one (``<mimic>``), and a cap on a neck turns and comes off along the same line.

    Args:
        assembly: The parts, world frame.
        joints: The chosen joints of the tree.
        alike: Which parts are congruent.

    Returns:
        Ball joints first, then universal ones that are no piece of a ball joint, then pairs of fingers, then caps.
    """
    by_child = {joint.child: joint for joint in joints}
    near = _MEETING * assembly.diagonal
    balls = [
        Compound(kind=CompoundKind.BALL, children=tuple(joint.child for joint in chain))
        for chain in _chains(by_child, 3)
        if _one_point(chain, near) and abs(np.linalg.det([joint.axis for joint in chain])) > _SPREAD
    ]
    taken = {frozenset(pair) for ball in balls for pair in combinations(ball.children, 2)}
    universals = [
        Compound(kind=CompoundKind.UNIVERSAL, children=(first.child, second.child))
        for first, second in _chains(by_child, 2)
        if frozenset((first.child, second.child)) not in taken
        and abs(float(first.axis @ second.axis)) < _SQUARE
        and _one_point((first, second), near)
        and _is_cross(assembly, first, second)
    ]
    return (*balls, *universals, *_fingers(assembly, joints, alike))


def described(compound: Compound, names: Sequence[str]) -> str:
    """A sentence for the user; `names` are those of the parts."""
    parts = [names[child] for child in compound.children]
    if compound.kind is CompoundKind.BALL:
        return f"The joints of {parts[0]}, {parts[1]} and {parts[2]} turn about one point: together a ball joint."
    if compound.kind is CompoundKind.UNIVERSAL:
        return (
            f"The joints of {parts[0]} and {parts[1]} cross at a right angle in {parts[0]}: together a universal joint."
        )
    return (
        f"{parts[0]} and {parts[1]} mirror each other as fingers do. Where one drive moves both, let one joint follow "
        "the other (<mimic>)."
    )


def _chains(by_child: Mapping[int, JointEstimate], length: int) -> Iterator[tuple[JointEstimate, ...]]:
    """All runs of so many turning joints, each hanging on the one before."""
    for joint in by_child.values():
        chain = [joint]
        while len(chain) < length and chain[0].parent in by_child:
            chain.insert(0, by_child[chain[0].parent])
        if len(chain) == length and all(item.kind.turns for item in chain):
            yield tuple(chain)


def _one_point(chain: Sequence[JointEstimate], near: float) -> bool:
    """True if all axes pass within `near` [m] of the point that is nearest to them all."""
    across = [np.eye(3) - np.outer(joint.axis, joint.axis) for joint in chain]
    offsets = [matrix @ joint.pivot for matrix, joint in zip(across, chain, strict=True)]
    point = np.linalg.lstsq(np.sum(across, axis=0), np.sum(offsets, axis=0), rcond=None)[0]
    gaps = [matrix @ point - offset for matrix, offset in zip(across, offsets, strict=True)]
    return bool(np.all(np.linalg.norm(gaps, axis=1) < near))


def _is_cross(assembly: Assembly, first: JointEstimate, second: JointEstimate) -> bool:
    """True if the part between two joints is small beside those that it joins."""
    middle, ends = assembly.parts[first.child], (assembly.parts[first.parent], assembly.parts[second.child])
    return all(middle.diagonal < _CROSS * end.diagonal for end in ends)


def _fingers(assembly: Assembly, joints: Sequence[JointEstimate], alike: AlikeParts) -> Iterator[Compound]:
    """Congruent parts that carry nothing and slide towards each other on one body."""
    bearing = {joint.parent for joint in joints}
    leaves = [joint for joint in joints if joint.kind is JointType.PRISMATIC and joint.child not in bearing]
    for one, other in combinations(leaves, 2):
        twins = one.parent == other.parent and alike.kind[one.child] == alike.kind[other.child]
        if twins and float(one.axis @ other.axis) < -1.0 + _SQUARE and _face(assembly, one, other):
            yield Compound(kind=CompoundKind.FINGERS, children=(one.child, other.child))


def _face(assembly: Assembly, one: JointEstimate, other: JointEstimate) -> bool:
    """True if two parts stand opposite each other along their axis, no farther apart than they travel together."""
    between: FloatArray = assembly.parts[other.child].centroid - assembly.parts[one.child].centroid
    along = float(between @ one.axis)
    beside = float(np.linalg.norm(between - along * one.axis))
    spans = [np.sort(assembly.parts[joint.child].vertices @ one.axis)[[0, -1]] for joint in (one, other)]
    gap = max(spans[0][0], spans[1][0]) - min(spans[0][1], spans[1][1])
    reach = (one.upper - one.lower) + (other.upper - other.lower)
    return beside < _BESIDE * abs(along) and gap < reach
