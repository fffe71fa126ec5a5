"""Mesh files of a model: each that cannot be used is named, and slips of units are found at the right link or joint."""

from __future__ import annotations

import struct
import time
from pathlib import Path

import pytest
import trimesh

from kinematify.config.validation import load_settings
from kinematify.robot.robot import Robot
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import Cause, CheckResult, Finding, Severity, Status
from kinematify.validation.run.needs import Recorder, meshes
from kinematify.validation.stage import StageRequest

SETTINGS = load_settings()
MESH_CHECKS = [check for check in CHECKS if "KV15" <= check < "KV16"]
MODEL = """\
<robot name="cupboard">
  <link name="body">
    <visual><geometry><mesh filename="body.obj"/></geometry></visual>
    <collision><geometry><mesh filename="body.obj"/></geometry></collision>
  </link>
  <link name="door">
    <visual><geometry><mesh filename="door.stl" scale="1 1 1"/></geometry></visual>
    <collision><geometry><mesh filename="door.stl" scale="1 1 1"/></geometry></collision>
  </link>
  <joint name="hinge" type="revolute">
    <origin xyz="0.4 0 0"/>
    <parent link="body"/>
    <child link="door"/>
    <axis xyz="0 0 1"/>
    <limit lower="0" upper="1.5" effort="1" velocity="1"/>
  </joint>
</robot>
"""


@pytest.fixture
def cupboard(tmp_path: Path) -> Path:
    (tmp_path / "model.urdf").write_text(MODEL)
    trimesh.creation.box(extents=(0.8, 0.8, 1.0)).export(tmp_path / "body.obj")
    trimesh.creation.box(extents=(0.8, 0.02, 1.0)).export(tmp_path / "door.stl")
    return tmp_path / "model.urdf"


def check_model(path: Path) -> tuple[Robot | None, dict[str, CheckResult]]:
    results: list[CheckResult] = []
    request = StageRequest(
        urdf=path,
        package_dirs=(),
        work=path.parent,
        settings=SETTINGS,
        selected=frozenset(MESH_CHECKS),
        deadline=time.process_time() + 60.0,
    )
    model = meshes(request, Recorder(results.append, request))
    assert sorted(result.check for result in results) == MESH_CHECKS, "every check is reported once"
    return model, {result.check: result for result in results}


def bad(results: dict[str, CheckResult]) -> list[Finding]:
    return [f for result in results.values() for f in result.findings if f.severity is not Severity.NOTE]


