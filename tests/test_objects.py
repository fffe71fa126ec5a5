"""The known objects are what they say: closed, apart from each other, and their joints really move."""

from __future__ import annotations

from functools import cache
from itertools import combinations

import numpy as np
import pytest
import trimesh
from trimesh.collision import CollisionManager

from kinematify.robot.joint_type import JointType
from tests.objects import BUILDERS, KnownJoint, KnownObject

STEPS = 11


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
every_seed = pytest.mark.parametrize("seed", [1])


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
