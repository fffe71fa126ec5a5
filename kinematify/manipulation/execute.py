"""Stage 3: a planned motion tracked by joint servos in an engine, and what became of the object's joint.

Two ways of holding: with a *weld*, the hand is fixed to the part when the fingers have arrived, so that only the plan
is judged; with *contact*, the fingers close and friction alone holds. In both, the hand does not collide with the held
part but, with contact, for the piece between the pads (`grip_piece`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.read import read_robot
from kinematify.robot.robot import rigid_groups
from kinematify.simulation.prepare import prepare

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.task import ExecutionSettings
    from kinematify.config.validation import PrepareSettings
    from kinematify.manipulation.motion import Motion, Reference
    from kinematify.manipulation.outcome import Hold
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot
    from kinematify.simulation.prepared import Prepared


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
    """What an engine made of a plan."""

    engine: str
    hold: Hold
    share: float
    """How far the joint opened, fraction of the planned way."""
    rest_speed: float
    """Speed of the joint at the end, fraction of the planned way [1/s]."""
    depth: float
    """Deepest that the robot got into the object, the hand in the held part left out [m]."""
    deepest: tuple[str, str] | None
    """Link of the robot and link of the object."""
    tracking: float
    """Largest lag of an arm joint behind its command [rad or m]."""
    success: bool
    """Opened far enough, at rest, and no deeper than the tolerance."""
    reason: str | None
    """What kept it from success."""
    simulated: float
    """[s]."""
    grasped: float
    """Time at which the fingers have closed and the pull begins [s]."""
    frames: tuple[Frame, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Loaded:
    """Both models as the engines load them, and who is who."""

    motion: Motion
    robot: Robot
    object: Robot
    robot_prepared: Prepared
    object_prepared: Prepared

    @property
    def held(self) -> str:
        """Child link of the joint that is opened."""
        return self.object.joint_by_name[self.motion.joint].child

    @property
    def held_links(self) -> frozenset[str]:
        """Links of the body that the hand holds."""
        return _body(self.object, self.motion.grasp.held) | _body(self.object, self.held)

    @property
    def hand_links(self) -> frozenset[str]:
        """Links of the hand: what the tool is fixed to, and the fingers."""
        robot = self.robot
        fingers = [robot.joint_by_name[name].child for name in self.motion.robot.finger_joints]
        links = set(_body(robot, self.motion.robot.tool))
        for link in fingers:
            links |= _below(robot, link)
        return frozenset(links)

    def fastest(self, settings: ExecutionSettings) -> FloatArray:
        """Speed limits of the arm joints [rad/s or m/s], shape (dof,)."""
        joints = [self.robot.joint_by_name[name] for name in self.motion.robot.arm_joints]
        return np.array([j.velocity if j.velocity and j.velocity > 0.0 else settings.velocity for j in joints])

    def strongest(self, settings: ExecutionSettings) -> FloatArray:
        """Effort limits of the arm joints [N m or N], shape (dof,)."""
        joints = [self.robot.joint_by_name[name] for name in self.motion.robot.arm_joints]
        return np.array([j.effort if j.effort and j.effort > 0.0 else settings.effort for j in joints])

    def fingers(self, gap: float) -> FloatArray:
        """Values of the finger joints with the pads at a distance [m], shape (fingers,)."""
        robot = self.motion.robot
        share = min(max(gap / robot.opening, 0.0), 1.0)
        closed, opened = np.array(robot.fingers_closed), np.array(robot.fingers_open)
        return np.asarray(closed + share * (opened - closed))


def load(motion: Motion, work: Path, settings: PrepareSettings) -> Loaded:
    """Write what the engines load into an existing folder.

    Raises:
        InputError: A model cannot be read.
        OSError: The folder cannot be written.
    """
    models, records = [], []
    for name, urdf in (("robot", motion.robot.urdf), ("object", motion.object_urdf)):
        folder = work / f"{name}_prepared"
        folder.mkdir(exist_ok=True)
        model = read_robot(urdf)
        models.append(model)
        records.append(prepare(model, folder, settings))
    return Loaded(
        motion=motion, robot=models[0], object=models[1], robot_prepared=records[0], object_prepared=records[1]
    )


@dataclass(kw_only=True)
class Log:
    """What an engine notes down on the way."""

    frames: list[Frame]
    depth: float = 0.0
    deepest: tuple[str, str] | None = None
    tracking: float = 0.0

    def touch(self, link: str, other: str, depth: float) -> None:
        """Note how deep a link of the robot is in a link of the object [m]."""
        if depth > self.depth:
            self.depth, self.deepest = depth, (link, other)


def judged(
    loaded: Loaded, log: Log, values: FloatArray, reference: Reference, settings: ExecutionSettings, *, engine: str,
    hold: Hold,
) -> Execution:  # fmt: skip
    """Judge a run.

    Args:
        loaded: What was run.
        log: What was noted down.
        values: Value of the object's joint after every step [rad or m], shape (steps,).
        reference: What was commanded.
        settings: Step and tolerances.
        engine: Its name.
        hold: How the part was held.
    """
    opened = loaded.motion.opened
    way = float(opened[-1] - opened[0])
    tail = max(2, round(0.2 * settings.settle_seconds / settings.time_step))
    share = float(values[-1] - opened[0]) / way if way else 1.0
    speed = float(np.ptp(values[-tail:])) / (tail * settings.time_step) / max(abs(way), 1e-9)
    reason = None
    if not np.isfinite(values).all():
        share, speed, reason = 0.0, float("inf"), "the simulation blew up"
    elif share < settings.opened:
        reason = f"the joint stops at {max(share, 0.0):.0%} of the planned way"
    elif speed > settings.rest_speed:
        reason = f"the joint still moves at the end, by {speed:.0%} of its way per second"
    elif log.depth > settings.depth:
        reason = f"{' and '.join(log.deepest or ())} get {log.depth * 1e3:.1f} mm into each other"
    return Execution(
        engine=engine,
        hold=hold,
        share=share,
        rest_speed=speed,
        depth=log.depth,
        deepest=log.deepest,
        tracking=log.tracking,
        success=reason is None,
        reason=reason,
        simulated=reference.steps * settings.time_step,
        grasped=reference.pulls * settings.time_step,
        frames=tuple(log.frames),
    )


def _body(robot: Robot, link: str) -> frozenset[str]:
    """Links that are fixed to a link, itself included."""
    return frozenset(next(group.links for group in rigid_groups(robot) if link in group.links))


def _below(robot: Robot, link: str) -> frozenset[str]:
    links = [link]
    for name in links:
        links += [joint.child for joint in robot.joints_below[name]]
    return frozenset(links)
