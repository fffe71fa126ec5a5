"""Pinocchio, which only computes: where every link is, and overlaps of raw files."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import coal
import numpy as np
import pinocchio as pin
from lxml import etree

from kinematify.simulation.engine import LoadedJoint, LoadedRobot, Refused
from kinematify.simulation.raw_model import MovesFreely, RawEngineModel, Reproductions, Unloadable, deepest_first

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.raw_model import Overlap

_SMALLEST = 0.01
"""Smaller models are compared as if they had this size [m]."""


class PinocchioEngine:
    """Pinocchio as `kinematify.simulation.engine.Engine`; it has no settings and says nothing."""

    def __init__(self, settings: EngineSettings, log: Path) -> None:
        """Need nothing."""
        del settings, log

    @staticmethod
    def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> PinocchioFile:
        """Load a file as users do."""
        del root
        return PinocchioFile(urdf, package_dirs)

    def load(self, prepared: Prepared, mechanism: LeaderMechanism) -> PinocchioModel:
        """Build the tree; the geometry is omitted, Pinocchio would only look for the files."""
        robot = etree.parse(prepared.urdf).getroot()
        for link in robot.iter("link"):
            for shape in link.findall("collision"):
                link.remove(shape)
        try:
            model = pin.buildModelFromXML(etree.tostring(robot, encoding="unicode"))
        except ValueError as error:
            raise Refused(str(error)) from error
        return PinocchioModel(model=model, mechanism=mechanism)

    def messages(self) -> list[str]:
        """None."""
        return []


@dataclass(frozen=True, kw_only=True, eq=False)
class PinocchioModel:
    """Prepared model in Pinocchio."""

    model: pin.Model
    mechanism: LeaderMechanism

    @cached_property
    def loaded(self) -> LoadedRobot:
        """Return what became of joints and masses."""
        model, joints = self.model, {}
        for name, joint in list(zip(model.names, model.joints, strict=True))[1:]:  # the first represents the world
            kind = joint.shortname()
            bounded = joint.nq == 1
            joints[str(name)] = LoadedJoint(
                turns="Revolute" in kind or kind.startswith("JointModelR"),
                lower=float(model.lowerPositionLimit[joint.idx_q]) if bounded else -np.inf,
                upper=float(model.upperPositionLimit[joint.idx_q]) if bounded else np.inf,
            )
        total = sum(inertia.mass for inertia in model.inertias)
        return LoadedRobot(joints=joints, masses=self._masses, total_mass=float(total))

    @property
    def _masses(self) -> dict[str, float]:
        """Return the mass of each link: a fixed joint's frame holds that of the link below, the first link the rest."""
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

    @cached_property
    def size(self) -> float:
        """Extent of the frames of all links at zero, at least 1 cm [m]."""
        places = self.poses(np.zeros((1, len(self.mechanism.joints))))[0, :, :3, 3]
        return max(float(np.linalg.norm(np.ptp(places, axis=0))), _SMALLEST)

    def poses(self, values: FloatArray) -> FloatArray:
        """Where every link is in every row; what the engine has lost is NaN."""
        model, data, mechanism = self.model, self.model.createData(), self.mechanism
        frames = {
            link: model.getFrameId(name, pin.FrameType.BODY)
            for link, name in enumerate(mechanism.links)
            if model.existFrame(name, pin.FrameType.BODY)
        }
        T_world_link = np.full((len(values), len(mechanism.links), 4, 4), np.nan)
        for row, q_joints in enumerate(values):
            pin.framesForwardKinematics(model, data, self._configuration(q_joints))
            for link, frame in frames.items():
                T_world_link[row, link] = data.oMf[frame].homogeneous
        return T_world_link

    def _configuration(self, values: FloatArray) -> FloatArray:
        q = pin.neutral(self.model)
        for name, value in zip(self.mechanism.joints, values, strict=True):
            if self.model.existJointName(name):
                joint = self.model.joints[self.model.getJointId(name)]
                # A joint that turns without end is a point on the unit circle.
                q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
        return np.asarray(q)


