"""Contacts measured again from the meshes: what a wrong tolerance or a faulty graph left out or made up.

A part that loses its parent (KV303, KV341) may simply hang on the wrong one because the contact with the right one was
never seen. The exact distances of all near parts say which contacts there are, whatever the graph holds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.build import build_contact_graph, exact_gap, near_pairs
from kinematify.joints.bearings.fit import fit_edge

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.geometry.surface import PartSurface
    from kinematify.joints.bearings.scores import EdgeBearing


@dataclass(frozen=True, kw_only=True)
class ContactAudit:
    """What the meshes say about the edges of a contact graph."""

    missing: tuple[Pair, ...]
    """Parts that touch and have no edge."""
    spurious: tuple[Pair, ...]
    """Edges between parts that do not touch."""
    tolerance: float
    """Gap up to which parts are held to touch, fraction of the diagonal."""

    def __bool__(self) -> bool:
        """Whether the graph is wrong."""
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
