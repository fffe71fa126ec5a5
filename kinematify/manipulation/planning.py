"""One joint of an object opened by a robot, as a plan: grasp, place, way to the grasp, pull, and what stops it.

A part that runs into another one is not lost where a further joint moves that one away: a robot opens the other joint
first, as a person would, and finds the object standing like that.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.rest_pairs import DepthAllowance
from kinematify.geometry.sweep import Sweeper
from kinematify.manipulation.collision_world import CollisionWorld
from kinematify.manipulation.execute import Motion
from kinematify.manipulation.grasp import moved_bodies, search_grasps
from kinematify.manipulation.plan_request import Failure
from kinematify.manipulation.pull import ITSELF, Pull, Puller, Stop
from kinematify.manipulation.robot_place import Places, object_box, object_motion
from kinematify.manipulation.sampling_planner import plan_reach

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.config.planning_settings import PlanSettings
    from kinematify.geometry.scene import Scene
    from kinematify.manipulation.kinematics import Arm
    from kinematify.manipulation.manipulator import TaskRobot
    from kinematify.manipulation.robot_place import RobotPlacement
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import Travel

_OPENERS = 2  # so many other joints at most are opened before one that they cover: two doors before a wide drawer


@dataclass(frozen=True, kw_only=True, eq=False)
class OpenedObject:
    """An object as it is when the turn of a joint comes, and how far it lets the joint go, whoever pulls."""

    scene: Scene
    first: Mapping[str, float] = field(default_factory=dict)
    """Joints that were opened before, and where to [rad or m]."""
    share: float = 1.0
    """Of the way from rest to the open end that is free, in [0, 1]."""
    pair: tuple[str, str] | None = None
    """Who meets at the end of it."""
    helpers: tuple[int, ...] = ()
    """Other leaders that move the two against each other."""


def pull_end(travel: Travel, settings: PlanSettings) -> float:
    """Value at which a joint counts as open: the farther end of its range from rest [rad or m]."""
    return travel.far_end if travel.limited else travel.rest + settings.range_turn


def clear_way(scene: Scene, joint: str, settings: PlanSettings) -> OpenedObject:
    """Open other joints until one can be opened.

    Args:
        scene: The object at rest.
        joint: Leading joint that is to be opened.
        settings: What counts as open.

    Returns:
        The object with the others opened; as it is where that would not help.
    """
    leader = [travel.joint for travel in scene.travels].index(joint)
    start = found = _freedom(scene, leader, settings, {})
    for _ in range(_OPENERS):
        if found.share >= settings.opened:
            break
        steps = []
        for helper in found.helpers:
            travel = scene.travels[helper]
            first = {**found.first, travel.joint: pull_end(travel, settings)}
            steps.append(_freedom(scene.standing(first), leader, settings, first))
        best = max(steps, key=lambda step: step.share, default=found)
        if best.share <= found.share:
            break
        found = best
    return found if found.share >= settings.opened else start


def _freedom(scene: Scene, leader: int, settings: PlanSettings, first: Mapping[str, float]) -> OpenedObject:
    """Return how far a leader goes while all others rest."""
    overlap = OverlapQueries(scene)
    sweep = Sweeper(scene, overlap, DepthAllowance(scene, overlap)).sweep(leader)
    travel = scene.travels[leader]
    end = pull_end(travel, settings)
    side = sweep.sides[0 if end < travel.rest else 1]
    deep = scene.settings.wrong * scene.size
    meeting = next((m for m in side.meetings if m.inside and m.depth > deep), None)
    if meeting is None:
        return OpenedObject(scene=scene, first=first)
    return OpenedObject(
        scene=scene,
        first=first,
        share=float(np.clip((meeting.first - travel.rest) / (end - travel.rest), 0.0, 1.0)),
        pair=scene.name(meeting.pair),
        helpers=tuple(sorted(scene.between(meeting.pair) - {leader})),
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class PullPlan:
    """Result of the plan for one joint."""

    joint: str
    place: RobotPlacement | None
    T_world_object: FloatArray
    reach: FloatArray | None
    """Arm joints from home to the grasp [rad or m], shape (n, dof)."""
    pull: FloatArray | None
    """Arm joints from the grasp on [rad or m], shape (m, dof)."""
    opened: FloatArray | None
    """Value of the object's joint in each row of `pull` [rad or m], shape (m,)."""
    fraction: float
    """How much of the declared range opens, in [0, 1]."""
    free: float
    """How much of the declared range the object itself leaves free, in [0, 1]."""
    first: Mapping[str, float]
    """Joints that have to be opened before, and where to [rad or m]."""
    failure: Failure | None
    stop: Stop | None
    """What ends the pull; None if it is complete."""
    words: str
    """Why it failed, a clause; empty if it did not."""
    tried: int
    """Pairs of place and grasp that were looked at closely."""
    manipulability: float
    """Smallest along the pull; 0 without one."""
    on_column: bool
    """The robot stands on a column of the height of its root link."""
    seconds: float


