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
    motion_weights,
    rank_candidates,
    refine,
)
from kinematify.paper.contact_region import ContactRegion, revolve, slide
from kinematify.paper.joints import estimate_paper_joint, paper_candidates
from kinematify.paper.sdf_grid import SignedDistanceCache, exact_signed_distance
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
    distances = np.abs(exact_signed_distance(other, samples.points))
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
        sides.append(CavlSide(field=ball, points=tensor, anchored=near, free=free, direction=direction))
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


# --- joints ------------------------------------------------------------------------------------------------------


def tilted(axis: FloatArray, towards: FloatArray, degrees: float) -> FloatArray:
    angle = np.deg2rad(degrees)
    return np.cos(angle) * axis + np.sin(angle) * towards


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


def test_parts_that_only_a_bridge_joins_get_a_joint_too() -> None:
    apart = part_of(box((1, 1, 1), (0, 0, 0))), part_of(box((1, 1, 1), (0, 0, 1.4)))
    scene = scene_of(apart, PAPER, band=0.001)
    assert scene.contact.centroid[2] == pytest.approx(0.7, abs=0.15)
    assert all(np.isfinite(item.score) for item in estimate_paper_joint(scene, PAPER, 0))


def test_angles_and_travels_must_be_pairs() -> None:
    values = load_config().model_dump()
    values["cavl"]["travels"] = [0.01]
    with pytest.raises(ConfigError, match="pairs"):
        load_config("default", cavl=values["cavl"])
