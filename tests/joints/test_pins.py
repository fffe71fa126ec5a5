"""What holds two parts is asked where the tree may depend on it, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.geometry.part_stats import assembly_stats
from kinematify.joints.bearings.scores import BearingLine
from kinematify.joints.features.pins import coaxial_carriers, find_pins
from tests.joints.joint_scenes import evidence
from tests.joints.test_edges import clock

CONFIG = load_config()


def bearing(pivot: tuple[float, float, float], axis: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> BearingLine:
    return BearingLine(axis=np.array(axis), pivot=np.array(pivot), score=1.0, surfaces=(1, 1), rings=(1, 1))


@pytest.mark.parametrize(("offset", "lean", "found"), [(0.0, 0.0, True), (0.1, 0.0, False), (0.0, 0.1, False)])
def test_a_carrier_bears_both_shafts_on_their_own_line(offset: float, lean: float, found: bool) -> None:
    """A body and two shafts one in the other; the inner one may stand off the line or lean."""
    inner = bearing((offset, 0.0, 5.0), (np.sin(lean), 0.0, np.cos(lean)))
    lines = {(0, 1): bearing((0, 0, 0)), (0, 2): bearing((0, 0, 0)), (1, 2): inner}
    assert (0 in coaxial_carriers(lines, angle=2.0, distance=0.05).get((1, 2), ())) is found


def test_the_case_bears_the_hands_of_a_clock_and_no_hand_bears_the_case() -> None:
    known = clock()
    _, graph, bearings = evidence(known)
    carriers = find_pins(known.assembly, graph, assembly_stats(known.assembly), bearings, CONFIG).carriers
    case, first, second = (known.index[name] for name in ("case", "hand_0", "hand_1"))
    assert carriers[first, second] == {case}
    assert not any(parts for edge, parts in carriers.items() if case in edge)
