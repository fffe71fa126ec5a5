"""SRDF: groups, end effector, named poses, and disabled pairs that Pinocchio reads back and geometry confirms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from lxml import etree

from kinematify.cli.app import run
from kinematify.config.validation import load_settings
from kinematify.errors import InputError
from kinematify.manipulation.manipulator import builtin_robot
from kinematify.manipulation.srdf import disabled_pairs, write_srdf
from kinematify.robot.read import read_robot

SETTINGS = load_settings()


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("arm")
    urdf = builtin_robot().urdf
    write_srdf(urdf, folder / "robot.srdf", SETTINGS)
    return urdf, folder / "robot.srdf"


def pairs_of(srdf: Path) -> dict[frozenset[str], str]:
    return {
        frozenset((pair.get("link1"), pair.get("link2"))): pair.get("reason")
        for pair in etree.parse(str(srdf)).getroot().findall("disable_collisions")
    }


def test_groups_hand_and_poses_of_the_arm(arm: tuple[Path, Path]) -> None:
    root = etree.parse(str(arm[1])).getroot()
    assert root.get("name") == "kinematify_arm"
    chain = root.find("group[@name='arm']/chain")
    assert (chain.get("base_link"), chain.get("tip_link")) == ("base", "hand")
    assert [j.get("name") for j in root.findall("group[@name='gripper']/joint")] == [
        "left_finger_joint", "right_finger_joint",
    ]  # fmt: skip
    assert root.find("end_effector").attrib == {
        "name": "hand", "parent_link": "hand", "group": "gripper", "parent_group": "arm",
    }  # fmt: skip
    assert {state.get("name") for state in root.findall("group_state")} == {"rest", "middle", "lower", "upper"}


def test_pinocchio_reads_it_back_with_the_same_pairs(arm: tuple[Path, Path]) -> None:
    urdf, srdf = arm
    model = pin.buildModelFromUrdf(str(urdf))
    geometry = pin.buildGeomFromUrdf(model, str(urdf), pin.GeometryType.COLLISION)
    geometry.addAllCollisionPairs()
    pin.removeCollisionPairs(model, geometry, str(srdf))
    kept = set()
    for pair in geometry.collisionPairs:
        links = frozenset(model.frames[geometry.geometryObjects[k].parentFrame].name for k in (pair.first, pair.second))
        kept |= {links} if len(links) == 2 else set()
    disabled, enabled = disabled_pairs(read_robot(urdf), SETTINGS)
    names = [link.name for link in read_robot(urdf).links if link.has_geometry]
    everything = {frozenset((a, b)) for a in names for b in names if a != b}
    assert kept == everything - {frozenset(pair) for pair, _ in disabled}
    assert len(kept) == enabled
    pin.loadReferenceConfigurations(model, str(srdf))
    assert model.referenceConfigurations["rest"][3] == pytest.approx(-1.525)


def test_a_pair_that_is_never_checked_never_meets(arm: tuple[Path, Path]) -> None:
    """With another sampling than the one that the file was made with, and another engine."""
    urdf, srdf = arm
    model = pin.buildModelFromUrdf(str(urdf))
    geometry = pin.buildGeomFromUrdf(model, str(urdf), pin.GeometryType.COLLISION)
    geometry.addAllCollisionPairs()
    data, geometry_data = model.createData(), pin.GeometryData(geometry)
    disabled, rng, met = pairs_of(srdf), np.random.default_rng(11), 0
    never = [
        index
        for index, pair in enumerate(geometry.collisionPairs)
        if disabled.get(
            frozenset(model.frames[geometry.geometryObjects[k].parentFrame].name for k in (pair.first, pair.second))
        )
        == "Never"
    ]
    for _ in range(300):
        pin.updateGeometryPlacements(
            model, data, geometry, geometry_data, rng.uniform(model.lowerPositionLimit, model.upperPositionLimit)
        )
        met += sum(pin.computeCollision(geometry, geometry_data, index) for index in never)
    assert never
    assert met == 0


def test_the_command_writes_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    urdf = builtin_robot().urdf
    assert run(["export", str(urdf), "--to", "srdf", "-o", str(tmp_path / "r.srdf"), "--tool", "tool"]) == 0
    assert "left to check" in capsys.readouterr().out
    root = etree.parse(str(tmp_path / "r.srdf")).getroot()
    assert root.find("end_effector").get("parent_link") == "tool"


def test_the_command_says_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    urdf = builtin_robot().urdf
    assert run(["export", str(urdf), "--to", "srdf", "-o", str(tmp_path / "r.srdf"), "--tool", "nose"]) == 2
    assert "no link 'nose'" in capsys.readouterr().err
    assert run(["export", str(urdf), "--to", "srdf", "-o", str(tmp_path / "none" / "r.srdf")]) == 0
    assert run(["export", str(tmp_path / "no.urdf"), "--to", "srdf", "-o", str(tmp_path / "r.srdf")]) == 2


def test_a_thing_without_joints_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    path.write_text(
        '<robot name="r"><link name="a"><visual><geometry><sphere radius="1"/></geometry></visual></link></robot>'
    )
    with pytest.raises(InputError, match="no movable joint"):
        write_srdf(path, tmp_path / "r.srdf", SETTINGS)
