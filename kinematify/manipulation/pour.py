"""Pouring: an arm takes a cup, carries it upright over a container, and tilts it there.

Cup and container are one object: the cup hangs on three joints that lift it, carry it over and tilt it. The planner of
pulls then does the rest: what the hand holds moves along these joints, upright until it tilts about its lip, and the
lip stays above the middle of the container.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.scene import read_scene, relative, visible_shapes
from kinematify.manipulation.grasp import moved_bodies
from kinematify.manipulation.plan_request import Failure
from kinematify.manipulation.planning import FreeRange, JointPlanning, OpenedObject, motion_of
from kinematify.manipulation.real_size import sizing, write_scaled
from kinematify.manipulation.robot_place import ObjectMotion, object_box
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Joint, Link, Robot, forward_kinematics, rest_configuration
from kinematify.robot.transforms import rotation_about
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.validation import ValidationSettings
    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.execute import Motion
    from kinematify.manipulation.kinematics import Arm
    from kinematify.robot.arrays import FloatArray

LIFT, CARRY, TILT = "pour_lift", "pour_carry", "pour_tilt"
_ROOT, _LIFTED, _CARRIED, _PIVOT = "pour_table", "pour_lifted", "pour_carried", "pour_pivot"
_CUP, _INTO = "cup_", "into_"
_LIP = 0.1  # of the cup's height: its uppermost part, where it is widest towards the container
_EXTRA = 0.1  # of range beyond what is needed [m or rad]

TURNS = 4  # the handle before, behind or beside the lip
"""Ways round of the cup that are tried, at equal angles."""
APART = 0.12  # room for a hand
"""Gap between cup and container at the start [m]."""
LEAST_LIFT = 0.06
"""The cup is lifted by no less [m]."""
ABOVE = 0.04
"""The lip stands so high above the container when the cup tilts [m]."""
TILT_DEG = 110.0  # empties a cup with upright walls
"""Angle by which the cup is tilted [deg]."""
STEP = 0.02
"""Of the plan, while the cup is lifted and carried [m]."""
STEP_DEG = 5.0
"""Of the plan, while it tilts [deg]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Vessel:
    """A cup or a container at its real size."""

    urdf: Path
    box: FloatArray
    """Lowest and highest corner at rest, frame of the root link [m], shape (2, 3)."""
    points: FloatArray
    """Corners of all shapes at rest, frame of the root link [m], shape (n, 3)."""

    @property
    def middle(self) -> FloatArray:
        """Middle of the underside, frame of the root link [m], shape (3,)."""
        return np.append(self.box.mean(axis=0)[:2], self.box[0, 2])


@dataclass(frozen=True, kw_only=True, eq=False)
class Pour:
    """The object that was made, and how far each joint moves."""

    urdf: Path
    lift: float
    """[m]."""
    carry: float
    """[m]."""
    tilt: float
    """[rad]."""


def read_vessel(urdf: Path, path: Path, settings: ValidationSettings, scale: float | None = None) -> Vessel:
    """Write a cup or container at its real size to `path` and measure it.

    Raises:
        InputError: It cannot be read, has no geometry, or its size makes no sense.
        OSError: The file cannot be written.
    """
    model = read_robot(urdf)
    scene = read_scene(model, settings.geometry, visible_shapes)
    if not scene.bodies:
        raise InputError(f"{urdf} has no geometry, so nothing can be poured from it or into it. Give another model.")
    write_scaled(urdf, sizing(urdf, model.name, object_box(scene), scale=scale).factor, path)
    scene = read_scene(read_robot(path), settings.geometry, visible_shapes)
    points = [corners @ T[:3, :3].T + T[:3, 3] for body, T in zip(scene.bodies, scene.at_rest, strict=True)
              for corners in body.shapes]  # fmt: skip
    return Vessel(urdf=path, box=object_box(scene), points=np.concatenate(points))


