"""The known objects are what they say: closed, apart from each other, and their joints really move."""

from __future__ import annotations

import time
from functools import cache
from itertools import combinations

import numpy as np
import pytest
import trimesh
from trimesh.collision import CollisionManager

from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rotation_about
from tests.objects import BUILDERS, KnownJoint, KnownObject, build_all, moved, posed, shuffled, with_yaw

STEPS = 11
LOOSE = {"gapped_pair": {"door"}}
"""Joints that nothing but the gap defines: no wrong axis can be distinguished from the right one by collisions."""
LIFTS_OFF = {"edge_door": {"slide +a", "slide +b", "turn +a", "turn -a"}, "nested_drawer": {"slide -a"}}
"""Other motions that are free as well: a plate that lies on an edge can be lifted off."""


@cache
def built(name: str, seed: int | None) -> KnownObject:
    return BUILDERS[name](seed=seed)


def manager(known: KnownObject, names: frozenset[str]) -> CollisionManager:
    bodies = CollisionManager()
    for part in known.parts:
        if part.name in names:
            bodies.add_object(part.name, trimesh.Trimesh(part.vertices, part.faces, process=False))
    return bodies


class Sweep:
    """The subtree of a joint against all else, the rest of the object standing still."""

    def __init__(self, known: KnownObject, joint: KnownJoint) -> None:
        self.joint = joint
        self.names = known.subtree(joint.child)
        self.moving = manager(known, self.names)
        self.standing = manager(known, frozenset(known.index) - self.names)

    def touches(self, motion: np.ndarray) -> list[tuple[str, str]]:
        """Return the pairs of parts that penetrate when the subtree is moved by `motion`."""
        for name in self.names:
            self.moving.set_transform(name, motion)
        return sorted(self.standing.in_collision_other(self.moving, return_names=True)[1])

    def values(self) -> np.ndarray:
        """Return joint values over the range; a whole turn where there are no limits."""
        lower, upper = self.joint.lower, self.joint.upper
        return np.linspace(max(lower, -np.pi), min(upper, np.pi), STEPS)


def movable(known: KnownObject) -> list[KnownJoint]:
    return [joint for joint in known.joints if joint.kind is not JointType.FIXED]


every_object = pytest.mark.parametrize("name", list(BUILDERS))
every_seed = pytest.mark.parametrize("seed", [None, 1])


@every_object
@every_seed
def test_every_joint_sweeps_its_range_without_penetration(name: str, seed: int | None) -> None:
    known = built(name, seed)
    for joint in movable(known):
        sweep = Sweep(known, joint)
        for value in sweep.values():
            assert sweep.touches(joint.motion(value)) == [], f"{joint.parent} -> {joint.child} at {value:.3f}"


@every_object
def test_stops_block_motion_beyond_the_limits(name: str) -> None:
    known = built(name, None)
    for joint in movable(known):
        sweep = Sweep(known, joint)
        for blocked, limit, sign in zip(joint.stops, (joint.lower, joint.upper), (-1.0, 1.0), strict=True):
            if blocked:
                beyond = limit + sign * np.array([0.02, 0.05, 0.12]) * (joint.upper - joint.lower)
                assert any(sweep.touches(joint.motion(value)) for value in beyond), f"{joint.child} passes {limit:.4f}"


def wrong_motions(joint: KnownJoint, size: float) -> dict[str, list[np.ndarray]]:
    """Return growing turns about, and slides along, lines across the joint's axis."""
    side = np.cross(joint.axis, np.eye(3)[np.argmin(np.abs(joint.axis))])
    side /= np.linalg.norm(side)
    wrong = {}
    for label, direction in (("+a", side), ("-a", -side), ("+b", np.cross(joint.axis, side))):
        turns, slides = [], []
        for amount in (0.03, 0.06, 0.12, 0.25):
            turn, slide = np.eye(4), np.eye(4)
            turn[:3, :3] = rotation_about(direction, amount)
            turn[:3, 3] = joint.pivot - turn[:3, :3] @ joint.pivot
            slide[:3, 3] = 0.2 * amount * size * direction
            turns.append(turn)
            slides.append(slide)
        wrong |= {f"turn {label}": turns, f"slide {label}": slides}
    return wrong


@every_object
def test_motions_off_the_true_axis_penetrate(name: str) -> None:
    known = built(name, None)
    for joint in movable(known):
        if joint.child in LOOSE.get(name, set()) or joint.freedom == 3:
            continue
        sweep = Sweep(known, joint)
        motions = wrong_motions(joint, known.assembly.diagonal)
        free = {label for label, path in motions.items() if not any(sweep.touches(motion) for motion in path)}
        assert free <= LIFTS_OFF.get(name, set()), f"{joint.child} also moves: {free}"


