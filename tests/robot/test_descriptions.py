"""Descriptions of other formats: read as their own engines read them, and bounded where they are hostile."""

from __future__ import annotations

import subprocess
from pathlib import Path

import mujoco
import numpy as np
import pybullet
import pytest
import trimesh
from pxr import Usd, UsdUtils
from pybullet_utils.bullet_client import BulletClient

import kinematify
from kinematify.cli.app import run
from kinematify.errors import DescriptionError
from kinematify.formats.export_model import export
from kinematify.refinement.urdf_editor import UrdfEditor
from kinematify.robot.description import form_of, open_description
from kinematify.robot.mesh_paths import near_mesh
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Robot, forward_kinematics, joint_values
from kinematify.robot.transforms import rotation_from_rpy
from kinematify.validation.finding import Severity, Status
from kinematify.validation.run import validate

MJCF = """<mujoco model="crane">
  <compiler angle="degree" eulerseq="zyx"/>
  <default><geom rgba="0.2 0.4 0.6 1"/></default>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <geom type="box" size="0.2 0.2 0.05"/>
    <body name="mast" pos="0 0 0.1" euler="0 0 40">
      <joint name="turn" axis="0 0 1" range="-90 90" damping="2" frictionloss="0.5"/>
      <joint name="lift" type="slide" axis="0 0 1" pos="0.1 0 0" range="0 0.3" ref="0.1"/>
      <geom type="cylinder" size="0.05 0.4" pos="0 0 0.4"/>
      <body name="boom" pos="0.05 0 0.8">
        <joint name="pitch" axis="0 1 1" pos="0.02 0.01 0" ref="15"/>
        <geom type="capsule" fromto="0 0 0 0.6 0 0" size="0.03"/>
        <geom type="ellipsoid" size="0.05 0.04 0.03" pos="0.6 0 0" contype="0" conaffinity="0" mass="0"/>
        <body name="hook" pos="0.6 0 -0.1">
          <joint name="swing" type="ball"/>
          <geom type="sphere" size="0.04"/>
        </body>
        <body name="counter" pos="-0.1 0 0">
          <joint name="follow" axis="0 1 0"/><geom type="box" size=".05 .05 .05"/>
        </body>
      </body>
    </body>
  </worldbody>
  <equality><joint joint1="follow" joint2="pitch" polycoef="0.1 -2 0 0 0"/></equality>
  <actuator><motor joint="turn" gear="5" ctrlrange="-2 2"/></actuator>
  <sensor><jointpos joint="turn"/></sensor>
</mujoco>
"""


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def center(robot: Robot, link: str, q: dict[str, float]) -> np.ndarray:
    """Centre of mass of a link in the frame of the root."""
    inertial = robot.link_by_name[link].inertial
    assert inertial is not None
    return (forward_kinematics(robot, q)[link] @ np.append(inertial.center_of_mass, 1.0))[:3]


def test_an_mjcf_moves_as_in_mujoco_and_its_losses_are_listed(tmp_path: Path) -> None:
    path = written(tmp_path, "crane.xml", MJCF)
    robot, model = read_robot(path), mujoco.MjModel.from_xml_path(str(path))
    data, draw = mujoco.MjData(model), np.random.default_rng(1)
    for _ in range(4):
        q = {name: float(draw.uniform(-0.5, 0.5)) for name in ("turn", "lift", "pitch")}
        for name, value in joint_values(robot, q).items():
            if name in ("turn", "lift", "pitch", "follow"):
                data.joint(name).qpos = value
        mujoco.mj_kinematics(model, data)
        for name in ("mast", "boom", "hook", "counter"):
            np.testing.assert_allclose(center(robot, name, q), data.body(name).xipos, atol=1e-6)
            rotation = forward_kinematics(robot, q)[name][:3, :3]
            np.testing.assert_allclose(rotation, data.body(name).xmat.reshape(3, 3), atol=1e-6)
    turn, lift = robot.joint_by_name["turn"], robot.joint_by_name["lift"]
    assert (turn.effort, turn.damping, turn.friction, turn.line) == (10.0, 2.0, 0.5, 8)
    assert (lift.lower, lift.upper, lift.kind) == (0.0, 0.3, "prismatic")
    assert robot.link_by_name["boom"].line == 11
    assert len(robot.link_by_name["boom"].visuals) == 2
    assert all(shape.mesh.appearance for shape in robot.link_by_name["boom"].visuals), "infer shows its colours"
    assert len(robot.link_by_name["boom"].collisions) == 1
    said = " ".join(robot.notes)
    for word in ("ball joint swing is read as fixed", "mast", "(1): sensors", "type plane: floor"):
        assert word in said


