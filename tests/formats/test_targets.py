"""Every target accepts what is written for it, and what it does not get is listed."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco
import numpy as np
import pytest
from lxml import etree
from pxr import Usd, UsdPhysics

from kinematify.cli.app import run
from kinematify.config.validation import load_settings
from kinematify.errors import ExportError
from kinematify.formats.content import read_content
from kinematify.formats.export_model import export
from kinematify.formats.reopen import check_target
from kinematify.robot.appearance import plain
from kinematify.robot.obj_file import write_obj
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from kinematify.formats.export_model import Exported

BOX = '<geometry><box size="0.1 0.1 0.1"/></geometry>'
ROUND = 'ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"'
LIMIT = '<limit lower="-1" upper="1" effort="4" velocity="2"/>'
SUFFIXES = {"mjcf": "xml", "sdf": "sdf", "usd": "usda", "urdf": "urdf", "glb": "glb"}


def link(name: str, inertia: str = ROUND) -> str:
    return (
        f'<link name="{name}"><inertial><mass value="1"/><inertia {inertia}/></inertial><visual>{BOX}</visual>'
        f"<collision>{BOX}</collision></link>"
    )


def joint(name: str, parent: str, child: str, kind: str = "revolute", more: str = LIMIT) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="0 0 0.2"/><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="0 1 0"/>{more}</joint>'
    )


def exported(folder: Path, to: str, *elements: str, free: bool = False) -> Exported:
    (folder / "given.urdf").write_text(f'<robot name="4 arms">{"".join(elements)}</robot>', encoding="utf-8")
    return export(folder / "given.urdf", to, folder / f"model.{SUFFIXES[to]}", free=free)


def lost(done: Exported) -> dict[str, str]:
    return {loss.what: loss.became for loss in done.lost}


@pytest.mark.parametrize("to", SUFFIXES)
def test_a_follower_of_a_fixed_joint_is_held_at_its_offset(tmp_path: Path, to: str) -> None:
    follows = LIMIT + '<mimic joint="{}" multiplier="0.5" offset="0.1"/>'
    done = exported(
        tmp_path, to, *map(link, "abcd"), joint("mount", "a", "b", "fixed"),
        joint("first", "b", "c", more=follows.format("mount")), joint("second", "c", "d", more=follows.format("first")),
    )  # fmt: skip
    assert [note for note in done.notes if "first follows" in note and "0.1 rad" in note]
    assert [note for note in done.notes if "second follows" in note and "0.15 rad" in note]
    if to == "mjcf":
        model = mujoco.MjModel.from_xml_path(str(done.path))
        assert model.body("d").quat == pytest.approx([np.cos(0.075), 0.0, np.sin(0.075), 0.0])


@pytest.mark.parametrize("to", ["mjcf", "sdf", "usd", "urdf"])
def test_the_only_color_of_a_mesh_file_is_kept(tmp_path: Path, to: str) -> None:
    red, faces = (0.75, 0.0, 0.25, 1.0), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2]])
    write_obj(tmp_path / "a.obj", np.eye(4)[:, :3], faces, appearance=plain(red, 3))
    shown = BOX.replace('<box size="0.1 0.1 0.1"/>', '<mesh filename="a.obj"/>')
    done = exported(tmp_path, to, f'<link name="a"><visual>{shown}</visual></link>')
    (shape,) = read_robot(done.path).link_by_name["a"].visuals
    assert shape.color == pytest.approx(red, abs=1e-6)


def test_siblings_in_sdf_have_names_of_their_own(tmp_path: Path) -> None:
    done = exported(
        tmp_path, "sdf", *map(link, ("world", "arm", "arm_joint", "__x__", "root_joint")), joint("arm", "world", "arm"),
        joint("a::b", "arm", "arm_joint"), joint("lid", "arm_joint", "__x__"), joint("lid_2", "__x__", "root_joint"),
    )  # fmt: skip
    model = etree.parse(done.path).find("model")
    assert model is not None
    names = Counter(str(child.get("name")) for child in model)
    assert max(names.values()) == 1
    assert not {"world", "__x__", "a::b"} & set(names)
    assert {"arm", "arm_joint", "arm_joint_2", "lid", "lid_2"} <= set(names)
    assert [note for note in done.notes if "joint 'arm' is named 'arm_joint_2'" in note]


def test_names_that_usd_allows_are_kept_and_others_are_listed(tmp_path: Path) -> None:
    names = ("leg.1", "leg-1", "leg_1", "00_fr", "größe", "leg_1_link")
    joints = [joint(name.replace("leg", "j"), "base", name) for name in names]
    done = exported(tmp_path, "usd", link("base"), *map(link, names), *joints)
    stage = Usd.Stage.Open(str(done.path))
    shown = {prim.GetDisplayName(): prim.GetName() for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.RigidBodyAPI)}
    assert set(shown) == {"base", *names}
    changed = {old: new for old, new in shown.items() if old != new}
    assert set(changed) == {"leg.1", "leg-1", "00_fr"}
    assert changed["00_fr"] == "_00_fr"
    assert len(set(shown.values())) == len(shown)
    for old, new in changed.items():
        assert f"The link {old!r} is named {new!r}" in " ".join(done.notes)


GAZEBO = """<gazebo reference="b"><material>Gazebo/Orange</material><mu1>0.9</mu1><mu2 value="0.8"/>
<selfCollide>true</selfCollide></gazebo><gazebo><plugin filename="x"/></gazebo>
<gazebo reference="j"><springStiffness>5</springStiffness><springReference>0.3</springReference></gazebo>
<transmission name="t"><joint name="j"/></transmission><ros2_control name="s"/>"""


@pytest.mark.parametrize("to", SUFFIXES)
def test_extensions_of_gazebo_and_ros_are_carried_or_listed(tmp_path: Path, to: str) -> None:
    soft = LIMIT + '<safety_controller k_velocity="1"/><dynamics damping="1" spring="2"/>'
    done = exported(tmp_path, to, link("a"), link("b"), joint("j", "a", "b", more=soft), GAZEBO)
    listed = lost(done)
    others = {f"gazebo {tag}" for tag in ("material", "selfCollide", "plugin")}
    others |= {"transmission", "ros2_control", "joint safety_controller"}
    assert "dynamics spring" in listed
    assert set(listed) & others == (set() if to == "urdf" else others)
    assert ("springs (springStiffness)" in listed) == (to in ("usd", "glb"))
    if to == "urdf":
        document = etree.parse(done.path)
        assert len(document.findall("gazebo")) == 3
        assert document.find("joint/safety_controller") is not None
    elif to == "mjcf":
        model = mujoco.MjModel.from_xml_path(str(done.path))
        assert max(model.geom_friction[:, 0]) == 1.0
        assert min(model.geom_friction[model.geom_contype > 0, 0]) == 0.9
        assert (model.jnt_stiffness[0].max(), model.qpos_spring[0]) == (5.0, 0.3)
    elif to == "sdf":
        ode = etree.parse(done.path).find(".//collision/surface/friction/ode")
        assert ode is not None
        assert (ode.findtext("mu"), ode.findtext("mu2")) == ("0.9", "0.8")
        dynamics = etree.parse(done.path).find(".//axis/dynamics")
        assert dynamics is not None
        assert (dynamics.findtext("spring_stiffness"), dynamics.findtext("spring_reference")) == ("5.0", "0.3")
    elif to == "usd":
        stage = Usd.Stage.Open(str(done.path))
        (drive,) = (UsdPhysics.DriveAPI(p, "angular") for p in stage.Traverse() if p.HasAPI(UsdPhysics.DriveAPI))
        assert drive.GetStiffnessAttr().Get() == pytest.approx(5.0 * np.pi / 180.0)
        frictions = [UsdPhysics.MaterialAPI(p).GetStaticFrictionAttr().Get() for p in stage.Traverse()]
        assert sorted(value for value in frictions if value) == pytest.approx([0.9, 1.0])


@pytest.mark.parametrize("to", ["mjcf", "sdf", "usd", "urdf"])
def test_an_inertia_that_is_changed_is_listed_with_its_link(tmp_path: Path, to: str) -> None:
    no_body = 'ixx="0.0035" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.0136"'
    done = exported(tmp_path, to, link("a"), link("b", no_body), joint("j", "a", "b"))
    (note,) = (note for note in done.notes if "inertia" in note)
    assert "link b " in note
    assert "0.0035, 0.01, 0.0136" in note
    assert "0.0036, 0.0101, 0.0137" in note


def test_a_joint_without_a_motor_is_listed_with_the_reason(tmp_path: Path) -> None:
    idle, stuck = (f'<limit lower="{low}" upper="{-low}" effort="0" velocity="0"/>' for low in (-1, 0))
    done = exported(
        tmp_path, "mjcf", *map(link, "abcd"), joint("idle", "a", "b", more=idle), joint("arm", "b", "c"),
        joint("stuck", "c", "d", more=stuck),
    )  # fmt: skip
    model = mujoco.MjModel.from_xml_path(str(done.path))
    assert model.nu == 1
    assert "idle (effort 0)" in lost(done)["actuated joints without effort"]
    assert model.jnt_limited[model.joint("stuck").id], "a range without width is a range"


@pytest.mark.parametrize(
    ("to", "old", "new", "message"),
    [
        ("mjcf", 'mass="1.0"', 'mass="2.0"', "mass of the link a"),
        ("mjcf", 'range="-1.0', 'range="-2.0', "joint j"),
        ("mjcf", '<body name="b" pos="0.0', '<body name="b" pos="0.1', "link b"),
        ("mjcf", "<joint ", "<hinge ", "refused"),
        ("sdf", "<izz>0.01", "<izz>0.02", "inertia of the link a"),
        ("sdf", '<joint name="j"', '<joint name="a"', "refused: .*siblings"),
        ("sdf", "<parent>a", "<parent>c", "refused"),
        ("usd", "float physics:mass = 1", "float physics:mass = 3", "mass of the link a"),
        ("usd", "#usda 1.0", "#usda", "refused"),
        ("urdf", 'type="revolute"', 'type="prismatic"', "joint j"),
    ],
)
def test_what_a_target_refuses_or_reads_otherwise_is_an_error(
    tmp_path: Path, to: str, old: str, new: str, message: str
) -> None:
    done = exported(tmp_path, to, *map(link, "ab"), joint("j", "a", "b"))
    content = read_content(tmp_path / "given.urdf", to, load_settings())
    check_target(content, to, done.path)
    text = done.path.read_text(encoding="utf-8")
    assert old in text
    done.path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ExportError, match=message):
        check_target(content, to, done.path)


def test_the_command_ends_with_status_1_where_mujoco_refuses_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    light = ROUND.replace("0.01", "1e-17")
    exported(tmp_path, "sdf", link("a"), link("b", light), joint("j", "a", "b"))
    assert run(["export", str(tmp_path / "given.urdf"), "--to", "mjcf", "-o", str(tmp_path / "m.xml")]) == 1
    assert "positive eigenvalues" in capsys.readouterr().err
