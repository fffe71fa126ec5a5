"""The numbered motions among which a question lets somebody choose: few, and distinct to the eye."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import JointCandidate
from kinematify.refinement.candidates import is_same
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Part
    from kinematify.config import VisionConfig
    from kinematify.joints.candidate import JointEstimate


def offered(joint: JointEstimate, part: Part, config: VisionConfig) -> tuple[JointCandidate, ...]:
    """Candidates of a joint that differ in type, axis or line, best first; the chosen one first where it moves.

    Args:
        joint: With its alternatives.
        part: That moves.
        config: `options`, `same_axis_deg` and `same_line`.
    """
    own = chosen_candidate(joint)
    ranked = [item for item in joint.alternatives if own is None or not is_same(joint, item)]
    kept: list[JointCandidate] = []
    for item in [*([] if own is None else [own]), *ranked]:
        if not any(look_alike(item, other, part.diagonal, config) for other in kept):
            kept.append(item)
    shown = kept[: config.options]
    # Both types are offered where both were proposed: the type is what geometry is least sure of.
    missing = [item for item in kept[config.options :] if all(item.kind.turns != one.kind.turns for one in shown)]
    return tuple([*shown[:-1], missing[0]] if missing else shown)


def chosen_candidate(joint: JointEstimate) -> JointCandidate | None:
    """Return what was chosen, as a candidate; None if it is fixed."""
    if joint.kind is JointType.FIXED:
        return None
    known = next((item for item in joint.alternatives if is_same(joint, item)), None)
    if known is not None:
        return known
    kind = JointType.REVOLUTE if joint.kind.turns else JointType.PRISMATIC
    return JointCandidate(kind=kind, axis=joint.axis, pivot=joint.pivot, score=0.0, source="chosen")


def look_alike(one: JointCandidate, other: JointCandidate, size: float, config: VisionConfig) -> bool:
    """True if two candidates of a part of this diagonal [m] cannot be distinguished in a picture."""
    if one.kind.turns != other.kind.turns:
        return False
    if abs(float(one.axis @ other.axis)) < np.cos(np.radians(config.same_axis_deg)):
        return False
    apart = float(np.linalg.norm(np.cross(other.pivot - one.pivot, one.axis)))
    return not one.kind.turns or apart < config.same_line * size


def shuffled(options: Sequence[JointCandidate], key: str) -> tuple[JointCandidate, ...]:
    """The options in an order that does not tell which one geometry prefers; the same key gives the same order."""
    order = np.random.default_rng(list(key.encode())).permutation(len(options))
    return tuple(options[int(index)] for index in order)
