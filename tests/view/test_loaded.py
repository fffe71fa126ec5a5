"""`kinematify.load`: a model of a file posed, shown and handed to engines from Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kinematify

_URDF = """<robot name="door">
<link name="frame"><inertial><mass value="3"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="1 0.1 2"/></geometry><material name="w"><color rgba="1 1 0 1"/></material></visual>
<collision><geometry><box size="1 0.1 2"/></geometry></collision></link>
<link name="door"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.04 1.8"/></geometry></visual>
<collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.04 1.8"/></geometry></collision></link>
<joint name="hinge" type="revolute"><parent link="frame"/><child link="door"/><origin xyz="-0.4 -0.1 0"/>
<axis xyz="0 0 -1"/><limit lower="0" upper="1.6" effort="1" velocity="1"/></joint>
</robot>"""


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    file = tmp_path / "model.urdf"
    file.write_text(_URDF)
    return file


def test_a_model_is_posed_by_the_name_of_the_joint_or_of_its_link(urdf: Path) -> None:
    robot = kinematify.load(urdf.parent)
    assert list(robot.joints) == ["hinge"]
    assert "joints hinge" in repr(robot)
    turned = robot.pose({"hinge": 0.5 * np.pi})["door"]
    assert np.allclose(turned, robot.pose({"door": 0.5 * np.pi})["door"])
    assert np.allclose(turned[:3, :3] @ [1.0, 0.0, 0.0], [0.0, -1.0, 0.0])
    with pytest.raises(kinematify.KinematifyError, match=r"no joint lid.*hinge"):
        robot.pose({"lid": 1.0})


@pytest.mark.parametrize(
    ("q", "reason"),
    [
        ({"hinge": 99}, r"hinge moves from 0 to 1\.6 rad; 99 rad lies outside"),
        ({"door": -0.1}, r"hinge moves from 0 to 1\.6 rad"),
        ({"hinge": "open"}, r"value of the joint hinge is 'open'; give a finite number in rad"),
        ({"hinge": float("nan")}, r"finite number"),
        (["hinge"], r"maps joint names to numbers.*list"),
    ],
)
def test_a_value_that_no_joint_can_take_is_refused_with_the_range(urdf: Path, q: Any, reason: str) -> None:
    robot = kinematify.load(urdf)
    for use in (robot.pose, robot.meshes):
        with pytest.raises(kinematify.KinematifyError, match=reason):
            use(q)


def test_a_joint_without_limits_takes_any_value(urdf: Path) -> None:
    urdf.write_text(_URDF.replace("revolute", "continuous"))
    assert np.allclose(kinematify.load(urdf).pose({"hinge": 99.0})["door"][0, 0], np.cos(99.0))


def test_meshes_stand_where_the_links_do_in_their_colours(urdf: Path) -> None:
    robot = kinematify.load(str(urdf))
    found = robot.meshes({"door": 0.5 * np.pi})
    assert np.allclose(found["door"].bounds[:, 0], [-0.42, -0.38])
    visual = found["frame"].visual
    assert visual is not None
    assert np.asarray(visual.face_colors)[0].tolist() == [255, 255, 0, 255]


def test_engines_get_the_model(urdf: Path) -> None:
    robot = kinematify.load(urdf)
    mujoco_model = robot.to_mujoco()
    assert (mujoco_model.njnt, mujoco_model.nu) == (1, 1)


def test_it_is_shown_until_it_is_closed(urdf: Path) -> None:
    window = kinematify.load(urdf).show({"door": 0.5}, port=18091)
    try:
        assert window.viewer.values == {"hinge": 0.5}
        assert f'<iframe src="{window.url}"' in window._repr_html_()
    finally:
        window.close()


def test_what_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(kinematify.KinematifyError, match="has no URDF file"):
        kinematify.load(tmp_path)
