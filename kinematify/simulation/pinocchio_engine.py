"""Pinocchio as an engine that only computes: where every link stands, mass matrix, gravity torques."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin
from lxml import etree

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.contacts import NO_CONTACTS
from kinematify.simulation.engine import LoadedJoint, LoadedModel, Measured, Refused

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.prepared import Prepared


def open_engine(settings: EngineSettings, log: Path) -> PinocchioEngine:
    """Return Pinocchio, which has no settings and says nothing."""
    del settings, log
    return PinocchioEngine()


class PinocchioEngine:
    """See `kinematify.simulation.engine.Engine`."""

    def load(self, prepared: Prepared, mechanism: LeaderMechanism) -> PinocchioModel:
        """Build the tree; the geometry is left out, Pinocchio would only look for the files."""
        robot = etree.parse(prepared.urdf).getroot()
        for link in robot.iter("link"):
            for shape in link.findall("collision"):
                link.remove(shape)
        try:
            model = pin.buildModelFromXML(etree.tostring(robot, encoding="unicode"))
        except ValueError as error:
            raise Refused(str(error)) from error
        model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
        return PinocchioModel(model=model, mechanism=mechanism)

    def messages(self) -> list[str]:
        """None."""
        return []


@dataclass(frozen=True, kw_only=True, eq=False)
class PinocchioModel:
    """See `kinematify.simulation.engine.EngineModel`."""

    model: pin.Model
    mechanism: LeaderMechanism

    @cached_property
    def loaded(self) -> LoadedModel:
        """What became of joints and masses."""
        model, joints = self.model, {}
        for name, joint in list(zip(model.names, model.joints, strict=True))[1:]:  # the first stands for the world
            kind = joint.shortname()
            bounded = joint.nq == 1
            joints[str(name)] = LoadedJoint(
                turns="Revolute" in kind or kind.startswith("JointModelR"),
                lower=float(model.lowerPositionLimit[joint.idx_q]) if bounded else -np.inf,
                upper=float(model.upperPositionLimit[joint.idx_q]) if bounded else np.inf,
            )
        total = sum(inertia.mass for inertia in model.inertias)
        return LoadedModel(joints=joints, masses=self._masses, total_mass=float(total))

    @property
    def _masses(self) -> dict[str, float]:
        """Of each link: the frame of a fixed joint holds that of the link below; a body's first link has the rest."""
        model = self.model
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

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        model, mechanism = self.model, self.mechanism
        links = all(model.existFrame(name, pin.FrameType.BODY) for name in mechanism.links)
        return links and all(model.existJointName(name) for name in mechanism.joints)

    def measure(self, values: FloatArray, *, dynamic: int) -> Measured:
        """Set the model to every row and look; what it has lost is NaN."""
        model, data, mechanism = self.model, self.model.createData(), self.mechanism
        frames = {
            link: model.getFrameId(name, pin.FrameType.BODY)
            for link, name in enumerate(mechanism.links)
            if model.existFrame(name, pin.FrameType.BODY)
        }
        velocity = np.array(
            [
                model.joints[model.getJointId(name)].idx_v if model.existJointName(name) else -1
                for name in mechanism.joints
            ],
            dtype=np.int64,
        )
        T_world_link = np.full((len(values), len(mechanism.links), 4, 4), np.nan)
        gravity = np.zeros_like(values)
        matrices = []
        for row, q_joints in enumerate(values):
            q = self._configuration(q_joints)
            pin.framesForwardKinematics(model, data, q)
            for link, frame in frames.items():
                T_world_link[row, link] = data.oMf[frame].homogeneous
            gravity[row] = np.append(pin.computeGeneralizedGravity(model, data, q), np.nan)[velocity]
            if row < dynamic:
                upper = np.triu(pin.crba(model, data, q))
                matrices.append(_picked(upper + np.triu(upper, 1).T, velocity))
        inertia = np.array(matrices).reshape(len(matrices), values.shape[1], values.shape[1])
        return Measured(T_world_link=T_world_link, contacts=NO_CONTACTS, gravity=gravity, inertia=inertia)

    def _configuration(self, values: FloatArray) -> FloatArray:
        q = pin.neutral(self.model)
        for name, value in zip(self.mechanism.joints, values, strict=True):
            if self.model.existJointName(name):
                joint = self.model.joints[self.model.getJointId(name)]
                # A joint that turns without end is a point on the unit circle.
                q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
        return np.asarray(q)


def _picked(matrix: FloatArray, indices: IntArray) -> FloatArray:
    """Rows and columns in the order of the document, NaN for joints that the engine lost."""
    padded = np.pad(matrix, (0, 1), constant_values=np.nan)
    picked: FloatArray = padded[np.ix_(indices, indices)]
    return picked