INERTIA = "<inertia><ixx>0.02</ixx><ixy>0</ixy><ixz>0</ixz><iyy>0.03</iyy><iyz>0</iyz><izz>0.04</izz></inertia>"
SDF = """<sdf version="{version}"><model name="arm"><pose>1 2 3 0 0 1</pose>
<link name="base"><inertial><mass>2</mass>{inertia}</inertial>
  <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link>
<link name="upper"><pose>0.1 0 0.2 0.3 0 0.5</pose><inertial><pose>0 0 0.1 0 0.2 0</pose><mass>1</mass>
  {inertia}</inertial>
  <visual name="v"><pose>0 0 0.1 0 0 0</pose><geometry><cylinder><radius>0.02</radius><length>0.2</length></cylinder>
  </geometry><material><diffuse>1 0 0 1</diffuse></material></visual></link>
<link name="tip"><pose>0.1 0.2 0.4 0 0 0</pose><inertial><mass>0.1</mass>{inertia}</inertial></link>
<joint name="hinge" type="revolute"><parent>base</parent><child>upper</child><pose>0 0 -0.05 0 0 0.4</pose>
  <axis><xyz>0 1 0</xyz><limit><lower>-1</lower><upper>2</upper><effort>7</effort></limit></axis></joint>
<joint name="slide" type="prismatic"><parent>upper</parent><child>tip</child>
  <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>0.1</upper></limit></axis></joint>
{more}</model></sdf>
"""


def test_an_sdf_moves_as_in_pybullet(tmp_path: Path) -> None:
    text = SDF.format(version="1.6", more="", inertia=INERTIA)
    text = text.replace("<pose>0 0 -0.05 0 0 0.4</pose>", "")  # PyBullet skips poses of joints
    path = written(tmp_path, "arm.sdf", text)
    robot, client = read_robot(path), BulletClient(pybullet.DIRECT)
    (body,) = client.loadSDF(str(path))
    joints = {client.getJointInfo(body, k)[1].decode(): k for k in range(client.getNumJoints(body))}
    links = {client.getJointInfo(body, k)[12].decode(): k for k in joints.values()}
    q = {"hinge": 0.7, "slide": 0.04}
    for name, value in q.items():
        client.resetJointState(body, joints[name], value)
    (p, _), (t, _) = (
        client.getLinkState(body, links[name], computeForwardKinematics=1)[:2] for name in ("upper", "tip")
    )
    turned = rotation_from_rpy(np.array([0.0, 0.0, 1.0]))  # the model's own pose
    ours = turned @ (center(robot, "tip", q) - center(robot, "upper", q))
    np.testing.assert_allclose(np.subtract(t, p), ours, atol=1e-6)
    assert robot.joint_by_name["hinge"].effort == 7.0


def test_frames_axes_and_losses_of_a_new_sdf(tmp_path: Path) -> None:
    more = """<joint name="world_joint" type="fixed"><parent>world</parent><child>base</child></joint>
<frame name="mount" attached_to="upper"><pose>0 0 0.3 0 0 0</pose></frame>
<link name="pen"><pose relative_to="mount" degrees="true">0 0.1 0 0 0 90</pose></link>
<joint name="spin" type="revolute"><parent>mount</parent><child>pen</child>
  <axis><xyz expressed_in="__model__">0 0 1</xyz><mimic joint="hinge"><multiplier>2</multiplier><offset>0.5</offset>
  <reference>0.1</reference></mimic></axis></joint>
<joint name="joint_u" type="universal"><parent>pen</parent><child>wheel</child><axis><xyz>1 0 0</xyz></axis>
  <axis2><xyz>0 1 0</xyz></axis2></joint><link name="wheel"><pose relative_to="pen">0 0 0.1 0 0 0</pose>
  <visual name="p"><geometry><plane/></geometry></visual></link>"""
    robot = read_robot(written(tmp_path, "arm.sdf", SDF.format(version="1.9", more=more, inertia=INERTIA)))
    spin = robot.joint_by_name["spin"]
    assert spin.kind == "continuous"
    assert spin.parent == "upper"
    assert spin.mimic is not None
    assert (spin.mimic.multiplier, spin.mimic.offset) == (2.0, pytest.approx(0.3))
    R_base_upper = forward_kinematics(robot, {})["upper"][:3, :3]
    # The axis is the model's z, seen from the pen, which is turned by the link and by 90 deg.
    np.testing.assert_allclose(R_base_upper @ spin.T_parent_child[:3, :3] @ spin.axis, [0, 0, 1], atol=1e-12)
    assert [joint.parent for joint in robot.joints if joint.child == "wheel"] == ["joint_u_between"]
    assert any("plane" in note for note in robot.notes)


