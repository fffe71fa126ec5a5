"""Models become URDF files that three engines read alike and that reproduce the input."""

from __future__ import annotations

import numpy as np
import pytest
from lxml import etree
from scipy.spatial import cKDTree

from kinematify.assembly.part import Assembly, Part
from kinematify.contact.tree import KinematicTree
from kinematify.errors import DescriptionError
from kinematify.model.build import build_model
from kinematify.model.urdf import write_urdf
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics
from tests.engines import READERS
from tests.mechanisms import CONFIG, Mechanism, box, chain, door, drawer, flat_and_fixed, joint

KINDS = {JointType.REVOLUTE: "turns", JointType.CONTINUOUS: "turns", JointType.PRISMATIC: "slides"}


@pytest.mark.parametrize("engine", READERS)
@pytest.mark.parametrize("build", [chain, flat_and_fixed], ids=lambda build: build.__name__)
def test_engines_read_the_same_joints(build, engine, tmp_path):
    model = build().model()
    read = READERS[engine](write_urdf(model, tmp_path), {}).joints
    moving = {item.name: item for item in model.joints if item.kind is not JointType.FIXED}
    assert set(read) == set(moving)
    for name, item in moving.items():
        assert read[name].kind == KINDS[item.kind]
        np.testing.assert_allclose(read[name].axis, item.axis, atol=1e-6)
        if item.kind is JointType.CONTINUOUS:
            assert read[name].limits is None
        else:
            np.testing.assert_allclose(read[name].limits, (item.lower, item.upper), atol=1e-6)


@pytest.mark.parametrize("engine", READERS)
@pytest.mark.parametrize("build", [chain, flat_and_fixed], ids=lambda build: build.__name__)
def test_zero_configuration_reproduces_the_input(build, engine, tmp_path):
    mechanism = build()
    read = READERS[engine](write_urdf(mechanism.model(), tmp_path), {}).vertices
    for part in mechanism.assembly.parts:
        if part.name == "flap" and engine in {"mujoco", "pybullet"}:
            continue  # a flat part collides as a thin solid, which has a test of its own
        tolerance = 1e-6 * mechanism.assembly.diagonal
        if engine == "pybullet":
            tolerance = max(tolerance, part.diagonal / 5000)  # Bullet rounds hulls to a grid of 1/10216 of their size
        found = read[part.name]
        # All parts here are convex, so that even engines that keep hulls have every vertex.
        assert cKDTree(found).query(part.vertices)[0].max() < tolerance
        if part.name != "flap":  # which carries a set-aside part as well
            assert cKDTree(part.vertices).query(found)[0].max() < tolerance


def test_masses_reach_mujoco(tmp_path):
    import mujoco

    model = chain().model()
    spec = mujoco.MjSpec.from_file(str(write_urdf(model, tmp_path)))
    spec.compiler.fusestatic = False
    compiled = spec.compile()
    for link in model.links:
        body = compiled.body(link.name)
        assert body.mass[0] == pytest.approx(link.inertial.mass)
        np.testing.assert_allclose(sorted(body.inertia), np.linalg.eigvalsh(link.inertial.tensor), rtol=1e-6)
        np.testing.assert_allclose(body.ipos, link.inertial.center_of_mass, atol=1e-9)


def test_root_frame_is_world_and_other_frames_lie_on_their_axes():
    mechanism = drawer()
    model = mechanism.model()
    assert model.root == "cabinet"
    np.testing.assert_array_equal(model.link_by_name["cabinet"].T_world_link, np.eye(4))
    T_world_link = model.link_by_name["drawer"].T_world_link
    np.testing.assert_array_equal(T_world_link[:3, :3], np.eye(3))
    np.testing.assert_array_equal(T_world_link[:3, 3], mechanism.joints[0].pivot)


def test_file_is_plain(tmp_path):
    urdf = write_urdf(flat_and_fixed().model(), tmp_path)
    text = urdf.read_text(encoding="utf-8")
    lines = text.splitlines()
    assert max(map(len, lines)) < 4096
    assert all(line.count("<") == 1 or "</" in line for line in lines)
    assert "package://" not in text
    robot = etree.parse(urdf).getroot()
    for mesh in robot.iter("mesh"):
        assert not mesh.get("filename").startswith("/")
        assert (tmp_path / mesh.get("filename")).is_file()
    for item in robot.iter("joint"):
        limit = item.find("limit")
        if item.get("type") in {"revolute", "prismatic"}:
            assert float(limit.get("lower")) < float(limit.get("upper"))
        if item.get("type") != "fixed":
            axis = np.array(item.find("axis").get("xyz").split(), dtype=float)
            assert np.linalg.norm(axis) == pytest.approx(1.0, abs=1e-15)
    colors = [{color.get("rgba") for color in link.iter("color")} for link in robot.iter("link")]
    assert all(len(found) == 1 for found in colors), "one colour for all of a link"
    assert len(set.union(*colors)) == len(colors) == 3


