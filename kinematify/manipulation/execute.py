"""A planned motion with its timing, tracked by joint servos in an engine, and what became of the object's joint.

Two ways of holding: with a *weld*, the hand is fixed to the part when the fingers have arrived, so that only the plan
is judged; with *contact*, the fingers close and friction alone holds. In both, the hand does not collide with the held
part but, with contact, for the piece between the pads (`grip_piece`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.manipulation.grip import grip_piece
from kinematify.manipulation.manipulator import effort_limits, hand_links
from kinematify.manipulation.plan_request import Hold
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.read import read_robot
from kinematify.robot.robot import fixed_together, rest_configuration
from kinematify.simulation.engine_runs import NOT_NUMBERS
from kinematify.simulation.engines import open_engine
from kinematify.simulation.prepared import prepare
from kinematify.simulation.world import ROBOT, Grip, PlacedModel, PlacedRobot, WorldSpec

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kinematify.config.task_settings import ExecutionSettings
    from kinematify.config.validation import PrepareSettings
    from kinematify.manipulation.grasp import Grasp
    from kinematify.manipulation.manipulator import TaskRobot
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot
    from kinematify.simulation.engine import Engine


_FRAME_RATE = 25.0  # states that are kept for the film [Hz]


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """Reach, grasp and pull, as planned; world z is up and the floor is at z = 0."""

    robot: TaskRobot
    object_urdf: Path
    """At its real size."""
    T_world_base: FloatArray
    """Root link of the robot, shape (4, 4)."""
    T_world_object: FloatArray
    """Root link of the object, shape (4, 4)."""
    joint: str
    """Joint of the object that is opened."""
    start: Mapping[str, float]
    """Values of the object's leading joints before the pull [rad or m]."""
    grasp: Grasp
    reach: FloatArray
    """Arm joints on the way to the grasp [rad or m], shape (n, dof), n >= 1."""
    pull: FloatArray
    """Arm joints during the pull, the first row is the last of `reach`, shape (m, dof), m >= 2. All other joints of the
    object stay where they are."""
    opened: FloatArray
    """Value of the object's joint in each row of `pull` [rad or m], shape (m,)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Reference:
    """Commands of the arm per time step, in three phases: reach, close the fingers, pull; the end is held."""

    arm: FloatArray
    """[rad or m], shape (steps, dof)."""
    speed: FloatArray
    """Its derivative, shape (steps, dof)."""
    grasped: int
    """Step at which the arm has arrived at the grasp and the fingers close."""
    pulls: int
    """Step at which the pull begins."""


def timed(motion: Motion, fastest: FloatArray, settings: ExecutionSettings, step: float) -> Reference:
    """Give a motion its timing: no joint exceeds its share of the speed limit, and both ends are smooth.

    Args:
        motion: The paths.
        fastest: Speed limits of the arm joints [rad/s or m/s], shape (dof,).
        settings: Shares and pauses.
        step: Time step [s].
    """
    allowed = settings.speed_share * fastest
    reach = _along(motion.reach, allowed, 0.0, step)
    pull = _along(motion.pull, allowed, settings.pull_seconds, step)
    closing = round(settings.grip_seconds / step)
    settling = round(settings.settle_seconds / step)
    arm = np.concatenate([reach, np.tile(reach[-1], (closing, 1)), pull, np.tile(pull[-1], (settling, 1))])
    speed = np.gradient(arm, step, axis=0) if len(arm) > 1 else np.zeros_like(arm)
    return Reference(arm=arm, speed=speed, grasped=len(reach), pulls=len(reach) + closing)


def _along(path: FloatArray, allowed: FloatArray, least: float, step: float) -> FloatArray:
    """Move along a path with a smooth start and end in at least `least` seconds, shape (steps, dof)."""
    if len(path) < 2:
        return path
    times = np.concatenate([[0.0], np.cumsum(np.max(np.abs(np.diff(path, axis=0)) / allowed, axis=1))])
    times += 1e-9 * np.arange(len(times))  # rows that are the same still follow one another
    # The derivative of the smooth step is at most 1.5 times that of the straight one.
    seconds = max(1.5 * float(times[-1]), least, step)
    return eased(path, times, max(2, round(seconds / step) + 1))


def eased(path: FloatArray, times: FloatArray, count: int) -> FloatArray:
    """Rows on a path with a smooth start and end, `times` those of its own rows, shape (count, dof)."""
    phase = np.linspace(0.0, 1.0, count)
    at = times[-1] * phase**2 * (3.0 - 2.0 * phase)
    return np.stack([np.interp(at, times, column) for column in path.T], axis=1)


@dataclass(frozen=True, kw_only=True, eq=False)
class Frame:
    """A state of both, for the film."""

    time: float
    """[s]."""
    robot: dict[str, float]
    """Values of all joints of the robot [rad or m]."""
    object: dict[str, float]
    """Values of all joints of the object [rad or m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Execution:
    """Result of a plan in an engine."""

    engine: str
    hold: Hold
    share: float
    """How far the joint opened, fraction of the planned way."""
    depth: float
    """Deepest that the robot got into the object, the hand in the held part omitted [m]."""
    deepest: tuple[str, str] | None
    """Link of the robot and link of the object."""
    success: bool
    """Opened far enough, at rest, and no deeper than the tolerance."""
    reason: str | None
    """What kept it from success."""
    grasped: float
    """Time at which the fingers have closed and the pull begins [s]."""
    frames: tuple[Frame, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Loaded:
    """Both models as the engines load them, and who is who."""

    motion: Motion
    robot: Robot
    object: Robot
    robot_file: Path
    object_file: Path

    @property
    def held(self) -> str:
        """Child link of the joint that is opened."""
        return self.object.joint_by_name[self.motion.joint].child

    @property
    def held_links(self) -> frozenset[str]:
        """Links of the body that the hand holds."""
        ends = self.motion.grasp.held, self.held
        return frozenset(link for end in ends for link in fixed_together(self.object, end))

    @property
    def hand_links(self) -> frozenset[str]:
        """Links of the hand (`kinematify.manipulation.manipulator.hand_links`)."""
        return hand_links(self.robot, self.motion.robot)

    def fastest(self, settings: ExecutionSettings) -> FloatArray:
        """Speed limits of the arm joints [rad/s or m/s], shape (dof,)."""
        joints = [self.robot.joint_by_name[name] for name in self.motion.robot.arm_joints]
        return np.array([j.velocity if j.velocity and j.velocity > 0.0 else settings.velocity for j in joints])


def load(motion: Motion, work: Path, settings: PrepareSettings) -> Loaded:
    """Write what the engines load into an existing folder.

    Raises:
        InputError: A model cannot be read.
        OSError: The folder cannot be written.
    """
    models, files = [], []
    for name, urdf in (("robot", motion.robot.urdf), ("object", motion.object_urdf)):
        folder = work / f"{name}_prepared"
        folder.mkdir(exist_ok=True)
        model = read_robot(urdf)
        models.append(model)
        files.append(prepare(model, folder, settings))
    return Loaded(motion=motion, robot=models[0], object=models[1], robot_file=files[0], object_file=files[1])


def execute(loaded: Loaded, settings: ExecutionSettings, *, engine: str, hold: Hold) -> Execution:
    """Run a planned motion.

    Args:
        loaded: Both models and the motion.
        settings: Servos, forces and tolerances.
        engine: One with `hold` among `EngineEntry.holds`.
        hold: What connects the hand with the part.

    Returns:
        What became of it; a world that blows up is no success.

    Raises:
        Unloadable: The engine cannot load a model.
    """
    run = _Run(loaded, settings, engine, hold)
    reference = timed(loaded.motion, loaded.fastest(settings), settings, settings.time_step)
    try:
        values = run.tracked(reference)
    finally:
        run.world.close()
    return run.judged(values, reference, engine)


class _Run:
    """Robot and object in an engine, at the start of a motion."""

    def __init__(self, loaded: Loaded, settings: ExecutionSettings, engine: str, hold: Hold) -> None:
        self._motion, self._settings, self._hold = loaded.motion, settings, hold
        self._frames: list[Frame] = []
        self._depth = 0.0
        self._deepest: tuple[str, str] | None = None
        self._robot, self._object = (LeaderMechanism(robot=model) for model in (loaded.robot, loaded.object))
        start = {**self._motion.start, self._motion.joint: float(self._motion.opened[0])}
        rest = rest_configuration(loaded.object)
        self._start = {travel.joint: start.get(travel.joint, rest[travel.joint]) for travel in self._object.travels}
        self._opened = self._object.joints.index(self._motion.joint)
        self._fingers = self._motion.robot.fingers_at(self._motion.grasp.spread)
        self._squeezed = self._squeeze()
        self.world: Engine = open_engine(engine, self._spec(loaded))
        gripped = {*(ROBOT + link for link in loaded.hand_links), *loaded.held_links}
        self._gripped = np.array([name in gripped for name in self.world.links])
        leaders = np.array([list(self._start.values())])
        self.world.place(self._object.all_values(leaders)[0], np.concatenate([self._motion.reach[0], self._fingers]))

    def _squeeze(self) -> FloatArray:
        """Fingers a centimetre inside of what they hold, so that they press with their full force."""
        grasp, closed = self._motion.grasp, self._motion.robot.fingers_at(0.0)
        gap = max(grasp.spread, 1e-6)
        return np.asarray(self._fingers + (closed - self._fingers) * (gap - grasp.width + 0.02) / gap)

    def _spec(self, loaded: Loaded) -> WorldSpec:
        motion, settings, friction = self._motion, self._settings, self._hold is Hold.CONTACT
        driven = {*motion.robot.arm_joints, *motion.robot.finger_joints}
        held, leaders = loaded.held, self._start
        return WorldSpec(
            step=settings.time_step,
            object=PlacedModel(
                urdf=loaded.object_file,
                mechanism=self._object,
                T_world_root=motion.T_world_object,
                locked=leaders,
                damping={motion.joint: settings.joint_damping},
            ),
            robot=PlacedRobot(
                urdf=loaded.robot_file,
                mechanism=self._robot,
                T_world_root=motion.T_world_base,
                locked={travel.joint: travel.rest for travel in self._robot.travels if travel.joint not in driven},
                arm=motion.robot.arm_joints,
                fingers=motion.robot.finger_joints,
                strongest=effort_limits(loaded.robot, motion.robot, settings.effort),
                postures=(motion.reach[0], motion.pull[0], motion.pull[-1]),
                tool=motion.robot.tool,
                settings=settings,
            ),
            grip=Grip(
                hand=loaded.hand_links,
                part=loaded.held_links,
                link=held,
                piece=grip_piece(loaded.object, held, leaders, motion.grasp) if friction else None,
                weld_force=settings.weld_force,
            ),
        )

    def tracked(self, reference: Reference) -> FloatArray:
        """Track the reference; returns the value of the object's joint after every step, shape (steps,)."""
        settings, world = self._settings, self.world
        every = max(1, round(1.0 / (_FRAME_RATE * settings.time_step)))
        steps = len(reference.arm)
        values = np.full(steps, np.nan)
        for step, wanted in enumerate(reference.arm):
            if step == reference.grasped and self._hold is Hold.CONTACT:
                self._fingers = self._squeezed
            if step == reference.pulls:
                world.unlock((self._motion.joint,))
                if self._hold is Hold.WELD:
                    world.weld()
            world.command(np.concatenate([wanted, self._fingers]), reference.speed[step])
            world.step()
            if not world.stable() or world.warnings().keys() & NOT_NUMBERS:
                break
            values[step] = world.state()[0][self._opened]
            self._look_for_deeper()
            if step % every == 0 or step == steps - 1:
                both = (self._robot, world.state(robot=True)[0]), (self._object, world.state()[0])
                robot, articulated = (dict(zip(of.joints, at.tolist(), strict=True)) for of, at in both)
                self._frames.append(Frame(time=step * settings.time_step, robot=robot, object=articulated))
        return values

    def _look_for_deeper(self) -> None:
        """Keep the deepest contact of the robot, that of the hand with what it holds left out."""
        pairs, depths = self.world.contacts()
        depths = np.where(self._gripped[pairs].all(axis=1), 0.0, depths)
        if depths.max(initial=0.0) > self._depth:
            deepest = int(depths.argmax())
            other, link = (self.world.links[number] for number in sorted(pairs[deepest]))  # the robot's come last
            self._depth, self._deepest = float(depths[deepest]), (link.removeprefix(ROBOT), other)

    def judged(self, values: FloatArray, reference: Reference, engine: str) -> Execution:
        """Judge the run by the value of the object's joint after every step [rad or m], shape (steps,)."""
        settings, opened = self._settings, self._motion.opened
        way = float(opened[-1] - opened[0])
        tail = max(2, round(0.2 * settings.settle_seconds / settings.time_step))
        share = float(values[-1] - opened[0]) / way if way else 1.0
        speed = float(np.ptp(values[-tail:])) / (tail * settings.time_step) / max(abs(way), 1e-9)
        reason = None
        if not np.isfinite(values).all():
            share, reason = 0.0, "the simulation blew up"
        elif share < settings.opened:
            reason = f"the joint stops at {max(share, 0.0):.0%} of the planned way"
        elif speed > settings.rest_speed:
            reason = f"the joint still moves at the end, by {speed:.0%} of its way per second"
        elif self._depth > settings.depth:
            reason = f"{' and '.join(self._deepest or ())} get {self._depth * 1e3:.1f} mm into each other"
        return Execution(
            engine=engine,
            hold=self._hold,
            share=share,
            depth=self._depth,
            deepest=self._deepest,
            success=reason is None,
            reason=reason,
            grasped=reference.pulls * settings.time_step,
            frames=tuple(self._frames),
        )
