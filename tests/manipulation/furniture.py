"""Furniture of boxes at its real size, and motions of the project's own arm that open it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin

from kinematify.config.validation import load_settings
from kinematify.geometry.scene import read_scene
from kinematify.manipulation.execute import Motion
from kinematify.manipulation.grasp import Grasp, search_grasps
from kinematify.manipulation.manipulator import TaskRobot, builtin_robot
from kinematify.robot.read import read_robot

SETTINGS = load_settings()


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> str:
    """A box of a link, both visual and collision geometry."""
    shape = f'<origin xyz="{" ".join(map(str, at))}"/><geometry><box size="{" ".join(map(str, size))}"/></geometry>'
    return f"<visual>{shape}</visual>\n<collision>{shape}</collision>\n"


def carcass(width: float, depth: float, height: float) -> str:
    """Five boards that are open towards -x; the floor is at z = 0."""
    board, half = 0.018, 0.5 * width
    return "".join((
        box((board, width, height), (0.5 * depth, 0.0, 0.5 * height)),
        box((depth, board, height), (0.0, -half, 0.5 * height)),
        box((depth, board, height), (0.0, half, 0.5 * height)),
        box((depth, width - board, board), (0.0, 0.0, 0.5 * board)),
        box((depth, width - board, board), (0.0, 0.0, height - 0.5 * board)),
    ))  # fmt: skip


def write_drawer_cabinet(path: Path, *, handle: float = 0.012, axis: str = "-1 0 0", scale: float = 1.0) -> Path:
    """A cabinet of 0.4 x 0.4 x 0.6 m with one drawer at 0.45 m, whose bar handle is `handle` thick [m]."""
    front = box((0.018, 0.35, 0.16), (-0.21, 0.0, 0.0))
    tray = box((0.34, 0.32, 0.01), (-0.03, 0.0, -0.06)) + box((0.34, 0.01, 0.12), (-0.03, 0.155, 0.0))
    bar = box((handle, 0.14, handle), (-0.255, 0.0, 0.02))
    posts = box((0.036, 0.01, 0.01), (-0.237, 0.06, 0.02)) + box((0.036, 0.01, 0.01), (-0.237, -0.06, 0.02))
    text = f"""<robot name="cabinet">
<link name="body">{carcass(0.4, 0.4, 0.6)}</link>
<link name="part_7">{front}{tray}{bar}{posts}</link>
<joint name="slide" type="prismatic"><origin xyz="0 0 0.45"/><parent link="body"/><child link="part_7"/>
<axis xyz="{axis}"/><limit lower="0" upper="0.25" effort="100" velocity="1"/></joint>
</robot>
"""
    path.write_text(text, encoding="utf-8")
    return path


def write_door_cabinet(path: Path) -> Path:
    """A cabinet of 0.4 x 0.4 x 0.6 m whose door turns about its upright edge at +y and has an upright bar handle."""
    door = box((0.018, 0.36, 0.55), (0.0, -0.185, 0.0))
    handle = box((0.012, 0.012, 0.14), (-0.045, -0.33, 0.05))
    posts = box((0.036, 0.01, 0.01), (-0.027, -0.33, 0.11)) + box((0.036, 0.01, 0.01), (-0.027, -0.33, -0.01))
    text = f"""<robot name="cabinet">
<link name="body">{carcass(0.4, 0.4, 0.6)}</link>
<link name="part_3">{door}{handle}{posts}</link>
<joint name="hinge" type="revolute"><origin xyz="-0.215 0.19 0.3"/><parent link="body"/><child link="part_3"/>
<axis xyz="0 0 1"/><limit lower="-1.4" upper="0" effort="100" velocity="1"/></joint>
</robot>
"""
    path.write_text(text, encoding="utf-8")
    return path


def write_covered_drawer(path: Path, *, door: str = "") -> Path:
    """A drawer with a bar handle behind the door of `write_door_cabinet`; `door` stands in for the limits of the hinge.

    The cabinet is deeper than that one, so that the drawer and its handle find room behind the door.
    """
    front = box((0.018, 0.33, 0.16), (-0.1, 0.0, 0.0))
    tray = box((0.26, 0.3, 0.01), (0.03, 0.0, -0.06)) + box((0.26, 0.01, 0.12), (0.03, 0.145, 0.0))
    bar = box((0.012, 0.14, 0.012), (-0.145, 0.0, 0.02))
    posts = box((0.036, 0.01, 0.01), (-0.127, 0.06, 0.02)) + box((0.036, 0.01, 0.01), (-0.127, -0.06, 0.02))
    write_door_cabinet(path)
    text = path.read_text(encoding="utf-8").replace(
        "</robot>",
        f"""<link name="part_9">{front}{tray}{bar}{posts}</link>
