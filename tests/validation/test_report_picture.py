"""The picture of an HTML report: any tree of joints can be drawn, in a process of its own."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kinematify.config.validation import load_settings
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.validation.formats.report_picture import Drawing, drawing_of, shown_model

GRIPPER = """<robot name="gripper">
  <link name="world"/>
  <link name="palm"><visual><geometry><box size="0.1 0.2 0.05"/></geometry></visual></link>
  <link name="left"><visual><origin xyz="0 0 0.05"/><geometry><box size="0.05 0.01 0.1"/></geometry></visual></link>
  <link name="right"><visual><origin xyz="0 0 0.05"/><geometry><box size="0.05 0.01 0.1"/></geometry></visual></link>
  <link name="wrist"/>
  <joint name="mount" type="fixed"><parent link="world"/><child link="palm"/><origin xyz="0 0 1" rpy="0 0 1"/></joint>
  <joint name="spin" type="revolute"><parent link="palm"/><child link="wrist"/><axis xyz="0 0 1"/>
    <limit lower="0.5" upper="1.5" effort="1" velocity="1"/></joint>
  <joint name="open" type="prismatic"><parent link="wrist"/><child link="left"/><origin xyz="0 0.01 0.05"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.05" effort="1" velocity="1"/></joint>
  <joint name="follow" type="prismatic"><parent link="wrist"/><child link="right"/><origin xyz="0 -0.01 0.05"/>
    <axis xyz="0 1 0"/><limit lower="-0.05" upper="0" effort="1" velocity="1"/><mimic joint="open" multiplier="-1"/>
  </joint>
</robot>"""


@pytest.fixture
def gripper(tmp_path: Path) -> Path:
    file = tmp_path / "gripper.urdf"
    file.write_text(GRIPPER)
    return file


def test_shown_model_stands_at_rest_and_moves_as_declared(gripper: Path) -> None:
    model = shown_model(read_robot(gripper))
    assert [link.name for link in model.links] == ["world", "wrist", "left", "right"]
    turned = (0.1 * np.cos(1) + 0.2 * np.sin(1), 0.1 * np.sin(1) + 0.2 * np.cos(1), 0.05)
    assert model.link_by_name["world"].part.diagonal == pytest.approx(np.linalg.norm(turned))
    limits = {joint.name: (joint.lower, joint.upper) for joint in model.joints}
    assert limits["spin"] == pytest.approx((-0.5, 0.5))
    assert limits["follow"] == pytest.approx((-0.05, 0.0))
    moved = forward_kinematics(model.robot, {"open": 0.05, "follow": -0.05})
    gap = np.linalg.norm(moved["left"][:3, 3] - moved["right"][:3, 3])
    assert gap == pytest.approx(0.12)


def test_a_model_is_drawn(gripper: Path) -> None:
    drawing = drawing_of(gripper, (), load_settings(), seconds=30.0)
    png = drawing.picture
    image = Image.open(io.BytesIO(png))
    assert image.format == "PNG"
    assert image.width > image.height > 200
    assert len(np.unique(np.asarray(image.convert("RGB")).reshape(-1, 3), axis=0)) > 500


def test_what_cannot_be_drawn_is_no_failure(tmp_path: Path) -> None:
    (tmp_path / "bare.urdf").write_text('<robot name="bare"><link name="base"/></robot>')
    (tmp_path / "broken.urdf").write_text("<robot")
    assert drawing_of(tmp_path / "bare.urdf", (), load_settings(), seconds=30.0) == Drawing()
    assert drawing_of(tmp_path / "broken.urdf", (), load_settings(), seconds=30.0) == Drawing()
