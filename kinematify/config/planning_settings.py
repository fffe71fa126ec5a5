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
    opened: float = 0.9
    """Share of the range from which a pull counts as complete."""
    bearings: int = 16
    """Directions around the part in which the arm may stand."""
    distances: list[float] = Field([0.45, 0.6, 0.75, 0.9])  # nearer the arm is folded, farther it is stretched out
    """Horizontal distance of the shoulder from the middle of the pull, fraction of the arm's reach."""
    heights: list[float] = Field([-0.25, 0.1, 0.4])  # an arm works best a little below its shoulder
    """Height of the shoulder above the middle of the pull, fraction of the arm's reach."""
    margin: float = 0.008  # convex pieces in engines reach 7 mm beyond the surface
    """Arm and object stay so far apart, without the hand [m]."""
