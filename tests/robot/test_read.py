"""Reading URDF: geometry in the link frame, forward kinematics as other engines have it, clear errors."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path

import numpy as np
import pytest
import trimesh
from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics, joint_values, rest_configuration, rigid_groups
from kinematify.robot.urdf_geometry import primitive
from tests.places import BENCH

ROBOTS = ("allegro", "fetch", "go2", "h1", "panda", "ur10e")
needs_bench = pytest.mark.skipif(not BENCH.is_dir(), reason="no benchmark models: set KINEMATIFY_BENCH to their folder")

BOX = '<visual><geometry><box size="1 2 4"/></geometry></visual>'


def link(name: str, inside: str = "") -> str:
    return f'<link name="{name}">{inside}</link>'


def joint(name: str, kind: str, parent: str, child: str, inside: str = "") -> str:
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inside}</joint>'


def limit(lower: float, upper: float) -> str:
    return f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'


def urdf(folder: Path, *elements: str) -> Path:
    path = folder / "robot.urdf"
    path.write_text(f'<robot name="r">{"".join(elements)}</robot>', encoding="utf-8")
    return path


def visual(shape: str, origin: str = "", scale: str = "") -> str:
    return f"<visual>{origin}<geometry>{shape}</geometry></visual>"


def bounds(path: Path) -> np.ndarray:
    mesh = read_robot(path).links[0].meshes[0]
    return np.stack([mesh.vertices.min(0), mesh.vertices.max(0)])


@pytest.mark.parametrize(
    ("shape", "half"),
    [
        ('<box size="1 2 4"/>', (0.5, 1.0, 2.0)),
        ('<sphere radius="0.5"/>', (0.5, 0.5, 0.5)),
        ('<cylinder radius="0.5" length="3"/>', (0.5, 0.5, 1.5)),
        ('<capsule radius="0.5" length="3"/>', (0.5, 0.5, 2.0)),
    ],
)
def test_primitives_are_centred_with_their_axis_along_z(
    tmp_path: Path, shape: str, half: tuple[float, float, float]
) -> None:
    found = bounds(urdf(tmp_path, link("a", visual(shape))))
    np.testing.assert_allclose(found, [np.negative(half), half], atol=2e-3)


@pytest.mark.parametrize("radius", [0.035, 2.5])
def test_a_sphere_is_the_icosphere_of_trimesh_to_the_last_bit(radius: float) -> None:
    shape, known = primitive("sphere", (radius,), np.eye(4)), trimesh.creation.icosphere(4, radius)
    assert shape.mesh is not None
    np.testing.assert_array_equal(shape.mesh.vertices, known.vertices)
    np.testing.assert_array_equal(shape.mesh.faces, known.faces)


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb", "dae", "off"])
def test_meshes_of_every_format_are_scaled_then_placed(tmp_path: Path, suffix: str) -> None:
    trimesh.creation.box(bounds=[[0, 0, 0], [1, 2, 3]]).export(tmp_path / f"m.{suffix}")
    origin = f'<origin xyz="10 0 0" rpy="0 0 {math.pi / 2}"/>'
    shape = f'<mesh filename="m.{suffix}" scale="2 1 1"/>'
    np.testing.assert_allclose(
        bounds(urdf(tmp_path, link("a", visual(shape, origin)))), [[8, 0, 0], [10, 2, 3]], atol=1e-6
    )


@pytest.mark.parametrize(("up", "unit"), [("X_UP", 0.0254), ("Y_UP", None)])
def test_collada_unit_counts_and_up_axis_does_not(tmp_path: Path, up: str, unit: float | None) -> None:
    text = trimesh.creation.box(bounds=[[0, 0, 0], [1, 2, 3]]).export(file_type="dae").decode()
    stated = "" if unit is None else f'<unit name="u" meter="{unit}"/>'
    asset = f"{stated}<up_axis>{up}</up_axis>"
    (tmp_path / "m.dae").write_text(text.replace("<up_axis>Y_UP</up_axis>", asset))
    found = bounds(urdf(tmp_path, link("a", visual('<mesh filename="m.dae"/>'))))
    np.testing.assert_allclose(found, np.multiply(unit or 1.0, [[0, 0, 0], [1, 2, 3]]), atol=1e-6)


def test_collada_geometry_is_read_without_the_material_that_the_file_does_not_hold(tmp_path: Path) -> None:
    box = trimesh.creation.box(bounds=[[0, 0, 0], [1, 2, 3]])
    tree = etree.fromstring(box.export(file_type="dae"))
    for library in tree.findall("{*}library_materials") + tree.findall("{*}library_effects"):
        library.getparent().remove(library)
    assert tree.findall(".//{*}instance_material"), "something is bound to what is gone"
    (tmp_path / "m.dae").write_bytes(etree.tostring(tree))
    found = bounds(urdf(tmp_path, link("a", visual('<mesh filename="m.dae"/>'))))
    np.testing.assert_allclose(found, [[0, 0, 0], [1, 2, 3]], atol=1e-6)


def test_a_primitive_without_size_is_no_shape(tmp_path: Path) -> None:
    shapes = visual('<sphere radius="0"/>') + visual('<box size="1 2 3"/>')
    (shape,) = read_robot(urdf(tmp_path, link("a", shapes))).links[0].visuals
    assert shape.size == (1.0, 2.0, 3.0)


LYING = """<robot name="stack">{links}
  <joint name="turn" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0 {height}"/></joint>