LINK = """<link name="{0}"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/>
</inertial><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>"""
JOINT = """<joint name="{0}_{1}" type="{2}"><parent link="{0}"/><child link="{1}"/>{3}<axis xyz="0.6 0 0.8"/>
<limit lower="-0.5" upper="0.5" effort="3" velocity="2"/></joint>"""


@pytest.mark.parametrize("form", ["mjcf", "sdf", "usd"])
def test_an_export_reads_back_with_the_same_motion(tmp_path: Path, form: str) -> None:
    origin = '<origin xyz="0.1 0.2 0.3" rpy="0.3 -0.2 1"/>'
    links = "".join(map(LINK.format, "abcd"))
    joints = [JOINT.format(*"ab", "revolute", origin), JOINT.format(*"bc", "prismatic", origin)]
    joints.append(JOINT.format(*"cd", "revolute", f'{origin}<mimic joint="a_b" multiplier="-2" offset="0.1"/>'))
    arm = written(tmp_path, "arm.urdf", f"<robot name='arm'>{links}{''.join(joints)}</robot>")
    given = read_robot(arm)
    suffix = {"mjcf": "xml", "sdf": "sdf", "usd": "usda"}[form]
    out = tmp_path / f"again.{suffix}"
    export(arm, form, out)
    assert form_of(out) == form
    again = read_robot(out)
    assert [joint.name for joint in again.leaders] == [joint.name for joint in given.leaders]
    q = {"a_b": 0.2, "b_c": 0.1}
    one, other = forward_kinematics(given, q), forward_kinematics(again, q)
    for name in "bcd":
        np.testing.assert_allclose(np.linalg.solve(other["a"], other[name]), one[name], atol=1e-6)
    opened = open_description(out, tmp_path)
    assert len(read_robot(opened.urdf).joints) == len(again.joints)


def test_faces_of_a_usd_are_cut_inside_of_them(tmp_path: Path) -> None:
    text = """#usda 1.0
(metersPerUnit = 1)
def Xform "u" (prepend apiSchemas = ["PhysicsRigidBodyAPI"]) {
def Mesh "m" {
  point3f[] points = [(0,0,0), (3,0,0), (3,2,0), (2,2,0), (2,1,0), (1,1,0), (1,2,0), (0,2,0)]
  int[] faceVertexCounts = [8]
  int[] faceVertexIndices = [0, 1, 2, 3, 4, 5, 6, 7]
}
}"""
    (shape,) = read_robot(written(tmp_path, "u.usda", text)).links[0].visuals
    assert trimesh.Trimesh(shape.mesh.vertices, shape.mesh.faces).area == pytest.approx(5.0)


XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="side" default="left"/><xacro:property name="long" value="${0.2 * 2}"/>
<xacro:include filename="$(find my_arm)/urdf/part.xacro"/>
<link name="base"/>
<xacro:part name="$(arg side)_arm" length="${long}"/>
</robot>"""
PART = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="part" params="name length">
<link name="${name}"><visual><geometry><box size="0.1 0.1 ${length}"/></geometry></visual>
<collision><geometry><mesh filename="./meshes/box.stl"/></geometry></collision></link>
<joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}"/></joint>
</xacro:macro></robot>"""


def test_a_xacro_is_expanded_without_ros(tmp_path: Path) -> None:
    package = tmp_path / "clone-of-my-arm"
    written(package, "package.xml", "<package><name>my_arm</name></package>")
    written(package, "urdf/part.xacro", PART)
    path = written(package, "urdf/arm.urdf.xacro", XACRO)
    (package / "meshes").mkdir()  # where the URDF is stored as a rule, beside the folder of the xacro
    trimesh.creation.box((0.1, 0.1, 0.1)).export(package / "meshes" / "box.stl")
    robot = read_robot(path, arguments={"side": "right"})
    assert [link.name for link in robot.links] == ["base", "right_arm"]
    assert robot.links[1].collisions[0].file == package / "meshes" / "box.stl"
    assert robot.links[1].visuals[0].size == (0.1, 0.1, 0.4)
    opened = open_description(path, tmp_path, arguments={"side": "right"})
    assert opened.lines["link", "base"] == 4
    with pytest.raises(DescriptionError, match="no xacro"):
        open_description(written(tmp_path, "a.urdf", "<robot/>"), tmp_path, arguments={"side": "right"})


