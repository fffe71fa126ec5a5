"""OpenPart: spaces as documented, engines that agree, success that cannot be cheated, clean bookkeeping."""

from __future__ import annotations

import pickle
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from kinematify.envs import joint_dynamics as dynamics
from kinematify.envs.base import OPEN_REWARD, START_DEPTH, START_OPEN, SUCCESS_REWARD
from kinematify.envs.bundled import BUNDLED
from kinematify.envs.goal import CALM, CONTROL_STEP, FAST, FORGET
from kinematify.envs.open_part import OpenPartEnv
from kinematify.envs.tasks import EPISODE_STEPS
from kinematify.envs.worlds import HAND_SPEED, LAG
from kinematify.errors import EnvironmentFault, InputError
from tests.envs.hands import OPEN_PART, documented_rows, run, steady, write_slider


def test_the_documented_spaces_are_the_spaces() -> None:
    env = OpenPartEnv()
    rows = documented_rows(OpenPartEnv)
    covered = [index for first, last, _, _ in rows for index in range(first, last + 1)]
    assert covered == list(range(env.observation_space.shape[0]))
    for first, last, low, high in rows:
        assert set(env.observation_space.low[first : last + 1].tolist()) == {low}
        assert set(env.observation_space.high[first : last + 1].tolist()) == {high}
    doc = OpenPartEnv.__doc__ or ""
    assert f"`Box((57,), {env.observation_space.dtype})`" in doc
    assert f"`Box(-1, 1, {env.action_space.shape}, {env.action_space.dtype})`" in doc
    steps = EPISODE_STEPS["open_part"]
    assert gymnasium.spec(OPEN_PART.split(":")[1]).max_episode_steps == steps
    numbers = (
        f"after {EPISODE_STEPS['open_part']} steps",
        f"of {CONTROL_STEP:g} s",
        f"shares of {HAND_SPEED:g} ways",
        f"{LAG:.0%}".replace("%", " %"),
        f"rest in {dynamics.SECONDS:g} s",
        f"{OPEN_REWARD:g} times the share",
        f"plus {SUCCESS_REWARD:g} for success",
        f"up to {FAST:g} ways per second",
        f"nothing at {2 * FAST:g}",
        f"faster than {CALM:g} ways",
        f"by {FORGET:.0%}".replace("%", " %"),
        f"open by 0 to {START_OPEN[1]:.0%}".replace("%", " %"),
        f"than {START_DEPTH:.1%}".replace("%", " %"),
        f"factors {dynamics.FACTORS[0]:g} to {dynamics.FACTORS[1]:g}",
        f"factor {dynamics.MASSES[0]:g} to {dynamics.MASSES[1]:g}",
        f"{dynamics.PLACE[0]:g} m along",
        f"{dynamics.PLACE[1]:g} rad about",
        f"{dynamics.DAMPING_RATE:g} 1/s",
        f"{dynamics.FRICTION_ACCELERATION:g} m/s^2",
        f"{dynamics.HOLD:g} times what",
    )
    flat = " ".join(doc.split())
    assert [words for words in numbers if words not in flat] == []
    _, info = env.reset(seed=0)
    assert all(f"``{key}``" in doc for key in info)


@pytest.mark.parametrize(
    ("env_id", "engine", "control"),
    [(OPEN_PART, "mujoco", "force"), ("kinematify.envs:kinematify/OpenPart-Sparse-v0", "pybullet", "position")],
)
def test_check_env_has_nothing_to_say(env_id: str, engine: str, control: str) -> None:
    env = gymnasium.make(env_id, engine=engine, control=control, randomize=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped, skip_render_check=True)  # pictures: test_picture.py
    env.close()


@pytest.mark.parametrize(("engine", "model"), [("mujoco", "bundled:door"), ("pybullet", "bundled:drawers")])
def test_a_steady_hand_opens_it_and_a_throw_is_not_paid(engine: str, model: str) -> None:
    env = gymnasium.make(OPEN_PART, model=model, engine=engine)
    total, info = run(env, steady, seed=1)
    assert info["is_success"], info
    assert not info["thrown"]
    assert 50.0 < total < 100.0
    assert info["max_penetration"] < 1e-3
    thrown, info = run(env, lambda seen: (seen[0] < 0.6) * seen[54:57], seed=1)
    assert info["thrown"], info
    assert info["open_fraction"] > 0.85
    assert not info["is_success"]
    assert thrown < 5.0
    env.close()


def test_both_engines_tell_the_same_story() -> None:
    """One file, one law of motion: after two seconds of the same forces the drawer stands in the same place."""
    stories = []
    for engine in ("mujoco", "pybullet"):
        env = gymnasium.make(OPEN_PART, model="bundled:nightstand", engine=engine)
        env.reset(seed=4)
        rng = np.random.default_rng(0)
        story = [env.step((rng.uniform(-0.4, 0.8) * np.array([0.0, -1.0, 0.0])).astype(np.float32)) for _ in range(40)]
        stories.append(np.array([step[0][0] for step in story]))
        env.close()
    assert stories[0].max() > 0.3
    assert np.abs(stories[0] - stories[1]).max() < 0.02


def test_a_pickled_environment_is_the_same_environment() -> None:
    env = OpenPartEnv("bundled:box", control="position", randomize=["mass"])
    copy = pickle.loads(pickle.dumps(env))
    action = np.array([0.1, -0.5, 0.3], dtype=np.float32)
    for each in (env, copy):
        each.reset(seed=2)
    np.testing.assert_array_equal(env.step(action)[0], copy.step(action)[0])


