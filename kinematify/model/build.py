"""From a tree with joints to a kinematic model: frames, names, limits, mass properties."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Part
from kinematify.geometry.convex import convex_hull, thickened
from kinematify.model.kinematic_model import KinematicModel, ModelLink
from kinematify.model.masses import inertial_of
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Joint
from kinematify.robot.transforms import pose_at
from kinematify.robot.vectors import referenced

_SNAP = 1e-3  # [rad] fits of bearings are off by 0.02 deg in the median

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import ModelConfig
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.candidate import JointEstimate
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial


def build_model(
    assembly: Assembly,
    tree: KinematicTree,
    joints: Sequence[JointEstimate],
    *,
    name: str,
    config: ModelConfig,
) -> KinematicModel:
    """Put links and joints together (paper III-A, the articulated model ``M``).

    The root link's frame is the world frame of the input; every other link frame has world orientation and its origin
    at the pivot of its joint, so that zero configuration reproduces the input. Set-aside parts ride on the link that
    is named as their nearest.

    Args:
        assembly: The parts.
        tree: Directed spanning tree over them.
        joints: One estimate for every tree edge, in any order.
        name: Name of the model, cut where engines would crash on its length.
        config: Densities, efforts, velocities and bounds.

    Raises:
        ValueError: The estimates are not those of the tree's edges.
    """
    by_edge = {(joint.parent, joint.child): joint for joint in joints}
    if len(by_edge) != len(joints) or set(by_edge) != set(tree.edges()):
        raise ValueError("A model needs one joint estimate for every tree edge and no other.")
    origins = np.zeros((len(assembly.parts), 3))
    for joint in joints:
        origins[joint.child] = joint.pivot
    thickness = max(config.min_thickness * assembly.diagonal, config.min_thickness_m)
    links = tuple(
        _link(assembly, index, origin, thickness=thickness, config=config) for index, origin in enumerate(origins)
    )
    joint_names = _joint_names([assembly.names[child] for _, child in tree.edges()], taken=set(assembly.names))
    return KinematicModel(
        name=name[: config.max_name_length],
        links=links,
        joints=tuple(
            _joint(by_edge[edge], links, joint_name, assembly.diagonal, config)
            for edge, joint_name in zip(tree.edges(), joint_names, strict=True)
        ),
    )


def _link(assembly: Assembly, index: int, origin: FloatArray, *, thickness: float, config: ModelConfig) -> ModelLink:
    part = assembly.parts[index]
    original = assembly.originals.get(part.name)
    return ModelLink(
        name=part.name,
        part=part,
        T_world_link=pose_at(origin),
        inertial=_inertial(original or part, origin, thickness, config),
        fixed_visuals=tuple(item.part for item in assembly.set_aside if item.nearest == part.name),
        original=original,
        collision_parts=_collision_parts(original or part, thickness),
    )


def _inertial(part: Part, origin: FloatArray, thickness: float, config: ModelConfig) -> Inertial:
    found, mass = inertial_of(part, origin, thickness=thickness, config=config), config.masses.get(part.name)
    if mass is None:
        return found
    return replace(found, mass=mass, tensor=found.tensor * (mass / found.mass), source="stated")


def _collision_parts(part: Part, thickness: float) -> tuple[Part, ...]:
    """A thin solid for a flat part, which no engine can collide; nothing for all others."""
    used = referenced(part.vertices, part.faces)
    thick = thickened(used, thickness)
    if len(thick) == len(used):
        return ()
    vertices, faces = convex_hull(thick)
    return (Part(name=f"{part.name}_collision", vertices=vertices, faces=faces),)


def _joint_names(children: Sequence[str], taken: set[str]) -> list[str]:
    """``<child>_joint`` for every child, numbered where a link or another joint has that name."""
    names = []
    for child in children:
        name, number = f"{child}_joint", 1
        while name in taken:
            number += 1
            name = f"{child}_joint_{number}"
        taken.add(name)
        names.append(name)
    return names


def _joint(
    estimate: JointEstimate, links: Sequence[ModelLink], name: str, diagonal: float, config: ModelConfig
) -> Joint:
    parent, child = links[estimate.parent], links[estimate.child]
    kind, lower, upper = _limits(estimate, diagonal, config)
    return Joint(
        name=name,
        kind=kind,
        parent=parent.name,
        child=child.name,
        T_parent_child=pose_at(child.T_world_link[:3, 3] - parent.T_world_link[:3, 3]),
        axis=snapped(estimate.axis),
        lower=lower,
        upper=upper,
        effort=config.turn_effort if kind.turns else config.slide_effort,
        velocity=config.turn_velocity if kind.turns else config.slide_velocity,
    )


def snapped(axis: FloatArray) -> FloatArray:
    """The frame's axis that a direction differs from by no more than fits do, else the direction itself."""
    nearest = np.round(axis)
    return nearest if float(np.linalg.norm(axis - nearest)) < _SNAP else axis


def _limits(estimate: JointEstimate, diagonal: float, config: ModelConfig) -> tuple[JointType, float, float]:
    """Type and limits that every engine takes: none for continuous, finite and apart for revolute and prismatic."""
    kind, lower, upper = estimate.kind, estimate.lower, estimate.upper
    if kind is JointType.FIXED:
        return kind, 0.0, 0.0
    if kind is JointType.CONTINUOUS or (kind is JointType.REVOLUTE and math.isinf(upper - lower)):
        return JointType.CONTINUOUS, -math.inf, math.inf
    unit = diagonal if kind is JointType.PRISMATIC else 1.0
    if kind is JointType.PRISMATIC:
        lower, upper = max(lower, -config.max_travel * unit), min(upper, config.max_travel * unit)
    play = config.play_travel * unit if kind is JointType.PRISMATIC else config.play
    if 0.0 < -lower <= min(play, config.play_share * (upper - lower)):
        lower = 0.0
    # MuJoCo ignores limits that are equal, which would turn a stuck joint into one without limits.
    return kind, lower, max(upper, lower + config.min_travel * unit)
