"""What is measured of the hypotheses of a joint: numbers that the geometry fixes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.generate.procedural.solids import box, cylinder, union
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


def rotor(blades: int, tilt: float) -> Manifold:
    """Blades about the y axis, each tilted about its own length [deg]."""
    blade = box((-0.012, -0.003, 0.0), (0.012, 0.003, 0.1)).rotate((0, 0, tilt))
    return union(*(blade.rotate((0, 360.0 * k / blades, 0)) for k in range(blades)))


BODY = box((-0.1, 0.011, -0.1), (0.1, 0.1, 0.1))


def test_a_disc_is_carried_onto_itself_about_its_axle_alone() -> None:
    found = measured(cylinder(0.1, (0, -0.01, 0), (0, 0.01, 0)), BODY)
    assert found["itself_odd"][1] < 0.01 < found["itself_odd"][0]
    assert found["outline_least"][1] > 0.95 > found["outline_least"][0]


def test_tilted_blades_wind_and_flat_ones_do_not() -> None:
    assert measured(rotor(4, 20.0), BODY)["twist"][1] > 0.5
    assert measured(rotor(4, 0.0), BODY)["twist"][1] < 0.2


def test_a_pin_in_a_solid_barrel_is_where_both_are_solid() -> None:
    """The two stand in each other at rest; that is a way of modelling, and it shows the line."""
    door = union(box((0.0, -0.01, -0.2), (0.3, 0.01, 0.2)), cylinder(0.012, (0, 0, -0.2), (0, 0, 0.2)))
    post = union(cylinder(0.02, (0, 0, -0.25), (0, 0, 0.25)), box((-0.2, -0.02, -0.25), (0, 0.02, 0.25)))
    found = measured(door, post)
    assert found["shared_radius"][2] < 0.1 < found["shared_radius"][0]
    assert found["shared_along"][2] > 0.5
    assert found["shared_around"][2] == 1.0


def test_a_hinge_at_an_edge_chooses_a_side_that_the_panel_does_not_show() -> None:
    centred = measured(box((-0.1, -0.01, -0.1), (0.1, 0.01, 0.1)), BODY)
    beside = measured(box((0.0, -0.01, -0.1), (0.2, 0.01, 0.1)), BODY)
    assert centred["mirror_child"][2] < 0.05
    assert beside["mirror_child"][2] > 0.5
    assert beside["mirror_reason"][2] < 0.05
