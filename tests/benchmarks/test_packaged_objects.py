"""Objects that packages carry: MJCF compiled by MuJoCo, URDF of an installed package, written as the fit reads them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from lxml import etree

from benchmarks.fit.mjcf import read_mjcf
from benchmarks.fit.packages import write_installed
from kinematify.assembly.erasure import erase
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot

_CABINET = """
<mujoco>
  <compiler angle="degree"/>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="other"><freejoint/><geom type="sphere" size="0.1"/></body>
    <body name="cabinet" pos="0 0 1">
      <geom type="box" size="0.2 0.3 0.4"/>
      <body name="shelf"><geom type="capsule" size="0.01 0.1"/></body>
      <body name="drawer" pos="0.2 0 0" euler="0 0 90">
        <joint name="slide" type="slide" axis="0 -1 0" range="0 0.3"/>
        <geom type="box" size="0.25 0.1 0.1" contype="0" conaffinity="0" group="1"/>
        <geom type="box" size="0.5 0.5 0.5" group="1"/>
        <body name="flap" pos="0.1 0 0">
          <joint name="hinge" axis="0 0 1" range="-90 0"/>
          <geom type="cylinder" size="0.02 0.05"/>
          <geom type="box" size="1 1 1" group="4"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def test_an_mjcf_tree_is_read_as_it_is_shown(tmp_path: Path) -> None:
    robot = read_mjcf(etree.fromstring(_CABINET), tmp_path / "scene.xml", ["cabinet"])
    assert [link.name for link in robot.links] == ["cabinet", "drawer", "flap"], "the shelf belongs to the cabinet"
    slide, hinge = robot.joints
    assert (slide.kind, slide.lower, slide.upper) == (JointType.PRISMATIC, 0.0, 0.3)
    np.testing.assert_allclose(slide.axis, [1.0, 0.0, 0.0], atol=1e-9)
    assert (hinge.kind, hinge.parent) == (JointType.REVOLUTE, "drawer")
    assert hinge.lower == pytest.approx(-np.pi / 2)
    np.testing.assert_allclose(slide.T_parent_child[:3, 3] + hinge.T_parent_child[:3, 3], [0.2, 0.1, 1.0], atol=1e-9)
    assert [shape.kind for link in robot.links for shape in link.visuals] == ["box", "capsule", "box", "cylinder"]
    np.testing.assert_allclose(np.ptp(robot.links[1].visuals[0].mesh.vertices, axis=0), [0.2, 0.5, 0.2], atol=1e-6)


def test_a_body_that_moves_freely_is_no_joint(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="other moves freely"):
        read_mjcf(etree.fromstring(_CABINET), tmp_path / "scene.xml", ["cabinet", "other"])


def test_objects_of_installed_packages_are_objects_of_the_fit(tmp_path: Path) -> None:
    names = write_installed(tmp_path)
    assert "bullet_husky" in names, "pybullet is installed for the tests"
    for name in names:
        facts = json.loads((tmp_path / name / "source.json").read_text(encoding="utf-8"))
        assert facts["license"]
        erased = erase(read_robot(tmp_path / name / "model.urdf", geometry="shown"), pose="rest", seed=0, yaw_deg=0.0)
        assert len(erased.assembly.parts) >= 2
    husky = erase(
        read_robot(tmp_path / "bullet_husky" / "model.urdf", geometry="shown"), pose="rest", seed=0, yaw_deg=0
    )
    assert [joint.kind for joint in husky.truth.joints] == [JointType.CONTINUOUS] * 4