@pytest.mark.parametrize(
    ("inside", "said"),
    [
        ("""<link name="$(eval open)"/>""", "open"),
        ("""<link name="${().__class__.__base__.__subclasses__()}"/>""", "__class__"),
        ("""<link name="${(lambda: ().__class__)()}"/>""", "__class__"),
        ("""<link name="${[g.gi_frame for g in [(x for x in [1])]]}"/>""", "gi_frame"),
        ("""<link name="$(find nowhere)"/>""", "nowhere"),
        ("""<xacro:include filename="hostile.urdf.xacro"/>""", "hostile"),
    ],
)
def test_a_hostile_xacro_runs_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, inside: str, said: str) -> None:
    monkeypatch.chdir(tmp_path)
    text = f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{inside}</robot>'
    with pytest.raises(DescriptionError, match=said):
        read_robot(written(tmp_path, "hostile.urdf.xacro", text))
    assert [item.name for item in tmp_path.iterdir()] == ["hostile.urdf.xacro"]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.usda", '#usda 1.0\ndef "a" (references = @../other/b.usda@) {}\n', "outside"),
        ("a.usda", '#usda 1.0\ndef Xform "a" {}\n', "no rigid body"),
        ("a.usda", "#usda 1.0\ndef def def", "does not open"),
        ("a.usd", 'def Xform "a" {}', "does not open"),
        ("a.xml", "<mujoco><include file='a.xml'/></mujoco>", "MuJoCo does not read"),
        ("a.xml", "<mujoco/>", "no body"),
        ("a.sdf", '<!DOCTYPE sdf [<!ENTITY a "b">]><sdf><model/></sdf>', "DOCTYPE"),
        ("a.sdf", "<sdf version='1.9'><world name='w'/></sdf>", "no model"),
        ("a.sdf", "<sdf version='1.9'><model><link name='a'><pose relative_to='a'/></link></model></sdf>", "itself"),
        ("a.sdf", "<sdf version='1.9'><model><link name='a'><pose>1 nan 0 0 0 0</pose></link></model></sdf>", "finite"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name(tmp_path: Path, name: str, text: str, said: str) -> None:
    written(tmp_path, "other/b.usda", '#usda 1.0\ndef "b" {}\n')
    with pytest.raises(DescriptionError, match=said):
        read_robot(written(tmp_path, f"here/{name}", text))


def test_findings_of_an_mjcf_name_its_lines_and_what_is_not_read(tmp_path: Path) -> None:
    text = MJCF.replace('range="0 0.3" ref="0.1"', 'range="0.05 0.3" ref="0.1"')
    report = validate(written(tmp_path, "crane.xml", text), engines=("mujoco",), selected=("KV108", "KV222"), workers=1)
    (zero,) = [item for item in report.findings if item.check == "KV222"]
    assert (zero.joint, zero.line) == ("lift", 9)
    assert any("sensors" in item.message for item in report.findings if item.check == "KV108")
    assert report.model.endswith("crane.xml")


def test_an_mjcf_whose_picture_or_skin_is_missing_is_judged_without_it(tmp_path: Path) -> None:
    lost = """<asset><texture name="wood" type="2d" file="wood.png"/><skin name="coat" file="coat.skn"/>
    <material name="oak" texture="wood" rgba="1 0 0 1"/></asset><worldbody>"""
    path = written(tmp_path, "crane.xml", MJCF.replace("<worldbody>", lost).replace('type="ball"', 'axis="0 1 0"'))
    found = [note for note in read_robot(path).notes if "omitted" in note]
    assert [name in note for name, note in zip(("texture wood", "skin coat"), found, strict=True)] == [True, True]
    report = validate(path, engines=("mujoco",), workers=1)
    assert not [item.check for item in report.checks if item.status is Status.BLOCKED]
    assert sum("wood.png" in item.message for item in report.findings if item.check == "KV108") == 1
    (opened,) = [item for item in report.findings if item.check == "KV801"]
    assert "none of the pictures" in opened.message
    assert "MuJoCo 3 of 4 joints move" in report.as_loaded  # the fourth follows


CABINET = """#usda 1.0
(upAxis = "{up}"
metersPerUnit = {unit}
defaultPrim = "top")
def Xform "top" {{
def Cube "base" (prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI", "PhysicsCollisionAPI"]) {{
double size = {size}
float physics:mass = 5
float3 physics:diagonalInertia = ({inertia}, {inertia}, {inertia})
}}
def Xform "door" (prepend apiSchemas = ["PhysicsRigidBodyAPI"]) {{
double3 xformOp:translate = {place}
uniform token[] xformOpOrder = ["xformOp:translate"]
def "shape" (references = </top/leaf>
instanceable = true) {{}}
}}
def Xform "leaf" {{
def Cube "box" {{
double size = {size}
}}
}}
def PhysicsRevoluteJoint "hinge" (prepend apiSchemas = ["PhysicsDriveAPI:angular"]) {{
rel physics:body0 = </top/base>
rel physics:body1 = </top/door>
point3f physics:localPos0 = {place}
uniform token physics:axis = "{up}"
float physics:lowerLimit = -90
float physics:upperLimit = 0
float drive:angular:physics:maxForce = {force}
float drive:angular:physics:damping = {force}
}}
}}"""


@pytest.mark.parametrize("form", ["usda", "usdc", "usdz", "reference", "cm", "y up"])
def test_a_usd_of_any_layout_is_the_same_model(tmp_path: Path, form: str) -> None:
    up, unit = ("Y" if form == "y up" else "Z"), (0.01 if form == "cm" else 1.0)
    place = (0.0, 1.0, 0.0) if up == "Y" else (0.0, 0.0, 1.0 / unit)
    text = CABINET.format(up=up, unit=unit, size=0.2 / unit, place=place, inertia=0.1 / unit**2, force=3.0 / unit**2)
    path = written(tmp_path, "cabinet.usda", text)
    if form in ("usdc", "reference"):
        stage = Usd.Stage.Open(str(path))
        stage.GetRootLayer().Export(str(tmp_path / "cabinet.usdc"))
        path = tmp_path / "cabinet.usdc"
    if form == "usdz":
        path = tmp_path / "cabinet.usdz"
        assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "cabinet.usda"), str(path))
    if form == "reference":
        head = '#usda 1.0\n(upAxis = "Z"\nmetersPerUnit = 1)\n'
        path = written(tmp_path, "whole.usda", f'{head}def "here" (references = @./cabinet.usdc@) {{}}')
    robot = read_robot(path)
    hinge, base = robot.joint_by_name["hinge"], robot.link_by_name["base"]
    assert base.inertial is not None
    assert base.inertial.mass == 5.0
    np.testing.assert_allclose(base.inertial.tensor, 0.1 * np.eye(3), rtol=1e-6)
    assert [hinge.lower, hinge.upper, hinge.effort] == pytest.approx([-np.pi / 2, 0.0, 3.0])
    assert hinge.damping == pytest.approx(3.0 * 180.0 / np.pi)
    root = forward_kinematics(robot, {})["base"]
    door = np.linalg.solve(root, forward_kinematics(robot, {"hinge": -1.0})["door"])
    np.testing.assert_allclose(np.linalg.norm(door[:3, 3]), 1.0, rtol=1e-6)
    (seen,) = robot.link_by_name["door"].visuals
    assert seen.size == pytest.approx((0.2, 0.2, 0.2))


