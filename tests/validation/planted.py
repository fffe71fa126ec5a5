"""Known objects as URDF files, with joints changed on the way, and what the evidence stage says of them."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from kinematify.config import load_config
from kinematify.config.validation import load_settings
from kinematify.contact.tree import KinematicTree
from kinematify.joints.candidate import JointEstimate
from kinematify.model.build import build_model
from kinematify.model.urdf import write_urdf
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rotation_about
from kinematify.validation.checks import CHECKS
from kinematify.validation.finding import CheckResult, Finding, JointSummary
from kinematify.validation.run.needs import Recorder, joints
from kinematify.validation.stage import StageRequest
from tests.known import KnownJoint, KnownObject

SELECTED = frozenset(CHECKS)
FindingGroup = list[CheckResult | JointSummary]


def write(known: KnownObject, folder: Path) -> Path:
    """Write a known object as a URDF."""
    index = known.index
    parents = [-1] * len(known.parts)
    for joint in known.joints:
        parents[index[joint.child]] = index[joint.parent]
    tree = KinematicTree(parents=tuple(parents))
    by_child = {index[joint.child]: joint for joint in known.joints}
    estimates = tuple(_estimate(index, by_child[child]) for _, child in tree.edges())
    model = build_model(known.assembly, tree, estimates, name=known.name, config=load_config().model)
    folder.mkdir(exist_ok=True)
    return write_urdf(model, folder)


def _estimate(index: dict[str, int], joint: KnownJoint) -> JointEstimate:
    return JointEstimate(
        parent=index[joint.parent],
        child=index[joint.child],
        kind=joint.kind,
        axis=joint.axis,
        pivot=joint.pivot,
        lower=joint.lower,
        upper=joint.upper,
        confidence=1.0,
    )


def reported(urdf: Path, folder: Path, *, seconds: float = 100.0) -> FindingGroup:
    """Run the evidence stage on a URDF."""
    results: FindingGroup = []
    request = StageRequest(
        urdf=urdf,
        package_dirs=(),
        work=folder,
        settings=load_settings(),
        selected=SELECTED,
        deadline=time.process_time() + seconds,
    )
    joints(request, Recorder(results.append, request))
    return results


def judged(known: KnownObject, folder: Path) -> FindingGroup:
    """Write a known object and run the evidence stage on it."""
    return reported(write(known, folder), folder)


def findings(results: FindingGroup) -> list[Finding]:
    """All findings of a stage."""
    return [finding for result in results if isinstance(result, CheckResult) for finding in result.findings]


def with_joint(known: KnownObject, child: str, **changes: object) -> KnownObject:
    """The object with fields of the joint above `child` replaced."""
    joints = tuple(replace(joint, **changes) if joint.child == child else joint for joint in known.joints)
    return replace(known, joints=joints)


def joint_of(known: KnownObject, child: str) -> KnownJoint:
    """The joint above a part."""
    return next(joint for joint in known.joints if joint.child == child)


def turned(known: KnownObject, child: str, degrees: float, about: tuple[float, float, float]) -> KnownObject:
    """The object with the axis of the joint above `child` turned."""
    axis = joint_of(known, child).axis
    return with_joint(
        known, child, axis=rotation_about(np.array(about) / np.linalg.norm(about), np.radians(degrees)) @ axis
    )


def shifted(known: KnownObject, child: str, direction: tuple[float, float, float], share: float = 0.2) -> KnownObject:
    """The object with the pivot above `child` moved by a share of the part's size."""
    part = known.parts[known.index[child]]
    way = np.array(direction) / np.linalg.norm(direction)
    return with_joint(known, child, pivot=joint_of(known, child).pivot + share * part.diagonal * way)


def swapped(known: KnownObject, child: str, limits: tuple[float, float]) -> KnownObject:
    """The object with the type of the joint above `child` swapped."""
    kind = JointType.REVOLUTE if joint_of(known, child).kind is JointType.PRISMATIC else JointType.PRISMATIC
    return with_joint(known, child, kind=kind, lower=limits[0], upper=limits[1])


def flipped(known: KnownObject, child: str) -> KnownObject:
    """The object with the axis of the joint above `child` reversed."""
    return with_joint(known, child, axis=-joint_of(known, child).axis)
