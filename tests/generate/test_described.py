"""Objects that files describe: sentences find them, and their parts move freely."""

from __future__ import annotations

import math
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from manifold3d import Manifold, Mesh64

import kinematify
from kinematify.errors import InputError
from kinematify.generate.described import ObjectDescription, known_families, library
from kinematify.generate.families import FAMILIES
from kinematify.generate.procedural.blueprint_file import described_blueprint
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.materials import COLORS
from kinematify.generate.procedural.parameter import read_table
from kinematify.generate.sentence import from_text
from kinematify.robot.joint_type import JointType
from tests.sentences import said_of

DESCRIBED = sorted(set(known_families()) - set(FAMILIES))


def solid_of(part):
    return Manifold(Mesh64(vert_properties=np.array(part.vertices), tri_verts=np.array(part.faces, dtype=np.uint64)))


def overlaps(blueprint):
    """Pairs of parts that share more than a cubic millimetre."""
    solids = {part.name: solid_of(part) for part in blueprint.parts}
    return [(a, b) for a, b in combinations(solids, 2) if (solids[a] ^ solids[b]).volume() > 1e-9]


IN_STEPS = [name for name in DESCRIBED if library()[name].draw]
SAMPLE = [name for name in DESCRIBED if name not in IN_STEPS] + [name for name in IN_STEPS if not library()[name].like][
    ::9
]
COUNTED = [
    (name, {parameter.name: int(bound)})
    for name in DESCRIBED
    if name not in IN_STEPS
    for parameter in known_families()[name].parameters
    for bound in parameter.bounds
    if bound != parameter.default
]


@pytest.mark.parametrize(("name", "given"), [*((name, {}) for name in SAMPLE), *COUNTED])
def test_parts_move_freely_to_both_ends(name, given):
    blueprint = build(known_families()[name], given)
    assert blueprint.joints
    assert not overlaps(blueprint)
    for joint in blueprint.joints:
        for value in (joint.lower, joint.upper) if np.isfinite(joint.upper) else (1.0, 4.0):
            assert not overlaps(blueprint.moved({joint.child: value})), (joint.child, value)


def test_a_follower_has_the_range_that_its_leader_asks_for():
    """A leader that goes beyond what its follower may do is stopped by it, or stops it, in an engine."""
    narrow, followers = [], 0
    for name, family in known_families().items():
        if family.draw and "follow" not in family.draw.__code__.co_names:
            continue
        joints = {joint.child: joint for joint in build(family, {}).joints}
        for follower in joints.values():
            if follower.mimic is None:
                continue
            followers += 1
            leader, rule = joints[follower.mimic.joint], follower.mimic
            asked = [rule.multiplier * end + rule.offset for end in (leader.lower, leader.upper)]
            if min(asked) < follower.lower - 1e-6 or max(asked) > follower.upper + 1e-6:
                narrow.append(f"{name}: {follower.child} follows {leader.child}")
    assert followers > 10
    assert not narrow


def test_no_yaml_of_the_package_is_a_program():
    verbs = {"let", "for", "when", "define", "call", "give", "do"}

    def keys(said):
        items = said.values() if isinstance(said, dict) else said if isinstance(said, list) else ()
        return {*(said if isinstance(said, dict) else ()), *(key for item in items for key in keys(item))}

    for file in Path(kinematify.__file__).parent.rglob("*.yaml"):
        assert "composer" in file.parts or not verbs & keys(read_table(file)), file


def test_a_drawn_object_has_the_size_that_is_asked_for():
    built = build(known_families()["standing_desk"], {"width": 1.4, "height": 0.7})
    assert np.ptp(built.assembly.bounds[:, 0]) == pytest.approx(1.4)
    with pytest.raises(InputError, match="must be a number from 1 to"):
        build(known_families()["standing_desk"], {"width": 40.0})


def test_no_word_names_two_families():
    words = [word for family in known_families().values() for word in family.words]
    assert sorted(words) == sorted(set(words))


def test_a_sentence_may_say_how_it_looks_and_what_it_has():
    bicycle = from_text("a red bicycle with two wheels, 1.2 m high").build()
    assert bicycle.parts[0].color == COLORS["red"]
    assert np.ptp(bicycle.assembly.bounds[:, 2]) == pytest.approx(1.2)
    assert from_text("a wheelbarrow with two handles").build().family == "wheelbarrow"
    for sentence in ("a bicycle with three wheels", "a wheelbarrow with three handles", "a bicycle with a rudder"):
        assert said_of(sentence), sentence


def test_sizes_of_parts_without_a_number_are_reported():
    made = from_text("a wheelchair with two big wheels and two small casters").made()
    assert made.specification.harmless == ("big wheels", "small casters")
    assert made.blueprint.family == "wheelchair"


