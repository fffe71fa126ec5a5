"""The base link of the true undirected tree of the benchmark's robots, at rest and in a random pose."""

from __future__ import annotations

import numpy as np
import pytest
import yourdfpy

from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.alike import AlikeParts, find_clusters
from kinematify.contact.graph import pair
from kinematify.geometry.part_stats import part_stats
from kinematify.geometry.surface import PartSurface
from kinematify.topology.base_link import base_probabilities
from tests.places import BENCH

ROBOTS = ("allegro", "fetch", "go2", "h1", "panda", "ur10e")
CONFIG = load_config()


@pytest.mark.parametrize("name", ROBOTS)
def test_base_of_a_real_robot(name: str) -> None:
    if not (BENCH / "robots" / name).is_dir():
        pytest.skip("The benchmark models are not here; set KINEMATIFY_BENCH to their folder.")
    robot = yourdfpy.URDF.load(str(BENCH / "robots" / name / "model.urdf"))
    kind = np.zeros(0, dtype=np.int64)
    for share in (0.0, 0.3):
        names, parts, edges = erased(robot, share)
        root = names.index(rigid_group(robot, robot.base_link))
        if share == 0.0:
            assembly = Assembly(parts=tuple(parts), source=name)
            surfaces = [PartSurface(part, crease_angle=np.radians(30)) for part in parts]
            kind = AlikeParts(len(parts), find_clusters(assembly, surfaces, config=CONFIG.contact, seed=0)).kind
        likely = base_probabilities(edges, [*map(part_stats, parts)], kind)
        assert likely.argmax() == root, dict(zip(names, likely, strict=True))


def erased(robot: yourdfpy.URDF, share: float) -> tuple[list[str], list[Part], list[tuple[int, int]]]:
    """Rigid parts in the world and the edges of their tree, each joint moved by up to `share` of half its range."""
    rng = np.random.default_rng(1)
    pose = {}
    for joint in robot.actuated_joints:
        limited = joint.limit is not None and joint.type != "continuous"
        low, high = (joint.limit.lower, joint.limit.upper) if limited else (-np.pi, np.pi)
        rest = 0.0 if low <= 0 <= high else (low + high) / 2
        half = min((high - low) / 2, np.pi)
        pose[joint.name] = float(np.clip(rest + share * rng.uniform(-1, 1) * half, low, high))
    robot.update_cfg(pose)
    meshes: dict[str, list] = {}
    for node in robot.scene.graph.nodes_geometry:
        transform, geometry = robot.scene.graph[node]
        link = robot.scene.graph.transforms.parents[node]
        meshes.setdefault(rigid_group(robot, link), []).append(robot.scene.geometry[geometry].copy())
        meshes[rigid_group(robot, link)][-1].apply_transform(transform)
    names = sorted(meshes)
    return names, [merged(name, meshes[name]) for name in names], true_edges(robot, names)


def merged(name: str, meshes: list) -> Part:
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + offset for mesh, offset in zip(meshes, offsets[:-1], strict=True)]
    return Part(name=name, vertices=np.concatenate([m.vertices for m in meshes]), faces=np.concatenate(faces))


def rigid_group(robot: yourdfpy.URDF, link: str) -> str:
    """The link at which the chain of fixed joints above `link` starts."""
    above = {joint.child: joint for joint in robot.robot.joints}
    while link in above and above[link].type == "fixed":
        link = above[link].parent
    return link


def true_edges(robot: yourdfpy.URDF, names: list[str]) -> list[tuple[int, int]]:
    return [
        pair(names.index(rigid_group(robot, joint.parent)), names.index(joint.child))
        for joint in robot.robot.joints
        if joint.type != "fixed"
    ]
