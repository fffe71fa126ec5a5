"""Exported models, read back by the libraries of their formats, stand as the URDF does in many configurations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import pytest
import trimesh
from lxml import etree
from pxr import Usd, UsdGeom, UsdPhysics

from kinematify import export
from kinematify.cli.app import run
from kinematify.config import load_config
from kinematify.errors import InputError, OutputError
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.registry import build
from kinematify.geometry.convex import signed_volume
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model as write_files
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.robot.transforms import rotation_about
from kinematify.versions import NO_WHEELS
from tests.plain_mujoco import stuck_joints

pybullet = pytest.importorskip("pybullet", reason=NO_WHEELS)

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

BOX = '<geometry><box size="{} {} {}"/></geometry>'
RED = '<material name="red"><color rgba="1 0 0 0.5"/></material>'


def link(name: str, shape: str, at: str = "0 0 0", *, inertial: str = "", color: str = "") -> str:
    origin = f'<origin xyz="{at}" rpy="0.1 0.2 0.3"/>'
    return (
        f'<link name="{name}">{inertial}<visual>{origin}{shape}{color}</visual>'
        f"<collision>{origin}{shape}</collision></link>"
    )


def write_model(folder: Path) -> Path:
    """Every joint type, turned frames, a follower, a tray (concave), and a link that is named as the outside."""
    tray = trimesh.boolean.difference(
        [trimesh.creation.box((0.4, 0.4, 0.2)), trimesh.creation.box((0.36, 0.36, 0.2)).apply_translation((0, 0, 0.02))]
    )
    tray.export(folder / "tray.obj")
    heavy = (
        '<inertial><origin xyz="0.01 0 0.02" rpy="0 0 0.5"/><mass value="2"/>'
        '<inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0" iyz="0.002"/></inertial>'
    )
    text = f"""<robot name="many things">
    <material name="red"><color rgba="1 0 0 0.5"/></material>
    {link("world", BOX.format(1, 1, 0.1), inertial=heavy)}
    {link("swing arm", '<geometry><cylinder radius="0.1" length="0.5"/></geometry>', "0 0 0.4", color=RED)}
    {
        link(
            "slider",
            '<geometry><mesh filename="tray.obj" scale="1 1 2"/></geometry>',
            "0.3 0 0",
            color='<material name="red"/>',
        )
    }
    {link("wheel", '<geometry><sphere radius="0.2"/></geometry>', "0 0.5 0")}
    {link("copy", BOX.format(0.1, 0.1, 0.3), "0 -0.5 0")}
    {link("cap", BOX.format(0.1, 0.1, 0.1))}
    <joint name="hinge" type="revolute"><origin xyz="0.1 0.2 0.3" rpy="0.3 -0.2 0.9"/><parent link="world"/>
    <child link="swing arm"/><axis xyz="0 0.6 0.8"/><limit lower="-0.5" upper="1.2" effort="20" velocity="3"/>
    <dynamics damping="0.4" friction="0.1"/></joint>
    <joint name="slide" type="prismatic"><origin xyz="0 0 0.9" rpy="1.2 0.3 0"/><parent link="swing arm"/>
    <child link="slider"/><axis xyz="-1 0 0"/><limit lower="0" upper="0.4" effort="5" velocity="1"/></joint>
    <joint name="spin" type="continuous"><origin xyz="0 1 0.5" rpy="0 0 2"/><parent link="world"/>
    <child link="wheel"/><axis xyz="1 0 0"/></joint>
    <joint name="follow" type="revolute"><origin xyz="0 -1 0.5"/><parent link="world"/><child link="copy"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
    <mimic joint="hinge" multiplier="-2" offset="0.1"/></joint>
    <joint name="glue" type="fixed"><origin xyz="0 0.8 0" rpy="0 1 0"/><parent link="wheel"/><child link="cap"/></joint>
    </robot>"""
    (folder / "model.urdf").write_text(text, encoding="utf-8")
    return folder / "model.urdf"


@pytest.fixture(scope="module")
def urdf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_model(tmp_path_factory.mktemp("urdf"))


def configurations() -> list[dict[str, float]]:
    rng = np.random.default_rng(0)
    return [
        {"hinge": float(a), "slide": float(b), "spin": float(c)}
        for a, b, c in rng.uniform((-0.5, 0.0, -3.0), (1.2, 0.4, 3.0), (10, 3))
    ]


def poses_of(urdf: Path) -> tuple[Robot, list[dict[str, FloatArray]]]:
    robot = read_robot(urdf, geometry="shown")
    return robot, [forward_kinematics(robot, q) for q in configurations()]


def values_of(q: dict[str, float]) -> dict[str, float]:
    return {**q, "follow": 0.1 - 2.0 * q["hinge"]}


def test_mujoco_reads_the_mjcf_and_has_every_link_where_the_urdf_has_it(urdf: Path, tmp_path: Path) -> None:
    done = export(urdf, "mjcf", tmp_path / "model.xml")
    assert any("world_link" in sentence for sentence in done.notes)
    model = mujoco.MjModel.from_xml_path(str(done.path))
    data = mujoco.MjData(model)
    for q, poses in zip(configurations(), poses_of(urdf)[1], strict=True):
        for name, value in values_of(q).items():
            data.qpos[model.joint(name).qposadr[0]] = value
        mujoco.mj_kinematics(model, data)
        for name, T in poses.items():
            body = data.body("world_link" if name == "world" else name)
            assert np.allclose(body.xpos, T[:3, 3], atol=1e-9)
            assert np.allclose(body.xmat.reshape(3, 3), T[:3, :3], atol=1e-9)
    assert model.joint("hinge").range.tolist() == [-0.5, 1.2]
    assert not model.jnt_limited[model.joint("spin").id]
    assert model.dof_damping[model.joint("hinge").dofadr[0]] == 0.4
    assert model.actuator("hinge").ctrlrange.tolist() == [-20.0, 20.0]
    assert model.body("world_link").mass[0] == 2.0


def test_mjcf_holds_the_hollow_of_a_tray_and_lets_followers_follow(urdf: Path, tmp_path: Path) -> None:
    model = mujoco.MjModel.from_xml_path(str(export(urdf, "mjcf", tmp_path / "model.xml").path))
    slider = model.body("slider").id
    colliding = [geom for geom in range(model.ngeom) if model.geom_bodyid[geom] == slider and model.geom_contype[geom]]
    assert len(colliding) >= 5  # a floor and four walls
    data = mujoco.MjData(model)
    data.qvel[model.joint("hinge").dofadr[0]] = 1.0
    data.qpos[model.joint("follow").qposadr[0]] = 0.1
    for _ in range(200):
        mujoco.mj_step(model, data)
    hinge, follow = (data.joint(name).qpos[0] for name in ("hinge", "follow"))
    assert abs(hinge) > 0.05
    assert follow == pytest.approx(0.1 - 2.0 * hinge, abs=0.02)


@pytest.fixture(scope="module", params=["cabinet", "toilet"])
def carved(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A model as `kinematify generate` writes it, with pieces carved by the motion."""
    config = load_config()
    model = true_model(build(request.param, seed=1), config)
    return write_files(simulable_model(model, config).robot, tmp_path_factory.mktemp(request.param))