def plan_pull(
    arm: Arm,
    scene: Scene,
    joint: str,
    settings: PlanSettings,
    *,
    point: FloatArray | None = None,
    base: FloatArray | None = None,
    seed: int = 0,
) -> PullPlan:
    """Plan how a robot opens one joint of an object that stands on the floor.

    Args:
        arm: The robot.
        scene: The object at its real size, in metres.
        joint: Joint that leads.
        settings: Thresholds.
        point: Hold the part there, frame of the object's root link [m], shape (3,); anywhere if None.
        base: Pose of the robot's root link in the frame of the object's root link, shape (4, 4); searched if None.
        seed: Of all that is random.

    Raises:
        InputError: The object has no such joint, or `point` is not on what it moves.
    """
    return _Planning(arm, scene, joint, settings, point=point, base=base, seed=seed).run()


def depend(plans: Sequence[PullPlan]) -> tuple[PullPlan, ...]:
    """Make plans fail that need another joint opened first, where the plan for that one fails."""
    failed = {plan.joint for plan in plans if plan.failure is not None}
    while True:
        held = {plan.joint for plan in plans if plan.joint not in failed and failed & plan.first.keys()}
        if not held:
            break
        failed |= held
    return tuple(_blocked_by(plan, failed) if plan.failure is None and plan.joint in failed else plan for plan in plans)


def _blocked_by(plan: PullPlan, failed: set[str]) -> PullPlan:
    other = next(name for name in plan.first if name in failed)
    return replace(plan, failure=Failure.COVERED, words=f"{other} has to be opened first, and the arm fails to do so")


def _longest_way(scene: Scene, joint: str, settings: PlanSettings) -> float:
    """Longest way of the middle of a moved part's corners, from rest to the open end [m]."""
    own, carried = moved_bodies(scene, joint)
    travel = next(travel for travel in scene.travels if travel.joint == joint)
    motion = object_motion(scene, joint, pull_end(travel, settings))
    ways = [0.0]
    for body in [*own, *carried]:
        corners = np.concatenate(scene.bodies[body].shapes)
        ends = [T[:3, :3] @ corners.T + T[:3, 3:] for T in motion.body_poses[[0, -1], body]]
        ways.append(float(np.linalg.norm(ends[1] - ends[0], axis=0).max()))
    return max(ways)


