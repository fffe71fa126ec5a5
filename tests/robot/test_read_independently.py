"""yourdfpy reads the same trees, limits and masses; what is written reads back as itself; broken files are refused."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from kinematify.manipulation.manipulator import builtin_robot
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Joint, Robot, forward_kinematics, rest_configuration
from kinematify.robot.write import write_robot
from tests.places import BENCH, ROOT

MODELS = [*sorted(BENCH.glob("*/*/model.urdf"))[::4], *ROOT.glob("examples/**/*.urdf")]


def configurations(robot: Robot, count: int) -> list[dict[str, float]]:
    """Rest, and random values of all leaders within their limits."""
    random = np.random.default_rng(0)
    inside = {joint.name: (max(joint.lower, -3.0), min(joint.upper, 3.0)) for joint in robot.leaders}
    rest = rest_configuration(robot)
    rows = [{name: float(random.uniform(*ends)) for name, ends in inside.items()} for _ in range(count)]
    return [{name: rest[name] for name in inside}, *rows]


@pytest.fixture(scope="module")
def arm() -> Path:
    return builtin_robot().urdf


def disagreements(path: Path) -> list[str]:
    """What yourdfpy, a reader of its own, says otherwise; meshes are compared elsewhere."""
    yourdfpy = pytest.importorskip("yourdfpy")
    ours = read_robot(path, geometry="none")
    theirs = yourdfpy.URDF.load(str(path), load_meshes=False, build_scene_graph=True)
    found = [] if theirs.base_link == ours.root else [f"root {theirs.base_link}"]
    for joint in ours.joints:
        other = theirs.joint_map[joint.name]
        if (other.type, other.parent, other.child) != (joint.declared_kind, joint.parent, joint.child):
            found.append(f"{joint.name} is {other.type} from {other.parent} to {other.child}")
        if joint.kind in (JointType.REVOLUTE, JointType.PRISMATIC):
            limit = other.limit
            stated = (limit.lower or 0.0, limit.upper or 0.0, limit.effort, limit.velocity)
            if stated != (joint.lower, joint.upper, joint.effort, joint.velocity):
                found.append(f"{joint.name} has the limit {stated}")
    for name, link in ours.link_by_name.items():
        inertial = theirs.link_map[name].inertial
        if (inertial is None) != (link.inertial is None):
            found.append(f"{name} has the inertial {inertial}")
        elif inertial is not None and link.inertial is not None and inertial.mass != pytest.approx(link.inertial.mass):
            found.append(f"{name} has the mass {inertial.mass}")
    for q in configurations(ours, 3):
        theirs.update_cfg(q)
        for name, pose in forward_kinematics(ours, q).items():
            if not np.allclose(pose, theirs.get_transform(name), atol=1e-6):
                found.append(f"{name} stands elsewhere at {q}")
    return found


FOUR_NUMBERS = re.compile(r'<axis xyz="[^"\s]+( [^"\s]+){3,}"')
"""No axis of URDF: urdfdom and we refuse such a file."""


@pytest.mark.skipif(not MODELS, reason="no benchmark models: set KINEMATIFY_BENCH to their folder")
def test_an_independent_reader_agrees_on_every_fourth_model() -> None:
    stated = [path for path in MODELS if not FOUR_NUMBERS.search(path.read_text("utf-8"))]
    found = {path.parent.name: disagreements(path) for path in stated}
    assert {name: reported for name, reported in found.items() if reported} == {}


def test_an_independent_reader_agrees_on_the_arm(arm: Path) -> None:
    assert disagreements(arm) == []


def assert_same_joint(one: Joint, other: Joint) -> None:
    for name in ("name", "kind", "parent", "child", "effort", "velocity", "damping", "friction", "lower", "upper"):
        assert getattr(one, name) == getattr(other, name), name
    np.testing.assert_allclose(one.T_parent_child, other.T_parent_child, atol=1e-12)
    np.testing.assert_allclose(one.axis, other.axis, atol=1e-15)
    assert one.mimic == other.mimic


def read_back(path: Path, folder: Path) -> None:
    """Write what was read, and compare what is read from there."""
    robot = read_robot(path)
    again = read_robot(write_robot(robot, folder / "again.urdf"))
    assert [link.name for link in again.links] == [link.name for link in robot.links]
    for one, other in zip(robot.joints, again.joints, strict=True):
        assert_same_joint(one, other)
    for link, copied in zip(robot.links, again.links, strict=True):
        assert (link.inertial is None) == (copied.inertial is None)
        if link.inertial is not None and copied.inertial is not None:
            assert copied.inertial.mass == link.inertial.mass
            np.testing.assert_array_equal(copied.inertial.center_of_mass, link.inertial.center_of_mass)
            np.testing.assert_array_equal(copied.inertial.tensor, link.inertial.tensor)
        for shape, same in zip((*link.visuals, *link.collisions), (*copied.visuals, *copied.collisions), strict=True):
            assert (shape.kind, shape.file, shape.size, shape.color) == (same.kind, same.file, same.size, same.color)
            np.testing.assert_allclose(shape.mesh.vertices, same.mesh.vertices, atol=1e-9)


def test_what_is_written_reads_back_as_itself(arm: Path, tmp_path: Path) -> None:
    read_back(arm, tmp_path)


@pytest.mark.skipif(not BENCH.is_dir(), reason="no benchmark models: set KINEMATIFY_BENCH to their folder")
@pytest.mark.parametrize("model", ["robots/allegro", "robots/panda", "everyday/oven_7138"])
def test_models_of_others_read_back_as_themselves(model: str, tmp_path: Path) -> None:
    read_back(BENCH / model / "model.urdf", tmp_path)
