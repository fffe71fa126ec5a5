"""Thresholds of the tasks (KV7xx), section `task` of the thresholds of the checks."""

from __future__ import annotations

from kinematify.config import StageConfig, section
from kinematify.config.planning_settings import PlanSettings


class ExecutionSettings(StageConfig):
    """Tracking a planned motion in engines."""

    time_step: float = 0.002
    """Of both engines [s]."""
    speed_share: float = 0.6  # of what the arm can do: servos keep up
    """Of the speed limit of each arm joint."""
    pull_seconds: float = 1.5  # people open doors in one to two seconds
    """A pull takes no less [s]."""
    grip_seconds: float = 0.3
    """Time to close the fingers [s]."""
    settle_seconds: float = 0.5
    """Holding at the end [s]."""
    servo_frequency: float = 8.0
    """Of the arm's servos [Hz]; they are critically damped."""
    armature: float = 0.1
    """Rotor inertia of every joint of the robot, fraction of the inertia that it moves."""
    effort: float = 50.0
    """Of arm joints that state none [N m or N]."""
    velocity: float = 1.0
    """Of arm joints that state none [rad/s or m/s]."""
    finger_inertia: float = 1.0  # spindles and gears of electric grippers
    """Of each finger with its drive [kg or kg m^2]; light fingers sink into what they hold."""
    grip_force: float = 60.0  # grippers of research arms exert 40 to 140 N
    """Of each finger [N]."""
    friction: float = 1.0  # rubber on varnish
    """Of pads on the object."""
    weld_force: float = 500.0  # doors of appliances need up to 70 N
    """That a weld of PyBullet may exert [N]."""
    joint_damping: float = 1.0  # a part that is pushed comes to rest within a second or two
    """Of the object's joint if it states none, fraction of its inertia [1/s]."""
    opened: float = 0.9
    """Share of the planned way at which a joint counts as opened."""
    rest_speed: float = 0.05
    """Speed of the joint that counts as rest, fraction of the planned way [1/s]."""
    depth: float = 0.008  # convex pieces of the object reach up to 7 mm beyond its surface
    """Depth of the robot in the object that does not count [m]."""


class TaskSettings(StageConfig):
    """KV7xx: tasks of a robot."""

    seconds: float = 240.0  # five joints take 60 s on a free machine, most of it for films and convex pieces
    """Wall time for a task with one object, beside that of the other checks [s]."""
    plan: PlanSettings = section()
    execution: ExecutionSettings = section()
    # pairs that meet in one configuration of a thousand are found; MoveIt takes 10,000 by default
    srdf_rows: int = 4096
    """Configurations in which pairs of links are looked at for an SRDF."""
