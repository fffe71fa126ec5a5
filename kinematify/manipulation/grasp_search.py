"""Places where two parallel pads can hold a part, found by rays from outside; nothing is known of names.

Seen along an approach direction, a place is a candidate if it is the first surface that is met, if rays from both sides
along a closing direction meet the part within the opening of the gripper with surfaces that face the pads, and if both
fingers find free lanes beside it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kinematify.geometry.rays import RayScene
from kinematify.geometry.sampling import curve_order, place_samples
from kinematify.robot.transforms import rotation_about, transformed
from kinematify.robot.vectors import lengths_of, triangle_normals

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray, IntArray

    BoolArray = NDArray[np.bool_]

_COARSE_NORMAL = 4.0  # normals in one cell of a quarter are one side of a piece
_FLOOR = 0.01  # the hand stays so far above the lowest point of the object [m]

POINTS = 6000  # of a drawer one in thirty is on the outside, of that one in ten on the handle
"""Places on the moving part that are looked at."""
POINTS_SEEN = 250  # 18 directions take 0.2 s
"""Of those that are seen along an approach direction, so many are measured."""
TIP = 0.01  # the hand is that of the built-in arm, which is like most hands for tables and kitchens
"""Fingers reach so far beyond the grasp point [m]."""
FINGER_LENGTH = 0.07
"""From the tip back to the palm [m]."""
FINGER_WIDTH = 0.02
"""Across approach and closing direction [m]."""
FINGER_THICKNESS = 0.014
"""Along the closing direction [m]."""
PALM_LENGTH = 0.12
"""Of what stands behind the fingers, wrist included, along the approach direction [m]."""
HIDDEN = 0.02  # the far side of a bar is met through its near side
"""Places that lie at most so far behind the surface that is met first still count as seen [m]."""
HOLDS = (0.006, 0.014, 0.026)  # a flat knob, a bar, and a firm hold of a board
"""Tips reach so far behind the surface that the approach meets first [m]."""
CLOSING_STEPS = 4  # every 45 degrees: bars stand upright, lie, or are diagonal
"""Closing directions per approach direction, over half a turn."""
TILT_DEG = 35.0  # friction of rubber on varnish holds up to about 0.7
"""Angle between closing direction and surface normal at either pad at most [deg]."""
PLENTY = 0.03
"""More room than this beside the fingers is no better [m]."""
KNOB_WIDTH = 0.07  # knobs of furniture measure 2 to 5 cm
"""What is held is a knob up to this width along both directions across the approach [m]."""
PLATE = 0.045  # handles are 1 to 4 cm deep
"""What goes on behind the grasp point for this length is the rim of a plate, else a handle [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Candidates:
    """Possible grasps, frame of the root link."""

    center: FloatArray
    """Between the pads [m], shape (n, 3)."""
    approach: FloatArray
    """Unit, shape (n, 3)."""
    closing: FloatArray
    """Unit, shape (n, 3)."""
    width: FloatArray
    """Of what is held [m], shape (n,)."""
    between: FloatArray
    """Middle of what the pads touch [m], shape (n, 3)."""
    clearance: FloatArray
    """Room beside the fingers, the smaller of both sides, at most `plenty` [m], shape (n,)."""

    def __len__(self) -> int:
        """Number of candidates."""
        return len(self.width)

    def __getitem__(self, rows: BoolArray | IntArray | slice) -> Candidates:
        """Return some of them."""
        return Candidates(**{name: values[rows] for name, values in vars(self).items()})

    @property
    def side(self) -> FloatArray:
        """Unit, across approach and closing direction, shape (n, 3)."""
        return np.cross(self.closing, self.approach)


class GraspSearch:
    """Looks at one body of a scene in one configuration."""

    def __init__(self, scene: Scene, poses: FloatArray, body: int, slack: float) -> None:
        """Place all bodies.

        Args:
            scene: The object.
            poses: Pose of every body, frame of the root link, shape (B, 4, 4).
            body: The one to hold.
            slack: Room between pad and surface on either side before the fingers close [m].
        """
        self.slack, self.body = slack, body
        self.meshes = [
            (transformed(item.solid.shells.vertices, T), item.solid.shells.faces)
            for item, T in zip(scene.bodies, poses, strict=True)
        ]
        self.rays = RayScene(self.meshes)
        """All bodies; the index of a mesh is that of its body."""
        self._far = self.rays.size

    def places(self, seed: int) -> FloatArray:
        """Points on the surface of the body, small pieces and narrow sides favoured, shape (n, 3)."""
        vertices, faces = self.meshes[self.body]
        corners = vertices[faces]
        cross = triangle_normals(corners)
        areas = 0.5 * lengths_of(cross)
        solid = areas > 0.0
        corners, areas, cross = corners[solid], areas[solid], cross[solid]
        side = _sides(faces[solid], cross, len(vertices))
        weights = areas / np.sqrt(np.bincount(side, areas)[side])
        picked, barycentric = place_samples(corners, weights, curve_order(corners, weights), POINTS, seed)
        return np.asarray(np.einsum("nk,nkd->nd", barycentric, corners[picked]))

    def directions(self) -> FloatArray:
        """Approach directions: along the three main directions of the body's faces, and between any two, (18, 3)."""
        vertices, faces = self.meshes[self.body]
        axes = main_directions(vertices, faces)
        signs = [np.array([i, j, k]) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
        chosen = np.array([sign for sign in signs if 1 <= np.abs(sign).sum() <= 2], dtype=np.float64)
        return np.asarray(chosen / lengths_of(chosen)[:, None] @ axes)

    def candidates(self, places: FloatArray, opening: float) -> tuple[Candidates, tuple[int, int, int]]:
        """Look at places (n, 3) along all approach and closing directions.

        Returns:
            What fingers could hold, and how many places, each with its directions, are met first from outside; have of
            these opposite surfaces within the opening of the gripper; and of these room for both fingers.
        """
        found, tallies = [], []
        for approach in self.directions():
            seen = self._seen(places, approach)
            seen = seen[:: max(1, -(-len(seen) // POINTS_SEEN))]
            for hold in HOLDS:
                for closing in _across(approach, CLOSING_STEPS):
                    some, tally = self._held(seen, approach, closing, opening=opening, hold=hold)
                    found.append(some)
                    tallies.append(tally)
        seen_at, held_at, free_at = (sum(counts) for counts in zip(*tallies, strict=True))
        return _joined(found), (seen_at, held_at, free_at)

    def is_plate(self, candidates: Candidates) -> BoolArray:
        """Test whether what is held goes on with the same thickness deeper in, shape (n,)."""
        deeper = candidates.between + PLATE * candidates.approach
        half = 0.5 * candidates.width + self.slack
        first = self._first(deeper + half[:, None] * candidates.closing, -candidates.closing)[0]
        second = self._first(deeper - half[:, None] * candidates.closing, candidates.closing)[0]
        return np.asarray((first < 2.0 * self.slack) & (second < 2.0 * self.slack))

    def extent(self, candidates: Candidates) -> FloatArray:
        """Length of what is held across approach and closing direction [m], inf where it goes on, shape (n,)."""
        side, half = candidates.side, KNOB_WIDTH
        first = self._first(candidates.between + half * side, -side)[0]
        second = self._first(candidates.between - half * side, side)[0]
        alone = (first > 0.0) & (second > 0.0) & (first < half) & (second < half)
        extent = 2.0 * half - first - second
        return np.asarray(np.where(alone & (extent <= half), extent, np.inf))

    def _seen(self, places: FloatArray, approach: FloatArray) -> FloatArray:
        """First surface points on the way to places, where they belong to the body and the hand is above the floor."""
        distance, mesh, _ = self._first(places - self._far * approach, np.broadcast_to(approach, places.shape))
        near = (distance >= self._far - HIDDEN) & (distance <= self._far * (1.0 + 1e-5))
        back = places - (FINGER_LENGTH + PALM_LENGTH) * approach
        above = back[:, 2] > self.rays.bounds[0, 2] + _FLOOR
        kept = near & (mesh == self.body) & (above | (abs(approach[2]) < 0.1))
        return np.asarray(places[kept] + (distance[kept] - self._far)[:, None] * approach)

    def _held(
        self, surface: FloatArray, approach: FloatArray, closing: FloatArray, *, opening: float, hold: float
    ) -> tuple[Candidates, tuple[int, int, int]]:
        """Measure halfway between the surface and the tips, which reach `hold` behind it."""
        reach = 0.5 * opening
        centers = surface + 0.5 * hold * approach
        along = np.broadcast_to(closing, centers.shape)
        first, first_mesh, first_face = self._first(centers + reach * closing, -along)
        second, second_mesh, second_face = self._first(centers - reach * closing, along)
        first, second = np.minimum(first, opening), np.minimum(second, opening)
        width = opening - first - second
        between = (first_mesh == self.body) & (second_mesh == self.body) & (width > -1e-5)
        for face in (first_face, second_face):
            between &= np.abs(self.rays.face_normals[face] @ closing) >= np.cos(np.radians(TILT_DEG))
        rows = np.flatnonzero(between & (width <= opening - 2.0 * self.slack))
        middle = centers[rows] + 0.5 * (second - first)[rows, None] * closing
        found = Candidates(
            center=middle + (0.5 * hold - TIP) * approach,
            approach=np.broadcast_to(approach, middle.shape),
            closing=along[rows],
            width=np.maximum(width[rows], 0.0),
            between=middle,
            clearance=np.zeros(len(rows)),
        )
        free = found[self._lanes_free(found)]
        return replace(free, clearance=self._clearance(free)), (len(centers), len(found), len(free))

    def _lanes_free(self, found: Candidates) -> BoolArray:
        """Test whether rays along both edges of both fingers come in as far as the tips, shape (n,)."""
        outward = 0.5 * found.width + self.slack + 0.5 * FINGER_THICKNESS
        free = np.ones(len(found), dtype=bool)
        for sign in (-1.0, 1.0):
            for edge in (-0.5, 0.5):
                beside = sign * outward[:, None] * found.closing + edge * FINGER_WIDTH * found.side
                distance, _, _ = self._first(found.center + beside - self._far * found.approach, found.approach)
                free &= distance >= self._far + TIP
        return free

    def _clearance(self, found: Candidates) -> FloatArray:
        outward = 0.5 * found.width + self.slack
        room = np.full(len(found), PLENTY)
        for sign in (-1.0, 1.0):
            start = found.center + sign * outward[:, None] * found.closing
            distance, _, _ = self._first(start, sign * found.closing)
            room = np.minimum(room, distance - FINGER_THICKNESS)
        return np.asarray(np.maximum(room, 0.0))

    def _first(self, origins: FloatArray, directions: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
        hits = self.rays.first_hits(np.ascontiguousarray(origins), np.ascontiguousarray(directions))
        return hits.distance, hits.mesh, hits.face


def main_directions(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Three perpendicular unit directions that most of the surface of a body faces, rows, shape (3, 3)."""
    corners = vertices[faces]
    cross = triangle_normals(corners)
    areas = lengths_of(cross)
    normals = cross[areas > 0.0] / areas[areas > 0.0, None]
    areas = areas[areas > 0.0]
    first = _commonest(normals, areas)
    flat = normals - np.outer(normals @ first, first)
    length = lengths_of(flat)
    across = length > np.cos(np.radians(30.0))
    if across.any():
        second = _commonest(flat[across] / length[across, None], areas[across])
    else:
        second = np.eye(3)[int(np.argmin(np.abs(first)))]
    second = second - (second @ first) * first
    second /= np.linalg.norm(second)
    return np.stack([first, second, np.cross(first, second)])


def _commonest(normals: FloatArray, areas: FloatArray) -> FloatArray:
    """Mean of the directions, up to sign, around the one with most area in its neighbourhood, shape (3,)."""
    largest = np.argsort(-areas, kind="stable")[:64]
    cosine = np.abs(normals[largest] @ normals.T)
    near = cosine > np.cos(np.radians(10.0))
    best = int(np.argmax(near @ areas))
    signs = np.sign(normals @ normals[largest[best]])
    mean = np.einsum("n,nd->d", areas * near[best] * signs, normals)
    return np.asarray(mean / np.linalg.norm(mean))


def _sides(faces: IntArray, cross: FloatArray, points: int) -> IntArray:
    """Number of the side of each face: connected faces that look roughly the same way, shape (F,)."""
    links = coo_array(
        (np.ones(2 * len(faces), dtype=np.int8), (np.r_[faces[:, 0], faces[:, 0]], np.r_[faces[:, 1], faces[:, 2]])),
        shape=(points, points),
    )
    _, piece = connected_components(links, directed=False)
    cells = np.round(cross / lengths_of(cross)[:, None] * _COARSE_NORMAL / 2.0).astype(np.int64)
    _, side = np.unique(np.c_[piece[faces[:, 0]], cells], axis=0, return_inverse=True)
    return np.asarray(side.reshape(-1))


def _across(approach: FloatArray, steps: int) -> FloatArray:
    """Closing directions at equal steps over half a turn, the first as level as can be, shape (steps, 3)."""
    up = np.array([0.0, 0.0, 1.0])
    level = np.cross(up, approach)
    if float(np.linalg.norm(level)) < 0.1:
        level = np.cross(np.array([1.0, 0.0, 0.0]), approach)
    level /= np.linalg.norm(level)
    return np.stack([rotation_about(approach, np.pi * k / steps) @ level for k in range(steps)])


def _joined(parts: Sequence[Candidates]) -> Candidates:
    return Candidates(**{name: np.concatenate([vars(part)[name] for part in parts]) for name in vars(parts[0])})
