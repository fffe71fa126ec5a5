"""A file in Pinocchio as `buildModelFromUrdf` and `buildGeomFromUrdf` read it."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import coal
import numpy as np
import pinocchio as pin

from kinematify.simulation.raw_model import MovesFreely, RawEngineModel, Reproductions, Unloadable, deepest_first

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.raw_model import Overlap

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
    """See `RawEngineModel`; what a joint connects is not looked at for overlaps."""

    code = Reproductions(joints=_JOINTS, overlap=_OVERLAP)

    def __init__(self, urdf: Path, root: str, package_dirs: Sequence[Path]) -> None:
        """Load it; paths of meshes are relative to its folder.

        Raises:
            Unloadable: Pinocchio does not open it.
            MovesFreely: It moves a link in other ways than by turning or sliding.
        """
        del root
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
        """See `RawEngineModel`; depths are told of convex shapes, by distances: `computeCollisions` misses boxes."""
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
    """A shape whose depth can be told, None for meshes that are not convex."""
    if not isinstance(shape, coal.BVHModelBase):
        return shape
    shape.buildConvexRepresentation(False)
    return shape.convex if shape.computeVolume() >= _CONVEX * shape.convex.computeVolume() else None