</robot>"""


@pytest.mark.parametrize(("height", "respected"), [(3.0, True), (1.0, False)])
def test_collada_up_axis_is_respected_only_where_links_meet(tmp_path: Path, height: float, respected: bool) -> None:
    text = trimesh.creation.box(bounds=[[0, 0, 0], [1, 3, 1]]).export(file_type="dae").decode()
    assert "<up_axis>Y_UP</up_axis>" in text
    (tmp_path / "m.dae").write_text(text)
    links = "".join(link(name, visual('<mesh filename="m.dae"/>')) for name in "ab")
    (tmp_path / "stack.urdf").write_text(LYING.format(links=links, height=height))
    robot = read_robot(tmp_path / "stack.urdf")
    assert robot.up_axis is not None
    assert robot.up_axis.respected is respected
    first = robot.links[0].meshes[0].vertices
    expected = [[0, -1, 0], [1, 0, 3]] if respected else [[0, 0, 0], [1, 3, 1]]
    np.testing.assert_allclose([first.min(axis=0), first.max(axis=0)], expected, atol=1e-6)
    assert any("up axis" in note for note in robot.notes) is respected


def test_collision_geometry_stands_in_for_a_missing_visual(tmp_path: Path) -> None:
    robot = read_robot(
        urdf(
            tmp_path,
            link("a", BOX.replace("visual", "collision")),
            link("b", BOX + BOX.replace("visual", "collision")),
            joint("j", "fixed", "a", "b"),
        ),
        geometry="shown",
    )
    assert [len(item.collisions) for item in robot.links] == [1, 0], "what is not shown is not read"
    assert [len(item.meshes) for item in robot.links] == [1, 1]


@pytest.mark.parametrize("how", ["manifest above", "manifest of package-dir", "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"])
def test_a_package_is_found_by_its_manifest_and_by_the_environment(
    tmp_path: Path, how: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A package that was cloned into a folder of another name."""
    package = tmp_path / "deep" / ("share/my_robot" if how == "AMENT_PREFIX_PATH" else "clone-of-it")
    (package / "meshes").mkdir(parents=True)
    (package / "urdf").mkdir()
    (package / "package.xml").write_text("<package format='2'>\n  <name>my_robot</name>\n</package>")
    trimesh.creation.box().export(package / "meshes" / "m.stl")
    inside = package / "urdf" if how == "manifest above" else tmp_path
    if how == "ROS_PACKAGE_PATH":
        monkeypatch.setenv(how, f"{tmp_path}/nowhere{os.pathsep}{package}")
    elif how == "AMENT_PREFIX_PATH":
        monkeypatch.setenv(how, str(tmp_path / "deep"))
    path = urdf(inside, link("a", visual('<mesh filename="package://my_robot/meshes/m.stl"/>')))
    dirs = [package] if how == "manifest of package-dir" else []
    assert read_robot(path, package_dirs=dirs).links[0].has_geometry


