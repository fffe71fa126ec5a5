"""Collision geometry that works as it is written: boxes and convex pieces, carved by the motion of every joint.

Engines see each mesh as its convex hull, and MuJoCo does not filter contacts with a root that it welds to the world: a
drawer in a hollow cabinet would start inside of a solid block. So every surface is taken apart into convex pieces
(`decomposed`), and these are cut back (`carved`) until no joint, swept alone over its range, brings what it moves
nearer to anything else than the clearance. Contacts stay switched on for every pair.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.carve import Sweep, carved
from kinematify.geometry.convex import ConvexPiece, convex_piece, enclosed_volume, surface_points
from kinematify.geometry.fewer import fewer_pieces
from kinematify.geometry.hull import convex_hull
from kinematify.geometry.overlap import Overlap
from kinematify.geometry.rest import Allowance
from kinematify.geometry.scene import read_scene
from kinematify.geometry.sweep import Sweeper
from kinematify.model.collision_pieces import decomposed
from kinematify.model.urdf import MESH_FOLDER
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import LinkMesh, Shape, forward_kinematics, joint_ends, rest_configuration
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.config import CollisionConfig
    from kinematify.config.validation import GeometrySettings, PrepareSettings
    from kinematify.model.collision_pieces import Pieces
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, Link, Robot

_THINNEST = 1e-4
"""Of flat pieces that are joined [m]."""
_PROBES = 400
"""Points of a link's surface by which it is told how much the pieces leave out."""
_MAX_STEM = 100  # file systems end at 255 bytes for a name
_BOX_CORNERS = np.stack(np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0, 1.0], indexing="ij"), axis=-1).reshape(8, 3)
_FILLED = 1e-3
"""A mesh is convex if its hull is larger by less than this share."""
_SQUARE = 1e-6
"""A piece is a box if its corners differ from those of one by less than this fraction of its diagonal."""


@dataclass(frozen=True, kw_only=True)
class FittedLink:
    """The collision geometry of one link and how well it stands for the surface."""

    link: str
    boxes: int
    convex: int
    """Convex meshes."""
    outside: float
    """How far the pieces reached beyond the surface at most before they were carved [m]."""
    left_out: float
    """Largest distance of the surface from the nearest piece [m]."""
    carved: float
    """Share of the volume of the pieces that the motion carved away."""


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
    robot: Robot, config: CollisionConfig, decomposition: PrepareSettings, geometry: GeometrySettings
) -> FittedCollision:
    """Replace the collision geometry of every link, or its visual geometry, by boxes and convex pieces.

    Joints are swept one by one, over their limits and a little beyond, because engines' limits are soft; the others
    rest. What no sweep meets stays: primitives are the same ones. Where the surfaces themselves block a motion, the
    pieces do too.

    Args:
        robot: The robot; a link may have any number of shapes.
        config: Clearance and slack.
        decomposition: How surfaces are taken apart.
        geometry: When surfaces block a motion.

    Returns:
        The robot with pieces in the link frames; meshes among them name files in ``meshes/`` that are not written yet.
    """
    pieces = decomposed(robot, decomposition)
    poses = forward_kinematics(robot, rest_configuration(robot))
    bodies = [_in_world(_few(pieces[link.name], config), poses[link.name]) for link in robot.links]
    clearance = min(config.clearance, config.clearance_share * _size(bodies))
    exact = _ExactSweeps(robot, geometry, config.forced_share)
    result = carved(
        bodies,
        _sweeps(robot, poses, config),
        exact.free_range,
        clearance=clearance,
        thinnest=config.thinnest_share * clearance,
    )
    links, facts = [], []
    for index, link in enumerate(robot.links):
        uncut = dict(zip(map(id, bodies[index]), pieces[link.name].primitives, strict=False))
        T_link_world = np.asarray(np.linalg.inv(poses[link.name]), dtype=np.float64)
        shapes = tuple(uncut.get(id(piece)) or _shape(_moved(piece, T_link_world)) for piece in result.pieces[index])
        links.append(replace(link, collisions=_named(shapes, link.name, index)))
        if shapes:
            facts.append(_fitted(link, shapes, outside=pieces[link.name].gap, lost=result.lost[index]))
    joints = _moving(robot)
    return FittedCollision(
        robot=replace(robot, links=tuple(links)),
        links=tuple(facts),
        clearance=clearance,
        jams=tuple((joints[k].name, robot.links[a].name, robot.links[b].name) for k, a, b in result.jams),
        blocked=tuple(exact.blocked),
    )


