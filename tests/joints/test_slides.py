"""Directions of sliding joints."""

from __future__ import annotations

import numpy as np
import pytest

from tests.joints.joint_scenes import ranked_slides, scene_of
from tests.objects import BUILDERS, with_yaw


@pytest.mark.parametrize("yaw", [0.0, 0.6])
@pytest.mark.parametrize("name", ["drawer", "sliding_lid", "square_lift"])
def test_the_true_direction_wins(name: str, yaw: float) -> None:
    known = with_yaw(BUILDERS[name](), yaw)
    joint = known.joints[0]
    ranked = ranked_slides(scene_of(known, joint.child))
    assert abs(float(ranked.axes[0] @ joint.axis)) > np.cos(np.radians(1.0))


def test_a_drawer_leaves_by_the_front_and_stops_at_the_back() -> None:
    known = BUILDERS["drawer"]()
    ranked = ranked_slides(scene_of(known, "drawer"))
    out, back = ranked.free_parent[0] if ranked.axes[0] @ known.joints[0].axis > 0 else ranked.free_parent[0][::-1]
    assert out > 0.3
    assert back < 0.05
