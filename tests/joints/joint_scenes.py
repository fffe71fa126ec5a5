"""Joint inference on known objects with their true tree: what the tests of `kinematify.joints` share."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.contact.graph import pair
from kinematify.contact.tree import KinematicTree
from kinematify.generate.procedural.solids import bore, box, cylinder
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_bearings
from kinematify.joints.candidate import SLIDE, TURN
from kinematify.joints.choice.decide import estimate_joints
from kinematify.joints.features.edge_scene import TreeScenes
from kinematify.joints.features.slide_cues import rank_slides
from kinematify.joints.features.turn_cues import rank_turns
from kinematify.joints.features.workspace import PartCache
from kinematify.joints.hypotheses.propose import propose
from tests.known import known_object, turning
from tests.objects import BUILDERS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from manifold3d import Manifold

    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointEstimate
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.joints.features.ranking import Ranked
    from tests.known import KnownObject

CONFIG = load_config()
Evidence = tuple["KinematicTree", "ContactGraph", "Mapping[tuple[int, int], EdgeBearing]"]


def evidence(known: KnownObject) -> Evidence:
    """True tree, contact graph and bearings of a known object."""
    parents = [-1] * len(known.parts)
    for joint in known.joints:
        parents[known.index[joint.child]] = known.index[joint.parent]
    assembly = known.assembly
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    graph = build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=0)
    bearings = fit_bearings(assembly, surfaces, graph, config=CONFIG.bearing, seed=0)
    return KinematicTree(parents=tuple(parents)), graph, bearings


def infer_joints(known: KnownObject) -> dict[str, JointEstimate]:
    """The estimate of every joint by the name of its child."""
    tree, graph, bearings = evidence(known)
    estimates = estimate_joints(known.assembly, graph, tree, bearings, config=CONFIG.joints, seed=0)
    return {known.parts[estimate.child].name: estimate for estimate in estimates}


@cache
def estimates_of(name: str) -> dict[str, JointEstimate]:
    """`infer_joints` of the object that the builder of this name makes, computed once."""
    return infer_joints(BUILDERS[name]())


def scene_of(known: KnownObject, child: str) -> JointScene:
    """The scene of the joint that moves `child`."""
    tree, graph, bearings = evidence(known)
    cache = PartCache(known.assembly, graph, samples=CONFIG.joints.samples, seed=0)
    index = known.index[child]
    edge = (tree.parents[index], index)
    return TreeScenes(cache, tree, CONFIG.joints).scene(edge, bearings.get(pair(*edge)))


def ranked_turns(scene: JointScene) -> Ranked:
    """The proposed turns of a scene, best first."""
    proposed = propose(scene)
    return rank_turns(scene, proposed.at(np.flatnonzero(proposed.kinds == TURN)))


def ranked_slides(scene: JointScene) -> Ranked:
    """The proposed slides of a scene, best first."""
    proposed = propose(scene)
    return rank_slides(scene, proposed.at(np.flatnonzero(proposed.kinds == SLIDE)))


def clock(extra: Manifold | None = None) -> KnownObject:
    """A case and two hands on shafts one in the other."""
    case = box((-0.1, 0.0, -0.1), (0.1, 0.04, 0.1))
    case -= bore(0.006, 3e-4, (0, -1, 0), (0, 0.03 + 3e-4, 0))
    solids = {"case": case}
    for k, (radius, length) in enumerate(((0.006, 0.05), (0.003, 0.08))):
        level = -0.003 - 0.004 * k
        hand = box((-0.004, level - 0.002, 0.0), (0.004, level, length)) + cylinder(
            0.01, (0, level - 0.002, 0), (0, level, 0)
        )
        solids[f"hand_{k}"] = hand + cylinder(radius, (0, level - 0.001, 0), (0, 0.03, 0))
    if extra is not None:
        solids["hand_1"] += extra
    solids["hand_0"] -= bore(0.003, 3e-4, (0, -1, 0), (0, 1, 0))
    joints = [turning("case", f"hand_{k}", (0, 1, 0), (0, 0, 0), (-np.inf, np.inf)) for k in range(2)]
    return known_object("clock", solids, *joints)
