"""A file in Pinocchio as `buildModelFromUrdf` and `buildGeomFromUrdf` read it."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import coal
import numpy as np
import pinocchio as pin

from kinematify.simulation.loaded_file import Unloadable, deepest_first

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.simulation.loaded_file import Overlap

_CONVEX = 0.99
"""Volume of a mesh that counts as convex, fraction of its hull's."""


class PinocchioFile:
    """See `kinematify.simulation.loaded_file.LoadedFile`; what a joint connects is not looked at for overlaps."""

    def __init__(self, urdf: Path, root: str, package_dirs: Sequence[Path]) -> None:
        """Load it; paths of meshes are relative to its folder.

        Raises:
            Unloadable: Pinocchio does not open it.
        """
        del root
        folders = [str(folder) for folder in (urdf.parent, *package_dirs)]
        try:
            self._model = pin.buildModelFromUrdf(str(urdf))
            self._geometry = pin.buildGeomFromUrdf(
                self._model, str(urdf), pin.GeometryType.COLLISION, package_dirs=folders
            )
        except ValueError as error:
            raise Unloadable(" ".join(str(error).split())) from error
        self._geometry.addAllCollisionPairs()
        self.joints: Sequence[str] = tuple(self._model.names)[1:]  # the first is the world

    @cached_property
    def limits(self) -> Mapping[str, tuple[float, float]]:
        """See `LoadedFile`."""
        model, found = self._model, {}
        for name, joint in zip(self.joints, list(model.joints)[1:], strict=True):
            ends = (float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q]))
            found[name] = ends if joint.nq == 1 else (-np.inf, np.inf)
        return found

    def overlaps(self, values: Mapping[str, float]) -> tuple[Overlap, ...]:
        """See `LoadedFile`; depths are told of convex shapes, by distances: `computeCollisions` misses boxes."""
        model, geometry, q = self._model, self._geometry, pin.neutral(self._model)
        for name, joint in zip(self.joints, list(model.joints)[1:], strict=True):
            value = values[name]
            q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
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

    @cached_property
    def _solids(self) -> list[Any]:
        return [_solid(shape.geometry) for shape in self._geometry.geometryObjects]


def _solid(shape: Any) -> Any:
    """A shape whose depth can be told, None for meshes that are not convex."""
    if not isinstance(shape, coal.BVHModelBase):
        return shape
    shape.buildConvexRepresentation(False)
    return shape.convex if shape.computeVolume() >= _CONVEX * shape.convex.computeVolume() else None
