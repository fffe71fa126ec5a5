"""DW-CAVL: the paper's equations, their laws and gradients, and joints of objects built in code."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pytest
import torch
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.contact.graph import ContactEdge, ContactSamples
from kinematify.errors import ConfigError
from kinematify.geometry.sampling import sample_surface
from kinematify.joints.candidate import JointCandidate
from kinematify.paper.cavl import (
    CavlScene,
    CavlSide,
    cavl_scene,
    cavl_terms,
    motion_weights,
    rank_candidates,
    refine,
    virtual_motions,
)
from kinematify.paper.contact_region import ContactRegion, revolve, slide, unit_axis
from kinematify.paper.joints import estimate_paper_joint, paper_candidates
from kinematify.paper.sdf_grid import SignedDistanceCache, exact_distance
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from kinematify.config import CavlConfig
    from kinematify.robot.arrays import FloatArray

DEFAULT, PAPER = load_config().cavl, load_config("paper").cavl
REVOLUTE, PRISMATIC = JointType.REVOLUTE, JointType.PRISMATIC
CONFIGS = pytest.mark.parametrize("config", [DEFAULT, PAPER], ids=["default", "paper"])


# --- objects -----------------------------------------------------------------------------------------------------


def box(extents: tuple[float, float, float], at: tuple[float, float, float]) -> trimesh.Trimesh:
    mesh = trimesh.creation.box(extents)
    mesh.apply_translation(at)
    return mesh


def part_of(*meshes: trimesh.Trimesh) -> Part:
    mesh = trimesh.util.concatenate(meshes)
    return Part(name="part", vertices=mesh.vertices, faces=mesh.faces)


def pin_in_socket() -> tuple[Part, Part]:
    """A door plate on a pin along z, the pin in a socket at a wall."""
    socket = trimesh.creation.annulus(0.105, 0.2, 0.6, sections=64)
    pin = trimesh.creation.cylinder(0.1, 0.9, sections=64)
    return part_of(socket, box((0.6, 0.1, 0.6), (-0.49, 0, 0))), part_of(pin, box((0.8, 0.06, 0.2), (0.45, 0, 0.42)))


def drawer_in_box() -> tuple[Part, Part]:
    """A block in a box that is open towards -y."""
    walls = [box((1, 0.8, 0.05), (0, 0, side * 0.3)) for side in (-1, 1)]
    walls += [box((0.05, 0.8, 0.55), (side * 0.475, 0, 0)) for side in (-1, 1)]
    return part_of(*walls, box((0.9, 0.05, 0.55), (0, 0.375, 0))), part_of(box((0.895, 0.75, 0.545), (0, -0.03, 0)))


def contact_of(part: Part, other: Part, band: float) -> ContactSamples:
    samples = sample_surface(part, 6000, 1)
    distances = exact_distance(other, samples.points)
    near = distances <= band
    return ContactSamples(
        points=samples.points[near],
        normals=samples.normals[near],
        distances=distances[near],
        areas=samples.areas[near],
    )


def scene_of(parts: tuple[Part, Part], config: CavlConfig, band: float = 0.02) -> CavlScene:
    corners = np.concatenate([part.bounds for part in parts])
    diagonal = float(np.linalg.norm(np.ptp(corners, axis=0)))
    a, b = parts
    edge = ContactEdge(
        a=0,
        b=1,
        gap=0.0,
        strength=1.0,
        samples_a=contact_of(a, b, band * diagonal),
        samples_b=contact_of(b, a, band * diagonal),
    )
    cache = SignedDistanceCache(load_config().sdf)
    return cavl_scene(
        edge,
        parent=0,
        child=1,
        fields=lambda index: cache.field(parts[index]),
        samples=[sample_surface(part, 1500, 0) for part in parts],
        diagonal=diagonal,
        config=config,
    )


@functools.cache
def pin_scene(symmetric: bool) -> CavlScene:
    return scene_of(pin_in_socket(), DEFAULT if symmetric else PAPER)


@functools.cache
def drawer_scene(symmetric: bool) -> CavlScene:
    return scene_of(drawer_in_box(), DEFAULT if symmetric else PAPER)


def candidate(kind: JointType, axis: FloatArray, pivot: FloatArray | None = None) -> JointCandidate:
    return JointCandidate(kind=kind, axis=axis, pivot=np.zeros(3) if pivot is None else pivot, score=0.0, source="test")


def angle_between(one: FloatArray, other: FloatArray) -> float:
    return float(np.rad2deg(np.arccos(np.clip(abs(one @ other), 0.0, 1.0))))


# --- equations ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Ball:
    """Exact field of a ball, for laws that a grid fulfils only to its own accuracy."""

    centre: FloatArray
    radius: float

    def value(self, points: torch.Tensor) -> torch.Tensor:
        return torch.linalg.vector_norm(points - torch.from_numpy(self.centre), dim=-1) - self.radius


def ball_scene(
    config: CavlConfig, rotation: FloatArray | None = None, scale: float = 1.0, shift: FloatArray | None = None
) -> CavlScene:
    """Random child points around a ball of radius 1 and parent points around one of radius 0.3, moved as a whole."""
    turn = np.eye(3) if rotation is None else rotation
    move = np.zeros(3) if shift is None else shift
    generator = np.random.default_rng(0)
    directions = generator.normal(size=(200, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    child = directions[:120] * generator.uniform(0.97, 1.6, (120, 1))
    parent = directions[120:] * 0.3 * generator.uniform(0.9, 1.5, (80, 1)) + [1.3, 0.0, 0.0]

    def placed(points: FloatArray) -> FloatArray:
        return scale * points @ turn.T + move

    diagonal = 4.0 * scale
    balls = [Ball(placed(np.zeros(3)), scale), Ball(placed(np.array([1.3, 0.0, 0.0])), 0.3 * scale)]
    sides = []
    for ball, points, direction in zip(balls, (placed(child), placed(parent)), (1.0, -1.0), strict=True):
        tensor = torch.from_numpy(points)
        initial = ball.value(tensor)
        near, free = (weights / len(points) for weights in motion_weights(initial, diagonal, config))
        sides.append(
            CavlSide(field=ball, points=tensor, initial=initial, anchored=near, free=free, direction=direction)
        )
    contact = [
        ContactSamples(
            points=points, normals=np.zeros_like(points), distances=np.zeros(len(points)), areas=np.ones(len(points))
        )
        for points in (placed(child[:50]), placed(parent[:50]))
    ]
    region = ContactRegion(first=contact[0], second=contact[1], width=0.01 * diagonal)
    return CavlScene(sides=tuple(sides if config.symmetric else sides[:1]), contact=region, diagonal=diagonal)


@pytest.mark.parametrize("kind", [REVOLUTE, PRISMATIC])
def test_the_objective_is_that_of_the_paper(kind: JointType) -> None:
    scene = ball_scene(PAPER)
    axis, pivot = np.array([0.0, 0.6, 0.8]), np.array([0.9, 0.1, -0.2])
    (scored,) = rank_candidates(scene, [candidate(kind, axis, pivot)], PAPER)
    expected = objective_as_written(scene, kind, torch.from_numpy(axis), torch.from_numpy(pivot))
    assert expected > 1e-5
    assert scored.evidence["cavl_objective"] == pytest.approx(expected, rel=1e-9)
    assert scored.score == pytest.approx(1.0 / (1.0 + expected), rel=1e-9)


def objective_as_written(scene: CavlScene, kind: JointType, axis: torch.Tensor, pivot: torch.Tensor) -> float:
    """Paper III-D, term by term in loops, lengths in diagonals."""
    side, unit = scene.sides[0], scene.diagonal
    margin, width, sharpness = PAPER.volume_margin, PAPER.contact_width, PAPER.sharpness / PAPER.volume_margin
    initial = side.field.value(side.points) / unit
    w = torch.exp(-(initial**2) / (2 * width**2)) / (1 + torch.exp(sharpness * (initial - margin)))
    w_inverse = 1 / (1 + torch.exp(-sharpness * (initial - margin)))
    total = 0.0
    for angle, travel in zip(PAPER.angles_deg, PAPER.travels, strict=True):
        if kind is REVOLUTE:
            moved = revolve(side.points, pivot[None], axis[None], torch.tensor([np.deg2rad(angle)]))[0, 0]
        else:
            moved = slide(side.points, axis[None], torch.tensor([travel * unit], dtype=torch.float64))[0, 0]
        after = side.field.value(moved) / unit
        count = len(side.points)
        consistency = (w * (after - margin).clamp_min(0) ** 2).sum() / (w.sum() + count * PAPER.epsilon)
        collision = (w_inverse * (-after - margin).clamp_min(0) ** 2).sum() / (w_inverse.sum() + count * PAPER.epsilon)
        total += float(PAPER.consistency_weight * consistency + PAPER.collision_weight * collision)
    total /= len(PAPER.angles_deg)
    if kind is REVOLUTE:
        total += PAPER.pivot_weight * float(
            ((pivot.numpy() - scene.contact.centroid) / unit) @ ((pivot.numpy() - scene.contact.centroid) / unit)
        )
    return total


rotations = st.tuples(*[st.floats(-3.0, 3.0)] * 3).map(lambda vector: Rotation.from_rotvec(vector).as_matrix())
shifts = st.tuples(*[st.floats(-100.0, 100.0)] * 3).map(np.array)


@CONFIGS
@settings(max_examples=15)
@given(rotation=rotations, scale=st.floats(0.01, 100.0), shift=shifts)
def test_moving_and_scaling_the_whole_changes_nothing(
    config: CavlConfig, rotation: FloatArray, scale: float, shift: FloatArray
) -> None:
    axes = np.random.default_rng(3).normal(size=(4, 3))
    pivots = np.random.default_rng(4).uniform(-1.0, 1.0, (4, 3))
    for kind in (REVOLUTE, PRISMATIC):
        here = [candidate(kind, axis, pivot) for axis, pivot in zip(axes, pivots, strict=True)]
        there = [candidate(kind, rotation @ item.axis, scale * rotation @ item.pivot + shift) for item in here]
        before = [item.score for item in rank_candidates(ball_scene(config), here, config)]
        after = [item.score for item in rank_candidates(ball_scene(config, rotation, scale, shift), there, config)]
        assert np.allclose(before, after, rtol=1e-6)


@CONFIGS
@given(axis=st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) > 0.1))
@settings(max_examples=15)
def test_the_sign_of_the_axis_and_the_place_of_the_pivot_along_it_mean_nothing(
    config: CavlConfig, axis: FloatArray
) -> None:
    free = config.model_copy(update={"pivot_weight": 0.0})
    scene, pivot = ball_scene(config), np.array([0.9, 0.1, -0.2])
    same = [
        candidate(REVOLUTE, axis, pivot),
        candidate(REVOLUTE, -axis, pivot),
        candidate(REVOLUTE, axis, pivot + 2.0 * axis),
    ]
    scores = [item.score for item in rank_candidates(scene, same, free)]
    assert np.allclose(scores, scores[0], rtol=1e-9)


def test_full_turns_cost_what_no_turn_costs() -> None:
    scene = ball_scene(DEFAULT)
    axes, pivots = torch.tensor([[0.0, 0.6, 0.8]], dtype=torch.float64), torch.rand((1, 3), dtype=torch.float64)
    small = torch.tensor([0.2, 0.5], dtype=torch.float64)
    costs = [
        cavl_terms(scene, REVOLUTE, pivots=pivots, axes=axes, motions=small + turn, config=DEFAULT).objective(DEFAULT)
        for turn in (0.0, 2.0 * np.pi)
    ]
    assert torch.allclose(costs[0], costs[1], rtol=1e-9)


def test_gradients_of_the_objective_agree_with_differences() -> None:
    for config in (DEFAULT, PAPER):
        scene = ball_scene(config)
        generator = torch.Generator().manual_seed(0)
        free, pivots = (torch.randn((3, 3), generator=generator, dtype=torch.float64).requires_grad_() for _ in "ab")

        def objective(
            a: torch.Tensor, p: torch.Tensor, scene: CavlScene = scene, config: CavlConfig = config
        ) -> torch.Tensor:
            motions = torch.deg2rad(torch.tensor(config.angles_deg, dtype=torch.float64))
            terms = cavl_terms(scene, REVOLUTE, pivots=p, axes=unit_axis(a), motions=motions, config=config)
            return terms.objective(config) / config.length_unit**-2

        assert torch.autograd.gradcheck(objective, (free, pivots), eps=1e-7, atol=1e-8, rtol=1e-4)


def test_weights_follow_the_distance() -> None:
    diagonal = 2.0
    distances = diagonal * torch.tensor([-0.1, 0.0, DEFAULT.volume_margin, 0.1], dtype=torch.float64)
    anchored, free = motion_weights(distances, diagonal, DEFAULT)
    assert anchored[1] > 0.95
    assert anchored[0] < 1e-6  # deep inside: not a contact
    assert anchored[3] < 1e-6
    assert free[2] == pytest.approx(0.5)
    assert free[0] < 1e-6
    assert free[3] > 1.0 - 1e-6


def test_thinning_keeps_the_objective() -> None:
    scene = pin_scene(DEFAULT.symmetric)
    items = [candidate(REVOLUTE, axis) for axis in np.eye(3)]
    full, thin = (rank_candidates(s, items, DEFAULT) for s in (scene, scene.thinned(600)))
    assert all(len(side.points) <= 600 for side in scene.thinned(600).sides)
    for one, other in zip(full, thin, strict=True):
        assert np.array_equal(one.axis, other.axis)
        assert one.evidence["cavl_objective"] == pytest.approx(other.evidence["cavl_objective"], rel=0.15)


def test_pieces_give_what_one_batch_gives() -> None:
    scene = ball_scene(DEFAULT)
    items = paper_candidates(scene.contact, scene.diagonal, DEFAULT, 0)
    pieces = DEFAULT.model_copy(update={"batch_queries": 1000})
    expected = [item.score for item in rank_candidates(scene, items, DEFAULT)]
    assert np.allclose([item.score for item in rank_candidates(scene, items, pieces)], expected, rtol=1e-12)


# --- joints ------------------------------------------------------------------------------------------------------


def tilted(axis: FloatArray, towards: FloatArray, degrees: float) -> FloatArray:
    angle = np.deg2rad(degrees)
    return np.cos(angle) * axis + np.sin(angle) * towards


@CONFIGS
@pytest.mark.parametrize("towards", [0, 1])
def test_the_pin_turns_about_its_own_axis(config: CavlConfig, towards: int) -> None:
    scene = pin_scene(config.symmetric)
    x, y, z = np.eye(3)
    degrees = [0.0, 3.0, 10.0, 30.0, 60.0, 90.0]
    items = [candidate(REVOLUTE, tilted(z, (x, y)[towards], angle)) for angle in degrees]
    ranked = rank_candidates(scene, items, config)
    assert [round(angle_between(item.axis, z)) for item in ranked] == degrees
    moved = rank_candidates(scene, [candidate(REVOLUTE, z, offset * x) for offset in (0.0, 0.05, 0.2)], config)
    assert [item.pivot[0] for item in moved] == [0.0, 0.05, 0.2]


@CONFIGS
@pytest.mark.parametrize("towards", [0, 2])
def test_the_drawer_slides_out(config: CavlConfig, towards: int) -> None:
    scene = drawer_scene(config.symmetric)
    degrees = [0.0, 10.0, 30.0, 60.0, 90.0]
    items = [candidate(PRISMATIC, tilted(np.eye(3)[1], np.eye(3)[towards], angle)) for angle in degrees]
    ranked = rank_candidates(scene, items, config)
    assert [round(angle_between(item.axis, np.eye(3)[1])) for item in ranked] == degrees


@CONFIGS
def test_the_paper_finds_the_pin(config: CavlConfig) -> None:
    best = estimate_paper_joint(pin_scene(config.symmetric), config, 0)[0]
    assert best.kind is REVOLUTE
    assert angle_between(best.axis, np.eye(3)[2]) < 3.0
    assert np.linalg.norm(best.pivot[:2]) < 0.02


@CONFIGS
def test_the_paper_finds_the_drawer(config: CavlConfig) -> None:
    best = estimate_paper_joint(drawer_scene(config.symmetric), config, 0)[0]
    assert best.kind is PRISMATIC
    assert angle_between(best.axis, np.eye(3)[1]) < 3.0


def test_a_rotated_object_gets_the_rotated_joint() -> None:
    turn = Rotation.from_euler("zyx", [37.0, 20.0, -50.0], degrees=True).as_matrix()
    parts = tuple(Part(name=part.name, vertices=part.vertices @ turn.T, faces=part.faces) for part in pin_in_socket())
    best = estimate_paper_joint(scene_of((parts[0], parts[1]), DEFAULT), DEFAULT, 0)[0]
    assert best.kind is REVOLUTE
    assert angle_between(best.axis, turn[:, 2]) < 3.0


@CONFIGS
def test_refinement_never_makes_a_candidate_worse_and_mends_a_tilted_one(config: CavlConfig) -> None:
    scene = pin_scene(config.symmetric).thinned(600)
    x, _, z = np.eye(3)
    start = [candidate(REVOLUTE, tilted(z, x, angle), 0.02 * x) for angle in (8.0, 40.0)]
    start += [candidate(PRISMATIC, tilted(z, x, 15.0))]
    before = {item.kind: [] for item in start}
    after = {item.kind: [] for item in start}
    for store, items in ((before, rank_candidates(scene, start, config)), (after, refine(scene, start, config))):
        for item in items:
            store[item.kind].append(item.evidence["cavl_objective"])
    for kind in (REVOLUTE, PRISMATIC):
        assert all(late <= early for early, late in zip(sorted(before[kind]), sorted(after[kind]), strict=True))
    mended = refine(scene, start[:1], config)[0]
    assert angle_between(mended.axis, z) < 3.0


def test_without_the_anchor_only_collision_counts() -> None:
    bare = PAPER.model_copy(update={"consistency_weight": 0.0, "pivot_weight": 0.0})
    scene = pin_scene(bare.symmetric)
    away = candidate(PRISMATIC, np.eye(3)[1])
    (scored,) = rank_candidates(scene, [away], bare)
    expected = scored.evidence["cavl_collision"] * bare.collision_weight
    assert scored.evidence["cavl_consistency"] > 0.0
    assert scored.evidence["cavl_objective"] == pytest.approx(expected)
    far = candidate(REVOLUTE, np.eye(3)[2], np.array([0.0, 0.3, 0.0]))
    anchored, loose = (rank_candidates(scene, [far], config)[0] for config in (PAPER, bare))
    assert loose.evidence["cavl_objective"] < anchored.evidence["cavl_objective"]


def test_the_same_seed_gives_the_same_joint() -> None:
    scene = pin_scene(PAPER.symmetric)
    first, again = (estimate_paper_joint(scene, PAPER, 5) for _ in "ab")
    assert [item.score for item in first] == [item.score for item in again]
    assert all(np.array_equal(one.axis, other.axis) for one, other in zip(first, again, strict=True))


# --- pool, motions, inputs ---------------------------------------------------------------------------------------


def test_the_pool_holds_what_the_paper_lists() -> None:
    scene = pin_scene(PAPER.symmetric)
    pool = paper_candidates(scene.contact, scene.diagonal, PAPER, 0)
    turning = [item for item in pool if item.kind is REVOLUTE]
    assert len(turning) == (5 + PAPER.random_axes) * len(PAPER.pivot_offsets)
    assert len(pool) - len(turning) == 5 + PAPER.random_axes
    assert {item.source for item in pool} >= {"paper_smallest_variance", "paper_contact_normal", "paper_completion"}
    for item in turning:
        beside = np.cross(item.axis, item.pivot - scene.contact.centroid)
        assert np.linalg.norm(beside) < 1e-12
    assert min(angle_between(item.axis, np.eye(3)[2]) for item in turning if item.source == "paper_principal") < 2.0


def test_the_contact_normal_points_across_the_gap() -> None:
    plates = part_of(box((1, 1, 0.1), (0, 0, -0.055))), part_of(box((1, 1, 0.1), (0, 0, 0.055)))
    contact = scene_of(plates, PAPER).contact
    assert angle_between(contact.normal, np.eye(3)[2]) < 2.0
    assert angle_between(contact.principal_axes[0], np.eye(3)[2]) < 2.0
    assert np.abs(contact.centroid).max() < 0.02


def test_exactly_touching_faces_have_a_normal_as_well() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    up = ContactSamples(points=points, normals=np.tile([0.0, 0, 1], (3, 1)), distances=np.zeros(3), areas=np.ones(3))
    down = ContactSamples(points=points, normals=-up.normals, distances=np.zeros(3), areas=np.ones(3))
    assert np.allclose(ContactRegion(first=up, second=down, width=0.1).normal, [0, 0, 1])
    flat = ContactSamples(points=points, normals=np.zeros((3, 3)), distances=np.zeros(3), areas=np.ones(3))
    assert np.allclose(np.abs(ContactRegion(first=flat, second=flat, width=0.1).normal), [0, 0, 1])


def test_matched_motions_move_the_contact_equally_far() -> None:
    scene = drawer_scene(DEFAULT.symmetric)
    motions = virtual_motions(scene, DEFAULT, lever=0.3)
    assert np.allclose(motions.travels, 0.3 * motions.angles)
    assert np.all(np.abs(motions.angles) <= np.deg2rad(np.abs(DEFAULT.angles_deg)) + 1e-12)
    unmatched = virtual_motions(scene, PAPER)
    assert np.allclose(unmatched.angles, np.deg2rad(PAPER.angles_deg))
    assert np.allclose(unmatched.travels, scene.diagonal * np.array(PAPER.travels))


def test_parts_that_only_a_bridge_joins_get_a_joint_too() -> None:
    apart = part_of(box((1, 1, 1), (0, 0, 0))), part_of(box((1, 1, 1), (0, 0, 1.4)))
    scene = scene_of(apart, PAPER, band=0.001)
    assert scene.contact.centroid[2] == pytest.approx(0.7, abs=0.15)
    assert all(np.isfinite(item.score) for item in estimate_paper_joint(scene, PAPER, 0))


def test_an_edge_of_other_parts_is_refused() -> None:
    empty = ContactSamples(points=np.empty((0, 3)), normals=np.empty((0, 3)), distances=np.empty(0), areas=np.empty(0))
    edge = ContactEdge(a=2, b=5, gap=0.0, strength=0.0, samples_a=empty, samples_b=empty)
    with pytest.raises(ValueError, match="2 and 5"):
        cavl_scene(
            edge, parent=2, child=3, fields=lambda _: Ball(np.zeros(3), 1.0), samples=[], diagonal=1.0, config=PAPER
        )


def test_angles_and_travels_must_be_pairs() -> None:
    values = load_config().model_dump()
    values["cavl"]["travels"] = [0.01]
    with pytest.raises(ConfigError, match="pairs"):
        load_config("default", cavl=values["cavl"])