def pieces_of(urdf: Path) -> dict[str, list[float]]:
    """Volumes of what each link collides with, small ones first [m^3]."""
    return {
        link.name: sorted(abs(signed_volume(shape.mesh.vertices, shape.mesh.faces)) for shape in link.collisions)
        for link in read_robot(urdf).links
    }


def same_pieces(found: dict[str, list[float]], urdf: Path) -> None:
    expected = pieces_of(urdf)
    assert found.keys() == expected.keys()
    for name, volumes in expected.items():
        assert sorted(found[name]) == pytest.approx(volumes, rel=1e-4)


def test_mjcf_collides_with_the_pieces_of_the_urdf_and_every_joint_moves(carved: Path, tmp_path: Path) -> None:
    done = export(carved, "mjcf", tmp_path / "model.xml")
    assert not any("convex" in note for note in done.notes)
    model = mujoco.MjModel.from_xml_path(str(done.path))
    assert model.nexclude == 0
    found: dict[str, list[float]] = {model.body(k).name: [] for k in range(1, model.nbody)}
    for geom in np.flatnonzero(model.geom_contype):
        size, mesh = model.geom_size[geom], model.geom_dataid[geom]
        volume = 8.0 * np.prod(size)
        if mesh >= 0:
            points = slice(model.mesh_vertadr[mesh], model.mesh_vertadr[mesh] + model.mesh_vertnum[mesh])
            volume = trimesh.convex.convex_hull(model.mesh_vert[points]).volume
        found[model.body(model.geom_bodyid[geom]).name].append(float(volume))
    same_pieces(found, carved)
    assert stuck_joints(model, read_robot(carved)) == []


