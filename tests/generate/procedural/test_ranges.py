"""Ranges that a sentence asks for: a joint goes farther only where nothing is in its way and its guide holds it."""

from __future__ import annotations

import math

import pytest

from kinematify.errors import InputError
from kinematify.generate.described import known_families
from kinematify.generate.procedural.clearance import DEEP, depth_of, may_go, moving_with, solid_of
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.language.parts import opened
from kinematify.generate.sentence import from_text


def _range(sentence: str, part: str) -> tuple[float, float]:
    made = from_text(sentence).made(seed=0)
    assert made.not_built == ()
    joint = next(joint for joint in made.blueprint.joints if joint.child.startswith(part))
    return joint.lower, joint.upper


@pytest.mark.parametrize(
    ("sentence", "part", "low", "high"),
    [
        ("a fridge whose door opens by 170 degrees", "door", 0, 170),
        ("a chest with a lid that can be opened by 100 degrees", "lid", 0, 100),
        ("a microwave whose door swings out by 160 degrees", "door", 0, 160),
        ("a tricycle whose handlebar turns by 45 degrees to either side", "handlebar", -45, 45),
        ("a gate that swings through 120 degrees", "leaf", 0, 120),
        ("a barstool whose seat turns by 90 degrees", "seat", -45, 45),
        ("a paper cutter with an arm that swings up by 40 degrees", "arm", 0, 40),
    ],
)
def test_a_turn_goes_as_far_as_a_sentence_says(sentence: str, part: str, low: float, high: float) -> None:
    assert _range(sentence, part) == pytest.approx((math.radians(low), math.radians(high)))


@pytest.mark.parametrize(
    ("sentence", "part", "way"),
    [
        ("a cabinet with two drawers that slide out 50 cm", "drawer", 0.5),
        ("a bench vice that opens by 15 cm", "jaw", 0.15),
        ("a syringe whose plunger travels 6 cm", "plunger", 0.06),
        ("a barn door, 2.1 m high, that slides 1.2 m to the left", "leaf", 1.2),
    ],
)
def test_an_object_is_large_enough_for_its_slides(sentence: str, part: str, way: float) -> None:
    lower, upper = _range(sentence, part)
    assert upper - lower == pytest.approx(way)


@pytest.mark.parametrize(
    "sentence",
    ["a cabinet, 40 cm deep, with two drawers that slide out 50 cm", "a garage door that goes up 3 m"],
)
def test_a_way_that_is_not_built_is_listed(sentence: str) -> None:
    assert any("it goes" in words for words in from_text(sentence).made(seed=0).not_built)


def test_a_joint_goes_no_farther_than_into_what_stands_there() -> None:
    made = build(known_families()["fridge"], {})
    joint = next(joint for joint in made.joints if joint.child.startswith("door"))
    assert may_go(made, joint.child, 0.0, math.radians(150))
    assert not may_go(made, joint.child, 0.0, math.radians(300))
    with pytest.raises(InputError, match="does not go so far"):
        opened(made, [joint.child], "range", math.radians(300))
    solids = {part.name: solid_of(part) for part in made.moved({joint.child: math.radians(300)}).parts}
    still = set(solids) - moving_with(joint.child, made.joints)
    assert max(depth_of(solids[joint.child], solids[name]) for name in still) > DEEP


def test_a_slide_stays_in_its_guide() -> None:
    made = build(known_families()["cabinet"], {"drawers": 2})
    joint = next(joint for joint in made.joints if joint.child.startswith("drawer"))
    assert may_go(made, joint.child, joint.lower, 1.02 * joint.upper)
    assert not may_go(made, joint.child, joint.lower, 2.0 * joint.upper)


@pytest.mark.parametrize("sentence", ["a gate open by 40 degrees", "a door with a lever handle, open by 40 degrees"])
def test_the_leaf_stands_open_and_not_its_handle(sentence: str) -> None:
    made = from_text(sentence).made()
    assert made.not_built == ()
    above = made.blueprint.joint_above
    assert above["leaf_1"].value == pytest.approx(math.radians(40))
    assert above["handle_1"].value == 0.0
