"""Models that engines simulate as they read them: the untouched file, with each engine's own defaults."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.generate.blueprint_files import true_model
from kinematify.generate.registry import build
from kinematify.model.simulable import simulable_model
from kinematify.model.urdf import write_model
from kinematify.robot.joint_type import JointType
from kinematify.versions import NO_WHEELS
from tests.places import ROOT
from tests.plain_mujoco import hand, stuck_joints, wanted

pybullet = pytest.importorskip("pybullet", reason=NO_WHEELS)

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.model.simulable import SimulableModel

FAMILIES = ("box", "microwave", "toilet")


@pytest.fixture(scope="module", params=FAMILIES)
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[SimulableModel, Path]:
    config = load_config()
    model = simulable_model(true_model(build(request.param, seed=1), config), config)
    return model, write_model(model.robot, tmp_path_factory.mktemp(request.param))


def test_the_plain_code_of_the_readme_loads_what_is_written(written: tuple[SimulableModel, Path]) -> None:
    made, urdf = written
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    lines = [line for line in page.splitlines() if line.startswith(("model = mujoco.", "body = pybullet."))]
    assert len(lines) == 2
    names: dict[str, Any] = {"mujoco": mujoco, "pybullet": pybullet}
    client = pybullet.connect(pybullet.DIRECT)
    try:
        exec("\n".join(lines).replace("out/example/model.urdf", str(urdf)), names)
        moving = [joint for joint in made.robot.joints if joint.kind is not JointType.FIXED]
        infos = [pybullet.getJointInfo(names["body"], k) for k in range(pybullet.getNumJoints(names["body"]))]
        assert names["model"].njnt == sum(info[2] != pybullet.JOINT_FIXED for info in infos) == len(moving) > 0
    finally:
        pybullet.disconnect(client)


def test_every_joint_moves_in_plain_mujoco(written: tuple[SimulableModel, Path]) -> None:
    made, urdf = written
    assert stuck_joints(mujoco.MjModel.from_xml_path(str(urdf)), made.robot) == []


def test_nothing_overlaps_or_moves_by_itself_in_plain_mujoco(written: tuple[SimulableModel, Path]) -> None:
    _, urdf = written
    model = mujoco.MjModel.from_xml_path(str(urdf))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    mujoco.mj_step(model, data, 1000)
    assert np.abs(data.qpos).max() < 0.01


def test_every_joint_moves_in_plain_pybullet(written: tuple[SimulableModel, Path]) -> None:
    made, urdf = written
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setGravity(0.0, 0.0, -9.81, physicsClientId=client)
        body = pybullet.loadURDF(
            str(urdf), useFixedBase=1, flags=pybullet.URDF_USE_SELF_COLLISION, physicsClientId=client
        )
        index = {
            pybullet.getJointInfo(body, k, physicsClientId=client)[1].decode(): k
            for k in range(pybullet.getNumJoints(body, physicsClientId=client))
        }
        for joint in made.robot.leaders:
            number = index[joint.name]
            sign, goal = math.copysign(1.0, wanted(joint)), abs(wanted(joint))
            free = {"controlMode": pybullet.VELOCITY_CONTROL, "force": 0.0, "physicsClientId": client}
            pybullet.setJointMotorControl2(body, number, **free)
            for _ in range(1500):
                pybullet.setJointMotorControl2(
                    body, number, pybullet.TORQUE_CONTROL, force=sign * hand(joint), physicsClientId=client
                )
                pybullet.stepSimulation(physicsClientId=client)
                if sign * pybullet.getJointState(body, number, physicsClientId=client)[0] >= goal:
                    break
            assert sign * pybullet.getJointState(body, number, physicsClientId=client)[0] >= goal, joint.name
            pybullet.resetJointState(body, number, 0.0, physicsClientId=client)
            pybullet.setJointMotorControl2(
                body, number, pybullet.VELOCITY_CONTROL, targetVelocity=0.0, force=100.0, physicsClientId=client
            )
    finally:
        pybullet.disconnect(client)


def test_the_record_says_what_was_fitted(written: tuple[SimulableModel, Path]) -> None:
    made, _ = written
    record = made.record()
    assert record["mode"] == "auto"
    assert {link["link"] for link in record["links"]} == {link.name for link in made.robot.links}
    assert all(link["boxes"] + link["convex"] > 0 for link in record["links"])


def test_visual_meshes_collide_where_they_are_asked_for() -> None:
    config = load_config()
    config = config.model_copy(update={"collision": config.collision.model_copy(update={"mode": "mesh"})})
    made = simulable_model(true_model(build("cabinet", seed=1), config), config)
    assert made.record() == {"mode": "mesh"}
    assert all(link.collisions == link.visuals for link in made.robot.links)
