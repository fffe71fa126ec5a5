"""Thresholds of the tasks (KV7xx), section `task` of the thresholds of the checks."""

from __future__ import annotations

from pydantic import Field

from kinematify.config import StageConfig, section
from kinematify.config.planning_settings import PlanSettings


class GraspSettings(StageConfig):
    """Where a parallel gripper can hold a part; sizes are those of the fingers and of the palm."""

    points: int = 6000  # of a drawer one in thirty is on the outside, of that one in ten on the handle
    """Places on the moving part that are looked at."""
    points_seen: int = 250  # 18 directions take 0.2 s
    """Of those that are seen along an approach direction, so many are measured."""
    tip: float = 0.01  # the hand is that of the built-in arm, which is like most hands for tables and kitchens
    """Fingers reach so far beyond the grasp point [m]."""
    finger_length: float = 0.07
    """From the tip back to the palm [m]."""
    finger_width: float = 0.02
    """Across approach and closing direction [m]."""
    finger_thickness: float = 0.014
    """Along the closing direction [m]."""
    palm_width: float = 0.15
    """Along the closing direction [m]."""
    palm_thickness: float = 0.055
    """Across approach and closing direction [m]."""
    palm_length: float = 0.12
    """Of what stands behind the fingers, wrist included, along the approach direction [m]."""
    approach: float = 0.06
    """The hand comes in along a straight line from so far off [m]."""
    hidden: float = 0.02  # the far side of a bar is met through its near side
    """Places that lie at most so far behind the surface that is met first still count as seen [m]."""
    holds: list[float] = Field([0.006, 0.014, 0.026])  # a flat knob, a bar, and a firm hold of a board
    """Tips reach so far behind the surface that the approach meets first [m]."""
    closing_steps: int = 4  # every 45 degrees: bars stand upright, lie, or are diagonal
    """Closing directions per approach direction, over half a turn."""
    slack: float = 0.006  # an arm arrives with an error of 1 to 2 mm
    """Room between pad and surface on either side before the fingers close [m]."""
    slack_share: float = 0.15  # small grippers are positioned the more carefully
    """The same at most, fraction of the opening of the gripper."""
    tilt_deg: float = 35.0  # friction of rubber on varnish holds up to about 0.7
    """Angle between closing direction and surface normal at either pad at most [deg]."""
    plenty: float = 0.03
    """More room than this beside the fingers is no better [m]."""
    lever_weight: float = 0.4  # the force that opens a door falls with the lever
    """Share of the lever arm in the rank."""
    clearance_weight: float = 0.2
    """Share of the room beside the fingers."""
    pull_weight: float = 0.2
    """Share of how the motion pulls: along the fingers or onto a pad, better than sideways out of them."""
    handle_weight: float = 0.2
    """Share of what is made to be held: handles and knobs, not rims."""
    knob: float = 0.07  # knobs of furniture measure 2 to 5 cm
    """What is held is a knob up to this width along both directions across the approach [m]."""
    plate: float = 0.045  # handles are 1 to 4 cm deep
    """What goes on behind the grasp point for this length is the rim of a plate, else a handle [m]."""
    same_place: float = 0.04
    """Grasps closer than this with nearly the same directions are one [m]."""
    same_deg: float = 25.0
    """The same for their directions [deg]."""
    tries: int = 800  # 0.2 ms each
    """Candidates whose room is checked exactly, the best first."""
    most: int = 60  # all directions from which a handle can be held: not each one can be followed
    """Grasps that are returned at most."""
    near_point: float = 0.04  # half of a hand's width
    """Grasps belong to a point that the user gave up to this distance [m]."""


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
    pad_width: float = 0.02  # those of the built-in arm
    """Of the pads, across approach and closing direction [m]."""
    pad_length: float = 0.02
    """Of the pads, along the approach direction [m]."""
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
    frame_rate: float = 25.0
    """States that are kept for the film [Hz]."""


class FilmSettings(StageConfig):
    """The film of a run and its still."""

    frames: int = 24  # 8 pictures a second of motion; each takes 0.15 s to draw
    """Pictures of the film at most."""
    width: int = 360
    """Of the film [pixels]."""
    height: int = 290
    """Of the film [pixels]."""
    still_width: int = 360
    """Of each of the three panels of the still [pixels]."""
    still_height: int = 330
    """The same for their height [pixels]."""
    colors: int = 64  # shades of five colours; a film of 3 s has 0.2 MB
    """Of the film's palette."""
    last_seconds: float = 1.5
    """The last picture is shown so long [s]."""
    azimuths: int = 12
    """Sides from which the view is tried."""
    subsamples: int = 2
    """Rays per pixel side where edges are smoothed."""
    rays: int = 3
    """Rays per pixel for how much of the sky a point sees."""


class PourSettings(StageConfig):
    """Pouring from a cup into a container."""

    turns: int = 4  # the handle before, behind or beside the lip
    """Ways round of the cup that are tried, at equal angles."""
    apart: float = 0.12  # room for a hand
    """Gap between cup and container at the start [m]."""
    least_lift: float = 0.06
    """The cup is lifted by no less [m]."""
    above: float = 0.04
    """The lip stands so high above the container when the cup tilts [m]."""
    tilt_deg: float = 110.0  # empties a cup with upright walls
    """Angle by which the cup is tilted [deg]."""
    step: float = 0.02
    """Of the plan, while the cup is lifted and carried [m]."""
    step_deg: float = 5.0
    """Of the plan, while it tilts [deg]."""


class TaskSettings(StageConfig):
    """KV7xx: tasks of a robot."""

    seconds: float = 240.0  # five joints take 60 s on a free machine, most of it for films and convex pieces
    """Wall time for a task with one object, beside that of the other checks [s]."""
    grasp: GraspSettings = section()
    plan: PlanSettings = section()
    execution: ExecutionSettings = section()
    film: FilmSettings = section()
    pour: PourSettings = section()
    # pairs that meet in one configuration of a thousand are found; MoveIt takes 10,000 by default
    srdf_rows: int = 4096
    """Configurations in which pairs of links are looked at for an SRDF."""