def test_a_manifest_goes_before_the_name_of_a_folder(tmp_path: Path) -> None:
    package = tmp_path / "my_robot" / "clone"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_robot</name></package>")
    trimesh.creation.box().export(package / "m.stl")
    (tmp_path / "my_robot" / "m.stl").write_text("another mesh")
    path = urdf(package, link("a", visual('<mesh filename="package://my_robot/m.stl"/>')))
    assert read_robot(path).links[0].has_geometry


@pytest.mark.parametrize("how", ["beside", "above", "package-dir parent", "package-dir itself"])
def test_package_addresses_are_found(tmp_path: Path, how: str) -> None:
    package = tmp_path / "deep" / "my_robot"
    (package / "meshes").mkdir(parents=True)
    (package / "urdf").mkdir()
    trimesh.creation.box().export(package / "meshes" / "m.stl")
    inside = {"beside": package, "above": package / "urdf"}.get(how, tmp_path)
    dirs = {"package-dir parent": [package.parent], "package-dir itself": [package]}.get(how, [])
    path = urdf(inside, link("a", visual('<mesh filename="package://my_robot/meshes/m.stl"/>')))
    assert read_robot(path, package_dirs=dirs).links[0].has_geometry


@pytest.mark.parametrize(
    ("inside", "note"),
    [
        ('<geometry><mesh filename="package://nowhere/m.stl"/></geometry>', r"package://nowhere/m\.stl.*--package-dir"),
        ('<geometry><mesh filename="http://localhost/m.stl"/></geometry>', "http://localhost"),
        ('<geometry><mesh filename=""/></geometry>', "names the file ''"),
        ('<geometry><mesh filename="bad.stl"/></geometry>', r"bad\.stl"),
        ('<geometry><mesh filename="scene.wrl"/></geometry>', r"scene\.wrl"),
        ('<geometry><cone size="1"/></geometry>', "<cone>"),
        ("<geometry/>", "no geometry element"),
        ("", "no geometry element"),
    ],
)
@pytest.mark.parametrize("tag", ["visual", "collision"])
def test_what_has_no_usable_geometry_is_left_out_with_a_note(tmp_path: Path, tag: str, inside: str, note: str) -> None:
    for name in ("bad.stl", "scene.wrl"):
        (tmp_path / name).write_bytes(b"nonsense" * 50)
    robot = read_robot(urdf(tmp_path, link("arm", f"{BOX}<{tag}>{inside}</{tag}>")))
    assert robot.links[0].has_geometry
    assert len(robot.notes) == 1
    assert robot.notes[0].startswith(f"A {tag} is omitted (line 1). ")
    assert "link arm" in robot.notes[0]
    assert re.search(note, robot.notes[0])


def test_a_quaternion_turns_and_a_namespace_is_read(tmp_path: Path) -> None:
    turned = joint("j", "continuous", "a", "b", '<origin xyz="0 0 1" quat_xyzw="0 0 0.5 0.5"/>')
    path = urdf(tmp_path, link("a", BOX), link("b", BOX), turned)
    path.write_text(path.read_text().replace("<robot", '<robot xmlns="http://drake.mit.edu"', 1))
    T = read_robot(path).joints[0].T_parent_child
    np.testing.assert_allclose(T, [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]], atol=1e-12)
    path.write_text(path.read_text().replace("0.5 0.5", "0 0"))
    with pytest.raises(DescriptionError, match=r"quat_xyzw.*zero"):
        read_robot(path)