def test_a_file_under_a_near_name_is_named_and_written(tmp_path: Path) -> None:
    (tmp_path / "Meshes").mkdir()
    trimesh.creation.box((0.1, 0.1, 0.1)).export(tmp_path / "Meshes" / "Base_Link.STL")
    mesh = '<geometry><mesh filename="{}"/></geometry>'
    shapes = [f"<visual>{mesh.format(name)}</visual>" for name in ("meshes/base_link.stl", "gone.stl", "")]
    collisions = [f"<collision>{mesh.format(name)}</collision>" for name in ("meshes/base_link.stl", "gone.stl")]
    turned = '<joint name="j" type="fixed"><origin quat_xyzw="0 0 1 1"/><parent link="a"/><child link="b"/></joint>'
    link = f'<link name="a">{"".join(shapes + collisions)}</link><link name="b"/>{turned}'
    path = written(tmp_path, "model.urdf", f"<robot name='r'>{link}</robot>")
    found = near_mesh("meshes/base_link.stl", tmp_path, ())
    assert found == tmp_path / "Meshes" / "Base_Link.STL"
    editor = UrdfEditor(path, tmp_path / "out" / "fixed.urdf")
    editor.settle_shapes()
    editor.write_rpy()
    fixed = read_robot(editor.write())
    assert not fixed.notes
    assert [len(fixed.links[0].visuals), len(fixed.links[0].collisions)] == [1, 1]
    assert 'rpy="0.0' in editor.out.read_text()
    np.testing.assert_allclose(fixed.joints[0].T_parent_child[:2, :2], [[0, -1], [1, 0]], atol=1e-9)


