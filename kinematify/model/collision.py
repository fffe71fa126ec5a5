"""Collision geometry that works as it is written: primitives and convex pieces, carved by the motion of every joint.

Engines see each mesh as its convex hull, and MuJoCo does not filter contacts with a root that it welds to the world: a
drawer in a hollow cabinet would start inside of a solid block. So every surface is taken apart into convex pieces
(`decomposed`), and these are cut back (`carved`) until no joint, swept over its range with those that follow it, brings
what it moves nearer to anything else than the clearance. Contacts stay switched on for every pair.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.carve import SweptJoint, carved
from kinematify.geometry.convex import (
    ConvexPiece,
    convex_piece,
    enclosed_volume,
    enclosing_piece,
    plain_piece,
    surface_points,
)
from kinematify.geometry.scene import judged_shapes, read_scene, visible_shapes
from kinematify.geometry.sweep import Sweeper
from kinematify.model.collision_pieces import decomposed, fewer_pieces
from kinematify.model.urdf import MESH_FOLDER
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.robot import LinkMesh, Shape, forward_kinematics, joint_ends, rest_configuration
from kinematify.robot.transforms import pose_at, rotation_from_x, transformed
from kinematify.robot.vectors import as_one, crossed, lengths_of
from kinematify.robot.weld import snapped

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

    from kinematify.config import CollisionConfig
    from kinematify.config.validation import GeometrySettings, PrepareSettings
    from kinematify.geometry.scene import Pair
    from kinematify.geometry.sweep import JointSweep
    from kinematify.model.collision_pieces import Pieces
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Link, Robot


_THINNEST = 1e-4
"""Of flat pieces that are joined [m]."""
_MARKS = 2000
"""Points of a link's surface that pieces represent while they are carved."""
_PROBES = 400
"""Points of a link's surface by which it is measured how much the pieces omit."""
_CORNERS = 160
"""Of a sphere or a cylinder while it is carved, at most; around a sphere it reaches 2.5 % of its radius beyond it."""
_MANY_FACES, _CELLS = 150_000, 300
"""Meshes of more triangles are thinned out on a grid of so many cells along their diagonal."""
_MAX_STEM = 100  # file systems end at 255 bytes for a name
_FILLED = 1e-3
"""A mesh is convex if its hull is larger by less than this share."""
_ROUND = 0.25
"""Cylinders and spheres reach beyond the pieces that they replace by at most this share of the clearance."""


@dataclass(frozen=True, kw_only=True)
class FittedLink:
    """The collision geometry of one link and how well it represents the surface."""

    link: str
    boxes: int
    cylinders: int
    spheres: int
    convex: int
    """Convex meshes."""
    outside: float
    """How far the pieces reach beyond the surface at most; carving takes some of it away [m]."""
    left_out: float
    """Largest distance of the surface from the nearest piece [m]."""
    carved: float
    """Share of the volume of the pieces that the motion carved away."""
    thinned: float
    """How far vertices were moved at most, to have fewer triangles, before anything was fitted [m]; mostly 0."""


