"""The robot that uses the object: the project's own arm, or a user's robot with its gripper found by geometry.

A user's gripper may point anywhere in its own link frame. `user_robot` therefore writes a copy of the file with one
more link, whose frame is the grasp frame of all planning: +z approaches, +y closes, origin between the finger tips.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.geometry.scene import judged_shapes
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Joint, Link, forward_kinematics, joint_values, rest_configuration, rigid_groups
from kinematify.robot.transforms import transformed
from kinematify.robot.vectors import referenced
from kinematify.robot.write import write_robot

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.manipulation.plan_request import TaskRequest
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

ROBOT_FILE = "robot.urdf"
GRASP_LINK = "kinematify_grasp_frame"
"""Link that is added to a user's robot."""

_TRAVEL = 0.05  # of each finger of the built-in arm [m]
_TIP_DEPTH = 0.01  # a finger holds with the last centimetre; the origin stands so far behind its end [m]
_TIP_SHARE = 0.35  # of a finger's length: its end, where the gap between the fingers is measured
_NARROW = 0.004  # a gripper that opens less holds nothing [m]


@dataclass(frozen=True, kw_only=True)
class TaskRobot:
    """A robot as planning and execution need it; joints that are in neither list stay at rest."""

    urdf: Path
    """Absolute; every mesh path in it is absolute too."""
    tool: str
    """Link whose frame is the grasp frame: +z approach direction, +y closing direction of the fingers, origin between
    the finger tips."""
    arm_joints: tuple[str, ...]
    """Joints that lead (no followers) between the root and the tool, from the root on."""
    finger_joints: tuple[str, ...]
    """Joints of the fingers, followers included."""
    opening: float
    """Largest gap between the pads [m]."""
    fingers_open: tuple[float, ...]
    """Values of `finger_joints` with the fingers apart [rad or m]."""
    fingers_closed: tuple[float, ...]
    """The same with the pads together; in between, the gap is taken to grow evenly."""
    home: tuple[float, ...]
    """Values of `arm_joints` from which a reach starts [rad or m]."""

    def finger_values(self, share: float) -> FloatArray:
        """Values of `finger_joints`, 0 with the pads together, 1 apart, shape (fingers,)."""
        closed, opened = np.array(self.fingers_closed), np.array(self.fingers_open)
        return np.asarray(closed + share * (opened - closed))

    def fingers_at(self, gap: float) -> FloatArray:
        """The same with the pads at a distance [m]."""
        return self.finger_values(min(max(gap / self.opening, 0.0), 1.0))


def robot_of(task: TaskRequest, folder: Path) -> TaskRobot:
    """Describe the robot of a task; a user's is written into an existing folder.

    Raises:
        InputError: There is no such robot, tool or gripper.
        OSError: The folder cannot be written.
    """
    if task.robot is None:
        return builtin_robot()
    if task.tool is None:
        raise InputError(
            f"--robot {task.robot} needs --tool with the link that carries the fingers, e.g. --tool gripper_link."
        )
    return user_robot(task.robot, task.tool, task.gripper, folder=folder, package_dirs=task.package_dirs)


def builtin_robot() -> TaskRobot:
    """Describe the project's own arm: seven turning joints and a parallel gripper, of boxes and cylinders only.

    Its proportions and limits are those of common research arms with a reach of 0.85 m. Collision shapes leave gaps of
    a few millimetres at the joints, so that neighbours touch in no configuration and no pair has to be ignored.
    """
    return TaskRobot(
        urdf=Path(__file__).with_name("arm.urdf").resolve(),
        tool="tool",
        arm_joints=tuple(f"joint_{number}" for number in range(1, 8)),
        finger_joints=("left_finger_joint", "right_finger_joint"),
        opening=2.0 * _TRAVEL,
        fingers_open=(_TRAVEL, _TRAVEL),
        fingers_closed=(0.0, 0.0),
        home=(0.0, -0.7, 0.0, -2.3, 0.0, 1.6, 0.0),  # folded over its base, hand pointing down
    )


