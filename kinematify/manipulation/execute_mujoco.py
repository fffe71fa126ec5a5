"""A planned motion in MuJoCo: both models in one world, servos on the arm, a weld or friction at the hand.

Engines see a part as convex pieces that may reach millimetres beyond its surface, which closes the gap behind a handle.
Fingers that hold by friction therefore act on one piece only: what lies between the pads of the exact part, as one
convex body. That they have room beside the part was looked at with its true surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.geometry.convex import convex_hull, thickened
from kinematify.geometry.scene import transformed
from kinematify.manipulation.request import Hold
from kinematify.robot.joint_type import JointType
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.robot import forward_kinematics, joint_values, rest_configuration, rigid_groups
from kinematify.robot.transforms import quaternion_of
from kinematify.simulation.mujoco_model import (
    add_latch,
    add_servos,
    attach,
    hold_by_friction,
    joint_ids,
    largest_inertia,
    make_rubber,
    parse,
    set_robot_servos,
    world_spec,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.config.task import ExecutionSettings
    from kinematify.manipulation.execute import Loaded
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Joint, Robot
    from kinematify.simulation.prepared import Prepared

    BoolArray = NDArray[np.bool_]
    from collections.abc import Mapping

    from kinematify.manipulation.grasp import Grasp

_ROBOT, _OBJECT = "robot_", "object_"
_HELD, _OTHERS, _GRIP = 1, 2, 4  # bits: the held part, all that is not held, and what lies between the pads
_WELD, _LATCH = "kinematify weld", "kinematify latch"


def open_world(loaded: Loaded, settings: ExecutionSettings, hold: Hold) -> MujocoExecution:
    """Compile robot and object into one world, at the start of the motion."""
    return MujocoExecution(loaded, settings, hold)


@dataclass(frozen=True, eq=False)
class MujocoExecution:
    """See `kinematify.manipulation.execute.ExecutionWorld`."""

    loaded: Loaded
    settings: ExecutionSettings
    hold: Hold

    @cached_property
    def model(self) -> mujoco.MjModel:
        """The compiled world."""
        model = self._spec().compile()
        self._set_servos(model)
        return model

    @cached_property
    def data(self) -> mujoco.MjData:
        """Its state."""
        data = mujoco.MjData(self.model)
        data.qpos[:] = self._start(self.model)
        mujoco.mj_forward(self.model, data)
        data.ctrl[self._dof :] = self.loaded.fingers(self.loaded.motion.grasp.spread)
        return data

    @property
    def _dof(self) -> int:
        """Number of servos of the arm; those of the fingers come after."""
        return len(self.loaded.motion.robot.arm_joints)

    def step(self, arm: FloatArray, speed: FloatArray) -> bool:
        """Simulate one time step; commands run ahead of the lag by damping over stiffness."""
        data = self.data
        data.ctrl[: self._dof] = arm + speed / (np.pi * self.settings.servo_frequency)
        mujoco.mj_step(self.model, data)
        return bool(np.isfinite(data.qpos).all()) and not data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number

    def squeeze(self) -> None:
        """Tell the fingers to close a centimetre inside of what they hold, so that they press with their full force."""
        grasp = self.loaded.motion.grasp
        closed, opened = self.loaded.fingers(0.0), self.loaded.fingers(grasp.spread)
        gap = max(grasp.spread, 1e-6)
        self.data.ctrl[self._dof :] = opened + (closed - opened) * (gap - grasp.width + 0.02) / gap

    def opened(self) -> float:
        """Value of the joint that is opened [rad or m]."""
        return float(self.data.qpos[self._opened_qpos])

    @cached_property
    def _opened_qpos(self) -> int:
        return int(self.model.joint(_OBJECT + self.loaded.motion.joint).qposadr[0])

    def arm(self) -> FloatArray:
        """Values of the arm's joints."""
        return np.asarray(self.data.qpos[self._arm_qpos])

    def close(self) -> None:
        """Nothing is held that Python does not free."""

    def _spec(self) -> mujoco.MjSpec:
        motion, settings = self.loaded.motion, self.settings
        spec = world_spec(settings.time_step)
        hold_by_friction(spec)
        robot, object_spec = (
            self._parsed(self.loaded.robot, self.loaded.robot_prepared),
            self._parsed(self.loaded.object, self.loaded.object_prepared),
        )
        self._set_contacts(robot, object_spec)
        attach(spec, robot, _ROBOT, motion.T_world_base)
        attach(spec, object_spec, _OBJECT, motion.T_world_object)
        floor = spec.worldbody.add_geom(name="kinematify floor", type=mujoco.mjtGeom.mjGEOM_PLANE)
        floor.size, floor.contype, floor.conaffinity = [0.0, 0.0, 1.0], _OTHERS, 0
        add_servos(spec, [_ROBOT + name for name in self._driven])
        self._add_bonds(spec)
        return spec

    def _parsed(self, model: Robot, prepared: Prepared) -> mujoco.MjSpec:
        spec = parse(prepared.urdf, LeaderMechanism(robot=model), step=self.settings.time_step).spec
        spec.compiler.balanceinertia = True
        return spec

    def _set_contacts(self, robot: mujoco.MjSpec, object_spec: mujoco.MjSpec) -> None:
        """The robot meets the object and the floor; neither meets itself, which the planner has looked at."""
        make_rubber(robot, self.settings.friction, self.settings.time_step)
        for geom in robot.geoms:
            geom.contype, geom.conaffinity = 0, _HELD | _OTHERS
            if geom.parent.name in self.loaded.hand_links:
                geom.conaffinity = _OTHERS | _GRIP
        for geom in object_spec.geoms:
            held = geom.parent.name in self.loaded.held_links
            geom.contype, geom.conaffinity = _HELD if held else _OTHERS, 0
        if self.hold is Hold.CONTACT:
            vertices, faces = grip_piece(
                self.loaded.object, self.loaded.held, self._leaders(), self.loaded.motion.grasp, self.settings
            )
            mesh = object_spec.add_mesh(name="kinematify grip", uservert=vertices.ravel(), userface=faces.ravel())
            grip = object_spec.body(self.loaded.held).add_geom(
                type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, mass=0.0
            )
            grip.contype, grip.conaffinity = _GRIP, 0

    def _leaders(self) -> dict[str, float]:
        """Leading joints of the object at the start [rad or m]."""
        rest = rest_configuration(self.loaded.object)
        start = {**self.loaded.motion.start, self.loaded.motion.joint: float(self.loaded.motion.opened[0])}
        return {joint.name: start.get(joint.name, rest[joint.name]) for joint in self.loaded.object.leaders}

    @property
    def _driven(self) -> tuple[str, ...]:
        """Joints of the robot that have servos."""
        return (*self.loaded.motion.robot.arm_joints, *self.loaded.motion.robot.finger_joints)

    def _add_bonds(self, spec: mujoco.MjSpec) -> None:
        """Weld the hand to the part, and hold every joint that is not driven where it starts."""
        weld = spec.add_equality(name=_WELD, type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY)
        weld.name1, weld.name2, weld.active = _ROBOT + self.loaded.motion.robot.tool, _OBJECT + self.loaded.held, False
        for prefix, model, values in self._sides():
            for joint in model.leaders:
                if prefix == _OBJECT or joint.name not in self._driven:
                    freed = prefix == _OBJECT and joint.name in self._freed
                    name = f"{_LATCH} {joint.name}" if freed else ""
                    add_latch(spec, prefix + joint.name, values[joint.name], name)

    def _sides(self) -> Sequence[tuple[str, Robot, dict[str, float]]]:
        """Prefix, model and values of all joints at the start, of robot and object."""
        loaded, motion = self.loaded, self.loaded.motion
        arm = dict(zip(motion.robot.arm_joints, motion.reach[0].tolist(), strict=True))
        gap = loaded.fingers(motion.grasp.spread)
        hand = dict(zip(motion.robot.finger_joints, gap.tolist(), strict=True))
        robot = {**rest_configuration(loaded.robot), **arm, **hand}
        values = {**rest_configuration(loaded.object), **motion.start, motion.joint: float(motion.opened[0])}
        return (
            (_ROBOT, loaded.robot, {**joint_values(loaded.robot, robot), **hand}),
            (_OBJECT, loaded.object, joint_values(loaded.object, values)),
        )

    def _start(self, model: mujoco.MjModel) -> FloatArray:
        qpos = np.array(model.qpos0)
        for prefix, _, values in self._sides():
            for name, value in values.items():
                index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, prefix + name)
                if index >= 0:
                    qpos[model.jnt_qposadr[index]] = value
        return qpos

    def _set_servos(self, model: mujoco.MjModel) -> None:
        """Servos for the robot, and damping for the joint that is opened."""
        motion, settings = self.loaded.motion, self.settings
        arm, fingers = (joint_ids(model, _ROBOT, n) for n in (motion.robot.arm_joints, motion.robot.finger_joints))
        rows = (motion.reach[0], motion.pull[0], motion.pull[-1])
        inertia = largest_inertia(model, self._start(model), model.jnt_qposadr[arm], rows)
        opened = int(model.joint(_OBJECT + motion.joint).dofadr[0])
        model.dof_damping[opened] = max(model.dof_damping[opened], settings.joint_damping * inertia[opened])
        dof, strongest = model.jnt_dofadr, self.loaded.strongest(settings)
        set_robot_servos(model, dof[arm], dof[fingers], inertia=inertia, strongest=strongest, settings=settings)

    @property
    def _freed(self) -> tuple[str, ...]:
        return (self.loaded.motion.joint, *self.loaded.motion.freed)

    @cached_property
    def _arm_qpos(self) -> IntArray:
        names = self.loaded.motion.robot.arm_joints
        return np.array([int(self.model.joint(_ROBOT + name).qposadr[0]) for name in names], dtype=np.int64)

    def take_hold(self) -> None:
        """Let the joint go, and weld the hand to the part where it now is."""
        model, data = self.model, self.data
        for name in self._freed:
            data.eq_active[model.equality(f"{_LATCH} {name}").id] = 0
        if self.hold is not Hold.WELD:
            return
        weld = model.equality(_WELD).id
        tool, held = (data.body(name) for name in (_ROBOT + self.loaded.motion.robot.tool, _OBJECT + self.loaded.held))
        first, second = tool.xmat.reshape(3, 3), held.xmat.reshape(3, 3)
        # The anchor, which is the tool's origin, in the frame of the part and in that of the tool.
        model.eq_data[weld, :3] = second.T @ (tool.xpos - held.xpos)
        model.eq_data[weld, 3:6] = 0.0
        model.eq_data[weld, 6:10] = quaternion_of(first.T @ second)
        model.eq_data[weld, 10] = 1.0
        data.eq_active[weld] = 1

    def deeper(self, than: float) -> tuple[float, tuple[str, str]] | None:
        """Deepest contact of the robot, if it is deeper than that."""
        count = self.data.ncon
        if not count:
            return None
        geoms = self.data.contact.geom[:count]
        depths = np.where(self._gripped[geoms].all(axis=1), 0.0, -self.data.contact.dist[:count])
        deepest = int(depths.argmax())
        if depths[deepest] <= than:
            return None
        bodies = (self.model.body(self.model.geom_bodyid[geom]).name for geom in geoms[deepest])
        link, other = sorted(bodies, key=lambda name: not name.startswith(_ROBOT))
        other = "the floor" if other == "world" else other.removeprefix(_OBJECT)
        return float(depths[deepest]), (link.removeprefix(_ROBOT), other)

    @cached_property
    def _gripped(self) -> BoolArray:
        """Which shapes belong to the hand or to what it holds, shape (geoms,)."""
        names = {_ROBOT + link for link in self.loaded.hand_links} | {_OBJECT + link for link in self.loaded.held_links}
        return np.array([self.model.body(body).name in names for body in self.model.geom_bodyid])

    def joints(self) -> tuple[dict[str, float], dict[str, float]]:
        """Values of all joints of robot and object."""
        robot, articulated = (
            {joint.name: float(self.data.joint(prefix + joint.name).qpos[0]) for joint in model.joints if _moves(joint)}
            for prefix, model, _ in self._sides()
        )
        return robot, articulated


