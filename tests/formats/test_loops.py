"""Closed chains of joints in every format: reported in a URDF, closed where the format can close them."""

from __future__ import annotations

import json
import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from click.testing import CliRunner
from lxml import etree
from pxr import Gf, Usd, UsdGeom, UsdPhysics

from kinematify.cli.app import cli
from kinematify.config import load_config
from kinematify.errors import DescriptionError, InputError
from kinematify.formats.export_model import export
from kinematify.formats.losses import _COUNTS, KEPT, OTHERS, TREATMENT
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.procedural.blueprint_file import described_blueprint
from kinematify.generate.providers.judge_blueprint import drawn_findings
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.validation.run import validate
from tests.toolbox import toolbox as drawn_toolbox


@pytest.fixture(scope="module")
def toolbox(tmp_path_factory):
    folder = tmp_path_factory.mktemp("toolbox")
    write_blueprint(drawn_toolbox(), folder, load_config())
    return folder / "model.urdf"


def test_both_links_of_a_loop_meet_at_every_value_of_the_leader(toolbox):
    robot = read_robot(toolbox, geometry="none")
    assert len(robot.loops) == 2
    for share in (0.0, 0.4, 1.0):
        q = {joint.name: share * joint.upper for joint in robot.joints if joint.leads}
        poses = forward_kinematics(robot, q)
        for loop in robot.loops:
            ends = [
                (poses[link] @ np.append(point, 1.0))[:3] for link, point in zip(loop.links, loop.points, strict=True)
            ]
            np.testing.assert_allclose(*ends, atol=1e-6)


def test_mujoco_closes_the_loop_by_itself(toolbox, tmp_path):
    export(toolbox, "mjcf", tmp_path / "toolbox.xml")
    document = etree.parse(tmp_path / "toolbox.xml")
    assert len(document.findall(".//equality/connect")) == 2
    # Without the followers' equations the pins alone must hold the parallelogram.
    for follows in document.findall(".//equality/joint"):
        follows.getparent().remove(follows)
    (tmp_path / "alone.xml").write_bytes(etree.tostring(document))
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "alone.xml"))
    data = mujoco.MjData(model)
    leader, follower = (model.joint(f"cantilever_tray_1_arm_{k}_joint") for k in (1, 2))
    for _ in range(3000):
        data.qfrc_applied[leader.dofadr[0]] = 3.0
        mujoco.mj_step(model, data)
    moved = float(data.qpos[leader.qposadr[0]])
    assert moved > 0.5
    assert float(data.qpos[follower.qposadr[0]]) == pytest.approx(moved, abs=0.05)


def test_the_command_ends_with_what_the_format_does_not_hold_and_takes_a_folder(toolbox, tmp_path):
    out, answer = tmp_path / "toolbox.xml", tmp_path / "answer.json"
    done = CliRunner().invoke(
        cli, ["export", str(toolbox.parent), "--to", "mjcf", "-o", str(out), "--json", str(answer)]
    )
    assert done.exit_code == 0, done.output
    lost = {item["what"]: item for item in json.loads(answer.read_text())["lost"]}
    robot = read_robot(toolbox, geometry="none")
    assert lost["closed loops"]["count"] == len(robot.loops) == 2
    assert lost["speed limits"]["count"] == len(robot.joints)
    motors = etree.parse(out).findall(".//actuator/motor")
    assert len(motors) == len(robot.leaders), "one for every joint that moves by itself"
    assert all(item["became"] in done.output for item in lost.values())


def test_a_folder_without_a_model_is_refused(tmp_path):
    with pytest.raises(InputError, match="no URDF file"):
        export(tmp_path, "mjcf", tmp_path / "out.xml")


def test_the_docs_have_the_table_of_the_code():
    page = (Path(__file__).parents[2] / "docs" / "formats.md").read_text(encoding="utf-8")
    assert f"| | {' | '.join(TREATMENT)} |" in page
    for what in (*_COUNTS, OTHERS):
        assert f"| {what} | {' | '.join(own.get(what, KEPT).split(': {')[0] for own in TREATMENT.values())} |" in page


def test_sdf_has_a_ball_joint(toolbox, tmp_path):
    export(toolbox, "sdf", tmp_path / "toolbox.sdf")
    joints = etree.parse(tmp_path / "toolbox.sdf").findall(".//joint[@type='ball']")
    assert {joint.findtext("child") for joint in joints} == {"cantilever_tray_1", "cantilever_tray_2"}


def test_usd_has_a_spherical_joint_outside_of_the_articulation(toolbox, tmp_path):
    export(toolbox, "usd", tmp_path / "toolbox.usda")
    stage = Usd.Stage.Open(str(tmp_path / "toolbox.usda"))
    joints = [prim for prim in stage.Traverse() if prim.IsA(UsdPhysics.SphericalJoint)]
    assert len(joints) == 2
    for prim in joints:
        joint = UsdPhysics.SphericalJoint(prim)
        assert joint.GetExcludeFromArticulationAttr().Get()
        ends = [
            UsdGeom.Xformable(stage.GetPrimAtPath(body.GetTargets()[0]))
            .ComputeLocalToWorldTransform(Usd.TimeCode.Default())
            .Transform(Gf.Vec3d(place.Get()))
            for body, place in (
                (joint.GetBody0Rel(), joint.GetLocalPos0Attr()),
                (joint.GetBody1Rel(), joint.GetLocalPos1Attr()),
            )
        ]
        np.testing.assert_allclose(*ends, atol=1e-6)


