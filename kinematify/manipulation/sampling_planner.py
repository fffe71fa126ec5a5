"""The free way to the grasp, from the home posture to before the part (OMPL's RRTConnect), then straight in."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from kinematify.manipulation.grasp import APPROACH
from kinematify.manipulation.pull import JUMP_AT

if TYPE_CHECKING:
    from kinematify.manipulation.collision_world import CollisionWorld
    from kinematify.manipulation.kinematics import Arm
    from kinematify.robot.arrays import FloatArray

_APPROACH_STEPS = 6  # the hand comes in along a straight line of so many poses
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
        target[:3, 3] -= share * APPROACH * end[:3, 2]
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
    checks = 0

    def valid(state: ob.State) -> bool:
        nonlocal checks
        checks += 1
        return bool(world.free(np.array([state[k] for k in rows]), holding=False))

    setup.setStateValidityChecker(valid)
    ends = [space.allocState(), space.allocState()]
    for state, values in zip(ends, (start, goal), strict=True):
        for k in rows:
            state[k] = float(values[k])
    setup.setStartAndGoalStates(*ends)
    setup.setPlanner(og.RRTConnect(setup.getSpaceInformation()))
    setup.solve(ob.PlannerTerminationCondition(lambda: checks > _REACH_CHECKS))
    if not setup.haveExactSolutionPath():
        return None
    setup.simplifySolution()
    path = setup.getSolutionPath()
    path.interpolate(max(path.getStateCount(), 2))
    return np.array([[state[k] for k in rows] for state in path.getStates()])
