"""What published files have that nobody expects: judged or refused in a clear sentence, never a crash."""

from __future__ import annotations

from pathlib import Path

import pytest
import trimesh

from kinematify.cli.verdict import describe
from kinematify.config.validation import load_settings
from kinematify.robot.read import read_robot
from kinematify.validation.document_copy import readable_copy
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run import validate
from kinematify.validation.stage import StageRequest

LIMIT = '<limit lower="0" upper="0.05" effort="10" velocity="1"/>'
BOX = '<box size="0.1 0.1 0.1"/>'
INERTIAL = '<inertial><mass value="1"/><inertia ixx="2e-3" iyy="2e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial>'


def robot(*, limit: str = LIMIT, shape: str = BOX, base: str = "base", part: str = "part") -> str:
    """A block that slides on another one."""

    def link(name: str, shape: str) -> str:
        shapes = "".join(f"<{tag}><geometry>{shape}</geometry></{tag}>" for tag in ("visual", "collision"))
        return f'<link name="{name}">{INERTIAL}{shapes}</link>\n'

    return (
        f'<?xml version="1.0" encoding="utf-8"?>\n<robot name="r">\n{link(base, BOX)}{link(part, shape)}'
        f'<joint name="slide" type="prismatic">\n<parent link="{base}"/><child link="{part}"/>'
        f'<origin xyz="0 0 0.1"/><axis xyz="1 0 0"/>{limit}</joint>\n</robot>\n'
    )


def chain(links: int) -> str:
    bodies = "".join(f'<link name="l{k}">{INERTIAL}</link>\n' for k in range(links))
    joints = "".join(
        f'<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/><axis xyz="0 0 1"/>'
        f"{LIMIT}</joint>\n"
        for k in range(links - 1)
    )
    return f'<robot name="r">\n{bodies}{joints}</robot>'


def mesh(name: str) -> str:
    return f'<mesh filename="{name}"/>'


CASES = {
    "two limits": (robot(limit=LIMIT + LIMIT.replace("0.05", "0.04")), "KV105", "has 2 <limit> elements"),
    "no velocity": (robot(limit=LIMIT.replace('velocity="1"', 'velocity="0"')), "KV223", "velocity=0"),
    "a path of Windows": (robot(shape=mesh("C:\\meshes\\part.stl")), "KV141", "part.stl"),
    "a mesh without faces": (robot(shape=mesh("points.obj")), "KV150", "no triangle"),
    "2,000 links": (chain(2000), "KV103", "2000 links"),
    "a package that is nowhere": (robot(shape=mesh("package://gone/part.stl")), "KV141", "package://gone/part.stl"),
}


@pytest.mark.parametrize("case", CASES)
def test_what_is_odd_is_reported_in_one_sentence_at_its_line(case: str, tmp_path: Path) -> None:
    text, check, words = CASES[case]
    (tmp_path / "points.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n")
    path = tmp_path / "model.urdf"
    path.write_text(text, encoding="utf-8")
    report = validate(path, engines=(), workers=1)
    (finding,) = [item for item in report.findings if item.check == check and words in item.message]
    assert finding.line is not None or check == "KV103"
    assert not [item.reason for item in report.checks if "Error" in (item.reason or "")], "no check fell over"
    assert len(describe(report).splitlines()) <= 30


def test_checks_that_a_broken_text_blocks_are_counted_in_a_line(tmp_path: Path) -> None:
    path = tmp_path / "model.urdf"
    path.write_text(robot().replace("</robot>", ""))
    report = validate(path, workers=1)
    blocked = sum(item.status is Status.BLOCKED for item in report.checks)
    (line,) = [line for line in describe(report, everything=True).splitlines() if line.startswith("  blocked (")]
    assert line.startswith(f"  blocked ({blocked} checks): ")


@pytest.mark.parametrize(("collides", "severity"), [(False, Severity.WARNING), (True, Severity.ERROR)])
def test_a_missing_mesh_is_one_finding_and_the_rest_is_judged(
    tmp_path: Path, collides: bool, severity: Severity
) -> None:
    path, tag = tmp_path / "model.urdf", "collision" if collides else "visual"
    lost = f"<{tag}><geometry>{mesh('gone.obj')}</geometry></{tag}>"
    path.write_text(robot().replace("</link>", f"{lost}</link>", 1))
    report = validate(path, engines=("mujoco",), workers=1)
    assert not [item.check for item in report.checks if item.status is Status.BLOCKED]
    assert [item.severity for item in report.findings if item.check == "KV141"] == [severity]
    assert "MuJoCo 1 of 1 joints move" in report.as_loaded