def collides_as_it_is(robot: Robot) -> bool:
    """Whether what the links collide with is what engines take it for: primitives and convex meshes, on every link."""
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


class _ExactSweeps:
    """Where the surfaces of two links let a joint move, asked pair by pair."""

    def __init__(self, robot: Robot, settings: GeometrySettings, forced_share: float) -> None:
        self._robot, self._joints = robot, _moving(robot)
        self._scene = read_scene(robot, settings)
        self._forced = forced_share * self._scene.size
        overlap = Overlap(self._scene)
        self._sweeper = Sweeper(self._scene, overlap, Allowance(self._scene, overlap))
        self._body_of = {name: index for index, body in enumerate(self._scene.bodies) for name in body.links}
        self._leader_of = {travel.joint: index for index, travel in enumerate(self._scene.travels)}
        self._asked: dict[tuple[int, int, int], tuple[float, float]] = {}
        self.blocked: list[Blocked] = []

    def free_range(self, sweep: int, first: int, second: int) -> tuple[float, float]:
        """Range around rest in which a joint does not bring two links into each other [rad or m]."""
        joint = self._joints[sweep].name
        a, b = sorted(self._body_of[self._robot.links[link].name] for link in (first, second))
        if joint not in self._leader_of:  # followers are swept for the clearance alone: they never move by themselves
            return -np.inf, np.inf
        leader = self._leader_of[joint]
        key = (leader, a, b)
        if key not in self._asked:
            self._asked[key] = self._range(leader, (a, b))
        return self._asked[key]

    def _range(self, leader: int, pair: tuple[int, int]) -> tuple[float, float]:
        travel, ends = self._scene.travels[leader], [-np.inf, np.inf]
        for side, sign in enumerate((-1.0, 1.0)):
            meeting = self._sweeper.meeting(leader, pair, sign)
            if meeting is not None and meeting.depth > self._forced:
                ends[side] = meeting.first - travel.rest
                links = self._scene.name(pair)
                self.blocked.append(Blocked(joint=travel.joint, links=links, at=meeting.first, depth=meeting.depth))
        return ends[0], ends[1]


def _moving(robot: Robot) -> list[Joint]:
    return [joint for joint in robot.joints if joint.kind is not JointType.FIXED]


def _sweeps(robot: Robot, poses: Mapping[str, FloatArray], config: CollisionConfig) -> list[Sweep]:
    """One sweep for every joint that moves, relative to where it rests."""
    joints = _moving(robot)
    index = {link.name: number for number, link in enumerate(robot.links)}
    rest = rest_configuration(robot)
    found = []
    for joint, low, high in zip(joints, *joint_ends(joints), strict=True):
        slack = config.turn_slack if joint.kind.turns else config.slide_slack
        T_world_child = poses[joint.child]
        found.append(
            Sweep(
                moved=frozenset(index[name] for name in _carried(robot, joint.child)),
                turns=joint.kind.turns,
                axis=T_world_child[:3, :3] @ joint.axis,
                pivot=T_world_child[:3, 3],
                lower=min(float(low) - rest[joint.name], 0.0) - slack,
                upper=max(float(high) - rest[joint.name], 0.0) + slack,
            )
        )
    return found


def _carried(robot: Robot, link: str) -> list[str]:
    """A link and all that hangs on it."""
    return [link, *(name for joint in robot.joints_below[link] for name in _carried(robot, joint.child))]


def _size(bodies: Sequence[Sequence[ConvexPiece]]) -> float:
    """Diagonal of the box around all pieces [m]."""
    ends = np.array([end for group in bodies for piece in group for end in (piece.low, piece.high)])
    return float(np.linalg.norm(np.ptp(ends, axis=0))) if len(ends) else 0.0


