"""DrawerPull: documented spaces, an arm that holds by friction alone, the same story twice, clear refusals."""

from __future__ import annotations

import pickle
import shutil
import sys
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from kinematify.envs import drawer_pull as pull
from kinematify.envs import robot_plan
from kinematify.envs.base import OPEN_REWARD, SUCCESS_REWARD
from kinematify.envs.drawer_pull import DrawerPullEnv
from kinematify.envs.expert import ArmExpert
from kinematify.envs.goal import CONTROL_STEP
from kinematify.envs.joint_dynamics import ROBOT_PLACE
from kinematify.envs.tasks import EPISODE_STEPS
from kinematify.envs.worlds import Servos
from kinematify.errors import EnvironmentFault, InputError
from kinematify.manipulation.manipulator import builtin_robot
from kinematify.simulation.world import ROBOT
from tests.envs.hands import documented_rows, write_slider

DRAWER_PULL = "kinematify.envs:kinematify/DrawerPull-v0"
BAR = """<link name="bar">
    <inertial><mass value="0.2"/><inertia ixx="0.0004" iyy="0.0001" izz="0.0004" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="0.14 0.012 0.012"/></geometry></visual>
    <collision><geometry><box size="0.14 0.012 0.012"/></geometry></collision></link>
  <joint name="bar_joint" type="fixed"><parent link="front"/><child link="bar"/><origin xyz="0 -0.05 0"/></joint>"""


