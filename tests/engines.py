"""The three readers of a URDF behind one face: joints, poses and vertices as each of them understands the file."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class ReadJoint:
    kind: str
    axis: np.ndarray
    """World frame at zero."""
    limits: tuple[float, float] | None


@dataclass(frozen=True)
class Reading:
    """What an engine made of a URDF at one configuration."""

    joints: dict[str, ReadJoint]
    """Moving joints only."""
    poses: dict[str, np.ndarray]
    """T_world_link."""
    vertices: dict[str, np.ndarray]
    """World frame; the hull's vertices where the engine keeps only those."""


def read_mujoco(urdf: Path, q: Mapping[str, float]) -> Reading:
    import mujoco

    spec = mujoco.MjSpec.from_file(str(urdf))
    spec.compiler.fusestatic = False
    model = spec.compile()
    data = mujoco.MjData(model)
    kinds = {int(mujoco.mjtJoint.mjJNT_HINGE): "turns", int(mujoco.mjtJoint.mjJNT_SLIDE): "slides"}
    mujoco.mj_kinematics(model, data)
    joints = {}
    for index in range(model.njnt):
        limits = tuple(model.jnt_range[index]) if model.jnt_limited[index] else None
        joints[model.joint(index).name] = ReadJoint(kinds[model.jnt_type[index]], data.xaxis[index].copy(), limits)
    for name, value in q.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_kinematics(model, data)
    poses, vertices = {}, {}
    for body in range(1, model.nbody):
        poses[model.body(body).name] = pose(data.xpos[body], data.xmat[body].reshape(3, 3))
    for geom in range(model.ngeom):
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        local = model.mesh_vert[first : first + count].astype(float)
        placed = local @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
        vertices.setdefault(model.body(model.geom_bodyid[geom]).name, []).append(placed)
    return Reading(joints, poses, {name: np.concatenate(blocks) for name, blocks in vertices.items()})


def read_pybullet(urdf: Path, q: Mapping[str, float]) -> Reading:
    with quiet():
        import pybullet

        client = pybullet.connect(pybullet.DIRECT)
    try:
        with quiet():
            body = pybullet.loadURDF(str(urdf), useFixedBase=1, physicsClientId=client)
        return _read_body(pybullet, client, body, q)
    finally:
        pybullet.disconnect(client)


def _read_body(pybullet, client: int, body: int, q: Mapping[str, float]) -> Reading:
    def place(position, quaternion) -> np.ndarray:
        return pose(position, np.reshape(pybullet.getMatrixFromQuaternion(quaternion), (3, 3)))

    def mesh(link: int, T_world_inertial: np.ndarray) -> np.ndarray:
        _, points = pybullet.getMeshData(body, link, physicsClientId=client)
        return np.reshape(points, (-1, 3)) @ T_world_inertial[:3, :3].T + T_world_inertial[:3, 3]

    kinds = {pybullet.JOINT_REVOLUTE: "turns", pybullet.JOINT_PRISMATIC: "slides"}
    infos = [pybullet.getJointInfo(body, j, physicsClientId=client) for j in range(pybullet.getNumJoints(body))]
    joints = {}
    for info in infos:
        if info[2] in kinds:
            limits = (info[8], info[9]) if info[8] <= info[9] else None
            joints[info[1].decode()] = ReadJoint(kinds[info[2]], np.array(info[13]), limits)
    for info in infos:
        if info[1].decode() in q:
            pybullet.resetJointState(body, info[0], q[info[1].decode()], physicsClientId=client)
    base = pybullet.getBodyInfo(body, physicsClientId=client)[0].decode()
    T_world_inertial = place(*pybullet.getBasePositionAndOrientation(body, physicsClientId=client))
    T_link_inertial = place(*pybullet.getDynamicsInfo(body, -1, physicsClientId=client)[3:5])
    poses = {base: T_world_inertial @ np.linalg.inv(T_link_inertial)}
    vertices = {base: mesh(-1, T_world_inertial)}
    for info in infos:
        state = pybullet.getLinkState(body, info[0], computeForwardKinematics=1, physicsClientId=client)
        name = info[12].decode()
        poses[name] = place(state[4], state[5])
        vertices[name] = mesh(info[0], place(state[0], state[1]))
    return Reading(joints, poses, vertices)


def read_pinocchio(urdf: Path, q: Mapping[str, float]) -> Reading:
    import pinocchio

    model, _, visual = pinocchio.buildModelsFromUrdf(str(urdf), package_dirs=[str(urdf.parent)])
    data, visual_data = model.createData(), pinocchio.GeometryData(visual)
    position = pinocchio.neutral(model)
    pinocchio.framesForwardKinematics(model, data, position)
    joints = {}
    for index in range(1, model.njoints):
        # A model of one joint gives a vector instead of a matrix of one column.
        column = pinocchio.computeJointJacobian(model, data, position, index).reshape(6, -1)[:, model.idx_vs[index]]
        turns = np.linalg.norm(column[3:]) > 0.5
        at = model.idx_qs[index]
        limits = (model.lowerPositionLimit[at], model.upperPositionLimit[at]) if model.nqs[index] == 1 else None
        local = column[3:] if turns else column[:3]
        joints[model.names[index]] = ReadJoint("turns" if turns else "slides", data.oMi[index].rotation @ local, limits)
    for name, value in q.items():
        index = model.getJointId(name)
        at, wide = model.idx_qs[index], model.nqs[index] == 2
        position[at : at + model.nqs[index]] = [np.cos(value), np.sin(value)] if wide else value
    pinocchio.framesForwardKinematics(model, data, position)
    pinocchio.updateGeometryPlacements(model, data, visual, visual_data, position)
    poses = {
        frame.name: data.oMf[index].homogeneous.copy()
        for index, frame in enumerate(model.frames)
        if frame.type == pinocchio.FrameType.BODY
    }
    vertices: dict[str, list[np.ndarray]] = {}
    for geometry, placement in zip(visual.geometryObjects, visual_data.oMg, strict=True):
        link = model.frames[geometry.parentFrame].name
        vertices.setdefault(link, []).append(
            geometry.geometry.vertices() @ placement.rotation.T + placement.translation
        )
    return Reading(joints, poses, {name: np.concatenate(blocks) for name, blocks in vertices.items()})


READERS = {"mujoco": read_mujoco, "pybullet": read_pybullet, "pinocchio": read_pinocchio}


def pose(position, rotation) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation, position
    return T


@contextmanager
def quiet() -> Iterator[None]:
    """PyBullet prints from C."""
    saved = os.dup(1)
    with Path(os.devnull).open("w") as null:
        os.dup2(null.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(saved, 1)
            os.close(saved)