def change(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_sound_meshes_pass(cupboard: Path) -> None:
    model, results = check_model(cupboard)
    assert model is not None
    assert all(result.status is Status.PASS for result in results.values())
    assert not any(result.findings for result in results.values())


def truncated(folder: Path) -> None:
    content = (folder / "door.stl").read_bytes()
    (folder / "door.stl").write_bytes(content[: len(content) // 2])


def lying(folder: Path) -> None:
    content = (folder / "door.stl").read_bytes()
    (folder / "door.stl").write_bytes(content[:80] + struct.pack("<I", 2**31) + content[84:])


def empty(folder: Path) -> None:
    (folder / "door.stl").write_bytes(b"")


def not_a_mesh(folder: Path) -> None:
    (folder / "door.stl").write_text("<robot/>")


@pytest.mark.parametrize("damage", [truncated, lying, empty, not_a_mesh])
def test_a_damaged_mesh_is_left_out_and_named_with_its_link(damage, cupboard: Path) -> None:
    damage(cupboard.parent)
    model, results = check_model(cupboard)
    assert model is not None
    assert [link.name for link in model.links if not link.has_geometry] == ["door"]
    (found,) = [item for item in bad(results) if item.check == "KV150"]
    assert (found.check, found.link, found.line, found.cause) == ("KV150", "door", 8, Cause.ASSET)
    assert "door.stl" in found.message


def test_every_damaged_mesh_is_reported_at_once(cupboard: Path) -> None:
    truncated(cupboard.parent)
    (cupboard.parent / "body.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    model, results = check_model(cupboard)
    assert model is not None
    assert [f.link for f in bad(results)] == ["body", "door"]
    assert results["KV158"].status is not Status.BLOCKED


@pytest.mark.parametrize("number", ["nan", "inf", "1e300"])
def test_wild_coordinates_are_refused(number: str, cupboard: Path) -> None:
    (cupboard.parent / "body.obj").write_text(f"v 0 0 0\nv 1 0 0\nv 0 {number} 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    model, results = check_model(cupboard)
    assert model is None
    assert [(f.check, f.link) for f in bad(results)] == [("KV151", "body")]


def test_a_flat_collision_mesh_is_a_matter_of_physics(cupboard: Path) -> None:
    (cupboard.parent / "body.obj").write_text("v 0 0 0\nv 1 0 0.3\nv 0 1 0.1\nv 1 1 0.4\nf 1 2 3\nf 2 4 3\n")
    model, results = check_model(cupboard)
    assert model is not None
    assert [(f.check, f.link, f.severity, f.cause) for f in bad(results)] == [
        ("KV153", "body", Severity.WARNING, Cause.PHYSICS)
    ]


def test_a_collision_mesh_inside_out_is_found(cupboard: Path) -> None:
    mesh = trimesh.creation.icosphere()
    mesh.invert()
    mesh.export(cupboard.parent / "body.obj")
    _, results = check_model(cupboard)
    assert [(f.check, f.link) for f in bad(results)] == [("KV156", "body")]


def test_too_many_triangles_for_an_stl_are_a_warning(cupboard: Path) -> None:
    trimesh.creation.icosphere(subdivisions=7).export(cupboard.parent / "door.stl")
    model, results = check_model(cupboard)
    assert model is not None
    assert [(f.check, f.link, f.value) for f in bad(results)] == [("KV152", "door", 327680.0)]


@pytest.mark.parametrize("factor", [1000.0, 0.001])
def test_one_mesh_in_another_unit_names_its_link(factor: float, cupboard: Path) -> None:
    change(cupboard, 'scale="1 1 1"', f'scale="{factor} {factor} {factor}"')
    _, results = check_model(cupboard)
    slips = [f for f in bad(results) if f.check == "KV157"]
    assert [(f.link, f.cause, f.severity) for f in slips] == [("door", Cause.ASSET, Severity.ERROR)]


@pytest.mark.parametrize(("button", "reported"), [(0.03, []), (0.006, ["door"])])
def test_a_button_of_a_lorry_is_in_the_same_unit(button: float, reported: list[str], cupboard: Path) -> None:
    trimesh.creation.box((6.0, 2.0, 2.0)).export(cupboard.parent / "body.obj")
    trimesh.creation.box((button, button, button)).export(cupboard.parent / "door.stl")
    bed = '<link name="bed"><visual><geometry><mesh filename="body.obj"/></geometry></visual></link>'
    joint = '<joint name="bolted" type="fixed"><parent link="body"/><child link="bed"/></joint>'
    change(cupboard, "</robot>", f"{bed}{joint}</robot>")
    _, results = check_model(cupboard)
    assert [f.link for f in bad(results) if f.check == "KV157" and f.joint is None] == reported


def test_an_origin_in_millimetres_names_its_joint(cupboard: Path) -> None:
    change(cupboard, 'xyz="0.4 0 0"', 'xyz="400 0 0"')
    _, results = check_model(cupboard)
    slips = [f for f in bad(results) if f.check == "KV157"]
    assert [(f.joint, f.cause) for f in slips] == [("hinge", Cause.KINEMATICS)]


@pytest.mark.parametrize(
    ("factor", "severity"), [(1000.0, Severity.ERROR), (20.0, Severity.WARNING), (0.001, Severity.ERROR)]
)
def test_a_whole_model_in_another_unit_is_found(factor: float, severity: Severity, cupboard: Path) -> None:
    for name in ("body.obj", "door.stl"):
        mesh = trimesh.load_mesh(cupboard.parent / name)
        mesh.apply_scale(factor)
        mesh.export(cupboard.parent / name)
    change(cupboard, 'xyz="0.4 0 0"', f'xyz="{0.4 * factor} 0 0"')
    _, results = check_model(cupboard)
    assert [(f.check, f.severity) for f in bad(results)] == [("KV158", severity)]


LYING = """<robot name="poles">
  <link name="low"><visual><geometry><mesh filename="pole.dae"/></geometry></visual></link>
  <link name="high"><visual><geometry><mesh filename="pole.dae"/></geometry></visual></link>
  <joint name="turn" type="continuous">
    <origin xyz="0 0 3"/><parent link="low"/><child link="high"/><axis xyz="0 0 1"/>
  </joint>
</robot>"""


def test_meshes_that_meet_only_with_the_up_axis_that_they_state_are_one_finding(tmp_path: Path) -> None:
    (tmp_path / "model.urdf").write_text(LYING)
    trimesh.creation.box(bounds=[[0, 0, 0], [1, 3, 1]]).export(tmp_path / "pole.dae")  # states Y_UP
    model, results = check_model(tmp_path / "model.urdf")
    assert [(f.check, f.severity) for f in bad(results)] == [("KV159", Severity.WARNING)]
    assert "It is applied here" in results["KV159"].findings[0].message
    assert model is not None
    assert float(model.links[0].meshes[0].vertices[:, 2].max()) == pytest.approx(3.0)
