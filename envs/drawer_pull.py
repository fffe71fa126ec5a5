"""DrawerPull: an arm with a gripper reaches for a drawer, grips it and pulls it open."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.spaces import Box
from gymnasium.utils import EzPickle

from kinematify.envs.articulated_object import AUTO, find_target
from kinematify.envs.base import OpeningEnv, made, one_of
from kinematify.envs.goal import CONTROL_STEP, OPEN_BOUND, PLACE_BOUND, SPEED_BOUND, SUBSTEPS
from kinematify.envs.robot_plan import env_robot, robot_plan
from kinematify.envs.worlds import Servos, arm_facts
from kinematify.manipulation.kinematics import damped_step
from kinematify.manipulation.manipulator import hand_links
from kinematify.manipulation.robot_place import column_mesh
from kinematify.render.environment_picture import Piece
from kinematify.render.picture import ARM, HAND, STAND
from kinematify.simulation.engine import depth_of
from kinematify.simulation.world import ROBOT

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from gymnasium import spaces
    from numpy.typing import NDArray

    from kinematify.envs.articulated_object import Target
    from kinematify.envs.robot_plan import EnvRobot, RobotPlan
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.world import ObjectState

    Space = spaces.Space[NDArray[np.float32]]

TOOL, JOINT = "tool", "joint"
ARM_BOUND = 7.0
"""Ends of observed joint values [rad or m]."""
REACH_REWARD, GRIP_REWARD = 0.15, 0.15
"""Weights of being near the handle and of holding it, which scale the others so that the sum stays 1."""
REACH_SCALE = 5.0  # 0.2 m away half of it is left
"""How fast the reward for being near falls off [1/m]."""
JOINT_STEP = 0.08  # 20 steps a second make 1.6 rad/s, which the arm's servos follow
"""Full action of a joint [rad]."""
TOOL_STEP, TURN_STEP = 0.02, 0.1  # 0.4 m/s
"""Full action along [m] and about [rad] an axis."""
FINGER_SECONDS = 0.4
"""From open to closed with full action [s]."""
POSTURE = 0.1  # an elbow that wanders off ends where the wrist has no way on
"""Share of the way to the posture of the planned grasp that is taken per step, where the tool does not mind."""
START_NOISE = 0.02
"""Of each joint at the start, either way [rad]."""
TOUCH_FORCE = 0.5  # less is no grip
"""Of each finger at least for a grip [N]."""
_LEAD = 0.12  # targets of servos stay so near to the joints that nothing is wound up [rad]
_DAMPING = 0.05  # of the inverse kinematics
_ELBOW = 0.5  # of the reach: so high above the shoulder an elbow gets


class DrawerPullEnv(OpeningEnv):
    """Reach for a drawer with a robot's arm, grip it, pull it open, and leave it open and at rest.

    The arm is the package's own, with seven joints and a parallel gripper, or a robot of yours. It stands where a
    plan of `kinematify validate --task pull` lets it open the joint. Servos move its joints with the effort of the
    file; what the fingers hold, they hold by contact and friction, on the convex pieces of the object. Any joint can
    be asked for; ``auto`` takes a drawer if there is one. Episodes are truncated after 240 steps of 0.05 s.

    ## Action space

    `Box(-1, 1, (7,), float32)` with ``control="tool"``, `Box(-1, 1, (8,), float32)` with ``control="joint"`` for an
    arm of 7 joints:

    | tool | joint | what |
    |---|---|---|
    | 0 to 2 | | motion of the tool along the world's axes, in shares of 0.02 m per step |
    | 3 to 5 | | turn of the tool about the world's axes, in shares of 0.1 rad per step |
    | | 0 to 6 | motion of each joint, in shares of 0.08 rad per step |
    | 6 | 7 | wanted opening of the gripper, -1 closed, 1 open, in 0.4 s at the fastest |

    What freedom tool control leaves, 0.1 of it per step takes the arm towards its posture at the planned grasp.

    ## Observation space

    `Box((86,), float32)` for an arm of 7 joints and models of up to 16 joints:

    | index | what | lowest | highest | unit |
    |---|---|---|---|---|
    | 0 to 15 | where each joint is in its range; slot 0 is the one that is opened, 0 closed, 1 open | -2 | 2 | 1 |
    | 16 to 31 | their speeds, in ranges per second | -20 | 20 | 1/s |
    | 32 to 47 | 1 for slots with a joint | 0 | 1 | 1 |
    | 48 to 54 | joints of the arm | -7 | 7 | rad |
    | 55 to 61 | their speeds | -20 | 20 | rad/s |
    | 62 to 62 | gap between the pads, share of the widest | -2 | 2 | 1 |
    | 63 to 65 | tool, from the robot's root link, world axes | -10 | 10 | m |
    | 66 to 68 | direction in which the tool approaches | -1 | 1 | 1 |
    | 69 to 71 | direction in which its fingers close | -1 | 1 | 1 |
    | 72 to 74 | from the tool to the hold | -10 | 10 | m |
    | 75 to 77 | direction in which the planned grasp approaches | -1 | 1 | 1 |
    | 78 to 80 | direction in which its fingers close | -1 | 1 | 1 |
    | 81 to 83 | unit direction in which the hold moves when the part opens | -1 | 1 | 1 |
    | 84 to 85 | force of each finger on the part, share of 60 N | 0 | 2 | 1 |

    ## Reward

    Dense, in [0, 1]: 0.15 times 1 - tanh(5 d) for a distance of d m between tool and hold; 0.15 while both fingers
    press on the part with at least 0.5 N; 0.35 times the share of `open_fraction` that is open, and 0.35 for success,
    both as in `OpenPartEnv`: nothing is paid for a part that was thrown. Sparse (``reward="sparse"``): 1 for success,
    else 0.

    ## Success, the end, start, info and randomisation

    As in `OpenPartEnv`. The arm starts in the posture of its plan, each joint off by up to 0.02 rad, fingers apart.
    The object is moved by ``pose`` by up to 0.02 m along x and y, and 0.08 rad. ``max_penetration`` counts the robot
    too. Info also has ``grip``: whether both fingers press on the part.
    """

    _with_robot = True
    _helping = REACH_REWARD + GRIP_REWARD

    def __init__(
        self,
        model: str | Path | None = None,
        *,
        control: str = TOOL,
        robot: str | Path | None = None,
        tool: str | None = None,
        **keywords: Any,
    ) -> None:
        """Make the environment.

        Args:
            model: As for `OpeningEnv`.
            control: ``tool`` or ``joint``.
            robot: URDF of a robot with a gripper of two fingers; the package's own arm if None.
            tool: Link of the robot that carries the fingers.
            keywords: Of `OpeningEnv`.

        Raises:
            InputError: A keyword is impossible, the model cannot be used, or the robot cannot open the joint.
            EnvironmentFault: The validation itself failed.
        """
        EzPickle.__init__(self, model, control=control, robot=robot, tool=tool, **keywords)
        one_of("control", control, (TOOL, JOINT))
        self.control, self._robot_words = control, (None if robot is None else str(robot), tool)
        super().__init__(model, **keywords)
        self._make_world()
        self._dof = len(self.robot.robot.arm_joints)
        joints = self.robot.scene.mechanism.joints
        self._driven = [joints.index(name) for name in (*self.robot.robot.arm_joints, *self.robot.robot.finger_joints)]
        self.action_space: Space = Box(-1.0, 1.0, (7 if control == TOOL else self._dof + 1,), np.float32)
        self.observation_space: Space = self._space()

    def _choose(self, joint: str) -> str:
        if joint == AUTO and self.articulated_object.suggested == AUTO and self.articulated_object.drawers:
            return self.articulated_object.drawers[0]
        return super()._choose(joint)

    def _targeted(self, joint: str) -> Target:
        """Plan with the robot; the hold is where the plan grips."""
        found = find_target(self.articulated_object, joint)
        self.robot: EnvRobot = env_robot(self.articulated_object, *self._robot_words)
        self.plan: RobotPlan = robot_plan(self.articulated_object, joint, self.robot)
        self.T_world_root = self.plan.T_world_object
        return replace(found, point=self.plan.T_link_tool[:3, 3])

    def _make_world(self) -> None:
        self.world = arm_facts(self.articulated_object, self.target, self.robot, self.plan).opened(self.engine)

    def _place(self, leaders: FloatArray) -> float:
        for name, value in self.plan.first.items():
            leaders[self.articulated_object.leader(name)] = value
        arm = self.robot.arm
        drawn = self.plan.reach[0] + self.np_random.uniform(-START_NOISE, START_NOISE, len(self.plan.reach[0]))
        self.wanted = np.clip(drawn, arm.lower, arm.upper)
        self._gap = 1.0
        values = self.articulated_object.scene.mechanism.all_values(leaders[None])[0]
        self.world.place(values, self._commands())
        return depth_of(self.world)

    def _commands(self) -> FloatArray:
        """Commands of the servos: arm, then fingers."""
        return np.concatenate([self.wanted, self.robot.robot.finger_values(self._gap)])

    def _act(self, action: NDArray[np.float32]) -> None:
        self._command(np.clip(np.asarray(action, dtype=np.float64), -1.0, 1.0))
        self.world.command(self._commands())
        self.world.step(SUBSTEPS)

    def _command(self, action: FloatArray) -> None:
        """Move the targets of the servos: never far from where the joints are, so that nothing winds up."""
        arm = self.robot.arm
        step = JOINT_STEP * action[:-1] if self.control == JOINT else self._joint_step(action[:6])
        now = self.world.state(robot=True)[0][self._driven[: self._dof]]
        wanted = np.clip(self.wanted + step, now - _LEAD, now + _LEAD)
        self.wanted = np.clip(wanted, arm.lower, arm.upper)
        rate = CONTROL_STEP / FINGER_SECONDS
        self._gap += float(np.clip(0.5 * (action[-1] + 1.0) - self._gap, -rate, rate))

    def _joint_step(self, action: FloatArray) -> FloatArray:
        """Joint motion that moves the tool along and about the world's axes, shape (dof,)."""
        arm = self.robot.arm
        turn = (self.plan.T_world_base[:3, :3] @ arm.pose(self.wanted)[:3, :3]).T
        twist = np.concatenate([turn @ (TOOL_STEP * action[:3]), turn @ (TURN_STEP * action[3:])])
        jacobian, wish = arm.jacobian(self.wanted), POSTURE * (self.plan.pull[0] - self.wanted)
        return np.asarray(wish + damped_step(jacobian, twist - jacobian @ wish, _DAMPING))

    def _helped(self) -> float:
        """Reward for being near and for gripping."""
        near = 1.0 - float(np.tanh(REACH_SCALE * self._distance))
        return REACH_REWARD * near + GRIP_REWARD * self._grips

    def _info(self, *, is_success: bool, escaped: bool) -> dict[str, Any]:
        return {**super()._info(is_success=is_success, escaped=escaped), "grip": self._grips}

    def _observe(self, reading: ObjectState) -> NDArray[np.float32]:
        found = np.zeros(self.observation_space.shape or ())
        self.goal.fill_joints(reading, found)
        poses, touch = self.world.link_poses(), self.world.touch()
        values, speeds = (part[self._driven] for part in self.world.state(robot=True))
        tool = poses[ROBOT + self.robot.robot.tool]
        planned = poses[self.target.link][:3, :3] @ self.plan.T_link_tool[:3, :3]
        away = reading.hold - tool[:3, 3]
        self._distance = float(np.sqrt(away @ away))
        self._grips = bool((touch >= TOUCH_FORCE).all())
        found[3 * self.goal.slots :] = np.concatenate([
            values[: self._dof], speeds[: self._dof], [self._opening(values[self._dof :])],
            tool[:3, 3] - self.plan.T_world_base[:3, 3], tool[:3, 2], tool[:3, 1], away, planned[:, 2], planned[:, 1],
            self.goal.direction(reading), touch / Servos.grip_force,
        ])  # fmt: skip
        box = self.observation_space
        assert isinstance(box, Box)
        return np.minimum(np.maximum(found, box.low), box.high).astype(np.float32)

    def _opening(self, fingers: FloatArray) -> float:
        """Gap between the pads, share of the widest."""
        closed, opened = self.robot.robot.finger_values(0.0), self.robot.robot.finger_values(1.0)
        return float(np.mean((fingers - closed) / (opened - closed)))

    def _space(self) -> Space:
        slots, dof, count = self.goal.slots, self._dof, len(self.robot.robot.finger_joints)
        bounds = [
            OPEN_BOUND,
            SPEED_BOUND,
            1.0,
            ARM_BOUND,
            SPEED_BOUND,
            OPEN_BOUND,
            PLACE_BOUND,
            1.0,
            PLACE_BOUND,
            1.0,
            2.0,
        ]
        high = np.repeat(bounds, [slots, slots, slots, dof, dof, 1, 3, 6, 3, 9, count]).astype(np.float32)
        low = -high
        low[2 * slots : 3 * slots] = low[len(low) - count :] = 0.0
        return Box(low, high, dtype=np.float32)

    def _pieces(self) -> Sequence[Piece]:
        hand = hand_links(self.robot.arm.declared, self.robot.robot)
        robot = [
            Piece(
                link=ROBOT + link.name, vertices=mesh.vertices, faces=mesh.faces,
                color=HAND if link.name in hand else ARM,
            )
            for link in self.robot.arm.declared.links
            for mesh in link.meshes
            if len(mesh.faces)
        ]  # fmt: skip
        return [*super()._pieces(), *robot, *self._column()]

    def _beside(self) -> Sequence[FloatArray]:
        base = self.plan.T_world_base[:3, 3]
        shoulder = base + np.array([0.0, 0.0, float(self.robot.arm.shoulder[2]) + _ELBOW * self.robot.arm.reach])
        return (np.stack([base * [1.0, 1.0, 0.0], shoulder]),)

    def _column(self) -> Sequence[Piece]:
        """Return what the robot stands on, if it does not stand on the floor."""
        found = column_mesh(float(self.plan.T_world_base[2, 3]))
        if found is None:
            return ()
        root = ROBOT + self.robot.scene.model.root
        return (Piece(link=root, vertices=found[0], faces=found[1], color=STAND),)


make_drawer_pull = partial(made, DrawerPullEnv)
"""What `gymnasium.make` calls; keywords are those of `DrawerPullEnv`, `observation` and `pixel_size` (`made`)."""
