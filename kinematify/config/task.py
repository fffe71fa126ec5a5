"""Thresholds of the tasks (KV7xx); values with their reasons in `configs/validation.yaml`, section `task`."""

from __future__ import annotations

from kinematify.config import StageConfig
from kinematify.config.planning import PlanSettings


class GraspSettings(StageConfig):
    """Where a parallel gripper can hold a part; sizes are those of the fingers and of the palm."""

    points: int
    """Places on the moving part that are looked at."""
    points_seen: int
    """Of those that are seen along an approach direction, so many are measured."""
    tip: float
    """Fingers reach so far beyond the grasp point [m]."""
    finger_length: float
    """From the tip back to the palm [m]."""
    finger_width: float
    """Across approach and closing direction [m]."""
    finger_thickness: float
    """Along the closing direction [m]."""
    palm_width: float
    """Along the closing direction [m]."""
    palm_thickness: float
    """Across approach and closing direction [m]."""
    palm_length: float
    """Of what stands behind the fingers, wrist included, along the approach direction [m]."""
    approach: float
    """The hand comes in along a straight line from so far off [m]."""
    hidden: float
    """Places that lie at most so far behind the surface that is met first still count as seen [m]."""
    holds: list[float]
    """Tips reach so far behind the surface that the approach meets first [m]."""
    closing_steps: int
    """Closing directions per approach direction, over half a turn."""
    slack: float
    """Room between pad and surface on either side before the fingers close [m]."""
    slack_share: float
    """The same at most, fraction of the opening of the gripper."""
    tilt_deg: float
    """Angle between closing direction and surface normal at either pad at most [deg]."""
    plenty: float
    """More room than this beside the fingers is no better [m]."""
    lever_weight: float
    """Share of the lever arm in the rank."""
    clearance_weight: float
    """Share of the room beside the fingers."""
    pull_weight: float
    """Share of how the motion pulls: along the fingers or onto a pad, better than sideways out of them."""
    handle_weight: float
    """Share of what is made to be held: handles and knobs, not rims."""
    knob: float
    """What is held is a knob up to this width along both directions across the approach [m]."""
    plate: float
    """What goes on behind the grasp point for this length is the rim of a plate, else a handle [m]."""
    same_place: float
    """Grasps closer than this with nearly the same directions are one [m]."""
    same_deg: float
    """The same for their directions [deg]."""
    tries: int
    """Candidates whose room is checked exactly, the best first."""
    most: int
    """Grasps that are returned at most."""
    near_point: float
    """Grasps belong to a point that the user gave up to this distance [m]."""


class ExecutionSettings(StageConfig):
    """Tracking a planned motion in engines."""

    time_step: float
    """Of both engines [s]."""
    speed_share: float
    """Of the speed limit of each arm joint."""
    pull_seconds: float
    """A pull takes no less [s]."""
    grip_seconds: float
    """Time to close the fingers [s]."""
    settle_seconds: float
    """Holding at the end [s]."""
    servo_frequency: float
    """Of the arm's servos [Hz]; they are critically damped."""
    armature: float
    """Rotor inertia of every joint of the robot, fraction of the inertia that it moves."""
    effort: float
    """Of arm joints that state none [N m or N]."""
    velocity: float
    """Of arm joints that state none [rad/s or m/s]."""
    finger_inertia: float
    """Of each finger with its drive [kg or kg m^2]; light fingers sink into what they hold."""
    grip_force: float
    """Of each finger [N]."""
    pad_width: float
    """Of the pads, across approach and closing direction [m]."""
    pad_length: float
    """Of the pads, along the approach direction [m]."""
    friction: float
    """Of pads on the object."""
    weld_force: float
    """That a weld of PyBullet may exert [N]."""
    joint_damping: float
    """Of the object's joint if it states none, fraction of its inertia [1/s]."""
    opened: float
    """Share of the planned way at which a joint counts as opened."""
    rest_speed: float
    """Speed of the joint that counts as rest, fraction of the planned way [1/s]."""
    depth: float
    """Depth of the robot in the object that does not count [m]."""
    frame_rate: float
    """States that are kept for the film [Hz]."""


class FilmSettings(StageConfig):
    """The film of a run and its still."""

    frames: int
    """Pictures of the film at most."""
    width: int
    """Of the film [pixels]."""
    height: int
    """Of the film [pixels]."""
    still_width: int
    """Of each of the three panels of the still [pixels]."""
    still_height: int
    """The same for their height [pixels]."""
    colors: int
    """Of the film's palette."""
    last_seconds: float
    """The last picture is shown so long [s]."""
    azimuths: int
    """Sides from which the view is tried."""
    subsamples: int
    """Rays per pixel side where edges are smoothed."""
    rays: int
    """Rays per pixel for how much of the sky a point sees."""


class PourSettings(StageConfig):
    """Pouring from a cup into a container."""

    turns: int
    """Ways round of the cup that are tried, at equal angles."""
    apart: float
    """Gap between cup and container at the start [m]."""
    least_lift: float
    """The cup is lifted by no less [m]."""
    above: float
    """The lip stands so high above the container when the cup tilts [m]."""
    tilt_deg: float
    """Angle by which the cup is tilted [deg]."""
    step: float
    """Of the plan, while the cup is lifted and carried [m]."""
    step_deg: float
    """Of the plan, while it tilts [deg]."""


class TaskSettings(StageConfig):
    """KV7xx: tasks of a robot."""

    seconds: float
    """Wall time for a task with one object, beside that of the other checks [s]."""
    grasp: GraspSettings
    plan: PlanSettings
    execution: ExecutionSettings
    film: FilmSettings
    pour: PourSettings
    srdf_rows: int
    """Configurations in which pairs of links are looked at for an SRDF."""
