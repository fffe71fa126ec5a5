"""Base of the environments: keywords, the object, start of an episode, randomisation, pictures, bookkeeping."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.utils import EzPickle

from kinematify.envs.articulated_object import AUTO, ENGINES, find_target, shared_articulated_object
from kinematify.envs.goal import Goal
from kinematify.envs.joint_dynamics import draw, drawing
from kinematify.envs.model_verdict import require_valid
from kinematify.errors import InputError
from kinematify.render.environment_picture import Piece, Renderer, ViewerWindow, has_screen, require_screen
from kinematify.render.picture import CARCASS, HELD, OTHERS
from kinematify.robot.robot import fixed_together
from kinematify.robot.transforms import transformed
from kinematify.simulation.engine import depth_of
from kinematify.simulation.engines import require_engine
from kinematify.versions import require

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from kinematify.envs.articulated_object import ArticulatedObject, Target
    from kinematify.envs.joint_dynamics import Draw
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.engine import Engine
    from kinematify.simulation.world import ObjectState

_OPTIONS = ("joint", "qpos", "open_fraction")
_HEIGHT, _WIDTH = 360, 480  # of pictures [pixels]
_AZIMUTH = 0.6  # of the camera, to the side of the way out, so that it is not seen end on [rad]
_ESCAPE = 3.0  # sizes of the object: nothing that hangs on joints gets as far from its place at rest

START_OPEN = (0.0, 0.05)  # a drawer is never shut to the millimetre
"""Share of the way that is open at the start, drawn evenly."""
_TRIES = 20  # draws until one has no interpenetration; then the part is shut
START_DEPTH = 0.002  # contacts that are deeper count as interpenetration
"""Deepest contact at the start, share of the object's size."""
OPEN_REWARD, SUCCESS_REWARD = 0.5, 0.5
"""Weights of the share of the way that is open, and of success, in the dense reward."""


