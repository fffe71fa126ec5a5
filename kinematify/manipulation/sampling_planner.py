"""Sampling-based planning (OMPL): the free way to the grasp, and pulls on the constraint manifold of arm and object.

The way to the grasp goes from the home posture to before the part, then straight in. In a pull the hand holds the part
all the way: states are the arm's joints and the share of the object's joint that is open; the constraint says that the
tool is where the joint has taken the grasp. Of OMPL's spaces the atlas is used: the projected one takes thousands of
times longer, and the tangent bundle leaves the manifold.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from kinematify.manipulation.pull import JUMP_AT, RESTARTS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.manipulation.collision_world import CollisionWorld
    from kinematify.manipulation.kinematics import Arm
    from kinematify.manipulation.pull import Pull, Puller
    from kinematify.manipulation.robot_place import RobotPlacement
    from kinematify.robot.arrays import FloatArray

_HALF_METRES = np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
_DELTA = 1e-4  # of the share, for its derivative
_STEP = 0.02  # between states on the manifold: the middles deviate with its square
_HALVINGS = 5
_MANIFOLD_CHECKS = 8000  # evaluations of the constraint, and configurations, in a search on the manifold: a second
_RESIDUAL = 1e-3  # deviation from the joint's constraint that a plan may have [m, and half metres per radian]
_APPROACH, _APPROACH_STEPS = 0.06, 6  # the hand comes in along a straight line of so many poses from so far off [m]
# Configurations that are checked in search of a path from one place, so far apart at most [rad or m]: most paths need a
# few hundred, 5 cm at the elbow. A search that counts finds the same on any machine.
_REACH_CHECKS, _REACH_STEP = 6000, 0.08
_SEEDED: list[int] = []


def quiet_and_seeded(seed: int) -> None:
    """Silence OMPL and seed it, once in a process: it refuses a second seed."""
    if not _SEEDED:
        ou.setLogLevel(ou.LogLevel.LOG_NONE)
        ou.RNG.setSeed(seed + 1)
        _SEEDED.append(seed)


class Counter:
    """Ends a search after so many steps of work: unlike a clock, it ends at the same place on any machine."""

    def __init__(self, most: int) -> None:
        """Begin at none."""
        self.count, self._most = 0, most

    def condition(self) -> ob.PlannerTerminationCondition:
        """Return what OMPL asks whether to go on."""
        return ob.PlannerTerminationCondition(lambda: bool(self.count > self._most))


class _HoldsOn(ob.Constraint):  # type: ignore[misc]
    """The tool is where the joint has taken the grasp: 6 equations in the arm's joints and the open share."""

    def __init__(self, puller: Puller, targets: FloatArray) -> None:
        super().__init__(puller.arm.dof + 1, 6)
        self._puller, self.targets = puller, targets
        self.counter = Counter(_MANIFOLD_CHECKS)

    def function(self, x: FloatArray, out: FloatArray) -> None:
        self.counter.count += 1
        out[:] = self.residual(np.asarray(x))

    def jacobian(self, x: FloatArray, out: FloatArray) -> None:
        x = np.asarray(x)
        out[:, :-1] = -_HALF_METRES[:, None] * self._puller.arm.jacobian(x[:-1])
        ahead, behind = (x + step * np.eye(len(x))[-1] for step in (_DELTA, -_DELTA))
        out[:, -1] = (self.residual(ahead) - self.residual(behind)) / (2.0 * _DELTA)

    def residual(self, x: FloatArray) -> FloatArray:
        target = self._puller.target_at(self.targets, float(x[-1]))
        return np.asarray(_HALF_METRES * self._puller.arm.error(x[:-1], target))