<joint name="slide" type="prismatic"><origin xyz="0 0 0.3"/><parent link="body"/><child link="part_9"/>
<axis xyz="-1 0 0"/><limit lower="0" upper="0.2" effort="100" velocity="1"/></joint>
</robot>""",
    )
    path.write_text(text.replace('lower="-1.4" upper="0"', door) if door else text, encoding="utf-8")
    return path


def planned(
    folder: Path, urdf: Path, joint: str, end: float, base: tuple[float, float, float], *, steps: int = 25
) -> Motion:
    """Plan with the first grasp whose pull the arm can follow: no obstacle is looked at but the grasp's own.

    Args:
        urdf: The furniture, front towards -x.
        joint: What is opened.
        end: Value of the joint at the end [rad or m].
        base: Where the arm stands: x, y [m] and yaw [rad].
        steps: Rows of the pull.
    """
    robot = builtin_robot()
    scene = read_scene(read_robot(urdf), SETTINGS.geometry)
    names = [travel.joint for travel in scene.travels]
    opened = np.linspace(scene.mechanism.rest[names.index(joint)], end, steps)
    T_world_base = np.eye(4)
    T_world_base[:2, :2] = [[np.cos(base[2]), -np.sin(base[2])], [np.sin(base[2]), np.cos(base[2])]]
    T_world_base[:2, 3] = base[:2]
    for grasp in search_grasps(scene, joint, robot.opening)[0]:
        targets = [
            np.linalg.inv(T_world_base) @ link_pose(scene, joint, value) @ grasp.T_link_grasp for value in opened
        ]
        pull = follow(robot, targets)
        if pull is not None:
            return Motion(
                robot=robot,
                object_urdf=urdf,
                T_world_base=T_world_base,
                T_world_object=np.eye(4),
                joint=joint,
                start={},
                grasp=grasp,
                reach=reach_of(robot, targets[0], pull[0]),
                pull=pull,
                opened=opened,
            )
    raise AssertionError(f"no grasp of {joint} can be followed")


def link_pose(scene, joint: str, value: float) -> np.ndarray:
    """Pose of the child link of a joint at a value, frame of the root."""
    from kinematify.robot.robot import forward_kinematics

    described = scene.model.joint_by_name[joint]
    return forward_kinematics(scene.model, {joint: value})[described.child]


def reach_of(robot: TaskRobot, target: np.ndarray, end: np.ndarray) -> np.ndarray:
    """A straight way in of 8 cm along the fingers, backwards from the grasp, then reversed."""
    back = []
    q = end
    for distance in np.linspace(0.0, 0.08, 9)[1:]:
        moved = target.copy()
        moved[:3, 3] -= distance * target[:3, 2]
        q = solved(robot, moved, q)
        if q is None:
            break
        back.append(q)
    return np.array([*reversed(back), end])


def follow(robot: TaskRobot, targets: list[np.ndarray]) -> np.ndarray | None:
    """Arm joints at all targets, each from the one before."""
    rng = np.random.default_rng(0)
    model = pin.buildModelFromUrdf(str(robot.urdf))
    low, high = model.lowerPositionLimit[:7], model.upperPositionLimit[:7]
    for start in [np.array(robot.home), *rng.uniform(low, high, (12, 7))]:
        q = solved(robot, targets[0], start)
        rows = []
        for target in targets:
            q = None if q is None else solved(robot, target, q)
            if q is None:
                break
            rows.append(q)
        if len(rows) == len(targets):
            return np.array(rows)
    return None


def solved(robot: TaskRobot, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
    """Damped least squares from one start; None if it does not arrive within the limits."""
    model = pin.buildModelFromUrdf(str(robot.urdf))
    data = model.createData()
    frame = model.getFrameId(robot.tool)
    goal = pin.SE3(target[:3, :3], target[:3, 3])
    q = np.concatenate([start, np.zeros(model.nq - 7)])
    low, high = model.lowerPositionLimit, model.upperPositionLimit
    for _ in range(200):
        pin.forwardKinematics(model, data, q)
        pin.updateFramePlacement(model, data, frame)
        error = pin.log6(data.oMf[frame].actInv(goal)).vector
        if np.linalg.norm(error) < 1e-6:
            return q[:7]
        J = pin.computeFrameJacobian(model, data, q, frame, pin.LOCAL)
        J[:, 7:] = 0.0
        q = np.clip(q + 0.5 * J.T @ np.linalg.solve(J @ J.T + 1e-6 * np.eye(6), error), low, high)
    return None


def grasps(urdf: Path, joint: str, opening: float = 0.1, **options) -> list[Grasp]:
    """Grasps of a joint's part."""
    scene = read_scene(read_robot(urdf), SETTINGS.geometry)
    return search_grasps(scene, joint, opening, **options)[0]
