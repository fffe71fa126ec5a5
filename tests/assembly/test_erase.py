"""Erasing kinematics: the protocol's parts, the truth about every joint, and the laws that both obey."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kinematify.assembly.erasure import erase, truth_path, write_erased
from kinematify.assembly.load import load_assembly
from kinematify.config import load_config
from kinematify.errors import OutputError
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Joint, Link, LinkMesh, Mimic, Robot, Shape
from kinematify.robot.transforms import rotation_about
from tests.places import BENCH

if TYPE_CHECKING:
    from kinematify.assembly.truth import TrueJoint
    from kinematify.robot.arrays import FloatArray

MODELS = sorted(BENCH.glob("*/*/model.urdf"))
needs_bench = pytest.mark.skipif(not MODELS, reason="no benchmark models: set KINEMATIFY_BENCH to their folder")


def wedge(name: str, size: float) -> Link:
    """A link whose shape no rotation maps to itself, so that its pose can be read off its vertices."""
    vertices = size * np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    return Link(name=name, visuals=(Shape(mesh=LinkMesh(vertices=vertices, faces=faces)),))


def joint(name: str, parent: str, child: str, kind: str = "revolute", **changes: object) -> Joint:
    pose = np.eye(4)
    pose[:3, :3] = rotation_about(np.array([0.6, 0.0, 0.8]), 0.7)
    pose[:3, 3] = [0.3, -0.2, 0.5]
    unlimited = kind == "continuous"
    base = Joint(
        name=name, kind=JointType(kind), parent=parent, child=child, T_parent_child=pose, axis=np.array([0, 0.6, 0.8]),
        lower=-math.inf if unlimited else -1.0, upper=math.inf if unlimited else 2.0,
    )  # fmt: skip
    return replace(base, **changes)  # type: ignore[arg-type]


def robot(links: list[Link], *joints: Joint) -> Robot:
    return Robot(name="r", links=tuple(links), joints=joints)


def chain() -> Robot:
    """Base, arm, slide and a mimicking finger; the tip is fixed to the arm."""
    return robot(
        [wedge(name, 1.0 + 0.1 * k) for k, name in enumerate("abcdt")],
        joint("turn", "a", "b"),
        joint("tip", "b", "t", "fixed", lower=0.0, upper=0.0),
        joint("slide", "b", "c", "prismatic"),
        joint("finger", "c", "d", mimic=Mimic(joint="turn", multiplier=-0.5, offset=0.1)),
    )


def empty(name: str) -> Link:
    return Link(name=name)


def screwed(true: TrueJoint, value: float, points: FloatArray) -> FloatArray:
    if true.kind is JointType.PRISMATIC:
        return points + value * true.axis
    return (points - true.pivot) @ rotation_about(true.axis, value).T + true.pivot


def test_links_on_fixed_joints_are_one_part() -> None:
    erased = erase(chain(), shuffle=False)
    assert erased.truth.part_links == (("a",), ("b", "t"), ("c",), ("d",))
    assert [len(part.faces) for part in erased.parts] == [4, 8, 4, 4]
    assert erased.truth.parents == (-1, 0, 1, 2)
    assert erased.truth.root == 0


def test_names_are_anonymous_and_order_is_shuffled() -> None:
    plain, erased = erase(chain(), shuffle=False), erase(chain(), seed=1)
    assert erased.truth.part_names == ("part_000", "part_001", "part_002", "part_003")
    assert [part.name for part in erased.parts] == list(erased.truth.part_names)
    assert erased.truth.part_links != plain.truth.part_links
    assert sorted(erased.truth.part_links) == sorted(plain.truth.part_links)


def corner_sets(triangles: FloatArray) -> set[frozenset[tuple[float, ...]]]:
    return {frozenset(tuple(corner) for corner in triangle) for triangle in triangles.tolist()}


@given(seed=st.integers(0, 10_000))
def test_random_pose_stays_within_the_protocol(seed: int) -> None:
    truth = erase(chain(), pose="random", seed=seed).truth
    q = truth.configuration
    assert abs(q["turn"]) <= 0.3 * 1.5
    assert abs(q["slide"]) <= 0.3 * 1.5
    assert q["finger"] == pytest.approx(-0.5 * q["turn"] + 0.1)
    for true in truth.joints:
        assert true.lower + true.value == pytest.approx(-1.0)
        assert true.upper + true.value == pytest.approx(2.0)
        assert true.value == q[true.name]


@given(seed=st.integers(0, 10_000), yaw=st.floats(-180, 180))
def test_moving_along_the_true_joints_undoes_the_random_pose(seed: int, yaw: float) -> None:
    """The truth's axes, pivots and values carry every part back to where it stands at rest."""
    rest, moved = (
        erase(chain(), yaw_deg=yaw, shuffle=False),
        erase(chain(), pose="random", seed=seed, yaw_deg=yaw, shuffle=False),
    )
    below = {0: {1, 2, 3}, 1: {2, 3}, 2: {3}}
    shapes = [part.vertices for part in moved.parts]
    for true in reversed(moved.truth.joints):  # from the leaves, so that no earlier axis has moved yet
        back = rest.truth.configuration[true.name] - moved.truth.configuration[true.name]
        carried = {true.child} | below.get(true.child, set())
        shapes = [screwed(true, back, shape) if k in carried else shape for k, shape in enumerate(shapes)]
    for shape, part in zip(shapes, rest.parts, strict=True):
        np.testing.assert_allclose(shape, part.vertices, atol=1e-12)


