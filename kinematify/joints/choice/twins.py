"""Congruent parts that hang on one part have joints of one type: what is likely for one speaks for all."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.measure.measurements import FIXED, SLIDE, TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.rooted_tree import RootedTree
    from kinematify.robot.arrays import FloatArray, IntArray

_LEAST = 1.0e-6  # probability of a type, so that one part alone cannot rule a type out for all


def alike_edges(graph: ContactGraph, tree: RootedTree) -> list[list[tuple[int, int]]]:
    """Edges whose children are congruent, on one parent or on congruent ones, in groups of two or more.

    Args:
        graph: Contact graph with clusters of congruent parts.
        tree: Parent of every part.

    Returns:
        Groups of (parent, child).
    """
    groups: dict[tuple[int, int, int], list[tuple[int, int]]] = {}
    for parent, child in tree.edges():
        cluster, above = graph.cluster_of[child], graph.cluster_of[parent]
        if cluster >= 0:
            groups.setdefault((cluster, above, parent if above < 0 else -1), []).append((parent, child))
    return [group for group in groups.values() if len(group) > 1]


def agreed(kinds: Sequence[IntArray], likely: Sequence[FloatArray]) -> list[FloatArray]:
    """Probabilities of the hypotheses of edges that are alike, after they have agreed on a type.

    The probability of each type is the geometric mean over the edges; within a type nothing changes.

    Args:
        kinds: FIXED, TURN or SLIDE of the hypotheses of each edge, shape (h,) each.
        likely: Their probabilities, sum 1, shape (h,) each.

    Returns:
        The new probabilities, sum 1, shape (h,) each.
    """
    of_types = [
        [max(float(probability[kind == each].sum()), _LEAST) for each in (FIXED, TURN, SLIDE)]
        for kind, probability in zip(kinds, likely, strict=True)
    ]
    logs = np.log(np.array(of_types))
    lifted = [
        probability * np.exp(logs.mean(axis=0) - own)[kind]
        for kind, probability, own in zip(kinds, likely, logs, strict=True)
    ]
    return [np.asarray(probability / probability.sum()) for probability in lifted]
