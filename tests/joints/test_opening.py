"""Which way turning joints open, as the fitted trees say it."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.fit.trees import opening_recipe_key
from kinematify.generate.procedural.solids import box
from kinematify.joints.choice.opening import measure_sides, opening_odds, turn_sign
from kinematify.joints.choice.scorer import OPENING_WEIGHTS, shipped_scorer
from tests.joints.joint_scenes import scene_of
from tests.known import known_object, turning

FREE = np.array([2.0, 2.0])  # [rad], so that no stop answers
Z = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module", params=["left", "right"])
def door(request: pytest.FixtureRequest):
    """A slab before a cabinet, without any hardware, and its hinge; it opens to -y."""
    shell = box((0, 0, 0), (0.6, 0.5, 0.8)) - box((0.02, -1, 0.02), (0.58, 0.48, 0.78))
    left = request.param == "left"
    pivot = (0.0 if left else 0.6, -0.01, 0.4)
    axis = -Z if left else Z
    joint = turning("shell", "door", axis, pivot, (0.0, 1.6))
    known = known_object("cabinet", {"shell": shell, "door": box((0, -0.021, 0), (0.6, -0.001, 0.8))}, joint)
    return scene_of(known, "door"), np.array(axis), np.array(pivot)


def test_a_slab_opens_away_from_its_body(door) -> None:
    scene, axis, pivot = door
    assert turn_sign(scene, axis, pivot, FREE) == 1.0
    assert turn_sign(scene, -axis, pivot, FREE) == -1.0


def test_an_axis_and_its_opposite_get_opposite_odds(door) -> None:
    scene, axis, pivot = door
    given = opening_odds(shipped_scorer(OPENING_WEIGHTS), measure_sides(scene, axis, pivot))
    reversed_ = opening_odds(shipped_scorer(OPENING_WEIGHTS), measure_sides(scene, -axis, pivot))
    assert given > 0.0
    assert given == pytest.approx(-reversed_, rel=0.05)


def test_what_stands_at_a_stop_opens_the_other_way(door) -> None:
    scene, axis, pivot = door
    assert turn_sign(scene, axis, pivot, np.array([0.02, 3.0])) == -1.0


def test_the_weights_are_of_the_recipe() -> None:
    shipped = shipped_scorer(OPENING_WEIGHTS)
    assert shipped.provenance["recipe"] == opening_recipe_key(shipped.measurements)
