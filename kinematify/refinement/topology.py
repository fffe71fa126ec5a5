"""Repairing the tree: parts that hang on what they do not touch, or run into what should carry them.

The contacts are measured again, the feedback weakens edges, and the search restarts warm from the trees it had, with
R_sim among its terms. Joints of edges that are new are chosen as the inference would.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.pipeline.stages import choose_joints, find_trees
from kinematify.refinement.history import PlanChange
from kinematify.refinement.plan import Plan
from kinematify.topology.reward import SimulatedEdges

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointEstimate
    from kinematify.validation.feedback import EdgeSignal

_SAME = np.cos(np.radians(1.0))
_NEAR = 1e-3  # of the distance of a line from the origin
Edge = tuple[int, int]
"""Parent and child."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SearchedContacts:
    """The graph that trees are searched on, with its bearings."""

    graph: ContactGraph
    bearings: Mapping[Pair, EdgeBearing]


class EdgeMemory:
    """What all rounds so far have had against edges of the tree."""

    def __init__(self) -> None:
        self.against: dict[Edge, float] = {}

    def add(self, assembly: Assembly, signals: tuple[EdgeSignal, ...]) -> None:
        """Keep the worst that was said of each edge."""
        for signal in signals:
            edge = assembly.names.index(signal.parent), assembly.names.index(signal.child)
            self.against[edge] = max(self.against.get(edge, 0.0), signal.weight)

    def survival(self, edge: Edge) -> float:
        """In (0, 1]; 1 for what nothing speaks against."""
        return float(np.exp(-self.against.get(edge, 0.0)))


def search_again(
    assembly: Assembly,
    contacts: SearchedContacts,
    memory: EdgeMemory,
    warm: tuple[KinematicTree, ...],
    config: Config,
    *,
    base: int | None,
) -> tuple[KinematicTree, ...]:
    """Search the trees again, warm, with what the simulation had against edges."""
    simulated = SimulatedEdges(
        survival={edge: memory.survival(edge) for edge in memory.against}, weight=config.refine.survival_weight
    )
    return find_trees(assembly, contacts.graph, contacts.bearings, config, base=base, simulated=simulated, warm=warm)


def replanned(
    plan: Plan, before: SearchedContacts, contacts: SearchedContacts, tree: KinematicTree
) -> tuple[Plan, list[PlanChange]]:
    """The plan on another tree, with the joints that the inference would choose there.

    Args:
        plan: On the tree before.
        before: The contacts that it was found on.
        contacts: That the new tree was found on.
        tree: The new one.
    """
    chosen = choose_joints(plan.assembly, contacts.graph, tree, contacts.bearings, plan.config)
    joints = with_kept(plan, before, chosen)
    names = plan.assembly.names
    new = Plan(assembly=plan.assembly, config=plan.config, tree=tree, joints=joints)
    changes = [
        PlanChange(
            part=names[child],
            what="parent",
            before=names[before] if before >= 0 else "(base)",
            after=names[after] if after >= 0 else "(base)",
            why="the contacts as measured again, and what the simulation had against edges",
        )
        for child, (before, after) in enumerate(zip(plan.tree.parents, tree.parents, strict=True))
        if before != after
    ]
    return new, changes


def with_kept(plan: Plan, contacts: SearchedContacts, chosen: Sequence[JointEstimate]) -> tuple[JointEstimate, ...]:
    """Joints of another tree; those of a plan stay on edges where the inference would choose on it what is chosen now.

    Args:
        plan: On the tree before.
        contacts: That it was found on.
        chosen: What the inference chooses on the new tree.
    """
    before = choose_joints(plan.assembly, contacts.graph, plan.tree, contacts.bearings, plan.config)
    then = {(joint.parent, joint.child): joint for joint in before}
    known = {(joint.parent, joint.child): joint for joint in plan.joints}
    edges = [(joint.parent, joint.child) for joint in chosen]
    return tuple(
        known[edge] if edge in then and _alike(joint, then[edge]) else joint
        for edge, joint in zip(edges, chosen, strict=True)
    )


def _alike(one: JointEstimate, other: JointEstimate) -> bool:
    """Whether two joints of one part are of one type about one line, or along one direction."""
    if one.kind is not other.kind or abs(float(one.axis @ other.axis)) < _SAME:
        return False
    apart = float(np.linalg.norm(np.cross(one.pivot - other.pivot, one.axis)))
    return not one.kind.turns or apart < _NEAR * max(float(np.linalg.norm(one.pivot)), _NEAR)
