"""A linkage in environments, in PyBullet by itself, and in the engine checks: the engine closes its loops."""

from __future__ import annotations

import shutil
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from lxml import etree

import kinematify
from benchmarks.linkages import linkage
from kinematify.config import load_config
from kinematify.envs.expert import HandExpert
from kinematify.envs.open_part import OpenPartEnv
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.robot.linkage import loop_gaps
from kinematify.validation.run import validate
from kinematify.versions import NO_WHEELS
from tests.toolbox import toolbox as drawn_toolbox

bullet = pytest.importorskip("pybullet", reason=NO_WHEELS)

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="module", params=["parallelogram", "four bars"])
def model(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A toolbox, whose joints follow by <mimic>, and a clamp, whose joints follow along curves."""
    folder: Path = tmp_path_factory.mktemp("linkage")
    toolbox = request.param == "parallelogram"
    drawn = drawn_toolbox() if toolbox else linkage("toggle_clamp", 0)
    write_blueprint(drawn, folder, load_config())
    return folder


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_a_hand_opens_a_linkage_that_stays_closed(model: Path, engine: str) -> None:
    env = OpenPartEnv(model=model, engine=engine, control="position", allow_invalid=True)
    expert = HandExpert(env)
    observation, info = env.reset(seed=0)
    expert.begin()
    for _ in range(160):
        observation, _, ended, _, info = env.step(expert.act(observation))
        if info["is_success"] or ended:
            break
    assert info["is_success"], info
    poses, robot = env.world.link_poses(), env.articulated_object.declared
    ends = [
        [(poses[link] @ np.append(point, 1.0))[:3] for link, point in zip(loop.links, loop.points, strict=True)]
        for loop in robot.loops
    ]
    assert max(np.linalg.norm(one - other) for one, other in ends) < 1e-3 * env.articulated_object.scene.size
    env.close()


def test_to_pybullet_closes_the_loops(model: Path) -> None:
    world, loaded = bullet.connect(bullet.DIRECT), kinematify.load(model)
    body = loaded.to_pybullet(world)
    assert bullet.getNumConstraints(physicsClientId=world) == len(loaded.robot.loops)
    count = bullet.getNumJoints(body, physicsClientId=world)
    joints = {bullet.getJointInfo(body, k, physicsClientId=world)[1].decode(): k for k in range(count)}
    driver = loaded.robot.leaders[0]
    target = 0.8 * driver.upper
    for step in range(480):
        aim = min(step / 240, 1.0) * target
        bullet.setJointMotorControl2(body, joints[driver.name], bullet.POSITION_CONTROL, aim, physicsClientId=world)
        bullet.stepSimulation(physicsClientId=world)
    values = {name: bullet.getJointState(body, k, physicsClientId=world)[0] for name, k in joints.items()}
    bullet.disconnect(world)
    assert values[driver.name] == pytest.approx(target, abs=0.02)
    diagonal = float(np.linalg.norm(np.ptp(np.concatenate([m.bounds for m in loaded.meshes().values()]), axis=0)))
    free = tuple(replace(joint, mimic=None, closure=None) for joint in loaded.robot.joints)
    assert max(loop_gaps(replace(loaded.robot, joints=free), values).values()) < 1e-3 * diagonal


def test_a_loop_whose_ends_are_apart_is_a_finding(model: Path, tmp_path: Path) -> None:
    folder = tmp_path / "open"
    shutil.copytree(model, folder)
    document = etree.parse(folder / "model.urdf")
    point = next(item for item in document.getroot().iter() if etree.QName(item).localname == "ball_constraint_p_AP")
    x, y, z = map(float, str(point.get("value")).split())
    point.set("value", f"{x} {y} {z + 0.05}")
    document.write(folder / "model.urdf")
    report = validate(folder / "model.urdf", selected=["KV230"], engines=())
    found = [item for item in report.findings if item.check == "KV230"]
    assert found
    assert all(0.04 < item.value < 0.1 for item in found)