class _Planning:
    """One joint of an object; see `plan_pull`."""

    def __init__(
        self, arm: Arm, scene: Scene, joint: str, plan: PlanSettings, *, point: FloatArray | None,
        base: FloatArray | None, seed: int,
    ) -> None:  # fmt: skip
        self._started = time.process_time()
        self._moves = _longest_way(scene, joint, plan) >= plan.least_way
        self._opened = clear_way(scene, joint, plan) if self._moves else OpenedObject(scene=scene)
        self._arm, self._joint, self._plan, self._point, self._seed = arm, joint, plan, point, seed
        opened = self._opened.scene
        travel = next(travel for travel in opened.travels if travel.joint == joint)
        self._motion = object_motion(opened, joint, pull_end(travel, plan))
        self._base = None if base is None else self._motion.T_world_object @ base
        self._places = Places(arm, self._motion, object_box(opened), plan)
        self._tried = 0
        self._stops: list[Stop] = []
        self._ways: Counter[str] = Counter()

    def run(self) -> PullPlan:
        """Look at the object first, then at grasps, then at places."""
        if not self._moves:
            words = f"it moves what it carries by less than {self._plan.least_way * 1e3:.0f} mm"
            return self._ended(Failure.NO_WAY, words)
        free = self._opened
        if free.pair is not None and free.share < self._plan.opened:
            failure = Failure.COVERED if free.helpers else Failure.JAMS
            words = f"{free.pair[0]} meets {free.pair[1]} of the object"
            return self._ended(failure, words, stop=Stop(kind=ITSELF, words=words, pair=free.pair), fraction=free.share)
        opening = self._arm.robot.opening
        grasps, reason = search_grasps(free.scene, self._joint, opening, point=self._point, seed=self._seed)
        if not grasps:
            return self._ended(Failure.NO_GRASP, reason)
        world = CollisionWorld(self._arm, free.scene, self._joint, self._plan.margin)
        places = self._places.ranked(grasps, self._base)
        return self._search(world, Puller(self._arm, world, self._motion), places)

    def _search(self, world: CollisionWorld, puller: Puller, places: list[RobotPlacement]) -> PullPlan:
        """Try the most promising places until one lets the arm open the joint."""
        column = self._places.on_column
        best: tuple[Pull, FloatArray] | None = None
        for pull in self._pulls(puller, places, column=column):
            if best is not None and pull.fraction <= best[0].fraction:
                continue
            way = self._way_to(world, pull, column=column)
            if way is None:
                continue
            best = (pull, way)
            if pull.fraction >= self._plan.opened:
                break
        if best is None:
            return self._nothing()
        pull, way = best
        if pull.fraction >= self._plan.opened:
            return self._ended(None, "", stop=pull.stop, pull=pull, way=way, fraction=pull.fraction)
        words = pull.stop.words if pull.stop else ""
        return self._ended(Failure.STOPS, words, stop=pull.stop, pull=pull, way=way, fraction=pull.fraction)

    def _pulls(self, puller: Puller, places: list[RobotPlacement], *, column: bool) -> Iterator[Pull]:
        """Pulls as they are found: followed from the middle, then from rest, the farthest of the others last."""
        partial: list[Pull] = []
        for from_start, share in ((False, 0.6), (True, 1.0)):
            chosen = places if not from_start else places[: max(8, len(places) // 4)]
            for place in chosen:
                if self._spent > share * self._plan.seconds:
                    break
                self._tried += 1
                found = puller.follow(place, column=column, from_start=from_start)
                if isinstance(found, Stop):
                    self._stops.append(found)
                    continue
                if found.stop is None or found.fraction >= self._plan.opened:
                    yield found
                else:
                    self._stops.append(found.stop)
                    partial.append(found)
        yield from sorted(partial, key=lambda pull: -pull.fraction)[:4]

    def _way_to(self, world: CollisionWorld, pull: Pull, *, column: bool) -> FloatArray | None:
        if self._spent > self._plan.seconds:
            return None
        world.place(pull.place.T_world_base, self._motion.T_world_object, column=column)
        world.pose_object(self._motion.body_poses[0], pull.place.grasp.spread)
        reach = plan_reach(self._arm, world, pull.path[0], seed=self._seed)
        if isinstance(reach, str):
            self._ways[reach] += 1
            return None
        return reach

    def _nothing(self) -> PullPlan:
        """No way to any grasp."""
        if self._ways:
            return self._ended(Failure.NO_PATH, self._ways.most_common(1)[0][0])
        kinds = Counter(stop.kind for stop in self._stops).most_common(1)
        usual = next((stop for stop in self._stops if stop.kind == kinds[0][0]), None)
        late = " before time ran out" if self._spent > self._plan.seconds else ""
        words = f"none of {self._tried} places and grasps{late}" + (f"; mostly {usual.words}" if usual else "")
        return self._ended(Failure.NO_REACH, words, stop=usual)

    def _ended(
        self, failure: Failure | None, words: str, *, stop: Stop | None = None, pull: Pull | None = None,
        way: FloatArray | None = None, fraction: float = 0.0,
    ) -> PullPlan:  # fmt: skip
        path = None if pull is None else pull.path
        return PullPlan(
            joint=self._joint,
            place=None if pull is None else pull.place,
            T_world_object=self._motion.T_world_object,
            reach=way,
            pull=path,
            opened=None if pull is None else pull.values,
            fraction=fraction,
            free=self._opened.share,
            first=self._opened.first,
            failure=failure,
            stop=stop,
            words=words,
            tried=self._tried,
            manipulability=min((self._arm.manipulability(q) for q in path), default=0.0) if path is not None else 0.0,
            on_column=self._places.on_column,
            seconds=self._spent,
        )

    @property
    def _spent(self) -> float:
        return time.process_time() - self._started


def motion_of(plan: PullPlan, robot: TaskRobot, model: Path) -> Motion | None:
    """Return what the engines are to track; None where the plan leads nowhere.

    Args:
        plan: The plan.
        robot: Its robot.
        model: URDF of the object at its real size.
    """
    if plan.pull is None or plan.reach is None or plan.opened is None or plan.place is None or len(plan.pull) < 2:
        return None
    return Motion(
        robot=robot,
        object_urdf=model,
        T_world_base=plan.place.T_world_base,
        T_world_object=plan.T_world_object,
        joint=plan.joint,
        start=plan.first,
        grasp=plan.place.grasp,
        reach=plan.reach,
        pull=plan.pull,
        opened=plan.opened,
    )
