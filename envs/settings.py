"""Values of the environments: one class per topic, values with their reasons in `configs/envs.yaml`."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from kinematify.config import StageConfig, load_values, validated

if TYPE_CHECKING:
    from pathlib import Path


class TimeSettings(StageConfig):
    """Steps."""

    step: float
    """Of the engine [s]."""
    control_rate: float
    """Actions per second [1/s]."""
    episode_steps: int
    """Actions of an episode of OpenPart."""
    robot_episode_steps: int
    """Actions of an episode of DrawerPull."""
    solver_iterations: int
    """Of PyBullet, per step."""

    @property
    def substeps(self) -> int:
        """Steps of the engine per action."""
        return max(1, round(1.0 / (self.control_rate * self.step)))

    @property
    def control_step(self) -> float:
        """Time between actions [s]."""
        return self.substeps * self.step


class ObjectSettings(StageConfig):
    """What files do not say about joints."""

    damping_rate: float
    """Damping of a joint without one, per inertia that it moves [1/s]."""
    friction_acceleration: float
    """Friction of a joint without one, per inertia that it moves [m/s^2 or rad/s^2]."""
    hold: float
    """Friction of a joint without one, over what gravity pulls it away from rest with."""
    slots: int
    """Joints in an observation; models with more get the next multiple."""


class HandSettings(StageConfig):
    """The hand of OpenPart."""

    opening: float
    """Largest width of a hold that is looked for [m]."""
    seconds: float
    """Time in which the hand can open the part from rest to rest [s]."""
    margin: float
    """Full force over what that needs."""
    least_force: float
    """Full force at least [N]."""
    lag: float
    """Distance between hand and part at which the spring has full force, share of the way."""
    speed: float
    """Full speed of the hand in position control [ways/s]."""


class SuccessSettings(StageConfig):
    """Success."""

    open_fraction: float
    """Share of the way that counts as open, if none is asked for."""
    fast: float
    """Faster is thrown [ways/s]."""
    calm: float
    """Slower is at rest [ways/s]."""
    forget: float
    """Share of the way by which a thrown part must come back."""
    deepest: float
    """Deepest contact that is no defect, share of the object's size."""
    escape: float
    """Farthest that a hold may get from its place at rest, in sizes of the object."""


class RewardSettings(StageConfig):
    """Weights of the dense reward."""

    open: float
    success: float
    reach: float
    reach_scale: float
    """How fast the reward for being near falls off [1/m]."""
    grip: float


class ResetSettings(StageConfig):
    """Start of an episode."""

    start_open: list[float]
    """Share of the way, drawn evenly."""
    tries: int
    """Draws until one has no interpenetration; then the part is shut."""
    depth: float
    """Deepest contact at the start, share of the object's size."""


class RandomizeSettings(StageConfig):
    """Ranges of `randomize`."""

    damping: list[float]
    """Factor, drawn evenly in its logarithm."""
    friction: list[float]
    """Factor of friction in joints and contacts, drawn evenly in its logarithm."""
    mass: list[float]
    """Factor of the masses of what moves, drawn evenly in its logarithm."""
    position: float
    """Of the object along x and y, either way [m]."""
    yaw: float
    """Of the object, either way [rad]."""
    robot_position: float
    """The same in front of a robot [m]."""
    robot_yaw: float
    """The same in front of a robot [rad]."""
    color: float
    """Of each channel, either way."""


class RobotSettings(StageConfig):
    """The robot of DrawerPull."""

    joint_step: float
    """Full action of a joint [rad]."""
    tool_step: float
    """Full action along an axis [m]."""
    turn_step: float
    """Full action about an axis [rad]."""
    finger_seconds: float
    """From open to closed with full action [s]."""
    lead: float
    """Farthest that the target of a servo is from its joint [rad]."""
    damping: float
    """Of the inverse kinematics."""
    posture: float
    """Share of the way to the posture of the planned grasp that is taken per step, where the tool does not mind."""
    start_noise: float
    """Of each joint at the start, either way [rad]."""
    servo_frequency: float
    """[Hz]."""
    armature: float
    """Inertia of motors over that of the links."""
    finger_inertia: float
    """[kg]."""
    grip_force: float
    """Of each finger at most [N]."""
    friction: float
    """Of the robot's surfaces."""
    touch_force: float
    """Of each finger at least for a grip [N]."""
    plan_seconds: float
    """Processor time for finding a place of the robot [s]."""


class PictureSettings(StageConfig):
    """Pictures."""

    width: int
    """[pixels]."""
    height: int
    """[pixels]."""
    distance: float
    """Of the camera from the middle, in radii of what is seen."""
    azimuth: float
    """Of the camera, from the direction in which the part opens [rad]."""
    elevation: float
    """Of the camera above the horizon [rad]."""
    field_of_view: float
    """Vertical [deg]."""


class EnvSettings(StageConfig):
    """All topics."""

    name: str
    time: TimeSettings
    object: ObjectSettings
    hand: HandSettings
    task: SuccessSettings
    reward: RewardSettings
    reset: ResetSettings
    randomize: RandomizeSettings
    robot: RobotSettings
    picture: PictureSettings


@cache
def load_settings(name_or_path: str | Path = "envs") -> EnvSettings:
    """Load a shipped file of settings by name, or any YAML file by path; see `kinematify.config.load_config`.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value does not fit.
    """
    return validated(EnvSettings, load_values(name_or_path), name_or_path)
