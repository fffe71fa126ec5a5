"""Kinds move as their names promise: what follows what, and how many there are of what people count."""

from __future__ import annotations

import pytest
import trimesh

from kinematify.generate.kind_search import key_of, kind_called
from kinematify.generate.registry import build
from kinematify.robot.joint_type import JointType


@pytest.mark.parametrize(
    ("kind", "followers", "leader"),
    [
        ("egg_beater", 2, "crank"),
        ("hand_drill", 1, "crank"),
        ("salad_spinner", 1, "crank"),
        ("corkscrew", 2, "screw"),
        ("window_blind", 5, "slat_0"),
        ("ferris_wheel", 6, "wheel"),
        ("iris", 8, "ring"),
        ("lead_screw", 1, "screw"),
        ("bass_drum", 1, "pedal"),
        ("cantilever_box", 3, "arm_front_1"),
        ("trash_can", 1, "lid"),
        ("umbrella", 8, "runner"),
        ("adjustable_wrench", 1, "jaw"),
    ],
)
def test_what_one_moves_the_others_follow(kind, followers, leader):
    joints = build(kind).joints
    assert sum(joint.mimic is not None and joint.mimic.joint == leader for joint in joints) == followers
    made = build(kind)
    leads = next(joint for joint in joints if joint.child == leader)
    moved = made.moved({leader: min(leads.upper, 1.0)})
    there = {part.name: part for part in made.parts}
    for joint in joints:
        if joint.mimic is not None and joint.mimic.joint == leader:
            ends = [joint.mimic.multiplier * end for end in (leads.lower, leads.upper)]
            assert joint.lower - 1e-9 <= min(ends) < max(ends) <= joint.upper + 1e-9, "it can go where it is taken"
            part = next(part for part in moved.parts if part.name == joint.child)
            assert abs(part.vertices - there[joint.child].vertices).max() > 1e-3


@pytest.mark.parametrize(
    ("name", "counts", "stem", "number"),
    [
        ("table football", {"rods": 8, "players": 3}, "rod_", 8),
        ("garden gate", {"leaves": 2, "pickets": 7}, "leaf_", 2),
        ("combination padlock", {"wheels": 4}, "wheel_", 4),
        ("camera iris", {"blades": 8}, "blade_", 8),
        ("sewing box", {"trays": 3}, "tray_", 6),
        ("weekly pill box", {"number": 7}, "lid_", 7),
        ("orrery", {"number": 2}, "planet_", 2),
        ("ferris wheel", {"gondolas": 10}, "gondola_", 10),
    ],
)
def test_a_count_that_people_name_is_built(name, counts, stem, number):
    kind = kind_called(key_of(name))
    assert kind is not None
    assert sum(part.name.startswith(stem) for part in build(kind, counts).parts) == number


def test_rods_of_table_football_slide_and_turn():
    kinds = {joint.child: joint.kind for joint in build("foosball_table").joints}
    assert {kinds[f"rod_{k}"] for k in range(1, 9)} == {JointType.CONTINUOUS}
    assert {kinds[f"bumper_{k}"] for k in range(1, 9)} == {JointType.PRISMATIC}


def test_a_wheelie_bin_is_hollow_and_its_lid_goes_right_over():
    made = build("wheelie_bin")
    body = made.parts[0]
    volume = trimesh.Trimesh(body.vertices, body.faces).volume
    assert 0.0 < volume < 0.2 * (body.bounds[1] - body.bounds[0]).prod()
    assert next(joint.upper for joint in made.joints if joint.child == "lid") > 4.6
    assert sum(part.name.startswith("wheel") for part in made.parts) == 2