class OpeningEnv(gymnasium.Env["NDArray[np.float32]", "NDArray[np.float32]"], EzPickle, ABC):
    """A joint of an object that is to be opened."""

    metadata: dict[str, Any] = {  # noqa: RUF012 - gymnasium's own declaration
        # Listed only where it works, so that check_env tries what it can.
        "render_modes": ["rgb_array", "human"] if has_screen() else ["rgb_array"],
        "render_fps": 20,
    }
    goal_type: ClassVar[type[Goal]] = Goal
    """What is success, and how near the object is to it: what a task of your own replaces."""
    _with_robot: ClassVar[bool] = False
    _helping: ClassVar[float] = 0.0
    """Weight of what a subclass rewards beside opening (`_helped`)."""
    world: Engine
    """What runs."""
    articulated_object: ArticulatedObject
    target: Target

    def __init__(
        self, model: str | Path | None = None, *, joint: str = AUTO, open_fraction: float = 0.9, engine: str = "mujoco",
        reward: str = "dense", randomize: bool | str | Collection[str] = False, terminate_on_success: bool = False,
        allow_invalid: bool = False, render_mode: str | None = None,
    ) -> None:  # fmt: skip
        """Check the keywords and read the object; subclasses then make their world and spaces.

        Args:
            model: URDF, folder with it, ``bundled:NAME``, ``procedural:FAMILY`` or ``procedural:FAMILY:SEED``; a chest
                of drawers if None.
            joint: Joint that is opened; ``auto`` takes the one whose part moves farthest, for a robot the drawer that
                goes farthest if there is one.
            open_fraction: Share of the way that counts as open, above 0 and at most 1.
            engine: ``mujoco`` or ``pybullet``.
            reward: ``dense`` or ``sparse``.
            randomize: What is drawn again in each episode.
            terminate_on_success: End the episode on success.
            allow_invalid: Take a model that fails `kinematify validate`.
            render_mode: None, ``rgb_array`` or ``human``.

        Raises:
            InputError: A keyword is impossible, or the model cannot be used; the message says what to do.
            EnvironmentFault: The engine or the screen is missing, or the validation itself failed.
        """
        one_of("engine", engine, ENGINES)
        one_of("reward", reward, ("dense", "sparse"))
        one_of("render_mode", render_mode, (None, "rgb_array", "human"))
        if render_mode == "human":
            require_screen()
        elif render_mode is not None:
            require('render_mode="rgb_array"', "pybullet")
        require_engine(engine)
        if not 0.0 < open_fraction <= 1.0:
            raise InputError(f"open_fraction is {open_fraction}, but must be above 0 and at most 1, such as 0.9.")
        self.engine, self.render_mode = engine, render_mode
        self._sparse, self.terminates = reward == "sparse", terminate_on_success
        self._drawn_names = drawing(randomize)
        self.open_fraction = open_fraction
        self.articulated_object = shared_articulated_object(model)
        self.validation = require_valid(self.articulated_object, engine, allow_invalid=allow_invalid)
        self.T_world_root = self.articulated_object.T_world_root
        self._asked_joint = joint
        self._draw: Draw | None = None
        self._window: ViewerWindow | None = None
        self._renderer: Renderer | None = None
        self._progress: dict[str, Any] = {}
        self._aim(self._choose(joint))

    def _choose(self, joint: str) -> str:
        """Return the joint that ``auto`` represents."""
        return self.articulated_object.usual if joint == AUTO else joint

    def _aim(self, joint: str) -> None:
        self.target = self._targeted(joint)
        self.goal = self.goal_type(self.articulated_object, self.target, self.open_fraction)
        # The hold at rest, world frame, the object at its usual place [m], shape (3,).
        at_rest = self.T_world_root @ self.articulated_object.link_pose(self.target.joint)
        self.middle: FloatArray = np.asarray(at_rest[:3, :3] @ self.target.point + at_rest[:3, 3])
        self.escape_distance = _ESCAPE * self.articulated_object.scene.size

    def _targeted(self, joint: str) -> Target:
        """Return the joint with the point at which its part is held."""
        return find_target(self.articulated_object, joint)

    # Start of an episode.

    def _start(self, options: Mapping[str, Any] | None) -> None:
        """Draw the object and place it; a start without interpenetration is drawn again until there is one."""
        given = dict(options or {})
        unknown = sorted(set(given) - set(_OPTIONS))
        if unknown:
            raise InputError(f"reset options {', '.join(unknown)} do not exist. There are {', '.join(_OPTIONS)}.")
        joint = self._choose(str(given.get("joint", self._asked_joint)))
        if joint != self.target.joint:
            self._retarget(joint)
        rng, mechanism = self.np_random, self.articulated_object.scene.mechanism
        counts = len(mechanism.joints), len(mechanism.links)
        self._draw = draw(self._drawn_names, *counts, rng, robot=self._with_robot)
        self.world.vary(self._draw)
        if "qpos" in given or "open_fraction" in given:
            self._place(self._asked_start(given))
            return
        for _ in range(_TRIES):
            leaders = mechanism.rest.copy()
            leaders[self.target.leader] = self.target.value(float(rng.uniform(*START_OPEN)))
            if self._place(leaders) <= START_DEPTH * self.articulated_object.scene.size:
                return
        leaders = mechanism.rest.copy()
        leaders[self.target.leader] = self.target.closed
        self._place(leaders)

    @abstractmethod
    def _place(self, leaders: FloatArray) -> float:
        """Set the joints that lead, shape (J,), and stop all; returns the depth of the deepest contact [m]."""

    def _retarget(self, joint: str) -> None:
        """Open another joint from now on."""
        self._aim(joint)
        self.world.close()
        self._make_world()
        self._close_pictures()

    @abstractmethod
    def _make_world(self) -> None:
        """Load the object, and the robot if there is one, into the engine."""

    def _asked_start(self, given: Mapping[str, Any]) -> FloatArray:
        """Values of the leaders that reset options ask for, shape (J,)."""
        leaders = self.articulated_object.scene.mechanism.rest.copy()
        for name, value in dict(given.get("qpos", {})).items():
            leader = self.articulated_object.leader(str(name))
            travel = self.articulated_object.travels[leader]
            if travel.limited and not travel.lower - 1e-9 <= float(value) <= travel.upper + 1e-9:
                raise InputError(
                    f"reset options put {name} at {value}, but its range is {travel.lower:g} to {travel.upper:g} "
                    f"{travel.unit}."
                )
            leaders[leader] = float(value)
        if "open_fraction" in given:
            fraction = float(given["open_fraction"])
            if not 0.0 <= fraction <= 1.0:
                raise InputError(f"reset options ask for open_fraction {fraction}, but it must be from 0 to 1.")
            leaders[self.target.leader] = self.target.value(fraction)
        return leaders

    def reading(self) -> ObjectState:
        """State of the object now."""
        return self.world.observe()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode.

        Raises:
            InputError: An option does not exist or is out of range.
        """
        self.begin_episode(seed, options)
        reading = self.world.observe()
        self._progress = self.goal.begin(reading)
        self._last = self._observe(reading)
        if self.render_mode == "human":
            self.render()
        return self._last, self._info(is_success=False, escaped=False)

    def begin_episode(self, seed: int | None, options: dict[str, Any] | None) -> None:
        """Draw and place the object; what is left of `reset` is to look at it."""
        super().reset(seed=seed)
        self._start(options)

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Act for 0.05 s; actions beyond -1 and 1 are clipped."""
        self._act(action)
        if not self.world.stable():
            return self._failed(self._last)
        reading = self.world.observe()
        self._last = self._observe(reading)
        reward, ended, info = self._outcome(reading, self._helped())
        if self.render_mode == "human":
            self.render()
        return self._last, reward, ended, False, info

    @abstractmethod
    def _act(self, action: NDArray[np.float32]) -> None:
        """Simulate until the next action."""

    @abstractmethod
    def _observe(self, reading: ObjectState) -> NDArray[np.float32]:
        """Observation of one step."""

    def _helped(self) -> float:
        """Reward beside opening, already weighted."""
        return 0.0

    # After a step.

    def _outcome(self, reading: ObjectState, extra: float) -> tuple[float, bool, dict[str, Any]]:
        """Reward, whether the episode ends, and info.

        Args:
            reading: State of the object.
            extra: What a subclass rewards beside opening, already weighted.
        """
        success, opened = self.goal.judge(reading, self._progress)
        done, escaped = bool(success), bool(np.abs(reading.hold - self.middle).max() > self.escape_distance)
        reward = float(self.rewarded(done, opened)) + (0.0 if self._sparse else extra)
        return reward, escaped or (done and self.terminates), self._info(is_success=done, escaped=escaped)

    def rewarded(self, success: Any, opened: Any) -> Any:
        """Reward for opening, of one environment or of many, as a number or an array.

        Args:
            success: Whether it is one.
            opened: How well the part stands open (`Goal.judge`).
        """
        if self._sparse:
            return 1.0 * success
        return (1.0 - self._helping) * (OPEN_REWARD * opened + SUCCESS_REWARD * success)

    def _failed(self, last: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """End an episode in which the engine produced numbers that are none."""
        info = self._info(is_success=False, escaped=False)
        info["unstable"] = True
        return last, 0.0, True, False, info

    def _info(self, *, is_success: bool, escaped: bool) -> dict[str, Any]:
        return {
            "is_success": is_success,
            "open_fraction": float(self._progress["fraction"]),
            "thrown": bool(self._progress["thrown"]),
            "max_penetration": depth_of(self.world),
            "escaped": escaped,
            "unstable": False,
            "warnings": self.world.warnings(),
            "joint": self.target.joint,
            "validation": self.validation,
        }

    # Pictures.

    def render(self) -> Any:
        """Return a picture, shape (height, width, 3), for ``rgb_array``; show it for ``human``.

        Raises:
            EnvironmentFault: There is no screen for ``human``.
        """
        if self.render_mode is None:
            gymnasium.logger.warn(
                'render() was called without render_mode; make the environment with render_mode="rgb_array".'
            )
            return None
        poses, tint = self.world.link_poses(), self._tint
        if self.render_mode == "human":
            self._window = self._window or ViewerWindow(self._pieces(), *self._view())
            self._window.draw(poses, tint)
            return None
        fine = self.camera().draw(poses, tint, (2 * _HEIGHT, 2 * _WIDTH)).reshape(_HEIGHT, 2, _WIDTH, 2, 3)
        return fine.mean(axis=(1, 3)).round().astype(np.uint8)

    def pixels(self, size: tuple[int, int]) -> NDArray[np.uint8]:
        """Return what a camera sees, shape (*size, 3), the same on every machine; `size` is height and width."""
        return self.camera().draw(self.world.link_poses(), self._tint, size)

    def camera(self) -> Renderer:
        """Return what pictures are taken with; it is made when it is first asked for, in some tenths of a second."""
        self._renderer = self._renderer or Renderer(self._pieces(), *self._view())
        return self._renderer

    @property
    def _tint(self) -> dict[str, FloatArray]:
        """Tint added to the colour of each link; none before the first episode."""
        if self._draw is None:
            return {}
        return dict(zip(self.articulated_object.scene.mechanism.links, self._draw.color, strict=True))

    def _pieces(self) -> Sequence[Piece]:
        declared = self.articulated_object.declared
        held = fixed_together(declared, self.target.link)
        colors = {name: HELD if name in held else OTHERS for name in self.articulated_object.scene.mechanism.links}
        colors[declared.root] = CARCASS
        return [
            Piece(
                link=link.name,
                vertices=shape.mesh.vertices,
                faces=shape.mesh.faces,
                color=colors[link.name] if shape.color is None or link.name in held else np.array(shape.color[:3]),
            )
            for link in declared.links
            for shape in link.visuals or link.collisions
            if len(shape.mesh.faces)
        ]

    def _view(self) -> tuple[FloatArray, float, float]:
        """Centre, radius and azimuth of what is seen: all of the object, from the side to which it opens."""
        scene, T = self.articulated_object.scene, self.T_world_root
        rows = np.stack([scene.mechanism.rest] * 2)
        rows[:, self.target.leader] = self.target.closed, self.target.opened
        corners = [
            transformed(shape, T @ pose)
            for row in scene.poses(rows)
            for body, pose in zip(scene.bodies, row, strict=True)
            for shape in body.shapes
        ]
        points = np.concatenate([*corners, *self._beside()])
        low, high = points.min(axis=0), points.max(axis=0)
        # The object stands in the middle of the world: where its part is held is the side to which it opens.
        azimuth = float(np.arctan2(self.middle[1], self.middle[0])) + _AZIMUTH
        return 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low)), azimuth

    def _beside(self) -> Sequence[FloatArray]:
        """Points beside the object that are to be seen [m], shape (n, 3) each."""
        return ()

    def _close_pictures(self) -> None:
        for shown in (self._window, self._renderer):
            if shown is not None:
                shown.close()
        self._window = self._renderer = None

    def close(self) -> None:
        """Free the engine, OpenGL and the window."""
        self._close_pictures()
        self.world.close()