def user_robot(
    urdf: Path,
    tool: str,
    gripper: Sequence[str] = (),
    *,
    folder: Path,
    package_dirs: Sequence[Path] = (),
) -> TaskRobot:
    """Describe a user's robot and write a copy with the grasp frame as a link of its own.

    Args:
        urdf: The robot.
        tool: Link of the gripper: the one that carries the fingers, or a frame between them.
        gripper: Joints of the fingers; if none are given, those that hang on the tool link or on what it is fixed to.
        folder: Existing folder for the copy.
        package_dirs: Where packages lie (``package://``).

    Raises:
        InputError: The robot cannot be read, has no such link or joints, or its fingers do not open.
        OSError: The folder cannot be written.
    """
    robot = read_robot(urdf, package_dirs=package_dirs)
    if tool not in robot.link_by_name:
        raise InputError(
            f"The robot {urdf} has no link {tool!r}, which --tool names. Its links are "
            f"{', '.join(robot.link_by_name)}. Name the link that carries the fingers."
        )
    fingers = named_fingers(robot, urdf, gripper) if gripper else found_fingers(robot, tool)
    if not fingers:
        raise InputError(
            f"Nothing moves on the link {tool!r} of {urdf}, so there are no fingers that could hold a handle. Name the "
            "link that carries the fingers with --tool, or their joints with --gripper."
        )
    chain = arm_chain(robot, tool)
    if not chain:
        raise InputError(
            f"No movable joint leads from the root of {urdf} to the link {tool!r}: there is no arm. Name the link at "
            "the end of the arm with --tool."
        )
    hand = _Hand(robot=robot, tool=tool, fingers=fingers)
    frame, opening = hand.measured(urdf)
    closed = hand.meeting(frame, opening)
    path = folder.resolve() / ROBOT_FILE
    write_robot(_with_grasp_frame(robot, tool, frame), path)
    rest = rest_configuration(robot)
    return TaskRobot(
        urdf=path,
        tool=GRASP_LINK,
        arm_joints=chain,
        finger_joints=tuple(joint.name for joint in fingers),
        opening=opening,
        fingers_open=tuple(hand.apart[joint.name] for joint in fingers),
        fingers_closed=tuple(closed[joint.name] for joint in fingers),
        home=tuple(rest[name] for name in chain),
    )


def hand_links(robot: Robot, task: TaskRobot) -> frozenset[str]:
    """Links that may touch what is held: the body of the tool, what carries the fingers, and all that hangs on it."""
    fingers = [robot.joint_by_name[name] for name in task.finger_joints]
    tops = {task.tool, *(joint.parent for joint in fingers)}
    links = [link for group in rigid_groups(robot) if tops & set(group.links) for link in group.links]
    for link in links:
        links += [joint.child for joint in robot.joints_below[link] if joint.kind is not JointType.FIXED]
    return frozenset(links)


def effort_limits(robot: Robot, task: TaskRobot, usual: float) -> FloatArray:
    """Effort limits of the arm joints, `usual` for those that state none [N m or N], shape (dof,)."""
    efforts = [robot.joint_by_name[name].effort for name in task.arm_joints]
    return np.array([effort if effort and effort > 0.0 else usual for effort in efforts])


def arm_chain(robot: Robot, tool: str) -> tuple[str, ...]:
    """Joints that lead (no followers) between the root and a link, from the root on."""
    above, link, found = robot.joint_above, tool, []
    while link in above:
        joint = above[link]
        if joint.leads:
            found.append(joint.name)
        link = joint.parent
    return tuple(reversed(found))


def named_fingers(robot: Robot, urdf: Path, names: Sequence[str]) -> tuple[Joint, ...]:
    """Return the finger joints that a user named, and their followers.

    Raises:
        InputError: The robot has no such movable joint.
    """
    movable = {joint.name: joint for joint in robot.joints if joint.kind is not JointType.FIXED}
    for name in names:
        if name not in movable:
            raise InputError(
                f"The robot {urdf} has no movable joint {name!r}, which --gripper names. Its movable joints are "
                f"{', '.join(movable)}. Name the joints of the fingers, separated by commas."
            )
    followers = [joint for joint in movable.values() if joint.mimic is not None and joint.mimic.joint in names]
    return tuple(dict.fromkeys([*(movable[name] for name in names), *followers]))