def test_the_loop_joint_of_isaac_sim_is_read_too(toolbox):
    document = etree.parse(toolbox)
    (first, _) = read_robot(toolbox, geometry="none").loops
    for closing in document.findall("{*}ball_constraint"):
        document.getroot().remove(closing)
    loop = etree.SubElement(document.getroot(), "loop_joint", name="of_isaac", type="spherical")
    for tag, link, point in zip(("link1", "link2"), first.links, first.points, strict=True):
        etree.SubElement(loop, tag, link=link, xyz=" ".join(map(str, point)))
    other = toolbox.with_name("isaac.urdf")
    document.write(other)
    (read,) = read_robot(other, geometry="none").loops
    assert read.links == first.links
    np.testing.assert_allclose(read.points, first.points)


def test_a_loop_of_a_link_that_is_not_there_is_refused(toolbox, tmp_path):
    document = etree.parse(toolbox)
    document.find("{*}ball_constraint/{*}ball_constraint_body_B").set("name", "nowhere")
    broken = toolbox.with_name("broken.urdf")
    document.write(broken)
    with pytest.raises(DescriptionError, match="nowhere"):
        read_robot(broken)


@pytest.mark.parametrize(("change", "said"), [("nothing", None), ("point", "at rest"), ("third", "no motion")])
def test_validate_reports_a_loop_that_is_open_or_rigid(toolbox, change, said):
    document = etree.parse(toolbox)
    root = document.getroot()
    loop = root.find("{*}ball_constraint")
    point = loop.find("{*}ball_constraint_p_BQ")
    if change == "point":
        point.set("value", "0.0 0.1 0.0")
    elif change == "third":
        for mimic in root.findall("joint/mimic"):
            mimic.getparent().remove(mimic)
        other = etree.fromstring(etree.tostring(loop))
        other.set("name", "third")
        for place in ("AP", "BQ"):
            given = other.find(f"{{*}}ball_constraint_p_{place}")
            start = [float(part) for part in given.get("value").split()]
            given.set("value", " ".join(str(a + b) for a, b in zip(start, (0.0, 0.03, 0.02), strict=True)))
        root.append(other)
    changed = toolbox.with_name(f"{change}.urdf")
    document.write(changed)
    check = next(item for item in validate(changed, selected=["KV230"], engines=()).checks if item.check == "KV230")
    said_so = [finding.message for finding in check.findings]
    assert not said_so if said is None else any(said in message for message in said_so)


CRANK, ROCKER, COUPLER = 0.2, 0.12, math.hypot(0.3, 0.08)
"""Links of a four-bar above a ground of 30 cm: the shortest one, the rocker, turns round and the crank swings."""


def four_bar(folder: Path, reach: float) -> Path:
    """Write one whose crank is declared to swing so far to both sides [rad]."""
    links = "".join(
        f"""<link name="{name}"><inertial><mass value="0.5"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0"
        iyz="0"/></inertial><visual><origin xyz="{at}"/><geometry><box size="{size}"/></geometry></visual></link>"""
        for name, size, at in (
            ("ground", "0.4 0.02 0.02", "0.15 0 -0.02"),
            ("crank", f"0.02 0.02 {CRANK}", f"0 0.03 {CRANK / 2}"),
            ("rocker", f"0.02 0.02 {ROCKER}", f"0 0.03 {ROCKER / 2}"),
            ("coupler", f"{COUPLER} 0.02 0.02", f"{COUPLER / 2} 0.06 0"),
        )
    )
    joints = "".join(
        f"""<joint name="{child}_joint" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin {at}/>
        <axis xyz="0 1 0"/><limit lower="{-reach}" upper="{reach}" effort="10" velocity="1"/></joint>"""
        for child, kind, parent, at in (
            ("crank", "revolute", "ground", 'xyz="0 0 0"'),
            ("rocker", "continuous", "ground", 'xyz="0.3 0 0"'),
            ("coupler", "continuous", "crank", f'xyz="0 0 {CRANK}" rpy="0 {math.atan2(0.08, 0.3)} 0"'),
        )
    )
    pin = f"""<loop_joint name="pin" type="spherical"><link1 link="rocker" xyz="0 0.06 {ROCKER}"/>
    <link2 link="coupler" xyz="{COUPLER} 0.06 0"/></loop_joint>"""
    path = folder / "four_bar.urdf"
    path.write_text(f'<robot name="four_bar">{links}{joints}{pin}</robot>', encoding="utf-8")
    return path