def test_sdf_collides_with_the_pieces_of_the_urdf(carved: Path, tmp_path: Path) -> None:
    model = etree.parse(export(carved, "sdf", tmp_path / "model.sdf").path).find("model")
    assert model is not None
    found: dict[str, list[float]] = {}
    for element in model.findall("link"):
        volumes = found.setdefault(str(element.get("name")), [])
        for geometry in element.findall("collision/geometry"):
            size, uri = geometry.findtext("box/size"), geometry.findtext("mesh/uri")
            volumes.append(
                trimesh.load_mesh(tmp_path / uri).volume
                if uri is not None
                else float(np.prod([float(word) for word in str(size).split()]))
            )
    same_pieces(found, carved)


def test_usd_collides_with_as_many_pieces_as_the_urdf(carved: Path, tmp_path: Path) -> None:
    stage = Usd.Stage.Open(str(export(carved, "usd", tmp_path / "model.usda").path))
    colliding = [prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.CollisionAPI)]
    assert len(colliding) == sum(len(volumes) for volumes in pieces_of(carved).values())


def test_free_model_falls_and_a_fixed_one_does_not(urdf: Path, tmp_path: Path) -> None:
    for free in (False, True):
        model = mujoco.MjModel.from_xml_path(str(export(urdf, "mjcf", tmp_path / f"{free}.xml", free=free).path))
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, 100)
        assert (data.body("world_link").xpos[2] < -0.1) == free


def matrix(position: Any, quaternion: Any) -> FloatArray:
    T = np.eye(4)
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, np.array([quaternion.GetReal(), *quaternion.GetImaginary()], dtype=np.float64))
    T[:3, :3], T[:3, 3] = rotation.reshape(3, 3), list(position)
    return T


def motion(kind: str, axis: FloatArray, value: float) -> FloatArray:
    T = np.eye(4)
    if kind == "prismatic":
        T[:3, 3] = value * axis
    elif kind != "fixed":
        T[:3, :3] = rotation_about(axis, value)
    return T


@pytest.mark.parametrize("suffix", ["usda", "usdc"])
def test_joints_of_the_usd_put_every_link_where_the_urdf_has_it(urdf: Path, tmp_path: Path, suffix: str) -> None:
    done = export(urdf, "usd", tmp_path / f"model.{suffix}")
    assert any("followers" in loss.what and "Newton" in loss.became for loss in done.lost)
    stage = Usd.Stage.Open(str(done.path))
    joints = [UsdPhysics.Joint(prim) for prim in stage.Traverse() if prim.IsA(UsdPhysics.Joint)]
    robot, expected = poses_of(urdf)
    name_of = {
        prim.GetPath(): prim.GetDisplayName() for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.RigidBodyAPI)
    }
    assert set(name_of.values()) == set(robot.link_by_name)
    kinds = {"PhysicsFixedJoint": "fixed", "PhysicsPrismaticJoint": "prismatic", "PhysicsRevoluteJoint": "revolute"}
    for q, poses in zip(configurations(), expected, strict=True):
        values = values_of(q)
        for joint in joints:
            ends = [relation.GetTargets() for relation in (joint.GetBody0Rel(), joint.GetBody1Rel())]
            before, after = (
                matrix(position.Get(), turn.Get())
                for position, turn in (
                    (joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()),
                    (joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr()),
                )
            )
            if not ends[0]:  # the root is fixed to the world
                assert np.allclose(poses[name_of[ends[1][0]]], before @ np.linalg.inv(after), atol=1e-6)
                continue
            parent, child = (poses[name_of[end[0]]] for end in ends)
            kind = kinds[joint.GetPrim().GetTypeName()]
            moved = motion(kind, np.eye(3)[0], values.get(joint.GetPrim().GetDisplayName(), 0.0))
            assert np.allclose(parent @ before @ moved @ np.linalg.inv(after), child, atol=2e-6)
    for path, name in name_of.items():
        prim = stage.GetPrimAtPath(path)
        world = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(Usd.TimeCode.Default())).T
        assert np.allclose(world, forward_kinematics(robot, {})[name], atol=1e-6)


