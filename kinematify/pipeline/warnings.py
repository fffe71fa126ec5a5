"""What the user should know of an inference, one sentence each."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kinematify.contact.graph import pair
from kinematify.joints.choice.compound import compounds, described

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import CompoundConfig, Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from kinematify.joints.candidate import JointEstimate
    from kinematify.topology.tree import KinematicTree


def warnings_of(
    assembly: Assembly,
    graph: ContactGraph,
    bearings: Mapping[Pair, EdgeBearing],
    trees: Sequence[KinematicTree],
    joints: Sequence[JointEstimate],
    *,
    config: Config,
) -> tuple[str, ...]:
    """Everything to tell of an inference; what was already told of the assembly comes first."""
    return (
        *assembly.warnings,
        *_doubtful_base(assembly, trees, config.topology.base_doubt),
        *_floating_parts(assembly, graph, trees[0]),
        *_compound_joints(assembly, joints, graph, config.joints.compound),
        *_followed_twins(assembly, joints, bearings),
    )


def _doubtful_base(assembly: Assembly, trees: Sequence[KinematicTree], doubt: float) -> list[str]:
    """Warn where another part would serve as base link nearly as well."""
    best = trees[0]
    rivals = [tree.root for tree in trees if tree.root != best.root and tree.reward >= best.reward - doubt]
    if not rivals:
        return []
    others = " or ".join(assembly.names[part] for part in dict.fromkeys(rivals))
    taken = assembly.names[best.root]
    said = f"Which part stands still is not clear: {taken} was taken, {others} would do nearly as well. "
    return [said + "Give --base to choose."]


def _floating_parts(assembly: Assembly, graph: ContactGraph, tree: KinematicTree) -> list[str]:
    """Warn of tree edges between parts that do not touch."""
    warnings = []
    for parent, child in tree.edges():
        edge = graph.by_pair.get(pair(parent, child))
        if edge is None or edge.bridge:
            gap = "" if edge is None else f" ({edge.gap / assembly.diagonal:.2%} of the object's diagonal apart)"
            name, above = assembly.names[child], assembly.names[parent]
            touched = [item for item in graph.edges if child in (item.a, item.b) and not item.bridge]
            warnings.append(
                f"{name} hangs on {above}, which it does not touch{gap}, and not on what it touches."
                if touched
                else f"{name} touches nothing; it hangs on {above}, the nearest part{gap}."
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
    return [f"{'. '.join(said)}. By itself, the rough contact shows another line; what all twins show was taken."]


def _runs_along(joint: JointEstimate, line: BearingLine) -> bool:
    """Whether a joint has the direction of a line, to 1 deg."""
    return bool(abs(float(joint.axis @ line.axis)) > math.cos(math.radians(1.0)))


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