def test_ball_in_socket_turns_about_any_axis() -> None:
    known = built("ball_in_socket", None)
    (joint,) = known.joints
    sweep = Sweep(known, joint)
    rng = np.random.default_rng(5)
    for direction in rng.normal(size=(20, 3)):
        motion = np.eye(4)
        motion[:3, :3] = rotation_about(direction / np.linalg.norm(direction), 0.3)
        motion[:3, 3] = joint.pivot - motion[:3, :3] @ joint.pivot
        assert sweep.touches(motion) == []


@every_object
@every_seed
def test_parts_are_closed_in_one_piece_and_apart(name: str, seed: int | None) -> None:
    known = built(name, seed)
    meshes = {part.name: trimesh.Trimesh(part.vertices, part.faces, process=False) for part in known.parts}
    for part_name, mesh in meshes.items():
        assert mesh.is_watertight, part_name
        assert mesh.volume > 0, part_name
        assert mesh.body_count == 1, part_name
    rigid = {frozenset((joint.parent, joint.child)) for joint in known.joints if joint.kind is JointType.FIXED}
    for first, second in combinations(meshes, 2):
        if {first, second} not in rigid:
            shared = trimesh.boolean.intersection([meshes[first], meshes[second]], engine="manifold")
            assert shared.is_empty, f"{first} and {second} penetrate"


@every_object
def test_joints_form_one_tree_with_sound_limits(name: str) -> None:
    known = built(name, None)
    children = [joint.child for joint in known.joints]
    assert sorted([known.root, *children]) == sorted(known.index)
    assert known.subtree(known.root) == frozenset(known.index)
    for joint in known.joints:
        assert np.isclose(np.linalg.norm(joint.axis), 1.0)
        assert joint.lower <= 0.0 <= joint.upper


@every_object
def test_posing_carries_the_truth_along(name: str) -> None:
    known = built(name, None)
    transform = np.eye(4)
    transform[:3, :3] = rotation_about(np.array([0.6, 0.0, 0.8]), 1.1)
    transform[:3, 3] = (0.3, -0.2, 0.9)
    turned = with_yaw(posed(known, transform), 0.7)
    whole = np.eye(4)
    whole[:3, :3] = rotation_about(np.array([0.0, 0.0, 1.0]), 0.7)
    whole = whole @ transform
    values = {joint.child: 0.5 * min(joint.upper, 1.0) for joint in known.joints}
    there = posed(moved(known, values), whole)
    here = moved(turned, values)
    for first, second in zip(there.parts, here.parts, strict=True):
        np.testing.assert_allclose(first.vertices, second.vertices, atol=1e-12)
    for first, second in zip(there.joints, here.joints, strict=True):
        np.testing.assert_allclose(first.axis, second.axis, atol=1e-12)
        np.testing.assert_allclose(first.lower, second.lower, atol=1e-12)
        np.testing.assert_allclose(np.cross(first.pivot - second.pivot, first.axis), 0.0, atol=1e-12)


def test_shuffling_changes_the_order_alone() -> None:
    known = built("four_legged", None)
    mixed = shuffled(known, 4)
    assert [part.name for part in mixed.parts] != [part.name for part in known.parts]
    assert {part.mesh_hash for part in mixed.parts} == {part.mesh_hash for part in known.parts}


def test_seed_varies_sizes_and_repeats() -> None:
    for plain, first, again in zip(build_all(), build_all(7), build_all(7), strict=True):
        assert not np.allclose(plain.assembly.bounds, first.assembly.bounds), plain.name
        for one, two in zip(first.parts, again.parts, strict=True):
            assert one.mesh_hash == two.mesh_hash, plain.name


def test_gapped_pair_has_the_stated_gap() -> None:
    known = BUILDERS["gapped_pair"](gap=0.01)
    cabinet, door = (manager(known, frozenset({name})) for name in ("cabinet", "door"))
    assert cabinet.min_distance_other(door) == pytest.approx(0.01 * known.assembly.diagonal, rel=0.03)


def test_torso_arms_are_congruent() -> None:
    known = built("torso", None)
    parts = {part.name: part for part in known.parts}
    for kind in ("upper_arm", "forearm"):
        turned = parts[f"left_{kind}"].vertices * (-1.0, -1.0, 1.0)
        np.testing.assert_allclose(turned, parts[f"right_{kind}"].vertices, atol=1e-9)


@pytest.mark.parametrize("joints", [1, 3, 10, 40])
def test_serial_arm_has_any_number_of_joints(joints: int) -> None:
    known = BUILDERS["serial_arm"](joints=joints)
    assert len(known.parts) == joints + 1
    assert len(known.joints) == joints


def test_building_everything_is_quick() -> None:
    start = time.process_time()
    build_all(3)
    assert time.process_time() - start < 5.0
