"""STEP: instances with names and colours become parts; joints lie exactly on cylinders and planes of the file."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.assembly.load import load_assembly
from kinematify.errors import AssemblyError, EnvironmentFault
from kinematify.pipeline.infer_assembly import infer
from kinematify.robot.joint_type import JointType
from tests.places import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.assembly.part import Assembly

CUPBOARD = ROOT / "examples" / "cupboard.step"
"""Written by examples/make_step.py: millimetres, turned by 17 deg and put aside by (120, 80, 0) mm."""
TURN = np.radians(17.0)
T_WORLD_CUPBOARD = np.array(
    [
        [np.cos(TURN), -np.sin(TURN), 0.0, 0.12],
        [np.sin(TURN), np.cos(TURN), 0.0, 0.08],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]
)
EXACT = 1e-6


@pytest.fixture(scope="module")
def cupboard() -> Assembly:
    pytest.importorskip("cascadio", reason="the extra `cad` is not installed")
    return load_assembly(CUPBOARD)


def test_instances_become_named_and_coloured_parts_in_metres(cupboard: Assembly) -> None:
    assert cupboard.names == ("carcass", "door", "knob", "lower_drawer", "upper_drawer")
    colors = {part.name: part.color for part in cupboard.parts}
    assert colors["lower_drawer"] == colors["upper_drawer"] == pytest.approx((0.85, 0.45, 0.15), abs=0.01)
    assert colors["door"] == pytest.approx((0.2, 0.45, 0.75), abs=0.01)
    lower, upper = (next(part for part in cupboard.parts if part.name == f"{k}_drawer") for k in ("lower", "upper"))
    assert np.allclose(upper.vertices - lower.vertices, (0.0, 0.0, 0.191), atol=1e-6)
    assert cupboard.bounds[:, 2] == pytest.approx((0.0, 0.4), abs=1e-6)
    assert not cupboard.warnings


def test_joints_lie_on_the_cylinders_and_planes_of_the_file(cupboard: Assembly) -> None:
    joints = {cupboard.names[joint.child]: joint for joint in infer(cupboard).joints}
    assert {name: joint.kind for name, joint in joints.items()} == {
        "door": JointType.REVOLUTE,
        "knob": JointType.CONTINUOUS,
        "lower_drawer": JointType.PRISMATIC,
        "upper_drawer": JointType.PRISMATIC,
    }
    for name, point, axis in (("door", (0.593, -0.015, 0.0), (0, 0, 1)), ("knob", (0.33, 0.0, 0.2), (0, 1, 0))):
        direction = T_WORLD_CUPBOARD[:3, :3] @ np.array(axis)
        on_line = T_WORLD_CUPBOARD[:3, :3] @ np.array(point) + T_WORLD_CUPBOARD[:3, 3]
        assert np.linalg.norm(np.cross(joints[name].axis, direction)) < EXACT
        assert np.linalg.norm(np.cross(joints[name].pivot - on_line, direction)) < EXACT
    for name in ("lower_drawer", "upper_drawer"):
        assert np.allclose(joints[name].axis, -T_WORLD_CUPBOARD[:3, 1], rtol=0.0, atol=EXACT)


def test_a_turned_and_scaled_file_takes_its_exact_faces_along(cupboard: Assembly) -> None:
    turned = load_assembly(CUPBOARD, up="y", scale=2.0)
    for before, after in zip(cupboard.parts, turned.parts, strict=True):
        assert before.exact is not None
        assert after.exact is not None
        assert np.allclose(after.exact.points, 2.0 * before.exact.points[:, [0, 2, 1]] * (1, -1, 1))
        assert np.allclose(after.exact.axes, before.exact.axes[:, [0, 2, 1]] * (1, -1, 1))


def test_a_truncated_file_is_reported_with_its_line(tmp_path: Path) -> None:
    pytest.importorskip("cascadio", reason="the extra `cad` is not installed")
    broken = tmp_path / "broken.stp"
    broken.write_text(CUPBOARD.read_text(encoding="utf-8")[:100_000], encoding="utf-8")
    with pytest.raises(
        AssemblyError, match=r"broken\.stp cannot be read .*Line \d+.*unexpected end of file.*export it"
    ):
        load_assembly(broken)


def test_without_the_package_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cascadio", None)
    with pytest.raises(EnvironmentFault, match=r"GLB.* install .?cascadio"):
        load_assembly(CUPBOARD)