@dataclass(frozen=True, kw_only=True)
class Blocked:
    """Two links whose surfaces meet within the range of a joint: their pieces do, too."""

    joint: str
    links: tuple[str, str]
    at: float
    """Value of the joint from which on they meet [rad or m]."""
    depth: float
    """How deep they get into each other within the range [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FittedCollision:
    """A robot with new collision geometry."""

    robot: Robot
    links: tuple[FittedLink, ...]
    """Those that have geometry."""
    clearance: float
    """Distance that is kept between links that a joint moves against each other [m]."""
    jams: tuple[tuple[str, str, str], ...]
    """Joint and two links that still meet in its range, because a link keeps at least one piece."""
    blocked: tuple[Blocked, ...]
    """What the surfaces themselves do not let pass."""


def fit_collision(
    robot: Robot,
    config: CollisionConfig,
    decomposition: PrepareSettings,
    geometry: GeometrySettings,
    *,
    only: frozenset[str] | None = None,
    swept: Mapping[str, JointSweep] | None = None,
) -> FittedCollision:
    """Replace the collision geometry of links, or their visual geometry, by boxes, cylinders and convex pieces.

    Joints are swept one by one, over their limits and a little beyond, because engines' limits are soft; those that
    follow one move with it, the others rest. What no sweep meets stays: primitives are the same ones. Where the
    surfaces themselves block a motion, the pieces do too.

    Args:
        robot: The robot; a link may have any number of shapes.
        config: Clearance and slack, and how finely surfaces are taken apart.
        decomposition: The rest of how they are.
        geometry: When surfaces block a motion.
        only: Links that get pieces, carved clear of what the others collide with now; all if absent.
        swept: Joints that were moved already with all that is visible of the same bodies.

    Returns:
        The robot with pieces in the link frames; meshes among them name files in ``meshes/`` that are not written yet.
    """
    given, robot = robot, _thinned(robot)
    kept = frozenset(i for i, link in enumerate(robot.links) if only is not None and link.name not in only)
    pieces = decomposed(
        robot,
        decomposition.model_copy(
            update={name: getattr(config, name) for name in ("link_gap", "model_gap", "cuts", "cuts_per_link")}
        ),
        only=only,
    )
    poses = forward_kinematics(robot, rest_configuration(robot))
    bodies = [
        _as_it_is(link, poses[link.name]) if i in kept else _in_world(_few(pieces[link.name], config), poses[link.name])
        for i, link in enumerate(robot.links)
    ]
    ends = np.array([end for group in bodies for piece in group for end in (piece.low, piece.high)])
    size = float(np.linalg.norm(np.ptp(ends, axis=0))) if len(ends) else 0.0
    clearance = min(config.clearance, config.clearance_share * size)
    sweeps = _sweeps(robot, poses, config)
    exact = _ExactSweeps(robot, geometry, config.forced_share, sweeps, swept)
    result = carved(
        bodies,
        [np.empty((0, 3)) if i in kept else _marks(link, poses[link.name]) for i, link in enumerate(robot.links)],
        [sweep.motion for sweep in sweeps],
        exact.free_end,
        clearance=clearance,
        thinnest=config.thinnest_share * clearance,
        most=config.most_carved,
        kept=kept,
    )
    links, facts = [], []
    for index, link in enumerate(robot.links):
        if index in kept:
            links.append(given.links[index])
            continue
        uncut = dict(zip(map(id, bodies[index]), pieces[link.name].primitives, strict=False))
        T_link_world = np.asarray(np.linalg.inv(poses[link.name]), dtype=np.float64)
        fitted = [fitted_shape(_moved(piece, T_link_world), _ROUND * clearance) for piece in result.pieces[index]]
        shapes = tuple(
            uncut.get(id(piece)) or shape for piece, (shape, _) in zip(result.pieces[index], fitted, strict=True)
        )
        links.append(replace(given.links[index], collisions=_named(shapes, link.name, index)))
        if shapes:
            kinds = Counter(shape.kind for shape in shapes)
            moved = _thinning(given.links[index])
            facts.append(
                FittedLink(
                    link=link.name,
                    boxes=kinds["box"],
                    cylinders=kinds["cylinder"],
                    spheres=kinds["sphere"],
                    convex=kinds["mesh"],
                    outside=pieces[link.name].gap + max(beyond for _, beyond in fitted) + moved,
                    left_out=_left_out(link, shapes) + moved,
                    carved=result.lost[index],
                    thinned=moved,
                )
            )
    return FittedCollision(
        robot=replace(given, links=tuple(links)),
        links=tuple(facts),
        clearance=clearance,
        jams=tuple((sweeps[k].joint, robot.links[a].name, robot.links[b].name) for k, a, b in result.jams),
        blocked=tuple(exact.blocked),
    )


def _thinned(robot: Robot) -> Robot:
    """The robot with meshes of millions of triangles on a grid."""
    return replace(
        robot,
        links=tuple(
            replace(link, visuals=tuple(map(_thin, link.visuals)), collisions=tuple(map(_thin, link.collisions)))
            if _thinning(link)
            else link
            for link in robot.links
        ),
    )


def _thin(shape: Shape) -> Shape:
    if len(shape.mesh.faces) <= _MANY_FACES:
        return shape
    vertices, faces = snapped(shape.mesh.vertices, shape.mesh.faces, _CELLS)
    return replace(shape, mesh=LinkMesh(vertices=vertices, faces=faces))


def _thinning(link: Link) -> float:
    """Return how far vertices of a link move because there are too many [m]."""
    heavy = [shape.mesh for shape in (*link.visuals, *link.collisions) if len(shape.mesh.faces) > _MANY_FACES]
    return max((3**0.5 * float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))) / _CELLS for mesh in heavy), default=0.0)


def collides_as_it_is(robot: Robot) -> bool:
    """True if what the links collide with is what engines take it for: primitives and convex meshes, on every link."""
    return all(
        bool(link.collisions) and all(shape.kind != "mesh" or _convex(shape.mesh) for shape in link.collisions)
        for link in robot.links
        if link.has_geometry
    )


def _convex(mesh: LinkMesh) -> bool:
    volume = enclosed_volume(mesh.vertices, mesh.faces) if len(mesh.faces) else None
    if volume is None:
        return False
    hull = convex_piece(mesh.vertices, thickness=_THINNEST, directions=len(mesh.vertices))
    return volume >= (1.0 - _FILLED) * hull.volume


@dataclass(frozen=True, kw_only=True, eq=False)
class _Sweep:
    """Two groups of links that a joint moves apart."""

    joint: str
    leader: int
    leads: bool
    """The joint itself is between them; where only followers are, they are carved for the clearance alone."""
    motion: SweptJoint


class _ExactSweeps:
    """Where the visible surfaces of two links let a joint move, asked pair by pair."""

    def __init__(
        self,
        robot: Robot,
        settings: GeometrySettings,
        forced_share: float,
        sweeps: Sequence[_Sweep],
        swept: Mapping[str, JointSweep] | None,
    ) -> None:
        self._sweeps, self._swept = sweeps, swept or {}
        self._scene = read_scene(robot, settings, visible_shapes)
        self._forced = forced_share * self._scene.size
        self._sweeper = Sweeper.of(self._scene)
        self._body_of = {name: index for index, body in enumerate(self._scene.bodies) for name in body.links}
        self._asked = cache(self._end)
        self.blocked: list[Blocked] = []

    def free_end(self, sweep: int, first: int, second: int, sign: float) -> float:
        """Value from rest up to which a joint does not bring two links into each other on one side [rad or m]."""
        asked = self._sweeps[sweep]
        if not asked.leads:
            return sign * np.inf
        a, b = sorted(self._body_of[self._scene.model.links[link].name] for link in (first, second))
        return self._asked(asked.leader, (a, b), sign)

    def _end(self, leader: int, pair: Pair, sign: float) -> float:
        travel = self._scene.travels[leader]
        swept = self._swept.get(travel.joint)
        meeting = (
            next((item for item in swept.sides[sign > 0.0].meetings if item.inside and item.pair == pair), None)
            if swept
            else self._sweeper.meeting(leader, pair, sign)
        )
        if meeting is None or meeting.depth <= self._forced:
            return sign * np.inf
        self.blocked.append(
            Blocked(joint=travel.joint, links=self._scene.name(pair), at=meeting.first, depth=meeting.depth)
        )
        return meeting.first - travel.rest


def _sweeps(robot: Robot, poses: Mapping[str, FloatArray], config: CollisionConfig) -> list[_Sweep]:
    """Sweeps of joints that lead, from where they rest: one for each two groups that a joint moves apart."""
    mechanism = LeaderMechanism(robot=robot)
    found = []
    leaders = robot.leaders
    for column, (joint, low, high) in enumerate(zip(leaders, *joint_ends(leaders), strict=True)):
        slack = config.turn_slack if joint.kind.turns else config.slide_slack
        moving = {name for name, lead in zip(mechanism.joints, mechanism.leads[:, column], strict=True) if lead}
        together = _MovedTogether(robot, joint.name, moving)
        rest, T_world_child = together.rest[joint.name], poses[joint.child]
        for resting, moved in combinations(together.groups, 2):
            motion = SweptJoint(
                moved=together.groups[moved],
                against=together.groups[resting],
                followed=partial(together.motions, resting, moved) if moving != {joint.name} else None,
                turns=joint.kind.turns,
                axis=T_world_child[:3, :3] @ joint.axis,
                pivot=T_world_child[:3, 3],
                lower=min(float(low) - rest, 0.0) - slack,
                upper=max(float(high) - rest, 0.0) + slack,
            )
            found.append(_Sweep(joint=joint.name, leader=column, leads=joint.name in resting ^ moved, motion=motion))
    return found


class _MovedTogether:
    """Links in groups that a leader and its followers do not move against each other."""

    def __init__(self, robot: Robot, leader: str, moving: Collection[str]) -> None:
        self._robot, self._leader, self.rest = robot, leader, rest_configuration(robot)
        index = {link.name: number for number, link in enumerate(robot.links)}
        way: dict[str, frozenset[str]] = {robot.root: frozenset()}
        for joint in robot.joints_downward:
            way[joint.child] = way[joint.parent] | ({joint.name} & set(moving))
        self.groups: dict[frozenset[str], frozenset[int]] = {}
        """Joints that move -> links, those nearest the root first."""
        for link, joints in way.items():
            self.groups[joints] = self.groups.get(joints, frozenset()) | {index[link]}
        self._link = {joints: min(links) for joints, links in self.groups.items()}
        self._displaced = cache(self._displacements)

    def motions(
        self, resting: frozenset[str], moved: frozenset[str], values: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the motion of a group relative to another, from rest in the world frame; values from rest (n,)."""
        displaced = self._displaced(tuple(values.tolist()))
        T = np.linalg.inv(displaced[self._link[resting]]) @ displaced[self._link[moved]]
        return T[:, :3, :3], T[:, :3, 3]

    def _displacements(self, values: tuple[float, ...]) -> dict[int, FloatArray]:
        """From where it rests, for one link of every group, shape (n, 4, 4)."""
        rest = forward_kinematics(self._robot, self.rest)
        poses = [
            forward_kinematics(self._robot, {**self.rest, self._leader: self.rest[self._leader] + value})
            for value in values
        ]
        names = {number: self._robot.links[number].name for number in self._link.values()}
        return {
            number: np.stack([pose[name] for pose in poses]) @ np.linalg.inv(rest[name])
            for number, name in names.items()
        }


