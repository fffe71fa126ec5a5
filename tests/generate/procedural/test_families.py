"""Every family builds sound objects: closed one-piece parts, a tree, and joints that move without a collision."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from trimesh.collision import CollisionManager

from kinematify.errors import InputError
from kinematify.generate.delivery import opened
from kinematify.generate.procedural.blueprint import Blueprint
from kinematify.generate.procedural.mesh_styles import STYLES
from kinematify.generate.registry import FAMILIES, all_kinds, build
from tests.known import carried

SEEDS = (None, 0)


def manager_of(blueprint: Blueprint) -> CollisionManager:
    manager = CollisionManager()
    for part in blueprint.parts:
        manager.add_object(part.name, trimesh.Trimesh(part.vertices, part.faces, process=False))
    return manager


def collisions(blueprint: Blueprint) -> set[tuple[str, str]]:
    return manager_of(blueprint).in_collision_internal(return_names=True)[1]


CASES = [(name, seed, {}) for name in FAMILIES for seed in SEEDS]
CASES += [("fridge", None, {"drawers": 2, "width": 0.9}), ("gripper", None, {"fingers": 3, "joints": 2})]


@pytest.fixture(scope="module", params=CASES, ids=str)
def blueprint(request: pytest.FixtureRequest) -> Blueprint:
    name, seed, given = request.param
    return build(name, {"style": "clean", **given}, seed=seed)


def test_parts_are_closed_and_in_one_piece(blueprint):
    for body in blueprint.parts:
        mesh = trimesh.Trimesh(body.vertices, body.faces, process=False)
        assert mesh.is_watertight, body.name
        assert mesh.body_count == 1, body.name


def test_joints_make_a_tree_with_parents_first(blueprint):
    placed = {blueprint.root}
    for joint in blueprint.joints:
        assert joint.parent in placed
        assert joint.child not in placed
        placed.add(joint.child)
    assert placed == {body.name for body in blueprint.parts}


def test_limits_hold_the_pose_in_which_it_is_shown(blueprint):
    for joint in blueprint.joints:
        assert joint.lower <= 0.0 <= joint.upper
        assert joint.upper > joint.lower


def test_every_joint_moves_through_its_range_without_a_collision(blueprint):
    manager = manager_of(blueprint)
    assert not manager.in_collision_internal()
    for joint in blueprint.joints:
        moving = carried(blueprint, joint.child)
        for value in np.linspace(max(joint.lower, -np.pi), min(joint.upper, np.pi), 5):
            for name in moving:
                manager.set_transform(name, joint.motion(float(value)))
            hits = manager.in_collision_internal(return_names=True)[1]
            assert not hits, f"{joint.child} at {value:.3f}: {hits}"
        for name in moving:
            manager.set_transform(name, np.eye(4))


@pytest.mark.parametrize("style", [style for style in STYLES if style != "clean"])
def test_a_style_changes_the_mesh_and_leaves_the_joints_free(style):
    clean, other = (build("gripper", {"style": name, "fingers": 3}, seed=0) for name in ("clean", style))
    shapes = [[part.vertices.shape for part in made.parts] for made in (clean, other)]
    assert shapes[0] != shapes[1]
    for one, two in zip(clean.parts, other.parts, strict=True):
        np.testing.assert_allclose(one.bounds, two.bounds, atol=2e-4)
    for value in (0.0, 0.6, 1.2):
        assert not collisions(other.moved({"finger_1": value}))


def test_doors_of_a_fridge_are_side_by_side_above_its_drawers():
    boxes = {part.name: part.bounds for part in build("fridge", {"drawers": 2}).parts}
    (left, right), drawers = (boxes[f"door_{k}"] for k in (1, 2)), (boxes[f"drawer_{k}"] for k in (1, 2))
    assert left[1][0] < right[0][0]
    assert max(box[1][2] for box in drawers) < min(left[0][2], right[0][2])


def test_a_drawer_that_is_out_cannot_be_lifted():
    made = build("table", {"layout": "2*drawer | drawer"})
    made = opened(made, [joint.child for joint in made.joints], (0.15, "m"))
    manager, lifted = manager_of(made), np.eye(4)
    lifted[2, 3] = 0.005
    for joint in made.joints:
        manager.set_transform(joint.child, lifted)
        hits = manager.in_collision_internal(return_names=True)[1]
        assert ("body", joint.child) in hits
        manager.set_transform(joint.child, np.eye(4))
    assert not collisions(made)


@pytest.mark.parametrize("name", FAMILIES)
def test_a_seed_gives_the_same_object_and_another_seed_what_is_given_and_draws_the_rest(name):
    first, again = (build(name, seed=3) for _ in range(2))
    for one, two in zip(first.parts, again.parts, strict=True):
        np.testing.assert_array_equal(one.vertices, two.vertices)
    parameter = next(p for p in all_kinds()[name].parameters if p.unit == "m" and p.usual)
    given = {parameter.name: 0.5 * sum(parameter.usual)}
    other = build(name, given, seed=4)
    assert given.items() <= other.parameters.items()
    assert other.parameters | given != first.parameters | given


def test_unknown_parameters_and_values_out_of_bounds_are_refused_with_a_hint():
    with pytest.raises(InputError, match="Did you mean drawers"):
        build("cabinet", {"drawer": 3})
    with pytest.raises(InputError, match="bar, knob"):
        build("cabinet", {"handle": "rope"})
