"""Parts that are fixed to the one that carries them, by their shapes and by their names."""

from __future__ import annotations

import trimesh

from kinematify.assembly.part import Assembly, Part
from kinematify.contact.build_graph import build_contact_graph
from kinematify.contact.tree import KinematicTree
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_bearings
from kinematify.joints.candidate import JointEstimate, JointType
from kinematify.joints.choice.decide import estimate_joints
from tests.joints.joint_scenes import CONFIG


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> trimesh.Trimesh:
    """A box with its centre somewhere [m]."""
    made = trimesh.creation.box(size)
    made.apply_translation(at)
    return made


def part(name: str, *meshes: trimesh.Trimesh) -> Part:
    """One part of several bodies."""
    whole = trimesh.util.concatenate(meshes)
    return Part(name=name, vertices=whole.vertices, faces=whole.faces)


def cupboard(door: str, handle: str) -> Assembly:
    """An open box, a door on its front, and a handle on the door."""
    carcass = part(
        "carcass",
        box((0.6, 0.5, 0.018), (0.0, 0.0, 0.009)),
        box((0.6, 0.5, 0.018), (0.0, 0.0, 0.791)),
        box((0.018, 0.5, 0.8), (-0.291, 0.0, 0.4)),
        box((0.018, 0.5, 0.8), (0.291, 0.0, 0.4)),
        box((0.6, 0.018, 0.8), (0.0, 0.241, 0.4)),
    )
    panel = part(door, box((0.595, 0.018, 0.795), (0.0, -0.259, 0.4)))
    grip = part(handle, box((0.015, 0.03, 0.12), (0.25, -0.283, 0.4)))
    return Assembly(parts=(carcass, panel, grip), source="cupboard")


def estimated(assembly: Assembly) -> tuple[JointEstimate, ...]:
    """The joints of door and handle, given the tree."""
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    graph = build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=0)
    bearings = fit_bearings(assembly, surfaces, graph, config=CONFIG.bearing, seed=0)
    tree = KinematicTree(parents=(-1, 0, 1))
    return estimate_joints(assembly, graph, tree, bearings, config=CONFIG.joints, seed=0)


def test_a_handle_is_fixed_to_its_door_and_the_door_is_not() -> None:
    door, handle = estimated(cupboard("part_001", "part_002"))
    assert door.kind is JointType.REVOLUTE
    assert handle.kind is JointType.FIXED
    assert handle.confidence > CONFIG.joints.confidence.fixed > door.evidence["probability_fixed"]
    assert (handle.lower, handle.upper) == (0.0, 0.0)
    assert all(candidate.kind is not JointType.FIXED for candidate in handle.alternatives)


def test_names_move_the_odds_by_a_bounded_term() -> None:
    silent, _ = estimated(cupboard("part_001", "part_002"))
    named, _ = estimated(cupboard("drawer", "part_002"))
    gained = named.evidence["odds_prismatic"] - silent.evidence["odds_prismatic"]
    assert 0.0 < gained <= CONFIG.joints.confidence.name_weight + CONFIG.joints.confidence.cues_lead + 1e-6