_OPEN = """import coal, numpy as np, pinocchio as pin
model = pin.buildModelFromUrdf({path!r}); \
shapes = pin.buildGeomFromUrdf(model, {path!r}, pin.GeometryType.COLLISION, package_dirs={folders})
"""
_JOINTS = (
    _OPEN
    + """for name, joint in zip(list(model.names)[1:], list(model.joints)[1:]): k = joint.idx_q; \
ends = (-float("inf"), float("inf")) if joint.nq == 2 else (model.lowerPositionLimit[k], model.upperPositionLimit[k]); \
print(name, *ends)
"""
)
_OVERLAP = (
    _OPEN
    + """seen = shapes.createData(); pin.updateGeometryPlacements(model, model.createData(), shapes, seen, \
np.array({values})); place = lambda k: coal.Transform3s(seen.oMg[k].rotation, seen.oMg[k].translation)
solid = [(getattr(g.geometry, "buildConvexRepresentation", lambda _: 0)(False), \
getattr(g.geometry, "convex", g.geometry))[1] for g in shapes.geometryObjects]
pairs = [(i, k) for i, a in enumerate(shapes.geometryObjects) for k, b in enumerate(shapes.geometryObjects) \
if (model.frames[a.parentFrame].name, model.frames[b.parentFrame].name) == {links}]
print(max(-coal.distance(solid[i], place(i), solid[k], place(k), coal.DistanceRequest(), coal.DistanceResult()) \
for i, k in pairs))
"""
)
_CONVEX = 0.99
"""Volume of a mesh that counts as convex, fraction of its hull's."""


class PinocchioFile(RawEngineModel):
    """Raw model: a file as `buildModelFromUrdf` and `buildGeomFromUrdf` read it.

    What a joint connects is not looked at for overlaps.
    """

    code = Reproductions(joints=_JOINTS, overlap=_OVERLAP)

    def __init__(self, urdf: Path, package_dirs: Sequence[Path]) -> None:
        """Load it; paths of meshes are relative to its folder.

        Raises:
            Unloadable: Pinocchio does not open it.
            MovesFreely: It moves a link in other ways than by turning or sliding.
        """
        folders = [str(folder) for folder in (urdf.parent, *package_dirs)]
        self._file = {"path": str(urdf), "folders": folders}
        try:
            self._model = pin.buildModelFromUrdf(str(urdf))
            self._geometry = pin.buildGeomFromUrdf(
                self._model, str(urdf), pin.GeometryType.COLLISION, package_dirs=folders
            )
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(**self._file)) from error
        if any(joint.nv != 1 for joint in list(self._model.joints)[1:]):
            raise MovesFreely(_JOINTS.format(**self._file))
        self._geometry.addAllCollisionPairs()
        self.joints = tuple(self._model.names)[1:]  # the first is the world
        model, self.limits = self._model, {}
        for name, joint in zip(self.joints, list(model.joints)[1:], strict=True):
            ends = (float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q]))
            self.limits[name] = ends if joint.nq == 1 else (-np.inf, np.inf)

    def overlaps(self, values: Mapping[str, float]) -> tuple[Overlap, ...]:
        """Implement `RawEngineModel`; depths are of convex shapes, by distances: `computeCollisions` misses boxes."""
        model, geometry, q = self._model, self._geometry, self._configuration(values)
        seen = geometry.createData()
        pin.updateGeometryPlacements(model, model.createData(), geometry, seen, q)
        places = [coal.Transform3s(place.rotation, place.translation) for place in seen.oMg]
        depths: dict[tuple[str, str], float] = {}
        for pair in geometry.collisionPairs:
            shapes = [geometry.geometryObjects[k] for k in (pair.first, pair.second)]
            above, below = sorted(shape.parentJoint for shape in shapes)
            solids = [self._solids[k] for k in (pair.first, pair.second)]
            if model.parents[below] == above or None in solids:
                continue
            request, found = coal.DistanceRequest(), coal.DistanceResult()
            distance = coal.distance(solids[0], places[pair.first], solids[1], places[pair.second], request, found)
            first, second = sorted(model.frames[shape.parentFrame].name for shape in shapes)
            depths[first, second] = max(depths.get((first, second), 0.0), -distance)
        return deepest_first(depths)

    def _in_code(self, values: Mapping[str, float]) -> object:
        return self._configuration(values).tolist()

    def _configuration(self, values: Mapping[str, float]) -> FloatArray:
        """Joints that turn without end are points on a circle."""
        q = np.array(pin.neutral(self._model))
        for name, joint in zip(self.joints, list(self._model.joints)[1:], strict=True):
            value = values[name]
            q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
        return q

    @cached_property
    def _solids(self) -> list[Any]:
        return [_solid(shape.geometry) for shape in self._geometry.geometryObjects]


def _solid(shape: Any) -> Any:
    """A shape whose depth can be measured, None for meshes that are not convex."""
    if not isinstance(shape, coal.BVHModelBase):
        return shape
    shape.buildConvexRepresentation(False)
    return shape.convex if shape.computeVolume() >= _CONVEX * shape.convex.computeVolume() else None
