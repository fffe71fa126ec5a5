"""Thresholds of planning, section `task.plan` of the thresholds of the checks."""

from __future__ import annotations

from pydantic import Field

from kinematify.config import StageConfig


class PlanSettings(StageConfig):
    """Settings of the placement of an arm and of its motion."""

    seconds: float = 20.0  # all places of a door take 8 s, and the first pass gets 0.6 of the time
    """Time of one core for the plan of one joint [s]."""
    smallest: float = 0.02  # the smallest latches and boxes
    """Objects with a smaller extent are nothing that an arm could use [m]."""
    largest: float = 20.0  # a gate; arms reach a metre
    """The same for larger ones [m]."""
    range_turn: float = 1.57  # knobs that turn for ever are turned by a quarter
    """Joints without limits are to be turned so far [rad]."""
    least_way: float = 0.005  # buttons are pressed, not pulled
    """Joints with a shorter way of what is held are not planned for [m]."""
    plinth: float = 0.4  # a hand that points up below the handle of an oven door; wall ovens hang higher
    """What swings down to the floor ends so far above it, the object on a plinth [m]."""
    tabletop: float = 0.6  # laptops, toasters, boxes; a chair or a bin is higher
    """Objects that measure less along every axis stand on a table that is as high as a plinth [m]."""
    opened: float = 0.9
    """Share of the range from which a pull counts as complete."""
    openers: int = 2  # two doors before a wide drawer
    """So many other joints at most are opened before one that they cover."""
    iterations: int = 40  # from the nearest sample a dozen are enough
    """Steps of inverse kinematics."""
    damping: float = 0.02
    """Of its least squares, relative to the remaining error."""
    centering: float = 0.02
    """Share of the way back to the middle of the range in each step, as far as the task leaves freedom."""
    largest_step: float = 0.4  # beyond that the linear model means nothing
    """Of a joint in one step [rad or m]."""
    same_place: float = 5.0e-5
    """Error of the tool's position that counts as none [m]."""
    same_turn: float = 5.0e-4
    """The same for its orientation [rad]."""
    radian: float = 0.2  # of a hand of 20 cm
    """Error of direction of one radian counts like so much error of position [m]."""
    restarts: int = 3
    """Samples of the arm from which inverse kinematics starts."""
    grasps: int = 14
    """Grasps that are planned with at most, the best first."""
    per_direction: int = 3  # the ends of a bar and its middle
    """Of these, so many at most come in from nearly the same direction."""
    bearings: int = 16
    """Directions around the part in which the arm may stand."""
    distances: list[float] = Field([0.45, 0.6, 0.75, 0.9])  # nearer the arm is folded, farther it is stretched out
    """Horizontal distance of the shoulder from the middle of the pull, fraction of the arm's reach."""
    heights: list[float] = Field([-0.25, 0.1, 0.4])  # an arm works best a little below its shoulder
    """Height of the shoulder above the middle of the pull, fraction of the arm's reach."""
    height_step: float = 0.05
    """Columns have heights of multiples of this [m]."""
    footprint: float = 0.16  # half of the built-in arm's base and a hand's width
    """The arm's base stays so far away from the object at rest [m]."""
    places: int = 480  # 2 to 20 ms each; with 160 it depended on the seed whether a house door opens
    """Pairs of a place and a grasp that are looked at closely, the most promising first."""
    steps: int = 25
    """Poses in which a pull is planned, both ends included."""
    jump: float = 0.6  # 25 poses over a turn of the wrist
    """Larger changes of a joint from one to the next are no continuous motion [rad or m]."""
    near_limit: float = 0.005
    """A joint is at its limit if it is so near, fraction of its range."""
    singular: float = 0.02
    """Smallest singular value of the Jacobian (lengths in half metres) below which the arm cannot follow."""
    margin: float = 0.008  # convex pieces in engines reach 7 mm beyond the surface
    """Arm and object stay so far apart, without the hand [m]."""
    approach: float = 0.06
    """The hand comes in along a straight line from so far off [m]."""
    approach_steps: int = 6
    """Poses of that line."""
    reach_checks: int = 6000  # a second; most paths need a few hundred
    """Configurations that are checked in search of a path to the grasp, from one place: a search that counts finds the
    same on any machine."""
    reach_step: float = 0.08  # 5 cm at the elbow
    """Configurations of a path that are checked are so far apart at most [rad or m]."""
    manifold_checks: int = 8000  # a second
    """Evaluations of the constraint, and configurations, in a search on the constraint manifold."""
    residual: float = 1.0e-3
    """Deviation from the joint's constraint that a plan may have [m, and half metres per radian]."""
    always: float = 0.9
    """Parts of the robot that collide in more than this share of configurations are built that way."""
