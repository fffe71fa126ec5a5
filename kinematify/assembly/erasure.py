"""Erasing the kinematics of a robot: anonymous rigid parts in one pose, and the truth beside them.

The protocol of the benchmark: links joined by fixed joints are one part, vertices are baked into world coordinates,
order and names are shuffled. A part is a rigid group that has geometry. Movable links without geometry (the hidden
cross of a universal joint) are no parts: the joints on both sides of them become a chain between two parts.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Assembly, Part
from kinematify.assembly.pieces import baked
from kinematify.assembly.truth import GroundTruth, TrueJoint
from kinematify.errors import DescriptionError, OutputError
from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import sides
from kinematify.robot.obj_file import write_obj
from kinematify.robot.robot import Robot, forward_kinematics, joint_values, rest_configuration, rigid_groups
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Container, Mapping, Sequence

    from numpy.random import Generator

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, RigidGroup

    _Way = tuple[str, list[tuple[Joint, bool]]]
    """Top link of the group that a way begins at, and its joints: False where it leads from child to parent link."""


__all__ = ["ErasedModel", "GroundTruth", "TrueJoint", "erase", "truth_path", "write_erased"]

POSES = ("rest", "random")
RANDOM_SHARE = 0.3
"""Largest motion of a joint in a random pose, as a share of half its range (the benchmark's protocol).

A continuous joint counts as one with the range -180 to 180 deg."""


@dataclass(frozen=True, kw_only=True)
class ErasedModel:
    """Assembly that a method may see, and the truth that it must not."""

    parts: tuple[Part, ...]
    """World frame of the erased pose; part i is node i of the truth."""
    truth: GroundTruth

    @property
    def assembly(self) -> Assembly:
        """The parts alone."""
        return Assembly(parts=self.parts, source="erased model")


def erase(
    robot: Robot, *, pose: str = "rest", seed: int = 0, yaw_deg: float = 0.0, shuffle: bool = True
) -> ErasedModel:
    """Turn a description into anonymous rigid parts and the ground truth about their joints.

    The root part is the first rigid group with geometry below the root link; joints above it move nothing against
    anything and are listed in the truth as dropped, as are joints that carry no geometry.

    Args:
        robot: The robot.
        pose: ``rest`` (`rest_configuration`), or ``random``: each joint moved by up to 30 % of half its range
            around rest, within its limits, followers following.
        seed: Draws the random pose and the order of parts, vertices and faces.
        yaw_deg: Turn of everything about the world's z axis [deg].
        shuffle: False keeps parts (parents first), vertices and faces in the order of the description.

    Raises:
        DescriptionError: `pose` is unknown, or no link has geometry.
    """
    pose_random, order_random = (np.random.default_rng([seed, stream]) for stream in range(2))
    q = _configuration(robot, pose, pose_random)
    T_world_link = _turned(forward_kinematics(robot, q), np.deg2rad(yaw_deg))
    groups = [group for group in rigid_groups(robot) if group.has_geometry]
    if not groups:
        raise DescriptionError(f"No link of {robot.name} has geometry, so there is no part to erase it to.")
    order = order_random.permutation(len(groups)) if shuffle else np.arange(len(groups))
    shown = [groups[k] for k in order]
    meshes = [baked(robot, group, T_world_link) for group in shown]
    parts = [Part(name=f"part_{k:03d}", vertices=mesh.vertices, faces=mesh.faces) for k, mesh in enumerate(meshes)]
    if shuffle:
        parts = [_scrambled(part, order_random) for part in parts]
    index = {group.top: k for k, group in enumerate(shown)}
    joints = _true_joints(_ways(robot, groups), index, q, T_world_link)
    used = {joint.source for joint in joints}
    truth = GroundTruth(
        name=robot.name,
        part_names=tuple(part.name for part in parts),
        part_links=tuple(group.links for group in shown),
        joints=joints,
        dropped=tuple(name for name in q if name not in used),
        configuration=q,
        pose=pose,
        seed=seed,
        yaw_deg=yaw_deg,
    )
    return ErasedModel(parts=tuple(parts), truth=truth)


def write_erased(erased: ErasedModel, folder: Path, *, overwrite: bool = False) -> Path:
    """Write ``part_000.obj`` and so on into a new folder, without loss, and the truth as ``FOLDER.truth.json``.

    Args:
        erased: What to write.
        folder: Does not exist yet, or is empty.
        overwrite: Replace the parts and the truth that an earlier call wrote there.

    Returns:
        The path of the truth.

    Raises:
        OutputError: The folder or the truth exists already, or cannot be written. Nothing is left half-written.
    """
    target, truth_file = folder.absolute(), truth_path(folder)
    if overwrite and truth_file.is_file() and target.is_dir():
        if any(not re.fullmatch(r"part_\d+\.obj", item.name) for item in target.iterdir()):
            raise OutputError(f"The output {folder} holds more than erased parts, so --force leaves it. Remove it.")
        shutil.rmtree(target)
        truth_file.unlink()
    if truth_file.exists() or (target.exists() and not (target.is_dir() and not any(target.iterdir()))):
        raise OutputError(
            f"The output {folder} (or the truth {truth_file.name} beside it) exists already. Remove both, or give "
            "another folder."
        )
    try:
        _write_aside_and_rename(erased, target, truth_file)
    except OSError as error:
        raise OutputError(
            f"The output {folder} cannot be written ({error.strerror}). Give a writable folder on a disk with space."
        ) from error
    return truth_file


def _configuration(robot: Robot, pose: str, random: Generator) -> dict[str, float]:
    """Value of every movable joint."""
    if pose not in POSES:
        raise DescriptionError(f"The pose {pose!r} is unknown. Choose one of {', '.join(POSES)}.")
    values = rest_configuration(robot)
    if pose == "random":
        values = joint_values(robot, {j.name: _moved(j, values[j.name], random) for j in robot.leaders})
    return {j.name: values[j.name] for j in robot.joints if j.kind is not JointType.FIXED}


def _moved(joint: Joint, rest: float, random: Generator) -> float:
    half_range = np.pi if joint.kind is JointType.CONTINUOUS else 0.5 * (joint.upper - joint.lower)
    step = RANDOM_SHARE * half_range * random.uniform(-1.0, 1.0)
    return float(np.clip(rest + step, joint.lower, joint.upper))


def _turned(T_world_link: Mapping[str, FloatArray], yaw: float) -> dict[str, FloatArray]:
    turn = np.eye(4)
    if yaw != 0.0:
        turn[:3, :3] = rotation_about(np.array([0.0, 0.0, 1.0]), yaw)
    return {link: turn @ transform for link, transform in T_world_link.items()}


def _scrambled(part: Part, random: Generator) -> Part:
    """The same surface with vertices, faces and the first corner of each face in random order."""
    vertex_order = random.permutation(len(part.vertices))
    faces = np.argsort(vertex_order)[part.faces[random.permutation(len(part.faces))]]
    corners = (random.integers(3, size=len(faces))[:, None] + np.arange(3)) % 3
    return Part(name=part.name, vertices=part.vertices[vertex_order], faces=np.take_along_axis(faces, corners, axis=1))


def _true_joints(
    ways: Mapping[str, _Way], index: Mapping[str, int], q: Mapping[str, float], T_world_link: Mapping[str, FloatArray]
) -> tuple[TrueJoint, ...]:
    """Joints between parts; `index` is the part of a group's top link."""
    seen: Counter[str] = Counter()
    joints = []
    for top, (start, steps) in ways.items():
        for serial, (described, downward) in enumerate(steps):
            # A joint between empty links that several parts hang on stands in several chains.
            seen[described.name] += 1
            copy = seen[described.name]
            joint = _true_joint(described, q[described.name], T_world_link, downward=downward)
            joints.append(
                replace(
                    joint,
                    name=joint.source if copy == 1 else f"{joint.source}#{copy}",
                    parent=index[start],
                    child=index[top],
                    serial=serial,
                    chain_length=len(steps),
                )
            )
    return tuple(joints)


def _true_joint(joint: Joint, value: float, T_world_link: Mapping[str, FloatArray], *, downward: bool) -> TrueJoint:
    """The joint in the world frame, ends still open; walked against its direction, its axis points the other way."""
    sign = 1.0 if downward else -1.0
    # The child's frame moves about or along the axis, so that its origin and the axis in it stay on the line.
    T_world_child = T_world_link[joint.child]
    return TrueJoint(
        name=joint.name,
        source=joint.name,
        kind=joint.kind,
        parent=-1,
        child=-1,
        axis=sign * (T_world_child[:3, :3] @ joint.axis),
        pivot=T_world_child[:3, 3],
        lower=joint.lower - value,
        upper=joint.upper - value,
        value=value,
        mimic=joint.mimic,
    )


def _ways(robot: Robot, groups: Sequence[RigidGroup]) -> dict[str, _Way]:
    """The way to every group with geometry but the first, from its parent group; keyed by the group's top link."""
    top_of = {link: group.top for group in rigid_groups(robot) for link in group.links}
    root, *others = (group.top for group in groups)
    return {top: _way(robot, top, root, top_of, {root, *others}) for top in others}


def _way(robot: Robot, top: str, root: str, top_of: Mapping[str, str], solid: Container[str]) -> _Way:
    """The way from the nearest group with geometry above, or from the root part where all above is empty."""
    steps: list[tuple[Joint, bool]] = []
    start = top
    while start in robot.joint_above:
        joint = robot.joint_above[start]
        steps.insert(0, (joint, True))
        start = top_of[joint.parent]
        if start in solid:
            return start, steps
    climb, descent = sides(robot, (root, top))
    steps = [*((joint, False) for joint in reversed(climb)), *((joint, True) for joint in descent)]
    return root, [step for step in steps if step[0].kind is not JointType.FIXED]


TRUTH_SUFFIX = ".truth.json"
"""Files that end so are the benchmark's business; `load_assembly` opens none of them."""


def truth_path(folder: Path) -> Path:
    """Return where the truth about the parts in `folder` is kept."""
    absolute = folder.absolute()
    return absolute.with_name(absolute.name + TRUTH_SUFFIX)


def _write_aside_and_rename(erased: ErasedModel, target: Path, truth_file: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{target.name}-", dir=target.parent) as folder:
        truth, parts = Path(folder, "truth"), Path(folder, "parts")
        parts.mkdir()
        for part in erased.parts:
            write_obj(parts / f"{part.name}.obj", part.vertices, part.faces)
        truth.write_text(erased.truth.to_json(), encoding="utf-8")
        truth.rename(truth_file)
        parts.rename(target)
