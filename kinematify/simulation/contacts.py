"""Which bodies touch along a sweep, how deep, and how much of it is there from the start."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.prepared import Prepared


@dataclass(frozen=True, kw_only=True, eq=False)
class Contacts:
    """Pairs of links in contact in some rows of a table of configurations, each pair once per row."""

    row: IntArray
    """Shape (c,)."""
    links: IntArray
    """Indices in the order of the document, smaller first, shape (c, 2)."""
    depth: FloatArray
    """Deepest point [m], shape (c,)."""


def deepest(row: IntArray, links: IntArray, depth: FloatArray) -> Contacts:
    """Keep the deepest contact of every pair in every row.

    Args:
        row: Shape (n,).
        links: In any order, shape (n, 2).
        depth: [m], shape (n,).
    """
    links = np.sort(links.reshape(-1, 2), axis=1)
    count = int(links.max(initial=0)) + 1
    key = (row * count + links[:, 0]) * count + links[:, 1]
    order = np.lexsort((-depth, key))
    first = np.ones(len(key), dtype=bool)
    first[1:] = np.diff(key[order]) > 0
    kept = order[first]
    return Contacts(row=row[kept], links=links[kept], depth=depth[kept])


@dataclass(frozen=True, kw_only=True, eq=False)
class Touching:
    """Depth of every pair of bodies that ever touches, over the rows of a sweep whose first row is the rest."""

    bodies: IntArray
    """Shape (p, 2)."""
    contacts: Contacts
    """Of the links of these bodies."""
    pair_of: IntArray
    """Index of the pair of bodies of each contact, shape (c,)."""
    depth: FloatArray
    """[m], 0 where they are apart, shape (p, rows)."""
    tolerance: float
    """Depth that never counts [m]."""
    slack: FloatArray
    """How far convex stand-ins can exceed what they represent [m], 0 for pairs that are apart at rest and that no joint
    connects, shape (p,)."""

    @cached_property
    def at_rest(self) -> FloatArray:
        """Depth in the first row [m], shape (p,)."""
        return self.depth[:, 0]

    @cached_property
    def allowed(self) -> FloatArray:
        """Depth that each pair may reach: what it has at rest, with tolerance and slack [m], shape (p,)."""
        return self.at_rest + self.tolerance + self.slack

    @cached_property
    def excess(self) -> FloatArray:
        """Depth beyond what is allowed [m], negative where there is room, shape (p, rows)."""
        return self.depth - self.allowed[:, None]

    def meet(self, rows: slice) -> tuple[int, ...]:
        """Indices of the pairs that get deeper than allowed in some rows."""
        return tuple(np.flatnonzero((self.excess[:, rows] > 0.0).any(axis=1)).tolist())

    def pair(self, index: int, names: tuple[str, ...], rows: Sequence[int] = ()) -> tuple[str, str]:
        """Return the names of the two links of a pair of bodies that get deepest into each other.

        Args:
            index: Of the pair.
            names: Of all links.
            rows: Where to look; everywhere if empty, or if the pair is apart in all of them.
        """
        of_pair = self.pair_of == index
        there = of_pair & np.isin(self.contacts.row, rows)
        chosen = np.flatnonzero(there if there.any() else of_pair)
        first, second = self.contacts.links[chosen[np.argmax(self.contacts.depth[chosen])]].tolist()
        return names[first], names[second]


def touching(
    contacts: Contacts, mechanism: LeaderMechanism, prepared: Prepared, *, rows: int, tolerance: float
) -> Touching:
    """Gather contacts of links into contacts of bodies; row 0 is the rest."""
    bodies = np.sort(mechanism.body_of_link[contacts.links], axis=1)
    pairs, index = np.unique(bodies, axis=0, return_inverse=True)
    index = index.reshape(-1)
    depth = np.zeros((len(pairs), rows))
    np.maximum.at(depth, (index, contacts.row), contacts.depth)
    deepest_links = np.zeros((len(pairs), 2), dtype=np.int64)
    order = np.argsort(contacts.depth)
    deepest_links[index[order]] = contacts.links[order]  # the deepest comes last and stays
    # Bodies between which there are several joints in one place overlap as those do that one joint connects.
    joined = np.array([(a, b) in mechanism.neighbours for a, b in pairs.tolist()], dtype=bool)
    near = joined | (depth[:, 0] > tolerance)
    names = [(mechanism.links[a], mechanism.links[b]) for a, b in deepest_links.tolist()]
    errors = np.array([stand_in_error(prepared, pair) for pair in names])
    slack = np.where(near, errors, 0.0)
    return Touching(bodies=pairs, contacts=contacts, pair_of=index, depth=depth, tolerance=tolerance, slack=slack)


def stand_in_error(prepared: Prepared, pair: tuple[str, str]) -> float:
    """Return how much deeper the convex pieces of two links can be in each other than their declared surfaces [m].

    Infinite where one is the hull of a concave mesh: it fills hollows, in which the other may rightly be.
    """
    links = [prepared.link_by_name[name] for name in pair]
    return float("inf") if any(link.filled for link in links) else sum(link.gap for link in links)


def stand_in_reason(prepared: Prepared, pair: tuple[str, str]) -> str:
    """Why an overlap of convex pieces may be none of the declared surfaces, as words that follow a comma."""
    error = stand_in_error(prepared, pair)
    if error == float("inf"):
        return "one of which is the convex hull of a concave mesh"
    return f"within the {error * 1e3:.3g} mm by which their convex pieces can exceed the meshes"
