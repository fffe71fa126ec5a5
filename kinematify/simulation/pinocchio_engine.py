"""Pinocchio as the analytical third opinion: where every link stands, mass matrix, gravity torques."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin
from lxml import etree

from kinematify.robot.read import read_without_geometry
from kinematify.simulation.prepared import load_prepared
from kinematify.validation.engines.configurations import (
    GRAVITY,
    EnginePoses,
    agreement_configurations,
    write_poses,
)
from kinematify.validation.engines.loading import LoadedJoint, LoadedModel, compare_with_file

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.validation.engines.configurations import Configurations
    from kinematify.validation.stage import Recorder, StageRequest

ENGINE = "pinocchio"


def run(request: StageRequest, recorder: Recorder) -> None:
    """Load `prepared.urdf`, compare what was loaded with the file (KV606), and leave `poses-pinocchio.npz`."""
    model = None
    with recorder.check("KV606", ENGINE) as check:
        declared, prepared = read_without_geometry(request.urdf), load_prepared(request.work)
        try:
            model = _load(prepared.urdf)
        except ValueError as error:
            check.find(
                f"Pinocchio refuses the model: {error}.",
                "Mend the other findings first; names with unusual characters are the commonest cause.",
            )
            return
        compare_with_file(check, declared, prepared, _loaded(model), request.settings.agreement.mass_error)
    if model is not None and recorder.wants("KV601", "KV602", "KV603", "KV605"):
        rows = agreement_configurations(declared.kinematics, request.settings.agreement, request.settings.seed)
        write_poses(request.work, ENGINE, poses(model, rows))


def _load(urdf: Path) -> pin.Model:
    """Build the tree; the geometry is left out, Pinocchio would only look for the files."""
    robot = etree.parse(urdf).getroot()
    for link in robot.iter("link"):
        for shape in link.findall("collision"):
            link.remove(shape)
    model = pin.buildModelFromXML(etree.tostring(robot, encoding="unicode"))
    model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
    return model


def _loaded(model: pin.Model) -> LoadedModel:
    joints = {}
    for name, joint in list(zip(model.names, model.joints, strict=True))[1:]:  # the first stands for the world
        kind = joint.shortname()
        bounded = joint.nq == 1
        joints[str(name)] = LoadedJoint(
            turns="Revolute" in kind or kind.startswith("JointModelR"),
            lower=float(model.lowerPositionLimit[joint.idx_q]) if bounded else -np.inf,
            upper=float(model.upperPositionLimit[joint.idx_q]) if bounded else np.inf,
        )
    total = sum(inertia.mass for inertia in model.inertias)
    return LoadedModel(joints=joints, masses=_link_masses(model), total_mass=float(total))


def _link_masses(model: pin.Model) -> dict[str, float]:
    """Mass of each link. The frame of a fixed joint holds that of the link below; a body's first link has the rest."""
    masses: dict[str, float] = {}
    rest = [float(inertia.mass) for inertia in model.inertias]
    first: dict[int, str] = {}
    for frame in model.frames:
        if frame.type != pin.FrameType.BODY:
            continue
        carrier = model.frames[frame.parentFrame]
        if frame.parentJoint not in first:
            first[frame.parentJoint] = str(frame.name)
        else:
            masses[str(frame.name)] = float(carrier.inertia.mass)
            rest[frame.parentJoint] -= float(carrier.inertia.mass)
    return masses | {name: rest[joint] for joint, name in first.items()}


def poses(model: pin.Model, rows: Configurations) -> EnginePoses:
    """Return what Pinocchio says of the rows."""
    data = model.createData()
    frames = [_body_frame(model, name) for name in rows.links]
    velocity = np.array([_velocity_index(model, name) for name in rows.joints], dtype=np.int64)
    T_world_link = np.full((len(rows.q), len(rows.links), 4, 4), np.nan)
    count = len(rows.joints)
    mass_matrix = np.full((rows.dynamic, count, count), np.nan)
    gravity = np.full((rows.dynamic, count), np.nan)
    for row, values in enumerate(rows.q):
        q = _configuration(model, rows.joints, values)
        pin.framesForwardKinematics(model, data, q)
        for link, frame in enumerate(frames):
            if frame is not None:
                T_world_link[row, link] = data.oMf[frame].homogeneous
        if row < rows.dynamic:
            upper = np.triu(pin.crba(model, data, q))
            mass_matrix[row] = _picked_matrix(upper + np.triu(upper, 1).T, velocity)
            gravity[row] = _picked(pin.computeGeneralizedGravity(model, data, q), velocity)
    masses = _link_masses(model)
    return EnginePoses(
        links=rows.links,
        joints=rows.joints,
        q=rows.q,
        T_world_link=T_world_link,
        masses=np.array([masses.get(name, np.nan) for name in rows.links]),
        total_mass=float(sum(inertia.mass for inertia in model.inertias)),
        mass_matrix=mass_matrix,
        gravity=gravity,
    )


def _body_frame(model: pin.Model, link: str) -> int | None:
    return model.getFrameId(link, pin.FrameType.BODY) if model.existFrame(link, pin.FrameType.BODY) else None


def _velocity_index(model: pin.Model, joint: str) -> int:
    return model.joints[model.getJointId(joint)].idx_v if model.existJointName(joint) else -1


def _configuration(model: pin.Model, joints: tuple[str, ...], values: FloatArray) -> FloatArray:
    q = pin.neutral(model)
    for name, value in zip(joints, values, strict=True):
        if model.existJointName(name):
            joint = model.joints[model.getJointId(name)]
            # A joint that turns without end is a point on the unit circle.
            q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
    return np.asarray(q)


def _picked(vector: FloatArray, indices: IntArray) -> FloatArray:
    """Entries in the order of the document, NaN for joints that the engine lost."""
    padded: FloatArray = np.append(vector, np.nan)[indices]
    return padded


def _picked_matrix(matrix: FloatArray, indices: IntArray) -> FloatArray:
    padded = np.pad(matrix, (0, 1), constant_values=np.nan)
    picked: FloatArray = padded[np.ix_(indices, indices)]
    return picked
