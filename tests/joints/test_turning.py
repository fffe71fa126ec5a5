"""What goes round and round, and what turns between stops, as the fitted trees say it."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.fit.trees import turning_recipe_key
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.joints.choice.opening import is_continuous
from kinematify.joints.choice.scorer import TURNING_WEIGHTS, shipped_scorer
from tests.joints.joint_scenes import scene_of
from tests.known import known_object, turning

Y, Z = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])


def wheel(gap: float):
    """A wheel with its axle in a block; its tyre stands in the mudguard by as much as the gap is negative [m]."""
    block = box((-0.3, -0.1, 0.0), (0.3, 0.1, 0.2)) - cylinder(0.0101, (0, 0.0, 0.05), (0, 0.2, 0.05))
    guard = box((-0.12, 0.1, 0.05 + 0.1 + gap), (0.12, 0.16, 0.2))
    tyre = cylinder(0.1, (0, 0.11, 0.05), (0, 0.15, 0.05)) + cylinder(0.01, (0, 0.01, 0.05), (0, 0.12, 0.05))
    joint = turning("body", "wheel", Y, (0.0, 0.13, 0.05), (-np.inf, np.inf))
    return scene_of(known_object("cart", {"body": block + guard, "wheel": tyre}, joint), "wheel")


@pytest.mark.parametrize("gap", [0.01, -0.002])
def test_a_wheel_goes_round_even_where_its_tyre_stands_in_the_mudguard(gap: float) -> None:
    free = np.full(2, np.pi if gap > 0.0 else 0.3)
    assert is_continuous(wheel(gap), Y, np.array([0.0, 0.13, 0.05]), free)


def test_a_door_does_not() -> None:
    shell = box((0, 0, 0), (0.6, 0.5, 0.8)) - box((0.02, -1, 0.02), (0.58, 0.48, 0.78))
    joint = turning("shell", "door", -Z, (0.0, -0.01, 0.4), (0.0, 1.6))
    known = known_object("cabinet", {"shell": shell, "door": box((0, -0.021, 0), (0.6, -0.001, 0.8))}, joint)
    assert not is_continuous(scene_of(known, "door"), -Z, np.array([0.0, -0.01, 0.4]), np.array([3.0, 0.0]))


def test_the_weights_are_of_the_recipe() -> None:
    shipped = shipped_scorer(TURNING_WEIGHTS)
    assert shipped.provenance["recipe"] == turning_recipe_key(shipped.measurements)
