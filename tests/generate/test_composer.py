"""Mechanisms placed on bodies: what a sentence asks for is there, moves freely, and nothing else is."""

from __future__ import annotations

import time
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from manifold3d import Manifold, Mesh64

from kinematify.errors import InputError
from kinematify.generate.composer.bodies import BODIES
from kinematify.generate.composer.body_sentence import sentence_of
from kinematify.generate.composer.compose import compose, draw_composition
from kinematify.generate.composer.placed_mechanisms import MECHANISMS
from kinematify.generate.procedural.materials import COLORS
from kinematify.generate.sentence import from_text
from kinematify.robot.joint_type import JointType
from tests.sentences import said_of

CART = "a cart with four casters, a push handle and two drawers"
TRUCK = "a pickup truck with four wheels, two doors and an opening tailgate"
BOX = "a control box with a crank, a gauge needle and nine buttons"


def composed(sentence):
    """The composition that a sentence asks for."""
    return from_text(sentence).plan.request.composition


def solids_of(blueprint):
    return {
        part.name: Manifold(
            Mesh64(vert_properties=np.array(part.vertices), tri_verts=np.array(part.faces, dtype=np.uint64))
        )
        for part in blueprint.parts
    }


def overlaps(blueprint):
    """Pairs of parts that share more than a cubic millimetre."""
    solids = solids_of(blueprint)
    return [(a, b) for a, b in combinations(solids, 2) if (solids[a] ^ solids[b]).volume() > 1e-9]


def ends_of(joint):
    return (joint.lower, joint.upper) if np.isfinite(joint.upper) else (1.0, 4.0)


@pytest.mark.parametrize(
    ("sentence", "counts"),
    [
        (CART, {JointType.CONTINUOUS: 8, JointType.PRISMATIC: 2}),
        (TRUCK, {JointType.CONTINUOUS: 4, JointType.REVOLUTE: 3}),
        (BOX, {JointType.CONTINUOUS: 1, JointType.REVOLUTE: 1, JointType.PRISMATIC: 9}),
        ("a toolbox with a lid and a carrying handle", {JointType.REVOLUTE: 2}),
        ("a crate with a carrying handle", {JointType.REVOLUTE: 1}),
        ("a column with a folding arm and a crank", {JointType.REVOLUTE: 2, JointType.CONTINUOUS: 1}),
        ("a platform with four wheels and a telescopic mast", {JointType.CONTINUOUS: 4, JointType.PRISMATIC: 1}),
        ("a toolbox with two cantilever trays and a handle", {JointType.REVOLUTE: 7}),
        ("a scissor lift on four wheels", {JointType.REVOLUTE: 5, JointType.CONTINUOUS: 4}),
        ("a cabinet with a gripper, three hooks and two pedals", {JointType.PRISMATIC: 2, JointType.REVOLUTE: 5}),
        ("a van with two front doors and two back doors", {JointType.CONTINUOUS: 4, JointType.REVOLUTE: 4}),
        ("a standing desk that goes up and down", {JointType.PRISMATIC: 1}),
        ("a bar stool", {JointType.CONTINUOUS: 1}),
        ("a mailbox with a red flag and a latch", {JointType.REVOLUTE: 3}),
        ("a remote control with six buttons and two sliders", {JointType.PRISMATIC: 8}),
        ("an oven with a door and a drawer", {JointType.REVOLUTE: 1, JointType.PRISMATIC: 1}),
        ("a toy fire truck with six wheels and a ladder on top", {JointType.CONTINUOUS: 6, JointType.REVOLUTE: 1}),
        ("a car with two doors, a hood and a trunk", {JointType.CONTINUOUS: 4, JointType.REVOLUTE: 4}),
        ("a garage with a roll-up door", {JointType.PRISMATIC: 1}),
        ("a workbench with a vise, a drawer and a towel rail", {JointType.PRISMATIC: 2}),
        ("a wooden chest with a lid and two carrying handles", {JointType.REVOLUTE: 3}),
        ("a toolbox with a drawer and a lid", {JointType.PRISMATIC: 1, JointType.REVOLUTE: 1}),
        ("a lorry with six wheels and two doors", {JointType.CONTINUOUS: 6, JointType.REVOLUTE: 2}),
        ("a fridge of 180 cm with a sliding door on the right and three drawers", {JointType.PRISMATIC: 4}),
    ],
)
def test_what_is_asked_for_is_built_and_moves_freely(sentence, counts):
    blueprint = from_text(sentence).build()
    kinds = [joint.kind for joint in blueprint.joints if joint.kind is not JointType.FIXED]
    assert {kind: kinds.count(kind) for kind in set(kinds)} == counts
    assert not overlaps(blueprint)
    assert all(len(solid.decompose()) == 1 for solid in solids_of(blueprint).values())
    for joint in blueprint.joints:
        for value in ends_of(joint):
            assert not overlaps(blueprint.moved({joint.child: value})), (joint.child, value)


