"""Warnings of an inference, one sentence each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.joints.bearings.refine_lines import across_axis
from kinematify.joints.choice.congruent_joints import TwinJoints
from kinematify.joints.choice.judge import alike_edges
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import CompoundConfig, Config
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
        *_doubtful_base(assembly, trees, config.topology.base_doubt),
        *floating_parts(assembly, graph, trees[0]),
        *_compound_joints(assembly, joints, graph, config.joints.compound),
        *_followed_twins(assembly, joints, bearings),
        *unlike_twins(assembly, graph, trees[0], joints, config),
    )


def _doubtful_base(assembly: Assembly, trees: Sequence[KinematicTree], doubt: float) -> list[str]:
    """Warn where another part would serve as base link nearly as well."""
    best = trees[0]
    rivals = [tree.root for tree in trees if tree.root != best.root and tree.reward >= best.reward - doubt]
    if not rivals:
        return []
    others = " or ".join(assembly.names[part] for part in dict.fromkeys(rivals))
    taken = assembly.names[best.root]
    said = f"The base link is not certain: {taken} was chosen, {others} scored nearly as well. "
    return [said + "Give --base to choose."]


def floating_parts(assembly: Assembly, graph: ContactGraph, tree: KinematicTree) -> list[str]:
    """Warn of tree edges between parts that do not touch."""
    warnings = []
    for parent, child in tree.edges():
        edge = graph.by_pair.get(pair(parent, child))
        if edge is None or edge.bridge:
            gap = "" if edge is None else f" ({edge.gap / assembly.diagonal:.2%} of the object's diagonal apart)"
            name, above = assembly.names[child], assembly.names[parent]
            touched = [item for item in graph.edges if child in (item.a, item.b) and not item.bridge]
            warnings.append(
                f"The parent of {name} is {above}, which it does not touch{gap}, although it touches other parts."
                if touched
                else f"{name} touches nothing; its parent is {above}, the nearest part{gap}."
            )
    return warnings


def _compound_joints(
    assembly: Assembly, joints: Sequence[JointEstimate], graph: ContactGraph, config: CompoundConfig
) -> list[str]:
    """Tell of joints that are one mechanism together."""
    found = compounds(assembly, joints, graph.clusters, config)
    return [described(compound, assembly.names) for compound in found]


def _followed_twins(
    assembly: Assembly, joints: Sequence[JointEstimate], bearings: Mapping[Pair, EdgeBearing]
) -> list[str]:
    """Tell which joints took their line from congruent ones."""
    said = []
    for joint in joints:
        bearing = bearings.get(pair(joint.parent, joint.child))
        if bearing is None or not bearing.follows or not _runs_along(joint, bearing.lines[0]):
            continue
        models = [f"{assembly.names[one]} and {assembly.names[other]}" for one, other in bearing.follows]
        own = f"{assembly.names[joint.parent]} and {assembly.names[joint.child]}"
        said.append(f"{own} turn as their congruent twins do ({'; '.join(models)})")
    if not said:
        return []
    return [f"{'. '.join(said)}. Their own contact, which is rough, shows another line than that of all these parts."]


def _runs_along(joint: JointEstimate, line: BearingLine) -> bool:
    """True if a joint has the direction of a line, to 1 deg."""
    return bool(abs(float(joint.axis @ line.axis)) > math.cos(math.radians(1.0)))


_SAME_END, _SAME_PLACE = 0.1, 0.02  # shares of the wider range and of the part's diagonal within which joints are alike


def unlike_twins(
    assembly: Assembly, graph: ContactGraph, tree: KinematicTree, joints: Sequence[JointEstimate], config: Config
) -> list[str]:
    """Warn of congruent parts with mirrored or repeated contacts whose joints differ, and name what they differ in."""
    twins, joint_of = TwinJoints(assembly, graph, config.bearing, seed=config.seed), {j.child: j for j in joints}
    said = []
    for group in alike_edges(graph, tree):
        alike = [joint_of[child] for _, child in group]
        model = max(alike, key=lambda joint: joint.confidence)
        unlike: dict[str, list[str]] = {}
        for joint in alike:
            # What is the same as it stands needs no motion, which takes longer to find.
            if joint is not model and _difference(model, joint, math.inf):
                size = assembly.parts[joint.child].diagonal
                found = [_difference(item, joint, size) for item in twins.carried(model, joint)]
                if found and all(found):
                    unlike.setdefault(found[0], []).append(assembly.names[joint.child])
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


class CompoundKind(StrEnum):
    """Kind of a group of joints."""

    BALL = "ball"
    UNIVERSAL = "universal"
    FINGERS = "fingers"
    CAP = "cap"


@dataclass(frozen=True, kw_only=True)
class Compound:
    """Several joints that are one mechanism."""

    kind: CompoundKind
    children: tuple[int, ...]
    """Indices of the parts that the joints move, from the base outward."""


def compounds(
    assembly: Assembly, joints: Sequence[JointEstimate], clusters: Sequence[Sequence[int]], config: CompoundConfig
) -> tuple[Compound, ...]:
    """Find joints that are one mechanism together, which a tree of single joints cannot say.

    A cross between two forks makes a universal joint, three axes through one point make a ball joint, two fingers that
    close on each other are driven as one (``<mimic>``), and a cap on a neck turns and comes off along the same line.

    Args:
        assembly: The parts, world frame.
        joints: The chosen joints of the tree.
        clusters: Parts that are congruent, by index.
        config: How exact lines must meet, and what counts as a cross.

    Returns:
        Ball joints first, then universal ones that are no piece of a ball joint, then pairs of fingers, then caps.
    """
    by_child = {joint.child: joint for joint in joints}
    near = config.meeting * assembly.diagonal
    balls = [
        Compound(kind=CompoundKind.BALL, children=tuple(joint.child for joint in chain))
        for chain in _chains(by_child, 3)
        if _one_point(chain, near) and abs(np.linalg.det([joint.axis for joint in chain])) > config.spread
    ]
    taken = {frozenset(pair) for ball in balls for pair in combinations(ball.children, 2)}
    universals = [
        Compound(kind=CompoundKind.UNIVERSAL, children=(first.child, second.child))
        for first, second in _chains(by_child, 2)
        if frozenset((first.child, second.child)) not in taken
        and abs(float(first.axis @ second.axis)) < config.square
        and _one_point((first, second), near)
        and _is_cross(assembly, first, second, config)
    ]
    return (*balls, *universals, *_fingers(assembly, joints, clusters, config), *_caps(assembly, joints, config))


def described(compound: Compound, names: Sequence[str]) -> str:
    """A sentence for the user; `names` are those of the parts."""
    parts = [names[child] for child in compound.children]
    if compound.kind is CompoundKind.BALL:
        return f"The joints of {parts[0]}, {parts[1]} and {parts[2]} turn about one point: together a ball joint."
    if compound.kind is CompoundKind.UNIVERSAL:
        return (
            f"The joints of {parts[0]} and {parts[1]} cross at a right angle in {parts[0]}: together a universal joint."
        )
    if compound.kind is CompoundKind.CAP:
        return (
            f"{parts[0]} closes the end of what it turns on and may come off along its axis: a screw or cylindrical "
            "pair, which takes two joints about one line with a link without geometry between them."
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


def _is_cross(assembly: Assembly, first: JointEstimate, second: JointEstimate, config: CompoundConfig) -> bool:
    """True if the part between two joints is small beside those that it joins."""
    middle, ends = assembly.parts[first.child], (assembly.parts[first.parent], assembly.parts[second.child])
    return all(middle.diagonal < config.cross * end.diagonal for end in ends)


def _fingers(
    assembly: Assembly, joints: Sequence[JointEstimate], clusters: Sequence[Sequence[int]], config: CompoundConfig
) -> Iterator[Compound]:
    """Congruent parts that carry nothing and slide towards each other on one body."""
    label = {part: index for index, cluster in enumerate(clusters) for part in cluster}
    bearing = {joint.parent for joint in joints}
    leaves = [
        joint
        for joint in joints
        if joint.kind is JointType.PRISMATIC and joint.child not in bearing and joint.child in label
    ]
    for one, other in combinations(leaves, 2):
        twins = one.parent == other.parent and label[one.child] == label[other.child]
        if twins and float(one.axis @ other.axis) < -1.0 + config.square and _face(assembly, one, other, config):
            yield Compound(kind=CompoundKind.FINGERS, children=(one.child, other.child))


def _face(assembly: Assembly, one: JointEstimate, other: JointEstimate, config: CompoundConfig) -> bool:
    """True if two parts stand opposite each other along their axis, no farther apart than they travel together."""
    between: FloatArray = assembly.parts[other.child].centroid - assembly.parts[one.child].centroid
    along = float(between @ one.axis)
    beside = float(np.linalg.norm(between - along * one.axis))
    spans = [np.sort(assembly.parts[joint.child].vertices @ one.axis)[[0, -1]] for joint in (one, other)]
    gap = max(spans[0][0], spans[1][0]) - min(spans[0][1], spans[1][1])
    reach = (one.upper - one.lower) + (other.upper - other.lower)
    return beside < config.beside * abs(along) and gap < reach


def _caps(assembly: Assembly, joints: Sequence[JointEstimate], config: CompoundConfig) -> Iterator[Compound]:
    """Parts that carry nothing and turn in a bearing on the end of a part about the same line, which they close."""
    carriers = {joint.parent for joint in joints}
    for joint in joints:
        turns = joint.kind.turns and joint.evidence.get("bearing_gate", 0.0) > 0.0
        if turns and joint.child not in carriers and _closes(assembly, joint, config):
            yield Compound(kind=CompoundKind.CAP, children=(joint.child,))


def _closes(assembly: Assembly, joint: JointEstimate, config: CompoundConfig) -> bool:
    """True if a part goes around the end of its parent, and over it."""
    cap, body = assembly.parts[joint.child], assembly.parts[joint.parent]
    across = across_axis(joint.axis)
    aside = float(np.linalg.norm(across @ (body.centroid - joint.pivot)))
    for direction in (joint.axis, -joint.axis):
        end = float(((body.vertices - joint.pivot) @ direction).max())
        height = (cap.vertices - joint.pivot) @ direction
        rim = cap.vertices[height < end]
        neck = body.vertices[(body.vertices - joint.pivot) @ direction > height.min()]
        if len(rim) == 0 or len(neck) == 0 or height.max() <= end:
            continue
        inner, outer = (np.linalg.norm((points - joint.pivot) @ across.T, axis=1).max() for points in (neck, rim))
        if outer > inner and aside < config.coaxial * inner and _on_the_line(cap, joint, direction, end):
            return True
    return False


def _on_the_line(part: Part, joint: JointEstimate, direction: FloatArray, beyond: float) -> bool:
    """True if the joint's line meets a part farther along `direction` than `beyond` [m]."""
    corners = part.vertices[part.faces] - joint.pivot
    flat = corners @ across_axis(joint.axis).T
    turns = np.stack([_cross(flat[:, k], flat[:, (k + 1) % 3]) for k in range(3)])
    met = (turns >= 0).all(axis=0) | (turns <= 0).all(axis=0)
    return bool(met.any() and ((corners[met] @ direction).max(axis=1) > beyond).any())


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