def test_what_changes_nothing_is_reported():
    request = from_text("a sleek retro-style pocket knife for my grandfather")
    assert request.family == "pocket_knife"
    assert request.made().specification.harmless == ("sleek", "retro-style", "for my grandfather")
    assert said_of("a sleek retro-style pocket knife for my grandfather") == ""
    assert "6 bottles" in said_of("a cabinet for 6 bottles")


@pytest.mark.parametrize("sentence", ["a cabinet for a sliding drawer", "a cabinet for two drawers"])
def test_a_purpose_that_names_a_mechanism_is_asked_for(sentence: str) -> None:
    joints = from_text(sentence).build(seed=0).joints
    assert any(joint.kind is JointType.PRISMATIC for joint in joints)


def test_a_purpose_that_asks_for_a_lid_is_not_dropped() -> None:
    assert from_text("a box to hold a hinged lid").specifications[0].harmless == ()


def test_copies_take_along_what_they_carry() -> None:
    caster = {"name": "caster_1", "shapes": [{"kind": "box", "size": [0.02, 0.02, 0.1], "xyz": [0.2, 0.1, 0.1]}]}
    wheel = {"name": "caster_1_wheel", "shapes": [{"kind": "sphere", "radius": 0.03, "xyz": [0.2, 0.15, 0.04]}]}
    turn = {"type": "revolute", "lower": -0.1, "upper": 1.0}
    described = ObjectDescription.model_validate(
        {
            "name": "cart",
            "title": "cart",
            "words": ["cart"],
            "parts": [{"name": "board", "shapes": [{"kind": "box", "size": [1, 1, 0.1]}]}, caster, wheel],
            "joints": [
                {**turn, "parent": "board", "child": "caster_1", "axis": [0, 0, 1], "pivot": [0.2, 0.1, 0]},
                {**turn, "parent": "caster_1", "child": "caster_1_wheel", "axis": [1, 0, 0], "pivot": [0.2, 0.15, 0]},
            ],
            "copies": [{"like": "caster_1", "mirrored": "x"}, {"like": "caster_1", "around": 2}],
        }
    )
    made = build(described.family(), {})
    above = made.joint_above
    assert set(above) == {f"caster_{k}{part}" for k in (1, 2, 3) for part in ("", "_wheel")}
    assert above["caster_2_wheel"].parent == "caster_2"
    assert np.allclose(above["caster_2"].axis, [0, 0, -1]), "it swings the other way"
    assert np.allclose(above["caster_2_wheel"].axis, [1, 0, 0]), "it rolls the same way"
    assert np.allclose(above["caster_2"].pivot, [-0.2, 0.1, 0])
    assert np.allclose(above["caster_3"].pivot, [-0.2, -0.1, 0])
    assert np.allclose(made.parts[-1].bounds.mean(axis=0), [-0.2, -0.15, 0.04])


@pytest.mark.parametrize(
    ("sentence", "stem", "number"),
    [
        ("a drone with six propellers", "propeller", 6),
        ("a ferris wheel with eight cabins", "cabin", 8),
        ("a wheelbarrow with two wheels", "wheel", 2),
        ("a two wheeled wheelbarrow", "wheel", 2),
        ("an iv stand with four casters and two hooks", "caster", 4),
        ("a swing set with two seats", "seat", 2),
    ],
)
def test_parts_that_repeat_are_as_many_as_a_sentence_says(sentence: str, stem: str, number: int) -> None:
    made = from_text(sentence).build()
    named = [part for part in made.parts if part.name.rstrip("0123456789_") == stem]
    assert len(named) == number
    middles = np.array([part.bounds.mean(axis=0) for part in named])
    gaps = np.linalg.norm(middles[:, None] - middles, axis=2) + np.eye(number) * 1e9
    np.testing.assert_allclose(gaps.min(axis=0), gaps.min(), rtol=0.03, err_msg="evenly")


def test_shapes_that_repeat_are_as_many_as_a_sentence_says() -> None:
    def volume(sentence: str) -> float:
        part = next(part for part in from_text(sentence).build().parts if part.name == "rotor")
        return float(solid_of(part).volume())

    three, four, five = (volume(f"a helicopter with {count} blades") for count in ("three", "four", "five"))
    assert four - three == pytest.approx(five - four, rel=0.02)
    assert four - three == pytest.approx(0.37 * 0.04 * 0.006, rel=0.1)


@pytest.mark.parametrize(
    "sentence", ["a wheelbarrow with four wheels", "a drone with no rotors", "a ladder with 40 steps"]
)
def test_counts_that_cannot_be_built_are_refused(sentence: str) -> None:
    assert " from " in said_of(sentence)


@pytest.mark.parametrize(
    "part", ["two of which are red", "two of them red", "and 2 of them are red", "with two of them being red"]
)
def test_some_of_several_may_look_otherwise(part: str) -> None:
    made = from_text(f"a dresser with six drawers, {part}").build()
    colors = [item.color for item in made.parts if item.name.startswith("drawer")]
    assert (len(colors), colors.count(COLORS["red"])) == (6, 2)


