"""KV157 and KV158: sizes that only a slip of units explains."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.validation.check import check
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from kinematify.validation.asset.mesh_look import Extent, MeshContext
    from kinematify.validation.check import OpenCheck

_MILLIMETRES = 1000.0
"""Factor of the usual slip."""


def _whole(look: MeshContext) -> str | None:
    """Every mesh that collides."""
    return "a mesh is missing, so that nobody knows how large its link is" if look.model.lacking else None


@check(
    "KV157",
    title="Links are in the same unit",
    fails="A link is in another unit than the others",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    needs=(_whole,),
)
def unit_slips(result: OpenCheck, look: MeshContext) -> None:
    """No link is more than `oversize` times as large as the largest other one, none with a mesh file `undersize` times
    smaller, unless 1000 times its size is beyond `large` (a button of a lorry); no link is farther from its parent
    than `apart` times the sizes of both (the cause is the joint).

    Why it matters: A mesh in millimetres beside others in metres is the most frequent mistake of exporters; so are
    origins that were not converted.

    Remedy: Write the factor to metres as the scale of the mesh, and origins in metres.
    """
    settings, extents = look.settings, look.extents
    for name, extent in extents.items():
        others = max((other.diagonal for key, other in extents.items() if key != name), default=0.0)
        # Of two sizes that do not go together, the one that no part of a machine has is the wrong one.
        too_large = 0.0 < others * settings.oversize < extent.diagonal
        too_small = extent.has_file and 0.0 < extent.diagonal * settings.undersize < others
        if too_large and (extent.diagonal > settings.large or others >= settings.tiny):
            _tell_out_of_proportion(result, extent, others, settings.oversize)
        elif too_small and others <= settings.large and extent.diagonal * _MILLIMETRES <= settings.large:
            _tell_out_of_proportion(result, extent, others, 1.0 / settings.undersize)
    if max((extent.diagonal for extent in extents.values()), default=0.0) < settings.tiny:
        return  # all meshes are in another unit, which the size of the model tells; no origin is the cause
    for joint, gap, size in look.gaps:
        if gap > settings.apart * size:
            result.find(
                f"The joint {joint} holds its link {gap:.4g} m away from the link above, which is {gap / size:.0f} "
                f"times the sizes of both ({size:.3g} m).",
                "Write the origin of the joint in metres; it looks like millimetres or centimetres.",
                cause=Cause.KINEMATICS,
                joint=joint,
                link=look.model.joint_by_name[joint].child,
                value=gap,
                limit=settings.apart * size,
                unit="m",
                line=look.model.joint_by_name[joint].line,
            )


def _tell_out_of_proportion(result: OpenCheck, extent: Extent, others: float, factor: float) -> None:
    ratio = extent.diagonal / others
    words = f"{ratio:.0f} times as large as" if ratio > 1 else f"{1 / ratio:.0f} times smaller than"
    result.find(
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


@check(
    "KV158",
    title="The model has a plausible size",
    fails="The model has an implausible size",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    needs=(_whole,),
)
def model_size(result: OpenCheck, look: MeshContext) -> None:
    """The diagonal of the model at zero lies between `small` and `large`; above `huge` it is an error if the model has
    joints that move, and so is a largest link below `tiny`.

    Why it matters: Gravity, friction and contact parameters of engines are made for metres: a cabinet of 2 km falls
    in slow motion.

    Remedy: Convert all meshes and origins to metres.
    """
    settings, extents = look.settings, look.extents
    if not extents:
        return
    low = np.min([extent.low for extent in extents.values()], axis=0)
    high = np.max([extent.high for extent in extents.values()], axis=0)
    size = float(np.linalg.norm(high - low))
    result.measured["diagonal_m"] = size
    largest = max(extents.values(), key=lambda extent: extent.diagonal)
    moves = any(joint.kind is not JointType.FIXED for joint in look.model.joints)
    # Joints in metres hold even the tiniest meshes apart, so that the largest link tells whether all are too small.
    shrunken = largest.diagonal < settings.tiny
    if shrunken or size < settings.small or size > settings.large:
        certain = shrunken or (size > settings.huge and moves)
        too_large = size > settings.large and not shrunken
        result.find(
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
