"""Objects that files describe: sentences find them, and their parts move freely."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from manifold3d import Manifold, Mesh64

from kinematify.errors import InputError
from kinematify.generate.described import ObjectDescription, known_families
from kinematify.generate.procedural.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.materials import COLORS
from kinematify.generate.procedural.request import from_text
from kinematify.robot.joint_type import JointType

DESCRIBED = sorted(set(known_families()) - set(FAMILIES))


def overlaps(blueprint):
    """Pairs of parts that share more than a cubic millimetre."""
    solids = {
        part.name: Manifold(
            Mesh64(vert_properties=np.array(part.vertices), tri_verts=np.array(part.faces, dtype=np.uint64))
        )
        for part in blueprint.parts
    }
    return [(a, b) for a, b in combinations(solids, 2) if (solids[a] ^ solids[b]).volume() > 1e-9]


@pytest.mark.parametrize("name", DESCRIBED)
def test_parts_move_freely_to_both_ends(name):
    blueprint = build(known_families()[name], {})
    assert blueprint.joints
    assert not overlaps(blueprint)
    for joint in blueprint.joints:
        for value in (joint.lower, joint.upper) if np.isfinite(joint.upper) else (1.0, 4.0):
            assert not overlaps(blueprint.moved({joint.child: value})), (joint.child, value)


def test_no_word_names_two_families():
    words = [word for family in known_families().values() for word in family.words]
    assert sorted(words) == sorted(set(words))


def test_a_sentence_may_say_how_it_looks_and_what_it_has():
    bicycle = from_text("a red bicycle with two wheels, 1.2 m high").build()
    assert bicycle.parts[0].color == COLORS["red"]
    assert np.ptp(bicycle.assembly.bounds[:, 2]) == pytest.approx(1.2)
    assert from_text("a wheelbarrow with two handles").build().family == "wheelbarrow"
    for sentence in ("a bicycle with three wheels", "a wheelbarrow with three handles", "a bicycle with a rudder"):
        with pytest.raises(InputError):
            from_text(sentence)


def test_sizes_of_parts_without_a_number_are_told():
    request = from_text("a wheelchair with two big wheels and two small casters")
    assert request.unused == ("big wheels", "small casters")
    assert request.build().family == "wheelchair"
    assert from_text("a cart with four small wheels and a wide drawer").unused == ("small wheels", "wide drawer")


def test_what_changes_nothing_is_told():
    request = from_text("a sleek retro-style pocket knife for my grandfather")
    assert request.family == "pocket_knife"
    assert request.unused == ("sleek", "retro-style", "for my grandfather")
    with pytest.raises(InputError, match="6 bottles"):
        from_text("a cabinet for 6 bottles")


@pytest.mark.parametrize("sentence", ["a cabinet for a sliding drawer", "a cabinet for two drawers"])
def test_a_purpose_that_names_a_mechanism_is_asked_for(sentence: str) -> None:
    request = from_text(sentence)
    assert request.unused == ()
    joints = request.build(seed=0).joints
    assert any(joint.kind is JointType.PRISMATIC for joint in joints)


def test_a_purpose_that_asks_for_a_lid_is_not_dropped() -> None:
    with pytest.raises(InputError, match="hold"):
        from_text("a box to hold a hinged lid")


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


def test_a_colour_that_is_asked_for_is_that_of_the_base() -> None:
    assert from_text("a blue tractor").build().parts[0].color == COLORS["blue"]
