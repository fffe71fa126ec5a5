"""Rigid motions, mirrorings included, that carry one part onto a congruent one."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations, product
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray

_START = 3.0  # times the distance that is asked for: principal axes of rough twins are some degrees off
_ROUNDS = 10  # of matching nearest points; converged to a tenth of the spacing of the points
_SAME = np.cos(np.radians(5.0))  # nearly equal motions are one


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidMotion:
    """x -> turn x + shift, in the world frame."""

    turn: FloatArray
    """Orthogonal, of determinant 1 or -1, shape (3, 3)."""
    shift: FloatArray
    """[m], shape (3,)."""

    def points(self, points: FloatArray) -> FloatArray:
        """Where points go, shape (n, 3) or (3,)."""
        return np.asarray(points @ self.turn.T + self.shift)

    def directions(self, directions: FloatArray) -> FloatArray:
        """Where directions go, shape (n, 3) or (3,)."""
        return np.asarray(directions @ self.turn.T)

    @property
    def inverse(self) -> RigidMotion:
        """The way back."""
        return RigidMotion(turn=self.turn.T, shift=-self.turn.T @ self.shift)


def motions_between(first: FloatArray, second: FloatArray, *, tolerance: float) -> list[RigidMotion]:
    """Every motion that lays one cloud upon another one, the closest first.

    The principal axes are laid upon each other in all orders and signs; matching nearest points finishes each that is
    close. Shapes with symmetries of their own have several answers.

    Args:
        first: Points all over one part, world frame [m], shape (n, 3).
        second: Points all over the other one [m], shape (m, 3).
        tolerance: Largest mean distance of the moved points from the nearest others [m].
    """
    tree = cKDTree(second)
    found: list[tuple[float, RigidMotion]] = []
    for start in _starts(first, second):
        if tree.query(start.points(first))[0].mean() > _START * tolerance:
            continue
        motion, distance = _matched(first, second, tree, start)
        if distance <= tolerance:
            found.append((distance, motion))
    kept: list[RigidMotion] = []
    for _, motion in sorted(found, key=lambda item: item[0]):
        if all(_agreement(motion, other) < _SAME for other in kept):
            kept.append(motion)
    return kept


def _starts(first: FloatArray, second: FloatArray) -> list[RigidMotion]:
    middles = first.mean(axis=0), second.mean(axis=0)
    axes = [np.linalg.eigh((cloud - m).T @ (cloud - m))[1] for cloud, m in zip((first, second), middles, strict=True)]
    starts = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            turn = (axes[1][:, order] * signs) @ axes[0].T
            starts.append(RigidMotion(turn=turn, shift=middles[1] - turn @ middles[0]))
    return starts


def _matched(first: FloatArray, second: FloatArray, tree: cKDTree, motion: RigidMotion) -> tuple[RigidMotion, float]:
    """Match nearest points until they stay, mirrored or not as at the start; and their mean distance [m]."""
    sign = np.sign(np.linalg.det(motion.turn))
    for _ in range(_ROUNDS):
        nearest = second[tree.query(motion.points(first))[1]]
        one, other = first.mean(axis=0), nearest.mean(axis=0)
        left, _, right = np.linalg.svd((nearest - other).T @ (first - one))
        flip = np.array([1.0, 1.0, sign * np.sign(np.linalg.det(left @ right))])
        turn = (left * flip) @ right
        motion = RigidMotion(turn=turn, shift=other - turn @ one)
    return motion, float(tree.query(motion.points(first))[0].mean())


def _agreement(one: RigidMotion, other: RigidMotion) -> float:
    """Cosine of the angle between two motions; -1 where only one of them mirrors."""
    if np.linalg.det(one.turn) * np.linalg.det(other.turn) < 0:
        return -1.0
    return float(np.clip((np.trace(one.turn.T @ other.turn) - 1.0) / 2.0, -1.0, 1.0))