@pytest.fixture(scope="module")
def drawer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A front with a bar, of boxes alone, so that nothing has to be cut."""
    return write_slider(tmp_path_factory.mktemp("drawer") / "drawer.urdf", extra=BAR)


def run_expert(env: gymnasium.Env, seed: int) -> dict[str, object]:
    expert = ArmExpert(env.unwrapped)
    observation, info = env.reset(seed=seed)
    expert.begin()
    over, deepest = False, 0.0
    while not over:
        observation, reward, terminated, truncated, info = env.step(expert.act(observation))
        assert 0.0 <= reward <= 1.0
        over, deepest = terminated or truncated, max(deepest, info["max_penetration"])
    return {**info, "deepest": deepest}


def test_the_documented_spaces_are_the_spaces(drawer: Path) -> None:
    env = DrawerPullEnv(drawer, allow_invalid=True)
    rows = documented_rows(DrawerPullEnv)
    covered = [index for first, last, _, _ in rows for index in range(first, last + 1)]
    assert covered == list(range(env.observation_space.shape[0]))
    for first, last, low, high in rows:
        assert set(env.observation_space.low[first : last + 1].tolist()) == {low}
        assert set(env.observation_space.high[first : last + 1].tolist()) == {high}
    flat = " ".join((DrawerPullEnv.__doc__ or "").split())
    share = 1.0 - pull.REACH_REWARD - pull.GRIP_REWARD
    for words in (
        f"`Box(-1, 1, {env.action_space.shape}, float32)`",
        "`Box((86,), float32)`",
        f"after {EPISODE_STEPS['drawer_pull']} steps of {CONTROL_STEP:g} s",
        f"shares of {pull.TOOL_STEP:g} m",
        f"shares of {pull.TURN_STEP:g} rad",
        f"shares of {pull.JOINT_STEP:g} rad",
        f"in {pull.FINGER_SECONDS:g} s at",
        f"leaves, {pull.POSTURE:g} of it per step",
        f"share of {Servos.grip_force:g} N",
        f"{pull.REACH_REWARD:g} times 1 - tanh({pull.REACH_SCALE:g} d)",
        f"{pull.GRIP_REWARD:g} while both fingers press on the part with at least {pull.TOUCH_FORCE:g} N",
        f"{share * OPEN_REWARD:g} times the share",
        f"{share * SUCCESS_REWARD:g} for success",
        f"off by up to {pull.START_NOISE:g} rad",
        f"up to {ROBOT_PLACE[0]:g} m along x and y",
        f"and {ROBOT_PLACE[1]:g} rad",
    ):
        assert words in flat
    assert gymnasium.spec(DRAWER_PULL.split(":")[1]).max_episode_steps == EPISODE_STEPS["drawer_pull"]
    assert DrawerPullEnv(drawer, control="joint", allow_invalid=True).action_space.shape == (8,)


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_check_env_has_nothing_to_say(drawer: Path, engine: str) -> None:
    for env_id in (DRAWER_PULL, DRAWER_PULL.replace("-v0", "-Sparse-v0")):
        env = gymnasium.make(env_id, model=drawer, engine=engine, randomize=True, allow_invalid=True)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            check_env(env.unwrapped, skip_render_check=True)
        env.close()


@pytest.mark.parametrize(("engine", "control"), [("mujoco", "tool"), ("mujoco", "joint"), ("pybullet", "joint")])
def test_the_expert_grips_and_opens(drawer: Path, engine: str, control: str) -> None:
    env = gymnasium.make(
        DRAWER_PULL, model=drawer, engine=engine, control=control, randomize=True, allow_invalid=True,
        terminate_on_success=True,
    )  # fmt: skip
    info = run_expert(env, seed=3)
    assert info["is_success"], info
    assert info["grip"]
    assert not info["thrown"]
    assert info["deepest"] < 2e-3
    assert info["warnings"] == {}
    env.close()


def test_without_friction_the_fingers_slip(drawer: Path) -> None:
    """Nothing is welded and nothing is snapped: the pull is friction."""
    env = gymnasium.make(DRAWER_PULL, model=drawer, control="joint", allow_invalid=True)
    model = env.unwrapped.world.model
    for geom in range(model.ngeom):
        if model.body(model.geom_bodyid[geom]).name.startswith(ROBOT):
            model.geom_friction[geom] = 1e-4
    info = run_expert(env, seed=3)
    assert info["open_fraction"] < 0.5
    assert not info["is_success"]


@pytest.mark.parametrize("engine", ["mujoco", "pybullet"])
def test_seeds_and_pickles(drawer: Path, engine: str) -> None:
    env = DrawerPullEnv(drawer, engine=engine, randomize=True, allow_invalid=True)
    copy = pickle.loads(pickle.dumps(env))
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (15, 7)).astype(np.float32)
    stories = []
    for each in (env, copy, env):
        start = each.reset(seed=5)[0]
        stories.append(np.array([start, *(each.step(action)[0] for action in actions)]))
    np.testing.assert_array_equal(stories[0], stories[1])
    np.testing.assert_array_equal(stories[0], stories[2])
    env.close()
    copy.close()


def test_a_robot_of_the_users(drawer: Path, tmp_path: Path) -> None:
    shutil.copy(builtin_robot().urdf, tmp_path / "arm.urdf")
    env = DrawerPullEnv(drawer, robot=tmp_path / "arm.urdf", tool="hand", control="joint", allow_invalid=True)
    assert env.action_space.shape == (8,)
    assert run_expert(gymnasium.wrappers.TimeLimit(env, 240), seed=0)["is_success"]
    with pytest.raises(InputError, match="tool="):
        DrawerPullEnv(drawer, robot=tmp_path / "arm.urdf", allow_invalid=True)


def test_what_no_gripper_can_hold_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_plan, "_PLAN_SECONDS", 0.2)
    model = write_slider(tmp_path / "smooth.urdf", thick=0.15)
    with pytest.raises(InputError, match=r"cannot open front_slide.*OpenPart"):
        DrawerPullEnv(model, allow_invalid=True)


def test_demonstrations_are_read_by_minari(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from kinematify.envs.demonstrations import record_demonstrations

    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    with monkeypatch.context() as absent:
        absent.setitem(sys.modules, "minari", None)
        with pytest.raises(EnvironmentFault, match="minari"):
            record_demonstrations("kinematify.envs:kinematify/OpenPart-v0", "kinematify/box/expert-v0")
    record_demonstrations(
        "kinematify.envs:kinematify/OpenPart-v0", "kinematify/box/expert-v0", seeds=range(2), model="bundled:box"
    )
    import minari

    dataset = minari.load_dataset("kinematify/box/expert-v0")
    episodes = list(dataset.iterate_episodes())
    assert [len(episode.rewards) for episode in episodes] == [100, 100]
    assert episodes[0].observations.shape == (101, 57)
    env = dataset.recover_environment()
    np.testing.assert_array_equal(env.reset(seed=0)[0], episodes[0].observations[0])
    env.close()