def write_pour(cup: Vessel, into: Vessel, yaw: float, path: Path) -> Pour:
    """Write both as one object; the container stands in direction x from the cup.

    Args:
        cup: What is poured from.
        into: What is poured into.
        yaw: Turn of the cup about the upright [rad].
        path: File to write.

    Raises:
        OSError: The file cannot be written.
    """
    turn = rotation_about(np.array([0.0, 0.0, 1.0]), yaw)
    standing = (cup.points - cup.middle) @ turn.T
    height = float(standing[:, 2].max())
    upper = standing[standing[:, 2] > (1.0 - _LIP) * height]
    lip = np.array([float(upper[:, 0].max()), 0.0, height])
    half = 0.5 * float(np.ptp(into.box[:, 0]))
    apart = float(standing[:, 0].max()) + half + APART
    rim = float(into.box[1, 2] - into.box[0, 2])
    pour = Pour(
        urdf=path,
        lift=max(LEAST_LIFT, rim + ABOVE - height),
        carry=apart - float(lip[0]),
        tilt=float(np.radians(TILT_DEG)),
    )
    hung, stood = _at_rest(cup, _CUP), _at_rest(into, _INTO)
    stand = np.eye(4)
    stand[:3, 3] = np.array([apart, 0.0, 0.0]) - into.middle
    at_lip = np.eye(4)
    at_lip[:3, 3] = lip
    hang = np.eye(4)
    hang[:3, :3] = turn
    hang[:3, 3] = -turn @ cup.middle - lip
    joints = (
        *stood.joints,
        _fixed(f"{_INTO}stands", _ROOT, stood.root, stand),
        _moving(LIFT, (_ROOT, _LIFTED), np.eye(4), JointType.PRISMATIC, axis=2, reach=pour.lift),
        _moving(CARRY, (_LIFTED, _CARRIED), np.eye(4), JointType.PRISMATIC, axis=0, reach=pour.carry),
        _moving(TILT, (_CARRIED, _PIVOT), at_lip, JointType.REVOLUTE, axis=1, reach=pour.tilt),
        *hung.joints,
        _fixed(f"{_CUP}hangs", _PIVOT, hung.root, hang),
    )
    frames = tuple(Link(name=name) for name in (_ROOT, _LIFTED, _CARRIED, _PIVOT))
    write_robot(Robot(name="pour", links=(*frames, *hung.links, *stood.links), joints=joints), path)
    return pour


def pour_motion(scene: Scene, pour: Pour) -> ObjectMotion:
    """Lift, carry and tilt one after the other, in equal steps; the shares of the way represent values."""
    counts = [
        max(2, round(pour.lift / STEP)),
        max(2, round(pour.carry / STEP)),
        max(2, round(pour.tilt / np.radians(STEP_DEG))),
    ]
    names = [travel.joint for travel in scene.travels]
    rows = [np.zeros(len(names))]
    for name, end, count in zip((LIFT, CARRY, TILT), (pour.lift, pour.carry, pour.tilt), counts, strict=True):
        for value in np.linspace(0.0, end, count + 1)[1:]:
            row = rows[-1].copy()
            row[names.index(name)] = value
            rows.append(row)
    table = np.array(rows)
    links = [forward_kinematics(scene.model, dict(zip(names, row.tolist(), strict=True))) for row in table]
    return ObjectMotion(
        joint=TILT,
        T_world_object=np.eye(4),
        values=np.linspace(0.0, 1.0, len(table)),
        rows=table,
        link_poses=np.stack([poses[_PIVOT] for poses in links]),
        body_poses=scene.poses(table),
    )


def _at_rest(vessel: Vessel, prefix: str) -> Robot:
    """A vessel with its joints fixed where they rest, and a prefix before all names."""
    robot = read_robot(vessel.urdf)
    values = rest_configuration(robot)
    return Robot(
        name=robot.name,
        links=tuple(replace(link, name=prefix + link.name) for link in robot.links),
        joints=tuple(
            _fixed(
                prefix + joint.name,
                prefix + joint.parent,
                prefix + joint.child,
                joint.T_parent_child @ joint.motion(values[joint.name]),
            )
            for joint in robot.joints
        ),
    )