def found_fingers(robot: Robot, tool: str) -> tuple[Joint, ...]:
    """Return the first movable joints below a link, or below the body that it is fixed to."""
    top = tool
    while top in robot.joint_above and robot.joint_above[top].kind is JointType.FIXED:
        top = robot.joint_above[top].parent
    found: list[Joint] = []
    frontier = [top]
    for link in frontier:
        for joint in robot.joints_below[link]:
            if joint.kind is JointType.FIXED:
                frontier.append(joint.child)
            else:
                found.append(joint)
    return tuple(found)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Hand:
    """The fingers of a gripper and where their surfaces are, in the frame of the tool link."""

    robot: Robot
    tool: str
    fingers: tuple[Joint, ...]

    @property
    def apart(self) -> dict[str, float]:
        """Values of the finger joints that bring the fingers farthest from each other [rad or m]."""
        return self._ends()[1]

    @property
    def together(self) -> dict[str, float]:
        """The opposite ends of the same joints [rad or m]."""
        return self._ends()[0]

    def measured(self, urdf: Path) -> tuple[FloatArray, float]:
        """Grasp frame in the tool frame, shape (4, 4), and the gap between the open fingers [m].

        Raises:
            InputError: The fingers have no geometry or do not open.
        """
        points = self._surfaces(self.apart)
        if len(points) < 2 or any(not len(part) for part in points):
            raise InputError(
                f"The gripper at {self.tool!r} of {urdf} needs two fingers with geometry, and "
                f"{', '.join(joint.name for joint in self.fingers)} move {sum(map(bool, map(len, points)))}. Name the "
                "joints of two opposite fingers with --gripper."
            )
        first, second = points[0], points[1]
        closing = self._closing(first, second)
        approach = self._approach(np.concatenate([first, second]), closing)
        frame = np.eye(4)
        frame[:3, :3] = np.column_stack([np.cross(closing, approach), closing, approach])
        gap, between = self._gap(points, closing, approach)
        if gap < _NARROW:
            raise InputError(
                f"The fingers at {self.tool!r} of {urdf} stand {max(gap, 0.0) * 1e3:.1f} mm apart when open, which "
                "holds nothing. Check the limits of their joints, or name the joints of two opposite fingers with "
                "--gripper."
            )
        both = np.concatenate([first, second])
        side = frame[:3, 0]
        middle = 0.5 * ((both @ side).min() + (both @ side).max())
        reach = float((both @ approach).max()) - _TIP_DEPTH
        frame[:3, 3] = middle * side + between * closing + reach * approach
        return frame, gap

    def meeting(self, frame: FloatArray, opening: float) -> dict[str, float]:
        """Values of the finger joints that bring the pads together, short of where they would go into each other.

        Args:
            frame: Grasp frame in the tool frame, shape (4, 4).
            opening: Gap between the open fingers [m].
        """
        gap = self._gap(self._surfaces(self.together), frame[:3, 1], frame[:3, 2])[0]
        share = max(0.0, -gap) / max(opening - gap, 1e-9)
        return {name: value + share * (self.apart[name] - value) for name, value in self.together.items()}

    def _gap(self, points: Sequence[FloatArray], closing: FloatArray, approach: FloatArray) -> tuple[float, float]:
        """Gap between the ends of the first two fingers and the middle of it, along the closing direction [m]."""
        low, high = (_end(part, part @ approach) @ closing for part in points[:2])
        if self._parted() @ closing > 0.0:
            low, high = high, low
        return float(high.min() - low.max()), 0.5 * float(high.min() + low.max())

    def _parted(self) -> FloatArray:
        """From the middle of the second open finger to that of the first one, tool frame [m], shape (3,)."""
        first, second = self._surfaces(self.apart)[:2]
        return np.asarray(first.mean(axis=0) - second.mean(axis=0))

    def _ends(self) -> tuple[dict[str, float], dict[str, float]]:
        """Values of the finger joints closed and open, leaders taken to the end that parts the fingers."""
        robot = self.robot
        leaders = list(dict.fromkeys(j.name if j.mimic is None else j.mimic.joint for j in self.fingers))
        ends = {name: self._bounds(name) for name in leaders}
        rest = {name: min(max(0.0, low), high) for name, (low, high) in ends.items()}
        apart, together = {}, {}
        for name, (low, high) in ends.items():
            spread = [self._spread({**rest, name: value}) for value in (low, high)]
            apart[name], together[name] = (low, high) if spread[0] > spread[1] else (high, low)
        names = [joint.name for joint in self.fingers]
        opened, closed = joint_values(robot, apart), joint_values(robot, together)
        return {name: closed[name] for name in names}, {name: opened[name] for name in names}

    def _bounds(self, name: str) -> tuple[float, float]:
        joint = self.robot.joint_by_name[name]
        turn = 0.25 * np.pi  # a finger without limits: an eighth of a turn either way
        return (joint.lower, joint.upper) if np.isfinite(joint.upper - joint.lower) else (-turn, turn)

    def _spread(self, q: dict[str, float]) -> float:
        """Distance of the middles of the first two fingers [m]."""
        points = [part for part in self._surfaces(q) if len(part)]
        return float(np.linalg.norm(points[0].mean(axis=0) - points[1].mean(axis=0))) if len(points) > 1 else 0.0

    def _surfaces(self, q: dict[str, float]) -> list[FloatArray]:
        """Corners of every finger in the tool frame [m], shape (n, 3) each."""
        poses, found = self._in_tool(q), []
        for finger in self.fingers:
            links = [finger.child]
            for link in links:
                links += [joint.child for joint in self.robot.joints_below[link] if joint not in self.fingers]
            found.append(self._corners(links, poses))
        return found

    def _in_tool(self, q: dict[str, float]) -> dict[str, FloatArray]:
        """Pose of every link in the tool frame, shape (4, 4) each."""
        poses = forward_kinematics(self.robot, {**rest_configuration(self.robot), **q})
        T_tool_world = np.asarray(np.linalg.inv(poses[self.tool]), dtype=np.float64)
        return {name: T_tool_world @ T for name, T in poses.items()}

    def _corners(self, links: Sequence[str], poses: dict[str, FloatArray]) -> FloatArray:
        """Corners of links in the tool frame [m], shape (n, 3)."""
        found = [np.empty((0, 3))]
        for link in links:
            declared, T = self.robot.link_by_name[link], poses[link]
            for shape in judged_shapes(declared):
                used = referenced(shape.mesh.vertices, shape.mesh.faces)
                found.append(transformed(used, T))
        return np.concatenate(found)

    def _closing(self, first: FloatArray, second: FloatArray) -> FloatArray:
        """Unit direction in which the fingers move against each other, tool frame, shape (3,)."""
        here, there = self._surfaces(self.apart), self._surfaces(self.together)
        motion = (here[0].mean(axis=0) - there[0].mean(axis=0)) - (here[1].mean(axis=0) - there[1].mean(axis=0))
        between = first.mean(axis=0) - second.mean(axis=0)
        direction = motion if float(np.linalg.norm(motion)) > 1e-6 else between
        return np.asarray(direction / np.linalg.norm(direction))

    def _approach(self, fingers: FloatArray, closing: FloatArray) -> FloatArray:
        """Unit direction from what carries the fingers to their tips, tool frame, shape (3,)."""
        carrier = self._carrier(self._in_tool(self.apart))
        away = fingers.mean(axis=0) - carrier
        away = away - (away @ closing) * closing
        # Fingers are longer than they are wide: their long side across the closing direction is the approach.
        centred = fingers - fingers.mean(axis=0)
        centred = centred - np.outer(centred @ closing, closing)
        axes = np.linalg.svd(centred, full_matrices=False)[2]
        candidates = [axis for axis in axes if abs(float(axis @ closing)) < 0.5][:2]
        best = max(candidates, key=lambda axis: abs(float(axis @ away)))
        best = best - (best @ closing) * closing
        return np.asarray(best / np.linalg.norm(best) * (1.0 if float(best @ away) >= 0.0 else -1.0))

    def _carrier(self, poses: dict[str, FloatArray]) -> FloatArray:
        """Middle of the body that the fingers hang on, tool frame [m], shape (3,)."""
        link = self.fingers[0].parent
        points = self._corners([link], poses)
        while not len(points) and link in self.robot.joint_above:
            link = self.robot.joint_above[link].parent
            points = self._corners([link], poses)
        if len(points):
            return np.asarray(0.5 * (points.min(axis=0) + points.max(axis=0)))
        return np.asarray(poses[self.fingers[0].parent][:3, 3])


def _end(points: FloatArray, along: FloatArray) -> FloatArray:
    """Return those of the points (n, 3) that are farthest along a direction."""
    return np.asarray(points[along >= along.max() - _TIP_SHARE * np.ptp(along)])


def _with_grasp_frame(robot: Robot, tool: str, T_tool_grasp: FloatArray) -> Robot:
    """The robot with the grasp frame as a link of its own."""
    joint = Joint(
        name=f"{GRASP_LINK}_joint", kind=JointType.FIXED, parent=tool, child=GRASP_LINK, T_parent_child=T_tool_grasp
    )
    return replace(robot, links=(*robot.links, Link(name=GRASP_LINK)), joints=(*robot.joints, joint))
