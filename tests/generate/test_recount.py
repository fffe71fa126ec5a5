"""Another number of alike parts than usual: each moves by itself, meets nothing and hangs on something."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.generate.composer.recount import recounted
from kinematify.generate.procedural.clearance import DEEP, depth_of, solid_of
from kinematify.generate.sentence import from_text


@pytest.mark.parametrize(
    ("sentence", "noun", "count"),
    [
        ("a grand piano with three pedals", "pedal", 3),  # side by side, of one
        ("an upright piano with three pedals", "pedal", 3),  # in their row, of two
        ("a retort stand with two clamps", "clamp", 2),  # on its rod
        ("a wheelbarrow with two wheels", "wheel", 2),  # on one axle
    ],
)
def test_so_many_are_built_as_are_asked_for(sentence: str, noun: str, count: int) -> None:
    made = from_text(sentence).made()
    assert made.not_built == ()
    joints = [joint for joint in made.blueprint.joints if joint.child.startswith(noun)]
    assert len(joints) == count
    solids = {part.name: solid_of(part) for part in made.blueprint.parts}
    for joint in joints:
        assert max(depth_of(solids[joint.child], solids[name]) for name in solids if name != joint.child) < DEEP
        assert solids[joint.child].min_gap(solids[joint.parent], 0.1) < 0.02
    middles = np.array([solids[joint.child].bounding_box() for joint in joints])
    assert len(np.unique(middles.round(4), axis=0)) == count


@pytest.mark.parametrize(
    ("sentence", "listed"),
    [
        ("a fire hydrant with three caps", "three caps (2 built)"),  # the third would be in the middle of it
        ("a coffee table with a lift-up top and two drawers", "two drawers (1 built)"),  # it would stand out
        ("a pushchair with three wheels", "three wheels (4 built)"),
    ],
)
def test_what_has_no_place_is_listed(sentence: str, listed: str) -> None:
    assert listed in from_text(sentence).made().not_built


def test_chained_parts_keep_their_number() -> None:
    made = from_text("a four-bar linkage").build()
    with pytest.raises(InputError, match="not alike"):
        recounted(made, ["crank"], 2)


def test_an_object_on_wheels_keeps_its_own_parts():
    made = from_text("a barbecue with two wheels").build()
    assert {"lid", "wheel_1", "wheel_2"} <= {joint.child for joint in made.joints}