def test_bars_of_a_closed_chain_stay_on_their_pin():
    blueprint = from_text("a toolbox with two cantilever trays").build()
    assert len(blueprint.loops) == 2
    # A loop is carried along by the first of its parts: seen from the other one it must be at the same place.
    turned = replace(blueprint, loops=tuple(replace(item, one=item.other, other=item.one) for item in blueprint.loops))
    for share in (0.3, 0.7, 1.0):
        values = {joint.child: share * joint.upper for joint in blueprint.joints if joint.mimic is None}
        pairs = zip(blueprint.moved(values).loops, turned.moved(values).loops, strict=True)
        for from_one, from_other in pairs:
            assert np.linalg.norm(from_one.pivot - blueprint.loops[0].pivot) > 1e-3
            np.testing.assert_allclose(from_one.pivot, from_other.pivot, atol=1e-12)


def test_a_lifted_platform_stays_level_above_its_base():
    blueprint = from_text("a scissor lift").build()
    up = blueprint.moved({"arm_0": blueprint.joint_above["arm_0"].upper})
    before, after = (made.parts[-1].vertices for made in (blueprint, up))
    rise = after - before
    np.testing.assert_allclose(rise, np.broadcast_to([0.0, 0.0, rise[0, 2]], rise.shape), atol=1e-9)
    assert rise[0, 2] > 0.3


def test_a_sliding_door_covers_the_half_that_is_said():
    for side, sign in (("left", -1.0), ("right", 1.0)):
        blueprint = from_text(f"a cabinet with a sliding door on the {side}").build()
        assert sign * blueprint.parts[1].bounds.mean(axis=0)[0] > 0.1
        assert sign * blueprint.joints[0].axis[0] < 0.0, "it slides to the other half"


def test_a_toy_is_small():
    shed, toy = (from_text(f"{article} shed with a door").build() for article in ("a", "a toy"))
    assert np.ptp(toy.assembly.bounds, axis=0).max() < 0.3 * np.ptp(shed.assembly.bounds, axis=0).max()
    assert not overlaps(toy)


@pytest.mark.parametrize(
    "sentence", ["a toy " * 1600 + "car", "a cabinet with " + "a and on " * 1100, "toy and on a " * 20]
)
def test_long_texts_are_refused_at_once(sentence):
    start = time.process_time()
    with pytest.raises(InputError):
        from_text(sentence)
    assert time.process_time() - start < 5.0


def test_what_opens_is_not_taken_for_what_is_open():
    assert "open" in said_of("a shed with a door and two windows that open")
    assert from_text("a shed with a window and a door, half open").build().joints[0].value > 0.0


def test_two_sliding_doors_pass_each_other():
    blueprint = from_text("a kiosk with two sliding doors").build()
    left, right = (part.bounds for part in blueprint.parts[1:])
    assert left[:, 2] == pytest.approx(right[:, 2]), "side by side"
    assert left[1, 0] < right[0, 0]
    for values in ({"sliding_door_1": 0.9}, {"sliding_door_2": 0.9}, {"sliding_door_1": 0.5, "sliding_door_2": 0.5}):
        reach = {joint.child: joint.upper for joint in blueprint.joints}
        assert not overlaps(blueprint.moved({name: share * reach[name] for name, share in values.items()}))