@pytest.mark.parametrize(
    ("part", "red"),
    [
        ("the middle one red", {2}),
        ("the second one from the top red", {2}),
        ("the third one is red", {3}),
        ("all but one red", {1, 2}),
        ("one red and two white", {1}),
        ("the top two red", {1, 2}),
    ],
)
def test_one_of_several_is_found_by_its_place(part: str, red: set[int]) -> None:
    made = from_text(f"a cabinet with three drawers, {part}").made()
    assert not made.not_built
    colors = {item.name: item.color for item in made.blueprint.parts}
    assert {k for k in (1, 2, 3) if colors[f"drawer_{k}"] == COLORS["red"]} == red


def test_a_castor_is_one_with_its_wheel() -> None:
    made = from_text("an office chair on five castors, two of which are red").build()
    red = [part.name for part in made.parts if part.color == COLORS["red"]]
    assert sorted(red) == ["castor_1", "castor_2", "wheel_1", "wheel_2"]


def test_a_range_of_both_ways_is_limited_on_both_sides() -> None:
    made = from_text("a metronome whose pendulum swings 20 degrees either way").made()
    joint = made.blueprint.joint_above["pendulum"]
    assert not made.not_built
    assert (joint.lower, joint.upper) == (pytest.approx(-math.radians(20)), pytest.approx(math.radians(20)))


@pytest.mark.parametrize(
    ("sentence", "listed"),
    [
        ("a cart with three wheels at the front and one at the back", "at the front (2 built)"),
        ("a cabinet with two doors on a red wall", "red"),
        ("a cupboard with one door in front of three drawers", "in front of three drawers (elsewhere)"),
        ("a metal toolbox with two trays that swing out", "swing (prismatic)"),
        ("a box with a lid hinged at the front", "hinged front (hinged on another side)"),
        ("a cart with four wheels, two of them swivel", "swivel (continuous)"),
        ("a filing cabinet with three drawers and four casters inside it", "inside it (elsewhere)"),
        ("a cabinet with two doors and a fan inside", "inside (elsewhere)"),
        ("a cabinet with four drawers of different sizes", "of different sizes"),
        ("a whiteboard on four wheels between the hinges", "between the hinges (no hinge)"),
    ],
)
def test_what_is_otherwise_than_it_was_said_is_listed(sentence: str, listed: str) -> None:
    assert listed in "; ".join(from_text(sentence).made().not_built)


def test_more_than_there_are_cannot_look_otherwise() -> None:
    with pytest.raises(InputError, match="there are only 2 drawers"):
        from_text("a cabinet with two drawers, five of which are blue").made()


def test_a_count_without_a_description_is_refused() -> None:
    shape = {"kind": "sphere", "radius": 0.03, "repeated": {"count": "blade"}}
    parts = [{"name": "body", "shapes": [shape]}, {"name": "rotor", "shapes": [{**shape, "xyz": [0, 0, 1]}]}]
    joints = [{"type": "continuous", "parent": "body", "child": "rotor"}]
    described = {"name": "fan", "title": "fan", "words": ["fan"], "parts": parts, "joints": joints}
    with pytest.raises(ValueError, match="no count 'blade'"):
        ObjectDescription.model_validate(described)
    with pytest.raises(InputError, match="'blade' is no number"):
        described_blueprint({"name": "fan", "parts": parts, "joints": joints})


def test_a_colour_that_is_asked_for_is_that_of_the_base() -> None:
    assert from_text("a blue tractor").build().parts[0].color == COLORS["blue"]


@pytest.mark.parametrize(
    ("sentence", "what", "carriers"),
    [
        ("a wardrobe with two doors and a mirror on the left door", "mirror", {"door_1"}),
        ("a locker with three doors and vents in each door", "vent", {"door_1", "door_2", "door_3"}),
        ("a fridge with a nameplate on the door", "nameplate", {"door_1"}),
        ("a cabinet with two doors, each with a window", "window", {"door_1", "door_2"}),
        ("a tool chest with two drawers, all with locks", "lock", {"drawer_1", "drawer_2"}),
        ("a cabinet with three drawers, of which the lowest is lockable", "lock", {"drawer_3"}),
        ("a locker with two doors, each with a vent and a nameplate", "nameplate", {"door_1", "door_2"}),
    ],
)
def test_what_a_kind_has_not_is_put_on_the_part_that_is_named(sentence: str, what: str, carriers: set[str]) -> None:
    made = from_text(sentence).made(seed=0)
    assert made.not_built == ()
    plates = [joint for joint in made.blueprint.joints if joint.child.startswith(what)]
    assert {joint.parent for joint in plates} == carriers
    for plate in plates:  # it goes with its carrier, and nothing is in its way
        far = made.blueprint.moved({plate.parent: made.blueprint.joint_above[plate.parent].upper})
        solids = {part.name: solid_of(part) for part in far.parts}
        assert (
            max((solids[plate.child] ^ other).volume() for name, other in solids.items() if name != plate.child) < 1e-9
        )
