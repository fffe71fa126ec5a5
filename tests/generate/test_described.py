"""Objects that files describe: sentences find them, and their parts move freely."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.errors import InputError
from kinematify.generate.described import ObjectDescription
from kinematify.generate.procedural.blueprint_file import described_blueprint
from kinematify.generate.registry import FAMILIES, all_kinds, build
from kinematify.model.masses import inertial_of
from tests.known import solid_of

DESCRIBED = sorted(set(all_kinds()) - set(FAMILIES))


def overlaps(blueprint, moving=None):
    """Pairs of parts that share more than a cubic millimetre, of those that moved against each other if joints did.

    Parts whose boxes are apart share nothing.
    """
    above = blueprint.joint_above

    def carrier(name):
        while name in above and not {name, getattr(above[name].mimic, "joint", None)} & moving:
            name = above[name].parent
        return name

    near = [
        (a, b)
        for a, b in combinations(blueprint.parts, 2)
        if (a.bounds[0] < b.bounds[1]).all()
        and (b.bounds[0] < a.bounds[1]).all()
        and (moving is None or carrier(a.name) != carrier(b.name))
    ]
    solids = {part.name: solid_of(part) for pair in near for part in pair}
    return [(a.name, b.name) for a, b in near if (solids[a.name] ^ solids[b.name]).volume() > 1e-9]


IN_STEPS = [name for name in DESCRIBED if all_kinds()[name].draw]
SAMPLE = [name for name in DESCRIBED if name not in IN_STEPS] + IN_STEPS[::9]
COUNTED = [
    (name, {parameter.name: type(parameter.default)(bound)})
    for name in DESCRIBED
    if name not in IN_STEPS
    for parameter in all_kinds()[name].parameters
    for bound in parameter.bounds or ()
    if bound != parameter.default
]


@pytest.mark.parametrize(("name", "given"), [*((name, {}) for name in SAMPLE), *COUNTED])
def test_parts_move_freely_to_both_ends(name, given):
    blueprint = build(name, given)
    assert blueprint.joints
    assert not overlaps(blueprint)
    for joint in blueprint.joints:
        for value in (joint.lower, joint.upper) if np.isfinite(joint.upper) else (1.0, 4.0):
            assert not overlaps(blueprint.moved({joint.child: value}), {joint.child}), (joint.child, value)


def test_a_follower_has_the_range_that_its_leader_asks_for():
    """A leader that goes beyond what its follower may do is stopped by it, or stops it, in an engine."""
    narrow, followers = [], 0
    for name, family in all_kinds().items():
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


REAL = """adjustable_wrench .25-.6|air_conditioner 8-20|bench_grinder 7-13|bicycle 9-18|blender 2-4.5
bottle_jack 2.5-6|box_car 900-1600|bunk_bed 50-110|bus_or_tram 7000-14000|cabinet 25-60|cable_car 500-1500|camera .4-1
caravan 700-1500|cement_truck 10000-16000|chainsaw 4-7|chest_freezer 35-60|circular_saw 2.5-5
coffee_machine 2.5-10|concrete_mixer 45-80|crib 20-40|dentist_chair 120-220|desk_lamp 1-3|dishwasher 35-55|door 20-50
drill_press 14-45|excavator 5000-9000|exercise_bike 20-50|fan 2-4|fire_hydrant 60-150|folding_chair 3-5.5
forklift 2500-4500|fridge 55-95|garage_door 60-140|go_kart 60-160|grand_piano 250-400|guitar 1.5-3.5
hospital_bed 90-180|ironing_board 4-9|ladder_truck 10000-16000|laptop 1.2-2.8|lathe 80-200|lawn_mower 18-40
microscope 3-8|microwave 10-18|motorcycle 140-230|office_chair 10-22|oven 40-70|padlock .1-.4|pallet_jack 55-90
piano 180-280|pickup_truck 1700-2600|power_drill 1.1-2.2|printer 5-14|safe 20-90|scissors .05-.15|sewing_machine 5-10
shipping_container 2000-2500|shopping_cart 18-30|snowmobile 200-320|stand_mixer 5-12|stroller 7-15|suitcase 2.5-5
table 15-40|toaster 1-2.5|toilet 20-45|train_wagon 15000-28000|travel_mug .3-.6|treadmill 50-120|trombone 1.2-2.5
van 1600-2600|vending_machine 200-350|vise 5-14|washing_machine 55-85|wheelchair 12-22"""
"""Catalogue masses of real things of that size, least and most [kg]."""


@pytest.mark.parametrize("line", REAL.replace("\n", "|").split("|"))
def test_no_mass_is_off_by_more_than_a_factor_of_three(line):
    name, _, masses = line.partition(" ")
    least, most = map(float, masses.split("-"))
    parts, config = build(name).parts, load_config().model
    mass = sum(inertial_of(part, np.zeros(3), thickness=1e-3, config=config).mass for part in parts)
    assert least / 3.0 <= mass <= 3.0 * most


def test_gondolas_hang_on_their_wheel():
    joints = build("ferris_wheel").joints[1:]
    assert np.allclose([np.linalg.norm(joint.pivot - (0.0, 0.0, 1.3)) for joint in joints], 0.9)


def test_no_word_names_two_families():
    words = [word for family in all_kinds().values() for word in family.words]
    assert sorted(words) == sorted(set(words))


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
            "copies": [{"like": "caster_1", "mirrored": "x"}, {"like": "caster_1", "repeated": {"count": 2}}],
        }
    )
    made = build(described.as_kind(described.make))
    above = made.joint_above
    assert set(above) == {f"caster_{k}{part}" for k in (1, 2, 3) for part in ("", "_wheel")}
    assert above["caster_2_wheel"].parent == "caster_2"
    assert np.allclose(above["caster_2"].axis, [0, 0, -1]), "it swings the other way"
    assert np.allclose(above["caster_2_wheel"].axis, [1, 0, 0]), "it rolls the same way"
    assert np.allclose(above["caster_2"].pivot, [-0.2, 0.1, 0])
    assert np.allclose(above["caster_3"].pivot, [-0.2, -0.1, 0])
    assert np.allclose(made.parts[-1].bounds.mean(axis=0), [-0.2, -0.15, 0.04])


def test_a_count_without_a_description_is_refused() -> None:
    shape = {"kind": "sphere", "radius": 0.03, "repeated": {"count": "blade"}}
    parts = [{"name": "body", "shapes": [shape]}, {"name": "rotor", "shapes": [{**shape, "xyz": [0, 0, 1]}]}]
    joints = [{"type": "continuous", "parent": "body", "child": "rotor"}]
    described = {"name": "fan", "title": "fan", "words": ["fan"], "parts": parts, "joints": joints}
    with pytest.raises(ValueError, match="no count 'blade'"):
        ObjectDescription.model_validate(described)
    with pytest.raises(InputError, match="'blade' is no number"):
        described_blueprint({"name": "fan", "parts": parts, "joints": joints})