def test_how_parts_move_is_read_against_what_is_built():
    for said in (
        "a flap that folds down",
        "a flap that can be lowered",
        "two flaps that open downwards",
        "a lid that lifts",
    ):
        assert from_text(f"a printer with {said}").build().joints, said
    for said in ("a flap that slides", "a flap that opens upwards", "a drawer that turns", "a lid that spins"):
        assert said_of(f"a printer with {said}"), said
    flag = from_text("a mailbox with a flag that can be raised").build()
    raised = next(part for part in flag.moved({"flag_1": 1.0}).parts if part.name == "flag_1")
    assert raised.bounds[1, 2] > next(part for part in flag.parts if part.name == "flag_1").bounds[1, 2]


@pytest.mark.parametrize("sentence", ["a rotating cabinet with a door", "a spinning kiosk with a door and a knob"])
def test_a_door_does_not_make_the_whole_turn(sentence):
    assert sentence.split()[1] in said_of(sentence)


def test_a_door_is_hinged_where_it_is_said():
    for said in ("that opens to the {}", "with a door hinged on the {}", "with a door that opens to the {} side"):
        for side, sign in (("left", -1.0), ("right", 1.0)):
            made = from_text(f"a medicine cabinet {said.format(side)}").made()
            assert sign * made.blueprint.joints[0].pivot[0] > 0.1 or made.not_built, (said, side)


def test_what_stands_below_is_built_below():
    for sentence in ("a kiosk with a drawer at the bottom and a door", "a kiosk with a door and a drawer below"):
        parts = {part.name: part.bounds.mean(axis=0)[2] for part in from_text(sentence).build().parts}
        assert parts["drawer_1"] < parts["door_1"], sentence


def test_blades_are_counted():
    few, many = (from_text(f"a windmill with {count} sails").build().parts[1] for count in ("three", "six"))
    assert len(many.faces) > len(few.faces)
    assert "sails" in said_of("a trailer with three sails")


def test_one_object_stands_on_another_one_or_beside_it():
    scope = from_text("a microscope on a table with two drawers").build()
    assert scope.family == "microscope"
    above = next(part for part in scope.parts if part.name == "microscope").bounds[0, 2]
    assert above == pytest.approx(scope.parts[0].bounds[1, 2], abs=1e-3)
    assert from_text("a desk with a lamp on top").build().family == "table"
    seated = from_text("a table and two chairs").build()
    assert len([part for part in seated.parts if "seat" in part.name]) == 2
    assert "elephant" in said_of("a table and an elephant")


def test_what_a_body_stands_on_may_come_last():
    assert from_text("a turntable on a red table").build().family == "table"
    assert "turntable" in said_of("a turntable and a red table")


def test_one_caster_is_one_beside_two_wheels():
    names = [part.name for part in from_text("a mobile robot with two wheels and a caster").build().parts]
    assert [name for name in names if name.startswith("caster")] == ["caster_1", "caster_1_wheel"]
    assert [name for name in names if name.startswith("wheel")] == ["wheel_1", "wheel_2"]


@pytest.mark.parametrize("seed", range(6))
def test_drawn_compositions_have_whole_parts_that_stand_free(seed):
    blueprint = compose(draw_composition(seed), seed=seed)
    assert not overlaps(blueprint)
    assert all(len(solid.decompose()) == 1 for solid in solids_of(blueprint).values())


@pytest.mark.parametrize("seed", range(40))
def test_what_is_drawn_can_be_said(seed):
    composition = draw_composition(seed)
    found = composed(sentence_of(composition))
    assert found == composition or (found is None and said_of(sentence_of(composition)) == ""), (
        "or the library has it whole"
    )


def test_parts_are_called_as_they_were_said():
    blueprint = from_text("a tool box with a hatch and two toggle switches").build()
    assert {part.name for part in blueprint.parts} == {"body", "hatch_1", "toggle_switch_1", "toggle_switch_2"}
    assert blueprint.family == "tool_box"