def _moves(joint: Joint) -> bool:
    return joint.kind is not JointType.FIXED


_THIN = 1e-3  # sheets are made so thick [m]


def grip_piece(
    model: Robot, link: str, values: Mapping[str, float], grasp: Grasp, settings: ExecutionSettings
) -> tuple[FloatArray, IntArray]:
    """Cut out what lies between the pads and return its convex hull.

    Args:
        model: The object.
        link: Link in whose frame the grasp is stated.
        values: Leading joints of the object [rad or m].
        grasp: How it is held.
        settings: Size of the pads.

    Returns:
        Vertices in the frame of the link [m], shape (V, 3), and faces (F, 3). Where nothing lies between the pads, a
        block as thick as the grasp says.
    """
    high = np.array([0.5 * settings.pad_width, 0.5 * grasp.spread, 0.5 * settings.pad_length])
    low = -high
    back = np.asarray(np.linalg.inv(grasp.T_link_grasp), dtype=np.float64)
    points = _clipped(_triangles(model, link, grasp.held, values) @ back[:3, :3].T + back[:3, 3], low, high)
    if not len(points):
        size = np.array([high[0], 0.5 * grasp.width, high[2]])
        points = size * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    vertices, faces = convex_hull(thickened(points, _THIN))
    return transformed(vertices, grasp.T_link_grasp), faces