def _fixed(name: str, parent: str, child: str, T_parent_child: FloatArray) -> Joint:
    return Joint(name=name, kind=JointType.FIXED, parent=parent, child=child, T_parent_child=T_parent_child)


def _moving(
    name: str, links: tuple[str, str], T_parent_child: FloatArray, kind: JointType, *, axis: int, reach: float
) -> Joint:
    return Joint(
        name=name,
        kind=kind,
        parent=links[0],
        child=links[1],
        T_parent_child=T_parent_child,
        axis=np.eye(3)[axis],
        lower=-_EXTRA,
        upper=reach + _EXTRA,
        effort=100.0,
        velocity=10.0,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class PourPlan:
    """Result of the plan."""

    motion: Motion | None
    """To be executed; None if there is no way to a grasp."""
    fraction: float
    """Of lift, carry and tilt together, in [0, 1]."""
    failure: Failure | None
    """`NO_GRASP`, `NO_REACH`, `NO_PATH` or `STOPS`; None if it is complete."""
    words: str
    """Why, a clause."""
    seconds: float


def plan_pour(
    arm: Arm, cup: Vessel, into: Vessel, folder: Path, settings: ValidationSettings, *, seed: int = 0
) -> PourPlan:
    """Plan how a robot pours from a cup into a container that is beside it on the floor.

    Args:
        arm: The robot.
        cup: At its real size.
        into: At its real size.
        folder: For the object that is made of both.
        settings: All thresholds.
        seed: Of all that is random.

    Raises:
        OSError: The folder cannot be written.
    """
    begun, best = time.process_time(), None
    for number in range(TURNS):
        pour = write_pour(cup, into, 2.0 * np.pi * number / TURNS, folder / f"pour_{number}.urdf")
        plan = _planned(arm, pour, settings, seed)
        if best is None or plan.fraction > best.fraction:
            best = plan
        if best.failure is None or time.process_time() - begun > TURNS * settings.task.plan.seconds:
            break
    assert best is not None
    return replace(best, seconds=time.process_time() - begun)


def _planned(arm: Arm, pour: Pour, settings: ValidationSettings, seed: int) -> PourPlan:
    """One way round of the cup; only all of its way is a success."""
    scene, started = read_scene(read_robot(pour.urdf), settings.geometry), time.process_time()
    motion = pour_motion(scene, pour)
    meeting = _meeting(scene, motion)
    if meeting is not None:
        return PourPlan(motion=None, fraction=0.0, failure=Failure.STOPS, words=meeting, seconds=0.0)
    task = settings.task.model_copy(update={"plan": settings.task.plan.model_copy(update={"opened": 1.0})})
    clearing = OpenedObject(scene=scene, freedom=FreeRange())
    plan = JointPlanning(arm, clearing, TILT, task, way=pour.lift, started=started, motion=motion, seed=seed).run()
    executed = motion_of(plan, arm.robot, pour.urdf)
    if executed is not None:
        column = [travel.joint for travel in scene.travels].index(TILT)
        opened = np.interp(executed.opened, motion.values, motion.rows[:, column])
        executed = replace(executed, opened=opened, freed=(LIFT, CARRY))
    return PourPlan(
        motion=executed, fraction=plan.fraction, failure=plan.failure, words=plan.words, seconds=plan.seconds
    )


def _meeting(scene: Scene, motion: ObjectMotion) -> str | None:
    """Return what the cup itself runs into on its way."""
    overlap = OverlapQueries(scene)
    cups = {body for bodies in moved_bodies(scene, TILT) for body in bodies}
    for pair in scene.pairs:
        if len(cups & set(pair)) == 1 and overlap.collide(pair, relative(motion.body_poses, pair)).any():
            first, second = scene.name(pair)
            return f"{first} meets {second} on the way"
    return None