def test_links_without_geometry_make_chains() -> None:
    described = robot(
        [wedge("a", 1), empty("cross"), wedge("b", 1)], joint("pitch", "a", "cross"), joint("roll", "cross", "b")
    )
    truth = erase(described, shuffle=False).truth
    assert [(j.name, j.parent, j.child, j.serial, j.chain_length) for j in truth.joints] == [
        ("pitch", 0, 1, 0, 2),
        ("roll", 0, 1, 1, 2),
    ]
    assert truth.dropped == ()


def test_joints_above_the_first_geometry_and_of_bare_frames_are_dropped() -> None:
    described = robot(
        [empty("world"), wedge("a", 1), wedge("b", 1), empty("frame")],
        joint("lift", "world", "a"), joint("turn", "a", "b"), joint("camera", "b", "frame"),
    )  # fmt: skip
    truth = erase(described, shuffle=False).truth
    assert [j.name for j in truth.joints] == ["turn"]
    assert truth.dropped == ("lift", "camera")


@given(seed=st.integers(0, 1000))
def test_truth_as_json(seed: int) -> None:
    described = robot(
        [wedge("a", 1), wedge("b", 1), wedge("c", 1)],
        joint("j", "a", "b", "continuous"),
        joint("k", "b", "c", mimic=Mimic(joint="j", multiplier=2.0, offset=0.0)),
    )
    truth = erase(described, pose="random", seed=seed, yaw_deg=12.5).truth
    values = json.loads(truth.to_json())
    assert (values["schema"], values["seed"], values["part_names"]) == (1, seed, list(truth.part_names))
    assert values["joints"][0]["upper"] is None
    assert values["joints"][1]["mimic"] == {"joint": "j", "multiplier": 2.0, "offset": 0.0}
    np.testing.assert_array_equal(values["joints"][0]["axis"], truth.joints[0].axis)
    assert "Infinity" not in truth.to_json()


def test_written_parts_are_read_back_exactly(tmp_path: Path) -> None:
    erased = erase(chain(), pose="random", seed=4, yaw_deg=37.0)
    truth_file = write_erased(erased, tmp_path / "deep" / "parts")
    assert truth_file == truth_path(tmp_path / "deep" / "parts") == tmp_path / "deep" / "parts.truth.json"
    assert sorted(file.name for file in (tmp_path / "deep").iterdir()) == ["parts", "parts.truth.json"]
    assert truth_file.read_text().strip() == erased.truth.to_json().strip()
    loaded = load_assembly(tmp_path / "deep" / "parts", config=load_config().assembly)
    for part, twin in zip(loaded.parts, erased.parts, strict=True):
        assert part.name == twin.name
        assert corner_sets(part.vertices[part.faces]) == corner_sets(twin.vertices[twin.faces])


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    erased = erase(chain())
    write_erased(erased, tmp_path / "parts")
    with pytest.raises(OutputError, match="exists already"):
        write_erased(erased, tmp_path / "parts")
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="exists already"):
        write_erased(erased, tmp_path / "file")
    with pytest.raises(OutputError, match="cannot be written"):
        write_erased(erased, tmp_path / "file" / "parts")
    assert len(list(tmp_path.iterdir())) == 3


@needs_bench
@pytest.mark.parametrize("kind", ["robots", "everyday"])
def test_benchmark_models_have_the_parts_and_joints_that_their_records_state(kind: str) -> None:
    wrong = []
    for path in (path for path in MODELS if path.parent.parent.name == kind):
        facts = json.loads((path.parent / "source.json").read_text())
        erased = erase(read_robot(path, geometry="shown"), pose="random", seed=1)
        found = (len(erased.parts), len(erased.truth.joints), erased.truth.parents.count(-1), erased.truth.dropped)
        if found != (facts["rigid_parts_with_geometry"], facts["dof"], 1, ()):
            wrong.append((path.parent.name, found))
    assert wrong == []