def two(kind: str, inside: str = "") -> tuple[str, ...]:
    return link("a", BOX), link("b", BOX), joint("j", kind, "a", "b", inside)


@pytest.mark.parametrize(
    ("elements", "message"),
    [
        ((), "no link"),
        ((link("a"), link("a")), "2 links named 'a'"),
        ((*two("fixed"), link("c"), joint("j", "fixed", "a", "c")), "2 joints named 'j'"),
        ((link("a"), link("b")), "2 root links: a, b"),
        ((*two("fixed"), joint("k", "fixed", "b", "a")), "cycle"),
        ((link("r"), *two("fixed"), joint("k", "fixed", "b", "a")), "cycle"),
        ((link("a"), joint("j", "fixed", "a", "a")), "cycle"),
        ((*two("fixed"), link("c"), joint("k", "fixed", "a", "c"), joint("l", "fixed", "b", "c")), "hangs on two"),
        ((link("a"), joint("j", "fixed", "a", "ghost")), "'ghost'"),
        (two("hinge"), "type 'hinge'"),
        (two("prismatic"), "no <limit>"),
        (two("revolute", limit(1, -1)), "lower limit 1.0 above"),
        (two("revolute", limit(math.nan, 1)), "lower='nan'"),
        (two("continuous", '<axis xyz="0 0 0"/>'), "zero length"),
        (two("continuous", '<axis xyz="0 1"/>'), "three finite numbers"),
        (two("continuous", '<origin xyz="0 inf 0"/>'), "three finite numbers"),
        (two("continuous", '<mimic joint="ghost"/>'), "mimics 'ghost'"),
        (two("continuous", '<mimic joint="j"/>'), "circle"),
        (two("floating"), "freely"),
        (two("planar"), "freely"),
        ((link("a", visual('<box size="1 -2 1"/>')),), "below zero"),
        (('<link name=""/>',), "no name"),
    ],
)
def test_mistakes_are_named(tmp_path: Path, elements: tuple[str, ...], message: str) -> None:
    with pytest.raises(DescriptionError, match=message):
        read_robot(urdf(tmp_path, *elements))


