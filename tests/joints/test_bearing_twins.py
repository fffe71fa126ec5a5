"""Contacts of congruent parts share their bearing: a lever that lost its own follows its mirrored twin."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.generate.procedural.solids import box, cylinder, union
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_evidence import contact_sides
from kinematify.joints.bearings.bearing_fit import fit_edge
from kinematify.joints.bearings.congruent_contacts import shared_by_twins

if TYPE_CHECKING:
    from kinematify.joints.bearings.scores import EdgeBearing

CONFIG = load_config()
LEFT, RIGHT = (0, 1), (0, 2)
TILT = np.radians(20.0)
AXIS = np.array([np.sin(TILT), np.cos(TILT), 0.0])
"""Of the left lever; that of the right one is mirrored at the plane across y."""
MIRRORED = AXIS * (1.0, -1.0, 1.0)


def solid_part(name: str, solid: object, *, mirrored: bool = False) -> Part:
    mesh = solid.to_mesh64()  # type: ignore[attr-defined]
    vertices, faces = mesh.vert_properties[:, :3], mesh.tri_verts
    return Part(
        name=name,
        vertices=vertices * (1.0, -1.0, 1.0) if mirrored else vertices,
        faces=faces[:, ::-1] if mirrored else faces,
    )


@cache
def walker() -> Assembly:
    """A body with a lever on a slanting pin at either side."""
    middle = np.array([0.0, 0.4, 0.0])
    ends = tuple(middle - 0.3 * AXIS), tuple(middle + 0.2 * AXIS)
    pins = [cylinder(0.05, *ends), cylinder(0.05, *(tuple(np.array(end) * (1.0, -1.0, 1.0)) for end in ends))]
    bar = union(box((-0.1, 0.38, -0.1), (0.6, 0.5, 0.1)), box((0.5, 0.38, -0.1), (0.6, 0.5, 0.4)))
    lever = bar - cylinder(0.052, tuple(middle - 0.6 * AXIS), tuple(middle + 0.6 * AXIS))
    body = solid_part("body", union(box((-0.4, -0.3, -0.2), (0.3, 0.3, 0.3)), *pins))
    return Assembly(parts=(body, solid_part("left", lever), solid_part("right", lever, mirrored=True)), source="test")


@cache
def shared(*, lost: bool) -> dict[tuple[int, int], EdgeBearing]:
    """Bearings after the vote; with `lost`, the right lever shows nothing but a weak line of chance before it."""
    assembly = walker()
    config = CONFIG.bearing.in_metres(assembly.diagonal)
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    graph = build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=0)
    assert graph.clusters == ((1, 2),)
    edges = {pair: graph.by_pair[pair] for pair in (LEFT, RIGHT)}
    own = {pair: fit_edge(surfaces, edge, config=config, seed=0) for pair, edge in edges.items()}
    if lost:
        chance = replace(own[RIGHT].lines[0], axis=np.array([0.0, 0.0, 1.0]), score=0.01)
        own[RIGHT] = replace(own[RIGHT], lines=(chance,))
    sides = {pair: contact_sides(surfaces, edge, config=config) for pair, edge in edges.items()}
    return shared_by_twins(own, sides, surfaces, graph, config=config)


def off_degrees(bearing: EdgeBearing, axis: np.ndarray) -> float:
    return float(np.degrees(np.arccos(min(abs(float(bearing.lines[0].axis @ axis)), 1.0))))


def test_a_lost_bearing_is_taken_from_the_mirrored_twin_and_said() -> None:
    found = shared(lost=True)
    assert found[RIGHT].follows == (LEFT,)
    assert off_degrees(found[RIGHT], MIRRORED) < 1.0
    assert off_degrees(found[RIGHT], AXIS) > 30.0
    offset = np.cross(found[RIGHT].lines[0].pivot - np.array([0.0, -0.4, 0.0]), MIRRORED)
    assert np.linalg.norm(offset) < 0.01
    assert found[LEFT].follows == ()
    assert off_degrees(found[LEFT], AXIS) < 1.0
