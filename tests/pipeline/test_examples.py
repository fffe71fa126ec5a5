"""The bundled cabinet is what its script makes, and its stated joints move freely."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.collision import CollisionManager

from examples.make_cabinet import JOINTS, TrueJoint, build_cabinet, write_cabinet
from tests.places import ROOT

CABINET = ROOT / "examples" / "cabinet"


def test_committed_files_are_what_the_script_writes(tmp_path: Path) -> None:
    write_cabinet(tmp_path)
    made = {path.name: path.read_text("utf-8") for path in tmp_path.iterdir()}
    assert made == {path.name: path.read_text("utf-8") for path in CABINET.iterdir()}
    assert sum(map(len, made.values())) < 200_000


def test_parts_are_closed() -> None:
    assert [name for name, mesh in build_cabinet().items() if not mesh.is_watertight] == []


def moved_by(joint: TrueJoint, amount: float) -> np.ndarray:
    """World transform of the child when the joint moves by `amount` [rad or m]."""
    if joint.kind == "prismatic":
        return trimesh.transformations.translation_matrix(amount * np.array(joint.axis))
    return trimesh.transformations.rotation_matrix(amount, joint.axis, joint.pivot)


def touching(poses: dict[str, np.ndarray]) -> set[tuple[str, str]]:
    """Pairs of parts whose surfaces cross when some parts are moved."""
    manager = CollisionManager()
    for name, mesh in build_cabinet().items():
        manager.add_object(name, mesh, transform=poses.get(name, np.eye(4)))
    return manager.in_collision_internal(return_names=True)[1]


@pytest.mark.parametrize("joint", JOINTS, ids=lambda joint: joint.child)
def test_joints_open_freely_in_the_positive_direction(joint: TrueJoint) -> None:
    full = {"revolute": 1.7, "prismatic": 0.3, "continuous": 3.1}[joint.kind]
    for amount in np.linspace(0.0, full, 7):
        T_moved = moved_by(joint, amount)
        carried = {other.child for other in JOINTS if other.parent == joint.child}
        assert touching(dict.fromkeys({joint.child, *carried}, T_moved)) == set()


@pytest.mark.parametrize(
    "joint", [joint for joint in JOINTS if joint.kind != "continuous"], ids=lambda joint: joint.child
)
def test_the_other_direction_is_blocked(joint: TrueJoint) -> None:
    amount = -0.3 if joint.kind == "revolute" else -0.05
    assert touching({joint.child: moved_by(joint, amount)}) != set()