@pytest.mark.parametrize(
    ("elements", "message"),
    [
        (two("hinge"), "type 'hinge'"),
        (two("prismatic"), "no <limit>"),
        (two("revolute", '<limit lower="0" upper="half"/>'), "upper='half'"),
        (two("continuous", '<axis xyz="1 0 0 0"/>'), "three finite numbers"),
        (two("continuous", '<dynamics damping="nan"/>'), "damping='nan'"),
        (two("continuous", '<mimic joint="ghost"/>'), "mimics 'ghost'"),
        ((link("b", f'{BOX}<inertial><mass value="2 kg"/></inertial>'), *two("continuous")[::2]), "value='2 kg'"),
    ],
)
def test_who_asks_for_parts_is_not_stopped_by_what_moves_or_weighs(
    tmp_path: Path, elements: tuple[str, ...], message: str
) -> None:
    path = urdf(tmp_path, *elements)
    with pytest.raises(DescriptionError, match=message):
        read_robot(path, geometry="shown")
    robot = read_robot(path, geometry="parts")
    assert len(rigid_groups(robot)) == 2
    (note,) = robot.notes
    assert re.search(message, note)
    fixed = urdf(tmp_path, *two("fixed", '<limit effort="much"/>'))
    assert len(rigid_groups(read_robot(fixed, geometry="parts"))) == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<robot><link", r"not well-formed.*line 1"),
        ("", "is empty"),
        ('<!DOCTYPE robot [<!ENTITY a "b">]><robot>&a;</robot>', "DOCTYPE"),
        ('<!DOCTYPE robot SYSTEM "http://localhost/x.dtd"><robot/>', "DOCTYPE"),
        ("<robot>" + "<a>" * 3000, "not well-formed"),
    ],
)
def test_files_that_are_no_urdf(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "robot.urdf"
    path.write_text(text)
    with pytest.raises(DescriptionError, match=message):
        read_robot(path)


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(DescriptionError, match="There is no file"):
        read_robot(tmp_path / "robot.urdf")


def test_free_root_joint_is_fixed_and_noted(tmp_path: Path) -> None:
    path = urdf(
        tmp_path, link("world"), link("mid"), *two("continuous"), joint("f", "planar", "world", "mid"),
        joint("g", "floating", "mid", "a"),
    )  # fmt: skip
    robot = read_robot(path)
    assert [group.links for group in rigid_groups(robot)] == [("world", "mid", "a"), ("b",)]
    assert len(robot.notes) == 2


def test_revolute_without_limits_is_continuous_and_noted(tmp_path: Path) -> None:
    robot = read_robot(urdf(tmp_path, *two("revolute")))
    assert robot.joints[0].kind is JointType.CONTINUOUS
    assert robot.joints[0].upper == math.inf
    assert "j" in robot.notes[0]


def test_axis_is_normalised_and_defaults_to_x(tmp_path: Path) -> None:
    np.testing.assert_allclose(
        read_robot(urdf(tmp_path, *two("continuous", '<axis xyz="0 3 4"/>'))).joints[0].axis,
        [0, 0.6, 0.8],
    )
    np.testing.assert_allclose(read_robot(urdf(tmp_path, *two("continuous"))).joints[0].axis, [1, 0, 0])


def test_mimic_chains_follow_their_leader(tmp_path: Path) -> None:
    robot = read_robot(
        urdf(
            tmp_path,
            link("a"),
            link("b"),
            link("c"),
            link("d"),
            joint("third", "continuous", "c", "d", '<mimic joint="second" multiplier="2" offset="0.5"/>'),
            joint("first", "continuous", "a", "b"),
            joint("second", "continuous", "b", "c", '<mimic joint="first" multiplier="-1"/>'),
        )
    )
    assert joint_values(robot, {"first": 1.0, "second": 9.0}) == {"third": -1.5, "first": 1.0, "second": -1.0}


def test_rest_is_zero_or_mid_limits(tmp_path: Path) -> None:
    follower = '<mimic joint="j" multiplier="2"/>' + limit(-9, 9)
    elements = (*two("prismatic", limit(1, 2)), link("c"), joint("k", "revolute", "b", "c", follower))
    assert rest_configuration(read_robot(urdf(tmp_path, *elements))) == {"j": 1.5, "k": 3.0}
    assert rest_configuration(read_robot(urdf(tmp_path, *two("prismatic", limit(-1, 3))))) == {"j": 0.0}


def random_configuration(robot, seed: int) -> dict[str, float]:  # type: ignore[no-untyped-def]
    random = np.random.default_rng(seed)
    leaders = robot.leaders
    return {j.name: float(random.uniform(max(j.lower, -3.0), min(j.upper, 3.0))) for j in leaders}


@needs_bench
@pytest.mark.parametrize("name", ROBOTS[:2])
def test_forward_kinematics_agrees_with_pinocchio(name: str) -> None:
    pin = pytest.importorskip("pinocchio")
    path = BENCH / "robots" / name / "model.urdf"
    robot = read_robot(path)
    model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    values = joint_values(robot, random_configuration(robot, seed=3))
    q = pin.neutral(model)
    for joint_name, value in values.items():
        if model.existJointName(joint_name):
            item = model.joints[model.getJointId(joint_name)]
            q[item.idx_q : item.idx_q + item.nq] = (math.cos(value), math.sin(value)) if item.nq == 2 else value
    pin.framesForwardKinematics(model, data, q)
    poses = forward_kinematics(robot, values)
    for link_name, pose in poses.items():
        frame = model.getFrameId(link_name, pin.FrameType.BODY)
        np.testing.assert_allclose(pose, data.oMf[frame].homogeneous, atol=1e-9)