def test_usd_has_limits_in_degrees_masses_and_filtered_pairs(urdf: Path, tmp_path: Path) -> None:
    stage = Usd.Stage.Open(str(export(urdf, "usd", tmp_path / "model.usda").path))
    by_name = {prim.GetDisplayName(): prim for prim in stage.Traverse() if prim.GetDisplayName()}
    hinge = UsdPhysics.RevoluteJoint(by_name["hinge"])
    assert hinge.GetUpperLimitAttr().Get() == pytest.approx(np.degrees(1.2))
    assert not np.isfinite(UsdPhysics.RevoluteJoint(by_name["spin"]).GetUpperLimitAttr().Get())
    assert UsdPhysics.PrismaticJoint(by_name["slide"]).GetUpperLimitAttr().Get() == pytest.approx(0.4)
    mass = UsdPhysics.MassAPI(by_name["world"])
    assert mass.GetMassAttr().Get() == 2.0
    turned = np.array([[0.02, 0.001, 0.0], [0.001, 0.03, 0.002], [0.0, 0.002, 0.04]])
    assert sorted(mass.GetDiagonalInertiaAttr().Get()) == pytest.approx(np.linalg.eigvalsh(turned), rel=1e-5)
    follower = by_name["follow"]
    assert follower.GetRelationship("newton:mimicJoint").GetTargets() == [by_name["hinge"].GetPath()]


def test_links_and_joints_of_the_sdf_stand_where_the_urdf_has_them(urdf: Path, tmp_path: Path) -> None:
    model = etree.parse(export(urdf, "sdf", tmp_path / "model.sdf").path).find("model")
    assert model is not None
    robot, expected = poses_of(urdf)
    own = {"world_link": "world"}  # SDFormat calls the outside "world"
    at_zero = {
        own.get(str(link.get("name")), str(link.get("name"))): pose(str(link.findtext("pose")))
        for link in model.findall("link")
    }
    assert set(at_zero) == set(robot.link_by_name)
    for q, poses in zip(configurations(), expected, strict=True):
        for joint in model.findall("joint"):
            parent, child, kind = (str(joint.findtext(key)) for key in ("parent", "child", "type"))
            if joint.get("name") == "root_joint":
                assert (parent, child) == ("world", "world_link")
                continue
            parent, child = own.get(parent, parent), own.get(child, child)
            axis = np.array([float(word) for word in str(joint.findtext("axis/xyz") or "1 0 0").split()])
            value = values_of(q).get(str(joint.get("name")), 0.0)
            moved = np.linalg.inv(at_zero[parent]) @ at_zero[child] @ motion(str(joint.get("type")), axis, value)
            assert np.allclose(poses[parent] @ moved, poses[child], atol=1e-9), kind
    hinge = next(joint for joint in model.findall("joint") if joint.get("name") == "hinge")
    assert [hinge.findtext(f"axis/limit/{key}") for key in ("lower", "upper", "effort", "velocity")] == [
        "-0.5", "1.2", "20.0", "3.0",
    ]  # fmt: skip
    for uri in model.iter("uri"):
        assert (tmp_path / str(uri.text)).is_file()


def pose(text: str) -> FloatArray:
    x, y, z, roll, pitch, yaw = (float(word) for word in text.split())
    T = np.eye(4)
    rows = ((2, yaw), (1, pitch), (0, roll))
    for axis, angle in rows:
        T[:3, :3] = T[:3, :3] @ rotation_about(np.eye(3)[axis], angle)
    T[:3, 3] = x, y, z
    return T


def test_glb_shows_the_model_upright_in_its_colours(urdf: Path, tmp_path: Path) -> None:
    scene = trimesh.load_scene(export(urdf, "glb", tmp_path / "model.glb").path)
    robot = read_robot(urdf, geometry="shown")
    poses = forward_kinematics(robot, {"hinge": 0.05})  # which puts the follower at zero
    hinge = robot.joint_by_name["hinge"]
    for name in ("swing arm", "slider"):
        poses[name] = hinge.T_parent_child @ np.linalg.inv(hinge.T_parent_child @ hinge.motion(0.05)) @ poses[name]
    points = np.concatenate([mesh.vertices @ poses[part.name][:3, :3].T + poses[part.name][:3, 3]
                             for part in robot.links for mesh in part.meshes])  # fmt: skip
    upright = np.column_stack([points[:, 0], points[:, 2], -points[:, 1]])  # glTF has y up
    assert np.allclose(scene.bounds, [upright.min(axis=0), upright.max(axis=0)], atol=1e-6)
    color = scene.geometry["swing arm_0"].visual.material.baseColorFactor
    assert color.tolist()[:3] == [255, 0, 0]