@pytest.mark.parametrize(("reach", "fits"), [(0.45, True), (0.6, False), (2.5, False)])
def test_a_crank_that_its_loop_does_not_let_reach_its_range_is_found_and_mujoco_shows_it(tmp_path, reach, fits):
    urdf = four_bar(tmp_path, reach)
    found = [item for item in validate(urdf, selected=["KV230"], engines=()).findings if item.check == "KV230"]
    assert [item.joint for item in found] == ([] if fits else ["crank_joint"])
    export(urdf, "mjcf", tmp_path / "four_bar.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "four_bar.xml"))
    model.opt.gravity[:] = 0.0
    model.jnt_limited[:] = 0
    data, crank, rocker = mujoco.MjData(model), model.joint("crank_joint").id, model.joint("rocker_joint").id
    seen = []
    for target in np.linspace(0.0, -math.pi, 4000):
        data.qpos[rocker], data.qvel[rocker] = target, 0.0
        mujoco.mj_step(model, data)
        seen.append(data.qpos[crank])
    end = -math.acos((0.09 + CRANK**2 - (COUPLER + ROCKER) ** 2) / (0.6 * CRANK)) + math.pi / 2
    assert min(seen) == pytest.approx(end, abs=2e-3), "as far as coupler and rocker reach when they are in line"
    assert (end <= -0.95 * reach) is fits
    assert fits or f"from {end:.3f}"[:10] in found[0].message


def test_no_hand_pushes_what_leads_a_loop_of_an_mjcf(tmp_path):
    """A crank that MuJoCo holds in its loop got nowhere by a push that moved the rocker by a straight line."""
    export(four_bar(tmp_path, 2.5), "mjcf", tmp_path / "four_bar.xml")
    report = validate(tmp_path / "four_bar.xml", selected=["KV804"], engines=("mujoco",))
    (check,) = [item for item in report.checks if item.check == "KV804" and item.engine == "mujoco"]
    assert (check.measured["joints"], check.findings) == (0.0, ())


def bar(name: str, start: tuple[float, float], end: tuple[float, float], height: float) -> dict[str, object]:
    """A flat bar between two pins."""
    middle = [0.5 * (a + b) for a, b in zip(start, end, strict=True)]
    angle = math.atan2(end[1] - start[1], end[0] - start[0])
    shape = {
        "kind": "box",
        "size": [math.dist(start, end), 0.012, 0.008],
        "xyz": [*middle, height],
        "rpy": [0, 0, angle],
    }
    return {"name": name, "material": "steel", "shapes": [shape]}


def test_the_slider_of_a_blueprint_is_where_its_crank_takes_it_in_mujoco(tmp_path):
    """A crank of 5 cm and a rod of 15 cm, closed by a pin alone: no bar has an equation of its own."""
    away = math.sqrt(0.15**2 - 0.05**2)
    board = {
        "name": "base",
        "material": "steel",
        "shapes": [{"kind": "box", "size": [0.5, 0.2, 0.01], "xyz": [0.1, 0, 0]}],
    }
    block = {"name": "slider", "shapes": [{"kind": "box", "size": [0.04, 0.03, 0.008], "xyz": [away, 0, 0.011]}]}
    turn = {"type": "continuous", "axis": [0, 0, 1]}
    slide = {
        "type": "prismatic",
        "parent": "base",
        "child": "slider",
        "axis": [1, 0, 0],
        "lower": -0.0425,
        "upper": 0.06,
    }
    blueprint = described_blueprint(
        {
            "name": "slider_crank",
            "parts": [board, bar("crank", (0, 0), (0, 0.05), 0.011), bar("rod", (0, 0.05), (away, 0), 0.021), block],
            "joints": [
                {**turn, "parent": "base", "child": "crank", "pivot": [0, 0, 0.011]},
                {**turn, "parent": "crank", "child": "rod", "pivot": [0, 0.05, 0.016]},
                {**slide, "lower": -0.0425, "upper": 0.06},
            ],
            "loops": [{"parts": ["rod", "slider"], "pivot": [away, 0, 0.016]}],
        }
    )
    assert drawn_findings(blueprint) == []
    write_blueprint(blueprint, tmp_path, load_config())
    export(tmp_path / "model.urdf", "mjcf", tmp_path / "model.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    model.opt.gravity[:] = 0.0
    data = mujoco.MjData(model)
    crank, slider = (int(model.joint(f"{name}_joint").qposadr[0]) for name in ("crank", "slider"))
    seen = []
    for _ in range(2000):
        data.qvel[model.joint("crank_joint").dofadr[0]] = 2.0
        mujoco.mj_step(model, data)
        angle = 0.5 * math.pi + data.qpos[crank]
        exact = 0.05 * math.cos(angle) + math.sqrt(0.15**2 - (0.05 * math.sin(angle)) ** 2) - away
        seen.append((data.qpos[slider], exact))
    found, exact = np.transpose(seen)
    np.testing.assert_allclose(found, exact, atol=2e-3)
    assert np.ptp(found) == pytest.approx(0.1, abs=5e-3)
