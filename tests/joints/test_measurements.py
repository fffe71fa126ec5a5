"""What is measured of the hypotheses of a joint: numbers that the geometry fixes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.solids import box, cylinder
from kinematify.joints.candidate import ELSEWHERE, TURN, Hypotheses
from kinematify.joints.features.measurements import MeasuredHypotheses, measure
from tests.joints.joint_scenes import scene_of
from tests.known import known_object, turning

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.joints.features.measurements import Values

AXES = np.eye(3)


def measured(child: Manifold, body: Manifold) -> Values:
    """The measurements of turns about x, y and z through the origin."""
    known = known_object("pair", {"body": body, "child": child}, turning("body", "child", (0, 1, 0), (0, 0, 0)))
    hypotheses = Hypotheses(
        kinds=np.full(3, TURN),
        axes=AXES,
        pivots=np.zeros((3, 3)),
        places=np.full(3, ELSEWHERE),
        sources=np.array(["x", "y", "z"]),
    )
    return measure(MeasuredHypotheses(scene_of(known, "child"), hypotheses))


BODY = box((-0.1, 0.011, -0.1), (0.1, 0.1, 0.1))


def test_a_disc_turns_freely_about_its_axle_alone() -> None:
    found = measured(cylinder(0.1, (0, -0.01, 0), (0, 0.01, 0)), BODY)
    assert found["enter_parent_3"][1] == 0.0 < found["enter_parent_3"][0]
    assert found["kept_large"][1] > 0.9 > found["kept_large"][0]
    assert found["eccentric"][1] < 0.01


def test_a_line_through_a_panel_is_off_centre_where_the_panel_lies_beside_it() -> None:
    centred = measured(box((-0.1, -0.01, -0.1), (0.1, 0.01, 0.1)), BODY)
    beside = measured(box((0.0, -0.01, -0.1), (0.2, 0.01, 0.1)), BODY)
    assert centred["off_most"][2] < 0.05
    assert beside["off_most"][2] > 0.9
