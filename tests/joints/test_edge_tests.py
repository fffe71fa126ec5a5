"""What is asked of contacts before the tree: folding leaves are held by their barrels, hands of a clock pass."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.joints.bearings.scores import BearingLine
from kinematify.joints.features.pins import has_journal, leaf_pairs, passes
from kinematify.joints.features.workspace import PartCache
from tests.joints.joint_scenes import clock, evidence
from tests.known import known_object, turning

if TYPE_CHECKING:
    from tests.known import KnownObject

CONFIG = load_config()


@pytest.mark.parametrize("pegged", [False, True])
def test_a_hand_with_a_peg_does_not_pass_the_other_one(pegged: bool) -> None:
    known = clock()
    if pegged:
        peg = box((0.002, -0.009, 0.02), (0.012, -0.001, 0.03))
        known = clock(extra=peg)
    _, graph, bearings = evidence(known)
    pair = (known.index["hand_0"], known.index["hand_1"])
    cache = PartCache(known.assembly, graph, samples=CONFIG.joints.samples, seed=0)
    assert passes(cache, pair, bearings[pair].lines[0], CONFIG.joints) is not pegged


def test_doors_side_by_side_do_not_hold_each_other() -> None:
    body = box((-0.4, 0.0, 0.0), (0.4, 0.4, 0.8)) - box((-0.38, -0.1, 0.02), (0.38, 0.38, 0.78))
    solids = {"body": body}
    for k, (left, right) in enumerate(((-0.39, -0.0005), (0.0005, 0.39))):
        solids[f"door_{k}"] = box((left, -0.02, 0.01), (right, 0.0, 0.79))
    joints = [turning("body", f"door_{k}", (0, 0, 1), (s * 0.39, 0, 0), (0, 1.5)) for k, s in enumerate((-1, 1))]
    known = known_object("doors", solids, *joints)
    _, graph, _ = evidence(known)
    cache = PartCache(known.assembly, graph, samples=500, seed=0)
    assert (1, 2) in graph.by_pair
    assert not any(has_journal(cache, pair, CONFIG.joints) for pair in graph.by_pair)


def leaves(*angles: float) -> KnownObject:
    """Boards 10 cm long and 3 mm thick on one pin along x, standing off the level at these angles [deg]."""
    solids = {}
    for k, angle in enumerate(angles):
        eye = cylinder(0.008, (-0.02 + 0.01 * k, 0, 0), (-0.012 + 0.01 * k, 0, 0))
        board = box((-0.02, 0.012, -0.0015), (0.02, 0.1, 0.0015))
        arm = box((-0.02 + 0.01 * k, 0.0, -0.0015), (-0.012 + 0.01 * k, 0.02, 0.0015))
        solids[f"leaf_{k}"] = (eye + arm + board).rotate((angle, 0, 0))
    joints = [turning("leaf_0", f"leaf_{k}", (1, 0, 0), (0, 0, 0), (0, 1)) for k in (1, 2)]
    return known_object("leaves", solids, *joints)


@pytest.mark.parametrize(("angles", "middle"), [((0, 10, 20), 1), ((10, 0, 20), 0), ((0, 25, 12), 2)])
def test_the_leaf_between_the_others_carries_the_outer_one(angles: tuple[float, ...], middle: int) -> None:
    known = leaves(*angles)
    _, graph, _ = evidence(known)
    cache = PartCache(known.assembly, graph, samples=800, seed=0)
    pin = BearingLine(
        axis=np.array([1.0, 0, 0]), pivot=np.zeros(3), score=1.0, surface_a=1, surface_b=1, circles_a=1, circles_b=1
    )
    lines = dict.fromkeys([(0, 1), (0, 2), (1, 2)], pin)
    beside, skipping = leaf_pairs(cache, [(0, 1, 2)], lines, frozenset(), CONFIG.joints)
    assert beside == {pair for pair in lines if middle in pair}
    assert skipping == set(lines) - beside
    nothing = (frozenset(), frozenset())
    assert leaf_pairs(cache, [(0, 1, 2)], lines, beside, CONFIG.joints) == nothing
