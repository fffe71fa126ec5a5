"""Repairing contacts and tree: parts that hang on what they do not touch, or run into what should carry them.

A part that loses its parent (KV303) may simply hang on the wrong one because the contact with the right one was
never seen. The exact distances of all near parts say which contacts there are, whatever the graph holds. The feedback
then weakens edges, and the search restarts warm from the trees it had, with R_sim among its terms. Joints of edges that
are new are chosen as the inference would. Pieces of one part are joined for the inference, and fixed to each other in
the answer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.build_graph import build_contact_graph, exact_gap, near_pairs
from kinematify.contact.seams import joined, largest_piece, rigid_pieces
from kinematify.contact.tree import KinematicTree
from kinematify.joints.bearings.bearing_fit import fit_edge
from kinematify.joints.bearings.scores import EdgeBearing
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.piece_report import joints_of_pieces, tree_of_pieces
from kinematify.pipeline.stages import choose_joints, find_trees
from kinematify.refinement.joint_plan import Plan, PlanChange
from kinematify.topology.reward import SimulatedEdges

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.surface import PartSurface
    from kinematify.joints.candidate import JointEstimate
    from kinematify.validation.run.feedback import EdgeSignal


@dataclass(frozen=True, kw_only=True)
class ContactAudit:
    """Comparison of the meshes with the edges of a contact graph."""

    missing: tuple[Pair, ...]
    """Parts that touch and have no edge."""
    spurious: tuple[Pair, ...]
    """Edges between parts that do not touch."""
    tolerance: float
    """Gap up to which parts are held to touch, fraction of the diagonal."""

    def __bool__(self) -> bool:
        """True if the graph is wrong."""
        return bool(self.missing or self.spurious)


def audit_contacts(
    assembly: Assembly, surfaces: Sequence[PartSurface], graph: ContactGraph, config: Config
) -> ContactAudit:
    """Hold a contact graph against the exact distances of its parts.

    Where most parts touch nothing at all, the gaps between them are of the object's own, and the tolerance is widened
    to them.
    """
    refine = config.refine
    widest = refine.widest_tolerance * assembly.diagonal
    gaps = {pair: exact_gap(surfaces, pair) for pair in near_pairs(assembly, widest)}
    tolerance = refine.contact_tolerance * assembly.diagonal
    nearest = [
        min((gap for pair, gap in gaps.items() if part in pair), default=np.inf) for part in range(len(surfaces))
    ]
    apart = np.array(nearest) > tolerance
    if apart.mean() > refine.hovering_share and np.isfinite(nearest).any():
        typical = float(np.median([gap for gap in nearest if np.isfinite(gap)]))
        tolerance = min(max(tolerance, refine.hovering_reach * typical), widest)
    touching = {pair for pair, gap in gaps.items() if gap <= tolerance}
    known = {(edge.a, edge.b) for edge in graph.edges if not edge.bridge}
    return ContactAudit(
        missing=tuple(sorted(touching - known)),
        spurious=tuple(sorted(known - touching)),
        tolerance=tolerance / assembly.diagonal,
    )


def rebuilt(
    assembly: Assembly,
    surfaces: Sequence[PartSurface],
    audit: ContactAudit,
    known: Mapping[Pair, EdgeBearing],
    config: Config,
) -> tuple[ContactGraph, dict[Pair, EdgeBearing]]:
    """The contact graph as the meshes have it, with the bearings of its edges.

    Args:
        assembly: The parts.
        surfaces: Derived geometry of each part, same order.
        audit: What the old graph had wrong.
        known: Bearings of the old graph; those of edges that it had right are taken over.
        config: Of the inference.
    """
    contact = config.contact.model_copy(update={"tolerance": audit.tolerance})
    graph = build_contact_graph(assembly, surfaces, config=contact, seed=config.seed)
    wrong = {*audit.missing, *audit.spurious}
    bearings = {pair: bearing for pair, bearing in known.items() if pair in graph.by_pair and pair not in wrong}
    if config.joints.method == "geometry":
        for pair, edge in graph.by_pair.items():
            if pair not in bearings:
                bearings[pair] = fit_edge(
                    surfaces, edge, diagonal=assembly.diagonal, config=config.bearing, seed=config.seed
                )
    return graph, bearings


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
    """Findings of all rounds against edges of the tree."""

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
    """True if two joints of one part are of one type about one line, or along one direction."""
    if one.kind is not other.kind or abs(float(one.axis @ other.axis)) < _SAME:
        return False
    apart = float(np.linalg.norm(np.cross(one.pivot - other.pivot, one.axis)))
    return not one.kind.turns or apart < _NEAR * max(float(np.linalg.norm(one.pivot)), _NEAR)


def infer_joined(
    plan: Plan, contacts: SearchedContacts, seams: dict[Pair, float], *, base: int | None
) -> tuple[Plan, SearchedContacts, list[PlanChange]]:
    """The plan that results when pieces with a common seam are one part.

    Args:
        plan: With the pieces as parts of their own.
        contacts: Their contacts; they stay those of the pieces.
        seams: Pairs of pieces with the length of their seam [m].
        base: Part that is known to be the base link.
    """
    assembly = plan.assembly
    groups = rigid_pieces(len(assembly.parts), seams)
    mains = [largest_piece(assembly, group) for group in groups]
    named = None
    if base is not None:
        named = assembly.names[next(main for main, group in zip(mains, groups, strict=True) if base in group)]
    if len(groups) < 2:
        return plan, contacts, []
    whole = infer(joined(assembly, groups), config=plan.config, base=named)
    tree = tree_of_pieces(whole.trees[0], groups, mains)
    joints = joints_of_pieces(assembly, tree, whole.joints, groups, mains)
    new = Plan(assembly=assembly, config=plan.config, tree=tree, joints=with_kept(plan, contacts, joints))
    changes = [
        PlanChange(
            part=assembly.names[piece],
            what="fixed",
            before=f"a part of its own on {_parent_name(plan, piece)}",
            after=f"fixed to {assembly.names[main]}",
            why=f"they are one part cut in two: their open rims coincide over {_seam(seams, group):.3g} m",
        )
        for main, group in zip(mains, groups, strict=True)
        for piece in group
        if piece != main
    ]
    return new, contacts, changes


def _parent_name(plan: Plan, part: int) -> str:
    above = plan.tree.parents[part]
    return "nothing" if above < 0 else plan.assembly.names[above]


def _seam(seams: dict[Pair, float], group: tuple[int, ...]) -> float:
    return sum(length for (a, b), length in seams.items() if a in group and b in group)