def _few(pieces: Pieces, config: CollisionConfig) -> Pieces:
    """At most as many convex pieces as a link may have."""
    few = fewer_pieces(pieces.convex, config.most_pieces, thickness=_THINNEST, corners=config.corners)
    return replace(pieces, convex=tuple(few))


def _in_world(pieces: Pieces, T_world_link: FloatArray) -> list[ConvexPiece]:
    """All pieces of a link in the world frame, primitives first."""
    hulls = [convex_hull(shape.mesh.vertices) for shape in pieces.primitives]
    primitives = [ConvexPiece(vertices=vertices, faces=faces) for vertices, faces in hulls]
    return [_moved(piece, T_world_link) for piece in (*primitives, *pieces.convex)]


def _named(shapes: Sequence[Shape], link: str, index: int) -> tuple[Shape, ...]:
    """Shapes with a file for each mesh; the number of the link tells names apart that differ in special letters."""
    stem = f"{re.sub(r'[^A-Za-z0-9_-]', '_', link)[:_MAX_STEM]}_{index}_collision"
    return tuple(
        replace(shape, file=Path(MESH_FOLDER, f"{stem}_{number}.obj")) if shape.kind == "mesh" else shape
        for number, shape in enumerate(shapes)
    )


def _moved(piece: ConvexPiece, T: FloatArray) -> ConvexPiece:
    return ConvexPiece(vertices=piece.vertices @ T[:3, :3].T + T[:3, 3], faces=piece.faces)


def _shape(piece: ConvexPiece) -> Shape:
    """A box where the piece is one, which engines collide exactly and quickest, else its mesh."""
    mesh = LinkMesh(vertices=piece.vertices, faces=piece.faces)
    axes = _box_axes(piece)
    if axes is None:
        return Shape(mesh=mesh)
    along = piece.vertices @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    T_link_box = np.eye(4)
    T_link_box[:3, :3] = axes.T
    T_link_box[:3, 3] = 0.5 * (low + high) @ axes
    x, y, z = (high - low).tolist()
    return Shape(kind="box", mesh=mesh, size=(x, y, z), T_link_shape=T_link_box)


def _box_axes(piece: ConvexPiece) -> FloatArray | None:
    """Axes of the box that a piece is, as rows, those nearest to the frame's; None if it is none."""
    if len(piece.vertices) != len(_BOX_CORNERS):
        return None
    a, b, c = (piece.vertices[piece.faces[:, k]] for k in range(3))
    normals = crossed(b - a, c - a)
    normals /= np.maximum(lengths_of(normals), 1e-300)[:, None]
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
    farthest = np.linalg.norm(along[:, None] - corners[None], axis=2).min(axis=0).max()
    return axes if farthest <= _SQUARE * float(np.linalg.norm(high - low)) else None


def _fitted(link: Link, shapes: Sequence[Shape], *, outside: float, lost: float) -> FittedLink:
    boxes = sum(shape.kind == "box" for shape in shapes)
    return FittedLink(
        link=link.name,
        boxes=boxes,
        convex=len(shapes) - boxes,
        outside=outside,
        left_out=_left_out(link, shapes),
        carved=lost,
    )


def _left_out(link: Link, shapes: Sequence[Shape]) -> float:
    """Largest distance of points on the surface of a link from the nearest of its pieces [m]."""
    points = np.concatenate(
        [
            surface_points(mesh.vertices, mesh.faces, max(_PROBES // len(link.meshes), 1))
            for mesh in link.meshes
            if len(mesh.faces)
        ]
    )
    nearest = np.full(len(points), np.inf)
    for shape in shapes:
        a, b, c = (shape.mesh.vertices[shape.mesh.faces[:, k]] for k in range(3))
        normals = crossed(b - a, c - a)
        normals /= np.maximum(lengths_of(normals), 1e-300)[:, None]
        beyond = (points @ normals.T - np.einsum("ij,ij->i", normals, a)).max(axis=1)
        nearest = np.minimum(nearest, np.maximum(beyond, 0.0))
    return float(nearest.max())
