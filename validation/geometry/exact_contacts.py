"""Which bodies touch or overlap in the configurations in which the engines are compared, for KV604."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.scene import relative
from kinematify.simulation.configurations import EnginePoses, agreement_configurations

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings
    from kinematify.geometry.overlap import OverlapQueries
    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray, IntArray


def exact_contacts(scene: Scene, overlap: OverlapQueries, settings: ValidationSettings) -> EnginePoses:
    """Look at every pair of bodies in every configuration.

    Returns:
        Contacts and depths as engines leave them, each body named by its first link with geometry; no poses.
    """
    rows = agreement_configurations(scene.model, settings.agreement, settings.seed)
    leaders = rows.q[:, [rows.joints.index(travel.joint) for travel in scene.travels]]
    poses = scene.poses(leaders)
    link = np.array([rows.links.index(body.name) for body in scene.bodies])
    contacts: list[IntArray] = [np.zeros((0, 3), dtype=np.int64)]
    depths: list[FloatArray] = [np.zeros(0)]
    for pair in scene.pairs:
        T = relative(poses, pair)
        meet = overlap.collide(pair, T)
        near = np.flatnonzero(meet | overlap.may_contain(pair, T))
        if len(near):
            depth = overlap.depth(pair, T[near])
            kept = meet[near] | (depth > 0.0)
            rows_of = near[kept]
            first, second = sorted(link[list(pair)].tolist())
            contacts.append(np.column_stack([rows_of, np.full(len(rows_of), first), np.full(len(rows_of), second)]))
            depths.append(depth[kept])
    return EnginePoses(
        links=rows.links,
        joints=rows.joints,
        q=rows.q,
        T_world_link=np.zeros((0, len(rows.links), 4, 4)),
        contacts=np.concatenate(contacts),
        contact_depth=np.concatenate(depths),
    )
