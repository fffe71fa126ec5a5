"""Sizes of parts, heights above the floor, one part unlike its siblings, and how a joint answers to a push."""

from __future__ import annotations

import numpy as np
import pytest

from kinematify.errors import InputError
from kinematify.generate.sentence import from_text


@pytest.mark.parametrize(
    ("sentence", "stem", "axis", "metres"),
    [
        ("a chest of drawers with four drawers, each 15 cm high", "drawer", 2, 0.15),
        ("a wheelbarrow with a wheel of 40 cm diameter", "wheel", 2, 0.4),
        ("a desk with 60 cm wide drawers", "drawer", 0, 0.6),
    ],
)
def test_parts_are_as_large_as_is_said(sentence: str, stem: str, axis: int, metres: float) -> None:
    made = from_text(sentence).made()
    sizes = [np.ptp(part.bounds, axis=0)[axis] for part in made.blueprint.parts if part.name.startswith(stem)]
    assert made.not_built == ()
    assert np.allclose(sizes, metres, rtol=0.02)


@pytest.mark.parametrize(
    ("sentence", "listed"),
    [
        ("a garden gate with a 40 cm long handle", "40 cm long"),
        ("a lathe with a carriage with 60 cm of travel", "60 cm of travel"),
        ("a kitchen cabinet with spring-loaded doors", "spring loaded (joints have no springs)"),
        ("a bathroom cabinet with a mirror on the middle door", "middle door"),
        ("a folding workbench", "folding (no part does)"),
        ("a cabinet that you can fold away", "fold"),
    ],
)
def test_what_has_no_effect_is_listed(sentence: str, listed: str) -> None:
    assert listed in "; ".join(from_text(sentence).made().not_built)


def test_a_range_of_heights_says_where_it_begins() -> None:
    made = from_text("a standing desk that goes up from 65 cm to 100 cm").made()
    joint = made.blueprint.joint_above["top"]
    assert made.not_built == ()
    assert np.isclose(np.ptp(made.blueprint.assembly.bounds, axis=0)[2], 0.65, rtol=0.02)
    assert np.isclose(joint.upper - joint.lower, 0.35)


def test_one_of_several_objects_may_be_unlike_the_others() -> None:
    made = from_text("three blue lockers, only the middle one has a red door").made().blueprint
    doors = sorted((part for part in made.parts if "door" in part.name), key=lambda part: part.bounds[0, 0])
    assert [part.color == doors[1].color for part in doors] == [False, True, False]


@pytest.mark.parametrize("sentence", ["a trunk whose lid stays open", "a toilet with a soft-close seat"])
def test_joints_stay_where_they_are_and_are_damped(sentence: str) -> None:
    assert from_text(sentence).made().not_built == ()


def test_pull_out_shelves_are_not_pulled_out() -> None:
    made = from_text("a wine fridge with six pull-out shelves").made()
    assert made.not_built == ()
    assert not any(joint.value for joint in made.blueprint.joints)


@pytest.mark.parametrize(
    ("sentence", "words"),
    [
        ("a three-legged stool that stands on exactly four legs", "two counts"),
        ("a one-armed desk lamp with three arms", "two counts"),
        ("a pedal bin whose lid opens by 40 degrees at most, standing open at 75 degrees", "it goes by 40 degrees"),
        ("a cabinet with two drawers, the third one open", "only 2 drawers"),
        ("a doorless wardrobe with two doors", "no door"),
        ("a fixed door that swings open", "what is fixed"),
        ("a locked cabinet with its door wide open", "what is locked"),
        ("a closed box with its lid open at 90 degrees", "what is closed"),
        ("a bookcase 80 cm wide with two doors that are each 70 cm wide, side by side", "80 cm wide"),
        ("a bookcase 50 cm high with three drawers on top of each other, each drawer 20 cm high", "50 cm high"),
    ],
)
def test_contradictions_are_refused(sentence: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        from_text(sentence).made()


@pytest.mark.parametrize(
    ("sentence", "of"),
    [
        ("a cabinet with two doors, a knob on the left door and a bar handle on the right one", ["knob", "bar handle"]),
        ("a cabinet with two doors, the right one without a handle", [None, "none"]),
        ("a cabinet with two doors, the left one with a brass knob", ["knob brass", None]),
    ],
)
def test_each_front_has_its_own_handle(sentence: str, of: list[str | None]) -> None:
    made = from_text(sentence).made()
    assert made.not_built == ()
    for name, handle in zip(("door_1", "door_2"), of, strict=True):
        assert made.blueprint.parameters.get(f"handle of {name}") == handle
    left, right = (part for part in made.blueprint.parts if part.name.startswith("door"))
    assert len(left.vertices) != len(right.vertices), "mirror images have as many"


@pytest.mark.parametrize(
    ("sentence", "listed"),
    [
        ("a bed with storage drawers underneath, two on each side", "on each side"),
        ("a cabinet with two doors, only one can be opened", "only (every door does)"),
        ("a cabinet with two doors, opening inwards", "opening inwards"),
        ("a wall cabinet whose doors open upwards", "open upwards"),
        ("a toolbox that opens on both sides", "on both sides"),
        ("a cabinet with two doors, and it turns", "turns"),
        ("a cabinet with two doors, tilted by 10 degrees", "tilted"),
        ("an office chair which folds flat", "folds"),
        ("a desk with a drawer deeper than the others", "than"),
    ],
)
def test_a_phrase_that_changes_nothing_is_listed(sentence: str, listed: str) -> None:
    assert listed in "; ".join(from_text(sentence).made().not_built)


def test_what_a_part_moves_and_where_a_part_is_may_be_said_first() -> None:
    sentence = (
        "a pillar drill with a table that goes up and down by 35 cm and, on the right side, "
        "a lever that lowers the chuck by 8 cm"
    )
    made = from_text(sentence).made()
    ways = [joint.upper - joint.lower for joint in made.blueprint.joints if not joint.kind.turns]
    assert made.not_built == ()
    assert all(np.isclose(ways, metres).any() for metres in (0.08, 0.35))