def _few(pieces: Pieces, config: CollisionConfig) -> Pieces:
    """At most as many convex pieces as a link may have."""
    return replace(
        pieces,
        convex=tuple(fewer_pieces(pieces.convex, config.most_pieces, thickness=_THINNEST, corners=config.corners)),
    )


def _in_world(pieces: Pieces, T_world_link: FloatArray) -> list[ConvexPiece]:
    """All pieces of a link in the world frame, primitives first."""
    primitives = (enclosing_piece(shape.mesh.vertices, directions=_CORNERS) for shape in pieces.primitives)
    return [_moved(piece, T_world_link) for piece in (*primitives, *pieces.convex)]


def _as_it_is(link: Link, T_world_link: FloatArray) -> list[ConvexPiece]:
    """Return what engines collide of a link that stays as it is: primitives and hulls, in the world frame."""
    return [
        _moved(convex_piece(shape.mesh.vertices, thickness=_THINNEST, directions=_CORNERS), T_world_link)
        for shape in link.collisions
        if len(shape.mesh.faces)
    ]


def _named(shapes: Sequence[Shape], link: str, index: int) -> tuple[Shape, ...]:
    """Shapes with a file for each mesh; the number of the link distinguishes names that differ in special letters."""
    stem = f"{re.sub(r'[^A-Za-z0-9_-]', '_', link)[:_MAX_STEM]}_{index}_collision"
    return tuple(
        replace(shape, file=Path(MESH_FOLDER, f"{stem}_{number}.obj")) if shape.kind == "mesh" else shape
        for number, shape in enumerate(shapes)
    )