def search_pull(puller: Puller, pull: Pull, *, column: bool, seed: int) -> Pull:
    """Look for another way to the end of the joint on the constraint manifold, where following fell short.

    Args:
        puller: Follows the joint.
        pull: How far it came.
        column: The robot stands on a column.
        seed: Of OMPL.

    Returns:
        A complete pull from the same place; the given one where none was found.
    """
    place = pull.place
    puller.world.place(place.T_world_base, puller.motion.T_world_object, column=column)
    targets = puller.targets(place)
    ends = [q for q in puller.arm.solve_all(targets[-1], RESTARTS) if puller.free_at(q, 1.0, place)]
    if not ends:
        return pull
    start = np.append(pull.path[0], 0.0)
    found = search_manifold(puller, place, start, [np.append(q, 1.0) for q in ends], seed=seed)
    if found is None:
        return pull
    values = np.interp(found[:, -1], np.linspace(0.0, 1.0, len(targets)), puller.motion.values)
    return replace(pull, path=found[:, :-1], values=values, fraction=1.0, stop=None, searched=True)


def search_manifold(
    puller: Puller, place: RobotPlacement, start: FloatArray, goals: Sequence[FloatArray], *, seed: int
) -> FloatArray | None:
    """Search a way from a state to one of several others.

    Args:
        puller: Arm, collision world and thresholds.
        place: Place and grasp; the world is posed for it.
        start: Arm joints and open share, on the manifold, shape (dof + 1,).
        goals: The same at the end, the first that is reached counts.
        seed: Of OMPL.

    Returns:
        States from start to goal that keep the constraint, in small steps, shape (n, dof + 1); None if none was found.
    """
    quiet_and_seeded(seed)
    constraint = _HoldsOn(puller, puller.targets(place))
    for goal in goals:
        states = _solved(puller, place, constraint, start, goal)
        if states is not None:
            states = _refined(puller, constraint, states)
        if states is not None:
            return states
    return None


def _solved(
    puller: Puller, place: RobotPlacement, constraint: _HoldsOn, start: FloatArray, goal: FloatArray
) -> FloatArray | None:
    arm = puller.arm
    ambient = ob.RealVectorStateSpace(arm.dof + 1)
    bounds = ob.RealVectorBounds(arm.dof + 1)
    for k, (low, high) in enumerate(zip([*arm.lower, -0.01], [*arm.upper, 1.01], strict=True)):
        bounds.setLow(k, float(low))
        bounds.setHigh(k, float(high))
    ambient.setBounds(bounds)
    space = ob.AtlasStateSpace(ambient, constraint)
    space.setDelta(_STEP)
    setup = og.SimpleSetup(ob.ConstrainedSpaceInformation(space))

    def valid(state: ob.State) -> bool:
        constraint.counter.count += 1
        x = np.array([state[k] for k in range(arm.dof + 1)])
        return bool(puller.free_at(x[:-1], float(x[-1]), place))

    setup.setStateValidityChecker(valid)
    ends = []
    for values in (start, goal):
        state = space.allocState()
        state.copy(values)
        space.anchorChart(state)
        ends.append(state)
    setup.setStartAndGoalStates(*ends)
    setup.setPlanner(og.RRTConnect(setup.getSpaceInformation()))
    setup.solve(constraint.counter.condition())
    if not setup.haveExactSolutionPath():
        return None
    path = setup.getSolutionPath()
    path.interpolate()
    rows = [[state[k] for k in range(arm.dof + 1)] for state in path.getStates()]
    return np.array(rows)


def _refined(puller: Puller, constraint: _HoldsOn, states: FloatArray) -> FloatArray | None:
    """Put states between those whose middle leaves the manifold, shape (n, dof + 1); None where that fails.

    Whoever follows the path goes straight from state to state, so the straight lines must keep the constraint too.
    """
    targets = constraint.targets
    if any(float(np.linalg.norm(constraint.residual(x))) > _RESIDUAL for x in states):
        return None
    for _ in range(_HALVINGS):
        rows, kept = [states[0]], True
        for before, after in pairwise(states):
            middle = 0.5 * (before + after)
            if float(np.linalg.norm(constraint.residual(middle))) > _RESIDUAL:
                q = puller.arm.solve(puller.target_at(targets, float(middle[-1])), middle[:-1], center=False)
                if q is None:
                    return None
                rows.append(np.append(q, middle[-1]))
                kept = False
            rows.append(after)
        if kept:
            return states
        states = np.array(rows)
    return None


