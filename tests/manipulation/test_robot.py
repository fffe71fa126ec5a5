"""The project's own arm, and users' robots whose gripper is found by geometry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from kinematify.config.validation import load_settings
from kinematify.errors import InputError
from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.scene import read_scene, relative
from kinematify.manipulation.manipulator import GRASP_LINK, TaskRobot, builtin_robot, user_robot
from kinematify.robot.read import read_robot
from tests.places import BENCH

needs_bench = pytest.mark.skipif(not BENCH.is_dir(), reason="the benchmark folder is not here")


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> TaskRobot:
    return builtin_robot()


def tool_pose(robot: TaskRobot, arm: tuple[float, ...], fingers: tuple[float, ...]) -> dict[str, np.ndarray]:
    """Poses of all frames, by name."""
    model = pin.buildModelFromUrdf(str(robot.urdf))
    data, q = model.createData(), pin.neutral(model)
    for name, value in zip((*robot.arm_joints, *robot.finger_joints), (*arm, *fingers), strict=True):
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
    pin.framesForwardKinematics(model, data, q)
    return {frame.name: data.oMf[index].homogeneous.copy() for index, frame in enumerate(model.frames)}


def test_neighbours_of_the_arm_touch_in_no_configuration(arm: TaskRobot) -> None:
    scene = read_scene(read_robot(arm.urdf), load_settings().geometry)
    rng = np.random.default_rng(1)
    low, high = (np.array([getattr(t, end) for t in scene.travels]) for end in ("lower", "upper"))
    poses = scene.poses(rng.uniform(low, high, (300, len(low))))
    overlap = OverlapQueries(scene)
    for connection in scene.connections:
        assert not overlap.collide(connection.pair, relative(poses, connection.pair)).any(), scene.name(connection.pair)


def test_mass_of_every_link_lies_in_its_shapes(arm: TaskRobot) -> None:
    for link in read_robot(arm.urdf).links:
        if not link.has_geometry:
            continue
        assert link.inertial is not None
        corners = np.concatenate([shape.mesh.vertices for shape in link.collisions])
        assert (link.inertial.center_of_mass > corners.min(axis=0)).all()
        assert (link.inertial.center_of_mass < corners.max(axis=0)).all()
        moments = np.linalg.eigvalsh(link.inertial.tensor)
        assert moments[0] > 0.0
        assert moments[2] < moments[0] + moments[1]


GRIPPER = """<robot name="user">
<link name="base"><visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>
<link name="palm"><visual><geometry><box size="0.04 0.12 0.06"/></geometry></visual></link>
<link name="f1"><visual><origin xyz="0.05 0 0"/><geometry><box size="0.06 0.01 0.02"/></geometry></visual></link>
<link name="f2"><visual><origin xyz="0.05 0 0"/><geometry><box size="0.06 0.01 0.02"/></geometry></visual></link>
<link name="camera"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="palm"/><origin xyz="0.3 0 0" rpy="0 0 0.4"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="j1" type="prismatic"><parent link="palm"/><child link="f1"/><origin xyz="0 0.01 0"/>
<axis xyz="0 1 0"/><limit lower="0" upper="0.03" effort="1" velocity="1"/></joint>
<joint name="j2" type="prismatic"><parent link="palm"/><child link="f2"/><origin xyz="0 -0.01 0"/>
<axis xyz="0 1 0"/><limit lower="-0.03" upper="0" effort="1" velocity="1"/><mimic joint="j1" multiplier="-1"/></joint>
<joint name="mount" type="fixed"><parent link="palm"/><child link="camera"/><origin xyz="0 0 0.1"/></joint>
</robot>"""


@pytest.fixture
def gripper(tmp_path: Path) -> Path:
    path = tmp_path / "user.urdf"
    path.write_text(GRIPPER)
    return path


@pytest.mark.parametrize("tool", ["palm", "camera"])
def test_the_grasp_frame_of_a_users_gripper_is_found(gripper: Path, tool: str, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    robot = user_robot(gripper, tool, folder=folder)
    assert robot.tool == GRASP_LINK
    assert robot.arm_joints == ("turn",)
    assert robot.finger_joints == ("j1", "j2")
    assert robot.opening == pytest.approx(0.07, abs=1e-6)
    assert robot.fingers_open == pytest.approx((0.03, -0.03))
    poses = tool_pose(robot, (0.0,), robot.fingers_open)
    frame = np.linalg.inv(poses["palm"]) @ poses[GRASP_LINK]
    assert frame[:3, 2] == pytest.approx([1, 0, 0], abs=1e-6)  # out of the palm
    assert np.abs(frame[:3, 1]) == pytest.approx([0, 1, 0], abs=1e-6)
    assert frame[:3, 3] == pytest.approx([0.07, 0, 0], abs=1e-6)  # the tips end at 0.08


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"tool": "hand"}, "no link 'hand'"),
        ({"tool": "f1"}, "Nothing moves on the link 'f1'"),
        ({"tool": "palm", "gripper": ("grip",)}, "no movable joint 'grip'"),
        ({"tool": "palm", "gripper": ("turn",)}, "two fingers"),
        ({"tool": "base", "gripper": ("j1", "j2")}, "there is no arm"),
    ],
)
def test_what_cannot_hold_is_refused(gripper: Path, tmp_path: Path, arguments: dict, words: str) -> None:
    with pytest.raises(InputError, match=words):
        user_robot(gripper, **arguments, folder=tmp_path)


def test_fingers_that_do_not_open_are_refused(gripper: Path, tmp_path: Path) -> None:
    gripper.write_text(GRIPPER.replace('upper="0.03"', 'upper="0"').replace('0.01 0"/>\n', '0.005 0"/>\n'))
    with pytest.raises(InputError, match="mm apart"):
        user_robot(gripper, "palm", folder=tmp_path)


@needs_bench
@pytest.mark.parametrize(("name", "tool", "opening"), [("panda", "panda_hand", 0.08), ("fetch", "gripper_link", 0.1)])
def test_grippers_of_published_robots_open_as_stated(name: str, tool: str, opening: float, tmp_path: Path) -> None:
    robot = user_robot(BENCH / "robots" / name / "model.urdf", tool, folder=tmp_path)
    assert robot.opening == pytest.approx(opening, abs=2e-3)
    rows = tool_pose(robot, robot.home, robot.fingers_open)
    frame = np.linalg.inv(rows[tool]) @ rows[GRASP_LINK]
    approach = [0, 0, 1] if name == "panda" else [1, 0, 0]
    assert frame[:3, 2] == pytest.approx(approach, abs=1e-3)


def test_pads_meet_where_fingers_could_pass_through_each_other(gripper: Path, tmp_path: Path) -> None:
    gripper.write_text(GRIPPER.replace('lower="0" upper="0.03"', 'lower="-0.02" upper="0.03"'))
    robot = user_robot(gripper, "palm", folder=tmp_path)
    assert robot.opening == pytest.approx(0.07)
    assert robot.fingers_closed == pytest.approx((-0.005, 0.005))