def _marks(link: Link, T_world_link: FloatArray) -> FloatArray:
    """Points on what the pieces of a link represent, world frame, shape (n, 3)."""
    return transformed(_on_surface((shape.mesh for shape in judged_shapes(link)), _MARKS), T_world_link)


def _moved(piece: ConvexPiece, T: FloatArray) -> ConvexPiece:
    return ConvexPiece(vertices=transformed(piece.vertices, T), faces=piece.faces)


def _on_surface(meshes: Iterable[LinkMesh], count: int) -> FloatArray:
    """Points on meshes, evenly by area, shape (count, 3); none where there is no face."""
    shown = [mesh for mesh in meshes if len(mesh.faces)]
    if not shown:
        return np.empty((0, 3))
    return surface_points(*as_one((mesh.vertices, mesh.faces) for mesh in shown), count)


def _left_out(link: Link, shapes: Sequence[Shape]) -> float:
    """Largest distance of points on the surface of a link from the nearest of its pieces [m]."""
    points = _on_surface(link.meshes, _PROBES)
    nearest = np.full(len(points), np.inf)
    for shape in shapes:
        normals, offsets = _face_planes(shape.mesh)
        beyond = (points @ normals.T - offsets).max(axis=1)
        nearest = np.minimum(nearest, np.maximum(beyond, 0.0))
    return float(nearest.max())