MIMIC = '<mimic joint="gone"/></joint>'


@pytest.mark.parametrize(
    ("fault", "check"),
    [
        ((BOX, mesh("nan.obj")), "KV151"),
        (("</joint>", MIMIC), "KV127"),
        (('"0 0 0.1"', '"0, 0, 0.1"'), "KV132"),
        ((' effort="', ' effort="about '), "KV132"),
        (("</joint>", '<dynamics damping="much"/></joint>'), "KV132"),
        (("</link>", '<inertial><mass value="2 kg"/></inertial></link>'), "KV132"),
    ],
)
def test_a_broken_mesh_mimic_or_number_blocks_nothing_else(tmp_path: Path, fault: tuple[str, str], check: str) -> None:
    (tmp_path / "nan.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 nan 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    path = tmp_path / "model.urdf"
    path.write_text(robot().replace(*fault, 1))
    report = validate(path, engines=("mujoco",), workers=1)
    assert not [(item.check, item.reason) for item in report.checks if item.status is Status.BLOCKED]
    assert [item.check for item in report.findings if item.severity is Severity.ERROR][:1] == [check]
    assert "MuJoCo 1 of 1 joints move" in report.as_loaded


ARM = """<robot name="arm">{head}
  <link name="base"><inertial><mass value="1"/><inertia ixx="1e-2" iyy="1e-2" izz="1e-2" ixy="0" ixz="0" iyz="0"/>
    </inertial><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="arm"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
    <inertia ixx="1e-2" iyy="1e-2" izz="1e-2" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="arm.stl"/></geometry></visual>
    <collision><geometry><mesh filename="arm.stl"/></geometry></collision></link>
  <link name="tool"><visual><geometry><sphere radius="0.005"/></geometry></visual></link>
  <joint name="turn" type="revolute"><origin xyz="0 0 0.1"/><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="9" velocity="1"/></joint>
  <joint name="fixed" type="fixed"><origin xyz="0.3 0 0"/><parent link="arm"/><child link="tool"/></joint>
  <link name="grip"><inertial><mass value="1e-3"/><inertia ixx="2e-8" iyy="2e-8" izz="2e-8" ixy="0" ixz="0" iyz="0"/>
    </inertial><collision><geometry><box size="0.01 0.01 0.01"/></geometry></collision></link>
  <joint name="close" type="prismatic"><origin xyz="0.305 0 0.02"/><parent link="arm"/><child link="grip"/>
    <axis xyz="0 1 0"/><limit lower="-0.01" upper="0.01" effort="9" velocity="1"/></joint>
</robot>"""


def test_of_a_body_without_its_mesh_nothing_is_said_about_its_room(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(ARM.format(head=""))
    report = validate(path, engines=(), selected=("KV1*", "KV2*", "KV3*"), workers=1)
    assert {item.check for item in report.findings if item.severity is not Severity.NOTE} == {"KV141"}


def test_meshes_are_found_where_the_file_tells_mujoco_to_look(tmp_path: Path) -> None:
    path = tmp_path / "urdf" / "arm.urdf"
    (tmp_path / "meshes").mkdir()
    path.parent.mkdir()
    trimesh.creation.box(bounds=[[-0.05, -0.05, 0.0], [0.3, 0.05, 0.05]]).export(tmp_path / "meshes" / "arm.stl")
    path.write_text(ARM.format(head='<mujoco><compiler meshdir="../meshes"/></mujoco>'))
    report = validate(path, engines=("mujoco",), workers=1)
    assert "MuJoCo 2 of 2 joints move" in report.as_loaded
    assert not [item.message for item in report.findings if item.severity is not Severity.NOTE]


def test_a_copy_lacks_the_one_shape_of_a_line_that_is_broken(tmp_path: Path) -> None:
    shapes = (f'<collision><geometry><box size="1 {side} 1"/></geometry></collision>' for side in (1, -1))
    path = tmp_path / "lid.urdf"
    path.write_text(f'<robot name="lid"><link name="lid">{"".join(shapes)}</link></robot>')
    report = validate(path, engines=(), selected=("KV138", "KV158", "KV240"), workers=1)
    assert {item.check: item.status for item in report.checks}["KV240"] is Status.PASS
    (copy,) = report.findings
    request = StageRequest(
        urdf=path, package_dirs=(), work=tmp_path, settings=load_settings(), selected=frozenset(), deadline=60.0
    )
    readable = readable_copy(request, [copy])
    assert readable is not None
    assert [shape.size for shape in read_robot(readable.path).links[0].collisions] == [(1.0, 1.0, 1.0)]


def test_names_and_meshes_in_any_script_are_kept(tmp_path: Path) -> None:
    trimesh.creation.box((0.1, 0.1, 0.1)).export(tmp_path / "würfel.obj")
    path = tmp_path / "möbel.urdf"
    path.write_text(robot(base="gehäuse", part="抽屉", shape=mesh("würfel.obj")), encoding="utf-8")
    report = validate(path, engines=("pybullet",), selected=("KV8*", "KV801", "KV804", "KV201"), workers=1)
    assert report.verdict == "pass"
    assert "PyBullet 1 of 1 joints move" in report.as_loaded


@pytest.mark.parametrize("end", ["</joint>", MIMIC])
def test_findings_of_geometry_have_the_line_of_their_joint_or_link(end: str, tmp_path: Path) -> None:
    path = tmp_path / "model.urdf"
    path.write_text(robot().replace('xyz="0 0 0.1"', 'xyz="0 0 0.4"').replace("</joint>", end))
    report = validate(path, engines=(), selected=("KV202", "KV303", "KV301"), workers=1)
    (finding,) = [item for item in report.findings if item.check == "KV303"]
    lines = path.read_text().splitlines()
    assert finding.line is not None
    assert 'joint name="slide"' in lines[finding.line - 1]


FINE = {
    "a package in a folder of another name": [(BOX, mesh("package://my_robot/part.stl"))],
    "a prefix without a namespace": [("</robot>", "<drake:joint/></robot>")],
    "an attribute with such a prefix": [('effort="10"', 'effort="10" drake:acceleration="9"')],
    "macros that nobody calls": [
        ('<robot name="r">', '<robot name="r" xmlns:xacro="x"><xacro:macro name="m"><link name="${n}"/></xacro:macro>')
    ],
    "a value with a default": [
        ('name="r"', 'name="r" xmlns:xacro="http://ros.org/wiki/xacro"'),
        ('"0 0 0.1"', '"$(optenv PLACE 0 0 0.1)"'),
    ],
    "a visual in VRML": [("</link>", f"<visual><geometry>{mesh('look.wrl')}</geometry></visual></link>")],
    "a wrist of 445 deg": [("prismatic", "revolute"), ('lower="0" upper="0.05"', 'lower="-3.883" upper="3.883"')],
    "turns without a bound": [("prismatic", "revolute"), ('lower="0" upper="0.05"', 'lower="-10.4" upper="10.01"')],
    "a drive without a bound": [('effort="10" velocity="1"', 'effort="1e9" velocity="1e9"')],
    "a hook on a rope": [('"0 0 0.1"', '"0 0 -0.1"'), ('"1 0 0"', '"0 0 -1"'), ('"0.05"', '"0.5"')],
}


@pytest.mark.parametrize("case", FINE)
def test_what_published_files_have_is_no_error_and_blocks_nothing(case: str, tmp_path: Path) -> None:
    text, path = robot(), tmp_path / "clone-main" / "model.urdf"
    for old, new in FINE[case]:
        assert old in text
        text = text.replace(old, new, 1)
    path.parent.mkdir()
    path.write_text(text)
    (path.parent / "package.xml").write_text("<package><name>my_robot</name></package>")
    (path.parent / "look.wrl").write_text("#VRML V2.0 utf8\n")
    trimesh.creation.box((0.1, 0.1, 0.1)).export(path.parent / "part.stl")
    report = validate(path, workers=1)
    assert not [(item.check, item.reason) for item in report.checks if item.status is Status.BLOCKED]
    assert not [item.message for item in report.findings if item.severity is Severity.ERROR]
    assert not [item.message for item in report.findings if item.check in {"KV133", "KV321"}]
    assert "PyBullet 1 of 1" in report.as_loaded or case == "a visual in VRML"