def test_flat_part_collides_as_a_thin_solid_and_looks_as_given(tmp_path):
    mechanism = flat_and_fixed()
    robot = etree.parse(write_urdf(mechanism.model(), tmp_path)).getroot()
    flap = robot.find("link[@name='flap']")
    assert [mesh.get("filename") for mesh in flap.findall("visual/geometry/mesh")] == [
        "meshes/flap.obj",
        "meshes/badge.obj",
    ]
    assert flap.find("collision/geometry/mesh").get("filename") == "meshes/flap_collision.obj"
    reading = READERS["mujoco"](tmp_path / "model.urdf", {})
    away = cKDTree(mechanism.assembly.parts[1].vertices).query(reading.vertices["flap"])[0]
    assert away.max() < 1e-4 * mechanism.assembly.diagonal


def test_original_mesh_is_written_instead_of_the_simplified_one(tmp_path):
    mechanism = door()
    leaf = mechanism.assembly.parts[1]
    a, b, c = leaf.faces[0]
    finer = Part(
        name="leaf",
        vertices=np.vstack([leaf.vertices, leaf.vertices[leaf.faces[0]].mean(axis=0)]),
        faces=np.vstack([leaf.faces[1:], [[a, b, 8], [b, c, 8], [c, a, 8]]]),
    )
    assembly = Assembly(parts=mechanism.assembly.parts, source="door", originals={"leaf": finer})
    model = build_model(assembly, mechanism.tree, mechanism.joints, name="door", config=CONFIG.model)
    write_urdf(model, tmp_path)
    assert (tmp_path / "meshes/leaf.obj").read_text().count("f ") == 14
    assert (tmp_path / "meshes/frame.obj").read_text().count("f ") == 12


def test_names_that_clash_stay_apart(tmp_path):
    parts = tuple(box(name, (i, 0, 0), (0.5, 0.5, 0.5)) for i, name in enumerate(("a", "A", "a_joint", "a.b", "a_b")))
    joints = tuple(joint(i, "revolute", (0, 0, 1), (i, 0, 0), (0.0, 1.0), parent=4) for i in range(4))
    tree = KinematicTree(parents=(4, 4, 4, 4, -1))
    model = build_model(Assembly(parts=parts, source="names"), tree, joints, name="names", config=CONFIG.model)
    assert [item.name for item in model.joints] == ["a_joint_2", "A_joint", "a_joint_joint", "a.b_joint"]
    write_urdf(model, tmp_path)
    stems = [path.stem.casefold() for path in (tmp_path / "meshes").iterdir()]
    assert len(set(stems)) == 5


@pytest.mark.parametrize(("scale", "shift"), [(1e-3, 50.0), (1e3, 0.0)])
def test_any_size_and_place_loads_in_mujoco(scale, shift, tmp_path):
    given = flat_and_fixed()
    parts = tuple(
        Part(name=part.name, vertices=(part.vertices + shift) * scale, faces=part.faces)
        for part in given.assembly.parts
    )
    joints = tuple(
        joint(item.child, item.kind, item.axis, (item.pivot + shift) * scale, (item.lower, item.upper))
        for item in given.joints
    )
    moved = Mechanism("moved", Assembly(parts=parts, source="moved"), given.tree, joints)
    reading = READERS["mujoco"](write_urdf(moved.model(), tmp_path), {})
    assert cKDTree(reading.vertices["body"]).query(parts[0].vertices)[0].max() < 1e-4 * moved.assembly.diagonal


def test_limits_that_engines_would_drop_are_mended():
    parts = tuple(box(f"p{i}", (i, 0, 0), (0.5, 0.5, 0.5)) for i in range(4))
    joints = (
        joint(1, "revolute", (0, 0, 1), (0, 0, 0), (0.3, 0.3)),
        joint(2, "prismatic", (0, 0, 1), (0, 0, 0), (0.0, np.inf)),
        joint(3, "revolute", (0, 0, 1), (0, 0, 0), (-np.inf, np.inf)),
    )
    assembly = Assembly(parts=parts, source="limits")
    tree = KinematicTree(parents=(-1, 0, 0, 0))
    stuck, slide, wheel = build_model(assembly, tree, joints, name="limits", config=CONFIG.model).joints
    assert stuck.lower == 0.3 < stuck.upper < 0.302
    assert slide.upper == pytest.approx(assembly.diagonal)
    assert wheel.kind is JointType.CONTINUOUS


def test_estimates_must_be_those_of_the_tree():
    mechanism = door()
    with pytest.raises(ValueError, match="every tree edge"):
        build_model(mechanism.assembly, mechanism.tree, (), name="door", config=CONFIG.model)
    with pytest.raises(DescriptionError, match="has no joint lid"):
        forward_kinematics(mechanism.model().robot, {"lid": 0.1})