def test_a_package_whose_folder_has_another_name_is_found_above_the_file(tmp_path: Path) -> None:
    (tmp_path / "2R ARM_description" / "meshes").mkdir(parents=True)
    trimesh.creation.box((0.1, 0.1, 0.1)).export(tmp_path / "2R ARM_description" / "meshes" / "Link 1.STL")
    mesh = '<mesh filename="package://2R ARM/meshes/Link 1.STL"/>'
    text = f"<robot name='r'><link name='a'><visual><geometry>{mesh}</geometry></visual></link></robot>"
    robot = read_robot(written(tmp_path, "2R ARM_description/urdf/2R ARM.urdf", text))
    assert robot.links[0].has_geometry
    assert not robot.notes


def test_robots_of_robot_descriptions_have_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("robot_descriptions", reason="the package robot_descriptions is not installed")
    monkeypatch.setenv("ROBOT_DESCRIPTIONS_CACHE", str(tmp_path))
    assert run(["validate", "panda", "--engines", "none"]) == 2
    assert "robot_descriptions pull panda_description" in capsys.readouterr().err
    folder = tmp_path / "example-robot-data"
    file = folder / "robots" / "panda_description" / "urdf" / "panda.urdf"
    file.parent.mkdir(parents=True)
    file.write_text('<robot name="panda"><link name="base"/></robot>')
    git = ["git", "-C", str(folder), "-c", "user.name=a", "-c", "user.email=a@b.c"]
    for words in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "a"]):
        subprocess.run([*git, *words], check=True)
    head = subprocess.run([*git, "rev-parse", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()
    place = tmp_path / f"example-robot-data-{head}" / "example-robot-data"
    place.parent.mkdir()
    folder.rename(place)
    monkeypatch.setenv("ROBOT_DESCRIPTION_COMMIT", head)
    assert kinematify.load("panda").robot.name == "panda"


CROWD = """<mujoco>
  <option gravity="0 0 -9.81"/>
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <body name="torso" pos="0 0 1">
      <freejoint name="root"/>
      <geom type="box" size="0.2 0.1 0.1"/>
      <body name="left" pos="0 0.02 -0.2">
        <joint name="left_hip" axis="0 1 0" pos="0 0 0.05" range="-30 30"/>
        <geom name="left" type="box" size="0.03 0.03 0.1" contype="1" conaffinity="0"/>
      </body>
      <body name="right" pos="0 -0.02 -0.2">
        <joint name="right_hip" axis="0 1 0" pos="0 0 0.05" range="-30 30"/>
        <geom name="right" type="box" size="0.03 0.03 0.1" contype="1" conaffinity="{}"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def test_what_an_mjcf_keeps_apart_is_a_note_and_its_base_may_float(tmp_path: Path) -> None:
    """The legs of gymnasium's walker2d overlap at zero, and its conaffinity keeps them apart."""
    apart, meeting = (validate(written(tmp_path, f"{k}.xml", CROWD.format(k)), workers=1) for k in (0, 1))
    (left_out,) = [item for item in apart.findings if item.check == "KV301"]
    assert left_out.severity is Severity.NOTE
    assert "conaffinity" in left_out.message
    assert [item.severity for item in meeting.findings if item.check == "KV301"] == [Severity.ERROR]
    assert "MuJoCo 2 of 2 joints move" in apart.as_loaded
    assert not [item for item in apart.findings if item.check.startswith("KV8") and item.engine == "mujoco"]
    assert {item.pair for item in meeting.findings if (item.check, item.engine) == ("KV802", "mujoco")} == {
        ("left", "right")
    }
