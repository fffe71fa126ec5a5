"""Pouring: an arm takes a cup, carries it upright over a container, and tilts it there."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.scene import read_scene, relative
from kinematify.manipulation.collision import CollisionWorld
from kinematify.manipulation.grasp import moved_bodies, search_grasps
from kinematify.manipulation.motion import Motion
from kinematify.manipulation.outcome import Failure
from kinematify.manipulation.place import Places, object_box
from kinematify.manipulation.pour_scene import CARRY, LIFT, TILT, pour_motion, write_pour
from kinematify.manipulation.pull import Pull, Puller
from kinematify.manipulation.reach import plan_reach
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from kinematify.config.validation import ValidationSettings
    from kinematify.manipulation.kinematics import Arm
    from kinematify.manipulation.place import Place
    from kinematify.manipulation.pour_scene import Pour, Vessel
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class PourPlan:
    """What became of the plan."""

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
    """Plan how a robot pours from a cup into a container that stands beside it on the floor.

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
    start, best = time.process_time(), None
    turns = settings.task.pour.turns
    for number in range(turns):
        pour = write_pour(cup, into, 2.0 * np.pi * number / turns, folder / f"pour_{number}.urdf", settings.task.pour)
        plan = _Planning(arm, pour, settings, seed, start).run()
        if best is None or plan.fraction > best.fraction:
            best = plan
        if best.failure is None or time.process_time() - start > turns * settings.task.plan.seconds:
            break
    assert best is not None
    return best


class _Planning:
    """One way round of the cup."""

    def __init__(self, arm: Arm, pour: Pour, settings: ValidationSettings, seed: int, started: float) -> None:
        self._arm, self._pour, self._seed, self._started = arm, pour, seed, started
        self._settings, self._plan = settings, settings.task.plan
        self._scene = read_scene(read_robot(pour.urdf), settings.geometry)
        self._motion = pour_motion(self._scene, pour, settings.task.pour)
        self._places = Places(arm, self._motion, object_box(self._scene), self._plan)
        self._begun = time.process_time()

    def run(self) -> PourPlan:
        """Look at grasps, then at places."""
        report = search_grasps(
            self._scene, TILT, self._arm.robot.opening, settings=self._settings.task.grasp, seed=self._seed
        )
        if not report.grasps:
            return self._ended(Failure.NO_GRASP, report.reason or "")
        meeting = self._meeting()
        if meeting is not None:
            return self._ended(Failure.STOPS, meeting)
        world = CollisionWorld(self._arm, self._scene, TILT, self._plan)
        puller = Puller(self._arm, world, self._motion, self._plan)
        best, words = None, "none of the places and grasps"
        for pull in self._pulls(puller, self._places.ranked(report.grasps)):
            if isinstance(pull, str):
                words = pull
                continue
            if best is not None and pull.fraction <= best[0].fraction:
                continue
            way = self._way_to(world, pull)
            if isinstance(way, str):
                words = way
                continue
            best = (pull, way)
            if pull.stop is None:
                break
        if best is None:
            return self._ended(
                Failure.NO_REACH if words.startswith(("none", "its", "the next")) else Failure.NO_PATH, words
            )
        pull, way = best
        return self._ended(
            None if pull.stop is None else Failure.STOPS, pull.stop.words if pull.stop else "", pull=pull, way=way
        )

    def _meeting(self) -> str | None:
        """What the cup itself runs into on its way."""
        overlap = OverlapQueries(self._scene)
        cups = {body for bodies in moved_bodies(self._scene, TILT) for body in bodies}
        for pair in self._scene.pairs:
            if len(cups & set(pair)) == 1 and overlap.collide(pair, relative(self._motion.body_poses, pair)).any():
                first, second = self._scene.name(pair)
                return f"{first} meets {second} on the way"
        return None

    def _pulls(self, puller: Puller, places: list[Place]) -> Iterator[Pull | str]:
        for from_start in (False, True):
            for place in places:
                if time.process_time() - self._begun > self._plan.seconds:
                    return
                found = puller.follow(place, column=self._places.on_column, from_start=from_start)
                yield found if isinstance(found, Pull) else found.words

    def _way_to(self, world: CollisionWorld, pull: Pull) -> FloatArray | str:
        world.place(pull.place.T_world_base, self._motion.T_world_object, column=self._places.on_column)
        world.pose_object(self._motion.body_poses[0], pull.place.grasp.spread)
        reach = plan_reach(self._arm, world, pull.path[0], self._plan, seed=self._seed)
        return reach.path if reach.path is not None else reach.reason or ""

    def _ended(
        self, failure: Failure | None, words: str, *, pull: Pull | None = None, way: FloatArray | None = None
    ) -> PourPlan:
        motion = None
        if pull is not None and way is not None and len(pull.path) > 1:
            column = [travel.joint for travel in self._scene.travels].index(TILT)
            motion = Motion(
                robot=self._arm.robot,
                object_urdf=self._pour.urdf,
                T_world_base=pull.place.T_world_base,
                T_world_object=self._motion.T_world_object,
                joint=TILT,
                start={},
                grasp=pull.place.grasp,
                reach=way,
                pull=pull.path,
                opened=self._motion.rows[: len(pull.path), column],
                freed=(LIFT, CARRY),
            )
        return PourPlan(
            motion=motion,
            fraction=0.0 if pull is None else pull.fraction,
            failure=failure,
            words=words,
            seconds=time.process_time() - self._started,
        )
