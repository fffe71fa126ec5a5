"""Contact graph: exact gaps, samples near contacts, bridges between what does not touch, and laws of the whole."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import minimum_spanning_tree

from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph, exact_gap, find_bridges
from kinematify.geometry.surface import part_surfaces
from tests.objects import BUILDERS

if TYPE_CHECKING:
    from kinematify.contact.graph import ContactGraph, ContactSamples

CONFIG = load_config()
Box = tuple[np.ndarray, np.ndarray]
"""Lower and upper corner."""


def box_part(name: str, lower: object, upper: object) -> Part:
    lower, upper = np.asarray(lower, dtype=np.float64), np.asarray(upper, dtype=np.float64)
    mesh = trimesh.creation.box(upper - lower)
    return Part(name=name, vertices=mesh.vertices + 0.5 * (lower + upper), faces=mesh.faces)


def boxes(*corners: Box) -> Assembly:
    return Assembly(parts=tuple(box_part(f"box{k}", *pair) for k, pair in enumerate(corners)), source="test")


def gap_of(assembly: Assembly) -> float:
    return exact_gap(part_surfaces(assembly, config=CONFIG.surface), (0, 1))


def graph_of(assembly: Assembly, seed: int = 0) -> ContactGraph:
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    return build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=seed)


def box_distance(first: Box, second: Box) -> float:
    return float(np.linalg.norm(np.maximum(np.maximum(first[0] - second[1], second[0] - first[1]), 0)))


# ---- gaps ------------------------------------------------------------------------------------------------------------


@settings(max_examples=40)
@given(offset=st.tuples(*[st.floats(-3.0, 3.0)] * 3), scale=st.floats(1e-2, 1e2))
def test_the_gap_between_boxes_is_exact(offset: tuple[float, float, float], scale: float) -> None:
    one = (np.zeros(3), np.full(3, scale))
    other = (scale * np.asarray(offset), scale * np.add(offset, (1.0, 0.5, 0.25)))
    inside = bool(np.all(other[0] > one[0]) and np.all(other[1] < one[1]))
    if not inside:
        assert gap_of(boxes(one, other)) == pytest.approx(box_distance(one, other), abs=1e-9 * scale, rel=1e-6)


def test_a_part_inside_a_cavity_has_the_gap_to_its_wall() -> None:
    outer, inner = (np.zeros(3), np.ones(3)), (np.full(3, 0.1), np.array([0.9, 0.9, 0.8]))
    assert gap_of(boxes(outer, inner)) == pytest.approx(0.1)


# ---- bridges ---------------------------------------------------------------------------------------------------------


@settings(max_examples=20)
@given(seed=st.integers(0, 10**6), count=st.integers(2, 7))
def test_bridges_are_the_smallest_gaps_that_join_all_components(seed: int, count: int) -> None:
    """The minimum spanning tree over all exact distances, by brute force."""
    rng = np.random.default_rng(seed)
    lower = rng.uniform(0, 20, (count, 3))
    corners = [(low, low + rng.uniform(0.2, 1.0, 3)) for low in lower]
    assembly = boxes(*corners)
    found = find_bridges(assembly, part_surfaces(assembly, config=CONFIG.surface), [], near=1.0, limit=np.inf)
    gaps = {pair: box_distance(corners[pair[0]], corners[pair[1]]) for pair in combinations(range(count), 2)}
    rows, columns = zip(*gaps, strict=True)
    weights = np.maximum(list(gaps.values()), 1e-12)  # scipy takes zero for no edge
    tree = minimum_spanning_tree(coo_matrix((weights, (rows, columns)), shape=(count, count)))
    assert len(found) == count - 1
    assert sum(found.values()) == pytest.approx(tree.sum(), abs=1e-6)
    assert all(gap == pytest.approx(gaps[pair], abs=1e-6) for pair, gap in found.items())


@pytest.mark.parametrize(("gap", "joined"), [(0.12, True), (0.14, False)])
def test_what_floats_is_joined_with_all_that_is_nearly_as_close(gap: float, joined: bool) -> None:
    """A block 0.1 from its left neighbour and `gap` from its right one; these two are far from each other."""
    corners = [(0.0, 1.0), (1.1, 2.0), (2.0 + gap, 3.0)]
    assembly = boxes(*[(np.array([a, 0, 0]), np.array([b, 1, 1])) for a, b in corners])
    found = find_bridges(assembly, part_surfaces(assembly, config=CONFIG.surface), [(0, 2)], near=1.25, limit=np.inf)
    assert set(found) == ({(0, 1), (1, 2)} if joined else {(0, 1)})


# ---- samples ---------------------------------------------------------------------------------------------------------


def sides(graph: ContactGraph) -> list[tuple[int, int, ContactSamples]]:
    """Own part, other part and samples of either side of every edge."""
    return [
        side for edge in graph.edges for side in ((edge.a, edge.b, edge.samples_a), (edge.b, edge.a, edge.samples_b))
    ]


@pytest.mark.parametrize("name", ["hinge_pin", "knob", "serial_arm"])
def test_samples_lie_on_their_part_near_the_other_with_the_right_distance(name: str) -> None:
    assembly = BUILDERS[name]().assembly
    graph = graph_of(assembly)
    band = CONFIG.contact.band * assembly.diagonal
    for own, other, samples in sides(graph):
        own_mesh, other_mesh = (
            # Enlarged, for trimesh takes short edges of small meshes for none.
            trimesh.Trimesh(1e3 * assembly.parts[k].vertices, assembly.parts[k].faces, process=False)
            for k in (own, other)
        )
        some = slice(None, None, max(len(samples.points) // 60, 1))
        on_own = trimesh.proximity.closest_point_naive(own_mesh, 1e3 * samples.points[some])[1] / 1e3
        to_other = trimesh.proximity.closest_point_naive(other_mesh, 1e3 * samples.points[some])[1] / 1e3
        assert len(samples.points) > 100
        assert on_own.max() < 1e-9
        assert np.allclose(to_other, samples.distances[some], atol=1e-9)
        assert samples.distances.max() <= band
        assert np.allclose(np.linalg.norm(samples.normals, axis=1), 1.0)
        assert 0 < samples.areas.sum() <= assembly.parts[own].area * (1 + 1e-9)


def test_strength_is_relative_to_the_largest_contact() -> None:
    """A 1 x 1 face against a 0.5 x 0.5 one."""
    base = (np.zeros(3), np.ones(3))
    twin = (np.array([1.0, 0, 0]), np.array([2.0, 1, 1]))
    knob = (np.array([0.25, 0.25, 1.0]), np.array([0.75, 0.75, 1.5]))
    graph = graph_of(boxes(base, twin, knob))
    assert graph.by_pair[0, 1].strength == 1.0
    assert graph.by_pair[0, 2].strength == pytest.approx(0.25, abs=0.05)


# ---- laws ------------------------------------------------------------------------------------------------------------

OBJECT = BUILDERS["parallel_gripper"]().assembly


def summary(
    graph: ContactGraph, assembly: Assembly, names: tuple[str, ...]
) -> dict[frozenset[str], tuple[float, float]]:
    return {
        frozenset((names[edge.a], names[edge.b])): (edge.gap / assembly.diagonal, edge.strength) for edge in graph.edges
    }


def assert_alike(one: Assembly, other: Assembly) -> None:
    """The same pairs touch, with gaps in proportion and strengths that differ by sampling only."""
    first, second = (summary(graph_of(assembly), assembly, assembly.names) for assembly in (one, other))
    assert first.keys() == second.keys()
    for pair, (gap, strength) in first.items():
        assert second[pair][0] == pytest.approx(gap, abs=1e-7)
        assert second[pair][1] == pytest.approx(strength, abs=0.02)


@settings(max_examples=2)
@given(seed=st.integers(0, 1000))
def test_permuting_the_parts_permutes_the_graph(seed: int) -> None:
    order = np.random.default_rng(seed).permutation(len(OBJECT.parts))
    permuted = Assembly(parts=tuple(OBJECT.parts[k] for k in order), source="test")
    assert_alike(OBJECT, permuted)
    assert graph_of(OBJECT).clusters
    clusters = {frozenset(OBJECT.names[k] for k in group) for group in graph_of(OBJECT).clusters}
    assert clusters == {frozenset(permuted.names[k] for k in group) for group in graph_of(permuted).clusters}


@settings(max_examples=2)
@given(scale=st.floats(1e-3, 1e3), shift=st.floats(-5.0, 5.0))
def test_size_and_place_do_not_matter(scale: float, shift: float) -> None:
    parts = tuple(
        Part(name=part.name, vertices=scale * (part.vertices + shift), faces=part.faces) for part in OBJECT.parts
    )
    assert_alike(OBJECT, Assembly(parts=parts, source="test"))
