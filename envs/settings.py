"""Values of the environments, which nobody sets: one class per topic."""

from __future__ import annotations


class TimeSettings:
    """Steps."""

    step = 0.002  # where the servos of `validate` and grips by friction are stable
    """Of the engine [s]."""
    control_rate = 20.0  # what most benchmarks of manipulation use
    """Actions per second [1/s]."""

    substeps = max(1, round(1.0 / (control_rate * step)))
    """Steps of the engine per action."""
    control_step = substeps * step
    """Time between actions [s]."""


class ObjectSettings:
    """Settings of joints that files do not state."""

    damping_rate = 1.5  # a drawer that is let go comes to rest within a second or two
    """Damping of a joint without one, per inertia that it moves [1/s]."""
    friction_acceleration = 0.3  # gives a drawer of 5 kg 1.5 N, a light kitchen slide
    """Friction of a joint without one, per inertia that it moves [m/s^2 or rad/s^2]."""
    hold = 1.3  # what would start to move by its own weight stands still, as it was given
    """Friction of a joint without one, over what gravity pulls it away from rest with."""
    slots = 16  # furniture has up to 12
    """Joints in an observation; models with more get the next multiple."""


class HandSettings:
    """The hand of OpenPart."""

    opening = 0.1
    """Largest width of a hold that is looked for [m]."""
    seconds = 1.5  # people open doors and drawers in one to two seconds
    """Time in which the hand can open the part from rest to rest [s]."""
    margin = 3.0  # what is needed stays in the middle of the range of actions
    """Full force over what that needs."""
    least_force = 0.05  # the lightest lids and clock hands need less
    """Full force at least [N]."""
    lag = 0.08  # with this share of the way between hand and part the spring pulls with full force
    """Distance between hand and part at which the spring has full force, share of the way."""
    speed = 1.2  # below `task.fast`
    """Full speed of the hand in position control [ways/s]."""


class SuccessSettings:
    """Success."""

    open_fraction = 0.9  # the share that RoboCasa and the docstring of ManiSkill ask for
    """Share of the way that counts as open, if none is asked for."""
    fast = 1.5  # a person pulls with 0.7, what is thrown or let slam has 2 and more
    """Faster is thrown [ways/s]."""
    calm = 0.1  # hardly seen to move
    """Slower is at rest [ways/s]."""
    forget = 0.1  # what was slammed must come back by this share of the way before it counts again
    """Share of the way by which a thrown part must come back."""
    deepest = 0.05  # convex pieces are never this far in each other
    """Deepest contact that is no defect, share of the object's size."""
    escape = 3.0  # nothing that hangs on joints gets as far
    """Farthest that a hold may get from its place at rest, in sizes of the object."""


class RewardSettings:
    """Weights of the dense reward."""

    open = 0.5
    """Of the share of the way that is open."""
    success = 0.5
    """Of success."""
    reach = 0.15
    """Of being near the handle, in DrawerPull, which scales the others so that the sum stays 1."""
    reach_scale = 5.0  # 0.2 m away half of it is left
    """How fast the reward for being near falls off [1/m]."""
    grip = 0.15
    """Of holding the handle, in DrawerPull as well."""


class ResetSettings:
    """Start of an episode."""

    start_open = (0.0, 0.05)  # a drawer is never shut to the millimetre
    """Share of the way, drawn evenly."""
    tries = 20
    """Draws until one has no interpenetration; then the part is shut."""
    depth = 0.002  # contacts that are deeper count as interpenetration
    """Deepest contact at the start, share of the object's size."""


class RandomizeSettings:
    """Ranges of `randomize`."""

    damping = (0.5, 2.0)
    """Factor, drawn evenly in its logarithm."""
    friction = (0.5, 2.0)
    """Factor of friction in joints and contacts, drawn evenly in its logarithm."""
    mass = (0.8, 1.25)  # what lies in a drawer
    """Factor of the masses of what moves, drawn evenly in its logarithm."""
    position = 0.05
    """Of the object along x and y, either way [m]."""
    yaw = 0.35  # 20 deg
    """Of the object, either way [rad]."""
    robot_position = 0.02  # what is out of an arm's reach teaches nothing
    """The same in front of a robot [m]."""
    robot_yaw = 0.08
    """The same in front of a robot [rad]."""
    color = 0.25
    """Of each channel, either way."""


class RobotSettings:
    """The robot of DrawerPull."""

    joint_step = 0.08  # 20 steps a second make 1.6 rad/s, which the arm's servos follow
    """Full action of a joint [rad]."""
    tool_step = 0.02  # 0.4 m/s
    """Full action along an axis [m]."""
    turn_step = 0.1
    """Full action about an axis [rad]."""
    finger_seconds = 0.4
    """From open to closed with full action [s]."""
    lead = 0.12  # targets of servos stay so near to the joints that nothing is wound up
    """Farthest that the target of a servo is from its joint [rad]."""
    damping = 0.05
    """Of the inverse kinematics."""
    posture = 0.1  # an elbow that wanders off ends where the wrist has no way on
    """Share of the way to the posture of the planned grasp that is taken per step, where the tool does not mind."""
    start_noise = 0.02
    """Of each joint at the start, either way [rad]."""
    servo_frequency = 8.0
    """[Hz]."""
    armature = 0.1
    """Inertia of motors over that of the links."""
    finger_inertia = 1.0
    """[kg]."""
    grip_force = 60.0  # grippers of research arms exert 40 to 140 N
    """Of each finger at most [N]."""
    friction = 1.0  # rubber on varnish
    """Of the robot's surfaces."""
    touch_force = 0.5  # less is no grip
    """Of each finger at least for a grip [N]."""
    plan_seconds = 20.0  # the place is kept for the next time
    """Processor time for finding a place of the robot [s]."""


class PictureSettings:
    """Pictures."""

    width = 480
    """[pixels]."""
    height = 360
    """[pixels]."""
    distance = 2.4  # all of it is seen, opened too
    """Of the camera from the middle, in radii of what is seen."""
    azimuth = 0.6  # to the side of the way out, so that it is not seen end on
    """Of the camera, from the direction in which the part opens [rad]."""
    elevation = 0.35
    """Of the camera above the horizon [rad]."""
    field_of_view = 45.0
    """Vertical [deg]."""


class EnvSettings:
    """All topics."""

    time = TimeSettings()
    object = ObjectSettings()
    hand = HandSettings()
    task = SuccessSettings()
    reward = RewardSettings()
    reset = ResetSettings()
    randomize = RandomizeSettings()
    robot = RobotSettings()
    picture = PictureSettings()


SETTINGS = EnvSettings()
