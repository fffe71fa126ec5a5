"""Semantic description (SRDF) of a robot for MoveIt: groups, end effector, named poses, and pairs without checks.

Pairs of links are disabled by what was measured: neighbours, pairs that touch at rest, that collide in nearly all
quasi-random configurations, or in none. The rest a planner must check.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations, product
from typing import TYPE_CHECKING

import fcl
import numpy as np
from lxml import etree

from kinematify.errors import InputError
from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.rest_pairs import DepthAllowance
from kinematify.geometry.scene import judged_shapes, placed_links, read_scene, relative
from kinematify.geometry.solid import Solid
from kinematify.geometry.together import random_rows
from kinematify.manipulation.manipulator import arm_chain, found_fingers, named_fingers
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import rest_configuration, rigid_groups
from kinematify.robot.transforms import transformed
from kinematify.robot.vectors import as_one

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from lxml.etree import _Element
    from numpy.typing import NDArray

    from kinematify.config.validation import ValidationSettings
    from kinematify.geometry.scene import Pair, Scene
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, Robot

    BoolArray = NDArray[np.bool_]

ARM, GRIPPER, END_EFFECTOR = "arm", "gripper", "hand"
_ARM_JOINTS = 3  # what carries two loose ends after fewer joints is a body with doors


class DisableReason(StrEnum):
    """Words that MoveIt knows."""

    ADJACENT = "Adjacent"
    """Fixed to each other, or only joints between them."""
    DEFAULT = "Default"
    """In contact at rest without a joint between them."""
    ALWAYS = "Always"
    """In contact in nearly all configurations."""
    NEVER = "Never"
    """In contact in none of the configurations."""


@dataclass(frozen=True, kw_only=True)
class SemanticGroup:
    """A chain and the hand at its end."""

    name: str
    base: str
    tip: str
    joints: tuple[str, ...]
    """Joints of the arm that lead, from the base on."""
    fingers: tuple[str, ...]
    """Joints of the hand, followers included; none if there is no hand."""


def write_srdf(
    urdf: Path,
    path: Path,
    settings: ValidationSettings,
    *,
    tool: str | None = None,
    gripper: Sequence[str] = (),
    package_dirs: Sequence[Path] = (),
) -> Counter[str]:
    """Write the SRDF of a robot.

    Args:
        urdf: The robot.
        path: File to write.
        settings: Number of configurations, seed, and what counts as always.
        tool: Link at the end of the arm. If absent: the one that carries fingers; without any, every chain is a group.
        gripper: Joints of the fingers; found on the tool if absent.
        package_dirs: Where packages lie (``package://``).

    Returns:
        How many pairs were disabled for each reason, and ``checked``: how many stay enabled.

    Raises:
        InputError: The robot cannot be read or has no movable joint, or there is no such link or joint.
        OSError: The file cannot be written.
    """
    model = read_robot(urdf, package_dirs=package_dirs)
    groups = semantic_groups(model, urdf, tool, gripper)
    pairs, enabled = disabled_pairs(model, settings)
    document = etree.Element("robot", name=model.name)
    for group in groups:
        _add_groups(document, group)
    for group in groups:
        _add_poses(document, model, group)
    root = model.root
    etree.SubElement(document, "virtual_joint", name="world_joint", type="fixed", parent_frame="world", child_link=root)
    for joint in model.joints:
        if joint.mimic is not None:
            etree.SubElement(document, "passive_joint", name=joint.name)
    for (first, second), reason in pairs:
        etree.SubElement(document, "disable_collisions", link1=first, link2=second, reason=reason.value)
    etree.ElementTree(document).write(path, pretty_print=True, xml_declaration=True, encoding="utf-8")
    return Counter({**Counter(reason.value for _, reason in pairs), "checked": enabled})


def semantic_groups(model: Robot, urdf: Path, tool: str | None, gripper: Sequence[str]) -> tuple[SemanticGroup, ...]:
    """Find the arm and its hand, or all chains; see `write_srdf` for arguments and errors."""
    robot = model
    if not model.leaders:
        raise InputError(
            f"The robot {urdf} has no movable joint, so there is nothing to plan. Give a robot that moves."
        )
    if tool is not None and tool not in robot.link_by_name:
        raise InputError(
            f"The robot {urdf} has no link {tool!r}, which --tool names. Its links are {', '.join(robot.link_by_name)}."
        )
    tips = (tool,) if tool is not None else _likely_tips(robot)
    if tool is not None and not arm_chain(robot, tool):
        raise InputError(f"No movable joint leads to the link {tool!r} of {urdf}. Name the end of the arm with --tool.")
    fingers: Sequence[Joint] = named_fingers(robot, urdf, gripper) if gripper else ()
    return tuple(
        SemanticGroup(
            name=ARM if len(tips) == 1 else tip,
            base=robot.root,
            tip=tip,
            joints=arm_chain(robot, tip),
            fingers=tuple(joint.name for joint in fingers or found_fingers(robot, tip)),
        )
        for tip in tips
    )


def _likely_tips(robot: Robot) -> tuple[str, ...]:
    """The link that carries the fingers at the end of an arm, or else the last moving link of every chain."""
    depth = {link: len(arm_chain(robot, link)) for link in robot.link_by_name}
    hands = [link for link in depth if depth[link] >= _ARM_JOINTS and len(_single_fingers(robot, link)) > 1]
    if hands:
        return (max(hands, key=lambda link: depth[link]),)
    return tuple(joint.child for joint in robot.joints if joint.leads and not found_fingers(robot, joint.child))


def _single_fingers(robot: Robot, link: str) -> list[Joint]:
    """Movable joints on a link with nothing movable behind them, as fingers have."""
    return [
        joint
        for joint in robot.joints_below[link]
        if joint.kind is not JointType.FIXED and not found_fingers(robot, joint.child)
    ]


def disabled_pairs(
    model: Robot, settings: ValidationSettings
) -> tuple[list[tuple[tuple[str, ...], DisableReason]], int]:
    """Return the pairs of links with geometry that need no check, in the document's order, and how many stay.

    Args:
        model: The robot.
        settings: Number of configurations, seed, and what counts as always.
    """
    rows = settings.task.srdf_rows
    scene = read_scene(model, settings.geometry.model_copy(update={"random_rows": rows}))
    order = {link.name: index for index, link in enumerate(model.links)}
    judged = {tuple(sorted(pair, key=order.__getitem__)): reason for pair, reason in _link_reasons(scene, settings)}
    ranked = sorted(judged.items(), key=lambda item: [order[name] for name in item[0]])
    found = [(links, reason) for links, reason in ranked if reason is not None]
    return found, len(ranked) - len(found)


def _link_reasons(scene: Scene, settings: ValidationSettings) -> list[tuple[tuple[str, str], DisableReason | None]]:
    """Judge every pair of links with geometry; None: it must be checked."""
    shown = [[name for name in body.links if scene.model.link_by_name[name].has_geometry] for body in scene.bodies]
    found: list[tuple[tuple[str, str], DisableReason | None]] = [
        (two, DisableReason.ADJACENT) for links in shown for two in combinations(links, 2)
    ]
    overlap = OverlapQueries(scene)
    allowance = DepthAllowance(scene, overlap)
    rest = scene.mechanism.rest[None]
    poses = scene.poses(np.concatenate([rest, random_rows(scene, settings.seed)]))
    links = _LinkSolids(scene)
    for pair in scene.pairs:
        between = list(product(shown[pair[0]], shown[pair[1]]))
        if allowance.joined(pair):
            found += [(two, DisableReason.ADJACENT) for two in between]
            continue
        T = relative(poses, pair)
        hit = overlap.collide(pair, T)
        inside = pair in allowance.pairs and allowance.pairs[pair].contained
        for two in between:
            touching = links.collide(pair, two, T, hit) if len(between) > 1 else hit
            found.append((two, _reason(touching, inside=inside, always=settings.geometry.always)))
    return found


def _reason(touching: BoolArray, *, inside: bool, always: float) -> DisableReason | None:
    """Judge a pair by its contacts at rest and in the other rows, shape (1 + rows,)."""
    if touching[0] or inside:
        return DisableReason.DEFAULT
    if touching.mean() > always:
        return DisableReason.ALWAYS
    return None if touching.any() else DisableReason.NEVER


class _LinkSolids:
    """Collision trees of single links, in the frames of their bodies, where bodies have several."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._solids: dict[str, Solid] = {}

    def collide(self, pair: Pair, links: tuple[str, str], T: FloatArray, hit: BoolArray) -> BoolArray:
        """Test whether two links collide, asked where their bodies do, poses (n, 4, 4) -> (n,)."""
        found = np.zeros_like(hit)
        first, second = (self._solid(body, link) for body, link in zip(pair, links, strict=True))
        unit, request = self._scene.unit, fcl.CollisionRequest()
        fixed, moving = fcl.CollisionObject(first.tree), fcl.CollisionObject(second.tree)
        for row in np.flatnonzero(hit):
            shift = (T[row, :3, :3] @ second.middle + T[row, :3, 3] - first.middle) / unit
            moving.setTransform(fcl.Transform(T[row, :3, :3], shift))
            found[row] = fcl.collide(fixed, moving, request, fcl.CollisionResult()) > 0
        return found

    def _solid(self, body: int, link: str) -> Solid:
        if link not in self._solids:
            model, settings = self._scene.model, self._scene.settings
            group = rigid_groups(model)[self._scene.bodies[body].group]
            T = placed_links(model, group)[link]
            shapes = judged_shapes(model.link_by_name[link])
            self._solids[link] = Solid(
                *as_one((transformed(shape.mesh.vertices, T), shape.mesh.faces) for shape in shapes),
                unit=self._scene.unit,
                hole=settings.hole,
                points=settings.points,
            )
        return self._solids[link]


def _add_groups(document: _Element, group: SemanticGroup) -> None:
    arm = etree.SubElement(document, "group", name=group.name)
    etree.SubElement(arm, "chain", base_link=group.base, tip_link=group.tip)
    if group.fingers:
        hand = etree.SubElement(document, "group", name=GRIPPER)
        for joint in group.fingers:
            etree.SubElement(hand, "joint", name=joint)
        etree.SubElement(
            document, "end_effector", name=END_EFFECTOR, parent_link=group.tip, group=GRIPPER, parent_group=group.name
        )


def _add_poses(document: _Element, model: Robot, group: SemanticGroup) -> None:
    """Rest and the middle of the limits of the arm; the ends of the fingers."""
    joints = model.joint_by_name
    rest = rest_configuration(model)
    middle = {
        name: 0.5 * (joints[name].lower + joints[name].upper)
        if np.isfinite(joints[name].upper - joints[name].lower)
        else rest[name]
        for name in group.joints
    }
    _add_pose(document, "rest", group.name, {name: rest[name] for name in group.joints})
    _add_pose(document, "middle", group.name, middle)
    leaders = [name for name in group.fingers if joints[name].mimic is None and np.isfinite(joints[name].upper)]
    if leaders:
        _add_pose(document, "lower", GRIPPER, {name: joints[name].lower for name in leaders})
        _add_pose(document, "upper", GRIPPER, {name: joints[name].upper for name in leaders})


def _add_pose(document: _Element, name: str, group: str, values: dict[str, float]) -> None:
    state = etree.SubElement(document, "group_state", name=name, group=group)
    for joint, value in values.items():
        etree.SubElement(state, "joint", name=joint, value=repr(float(value) + 0.0))
