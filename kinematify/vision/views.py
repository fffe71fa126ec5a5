"""From where a part is looked at: the two points of view that show most of it, see-through where it stays hidden."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.render.camera import fit_camera
from kinematify.render.picture import PictureScene, PosedMesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import VisionConfig
    from kinematify.joints.candidate import JointCandidate
    from kinematify.render.camera import Camera
    from kinematify.robot.arrays import FloatArray

_AZIMUTHS = np.radians(22.5 + 45.0 * np.arange(8))  # never straight at a face: depth would not show
_HEIGHTS = np.radians([-20.0, 20.0, 50.0])
_PROBE = 64  # [pixels] side of the pictures that are compared
_APART = np.cos(np.radians(40.0))  # two views from nearly the same place say the same
_HIDDEN = 0.4  # a part of whose outline less is seen counts as hidden
_ROOM = 0.22  # of the part's diagonal: what is around it is shown, too
_MARGIN = 8  # [pixels]


@dataclass(frozen=True, kw_only=True)
class Viewpoint:
    """A point of view."""

    azimuth: float
    """Where the camera stands, from x towards y [rad]."""
    elevation: float
    """[rad]"""

    def camera(self, points: FloatArray, side: int, config: VisionConfig) -> Camera:
        """A camera that shows points, shape (n, 3) [m], in a square picture of this side [pixels]."""
        return fit_camera(
            points, azimuth=self.azimuth, elevation=self.elevation, size=(side, side),
            field_of_view=float(np.radians(config.field_of_view)), margin=min(_MARGIN, side // 8),
        )  # fmt: skip

    @property
    def towards(self) -> FloatArray:
        """Unit direction from the object to the camera, shape (3,)."""
        level = np.cos(self.elevation)
        return np.array([np.cos(self.azimuth) * level, np.sin(self.azimuth) * level, np.sin(self.elevation)])


@dataclass(frozen=True, kw_only=True, eq=False)
class Viewpoints:
    """Where to look at one part from."""

    best: Viewpoint
    second: Viewpoint
    see_through: bool
    """Most of the part is hidden from everywhere."""


def around(assembly: Assembly, parts: Sequence[int]) -> FloatArray:
    """Corners of the box of some parts with room around them [m], shape (8, 3)."""
    low = np.min([assembly.parts[index].bounds[0] for index in parts], axis=0)
    high = np.max([assembly.parts[index].bounds[1] for index in parts], axis=0)
    room = _ROOM * float(np.linalg.norm(high - low))
    return corners(low - room, high + room)


def corners(low: FloatArray, high: FloatArray) -> FloatArray:
    """Corners of a box, shape (8, 3)."""
    picks = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
    return np.where(picks, high, low)


def part_pixels(whole: PictureScene, alone: PictureScene, part: int, camera: Camera) -> tuple[int, int]:
    """Pixels of a part that are seen, and those of its whole outline.

    Args:
        whole: One mesh per part.
        alone: The part's mesh only.
        part: Its index.
        camera: From where.
    """
    return int(whole.visible_pixels(camera)[part]), int(alone.visible_pixels(camera)[0])


def find_viewpoints(
    assembly: Assembly, child: int, options: Sequence[JointCandidate], config: VisionConfig
) -> Viewpoints:
    """Choose among 8 azimuths and 3 heights the two views that show most of a part and of its motions.

    Args:
        assembly: The parts, z up.
        child: The one that moves.
        options: Its possible motions; their axes should not point at the viewer.
        config: Opening angle.
    """
    mesh_of = [PosedMesh(vertices=item.vertices, faces=item.faces, color=np.ones(3)) for item in assembly.parts]
    whole, alone = PictureScene(meshes=tuple(mesh_of)), PictureScene(meshes=(mesh_of[child],))
    region = around(assembly, [child])
    views = [Viewpoint(azimuth=float(a), elevation=float(e)) for e in _HEIGHTS for a in _AZIMUTHS]
    counted = [part_pixels(whole, alone, child, view.camera(region, _PROBE, config)) for view in views]
    clear = np.array([_clarity(view, options) for view in views])
    seen, outline = (np.array([count[k] for count in counted], dtype=np.float64) for k in (0, 1))
    best = int(np.argmax(seen * clear))
    see_through = bool(seen[best] < _HIDDEN * outline[best])
    worth = (outline if see_through else seen) * clear
    best = int(np.argmax(worth))
    apart = np.array([float(view.towards @ views[best].towards) < _APART for view in views])
    second = int(np.argmax(np.where(apart, worth, -1.0)))
    return Viewpoints(best=views[best], second=views[second], see_through=see_through)


def _clarity(view: Viewpoint, options: Sequence[JointCandidate]) -> float:
    """Rate how well motions are seen from a point, in [0, 1]: slides from the side, turns neither along nor across."""
    if not options:
        return 1.0
    along = np.array([abs(float(item.axis @ view.towards)) for item in options])
    across = np.sqrt(np.maximum(1.0 - along**2, 0.0))
    turns = np.array([item.kind.turns for item in options])
    return float(np.mean(np.where(turns, 0.5 + along * across, across)))