def plan_reach(arm: Arm, world: CollisionWorld, grasp: FloatArray, *, seed: int) -> FloatArray | str:
    """Plan the way to a posture.

    Args:
        arm: The robot.
        world: Everything posed as it is before the pull.
        grasp: Arm joints at the grasp, shape (dof,).
        seed: Of OMPL.

    Returns:
        Arm joints from home to the grasp [rad or m], shape (n, dof), or why there is no way.
    """
    straight = _straight_in(arm, world, grasp)
    if isinstance(straight, str):
        return straight
    home = _free_start(arm, world)
    if home is None:
        return "the arm finds no free posture to start from beside the object"
    way = _free_path(arm, world, home, straight[0], seed=seed)
    if way is None:
        return "no way free of collisions leads to the grasp"
    return np.concatenate([way, straight[1:]])


def _straight_in(arm: Arm, world: CollisionWorld, grasp: FloatArray) -> FloatArray | str:
    """Postures from before the part along the fingers to the grasp, or why that fails."""
    hit = world.hit(grasp, holding=False)
    if hit is not None:
        return f"at the grasp its {hit.first} meets {hit.second}"
    path, q, end = [grasp], grasp, arm.pose(grasp)
    for share in np.linspace(0.0, 1.0, _APPROACH_STEPS + 1)[1:]:
        target = end.copy()
        target[:3, 3] -= share * _APPROACH * end[:3, 2]
        moved = arm.solve(target, q)
        if moved is None or float(np.abs(moved - q).max()) > JUMP_AT:
            return "the straight way in is out of its reach"
        hit = world.hit(moved, holding=False)
        if hit is not None:
            return f"on the straight way in its {hit.first} meets {hit.second}"
        path.append(moved)
        q = moved
    return np.array(path[::-1])


def _free_start(arm: Arm, world: CollisionWorld) -> FloatArray | None:
    """The home posture, or the free sample that is nearest to it."""
    order = np.argsort(np.abs(arm.samples - arm.home).max(axis=1))[:200]
    return next((q for q in (arm.home, *arm.samples[order]) if world.free(q, holding=False)), None)


def _free_path(arm: Arm, world: CollisionWorld, start: FloatArray, goal: FloatArray, *, seed: int) -> FloatArray | None:
    """Shortened path of RRTConnect, shape (n, dof)."""
    quiet_and_seeded(seed)
    space = ob.RealVectorStateSpace(arm.dof)
    bounds = ob.RealVectorBounds(arm.dof)
    for k in range(arm.dof):
        bounds.setLow(k, float(arm.lower[k]) - 1e-6)
        bounds.setHigh(k, float(arm.upper[k]) + 1e-6)
    space.setBounds(bounds)
    space.setLongestValidSegmentFraction(_REACH_STEP / float(space.getMaximumExtent()))
    setup = og.SimpleSetup(space)
    rows = range(arm.dof)
    counter = Counter(_REACH_CHECKS)

    def valid(state: ob.State) -> bool:
        counter.count += 1
        return bool(world.free(np.array([state[k] for k in rows]), holding=False))

    setup.setStateValidityChecker(valid)
    ends = [space.allocState(), space.allocState()]
    for state, values in zip(ends, (start, goal), strict=True):
        for k in rows:
            state[k] = float(values[k])
    setup.setStartAndGoalStates(*ends)
    setup.setPlanner(og.RRTConnect(setup.getSpaceInformation()))
    setup.solve(counter.condition())
    if not setup.haveExactSolutionPath():
        return None
    setup.simplifySolution()
    path = setup.getSolutionPath()
    path.interpolate(max(path.getStateCount(), 2))
    return np.array([[state[k] for k in rows] for state in path.getStates()])
