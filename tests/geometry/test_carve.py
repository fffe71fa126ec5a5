"""Convex pieces carved by the motion of joints, judged by signed distances of another library."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import coal
import numpy as np
import pytest

from kinematify.geometry.carve import SweptJoint, carved
from kinematify.geometry.convex import ConvexPiece, convex_piece, surface_points
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.geometry.carve import Carved

CLEARANCE = 0.003


def box(low: Sequence[float], high: Sequence[float]) -> ConvexPiece:
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    return convex_piece(corners, thickness=1e-6, directions=64)


def rod(radius: float, length: float) -> ConvexPiece:
    """About z, in the middle of the frame."""
    turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    ring = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points = np.concatenate([np.column_stack([ring, np.full(24, z)]) for z in (-length / 2.0, length / 2.0)])
    return convex_piece(points, thickness=1e-6, directions=256)


def slide(moved: int, axis: tuple[float, float, float], upper: float) -> SweptJoint:
    return SweptJoint(
        moved=frozenset({moved}),
        against=frozenset({1 - moved}),
        turns=False,
        axis=np.array(axis),
        pivot=np.zeros(3),
        lower=0.0,
        upper=upper,
    )


def turn(moved: int, pivot: tuple[float, float, float], lower: float, upper: float) -> SweptJoint:
    axis = np.array([0.0, 0.0, 1.0])
    return SweptJoint(
        moved=frozenset({moved}),
        against=frozenset({1 - moved}),
        turns=True,
        axis=axis,
        pivot=np.array(pivot),
        lower=lower,
        upper=upper,
    )


def everywhere(sweep: int, first: int, second: int, sign: float) -> float:
    return sign * math.inf


def freed(bodies: Sequence[Sequence[ConvexPiece]], sweep: SweptJoint, free_end=everywhere, most: int = 64) -> Carved:
    surfaces = [
        np.concatenate([surface_points(piece.vertices, piece.faces, 500) for piece in pieces]) for pieces in bodies
    ]
    return carved(bodies, surfaces, [sweep], free_end, clearance=CLEARANCE, thinnest=0.2 * CLEARANCE, most=most)


def convex(piece: ConvexPiece) -> coal.ConvexBase:
    points = coal.StdVec_Vec3s()
    for point in piece.vertices:
        points.append(point)
    return coal.ConvexBase.convexHull(points, False, "Qt")


def nearest(result: Carved, sweep: SweptJoint) -> float:
    """Smallest signed distance between what moves and what rests at many values [m]."""
    (moving,) = sweep.moved
    values = np.linspace(sweep.lower, sweep.upper, 181)
    shapes = [[convex(piece) for piece in pieces] for pieces in result.pieces]
    smallest = math.inf
    for rotation, translation in zip(*sweep.motions(values), strict=True):
        pose, world = coal.Transform3s(np.array(rotation), np.array(translation)), coal.Transform3s.Identity()
        for mine in shapes[moving]:
            for body, others in enumerate(shapes):
                for other in others if body != moving else ():
                    distance = coal.distance(mine, pose, other, world, coal.DistanceRequest(), coal.DistanceResult())
                    smallest = min(smallest, distance)
    return smallest


def parallel(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How the second bar of a parallelogram moves as the first one sees it: its pivot goes round on a circle."""
    pivot = np.array([0.0, 0.05, 0.0])
    turned = rotation_about(np.array([0.0, 0.0, 1.0]), -values)
    return np.broadcast_to(np.eye(3), (len(values), 3, 3)), turned @ pivot - pivot