def test_reset_options() -> None:
    env = OpenPartEnv("bundled:nightstand")
    observation, info = env.reset(seed=0, options={"open_fraction": 0.5})
    assert info["open_fraction"] == pytest.approx(0.5)
    assert observation[0] == pytest.approx(0.5)
    observation, info = env.reset(seed=0, options={"joint": "door_1_joint", "qpos": {"drawer_1_joint": 0.1}})
    assert info["joint"] == "door_1_joint"
    assert info["open_fraction"] == pytest.approx(0.0)
    assert observation[1] == pytest.approx(0.1 / env.articulated_object.travels[1].upper)
    _, info = env.reset(seed=0)
    assert info["joint"] == "drawer_1_joint"
    for options, words in (
        ({"qpos": {"drawer_1_joint": 3.0}}, "range"),
        ({"open_fraction": 1.5}, "from 0 to 1"),
        ({"speed": 1}, "do not exist"),
        ({"joint": "drawer_9_joint"}, "Did you mean drawer_1_joint"),
    ):
        with pytest.raises(InputError, match=words):
            env.reset(options=options)


def test_what_is_randomised_and_what_is_not() -> None:
    env = OpenPartEnv("bundled:drawers", randomize=["mass", "pose"])
    model = env.world.model
    seen = []
    for seed in (0, 1):
        env.reset(seed=seed)
        seen.append(
            (model.body_mass.copy(), model.body_pos.copy(), model.dof_damping.copy(), model.dof_frictionloss.copy())
        )
    for before, after, differ in zip(*seen, (True, True, False, False), strict=True):
        assert bool((before != after).any()) is differ
    ratio = seen[0][0][1:] / OpenPartEnv("bundled:drawers").world.model.body_mass[1:]
    assert 0.79 < ratio.min() < ratio.max() < 1.26


def test_the_objects_own_damping_and_friction_are_kept(tmp_path: Path) -> None:
    env = OpenPartEnv(write_slider(tmp_path / "slider.urdf"))
    assert env.world.model.dof_damping.tolist() == [4.0]
    assert env.world.model.dof_frictionloss.tolist() == [1.0]
    assert env.validation in {"pass", "warn"}


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"joint": "drawr_1_joint"}, "Did you mean drawer_1_joint.*drawer_2_joint, drawer_3_joint"),
        ({"engine": "bullet"}, "'mujoco', 'pybullet'"),
        ({"control": "torque"}, "'force', 'position'"),
        ({"reward": "shaped"}, "'dense', 'sparse'"),
        ({"open_fraction": 0.0}, "above 0"),
        ({"randomize": ["gravity"]}, "damping, friction, mass, pose, color"),
        ({"robot": "arm.urdf"}, "DrawerPull"),
        ({"render_mode": "ansi"}, "rgb_array"),
        ({"model": "nowhere.urdf"}, "There is no model nowhere.urdf"),
        ({"model": "bundled:drawer"}, "Did you mean bundled:drawers"),
        ({"model": "procedural:ovn"}, "Did you mean procedural:oven"),
    ],
)
def test_impossible_keywords_are_refused(keywords: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        gymnasium.make(OPEN_PART, **keywords)


def test_a_model_without_movable_joints_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="nothing to open"):
        OpenPartEnv(write_slider(tmp_path / "stiff.urdf", kind="fixed"))


def test_a_model_that_fails_validation_is_refused_unless_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wall = """<link name="wall"><visual><geometry><box size="0.4 0.2 0.2"/></geometry></visual>
    <collision><geometry><box size="0.4 0.2 0.2"/></geometry></collision></link>
  <joint name="wall_joint" type="fixed"><parent link="body"/><child link="wall"/><origin xyz="0 -0.45 0"/></joint>"""
    model = write_slider(tmp_path / "walled.urdf", thick=0.1, extra=wall)
    with pytest.raises(InputError, match=r"does not pass kinematify validate: KV\d+.*allow_invalid=True"):
        OpenPartEnv(model)
    assert capsys.readouterr().err.count("validating") == 1, "seconds of silence look like a hang"
    env = OpenPartEnv(model, allow_invalid=True)
    assert capsys.readouterr().err == "", "the verdict is kept"
    assert env.reset(seed=0)[1]["validation"] == "fail"
    _, info = run(gymnasium.make(OPEN_PART, model=model, allow_invalid=True), steady, seed=0)
    assert info["open_fraction"] < 0.6  # real contacts: the wall is in the way


def test_a_window_without_a_screen_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(EnvironmentFault, match="rgb_array"):
        gymnasium.make(OPEN_PART, render_mode="human")


@pytest.mark.parametrize("model", sorted(BUNDLED)[::3])
def test_bundled_objects_stand_still_until_they_are_pushed(model: str) -> None:
    env = OpenPartEnv(f"bundled:{model}")
    env.reset(seed=0, options={"open_fraction": 0.0})
    for _ in range(20):
        observation, _, _, _, info = env.step(np.zeros(3, dtype=np.float32))
    assert abs(info["open_fraction"]) < 0.01
    assert np.abs(observation[16:32]).max() < 0.02
    assert info["warnings"] == {}
    assert info["max_penetration"] < 1e-3


@pytest.mark.parametrize(("engine", "model"), [("mujoco", "bundled:box"), ("pybullet", "bundled:door")])
def test_full_force_against_the_ends_of_the_range_does_not_push_through(model: str, engine: str) -> None:
    env = OpenPartEnv(model, engine=engine)
    observation, _ = env.reset(seed=0)
    for sign in (-1.0, 1.0):
        shares = []
        for _ in range(60):
            observation, *_ = env.step((sign * observation[54:57]).astype(np.float32))
            shares.append(float(observation[0]))
        assert min(shares) > -0.02, sign
        assert max(shares) < 1.02, sign
    env.close()