_BOX_CORNERS = np.stack(np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0, 1.0], indexing="ij"), axis=-1).reshape(8, 3)
_SQUARE = 1e-6
"""A piece is a box if its corners differ from those of one by less than this fraction of its diagonal."""
_ROUNDNESS = 1e-3
"""A piece is round if its corners are on a circle or a sphere but for this fraction of its radius."""
_LEAST_CORNERS = 8
"""Of what may represent a circle."""


def fitted_shape(piece: ConvexPiece, most_beyond: float) -> tuple[Shape, float]:
    """Return the shape that a piece is, and how far that reaches beyond it [m].

    Corners of round pieces lie on their cylinder or sphere, so that nothing is omitted.

    Args:
        piece: In the link frame.
        most_beyond: How far a cylinder or a sphere may reach beyond it [m].

    Returns:
        A box, a cylinder, a sphere or a mesh, and a distance that is 0 for boxes and meshes.
    """
    mesh = LinkMesh(vertices=piece.vertices, faces=piece.faces)
    axes = _box_axes(piece)
    if axes is not None:
        along = piece.vertices @ axes.T
        low, high = along.min(axis=0), along.max(axis=0)
        x, y, z = (high - low).tolist()
        return Shape(
            kind="box", mesh=mesh, size=(x, y, z), T_link_shape=pose_at(0.5 * (low + high) @ axes, axes.T)
        ), 0.0
    for shape, beyond in (_cylinder(piece, mesh), _sphere(piece, mesh)):
        if shape is not None and beyond <= most_beyond:
            return shape, beyond
    plain = plain_piece(piece)
    return Shape(mesh=LinkMesh(vertices=plain.vertices, faces=plain.faces)), 0.0


