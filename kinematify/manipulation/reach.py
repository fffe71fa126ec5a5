"""The way to the grasp: free of collisions from the home posture to before the part, then straight in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from ompl import base as ob
from ompl import geometric as og

from kinematify.manipulation.manifold import Counter, quiet_and_seeded

if TYPE_CHECKING:
    from kinematify.config.planning import PlanSettings
    from kinematify.manipulation.collision import CollisionWorld
    from kinematify.manipulation.kinematics import Arm
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Reach:
    """A way to the grasp, or why there is none."""

    path: FloatArray | None
    """Arm joints from home to the grasp [rad or m], shape (n, dof)."""
    reason: str | None


def plan_reach(arm: Arm, world: CollisionWorld, grasp: FloatArray, settings: PlanSettings, *, seed: int) -> Reach:
    """Plan the way to a posture.

    Args:
        arm: The robot.
        world: Everything posed as it is before the pull.
        grasp: Arm joints at the grasp, shape (dof,).
        settings: Times and steps.
        seed: Of OMPL.
    """
    straight = _straight_in(arm, world, grasp, settings)
    if isinstance(straight, str):
        return Reach(path=None, reason=straight)
    home = _free_start(arm, world)
    if home is None:
        return Reach(path=None, reason="the arm finds no free posture to start from beside the object")
    way = _free_path(arm, world, home, straight[0], settings, seed=seed)
    if way is None:
        return Reach(path=None, reason="no way free of collisions leads to the grasp")
    return Reach(path=np.concatenate([way, straight[1:]]), reason=None)


def _straight_in(arm: Arm, world: CollisionWorld, grasp: FloatArray, settings: PlanSettings) -> FloatArray | str:
    """Postures from before the part along the fingers to the grasp, or why that fails."""
    hit = world.hit(grasp, holding=False)
    if hit is not None:
        return f"at the grasp its {hit.first} meets {hit.second}"
    path, q, end = [grasp], grasp, arm.pose(grasp)
    for share in np.linspace(0.0, 1.0, settings.approach_steps + 1)[1:]:
        target = end.copy()
        target[:3, 3] -= share * settings.approach * end[:3, 2]
        moved = arm.solve(target, q)
        if moved is None or float(np.abs(moved - q).max()) > settings.jump:
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


def _free_path(
    arm: Arm, world: CollisionWorld, start: FloatArray, goal: FloatArray, settings: PlanSettings, *, seed: int
) -> FloatArray | None:
    """Shortened path of RRTConnect, shape (n, dof)."""
    quiet_and_seeded(seed)
    space = ob.RealVectorStateSpace(arm.dof)
    bounds = ob.RealVectorBounds(arm.dof)
    for k in range(arm.dof):
        bounds.setLow(k, float(arm.lower[k]) - 1e-6)
        bounds.setHigh(k, float(arm.upper[k]) + 1e-6)
    space.setBounds(bounds)
    space.setLongestValidSegmentFraction(settings.reach_step / float(space.getMaximumExtent()))
    setup = og.SimpleSetup(space)
    rows = range(arm.dof)
    counter = Counter(settings.reach_checks)

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
