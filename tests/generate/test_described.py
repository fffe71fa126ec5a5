"""Objects that files describe: sentences find them, and their parts move freely."""

from __future__ import annotations

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
from kinematify.generate.procedural.parameter import parse_table

DESCRIBED = sorted(set(known_families()) - set(FAMILIES))


def solid_of(part):
    return Manifold(Mesh64(vert_properties=np.array(part.vertices), tri_verts=np.array(part.faces, dtype=np.uint64)))


def overlaps(blueprint):
    """Pairs of parts that share more than a cubic millimetre."""
    solids = {part.name: solid_of(part) for part in blueprint.parts}
    return [(a, b) for a, b in combinations(solids, 2) if (solids[a] ^ solids[b]).volume() > 1e-9]


IN_STEPS = [name for name in DESCRIBED if library()[name].draw]
SAMPLE = [name for name in DESCRIBED if name not in IN_STEPS] + IN_STEPS[::9]
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
        assert not verbs & keys(parse_table(file.read_text(encoding="utf-8"))), file


def test_a_drawn_object_has_the_size_that_is_asked_for():
    built = build(known_families()["standing_desk"], {"width": 1.4, "height": 0.7})
    assert np.ptp(built.assembly.bounds[:, 0]) == pytest.approx(1.4)
    with pytest.raises(InputError, match="must be a number from 1 to"):
        build(known_families()["standing_desk"], {"width": 40.0})


def test_no_word_names_two_families():
    words = [word for family in known_families().values() for word in family.words]
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


def test_a_count_without_a_description_is_refused() -> None:
    shape = {"kind": "sphere", "radius": 0.03, "repeated": {"count": "blade"}}
    parts = [{"name": "body", "shapes": [shape]}, {"name": "rotor", "shapes": [{**shape, "xyz": [0, 0, 1]}]}]
    joints = [{"type": "continuous", "parent": "body", "child": "rotor"}]
    described = {"name": "fan", "title": "fan", "words": ["fan"], "parts": parts, "joints": joints}
    with pytest.raises(ValueError, match="no count 'blade'"):
        ObjectDescription.model_validate(described)
    with pytest.raises(InputError, match="'blade' is no number"):
        described_blueprint({"name": "fan", "parts": parts, "joints": joints})
