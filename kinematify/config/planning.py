"""Thresholds of planning; values with their reasons in `configs/validation.yaml`, section `task`."""

from __future__ import annotations

from kinematify.config import StageConfig


class PlanSettings(StageConfig):
    """How an arm is placed, and how its motion is planned."""

    seconds: float
    """Time of one core for the plan of one joint [s]."""
    smallest: float
    """Objects with a smaller extent are nothing that an arm could use [m]."""
    largest: float
    """The same for larger ones [m]."""
    range_turn: float
    """Joints without limits are to be turned so far [rad]."""
    least_way: float
    """Joints with a shorter way of what is held are not planned for [m]."""
    plinth: float
    """What swings down to the floor ends so far above it, the object on a plinth [m]."""
    tabletop: float
    """Objects that measure less along every axis stand on a table that is as high as a plinth [m]."""
    opened: float
    """Share of the range from which a pull counts as complete."""
    openers: int
    """So many other joints at most are opened before one that they cover."""
    iterations: int
    """Steps of inverse kinematics."""
    damping: float
    """Of its least squares, relative to the remaining error."""
    centering: float
    """Share of the way back to the middle of the range in each step, as far as the task leaves freedom."""
    largest_step: float
    """Of a joint in one step [rad or m]."""
    same_place: float
    """Error of the tool's position that counts as none [m]."""
    same_turn: float
    """The same for its orientation [rad]."""
    radian: float
    """Error of direction of one radian counts like so much error of position [m]."""
    restarts: int
    """Samples of the arm from which inverse kinematics starts."""
    grasps: int
    """Grasps that are planned with at most, the best first."""
    per_direction: int
    """Of these, so many at most come in from nearly the same direction."""
    bearings: int
    """Directions around the part in which the arm may stand."""
    distances: list[float]
    """Horizontal distance of the shoulder from the middle of the pull, fraction of the arm's reach."""
    heights: list[float]
    """Height of the shoulder above the middle of the pull, fraction of the arm's reach."""
    height_step: float
    """Columns have heights of multiples of this [m]."""
    footprint: float
    """The arm's base stays so far away from the object at rest [m]."""
    places: int
    """Pairs of a place and a grasp that are looked at closely, the most promising first."""
    steps: int
    """Poses in which a pull is planned, both ends included."""
    jump: float
    """Larger changes of a joint from one to the next are no continuous motion [rad or m]."""
    near_limit: float
    """A joint is at its limit if it is so near, fraction of its range."""
    singular: float
    """Smallest singular value of the Jacobian (lengths in half metres) below which the arm cannot follow."""
    margin: float
    """Arm and object stay so far apart, the hand left out [m]."""
    approach: float
    """The hand comes in along a straight line from so far off [m]."""
    approach_steps: int
    """Poses of that line."""
    reach_checks: int
    """Configurations that are checked in search of a path to the grasp, from one place: a search that counts finds the
    same on any machine."""
    reach_step: float
    """Configurations of a path that are checked are so far apart at most [rad or m]."""
    manifold_checks: int
    """Evaluations of the constraint, and configurations, in a search on the constraint manifold."""
    residual: float
    """Deviation from the joint's constraint that a plan may have [m, and half metres per radian]."""
    always: float
    """Parts of the robot that collide in more than this share of configurations are built that way."""