def _triangles(model: Robot, link: str, held: str, values: Mapping[str, float]) -> FloatArray:
    """Corners of all faces of the held body, frame of the link, shape (F, 3, 3)."""
    poses = forward_kinematics(model, values)
    group = next(group for group in rigid_groups(model) if held in group.links)
    found = [np.empty((0, 3, 3))]
    for name in group.links:
        declared = model.link_by_name[name]
        T = np.linalg.inv(poses[link]) @ poses[name]
        for shape in declared.collisions or declared.visuals:
            found.append(transformed(shape.mesh.vertices, T)[shape.mesh.faces])
    return np.concatenate(found)


def _clipped(triangles: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Corners of what is left of triangles (F, 3, 3) inside a box, shape (n, 3)."""
    near = (triangles.min(axis=1) <= high).all(axis=1) & (triangles.max(axis=1) >= low).all(axis=1)
    found = [np.empty((0, 3))]
    for triangle in triangles[near]:
        polygon = triangle
        for axis in range(3):
            for sign, bound in ((1.0, high[axis]), (-1.0, -low[axis])):
                polygon = _below(polygon, sign * polygon[:, axis] - bound)
        found.append(polygon)
    return np.concatenate(found)


def _below(polygon: FloatArray, above: FloatArray) -> FloatArray:
    """Part of a polygon (n, 3) whose corners lie `above` a plane by so much (n,) that is not above it."""
    if (above <= 0.0).all():
        return polygon
    kept: list[FloatArray] = []
    for index in range(len(polygon)):
        after = (index + 1) % len(polygon)
        if above[index] <= 0.0:
            kept.append(polygon[index])
        if (above[index] <= 0.0) != (above[after] <= 0.0):
            share = above[index] / (above[index] - above[after])
            kept.append(polygon[index] + share * (polygon[after] - polygon[index]))
    return np.array(kept).reshape(-1, 3)