def one_of(name: str, value: object, choices: Sequence[object]) -> None:
    """Refuse a keyword that is none of its choices.

    Raises:
        InputError: It is none.
    """
    if value not in choices:
        raise InputError(f"{name} is {value!r}, but must be one of {', '.join(map(repr, choices))}.")


STATE, PIXELS, BOTH = "state", "pixels", "pixels+state"
PIXEL_SIZE = (84, 84)
"""Height and width where none are asked for."""


class PixelObservation(gymnasium.ObservationWrapper[Any, Any, Any]):
    """Shows a picture of the object in place of its state, or both under the keys ``pixels`` and ``state``.

    Pictures are `Box(0, 255, (height, width, 3), uint8)`, the object at rest and open in sight, from the side to which
    it opens, the part that is opened in green. They are drawn by software, so that a seed gives the same picture on
    every machine and in both engines.
    """

    def __init__(self, env: OpeningEnv, *, with_state: bool, size: tuple[int, int]) -> None:
        """Wrap an environment.

        Args:
            env: What is seen.
            with_state: Return the state too.
            size: Height and width [pixels].
        """
        super().__init__(env)
        env.camera()  # now, so that the first reset is as quick as the others
        self._bare, self._with_state, self._size = env, with_state, size
        picture = spaces.Box(0, 255, (*size, 3), np.uint8)
        self.observation_space = spaces.Dict({PIXELS: picture, STATE: env.observation_space}) if with_state else picture

    def observation(self, observation: Any) -> Any:
        """Add the picture to a state, or put it in its place."""
        picture = self._bare.pixels(self._size)
        return {PIXELS: picture, STATE: observation} if self._with_state else picture


def observed(env: OpeningEnv, observation: str, size: tuple[int, int]) -> gymnasium.Env[Any, Any]:
    """Return an environment with the observations of an `observation` keyword.

    Raises:
        InputError: There is no such keyword, or the size is none.
    """
    one_of("observation", observation, (STATE, PIXELS, BOTH))
    if len(size) != 2 or min(size) < 1:
        raise InputError(f"pixel_size is {size}, but must be a height and a width in pixels, such as (84, 84).")
    return env if observation == STATE else PixelObservation(env, with_state=observation == BOTH, size=size)


def made(
    kind: type[OpeningEnv], *, observation: str = STATE, pixel_size: tuple[int, int] = PIXEL_SIZE, **keywords: Any
) -> gymnasium.Env[Any, Any]:
    """Make an environment; what `gymnasium.make` calls, so that it does not judge `render_mode` itself.

    Args:
        kind: Its class.
        observation: ``state``, ``pixels`` or ``pixels+state``; see `PixelObservation`.
        pixel_size: Height and width of pictures.
        keywords: Of the class.

    Raises:
        InputError: A keyword is impossible.
        EnvironmentFault: As for the class.
    """
    return observed(kind(**keywords), observation, pixel_size)