def test_formats_and_files_that_cannot_be_are_refused(
    urdf: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(InputError, match="mjcf, usd, sdf, urdf, glb, srdf"):
        export(urdf, "step", tmp_path / "model.step")
    with pytest.raises(OutputError, match="usda"):
        export(urdf, "usd", tmp_path / "model.txt")
    with pytest.raises(OutputError, match=r"model\.xml"):
        export(urdf, "mjcf", tmp_path / "model.mjcf")
    with pytest.raises(OutputError, match=r"model\.urdf"):
        export(urdf, "mjcf", urdf / "model.xml")
    assert run(["export", str(urdf), "--to", "glb", "-o", str(tmp_path / "m.glb"), "--free"]) == 2
    assert "--free" in capsys.readouterr().err
    assert run(["export", str(tmp_path / "none.urdf"), "--to", "mjcf", "-o", str(tmp_path / "m.xml")]) == 2
    assert run(["export", str(urdf), "--to", "mjcf", "-o", str(tmp_path / "m.xml")]) == 0
    assert "convex pieces" in capsys.readouterr().out


def test_urdf_keeps_the_model_and_cuts_what_collides_into_convex_pieces(urdf: Path, tmp_path: Path) -> None:
    done = export(urdf, "urdf", tmp_path / "engines.urdf")
    before, after = read_robot(urdf), read_robot(done.path)
    for q, poses in zip(configurations(), poses_of(urdf)[1], strict=True):
        moved = forward_kinematics(after, q)
        assert all(np.allclose(moved[name], T, atol=1e-12) for name, T in poses.items())
    for joint, copy in zip(before.joints, after.joints, strict=True):
        assert (joint.name, joint.kind) == (copy.name, copy.kind)
        assert (joint.lower, joint.upper) == (copy.lower, copy.upper)
        assert joint.damping == copy.damping
    assert after.joint_by_name["follow"].mimic == before.joint_by_name["follow"].mimic
    tray = after.link_by_name["slider"].collisions
    assert len(tray) >= 5  # a floor and four walls
    for shape in tray:
        mesh = trimesh.Trimesh(shape.mesh.vertices, shape.mesh.faces)
        assert mesh.volume == pytest.approx(mesh.convex_hull.volume, rel=1e-6)
    assert [shape.kind for shape in after.link_by_name["wheel"].collisions] == ["sphere"]
    seen = after.link_by_name["slider"].visuals[0].mesh
    assert np.allclose(seen.vertices, before.link_by_name["slider"].visuals[0].mesh.vertices, atol=1e-8)


def test_bullet_puts_a_ball_into_the_hollow_of_an_exported_tray(urdf: Path, tmp_path: Path) -> None:
    """PyBullet takes a mesh for its hull: in the model as it was the ball would lie on top of the filled tray."""
    done = export(urdf, "urdf", tmp_path / "engines.urdf")
    depth = {}
    for path in (urdf, done.path):
        client = pybullet.connect(pybullet.DIRECT)
        try:
            robot = pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client)
            name = [pybullet.getJointInfo(robot, k, physicsClientId=client)[12].decode() for k in range(5)]
            poses = forward_kinematics(read_robot(path, geometry="shown"), {})
            tray = poses["slider"] @ read_robot(path).link_by_name["slider"].visuals[0].T_link_shape
            ball = pybullet.createMultiBody(
                1.0,
                pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.05, physicsClientId=client),
                basePosition=(tray @ [0.0, 0.0, 0.05, 1.0])[:3].tolist(),
                physicsClientId=client,
            )
            close = pybullet.getClosestPoints(
                ball, robot, 1.0, linkIndexB=name.index("slider"), physicsClientId=client
            )  # fmt: skip
            depth[path] = min(point[8] for point in close)
        finally:
            pybullet.disconnect(client)
    assert depth[urdf] < -0.02
    assert depth[done.path] > 0.0


def test_export_never_writes_over_the_model_that_it_reads(urdf: Path) -> None:
    before = urdf.read_bytes()
    with pytest.raises(InputError, match="the model itself"):
        export(urdf, "urdf", urdf, overwrite=True)
    assert urdf.read_bytes() == before