def _face_planes(piece: ConvexPiece | LinkMesh) -> tuple[FloatArray, FloatArray]:
    """Unit normals (F, 3) and offsets (F,) of the faces."""
    a, b, c = (piece.vertices[piece.faces[:, k]] for k in range(3))
    normals = crossed(b - a, c - a)
    normals /= np.maximum(lengths_of(normals), 1e-300)[:, None]
    return normals, np.einsum("ij,ij->i", normals, a)


def _box_axes(piece: ConvexPiece) -> FloatArray | None:
    """Axes of the box that a piece is, as rows, those nearest to the frame's; None if it is none."""
    if len(piece.vertices) != len(_BOX_CORNERS):
        return None
    normals = _face_planes(piece)[0]
    first = normals[np.argmax(np.abs(normals[:, 0]))]
    second = normals[np.argmin(np.abs(normals @ first) - 1e-3 * np.abs(normals[:, 1]))]
    axes = np.stack([first, second, crossed(first, second)])
    axes = np.stack([axes[k] for k in np.argmax(np.abs(axes), axis=0)])
    axes *= np.where(np.diag(axes) < 0.0, -1.0, 1.0)[:, None]
    if abs(float(np.linalg.det(axes)) - 1.0) > _SQUARE:
        return None
    along = piece.vertices @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    corners = low + _BOX_CORNERS * (high - low)
    farthest = lengths_of(along[:, None] - corners[None]).min(axis=0).max()
    return axes if farthest <= _SQUARE * float(np.linalg.norm(high - low)) else None


def _cylinder(piece: ConvexPiece, mesh: LinkMesh) -> tuple[Shape | None, float]:
    """The cylinder on which all corners of a prism lie."""
    normals = _face_planes(piece)[0]
    heights = piece.vertices @ normals.T
    low, high = heights.min(axis=0), heights.max(axis=0)
    on_ends = np.minimum(heights - low, high - heights).max(axis=0) <= _ROUNDNESS * (high - low)
    if not on_ends.any():
        return None, 0.0
    end = int(np.argmax(on_ends))
    axis = normals[end]
    R_link_axis = rotation_from_x(axis)[:, [1, 2, 0]]
    across = piece.vertices @ R_link_axis[:, :2]
    center, radius = _sphere_through(across)
    if center is None:
        return None, 0.0
    turns = np.sort(np.arctan2(*(across - center).T))
    gaps = np.diff(turns, append=turns[0] + 2.0 * np.pi)
    if (gaps > _ROUNDNESS).sum() < _LEAST_CORNERS:
        return None, 0.0
    beyond = radius * (1.0 - np.cos(0.5 * gaps.max()))
    middle = R_link_axis @ np.append(center, 0.5 * (low[end] + high[end]))
    size = (radius, float(high[end] - low[end]))
    return Shape(kind="cylinder", mesh=mesh, size=size, T_link_shape=pose_at(middle, R_link_axis)), float(beyond)


def _sphere(piece: ConvexPiece, mesh: LinkMesh) -> tuple[Shape | None, float]:
    """The sphere on which all corners lie."""
    center, radius = _sphere_through(piece.vertices)
    if center is None or len(piece.vertices) < _LEAST_CORNERS:
        return None, 0.0
    normals, offsets = _face_planes(piece)
    beyond = radius - float((offsets - normals @ center).min())
    return Shape(kind="sphere", mesh=mesh, size=(radius,), T_link_shape=pose_at(center)), beyond


def _sphere_through(points: FloatArray) -> tuple[FloatArray | None, float]:
    """Centre and radius of the circle (n, 2) or sphere (n, 3) through all points, None where there is none."""
    middle = points.mean(axis=0)
    shifted = points - middle
    unknowns = np.column_stack([2.0 * shifted, np.ones(len(points))])
    found = np.linalg.lstsq(unknowns, (shifted**2).sum(axis=1), rcond=None)[0]
    center = found[:-1]
    distances = np.linalg.norm(shifted - center, axis=1)
    radius = float(distances.max())
    return (center + middle, radius) if np.ptp(distances) <= _ROUNDNESS * radius else (None, 0.0)