BARS = [[box((-0.01, -0.01, 0.0), (0.3, 0.01, 0.01))], [box((-0.01, 0.04, 0.0), (0.3, 0.06, 0.01))]]
CARCASS = [box((-0.2, -0.02, -0.2), (-0.18, 0.4, 0.2)), box((0.18, -0.02, -0.2), (0.2, 0.4, 0.2))]
SCENES = {
    "a drawer flush between boards": (
        [CARCASS, [box((-0.18, 0.0, -0.1), (0.18, 0.39, 0.1))]],
        slide(1, (0.0, -1.0, 0.0), 0.35),
    ),
    "a drawer drawn as a box in a solid block": (
        [[box((-0.3, 0.0, -0.3), (0.3, 0.5, 0.3))], [box((-0.2, -0.02, -0.1), (0.2, 0.4, 0.1))]],
        slide(1, (0.0, -1.0, 0.0), 0.35),
    ),
    "a door whose edge turns beside its post": (
        [[box((-0.06, -0.03, 0.0), (0.0, 0.03, 1.0))], [box((0.0, -0.01, 0.01), (0.5, 0.01, 0.99))]],
        turn(1, (0.0, -0.01, 0.0), -1.6, 0.0),
    ),
    "a pin in a solid barrel": (
        [[rod(0.02, 0.1)], [rod(0.005, 0.12), box((0.03, -0.01, -0.05), (0.3, 0.01, 0.05))]],
        turn(1, (0.0, 0.0, 0.0), -np.pi, np.pi),
    ),
    "a square peg that turns in a plate": (
        [[box((-0.2, -0.2, -0.01), (0.2, 0.2, 0.01))], [box((-0.03, -0.03, -0.05), (0.03, 0.03, 0.05))]],
        turn(1, (0.0, 0.0, 0.0), -np.pi, np.pi),
    ),
    "bars of a parallelogram": (BARS, replace(turn(1, (0.0, 0.05, 0.0), -1.0, 1.0), followed=parallel)),
}


@pytest.mark.parametrize("name", SCENES)
def test_what_moves_keeps_the_clearance_at_every_value(name: str) -> None:
    bodies, sweep = SCENES[name]
    result = freed(bodies, sweep)
    assert nearest(result, sweep) > 0.99 * CLEARANCE
    assert all(result.pieces)
    assert result.jams == ()


def test_flush_boards_lose_little() -> None:
    result = freed(*SCENES["a drawer flush between boards"])
    assert max(result.lost) < 0.2
    assert [len(pieces) for pieces in result.pieces] == [2, 1]


def test_a_drawer_in_a_block_keeps_its_box() -> None:
    result = freed(*SCENES["a drawer drawn as a box in a solid block"])
    assert result.lost[1] < 0.05
    assert result.lost[0] == pytest.approx(0.4 * 0.4 * 0.2 / (0.6 * 0.5 * 0.6), abs=0.06)


def test_what_is_blocked_is_not_carved() -> None:
    bodies, _ = SCENES["a drawer flush between boards"]
    sideways = slide(1, (1.0, 0.0, 0.0), 0.3)
    result = freed(bodies, sideways, lambda sweep, first, second, sign: min(sign * math.inf, 0.0))
    assert max(result.lost) < 0.2
    assert nearest(result, sideways) < -0.05


def test_a_body_inside_another_one_keeps_a_piece() -> None:
    result = freed([[rod(0.1, 0.3)], [rod(0.02, 0.02)]], turn(1, (0.0, 0.0, 0.0), -1.0, 1.0))
    assert all(result.pieces)


def test_of_a_button_in_a_barrel_the_head_is_left() -> None:
    """Neither has anything left that keeps the clearance; both would stand in each other."""
    barrel, button = rod(0.0155, 0.3), rod(0.012, 0.3)
    inserted = ConvexPiece(vertices=button.vertices + np.array([0.0, 0.0, 0.004]), faces=button.faces)
    sweep = slide(1, (0.0, 0.0, -1.0), 0.002)
    result = freed([[barrel], [inserted]], sweep)
    assert result.jams == ()
    assert result.lost[0] == 0.0
    assert result.pieces[1][0].high[2] - result.pieces[1][0].low[2] == pytest.approx(0.002)
    assert nearest(result, sweep) > -1e-6


def test_a_thin_wall_beside_a_thick_filler_stays() -> None:
    """The wall is 2 % of the volume that the filler has, and all that there is of its side."""
    drawer = [box((-0.2, 0.0, 0.0), (0.2, 0.4, 0.05)), box((0.19, 0.0, 0.05), (0.2, 0.4, 0.15))]
    result = freed([[box((0.195, 0.0, 0.0), (0.25, 0.4, 0.3))], drawer], slide(1, (0.0, -1.0, 0.0), 0.35))
    assert max(float(piece.high[2]) for piece in result.pieces[1]) == pytest.approx(0.15)
