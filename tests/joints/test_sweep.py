"""The virtual motion test against motions whose stops are known."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.generate.procedural.solids import box
from kinematify.joints.features.motion_test import moving_points, slide_paths, turn_paths
from tests.joints.joint_scenes import CONFIG, scene_of
from tests.known import known_object, sliding
from tests.objects import BUILDERS

SWEEP = CONFIG.joints.sweep


def wall_in_front(distance: float) -> object:
    """A cube on a floor with a wall at `distance` along x."""
    room = box((-1, -1, -0.2), (1, 1, -0.001)) + box((0.1 + distance, -1, -0.1), (0.15 + distance, 1, 1))
    return known_object(
        "walled",
        {"room": room, "cube": box((-0.1, -0.1, 0), (0.1, 0.1, 0.2))},
        sliding("room", "cube", (1, 0, 0), (0, 0, 0), (0.0, distance)),
    )


@pytest.mark.parametrize("distance", [0.05, 0.2, 0.5])
def test_a_slide_stops_at_the_wall(distance: float) -> None:
    scene = scene_of(wall_in_front(distance), "cube")
    points = moving_points(scene)
    axes = np.array([[1.0, 0.0, 0.0]])
    paths = slide_paths(scene.cache, points, axes, limit=1.5, config=SWEEP)
    free = paths.against((scene.parent,)).free(SWEEP.share)[0]
    assert free[0] == pytest.approx(distance, abs=0.01)
    assert free[1] == 1.5


def test_an_open_shell_stops_motion_as_a_solid_does() -> None:
    known = wall_in_front(0.3)
    scene = scene_of(known, "cube")
    points = moving_points(scene)
    # The wall is entered through its front face alone, so faces behind it do not matter.
    hits = scene.cache.first_hits(scene.parent, points, np.tile([0.8, 0.0, 0.0], (len(points), 1)))
    assert np.isfinite(hits).all()


def test_a_door_opens_outwards_and_not_inwards() -> None:
    known = BUILDERS["edge_door"]()
    scene = scene_of(known, known.joints[0].child)
    joint = known.joints[0]
    points = moving_points(scene)
    paths = turn_paths(scene.cache, points, joint.axis[None], joint.pivot[None], limit=np.pi / 2, config=SWEEP)
    outwards, inwards = paths.against((scene.parent,)).free(SWEEP.share)[0]
    assert outwards > np.radians(80.0)
    assert inwards < np.radians(10.0)