def test_a_mechanism_stands_open_and_moves_as_is_said():
    request = from_text("two fridges of 180 cm with 3 drawers, hinged door opened 45 degrees, red")
    made = request.build()
    assert made.joint_above["door_1"].value == pytest.approx(np.pi / 4)
    assert {made.joint_above[f"drawer_{k}"].value for k in (1, 2, 3)} == {0.0}
    assert np.ptp(made.parts[0].vertices[:, 2]) == pytest.approx(1.8)
    assert made.parts[0].color == COLORS["red"]
    assert "door_1_2" in made.joint_above
    lid = from_text("a cart with a half open lid and a drawer").build().joint_above["lid_1"]
    assert lid.value == pytest.approx(lid.upper)
    assert "sliding" in said_of("a cart with a sliding")


def test_controls_keep_clear_of_wheels():
    made = from_text("a car with four wheels and four fans").build()
    assert not overlaps(made)


def test_a_seed_draws_what_is_not_asked_for():
    composition = composed("a cart, 90 cm wide, with two drawers")
    first, again, other = (compose(composition, seed=seed).parts[0] for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.vertices, again.vertices)
    sizes = [np.ptp(part.vertices, axis=0) for part in (first, other)]
    assert sizes[0][0] == pytest.approx(0.9)
    assert sizes[1][0] == pytest.approx(0.9)
    assert abs(sizes[0][2] - sizes[1][2]) > 1e-3


def test_a_body_grows_with_what_is_placed_on_it():
    few, many = (compose(composed(f"a kiosk with {n} drawers")).parameters["size"] for n in ("two", "20"))
    assert many[2] > 1.5 * few[2]


def test_sides_looks_and_openness_are_as_said():
    composition = composed("a dark red control box with a crank on the left side and golden knobs, half open")
    assert composition.color == "dark red"
    assert [(item.mechanism.words[0], item.count, item.side, item.color) for item in composition.wanted] == [
        ("crank", 1, "left", None),
        ("knob", 2, "", "gold"),
    ]
    assert composition.rest == 0.5
    cart = from_text("a cart with two drawers; the drawers are red").build()
    body, *drawers = (part.color for part in cart.parts)
    assert drawers == [COLORS["red"]] * 2
    assert body != COLORS["red"]
    crank = compose(composition).joint_above["crank_1"]
    np.testing.assert_allclose(crank.axis, [1.0, 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize(
    ("sentence", "words"),
    [
        ("a toolbox with two cantilever stairs", "cantilever"),
        ("thirteen carts with a wheel", "13 cart"),
        ("a cart door", "cart"),
        ("a cart with two crocodiles", "crocodiles"),
        ("a cart with a drawer and no drawer", "drawer"),
        ("a cart with two drawers with a knob on each drawer", "each"),
        ("a cart with red and blue knobs", "red"),
        ("a cart with two drawers, red, blue", "blue"),
        ("a cart with two drawers 20 cm deep", "cm"),
        ("a drawer of a cart", "drawer"),
        ("a drum truck with four wheels", "drum"),
        ("a cart with two three drawers", "three"),
        ("a cart that goes up", "goes up"),
        ("a kettle 2 m high", "2 m high"),
    ],
)
def test_what_is_not_understood_is_named(sentence, words):
    assert words in said_of(sentence)


@pytest.mark.parametrize(
    ("sentence", "words"),
    [
        ("a pot with three handles", "handle"),
        ("a cart with a push handle", "Nothing of this cart would move"),
        ("a cart with three wheels", "wheels"),
        ("a cart with two wheels on the left", "two wheels"),
        ("a chest with three lids and a carrying handle", "one lid"),
        ("a control panel with two drawers", "drawers"),
        ("a cabinet with two cantilever trays", "cantilever tray"),
        ("a toolbox with two cantilever trays and a lid", "needs the top for itself"),
        ("a table with a folding leg", "folding leg"),
        ("a frame with a caster", "no place for a caster"),
        ("a column with an arm and a turntable on top", "turntable"),
        ("a cart, 20 cm tall, with nine drawers", "no room"),
        ("a control box with 400 buttons", "400 buttons"),
    ],
)
def test_what_cannot_be_built_is_reported(sentence, words):
    assert words in said_of(sentence)


def test_no_word_names_two_things():
    for kinds in (BODIES, MECHANISMS):
        words = [word for kind in kinds for word in kind.words]
        assert len(set(words)) == len(words)
