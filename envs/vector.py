"""Many OpenPart environments at once, stepped by MuJoCo's own threads: no Python between the steps of one action."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, cast

import mujoco
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from mujoco.rollout import Rollout

from kinematify.envs.base import STATE
from kinematify.envs.goal import SUBSTEPS
from kinematify.envs.open_part import POSITION, OpenPartEnv, hand_space, observe_hand
from kinematify.envs.tasks import EPISODE_STEPS
from kinematify.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.mujoco_engine import MujocoEngine
    from kinematify.simulation.world import ObjectState

    BoolArray = NDArray[np.bool_]

_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS.value


class OpenPartVectorEnv(VectorEnv["NDArray[np.float32]", "NDArray[np.float32]", "NDArray[Any]"]):
    """`num_envs` copies of `OpenPartEnv` in MuJoCo; spaces, rewards and success are those of that class.

    ``gymnasium.make_vec(id, num_envs, vectorization_mode="vector_entry_point")`` makes it. Every copy has its own
    random object with `randomize`. An environment that ended begins again with the next step, whose action, reward and
    end are then without meaning (gymnasium's ``NEXT_STEP``). Infos hold arrays of length `num_envs`: ``is_success``,
    ``open_fraction``, ``thrown``, ``escaped``, ``unstable``. Only `OpenPartEnv` tells ``max_penetration`` and
    ``warnings``.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - gymnasium's own declaration
        "autoreset_mode": AutoresetMode.NEXT_STEP,
        "render_modes": ["rgb_array"],
    }

    def __init__(
        self,
        num_envs: int = 1,
        *,
        max_episode_steps: int = EPISODE_STEPS["open_part"],
        threads: int | None = None,
        env_type: type[OpenPartEnv] = OpenPartEnv,
        **keywords: Any,
    ) -> None:
        """Make the environments.

        Args:
            num_envs: How many.
            max_episode_steps: Actions after which episodes are truncated.
            threads: Of MuJoCo; as many as there are cores if None.
            env_type: Class of each copy.
            keywords: Of `OpenPartEnv`; `engine` can only be ``mujoco``.

        Raises:
            InputError: A keyword is impossible.
            EnvironmentFault: As for `OpenPartEnv`.
        """
        if num_envs < 1 or max_episode_steps < 1:
            raise InputError(
                f"num_envs is {num_envs} and max_episode_steps {max_episode_steps}; both must be at least 1."
            )
        if keywords.get("engine", "mujoco") != "mujoco":
            raise InputError(
                f"Only MuJoCo steps many environments at once, but engine={keywords['engine']!r} was given. Use "
                'vectorization_mode="sync" or "async" for PyBullet.'
            )
        if keywords.pop("observation", STATE) != STATE:
            raise InputError(
                "Many environments at once are observed by their state, but pixels were asked for. Use "
                'vectorization_mode="sync" or "async" for pixels.'
            )
        self.num_envs, self._longest = num_envs, max_episode_steps
        self._envs = [env_type(**keywords) for _ in range(num_envs)]
        first = self._envs[0]
        self.goal, self.render_mode = first.goal, first.render_mode
        self.single_action_space, self.single_observation_space = first.action_space, hand_space(first.goal)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._threads = min(threads or len(os.sched_getaffinity(0)), num_envs)
        self._allocate()

    def _allocate(self) -> None:
        self._worlds = [cast("MujocoEngine", env.world) for env in self._envs]
        self._models, model = [world.model for world in self._worlds], self._worlds[0].model
        self._workers = [mujoco.MjData(model) for _ in range(self._threads)]
        self._rollout = Rollout(nthread=self._threads if self._threads > 1 else 0)
        size = mujoco.mj_stateSize(model, _STATE)
        self._state, self._sensors = np.zeros((self.num_envs, size)), np.zeros((self.num_envs, model.nsensordata))
        self._control = np.zeros((self.num_envs, SUBSTEPS, model.nu))
        self._states = np.zeros((self.num_envs, SUBSTEPS, size))
        self._outputs = np.zeros((self.num_envs, SUBSTEPS, model.nsensordata))
        self._warmstart = np.zeros((self.num_envs, model.nv))
        self._nq, self._nv = model.nq, model.nv
        self._elapsed = np.zeros(self.num_envs, dtype=np.int64)
        self._over = np.zeros(self.num_envs, dtype=bool)
        self._middle = self._envs[0].middle

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode in every environment; environment k gets `seed` + k."""
        given = [seed + k for k in range(self.num_envs)] if isinstance(seed, int) else seed or [None] * self.num_envs
        for k, value in enumerate(given):
            self._begin(k, value, options)
        reading = self._reading()
        self._progress = self.goal.begin(reading)
        self._over[:] = False
        return self._observe(reading), self._info(self._over.copy(), self._over.copy(), self._over.copy())

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], FloatArray, NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Push in every environment for 0.05 s."""
        over = np.flatnonzero(self._over)
        self._advance(np.clip(np.asarray(actions, dtype=np.float64), -1.0, 1.0))
        stable = np.isfinite(self._state).all(axis=1)
        self._state[~stable] = 0.0
        for k in over:
            self._begin(int(k), None, None)
        reading = self._reading()
        success, opened = self.goal.judge(reading, self._progress)
        for name, fresh in self.goal.begin(reading).items():  # episodes that began have no past
            self._progress[name][over] = fresh[over]
        escaped = np.abs(reading.hold - self._middle).max(axis=-1) > self._envs[0].escape_distance
        kept = np.ones(self.num_envs, dtype=bool)
        kept[over] = False
        success, escaped, unstable = success & stable & kept, escaped & stable & kept, ~stable & kept
        reward = np.asarray(self._envs[0].rewarded(success, opened) * (stable & kept), dtype=np.float64)
        self._elapsed[kept] += 1
        terminated = escaped | unstable | (success & self._envs[0].terminates)
        truncated = (self._elapsed >= self._longest) & ~terminated
        self._over = terminated | truncated
        return self._observe(reading), reward, terminated, truncated, self._info(success, escaped, unstable)

    def _begin(self, k: int, seed: int | None, options: dict[str, Any] | None) -> None:
        """Begin an episode in one environment and take its state."""
        env = self._envs[k]
        env.begin_episode(seed, options)
        if env.target is not self.goal.target:
            raise InputError("All environments of OpenPartVectorEnv open one joint; give it as the keyword joint.")
        world = self._worlds[k]
        mujoco.mj_getState(world.model, world.data, self._state[k], _STATE)
        self._sensors[k], self._control[k], self._warmstart[k] = world.data.sensordata, world.data.ctrl, 0.0
        self._elapsed[k] = 0

    def _advance(self, actions: FloatArray) -> None:
        """Simulate one action in all environments."""
        self._control[:] = self._envs[0].commanded(self._control[:, 0], self._sensors[:, :3], actions)[:, None]
        self._rollout.rollout(
            self._models, self._workers, self._state, self._control, skip_checks=True,
            nstep=self._control.shape[1], initial_warmstart=self._warmstart, state=self._states,
            sensordata=self._outputs,
        )  # fmt: skip
        self._state[:], self._sensors[:] = self._states[:, -1], self._outputs[:, -1]

    def _reading(self) -> ObjectState:
        start = 1  # time
        qpos = self._state[:, start : start + self._nq]
        qvel = self._state[:, start + self._nq : start + self._nq + self._nv]
        return self._worlds[0].observe((qpos, qvel, self._sensors))

    def _observe(self, reading: ObjectState) -> NDArray[np.float32]:
        command = self._control[:, 0] - self._sensors[:, :3] if self._envs[0].control == POSITION else 0.0
        return observe_hand(self.goal, reading, self._middle, np.asarray(command), self._envs[0].bounds)

    def _info(self, success: BoolArray, escaped: BoolArray, unstable: BoolArray) -> dict[str, Any]:
        return {
            "is_success": success,
            "open_fraction": self._progress["fraction"].copy(),
            "thrown": self._progress["thrown"].copy(),
            "escaped": escaped,
            "unstable": unstable,
        }

    def render(self) -> tuple[Any, ...]:
        """Return a picture of every environment."""
        for k, world in enumerate(self._worlds):
            mujoco.mj_setState(world.model, world.data, self._state[k], _STATE)
            mujoco.mj_kinematics(world.model, world.data)
        return tuple(env.render() for env in self._envs)

    def close_extras(self, **keywords: Any) -> None:
        """Free threads and pictures."""
        del keywords
        self._rollout.close()
        for env in self._envs:
            env.close()
