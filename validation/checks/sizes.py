"""KV157 and KV158: sizes that only a slip of units explains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.robot import forward_kinematics
from kinematify.validation.finding import Blame, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.config.validation import FileSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link, Robot
    from kinematify.validation.stage import OpenCheck


@dataclass(frozen=True, kw_only=True, eq=False)
class _Extent:
    """The room that the geometry of a link takes."""

    link: Link
    diagonal: float
    """[m], independent of the link's pose."""
    low: FloatArray
    """World frame at zero [m], shape (3,)."""
    high: FloatArray

    @property
    def has_file(self) -> bool:
        """True if a mesh file belongs to it."""
        return any(shape.file is not None for shape in (*self.link.visuals, *self.link.collisions))

    @property
    def line(self) -> int:
        """Line of its first shape."""
        return min(shape.line for shape in (*self.link.visuals, *self.link.collisions))


def check_unit_slips(model: Robot, settings: FileSettings, check: OpenCheck) -> None:
    """KV157: a link out of all proportion to the others, or far away from its parent."""
    extents = _extents(model)
    for name, extent in extents.items():
        others = max((other.diagonal for key, other in extents.items() if key != name), default=0.0)
        # Of two sizes that do not go together, the one that no part of a machine has is the wrong one.
        too_large = 0.0 < others * settings.oversize < extent.diagonal
        too_small = extent.has_file and 0.0 < extent.diagonal * settings.undersize < others
        if too_large and (extent.diagonal > settings.large or others >= settings.tiny):
            _tell_out_of_proportion(check, extent, others, settings.oversize)
        elif too_small and others <= settings.large:
            _tell_out_of_proportion(check, extent, others, 1.0 / settings.undersize)
    if max((extent.diagonal for extent in extents.values()), default=0.0) < settings.tiny:
        return  # all meshes are in another unit, which the size of the model tells; no origin is to blame
    for joint, gap, size in _gaps(model, extents):
        if gap > settings.apart * size:
            check.find(
                f"The joint {joint} holds its link {gap:.4g} m away from the link above, which is {gap / size:.0f} "
                f"times the sizes of both ({size:.3g} m).",
                "Write the origin of the joint in metres; it looks like millimetres or centimetres.",
                blame=Blame.KINEMATICS,
                joint=joint,
                link=model.joint_by_name[joint].child,
                value=gap,
                limit=settings.apart * size,
                unit="m",
                line=model.joint_by_name[joint].line,
            )


def _tell_out_of_proportion(check: OpenCheck, extent: _Extent, others: float, factor: float) -> None:
    ratio = extent.diagonal / others
    words = f"{ratio:.0f} times as large as" if ratio > 1 else f"{1 / ratio:.0f} times smaller than"
    check.find(
        f"The geometry of the link {extent.link.name} measures {extent.diagonal:.4g} m, {words} the largest other link "
        f"({others:.3g} m): its mesh is in another unit.",
        f'Write scale="{" ".join([_likely_factor(ratio)] * 3)}" for its meshes, or export them in metres.',
        link=extent.link.name,
        value=extent.diagonal,
        limit=others * factor,
        unit="m",
        line=extent.line,
    )


def _likely_factor(ratio: float) -> str:
    if ratio > 1.0:
        return "0.001"
    return "1000" if ratio < 1e-2 else "1"


def check_model_size(model: Robot, settings: FileSettings, check: OpenCheck) -> None:
    """KV158: the diagonal of the whole model."""
    extents = _extents(model)
    if not extents:
        return
    low = np.min([extent.low for extent in extents.values()], axis=0)
    high = np.max([extent.high for extent in extents.values()], axis=0)
    size = float(np.linalg.norm(high - low))
    check.measured["diagonal_m"] = size
    largest = max(extents.values(), key=lambda extent: extent.diagonal)
    moves = any(joint.kind != "fixed" for joint in model.joints)
    # Joints in metres hold even the tiniest meshes apart, so that the largest link tells whether all are too small.
    shrunken = largest.diagonal < settings.tiny
    if shrunken or size < settings.small or size > settings.large:
        certain = shrunken or (size > settings.huge and moves)
        too_large = size > settings.large and not shrunken
        check.find(
            f"The model measures {size:.4g} m across; its largest link is {largest.link.name} with "
            f"{largest.diagonal:.4g} m. URDF lengths are metres.",
            'Write scale="0.001 0.001 0.001" for meshes in millimetres (0.01 for centimetres), or export in metres.'
            if too_large
            else "Leave out the scale of meshes that are in metres already, or export in metres.",
            severity=Severity.ERROR if certain else Severity.WARNING,
            link=largest.link.name,
            value=largest.diagonal if shrunken else size,
            limit=settings.large if too_large else settings.tiny if shrunken else settings.small,
            unit="m",
            line=largest.line,
        )


def _extents(model: Robot) -> dict[str, _Extent]:
    """Keyed by link; links without geometry are left out."""
    found = {}
    poses = forward_kinematics(model, {})
    for link in model.links:
        clouds = [shape.mesh.vertices for shape in (*link.visuals, *link.collisions) if len(shape.mesh.vertices)]
        if clouds:
            points = np.concatenate(clouds)
            placed = points @ poses[link.name][:3, :3].T + poses[link.name][:3, 3]
            found[link.name] = _Extent(
                link=link,
                diagonal=float(np.linalg.norm(np.ptp(points, axis=0))),
                low=placed.min(axis=0),
                high=placed.max(axis=0),
            )
    return found


def _gaps(model: Robot, extents: dict[str, _Extent]) -> Iterator[tuple[str, float, float]]:
    """Joint above a link, distance of its bounding box from that of the next link above with one, sum of sizes [m]."""
    above = model.joint_above
    for name, extent in extents.items():
        joints = []
        place = name
        while place in above and (place == name or place not in extents):
            joints.append(above[place])
            place = above[place].parent
        if joints and place in extents:
            parent = extents[place]
            gap = np.maximum(0.0, np.maximum(extent.low - parent.high, parent.low - extent.high))
            farthest = max(joints, key=lambda joint: float(np.linalg.norm(joint.T_parent_child[:3, 3])))
            yield farthest.name, float(np.linalg.norm(gap)), extent.diagonal + parent.diagonal
